"""The route of a part of curved surfaces: layers first, upright walls, then every area with the largest cutter that reaches it.

Each area is semi-finished and finished with its own cutter; local features get their own, so that they don't bind what remains to a small
one (quick segmentation: variable parameters). What a cutter doesn't reach of its area goes to a smaller one as an area of its own.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from trunnion import tolerance
from trunnion.findings import face_tags, warning
from trunnion.model.blank import Blank
from trunnion.model.feature import Recognition
from trunnion.model.process import ProcessTree
from trunnion.model.setup import Setup
from trunnion.plan.clearance import ClearanceScene
from trunnion.plan.feasibility import too_large
from trunnion.plan.freeform.finishing.areas import (
    areas_of,
    blank_faces,
    connected,
    hidden_areas,
    on_outline,
    walls_of,
    with_joined_hollows,
)
from trunnion.plan.freeform.reach import AreaSamples, reached, samples_on
from trunnion.plan.freeform.roughing.directions import sides_for
from trunnion.plan.freeform.space import SurfaceSpace
from trunnion.plan.process import process_of
from trunnion.plan.settings import RouteSettings
from trunnion.plan.surface.area_route import finishers, plan_area, plan_hidden_area
from trunnion.plan.surface.land_route import plan_lands
from trunnion.plan.surface.order import in_order
from trunnion.plan.surface.outline_route import plan_outline
from trunnion.plan.surface.plan_state import SurfacePlanState
from trunnion.plan.surface.roughing_findings import report_hollows
from trunnion.plan.surface.roughing_route import plan_roughing, roughing_reach
from trunnion.plan.surface.settings import SurfaceRouteSettings
from trunnion.plan.surface.slivers import sliver_findings, slivers_of, with_slivers
from trunnion.plan.tool_choice import depth_reached
from trunnion.plan.typical import typical_plan
from trunnion.progress import Progress
from trunnion.shop import Shop

CUTTER_RULES = ("layers", "outline", "land", "area", "rest_area", "rest_land")
"""Words that a typical plan may give for a stage's cutter."""
MOST = 0.9
"""Share of a face that an upright cutter must reach; else the face counts as hidden from above."""
SLENDER = 4
"""How many of the most slender cutters say what is hidden: larger ones reach no more."""


def refused_process(
    recognition: Recognition,
    blank: Blank,
    setups: Sequence[Setup],
    shop: Shop,
    route: RouteSettings,
) -> ProcessTree | None:
    """Return the process that says why nothing is planned for a blank that a machine can't take; None where all can."""
    findings = too_large(blank, setups, shop)
    if not findings:
        return None
    plan = typical_plan(shop, recognition.family, route.plan, CUTTER_RULES)
    material = shop.material(blank.material)
    return process_of((), findings, plan=plan, material=material, setups=setups, shop=shop)


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
        in_order(state, plan.stages),
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
    walls: set[int] = set()
    free = on_outline(space, upright, progress)
    for tags in progress.each(connected(free, part.graph())):
        if plan_outline(state, tags):
            walls.update(tags)
    level = plan_lands(state, set(mine) - walls, finishers(state), progress.part(0.0, 0.05))
    open_faces = set(mine) - walls - level.tags
    state.has_overhangs = bool((samples.normal[:, 2] < -math.sin(tolerance.ANGLE)).any())
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
            plan_hidden_area(state, area, share)
        else:
            plan_area(state, area, level, share)
    progress.at(0.8, "roughing")
    plan_roughing(
        state, space, float(space.skin.points[:, 2].min()), "part", progress.part(0.8, 0.85)
    )
    if hidden:
        seen = samples.of(np.isin(samples.face, hidden))
        for n, side in enumerate(
            sides_for(
                space,
                state.setup,
                state.around,
                seen,
                finishers(state),
                state.route.reach_clearance,
                lambda there: roughing_reach(state, there),
                progress.part(0.85, 0.98),
            ),
            1,
        ):
            plan_roughing(state, side.space, side.bottom, f"side-{n}", progress.part(0.98, 1.0))
    report_hollows(state, areas, progress)


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
    slender = sorted(finishers(state), key=lambda t: (t.diameter, -depth_reached(t)))[:SLENDER]
    for tool in slender:
        seen |= reached(state.space, samples, tool, state.route.reach_clearance, 0.0, progress)
    sampled = tags & set(np.unique(samples.face).tolist())
    return tuple(sorted(t for t in sampled if seen[samples.face == t].mean() < MOST))
