"""Straight cuts in their order, and how high they leave columns of stock: at places, where a field of heights knows its cells alone."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np

from trunnion.geometry.arrays import Bools, Floats, Ints, items_of
from trunnion.geometry.kernels import heightfield
from trunnion.model.motion.toolpath import Toolpath
from trunnion.model.tool import Tool
from trunnion.toolpath.stock.heightfield import cutting_chords

SQUARE = 2.0
"""mm: side of the squares that cuts are looked up by."""
SPACING = 0.1
"""mm between places on a circle about a tool's axis."""
CIRCLES = 256
"""Circles that are kept: a tool with its holder has some dozens."""


@dataclass(frozen=True, slots=True, eq=False)
class ColumnCuts:
    """Straight cuts of a flat, bull or ball end cutter from `starts` to `ends` (n, 3), in their order. Each takes off no more than its
    flutes reach over."""

    starts: Floats
    ends: Floats
    radius: float
    corner_radius: float
    flute_length: float

    @staticmethod
    def of(path: Toolpath, tool: Tool, widths: float) -> ColumnCuts:
        """Return the cuts of a path; `widths` is the share of the cutter's radius that counts."""
        starts, ends, _, error = cutting_chords(path, tool)
        radius = widths * (tool.column_radius - error)
        return ColumnCuts(starts, ends, radius, min(tool.corner_radius, radius), tool.flute_length)

    def lowered(self, heights: Floats, points: Floats) -> Floats:
        """Return the heights (k,) that the cuts leave of columns at points (k, 2) near each other."""
        low, high = points.min(axis=0) - self.radius, points.max(axis=0) + self.radius
        a, b = self.starts[:, :2], self.ends[:, :2]
        near = ((np.maximum(a, b) > low) & (np.minimum(a, b) < high)).all(axis=1)
        rows, left = np.flatnonzero(near), heights.copy()
        heightfield.columns_cut(
            left,
            np.ascontiguousarray(points),
            self.starts[rows],
            self.ends[rows],
            self.radius,
            self.corner_radius,
            self.flute_length,
        )
        return left


@dataclass(frozen=True, eq=False)
class ColumnCutGrid:
    """Straight cuts that are looked up by squares of a plan with a lower corner (2,): those of square k are `rows` from first[k] on, in
    their order."""

    cuts: ColumnCuts
    corner: Floats
    shape: Ints
    rows: Ints
    first: Ints

    @staticmethod
    def of(cuts: ColumnCuts, low: Floats, high: Floats) -> ColumnCutGrid:
        """Return what of cuts comes into a plan from `low` to `high` (2,)."""
        shape = np.maximum(np.ceil((high - low) / SQUARE), 1.0).astype(np.int64)
        a, b = cuts.starts[:, :2], cuts.ends[:, :2]
        begin = np.floor((np.minimum(a, b) - cuts.radius - low) / SQUARE).astype(np.int64)
        end = np.floor((np.maximum(a, b) + cuts.radius - low) / SQUARE).astype(np.int64) + 1
        begin, end = np.maximum(begin, 0), np.minimum(end, shape)
        wide = np.maximum(end - begin, 0)
        count = wide.prod(axis=1)
        row, number = items_of(count)
        deep = np.maximum(wide[row, 1], 1)
        square = (begin[row, 0] + number // deep) * shape[1] + begin[row, 1] + number % deep
        order = np.argsort(square, kind="stable")
        first = np.searchsorted(square[order], np.arange(shape.prod() + 1))
        ready = replace(
            cuts, starts=np.ascontiguousarray(cuts.starts), ends=np.ascontiguousarray(cuts.ends)
        )
        return ColumnCutGrid(ready, np.array(low), shape, row[order], first)

    def lowered(self, heights: Floats, points: Floats, done: Bools | None = None) -> Floats:
        """Return the heights (k,) that the cuts leave of columns at points (k, 2) of the plan; of the cuts (n,) only those that are `done`
        where that is given."""
        left, cuts = heights.copy(), self.cuts
        heightfield.columns_cut_by_squares(
            left,
            np.ascontiguousarray(points),
            self.corner,
            SQUARE,
            self.shape,
            self.rows,
            self.first,
            self._all if done is None else done,
            cuts.starts,
            cuts.ends,
            cuts.radius,
            cuts.corner_radius,
            cuts.flute_length,
        )
        return left

    @cached_property
    def _all(self) -> Bools:
        return np.ones(len(self.cuts.starts), dtype=bool)


@lru_cache(maxsize=CIRCLES)
def circle(radius: float) -> Floats:
    """Return places (k, 2) no farther apart than `SPACING` on a circle of a radius (mm) about the origin; kept by radius."""
    count = math.ceil(2.0 * math.pi * radius / SPACING)
    angle = 2.0 * math.pi * np.arange(count) / count
    found = radius * np.column_stack([np.cos(angle), np.sin(angle)])
    found.setflags(write=False)
    return found
