"""The route of a part of curved surfaces: layers first, upright walls, then every area with the largest cutter that reaches it.

Each area is semi-finished and finished with its own cutter; local features get their own, so that they don't bind what remains to a small
one (quick segmentation: variable parameters). What a cutter doesn't reach of its area goes to a smaller one as an area of its own.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from trunnion import registry
from trunnion.findings import error, face_tags, warning
from trunnion.model.blank import Blank
from trunnion.model.feature import Recognition
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.clearance import ClearanceScene
from trunnion.plan.cutting.milling import CuttingSettings, roughing_depth, roughing_width
from trunnion.plan.feasibility import too_large
from trunnion.plan.freeform.cutters.choice import NEGLIGIBLE, AreaCutters, cutter_for, named
from trunnion.plan.freeform.estimate.scallop import stepover_on_plane
from trunnion.plan.freeform.finishing.areas import (
    Area,
    areas_of,
    blank_faces,
    connected,
    hidden_areas,
    on_outline,
    walls_of,
    with_joined_hollows,
)
from trunnion.plan.freeform.keys import (
    ALLOWANCE,
    BOTTOM,
    CELL,
    EARLIER,
    EXTENSION,
    SCALLOP,
    UPRIGHT_EARLIER,
)
from trunnion.plan.freeform.lands import LAND, REST_LAND
from trunnion.plan.freeform.reach import AreaSamples, is_clear_of_walls, leans, reached, samples_on
from trunnion.plan.freeform.roughing.directions import sides_for
from trunnion.plan.freeform.roughing.hollows import hollow_depths
from trunnion.plan.freeform.roughing.layers import remaining_on_walls
from trunnion.plan.freeform.space import SurfaceSpace
from trunnion.plan.freeform.tilted_reach import SAMPLES as LEANING_SAMPLES
from trunnion.plan.freeform.tilted_reach import leaning_cutter
from trunnion.plan.process import process_of
from trunnion.plan.sequence import OrderedOperation, ordered
from trunnion.plan.settings import RouteSettings
from trunnion.plan.surface.land_route import FinishedLands, plan_lands
from trunnion.plan.surface.plan_state import SurfacePlanState, face_name
from trunnion.plan.surface.settings import SurfaceRouteSettings
from trunnion.plan.surface.slivers import sliver_findings, slivers_of, with_slivers
from trunnion.plan.tool_choice import depth_reached
from trunnion.plan.typical import typical_plan
from trunnion.progress import Progress
from trunnion.settings import Value, choose
from trunnion.shop import Shop, Stage
from trunnion.units import trimmed

CUTTER_RULES = ("layers", "outline", "land", "area", "rest_area", "rest_land")
"""Words that a typical plan may give for a stage's cutter."""
ROUGH_SHARE = 0.4
"""Largest roughing cutter over the blank's smaller side seen along the tool: it has to turn inside."""
REST_SHARE = 0.65
"""Largest cutter of rest roughing over the one before it."""
NEAR_FINISH = 1.6
"""Largest cutter of the last roughing over the smallest finishing cutter."""
LEAST_REST = 4.0
"""mm: rest roughing with a smaller cutter than this costs more than it spares the finishing."""
ON_SKIN = ("semi", "finish", "rest_finish")
"""Kinds of operations on curved faces."""
FULL = 2.0
"""Times what layers leave over a slope: as deep as passes on a skin meet material in an inner edge, where both faces have left theirs."""
OPENED = 0.5
"""Of the square of a cutter's diameter: area of hollows that are worth roughing with it."""
MISSED = 1.0
"""mm2 that an area's cutter may leave without a further cutter for it."""
MOST = 0.9
"""Share of a face that an upright cutter must reach; else the face counts as hidden from above."""
LARGEST_LEANING = 16.0
"""mm: larger balls have no space to lean on parts that need it."""
FEW = 200
"""Positions along a wall that say whether a tool has space beside it."""
SLENDER = 4
"""How many of the most slender cutters say what is hidden: larger ones reach no more."""
FALLING = ("rough", "semi")
"""Kinds of operations that larger cutters come first in: what they leave is little for the smaller ones."""
WALL_STEP = 1.5
"""Axial step of a wall over the cutter's diameter."""
WALL_SHARE = 0.7
"""Largest cutter of an outline over the largest roughing cutter: finishing wants it stiff, but not heavy."""


def make_surface_route(
    recognition: Recognition,
    blank: Blank,
    setups: Sequence[Setup],
    shop: Shop,
    space: SurfaceSpace,
    around: ClearanceScene,
    route: RouteSettings,
    settings: SurfaceRouteSettings,
    progress: Progress,
) -> ProcessTree:
    """Return the process of a part of curved surfaces: operations in cutting order, tools numbered in the order of use.

    What an upright tool doesn't reach is roughed from other directions and finished by a leaning one where the machine has rotary axes.
    Faces that no cutter reaches become findings (`route.not-planned`) that name the remedy.
    """
    plan = typical_plan(shop, recognition.family, route.plan, CUTTER_RULES)
    material = shop.material(blank.material)
    findings = too_large(blank, setups, shop)
    if findings:
        return ProcessTree(
            plan=plan.name, material=material.name, setups=tuple(setups), findings=tuple(findings)
        )
    state = SurfacePlanState(
        space=space,
        around=around,
        recognition=recognition,
        material=material,
        machine=shop.machine(setups[0].machine),
        shop=shop,
        setup=setups[0],
        route=route,
        settings=settings,
        stages={s.kind: s for s in plan.stages},
    )
    _plan(state, progress)
    _add_slivers(state)
    return process_of(
        _in_order(state, plan.stages),
        state.findings,
        plan=plan,
        material=material,
        setups=setups,
        shop=shop,
    )


def _plan(state: SurfacePlanState, progress: Progress) -> None:
    space, part = state.space, state.space.part
    outside = blank_faces(part, space.blank)
    mine = sorted({tag for f in state.recognition for tag in f.tags} - set(outside))
    progress.at(0.0, "looking at faces")
    samples = samples_on(space.skin, tuple(mine))
    upright = walls_of(samples, mine)
    walls = on_outline(space, samples, upright, progress)
    for tags in progress.each(connected(walls, part.graph())):
        _outline(state, tags)
    level = plan_lands(state, set(mine) - set(walls), _finishers(state), progress.part(0.0, 0.05))
    open_faces = set(mine) - set(walls) - level.tags
    hidden = (
        with_joined_hollows(
            state.recognition,
            part.graph(),
            _hidden(state, samples, open_faces, progress.part(0.05, 0.1)),
            open_faces,
        )
        if state.machine.rotary
        else ()
    )
    areas = [
        *areas_of(state.recognition, part.graph(), {*outside, *walls, *level.tags, *hidden}),
        *hidden_areas(state.recognition, part.graph(), hidden),
    ]
    for n, area in enumerate(areas):
        share = progress.part(0.1 + 0.7 * n / len(areas), 0.1 + 0.7 * (n + 1) / len(areas))
        share.at(0.0, f"cutter for {area.id}")
        if area.hidden:
            state.hanging.update(() if area.local else area.tags)
            _hidden_area(state, area, share)
        else:
            _area(state, area, level, share)
    progress.at(0.8, "roughing")
    _rough(state, space, float(space.skin.points[:, 2].min()), "part", progress.part(0.8, 0.85))
    if hidden:
        seen = samples.of(np.isin(samples.face, hidden))
        for n, side in enumerate(
            sides_for(
                space,
                state.setup,
                state.around,
                seen,
                _finishers(state),
                state.route.reach_clearance,
                lambda there: _roughing_reach(state, there),
                progress.part(0.85, 0.98),
            ),
            1,
        ):
            _rough(state, side.space, side.bottom, f"side-{n}", progress.part(0.98, 1.0))


def _add_slivers(state: SurfacePlanState) -> None:
    """Cut the patches that are too small to be planned by themselves with what lies around them; tell of those that stay."""
    part = state.space.part
    mine = (slivers_of(state.recognition) | state.unsampled) & set(part.tags) - set(
        blank_faces(part, state.space.blank)
    )
    before = state.operations
    state.operations, remaining = with_slivers(before, mine, part.graph(), state.space.skin)
    state.findings.extend(sliver_findings(before, state.operations))
    if remaining:
        state.findings.append(
            warning(
                "route.not-planned",
                f"{len(remaining)} patches in no group lie beside nothing that is cut",
                *face_tags(remaining),
                remedy="lower recognize.surface.smallest and recognize.surface.sliver_width to plan them by themselves",
            )
        )


def _hidden(
    state: SurfacePlanState, samples: AreaSamples, tags: set[int], progress: Progress
) -> tuple[int, ...]:
    """Return the faces that no upright cutter finishes most of; a face without a sample is a sliver and none of them."""
    seen = np.zeros(len(samples), dtype=bool)
    slender = sorted(_finishers(state), key=lambda t: (t.diameter, -depth_reached(t)))[:SLENDER]
    for tool in slender:
        seen |= reached(state.space, samples, tool, state.route.reach_clearance, 0.0, progress)
    sampled = tags & set(np.unique(samples.face).tolist())
    return tuple(sorted(t for t in sampled if seen[samples.face == t].mean() < MOST))


def _leaning_finishers(state: SurfacePlanState) -> tuple[Tool, ...]:
    """Return the longest ball of each diameter, the smallest first."""
    longest = {
        t.diameter: t
        for t in sorted(_finishers(state), key=lambda t: (t.diameter, depth_reached(t), t.name))
    }
    return tuple(longest[d] for d in sorted(longest) if d <= LARGEST_LEANING)


def _rough(
    state: SurfacePlanState, space: SurfaceSpace, bottom: float, name: str, progress: Progress
) -> None:
    """Plan roughing by layers with a large cutter from a direction, and with falling sizes what those before left: down to about the size
    of the smallest finishing cutter, so that this one finds little, and on into hollows that are too narrow for that size."""
    deep, most = float(space.high[2]) - bottom, _largest_rougher(state, space)
    tool = _rougher(state, most, deep, state.settings.rough_cutter)
    if tool is None:
        state.findings.append(
            error(
                "route.no-cutter",
                f"no roughing cutter up to D {trimmed(most, 1)} reaches {trimmed(deep, 1)} mm deep",
                state.recognition.features[0].id,
                remedy="add a longer cutter to the tools folder",
            )
        )
        return
    _add_rough(state, "rough", name, tool, space, bottom)
    smallest = min(
        (o.cutter.diameter for o in state.operations if o.kind in ("finish", LAND, REST_LAND)),
        default=tool.diameter,
    )
    n = 1
    while True:
        rest = _rougher(state, REST_SHARE * tool.diameter, deep, "")
        if rest is None or rest.diameter < LEAST_REST:
            break
        if tool.diameter > NEAR_FINISH * smallest:
            _add_rough(state, "rest", f"{name}-{n}", rest, space, bottom)
        else:
            opened = _hollows(state, space, tool, progress) - _hollows(state, space, rest, progress)
            if opened < OPENED * rest.diameter**2:
                break
            why = (
                f"It opens hollows of {trimmed(opened, 0)} mm2 that {tool.name} doesn't come into."
            )
            _add_rough(state, "rest", f"{name}-{n}", rest, space, bottom, why)
        tool, n = rest, n + 1


def _hollows(state: SurfacePlanState, space: SurfaceSpace, tool: Tool, progress: Progress) -> float:
    """Return the area in mm2 of curved faces that roughing with a cutter leaves more material over than their cutters are meant for: it
    is too wide for what they lie in."""
    settings = state.settings
    tags = {t for o in state.operations if o.kind in ON_SKIN for t in o.faces}
    samples = samples_on(space.skin, tuple(sorted(tags)))
    samples = samples.of(samples.normal[:, 2] > 0.0)
    radius = tool.radius + remaining_on_walls(space, settings.rough_allowance, settings.cell)
    depths = hollow_depths(space, samples.point, radius, progress)
    return samples.area * float((depths > FULL * _remaining_after_layers(space, settings)).sum())


def _remaining_after_layers(space: SurfaceSpace, settings: SurfaceRouteSettings) -> float:
    """Return how thick, in mm and in the mean, roughing by layers leaves material on a slope: what it leaves on walls, and its steps."""
    return remaining_on_walls(space, settings.rough_allowance, settings.cell) + 0.5 * settings.layer


def _rougher(state: SurfacePlanState, most: float, deep: float, name: str) -> Tool | None:
    """Return the largest roughing cutter up to a diameter that reaches a depth, with the corner that leaves least of a slope."""
    if name:
        return named(state.shop, name)
    fits = [
        t for t in _roughers(state, most) if depth_reached(t) >= deep + state.route.reach_clearance
    ]
    return max(
        fits,
        key=lambda t: (
            t.diameter,
            -depth_reached(t),
            -abs(t.corner_radius - 0.1 * t.diameter),
            t.name,
        ),
        default=None,
    )


def _roughers(state: SurfacePlanState, most: float) -> list[Tool]:
    return [t for t in state.cutters("rough") if t.form in ("flat", "bull") and t.diameter <= most]


def _largest_rougher(state: SurfacePlanState, space: SurfaceSpace) -> float:
    """Return the largest diameter in mm of a roughing cutter from a direction."""
    size = float((space.high - space.low)[:2].min())
    return min(state.route.largest, ROUGH_SHARE * size)


def _roughing_reach(state: SurfacePlanState, space: SurfaceSpace) -> float:
    """Return how deep in mm under the blank's top roughing comes from a direction."""
    deepest = max(
        (depth_reached(t) for t in _roughers(state, _largest_rougher(state, space))), default=0.0
    )
    return deepest - state.route.reach_clearance


def _add_rough(
    state: SurfacePlanState,
    kind: str,
    name: str,
    tool: Tool,
    space: SurfaceSpace,
    bottom: float,
    *why: str,
) -> None:
    stage, settings, cutting = state.stages[kind], state.settings, choose(CuttingSettings, {})
    depth = min(settings.layer, roughing_depth(tool, state.material, cutting))
    width = roughing_width(tool, state.material, cutting)
    rules = (
        stage.rule,
        f"{tool.name}: reaches {trimmed(depth_reached(tool), 1)} mm deep.",
        *why,
        f"It leaves {trimmed(settings.rough_allowance, 2)} mm all round, in layers of {trimmed(depth, 2)} mm.",
    )
    choices: dict[str, Value] = {
        ALLOWANCE: settings.rough_allowance,
        BOTTOM: bottom,
        CELL: settings.cell,
    }
    state.add(
        kind,
        name,
        state.first_feature(),
        tool,
        (),
        depth,
        width,
        choices,
        rules,
        operation_kind="rough",
        direction=space.direction,
    )


def _outline(state: SurfacePlanState, tags: tuple[int, ...]) -> None:
    """Plan upright walls that stand free, along the part's outline."""
    stage, space = state.stages["profile_finish"], state.space
    z = space.skin.points[space.skin.triangles[space.skin.of(tags)], 2]
    top, height = float(z.max()), float(z.max() - z.min())
    most = WALL_SHARE * state.route.largest
    fits = [
        t
        for t in state.cutters("finish")
        if t.form == "flat"
        and t.diameter <= most
        and depth_reached(t) >= top - float(z.min()) + state.route.reach_clearance
        and is_clear_of_walls(
            space,
            samples_on(space.skin, tags, FEW),
            t,
            float(z.min()),
            state.route.reach_clearance,
            state.settings.rough_allowance,
        )
    ]
    if not fits:
        state.findings.append(
            error(
                "route.no-cutter",
                f"no end mill up to D {trimmed(most, 1)} reaches {trimmed(height, 1)} mm "
                "down a wall",
                *face_tags(tags),
                remedy="add a longer cutter to the tools folder",
            )
        )
        return
    tool = max(fits, key=lambda t: (t.diameter, -depth_reached(t), t.name))
    steps = max(1, math.ceil(height / min(tool.flank_step(height), WALL_STEP * tool.diameter)))
    rules = (
        stage.rule,
        f"{tool.name}: the stiffest end mill up to D {trimmed(most, 1)} that reaches {trimmed(height, 1)} mm.",
    )
    state.add(
        "profile_finish",
        face_name(tags),
        state.feature_of(tags),
        tool,
        tags,
        height / steps,
        remaining_on_walls(space, state.settings.rough_allowance, state.settings.cell),
        {},
        rules,
    )


def _area(state: SurfacePlanState, area: Area, level: FinishedLands, progress: Progress) -> None:
    """Plan semi-finishing and finishing of an area with its own cutter, and of what that cutter leaves with a smaller one.

    The feet of sides that end mills finish with lands are no matter of its cutter.
    """
    settings = state.settings
    samples = samples_on(state.space.skin, area.tags)
    state.unsampled.update(set(area.tags) - set(samples.face.tolist()))
    samples = level.without_feet(samples)
    area = replace(area, tags=tuple(t for t in area.tags if (samples.face == t).any()))
    wanted = settings.local_cutter if area.local else settings.cutter
    found = cutter_for(
        state.space,
        samples,
        _finishers(state),
        settings.share,
        state.route.reach_clearance,
        named(state.shop, wanted) if wanted else None,
        progress,
    )
    _report_unreached(state, area, samples, found)
    if found.tool is None:
        return
    tags = tuple(t for t in area.tags if found.reached[samples.face == t].any())
    for kind in ("semi", "finish") if settings.semi_allowance > 0.0 else ("finish",):
        for name, mine, strategy in _by_slope(area, tags, samples, math.radians(settings.steep)):
            _add_finish(state, kind, name, mine, found.tool, strategy, samples)
    if found.rest is not None:
        missed = samples.of(found.missed)
        remaining = Area(
            id=area.id, tags=tuple(t for t in area.tags if (missed.face == t).any()), local=True
        )
        for name, mine, strategy in _by_slope(
            remaining, remaining.tags, missed, math.radians(settings.steep)
        ):
            _add_finish(
                state, "rest_finish", name, mine, found.rest, strategy, missed, earlier=found.tool
            )
        # Faces that the larger cutter never touches are still as roughing left them.
        raw = replace(
            remaining, id=f"{area.id}-rest", tags=tuple(t for t in remaining.tags if t not in tags)
        )
        if raw.tags and settings.semi_allowance > 0.0:
            for name, mine, strategy in _by_slope(
                raw, raw.tags, missed, math.radians(settings.steep)
            ):
                _add_finish(state, "semi", name, mine, found.rest, strategy, missed)
    _leaning_rest(state, area, samples, found, progress)


def _leaning_rest(
    state: SurfacePlanState,
    area: Area,
    samples: AreaSamples,
    found: AreaCutters,
    progress: Progress,
) -> None:
    """Plan for a leaning cutter what the upright ones of an area leave: what they can't touch, and what shank or holder keep them off."""
    if found.tool is None or not state.machine.rotary:
        return
    last, seen = found.tool, found.reached.copy()
    if found.rest is not None:
        last = found.rest
        missed = np.flatnonzero(~seen)
        seen[missed] = reached(
            state.space, samples.of(~seen), last, state.route.reach_clearance, 0.0, progress
        )
    tags = tuple(t for t in area.tags if not seen[samples.face == t].all())
    if (~seen).sum() <= NEGLIGIBLE * len(seen):
        return
    every = max(1, int((~seen).sum()) // LEANING_SAMPLES)
    few = samples.of(~seen & (np.cumsum(~seen) % every == 0))
    leaning = leaning_cutter(
        few, _leaning_finishers(state), state.around, state.settings.share, None, progress
    )
    if leaning.tool is None:
        return
    for kind in (
        ("semi", "rest_finish") if state.settings.semi_allowance > 0.0 else ("rest_finish",)
    ):
        _add_finish(
            state,
            kind,
            f"{area.id}{LEANING}",
            tags,
            leaning.tool,
            "surface.point",
            samples.of(~seen),
            upright=last,
        )


def _hidden_area(state: SurfacePlanState, area: Area, progress: Progress) -> None:
    """Plan semi-finishing and finishing of an area with a leaning cutter."""
    settings = state.settings
    samples, few = (
        samples_on(state.space.skin, area.tags),
        samples_on(state.space.skin, area.tags, LEANING_SAMPLES),
    )
    wanted = settings.local_cutter if area.local else settings.cutter
    own = named(state.shop, wanted) if wanted else None
    found = leaning_cutter(
        few, _leaning_finishers(state), state.around, settings.share, own, progress
    )
    _report_unreached(state, area, few, found)
    if found.tool is None:
        return
    if settings.semi_allowance > 0.0:
        _add_finish(state, "semi", area.id, area.tags, found.tool, "surface.point", samples)
    _add_finish(state, "finish", area.id, area.tags, found.tool, "surface.point", samples)
    if found.rest is not None:
        remaining = tuple(t for t in area.tags if (found.missed & (few.face == t)).any())
        _add_finish(
            state,
            "rest_finish",
            area.id,
            remaining,
            found.rest,
            "surface.point",
            samples,
            earlier=found.tool,
        )


def _by_slope(
    area: Area, tags: Sequence[int], samples: AreaSamples, limit: float
) -> list[tuple[str, tuple[int, ...], str]]:
    """Return the operations of an area: name, faces, strategy. Local features are of many slopes, which constant scallop suits best.

    Positions that lean by more than a limit (rad) are cut by waterlines: a face with some of both is in both operations.
    """
    above = leans(samples) > limit
    steep = tuple(t for t in tags if above[samples.face == t].mean() > SOME)
    if STEEP not in registry.names("strategies"):
        steep = ()
    shallow = tuple(
        t for t in tags if t not in steep or above[samples.face == t].mean() < 1.0 - SOME
    )
    found = (
        [(area.id, shallow, first_known(FOR_LOCAL if area.local else FOR_SHALLOW))]
        if shallow
        else []
    )
    return [*found, (f"{area.id}{FIRST}", steep, STEEP)] if steep else found


FOR_LOCAL = ("surface.constant", "surface.parallel")
FOR_SHALLOW = ("surface.parallel", "surface.constant")
"""Strategies for local features and for shallow faces, the best first."""
STEEP = "surface.waterline"
"""The strategy for steep faces."""
LEANING = "-leaning"
"""Ends the name of an operation on what the upright cutters of an area can't come to."""
FIRST = "-steep"
"""Ends the name of an operation on the steep positions of an area. It comes before the others there: from the top down it takes off what
would stand in the way of a neck or shank at a wall's foot."""
REST_LEAD = 0.3
"""mm: radius of leads in rest finishing: what is left lies beside faces that stand up."""
COARSE, CHORD_SHARE = 0.01, 0.075
"""mm: from this scallop height on passes need not follow their path as closely as strategies do by themselves; and how closely of it."""
SOME = 0.02
"""Share of a face that is worth another strategy."""
SLOPE_LIMITS = {
    "surface.waterline": ("surface.waterline.shallowest", -5.0),
    "surface.constant": ("surface.constant.steepest", 5.0),
    "surface.parallel": ("surface.parallel.steepest", 5.0),
}
"""Where strategies for shallow and steep positions meet: the setting that says it, and by how many degrees each goes on past the limit."""


def first_known(names: Sequence[str]) -> str:
    """Return the first of some strategies that is there; the first one where none is."""
    known = registry.names("strategies")
    return next((name for name in names if name in known), names[0])


def _add_finish(
    state: SurfacePlanState,
    kind: str,
    name: str,
    tags: tuple[int, ...],
    tool: Tool,
    strategy: str,
    samples: AreaSamples,
    earlier: Tool | None = None,
    upright: Tool | None = None,
) -> None:
    stage, settings = state.stages[kind], state.settings
    if strategy not in registry.names("strategies"):
        state.findings.append(
            warning(
                "route.no-strategy",
                f"{name}: no strategy {strategy} is there; {kind} is left out",
                *face_tags(tags),
                remedy="install a package that has it",
            )
        )
        return
    semi = kind == "semi"
    allowance = settings.semi_allowance if semi else 0.0
    height = settings.semi_scallop if semi else settings.height()
    after_rough = semi or settings.semi_allowance <= 0.0
    depth = (
        _remaining_after_layers(state.space, settings) if after_rough else settings.semi_allowance
    )
    width = stepover_on_plane(tool.corner_radius or 0.5 * tool.radius, height)
    area = samples.area * float(np.isin(samples.face, tags).sum())
    rules = (
        stage.rule,
        f"{tool.name} over {trimmed(area, 0)} mm2: scallops of {trimmed(1000.0 * height, 1)} um, "
        f"{trimmed(width, 3)} mm between passes on a plane.",
        f"It leaves {trimmed(allowance, 2)} mm.",
    )
    choices: dict[str, Value] = {SCALLOP: height, ALLOWANCE: allowance}
    if settings.extension > 0.0:
        choices[EXTENSION] = settings.extension
    if height >= COARSE:
        choices[f"{strategy}.chord"] = CHORD_SHARE * height
    if strategy in SLOPE_LIMITS and STEEP in registry.names("strategies"):
        key, past = SLOPE_LIMITS[strategy]
        choices[key] = min(max(settings.steep + past, 1.0), 89.0)
    if earlier is not None:
        choices |= {EARLIER: earlier.name, f"{strategy}.lead_radius": REST_LEAD}
    if upright is not None:
        choices |= {
            UPRIGHT_EARLIER: upright.name,
            "surface.point.pattern": "constant",
            "surface.point.lead_radius": REST_LEAD,
        }
    state.add(
        kind,
        name,
        state.feature_of(tags),
        tool,
        tags,
        depth,
        width,
        choices,
        rules,
        strategy=strategy,
    )


def _finishers(state: SurfacePlanState) -> tuple[Tool, ...]:
    return tuple(
        t
        for t in state.cutters("surface")
        if t.form == "ball" and t.diameter <= state.route.largest
    )


def _report_unreached(
    state: SurfacePlanState, area: Area, samples: AreaSamples, found: AreaCutters
) -> None:
    """Return which faces no cutter reaches, or not the one that was requested."""
    lost = [t for t in area.tags if not found.reachable[samples.face == t].any()]
    if lost:
        size = samples.area * float(np.isin(samples.face, lost).sum())
        remedy = (
            "turn the part in another setup"
            if state.machine.rotary
            else "machine them on a machine with rotary axes (setup.machine), or turn the part in another setup"
        )
        state.findings.append(
            warning(
                "route.not-planned",
                f"{area.id}: no cutter reaches {len(lost)} of its faces, {trimmed(size, 0)} mm2 "
                "from the tool's direction",
                *face_tags(lost),
                remedy=remedy,
            )
        )


def _in_order(state: SurfacePlanState, stages: Sequence[Stage]) -> list[Operation]:
    """Return the operations in the order of the plan's stages, with as few tool changes as that allows."""
    rank = {stage.name: n for n, stage in enumerate(stages)}
    by_stage = {stage.name: stage for stage in stages}
    jobs, done = [], {}
    for o in state.operations:
        stage = by_stage[o.group]
        before = {
            other.id
            for other in state.operations
            if other.group in stage.after_all
            or (other.group in stage.after and set(other.faces or o.faces) & set(o.faces))
            or other.id == o.id + FIRST
            or (other.group == o.group and _is_over(state, other) and not _is_over(state, o))
            or (
                o.kind in FALLING
                and other.group == o.group
                and other.cutter.diameter > o.cutter.diameter
                and _is_over(state, other) == _is_over(state, o)
            )
        }
        done[o.id] = replace(o, after=tuple(sorted(before)))
        jobs.append(
            OrderedOperation(
                id=o.id,
                tool=o.tool.name,
                stage=rank[o.group],
                position=_position(state, o.faces),
                after=frozenset(before),
            )
        )
    return [done[id] for id in ordered(jobs)]


def _is_over(state: SurfacePlanState, operation: Operation) -> bool:
    """Return whether an operation cuts hidden faces alone: what is left on them stands in the way of necks below, so they come first."""
    return bool(operation.faces) and state.hanging.issuperset(operation.faces)


def _position(state: SurfacePlanState, tags: tuple[int, ...]) -> tuple[float, float]:
    if not tags:
        return 0.0, 0.0
    at = state.space.frame.to_local(state.space.part.graph().centre[tags[0] - 1])
    return float(at[0]), float(at[1])
