"""Cuts pits in the walls of pockets with a T-slot cutter: down beside the wall, then under the material, pass by pass."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from trunnion import tolerance
from trunnion.findings import Finding, warning
from trunnion.geometry.arrays import Floats
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.curve_parts import parts_where
from trunnion.geometry.plane.region import Region
from trunnion.model.motion.toolpath import Mark
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import T_SLOT, Tool
from trunnion.plan.prismatic.drive import PlaneDrive
from trunnion.plan.prismatic.pits import PitReach, PitSettings, pit_heights
from trunnion.progress import Progress
from trunnion.toolpath.axis_region import AxisRegion
from trunnion.toolpath.contract import Planned, strategy
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.link import travel
from trunnion.toolpath.motion.load.engagement import inner_corner
from trunnion.toolpath.stock.heightfield import PlanningStock

SMALLEST_LEFTOVER, SMALLEST_SHARE = 0.1, 0.01
"""mm2, and of a pit's plan area: less that is left needs no word."""
ENGAGED = 0.02
"""mm: passes begin where the disc is in the pit by as much."""
ALONG_WALL = 0.05
"""mm that the passes inside of a pit keep off where the last one along its walls goes."""
ASIDE = 1.0
"""mm that the disc goes off the wall before it is lifted, and comes down off it."""
MOST_PASSES = 1000
"""Passes under the material at most: none is so deep."""


@strategy(settings=PitSettings, drive=PlaneDrive, meets=inner_corner)
def pit(
    drive: PlaneDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    settings: PitSettings,
    progress: Progress,
) -> Planned:
    """Return the motions that cut a pit, and what of it the cutter leaves.

    `drive.levels` are what is over the pit, where nothing is wanted, and the pit itself. The disc comes down where nothing is over it; the
    passes are parallel to the rim of that area, each deeper by the width of cut, and the last goes along the pit's walls.
    """
    over, level = drive.levels[0], drive.levels[-1]
    if tool.form != T_SLOT or tool.flute_length > level.top - level.bottom + tolerance.COINCIDENT:
        return _not_cut(drive, f"{tool.name} is no T-slot cutter that is thin enough for it")
    reach = PitReach.of(
        level.wanted,
        level.boundary,
        over.boundary,
        over.top - level.bottom,
        tool,
        settings.clearance,
    )
    if not reach.outside or not reach.covered:
        return _not_cut(drive, f"{tool.name} does not come down beside it and into it")
    builder = PathBuilder(tool, data, stock, setup, settings.safety)
    heights = pit_heights(level.bottom, level.top, tool)
    passes = list(_passes(reach, level.wanted, tool, data.width, progress))
    for n, z in enumerate(heights):
        progress.at(n / len(heights), f"{drive.feature}: down to {z:.3f}")
        for curve in passes:
            progress.check()
            _cut(builder, curve, z, reach, settings)
    _leave(builder, reach)
    return Planned(path=builder.finished(), findings=tuple(_left(drive, level.wanted, reach, tool)))


def _passes(
    reach: PitReach, wanted: Region, tool: Tool, width: float, progress: Progress
) -> Iterator[Curve]:
    """Yield the passes of a height: those parallel to where the disc comes down, and the one along the walls of the pit.

    The material is on the right of each, so the cutter climbs. Invariant: a pass goes in no deeper than `width` beyond the one before.
    """
    inner = reach.axis.offset(-ALONG_WALL)
    within = tool.radius - ENGAGED

    def is_inside(points: Floats) -> Floats:
        return np.minimum(inner.signed_distance(points), wanted.signed_distance(points) + within)

    if inner:
        for n in progress.each(range(1, MOST_PASSES)):
            behind = reach.outside.offset(n * width)
            if not inner.minus(behind):
                break
            for rim in behind.curves():
                yield from parts_where(rim, is_inside)
    for rim in reach.axis.curves():
        yield from parts_where(rim, lambda p: wanted.signed_distance(p) + within)


def _cut(
    builder: PathBuilder, curve: Curve, z: float, reach: PitReach, settings: PitSettings
) -> None:
    """Cut one pass: from where the disc is free straight to its start, and from its end back."""
    region, feed = AxisRegion(reach.axis), builder.data.feed
    start, end = (curve.at(s)[0] for s in (0.0, curve.length))
    before, here = _nearest(reach.outside, start), builder.here
    if (
        here is None
        or abs(here[2] - z) > tolerance.SHORT_MOVE
        or not region.holds_line(here, before)
    ):
        _leave(builder, reach)
        travel(builder, _off_walls(reach, before), z)
    builder.line((*before, z), feed, Mark.LINK)
    builder.line((*start, z), feed * settings.slot_feed, Mark.ENTRY)
    builder.curve(curve, z, feed)
    builder.line((*_nearest(reach.outside, end), z), feed, Mark.LEAD)


def _leave(builder: PathBuilder, reach: PitReach) -> None:
    """Go off the wall, to where the disc is lifted."""
    if builder.here is not None:
        builder.line(
            (*_off_walls(reach, builder.here[:2]), builder.here[2]), builder.data.feed, Mark.LEAD
        )


def _off_walls(reach: PitReach, point: Floats) -> Floats:
    """Return a position (2,) near one from which the disc may be lifted, `ASIDE` farther off all walls where there is room for that."""
    inner = reach.outside.offset(-ASIDE)
    found = _nearest(inner, point) if inner else point
    return found if AxisRegion(reach.axis).holds_line(point, found) else point


def _nearest(area: Region, point: Floats) -> Floats:
    """Return the position (2,) of an area that is nearest to another one."""
    if float(area.signed_distance(point[None])[0]) >= 0.0:
        return point
    near = [rim.at(rim.nearest(point))[0] for rim in area.curves()]
    return min(near, key=lambda p: math.dist(p, point))


def _not_cut(drive: PlaneDrive, reason: str) -> Planned:
    finding = warning(
        "pit.not-cut",
        f"{drive.feature} is not cut: {reason}",
        drive.feature,
        remedy="choose a smaller T-slot cutter, or one with a thinner neck",
    )
    return Planned(findings=(finding,))


def _left(drive: PlaneDrive, wanted: Region, reach: PitReach, tool: Tool) -> list[Finding]:
    """Return what is to be said of the part of a pit that the disc does not get to."""
    left = wanted.area - reach.covered.area
    if left < max(SMALLEST_LEFTOVER, SMALLEST_SHARE * wanted.area):
        return []
    share = 100.0 * left / wanted.area
    return [
        warning(
            "pit.left",
            f"{left:.1f} mm2 of {drive.feature}, {share:.0f} % of its plan area, stay: {tool.name} is too wide for its corners, or its "
            "neck too thick for its depth",
            drive.feature,
            remedy="choose a smaller T-slot cutter or one with a thinner neck, round its corners more, or cut the rest by other means",
        )
    ]
