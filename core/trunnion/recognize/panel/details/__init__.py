"""What a panel has besides pockets, ribs, holes and its outline: chamfers, pits in walls, fringes."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from trunnion.findings import Finding, face_tags, warning
from trunnion.model.feature import Feature
from trunnion.recognize.panel.details.chamfers import chamfers
from trunnion.recognize.panel.details.fringes import fringes
from trunnion.recognize.panel.details.pits import pits
from trunnion.recognize.panel.features import FeatureNumbers, SideFeatures
from trunnion.recognize.panel.side import PanelSide

PIT_REMEDY = "cut it with a T-slot cutter, or from another side"


def make_details(
    above: PanelSide,
    below: PanelSide,
    features: Sequence[Feature],
    remaining: Collection[int],
    numbers: FeatureNumbers,
) -> SideFeatures:
    """Return chamfers, pits and fringes: of the `remaining` faces (rows), which no feature explains, and of the pockets' free-form walls.

    No upright cutter gets into pits: each is named with a finding.
    """
    made = [*chamfers(above, below, remaining, numbers)]
    rest = set(remaining) - {tag - 1 for f in made for tag in f.tags}
    made += pits(above, features, rest, numbers)
    rest -= {tag - 1 for f in made for tag in f.tags}
    made += fringes(above, features, rest, numbers)
    return SideFeatures(
        features=tuple(made), findings=tuple(_finding(f) for f in made if f.kind == "pit")
    )


def _finding(pit: Feature) -> Finding:
    return warning(
        "panel.undercut",
        f"{pit.id} is not planned: pits are not handled yet",
        pit.id,
        *face_tags(pit.tags),
        remedy=PIT_REMEDY,
    )
