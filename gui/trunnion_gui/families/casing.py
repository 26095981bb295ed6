"""Casings in the window: bosses with where they stand round the axis, what outline they have, and how far their foot reaches."""

from __future__ import annotations

from trunnion.model.feature import Feature
from trunnion_gui.families.contract import Column, FamilyView
from trunnion_gui.i18n import tr
from trunnion_gui.look.words import amount

BOSS = "boss"


class CasingView(FamilyView):
    """The view of casings; holes, profiles and pockets look as those of any family do."""

    name = "casing"
    kinds = (BOSS,)

    def columns(self) -> tuple[Column, ...]:
        """Return the columns of bosses: outline, angle about the main axis, height along it, and the bounds of the foot."""
        return (
            Column(
                title=tr("Outline"), tip=tr("Shape of the boss across its sides"), words=outline
            ),
            Column(
                title=tr("Angle, °"),
                tip=tr("Where the boss stands about the main axis, from the x axis of the frame"),
                words=lambda f: _size(f, "theta"),
                cell_tip=lambda f: _bounds(f, "theta", "°"),
            ),
            Column(
                title=tr("Along the axis, mm"),
                tip=tr("Where the boss stands along the main axis, from the lower end face"),
                words=lambda f: _size(f, "z"),
                cell_tip=lambda f: _bounds(f, "z", " mm"),
            ),
        )

    def size(self, feature: Feature) -> str:
        """Return the diameter of a round boss, of another one its length, and the height over the ground."""
        wide = next((n for n in ("diameter", "length", "length_u") if n in feature.sizes), "")
        return " × ".join(s for s in (_size(feature, wide), _size(feature, "height")) if s) + " mm"


def outline(feature: Feature) -> str:
    """Return the outline of a boss in words; empty where nothing is said of it."""
    word = feature.attributes.get("outline", "")
    return tr(str(word)) if word else ""


def _size(feature: Feature, name: str) -> str:
    value = feature.sizes.get(name)
    return amount(value, 2) if isinstance(value, (int, float)) else ""


def _bounds(feature: Feature, name: str, unit: str) -> str:
    """Return how far a foot reaches along a size, and its fillet's toe where it has one."""
    low, high = _size(feature, f"{name}_low"), _size(feature, f"{name}_high")
    if not low:
        return ""
    found = tr("foot from {low} to {high}").format(low=low + unit, high=high + unit)
    toe = _size(feature, f"toe_{name}_low"), _size(feature, f"toe_{name}_high")
    if toe[0]:
        with_fillet = tr("with its fillet from {low} to {high}")
        found += "; " + with_fillet.format(low=toe[0] + unit, high=toe[1] + unit)
    return found
