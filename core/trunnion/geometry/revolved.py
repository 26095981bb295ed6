"""Solids of revolution about z: a closed outline in the half-plane of radius and height, and what it encloses when it turns."""

from __future__ import annotations

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.kernels.distance import nearest_segment, winding_numbers
from trunnion.geometry.rays import Intervals

CAPACITY = 4
"""Intervals that each ray can hold at first: twice through a thin wall is the usual."""


def revolved_volume(outline: Floats) -> float:
    """Return the volume of an outline (k, 2) of radius and height that turns about its z axis: Green's theorem on 2 pi r dr dz."""
    (r0, z0), (r1, z1) = outline.T, np.roll(outline, -1, axis=0).T
    return float(np.pi / 3.0 * ((z1 - z0) * (r0 * r0 + r0 * r1 + r1 * r1)).sum())


def revolved_depth(outline: Floats, points: Floats) -> Floats:
    """Return how far below the surface points (n, 3) are (n,), negative outside; the axis is no surface."""
    at = half_plane(points)
    inside = winding_numbers(at, *_lines(outline)) != 0
    away = nearest_segment(at, *_lines(outline, surface_rows(outline)))[0]
    return np.where(inside, away, -away)


def half_plane(points: Floats) -> Floats:
    """Return radius and height (n, 2) of points (n, 3)."""
    return np.column_stack([np.hypot(points[:, 0], points[:, 1]), points[:, 2]])


def surface_rows(outline: Floats) -> Ints:
    """Return the lines of an outline that make surface: those that don't lie on the axis."""
    return np.flatnonzero((outline[:, 0] > 0.0) | (np.roll(outline[:, 0], -1) > 0.0))


def smooth_runs(outline: Floats) -> list[Ints]:
    """Return the lines of `surface_rows` (rows of their first points) in runs that go on without a corner, in their order round the
    outline; level ones are runs of their own."""
    rows = surface_rows(outline)
    step = np.roll(outline, -1, axis=0)[rows] - outline[rows]
    heading = np.arctan2(step[:, 1], step[:, 0])
    level = np.abs(step[:, 1]) <= tolerance.COINCIDENT
    turn = np.abs(np.angle(np.exp(1j * (heading - np.roll(heading, 1)))))
    follows = np.roll(rows, 1) == (rows - 1) % len(outline)
    begins = ~follows | (turn > tolerance.SMOOTH_JOIN) | level | np.roll(level, 1)
    if not begins.any():
        return [rows]
    first = int(np.argmax(begins))
    rows, begins = np.roll(rows, -first), np.roll(begins, -first)
    return np.split(rows, np.flatnonzero(begins)[1:])


def run_distances(outline: Floats, points: Floats) -> Floats:
    """Return the distance (n, s) of points (n, 3) to the surface of each of `smooth_runs`."""
    at = half_plane(points)
    return np.stack(
        [nearest_segment(at, *_lines(outline, run))[0] for run in smooth_runs(outline)], axis=1
    )


def revolved_intervals(outline: Floats, start: Floats, direction: Floats) -> Intervals:
    """Return where rays from `start` (n, 3) along a unit `direction` (3,) are in the solid."""
    # Loaded where it is first needed: a window that only shows a part starts sooner without compiled loops.
    from trunnion.geometry.kernels.revolved_rays import revolved_rays_loop, slabs

    scale = tolerance.PARAMETRIC * float(np.abs(outline).max())
    start = np.ascontiguousarray(start, dtype=np.float64)
    direction = np.ascontiguousarray(direction, dtype=np.float64)
    capacity = CAPACITY
    while True:
        count = np.zeros(len(start), np.int64)
        low, high = np.zeros((len(start), capacity)), np.zeros((len(start), capacity))
        most = max(
            1,
            revolved_rays_loop(outline, *slabs(outline), start, direction, scale, count, low, high),
        )
        if most <= capacity:
            return Intervals(count, low[:, :most].copy(), high[:, :most].copy())
        capacity = most


def _lines(outline: Floats, rows: Ints | None = None) -> tuple[Floats, ...]:
    """Return lines of an outline as the distance kernels take them."""
    end = np.roll(outline, -1, axis=0)
    begin = outline
    if rows is not None:
        begin, end = begin[rows], end[rows]
    nothing = np.zeros(len(begin))
    return begin, end, np.zeros_like(begin), nothing, nothing
