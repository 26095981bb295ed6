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

REMEDIES = {
    "chamfer": ("panel.chamfer", "cut it by a hand-made operation"),
    "pit": ("panel.undercut", "cut it with a T-slot cutter, or from another side"),
    "fringe": ("panel.leaning-wall", "machine it with another strategy"),
}
"""For each kind the code of the finding that nothing is planned for it, and what a person can do."""


def make_details(
    above: PanelSide,
    below: PanelSide,
    features: Sequence[Feature],
    remaining: Collection[int],
    numbers: FeatureNumbers,
) -> SideFeatures:
    """Return chamfers, pits and fringes: of the `remaining` faces (rows), which no feature explains, and of the pockets' free-form walls.

    What no pocket holds too is not planned, and named with a finding.
    """
    made = [*chamfers(above, below, remaining, numbers)]
    rest = set(remaining) - {tag - 1 for f in made for tag in f.tags}
    made += pits(above, features, rest, numbers)
    rest -= {tag - 1 for f in made for tag in f.tags}
    made += fringes(above, features, rest, numbers)
    return SideFeatures(
        features=tuple(made), findings=tuple(_finding(f) for f in made if _is_left(f))
    )


def _is_left(feature: Feature) -> bool:
    """Return whether nothing cuts a feature: a pocket's fringe is cut with its pocket."""
    return feature.kind != "fringe" or "in" not in feature.attributes


def _finding(feature: Feature) -> Finding:
    code, remedy = REMEDIES[feature.kind]
    return warning(
        code,
        f"{feature.id} is not planned: {feature.kind}s are not handled yet",
        feature.id,
        *face_tags(feature.tags),
        remedy=remedy,
    )
