"""Tangential arcs that bring a cutter onto a contour and off it again, from the free side (the left of the path)."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.geometry.plane.curve import Curve
from trunnion.model.motion.toolpath import Mark
from trunnion.toolpath.axis_region import AxisRegion
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.link import descent, is_free, may_plunge, travel

SHARES = (1.0, 0.6, 0.35, 0.2)
"""Shares of the wanted radius that are tried one after the other where there is little space."""

RUN_INS = (0.0, 0.1, 0.2, 0.35, 0.5, 1.0, 2.0, 3.0, 4.0)
"""Of the cutter's radius: straights before the arc that are tried; one that begins off the material is taken."""

QUARTER = 0.5 * math.pi
STARTS = 12
"""Positions of a closed contour that are tried as its start."""


@dataclass(frozen=True, slots=True, eq=False)
class Lead:
    """A quarter arc between `outside` (2,), off the contour, and the contour; `centre` (2,), `radius` mm.

    `before` (2,) is where the tool comes down: at `outside`, or farther off on the straight that runs into the arc.
    """

    outside: Floats
    centre: Floats
    radius: float
    before: Floats


def lead_in(point: Floats, tangent: Floats, radius: float) -> Lead:
    """Return the quarter arc that ends at a point of a contour in its direction, anticlockwise from the left."""
    centre = point + radius * _left_normal(tangent)
    return Lead(centre - radius * tangent, centre, radius, centre - radius * tangent)


def lead_out(point: Floats, tangent: Floats, radius: float) -> Lead:
    """Return the quarter arc that begins at a point of a contour in its direction and leaves to the left."""
    centre = point + radius * _left_normal(tangent)
    return Lead(centre + radius * tangent, centre, radius, centre + radius * tangent)


def fitting_lead(
    point: Floats, tangent: Floats, radius: float, axis_region: AxisRegion, *, leaves: bool
) -> Lead | None:
    """Return the largest lead up to `radius` that stays in the axis region, or None."""
    for share in SHARES:
        lead = (lead_out if leaves else lead_in)(point, tangent, share * radius)
        if axis_region.holds(_arc_points(lead, point)):
            return lead
    return None


def cut_closed(
    builder: PathBuilder,
    loop: Curve,
    z: float,
    axis_region: AxisRegion,
    feed: float,
    *,
    radius: float,
    overlap: float,
    rounds: int = 1,
) -> bool:
    """Cut a closed contour from its best start, with a lead in, `rounds` times round, an overlap and a lead out.

    The best start has space for the largest lead, in a position that is certainly free, in the middle of a long straight. Return whether
    a lead was found that begins in the axis region and in no full material; nothing is cut otherwise.
    """
    start = _best_start(builder, loop, z, axis_region, radius)
    if start is None:
        return False
    s, lead = start
    point, _ = loop.at(s)
    enter(builder, lead, point, z, feed, axis_region)
    opened = loop.split(s, s)
    for _ in range(rounds):
        builder.curve(opened, z, feed)
    last, tangent = loop.at(s)
    if overlap > 0.0:
        over = loop.split(s, s + min(overlap, 0.5 * loop.length))
        builder.curve(over, z, feed)
        last, tangent = loop.at(s + over.length)
    leave(builder, fitting_lead(last, tangent, lead.radius, axis_region, leaves=True), z, feed)
    return True


def enter(
    builder: PathBuilder,
    lead: Lead,
    point: Floats,
    z: float,
    feed: float,
    axis_region: AxisRegion | None = None,
) -> None:
    """Come down at a lead's outer end, on a way that may stay down in an axis region, and follow it onto the contour."""
    travel(builder, lead.before, z, axis_region)
    builder.line((*lead.outside, z), feed, Mark.LEAD)
    builder.arc((*point, z), lead.centre, QUARTER, feed, Mark.LEAD)


def leave(builder: PathBuilder, lead: Lead | None, z: float, feed: float) -> None:
    """Follow a lead off the contour, when there is space for one."""
    if lead is not None:
        builder.arc((*lead.outside, z), lead.centre, QUARTER, feed, Mark.LEAD)


def start_positions(loop: Curve) -> list[float]:
    """Return arc lengths where a closed contour may be begun: the middles of its longest lines and arcs, straight ones first."""
    seg = loop.segments()
    before = np.cumsum(seg.length) - seg.length
    worth = np.where(seg.sweep == 0.0, seg.length, 0.1 * seg.length)
    order = np.argsort(-worth, kind="stable")[:STARTS]
    return [float(before[k] + 0.5 * seg.length[k]) for k in order]


def from_free(
    builder: PathBuilder, lead: Lead, tangent: Floats, z: float, axis_region: AxisRegion
) -> tuple[Lead, bool]:
    """Return a lead that begins where no material is, and whether it does.

    It is lengthened by the straight that takes it there, and farther off the wall where that is shorter than the way down beside it that
    has to be fed.
    """
    best: tuple[float, Lead] | None = None
    for share in RUN_INS:
        run = share * builder.tool.radius
        if best is not None and run >= best[0]:
            break
        before = lead.outside + run * _left_normal(tangent)
        if is_free(builder, before, z) and axis_region.holds_line(before, lead.outside):
            cost = run + descent(builder, before, z)
            if best is None or cost < best[0]:
                best = cost, replace(lead, before=before)
    return (lead, False) if best is None else (best[1], True)


def _best_start(
    builder: PathBuilder, loop: Curve, z: float, axis_region: AxisRegion, radius: float
) -> tuple[float, Lead] | None:
    best: tuple[tuple[bool, float], float, Lead] | None = None
    for s in start_positions(loop):
        point, tangent = loop.at(s)
        found = fitting_lead(point, tangent, radius, axis_region, leaves=False)
        if found is None:
            continue
        lead, free = from_free(builder, found, tangent, z, axis_region)
        if not free and not may_plunge(builder, lead.before, z):
            continue
        worth = (free, lead.radius)
        if best is None or worth > best[0]:
            best = (worth, s, lead)
        if worth == (True, radius):
            break
    return None if best is None else (best[1], best[2])


def _arc_points(lead: Lead, point: Floats) -> Floats:
    a, b = lead.outside - lead.centre, point - lead.centre
    share = np.linspace(0.0, QUARTER, max(4, int(lead.radius / tolerance.SEW / 50.0) + 4))
    return lead.centre + np.cos(share)[:, None] * a + np.sin(share)[:, None] * b


def _left_normal(tangent: Floats) -> Floats:
    return np.array([-tangent[1], tangent[0]])
