"""Plane drives of parts of curved surfaces: layers from how high the part is, and lands and outlines of their own modules."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from trunnion import tolerance
from trunnion.findings import Refused
from trunnion.geometry.arrays import Floats
from trunnion.geometry.plane.region import EMPTY_REGION, Region
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.plan.contract import StockHeights
from trunnion.plan.freeform.keys import BOTTOM, CELL, KEPT, LAYER, number, total_allowance
from trunnion.plan.freeform.lands import LAND, REST_LAND, land_drive
from trunnion.plan.freeform.outline import outline_drive
from trunnion.plan.freeform.roughing.heights import (
    HeightMap,
    cell_over,
    region_below,
    wall_gap,
)
from trunnion.plan.freeform.space import SurfaceSpace
from trunnion.plan.prismatic.drive import DriveLevel, PlaneDrive
from trunnion.progress import Progress

STRAIGHT = 0.5
"""Of the allowance: how far the rims of layers may be straightened."""
LEAST_STRAIGHT = 0.02
"""mm: the same where hardly anything is left."""
LEVEL_AREA = 4.0
"""mm2: level faces together at a height at least this large end a layer on them."""
POCKET_SAMPLES = 240_000
"""Positions of a pocket's map, which is made once for all of its operations: about four seconds of dropping."""
WORTH = 0.2
"""Of a layer: stock that is no higher over it isn't worth a pass in it."""
HAIR = 0.05
"""mm: half the width up to which what is left of a step is nothing."""
RIM = 2.0
"""Cells of the stock that walls keep high though everything beside them is cut."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LayerArea:
    """Where a pocket is roughed by layers: `low` and `high` (3,) are the corners of the box that is mapped, `level` the heights of level
    faces that end layers, `within` returns the plan area that a layer with its bottom at a height keeps in."""

    low: Floats
    high: Floats
    level: Sequence[float]
    within: Callable[[float], Region]

    def height_map(
        self, space: SurfaceSpace, cell: float, allowance: float, progress: Progress
    ) -> HeightMap:
        """Return how high the part, thicker by an allowance, stands in the box, on cells of a side in mm."""
        return HeightMap.of(
            space.skin.drop, self.low, self.high, cell, allowance, progress, POCKET_SAMPLES
        )

    def remaining(self, cell: float, allowance: float) -> float:
        """Return how thick, in mm and in the mean, layers leave material on upright walls; nowhere is it twice as thick."""
        return allowance + wall_gap(
            cell_over(self.low, self.high, cell, POCKET_SAMPLES), _chord(allowance)
        )


def plane_drive_of(
    operation: Operation,
    space: SurfaceSpace,
    stock: StockHeights,
    progress: Progress,
    process: ProcessTree | None = None,
) -> PlaneDrive:
    """Return the drive of a plane operation on a part of curved surfaces, in the cutting frame; `process` says what was cut before."""
    highest = float(stock.heights.max())
    if operation.kind == REST_LAND:
        before = (
            [o for o in process.operations if o.kind == LAND and not o.suppressed]
            if process
            else []
        )
        return progress.aside(lambda _: land_drive(operation, space, before, highest))
    if operation.kind == LAND:
        return progress.aside(lambda _: land_drive(operation, space, (), highest))
    if operation.kind == "rough":
        return _layers(operation, space, stock, progress)
    if operation.kind == "profile_finish":
        return progress.aside(lambda _: outline_drive(operation, space))
    raise Refused(
        f"{operation.id}: parts of curved surfaces have no drive for plane operations of kind {operation.kind}"
    )


def remaining_on_walls(space: SurfaceSpace, allowance: float, cell: float) -> float:
    """Return how thick, in mm and in the mean, layers with an allowance from a map with these cells (mm) leave material on upright walls.

    Nowhere is it twice as thick.
    """
    return allowance + wall_gap(cell_over(*_mapped_box(space, cell), cell), _chord(allowance))


def _chord(allowance: float) -> float:
    """Return how far in mm the rims of layers with an allowance may be straightened."""
    return max(STRAIGHT * allowance, LEAST_STRAIGHT)


def _mapped_box(space: SurfaceSpace, cell: float) -> tuple[Floats, Floats]:
    """Return the corners (3,) of the box that layers map the part over: the blank and two cells all round."""
    margin = np.array([1.0, 1.0, 0.0]) * 2.0 * cell
    return space.low - margin, space.high + margin


def _layers(
    operation: Operation, space: SurfaceSpace, stock: StockHeights, progress: Progress
) -> PlaneDrive:
    """Return layers over all of the part, as `layers_of`."""
    allowance, cell = total_allowance(operation), number(operation, CELL)
    low, high = _mapped_box(space, cell)
    tall = HeightMap.of(space.skin.drop, low, high, cell, allowance, progress)
    outside = space.around().minus(
        Region.rectangle(
            *(tall.corner + cell),
            *(tall.corner + tall.cell * (np.array(tall.height.shape) - 1) - cell),
        )
    )
    chord = _chord(allowance)
    return layers_of(
        operation,
        space,
        stock,
        level_faces(space),
        lambda z: outside.union(tall.below(z, chord)),
        (low, high),
        progress,
    )


def pocket_layers(
    operation: Operation,
    space: SurfaceSpace,
    stock: StockHeights,
    area: LayerArea,
    tall: HeightMap,
    progress: Progress,
) -> PlaneDrive:
    """Return layers within the area of a pocket, as `layers_of`, from its height map."""
    chord = _chord(total_allowance(operation))
    return layers_of(
        operation,
        space,
        stock,
        area.level,
        lambda z: tall.below(z, chord).intersect(area.within(z)),
        (area.low, area.high),
        progress,
    )


def layers_of(
    operation: Operation,
    space: SurfaceSpace,
    stock: StockHeights,
    level: Sequence[float],
    free_at: Callable[[float], Region],
    box: tuple[Floats, Floats],
    progress: Progress,
) -> PlaneDrive:
    """Return layers down to the operation's bottom: what is over each that the part, its allowance all round, doesn't need.

    `level` are the heights of level faces, which end a layer; `free_at` returns where nothing of the part with its allowance is at a height
    or over it, within a `box` with corners (3,). A layer that nothing is over wants nothing.

    Layers are as thick as the depth of cut. From the bottom of each upwards what its cutter couldn't come to on slopes is then cut in steps
    (choice `LAYER`), each from the side that is cut already: every place is cut once on the way down and once on the way up, not at every
    step.
    """
    allowance = total_allowance(operation)
    bottom = number(operation, BOTTOM) + number(operation, KEPT)
    top, radius = float(stock.heights.max()), operation.cutter.radius
    blank, around = space.blank_area(), space.around()
    depth = operation.data.depth
    step = min(number(operation, LAYER) or depth, depth)
    levels = []
    for above, steps in layer_groups(top, _heights(level, top, bottom, step, allowance), depth):
        cleared = EMPTY_REGION
        for z, next_up in pairwise([*reversed(steps), above]):
            progress.check()
            free = free_at(z)
            high = stock_over(stock, z, next_up, box)
            wanted = without_rims(high, free, stock.cell).intersect(blank)
            if cleared and wanted:
                wanted = wanted.minus(cleared).opened(HAIR)
                # What is left goes on into what is cleared, so that it is entered from there.
                wanted = wanted.offset(0.5 * radius).intersect(free) if wanted else wanted
            axis_region = free.offset(-radius)
            cleared = axis_region.offset(radius + HAIR) if axis_region else cleared
            levels.append(
                DriveLevel(top=above, bottom=z, wanted=wanted, boundary=free if wanted else around)
            )
    return PlaneDrive(
        feature=operation.feature,
        kind=operation.kind,
        levels=tuple(levels),
        stock_top=top,
        faces=operation.faces,
    )


def layer_groups(
    top: float, heights: Sequence[float], depth: float
) -> list[tuple[float, list[float]]]:
    """Return heights from the top down in groups no thicker than a depth, each with the height that it begins at; groups are as even as
    the heights allow."""
    count = max(1, math.ceil((top - heights[-1]) / depth - tolerance.COINCIDENT)) if heights else 1
    even = (top - heights[-1]) / count if heights else depth
    groups: list[tuple[float, list[float]]] = []
    above, group = top, list[float]()
    for n, z in enumerate(heights):
        group.append(z)
        last = n + 1 == len(heights)
        if last or above - heights[n + 1] > even * (1.0 + tolerance.PARAMETRIC):
            groups.append((above, group))
            above, group = z, []
    return groups


def _heights(
    level: Sequence[float], top: float, bottom: float, step: float, allowance: float
) -> list[float]:
    """Return the heights of layers from the top down, none thicker than a step: each level face ends one, its allowance kept."""
    breaks = [
        top,
        *(
            z + allowance
            for z in level
            if bottom + tolerance.SEW < z + allowance < top - tolerance.SEW
        ),
        bottom,
    ]
    found: list[float] = []
    for high, low in pairwise(breaks):
        count = max(1, int(np.ceil((high - low) / step - tolerance.COINCIDENT)))
        found += [high + (low - high) * (n + 1) / count for n in range(count)]
    return found


def level_faces(space: SurfaceSpace) -> list[float]:
    """Return the heights of level faces that look up, from the highest down; those that lie within a sliver are one."""
    skin = space.skin
    a, b, c = np.moveaxis(skin.points[skin.triangles], 1, 0)
    normal = np.cross(b - a, c - a)
    area = 0.5 * np.linalg.norm(normal, axis=1)
    level = normal[:, 2] > 2.0 * area * np.cos(tolerance.ANGLE)
    heights, areas = a[level, 2], area[level]
    order = np.argsort(-heights, kind="stable")
    heights, areas = heights[order], areas[order]
    found = []
    for group in np.split(
        np.arange(len(heights)), np.flatnonzero(np.diff(heights) < -tolerance.SLIVER) + 1
    ):
        if len(group) and areas[group].sum() > LEVEL_AREA:
            found.append(float(heights[group].max()))
    return found


def stock_over(stock: StockHeights, z: float, above: float, box: tuple[Floats, Floats]) -> Region:
    """Return where the stock in a box is over a layer by more than is worth nothing."""
    heights, corner = _cells_in(stock, *box)
    higher = heights > z + WORTH * (above - z)
    if not higher.any():
        return EMPTY_REGION
    if higher.all():
        return Region.rectangle(*corner, *(corner + stock.cell * np.array(heights.shape)))
    # Each cell of the stock as a position of a grid: low where it stands high.
    most = float(heights.max())
    grid = np.pad(np.where(higher, most - 1.0, most + 1.0), 1, constant_values=most + 1.0)
    return region_below(grid, corner - 0.5 * stock.cell, stock.cell, most, LEAST_STRAIGHT)


def without_rims(high: Region, free: Region, cell: float) -> Region:
    """Return what of an area in which stock in cells of a side (mm) is high a layer cuts that keeps to a `free` area.

    Along walls, which bound the free area, the field keeps a strip of cells high that the cutter has been at. Away from them what is as
    narrow is stock: a thin plate that nothing else would cut, and that a deeper layer's neck would meet.
    """
    rim = RIM * cell
    wide = high.opened(rim)
    narrow = high.minus(wide).intersect(free.offset(-2.0 * rim)).opened(0.5 * cell)
    plates = tuple(piece for piece in narrow.pieces if piece.area > (2.0 * rim) ** 2)
    return wide.intersect(free).opened(0.5 * rim).union(Region(plates))


def _cells_in(stock: StockHeights, low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """Return the heights (nx, ny) of the cells in a box and some around it, which rims that are left out keep to, and their corner."""
    around = 2.0 * RIM * stock.cell
    first, last = (
        np.clip(np.round((at - stock.corner) / stock.cell).astype(int), 0, stock.heights.shape)
        for at in (low[:2] - around, high[:2] + around)
    )
    return stock.heights[first[0] : last[0], first[1] : last[1]], stock.corner + stock.cell * first
