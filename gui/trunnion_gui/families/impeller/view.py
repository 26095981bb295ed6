"""Impellers in the window: blades in their order round the wheel, splitters with their channel, and the pair that represents all."""

from __future__ import annotations

from trunnion.model.feature import Feature, Recognition
from trunnion_gui.families.contract import Column, FamilyView
from trunnion_gui.i18n import tr

BLADE, SPLITTER = "blade", "splitter"
KINDS = (BLADE, SPLITTER, "hub", "bore", "plane")
"""Kinds of features that only impellers have; profiles and holes look as those of any family do."""


class ImpellerView(FamilyView):
    """The view of impellers."""

    name = "impeller"
    kinds = KINDS

    def columns(self) -> tuple[Column, ...]:
        return (
            Column(
                title=tr("Channel"),
                tip=tr("The main blades that a splitter stands between"),
                words=channel,
            ),
            Column(
                title=tr("Pair"),
                tip=tr("The two neighbours that are programmed for all"),
                is_ticked=is_paired,
            ),
        )

    def remark(self, found: Recognition) -> str:
        pair = [f.id for f in found.of_kind(BLADE, SPLITTER) if is_paired(f)]
        return tr(", neighbouring pair {pair}").format(pair=" + ".join(pair)) if pair else ""


def channel(feature: Feature) -> str:
    """Return the main blades that a splitter stands between, empty for others."""
    return str(feature.attributes.get("channel", ""))


def is_paired(feature: Feature) -> bool:
    """Return whether a feature is one of the neighbouring pair that represents all blades."""
    return bool(feature.attributes.get("pair"))
