"""The largest engagement that strategies can meet, by how they cut: what the planner takes the peak of the load from.

Widths are means over a diameter's way, as the load is measured: a corner that loads a cutter for less does not count in full.
"""

from __future__ import annotations

import math
from typing import Any

from trunnion import tolerance
from trunnion.model.operation import CuttingData, Engagement, Operation
from trunnion.model.tool import Tool
from trunnion.plan.cutting.engaged import ENGAGED
from trunnion.toolpath.motion.load.easing import LEAST, slot_of_finish

CRESCENTS = "crescents meet material"
FULL_WIDTH = "the cutter enters at full width"
INNER_CORNER = "walls meet in a corner"
LEFTOVERS = "it meets what roughing left"
EASING_SLACK = 1.25
"""What easing still lets through: it goes by pieces of half a radius and a field of heights, and takes the mean of a diameter's way."""
ENGAGED_SLACK = 1.05
"""What it lets through at constant engagement, where the width of cut stays what it is."""
ENGAGED_SPARE = 1.2
"""By how much more what is eased there goes slower, in necks and corners that are cut by slots: the thinner chips are, the more force a
section asks (Kienzle), and at half the feed that is a fifth."""
LAYERS = 2.0
"""Layers of roughing that leftovers in a corner are high where a cutter meets them at once."""
BOTH_WALLS = 2.0
"""Walls whose allowance a cutter takes at once in an inner corner."""


def full_width(
    tool: Tool, data: CuttingData, settings: Any, before: Operation | None
) -> Engagement:
    """Return a slot of the operation's depth at the settings' `slot_feed`: how contour-parallel passes open an area."""
    return Engagement(
        width=tool.diameter,
        depth=data.deepest_slot,
        share=settings.slot_feed * data.slot_share * data.layer_share,
        at=FULL_WIDTH,
        slows=True,
    )


def roughing(tool: Tool, data: CuttingData, settings: Any, before: Operation | None) -> Engagement:
    """Return what `full_width` does; at constant engagement the width of cut with what easing lets through, if that is more: only entries
    and necks meet a slot there."""
    slot = full_width(tool, data, settings, before)
    if settings.pattern not in ENGAGED:
        return slot
    width = min(ENGAGED_SLACK * data.width, tool.diameter)
    if slot.width * slot.depth * slot.share >= width * data.depth:
        return slot
    return Engagement(width=width, depth=data.depth, share=1.0, at=CRESCENTS)


def top_width(tool: Tool, data: CuttingData, settings: Any, before: Operation | None) -> Engagement:
    """Return the whole width of a top that is free, at the settings' `slot_feed` where that is more than the width of cut."""
    if data.widest <= data.width:
        return Engagement(width=data.width, depth=data.depth, share=1.0, at="")
    width = min(data.widest, tool.diameter)
    return Engagement(
        width=width,
        depth=data.depth,
        share=settings.slot_feed * data.slot_share,
        at=FULL_WIDTH,
        slows=True,
    )


def inner_corner(
    tool: Tool, data: CuttingData, settings: Any, before: Operation | None
) -> Engagement:
    """Return the width of cut where a contour turns into a corner."""
    return Engagement(
        width=corner_width(tool, data.width), depth=data.depth, share=1.0, at=INNER_CORNER
    )


def contour_leftovers(
    tool: Tool, data: CuttingData, settings: Any, before: Operation | None
) -> Engagement:
    """Return what a finishing pass along walls meets in a corner: both walls' allowance, the steps of roughing by layers on one, and what
    a larger cutter left there."""
    width = corner_width(tool, BOTH_WALLS * data.width + _larger(tool, before) + step_width(before))
    return Engagement(
        width=width,
        depth=data.depth,
        share=1.0,
        at=LEFTOVERS if _larger(tool, before) else INNER_CORNER,
    )


def eased_leftovers(
    tool: Tool, data: CuttingData, settings: Any, before: Operation | None
) -> Engagement:
    """Return what `contour_leftovers` does, as far as the easing of finishing feeds (`eased_finish`) lets it."""
    return _eased(tool, data, contour_leftovers(tool, data, settings, before))


def eased_corner(
    tool: Tool, data: CuttingData, settings: Any, before: Operation | None
) -> Engagement:
    """Return two steps of width where walls meet, as far as the easing of finishing feeds (`eased_finish`) lets them."""
    width = corner_width(tool, BOTH_WALLS * data.width)
    return _eased(tool, data, Engagement(width=width, depth=data.depth, share=1.0, at=INNER_CORNER))


def floor_leftovers(
    tool: Tool, data: CuttingData, settings: Any, before: Operation | None
) -> Engagement:
    """Return full width at the floor's allowance, or what a larger cutter left in corners at the slowest that easing goes, if that is
    more. A helix ends at the whole feed."""
    opening = Engagement(width=tool.diameter, depth=data.depth, share=1.0, at=FULL_WIDTH)
    if before is None or _larger(tool, before) <= 0.0:
        return opening
    width = min(settings.wall_distance + _larger(tool, before), tool.diameter)
    depth = min(LAYERS * before.data.depth, tool.flute_length)
    if width * depth * LEAST <= opening.width * opening.depth:
        return opening
    return Engagement(width=width, depth=depth, share=LEAST, at=LEFTOVERS)


def surface_leftovers(
    tool: Tool, data: CuttingData, settings: Any, before: Operation | None
) -> Engagement:
    """Return the whole cutter in what two faces that meet have left on them: how passes on a skin run into an inner edge."""
    return Engagement(
        width=tool.diameter, depth=BOTH_WALLS * data.depth, share=1.0, at=INNER_CORNER
    )


def corner_width(tool: Tool, width: float) -> float:
    """Return the mean width in mm over a diameter's way into a square corner between layers of a width in mm, at most the diameter.

    To the layer along the wall comes what the cutter's front takes of the other: half the segment of its circle that lies in the layer.
    """
    return min(width + 0.5 * segment(tool.radius, width) / tool.diameter, tool.diameter)


def step_width(before: Operation | None) -> float:
    """Return the mean width in mm of the steps that the rounded corner of a roughing cutter leaves on a wall, layer by layer.

    At a height z over a layer's bottom a corner of radius r leaves r - sqrt(r^2 - (r - z)^2), up to r; the mean is over a layer.
    """
    if before is None:
        return 0.0
    radius = before.cutter.corner_radius
    height = min(radius, before.data.depth)
    if height <= 0.0:
        return 0.0
    return (radius * height - 0.5 * segment(radius, height)) / before.data.depth


def segment(radius: float, height: float) -> float:
    """Return the area in mm2 of a circle's segment of a height (mm).

    >>> round(segment(10.0, 10.0), 3), segment(10.0, 0.0)
    (157.08, 0.0)
    """
    h = min(max(height, 0.0), 2.0 * radius)
    return radius**2 * math.acos(1.0 - h / radius) - (radius - h) * math.sqrt(
        h * (2.0 * radius - h)
    )


def _eased(tool: Tool, data: CuttingData, met: Engagement) -> Engagement:
    most = EASING_SLACK * slot_of_finish(tool, data) / max(data.depth, tolerance.SEW)
    return Engagement(
        width=min(met.width, most),
        depth=met.depth,
        share=met.share,
        at=met.at,
        slows=most < met.width,
    )


def _larger(tool: Tool, before: Operation | None) -> float:
    """Return by how much the radius of the cutter before is larger, in mm."""
    return max(before.cutter.radius - tool.radius, 0.0) if before is not None else 0.0
