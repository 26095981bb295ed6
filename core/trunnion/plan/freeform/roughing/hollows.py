"""How deep the hollows of a part are that a cutter is too wide for: what roughing with it leaves full, for others to clear.

The depth is that of the black top-hat of the part's height field by a disc, its closing less itself (J. Serra, Image Analysis and
Mathematical Morphology, 1982): the closing is as low as the disc comes anywhere over a position.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.ndimage import minimum_filter

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

    Points and depths are in the cutting frame. Between the grid's positions the disc is taken to be as low as at the lowest near by, so
    a hollow is never deeper than this says, and one that is wider than the disc by less than a cell may be told as open.
    """
    if not len(points):
        return np.zeros(0)
    low, high = points[:, :2].min(axis=0) - radius, points[:, :2].max(axis=0) + radius
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
    row = np.clip(np.rint((points[:, :2] - low) / cell).astype(int), 0, count - 1)
    over = space.skin.drop.drop(points[:, :2], level_disc(0.0), lowest, progress)
    return np.maximum(closed[row[:, 0], row[:, 1]] - over, 0.0)


def _disc(radius: float) -> Bools:
    """Return the cells (2 r + 1, 2 r + 1) of a disc whose radius is given in cells."""
    reach = np.arange(-math.floor(radius), math.floor(radius) + 1)
    return np.asarray(np.hypot(reach[:, None], reach[None, :]) <= radius)
