"""Roughs a pocket by layers, at constant engagement or by contour-parallel passes, entered by helix, ramp or from outside."""

from __future__ import annotations

import math
from functools import partial

from trunnion import tolerance
from trunnion.findings import Finding, face_tags, info, warning
from trunnion.geometry.plane.region import Region
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.cutting.engaged import BY_TIME, CONSTANT_ENGAGEMENT, CONTOUR_PARALLEL, ENGAGED
from trunnion.plan.prismatic.drive import DriveLevel, PlaneDrive, foot_clearance
from trunnion.progress import Progress
from trunnion.settings import setting, settings
from trunnion.toolpath.constant_engagement.clearing import RIM, EngagedClearing
from trunnion.toolpath.contract import Planned, strategy
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.choices import safety
from trunnion.toolpath.motion.load.easing import fed_by_load
from trunnion.toolpath.motion.load.engagement import ENGAGED_SLACK, ENGAGED_SPARE, roughing
from trunnion.toolpath.offsetting import choices
from trunnion.toolpath.offsetting.area_clearing import (
    ClearingLayer,
    ClearingParameters,
    clear_area,
    cut_rims,
)
from trunnion.toolpath.offsetting.levels import layers
from trunnion.toolpath.offsetting.passes import ClearingPasses, passes_over
from trunnion.toolpath.offsetting.rings import safe_step
from trunnion.toolpath.stock.heightfield import PlanningStock

SMALLEST_LEFTOVER = 1.0
"""mm2: less that is left needs no word."""

RIDGE = 0.3
"""mm: highest ridge between passes of a cutter with a rounded end; the next layer or the floor's finish takes it away."""

WORTH = 0.2
"""Of a layer: stock that is no higher over it isn't worth a pass in it."""

TALL = 1.0
"""Radii of the cutter: a strip over a fillet that is taller is cut by a pass of its own; finishing takes lower ones."""

ENTRY = 3.0
"""degrees: slope of entries into materials that say nothing of it."""


@settings("plane.rough")
class RoughSettings:
    """How a pocket is roughed. Width and depth of cut come with the cutting data, allowances with the drive."""

    pattern: str = setting(
        CONTOUR_PARALLEL,
        choices=(BY_TIME, CONSTANT_ENGAGEMENT, CONTOUR_PARALLEL),
        label="Pattern",
        help="constant-engagement: spirals and crescents that keep the angle of contact. contour-parallel: offsets of the walls, the first "
        "one in full width. by-time: each layer in the quicker one.",
    )
    ramp_angle: float = setting(
        0.0,
        unit="deg",
        low=0.0,
        high=30.0,
        label="Entry angle",
        help="Slope of the helix or ramp into full material; 0: what the material bears.",
    )
    slot_feed: float = choices.slot_feed(
        0.6, "Share of the feed while the whole cutter's width is in material."
    )
    safety: float = safety()


@strategy(settings=RoughSettings, drive=PlaneDrive, meets=roughing)
def rough(
    drive: PlaneDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    settings: RoughSettings,
    progress: Progress,
) -> Planned:
    """Return the motions that clear every band of the drive layer by layer down to the floors' allowance, and what the cutter leaves."""
    builder = PathBuilder(tool, data, stock, setup, settings.safety)
    parameters = ClearingParameters(
        step=safe_step(tool, data.layer_width or data.width, RIDGE),
        ramp=math.radians(settings.ramp_angle or data.entry_angle or ENTRY),
        slot=settings.slot_feed * data.slot_share,
        share=data.layer_share,
    )
    engaged = settings.pattern in ENGAGED
    clear = (
        EngagedClearing(data, parameters, by_time=settings.pattern == BY_TIME).clear
        if engaged
        else partial(clear_area, parameters=parameters)
    )
    findings: list[Finding] = []
    remaining: list[tuple[DriveLevel, float]] = []
    above, first = max(drive.top, drive.stock_top), True
    for n, level in enumerate(drive.levels):
        if n and abs(level.top - drive.levels[n - 1].bottom) > tolerance.SEW:
            # It doesn't go on below the level before: what stands over it is asked of the stock.
            above, first = level.top, True
        heights = layers(
            above,
            level.bottom,
            data.depth if engaged else data.deepest_slot,
            _horizontals(drive, n),
            drive.floor_allowance,
        )
        made: dict[float, ClearingPasses] = {}
        for z in heights:
            progress.at(
                (drive.top - z) / max(drive.top - drive.bottom, tolerance.SEW),
                f"{drive.feature}: layer at {z:.3f}",
            )
            distance = tool.radius + drive.wall_allowance + _foot(drive, tool, z)
            passes = _passes(made, drive, level, tool, distance, parameters.step)
            if passes.rings and not _is_cleared(builder, level.wanted, z):
                known = None if first or passes.clip is not None else above
                clear(
                    builder,
                    ClearingLayer(
                        z=z,
                        rings=passes.rings,
                        axis_region=passes.axis_region,
                        clip=passes.clip,
                        top=known,
                        wanted=level.wanted,
                        worth=min(RIDGE, WORTH * (above - z)),
                    ),
                    progress=progress,
                )
                rim = _over_feet(drive, tool, z)
                # Under strips that no flute reaches over from the next band's first layer the neck would come to them.
                goes_on = n + 1 < len(drive.levels) and z == heights[-1]
                too_high = goes_on and above - (z - data.depth) > tool.flute_length - tolerance.SEW
                if above - rim > TALL * tool.radius or (too_high and math.isfinite(rim)):
                    # Strips stand on walls over fillets that have kept the cutter off all the layer's height.
                    beside = tool.radius + drive.wall_allowance + _foot(drive, tool, rim)
                    strips = _passes(dict(made), drive, level, tool, beside, parameters.step)
                    cut_rims(
                        builder,
                        ClearingLayer(
                            z=rim,
                            rings=strips.rings,
                            axis_region=strips.axis_region,
                            clip=strips.clip,
                        ),
                        parameters,
                        progress,
                    )
            above, first = z, False
        if made and not made[max(made)].axis_region.region:
            findings.append(_too_wide(drive, level, tool))
        elif made:
            remaining.append(
                (level, _remaining_area(level, max(made), made[max(made)].axis_region.region))
            )
    findings += _corners(
        drive, tool, [(level, area) for level, area in remaining if area >= SMALLEST_LEFTOVER]
    )
    slot, spare = parameters.slot * data.deepest_slot / data.depth, 1.0
    if engaged:
        slot, spare = ENGAGED_SLACK * data.width / tool.diameter, ENGAGED_SPARE
    return Planned(
        path=fed_by_load(builder.finished(), tool, data, stock, slot, progress, spare=spare),
        findings=tuple(findings),
    )


def _over_feet(drive: PlaneDrive, tool: Tool, z: float) -> float:
    """Return the height from which on no fillet at the foot of walls keeps a cutter off them that it keeps off at a height."""
    gap = drive.fillet - tool.corner_radius
    return max(
        (f.z + gap for f in drive.floors if 0.0 <= z - f.z + tolerance.SEW < gap), default=math.inf
    )


def _passes(
    made: dict[float, ClearingPasses],
    drive: PlaneDrive,
    level: DriveLevel,
    tool: Tool,
    distance: float,
    step: float,
) -> ClearingPasses:
    """Return the passes over a band whose axes keep a distance from its walls: one of those made before, or a new one among them."""
    if distance not in made:
        made[distance] = passes_over(
            level.wanted, level.boundary, tool, distance, step, mitred=drive.fillet > 0.0
        )
    return made[distance]


def _horizontals(drive: PlaneDrive, row: int) -> list[float]:
    """Return the heights of horizontal faces that the layers of a band end on: floors, and tops of what is in the next band."""
    level = drive.levels[row]
    found = [f.z for f in drive.floors]
    if (
        row + 1 == len(drive.levels)
        or level.wanted.area - drive.levels[row + 1].wanted.area > SMALLEST_LEFTOVER
    ):
        found.append(level.bottom)
    return found


def _foot(drive: PlaneDrive, tool: Tool, z: float) -> float:
    above = [z - f.z for f in drive.floors if z >= f.z - tolerance.SEW]
    return max((foot_clearance(drive.fillet, tool.corner_radius, t) for t in above), default=0.0)


def _is_cleared(builder: PathBuilder, wanted: Region, z: float) -> bool:
    """Return whether the stock has nothing left above `z` over an area, its rim not looked at."""
    stock = builder.stock()
    inner = wanted.offset(-RIM * stock.cell)
    return bool(inner) and stock.is_clear(z + tolerance.COINCIDENT, inner)


def _too_wide(drive: PlaneDrive, level: DriveLevel, tool: Tool) -> Finding:
    return warning(
        "rough.too-wide",
        f"{tool.name} does not fit between the walls of {drive.feature} below {level.top:.2f}: "
        f"{level.wanted.area:.0f} mm2 stay",
        drive.feature,
        *face_tags(drive.faces),
        remedy="choose a smaller cutter",
    )


def _remaining_area(level: DriveLevel, distance: float, region: Region) -> float:
    """Return the area in mm2 that a cutter leaves of what is wanted, its axis everywhere in an axis region that keeps a distance from the
    rim."""
    return level.wanted.minus(region.offset(distance + tolerance.SEW)).area


def _corners(
    drive: PlaneDrive, tool: Tool, remaining: list[tuple[DriveLevel, float]]
) -> list[Finding]:
    """Return one finding for all bands with corners that are left."""
    if not remaining:
        return []
    most, low, high = (
        max(area for _, area in remaining),
        min(level.bottom for level, _ in remaining),
        max(level.top for level, _ in remaining),
    )
    size = f"{most:.0f} mm2" if len(remaining) == 1 else f"up to {most:.0f} mm2"
    return [
        info(
            "rough.left",
            f"{size} of {drive.feature} between {low:.2f} and {high:.2f} stay in corners that {tool.name} can't reach",
            drive.feature,
            remedy="clear them by a smaller cutter afterwards",
        )
    ]
