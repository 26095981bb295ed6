"""Finishes floors: contour-parallel passes at the floor's height from the inside out, keeping off the walls' allowance.

The strip along the wall and the fillet are finished by the wall passes, the last of which runs at the floor's height.
"""

from __future__ import annotations

import math

from trunnion import tolerance
from trunnion.findings import Finding, error, info, warning
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.prismatic.drive import PlaneDrive, foot_clearance
from trunnion.progress import Progress
from trunnion.settings import setting, settings
from trunnion.toolpath.axis_region import level_at
from trunnion.toolpath.contract import Planned, strategy
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.choices import safety
from trunnion.toolpath.motion.load.easing import eased_finish
from trunnion.toolpath.motion.load.engagement import floor_leftovers
from trunnion.toolpath.offsetting import choices
from trunnion.toolpath.offsetting.area_clearing import ClearingLayer, ClearingParameters, clear_area
from trunnion.toolpath.offsetting.passes import passes_over
from trunnion.toolpath.offsetting.rings import safe_step
from trunnion.toolpath.stock.heightfield import PlanningStock

SMALLEST_LEFTOVER = 1.0
"""mm2: less that is left needs no word."""


@settings("plane.floor")
class FloorSettings:
    """How floors are finished. The step between passes comes with the cutting data."""

    wall_distance: float = setting(
        0.4,
        unit="mm",
        low=0.0,
        high=10.0,
        label="Distance from walls",
        help="Kept between cutter and finished wall, a little more than the walls' allowance.",
    )
    ramp_angle: float = choices.ramp_angle(2.0, "Slope of the helix or ramp onto the floor.")
    slot_feed: float = choices.slot_feed(
        1.0, "Share of the feed while the whole cutter's width is in material."
    )
    safety: float = safety()


@strategy(
    settings=FloorSettings,
    drive=PlaneDrive,
    leaves=("floor.left",),
    settles=("floor.left",),
    meets=floor_leftovers,
    own_faces=True,
)
def floor(
    drive: PlaneDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    settings: FloorSettings,
    progress: Progress,
) -> Planned:
    """Return the motions that finish every floor of the drive, from the highest down, and what they leave."""
    builder = PathBuilder(tool, data, stock, setup, settings.safety)
    parameters = ClearingParameters(
        step=safe_step(tool, data.width),
        ramp=math.radians(settings.ramp_angle),
        slot=settings.slot_feed,
    )
    findings: list[Finding] = []
    floors = sorted(drive.floors, key=lambda f: -f.z)
    for n, each in enumerate(floors):
        progress.at(n / len(floors), f"{drive.feature}: floor at {each.z:.3f}")
        level = level_at(drive, each.z)
        distance = (
            tool.radius
            + drive.wall_allowance
            + settings.wall_distance
            + foot_clearance(each.fillet, tool.corner_radius, 0.0)
        )
        passes = passes_over(
            each.region, level.boundary, tool, distance, parameters.step, mitred=each.fillet > 0.0
        )
        if not passes.rings:
            findings.append(
                warning(
                    "floor.too-wide",
                    f"{tool.name} does not fit between the walls around the floor at {each.z:.2f}: "
                    f"{each.region.area:.0f} mm2 stay",
                    drive.feature,
                    f"face {each.face}",
                    remedy="choose a smaller cutter",
                )
            )
            continue
        clear_area(
            builder,
            ClearingLayer(
                z=each.z, rings=passes.rings, axis_region=passes.axis_region, clip=passes.clip
            ),
            parameters,
            progress,
        )
        remaining = each.region.minus(
            passes.axis_region.region.offset(distance + tolerance.SEW)
        ).area
        if remaining > SMALLEST_LEFTOVER:
            findings.append(
                info(
                    "floor.left",
                    f"{remaining:.0f} mm2 of the floor at {each.z:.2f} stay in corners that {tool.name} can't reach",
                    drive.feature,
                    f"face {each.face}",
                    remedy="finish them with the corners, by a smaller cutter",
                )
            )
    if not floors:
        findings.append(
            error(
                "floor.none",
                f"{drive.feature} has no floor to finish",
                drive.feature,
                remedy="suppress the operation",
            )
        )
    return Planned(
        path=eased_finish(builder.finished(), tool, data, stock, progress), findings=tuple(findings)
    )
