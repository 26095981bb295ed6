"""Entries into full material: a helix where it fits, else a ramp along the contour."""

from __future__ import annotations

import math

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.geometry.plane.curve import Curve
from trunnion.model.motion.toolpath import Mark
from trunnion.toolpath.axis_region import AxisRegion
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.link import travel

SMALLEST_HELIX = 0.15
"""Of the diameter: a helix with a smaller radius would drill with the cutter's dead centre."""

WIDEST_HELIX = 0.45
"""Of the flat end's radius (and of the diameter): a wider helix leaves a post in its middle."""

GAP = 0.3
"""mm above the material where the helix or ramp begins."""

GRID = 24
"""Positions along each side of a box that are tried for the deepest position of an axis region."""


def deepest_position(area: AxisRegion, axis_region: AxisRegion) -> tuple[Floats, float]:
    """Return the position (2,) in `area` that is deepest inside `axis_region`, and how deep it is there."""
    low, high = area.region.box()
    best, depth = 0.5 * (low + high), -math.inf
    for _ in range(2):
        x, y = np.meshgrid(
            np.linspace(low[0], high[0], GRID), np.linspace(low[1], high[1], GRID), indexing="ij"
        )
        points = np.stack([x.ravel(), y.ravel()], axis=1)
        found = np.where(area.depth(points) >= 0.0, axis_region.depth(points), -math.inf)
        row = int(np.argmax(found))
        if found[row] > depth:
            best, depth = points[row], float(found[row])
        step = (high - low) / (GRID - 1)
        low, high = best - step, best + step
    return best, depth


def helix_radius(builder: PathBuilder, depth: float, drop: float, angle: float) -> float:
    """Return the radius of the helix that fits where the axis region is `depth` deep, or 0 when none does.

    A helix that goes down by `drop` mm at a slope of `angle` is no wider than one turn needs.
    """
    tool = builder.tool
    flat = tool.radius - tool.corner_radius
    smallest = SMALLEST_HELIX * tool.diameter
    widest = min(2.0 * WIDEST_HELIX * max(flat, 0.5 * tool.radius), 0.98 * depth)
    if widest < smallest:
        return 0.0
    return min(widest, max((drop + GAP) / (math.tau * math.tan(angle)), smallest))


def helix(
    builder: PathBuilder,
    centre: Floats,
    radius: float,
    towards: Floats,
    top: float,
    z: float,
    angle: float,
) -> None:
    """Go down anticlockwise round `centre` from just above `top` to `z`, at a slope of `angle` or in one turn where that is less steep, and
    once round there, ending on the side of `towards` (2,)."""
    direction = towards - centre
    last = math.atan2(direction[1], direction[0])
    begin = top + GAP
    sweep = max((begin - z) / (radius * math.tan(angle)), math.tau)

    def at(turned: float) -> Floats:
        """Return the position (2,) on the circle by how far it is turned before the end of the helix (rad)."""
        return centre + radius * np.array([math.cos(last - turned), math.sin(last - turned)])

    travel(builder, at(sweep), begin)
    feed = builder.data.ramp_feed(angle)
    count = max(1, math.ceil(sweep / math.pi - tolerance.COINCIDENT))
    for n in range(count - 1, -1, -1):
        turned = sweep * n / count
        height = z + (begin - z) * n / count
        builder.arc((*at(turned), height), centre, sweep / count, feed, Mark.ENTRY)
    for turned in (math.pi, 0.0):
        builder.arc((*at(turned), z), centre, math.pi, builder.data.feed, Mark.ENTRY)


def ramp_round(
    builder: PathBuilder, loop: Curve, s: float, top: float, z: float, angle: float
) -> None:
    """Go down along a closed contour from its position `s`, round and round until `z`, ending where it began."""
    opened = loop.split(s, s)
    begin = top + GAP
    rounds = max(
        1, math.ceil((begin - z) / (opened.length * math.tan(angle)) - tolerance.COINCIDENT)
    )
    travel(builder, opened.start, begin)
    for n in range(rounds):
        high, low = (begin - (begin - z) * k / rounds for k in (n, n + 1))
        builder.curve(opened, low, builder.data.ramp_feed(angle), Mark.ENTRY, start_z=high)


def ramp_along(builder: PathBuilder, piece: Curve, top: float, z: float, angle: float) -> None:
    """Go down to and fro along the beginning of an open contour until `z`, ending at its start."""
    begin = top + GAP
    needed = (begin - z) / math.tan(angle)
    part = piece.split(0.0, min(piece.length, max(0.5 * needed, builder.tool.radius)))
    back = part.reversed()
    legs = 2 * max(1, math.ceil(0.5 * needed / part.length - tolerance.COINCIDENT))
    travel(builder, part.start, begin)
    for n in range(legs):
        high, low = (begin - (begin - z) * k / legs for k in (n, n + 1))
        builder.curve(
            part if n % 2 == 0 else back,
            low,
            builder.data.ramp_feed(angle),
            Mark.ENTRY,
            start_z=high,
        )
