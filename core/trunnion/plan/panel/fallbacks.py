"""What a task requests instead when no cutter of the catalogue fits it as wanted: the next best that a programmer would take.

A deep pocket with tight corners often has no cutter that is slimmer than its corners and long enough. The ladder: a cutter exactly as
round as the corner; then the slimmest that reaches, and the corner is left, named and measured by the proof; in roughing one that has less
space to turn, then one that leaves more to rest roughing. A slot narrower than every end mill for pockets gets one of the small ones.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from trunnion.findings import Finding, face_tags, remark
from trunnion.model.tool import Tool
from trunnion.plan.panel.floor_cutters import floor_time
from trunnion.plan.panel.outline_tasks import without_corners
from trunnion.plan.panel.tasks import (
    REST,
    WALL_DISTANCE,
    OperationTask,
    PanelPlanState,
    catalogue,
    floor_distance,
    narrow_cutters,
)
from trunnion.plan.prismatic.drive import FLOOR_ALLOWANCE, WALL_ALLOWANCE
from trunnion.plan.tool_choice import Candidates, ToolRequirement, candidates
from trunnion.settings import Value
from trunnion.units import trimmed

MOST_MISSED = 0.6
"""Share of a pocket that roughing leaves to smaller cutters at most, where none gets into the rest of it."""

NARROW_ALLOWANCE = 0.1
"""mm that roughing leaves on the walls of a slot for a small end mill: more would be as wide as the cutter."""


def best_fit(state: PanelPlanState, task: OperationTask) -> tuple[OperationTask, Candidates]:
    """Return the task as it can be done, with its cutters; without any where nothing on the ladder fits.

    Where no step of it helps, the smallest cutters of the catalogue are asked as well: those for what no other gets into.
    """
    if task.found is not None:
        return task, task.found
    tools, clearance = catalogue(state, task.stage), state.settings.reach_clearance
    wanted = candidates(task.requirement, tools, clearance, state.progress)
    if wanted.tools:
        return task, wanted
    for requirement, why in _ladder(state, task):
        found = candidates(requirement, tools, clearance, state.progress)
        if found.tools:
            state.findings.append(_second_choice(task, wanted, why))
            return replace(task, requirement=requirement), found
    if task.stage.cutter == "face" or task.stage.cutter in REST:
        return task, wanted
    small, narrow = narrow_cutters(state), _with_small_allowance(state, task)
    if not small:
        return task, wanted
    smallest = candidates(narrow.requirement, small, clearance, state.progress)
    for requirement in (narrow.requirement, *(r for r, _ in _ladder(state, narrow))):
        found = (
            smallest
            if requirement is narrow.requirement
            else candidates(requirement, small, clearance, state.progress)
        )
        if found.tools:
            why = "an end mill for narrow slots gets in"
            if task.stage.cutter == "rough":
                state.narrow.add(task.feature)
            state.findings.append(_second_choice(task, wanted, why))
            return replace(narrow, requirement=requirement), found
    return task, smallest


def _with_small_allowance(state: PanelPlanState, task: OperationTask) -> OperationTask:
    """Return a roughing that leaves as little on walls as a small cutter's finishing takes, and a floor after it that comes as near to
    them; other tasks as they are."""
    gain, rule = state.settings.wall_allowance - NARROW_ALLOWANCE, task.stage.cutter
    if gain <= 0.0 or not (rule == "rough" or (rule == "floor" and task.feature in state.narrow)):
        return task
    usual = task.requirement
    requirement = replace(
        usual,
        envelope_area=usual.envelope_area.offset(gain),
        wanted=usual.wanted.offset(gain),
        others=tuple((area.offset(gain), wanted.offset(gain)) for area, wanted in usual.others),
    )
    allowances: dict[str, Value] = (
        {
            WALL_ALLOWANCE: NARROW_ALLOWANCE,
            FLOOR_ALLOWANCE: state.settings.floor_allowance,
        }
        if rule == "rough"
        else {WALL_DISTANCE: floor_distance(NARROW_ALLOWANCE)}
    )
    return replace(task, requirement=requirement, choices=allowances)


def _ladder(state: PanelPlanState, task: OperationTask) -> list[tuple[ToolRequirement, str]]:
    """Return what may be requested instead, best first, each with what becomes of it in words."""
    requirement, rule = task.requirement, task.stage.cutter
    if rule in ("profile_rough", "profile_finish"):
        open_corners = without_corners(state, requirement, catalogue(state, task.stage))
        return (
            []
            if open_corners is None
            else [(open_corners, "its inner corners are left to slimmer cutters")]
        )
    if rule in ("rough", "layers"):
        tight = replace(requirement, spare=1.0)
        return [
            (tight, "it is roughed by a cutter that has little room to turn"),
            (
                replace(tight, missable=MOST_MISSED),
                "what the roughing cutter leaves is roughed by smaller ones",
            ),
        ]
    if rule not in ("rest", "wall", "corner") or not requirement.radius:
        return []
    round_as_corner = replace(requirement, radius=requirement.radius / state.settings.corner_share)
    ladder = [(round_as_corner, "its cutter is as round as the corners")]
    if rule == "wall":
        loose = replace(requirement, radius=0.0, missable=state.settings.missable, cusps=False)
        return [*ladder, (loose, "its corners are left to another cutter")]
    slimmest, before = _slimmest(state, task), state.tool_before(rule, task.feature)
    if before is not None and slimmest < before.radius:
        coarser = replace(requirement, radius=slimmest, missable=1.0, cusps=False, near=0.0)
        ladder.append(
            (
                coarser,
                f"the slimmest that reaches leaves a radius of {trimmed(slimmest, 2)} mm in the corners",
            )
        )
    return ladder


def _slimmest(state: PanelPlanState, task: OperationTask) -> float:
    """Return the radius of the slimmest cutter that gets down to a task's foot."""
    open_to_all = replace(task.requirement, radius=0.0, missable=1.0, cusps=False, near=0.0)
    found = candidates(
        open_to_all, catalogue(state, task.stage), state.settings.reach_clearance, state.progress
    )
    return min((t.radius for t in found.tools), default=math.inf)


def _second_choice(task: OperationTask, wanted: Candidates, why: str) -> Finding:
    return remark(
        "route.second-choice",
        f"{task.feature}: {wanted.reason} ({task.stage.name}); {why}",
        task.feature,
        *face_tags(task.faces),
        remedy=wanted.remedy,
    )


def with_floors_behind_roughing(state: PanelPlanState, tasks: Sequence[OperationTask]) -> None:
    """Give floors a cutter that finds space where roughing cleared, in pockets whose corners no roughing cutter got into.

    A floor's cutter goes to the bottom at once: one that is slimmer than the last roughing cutter goes into stock that is as high as
    the pocket is deep, and above its flutes the neck and shank meet it.
    """
    narrow = {t.name for t in narrow_cutters(state)}
    for task in tasks:
        tool, cleared = state.tools[task.id], _cleared(state, task, tasks)
        if (
            task.stage.cutter != "floor"
            # No wider one gets to a floor that a cutter for narrow slots was chosen for.
            or tool.name in narrow
            or tool.radius >= cleared
            or tool.flute_length >= task.height
        ):
            continue
        whole = [t for t in _floor_tools(state, task, task.requirement) if t.radius >= cleared]
        if whole:
            quickest = {t.name: floor_time(state, task, t) for t in whole}
            state.tools[task.id] = min(whole, key=lambda t: (quickest[t.name], t.name))
            continue
        most = replace(task.requirement, missable=1.0, near=0.0)
        as_wide = [t for t in _floor_tools(state, task, most) if t.radius >= cleared]
        if as_wide:
            state.tools[task.id] = min(as_wide, key=lambda t: (t.radius, -t.corner_radius, t.name))


def _floor_tools(
    state: PanelPlanState, task: OperationTask, requirement: ToolRequirement
) -> Sequence[Tool]:
    return candidates(
        requirement, catalogue(state, task.stage), state.settings.reach_clearance, state.progress
    ).tools


def _cleared(state: PanelPlanState, task: OperationTask, tasks: Sequence[OperationTask]) -> float:
    """Return the radius of the smallest cutter that roughed a task's feature, 0 where none did."""
    rough = [t for t in tasks if t.feature == task.feature and t.stage.cutter in ("rough", "rest")]
    return min((state.tools[t.id].radius for t in rough), default=0.0)


def behind_rest_roughing(
    state: PanelPlanState, task: OperationTask, tasks: Sequence[OperationTask]
) -> frozenset[str]:
    """Return the ids of rest roughing that a floor's cutter has to wait for: it is slimmer than the first roughing cutter, so it goes into
    corners where stock is up to the pocket's rim."""
    first = state.tools.get(f"rough-{task.feature}")
    if task.stage.cutter != "floor" or first is None or state.tools[task.id].radius >= first.radius:
        return frozenset()
    return frozenset(t.id for t in tasks if t.feature == task.feature and t.stage.cutter == "rest")
