"""What a panel has besides pockets, ribs, holes and its outline: chamfers, pits in walls, fringes."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from trunnion.model.feature import Feature
from trunnion.recognize.panel.details.chamfers import chamfers
from trunnion.recognize.panel.details.fringes import fringes
from trunnion.recognize.panel.details.pits import pits
from trunnion.recognize.panel.features import FeatureNumbers
from trunnion.recognize.panel.side import PanelSide


def make_details(
    above: PanelSide,
    below: PanelSide,
    features: Sequence[Feature],
    remaining: Collection[int],
    numbers: FeatureNumbers,
) -> tuple[Feature, ...]:
    """Return chamfers, pits and fringes: of the `remaining` faces (rows), which no feature explains, and of the pockets' free-form
    walls."""
    made = [*chamfers(above, below, remaining, numbers)]
    rest = set(remaining) - {tag - 1 for f in made for tag in f.tags}
    made += pits(above, features, rest, numbers)
    rest -= {tag - 1 for f in made for tag in f.tags}
    made += fringes(above, features, rest, numbers)
    return tuple(made)
