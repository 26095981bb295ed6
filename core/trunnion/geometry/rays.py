"""Where rays are inside a solid: intervals along each, for boxes and closed triangle meshes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints, items_of

TOGETHER = 4_000_000
"""Pairs of triangles and rays that are looked at together: some hundred MB of tables."""
BIN_RAYS = 4
"""Rays in a bin, about: fewer make more bins to visit than rays to look at."""


@dataclass(frozen=True, slots=True, eq=False)
class Intervals:
    """Of n rays: count (n,) of intervals inside, low and high (n, k) mm along each ray from its start, upwards, 0 beyond the count."""

    count: Ints
    low: Floats
    high: Floats

    def clipped(self, lowest: float, highest: float) -> Intervals:
        """Return what lies between two positions along the rays."""
        low, high = np.maximum(self.low, lowest), np.minimum(self.high, highest)
        kept = high > low
        kept &= np.arange(self.low.shape[1]) < self.count[:, None]
        low[~kept] = high[~kept] = 0.0
        if low.shape[1] > 1:
            order = np.argsort(~kept, axis=1, kind="stable")
            low, high = (np.take_along_axis(ends, order, axis=1) for ends in (low, high))
        return Intervals(kept.sum(axis=1).astype(np.int64), low, high)

    def tops(self, nothing: float) -> Floats:
        """Return the highest end of each ray's intervals (n,), or `nothing` for a ray that is never inside."""
        top = self.high[:, 0]
        if self.high.shape[1] > 1:
            last = np.maximum(self.count - 1, 0)[:, None]
            top = np.take_along_axis(self.high, last, axis=1)[:, 0]
        return np.where(self.count > 0, top, nothing)


def stacked(parts: Sequence[Intervals]) -> Intervals:
    """Return the intervals of rays one after the other."""
    width = max(p.low.shape[1] for p in parts)
    low, high = (
        np.concatenate([_wide(a, width) for a in ends])
        for ends in zip(*((p.low, p.high) for p in parts), strict=True)
    )
    return Intervals(np.concatenate([p.count for p in parts]), low, high)


def _wide(ends: Floats, width: int) -> Floats:
    """Return ends (n, k) of intervals with zeros up to a width."""
    missing = width - ends.shape[1]
    return np.pad(ends, ((0, 0), (0, missing))) if missing else ends


def box_intervals(low: Floats, high: Floats, start: Floats, direction: Floats) -> Intervals:
    """Return where rays from `start` (n, 3) along a unit `direction` (3,) are in a box; one along a side of it is inside.

    Kay and Kajiya's slabs (Ray tracing complex scenes, 1986).
    """
    enter, leave = np.full(len(start), -np.inf), np.full(len(start), np.inf)
    for k in range(3):
        position, (first, last) = start[:, k], (low[k], high[k])
        if direction[k] == 0.0:
            inside = position >= first - tolerance.PARAMETRIC
            inside &= position <= last + tolerance.PARAMETRIC
            leave[~inside] = -np.inf
        else:
            near, far = (first, last) if direction[k] > 0.0 else (last, first)
            np.maximum(enter, (near - position) / direction[k], out=enter)
            np.minimum(leave, (far - position) / direction[k], out=leave)
    inside = leave > enter
    enter[~inside] = leave[~inside] = 0.0
    return Intervals(inside.astype(np.int64), enter[:, None], leave[:, None])


def box_grid_intervals(
    low: Floats, high: Floats, axis: int, u: Floats, v: Floats, ends: tuple[float, float]
) -> Intervals:
    """Return where rays along an axis of a box are in it, between two ends of that axis: row by row of a grid, at u (columns,) on the next
    axis and v (rows,) on the one after; one along a side is inside."""
    first, last = max(float(low[axis]), ends[0]), min(float(high[axis]), ends[1])
    columns, rows = (
        (at >= low[k % 3] - tolerance.PARAMETRIC) & (at <= high[k % 3] + tolerance.PARAMETRIC)
        for k, at in ((axis + 1, u), (axis + 2, v))
    )
    inside = (rows[:, None] & columns).reshape(-1, 1) & (last > first)
    return Intervals(inside[:, 0].astype(np.int64), inside * first, inside * last)


def mesh_intervals(points: Floats, triangles: Ints, start: Floats, direction: Floats) -> Intervals:
    """Return where rays from `start` (n, 3) along a unit `direction` (3,) are in a closed mesh, its triangles anticlockwise from outside.

    A ray through an edge or a corner counts as one a hair beside it, the same hair for all triangles (simulation of simplicity,
    Edelsbrunner and Muecke 1990), so none slips between two of them.
    """
    axes = _plan_axes(direction)
    ray, height, sign = _crossings(points @ axes.T, triangles, start @ axes[:2].T)
    return paired(len(start), ray, height - (start @ axes[2])[ray], sign)


def paired(n: int, ray: Ints, along: Floats, sign: Ints) -> Intervals:
    """Return intervals from crossings in any order: the ray (m,), how far along it (m,), and +1 (m,) where it enters, -1 where it leaves.

    Solids that overlap are one; what is shorter than noise is nothing.
    """
    order = np.lexsort((-sign, along, ray))
    ray, along, sign = ray[order], along[order], sign[order]
    depth = np.cumsum(sign)
    first = np.searchsorted(ray, np.arange(n))
    before = np.concatenate([[0], depth])[first]
    inside = depth - before[ray]
    begins = np.flatnonzero((inside == 1) & (sign == 1))
    ends = np.flatnonzero((inside == 0) & (sign == -1))
    low, high, owner = along[begins], along[ends], ray[begins]
    kept = high - low > tolerance.PARAMETRIC
    low, high, owner = low[kept], high[kept], owner[kept]
    count = np.bincount(owner, minlength=n).astype(np.int64)
    position = np.arange(len(owner)) - np.searchsorted(owner, owner)
    shape = (n, max(1, int(count.max(initial=0))))
    lows, highs = np.zeros(shape), np.zeros(shape)
    lows[owner, position], highs[owner, position] = low, high
    return Intervals(count, lows, highs)


def _plan_axes(direction: Floats) -> Floats:
    """Return three axes as rows (3, 3), the last one the direction; those of a direction along an axis are axes, exactly."""
    k = int(np.argmax(np.abs(direction)))
    across = np.zeros(3)
    across[(k + 1) % 3] = 1.0
    x = across - (across @ direction) * direction
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(direction, x), direction])


def _crossings(points: Floats, triangles: Ints, plan: Floats) -> tuple[Ints, Floats, Ints]:
    """Return rays (m,), heights (m,) and signs (m,) of all crossings of rays at `plan` (n, 2) upwards with triangles."""
    if not len(plan) or not len(triangles):
        return np.zeros(0, np.int64), np.zeros(0), np.zeros(0, np.int64)
    bins = _Bins(plan)
    found = []
    for some, rays in bins.pairs(points[:, :2][triangles]):
        corner = points[triangles[some]]
        inside, turn = _over(points[:, :2], triangles[some], plan[rays])
        some, rays, turn, corner = some[inside], rays[inside], turn[inside], corner[inside]
        found.append((rays, _height(corner, plan[rays]), turn))
    rays, heights, turns = (np.concatenate(part) for part in zip(*found, strict=True))
    # Anticlockwise from above: the triangle looks up, and a ray that goes up leaves there.
    return rays, heights, -turns


def _over(plan: Floats, triangles: Ints, at: Floats) -> tuple[Bools, Ints]:
    """Return which triangles (m, 3) are over positions (m, 2), and whether they turn anticlockwise (+1) or clockwise (-1) there."""
    sides = []
    for k in range(3):
        a, b = triangles[:, k], triangles[:, (k + 1) % 3]
        swapped = a > b
        first, last = np.where(swapped, b, a), np.where(swapped, a, b)
        p, d = plan[first], plan[last] - plan[first]
        side = np.sign(d[:, 0] * (at[:, 1] - p[:, 1]) - d[:, 1] * (at[:, 0] - p[:, 0]))
        # On the edge: as a hair (e, e^2) beside.
        hair_side = np.where(d[:, 1] != 0.0, -np.sign(d[:, 1]), np.sign(d[:, 0]))
        side = np.where(side == 0.0, hair_side, side)
        sides.append(np.where(swapped, -side, side))
    total = np.sum(sides, axis=0)
    return np.abs(total) == 3.0, np.sign(total).astype(np.int64)


def _height(corner: Floats, at: Floats) -> Floats:
    """Return the heights (m,) of the planes of triangles (m, 3, 3) over positions (m, 2)."""
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    away = at - corner[:, 0, :2]
    slope = (normal[:, :2] * away).sum(axis=1)
    height = corner[:, 0, 2] - np.divide(
        slope, normal[:, 2], out=np.zeros(len(at)), where=normal[:, 2] != 0.0
    )
    return np.clip(height, corner[:, :, 2].min(axis=1), corner[:, :, 2].max(axis=1))


class _Bins:
    """Positions (n, 2) sorted into the squares of a grid."""

    def __init__(self, plan: Floats) -> None:
        self.low = plan.min(axis=0)
        size = np.maximum(plan.max(axis=0) - self.low, tolerance.PARAMETRIC)
        self.pitch = float(np.sqrt(size.prod() * BIN_RAYS / len(plan))) or 1.0
        self.pitch = max(self.pitch, float(size.max()) / len(plan))
        self.shape = np.floor(size / self.pitch).astype(np.int64) + 1
        cell = self._cell(plan)
        flat = cell[:, 0] * self.shape[1] + cell[:, 1]
        self.order = np.argsort(flat, kind="stable")
        self.start = np.searchsorted(flat[self.order], np.arange(self.shape.prod() + 1))

    def _cell(self, plan: Floats) -> Ints:
        cell = np.floor((plan - self.low) / self.pitch).astype(np.int64)
        return np.clip(cell, 0, self.shape - 1)

    def pairs(self, corners: Floats) -> list[tuple[Ints, Ints]]:
        """Return triangles and positions near one another, in portions; corners (t, 3, 2)."""
        low, high = corners.min(axis=1), corners.max(axis=1)
        first, last = self._cell(low), self._cell(high)
        n_cells = (last - first + 1).prod(axis=1)
        found, begin = [], 0
        ends = np.cumsum(n_cells)
        while begin < len(corners):
            done = ends[begin - 1] if begin else 0
            stop = max(begin + 1, int(np.searchsorted(ends, done + TOGETHER // BIN_RAYS, "right")))
            found.append(self._some(np.arange(begin, stop), first, last, n_cells))
            begin = stop
        return found

    def _some(self, some: Ints, first: Ints, last: Ints, n_cells: Ints) -> tuple[Ints, Ints]:
        of, k = items_of(n_cells[some])
        triangle = some[of]
        across = last[triangle, 1] - first[triangle, 1] + 1
        cell = (first[triangle, 0] + k // across) * self.shape[1] + first[triangle, 1] + k % across
        many = self.start[cell + 1] - self.start[cell]
        owner, k = items_of(many)
        return triangle[owner], self.order[self.start[cell[owner]] + k]
