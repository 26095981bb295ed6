"""Passes: what surface strategies make before they are linked to a toolpath."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Bools, Floats, Ints, floats, items_of

UPRIGHT = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Pass:
    """One uninterrupted cut, in the cutting frame: what lies between two tips is a straight move.

    tip (k, 3) mm; axis (k, 3) unit, from tip to spindle; normal (k, 3) the outward unit normal of the face at the contact: leads come in
    and go out on that side. `closed`: the last tip is the first one again.
    """

    tip: Floats
    axis: Floats
    normal: Floats
    closed: bool = False

    def __post_init__(self) -> None:
        n = len(np.asarray(self.tip))
        for name in ("tip", "axis", "normal"):
            object.__setattr__(self, name, floats(getattr(self, name), (n, 3), f"pass {name}"))

    def __len__(self) -> int:
        return len(self.tip)

    @property
    def upright(self) -> bool:
        """Whether the tool's axis is the cutting frame's z all along."""
        return bool((np.abs(self.axis - UPRIGHT) < 1e-12).all())

    @property
    def length(self) -> float:
        """Length of the path of the tip in mm."""
        return float(np.linalg.norm(np.diff(self.tip, axis=0), axis=1).sum())

    def reversed(self) -> Pass:
        """Return the pass cut the other way."""
        return Pass(
            tip=self.tip[::-1], axis=self.axis[::-1], normal=self.normal[::-1], closed=self.closed
        )

    def of(self, rows: Bools | Ints | slice) -> Pass:
        """Return a part of the pass; it is not closed."""
        return Pass(tip=self.tip[rows], axis=self.axis[rows], normal=self.normal[rows])


def spaced(tip: Floats, step: float) -> tuple[Floats, Ints]:
    """Return positions (n, 3) along straight moves from tip to tip (k, 3), no farther apart than a step (mm), and the move (n,) that each
    is on."""
    moved = np.linalg.norm(np.diff(tip, axis=0), axis=1)
    count = np.maximum(np.ceil(moved / step), 1.0).astype(np.int64)
    row, number = items_of(count)
    share = (number / count[row])[:, None]
    positions = np.vstack([tip[row] + share * (tip[row + 1] - tip[row]), tip[-1:]])
    return positions, np.append(row, len(count) - 1)
