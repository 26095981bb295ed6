"""Plane drives over ground laid flat: layers from the blank down, and the ground itself as a floor, all of it or what cutters left."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from trunnion import tolerance
from trunnion.geometry.plane.region import Region
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
FLAT = 0.01
"""mm that a level disc may stay off bent ground and still have finished it."""
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


def ring_of(ground: DevelopedGround) -> Region:
    """Return the area of ground on which the blank stands, and a little beside it."""
    return ground.blank_over(WORTH).offset(BESIDE).intersect(ground.band(*ground.ends))


def layer_heights(
    top: float, bottom: float, step: float, tops: Sequence[float], allowance: float
) -> list[float]:
    """Return the heights of layers from the top down, none thicker than a step: each boss's top ends one, its allowance kept."""
    ends = sorted({z + allowance for z in tops if bottom < z + allowance < top}, reverse=True)
    breaks = [top, *ends, bottom]
    kept = [breaks[0]]
    for z in breaks[1:]:
        # Tops at nearly one height end one layer, the upper of them.
        if kept[-1] - z > tolerance.SEW * 10.0 or z == bottom:
            kept.append(z)
    found: list[float] = []
    for high, low in pairwise(kept):
        count = max(1, math.ceil((high - low) / step - tolerance.COINCIDENT))
        found += [high + (low - high) * (n + 1) / count for n in range(count)]
    return found


def layers_over(
    operation: Operation,
    ground: DevelopedGround,
    tops: Sequence[float],
    before: Sequence[GroundCutter],
) -> PlaneDrive:
    """Return layers from the blank down to the ground's allowance, without what earlier cutters cleared; `tops` are heights (mm) over the
    ground from which on bosses are clear."""
    floor, wall = number(operation, FLOOR_ALLOWANCE), number(operation, WALL_ALLOWANCE)
    mine = GroundCutter.of(operation)
    levels, above = [], ground.top
    for z in layer_heights(ground.top, floor, operation.data.depth, tops, floor):
        boundary = _free(ground, z - floor, mine)
        wanted = ground.blank_over(z + WORTH).intersect(boundary)
        for earlier in before:
            axis_region = _free(ground, z - floor, earlier).offset(
                -earlier.tool.radius - earlier.allowance
            )
            if axis_region:
                done = axis_region.offset(earlier.tool.radius + earlier.allowance + HAIR)
                wanted = wanted.minus(done).opened(HAIR)
        if before and wanted:
            # What is left goes on into what is cleared, so that it is entered from there.
            wanted = wanted.offset(0.5 * mine.tool.radius).intersect(boundary)
        levels.append(DriveLevel(top=above, bottom=z, wanted=wanted, boundary=boundary))
        above = z
    return PlaneDrive(
        feature=operation.feature,
        kind=operation.kind,
        levels=tuple(levels),
        stock_top=ground.top,
        faces=operation.faces,
        wall_allowance=wall,
        floor_allowance=0.0,
    )


def floor_over(
    operation: Operation, ground: DevelopedGround, before: Sequence[GroundCutter], stock: float
) -> PlaneDrive:
    """Return the ground as a floor on which `stock` mm stand, without what earlier cutters finished."""
    mine = GroundCutter.of(operation)
    boundary = _free(ground, 0.0, mine)
    wanted = remaining_on(ground, ring_of(ground).minus(ground.over(SKIMMED)), before)
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
        axis_region = _free(ground, 0.0, earlier).offset(-earlier.tool.radius)
        if axis_region:
            flat = earlier.tool.radius - earlier.tool.corner_radius
            wanted = wanted.minus(axis_region.offset(min(reach, flat))).opened(HAIR)
    return wanted


def _free(ground: DevelopedGround, z: float, cutter: GroundCutter) -> Region:
    return ground.free(z, cutter.tool, cutter.around, cutter.above)
