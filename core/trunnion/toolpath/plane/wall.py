"""Finishes walls: climbing passes along the guide lines in axial steps, then down the fillet to the floor's height."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np

from trunnion import tolerance
from trunnion.findings import Finding, error, face_tags, info, warning
from trunnion.geometry.arrays import Floats
from trunnion.geometry.plane.region import EMPTY_REGION, Region, union_all
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.prismatic.drive import Floor, PlaneDrive, WallGuide, foot_clearance
from trunnion.progress import Progress
from trunnion.settings import setting, settings
from trunnion.toolpath.axis_region import AxisRegion, AxisRegions, is_closed, level_at
from trunnion.toolpath.contract import Planned, strategy
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.choices import safety
from trunnion.toolpath.motion.load.easing import eased_finish
from trunnion.toolpath.motion.load.engagement import eased_leftovers
from trunnion.toolpath.motion.order import nearest_first
from trunnion.toolpath.offsetting import choices
from trunnion.toolpath.offsetting.area_clearing import ClearingLayer, ClearingParameters, clear_area
from trunnion.toolpath.offsetting.contour import (
    ContourApproach,
    contour_parts,
    cut_parts,
    length_out_of_reach,
)
from trunnion.toolpath.offsetting.levels import fillet_steps, steps_down, with_tops
from trunnion.toolpath.offsetting.rings import ring_tree, safe_step
from trunnion.toolpath.stock.heightfield import PlanningStock

SMALLEST_LEFTOVER = 1.0
"""mm2: less that is left needs no word."""

RIM = 3.0
"""Cells along the walls that the wall passes have cut, though the field can't be sure of it."""

MOST_FILLET_STEPS = 40
"""More passes than this on one fillet mean that the cutter is the wrong one."""


@settings("plane.wall")
class WallSettings:
    """How walls are finished. The axial step comes with the cutting data."""

    lead_radius: float = choices.lead_radius(
        4.0,
        "Radius of the tangential arcs onto the wall and off it; smaller where there is no room.",
    )
    overlap: float = choices.overlap(2.0)
    spring: bool = setting(
        False, label="Spring pass", help="Go along each wall a second time without moving in."
    )
    scallop: float = choices.fillet_scallop()
    floor_rest: bool = setting(
        True,
        label="Rest of the floor",
        help="Finish what a larger floor cutter left between walls that stand close.",
    )
    ramp_angle: float = choices.ramp_angle(2.0)
    safety: float = safety()


@strategy(settings=WallSettings, drive=PlaneDrive, meets=eased_leftovers, own_faces=True)
def wall(
    drive: PlaneDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    settings: WallSettings,
    progress: Progress,
) -> Planned:
    """Return the motions that finish every wall of the drive, and the lengths of wall that the cutter can't reach."""
    builder = PathBuilder(tool, data, stock, setup, settings.safety)
    approach = ContourApproach(
        radius=settings.lead_radius,
        overlap=settings.overlap,
        ramp=math.radians(settings.ramp_angle),
        rounds=2 if settings.spring else 1,
    )
    findings: list[Finding] = []
    axis_regions = AxisRegions()
    for n, guide in enumerate(drive.walls):
        found = False
        step = min(data.depth, tool.flank_step(guide.top - guide.bottom))
        for z, extra in _heights(guide, tool, step, settings.scallop, builder.tops()):
            progress.at(n / len(drive.walls), f"{drive.feature}: wall at {z:.3f}")
            boundary = _off_other_feet(level_at(drive, z).boundary, drive, guide, tool, z)
            distance = tool.radius + drive.wall_allowance + extra
            axis_region = axis_regions.of(
                boundary, distance, mitred=guide.fillet > 0.0 and guide.loop.closed
            )
            parts = contour_parts(axis_region, guide.curve, distance)
            cut_parts(builder, parts, z, axis_region, approach, past=guide.run_of is None)
            found = found or bool(parts)
        findings += _remaining_findings(drive, guide, tool, found, axis_regions)
    if settings.floor_rest:
        for each in drive.floors:
            progress.check()
            _cut_floor_rest(builder, drive, each, tool, approach, progress)
    if not drive.walls:
        findings.append(
            error(
                "wall.none",
                f"{drive.feature} has no wall to finish",
                drive.feature,
                remedy="suppress the operation",
            )
        )
    return Planned(
        path=eased_finish(builder.finished(), tool, data, stock, progress), findings=tuple(findings)
    )


def _off_other_feet(
    boundary: Region, drive: PlaneDrive, guide: WallGuide, tool: Tool, z: float
) -> Region:
    """Return where the envelope may be beside a wall, kept off feet that are rounder than this wall's by what they need more.

    The axis keeps the clearance of this wall's own foot from everything; a rounder foot beside it, a pocket's around an island or the
    other way round, needs more, and gets it here.
    """
    own = foot_clearance(guide.fillet, tool.corner_radius, z - guide.bottom)
    islands, pocket = EMPTY_REGION, 0.0
    for other in (*drive.walls, *drive.beside):
        if abs(other.bottom - guide.bottom) > tolerance.SEW:
            continue
        more = foot_clearance(other.fillet, tool.corner_radius, z - guide.bottom) - own
        if not other.is_around:
            pocket = max(pocket, more)
        elif more > tolerance.COINCIDENT:
            islands = islands.union(Region.of([other.loop]).offset(more))
    if pocket > tolerance.COINCIDENT:
        material_inside = _inside_of(w for w in (*drive.walls, *drive.beside) if w.is_around)
        boundary = boundary.union(material_inside).offset(-pocket).minus(material_inside)
    return boundary.minus(islands) if islands else boundary


def _inside_of(guides: Iterable[WallGuide]) -> Region:
    """Return what closed guide lines run around."""
    inside = [Region.of([g.loop]) for g in guides]
    return union_all(inside) if inside else EMPTY_REGION


def _cut_floor_rest(
    builder: PathBuilder,
    drive: PlaneDrive,
    each: Floor,
    tool: Tool,
    approach: ContourApproach,
    progress: Progress,
) -> None:
    """Cut what a larger floor cutter left where it had no space: floor that neither it nor the wall passes have certainly reached."""
    stock = builder.stock()
    inner = each.region.offset(-each.fillet - RIM * stock.cell)
    positions = stock.positions_above(each.z + tolerance.COINCIDENT, inner)
    if not len(positions):
        return
    rest = union_all(
        [
            Region.rectangle(*(low - stock.cell), *(high + stock.cell))
            for low, high in _clusters(positions, tool.radius)
        ]
    )
    distance = (
        tool.radius + drive.wall_allowance + foot_clearance(each.fillet, tool.corner_radius, 0.0)
    )
    level = level_at(drive, each.z)
    axis_region = AxisRegion.of(
        level.boundary, distance, mitred=each.fillet > 0.0 and is_closed(level)
    )
    step = safe_step(tool, tool.radius)
    parameters = ClearingParameters(step=step, ramp=approach.ramp, slot=1.0)
    for clip in nearest_first(rest.offset(step).split(), lambda: builder.here, _away):
        layer = ClearingLayer(
            z=each.z,
            rings=ring_tree(axis_region.region, step, clip),
            axis_region=axis_region,
            clip=clip,
        )
        clear_area(builder, layer, parameters, progress)


def _away(area: Region, position: Floats) -> float:
    """Return how far an area is from a position (2,)."""
    return max(-float(area.signed_distance(position)[0]), 0.0)


def _clusters(positions: Floats, apart: float) -> list[tuple[Floats, Floats]]:
    """Return the boxes (low, high) around groups of positions (k, 2) that are nearer to one another than `apart`, by squares of that
    size."""
    squares = np.floor(positions / apart).astype(int)
    boxes = []
    for square in np.unique(squares, axis=0):
        inside = positions[(squares == square).all(axis=1)]
        boxes.append((inside.min(axis=0), inside.max(axis=0)))
    return boxes


def _heights(
    guide: WallGuide, tool: Tool, step: float, scallop: float, tops: Sequence[float]
) -> list[tuple[float, float]]:
    """Return (height, what is kept more than the radius from the wall) of all passes, downwards, some at the tops of what is avoided."""
    foot = fillet_steps(guide.fillet, tool.corner_radius, scallop)
    straight = (
        steps_down(guide.top, guide.bottom + foot[0], step)
        if guide.top - guide.bottom > foot[0] + tolerance.SEW
        else ()
    )
    heights = [*straight, *(guide.bottom + t for t in foot[1 if straight else 0 :])]
    return [
        (z, foot_clearance(guide.fillet, tool.corner_radius, z - guide.bottom))
        for z in with_tops(heights, guide.top, tops)
    ]


def _remaining_findings(
    drive: PlaneDrive,
    guide: WallGuide,
    tool: Tool,
    found: bool,
    axis_regions: AxisRegions,
) -> list[Finding]:
    height = guide.top - guide.bottom
    if not found:
        return [
            warning(
                "wall.too-narrow",
                f"{tool.name} can't come to a wall of {drive.feature}: {guide.curve.length * height:.0f} mm2 stay",
                drive.feature,
                *face_tags(guide.faces),
                remedy="choose a smaller cutter",
            )
        ]
    steps = len(fillet_steps(guide.fillet, tool.corner_radius, tolerance.GOUGE))
    findings = []
    if steps > MOST_FILLET_STEPS:
        findings.append(
            info(
                "wall.fillet-cutter",
                f"the fillet of {guide.fillet:g} mm takes {steps} passes with {tool.name}",
                drive.feature,
                *face_tags(guide.faces),
                remedy="choose a cutter whose corner radius is the fillet's",
            )
        )
    distance = tool.radius + drive.wall_allowance
    missed = length_out_of_reach(
        axis_regions.of(level_at(drive, guide.bottom).boundary, distance),
        guide.curve,
        distance,
    )
    if missed * height > SMALLEST_LEFTOVER:
        findings.append(
            info(
                "wall.left",
                f"{missed * height:.0f} mm2 of wall stay in corners that {tool.name} can't reach",
                drive.feature,
                *face_tags(guide.faces),
                remedy="finish them with the corners, by a smaller cutter",
            )
        )
    return findings
