"""What stands beside the neck, shank and holder of an upright tool while its passes are cut one after the other.

Two fields of fine cells know it: one errs to neither side, in the other a cell is as high as anything in it. Where only this one has
something in the way, as beside every wall, cells can't tell: places on the body's rims are asked, exactly, for what all cuts before left
there. Whatever comes into a body on its way comes in over a rim.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.kernels import heightfield
from trunnion.model.tool import Tool
from trunnion.toolpath.contact_passes.passes import Pass
from trunnion.toolpath.stock.column_cuts import ColumnCutGrid, ColumnCuts, circle
from trunnion.toolpath.stock.heightfield import ARC_CHORD, PlanningStock

SMALLER = ARC_CHORD + tolerance.RAPID_DEPTH
"""mm that rims are smaller than the body: where arcs were opened into chords a cutter is known to have come less far."""
PLACES = 200_000
"""Places that are asked at a time."""
RIMS = 1.0
"""mm from one rim to the next on a body that gets wider."""


@dataclass(frozen=True, eq=False, kw_only=True)
class CutStock:
    """The stock that passes begin with: as it was `planned` on, in fine cells that err to neither side (`centred`), and in fine cells as
    high as what stands in them (`upper`)."""

    planned: PlanningStock
    centred: PlanningStock
    upper: PlanningStock

    @cached_property
    def earlier(self) -> Sequence[ColumnCutGrid]:
        """What was cut before, as far as it comes into the fine cells."""
        low, high = self.upper.box()
        return [
            ColumnCutGrid.of(ColumnCuts.of(path, tool, self.planned.widths), low, high)
            for path, tool in self.planned.exact_cuts
        ]

    def beside(self, passes: Sequence[Pass], tool: Tool) -> BodyStock:
        """Return the stock before the first of some passes of a tool."""
        return BodyStock(self, passes, tool)


class BodyStock:
    """The stock beside passes of an upright tool, each of which is `cut` when it is its turn."""

    def __init__(self, stock: CutStock, passes: Sequence[Pass], tool: Tool) -> None:
        self._stock, self._passes, self._tool = stock, passes, tool
        self.centred, self._upper = stock.centred.working(), stock.upper.working()
        self._rows = np.array(tool.profile()).reshape(-1, 4)
        half = heightfield.HALF_DIAGONAL * stock.centred.cell
        self._body = _widened(self._rows, tool.radius, half)
        self._rims = list(_rims(self._rows))
        # Passes only lower it.
        self._tops = float(self.centred.field.max()), float(self._upper.field.max())
        self._first = np.cumsum([0, *(len(p) - 1 for p in passes)])
        starts, ends = (
            np.concatenate([np.zeros((0, 3)), *(p.tip[of] for p in passes)])
            for of in (slice(None, -1), slice(1, None))
        )
        cuts = ColumnCuts(starts, ends, tool.radius, tool.corner_radius, tool.flute_length)
        self._own = ColumnCutGrid.of(cuts, *self._upper.box())
        self._done = np.zeros(len(starts), dtype=bool)

    def is_free(self, tips: Floats) -> Bools:
        """Return at which tips (k, 3) the tool meets no stock above its flutes."""
        tips = np.ascontiguousarray(tips)
        free = ~_met(self.centred, self._tops[0], tips, self._body)
        for z, radius in self._rims:
            rows = np.flatnonzero(free)
            free[rows] = ~self._comes_over(tips[rows], z, radius)
        return free

    def cut(self, number: int, moves: slice) -> None:
        """Cut moves of a pass."""
        one, tool = self._passes[number], self._tool
        starts, ends = (np.ascontiguousarray(of[moves]) for of in (one.tip[:-1], one.tip[1:]))
        for field in (self.centred, self._upper):
            wider = heightfield.HALF_DIAGONAL * field.cell if field.centred else 0.0
            heightfield.zmap_cut(
                field.field,
                *field.corner,
                field.cell,
                starts,
                ends,
                tool.radius + wider,
                tool.corner_radius,
                tool.flute_length,
                np.empty((len(starts), 2)),
            )
        self._done[self._first[number] : self._first[number + 1]][moves] = True

    def _comes_over(self, tips: Floats, z: float, radius: float) -> Bools:
        """Return at which tips (k, 3) something higher than a rim, z over the tip, stands on it."""
        found, upper = np.zeros(len(tips), dtype=bool), self._upper
        # Shank and holder are mostly above all that stands.
        if not len(tips) or tips[:, 2].min() + z >= self._tops[1]:
            return found
        wide = radius + heightfield.HALF_DIAGONAL * upper.cell
        rows = np.flatnonzero(_met(upper, self._tops[1], tips, np.array([[z, wide, z, wide]])))
        places = circle(radius)
        pieces = math.ceil(len(rows) * len(places) / PLACES)
        for some in np.array_split(rows, pieces) if pieces else ():
            points = (tips[some, None, :2] + places).reshape(-1, 2)
            owner = np.repeat(some, len(places))
            over = tips[owner, 2] + z + tolerance.RAPID_DEPTH
            higher = upper.heights_at(points) > over
            points, owner, over = points[higher], owner[higher], over[higher]
            found[owner[self._is_higher(points, over)]] = True
        return found

    def _is_higher(self, points: Floats, over: Floats) -> Bools:
        """Return at which points (k, 2) all cuts left something higher than a height (k,)."""
        found = np.zeros(len(points), dtype=bool)
        if not len(points):
            return found
        left = np.arange(len(points))
        heights = self._stock.planned.heights_at(points)
        # Cuts before only lower what others begin with: what some do alone all do.
        latest_first = [
            (self._own, self._done),
            *((c, None) for c in reversed(self._stock.earlier)),
        ]
        for cuts, done in latest_first:
            left = left[cuts.lowered(heights[left], points[left], done) > over[left]]
            if not len(left):
                return found
        heights, points = heights[left], points[left]
        for cuts in self._stock.earlier:
            heights = cuts.lowered(heights, points)
        found[left] = self._own.lowered(heights, points, self._done) > over[left]
        return found


def _met(stock: PlanningStock, top: float, tips: Floats, rows: Floats) -> Bools:
    """Return at which tips (k, 3) a body of cones (r, 4) meets something of a stock in fine cells, which is nowhere higher than `top`."""
    found = np.zeros(len(tips), dtype=bool)
    heightfield.zmap_meets(stock.field, top, *stock.corner, stock.cell, tips, rows, found)
    return found


def _widened(rows: Floats, radius: float, more: float) -> Floats:
    """Return the cones (r, 4) of a body wider by `more` (mm), as far as a cell's middle may be from what stands in it; where they are
    thinner than the cutter no wider than that: it has been where they go."""
    wide = rows.copy()
    near = rows[:, [1, 3]]
    wide[:, [1, 3]] = np.where(near >= radius, near + more, np.minimum(near + more, radius))
    return wide


def _rims(rows: Floats) -> Iterator[tuple[float, float]]:
    """Yield the height over the tip and the radius of rims of a body of cones (r, 4): at the lower ends, and on where it gets wider."""
    for low, near, high, far in rows.tolist():
        more = math.ceil(max(far - near, 0.0) / RIMS)
        for k in range(more + 1):
            share = k / max(more, 1)
            radius = near + share * (far - near) - SMALLER
            if radius > 0.0:
                yield low + share * (high - low), radius
