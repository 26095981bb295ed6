"""Solids of revolution about z: a closed outline in the half-plane of radius and height, and what it encloses when it turns."""

from __future__ import annotations

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.kernels.distance import nearest_segment, winding_numbers
from trunnion.geometry.rays import Intervals, stacked

TOGETHER = 500_000
"""Rays times lines of the outline that are looked at together."""


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
    """Return where rays from `start` (n, 3) along a unit `direction` (3,) are in the solid.

    Each line of the outline makes a cone, a cylinder or a plane; between two neighbouring crossings with those a ray is inside all the way
    or nowhere, which the middle says.
    """
    step = max(1, TOGETHER // len(outline))
    return stacked(
        [_some(outline, start[k : k + step], direction) for k in range(0, max(len(start), 1), step)]
    )


def _some(outline: Floats, start: Floats, direction: Floats) -> Intervals:
    t = np.sort(_roots(outline, start, direction), axis=1)
    used = max(2, int(np.isfinite(t).sum(axis=1).max(initial=0)))
    t = t[:, :used]
    there = np.isfinite(t[:, 1:])
    middle = np.where(there, 0.5 * (t[:, :-1] + np.where(there, t[:, 1:], 0.0)), 0.0)
    positions = start[:, None] + middle[:, :, None] * direction
    inside = _is_inside(outline, half_plane(positions.reshape(-1, 3)))
    return joined(t, inside.reshape(middle.shape) & there)


def _is_inside(outline: Floats, at: Floats) -> Bools:
    """Return whether points (n, 2) are inside an outline (k, 2) that does not cross itself: between two of its heights the lines that pass
    there keep their order, and a point is inside where an odd number of them lies beyond it."""
    level, first, slope = _slabs(outline)
    row = np.searchsorted(level, at[:, 1], side="right") - 1
    between = (row >= 0) & (row < len(level) - 1)
    row = np.where(between, row, 0)
    inside = np.zeros(len(at), dtype=bool)
    for k in range(first.shape[1]):
        inside ^= first[row, k] + slope[row, k] * (at[:, 1] - level[row]) > at[:, 0]
    return inside & between


def _slabs(outline: Floats) -> tuple[Floats, Floats, Floats]:
    """Return the heights (k + 1,) of an outline's points, and for the lines that pass between each two of them their radius at the lower
    one and its change over the height (k, m), below everything where there are fewer."""
    (r0, z0), (r1, z1) = outline.T, np.roll(outline, -1, axis=0).T
    level = np.unique(outline[:, 1])
    low, high = np.minimum(z0, z1), np.maximum(z0, z1)
    passing = (low[None] <= level[:-1, None]) & (high[None] >= level[1:, None]) & (high > low)
    most = int(passing.sum(axis=1).max(initial=1))
    first, slope = (np.full((len(level) - 1, most), v) for v in (-np.inf, 0.0))
    for k, rows in enumerate(passing):
        lines = np.flatnonzero(rows)
        own = (r1 - r0)[lines] / (z1 - z0)[lines]
        slope[k, : len(lines)] = own
        first[k, : len(lines)] = r0[lines] + own * (level[k] - z0[lines])
    return level, first, slope


def joined(t: Floats, inside: Bools) -> Intervals:
    """Return the intervals of rays that change at t (n, m), sorted, and are inside (n, m - 1) between."""
    n, before = len(t), np.pad(inside, ((0, 0), (1, 1)))
    begins, ends = ~before[:, :-1] & before[:, 1:], before[:, :-1] & ~before[:, 1:]
    count = begins.sum(axis=1).astype(np.int64)
    shape = (n, max(1, int(count.max(initial=0))))
    low, high = np.zeros(shape), np.zeros(shape)
    used = np.arange(shape[1]) < count[:, None]
    low[used], high[used] = t[begins], t[ends]
    return Intervals(count, low, high)


def _roots(outline: Floats, start: Floats, direction: Floats) -> Floats:
    """Return where rays cross the cones and planes of an outline's lines (n, 2 k), infinite where they don't."""
    (r0, z0), (r1, z1) = outline.T, np.roll(outline, -1, axis=0).T
    scale = float(np.abs(outline).max())
    found = []
    for a, b, c, d in zip(r0, z0, r1, z1, strict=True):
        pair = (
            _plane(b, start, direction)
            if abs(d - b) <= tolerance.PARAMETRIC * scale
            else _cone(a, b, (c - a) / (d - b), start, direction)
        )
        z = start[:, 2, None] + np.where(np.isfinite(pair), pair, 0.0) * direction[2]
        low, high = min(b, d) - tolerance.COINCIDENT, max(b, d) + tolerance.COINCIDENT
        found.append(np.where((z >= low) & (z <= high), pair, np.inf))
    return np.hstack(found)


def _plane(z: float, start: Floats, direction: Floats) -> Floats:
    """Return where rays cross a plane at a height (n, 2)."""
    if direction[2] == 0.0:
        return np.full((len(start), 2), np.inf)
    return np.column_stack([(z - start[:, 2]) / direction[2], np.full(len(start), np.inf)])


def _cone(r: float, z: float, slope: float, start: Floats, direction: Floats) -> Floats:
    """Return where rays cross the cone of radius r at height z that grows by `slope` a mm (n, 2): roots of a quadratic."""
    wide = r + slope * (start[:, 2] - z)
    grow = slope * direction[2]
    a = direction[0] ** 2 + direction[1] ** 2 - grow**2
    b = start[:, :2] @ direction[:2] - wide * grow
    c = start[:, 0] ** 2 + start[:, 1] ** 2 - wide**2
    if abs(a) <= tolerance.PARAMETRIC:
        t = np.divide(-0.5 * c, b, out=np.full(len(start), np.inf), where=b != 0.0)
        return np.column_stack([t, np.full(len(start), np.inf)])
    square = b * b - a * c
    root = np.sqrt(np.where(square > 0.0, square, 0.0))
    pair = np.column_stack([(-b - root) / a, (-b + root) / a])
    return np.where(square[:, None] > 0.0, pair, np.inf)


def _lines(outline: Floats, rows: Ints | None = None) -> tuple[Floats, ...]:
    """Return lines of an outline as the distance kernels take them."""
    end = np.roll(outline, -1, axis=0)
    begin = outline
    if rows is not None:
        begin, end = begin[rows], end[rows]
    nothing = np.zeros(len(begin))
    return begin, end, np.zeros_like(begin), nothing, nothing
