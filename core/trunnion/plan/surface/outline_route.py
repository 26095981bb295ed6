"""Upright walls that stand free along the outline of a part of curved surfaces: the flank of a stiff end mill, in steps."""

from __future__ import annotations

import math

import numpy as np
from scipy.spatial import cKDTree

from trunnion import tolerance
from trunnion.findings import error, face_tags
from trunnion.plan.freeform.reach import AreaSamples, free_before, is_clear_of_walls, samples_on
from trunnion.plan.freeform.roughing.layers import remaining_on_walls
from trunnion.plan.surface.plan_state import SurfacePlanState, face_name
from trunnion.plan.tool_choice import depth_reached
from trunnion.units import trimmed

FEW = 200
"""Positions along a wall that say whether a tool has space beside it."""
SPACE = 1.25
"""Of a cutter's radius: the smallest radius of a hollow wall that it is not engaged in nearly all round, with space for leads."""
WALL_STEP = 1.5
"""Axial step of a wall over the cutter's diameter."""
WALL_SHARE = 0.7
"""Largest cutter of an outline over the largest roughing cutter: finishing wants it stiff, but not heavy."""


def plan_outline(state: SurfacePlanState, tags: tuple[int, ...]) -> bool:
    """Plan upright walls that stand free, along the part's outline; return whether they are looked after.

    They are not where no end mill that reaches down has space before them: then they are left to what finishes the faces round them.
    """
    stage, space = state.stages["profile_finish"], state.space
    samples = samples_on(space.skin, tags, FEW)
    z = space.skin.points[space.skin.triangles[space.skin.of(tags)], 2]
    bottom, top = float(z.min()), float(z.max())
    height = top - bottom
    most = WALL_SHARE * state.route.largest
    fits = [
        t
        for t in state.cutters("finish")
        if t.form == "flat"
        and t.diameter <= most
        and depth_reached(t) >= height + state.route.reach_clearance
        and is_clear_of_walls(
            space,
            samples,
            t,
            bottom,
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
        return True
    fits = [t for t in fits if not _closes_round(samples, SPACE * t.radius)]
    beside = state.settings.rough_allowance
    share = [float(free_before(space, samples, t.radius + beside, bottom).mean()) for t in fits]
    most_free = max(share, default=0.0)
    if most_free <= 0.0:
        return False
    fits = [t for t, free in zip(fits, share, strict=True) if free >= most_free]
    tool = max(fits, key=lambda t: (t.diameter, -depth_reached(t), t.name))
    steps = max(1, math.ceil(height / min(tool.flank_step(height), WALL_STEP * tool.diameter)))
    rules = (
        stage.rule,
        f"{tool.name}: the stiffest end mill up to D {trimmed(most, 1)} that reaches {trimmed(height, 1)} mm "
        "and has space before the wall.",
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
    return True


def _closes_round(samples: AreaSamples, radius: float) -> bool:
    """Return whether upright walls come into a circle of a radius (mm) that touches them, as those of a narrower hole do."""
    point = samples.point[:, :2]
    centre = point + radius * samples.normal[:, :2]
    nearest, _ = cKDTree(point).query(centre)
    return bool(np.min(nearest) < radius - tolerance.SEW)
