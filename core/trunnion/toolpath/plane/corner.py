"""Cuts what larger cutters left in the corners of a pocket: only the corner, entered and left tangentially on the cut wall."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from trunnion import tolerance
from trunnion.findings import Finding, info, warning
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.curve_parts import parts_where
from trunnion.geometry.plane.region import Region
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.prismatic.drive import DriveLevel, PlaneDrive, foot_clearance
from trunnion.progress import Progress
from trunnion.settings import settings
from trunnion.toolpath.axis_region import AxisRegion, is_closed
from trunnion.toolpath.contract import Planned, strategy
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.choices import safety
from trunnion.toolpath.motion.link import RIM
from trunnion.toolpath.motion.load.easing import eased_finish
from trunnion.toolpath.motion.load.engagement import eased_corner
from trunnion.toolpath.motion.order import nearest_first
from trunnion.toolpath.offsetting import choices
from trunnion.toolpath.offsetting.contour import ContourApproach, cut_open, cut_parts
from trunnion.toolpath.offsetting.levels import fillet_steps, steps_down
from trunnion.toolpath.offsetting.rings import depth_first, ring_tree, safe_step
from trunnion.toolpath.offsetting.trimming import GRAZE, WORTH, PassTrimming
from trunnion.toolpath.stock.heightfield import PlanningStock

SMALLEST_REST = 0.02
"""mm2: a rest smaller than this can't be told from two offsets that differ in their last digits."""

SMALLEST_LEFTOVER = 0.05
"""mm2: less that is left needs no word."""

OVERRUN = 1.0
"""mm that a pass overlaps what is cut at each end of a rest, along the wall."""

TIP = 0.25
"""mm: where a rest is narrower, as its ends along the walls are, roughing leaves it to finishing."""

DEEPEST = 1.5
"""Diameters: the deepest layer that a narrow rest is roughed in, as deep as a wall's finishing steps."""

ENGAGED = 0.02
"""mm: a pass that would enter a rest by less is not made."""


@settings("plane.corner")
class CornerSettings:
    """How corners are cleared and finished. Width and depth of cut come with the cutting data, allowances with the drive."""

    lead_radius: float = choices.lead_radius(
        1.0,
        "Radius of the tangential arcs onto the wall and off it; smaller where there is no room.",
    )
    scallop: float = choices.fillet_scallop()
    ramp_angle: float = choices.ramp_angle(2.0)
    safety: float = safety()


@dataclass(frozen=True, slots=True, eq=False)
class _Height:
    """One height that the corners of a band are cut at, and what the axis keeps from the walls there."""

    z: float
    distance: float


@strategy(settings=CornerSettings, drive=PlaneDrive, meets=eased_corner)
def corner(
    drive: PlaneDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    settings: CornerSettings,
    progress: Progress,
) -> Planned:
    """Return the motions that clear what a cutter of `drive.earlier_radius` left in the corners, and what this one leaves."""
    builder = PathBuilder(tool, data, stock, setup, settings.safety, drive.tabs)
    approach = ContourApproach(
        radius=settings.lead_radius, overlap=0.0, ramp=math.radians(settings.ramp_angle)
    )
    step = safe_step(tool, data.width)
    findings: list[Finding] = []
    above = drive.top
    for n, level in enumerate(drive.levels):
        progress.at(n / len(drive.levels), f"{drive.feature}: corners down to {level.bottom:.3f}")
        rests = _rests(drive, level, tool).split()
        near = _reaching(rests, tool)
        axis_regions: dict[float, tuple[AxisRegion, tuple[Curve, ...]]] = {}
        for rest in nearest_first(
            rests, lambda: builder.here, lambda r, p: abs(float(r.signed_distance(p)[0]))
        ):
            corner_passes: dict[float, list[Curve]] = {}
            layer, at_once = _layer(drive, rest, tool, data)
            for height in _heights(drive, n, above, tool, layer, settings.scallop):
                progress.check()
                if height.distance not in axis_regions:
                    axis_regions[height.distance] = _passes(
                        drive, level, height.distance, step, near, tool
                    )
                axis_region, rims = axis_regions[height.distance]
                if height.distance not in corner_passes:
                    over = axis_region.region.curves() if at_once else rims
                    reach = height.distance - drive.wall_allowance
                    corner_passes[height.distance] = list(_corner_passes(over, rest, tool, reach))
                for part in _over_stock(
                    builder, corner_passes[height.distance], rest, height, drive, axis_region
                ):
                    if part.closed:
                        cut_parts(builder, [part], height.z, axis_region, approach)
                    else:
                        cut_open(builder, part, height.z, axis_region, approach, past=False)
        lowest = _heights(drive, n, above, tool, data.depth, settings.scallop)
        above = lowest[-1].z if lowest else above
        findings += _remaining_findings(drive, level, tool, rests)
    if not len(builder) and not findings:
        findings.append(
            info(
                "corner.little",
                f"what stands in the corners of {drive.feature} is no more than finishing takes with its allowance",
                drive.feature,
                remedy="suppress the operation",
            )
        )
    return Planned(
        path=eased_finish(builder.finished(), tool, data, stock, progress), findings=tuple(findings)
    )


def _over_stock(
    builder: PathBuilder,
    passes: list[Curve],
    rest: Region,
    height: _Height,
    drive: PlaneDrive,
    axis_region: AxisRegion,
) -> Iterator[Curve]:
    """Yield the parts of passes beside a rest at a height where its stock stands before the cutter.

    Of finishing the passes along the walls are whole, for what they take off is finer than the planner's stock; the others are there for
    what roughing has left, and the stock at the rim, which a wall keeps high, does not count.
    """
    finishes = drive.finishes
    grazes = GRAZE if _leaves_slivers(drive, builder.tool) else 0.0
    trimming = (
        PassTrimming.of(builder, rest, height.z + WORTH, RIM if finishes else grazes)
        if passes
        else None
    )
    for curve in passes:
        middle = curve.at(0.5 * curve.length)[0]
        if trimming is None or (
            finishes and float(axis_region.depth(middle)[0]) <= tolerance.ON_REGION
        ):
            yield curve
        else:
            yield from trimming.parts(builder, curve)


def _rests(drive: PlaneDrive, level: DriveLevel, tool: Tool) -> Region:
    """Return what the earlier cutter left of a band's wanted area, the allowance on the walls taken off; of roughing without what is so
    little that finishing takes it."""
    wanted = (
        level.wanted.offset(-drive.wall_allowance) if drive.wall_allowance > 0.0 else level.wanted
    )
    if drive.earlier_radius <= 0.0:
        return wanted
    cut = level.boundary.offset(-drive.earlier_radius - drive.earlier_allowance)
    slack = max(drive.earlier_allowance - drive.wall_allowance, 0.0) + tolerance.SEW
    rest = wanted.minus(cut.offset(drive.earlier_radius + slack)) if cut else wanted
    if not _leaves_slivers(drive, tool):
        return Region(tuple(p for p in rest.pieces if p.area > SMALLEST_REST))
    rest = rest.offset(-0.5 * TIP).offset(0.5 * TIP)
    # No wider than the allowance on the mean of a diameter's way, as loads are measured: finishing takes that with the allowance.
    least = max(SMALLEST_REST, drive.wall_allowance * tool.diameter)
    return Region(tuple(p for p in rest.pieces if p.area > least))


def _leaves_slivers(drive: PlaneDrive, tool: Tool) -> bool:
    """Return whether roughing may leave to finishing what is hardly more than its allowance: not where the tool goes deeper than its flutes
    are long, for its neck would meet in a lower layer what an upper one left."""
    return not drive.finishes and drive.top - drive.bottom <= tool.flute_length


def _layer(drive: PlaneDrive, rest: Region, tool: Tool, data: CuttingData) -> tuple[float, bool]:
    """Return how deep the layers of one rest are, and whether the passes along the walls take all of it.

    Roughing takes the cross-section that the cutting data bear: where a rest is narrower than their width on the mean of a diameter's
    way, as loads are measured, one pass takes it in layers that are deeper by as much.
    """
    bite = rest.area / tool.diameter
    if drive.finishes or bite > data.width:
        return data.depth, False
    return max(min(data.depth * data.width / bite, DEEPEST * tool.diameter), data.depth), True


def _heights(
    drive: PlaneDrive, row: int, above: float, tool: Tool, depth: float, scallop: float
) -> list[_Height]:
    level = drive.levels[row]
    is_face = (
        row + 1 == len(drive.levels)
        or level.wanted.area - drive.levels[row + 1].wanted.area > SMALLEST_LEFTOVER
    )
    bottom = level.bottom + (drive.floor_allowance if is_face else 0.0)
    if above - bottom < tolerance.SEW:
        return []
    on_floor = any(abs(f.z - level.bottom) < tolerance.SEW and f.fillet > 0.0 for f in drive.floors)
    foot = (
        fillet_steps(drive.fillet, tool.corner_radius, scallop)
        if on_floor and drive.finishes
        else (0.0,)
    )
    straight = (
        steps_down(above, bottom + foot[0], min(depth, tool.flank_step(above - bottom - foot[0])))
        if above - bottom > foot[0] + tolerance.SEW
        else ()
    )
    heights = [*straight, *(bottom + t for t in foot[1 if straight else 0 :])]
    radius = tool.radius + drive.wall_allowance
    return [_Height(z, radius + _foot(drive, tool, z)) for z in heights]


def _foot(drive: PlaneDrive, tool: Tool, z: float) -> float:
    above = [z - f.z for f in drive.floors if z >= f.z - tolerance.SEW and f.fillet > 0.0]
    return max((foot_clearance(drive.fillet, tool.corner_radius, t) for t in above), default=0.0)


def _reaching(rests: tuple[Region, ...], tool: Tool) -> Region:
    return Region(tuple(p for r in rests for p in r.offset(tool.radius).pieces))


def _passes(
    drive: PlaneDrive, level: DriveLevel, distance: float, step: float, near: Region, tool: Tool
) -> tuple[AxisRegion, tuple[Curve, ...]]:
    """Return the axis region and the rims of its rings that come near a rest, the innermost first."""
    mitred = drive.fillet > 0.0 and is_closed(level)
    axis_region = AxisRegion.of(level.boundary, distance, mitred=mitred).off(
        drive.frame, tool.radius
    )
    if not axis_region.region:
        return axis_region, ()
    return axis_region, tuple(
        c for ring in depth_first(ring_tree(axis_region.region, step, near)) for c in ring.curves()
    )


def _corner_passes(
    rims: tuple[Curve, ...], rest: Region, tool: Tool, reach: float
) -> Iterator[Curve]:
    """Yield the parts of the passes beside one rest that cut into it, the axis `reach` from its walls.

    A smaller circle that touches the wall where a larger one did lies inside it: so beside the end of a rest the cutter touches nothing of
    it yet, and runs in and out as far as it is to overlap what is cut.
    """
    around, inside = math.hypot(reach, OVERRUN), tool.radius - ENGAGED
    low, high = rest.box()
    for rim in rims:
        first, last = rim.box()
        if (first > high + around).any() or (last < low - around).any():
            continue
        for part in parts_where(rim, lambda p: rest.signed_distance(p) + around):
            if parts_where(part, lambda p: rest.signed_distance(p) + inside):
                yield part


def _remaining_findings(
    drive: PlaneDrive, level: DriveLevel, tool: Tool, rests: tuple[Region, ...]
) -> list[Finding]:
    if not rests:
        return []
    distance = tool.radius + drive.wall_allowance
    axis_region = AxisRegion.of(level.boundary, distance)
    rest = Region(tuple(p for r in rests for p in r.pieces))
    if not axis_region.region:
        return [
            warning(
                "corner.too-wide",
                f"{tool.name} does not fit into {drive.feature} below {level.top:.2f}: {rest.area:.1f} mm2 stay",
                drive.feature,
                remedy="choose a smaller cutter",
            )
        ]
    remaining = rest.minus(axis_region.region.offset(tool.radius + tolerance.SEW)).area
    if remaining < SMALLEST_LEFTOVER:
        return []
    return [
        info(
            "corner.left",
            f"{remaining:.1f} mm2 in corners of {drive.feature} between {level.bottom:.2f} and {level.top:.2f} stay: they "
            f"are sharper than {tool.name}",
            drive.feature,
            remedy="choose a smaller cutter for the corners",
        )
    ]
