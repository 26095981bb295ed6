"""Which cutter for what: the candidates that fit a requirement, and a small set of cutters that serves many requirements."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from trunnion import tolerance
from trunnion.geometry.plane.region import Region
from trunnion.model.tool import Tool
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.units import trimmed

CUSP_SPREAD = 1.1
"""What a cutter leaves in sharp edges over the square of its radius, over the same of the smallest: 1 between straight walls."""


SLENDER = 7.5
"""Stickout over diameter from which on a cutter is for what no shorter one of its size reaches, and saves no tool change elsewhere."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ToolRequirement:
    """What a cutter is wanted for.

    `depth`: how far below the highest surroundings its tip goes; `envelope_area`: the plane area its envelope must keep in; `wanted`: what
    it should cover there (the envelope's area itself when empty). `corner_radius`: largest corner radius that leaves no material at the
    foot;
    `exact`: the corner radius has to be that one. `radius`: largest radius of the cutter (0: no bound). `missable`: share of the wanted
    area that may be left to smaller cutters. `spare`: how many of its radii must fit from rim to middle where that area is widest, so
    that it can enter and turn. `keep`: for floors, the distance from the finished walls beside the fillet's own; then it is the cutter's
    flat that has to cover what is wanted (below 0: the whole disc). `near`: how much smaller than the largest candidate a cutter may be,
    as a share of its diameter, to be chosen because it serves other requirements too. `cusps`: only what stays in sharp inner edges may be
    missed, where no cutter gets; a passage that smaller cutters get through may not. `others`: further pairs of an
    envelope's area and what is wanted in it, at other heights, that the same cutter has to serve.
    """

    depth: float
    envelope_area: Region
    wanted: Region
    corner_radius: float
    exact: bool = False
    radius: float = 0.0
    missable: float = 0.0
    spare: float = 1.0
    keep: float = -1.0
    near: float = 0.5
    cusps: bool = False
    others: tuple[tuple[Region, Region], ...] = ()

    def each(self) -> tuple[ToolRequirement, ...]:
        """Return a requirement for each of its areas."""
        alone = replace(self, others=())
        return (
            alone,
            *(replace(alone, envelope_area=area, wanted=wanted) for area, wanted in self.others),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Candidates:
    """The cutters that fit a requirement, largest first, or in words why none does; `hindered`: there are some, but what stands around
    keeps them away."""

    tools: tuple[Tool, ...]
    reason: str = ""
    remedy: str = ""
    hindered: bool = False


def candidates(
    requirement: ToolRequirement,
    tools: Sequence[Tool],
    clearance: float,
    progress: Progress = NO_PROGRESS,
) -> Candidates:
    """Return the cutters that fit a requirement; each test that leaves none says what would be needed."""
    if not tools:
        return Candidates(
            tools=(),
            reason="there is no cutter to choose from for this material",
            remedy="add cutters to the tools folder",
        )
    small = [
        t
        for t in tools
        if not requirement.radius or t.radius <= requirement.radius + tolerance.COINCIDENT
    ]
    if not small:
        smallest = min(t.diameter for t in tools)
        return Candidates(
            tools=(),
            remedy="add a smaller cutter to the tools folder, or machine the feature by other means",
            reason=f"no tool is small enough: at most D {trimmed(2 * requirement.radius, 3)} fits, "
            f"the smallest is D {trimmed(smallest, 3)}",
        )
    foot = [t for t in small if t.corner_radius <= requirement.corner_radius + tolerance.COINCIDENT]
    if requirement.exact:
        foot = [
            t
            for t in foot
            if abs(t.corner_radius - requirement.corner_radius) <= tolerance.COINCIDENT
        ]
    if not foot:
        return Candidates(
            tools=(),
            remedy="add a cutter with this corner radius to the tools folder",
            reason=f"no cutter up to D {trimmed(2 * max(t.radius for t in small), 3)} has a corner radius "
            f"{'of' if requirement.exact else 'up to'} {trimmed(requirement.corner_radius, 3)} mm",
        )
    deep = [t for t in foot if depth_reached(t) >= requirement.depth + clearance]
    if not deep:
        return Candidates(
            tools=(),
            remedy="add a longer cutter to the tools folder, or allow a larger one by a larger corner radius",
            reason=f"no tool reaches {trimmed(requirement.depth, 2)} mm deep with {trimmed(clearance, 2)} mm clearance; "
            f"the longest that fits reaches {trimmed(max(depth_reached(t) for t in foot), 2)} mm",
        )
    inside = (
        _fitting(requirement, deep, progress)
        if requirement.keep < 0.0
        else _fitting_floor(requirement, deep, progress)
    )
    if not inside:
        return Candidates(
            tools=(),
            remedy="add a smaller cutter to the tools folder, or machine the feature by other means",
            reason=f"no tool is small enough: the smallest that reaches is D {trimmed(min(t.diameter for t in deep), 3)}",
        )
    largest = max(t.diameter for t in inside)
    near = [t for t in without_slender(inside) if t.diameter >= requirement.near * largest]
    return Candidates(
        tools=tuple(
            sorted(near, key=lambda t: (-t.diameter, depth_reached(t), -t.corner_radius, t.name))
        )
    )


def without_slender(tools: Sequence[Tool]) -> list[Tool]:
    """Return cutters without the slender ones that a shorter one of their diameter and corner radius stands in for."""
    shortest: dict[tuple[float, float], float] = {}
    for tool in tools:
        size = tool.diameter, tool.corner_radius
        shortest[size] = min(shortest.get(size, tool.stickout), tool.stickout)
    return [
        t
        for t in tools
        if t.stickout <= max(SLENDER * t.diameter, shortest[t.diameter, t.corner_radius])
    ]


def depth_reached(tool: Tool) -> float:
    """Return how deep a cutter goes before its shank, thick as itself, or its holder comes to the rim."""
    return min(tool.neck_length, tool.stickout)


def _fitting(requirement: ToolRequirement, tools: Sequence[Tool], progress: Progress) -> list[Tool]:
    """Return the cutters that cover what is wanted without leaving the envelope's area, but for the share that may be missed.

    Where one fits, so do all smaller ones: the largest is looked for.
    """
    areas = [(area, _missable(area, tools)) for area in requirement.each()]
    for tool in progress.each(sorted(tools, key=lambda t: -t.diameter)):
        if requirement.spare > 1.0 and not requirement.envelope_area.offset(
            -requirement.spare * tool.radius
        ):
            continue
        if all(_missed_area(area, tool) <= most(tool) for area, most in areas):
            return [t for t in tools if t.diameter <= tool.diameter]
    return []


def fits_through(requirement: ToolRequirement, tool: Tool, tools: Sequence[Tool]) -> bool:
    """Return whether a cutter covers what is wanted, but for what may be missed, as well as the others of the catalogue would."""
    return all(
        _missed_area(area, tool) <= _missable(area, tools)(tool) for area in requirement.each()
    )


def _missed_area(requirement: ToolRequirement, tool: Tool) -> float:
    """Return the area of what is wanted that a cutter doesn't cover."""
    wanted, covered = requirement.wanted or requirement.envelope_area, _covered(requirement, tool)
    return wanted.minus(covered).area if covered else wanted.area


def _missable(requirement: ToolRequirement, tools: Sequence[Tool]) -> Callable[[Tool], float]:
    """Return the area that each cutter may leave: in sharp edges it grows with the square of the cutter's radius."""
    total = (requirement.wanted or requirement.envelope_area).area
    most, slack = requirement.missable * total, tolerance.AREA * max(total, 1.0)
    if not requirement.cusps:
        return lambda tool: most + slack
    smallest = min(tools, key=lambda t: t.diameter)
    cusps = CUSP_SPREAD * _missed_area(requirement, smallest)
    return lambda tool: min(most, cusps * (tool.radius / smallest.radius) ** 2) + slack


def _fitting_floor(
    requirement: ToolRequirement, tools: Sequence[Tool], progress: Progress
) -> list[Tool]:
    """Return the same for a floor, among sharp cutters and those with the largest corner radius: each radius has a flat of its own."""
    radii = {min(t.corner_radius for t in tools), max(t.corner_radius for t in tools)}
    return [
        t
        for radius in sorted(radii)
        for t in _fitting(requirement, [t for t in tools if t.corner_radius == radius], progress)
    ]


def _covered(requirement: ToolRequirement, tool: Tool) -> Region:
    """Return what a cutter reaches: its disc in the envelope's area, or for a floor its flat, kept off the walls and their fillet."""
    if requirement.keep < 0.0:
        return requirement.envelope_area.opened(tool.radius)
    flat = tool.radius - tool.corner_radius
    return requirement.envelope_area.offset(
        -(requirement.keep + requirement.corner_radius + flat)
    ).offset(flat)


def covered_by_few(
    fits: Mapping[str, Sequence[Tool]], kept: Sequence[Tool] = ()
) -> dict[str, Tool]:
    """Return a cutter for every requirement, few cutters in all: first those that are in use anyhow,
    then always the one that serves most requirements.

    Among cutters that serve equally many the larger, then the shorter, then the one with the larger corner radius is taken.
    """
    assigned: dict[str, Tool] = {}
    for requirement, tools in fits.items():
        own = [t for t in tools if any(t.name == k.name for k in kept)]
        if own:
            assigned[requirement] = own[0]
    remaining = {
        requirement: tools
        for requirement, tools in fits.items()
        if requirement not in assigned and tools
    }
    while remaining:
        served: dict[str, int] = {}
        named: dict[str, Tool] = {}
        for tools in remaining.values():
            for tool in tools:
                served[tool.name] = served.get(tool.name, 0) + 1
                named[tool.name] = tool
        best = min(
            named.values(),
            key=lambda t: (
                -served[t.name],
                -t.diameter,
                depth_reached(t),
                -t.corner_radius,
                t.name,
            ),
        )
        for requirement in [
            requirement
            for requirement, tools in remaining.items()
            if any(t.name == best.name for t in tools)
        ]:
            assigned[requirement] = best
            del remaining[requirement]
    return assigned
