"""Points of a part's stock, each cleared by the first move whose cutter covers it: exact where a field of heights knows its cells alone.

Points are kept in lists by the square cells of a grid that they lie in; cell (i, j) spans x from `x0 + i cell` and y from `y0 + j cell`.
mm, the setup frame, tool axis +z.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Floats, Ints

UNCUT = -1
"""By which move a point is cleared that none has cleared yet."""


@njit(cache=True, nogil=True)
def cut_points(
    points: Floats,
    first: Ints,
    following: Ints,
    x0: float,
    y0: float,
    cell: float,
    starts: Floats,
    ends: Floats,
    radius: float,
    corner: float,
    by: Ints,
) -> None:
    """Put down the number of the first of some moves of the tip from `starts` to `ends` (n, 3), of a flat, bull or ball end cutter, that
    clears each of points (k, 3) which stands, in `by` (k,).

    first (nx, ny) is a point of each cell and following (k,) the next of the same cell, -1 behind the last. A move clears what the cutter
    covers where it is nearest to it in plan.
    """
    nx, ny = first.shape
    flat = radius - corner
    for n in range(len(starts)):
        ax, ay, az = starts[n, 0], starts[n, 1], starts[n, 2]
        dx, dy, dz = ends[n, 0] - ax, ends[n, 1] - ay, ends[n, 2] - az
        square = dx * dx + dy * dy
        share = 1.0 / square if square > 0.0 else 0.0
        i0 = max(int(math.floor((min(ax, ax + dx) - radius - x0) / cell)), 0)
        i1 = min(int(math.floor((max(ax, ax + dx) + radius - x0) / cell)) + 1, nx)
        j0 = max(int(math.floor((min(ay, ay + dy) - radius - y0) / cell)), 0)
        j1 = min(int(math.floor((max(ay, ay + dy) + radius - y0) / cell)) + 1, ny)
        for i in range(i0, i1):
            for j in range(j0, j1):
                k = first[i, j]
                while k >= 0:
                    if by[k] == UNCUT:
                        px, py = points[k, 0] - ax, points[k, 1] - ay
                        t = min(max((px * dx + py * dy) * share, 0.0), 1.0)
                        ox, oy = px - t * dx, py - t * dy
                        away = math.sqrt(ox * ox + oy * oy)
                        if away <= radius:
                            inner = max(away - flat, 0.0)
                            # Quarter circle of the corner.
                            lift = corner - math.sqrt(max(corner * corner - inner * inner, 0.0))
                            low = az + t * dz if square > 0.0 else min(az, az + dz)
                            if low + lift <= points[k, 2]:
                                by[k] = n
                    k = following[k]


def cut_points_reference(
    points: Floats, starts: Floats, ends: Floats, radius: float, corner: float, by: Ints
) -> None:
    """Plain numpy form of `cut_points`: every point for every move."""
    for n, (a, b) in enumerate(zip(starts, ends, strict=True)):
        way = b - a
        square = float(way[:2] @ way[:2])
        t = np.clip((points[:, :2] - a[:2]) @ way[:2] / square, 0.0, 1.0) if square > 0.0 else None
        low = min(a[2], b[2]) if t is None else a[2] + t * way[2]
        near = a[:2] if t is None else a[:2] + t[:, None] * way[:2]
        away = np.linalg.norm(points[:, :2] - near, axis=1)
        inner = np.maximum(away - (radius - corner), 0.0)
        lift = corner - np.sqrt(np.maximum(corner**2 - inner**2, 0.0))
        by[(by == UNCUT) & (away <= radius) & (low + lift <= points[:, 2])] = n
