"""The operations that stages on pockets with leaning walls or curved floors request: layers, level floors, sides, curved floors."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from trunnion.findings import Finding, Refused, error, face_tags, warning
from trunnion.geometry.arrays import Bools
from trunnion.geometry.plane.region import Region
from trunnion.model.feature import Feature
from trunnion.model.tool import Tool
from trunnion.plan.cutting.milling import (
    CuttingSettings,
    cutting_data,
    roughing_depth,
    roughing_width,
)
from trunnion.plan.freeform.cutters.choice import (
    AreaCutters,
    CutterStep,
    by_corner,
    by_diameter,
    cutter_for,
    with_larger_first,
    with_rounder_between,
)
from trunnion.plan.freeform.estimate.scallop import level_step, stepover_on_plane
from trunnion.plan.freeform.finishing.chord import chord_choices
from trunnion.plan.freeform.keys import ALLOWANCE, BOTTOM, CELL, EARLIER, SCALLOP
from trunnion.plan.freeform.reach import AreaSamples, leans, samples_on
from trunnion.plan.freeform.space import SurfaceSpace
from trunnion.plan.panel.freeform_pocket import FreeformPocket
from trunnion.plan.panel.leaning_settings import LeaningSettings
from trunnion.plan.panel.tasks import (
    FLOOR_DISTANCE,
    NEAR_FLOOR,
    NEAR_ROUGH,
    NEAR_WALL,
    SHARP,
    SPARE,
    OperationTask,
    PanelPlanState,
    catalogue,
)
from trunnion.plan.prismatic.lean import POCKETS
from trunnion.plan.prismatic.regions import number
from trunnion.plan.tool_choice import Candidates, ToolRequirement, depth_reached, fits_through
from trunnion.settings import Value, choose
from trunnion.shop import Stage
from trunnion.units import SECONDS_PER_MINUTE, trimmed

FLOOR_WIDTH = 0.6
"""Distance of a floor's passes over the width of the cutter's flat."""
FOOT = 2.0
"""degrees: at the foot of sides over level floors, what leans less from level is the floor's; a fillet ends in it."""
LAP = 5.0
"""degrees by which waterlines and passes of constant scallop go on past the slope where they meet."""
SAMPLES = 600
"""Positions on the faces of a pocket that its cutters are chosen by: one stands for less than what is left to no further cutter."""
HANGING = 2.0
"""Times what layers leave: beside walls that lean over it stands as high as the pocket is deep, thicker in corners."""
REST_LEAD = 0.3
"""mm: radius of leads in rest finishing: what is left lies beside faces that stand up."""
WORTH_NAMING = 1.0
"""mm2: less that no cutter reaches needs no word."""
SIDES_STRATEGY, FLOOR_STRATEGY = "surface.waterline", "surface.constant"
NEEDED = frozenset({"layers", "sides"})
"""Rules without which a typical plan knows no leaning walls."""


@dataclass(slots=True, kw_only=True)
class FreeformPlanning:
    """What is known of a setup's freeform pockets while it is planned: their spaces, and the cutters of their sides and curved floors with
    the samples that these were chosen by."""

    curved: SurfaceSpace
    settings: LeaningSettings
    pockets: dict[str, FreeformPocket | None] = field(default_factory=dict)
    cutters: dict[tuple[str, str], tuple[AreaSamples, AreaCutters]] = field(default_factory=dict)


def _planning(state: PanelPlanState) -> FreeformPlanning | None:
    if state.curved is None:
        return None
    if state.freeform is None:
        state.freeform = FreeformPlanning(
            curved=state.curved(), settings=choose(LeaningSettings, state.choices)
        )
    known: FreeformPlanning = state.freeform
    return known


def _pockets(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[tuple[FreeformPlanning, FreeformPocket]]:
    """Return the freeform pockets of a stage; one without free space is told of once and left out."""
    mine = [
        f
        for f in features
        if f.kind in stage.on and f.kind in POCKETS and state.space.is_freeform(f)
    ]
    known = _planning(state) if mine else None
    if known is None:
        return []
    for feature in state.progress.each(mine):
        if feature.id not in known.pockets:
            try:
                known.pockets[feature.id] = FreeformPocket.of(
                    feature,
                    state.space,
                    known.curved,
                    state.adjacent.get(feature.id, frozenset()),
                )
            except Refused as reason:
                known.pockets[feature.id] = None
                state.findings.append(
                    warning("route.not-planned", str(reason), feature.id, *face_tags(feature.tags))
                )
    return [(known, p) for f in mine if (p := known.pockets[f.id]) is not None]


def _layer_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    found = []
    for known, pocket in _pockets(state, stage, features):
        requirement = _rough_requirement(state, known, pocket)
        if pocket.feature.kind == "open_pocket" or not any(
            requirement.envelope_area.offset(-SPARE * t.radius) for t in catalogue(state, stage)
        ):
            requirement = replace(requirement, spare=1.0)
        found.append(_layers(state, stage, known, pocket, requirement, stage.kind))
    return found


def _rest_layer_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    """Ask for layers with a cutter that comes through the corners, where the first one is too large for these."""
    found = []
    for known, pocket in _pockets(state, stage, features):
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
    areas = [(_kept_off(v.boundary, kept), _kept_off(v.wanted, kept)) for v in levels]
    if not areas:
        areas = [(_kept_off(pocket.mouth, kept), _kept_off(pocket.mouth, kept))]
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


def _kept_off(area: Region, distance: float) -> Region:
    return area.offset(-distance) or area


def _layers(
    state: PanelPlanState,
    stage: Stage,
    known: FreeformPlanning,
    pocket: FreeformPocket,
    requirement: ToolRequirement,
    name: str,
) -> OperationTask:
    settings, cutting = known.settings, choose(CuttingSettings, {})
    layer = _layer(pocket, settings)

    def engagement(tool: Tool) -> tuple[float, float]:
        depth = roughing_depth(tool, state.material, cutting)
        return min(depth, layer), roughing_width(tool, state.material, cutting)

    return _task(
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
        },
        engagement,
    )


def _layer(pocket: FreeformPocket, settings: LeaningSettings) -> float:
    """Return the largest height of a pocket's layers in mm: their steps stand out of the leaning walls by no more than is wanted."""
    lean = settings.step / pocket.growth if pocket.growth > 0.0 else math.inf
    return min(lean, settings.layer) if pocket.curved else lean


def _task(
    state: PanelPlanState,
    stage: Stage,
    pocket: FreeformPocket,
    id: str,
    requirement: ToolRequirement,
    faces: tuple[int, ...],
    choices: Mapping[str, Value],
    engagement: Callable[[Tool], tuple[float, float]],
    found: Candidates | None = None,
    why: str = "",
) -> OperationTask:
    low, high = pocket.mouth.box()
    middle = 0.5 * (low + high)
    return OperationTask(
        id=id,
        stage=stage,
        feature=pocket.feature.id,
        position=(float(middle[0]), float(middle[1])),
        requirement=requirement,
        faces=faces,
        height=state.space.top - pocket.bottom,
        width=float(np.min(high - low)),
        found=found,
        why=why,
        choices=choices,
        engagement=engagement,
    )


def _floor_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    found = []
    for known, pocket in _pockets(state, stage, features):
        floors, levels = pocket.floors()
        if not floors:
            continue
        distance = _floor_distance(state, known, pocket)
        areas = [(_kept_off(v.boundary, distance), _kept_off(v.wanted, distance)) for v in levels]
        requirement = ToolRequirement(
            depth=state.space.top - floors[-1].z,
            envelope_area=areas[-1][0],
            wanted=areas[-1][1],
            corner_radius=pocket.fillet,
            missable=SHARP,
            near=NEAR_FLOOR,
            others=tuple(areas[:-1]),
        )

        def engagement(tool: Tool) -> tuple[float, float]:
            flat = tool.diameter - 2.0 * tool.corner_radius
            return state.settings.floor_allowance, FLOOR_WIDTH * flat

        found.append(
            _task(
                state,
                stage,
                pocket,
                f"floor-{pocket.feature.id}",
                requirement,
                tuple(f.face for f in floors),
                {"plane.floor.wall_distance": distance},
                engagement,
            )
        )
    return found


def _floor_distance(
    state: PanelPlanState, known: FreeformPlanning, pocket: FreeformPocket
) -> float:
    """Return what a floor's cutter keeps from the sides: it must not meet what layers leave there, which the foot of waterlines cuts."""
    left = pocket.layer_area().remaining(known.settings.cell, state.settings.floor_allowance)
    return left + FLOOR_DISTANCE


def _side_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    found = []
    for known, pocket in _pockets(state, stage, features):
        settings = known.settings
        samples, cutters = _cutters(state, known, pocket, "sides", pocket.sides)
        _report_unreached(state, pocket, samples, cutters)
        if cutters.tool is None:
            if len(samples):
                state.findings.append(_no_cutter(pocket, stage, pocket.sides))
            continue
        left = pocket.layer_area().remaining(settings.cell, state.settings.floor_allowance)
        left += settings.step
        if pocket.hang > 0.0:
            # What stays at a wall that leans over is nowhere finished: necks keep off more than elsewhere.
            left *= HANGING
        shallowest = max(settings.steep - LAP, FOOT) if pocket.curved else FOOT
        steps = with_rounder_between(
            cutters,
            _side_cutters(state, pocket),
            partial(_level_time, state, samples, settings.scallop),
            _tool_change(state),
        )
        for n, step in enumerate(steps):
            choices: dict[str, Value] = {
                SCALLOP: settings.scallop,
                ALLOWANCE: 0.0,
                f"{SIDES_STRATEGY}.shallowest": shallowest,
                **chord_choices(SIDES_STRATEGY, settings.scallop),
                **_after(SIDES_STRATEGY, step.earlier),
            }
            found.append(
                _surface_task(
                    state, stage, pocket, step, samples, choices, (left, settings.scallop), n
                )
            )
    return found


def _curved_floor_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    return _on_curved_floors(state, stage, features, semi=False)


def _curved_semi_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    return _on_curved_floors(state, stage, features, semi=True)


def _on_curved_floors(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature], *, semi: bool
) -> list[OperationTask]:
    found = []
    for known, pocket in _pockets(state, stage, features):
        settings = known.settings
        if not pocket.curved or (semi and settings.semi_allowance <= 0.0):
            continue
        faces = (*pocket.curved, *_feet(state, pocket))
        samples, cutters = _cutters(state, known, pocket, "floor", faces)
        if cutters.tool is None:
            if not semi:
                state.findings.append(_no_cutter(pocket, stage, faces))
            continue
        left = pocket.layer_area().remaining(settings.cell, state.settings.floor_allowance)
        left += 0.5 * _layer(pocket, settings)
        height = settings.semi_scallop if semi else settings.scallop
        is_after_layers = semi or settings.semi_allowance <= 0.0
        steps = with_larger_first(
            cutters,
            _balls(state),
            samples.area,
            partial(_area_rate, state, height=settings.scallop),
            _tool_change(state),
        )
        for n, step in enumerate(steps):
            choices: dict[str, Value] = {
                SCALLOP: height,
                ALLOWANCE: settings.semi_allowance if semi else 0.0,
                f"{FLOOR_STRATEGY}.steepest": settings.steep + LAP,
                **chord_choices(FLOOR_STRATEGY, height),
                **_after(FLOOR_STRATEGY, step.earlier),
            }
            depth = left if is_after_layers else settings.semi_allowance
            found.append(
                _surface_task(state, stage, pocket, step, samples, choices, (depth, height), n)
            )
    return found


def _feet(state: PanelPlanState, pocket: FreeformPocket) -> tuple[int, ...]:
    """Return the fillets at the foot of a pocket's sides that stand on its curved floors."""
    graph, own = state.space.part.graph(), set(pocket.sides)
    beside = {n + 1 for t in pocket.curved for n in graph.neighbours(t - 1)}
    fillets = {
        t
        for f in (pocket.feature, *state.space.islands_of(pocket.feature))
        for t in f.with_role("floor_fillet")
    }
    return tuple(sorted(own & beside & fillets))


def _after(strategy: str, earlier: Tool | None) -> dict[str, Value]:
    if earlier is None:
        return {}
    return {EARLIER: earlier.name, f"{strategy}.lead_radius": REST_LEAD}


def _surface_task(
    state: PanelPlanState,
    stage: Stage,
    pocket: FreeformPocket,
    step: CutterStep,
    samples: AreaSamples,
    choices: Mapping[str, Value],
    cut: tuple[float, float],
    n: int = 1,
) -> OperationTask:
    """Return the task of the `n`-th cutter after an area's first one on the faces of its samples; `cut` is what stands on them and the
    scallop height that is wanted, mm."""
    (depth, height), tool, earlier = cut, step.tool, step.earlier
    samples = samples.of(step.rows)
    faces = tuple(int(t) for t in np.unique(samples.face))
    width = stepover_on_plane(tool.corner_radius or 0.5 * tool.radius, height)
    area = samples.area * len(samples)
    why = (
        f"over {trimmed(area, 0)} mm2: scallops of {trimmed(1000.0 * height, 1)} um, "
        f"{trimmed(width, 3)} mm between passes on a plane."
    )
    if earlier is not None:
        why = f"{why} What {earlier.name} is lifted off by other faces is left to it."
    return _task(
        state,
        stage,
        pocket,
        f"{stage.kind}-{pocket.feature.id}{_rest_name(n) if earlier else ''}",
        ToolRequirement(
            depth=state.space.top - pocket.bottom,
            envelope_area=pocket.mouth,
            wanted=pocket.mouth,
            corner_radius=tool.corner_radius,
        ),
        faces,
        choices,
        lambda _: (depth, width),
        Candidates(tools=(tool,)),
        why,
    )


def _rest_name(n: int) -> str:
    """Return the end of the name of an area's `n`-th operation on a rest: `-rest`, then `-rest-2`."""
    return "-rest" if n < 2 else f"-rest-{n}"


def _area_rate(state: PanelPlanState, tool: Tool, height: float) -> float:
    """Return what a ball finishes in mm2/min: the distance of its passes on a plane times its feed."""
    width = stepover_on_plane(tool.corner_radius, height)
    cutting = choose(CuttingSettings, state.choices)
    data = cutting_data(tool, state.material, state.machine, "finish", cutting, height, width)
    return width * data.feed


def _level_time(
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


def _tool_change(state: PanelPlanState) -> float:
    """Return what one more tool takes in min."""
    return state.machine.tool_change_s / SECONDS_PER_MINUTE


def _cutters(
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
        tools = _side_cutters(state, pocket) if sides else _balls(state)
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


def _balls(state: PanelPlanState) -> list[Tool]:
    tools = state.shop.tools_for(state.material.iso_group, "surface")
    return [t for t in tools if t.form == "ball" and t.diameter <= state.settings.largest]


def _side_cutters(state: PanelPlanState, pocket: FreeformPocket) -> list[Tool]:
    """Return the end mills and balls that come through a pocket's corners; of each size the shortest that is as long as it is deep."""
    mills = state.shop.tools_for(state.material.iso_group, "finish")
    tools = [t for t in (*mills, *_balls(state)) if t.form in ("flat", "bull", "ball")]
    tools = [t for t in tools if t.diameter <= state.settings.largest]
    corner = number(pocket.feature, "corner_radius") * state.settings.corner_share
    small = [t for t in tools if corner <= 0.0 or t.radius <= corner] or tools
    deep = pocket.top - pocket.bottom + state.settings.reach_clearance
    found: dict[tuple[float, float], Tool] = {}
    for tool in sorted(small, key=lambda t: (depth_reached(t), t.name)):
        size = tool.diameter, tool.corner_radius
        if size not in found or depth_reached(found[size]) < deep:
            found[size] = tool
    return list(found.values())


def _report_unreached(
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


def _no_cutter(pocket: FreeformPocket, stage: Stage, faces: Sequence[int]) -> Finding:
    return error(
        "route.no-cutter",
        f"{pocket.feature.id}: no cutter of the catalogue reaches its faces ({stage.name})",
        pocket.feature.id,
        *face_tags(faces),
        remedy="add a longer or smaller cutter to the tools folder",
    )


FREEFORM_TASK_MAKERS: Mapping[
    str, Callable[[PanelPlanState, Stage, Sequence[Feature]], list[OperationTask]]
] = {
    "layers": _layer_tasks,
    "rest_layers": _rest_layer_tasks,
    "leaning_floor": _floor_tasks,
    "sides": _side_tasks,
    "curved_semi": _curved_semi_tasks,
    "curved_floor": _curved_floor_tasks,
}
"""The rule behind each word that a typical plan gives for the cutter of a stage on leaning walls and curved floors."""
