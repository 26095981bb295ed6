"""Whether bodies of revolution hold points: for planning clear of material that stands.

A body is given by cones in rows [z0, r0, z1, r1] along its axis, z from the tip up; a point is in it where it lies within a cone's
height and nearer to the axis than the cone is wide there. mm; each pose is a tip and a unit axis.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Bools, Floats


@njit(cache=True, nogil=True)
def bodies_hold(points: Floats, tips: Floats, axes: Floats, rows: Floats, held: Bools) -> None:
    """Fill `held` (k,) with whether a body at tips (k, 3) with axes (k, 3) holds any of points (m, 3)."""
    low, high, widest = rows[0, 0], rows[0, 2], 0.0
    for r in range(len(rows)):
        low, high = min(low, rows[r, 0]), max(high, rows[r, 2])
        widest = max(widest, rows[r, 1], rows[r, 3])
    for k in range(len(tips)):
        held[k] = False
        for m in range(len(points)):
            x = points[m, 0] - tips[k, 0]
            y = points[m, 1] - tips[k, 1]
            z = points[m, 2] - tips[k, 2]
            along = x * axes[k, 0] + y * axes[k, 1] + z * axes[k, 2]
            if along < low or along > high:
                continue
            square = x * x + y * y + z * z - along * along
            if square >= widest * widest:
                continue
            for r in range(len(rows)):
                z0, r0, z1, r1 = rows[r, 0], rows[r, 1], rows[r, 2], rows[r, 3]
                if along < z0 or along > z1:
                    continue
                wide = max(r0, r1)
                if z1 > z0:
                    wide = r0 + (r1 - r0) * (along - z0) / (z1 - z0)
                if square < wide * wide:
                    held[k] = True
                    break
            if held[k]:
                break


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
