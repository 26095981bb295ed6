"""Areas to avoid: where the tip of one operation's tool may not go."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Floats


@dataclass(frozen=True, slots=True, kw_only=True, order=True)
class KeepOutBox:
    """A box that a tool's tip stays out of, in the operation's cutting frame (its setup's frame, turned so that z is its direction).

    `low` and `high` are its corners in plan, mm; below `top`, a height in mm, it is solid without end: over it all is cut. A tip on its
    rim is outside. Raises `ValueError` where a corner is not below the other one.
    """

    low: tuple[float, float]
    high: tuple[float, float]
    top: float

    def __post_init__(self) -> None:
        if not (self.low[0] < self.high[0] and self.low[1] < self.high[1]):
            raise ValueError(
                f"a box to keep out of goes from {self.low} to {self.high}: it is empty"
            )

    def meets(self, other: KeepOutBox) -> bool:
        """Return whether two boxes have area in common in plan."""
        return all(
            a < d and c < b
            for a, b, c, d in zip(self.low, self.high, other.low, other.high, strict=True)
        )

    def holds(self, other: KeepOutBox) -> bool:
        """Return whether another box is wholly inside this one."""
        ends = zip(self.low, self.high, other.low, other.high, strict=True)
        return other.top <= self.top and all(a <= c and d <= b for a, b, c, d in ends)


def plan_boxes(boxes: Iterable[KeepOutBox]) -> Floats:
    """Return boxes as rows (k, 5): x and y of the lower corner in plan, of the higher one, and the top."""
    return np.array([(*b.low, *b.high, b.top) for b in boxes], dtype=np.float64).reshape(-1, 5)
