"""Upright walls that stand free along the outline of a part of curved surfaces: the flank of a stiff end mill, in steps."""

from __future__ import annotations

import math

from trunnion.findings import error, face_tags
from trunnion.plan.freeform.reach import is_clear_of_walls, samples_on
from trunnion.plan.freeform.roughing.layers import remaining_on_walls
from trunnion.plan.surface.plan_state import SurfacePlanState, face_name
from trunnion.plan.tool_choice import depth_reached
from trunnion.units import trimmed

FEW = 200
"""Positions along a wall that say whether a tool has space beside it."""
WALL_STEP = 1.5
"""Axial step of a wall over the cutter's diameter."""
WALL_SHARE = 0.7
"""Largest cutter of an outline over the largest roughing cutter: finishing wants it stiff, but not heavy."""


def plan_outline(state: SurfacePlanState, tags: tuple[int, ...]) -> None:
    """Plan upright walls that stand free, along the part's outline."""
    stage, space = state.stages["profile_finish"], state.space
    z = space.skin.points[space.skin.triangles[space.skin.of(tags)], 2]
    top, height = float(z.max()), float(z.max() - z.min())
    most = WALL_SHARE * state.route.largest
    fits = [
        t
        for t in state.cutters("finish")
        if t.form == "flat"
        and t.diameter <= most
        and depth_reached(t) >= top - float(z.min()) + state.route.reach_clearance
        and is_clear_of_walls(
            space,
            samples_on(space.skin, tags, FEW),
            t,
            float(z.min()),
            state.route.reach_clearance,
            state.settings.rough_allowance,
        )
    ]
    if not fits:
        state.findings.append(
            error(
                "route.no-cutter",
                f"no end mill up to D {trimmed(most, 1)} reaches {trimmed(height, 1)} mm "
                "down a wall",
                *face_tags(tags),
                remedy="add a longer cutter to the tools folder",
            )
        )
        return
    tool = max(fits, key=lambda t: (t.diameter, -depth_reached(t), t.name))
    steps = max(1, math.ceil(height / min(tool.flank_step(height), WALL_STEP * tool.diameter)))
    rules = (
        stage.rule,
        f"{tool.name}: the stiffest end mill up to D {trimmed(most, 1)} that reaches {trimmed(height, 1)} mm.",
    )
    state.add(
        "profile_finish",
        face_name(tags),
        state.feature_of(tags),
        tool,
        tags,
        height / steps,
        remaining_on_walls(space, state.settings.rough_allowance, state.settings.cell),
        {},
        rules,
    )
