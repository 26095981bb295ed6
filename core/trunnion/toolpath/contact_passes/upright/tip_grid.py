"""Where the tip of a cutter may be while it touches an area, in plan: a grid of positions to drop it at."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import binary_dilation

from trunnion.geometry.arrays import Floats
from trunnion.geometry.sheet.sheet import Sheet
from trunnion.toolpath.contact_passes.passes import UPRIGHT

MOST_POINTS = 1_500_000
"""Points of a grid at most; beyond, cells grow."""


def spread(tips: Floats, step: float) -> Floats:
    """Return positions (n, 3) over triangles (m, 3, 3), no farther than `step` apart on each."""
    sides = np.linalg.norm(tips - np.roll(tips, -1, axis=1), axis=2).max(axis=1)
    parts = np.maximum(np.ceil(sides / step), 1.0).astype(np.int64)
    out = []
    for n in np.unique(parts).tolist():
        i, j = (v.ravel() for v in np.meshgrid(np.arange(n + 1), np.arange(n + 1), indexing="ij"))
        i, j = i[i + j <= n] / n, j[i + j <= n] / n
        some = tips[parts == n]
        shares = np.column_stack([1.0 - i - j, i, j])
        out.append((shares @ some).reshape(-1, 3))
    return np.concatenate(out)


def grid_around(tips: Floats, cell: float, margin: int) -> Sheet:
    """Return a level sheet of square cells in halves, the triangles anticlockwise, as far as `margin` cells round tips (n, 3)."""
    corner = tips[:, :2].min(axis=0) - (margin + 1) * cell
    size = tips[:, :2].max(axis=0) + (margin + 1) * cell - corner
    cell = max(cell, float(np.sqrt(size.prod() / MOST_POINTS)))
    wanted = np.zeros(np.ceil(size / cell).astype(np.int64) + 1, dtype=bool)
    at = np.round((tips[:, :2] - corner) / cell).astype(np.int64)
    wanted[at[:, 0], at[:, 1]] = True
    wanted = binary_dilation(wanted, iterations=margin)
    number = np.full(wanted.shape, -1)
    number[wanted] = np.arange(int(wanted.sum()))
    a, b, c, d = number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]
    halves = np.concatenate(
        [np.stack([a, b, c], axis=2).reshape(-1, 3), np.stack([a, c, d], axis=2).reshape(-1, 3)]
    )
    halves = halves[(halves >= 0).all(axis=1)]
    points = np.column_stack([corner + cell * np.argwhere(wanted), np.zeros(int(wanted.sum()))])
    return Sheet(
        points=points,
        normals=np.broadcast_to(UPRIGHT, points.shape),
        triangles=halves,
        face=np.ones(len(halves), np.int64),
    )
