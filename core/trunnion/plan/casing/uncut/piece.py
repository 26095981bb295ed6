"""An uncut piece: where it is, how much it is, and the largest cutter that clears it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from trunnion.geometry.arrays import Floats

INSIDE, BETWEEN, BESIDE = 1, 2, 3
"""Classes: inside a boss's outline, between two bosses, between a boss and a side of its pocket."""
DECIMALS = 4


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class UncutPiece:
    """Material that a cutter leaves, in the casing's frame.

    `number` is its class, `owners` the features on both sides of it; `area` (mm2) of its section, across the boss's direction for class 1,
    on the ground for the others; `volume` (mm3) down to the ground; `boundary` (k, 3) the closed outline of that section, mm; `end_lines`
    pairs of points where the cutter stops; `clears` the diameter (mm) of the largest cutter that leaves nothing there, 0 where none does.
    """

    number: int
    owners: tuple[str, ...]
    cutter: float
    area: float
    volume: float
    boundary: Floats
    clears: float
    end_lines: tuple[tuple[Floats, Floats], ...] = field(default=())

    def as_dict(self) -> dict[str, Any]:
        """Return it as the JSON that other programs rely on."""
        return {
            "class": self.number,
            "owners": list(self.owners),
            "cutter_diameter": self.cutter,
            "area": round(self.area, DECIMALS),
            "volume": round(self.volume, DECIMALS),
            "largest_cutter": round(self.clears, DECIMALS),
            "boundary": np.round(self.boundary, DECIMALS).tolist(),
            "end_lines": [
                [np.round(p, DECIMALS).tolist() for p in line] for line in self.end_lines
            ],
        }
