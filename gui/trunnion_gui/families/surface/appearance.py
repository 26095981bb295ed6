"""How groups of equal patches look: their classes, their radii in words and as colours."""

from __future__ import annotations

from collections.abc import Sequence

from trunnion.model.feature import Feature, Recognition
from trunnion_gui.families.contract import Column, FeatureClass, LegendRow
from trunnion_gui.families.surface.groups import GROUP, LOCAL, is_local
from trunnion_gui.i18n import tr
from trunnion_gui.look.colours import hexed, palette
from trunnion_gui.look.words import amount

_LARGE = 100.0
"""mm: of larger radii nobody wants to know the decimals."""


def classes(kind: str, features: Sequence[Feature]) -> tuple[FeatureClass, ...]:
    """Return the remaining area and the local features, those of them that there are."""
    remaining, local = class_colours()
    all_of_them = (
        FeatureClass(
            kind, tr("Remaining area"), remaining, tuple(f for f in features if not is_local(f))
        ),
        FeatureClass(LOCAL, tr("Local features"), local, tuple(f for f in features if is_local(f))),
    )
    return tuple(c for c in all_of_them if c.features)


def class_colours() -> tuple[str, str]:
    """Return the colours that represent the groups of the remaining area, and for local features."""
    remaining, local = palette().kinds[GROUP].classes
    return remaining.colours[0], local.colours[0]


def radius_columns() -> tuple[Column, ...]:
    """Return the columns of the smallest concave and convex radii."""
    return (
        _radius_column(
            "concave_radius",
            tr("r in"),
            tr("Smallest concave radius in mm; no larger ball reaches"),
            "fillet_radius",
            tr("fillet"),
        ),
        _radius_column(
            "convex_radius",
            tr("r out"),
            tr("Smallest convex radius in mm"),
            "rounding_radius",
            tr("rounded edge"),
        ),
    )


def _radius_column(name: str, title: str, tip: str, detail: str, detail_words: str) -> Column:
    """Return the column of one radius; its cells' tips give another one, of the fillets or rounded edges."""

    def cell_tip(feature: Feature) -> str:
        radius = radius_words(feature, detail)
        return f"{detail_words} R {radius} mm" if radius else ""

    return Column(title=title, tip=tip, words=lambda f: radius_words(f, name), cell_tip=cell_tip)


def radius_words(feature: Feature, name: str) -> str:
    """Return a radius of a group without its unit, nothing where there is none."""
    value = _radius(feature, name)
    return "" if value is None else amount(value, 2 if value < _LARGE else 0)


def radius_colour(radius: float) -> str:
    """Return the colour of a radius in mm."""
    return hexed(palette().radius.at(radius))


def radii_by_face(found: Recognition) -> dict[int, str]:
    """Return the colour of the smallest concave radius of each face's group, by tag; faces without one are left out."""
    return {
        tag: radius_colour(radius)
        for f in found
        for tag in f.tags
        if (radius := _radius(f, "concave_radius")) is not None
    }


def radius_legend() -> list[LegendRow]:
    """Return the rows of the steps of radii."""
    scale = palette().radius
    words = [*(f"≤ {limit:g} mm" for limit in scale.limits), f"> {scale.limits[-1]:g} mm"]
    return [
        ("", tr("Smallest concave radius"), ""),
        *((hexed(c), w, "") for c, w in zip(scale.colours, words, strict=True)),
    ]


def _radius(feature: Feature, name: str) -> float | None:
    """Return a radius of a group of patches in mm, None where nothing is curved that way."""
    value = feature.sizes.get(name)
    return float(value) if isinstance(value, (int, float)) and 0.0 < value < float("inf") else None
