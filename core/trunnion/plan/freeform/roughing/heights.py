"""How high a part is, seen along the tool: a map that is nowhere lower than the part with its allowance, and areas where it is low.

Each position of a square grid knows the height of the part, thickened all round by an allowance, over a disc as wide as a cell's diagonal.
So every corner of a cell is at least as high as the part anywhere in the cell, and where a cell is split by a height, one corner that lies
below it is enough to know that the cell does.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import cast

import contourpy
import numpy as np
import shapely

from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.plane.plan_area import region_of
from trunnion.geometry.plane.region import EMPTY_REGION, Region
from trunnion.geometry.surface.drop_surface import DropSurface
from trunnion.progress import NO_PROGRESS, Progress

MOST_SAMPLES = 60_000
"""Positions of a map: about a second of dropping; beyond, cells grow."""


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

    Between the corners of a cell heights change evenly along its edges; low corners across from one another are joined where the mean of
    all four is low. Rims are straightened by at most `chord` mm and moved inwards by as much, so that nothing higher comes in.
    """
    contours = contourpy.contour_generator(
        corner[0] + cell * np.arange(height.shape[0]),
        corner[1] + cell * np.arange(height.shape[1]),
        height.T,
        name="serial",
        fill_type=contourpy.FillType.OuterOffset,
    )
    pieces = cast(tuple[list[Floats], list[Ints]], contours.filled(-math.inf, z))
    rings = [np.split(points, ends[1:-1]) for points, ends in zip(*pieces, strict=True)]
    if not rings:
        return EMPTY_REGION
    area = shapely.MultiPolygon([(outer, holes) for outer, *holes in rings])
    # Where a corner lies at the very height, rims touch themselves.
    whole = area if area.is_valid else shapely.make_valid(area)
    # Moved in by as much as it was straightened, corners kept sharp; and out and in again over what is narrower than that.
    return region_of(
        shapely.buffer(shapely.simplify(whole, chord), -chord, join_style="mitre", mitre_limit=2.0)
    )


def _disc(radius: float, allowance: float) -> Floats:
    """Return the lower side of a level disc, thicker all round by an allowance, as kernels of drops know it."""
    level = [0.0, radius, 0.0, 0.0, 0.0, 0.0]
    return np.array(
        [level]
        if allowance <= 0.0
        else [level, [radius, radius + allowance, 1.0, radius, allowance, allowance]]
    )
