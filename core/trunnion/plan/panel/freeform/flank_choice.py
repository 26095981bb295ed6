"""Which walls of a freeform pocket a cutter's flank finishes, and which cutter it is."""

from __future__ import annotations

import math

import numpy as np

from trunnion import tolerance
from trunnion.model.tool import Tool
from trunnion.plan.freeform.finishing.partition import parted_within
from trunnion.plan.freeform.swarf.flank import FEET, first_fitting
from trunnion.plan.panel.freeform.cutters import side_cutters
from trunnion.plan.panel.freeform.planning import FreeformPlanning
from trunnion.plan.panel.freeform.pocket import FreeformPocket
from trunnion.plan.panel.tasks import PanelPlanState

ROOMY = 0.9
"""Share of the places tried on walls at which a flank has to have room: beside steps of the floor and ribs it may have none."""
MUCH_LESS = 0.6
"""Of the flat of a flank's end: a cutter for feet has no more."""
DEVELOPABLE = ("plane", "cylinder", "cone")
"""Surfaces with straight lines along which the normal stays: a flank lies on these."""


def flank_of(
    state: PanelPlanState, known: FreeformPlanning, pocket: FreeformPocket
) -> tuple[Tool, tuple[int, ...]] | None:
    """Return the cutter that finishes the walls of a pocket by its flank, and their tags, worked out once; None where no wall leans, where
    no tool may lean, none is wanted, or none has room.

    Its corner is no rounder than the fillets at their feet, and as round as can be: these come out of the cutter.
    """
    if state.leaning is None or not known.settings.swarf:
        return None
    key = pocket.feature.id
    if key not in known.swarf:
        known.swarf[key] = _found_flank(state, known, pocket)
    return known.swarf[key]


def foot_cutter(
    state: PanelPlanState,
    known: FreeformPlanning,
    pocket: FreeformPocket,
    flank: Tool,
    hanging: tuple[int, ...],
) -> Tool | None:
    """Return the cutter for the feet of walls of a pocket that lean over, worked out once: the one that has room and that the floor lifts
    least; None where it lifts none much less than the flank's own.

    A leaning cutter's end comes lowest on the side away from such a wall, the lower the wider the flat of its end.
    """
    assert state.leaning is not None
    key = pocket.feature.id
    if key not in known.feet:
        tools = [
            t
            for t in side_cutters(state, pocket)
            if t.corner_radius <= pocket.fillet and flat_radius(t) <= MUCH_LESS * flat_radius(flank)
        ]
        ranked = sorted(tools, key=lambda t: (flat_radius(t), -t.diameter, t.name))
        skin, own = parted_within(known.curved.skin, hanging, pocket.under_overhangs())
        query_for = state.leaning(known.curved)
        known.feet[key] = first_fitting(skin, own, ranked, query_for, ROOMY, FEET)
    return known.feet[key]


def hanging_walls(
    known: FreeformPlanning, pocket: FreeformPocket, walls: tuple[int, ...]
) -> tuple[tuple[int, ...], float]:
    """Return which walls of a pocket lean over, and how thick in mm what stands under them is."""
    skin, found, thickness = known.curved.skin, list[int](), 0.0
    for tag in walls:
        rows = np.unique(skin.triangles[skin.of((tag,))])
        down = -float(skin.normals[rows, 2].min())
        if down <= math.sin(tolerance.ANGLE):
            continue
        lean = down / math.sqrt(1.0 - down * down)
        high = min(float(skin.points[rows, 2].max()), pocket.top)
        found.append(tag)
        thickness = max(thickness, lean * (high - pocket.bottom))
    return tuple(found), thickness


def flat_radius(tool: Tool) -> float:
    """Return the radius in mm of the flat of a cutter's end."""
    return tool.radius - tool.corner_radius


def fillets_of(state: PanelPlanState, pocket: FreeformPocket) -> tuple[int, ...]:
    """Return the fillets at the feet of a pocket's walls and of its islands'."""
    features = (pocket.feature, *state.space.islands_of(pocket.feature))
    return tuple(dict.fromkeys(t for f in features for t in f.with_role("floor_fillet")))


def _found_flank(
    state: PanelPlanState, known: FreeformPlanning, pocket: FreeformPocket
) -> tuple[Tool, tuple[int, ...]] | None:
    assert state.leaning is not None
    graph = state.space.part.graph()
    fillets = fillets_of(state, pocket)
    walls = tuple(
        t for t in pocket.sides if t not in fillets and graph.surface[t - 1] in DEVELOPABLE
    )
    if not walls or (pocket.growth <= 0.0 and pocket.hang <= 0.0):
        return None
    tools = [t for t in side_cutters(state, pocket) if t.corner_radius <= pocket.fillet]
    ranked = sorted(tools, key=lambda t: (-t.corner_radius, -t.diameter, t.name))
    skin, own = parted_within(known.curved.skin, walls, pocket.under_overhangs())
    tool = first_fitting(skin, own, ranked, state.leaning(known.curved), ROOMY)
    return None if tool is None else (tool, walls)
