"""How high a part is, seen along the tool: a map that is nowhere lower than the part with its allowance, and areas where it is low.

Each position of a square grid knows the height of the part, thickened all round by an allowance, over a disc as wide as a cell's diagonal.
So every corner of a cell is at least as high as the part anywhere in the cell, and where a cell is split by a height, one corner that lies
below it is enough to know that the cell does.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import shapely

from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.plane.plan_area import region_of
from trunnion.geometry.plane.region import EMPTY_REGION, Region
from trunnion.geometry.surface.drop_surface import DropSurface
from trunnion.progress import NO_PROGRESS, Progress

MOST_SAMPLES = 60_000
"""Positions of a map: about a second of dropping; beyond, cells grow."""
CORNERS = ((0, 0), (1, 0), (1, 1), (0, 1))
"""Corners of a cell, anticlockwise."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeightMap:
    """Heights (nx, ny) mm at the positions `corner` + (i, j) `cell`."""

    height: Floats
    corner: Floats
    cell: float

    @staticmethod
    def of(
        drop: DropSurface,
        low: Floats,
        high: Floats,
        cell: float,
        allowance: float,
        progress: Progress = NO_PROGRESS,
        most: int = MOST_SAMPLES,
    ) -> HeightMap:
        """Return the map of a surface over a box with corners (3,), which should hold it with space to spare; nothing is below `low`,
        and there are at most `most` positions."""
        size = high[:2] - low[:2]
        cell = cell_over(low, high, cell, most)
        count = np.ceil(size / cell).astype(int) + 1
        corner = 0.5 * (low[:2] + high[:2]) - 0.5 * cell * (count - 1)
        positions = corner + cell * np.argwhere(np.ones(tuple(count), dtype=bool))
        top = drop.drop(
            positions, _disc(math.sqrt(2.0) * cell, allowance), float(low[2]) - allowance, progress
        )
        return HeightMap(height=top.reshape(tuple(count)) + allowance, corner=corner, cell=cell)

    def below(self, z: float, chord: float) -> Region:
        """Return the area of the map that lies at a height or below it, with rims straightened by at most `chord` mm, always inwards."""
        return region_below(self.height, self.corner, self.cell, z, chord)


def cell_over(low: Floats, high: Floats, cell: float, most: int = MOST_SAMPLES) -> float:
    """Return the side in mm of the cells of a map over a box with corners (3,): `cell`, or what keeps it to `most` positions."""
    size = high[:2] - low[:2]
    return max(cell, math.sqrt(float(size[0] * size[1]) / most))


def wall_gap(cell: float, chord: float) -> float:
    """Return by how much, in mm and in the mean, the rims of `HeightMap.below` stay farther from upright walls than the map's allowance.

    A position is low from a cell's diagonal off the wall on. The rim crosses the edge to a position that isn't, on either side of that
    distance by less than a cell, and straightening moves it off by the chord error. So no rim is farther off than twice this.
    """
    return math.sqrt(2.0) * cell + chord


def region_below(height: Floats, corner: Floats, cell: float, z: float, chord: float) -> Region:
    """Return the area, over a grid of heights (nx, ny) with its first place at `corner` (2,), that lies at most at `z`.

    Between the corners of a cell heights change evenly along its edges. Rims are straightened by at most `chord` mm and moved inwards by as
    much, so that nothing higher comes in.
    """
    low: Bools = np.asarray(height <= z)
    around = np.stack([low[i : i + low.shape[0] - 1, j : j + low.shape[1] - 1] for i, j in CORNERS])
    whole = np.asarray(around.all(axis=0))
    mixed = np.asarray(around.any(axis=0) & ~whole)
    parts = [*_runs(whole, corner, cell), *_slices(height, mixed, corner, cell, z)]
    if not parts:
        return EMPTY_REGION
    area = shapely.union_all(np.array(parts))
    # Moved in by as much as it was straightened, corners kept sharp; and out and in again over what is narrower than that.
    area = shapely.buffer(
        shapely.simplify(area, chord), -chord, join_style="mitre", mitre_limit=2.0
    )
    return region_of(area)


def _disc(radius: float, allowance: float) -> Floats:
    """Return the lower side of a level disc, thicker all round by an allowance, as kernels of drops know it."""
    level = [0.0, radius, 0.0, 0.0, 0.0, 0.0]
    return np.array(
        [level]
        if allowance <= 0.0
        else [level, [radius, radius + allowance, 1.0, radius, allowance, allowance]]
    )


def _runs(whole: Bools, corner: Floats, cell: float) -> list[shapely.Geometry]:
    """Return boxes over rows of cells that are whole."""
    edge = np.diff(np.pad(whole, ((0, 0), (1, 1))).astype(np.int8), axis=1)
    (i, first), (_, last) = np.nonzero(edge == 1), np.nonzero(edge == -1)
    # Rows that meet have the very same x there: a hair between them would stay when rims are moved in.
    x0, x1, y0, y1 = (
        corner[0] + cell * i,
        corner[0] + cell * (i + 1),
        corner[1] + cell * first,
        corner[1] + cell * last,
    )
    return [shapely.box(*corners) for corners in np.column_stack([x0, y0, x1, y1]).tolist()]


def _slices(
    height: Floats, mixed: Bools, corner: Floats, cell: float, z: float
) -> list[shapely.Geometry]:
    """Return what lies low of cells that are split: the corners below, and on the edges between the positions where they cross the
    height."""
    i, j = np.nonzero(mixed)
    if not len(i):
        return []
    at = np.stack([np.column_stack([i + a, j + b]) for a, b in CORNERS], axis=1)
    value = height[at[:, :, 0], at[:, :, 1]] - z
    position, after, next_value = (
        at.astype(np.float64),
        np.roll(at, -1, axis=1),
        np.roll(value, -1, axis=1),
    )
    crossed = (value <= 0.0) != (next_value <= 0.0)
    share = np.divide(value, value - next_value, out=np.zeros_like(value), where=crossed)
    crossing = position + share[:, :, None] * (after - position)
    # Corner, crossing, corner, ... : what isn't there takes the place of what was before it, which adds no area.
    ring = np.stack([position, crossing], axis=2).reshape(len(i), 8, 2)
    there = np.stack([value <= 0.0, crossed], axis=2).reshape(len(i), 8)
    twice = np.concatenate([there, there], axis=1)
    rows = np.maximum.accumulate(np.where(twice, np.arange(16), -1), axis=1)[:, 8:] % 8
    ring = corner + cell * np.take_along_axis(ring, rows[:, :, None], axis=1)
    return [*np.atleast_1d(np.asarray(shapely.polygons(ring)))]
