"""The operations that clear freeform pockets: layers, and layers with a smaller cutter in corners."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from trunnion import tolerance
from trunnion.geometry.plane.region import EMPTY_REGION
from trunnion.model.feature import Feature
from trunnion.model.tool import Tool
from trunnion.plan.cutting.milling import CuttingSettings, roughing_depth, roughing_width
from trunnion.plan.freeform.keys import ALLOWANCE, BOTTOM, CELL, LAYER
from trunnion.plan.panel.freeform.planning import (
    FreeformPlanning,
    kept_off,
    layer_height,
    pocket_task,
    pockets_of,
)
from trunnion.plan.panel.freeform.pocket import FreeformPocket
from trunnion.plan.panel.tasks import (
    NEAR_ROUGH,
    NEAR_WALL,
    SHARP,
    SPARE,
    OperationTask,
    PanelPlanState,
    catalogue,
)
from trunnion.plan.prismatic.regions import number
from trunnion.plan.tool_choice import ToolRequirement, depth_reached, fits_through
from trunnion.settings import choose
from trunnion.shop import Stage

DEPTHS = 4
"""Heights over a curved floor, evenly between its lowest and its highest place, at which its rest cutter has to come down."""
LEAST_GAP = 0.5
"""Of a layer's height: no rest cutter is asked for gaps that are less deep, whatever is finished with."""


def layer_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    found = []
    for known, pocket in pockets_of(state, stage, features):
        requirement = _rough_requirement(state, known, pocket)
        if pocket.feature.kind == "open_pocket" or not any(
            requirement.envelope_area.offset(-SPARE * t.radius) for t in catalogue(state, stage)
        ):
            requirement = replace(requirement, spare=1.0)
        found.append(_layers(state, stage, known, pocket, requirement, stage.kind))
    return found


def rest_layer_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    """Ask for layers with a cutter that comes through the corners, and down beside what rises of a curved floor, where the first one is too
    large for these."""
    found = []
    for known, pocket in pockets_of(state, stage, features):
        before = state.tools.get(f"rough-{pocket.feature.id}")
        if before is None:
            continue
        corner = number(pocket.feature, "corner_radius") * state.settings.corner_share
        requirement = replace(
            _rough_requirement(state, known, pocket),
            radius=corner,
            missable=SHARP,
            spare=1.0,
            near=NEAR_WALL,
        )
        requirement = _down_to_curved_floor(state, stage, known, pocket, requirement)
        is_through = fits_through(replace(requirement, radius=0.0), before, catalogue(state, stage))
        if is_through and not 0.0 < corner < before.radius:
            continue
        found.append(_layers(state, stage, known, pocket, requirement, "rest"))
    return found


def _rough_requirement(
    state: PanelPlanState, known: FreeformPlanning, pocket: FreeformPocket
) -> ToolRequirement:
    """Return what a roughing cutter of a pocket has to fit: its floors, kept off its sides by what layers leave there."""
    kept = pocket.layer_area().remaining(known.settings.cell, state.settings.floor_allowance)
    _, levels = pocket.floors()
    areas = [(kept_off(v.boundary, kept), kept_off(v.wanted, kept)) for v in levels]
    if not areas:
        areas = [(kept_off(pocket.mouth, kept), kept_off(pocket.mouth, kept))]
    envelope_area, wanted = areas[-1]
    return ToolRequirement(
        depth=state.space.top - pocket.bottom,
        envelope_area=envelope_area,
        wanted=wanted,
        corner_radius=pocket.fillet,
        missable=state.settings.missable,
        spare=SPARE,
        near=NEAR_ROUGH,
        others=tuple(areas[:-1]),
    )


def _down_to_curved_floor(
    state: PanelPlanState,
    stage: Stage,
    known: FreeformPlanning,
    pocket: FreeformPocket,
    requirement: ToolRequirement,
) -> ToolRequirement:
    """Return a requirement whose cutter also leaves nothing on a curved floor that is higher than the flutes of what finishes it.

    Between a wall and a floor that falls towards it a cutter comes no lower than where the gap is as wide as itself. What stays below meets
    the necks of the finishing cutters where it is higher than the shortest of their flutes. So at each height the cutter has to cover what
    is free by so much lower, less a layer and its allowance, by which layers stand over the floor anyhow. Where no cutter of the catalogue
    covers a gap, the slimmest one's share of it is wanted.
    """
    finishing = known.finishing.get(pocket.feature.id, ())
    tools, clearance = catalogue(state, stage), state.settings.reach_clearance
    deep = [t for t in tools if depth_reached(t) >= requirement.depth + clearance]
    if not pocket.curved or not finishing or not deep:
        return requirement
    allowance, layer = state.settings.floor_allowance, layer_height(pocket, known.settings)
    flutes = min(t.flute_length for t in finishing)
    lower = max(flutes - layer - allowance, LEAST_GAP * layer)
    kept = pocket.layer_area().remaining(known.settings.cell, allowance)
    slimmest = min(deep, key=lambda t: (t.diameter, t.name))
    areas = list(requirement.others)
    for z in np.linspace(pocket.bottom, pocket.crest, DEPTHS + 1)[:-1] + lower:
        around = pocket.free_at(float(z)).offset(-kept) if z < pocket.rim else EMPTY_REGION
        under = pocket.free_at(float(z - lower) + tolerance.OFF_PLANE).offset(-kept)
        wanted = under.intersect(around.opened(slimmest.radius)) if around and under else around
        if wanted and under:
            areas.append((around, wanted))
    return replace(requirement, others=tuple(areas))


def _layers(
    state: PanelPlanState,
    stage: Stage,
    known: FreeformPlanning,
    pocket: FreeformPocket,
    requirement: ToolRequirement,
    name: str,
) -> OperationTask:
    settings, cutting = known.settings, choose(CuttingSettings, {})
    layer = layer_height(pocket, settings)

    def engagement(tool: Tool) -> tuple[float, float]:
        return roughing_depth(tool, state.material, cutting), roughing_width(
            tool, state.material, cutting
        )

    return pocket_task(
        state,
        stage,
        pocket,
        f"{name}-{pocket.feature.id}",
        requirement,
        (),
        {
            ALLOWANCE: state.settings.floor_allowance,
            # Lower than the lowest floor's allowance only holes in it are free.
            BOTTOM: pocket.bottom + (0.0 if pocket.curved else state.settings.floor_allowance),
            CELL: settings.cell,
            **({LAYER: layer} if math.isfinite(layer) else {}),
        },
        engagement,
    )
