"""The operations on slopes outside of pockets: leaning sides of the outline, fringes on it, and chamfers of any angle."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial

import numpy as np

from trunnion import tolerance
from trunnion.findings import face_tags, warning
from trunnion.model.feature import Feature
from trunnion.model.tool import Tool
from trunnion.plan.cutting.milling import CuttingSettings, roughing_depth
from trunnion.plan.freeform.cutters.choice import (
    AreaCutters,
    CutterStep,
    by_corner,
    cutter_for,
    steps_of,
    with_rounder_between,
)
from trunnion.plan.freeform.estimate.scallop import stepover_on_plane
from trunnion.plan.freeform.finishing.chord import chord_choices
from trunnion.plan.freeform.keys import ALLOWANCE, SCALLOP
from trunnion.plan.freeform.reach import AreaSamples, leans, samples_on
from trunnion.plan.panel.freeform.cutters import (
    SAMPLES,
    WORTH_NAMING,
    balls,
    level_time,
    mills_and_balls,
    tool_change,
)
from trunnion.plan.panel.freeform.finishing_tasks import FOOT, after_earlier, rest_name
from trunnion.plan.panel.freeform.planning import FreeformPlanning, planning_of
from trunnion.plan.panel.tasks import OperationTask, PanelPlanState
from trunnion.plan.prismatic.lean import LEANING
from trunnion.plan.tool_choice import Candidates, ToolRequirement
from trunnion.settings import Value, choose
from trunnion.shop import Stage
from trunnion.units import trimmed

STRATEGY = "surface.waterline"
WIDTH = 0.5
"""Of the cutter's diameter: what a pass takes of the stock outside of a slope at most."""
LEVEL = math.sin(tolerance.ANGLE)
"""Least height of a unit normal that looks down: upright faces among slopes are cut with these."""
STEEPEST = math.radians(89.0)
"""Slopes are taken for no steeper when the height of their levels is worked out."""


def slope_rough_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    """Ask for level passes that take what stands outside of slopes, past what the outline's cutter leaves, in as many as that is wide."""
    found = []
    for known, feature, samples, cutters in _slopes(state, stage, features):
        tool, allowance = cutters.tool, state.settings.wall_allowance
        if tool is None:
            continue
        mine = samples.of(cutters.reached)
        thickness = float(state.space.silhouette().signed_distance(mine.point[:, :2]).max())
        wide = WIDTH * tool.diameter
        count = math.ceil(thickness / wide)
        if thickness <= allowance:
            continue
        step = min(
            known.settings.step * math.tan(min(float(leans(mine).max()), STEEPEST)),
            roughing_depth(tool, state.material, choose(CuttingSettings, {})),
        )
        for n in reversed(range(count)):
            choices: dict[str, Value] = {
                SCALLOP: known.settings.step,
                ALLOWANCE: allowance + n * wide,
                f"{STRATEGY}.step": step,
                f"{STRATEGY}.shallowest": FOOT,
                **chord_choices(STRATEGY, allowance),
            }
            whole = CutterStep(tool=tool, rows=cutters.reached)
            name = state.task_id(stage, feature) + (f"-{count - n}" if count > 1 else "")
            found.append(_task(state, stage, feature, name, whole, samples, choices, (wide, step)))
    return found


def slope_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    """Ask for level passes that finish slopes, the roundest end that reaches them first."""
    found = []
    for known, feature, samples, cutters in _slopes(state, stage, features):
        _report_unreached(state, feature, samples, cutters)
        height = known.settings.scallop
        steps = (
            with_rounder_between(
                cutters,
                _tools(state, feature),
                partial(level_time, state, samples, height),
                tool_change(state),
            )
            if feature.kind != "chamfer"
            else steps_of(cutters)
        )
        for n, step in enumerate(steps):
            choices: dict[str, Value] = {
                SCALLOP: height,
                ALLOWANCE: 0.0,
                f"{STRATEGY}.shallowest": FOOT,
                **chord_choices(STRATEGY, height),
                **after_earlier(STRATEGY, step.earlier),
            }
            width = stepover_on_plane(step.tool.corner_radius or 0.5 * step.tool.radius, height)
            name = state.task_id(stage, feature) + (rest_name(n) if step.earlier else "")
            left = _thickness_on(state, known, feature)
            found.append(_task(state, stage, feature, name, step, samples, choices, (left, width)))
    return found


def _thickness_on(state: PanelPlanState, known: FreeformPlanning, feature: Feature) -> float:
    """Return how thick in mm stock stands on a slope that is finished: a chamfer's is still whole, half its width at most."""
    width = feature.sizes.get("width")
    if feature.kind == "chamfer" and isinstance(width, (int, float)):
        return float(width)
    return state.settings.wall_allowance + known.settings.step


def _slopes(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[tuple[FreeformPlanning, Feature, AreaSamples, AreaCutters]]:
    """Return the features of a stage with slopes that look up in the setup, samples on these, and the cutters for them, worked out once."""
    found = []
    mine = [f for f in features if f.kind in stage.on and slopes_of(f)]
    known = planning_of(state) if mine else None
    for feature in state.progress.each(mine) if known is not None else ():
        key = (feature.id, "slopes")
        if known is not None and key not in known.cutters:
            samples = samples_on(known.curved.skin, slopes_of(feature), SAMPLES)
            samples = samples.of(samples.normal[:, 2] > -LEVEL)
            known.cutters[key] = (
                samples,
                cutter_for(
                    known.curved,
                    samples,
                    _tools(state, feature),
                    known.settings.share,
                    state.settings.reach_clearance,
                    None,
                    state.progress,
                    by_corner,
                ),
            )
        if known is not None and len(known.cutters[key][0]):
            found.append((known, feature, *known.cutters[key]))
    return found


def slopes_of(feature: Feature) -> tuple[int, ...]:
    """Return the tags of a feature's faces that lean and are no pocket's: all of a chamfer and of a fringe on the outline."""
    if feature.kind == "profile":
        return feature.with_role(*LEANING)
    if feature.kind == "chamfer" or (feature.kind == "fringe" and feature.attributes.get("outer")):
        return feature.with_role("face")
    return ()


def _tools(state: PanelPlanState, feature: Feature) -> list[Tool]:
    """Return balls for chamfers; for what leans at the outline end mills too, which come down to its foot."""
    deep = state.space.top - state.space.bottom + state.settings.reach_clearance
    return balls(state) if feature.kind == "chamfer" else mills_and_balls(state, 0.0, deep)


def _task(
    state: PanelPlanState,
    stage: Stage,
    feature: Feature,
    id: str,
    step: CutterStep,
    samples: AreaSamples,
    choices: dict[str, Value],
    cut: tuple[float, float],
) -> OperationTask:
    """Return the task of a cutter on the faces of its samples; `cut` is how thick what it takes is and how far its levels are apart, mm."""
    mine, tool, space = samples.of(step.rows), step.tool, state.space
    low, high = mine.point.min(axis=0), mine.point.max(axis=0)
    area = mine.area * len(mine)
    around = space.around()
    return OperationTask(
        id=id,
        stage=stage,
        feature=feature.id,
        position=(float(low[0]), float(low[1])),
        requirement=ToolRequirement(
            depth=space.top - float(low[2]),
            envelope_area=around,
            wanted=around,
            corner_radius=tool.corner_radius,
        ),
        faces=tuple(int(t) for t in np.unique(mine.face)),
        height=float(high[2] - low[2]),
        width=float(np.min(high[:2] - low[:2])),
        found=Candidates(tools=(tool,)),
        why=f"over {trimmed(area, 0)} mm2, {trimmed(cut[0], 2)} mm thick, in levels {trimmed(cut[1], 3)} mm apart on a plane.",
        choices=choices,
        engagement=lambda _: cut,
    )


def _report_unreached(
    state: PanelPlanState, feature: Feature, samples: AreaSamples, cutters: AreaCutters
) -> None:
    area = samples.area * float((~cutters.reachable).sum())
    if area < WORTH_NAMING:
        return
    lost = np.unique(samples.face[~cutters.reachable])
    state.findings.append(
        warning(
            "route.not-planned",
            f"{feature.id}: no upright cutter reaches {trimmed(area, 0)} mm2 of its slopes; the rest of it is planned",
            feature.id,
            *face_tags(int(t) for t in lost),
            remedy="machine them on a machine with rotary axes or from another side; the proof counts what is left",
        )
    )
