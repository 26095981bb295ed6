"""The operation along the upper edges of walls that lean over: a flank takes what layers left outside of them, down to the floor."""

from __future__ import annotations

from collections.abc import Sequence

from trunnion.model.feature import Feature
from trunnion.model.tool import Tool
from trunnion.plan.panel.freeform.flank_choice import flank_of
from trunnion.plan.panel.freeform.planning import pocket_task, pockets_of
from trunnion.plan.panel.tasks import NEAR_WALL, SHARP, OperationTask, PanelPlanState, catalogue
from trunnion.plan.prismatic.regions import number
from trunnion.plan.tool_choice import ToolRequirement, candidates
from trunnion.shop import Stage

FLOOR_REST = "plane.wall.floor_rest"


def overhang_rim_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    """Ask for passes along the rims of overhangs by a cutter that comes through the corners beside; where none does, the strip stays."""
    found = []
    for known, pocket in pockets_of(state, stage, features):
        rims = pocket.overhang_rims()
        if not rims:
            continue
        # A flank that leans takes them with what stands under the wall; at sharp feet an upright end finishes the floor beside it besides.
        if pocket.fillet > 0.0 and flank_of(state, known, pocket) is not None:
            continue
        levels = pocket.floors()[1]
        areas = tuple((v.boundary, v.wanted) for v in levels)
        requirement = ToolRequirement(
            depth=state.space.top - levels[-1].bottom,
            envelope_area=areas[-1][0],
            wanted=areas[-1][1],
            corner_radius=pocket.fillet,
            radius=number(pocket.feature, "corner_radius") * state.settings.corner_share,
            missable=SHARP,
            near=NEAR_WALL,
            others=areas[:-1],
        )
        fit = candidates(
            requirement, catalogue(state, stage), state.settings.reach_clearance, state.progress
        )
        if not fit.tools:
            continue
        known.rims.add(pocket.feature.id)
        left = pocket.layer_area().remaining(known.settings.cell, state.settings.floor_allowance)
        height = max(rim.top - rim.bottom for rim in rims)

        def engagement(
            tool: Tool, height: float = height, left: float = left
        ) -> tuple[float, float]:
            return tool.flank_step(height), left

        hanging = pocket.feature.with_role("inner_convergence")
        found.append(
            pocket_task(
                state,
                stage,
                pocket,
                f"{stage.kind}-{pocket.feature.id}",
                requirement,
                (),
                {FLOOR_REST: False},
                engagement,
                fit,
                f"along the upper edges of {len(hanging)} faces that lean over.",
            )
        )
    return found
