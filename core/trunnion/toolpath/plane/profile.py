"""Cuts the outer profile: rings from outside in to rough it, one climbing pass a level to finish it, down to the bottom exactly."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any

import numpy as np

from trunnion import tolerance
from trunnion.findings import Finding, error, face_tags, info, warning
from trunnion.geometry.arrays import Floats
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.curve_parts import parts_where, points_along
from trunnion.geometry.plane.region import Region
from trunnion.model.operation import CuttingData, Engagement, Operation
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.prismatic.drive import PlaneDrive, WallGuide
from trunnion.progress import Progress
from trunnion.settings import setting, settings
from trunnion.toolpath.axis_region import AxisRegion, level_at
from trunnion.toolpath.contract import Planned, strategy
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.choices import safety
from trunnion.toolpath.motion.link import ASIDE
from trunnion.toolpath.motion.load.easing import fed_by_load
from trunnion.toolpath.motion.load.engagement import EASING_SLACK, contour_leftovers, inner_corner
from trunnion.toolpath.motion.order import nearest
from trunnion.toolpath.offsetting import choices
from trunnion.toolpath.offsetting.contour import (
    ContourApproach,
    contour_parts,
    curve_away,
    cut_parts,
    length_out_of_reach,
)
from trunnion.toolpath.offsetting.levels import steps_down, with_tops
from trunnion.toolpath.offsetting.trimming import GRAZE, WORTH, PassTrimming
from trunnion.toolpath.stock.heightfield import PlanningStock

SMALLEST_LEFTOVER = 1.0
"""mm2: less that is left needs no word."""

LITTLE = 0.25
"""mm on the mean of a diameter's way: the next ring takes so much more, where that is all a ring would cut at a corner of the blank."""

RIM_SPACING = 2.0
"""mm between the positions of the blank's rim whose distance from the profile is measured."""


@settings("plane.profile_rough")
class ProfileRoughSettings:
    """How the outer profile is roughed. Width and depth of cut come with the cutting data, the allowance with the drive."""

    lead_radius: float = choices.lead_radius(5.0, "Radius of the tangential arcs.")
    overlap: float = choices.overlap(2.0)
    ramp_angle: float = choices.ramp_angle(3.0)
    safety: float = safety()


@settings("plane.profile_finish")
class ProfileFinishSettings:
    """How the outer profile is finished. The axial step comes with the cutting data."""

    lead_radius: float = choices.lead_radius(5.0, "Radius of the tangential arcs.")
    overlap: float = choices.overlap(3.0)
    spring: bool = setting(
        False, label="Spring pass", help="Go round a second time without moving in."
    )
    ramp_angle: float = choices.ramp_angle(2.0)
    safety: float = safety()


def _ring_width(
    tool: Tool, data: CuttingData, settings: Any, before: Operation | None
) -> Engagement:
    """Return the width of cut where a ring turns into a corner, wider on both sides of it by what the ring before has left there."""
    return inner_corner(tool, replace(data, width=data.width + 2.0 * LITTLE), settings, before)


@strategy(settings=ProfileRoughSettings, drive=PlaneDrive, meets=_ring_width)
def profile_rough(
    drive: PlaneDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    settings: ProfileRoughSettings,
    progress: Progress,
) -> Planned:
    """Return the motions that take the blank's margin off the profile by layers, in rings from outside in.

    Where tabs hold the part to a frame of the blank, the frame stays: the outermost ring beside it opens the channel by a slot, at the feed
    that removes as much a minute as the width of cut does.
    """
    builder = PathBuilder(tool, data, stock, setup, settings.safety, drive.tabs)
    approach = ContourApproach(
        radius=settings.lead_radius,
        overlap=settings.overlap,
        ramp=math.radians(settings.ramp_angle),
    )
    findings: list[Finding] = []
    rim = _blank_rim(stock)
    for guide in drive.walls:
        margin = float(guide.curve.distance(rim).max())
        distances = _ring_distances(drive, tool, data.width, margin)
        axis_regions: dict[tuple[int, float], tuple[AxisRegion, list[Curve]]] = {}
        slots = _slots(drive, guide, distances, tool)
        slow = replace(data, feed=data.feed * min(data.width / tool.diameter, 1.0))
        margins: dict[int, Region] = {}
        for z in steps_down(max(guide.top, drive.stock_top), guide.bottom, data.depth):
            boundary = level_at(drive, z).boundary
            if id(boundary) not in margins:
                margins[id(boundary)] = _outside(boundary, stock, drive.wall_allowance)
            rings = []
            for distance in distances:
                progress.at(
                    (guide.top - z) / max(guide.top - guide.bottom, tolerance.SEW),
                    f"{drive.feature}: layer at {z:.3f}",
                )
                key = (id(boundary), distance)
                if key not in axis_regions:
                    axis_region = AxisRegion.of(boundary, distance).off(drive.frame, tool.radius)
                    axis_regions[key] = (
                        axis_region,
                        _touching(
                            contour_parts(axis_region, guide.curve, distance), stock, tool.radius
                        ),
                    )
                axis_region, passes = axis_regions[key]
                rings.append(
                    _Ring(
                        axis_region=axis_region,
                        passes=passes,
                        data=slow if distance in slots else data,
                        least=0.0 if distance == distances[-1] else LITTLE * tool.diameter,
                    )
                )
            trimming = PassTrimming.of(builder, margins[id(boundary)], z + WORTH, GRAZE)
            layer = _RingLayer(builder, rings, z, trimming, approach)
            for n in range(len(rings)):
                progress.check()
                layer.cut(n)
        findings += _remaining_findings(drive, guide, tool, drive.wall_allowance)
    planned = _planned(drive, builder, findings)
    # A ring meets a slot where the outline turns into a notch: there it may take what it takes in a corner, as the load was foreseen.
    corner = _ring_width(tool, data, settings, None).width / EASING_SLACK
    path = fed_by_load(
        planned.path, tool, data, stock, max(corner, data.width) / tool.diameter, progress
    )
    return replace(planned, path=path)


@strategy(settings=ProfileFinishSettings, drive=PlaneDrive, meets=contour_leftovers, own_faces=True)
def profile_finish(
    drive: PlaneDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    settings: ProfileFinishSettings,
    progress: Progress,
) -> Planned:
    """Return the motions that finish the profile in axial steps down to its bottom."""
    builder = PathBuilder(tool, data, stock, setup, settings.safety, drive.tabs)
    approach = ContourApproach(
        radius=settings.lead_radius,
        overlap=settings.overlap,
        ramp=math.radians(settings.ramp_angle),
        rounds=2 if settings.spring else 1,
    )
    findings: list[Finding] = []
    for guide in drive.walls:
        distance = tool.radius + drive.wall_allowance
        for z in _steps(builder, drive, guide, distance):
            progress.at(
                (guide.top - z) / max(guide.top - guide.bottom, tolerance.SEW),
                f"{drive.feature}: pass at {z:.3f}",
            )
            axis_region = AxisRegion.of(level_at(drive, z).boundary, distance).off(
                drive.frame, tool.radius
            )
            parts = contour_parts(axis_region, guide.curve, distance)
            cut_parts(builder, parts, z, axis_region, approach, past=guide.run_of is None)
        if tool.corner_radius > 0.0:
            findings.append(
                warning(
                    "profile.corner",
                    f"{tool.name} leaves its corner radius at the bottom of {drive.feature}: "
                    f"{guide.curve.length * tool.corner_radius:.0f} mm2",
                    drive.feature,
                    remedy="choose a flat cutter",
                )
            )
        findings += _remaining_findings(drive, guide, tool, drive.wall_allowance)
    return _planned(drive, builder, findings)


def _outside(boundary: Region, stock: PlanningStock, allowance: float) -> Region:
    """Return the blank's margin: what of its box is outside the part and the allowance on it."""
    low, high = stock.box()
    return boundary.offset(-allowance).intersect(Region.rectangle(*low, *high))


def _ring_distances(drive: PlaneDrive, tool: Tool, width: float, margin: float) -> list[float]:
    """Return how far from the part the axis goes in each ring, the outermost first, so that a margin of the blank is taken off.

    Whole widths from the part outwards: the outermost ring has the least to cut, along straight sides often nothing. Beside a frame that
    tabs hold the part to, the rings of the channel are even, so that it is as wide as the tabs reach.
    """
    inner, channel = tool.radius + drive.wall_allowance, 0.0
    found = []
    if drive.tabs:
        channel = max(max(t.reach for t in drive.tabs) - tool.radius - inner, 0.0)
        number = math.ceil(channel / width - tolerance.COINCIDENT)
        found = [inner + channel * n / number for n in range(number)]
        inner += channel
    count = max(
        1, math.ceil((margin - drive.wall_allowance - channel) / width - tolerance.COINCIDENT)
    )
    found += [inner + n * width for n in range(count)]
    return found[::-1]


def _slots(
    drive: PlaneDrive, guide: WallGuide, distances: list[float], tool: Tool
) -> frozenset[float]:
    """Return the distances of rings that are in full width beside a frame: somewhere no ring goes outside of them."""
    if not drive.frame:
        return frozenset()
    boundary = level_at(drive, guide.bottom).boundary
    found, outer_is_whole = [], True
    for distance in distances:
        axis_region = AxisRegion.of(boundary, distance)
        passes, kept = (
            contour_parts(region, guide.curve, distance)
            for region in (axis_region, axis_region.off(drive.frame, tool.radius))
        )
        if kept and not outer_is_whole:
            found.append(distance)
        whole, done = (sum(c.length for c in curves) for curves in (passes, kept))
        outer_is_whole = done > whole - tolerance.SEW
    return frozenset(found)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Ring:
    """A ring round the outline: its axis region and passes, the data it is cut with, and what a part of it has to meet of the blank's
    margin, more than `least` mm2, to be cut."""

    axis_region: AxisRegion
    passes: list[Curve]
    data: CuttingData
    least: float


@dataclass(frozen=True, slots=True, eq=False)
class _RingLayer:
    """The rings of one layer, the outermost first, at height `z`, cut where the blank's margin stands before the cutter.

    Where they meet it in short arcs alone, at the corners of the blank, the arcs of all rings at a corner are cut before the next corner's.
    `cut_arcs` are those with their rings.
    """

    builder: PathBuilder
    rings: list[_Ring]
    z: float
    trimming: PassTrimming
    approach: ContourApproach
    cut_arcs: list[tuple[int, Curve]] = field(default_factory=list)

    def cut(self, n: int, beside: Curve | None = None, uncut: tuple[Curve, ...] = ()) -> None:
        """Cut ring `n`, the nearest next; given an arc that was cut just before, what of it is `beside` that alone, but for what comes near
        what is still `uncut` of the rings outside of it."""
        builder, ring = self.builder, self.rings[n]
        shorter = replace(self.approach, radius=min(self.approach.radius, ASIDE))
        wholes = list(ring.passes)
        while wholes:
            whole = wholes.pop(nearest(wholes, builder.here, curve_away))
            builder.data = ring.data
            parts = self._trimmed(whole, ring.least)
            if parts == [whole]:
                if beside is None:
                    cut_parts(builder, parts, self.z, ring.axis_region, self.approach)
                continue
            if beside is not None:
                around = (*uncut, *wholes)
                parts = [
                    part
                    for part in parts
                    if self._are_near(part, beside)
                    and not any(self._are_near(part, other) for other in around)
                ]
            parts = [part for part in parts if not self._is_cut(part, n)]
            while parts:
                arc = parts.pop(nearest(parts, builder.here, curve_away))
                self.cut_arcs.append((n, arc))
                builder.data = ring.data
                cut_parts(builder, [arc], self.z, ring.axis_region, shorter, past=False)
                if n + 1 < len(self.rings):
                    self.cut(n + 1, arc, (*uncut, *wholes, *parts))

    def _trimmed(self, whole: Curve, least: float) -> list[Curve]:
        parts = self.trimming.parts(self.builder, whole)
        if least <= 0.0:
            return parts
        return [part for part in parts if self.trimming.area(self.builder, part) > least]

    def _is_cut(self, part: Curve, n: int) -> bool:
        """Return whether an arc of ring `n` was cut before: the rim of what stands inside of it still seems to stand before the cutter."""
        own = [arc for m, arc in self.cut_arcs if m == n]
        if not own:
            return False
        graze = self.trimming.graze
        _, points = points_along(part, graze)
        return any(float(arc.distance(points).max()) < graze for arc in own)

    def _are_near(self, part: Curve, other: Curve) -> bool:
        """Return whether the cutter on one pass comes to what it meets on another."""
        _, points = points_along(part, self.builder.tool.radius)
        return float(other.distance(points).min()) < self.builder.tool.diameter


def _steps(
    builder: PathBuilder, drive: PlaneDrive, guide: WallGuide, distance: float
) -> tuple[float, ...]:
    """Return the heights of the passes along a wall: so many that the flutes, not the shank, meet what roughing left over the wall too."""
    tool, data, stock = builder.tool, builder.data, builder.stock()
    height = guide.top - guide.bottom
    step = tool.flank_step(height)
    if data.depth < height - tolerance.SEW:
        step = min(data.depth, step)
    axis_region = AxisRegion.of(level_at(drive, guide.bottom).boundary, distance)
    # The disc a cell short of the wall: the cells at its rim are the part's own.
    material_inside = [
        stock.height(a, b, max(tool.radius - stock.cell, stock.cell))
        for part in contour_parts(axis_region, guide.curve, distance)
        for a, b in pairwise(points_along(part, tool.radius)[1])
    ]
    highest = max([guide.top, *material_inside])
    return with_tops(steps_down(highest, guide.bottom, step), highest, builder.tops())


def _planned(drive: PlaneDrive, builder: PathBuilder, findings: list[Finding]) -> Planned:
    path = builder.finished()
    if not len(path) and not findings:
        findings.append(
            error(
                "profile.none",
                f"{drive.feature} has no wall to cut",
                drive.feature,
                remedy="suppress the operation",
            )
        )
    return Planned(path=path, findings=tuple(findings))


def _blank_rim(stock: PlanningStock) -> Floats:
    (x0, y0), (x1, y1) = stock.box()
    x = np.linspace(x0, x1, int((x1 - x0) / RIM_SPACING) + 2)
    y = np.linspace(y0, y1, int((y1 - y0) / RIM_SPACING) + 2)
    sides = [np.stack([x, np.full_like(x, v)], axis=1) for v in (y0, y1)] + [
        np.stack([np.full_like(y, v), y], axis=1) for v in (x0, x1)
    ]
    return np.concatenate(sides)


def _touching(parts: list[Curve], stock: PlanningStock, radius: float) -> list[Curve]:
    """Return what of the passes comes near enough to the blank to cut."""
    low, high = stock.box()

    def near(points: Floats) -> Floats:
        outside = np.maximum(np.maximum(low - points, points - high), 0.0)
        return radius - np.hypot(outside[:, 0], outside[:, 1])

    return [piece for part in parts for piece in parts_where(part, near)]


def _remaining_findings(
    drive: PlaneDrive, guide: WallGuide, tool: Tool, allowance: float
) -> list[Finding]:
    distance, height = tool.radius + allowance, guide.top - guide.bottom
    axis_region = AxisRegion.of(level_at(drive, guide.bottom).boundary, distance).off(
        drive.frame, tool.radius
    )
    if not axis_region.region:
        return [
            warning(
                "profile.no-room",
                f"{tool.name} has no room around {drive.feature}: {guide.curve.length * height:.0f} mm2 stay",
                drive.feature,
                *face_tags(guide.faces),
                remedy="choose a smaller cutter",
            )
        ]
    missed = length_out_of_reach(axis_region, guide.curve, distance)
    if missed * height < SMALLEST_LEFTOVER:
        return []
    return [
        info(
            "profile.left",
            f"{missed * height:.0f} mm2 of {drive.feature} stay in concave corners that {tool.name} can't reach",
            drive.feature,
            *face_tags(guide.faces),
            remedy="finish them with a smaller cutter",
        )
    ]
