"""Where rays are in a solid of revolution about z: compiled, a ray at a time. Plain reference `revolved_rays`.

Each line of the outline makes a cone, a cylinder or a plane; between two neighbouring crossings with those a ray is inside all the way
or nowhere, which the middle says. A point is inside where an odd number of the lines that pass its height lies beyond it.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.rays import Intervals


def revolved_rays(outline: Floats, start: Floats, direction: Floats) -> Intervals:
    """Return where rays from `start` (n, 3) along a unit `direction` (3,) are inside an outline (k, 2) that turns."""
    t = np.sort(_roots(outline, start, direction), axis=1)
    used = max(2, int(np.isfinite(t).sum(axis=1).max(initial=0)))
    t = t[:, :used]
    there = np.isfinite(t[:, 1:])
    middle = np.where(there, 0.5 * (t[:, :-1] + np.where(there, t[:, 1:], 0.0)), 0.0)
    positions = start[:, None] + middle[:, :, None] * direction
    away = np.hypot(positions[..., 0], positions[..., 1])
    inside = inside_outline(outline, np.column_stack([away.ravel(), positions[..., 2].ravel()]))
    return joined(t, inside.reshape(middle.shape) & there)


def inside_outline(outline: Floats, at: Floats) -> Bools:
    """Return whether points (n, 2) are inside an outline (k, 2) that does not cross itself: between two of its heights the lines that pass
    there keep their order, and a point is inside where an odd number of them lies beyond it."""
    level, first, slope = slabs(outline)
    row = np.searchsorted(level, at[:, 1], side="right") - 1
    between = (row >= 0) & (row < len(level) - 1)
    row = np.where(between, row, 0)
    inside = np.zeros(len(at), dtype=bool)
    for k in range(first.shape[1]):
        inside ^= first[row, k] + slope[row, k] * (at[:, 1] - level[row]) > at[:, 0]
    return inside & between


def slabs(outline: Floats) -> tuple[Floats, Floats, Floats]:
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


@njit(cache=True, nogil=True)
def _lines(outline, direction, flat):  # type: ignore[no-untyped-def]  # pragma: no cover - compiled
    """Return what all rays share of the lines of an outline (k, 7): radius and height of a point, change of the radius over the height (not
    a number for a plane), that along the rays, the square's coefficient, and the heights between which the line is."""
    lines, n = np.empty((len(outline), 7)), len(outline)
    across = direction[0] * direction[0] + direction[1] * direction[1]
    for i in range(n):
        r, z, r1, z1 = (
            outline[i, 0],
            outline[i, 1],
            outline[(i + 1) % n, 0],
            outline[(i + 1) % n, 1],
        )
        slope = math.nan if abs(z1 - z) <= flat else (r1 - r) / (z1 - z)
        grow = slope * direction[2]
        lines[i, 0], lines[i, 1], lines[i, 2], lines[i, 3] = r, z, slope, grow
        lines[i, 4] = across - grow * grow
        lines[i, 5] = min(z, z1) - tolerance.COINCIDENT
        lines[i, 6] = max(z, z1) + tolerance.COINCIDENT
    return lines


@njit(cache=True, nogil=True)
def _insert(found, n, t):  # type: ignore[no-untyped-def]  # pragma: no cover - compiled
    """Put a crossing among those found so far (n), in their order: a ray crosses few lines."""
    k = n
    while k > 0 and found[k - 1] > t:
        found[k] = found[k - 1]
        k -= 1
    found[k] = t


@njit(cache=True, nogil=True)
def _holds(level, first, slope, rho, z):  # type: ignore[no-untyped-def]  # pragma: no cover - compiled
    """Return whether a point (rho, z) is inside the outline that `slabs` has cut."""
    row = np.searchsorted(level, z, side="right") - 1
    if row < 0 or row >= len(level) - 1:
        return False
    inside = False
    for k in range(first.shape[1]):
        if first[row, k] + slope[row, k] * (z - level[row]) > rho:
            inside = not inside
    return inside


@njit(cache=True, nogil=True)
def revolved_rays_loop(outline, level, first, slope, start, direction, flat, count, low, high):  # type: ignore[no-untyped-def]  # pragma: no cover - compiled
    """The same as `revolved_rays`, of an outline and its slabs: fills count (n,), low and high (n, m) as far as they go; return the
    most intervals that a ray has. `flat` mm: how far the ends of a line that makes a plane are apart along z at most."""
    capacity, most = low.shape[1], 0
    lines, found = _lines(outline, direction, flat), np.empty(2 * len(outline))
    dx, dy, dz = direction[0], direction[1], direction[2]
    for k in range(len(start)):
        sx, sy, sz = start[k, 0], start[k, 1], start[k, 2]
        along, square_away = sx * dx + sy * dy, sx * sx + sy * sy
        n = 0
        for i in range(len(lines)):
            grows = lines[i, 2]
            if math.isnan(grows):
                if dz != 0.0:
                    t = (lines[i, 1] - sz) / dz
                    if lines[i, 5] <= sz + t * dz <= lines[i, 6]:
                        _insert(found, n, t)
                        n += 1
                continue
            wide, a = lines[i, 0] + grows * (sz - lines[i, 1]), lines[i, 4]
            b, c = along - wide * lines[i, 3], square_away - wide * wide
            if abs(a) <= tolerance.PARAMETRIC:
                if b != 0.0:
                    t = -0.5 * c / b
                    if lines[i, 5] <= sz + t * dz <= lines[i, 6]:
                        _insert(found, n, t)
                        n += 1
                continue
            square = b * b - a * c
            if square > 0.0:
                root = math.sqrt(square)
                for t in ((-b - root) / a, (-b + root) / a):
                    if lines[i, 5] <= sz + t * dz <= lines[i, 6]:
                        _insert(found, n, t)
                        n += 1
        made, is_open = 0, False
        for i in range(n):
            inside = False
            if i + 1 < n:
                t = 0.5 * (found[i] + found[i + 1])
                inside = _holds(
                    level, first, slope, math.hypot(sx + t * dx, sy + t * dy), sz + t * dz
                )
            if inside and not is_open and made < capacity:
                low[k, made] = found[i]
            if is_open and not inside:
                if made < capacity:
                    high[k, made] = found[i]
                made += 1
            is_open = inside
        count[k] = made
        most = max(most, made)
    return most
