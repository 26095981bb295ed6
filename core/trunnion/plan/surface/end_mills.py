"""The end mills of level lands: for each the largest that covers nearly what any does, and one for what that leaves; few in all."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools
from trunnion.geometry.region import EMPTY_REGION, Region
from trunnion.model.tool import Tool
from trunnion.plan.choosing import covered_by_few, depth_reached
from trunnion.plan.surface.areas import VERTICAL
from trunnion.plan.surface.lands import SIDE, Keeping, Land, Standing, covered, stands_free, without
from trunnion.plan.surface.reach import Places
from trunnion.progress import Progress

MOST = 0.9
"""Share of a land that end mills must cover: of less they would leave too much for another way of cutting it."""
WORTH = 100.0
"""mm2: a ball finishes a smaller land in the time of a tool change."""
WORTH_LEFT = 4.0
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
class Chosen:
    """The end mill of a land, another one for what that leaves (None: nothing worth it), and what of the land no end mill reaches.

    `flanks`: where their flats come right up to sides, and how high over the land (mm) their flanks then finish an upright one.
    """

    land: Land
    tool: Tool
    rest: Tool | None
    left: Region
    flanks: tuple[tuple[Region, float], ...]

    def finishes(self, places: Places) -> Bools:
        """Say which places (k,) lie on the foot of an upright side, which the end mills finish while they cut the land beside it."""
        found = np.zeros(len(places), dtype=bool)
        upright = np.abs(places.normal[:, 2]) < VERTICAL
        for region, height in self.flanks:
            above = places.point[:, 2] - self.land.z
            rows = np.flatnonzero(upright & (above > -tolerance.SLIVER) & (above <= height))
            found[rows] |= region.contains(places.point[rows, :2] + BEFORE * places.normal[rows, :2])
        return found


def end_mills_for(standing: Standing, lands: Sequence[Land], tools: Sequence[Tool], ball: float, share: float, keeping: Keeping,
                  kept: Sequence[Tool], progress: Progress) -> tuple[Chosen, ...]:
    """Return the lands that are worth an end mill, with their cutters.

    `ball`: radius of the smallest ball that would finish them instead; `kept`: cutters that are in use anyhow.
    """
    ranked = sorted((t for t in tools if t.form in ("flat", "bull")),
                    key=lambda t: (-t.diameter, t.corner_radius, depth_reached(t), t.name))
    bare = replace(keeping, beside=0.0)
    reach: dict[int, dict[str, Region]] = {}
    fits: dict[str, list[Tool]] = {}
    for n, land in enumerate(lands):
        progress.at(n / max(len(lands), 1), f"end mill for the land at {land.z:.2f}")
        if not _is_worth(standing, land, ball):
            continue
        reach[n] = {t.name: covered(land, standing.free(land.z, t, bare), t) for t in ranked}
        most = max((r.area for r in reach[n].values()), default=0.0)
        if most < MOST * land.region.area:
            continue
        free = [t for t in ranked if reach[n][t.name].area >= share * most
                and stands_free(standing.space, land, standing.free(land.z, t, bare), t)]
        fits[str(n)] = [t for t in free if t.diameter >= NEAR * free[0].diameter]
    first = covered_by_few({key: found for key, found in fits.items() if found}, kept)
    missed: dict[str, Region] = {}
    rests: dict[str, list[Tool]] = {}
    for key, tool in first.items():
        land = lands[int(key)]
        missed[key] = without(land.region, covered(land, standing.free(land.z, tool, keeping), tool))
        rests[key] = _for_rest(missed[key], reach[int(key)], [t for t in ranked if t.diameter <= tool.diameter], share)
    second = covered_by_few({key: found for key, found in rests.items() if found}, tuple(first.values()))
    found = []
    for key, tool in first.items():
        rest = second.get(key)
        done = reach[int(key)][rest.name] if rest else EMPTY_REGION
        found.append(Chosen(land=lands[int(key)], tool=tool, rest=rest, left=without(missed[key], done),
                            flanks=tuple((region, height) for mill, region, height in (
                                (tool, reach[int(key)][tool.name].minus(missed[key]), SIDE),
                                (rest, done, FOOT * rest.diameter if rest else 0.0)) if mill and region and mill.form == "flat")))
    return tuple(found)


def _for_rest(missed: Region, reach: dict[str, Region], tools: Sequence[Tool], share: float) -> list[Tool]:
    """Return the end mills that cover nearly all that any does of what was missed; none where that is too little."""
    area = {t.name: missed.intersect(reach[t.name]).area for t in tools} if missed else {}
    most = max(area.values(), default=0.0)
    found = [t for t in tools if area[t.name] >= share * most] if most > MISSED else []
    return [t for t in found if t.diameter >= NEAR * found[0].diameter]


def _is_worth(standing: Standing, land: Land, ball: float) -> bool:
    """Say whether a land is large enough for an end mill, or a ball would leave too much of it beside what stands there."""
    if land.region.area >= WORTH:
        return True
    room = standing.space.around().minus(standing.over(land.z + ball)).offset(-ball)
    return without(land.region, room.intersect(land.region)).area > WORTH_LEFT
