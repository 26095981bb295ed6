"""Level lands of a part of curved surfaces, and where an end mill may be whose tip is at their height.

A land is cut flat, in plan. What the part has higher than a land is in the way of its end mill: the part's section just above it, and what
leans out over that.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass, field

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats, items_of
from trunnion.geometry.plane.plan_area import plan_area_above
from trunnion.geometry.plane.region import EMPTY_REGION, Region, union_all
from trunnion.model.operation import Operation
from trunnion.model.tool import Tool
from trunnion.plan.freeform.cutters.cutter import level_disc
from trunnion.plan.freeform.finishing.areas import connected
from trunnion.plan.freeform.keys import number
from trunnion.plan.freeform.space import SurfaceSpace
from trunnion.plan.prismatic.drive import DriveLevel, Floor, PlaneDrive
from trunnion.progress import NO_PROGRESS, Progress

SKIM = 2e-4
"""mm: how far above a land what is in the way is looked for. An end mill enters a fillet that begins on the land by no more than this,
and goes on over its rim by sqrt(2 R SKIM), less than a stepover of any ball."""
SIDE = 1.0
"""mm: what is higher than this over a land's rim is a side; a fillet that is still lower there is cut along by the rim as it comes."""
STEP = 2.0
"""mm: heights that shank and holder are kept off the part at go in such steps, always down: few sections serve many tools."""
NECK = 1.0
"""mm that an end mill keeps off unfinished sides that are higher than its flutes: in corners more is there than roughing's allowance,
and a neck does not cut."""
UNDER = math.sin(math.radians(0.01))
"""Part along -z of the normal from which on a triangle hangs over: 1 um in 6 mm."""
TOUCHING = 0.02
"""mm: a disc that is smaller by this is free wherever the cutter only touches what is beside it."""
HAIR = 0.02
"""mm: half the width up to which what is left along the rim of what is done is none."""
RIM_SPACING = 0.5
"""mm between the positions along a rim at which it is tested whether a cutter is free."""
LAND, REST_LAND = "land", "rest_land"
"""Kinds of operations on lands: with a large end mill, and with another one of what that left."""
STOCK, LATERAL, AROUND_TOOL, ABOVE_TOOL = (
    "surface.stock",
    "surface.beside",
    "surface.around",
    "surface.above",
)
"""Keys of the choices of operations on lands, mm: the stock that roughing left on them, and what `LandClearances` says."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Land:
    """Level faces at one height that hang together: their tags, the height in the cutting frame, and their area in plan."""

    tags: tuple[int, ...]
    z: float
    region: Region


@dataclass(frozen=True, slots=True, kw_only=True)
class LandClearances:
    """What an end mill keeps, in mm: `lateral` from sides of the part that are not finished yet, `around` shank and holder from the part
    all round, `above` them over it."""

    lateral: float
    around: float
    above: float


@dataclass(frozen=True, slots=True, eq=False)
class PartAbove:
    """What a part has above heights, in plan; each is found once, with looks at progress."""

    space: SurfaceSpace
    progress: Progress = NO_PROGRESS
    _found: dict[float, Region] = field(init=False, repr=False, default_factory=dict)

    def over(self, z: float) -> Region:
        """Return the plan area over which the part reaches higher than `z`."""
        if z not in self._found:
            if z >= float(self.space.skin.points[:, 2].max()):
                self._found[z] = EMPTY_REGION
            else:
                hanging = self.progress.aside(lambda _: self._hanging(z))
                self._found[z] = self.space.part.section(self.space.frame, z).union(hanging)
        return self._found[z]

    def _hanging(self, z: float) -> Region:
        """Return the shadow of what faces downwards above a height: together with the section there it is all that is above."""
        skin = self.space.skin
        corners = skin.points[skin.triangles[self._tops() > z]]
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        hangs = normal[:, 2] < -UNDER * np.linalg.norm(normal, axis=1)
        if not hangs.any():
            return EMPTY_REGION
        return plan_area_above(corners[hangs], z, 2.0 * skin.bound)

    def _tops(self) -> Floats:
        """Return how high (t,) the triangles of the skin reach."""
        first, second, third = self.space.skin.points[:, 2][self.space.skin.triangles].T
        return np.asarray(np.maximum(np.maximum(first, second), third))

    def _beside(self, z: float, within: Region | None, more: float) -> Region:
        """Return what the part has above a height, of the box around an area and some mm more alone where one is given."""
        if within is None:
            return self.over(z)
        low, high = within.box()
        low, high = low - more, high + more
        if not self._reaches(z, low, high):
            return EMPTY_REGION
        return self.over(z).intersect(Region.rectangle(*low.tolist(), *high.tolist()))

    def _reaches(self, z: float, low: Floats, high: Floats) -> bool:
        """Return whether any triangle reaches higher than a height in a box in plan with corners (2,): where none does the part is no
        higher, but for the bound of its triangles, for there is none of it without surface above."""
        skin = self.space.skin
        corners = skin.points[skin.triangles[self._tops() > z]][:, :, :2]
        inside = (corners.max(axis=1) >= low - skin.bound) & (
            corners.min(axis=1) <= high + skin.bound
        )
        return bool(inside.all(axis=1).any())

    def free(
        self,
        z: float,
        tool: Tool,
        clearances: LandClearances,
        within: Region | None = None,
    ) -> Region:
        """Return the plan area that the envelope of an end mill may be in, its tip at a height: what is in its way, and in that of shank
        and holder, is left out. It goes on past the blank.

        Where `within` is given it is not looked at outside the box around that, and what is higher by less than the bound of the part's
        triangles may be missed: enough to choose a tool by, not to move it."""
        obstacles = [self._beside(z + SKIM, within, 0.0)]
        if clearances.lateral > 0.0:
            lateral = clearances.lateral
            obstacles.append(self._beside(z + SIDE, within, lateral).offset(lateral))
        for z0, r0, _, r1 in tool.profile():
            more, height = (
                max(r0, r1) - tool.radius,
                z + max(SKIM, STEP * math.floor((z0 - clearances.above) / STEP)),
            )
            if more > -tolerance.COINCIDENT:
                grown = more + clearances.around
            elif clearances.lateral > 0.0:
                grown = max(NECK, clearances.lateral)
            else:
                continue
            obstacles.append(self._beside(height, within, grown).offset(grown))
        return self.space.around().minus(union_all(obstacles))


def lands_of(space: SurfaceSpace, tags: Collection[int]) -> tuple[Land, ...]:
    """Return the level lands among faces that look up, from the highest down."""
    graph, skin = space.part.graph(), space.skin
    level = [t for t in sorted(tags) if graph.surface[t - 1] == "plane" and _is_level(space, t)]
    found = []
    for mine in connected(level, graph):
        top = float(skin.points[skin.triangles[skin.of(mine)], 2].max())
        region = union_all([space.part.face_outline(space.frame, t) for t in mine])
        found.append(Land(tags=mine, z=top, region=region))
    return tuple(sorted(found, key=lambda land: (-land.z, land.tags)))


def _is_level(space: SurfaceSpace, tag: int) -> bool:
    up = space.frame.local_direction(space.part.graph().normal[tag - 1])[2]
    z = space.skin.points[space.skin.triangles[space.skin.face == tag], 2]
    return bool(up > np.cos(tolerance.ANGLE) and np.ptp(z) < tolerance.SLIVER)


def covered(land: Land, free: Region, tool: Tool) -> Region:
    """Return what of a land the flat of an end mill covers that stays in a free area."""
    axis_region = free.offset(-tool.radius)
    return (
        axis_region.offset(tool.radius - tool.corner_radius).intersect(land.region)
        if axis_region
        else EMPTY_REGION
    )


def is_free_of_part(
    part_above: PartAbove, land: Land, tool: Tool, progress: Progress = NO_PROGRESS
) -> bool:
    """Return whether the part, as triangles, is nowhere in the way of an end mill that comes right up to what is beside a land: a section
    that misses something would let it in."""
    space = part_above.space
    axis_region = (
        part_above.space.around()
        .minus(part_above.over(land.z + SKIM))
        .offset(-tool.radius)
        .intersect(land.region.offset(tool.radius))
    )
    if not axis_region:
        return True
    rim = axis_region.segments()
    count = np.maximum(np.ceil(rim.length / RIM_SPACING), 1.0).astype(np.int64)
    row, number = items_of(count)
    share = number / count[row]
    disc = level_disc(max(tool.radius - TOUCHING, 0.5 * tool.radius))
    progress.check()
    over = space.skin.drop.drop(
        rim.at(row, share * rim.length[row]),
        disc,
        float(space.low[2]) - 1.0,
        progress.part(1.0, 1.0),
    )
    return bool((over <= land.z + tolerance.FINISH_GOUGE + 2.0 * space.skin.bound).all())


def land_drive(
    operation: Operation,
    space: SurfaceSpace,
    before: Sequence[Operation],
    stock_top: float,
    progress: Progress = NO_PROGRESS,
) -> PlaneDrive:
    """Return the drive of an end mill on lands, from the highest down: of each what the operations `before` it left.

    Stock that is thicker than the operation's depth comes off in even steps.
    """
    part_above, clearances, tool = (
        PartAbove(space, progress),
        clearances_of(operation),
        operation.cutter,
    )
    stock = number(operation, STOCK)
    steps = (
        max(1, math.ceil(stock / operation.data.depth - tolerance.COINCIDENT))
        if operation.data.depth > 0.0
        else 1
    )
    levels: list[DriveLevel] = []
    floors: list[Floor] = []
    for lands in progress.each(_together(lands_of(space, operation.faces))):
        z = min(land.z for land in lands)
        wanted = [remaining_of(part_above, land, before) for land in lands]
        levels.append(
            DriveLevel(
                top=levels[-1].bottom if levels else max(stock_top, z),
                bottom=z,
                wanted=union_all(wanted),
                boundary=part_above.free(z, tool, clearances),
            )
        )
        floors += [
            Floor(z=land.z + stock * n / steps, region=region, fillet=0.0, face=land.tags[0])
            for land, region in zip(lands, wanted, strict=True)
            if region
            for n in reversed(range(steps))
        ]
    return PlaneDrive(
        feature=operation.feature,
        kind=operation.kind,
        levels=tuple(levels),
        floors=tuple(floors),
        stock_top=stock_top,
        faces=operation.faces,
    )


def remaining_of(part_above: PartAbove, land: Land, before: Sequence[Operation]) -> Region:
    """Return what operations on a land leave of it: but for hairs along their rims all of it where there are none."""
    remaining = land.region
    for operation in before:
        if set(operation.faces) & set(land.tags):
            remaining = without(
                remaining,
                covered(
                    land,
                    part_above.free(land.z, operation.cutter, clearances_of(operation)),
                    operation.cutter,
                ),
            )
    return remaining


def without(region: Region, done: Region) -> Region:
    """Return what is left of a region, without hairs along the rims of what is done."""
    return region.minus(done).opened(HAIR) if done else region


def clearances_of(operation: Operation) -> LandClearances:
    """Return what an operation on lands keeps, from its choices."""
    lateral, around, above = (number(operation, key) for key in (LATERAL, AROUND_TOOL, ABOVE_TOOL))
    return LandClearances(lateral=lateral, around=around, above=above)


def _together(lands: Sequence[Land]) -> list[list[Land]]:
    """Return lands, from the highest down, in sets whose heights strategies take for one."""
    found: list[list[Land]] = []
    for land in lands:
        if found and found[-1][0].z - land.z <= tolerance.SEW:
            found[-1].append(land)
        else:
            found.append([land])
    return found
