"""The operations on level lands: a large end mill before curved faces are finished, and after that another one for what it left."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np

from trunnion.findings import BadInput, face_tags, info
from trunnion.model.tool import Tool
from trunnion.plan.freeform.cutters.end_mills import MISSED, LandCutters, end_mills_for
from trunnion.plan.freeform.finishing.rest import HOLDER_CLEARANCE
from trunnion.plan.freeform.lands import (
    ABOVE_TOOL,
    AROUND_TOOL,
    LAND,
    LATERAL,
    REST_LAND,
    STOCK,
    Land,
    LandClearances,
    PartAbove,
    lands_of,
)
from trunnion.plan.freeform.reach import AreaSamples, reached, samples_on
from trunnion.plan.surface.plan_state import SurfacePlanState, face_name
from trunnion.progress import Progress
from trunnion.settings import Value
from trunnion.units import trimmed

WIDTH = 0.6
"""Distance of an end mill's passes over the width of its flat."""
DEEPEST = 0.5
"""mm: the thickest stock that an end mill takes off a land at once; more comes off in even steps."""
LEAST = 0.02
"""mm: the depth that cutting data are found for where roughing leaves nothing."""
SLITS = 0.01
"""Share of a land that balls may come to and no end mill; a land with more of it stays with them as a whole."""
FEW = 200
"""Positions on a face that say whether end mills finish all of it."""
APART = 0.1
"""mm that an end mill keeps more than roughing's allowance from sides that are not finished yet."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FinishedLands:
    """The lands that end mills finish, with these, and the tags of all faces that they finish: lands, and low sides beside them."""

    lands: tuple[LandCutters, ...] = ()
    tags: frozenset[int] = frozenset()

    def without_feet(self, samples: AreaSamples) -> AreaSamples:
        """Return the positions that are not on the feet of sides that end mills finish."""
        done = np.zeros(len(samples), dtype=bool)
        for each in self.lands:
            done |= each.finishes(samples)
        return samples.of(~done)


def plan_lands(
    state: SurfacePlanState, tags: Collection[int], balls: Sequence[Tool], progress: Progress
) -> FinishedLands:
    """Add operations on the level lands among faces; `balls` would finish them instead."""
    if not state.settings.lands or not {LAND, REST_LAND} <= set(state.stages):
        return FinishedLands()
    settings, route = state.settings, state.route
    clearances = LandClearances(
        lateral=settings.rough_allowance + APART,
        around=settings.rough_allowance + HOLDER_CLEARANCE,
        above=route.reach_clearance,
    )
    mills = [t for t in state.cutters("finish") if t.diameter <= route.largest]
    try:
        part_above = PartAbove(state.space, progress)
        found = end_mills_for(
            part_above,
            lands_of(state.space, tags),
            mills,
            min((t.radius for t in balls), default=0.0),
            settings.share,
            clearances,
            [o.cutter for o in state.operations],
            progress,
        )
        found = tuple(c for c in found if not _is_for_balls(state, c, balls))
    except BadInput as reason:
        state.findings.append(
            info(
                "route.lands",
                f"level faces are left to balls: {reason}",
                remedy="nothing needs to be done",
            )
        )
        return FinishedLands()
    for c in found:
        if c.remaining.area > MISSED:
            state.findings.append(
                info(
                    "route.land-left",
                    f"{trimmed(c.remaining.area, 1)} mm2 of the land at {trimmed(c.land.z, 2)} stay in "
                    "corners that no end mill gets into",
                    *face_tags(c.land.tags),
                    remedy="finish them by other means",
                )
            )
    low = _low_sides(state, tags, found)
    for kind, pairs, lateral in (
        (LAND, [(c.tool, c) for c in found], clearances.lateral),
        (REST_LAND, [(c.rest, c) for c in found if c.rest is not None], 0.0),
    ):
        by_name = {tool.name: tool for tool, _ in pairs}
        for name, tool in by_name.items():
            mine = [c for other, c in pairs if other.name == name]
            sides = [
                t for t, c in low.items() if c in mine and (kind == REST_LAND or c.rest is None)
            ]
            _add(
                state,
                kind,
                tool,
                [c.land for c in mine],
                sides,
                {LATERAL: lateral, AROUND_TOOL: clearances.around, ABOVE_TOOL: clearances.above},
            )
    return FinishedLands(
        lands=found, tags=frozenset({t for c in found for t in c.land.tags} | set(low))
    )


def _is_for_balls(state: SurfacePlanState, cutters: LandCutters, balls: Sequence[Tool]) -> bool:
    """Return whether balls come to too much of a land that no end mill does: into slits that run out from it."""
    if cutters.remaining.area <= MISSED:
        return False
    samples = samples_on(state.space.skin, cutters.land.tags)
    samples = samples.of(cutters.remaining.contains(samples.point[:, :2]))
    seen = np.zeros(len(samples), dtype=bool)
    for ball in sorted(balls, key=lambda t: t.diameter):
        seen[~seen] = reached(state.space, samples.of(~seen), ball, state.route.reach_clearance)
    return float(seen.sum()) * samples.area > max(MISSED, SLITS * cutters.land.region.area)


def _low_sides(
    state: SurfacePlanState, tags: Collection[int], lands: Sequence[LandCutters]
) -> dict[int, LandCutters]:
    """Return the upright faces that the end mills of a land finish all over, with that land."""
    found = {}
    for tag in sorted(tags) if lands else ():
        samples = samples_on(state.space.skin, (tag,), FEW)
        done = next((c for c in lands if len(samples) and c.finishes(samples).all()), None)
        if done is not None:
            found[tag] = done
    return found


def _add(
    state: SurfacePlanState,
    kind: str,
    tool: Tool,
    lands: Sequence[Land],
    sides: Sequence[int],
    choices: dict[str, Value],
) -> None:
    tags = tuple(sorted([*(t for land in lands for t in land.tags), *sides]))
    stock = state.settings.rough_allowance
    depth = max(stock / max(1, math.ceil(stock / DEEPEST)), LEAST)
    width = WIDTH * (tool.diameter - 2.0 * tool.corner_radius)
    rules = (
        state.stages[kind].rule,
        f"{tool.name} over {trimmed(sum(land.region.area for land in lands), 0)} mm2: "
        f"{trimmed(width, 2)} mm between passes, {trimmed(depth, 2)} mm deep.",
    )
    state.add(
        kind,
        face_name(tags),
        state.feature_of(tags),
        tool,
        tags,
        depth,
        width,
        {STOCK: stock if kind == LAND else 0.0, "plane.floor.wall_distance": 0.0, **choices},
        rules,
    )
