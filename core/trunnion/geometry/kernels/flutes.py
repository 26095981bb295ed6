"""Where flutes of tools have been: their poses in lists by cubic cells, and bodies among what stands.

Poses are looked up by the cells of side `side` that the cylinder about their flutes comes into, from `low` (3,) on: `first` (nx, ny, nz) is
the entry of each cell that was put in last, `following` (e,) the one before it, -1 behind the last, and `pose` (e,) the pose of an entry.
Poses are put in in the order in which they cut. Flutes are bodies of revolution as `bodies.py` has them. mm.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.kernels.bodies import is_in_body
from trunnion.geometry.kernels.kernel_arrays import BORROWED


@njit(cache=True, nogil=True)
def list_poses(
    first: Ints,
    low: Floats,
    side: float,
    following: Ints,
    pose: Ints,
    entries: int,
    tips: Floats,
    axes: Floats,
    begin: int,
    rows: Floats,
) -> int:
    """Put the poses from `begin` on, tips and axes (n, 3), of flutes in the lists, which have so many entries; return how many they have
    then. Nothing is written where the lists have no room for them."""
    count = first.shape
    bottom, top, widest = rows[0, 0], rows[0, 2], 0.0
    for r in range(len(rows)):
        bottom, top = min(bottom, rows[r, 0]), max(top, rows[r, 2])
        widest = max(widest, rows[r, 1], rows[r, 3])
    a, b = np.zeros(3, np.int64), np.zeros(3, np.int64)
    for writes in (False, True):
        n = entries
        for k in range(begin, len(tips)):
            for d in range(3):
                # The box of a cylinder: its ends' centres, and its radius across the axis.
                across = widest * math.sqrt(max(1.0 - axes[k, d] * axes[k, d], 0.0))
                one, other = tips[k, d] + bottom * axes[k, d], tips[k, d] + top * axes[k, d]
                a[d] = max(int(math.floor((min(one, other) - across - low[d]) / side)), 0)
                b[d] = min(
                    int(math.floor((max(one, other) + across - low[d]) / side)) + 1, count[d]
                )
            if not writes:
                n += max(b[0] - a[0], 0) * max(b[1] - a[1], 0) * max(b[2] - a[2], 0)
                continue
            for i in range(a[0], b[0]):
                for j in range(a[1], b[1]):
                    for m in range(a[2], b[2]):
                        following[n], pose[n] = first[i, j, m], k
                        first[i, j, m] = n
                        n += 1
        if n > len(following):
            break
    return n


@njit(**BORROWED)
def bodies_free(
    first: Ints,
    low: Floats,
    side: float,
    following: Ints,
    pose: Ints,
    cut_tips: Floats,
    cut_axes: Floats,
    numbers: Ints,
    kinds: Ints,
    flutes: Floats,
    heights: Floats,
    corner: Floats,
    cell: float,
    tips: Floats,
    frames: Floats,
    body: Floats,
    before: Ints,
    free: Bools,
) -> None:
    """Fill `free` (k,) with whether all points (p, 3) of a body, at tips (k, 3) and turned by frames (k, 3, 3) in rows, are above a field
    of heights, beside it, or in flutes at one of the listed poses with a number (n,) below `before` (k,).

    The field is in square cells of a side `cell` from `corner` (2,) on. kinds (n,) are the flutes of each pose, of flutes (f, r, 4).
    """
    count, field = first.shape, heights.shape
    for k in range(len(tips)):
        free[k] = True
        for p in range(len(body)):
            u, v, w = body[p, 0], body[p, 1], body[p, 2]
            x = tips[k, 0] + u * frames[k, 0, 0] + v * frames[k, 1, 0] + w * frames[k, 2, 0]
            y = tips[k, 1] + u * frames[k, 0, 1] + v * frames[k, 1, 1] + w * frames[k, 2, 1]
            z = tips[k, 2] + u * frames[k, 0, 2] + v * frames[k, 1, 2] + w * frames[k, 2, 2]
            a = int(math.floor((x - corner[0]) / cell))
            b = int(math.floor((y - corner[1]) / cell))
            if a < 0 or b < 0 or a >= field[0] or b >= field[1] or heights[a, b] <= z:
                continue
            i = int(math.floor((x - low[0]) / side))
            j = int(math.floor((y - low[1]) / side))
            m = int(math.floor((z - low[2]) / side))
            is_cut = False
            if 0 <= i < count[0] and 0 <= j < count[1] and 0 <= m < count[2]:
                # The last ones put in are the nearest above: most points are found there.
                e = first[i, j, m]
                while e >= 0:
                    n = pose[e]
                    if numbers[n] < before[k] and is_in_body(
                        x - cut_tips[n, 0],
                        y - cut_tips[n, 1],
                        z - cut_tips[n, 2],
                        cut_axes[n],
                        flutes[kinds[n]],
                    ):
                        is_cut = True
                        break
                    e = following[e]
            if not is_cut:
                free[k] = False
                break


def bodies_free_reference(
    cut_tips: Floats,
    cut_axes: Floats,
    numbers: Ints,
    kinds: Ints,
    flutes: Floats,
    heights: Floats,
    corner: Floats,
    cell: float,
    tips: Floats,
    frames: Floats,
    body: Floats,
    before: Ints,
) -> Bools:
    """Plain numpy form of `bodies_free`: every point in the flutes at every pose."""
    found = np.ones(len(tips), dtype=bool)
    for k, (tip, frame) in enumerate(zip(tips, frames, strict=True)):
        points = tip + body @ frame
        at = np.floor((points[:, :2] - corner) / cell).astype(np.int64)
        inside = ((at >= 0) & (at < heights.shape)).all(axis=1)
        above = np.full(len(points), -np.inf)
        above[inside] = heights[tuple(at[inside].T)]
        left = above > points[:, 2]
        for n in np.flatnonzero(numbers < before[k]).tolist():
            off = points - cut_tips[n]
            along = off @ cut_axes[n]
            away = np.linalg.norm(off - along[:, None] * cut_axes[n], axis=1)
            for z0, r0, z1, r1 in flutes[kinds[n]].tolist():
                wide = np.interp(along, [z0, z1], [r0, r1]) if z1 > z0 else max(r0, r1)
                left &= ~((along >= z0) & (along <= z1) & (away < wide))
        found[k] = not left.any()
    return found
