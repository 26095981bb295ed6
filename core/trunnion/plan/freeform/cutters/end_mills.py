"""The end mills of level lands: for each the largest that covers nearly what any does, and one for what that leaves; few in all."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools
from trunnion.geometry.plane.region import EMPTY_REGION, Region
from trunnion.model.tool import Tool
from trunnion.plan.freeform.lands import (
    SIDE,
    SKIM,
    Land,
    LandClearances,
    PartAbove,
    covered,
    is_free_of_part,
    without,
)
from trunnion.plan.freeform.reach import AreaSamples
from trunnion.plan.freeform.wall_curves import VERTICAL
from trunnion.plan.tool_choice import covered_by_few, depth_reached, without_slender
from trunnion.progress import Progress

MOST = 0.9
"""Share of a land that end mills must cover: of less they would leave too much for another way of cutting it."""
HALF = 0.5
"""Share of a land that an end mill must cover off its sides: else it is a slot, with sides all over."""
WORTH = 100.0
"""mm2: a ball finishes a smaller land in the time of a tool change."""
WORTH_REMAINING = 4.0
"""mm2: where balls leave more of a small land than this it is worth an end mill all the same."""
MISSED = 1.0
"""mm2 that the end mill of a land may leave without another one for it."""
NEAR = 0.5
"""Least diameter over the largest possible of an end mill that is taken because it serves other lands too."""
FOOT = 0.5
"""Of the diameter: how high an end mill's flank finishes upright sides while it cuts what is left at their feet."""
BEFORE = 0.05
"""mm before a side where the land must be covered for the side itself to be touched."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LandCutters:
    """The end mill of a land, another one for what that leaves (None: nothing worth it), and what of the land no end mill reaches.

    `flanks`: where their flats come right up to sides, and how high over the land (mm) their flanks then finish an upright one.
    """

    land: Land
    tool: Tool
    rest: Tool | None
    remaining: Region
    flanks: tuple[tuple[Region, float], ...]

    def finishes(self, samples: AreaSamples) -> Bools:
        """Return which samples (k,) lie on the foot of an upright side, which the end mills finish while they cut the land beside it."""
        found = np.zeros(len(samples), dtype=bool)
        upright = np.abs(samples.normal[:, 2]) < VERTICAL
        for region, height in self.flanks:
            above = samples.point[:, 2] - self.land.z
            rows = np.flatnonzero(upright & (above > -tolerance.SLIVER) & (above <= height))
            found[rows] |= region.contains(
                samples.point[rows, :2] + BEFORE * samples.normal[rows, :2]
            )
        return found


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Reach:
    """What of a land end mills cover, by their names: off sides that are not finished yet, and right up to them."""

    land: Land
    before: dict[str, Region]
    after: dict[str, Region]

    @staticmethod
    def of(
        part_above: PartAbove,
        land: Land,
        tools: Sequence[Tool],
        clearances: LandClearances,
        progress: Progress,
    ) -> _Reach:
        """Return what tools cover of a land."""
        before, after = (
            {
                t.name: covered(land, part_above.free(land.z, t, kept), t)
                for t in progress.each(tools)
            }
            for kept in (clearances, replace(clearances, lateral=0.0))
        )
        return _Reach(land=land, before=before, after=after)

    def missed(self, tool: Tool) -> Region:
        """Return what an end mill leaves while it keeps off sides."""
        return without(self.land.region, self.before[tool.name])


def end_mills_for(
    part_above: PartAbove,
    lands: Sequence[Land],
    tools: Sequence[Tool],
    ball: float,
    share: float,
    clearances: LandClearances,
    kept: Sequence[Tool],
    progress: Progress,
) -> tuple[LandCutters, ...]:
    """Return the lands that are worth an end mill, and small ones that the cutters of these finish as well, with their cutters.

    `ball`: radius of the smallest ball that would finish them instead; `kept`: cutters that are in use anyhow.
    """
    ranked = sorted(
        (t for t in tools if t.form in ("flat", "bull")),
        key=lambda t: (-t.diameter, t.corner_radius, depth_reached(t), t.name),
    )
    reach: dict[str, _Reach] = {}
    for n, land in enumerate(lands):
        progress.at(n / max(len(lands), 1), f"end mill for the land at {land.z:.2f}")
        if ranked and _may_cover(part_above, land, ranked):
            reach[str(n)] = _Reach.of(part_above, land, ranked, clearances, progress)
    progress.at(1.0, "end mills for all lands")
    fits = {
        key: without_slender(_for_land(part_above, each, ranked, share, progress))
        for key, each in reach.items()
    }
    worth = {
        key for key, each in progress.each(reach.items()) if _is_worth(part_above, each.land, ball)
    }
    first = covered_by_few({key: found for key, found in fits.items() if key in worth}, kept)
    rest = covered_by_few(
        {
            key: without_slender(_for_rest(part_above, reach[key], tool, ranked, share, progress))
            for key, tool in first.items()
        },
        tuple(first.values()),
    )
    found = [
        _cutters_of(reach[key], tool, rest.get(key)) for key, tool in progress.each(first.items())
    ]
    in_use = {t.name for t in first.values()}
    for key in reach.keys() - worth if in_use else ():
        tool = next((t for t in fits[key] if t.name in in_use), None)
        if tool is not None and reach[key].missed(tool).area <= MISSED:
            found.append(_cutters_of(reach[key], tool, None))
    return tuple(sorted(found, key=lambda c: (-c.land.z, c.land.tags)))


def _cutters_of(reach: _Reach, tool: Tool, rest: Tool | None) -> LandCutters:
    missed, done = reach.missed(tool), reach.after[rest.name] if rest else EMPTY_REGION
    flanks = [(tool, reach.before[tool.name], SIDE)] + (
        [(rest, done, FOOT * rest.diameter)] if rest else []
    )
    return LandCutters(
        land=reach.land,
        tool=tool,
        rest=rest,
        remaining=without(missed, done),
        flanks=tuple((region, height) for mill, region, height in flanks if mill.form == "flat"),
    )


def _may_cover(part_above: PartAbove, land: Land, tools: Sequence[Tool]) -> bool:
    """Return whether the slimmest end mill would cover enough of a land with nothing above its flutes: others cover no more."""
    slimmest = min(tools, key=lambda t: (t.diameter, t.corner_radius))
    return _is_most(
        covered(land, part_above.space.around().minus(part_above.over(land.z + SKIM)), slimmest),
        land,
    )


def _is_most(region: Region, land: Land) -> bool:
    return region.area >= MOST * land.region.area


def _for_land(
    part_above: PartAbove, reach: _Reach, tools: Sequence[Tool], share: float, progress: Progress
) -> list[Tool]:
    """Return the end mills, largest first, that cover off its sides nearly all of a land that any does; none where that is too little."""
    most = max(r.area for r in reach.before.values())
    if most < HALF * reach.land.region.area or not any(
        _is_most(r, reach.land) for r in reach.after.values()
    ):
        return []
    return _near(
        [
            t
            for t in tools
            if reach.before[t.name].area >= share * most
            and is_free_of_part(part_above, reach.land, t, progress)
        ]
    )


def _for_rest(
    part_above: PartAbove,
    reach: _Reach,
    tool: Tool,
    tools: Sequence[Tool],
    share: float,
    progress: Progress,
) -> list[Tool]:
    """Return the end mills, largest first, that cover nearly all that any does of what another missed; none where that is too little."""
    missed = reach.missed(tool)
    area = {
        t.name: missed.intersect(reach.after[t.name]).area
        for t in progress.each(tools)
        if t.diameter <= tool.diameter
    }
    most = max(area.values())
    return _near(
        [
            t
            for t in tools
            if area.get(t.name, 0.0) >= share * most
            and is_free_of_part(part_above, reach.land, t, progress)
        ]
        if most > MISSED
        else []
    )


def _near(tools: list[Tool]) -> list[Tool]:
    return [t for t in tools if t.diameter >= NEAR * tools[0].diameter]


def _is_worth(part_above: PartAbove, land: Land, ball: float) -> bool:
    """Return whether a land is large enough for an end mill, or a ball would leave too much of it beside what is there."""
    if land.region.area >= WORTH:
        return True
    axis_region = part_above.space.around().minus(part_above.over(land.z + ball)).offset(-ball)
    return without(land.region, axis_region.intersect(land.region)).area > WORTH_REMAINING
