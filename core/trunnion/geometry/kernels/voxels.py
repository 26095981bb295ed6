"""What is taken of the voxels of a block in space: by bodies of revolution, and by all that is above a field of heights.

Voxels are known by their middles, which begin at `low` (3,) mm and lie `step` (3,) apart along the block's axes. Bodies are given as
`bodies.py` has them. mm.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.kernels.bodies import bodies_hold_reference, is_in_body


@njit(cache=True, nogil=True)
def voxels_held(
    present: Bools, low: Floats, step: Floats, tips: Floats, axes: Floats, rows: Floats
) -> None:
    """Clear of `present` (nx, ny, nz) the voxels whose middles a body at tips (k, 3) with axes (k, 3) holds."""
    count = present.shape
    first, last = np.zeros(3, np.int64), np.zeros(3, np.int64)
    bottom, top, widest = rows[0, 0], rows[0, 2], 0.0
    for r in range(len(rows)):
        bottom, top = min(bottom, rows[r, 0]), max(top, rows[r, 2])
        widest = max(widest, rows[r, 1], rows[r, 3])
    for k in range(len(tips)):
        tip, axis = tips[k], axes[k]
        for d in range(3):
            # The box of a cylinder: its ends' centres, and its radius across the axis.
            across = widest * math.sqrt(max(1.0 - axis[d] * axis[d], 0.0))
            one, other = tip[d] + bottom * axis[d], tip[d] + top * axis[d]
            first[d] = max(int(math.ceil((min(one, other) - across - low[d]) / step[d])), 0)
            last[d] = min(
                int(math.floor((max(one, other) + across - low[d]) / step[d])) + 1, count[d]
            )
        for i in range(first[0], last[0]):
            x = low[0] + i * step[0] - tip[0]
            for j in range(first[1], last[1]):
                y = low[1] + j * step[1] - tip[1]
                for m in range(first[2], last[2]):
                    if present[i, j, m] and is_in_body(
                        x, y, low[2] + m * step[2] - tip[2], axis, rows
                    ):
                        present[i, j, m] = False


@njit(cache=True, nogil=True)
def voxels_above(
    present: Bools,
    low: Floats,
    step: Floats,
    turn: Floats,
    shift: Floats,
    heights: Floats,
    corner: Floats,
    side: float,
) -> None:
    """Clear of `present` (nx, ny, nz) the voxels that are wholly above a field of heights (a, b) or beside it. The field is in square cells
    of a side, from `corner` (2,) on; a position of the block is at turn (3, 3) @ position + shift (3,) there."""
    half = np.zeros(3)
    for d in range(3):
        for e in range(3):
            half[d] += 0.5 * abs(turn[d, e]) * step[e]
    count, field = present.shape, heights.shape
    for i in range(count[0]):
        for j in range(count[1]):
            for m in range(count[2]):
                if not present[i, j, m]:
                    continue
                x, y, z = low[0] + i * step[0], low[1] + j * step[1], low[2] + m * step[2]
                u = turn[0, 0] * x + turn[0, 1] * y + turn[0, 2] * z + shift[0] - corner[0]
                v = turn[1, 0] * x + turn[1, 1] * y + turn[1, 2] * z + shift[1] - corner[1]
                w = turn[2, 0] * x + turn[2, 1] * y + turn[2, 2] * z + shift[2] - half[2]
                # The cells of the field under the box about the voxel; beside the field nothing stands.
                a0 = max(int(math.floor((u - half[0]) / side)), 0)
                a1 = min(int(math.floor((u + half[0]) / side)) + 1, field[0])
                b0 = max(int(math.floor((v - half[1]) / side)), 0)
                b1 = min(int(math.floor((v + half[1]) / side)) + 1, field[1])
                remains = False
                for a in range(a0, a1):
                    for b in range(b0, b1):
                        if heights[a, b] > w:
                            remains = True
                            break
                    if remains:
                        break
                present[i, j, m] = remains


def voxels_held_reference(
    present: Bools, low: Floats, step: Floats, tips: Floats, axes: Floats, rows: Floats
) -> None:
    """Plain numpy form of `voxels_held`: every voxel for every pose."""
    held = np.zeros(1, dtype=bool)
    for row in np.argwhere(np.ones(present.shape, dtype=bool)).tolist():
        point = (low + np.array(row) * step)[None]
        for k in range(len(tips)):
            bodies_hold_reference(point, tips[k : k + 1], axes[k : k + 1], rows, held)
            present[tuple(row)] &= not held[0]


def voxels_above_reference(
    present: Bools,
    low: Floats,
    step: Floats,
    turn: Floats,
    shift: Floats,
    heights: Floats,
    corner: Floats,
    side: float,
) -> None:
    """Plain numpy form of `voxels_above`: the corners of every voxel, and every cell of the field."""
    signs = np.argwhere(np.ones((2, 2, 2), dtype=bool)) - 0.5
    a, b = np.indices(heights.shape)
    for row in np.argwhere(present).tolist():
        there = (low + (np.array(row) + signs) * step) @ turn.T + shift
        first, last = there.min(axis=0), there.max(axis=0)
        u, v = (corner[k] + side * at for k, at in enumerate((a, b)))
        under = (u + side > first[0]) & (u <= last[0]) & (v + side > first[1]) & (v <= last[1])
        present[tuple(row)] = bool((heights[under] > first[2]).any())
