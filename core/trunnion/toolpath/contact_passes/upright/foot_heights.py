"""How low a cutter comes on steep faces: to where it touches them lowest, or to what stops it at the foot of an upright wall.

A cutter beside a wall is dropped past hundreds of triangles of it, and finely divided walls have corners by the hundred thousand. Only the
lowest stop and the highest foot are wanted: the cutter is dropped at few places, and at all that may come to either.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.model.tool import Tool
from trunnion.plan.freeform.cutters.cutter import lower_side
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.progress import Progress
from trunnion.toolpath.contact_passes.stepover.spacing import FacetSlopes

UPWARD = -math.sin(tolerance.ANGLE)
"""The least part along z of normals of upright walls."""
FOOT = 5e-4
"""mm over what stops a cutter at the foot of an upright wall: there its lowest level is."""
OFF = 2e-3
"""mm off an upright wall: there a cutter comes down past it."""
APART = (0.25, 0.05, 0.01)
"""mm: of the places in squares of these sides, one after the other, the cutter is dropped at one each before others."""
AROUND = 3.0
"""Times as far away places tell by how much heights in between may differ."""
DOUBT = 2.0
"""Times what heights around differ by that one in between may differ by."""
SAME = 1e-7
"""mm: heights that differ by less are one."""


@dataclass(frozen=True, slots=True, eq=False)
class WallFoot:
    """How low (m,) the tip comes that touches each triangle: lower than it only where the foot of an upright one stops it; and the height
    of the highest such foot, -inf where there is none. Of upright ones the lowest and that foot are exact, others are bounds."""

    low: Floats
    highest_foot: float

    def some(self, which: Bools, highest_foot: float) -> WallFoot:
        """Return those of some of the triangles, whose highest foot is given."""
        return WallFoot(self.low[which], highest_foot)


def lowest_tips(
    slopes: FacetSlopes, drive: SurfaceDrive, tool: Tool, progress: Progress
) -> WallFoot:
    """Return how low the tip comes on each triangle, and where the foot of upright walls is highest."""
    low, high = slopes.tips[:, :, 2].min(axis=1), slopes.tips[:, :, 2].max(axis=1)
    upright = np.flatnonzero(slopes.normal[:, 2] <= -UPWARD)
    if not len(upright):
        return WallFoot(low, -math.inf)
    drive.skin.made_ready(progress)
    plan = (slopes.tips[upright] + OFF * slopes.normal[upright, None])[:, :, :2].reshape(-1, 2)
    # Triangles share their corners.
    first, of = _gathered(plan, tolerance.COINCIDENT)
    walls = _Walls(low[upright], high[upright], plan[first], of.reshape(-1, 3))
    lowest = float(drive.low[2]) - tool.flute_length

    def stops(places: Floats) -> Floats:
        over = drive.skin.drop.drop(places, lower_side(tool, drive.allowance), lowest, progress)
        return over + drive.allowance + FOOT

    least, most = stop_bounds(walls, stops)
    low[upright] = walls.lowest(least)
    return WallFoot(low, walls.highest_foot(most))


@dataclass(frozen=True, slots=True, eq=False)
class _Walls:
    """Triangles of upright walls: how `low` and `high` (u,) the tips are that touch each, and the `places` (k, 2) in plan where a cutter
    comes down past their corners, of which those of each are `of` (u, 3)."""

    low: Floats
    high: Floats
    places: Floats
    of: Ints

    def lowest(self, stops: Floats) -> Floats:
        """Return how low (u,) the tip comes on each triangle where it is stopped at heights (k,)."""
        stopped = stops[self.of].min(axis=1)
        # Where it is stopped over the whole triangle, the foot is another one's.
        return np.where(stopped < self.high, np.maximum(self.low, stopped), self.high)

    def highest_foot(self, stops: Floats) -> float:
        """Return the highest foot, -inf where there is none."""
        # Where another wall stands in its way it is stopped by the top of that one, which is no foot.
        feet = stops[self.of]
        return float(feet[feet < self.high[:, None]].max(initial=-math.inf))


def stop_bounds(walls: _Walls, stops: Callable[[Floats], Floats]) -> tuple[Floats, Floats]:
    """Return between which heights (k,) a cutter is stopped at the places of walls; `stops` returns them exactly, for places (n, 2).

    Both are exact wherever the lowest or the highest foot may be: one of the places near each other is asked, and what it differs by from
    those around it bounds the others.
    """
    least, most = (np.full(len(walls.places), sign * math.inf) for sign in (-1.0, 1.0))
    for side in APART:
        rows = _undecided(walls, least, most)
        if len(rows):
            first, of = _gathered(walls.places[rows], side)
            places = walls.places[rows[first]]
            at = stops(places)
            spread = DOUBT * _spread(places, at, AROUND * side)
            least[rows] = np.maximum(least[rows], (at - spread)[of])
            most[rows] = np.minimum(most[rows], (at + spread)[of])
            least[rows[first]] = most[rows[first]] = at
    rows = _undecided(walls, least, most)
    if len(rows):
        least[rows] = most[rows] = stops(walls.places[rows])
    return least, most


def _undecided(walls: _Walls, least: Floats, most: Floats) -> Ints:
    """Return the places (n,) whose height is not known and may be where the lowest stop or the highest foot is: branch and bound."""
    wanted = np.zeros(len(walls.places), dtype=bool)
    low, high = walls.lowest(least), walls.lowest(most)
    wanted[walls.of[(low <= high.min()) & (low < high)]] = True
    top = walls.high[:, None]
    lower, upper = least[walls.of], most[walls.of]
    sure = float(lower[upper < top].max(initial=-math.inf))
    wanted[walls.of[(lower < top) & (upper >= sure)]] = True
    return np.flatnonzero(wanted & (least < most))


def _gathered(places: Floats, side: float) -> tuple[Ints, Ints]:
    """Return a place (g,) of each square of a side (mm) that holds any of places (n, 2), and the square (n,) that each lies in."""
    _, first, of = np.unique(
        np.round(places / side).astype(np.int64), axis=0, return_index=True, return_inverse=True
    )
    return first, of.ravel()


def _spread(places: Floats, heights: Floats, around: float) -> Floats:
    """Return by how much (g,) heights at places (g, 2) differ from those around each (mm) at most; without bound where none are."""
    pairs = cKDTree(places).query_pairs(around, output_type="ndarray")
    found = np.full(len(places), -math.inf)
    differs = np.abs(np.diff(heights[pairs], axis=1)).ravel()
    for end in pairs.T:
        np.maximum.at(found, end, differs)
    found[found <= SAME] = 0.0
    return np.where(np.bincount(pairs.ravel(), minlength=len(places)) > 0, found, math.inf)
