"""How deep the hollows of a part are that a cutter is too wide for: what roughing with it leaves full, for others to clear.

The depth is that of the black top-hat of the part's height field by a disc, its closing less itself (J. Serra, Image Analysis and
Mathematical Morphology, 1982): the closing is as low as the disc comes anywhere over a position.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.ndimage import minimum_filter

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats
from trunnion.plan.freeform.cutters.cutter import level_disc
from trunnion.plan.freeform.space import SurfaceSpace
from trunnion.progress import NO_PROGRESS, Progress

CELLS = 8.0
"""Cells of the grid over the disc's radius."""
MOST_SAMPLES = 20_000
"""Positions of the grid: some tenths of a second of dropping; beyond, cells grow."""


def hollow_depths(
    space: SurfaceSpace, points: Floats, radius: float, progress: Progress = NO_PROGRESS
) -> Floats:
    """Return how deep (k,) mm the part lies below a level disc of a radius (mm) that comes as low as it can over points (k, 3).

    Points and depths are in the cutting frame. A hollow is at least as deep as this says: see `lowest_disc`.
    """
    over = space.skin.drop.drop(points[:, :2], level_disc(0.0), float(space.low[2]), progress)
    return np.maximum(lowest_disc(space, points[:, :2], radius, progress) - over, 0.0)


def are_opened(
    space: SurfaceSpace,
    bottom: float,
    points: Floats,
    radius: float,
    progress: Progress = NO_PROGRESS,
) -> Bools:
    """Return which points (k, 3) beside the part a level disc of a radius (mm) comes to on its way down to a height: what lies there can
    be roughed away. Points are in the cutting frame."""
    lowest = lowest_disc(space, points[:, :2], radius, progress)
    return np.asarray((points[:, 2] > bottom - tolerance.SEW) & (points[:, 2] > lowest))


def lowest_disc(
    space: SurfaceSpace, points: Floats, radius: float, progress: Progress = NO_PROGRESS
) -> Floats:
    """Return how low (k,) a level disc of a radius (mm) comes that lies over points (k, 2) somewhere: the closing of the part's heights.

    Between the grid's positions the disc is taken to be as low as at the lowest near by, so it comes no lower than this says, and a hollow
    that is wider than the disc by less than a cell may be told as open.
    """
    if not len(points):
        return np.zeros(0)
    low, high = points.min(axis=0) - radius, points.max(axis=0) + radius
    cell = max(radius / CELLS, math.sqrt(float(np.prod(high - low)) / MOST_SAMPLES))
    count = np.ceil((high - low) / cell).astype(int) + 1
    positions = low + cell * np.argwhere(np.ones(tuple(count), dtype=bool))
    lowest = float(space.low[2])
    disc = space.skin.drop.drop(positions, level_disc(radius), lowest, progress).reshape(
        tuple(count)
    )
    # A position is up to half a diagonal from a point, and from where the disc would come lowest.
    closed = minimum_filter(
        disc, footprint=_disc(radius / cell + math.sqrt(2.0)), mode="constant", cval=np.inf
    )
    row = np.clip(np.rint((points - low) / cell).astype(int), 0, count - 1)
    return np.asarray(closed[row[:, 0], row[:, 1]])


def _disc(radius: float) -> Bools:
    """Return the cells (2 r + 1, 2 r + 1) of a disc whose radius is given in cells."""
    reach = np.arange(-math.floor(radius), math.floor(radius) + 1)
    return np.asarray(np.hypot(reach[:, None], reach[None, :]) <= radius)
