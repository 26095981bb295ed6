"""Plane drives over ground laid flat: layers from the blank down, and the ground itself as a floor, all of it or what cutters left."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from trunnion import tolerance
from trunnion.geometry.plane.region import EMPTY_REGION, Region
from trunnion.model.operation import Operation
from trunnion.model.tool import Tool
from trunnion.plan.development.ground import DevelopedGround
from trunnion.plan.freeform.keys import number
from trunnion.plan.freeform.lands import ABOVE_TOOL, AROUND_TOOL
from trunnion.plan.prismatic.drive import (
    FLOOR_ALLOWANCE,
    WALL_ALLOWANCE,
    DriveLevel,
    Floor,
    PlaneDrive,
)

ROUGH, FLOOR = "rough", "floor"
"""Kinds of operations over ground laid flat."""
HAIR = 0.05
"""mm: half the width up to which what is left along rims is none."""
WORTH = 0.1
"""mm of the blank over a layer that is worth a pass."""
NEARLY = 10.0 * tolerance.SEW
"""mm: heights that differ by less are cut as one."""
FLAT = 0.01
"""mm that a level disc may stay off bent ground and still have finished it."""
OFF_STOCK = 0.3
"""mm that shank and holder keep from what earlier roughing left on sides."""
BESIDE = 1.0
"""mm that a bottom is finished on beyond the ring that stands on it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GroundCutter:
    """A cutter that went over the same ground before: what it kept from walls (mm), and around and above shank and holder."""

    tool: Tool
    allowance: float
    around: float
    above: float

    @staticmethod
    def of(operation: Operation) -> GroundCutter:
        """Return the cutter of an operation."""
        return GroundCutter(
            tool=operation.cutter,
            allowance=number(operation, WALL_ALLOWANCE),
            around=number(operation, AROUND_TOOL),
            above=number(operation, ABOVE_TOOL),
        )


def tangent_reach(ground: DevelopedGround) -> float:
    """Return how far (mm) from its axis a level disc that touches bent ground finishes it across: sqrt(2 r e) for a gap e at its rim."""
    return math.sqrt(2.0 * ground.least_radius * FLAT)


def shank_clearance(
    ground: DevelopedGround, tool: Tool, roughed: Sequence[Tool], allowance: float
) -> float:
    """Return what (mm) a shank must keep from the part, beside what larger cutters left on its sides with an allowance; 0 where the flutes
    are longer than that is high.

    At the top of the ring a straight cutter is narrower over the plane, and leaves that much more than its allowance.
    """
    larger = [cutter.radius for cutter in roughed if cutter.radius > tool.radius]
    if not larger or tool.flute_length >= ground.ring_top:
        return 0.0
    return allowance + (1.0 - ground.widths) * max(larger) + OFF_STOCK


def ring_of(ground: DevelopedGround) -> Region:
    """Return the area of ground on which the blank stands, and a little beside it."""
    return ground.blank_over(WORTH).offset(BESIDE).intersect(ground.milled())


@dataclass(frozen=True, slots=True, kw_only=True)
class Layer:
    """A layer over ground, from `top` down to `bottom` (mm), and the heights between, from the top down, to which bosses that end in it
    are cut."""

    top: float
    bottom: float
    tops: tuple[float, ...] = ()


def layers_down(
    top: float, bottom: float, step: float, tops: Sequence[float], allowance: float
) -> list[Layer]:
    """Return layers from the top down, all a step thick but the first, where the blank is narrowest; bosses' tops keep an allowance."""
    count = max(1, math.ceil((top - bottom) / step - tolerance.COINCIDENT))
    heights = [top, *(bottom + n * step for n in range(count - 1, -1, -1))]
    ends = list[float]()
    for z in sorted((z + allowance for z in tops), reverse=True):
        # Tops at nearly one height are cut to the upper of them.
        if not ends or ends[-1] - z > NEARLY:
            ends.append(z)
    # What is hardly below a layer's bottom is cut with it; what is above it, however little, stands in its way.
    return [
        Layer(
            top=high,
            bottom=low,
            tops=tuple(z for z in ends if low + tolerance.COINCIDENT < z < high - NEARLY),
        )
        for high, low in pairwise(heights)
    ]


def layers_over(
    operation: Operation,
    ground: DevelopedGround,
    tops: Sequence[float],
    before: Sequence[GroundCutter],
) -> PlaneDrive:
    """Return layers from the blank down to the ground's allowance, without what earlier cutters cleared; `tops` are heights (mm) over the
    ground from which on bosses are clear.

    A layer goes round the bosses first, whole; what it leaves over those that end in it is then cut down to their tops, from its sides:
    a layer of its own for each top would go over all of the ground again.
    """
    floor, wall = number(operation, FLOOR_ALLOWANCE), number(operation, WALL_ALLOWANCE)
    mine = GroundCutter.of(operation)
    levels = []
    top = ground.top_with(floor)
    for layer in layers_down(top, floor, operation.data.depth, tops, floor):
        done = cleared_by(mine, ground, layer.bottom - floor)
        over = list[DriveLevel]()
        for z in reversed(layer.tops):
            level = _level(ground, layer.top, z, floor, mine, before, (done,))
            over.append(level)
            done = cleared_by(mine, ground, z - floor)
        whole = _level(ground, layer.top, layer.bottom, floor, mine, before)
        levels += [whole, *(level for level in reversed(over) if level.wanted)]
    return PlaneDrive(
        feature=operation.feature,
        kind=operation.kind,
        levels=tuple(levels),
        stock_top=top,
        faces=operation.faces,
        wall_allowance=wall,
        floor_allowance=0.0,
    )


def _level(
    ground: DevelopedGround,
    top: float,
    z: float,
    floor: float,
    mine: GroundCutter,
    before: Sequence[GroundCutter],
    cleared: Sequence[Region] = (),
) -> DriveLevel:
    """Return what a cutter cuts at a height: what of the blank stands there and no earlier cutter took, without what is cleared anyway."""
    boundary = free_for(ground, z - floor, mine)
    wanted = ground.blank_over(z + WORTH).intersect(boundary)
    cleared = [*cleared, *(cleared_by(earlier, ground, z - floor) for earlier in before)]
    for done in cleared:
        wanted = wanted.minus(done).opened(HAIR)
    if cleared and wanted:
        # What is left goes on into what is cleared, so that it is entered from there.
        wanted = wanted.offset(0.5 * mine.tool.radius).intersect(boundary)
    return DriveLevel(top=top, bottom=z, wanted=wanted, boundary=boundary)


def cleared_by(cutter: GroundCutter, ground: DevelopedGround, z: float) -> Region:
    """Return what a cutter clears at a height over ground, and a hair more."""
    kept = cutter.tool.radius + cutter.allowance
    axis_region = free_for(ground, z, cutter).offset(-kept)
    return axis_region.offset(kept + HAIR) if axis_region else axis_region


def floor_over(
    operation: Operation,
    ground: DevelopedGround,
    before: Sequence[GroundCutter],
    stock: float,
    turned: Region = EMPTY_REGION,
) -> PlaneDrive:
    """Return the ground as a floor on which `stock` mm stand, without what earlier cutters finished and what is `turned`."""
    mine = GroundCutter.of(operation)
    boundary = free_for(ground, 0.0, mine)
    wanted = ring_of(ground).minus(ground.over(SKIMMED))
    if turned:
        wanted = wanted.minus(turned).opened(HAIR)
    wanted = remaining_on(ground, wanted, before)
    face = operation.faces[0] if operation.faces else 0
    return PlaneDrive(
        feature=operation.feature,
        kind=operation.kind,
        levels=(DriveLevel(top=max(stock, FLAT), bottom=0.0, wanted=wanted, boundary=boundary),),
        floors=(Floor(z=0.0, region=wanted, fillet=0.0, face=face),) if wanted else (),
        stock_top=max(stock, FLAT),
        faces=operation.faces,
    )


SKIMMED = 5e-3
"""mm over the ground from which on what stands there is no ground any more."""


def remaining_on(ground: DevelopedGround, wanted: Region, before: Sequence[GroundCutter]) -> Region:
    """Return what cutters leave of ground: what their discs stay off, beside things that stand there, counts as left."""
    reach = tangent_reach(ground)
    for earlier in before:
        axis_region = free_for(ground, 0.0, earlier).offset(-earlier.tool.radius)
        if axis_region:
            flat = earlier.tool.radius - earlier.tool.corner_radius
            wanted = wanted.minus(axis_region.offset(min(reach, flat))).opened(HAIR)
    return wanted


def free_for(ground: DevelopedGround, z: float, cutter: GroundCutter) -> Region:
    """Return the area that a cutter's envelope may be in, its tip `z` mm over ground."""
    return ground.free(z, cutter.tool, cutter.around, cutter.above)
