"""Which tools fit holes: by diameter, by the length of their flutes, and by what stands around the hole when they are deepest.

Above its flutes a drill grows wider: neck, shank, holder. Each of these rings must have its clearance from the part at the height where it
is then: a hole at the foot of a wall needs a drill that is longer than the wall is high, one in the open needs no more than its flutes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from trunnion import tolerance
from trunnion.geometry.plane.region import Region
from trunnion.model.tool import Tool
from trunnion.plan.holes.axis_clearance import AxisClearance, SkinGroups
from trunnion.plan.holes.hole import Countersink, PlannedHole
from trunnion.plan.prismatic.regions import SetupSpace
from trunnion.plan.tool_choice import Candidates, depth_reached
from trunnion.shop import Shop
from trunnion.units import trimmed

CHIP_SPACE = 0.5
"""Of the diameter: how much of the flutes stays over a hole's mouth, so that chips get out."""
AROUND = 60.0
"""mm: how far around a hole the part is looked at; holders are less wide."""
NEAR_MILL = 0.5
"""How much smaller than the largest end mill that fits one may be, over its diameter, when it serves other operations too."""
LARGEST_MILL = 0.8
"""Of a hole's diameter: a wider end mill has no room to go round in."""


SAME_ANGLE = 0.5
"""Degrees: a tool's cone whose angle differs by less from a hole's has that angle."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ToolCone:
    """The cone at a tool's end: its `angle` in degrees over both sides, and its diameters mm at the tip (`narrow`) and where it ends."""

    angle: float
    narrow: float
    wide: float


def cone_of(tool: Tool) -> ToolCone | None:
    """Return the cone that a form tool begins with, None where it begins with none."""
    if tool.form != "form" or tool.outline[0][2] != 0.0:
        return None
    (r0, z0, _), (r1, z1, _) = tool.outline[:2]
    if r1 <= r0 or z1 <= z0:
        return None
    angle = math.degrees(2.0 * math.atan2(r1 - r0, z1 - z0))
    return ToolCone(angle=angle, narrow=2.0 * r0, wide=2.0 * r1)


def sink_tip(hole: PlannedHole, sink: Countersink, cone: ToolCone) -> float:
    """Return how deep the tip of a countersink's tool goes: its cone is as wide at the hole's mouth as the countersink."""
    return hole.top - 0.5 * (sink.diameter - cone.narrow) / math.tan(math.radians(0.5 * sink.angle))


@dataclass(slots=True, kw_only=True)
class HoleSpace:
    """What stands around holes in a setup, `clearance` mm over which shank and holder stay; sections are made once a height.

    Where `groups` of a skin are given, in the part's coordinates, its triangles answer all that is not within their error: sections cost a
    part with many directions of holes most of its planning.
    """

    space: SetupSpace
    clearance: float
    groups: SkinGroups | None = None
    _free: dict[tuple[float, float, float], float] = field(default_factory=dict)
    _nearest: tuple[tuple[float, float], AxisClearance] | None = None

    def free_radius(self, hole: PlannedHole, z: float) -> float:
        """Return how far the part is from a hole's axis at a height, with all that hangs over it; infinite over the part."""
        if z >= self.space.top:
            return math.inf
        key = (round(hole.x, 6), round(hole.y, 6), round(z, 6))
        if key not in self._free:
            material = self.space.material_over(z, Region.circle(hole.position, AROUND))
            away = -float(material.signed_distance(hole.position[None])[0]) if material else AROUND
            self._free[key] = away
        return self._free[key]

    def is_free(self, hole: PlannedHole, z: float, radius: float) -> bool:
        """Return whether the part is no nearer to a hole's axis than a radius (mm), at a height and over it."""
        if self.groups is not None:
            least, most = self._triangles_near(self.groups, hole).distance_from(z)
            if least >= radius or most < radius:
                return least >= radius
        return self.free_radius(hole, z) >= radius

    def _triangles_near(self, groups: SkinGroups, hole: PlannedHole) -> AxisClearance:
        """Return the triangles near a hole; those of the last hole are kept."""
        if self._nearest is None or self._nearest[0] != (hole.x, hole.y):
            bound = max(groups.skin.bound, tolerance.CHORD)
            frame = self.space.setup.frame
            self._nearest = (
                (hole.x, hole.y),
                AxisClearance.near(groups, bound, frame, hole.position, AROUND),
            )
        return self._nearest[1]

    def is_open(self, hole: PlannedHole) -> bool:
        """Return whether nothing of the part covers a hole's mouth."""
        return self.is_free(hole, hole.top + tolerance.OFF_PLANE, hole.radius - tolerance.SEW)

    def has_space(self, hole: PlannedHole, tool: Tool, tip: float, aside: float = 0.0) -> bool:
        """Return whether all above a tool's flutes keeps clear of the part, its tip at a height, its axis up to `aside` mm off the
        hole's."""
        for above, radius in tool.rings()[1:]:
            z = tip + above - self.clearance
            if not self.is_free(hole, z, radius + aside + tolerance.HOLDER_CLEARANCE):
                return False
        return True


def tip_of(hole: PlannedHole, tool: Tool, breakthrough: float) -> float:
    """Return how deep a drill's tip goes in a hole, mm in the setup's frame.

    Through holes: the full diameter goes on past the end. Blind holes: as deep as neither the tip nor the edge of the drill's full
    diameter leaves the hole's own cone, or goes below its floor. A drill of the hole's diameter ends where that does, or with its tip at
    the cone's; a thinner one with that point goes on down to the tip of the cone.
    """
    if hole.through:
        return hole.bottom - breakthrough - tool.point_length
    # How high over the cone's tip the hole is as wide as the drill.
    narrow = hole.point_length * min(tool.radius / hole.radius, 1.0)
    return hole.bottom - hole.point_length + max(narrow - tool.point_length, 0.0)


def drills_for(
    hole: PlannedHole,
    tools: Sequence[Tool],
    around: HoleSpace,
    diameter_tolerance: float,
    breakthrough: float,
) -> Candidates:
    """Return the drills that fit a hole, the best first; each test that leaves none says what would be needed.

    The best has the hole's own point, then the least difference in diameter, then it is the shortest. A drill wider than the hole by more
    than half of what the proof lets enter the part is none.
    """
    size = trimmed(hole.diameter, 3)
    fits = [
        t
        for t in tools
        if abs(t.diameter - hole.diameter) <= diameter_tolerance + tolerance.COINCIDENT
        and t.radius - hole.radius <= 0.5 * tolerance.GOUGE + tolerance.COINCIDENT
    ]
    if not fits:
        return Candidates(
            tools=(),
            reason=f"the catalogue has no drill of D {size}",
            remedy=f"add a drill of D {size} to the tools folder",
        )
    tips = {t.name: tip_of(hole, t, breakthrough) for t in fits}
    long = [t for t in fits if t.flute_length >= hole.top - tips[t.name] + CHIP_SPACE * t.diameter]
    if not long:
        need = min(hole.top - tips[t.name] + CHIP_SPACE * t.diameter for t in fits)
        return Candidates(
            tools=(),
            reason=f"no drill of D {size} has flutes of {trimmed(need, 1)} mm; the longest are "
            f"{trimmed(max(t.flute_length for t in fits), 1)} mm",
            remedy=f"add a longer drill of D {size} to the tools folder",
        )
    free = [t for t in long if around.has_space(hole, t, tips[t.name])]
    if not free:
        return Candidates(
            tools=(),
            reason=f"shank or holder of every drill of D {size} would come too near to what stands around it",
            remedy=f"add a longer drill of D {size} to the tools folder, or drill before what stands there is left",
            hindered=True,
        )
    # A point of its own is what a blind hole asks for, before all that would save a tool.
    own = [t for t in free if abs(t.point_angle - hole.point_angle) <= SAME_ANGLE]
    fitting = free if hole.through or not own else own
    return Candidates(tools=tuple(sorted(fitting, key=_order_of(hole))))


def pilots_for(
    hole: PlannedHole,
    widest: float,
    tools: Sequence[Tool],
    around: HoleSpace,
    breakthrough: float,
) -> Candidates:
    """Return the drills, at most as wide as that (mm), that leave the cone of a blind hole which is milled after them, the thickest first:
    those with its point that are long enough; none for a hole that has no cone."""
    if hole.through or hole.is_flat:
        return Candidates(tools=())
    tips = {t.name: tip_of(hole, t, breakthrough) for t in tools}
    found = [
        t
        for t in tools
        if t.diameter <= widest + tolerance.COINCIDENT
        and abs(t.point_angle - hole.point_angle) <= SAME_ANGLE
        and t.flute_length >= hole.top - tips[t.name] + CHIP_SPACE * t.diameter
        and around.has_space(hole, t, tips[t.name])
    ]
    thickest = max((t.diameter for t in found), default=0.0)
    return Candidates(
        tools=tuple(
            sorted(
                (t for t in found if t.diameter >= thickest - tolerance.COINCIDENT),
                key=lambda t: (t.stickout, t.name),
            )
        )
    )


def mills_of(
    shop: Shop,
    iso_group: str,
    hole: PlannedHole,
    around: HoleSpace,
    top: float,
    breakthrough: float,
) -> Candidates:
    """Return the catalogue's end mills for a group of materials that mill a hole (`mills_for`): the small ones for holes alone only where
    no other does."""
    others, small = (shop.tools_for(iso_group, use) for use in ("finish", "hole_mill"))
    found = mills_for(hole, others, around, top, breakthrough)
    return found if found.tools else mills_for(hole, (*others, *small), around, top, breakthrough)


def mills_for(
    hole: PlannedHole, tools: Sequence[Tool], around: HoleSpace, top: float, breakthrough: float
) -> Candidates:
    """Return the flat end mills that mill a hole, the largest first; each test that leaves none says what would be needed.

    `top` is the height from which the cutter goes down in the hole: the mouth of all of it, where `hole` is its floor alone.
    """
    size = trimmed(hole.diameter, 3)
    tip = hole.bottom - (breakthrough if hole.through else 0.0)
    small = [t for t in tools if t.form == "flat" and t.diameter <= LARGEST_MILL * hole.diameter]
    if not small:
        return Candidates(
            tools=(),
            reason=f"no end mill is small enough for D {size}",
            remedy=f"add an end mill up to D {trimmed(LARGEST_MILL * hole.diameter, 2)} to the tools folder",
        )
    long = [t for t in small if depth_reached(t) >= top - tip + around.clearance]
    if not long:
        return Candidates(
            tools=(),
            reason=f"no end mill that gets into D {size} reaches {trimmed(top - tip, 1)} mm deep",
            remedy=f"add a longer end mill up to D {trimmed(LARGEST_MILL * hole.diameter, 2)} to the tools folder",
        )
    free = [t for t in long if around.has_space(hole, t, tip, hole.radius - t.radius)]
    if not free:
        return Candidates(
            tools=(),
            reason=f"the holder of every end mill for D {size} would come too near to what stands around it",
            remedy="add a longer end mill to the tools folder",
        )
    largest = max(t.diameter for t in free)
    near = [t for t in free if t.diameter >= NEAR_MILL * largest]
    return Candidates(
        tools=tuple(sorted(near, key=lambda t: (-t.diameter, depth_reached(t), t.name)))
    )


def either(drills: Candidates, mills: Candidates) -> Candidates:
    """Return the drills of a hole, or why neither a drill nor an end mill fits it."""
    if drills.tools or not mills.reason:
        return drills
    return Candidates(
        tools=(),
        reason=f"{drills.reason}; {mills.reason}",
        remedy=f"{drills.remedy}, or {mills.remedy}",
    )


def sinks_for(
    hole: PlannedHole, sink: Countersink, tools: Sequence[Tool], around: HoleSpace
) -> Candidates:
    """Return the tools that make a hole's countersink, the narrowest first; each test that leaves none says what would be needed."""
    size = f"{trimmed(sink.angle, 1)} degrees"
    cones = [(t, cone) for t in tools if (cone := cone_of(t)) is not None]
    same = [(t, c) for t, c in cones if abs(c.angle - sink.angle) <= SAME_ANGLE]
    wide = [
        (t, c)
        for t, c in same
        if c.wide >= sink.diameter - tolerance.COINCIDENT
        and c.narrow <= hole.diameter + tolerance.COINCIDENT
    ]
    if not wide:
        return Candidates(
            tools=(),
            reason=f"the catalogue has no countersink of {size}"
            + (f" that is {trimmed(sink.diameter, 3)} mm wide" if same else ""),
            remedy=f"add a countersink of {size}, at least D {trimmed(sink.diameter, 3)}, to the tools folder",
        )
    free = []
    for tool, cone in wide:
        tip = sink_tip(hole, sink, cone)
        ends = hole.through or tip >= hole.bottom
        # Of what is wider than the cone at the mouth all stands over it.
        if ends and around.has_space(hole, tool, tip) and _rim_is_free(hole, tool, around):
            free.append(tool)
    if not free:
        return Candidates(
            tools=(),
            reason=f"every countersink of {size} would touch what stands around the hole or its bottom",
            remedy="add a slimmer countersink to the tools folder",
        )
    return Candidates(tools=tuple(sorted(free, key=lambda t: (t.diameter, t.stickout, t.name))))


def _rim_is_free(hole: PlannedHole, tool: Tool, around: HoleSpace) -> bool:
    """Return whether the part leaves space for a tool's whole diameter just over a hole's mouth."""
    return around.is_free(hole, hole.top + tolerance.OFF_PLANE, tool.radius)


def _order_of(hole: PlannedHole) -> Callable[[Tool], tuple[float, float, float, str]]:
    def order(tool: Tool) -> tuple[float, float, float, str]:
        other_point = 0.0 if hole.through else abs(tool.point_angle - hole.point_angle)
        return (other_point, abs(tool.diameter - hole.diameter), tool.stickout, tool.name)

    return order
