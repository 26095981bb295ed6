"""Columns along the setup's z on a turned lattice: where they stand, the blank in them, and how high the part is at and around them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numba import njit

from simulation.written import Written

TURN = math.atan((math.sqrt(5.0) - 1.0) / 2.0)
"""rad: the lattice's turn against the setup. The golden ratio is the number worst told by fractions: along any wall, however it lies, the
columns come at distances that fill the row evenly."""
NOTHING = -1e9
"""mm: the height where there is no part, and no stock."""
RING = 8
"""Places on the circle about a column that the part's height is looked up at."""


@dataclass(frozen=True, slots=True, eq=False)
class Lattice:
    """Columns (ny, nx): corner (2,) mm of the first in the turned frame, and their distance in mm."""

    corner: np.ndarray
    cell: float
    shape: tuple[int, int]

    def points(self) -> np.ndarray:
        """Return where the columns stand in the setup frame: (ny, nx, 2) mm."""
        rows, columns = np.indices(self.shape)
        turned = np.stack([columns, rows], axis=2) * self.cell + self.corner
        return turned @ _turn(-TURN).T


def turned(points: np.ndarray) -> np.ndarray:
    """Return points (n, 3) of the setup frame in the lattice's frame."""
    return np.column_stack([points[:, :2] @ _turn(TURN).T, points[:, 2]])


def lattice_over(scene: Written, cell: float) -> Lattice:
    """Return the columns of a blank."""
    corners = turned(
        scene.frame.into(_corners(scene.blank) @ scene.blank_frame.axes + scene.blank_frame.origin)
    )
    low, high = corners[:, :2].min(axis=0), corners[:, :2].max(axis=0)
    nx, ny = np.ceil((high - low) / cell).astype(int) + 1
    return Lattice(low, cell, (int(ny), int(nx)))


def blank_heights(scene: Written, lattice: Lattice) -> np.ndarray:
    """Return the top of the blank in each column (ny, nx), setup frame, `NOTHING` beside it."""
    points = lattice.points().reshape(-1, 2)
    start = np.column_stack([points, np.zeros(len(points))]) @ scene.frame.axes + scene.frame.origin
    along = scene.blank_frame.axes @ scene.frame.axes[2]
    start = scene.blank_frame.into(start)
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = (scene.blank[:, None] - start) / along
    still = np.abs(along) < 1e-9
    inside = ((start >= scene.blank[0]) & (start <= scene.blank[1])) | ~still
    top = np.where(still, np.inf, ends.max(axis=0)).min(axis=1)
    low = np.where(still, -np.inf, ends.min(axis=0)).max(axis=1)
    return np.where(inside.all(axis=1) & (low < top), top, NOTHING).reshape(lattice.shape)


def part_heights(
    triangles: np.ndarray, lattice: Lattice, reach: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return how high the part is at lowest and at highest within `reach` mm about each column, (ny, nx) each.

    triangles (n, 3, 3) in the lattice's frame. Looked up at `RING` places whose polygon holds the circle of `reach`: right at a straight
    edge, however it runs.
    """
    low = np.full(lattice.shape, NOTHING)
    _raise(low, triangles, *lattice.corner, lattice.cell)
    high = low.copy()
    for k in range(RING):
        angle = 2.0 * math.pi * k / RING
        off = reach / math.cos(math.pi / RING) * np.array([math.cos(angle), math.sin(angle)])
        beside = np.full(lattice.shape, NOTHING)
        _raise(beside, triangles, *(lattice.corner + off), lattice.cell)
        np.minimum(low, beside, out=low)
        np.maximum(high, beside, out=high)
    return low, high


@njit(cache=True)
def _raise(heights, triangles, x0, y0, cell):
    """Raise columns to the triangles that stand over them."""
    rows, columns = heights.shape
    for n in range(len(triangles)):
        ax, ay, az = triangles[n, 0]
        bx, by, bz = triangles[n, 1]
        cx, cy, cz = triangles[n, 2]
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if abs(area) < 1e-12:
            continue
        first = max(int(math.ceil((min(ax, bx, cx) - x0) / cell)), 0)
        last = min(int(math.floor((max(ax, bx, cx) - x0) / cell)), columns - 1)
        low = max(int(math.ceil((min(ay, by, cy) - y0) / cell)), 0)
        high = min(int(math.floor((max(ay, by, cy) - y0) / cell)), rows - 1)
        for j in range(low, high + 1):
            y = y0 + j * cell
            for i in range(first, last + 1):
                x = x0 + i * cell
                u = ((bx - x) * (cy - y) - (by - y) * (cx - x)) / area
                v = ((cx - x) * (ay - y) - (cy - y) * (ax - x)) / area
                w = 1.0 - u - v
                if u >= -1e-9 and v >= -1e-9 and w >= -1e-9:
                    heights[j, i] = max(heights[j, i], u * az + v * bz + w * cz)


def _turn(angle: float) -> np.ndarray:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s], [s, c]])


def _corners(box: np.ndarray) -> np.ndarray:
    return np.array(
        [[box[i, 0], box[j, 1], box[k, 2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)]
    )
