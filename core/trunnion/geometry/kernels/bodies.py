"""Whether bodies of revolution hold points: for planning clear of material that stands.

A body is given by cones in rows [z0, r0, z1, r1] along its axis, z from the tip up; a point is in it where it lies within a cone's
height and nearer to the axis than the cone is wide there. mm; each pose is a tip and a unit axis.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.kernels.kernel_arrays import BORROWED

EDGE = 1e-6
"""mm that the balls about groups count as wider by, for rounding."""


@njit(**BORROWED)
def bodies_hold(
    points: Floats,
    start: Ints,
    ball: Floats,
    large_start: Ints,
    large_ball: Floats,
    tips: Floats,
    axes: Floats,
    rows: Floats,
    held: Bools,
) -> None:
    """Fill `held` (k,) with whether a body at tips (k, 3) with axes (k, 3) holds any of points (m, 3), which are in groups as `PointGroups`
    has them."""
    low, high, widest = rows[0, 0], rows[0, 2], 0.0
    for r in range(len(rows)):
        low, high = min(low, rows[r, 0]), max(high, rows[r, 2])
        widest = max(widest, rows[r, 1], rows[r, 3])
    for k in range(len(tips)):
        held[k] = False
        tip, axis = tips[k], axes[k]
        for g in range(len(large_ball)):
            if held[k]:
                break
            if _misses(large_ball[g], tip, axis, low, high, widest):
                continue
            for s in range(large_start[g], large_start[g + 1]):
                if held[k]:
                    break
                if not _misses(ball[s], tip, axis, low, high, widest):
                    held[k] = _holds(points, start[s], start[s + 1], tip, axis, rows)


@njit(**BORROWED, inline="always")
def _misses(
    ball: Floats, tip: Floats, axis: Floats, low: float, high: float, widest: float
) -> bool:
    """Return whether a ball lies outside of the cylinder about a body."""
    x, y, z = ball[0] - tip[0], ball[1] - tip[1], ball[2] - tip[2]
    along = x * axis[0] + y * axis[1] + z * axis[2]
    if along + ball[3] < low - EDGE or along - ball[3] > high + EDGE:
        return True
    far = widest + ball[3] + EDGE
    return x * x + y * y + z * z - along * along > far * far


@njit(**BORROWED, inline="always")
def is_in_body(x: float, y: float, z: float, axis: Floats, rows: Floats) -> bool:
    """Return whether a position from the tip lies in a body."""
    along = x * axis[0] + y * axis[1] + z * axis[2]
    square = x * x + y * y + z * z - along * along
    for r in range(len(rows)):
        z0, r0, z1, r1 = rows[r, 0], rows[r, 1], rows[r, 2], rows[r, 3]
        if along < z0 or along > z1:
            continue
        wide = max(r0, r1)
        if z1 > z0:
            wide = r0 + (r1 - r0) * (along - z0) / (z1 - z0)
        if square < wide * wide:
            return True
    return False


@njit(**BORROWED)
def _holds(points: Floats, first: int, last: int, tip: Floats, axis: Floats, rows: Floats) -> bool:
    """Return whether a body holds any of the points from `first` to `last`."""
    for m in range(first, last):
        x, y, z = points[m, 0] - tip[0], points[m, 1] - tip[1], points[m, 2] - tip[2]
        if is_in_body(x, y, z, axis, rows):
            return True
    return False


def bodies_hold_reference(
    points: Floats, tips: Floats, axes: Floats, rows: Floats, held: Bools
) -> None:
    """Plain numpy form of `bodies_hold`: every point for every pose and cone."""
    for k in range(len(tips)):
        off = points - tips[k]
        along = off @ axes[k]
        away = np.linalg.norm(off - along[:, None] * axes[k], axis=1)
        held[k] = any(
            bool(
                (
                    (along >= z0)
                    & (along <= z1)
                    & (away < (np.interp(along, [z0, z1], [r0, r1]) if z1 > z0 else max(r0, r1)))
                ).any()
            )
            for z0, r0, z1, r1 in rows.tolist()
        )
