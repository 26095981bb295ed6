"""Mills holes: helices round the axis, ring by ring from the middle outwards, each down to the bottom and once round there."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from trunnion import tolerance
from trunnion.findings import Finding, remark, warning
from trunnion.geometry.arrays import Floats
from trunnion.model.motion.toolpath import Mark
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.holes.drive import HoleDrive
from trunnion.plan.holes.hole import PlannedHole
from trunnion.progress import Progress
from trunnion.settings import setting, settings
from trunnion.toolpath.contract import Planned, strategy
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.choices import safety
from trunnion.toolpath.motion.feed import arc_feed
from trunnion.toolpath.motion.hole_access import kept_off
from trunnion.toolpath.motion.link import top_under, travel
from trunnion.toolpath.motion.load.engagement import full_width
from trunnion.toolpath.motion.tour import short_tour
from trunnion.toolpath.offsetting import choices
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.units import trimmed

WIDEST_FIRST = 0.9
"""Of the cutter's flat radius: a wider first ring would leave a post in the middle."""
GAP = 0.3
"""mm above the material where a helix begins."""
ASIDE = 0.5
"""Of the way to the axis that the cutter leaves the wall by before it is lifted."""
SMALLEST_RING = 1e-2
"""mm: a cutter that has less room to go round goes straight down instead."""


@settings("hole.mill")
class MillSettings:
    """How holes are milled. Width and depth of cut come with the cutting data."""

    ramp_angle: float = choices.ramp_angle(3.0, "Slope of the helix into full material.")
    slot_feed: float = choices.slot_feed(
        0.6, "Share of the feed in the first ring, which is cut at full width."
    )
    breakthrough: float = setting(
        0.5,
        unit="mm",
        low=0.0,
        high=20.0,
        label="Breakthrough",
        help="How far the cutter goes on past the end of a through hole.",
    )
    allowance: float = setting(
        0.0,
        unit="mm",
        low=0.0,
        high=5.0,
        label="Allowance",
        help="What is left on the side of the bore, for a reamer that comes after.",
    )
    safety: float = safety()


@strategy(
    settings=MillSettings,
    drive=HoleDrive,
    settles=("hole.floor",),
    meets=full_width,
    own_faces=True,
)
def mill(
    drive: HoleDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    settings: MillSettings,
    progress: Progress,
) -> Planned:
    """Return the helices that mill holes, and which holes the cutter can't get into."""
    builder = PathBuilder(tool, data, stock, setup, settings.safety)
    findings: list[Finding] = []
    order = short_tour(np.array([h.position for h in drive.holes]), progress)
    for row in progress.each(order):
        hole = drive.holes[row]
        hole = replace(hole, diameter=hole.diameter - 2.0 * settings.allowance)
        widest = hole.radius - tool.radius
        z = _bottom(hole, tool, settings.breakthrough)
        stopped = _too_wide(hole, tool) or kept_off(builder, hole, z, max(widest, 0.0))
        if stopped is not None:
            findings.append(stopped)
            continue
        top = max(hole.top, top_under(builder, hole.position, widest))
        for number, radius in enumerate(ring_radii(hole, tool, data.width)):
            _ring(builder, hole.position, radius, top, z, number == 0, settings)
        findings += _left(hole)
    return Planned(path=builder.finished(), findings=tuple(findings))


def ring_radii(hole: PlannedHole, tool: Tool, width: float) -> list[float]:
    """Return the radii of the rings of a hole in mm, the last one at its wall; each takes at most a width more than the one before.

    The first covers the axis, or what is free around it already.
    """
    last = max(hole.radius - tool.radius, 0.0)
    first = WIDEST_FIRST * max(tool.radius - tool.corner_radius, 0.5 * tool.radius)
    first = min(max(first, 0.5 * hole.core + width - tool.radius), last)
    steps = max(math.ceil((last - first) / width - tolerance.COINCIDENT), 0)
    return [first + (last - first) * k / steps for k in range(steps)] + [last]


def _bottom(hole: PlannedHole, tool: Tool, breakthrough: float) -> float:
    """Return how deep the tip goes."""
    return hole.bottom - (breakthrough + tool.corner_radius if hole.through else 0.0)


def _ring(
    builder: PathBuilder,
    centre: Floats,
    radius: float,
    top: float,
    z: float,
    full: bool,
    settings: MillSettings,
) -> None:
    """Go down round the axis anticlockwise, which climbs, then once round at the bottom, and leave the wall towards the axis."""
    tool, data = builder.tool, builder.data
    begin = max(top, z) + GAP
    feed = data.feed * (settings.slot_feed * data.slot_share if full else 1.0)
    if radius < SMALLEST_RING:
        travel(builder, centre, begin)
        builder.line((*centre, z), data.plunge_feed, Mark.ENTRY)
        return
    pitch = min(math.tau * radius * math.tan(math.radians(settings.ramp_angle)), data.depth)
    halves = 2 * max(1, math.ceil((begin - z) / pitch - tolerance.COINCIDENT))
    sides = [centre + np.array([side * radius, 0.0]) for side in (1.0, -1.0)]
    travel(builder, sides[0], begin)
    round_feed = arc_feed(feed, radius, tool.radius, math.pi)
    for n in range(1, halves + 1):
        height = begin - (begin - z) * n / halves
        builder.arc((*sides[n % 2], height), centre, math.pi, round_feed, Mark.ENTRY)
    for side in (sides[1], sides[0]):
        builder.arc((*side, z), centre, math.pi, round_feed, Mark.CUT)
    away = sides[0] + ASIDE * (centre - sides[0])
    builder.line((*away, z), data.feed, Mark.LEAD)


def _too_wide(hole: PlannedHole, tool: Tool) -> Finding | None:
    if tool.radius <= hole.radius + tolerance.COINCIDENT:
        return None
    return warning(
        "hole.too-narrow",
        f"{hole.feature} is not cut: {tool.name} is wider than its {trimmed(hole.diameter, 3)} mm",
        hole.feature,
        remedy="choose a smaller cutter",
    )


def _left(hole: PlannedHole) -> list[Finding]:
    """Return what is to be said of the cone that a cutter leaves at the bottom of a blind hole: all of it, or what is around a drill that
    was there before."""
    ring = hole.radius - 0.5 * hole.core
    if hole.through or hole.is_flat or ring <= SMALLEST_RING:
        return []
    left = "is left" if hole.core <= 0.0 else f"is left in a ring {trimmed(ring, 2)} mm wide"
    deep = hole.point_length if hole.core <= 0.0 else hole.point_length * ring / hole.radius
    return [
        remark(
            "hole.point",
            f"{hole.feature}: the cone of {trimmed(hole.point_angle, 1)} degrees at its bottom {left}, "
            f"{trimmed(deep, 2)} mm deep",
            hole.feature,
            remedy="drill its middle with that point before, or accept it",
        )
    ]
