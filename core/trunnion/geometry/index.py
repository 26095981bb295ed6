"""Which boxes in the plane are near a place: a uniform grid over boxes, for many questions about the same things."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from trunnion.geometry.arrays import Floats, Ints, floats


class BoxIndex:
    """A uniform grid over boxes `low`, `high` (n, 2) mm; raises `ValueError` when there is no box or one is upside down."""

    def __init__(self, low: ArrayLike, high: ArrayLike) -> None:
        self.low: Floats = floats(low, (None, 2), "box low")
        self.high: Floats = floats(high, (len(self.low), 2), "box high")
        if len(self.low) == 0 or (self.high < self.low).any():
            raise ValueError("boxes: there must be at least one, with no high corner below its low corner")
        self.origin: Floats = self.low.min(axis=0)
        span = np.maximum(self.high.max(axis=0) - self.origin, np.finfo(np.float64).tiny)
        # About one box a cell: finer grids repeat large boxes too often, coarser ones answer too much.
        per_axis = int(np.ceil(np.sqrt(len(self.low))))
        self.cells = np.array([per_axis, per_axis])
        self.size: Floats = span / self.cells
        first, last = self._cell(self.low), self._cell(self.high)
        wide = last - first + 1
        count = wide[:, 0] * wide[:, 1]
        box = np.repeat(np.arange(len(count)), count)
        step = np.arange(len(box)) - np.repeat(np.cumsum(count) - count, count)
        cell = (first[box, 0] + step % wide[box, 0]) * per_axis + first[box, 1] + step // wide[box, 0]
        order = np.argsort(cell, kind="stable")
        self._boxes: Ints = box[order]
        self._begin: Ints = np.searchsorted(cell[order], np.arange(per_axis * per_axis + 1))

    def _cell(self, points: Floats) -> Ints:
        at = np.floor((points - self.origin) / self.size)
        return np.clip(at, 0, self.cells - 1).astype(np.int64)

    def near(self, low: ArrayLike, high: ArrayLike) -> Ints:
        """Return the rows of all boxes that meet the box from `low` to `high` (2,), ascending."""
        a, b = np.asarray(low, dtype=np.float64), np.asarray(high, dtype=np.float64)
        (x0, y0), (x1, y1) = self._cell(a), self._cell(b)
        columns = [self._boxes[self._begin[x * self.cells[1] + y0]:self._begin[x * self.cells[1] + y1 + 1]] for x in range(x0, x1 + 1)]
        rows = np.unique(np.concatenate(columns))
        return rows[((self.low[rows] <= b) & (self.high[rows] >= a)).all(axis=1)]

    def pairs(self) -> Ints:
        """Return all pairs (k, 2) of boxes that meet each other, the smaller row first, ascending."""
        found = [np.stack([np.full(len(rows), i), rows], axis=1) for i in range(len(self.low))
                 if len(rows := (near := self.near(self.low[i], self.high[i]))[near > i])]
        return np.concatenate(found) if found else np.empty((0, 2), dtype=np.int64)
