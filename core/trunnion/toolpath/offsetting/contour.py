"""Passes along walls: the rim of the axis region where a guide line made it, with leads, and straight on past open ends."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.curve_parts import parts_where, points_along
from trunnion.toolpath.axis_region import AxisRegion
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.link import is_off, may_plunge, step_aside, top_under, travel
from trunnion.toolpath.motion.order import nearest_first
from trunnion.toolpath.offsetting.entry import ramp_along, ramp_round
from trunnion.toolpath.offsetting.lead import cut_closed, enter, fitting_lead, from_free, leave

PAST = (1.2, 0.6, 0.3)
"""Of the cutter's radius: how far past its end an open wall is followed, as far as there is space."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ContourApproach:
    """How a contour is entered and left: radius of the leads and overlap of a closed contour in mm, slope of ramps in radians,
    times it is gone round."""

    radius: float
    overlap: float
    ramp: float
    rounds: int = 1


def contour_parts(axis_region: AxisRegion, guide: Curve, distance: float) -> list[Curve]:
    """Return the parts of the axis region's rim that lie `distance` from a guide line, the axis region on their left."""
    found: list[Curve] = []
    for rim in axis_region.region.curves():
        found += parts_where(
            rim,
            lambda p: np.minimum(
                distance + tolerance.ON_REGION - guide.distance(p), _past_ends(guide, p, distance)
            ),
        )
    return found


def _past_ends(guide: Curve, points: Floats, distance: float) -> Floats:
    """Return how far points (k, 2) are from the half discs past a guide line's open ends (negative inside): there a pass goes straight on
    instead of round the end."""
    if guide.closed:
        return np.full(len(points), np.inf)
    (first, heading), (last, last_heading) = guide.at(0.0), guide.at(guide.length)
    beyond = [
        np.where(
            np.linalg.norm(points - end, axis=1) <= distance + tolerance.SEW,
            (points - end) @ direction,
            -np.inf,
        )
        for end, direction in ((first, -heading), (last, last_heading))
    ]
    # Ends a little before the half discs, so that the last direction is the wall's and not that of the arc round its end.
    return -tolerance.ON_REGION - np.maximum(*beyond)


def length_out_of_reach(axis_region: AxisRegion, guide: Curve, distance: float) -> float:
    """Return how much of a guide line in mm an axis in the axis region can't come within `distance` of."""
    s, points = points_along(guide)
    spans = np.diff(np.append(s, guide.length))
    if len(spans) < len(points):
        spans = np.append(spans, 0.0)
    missed = -axis_region.depth(points) > distance + tolerance.SEW
    return float(spans[missed].sum())


def cut_parts(
    builder: PathBuilder,
    parts: list[Curve],
    z: float,
    axis_region: AxisRegion,
    approach: ContourApproach,
    *,
    past: bool = True,
) -> None:
    """Cut contours at height `z`, the nearest next, open ones as `cut_open` does."""
    for part in nearest_first(parts, lambda: builder.here, curve_away):
        if part.closed:
            _cut_loop(builder, part, z, axis_region, approach)
        else:
            for _ in range(approach.rounds):
                cut_open(builder, part, z, axis_region, approach, past=past)


def cut_open(
    builder: PathBuilder,
    part: Curve,
    z: float,
    axis_region: AxisRegion,
    approach: ContourApproach,
    *,
    past: bool = True,
) -> None:
    """Cut an open contour, followed straight on past both ends as far as there is space when `past`, with leads.

    An end that lies off the material and off every wall needs no lead: the cutter comes down on it, or is lifted there.
    """
    feed = builder.data.feed
    (first, heading), (last, last_heading) = part.at(0.0), part.at(part.length)
    begin, end = (
        (
            _past(builder, first, -heading, axis_region),
            _past(builder, last, last_heading, axis_region),
        )
        if past
        else (first, last)
    )
    if is_off(builder, begin, z):
        travel(builder, begin, z, axis_region)
    elif not _lead_in(builder, begin, heading, z, axis_region, approach.radius):
        ramp_along(builder, part, max(top_under(builder, p) for p in part.points), z, approach.ramp)
    builder.line((*first, z), feed)
    builder.curve(part, z, feed)
    builder.line((*end, z), feed)
    if is_off(builder, end, z):
        return
    off = fitting_lead(end, last_heading, approach.radius, axis_region, leaves=True)
    leave(builder, off, z, feed)
    if off is None:
        step_aside(builder, last_heading, axis_region)


def _lead_in(
    builder: PathBuilder,
    begin: Floats,
    heading: Floats,
    z: float,
    axis_region: AxisRegion,
    radius: float,
) -> bool:
    """Enter a contour by a lead, where one fits that begins off the material; say whether."""
    lead = fitting_lead(begin, heading, radius, axis_region, leaves=False)
    if lead is None:
        return False
    lead, free = from_free(builder, lead, heading, z, axis_region)
    if not free and not may_plunge(builder, lead.before, z):
        return False
    enter(builder, lead, begin, z, builder.data.feed, axis_region)
    return True


def _cut_loop(
    builder: PathBuilder, loop: Curve, z: float, axis_region: AxisRegion, approach: ContourApproach
) -> None:
    feed = builder.data.feed
    if cut_closed(
        builder,
        loop,
        z,
        axis_region,
        feed,
        radius=approach.radius,
        overlap=approach.overlap,
        rounds=approach.rounds,
    ):
        return
    ramp_round(
        builder, loop, 0.0, max(top_under(builder, p) for p in loop.points), z, approach.ramp
    )
    opened = loop.split(0.0, 0.0)
    for _ in range(approach.rounds):
        builder.curve(opened, z, feed)
    step_aside(builder, loop.at(0.0)[1], axis_region)


def _past(builder: PathBuilder, end: Floats, direction: Floats, axis_region: AxisRegion) -> Floats:
    for share in PAST:
        past = end + share * builder.tool.radius * direction
        if axis_region.holds_line(end, past):
            return past
    return end


def curve_away(curve: Curve, position: Floats) -> float:
    """Return how far a pass begins from a position (2,): a closed one begins anywhere."""
    return float(curve.distance(position)[0]) if curve.closed else math.dist(curve.start, position)
