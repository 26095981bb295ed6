"""A box: plate, block or sawn bar."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints, floats
from trunnion.geometry.frame import Frame
from trunnion.geometry.plane.region import Region
from trunnion.geometry.rays import Intervals, box_grid_intervals, box_intervals
from trunnion.model.blank.base import BlankBase, Builder, S

_QUADS = np.array(
    [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
)
"""Sides of a box by rows of `corners`, anticlockwise from outside."""
GROWN = 0.75
"""Of a cell: how far a box is grown that stands askew over a grid, so that a cell which it only grazes counts: past half a diagonal."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Box(BlankBase):
    """A box in a frame of its own: `low` and `high` (3,) mm are its corners in `frame`; `material` a catalogue name."""

    source: ClassVar[str] = ""
    KIND: ClassVar[str] = "box"
    is_box: ClassVar[bool] = True
    frame: Frame
    low: Floats
    high: Floats
    material: str
    density: float
    kind: str = "box"

    def __post_init__(self) -> None:
        self.checked_kind()
        object.__setattr__(self, "low", floats(self.low, (3,), "blank low"))
        object.__setattr__(self, "high", floats(self.high, (3,), "blank high"))
        if not (self.high > self.low).all():
            raise ValueError("blank: its high corner must lie above its low one")

    @property
    def volume(self) -> float:
        """Volume in mm3."""
        return float(np.prod(self.size))

    def measures(self) -> tuple[tuple[str, float], ...]:
        """Return length, width and height."""
        return tuple(("", float(v)) for v in self.size)

    def intervals(self, start: Floats, direction: Floats) -> Intervals:
        """See `BlankBase`."""
        return box_intervals(self.low, self.high, start, direction)

    def grid_intervals(
        self, axis: int, u: Floats, v: Floats, ends: tuple[float, float]
    ) -> Intervals:
        """See `BlankBase`."""
        return box_grid_intervals(self.low, self.high, axis, u, v, ends)

    def depth(self, points: Floats, frame: Frame) -> Floats:
        """See `BlankBase`; of a box that stands askew in the frame, of the box around it."""
        low, high = self.box_in(frame)
        return np.clip(np.minimum(points - low, high - points).min(axis=1), 0.0, None)

    def inward(self, points: Floats) -> Floats:
        """See `BlankBase`."""
        return np.minimum(points - self.low, self.high - points).min(axis=1)

    def sides(self, points: Floats, near: float, sag: float = 0.0) -> Bools:
        """See `BlankBase`: the three at the low corner, then the three at the high one."""
        return np.abs(np.hstack([points - self.low, points - self.high])) <= near

    def shell(self) -> tuple[Floats, Ints]:
        """See `BlankBase`."""
        return self.corners(self.frame), np.vstack([_QUADS[:, [0, 1, 2]], _QUADS[:, [0, 2, 3]]])

    def built(self, builder: Builder[S]) -> S:
        """See `BlankBase`."""
        return builder.box(self.frame, self.low, self.high)

    def plan_area(self, frame: Frame) -> Region:
        """See `BlankBase`; of a box that stands askew in the frame, of the box around it."""
        low, high = self.box_in(frame)
        return Region.rectangle(*low[:2], *high[:2])

    def tops(
        self, frame: Frame, corner: Floats, cell: float, shape: tuple[int, int], lowest: float
    ) -> Floats:
        """See `BlankBase`: where the line through a cell's middle leaves the box, grown so that a cell which it only grazes counts."""
        top = float(self.box_in(frame)[1][2])
        away = self.frame.local_direction(frame.z)
        if np.abs(away).max() > 1.0 - tolerance.PARAMETRIC:
            return np.full(shape, top)
        positions = corner + (np.argwhere(np.ones(shape, dtype=bool)) + 0.5) * cell
        start = self.own(np.column_stack([positions, np.zeros(len(positions))]), frame)
        reach = GROWN * cell
        with np.errstate(divide="ignore", invalid="ignore"):
            ends = np.stack([(self.low - reach - start) / away, (self.high + reach - start) / away])
        ends = np.where(np.isnan(ends), np.array([-np.inf, np.inf])[:, None, None], ends)
        first, last = ends.min(axis=0).max(axis=1), ends.max(axis=0).min(axis=1)
        over = np.where(first < last, last, -np.inf).reshape(shape)
        return np.clip(over, lowest, top)
