"""The operations on a panel's outline: roughed and finished all round, sharp inner corners left to slimmer cutters where that pays."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from trunnion import tolerance
from trunnion.findings import face_tags, warning
from trunnion.geometry.plane.region import Region
from trunnion.model.feature import Feature
from trunnion.model.tool import Tool
from trunnion.plan.panel.tasks import (
    NEAR_ROUGH,
    NEAR_WALL,
    REST,
    OperationTask,
    PanelPlanState,
    catalogue,
    narrow_cutters,
)
from trunnion.plan.prismatic.drive import profile_bottom
from trunnion.plan.tool_choice import Candidates, ToolRequirement, candidates, depth_reached
from trunnion.shop import Stage
from trunnion.units import trimmed

CORNER_AREA, CORNER_WIDTH = 0.35, 0.2
"""Largest area of what a cutter leaves in a corner over the square of its radius, and largest radius of a circle in it over its radius: of
a sharp right angle 0.21 and 0.17. What is larger is a passage that the cutter is too wide for."""
LEAST = 0.05
"""mm2 that a cutter leaves in corners: less needs no operation of its own."""
THIN = 0.1
"""mm: largest radius of a circle in what is left of a sharp edge that no slimmer cutter comes into either, and that stays."""


def _profile_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    """Return the tasks all round outlines. Where only slender or much smaller cutters get into all corners, others leave these to them."""
    found = []
    for feature in _outlines(state, stage, features):
        requirement = _requirement(state, feature)
        if requirement.wanted:
            stiffer = _stiffer(state, requirement, catalogue(state, stage))
            found.append(_task(state, stage, feature, stiffer or requirement))
    return found


def _stiffer(
    state: PanelPlanState, requirement: ToolRequirement, tools: Sequence[Tool]
) -> ToolRequirement | None:
    """Return the requirement without corners where that pays: cutters that do with it are none too slender, or much larger."""
    clearance = state.settings.reach_clearance
    fine = candidates(requirement, tools, clearance, state.progress).tools
    widest = max((t.diameter for t in fine), default=0.0)
    if not fine or all(2.0 * r <= widest for r in _radii(state, requirement, tools)):
        return None
    open_corners = without_corners(state, requirement, tools)
    if open_corners is None:
        return None
    stiff = candidates(open_corners, tools, clearance, state.progress).tools
    is_much_larger = any(t.diameter >= state.settings.falling * widest for t in stiff)
    is_less_slender = all(_is_slender(state, t) for t in fine) and not all(
        _is_slender(state, t) for t in stiff
    )
    return open_corners if is_much_larger or is_less_slender else None


def _corner_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    """Return the tasks in corners of outlines that the cutter all round has left: by one that gets into all of them, a small end mill where
    no other does, or else by the slimmest that reaches."""
    found = []
    for feature in _outlines(state, stage, features):
        before = state.tool_before(stage.cutter, feature.id)
        requirement = replace(_requirement(state, feature), near=NEAR_WALL)
        if before is None or _corners_after(state, requirement, before.radius).area < LEAST:
            continue
        tools, small = catalogue(state, stage), narrow_cutters(state)
        fits = _into_corners(state, requirement, tools, before)
        if not fits.tools:
            fits = _into_corners(state, requirement, small, before)
        if not fits.tools:
            fits = _slimmest(state, requirement, (*tools, *small), before)
            _report_corners(state, stage, feature, before, fits)
        if fits.tools:
            task = _task(state, stage, feature, requirement)
            found.append(replace(task, found=fits, faces=feature.with_role("corner")))
    return found


def without_corners(
    state: PanelPlanState, requirement: ToolRequirement, tools: Sequence[Tool]
) -> ToolRequirement | None:
    """Return a requirement without the corners that the largest cutter leaves of those that leave nothing else; None where every cutter
    that reaches leaves more."""
    for radius in _radii(state, requirement, tools):
        state.progress.check()
        remaining = _remaining_after(requirement, radius)
        if all(_is_corner(piece, radius) for piece in remaining.split()):
            return replace(requirement, wanted=requirement.wanted.minus(remaining))
    return None


def _radii(
    state: PanelPlanState, requirement: ToolRequirement, tools: Sequence[Tool]
) -> list[float]:
    """Return the radii of the cutters that reach as deep as is asked for, the largest first."""
    deep = requirement.depth + state.settings.reach_clearance
    return sorted({t.radius for t in tools if depth_reached(t) >= deep}, reverse=True)


def _is_corner(piece: Region, radius: float) -> bool:
    """Return whether what a cutter of a radius leaves is no more than it leaves in a corner."""
    return piece.area <= CORNER_AREA * radius**2 and not piece.offset(-CORNER_WIDTH * radius)


def _remaining_after(requirement: ToolRequirement, radius: float) -> Region:
    """Return the area of what is wanted that a cutter of a radius doesn't cover; slivers of two offsets are none of it."""
    remaining = requirement.wanted.minus(requirement.envelope_area.opened(radius))
    return Region(tuple(p for p in remaining.pieces if p.area > tolerance.SEW))


def _corners_after(state: PanelPlanState, requirement: ToolRequirement, radius: float) -> Region:
    """Return what a cutter of a radius leaves in corners that is worth a slimmer one: all but what is thin in sharp edges."""
    slimmest = min((t.radius for t in narrow_cutters(state)), default=radius)
    remaining = _remaining_after(requirement, radius)
    if not remaining:
        return remaining
    sharp = requirement.wanted.minus(requirement.envelope_area.opened(min(slimmest, radius)))
    return Region(
        tuple(
            p
            for piece in remaining.split()
            if piece.offset(-THIN) or not piece.intersect(sharp)
            for p in piece.pieces
        )
    )


def _into_corners(
    state: PanelPlanState, requirement: ToolRequirement, tools: Sequence[Tool], before: Tool
) -> Candidates:
    """Return the cutters slimmer than the one before that leave nothing worth an operation in corners."""
    slimmer = [t for t in tools if t.radius < before.radius - tolerance.COINCIDENT]
    for radius in _radii(state, requirement, slimmer):
        state.progress.check()
        if _corners_after(state, requirement, radius).area < LEAST:
            return candidates(
                replace(requirement, radius=radius, missable=1.0),
                tools,
                state.settings.reach_clearance,
                state.progress,
            )
    return Candidates(tools=())


def _slimmest(
    state: PanelPlanState, requirement: ToolRequirement, tools: Sequence[Tool], before: Tool
) -> Candidates:
    """Return the slimmest cutter that reaches, if it is slimmer than the one before."""
    found = candidates(
        replace(requirement, missable=1.0, near=0.0),
        tools,
        state.settings.reach_clearance,
        state.progress,
    )
    slimmer = [t for t in found.tools if t.radius < before.radius - tolerance.COINCIDENT]
    least = min((t.radius for t in slimmer), default=0.0)
    return replace(found, tools=tuple(t for t in slimmer if t.radius <= least))


def _report_corners(
    state: PanelPlanState, stage: Stage, feature: Feature, before: Tool, fits: Candidates
) -> None:
    """Tell that corners keep the radius of the slimmest cutter, or of the one before; roughing leaves them to finishing."""
    if stage.cutter in REST:
        return
    last = fits.tools[0] if fits.tools else before
    state.findings.append(
        warning(
            "route.corner-left",
            f"{feature.id}: some of its inner corners keep a radius of {trimmed(last.radius, 2)} mm, that of the slimmest cutter "
            "that reaches as deep",
            feature.id,
            *face_tags(feature.with_role("corner")),
            remedy="add a slimmer or longer cutter to the tools folder, or finish them by other means",
        )
    )


def _outlines(state: PanelPlanState, stage: Stage, features: Sequence[Feature]) -> list[Feature]:
    return [f for f in features if f.kind in stage.on and f.id not in state.slopes]


def _requirement(state: PanelPlanState, feature: Feature) -> ToolRequirement:
    space = state.space
    outline = space.silhouette()
    return ToolRequirement(
        depth=space.top - profile_bottom(space, feature.id in state.halved),
        envelope_area=space.around().minus(outline),
        wanted=space.blank_area().minus(outline),
        corner_radius=0.0,
        near=NEAR_ROUGH,
    )


def _task(
    state: PanelPlanState, stage: Stage, feature: Feature, requirement: ToolRequirement
) -> OperationTask:
    space = state.space
    low, high = space.silhouette().box()
    side = float(np.max([low - space.blank_low[:2], space.blank_high[:2] - high]))
    return OperationTask(
        id=state.task_id(stage, feature),
        half=feature.id in state.halved,
        stage=stage,
        feature=feature.id,
        requirement=requirement,
        width=side,
        position=(float(space.blank_low[0]), float(space.blank_low[1])),
        faces=feature.with_role("wall", "corner"),
        height=requirement.depth,
    )


def _is_slender(state: PanelPlanState, tool: Tool) -> bool:
    return tool.stickout / tool.diameter > state.settings.slender


OUTLINE_TASK_MAKERS: Mapping[
    str, Callable[[PanelPlanState, Stage, Sequence[Feature]], list[OperationTask]]
] = {
    "profile_rough": _profile_tasks,
    "profile_finish": _profile_tasks,
    "outline_rest": _corner_tasks,
    "outline_corner": _corner_tasks,
}
"""The rule behind each word that a typical plan gives for the cutter of a stage on the outline."""
