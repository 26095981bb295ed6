"""The cutters of a freeform pocket's walls and curved floors: those that may be taken, what they reach, how long they take."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from trunnion.findings import Finding, error, face_tags, warning
from trunnion.geometry.arrays import Bools
from trunnion.model.tool import Tool
from trunnion.plan.allowances import allowance_of
from trunnion.plan.cutting.milling import CuttingSettings, cutting_data
from trunnion.plan.freeform.cutters.choice import (
    NEGLIGIBLE,
    AreaCutters,
    CutterStep,
    by_corner,
    by_diameter,
    cutter_for,
)
from trunnion.plan.freeform.estimate.scallop import level_step, stepover_on_plane
from trunnion.plan.freeform.reach import AreaSamples, leans, samples_on
from trunnion.plan.panel.freeform.planning import FreeformPlanning
from trunnion.plan.panel.freeform.pocket import FreeformPocket
from trunnion.plan.panel.tasks import PanelPlanState
from trunnion.plan.prismatic.regions import number
from trunnion.plan.tool_choice import depth_reached
from trunnion.settings import choose
from trunnion.shop import Stage
from trunnion.units import SECONDS_PER_MINUTE, trimmed

LAP = 5.0
"""degrees by which waterlines and passes of constant scallop go on past the slope where they meet."""
SAMPLES = 600
"""Positions on the faces of a pocket that its cutters are chosen by: one stands for less than what is left to no further cutter."""
WORTH_NAMING = 1.0
"""mm2: less that no cutter reaches needs no word."""


def cutters_of(
    state: PanelPlanState,
    known: FreeformPlanning,
    pocket: FreeformPocket,
    what: str,
    faces: tuple[int, ...],
) -> tuple[AreaSamples, AreaCutters]:
    """Return samples on faces of a pocket and the cutters for them, worked out once: for sides the roundest end that reaches, for curved
    floors the largest ball."""
    key = (pocket.feature.id, what)
    if key not in known.cutters:
        samples = pocket.holds(samples_on(known.curved.skin, faces, SAMPLES))
        sides = what == "sides"
        if pocket.curved:
            # Over curved floors the slope parts what waterlines finish from what passes of constant scallop do.
            lean, limit = leans(samples), known.settings.steep
            steep = lean > math.radians(limit - LAP)
            samples = samples.of(steep if sides else lean < math.radians(limit + LAP))
        tools = side_cutters(state, pocket) if sides else balls(state)
        known.cutters[key] = (
            samples,
            cutter_for(
                known.curved,
                samples,
                tools,
                known.settings.share,
                state.settings.reach_clearance,
                None,
                state.progress,
                by_corner if sides else by_diameter,
            ),
        )
    return known.cutters[key]


def balls(state: PanelPlanState) -> list[Tool]:
    """Return the balls for the material that are no larger than is wanted."""
    tools = state.shop.tools_for(state.material.iso_group, "surface")
    return [t for t in tools if t.form == "ball" and t.diameter <= state.settings.largest]


def sharper_steps(
    state: PanelPlanState,
    known: FreeformPlanning,
    pocket: FreeformPocket,
    samples: AreaSamples,
    steps: Sequence[CutterStep],
) -> tuple[CutterStep, ...]:
    """Return the step of an end mill with a sharper corner than any ball for what all balls leave at a sharp foot of a curved floor; none
    where it reaches hardly anything more."""
    last = steps[-1].tool
    missed = ~np.logical_or.reduce([step.rows for step in steps])
    deep = pocket.top - pocket.bottom + state.settings.reach_clearance
    sharper = [
        t
        for t in mills_and_balls(state, 0.0, deep)
        if t.form == "bull" and 0.0 < t.corner_radius < last.corner_radius
    ]
    if not missed.any() or not sharper:
        return ()
    found = cutter_for(
        known.curved,
        samples.of(missed),
        sharper,
        known.settings.share,
        state.settings.reach_clearance,
        None,
        state.progress,
        by_corner,
    )
    if found.tool is None or found.reached.sum() <= NEGLIGIBLE * len(samples):
        return ()
    rows = missed.copy()
    rows[missed] = found.reached
    return (CutterStep(tool=found.tool, rows=rows, earlier=last),)


def side_cutters(state: PanelPlanState, pocket: FreeformPocket) -> list[Tool]:
    """Return the end mills and balls that come through a pocket's corners; of each size the shortest that is as long as it is deep.

    Corners and fillets are by so much sharper as the pocket keeps on its walls.
    """
    kept = allowance_of(pocket.feature).wall_allowance
    corner = max(number(pocket.feature, "corner_radius") - kept, 0.0) * state.settings.corner_share
    deep = pocket.top - pocket.bottom + state.settings.reach_clearance
    tools = mills_and_balls(state, corner, deep)
    if kept <= 0.0 or pocket.fillet <= 0.0:
        return tools
    return [t for t in tools if t.corner_radius <= pocket.fillet - kept] or tools


def mills_and_balls(state: PanelPlanState, corner: float, deep: float) -> list[Tool]:
    """Return the end mills and balls of at most a radius in mm (0: of any), where there are such; of each size the shortest that reaches as
    `deep` in mm."""
    mills = state.shop.tools_for(state.material.iso_group, "finish")
    tools = [t for t in (*mills, *balls(state)) if t.form in ("flat", "bull", "ball")]
    tools = [t for t in tools if t.diameter <= state.settings.largest]
    small = [t for t in tools if corner <= 0.0 or t.radius <= corner] or tools
    found: dict[tuple[float, float], Tool] = {}
    for tool in sorted(small, key=lambda t: (depth_reached(t), t.name)):
        size = tool.diameter, tool.corner_radius
        if size not in found or depth_reached(found[size]) < deep:
            found[size] = tool
    return list(found.values())


def area_rate(state: PanelPlanState, tool: Tool, height: float) -> float:
    """Return what a ball finishes in mm2/min: the distance of its passes on a plane times its feed."""
    width = stepover_on_plane(tool.corner_radius, height)
    cutting = choose(CuttingSettings, state.choices)
    data = cutting_data(tool, state.material, state.machine, "finish", cutting, height, width)
    return width * data.feed


def level_time(
    state: PanelPlanState, samples: AreaSamples, height: float, tool: Tool, rows: Bools
) -> float:
    """Return how long in min level passes over samples (k,) take: their areas seen from the side over the steps, at the cutter's feed."""
    up = samples.normal[rows, 2]
    flank = max(tool.flute_length - tool.corner_radius, tool.corner_radius)
    step = level_step(tool.corner_radius, height, up, flank)
    cutting = choose(CuttingSettings, state.choices)
    width = stepover_on_plane(tool.corner_radius or 0.5 * tool.radius, height)
    data = cutting_data(tool, state.material, state.machine, "finish", cutting, height, width)
    side = np.sqrt(np.maximum(1.0 - up * up, 0.0))
    return float((samples.area * side / step).sum() / data.feed)


def tool_change(state: PanelPlanState) -> float:
    """Return what one more tool takes in min."""
    return state.machine.tool_change_s / SECONDS_PER_MINUTE


def report_unreached(
    state: PanelPlanState, pocket: FreeformPocket, samples: AreaSamples, cutters: AreaCutters
) -> None:
    """Tell which sides no upright cutter comes to: what leans over, and what lies under it."""
    seen = {int(t): cutters.reachable[samples.face == t] for t in np.unique(samples.face)}
    lost = [t for t, rows in seen.items() if not rows.all()]
    area = samples.area * float((~cutters.reachable).sum())
    if area < WORTH_NAMING or not lost:
        return
    state.findings.append(
        warning(
            "route.not-planned",
            f"{pocket.feature.id}: {trimmed(area, 0)} mm2 of its sides lean over or lie under what does, no upright cutter reaches "
            "them; the rest of it is planned",
            pocket.feature.id,
            *face_tags(lost),
            remedy="machine them on a machine with rotary axes or from another side; the proof counts what is left",
        )
    )


def no_cutter(pocket: FreeformPocket, stage: Stage, faces: Sequence[int]) -> Finding:
    return error(
        "route.no-cutter",
        f"{pocket.feature.id}: no cutter of the catalogue reaches its faces ({stage.name})",
        pocket.feature.id,
        *face_tags(faces),
        remedy="add a longer or smaller cutter to the tools folder",
    )
