"""The operations that stages on pits in walls request: a T-slot cutter that gets in, or why none does."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from trunnion import tolerance
from trunnion.findings import Refused, face_tags, warning
from trunnion.model.feature import Feature
from trunnion.model.tool import Tool
from trunnion.plan.panel.tasks import OperationTask, PanelPlanState
from trunnion.plan.prismatic.pits import (
    PIT,
    PitReach,
    PitSettings,
    PitSpace,
    pit_heights,
    pit_space,
)
from trunnion.plan.tool_choice import Candidates, ToolRequirement
from trunnion.settings import choose
from trunnion.shop import Stage
from trunnion.units import trimmed

USE = "undercut"
"""Use of T-slot cutters in the catalogue."""
LEAST_SHARE = 0.5
"""Of a pit's plan area: a cutter that gets to less of it is not worth its operation."""
AS_GOOD = 0.01
"""Of a pit's plan area that a cutter may leave more of than the best, and be as good."""
WIDTH = 0.1
"""Width of cut over the diameter: a disc on a thin neck bears no more."""


def _pit_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    """Return the tasks on pits; what hinders is told."""
    found = []
    for feature in state.progress.each(features):
        if feature.kind not in stage.on:
            continue
        try:
            task = _task(state, stage, feature)
        except Refused as reason:
            state.findings.append(
                warning("route.not-planned", str(reason), feature.id, *face_tags(feature.tags))
            )
            continue
        if task.found is not None and not task.found.tools:
            state.findings.append(
                warning(
                    "route.not-planned",
                    f"{feature.id} not planned: {task.found.reason}",
                    feature.id,
                    *face_tags(feature.tags),
                    remedy=task.found.remedy,
                )
            )
            continue
        found.append(task)
    return found


def _task(state: PanelPlanState, stage: Stage, feature: Feature) -> OperationTask:
    pit = pit_space(feature, state.space)
    low, high = pit.wanted.box()
    middle = 0.5 * (low + high)
    requirement = ToolRequirement(
        depth=pit.top - pit.floor,
        envelope_area=pit.beside,
        wanted=pit.wanted,
        corner_radius=pit.fillet,
    )
    tools = state.shop.tools_for(state.material.iso_group, USE)
    fits = t_slot_cutters(pit, tools, choose(PitSettings, state.choices).clearance)

    def engagement(tool: Tool) -> tuple[float, float]:
        return min(tool.flute_length, pit.height), WIDTH * tool.diameter

    return OperationTask(
        id=state.task_id(stage, feature),
        stage=stage,
        feature=feature.id,
        position=(float(middle[0]), float(middle[1])),
        requirement=requirement,
        faces=feature.tags,
        height=pit.height,
        width=float((high - low).min()),
        found=fits,
        why="it gets to most of the pit, in the fewest passes one over the other.",
        engagement=engagement,
    )


def t_slot_cutters(pit: PitSpace, tools: Sequence[Tool], clearance: float) -> Candidates:
    """Return the cutters that get to most of a pit, or in words why none gets to enough of it; `clearance` is what all behind the disc
    keeps off the part, mm."""
    thin = [t for t in tools if t.flute_length <= pit.height + tolerance.COINCIDENT]
    if not thin:
        return Candidates(
            tools=(),
            reason=f"no T-slot cutter is as thin as it is high, {trimmed(pit.height, 2)} mm",
            remedy="add a thinner one to the tools folder",
        )
    # A corner radius below that of the fillets would cut into these.
    round_ = [t for t in thin if t.corner_radius >= pit.fillet - tolerance.COINCIDENT]
    if not round_:
        return Candidates(
            tools=(),
            reason=f"no T-slot cutter that is thin enough has the corner radius of its fillets, {trimmed(pit.fillet, 2)} mm",
            remedy="add one to the tools folder",
        )
    shares = {t.name: _share(pit, t, clearance) for t in round_}
    best = max(shares.values())
    if best < LEAST_SHARE:
        first = max(round_, key=lambda t: (shares[t.name], t.name))
        return Candidates(
            tools=(),
            reason="no T-slot cutter gets far enough under the material between its ends: "
            + (
                f"the best, {first.name}, to {trimmed(100.0 * best, 0)} % of its plan area"
                if best > 0.0
                else "none comes down beside it and into it"
            ),
            remedy="add one with a thinner neck or a smaller disc to the tools folder, or cut it by other means",
            hindered=True,
        )
    good = [t for t in round_ if shares[t.name] >= best - AS_GOOD]
    order = sorted(
        good,
        key=lambda t: (
            len(pit_heights(pit.floor, pit.roof, t)),
            t.corner_radius,
            -t.diameter,
            t.name,
        ),
    )
    few = len(pit_heights(pit.floor, pit.roof, order[0]))
    sharp = order[0].corner_radius
    return Candidates(
        tools=tuple(
            t
            for t in order
            if len(pit_heights(pit.floor, pit.roof, t)) == few and t.corner_radius == sharp
        )
    )


def _share(pit: PitSpace, tool: Tool, clearance: float) -> float:
    """Return how much of a pit's plan area a cutter gets to, as a share."""
    reach = PitReach.of(pit.wanted, pit.beside, pit.over, pit.top - pit.floor, tool, clearance)
    return reach.covered.area / pit.wanted.area


PIT_TASK_MAKERS: Mapping[
    str, Callable[[PanelPlanState, Stage, Sequence[Feature]], list[OperationTask]]
] = {PIT: _pit_tasks}
"""The rule behind the word that a typical plan gives for the cutter of a stage on pits."""
