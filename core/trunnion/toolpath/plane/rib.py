"""Cuts the tops of ribs and islands: the whole top with its flares, by layers, the cutter hanging over both sides."""

from __future__ import annotations

import math

from trunnion import tolerance
from trunnion.findings import Finding, info, warning
from trunnion.geometry.plane.region import Region
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.prismatic.drive import DriveLevel, PlaneDrive
from trunnion.progress import Progress
from trunnion.settings import setting, settings
from trunnion.toolpath.axis_region import AxisRegion
from trunnion.toolpath.contract import Planned, strategy
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.choices import safety
from trunnion.toolpath.motion.engagement import top_width
from trunnion.toolpath.offsetting import choices
from trunnion.toolpath.offsetting.area_clearing import ClearingLayer, ClearingParameters, clear_area
from trunnion.toolpath.offsetting.levels import steps_down
from trunnion.toolpath.offsetting.rings import ring_tree, safe_step
from trunnion.toolpath.stock.heightfield import PlanningStock

SMALLEST_LEFTOVER = 1.0
"""mm2: less that is left needs no word."""

FLARE_MARGIN = 0.5
"""mm around the strips beside walls that only a cutter standing beside the top covers."""


@settings("plane.rib_top")
class RibTopSettings:
    """How tops are cut. Width and depth of cut come with the cutting data."""

    overhang: float = setting(
        0.5,
        unit="mm",
        low=0.0,
        high=20.0,
        label="Overhang",
        help="How far outside the top's edge the middle of the cutter runs.",
    )
    wall_distance: float = setting(
        0.0,
        unit="mm",
        low=0.0,
        high=10.0,
        label="Distance from walls",
        help="Kept between the cutter and the finished walls at a rib's ends.",
    )
    ramp_angle: float = choices.ramp_angle(3.0, "Slope of the helix or ramp onto the top.")
    slot_feed: float = choices.slot_feed(
        0.8, "Share of the feed while the whole width of a rib is cut at once."
    )
    safety: float = safety()


@strategy(settings=RibTopSettings, drive=PlaneDrive, meets=top_width)
def rib_top(
    drive: PlaneDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    settings: RibTopSettings,
    progress: Progress,
) -> Planned:
    """Return the motions that bring a top to its height by layers, and what of it the cutter leaves."""
    builder = PathBuilder(tool, data, stock, setup, settings.safety)
    parameters = ClearingParameters(
        step=safe_step(tool, data.width),
        ramp=math.radians(settings.ramp_angle),
        slot=settings.slot_feed * data.slot_share,
    )
    findings: list[Finding] = []
    above = max(drive.top, drive.stock_top)
    for level in drive.levels:
        axis_region = AxisRegion.of(level.boundary, tool.radius + settings.wall_distance)
        over = _over(level, axis_region, tool, settings.overhang)
        if not over:
            findings.append(
                warning(
                    "rib.too-narrow",
                    f"{tool.name} does not fit over {drive.feature}: {level.wanted.area:.0f} mm2 stay",
                    drive.feature,
                    remedy="choose a smaller cutter",
                )
            )
            continue
        rings = ring_tree(over, parameters.step)
        for z in steps_down(above, level.bottom, data.depth):
            progress.at(
                (drive.top - z) / max(drive.top - drive.bottom, tolerance.SEW),
                f"{drive.feature}: layer at {z:.3f}",
            )
            if not stock.is_clear(z + tolerance.COINCIDENT, level.wanted):
                clear_area(
                    builder,
                    ClearingLayer(z=z, rings=rings, axis_region=axis_region, top=None),
                    parameters,
                    progress,
                )
            above = z
        remaining = level.wanted.minus(over.offset(_flat(tool) + tolerance.SEW)).area
        if remaining > SMALLEST_LEFTOVER:
            findings.append(
                info(
                    "rib.left",
                    f"{remaining:.0f} mm2 of the top of {drive.feature} stay beside walls",
                    drive.feature,
                    remedy="choose a flat cutter, or a smaller one",
                )
            )
    return Planned(path=builder.finished(), findings=tuple(findings))


def _flat(tool: Tool) -> float:
    return max(tool.radius - tool.corner_radius, tolerance.SLIVER)


def _over(level: DriveLevel, axis_region: AxisRegion, tool: Tool, overhang: float) -> Region:
    """Return where the axis goes: over the top and a little more, and beside it where a wall keeps the axis away from its flares."""
    near = level.wanted.offset(overhang) if overhang > 0.0 else level.wanted
    over = axis_region.region.intersect(near)
    missed = level.wanted.minus(over.offset(_flat(tool))) if over else level.wanted
    missed = Region(tuple(p for p in missed.pieces if p.area > tolerance.SEW))
    return (
        over.union(axis_region.region.intersect(missed.offset(_flat(tool) + FLARE_MARGIN)))
        if missed
        else over
    )
