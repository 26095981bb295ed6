"""Cuts the tops of ribs and islands: the whole top with its flares, by layers, the cutter hanging over both sides."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from trunnion import tolerance
from trunnion.findings import Finding, info, warning
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.curve_parts import points_along
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
from trunnion.toolpath.motion.load.engagement import top_width
from trunnion.toolpath.offsetting import choices
from trunnion.toolpath.offsetting.area_clearing import (
    ClearingLayer,
    ClearingParameters,
    clear_area,
    cut_lines,
)
from trunnion.toolpath.offsetting.levels import steps_down
from trunnion.toolpath.offsetting.rings import OffsetRing, ring_tree, safe_step
from trunnion.toolpath.stock.heightfield import PlanningStock

PARTS = 64
"""Parts of a loop, of which as few as will do are cut."""

MOST_OF_LOOP = 0.8
"""Of a loop: a part of it that is longer isn't worth coming back over the whole strip afterwards."""

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
        lines = [_one_pass(ring, level.wanted, _flat(tool)) for ring in rings]
        passes = [line for line in lines if line is not None]
        loops = tuple(r for r, line in zip(rings, lines, strict=True) if line is None)
        for z in steps_down(above, level.bottom, data.depth):
            progress.at(
                (drive.top - z) / max(drive.top - drive.bottom, tolerance.SEW),
                f"{drive.feature}: layer at {z:.3f}",
            )
            if not stock.is_clear(z + tolerance.COINCIDENT, level.wanted):
                layer = ClearingLayer(z=z, rings=loops, axis_region=axis_region, top=None)
                clear_area(builder, layer, parameters, progress)
                cut_lines(builder, layer, passes, parameters, progress)
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


def _one_pass(ring: OffsetRing, wanted: Region, flat: float) -> Curve | None:
    """Return the shortest part of a loop that a cutter with a flat of a radius in mm brings to its height all by that the whole loop does:
    along a strip that is no wider than the cutter one way is enough. None where that leaves out little of the loop."""
    if ring.inner or len(ring.curves()) != 1:
        return None
    loop = ring.curves()[0]
    rim = np.concatenate([points_along(c)[1] for c in wanted.curves()])
    served = rim[(loop.distance(rim) <= flat) | ring.region.contains(rim)]
    at = np.linspace(0.0, loop.length, PARTS + 1)
    covers = np.column_stack(
        [loop.split(a, b).distance(served) <= flat + tolerance.SEW for a, b in pairwise(at)]
    )
    # Windows of consecutive parts, round the loop: the shortest of which every place is covered by some part.
    count = np.cumsum(np.pad(np.tile(covers, 2), ((0, 0), (1, 0))), axis=1)
    for parts in range(1, int(MOST_OF_LOOP * PARTS) + 1):
        covered = (count[:, parts : parts + PARTS] > count[:, :PARTS]).all(axis=0)
        if covered.any():
            first = int(np.argmax(covered))
            return loop.split(float(at[first]), float(at[first]) + parts * loop.length / PARTS)
    return None


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
