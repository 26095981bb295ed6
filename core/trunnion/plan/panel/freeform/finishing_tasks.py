"""The operations that finish freeform pockets: level floors, walls by waterlines, curved floors by passes of constant scallop."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial

import numpy as np

from trunnion.model.feature import Feature
from trunnion.model.tool import Tool
from trunnion.plan.freeform.cutters.choice import (
    CutterStep,
    with_larger_first,
    with_rounder_between,
)
from trunnion.plan.freeform.estimate.scallop import stepover_on_plane
from trunnion.plan.freeform.finishing.chord import chord_choices
from trunnion.plan.freeform.keys import ALLOWANCE, EARLIER, OVERHANG, SCALLOP
from trunnion.plan.freeform.reach import AreaSamples
from trunnion.plan.panel.freeform.cutters import (
    LAP,
    area_rate,
    balls,
    cutters_of,
    level_time,
    no_cutter,
    report_unreached,
    sharper_steps,
    side_cutters,
    tool_change,
)
from trunnion.plan.panel.freeform.flank_choice import flank_of
from trunnion.plan.panel.freeform.planning import (
    FreeformPlanning,
    kept_off,
    layer_height,
    pocket_task,
    pockets_of,
)
from trunnion.plan.panel.freeform.pocket import FreeformPocket
from trunnion.plan.panel.tasks import (
    FLOOR_DISTANCE,
    NEAR_FLOOR,
    SHARP,
    WALL_DISTANCE,
    OperationTask,
    PanelPlanState,
)
from trunnion.plan.prismatic.regions import number
from trunnion.plan.tool_choice import Candidates, ToolRequirement
from trunnion.settings import Value
from trunnion.shop import Stage
from trunnion.units import trimmed

FLOOR_WIDTH = 0.6
"""Distance of a floor's passes over the width of the cutter's flat."""
FOOT = 2.0
"""degrees: at the foot of sides over level floors, what leans less from level is the floor's; a fillet ends in it."""
OVERHANG_DISTANCE = 2.0
"""Times what layers leave: beside walls that lean over it stands as high as the pocket is deep, thicker in corners."""
AFTER_FLANK = 0.1
"""mm: what a floor's cutter keeps from sides that a flank has finished, and their fillets."""
REST_LEAD = 0.3
"""mm: radius of leads in rest finishing: what is left lies beside faces that stand up."""
SIDES_STRATEGY, FLOOR_STRATEGY = "surface.waterline", "surface.constant"


def floor_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    """Ask for passes over level floors of pockets whose sides are finished after them, level by level."""
    return _on_floors(state, stage, features, after_flank=False)


def swarf_floor_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    """Ask for passes over level floors of pockets whose walls a flank has finished: up to their feet, which no waterline finishes."""
    return _on_floors(state, stage, features, after_flank=True)


def _on_floors(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature], *, after_flank: bool
) -> list[OperationTask]:
    found = []
    for known, pocket in pockets_of(state, stage, features):
        floors, levels = pocket.floors()
        if not floors or (flank_of(state, known, pocket) is not None) != after_flank:
            continue
        distance = AFTER_FLANK if after_flank else _distance_from_sides(state, known, pocket)
        areas = [(kept_off(v.boundary, distance), kept_off(v.wanted, distance)) for v in levels]
        requirement = ToolRequirement(
            depth=state.space.top - floors[-1].z,
            envelope_area=areas[-1][0],
            wanted=areas[-1][1],
            corner_radius=pocket.fillet,
            radius=_through_corners(state, known, pocket, distance),
            missable=SHARP,
            near=NEAR_FLOOR,
            others=tuple(areas[:-1]),
        )

        def engagement(tool: Tool) -> tuple[float, float]:
            flat = tool.diameter - 2.0 * tool.corner_radius
            return state.settings.floor_allowance, FLOOR_WIDTH * flat

        found.append(
            pocket_task(
                state,
                stage,
                pocket,
                f"floor-{pocket.feature.id}",
                requirement,
                tuple(f.face for f in floors),
                {WALL_DISTANCE: distance},
                engagement,
            )
        )
    return found


def _through_corners(
    state: PanelPlanState, known: FreeformPlanning, pocket: FreeformPocket, distance: float
) -> float:
    """Return the largest radius in mm of a cutter that finishes a pocket's floors at a distance (mm) from its sides, 0 for any: what it
    leaves in corners is cut by the foot of waterlines, but not by a flank."""
    if flank_of(state, known, pocket) is None:
        return 0.0
    graph, corner = state.space.part.graph(), number(pocket.feature, "corner_radius")
    if any(graph.surface[t - 1] == "cone" for t in pocket.feature.with_role("corner")):
        # A cone's radius is told half-way up; at its foot it is less where walls lean away.
        corner -= 0.5 * pocket.growth * (pocket.top - pocket.bottom)
    return max(corner * state.settings.corner_share - distance, 0.0)


def _distance_from_sides(
    state: PanelPlanState, known: FreeformPlanning, pocket: FreeformPocket
) -> float:
    """Return what a floor's cutter keeps from the sides: it must not meet what layers leave there, which the foot of waterlines cuts."""
    left = pocket.layer_area().remaining(known.settings.cell, state.settings.floor_allowance)
    return left + FLOOR_DISTANCE


def side_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    found = []
    for known, pocket in pockets_of(state, stage, features):
        settings = known.settings
        if flank_of(state, known, pocket) is not None:
            continue
        samples, cutters = cutters_of(state, known, pocket, "sides", pocket.sides)
        report_unreached(state, pocket, samples, cutters)
        if cutters.tool is None:
            if len(samples):
                state.findings.append(no_cutter(pocket, stage, pocket.sides))
            continue
        left = pocket.layer_area().remaining(settings.cell, state.settings.floor_allowance)
        left += settings.step
        hanging: dict[str, Value] = {}
        if pocket.feature.id in known.rims or not pocket.near_overhangs:
            # Outside of the rims of what leans over nothing stands any more, and no neck comes inside of them; nor through a rib.
            hanging = {OVERHANG: 0.0}
        elif pocket.hang > 0.0:
            # What stays at a wall that leans over is nowhere finished: necks keep off more than elsewhere.
            left *= OVERHANG_DISTANCE
        shallowest = max(settings.steep - LAP, FOOT) if pocket.curved else FOOT
        steps = with_rounder_between(
            cutters,
            side_cutters(state, pocket),
            partial(level_time, state, samples, settings.scallop),
            tool_change(state),
        )
        for n, step in enumerate(steps):
            known.finishing.setdefault(pocket.feature.id, []).append(step.tool)
            choices: dict[str, Value] = {
                SCALLOP: settings.scallop,
                ALLOWANCE: 0.0,
                f"{SIDES_STRATEGY}.shallowest": shallowest,
                **hanging,
                **chord_choices(SIDES_STRATEGY, settings.scallop),
                **after_earlier(SIDES_STRATEGY, step.earlier),
            }
            found.append(
                _surface_task(
                    state, stage, pocket, step, samples, choices, (left, settings.scallop), n
                )
            )
    return found


def curved_floor_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    return _on_curved_floors(state, stage, features, semi=False)


def curved_semi_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    return _on_curved_floors(state, stage, features, semi=True)


def _on_curved_floors(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature], *, semi: bool
) -> list[OperationTask]:
    found = []
    for known, pocket in pockets_of(state, stage, features):
        settings = known.settings
        if not pocket.curved or (semi and settings.semi_allowance <= 0.0):
            continue
        faces = (*pocket.curved, *_feet(state, pocket))
        samples, cutters = cutters_of(state, known, pocket, "floor", faces)
        if cutters.tool is None:
            if not semi:
                state.findings.append(no_cutter(pocket, stage, faces))
            continue
        left = pocket.layer_area().remaining(settings.cell, state.settings.floor_allowance)
        left += 0.5 * layer_height(pocket, settings)
        height = settings.semi_scallop if semi else settings.scallop
        steps = with_larger_first(
            cutters,
            balls(state),
            samples.area,
            partial(area_rate, state, height=settings.scallop),
            tool_change(state),
        )
        if not semi:
            steps = (*steps, *sharper_steps(state, known, pocket, samples, steps))
        # Semi-finishing makes the load even where the first cutter goes: what that leaves is little, and none of its rests are.
        for n, step in enumerate(steps[:1] if semi else steps):
            known.finishing.setdefault(pocket.feature.id, []).append(step.tool)
            is_after_layers = semi or step.earlier is not None or settings.semi_allowance <= 0.0
            choices: dict[str, Value] = {
                SCALLOP: height,
                ALLOWANCE: settings.semi_allowance if semi else 0.0,
                f"{FLOOR_STRATEGY}.steepest": settings.steep + LAP,
                **chord_choices(FLOOR_STRATEGY, height),
                **after_earlier(FLOOR_STRATEGY, step.earlier),
                **({} if pocket.near_overhangs else {OVERHANG: 0.0}),
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


def after_earlier(strategy: str, earlier: Tool | None) -> dict[str, Value]:
    """Return the choices of an operation on what an earlier cutter left."""
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
    return pocket_task(
        state,
        stage,
        pocket,
        f"{stage.kind}-{pocket.feature.id}{rest_name(n) if earlier else ''}",
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


def rest_name(n: int) -> str:
    """Return the end of the name of an area's `n`-th operation on a rest: `-rest`, then `-rest-2`."""
    return "-rest" if n < 2 else f"-rest-{n}"
