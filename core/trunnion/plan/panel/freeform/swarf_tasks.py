"""The operations that cut leaning walls of pockets by a cutter's flank, where the machine has rotary axes."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from trunnion.findings import Finding, face_tags, warning
from trunnion.model.feature import Feature
from trunnion.model.tool import Tool
from trunnion.plan.cutting.milling import CuttingSettings, roughing_depth, roughing_width
from trunnion.plan.freeform.estimate.scallop import stepover_on_plane
from trunnion.plan.freeform.finishing.chord import chord_choices
from trunnion.plan.freeform.finishing.partition import parted_within
from trunnion.plan.freeform.keys import ALLOWANCE, PAST_RIM, SCALLOP
from trunnion.plan.freeform.reach import AreaSamples, samples_on
from trunnion.plan.freeform.tilted_reach import SAMPLES, leaning_cutter
from trunnion.plan.panel.freeform.cutters import balls
from trunnion.plan.panel.freeform.finishing_tasks import AFTER_FLANK, REST_LEAD
from trunnion.plan.panel.freeform.flank_choice import (
    fillets_of,
    flank_of,
    flat_radius,
    foot_cutter,
    hanging_walls,
)
from trunnion.plan.panel.freeform.planning import FreeformPlanning, pocket_task, pockets_of
from trunnion.plan.panel.freeform.pocket import FreeformPocket
from trunnion.plan.panel.tasks import OperationTask, PanelPlanState
from trunnion.plan.tool_choice import Candidates, ToolRequirement, depth_reached
from trunnion.recognize.grow import bend_radius
from trunnion.settings import Value, choose
from trunnion.shop import Stage
from trunnion.units import trimmed

STRATEGY, POINT = "surface.swarf", "surface.point"
STEEPEST = 85.0
"""degrees: how far a ball's axis may lean from the normal of what it finishes under a wall."""
LAP = 0.5
"""mm by which what is finished of a floor under an overhang goes on over what an upright cutter finished."""
WIDTH = 0.5
"""Of the width of cut that roughing has: a flank takes it at nearly all its length."""


def swarf_rough_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    """Ask for flank passes that take what stands under walls that lean over, in as many as that is wide."""
    found = []
    for known, pocket, tool, faces in _walls(state, stage, features):
        hanging, thickness = hanging_walls(known, pocket, faces)
        allowance, cutting = state.settings.wall_allowance, choose(CuttingSettings, {})
        if not hanging or thickness <= allowance:
            continue
        wide = WIDTH * roughing_width(tool, state.material, cutting)
        deep = min(tool.flute_length, roughing_depth(tool, state.material, cutting))
        count = math.ceil((thickness - allowance) / wide)
        for n in reversed(range(count)):
            left = allowance + n * wide
            name = f"{stage.kind}-{pocket.feature.id}" + (f"-{count - n}" if count > 1 else "")
            choices: dict[str, Value] = {
                ALLOWANCE: left,
                f"{STRATEGY}.step": deep,
            }
            found.append(_task(state, stage, pocket, name, tool, hanging, choices, (deep, wide)))
    return found


def swarf_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    """Ask for the flank passes that finish walls."""
    found = []
    for known, pocket, tool, faces in _walls(state, stage, features):
        left = pocket.layer_area().remaining(known.settings.cell, state.settings.floor_allowance)
        left = max(left + known.settings.step, state.settings.wall_allowance)
        name = f"{stage.kind}-{pocket.feature.id}"
        deep = tool.flank_step(pocket.top - pocket.bottom)
        choices: dict[str, Value] = {SCALLOP: known.settings.scallop, ALLOWANCE: 0.0}
        found.append(_task(state, stage, pocket, name, tool, faces, choices, (deep, left)))
    return found


def swarf_foot_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    """Ask for the lowest flank passes of walls that lean over with a cutter that a floor lifts less than the one that finished them."""
    found = []
    for known, pocket, flank, walls in _walls(state, stage, features):
        hanging = hanging_walls(known, pocket, walls)[0]
        tool = foot_cutter(state, known, pocket, flank, hanging) if hanging else None
        if tool is None:
            continue
        name, deep = f"{stage.kind}-{pocket.feature.id}", flat_radius(flank)
        choices: dict[str, Value] = {
            SCALLOP: known.settings.scallop,
            ALLOWANCE: 0.0,
            f"{STRATEGY}.feet": True,
            f"{STRATEGY}.lead_radius": REST_LEAD,
        }
        left = state.settings.wall_allowance
        found.append(_task(state, stage, pocket, name, tool, hanging, choices, (deep, left)))
    return found


def leaning_fillet_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    """Ask for passes of a leaning ball along fillets at the feet of walls: where a flank turns into a corner, and under walls that lean
    over, its end is lifted off the floor and leaves these unfinished."""
    # As upright as can be: out along a steep axis there is room, which a flat one has in deep pockets only where it cuts.
    upright: dict[str, Value] = {
        f"{POINT}.axis": "fixed",
        f"{POINT}.axis_from": " ".join(trimmed(float(v), 9) for v in state.space.setup.frame.z),
        f"{POINT}.steepest": STEEPEST,
    }
    graph, found = state.space.part.graph(), []
    for known, pocket, _, _ in _walls(state, stage, features):
        feet = fillets_of(state, pocket)
        samples = pocket.holds(samples_on(known.curved.skin, feet, SAMPLES))
        if feet and len(samples):
            least = min(bend_radius(graph, t - 1) for t in feet)
            found += _point_milled(
                state, stage, known, pocket, feet, samples, 0.5 * least, least, upright
            )
    return found


def overhung_floor_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    """Ask for passes of a leaning ball over what of floors something hangs over."""
    found = []
    for known, pocket, _, _ in _walls(state, stage, features):
        past = AFTER_FLANK + LAP
        floors, area = pocket.overhung_floors(past)
        if not floors:
            continue
        samples = samples_on(*parted_within(known.curved.skin, floors, area), SAMPLES)
        left = state.settings.floor_allowance
        largest = state.settings.largest
        choices: dict[str, Value] = {PAST_RIM: past, f"{POINT}.pattern": "constant"}
        found += _point_milled(state, stage, known, pocket, floors, samples, left, largest, choices)
    return found


def _point_milled(
    state: PanelPlanState,
    stage: Stage,
    known: FreeformPlanning,
    pocket: FreeformPocket,
    faces: tuple[int, ...],
    samples: AreaSamples,
    left: float,
    largest: float,
    choices: Mapping[str, Value],
) -> list[OperationTask]:
    """Return the task of the largest leaning ball, its radius (mm) no larger than the largest, that comes to enough samples of faces, on
    which stock stands by what is `left` (mm); none, and a finding, where no ball does."""
    assert state.leaning is not None
    longest = {
        t.diameter: t
        for t in sorted(balls(state), key=lambda t: (t.diameter, depth_reached(t), t.name))
    }
    tools = [t for t in longest.values() if t.radius <= largest]
    query_for, share = state.leaning(known.curved), known.settings.share
    tool = leaning_cutter(samples, tools, query_for, share, None, state.progress).tool
    if tool is None:
        state.findings.append(_no_ball(pocket, stage, faces))
        return []
    height = known.settings.scallop
    values: dict[str, Value] = {
        SCALLOP: height,
        ALLOWANCE: 0.0,
        f"{POINT}.lead_radius": REST_LEAD,
        **chord_choices(POINT, height),
        **choices,
    }
    name = f"{stage.kind}-{pocket.feature.id}"
    cut = (left, stepover_on_plane(tool.corner_radius, height))
    return [_task(state, stage, pocket, name, tool, faces, values, cut)]


def _no_ball(pocket: FreeformPocket, stage: Stage, feet: Sequence[int]) -> Finding:
    return warning(
        "route.not-planned",
        f"{pocket.feature.id}: no leaning ball of the catalogue comes to what lies under its walls ({stage.name})",
        pocket.feature.id,
        *face_tags(feet),
        remedy="add a longer or smaller ball to the tools folder; the proof counts what is left",
    )


def _walls(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[tuple[FreeformPlanning, FreeformPocket, Tool, tuple[int, ...]]]:
    """Return the pockets of a stage whose walls a flank lies on, with the cutter and the tags of these walls."""
    if state.leaning is None:
        return []
    found = []
    for known, pocket in pockets_of(state, stage, features):
        found_flank = flank_of(state, known, pocket)
        if found_flank is not None:
            found.append((known, pocket, *found_flank))
    return found


def _task(
    state: PanelPlanState,
    stage: Stage,
    pocket: FreeformPocket,
    name: str,
    tool: Tool,
    faces: tuple[int, ...],
    choices: Mapping[str, Value],
    cut: tuple[float, float],
) -> OperationTask:
    return pocket_task(
        state,
        stage,
        pocket,
        name,
        ToolRequirement(
            depth=state.space.top - pocket.bottom,
            envelope_area=pocket.mouth,
            wanted=pocket.mouth,
            corner_radius=tool.corner_radius,
        ),
        faces,
        choices,
        lambda _: cut,
        Candidates(tools=(tool,)),
        f"on {len(faces)} faces, {trimmed(cut[0], 2)} mm deep and {trimmed(cut[1], 2)} mm wide at a pass.",
    )
