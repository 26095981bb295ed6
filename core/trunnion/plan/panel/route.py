"""The route: from features to operations with cutters, data and an order, by a typical plan; every choice with its rule in words."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import partial

from trunnion import tolerance
from trunnion.model.blank import Blank
from trunnion.model.feature import Feature, Recognition
from trunnion.model.operation import CuttingData, Operation
from trunnion.model.process import ProcessTree
from trunnion.model.session import SizeEntry
from trunnion.model.setup import Setup
from trunnion.model.tabs import POSITIONS
from trunnion.model.tool import Tool
from trunnion.plan.clearance import ClearanceScene
from trunnion.plan.cutting.engaged import (
    RoughingChoice,
    engaged_depth,
    engaged_width,
    even_depth,
    roughing_choice,
    strip_engagement,
)
from trunnion.plan.cutting.milling import (
    ROUGH,
    CuttingSettings,
    cutting_data,
    layer_depth,
    layer_width,
    roughing_depth,
    roughing_width,
)
from trunnion.plan.feasibility import both_sides, too_large
from trunnion.plan.freeform.space import SurfaceSpace
from trunnion.plan.holes.cutting_data import hole_data, is_on_holes
from trunnion.plan.panel.edges import lost_on_edges, with_edges
from trunnion.plan.panel.fallbacks import (
    behind_rest_roughing,
    best_fit,
    with_floors_behind_roughing,
)
from trunnion.plan.panel.feasibility import (
    adjacent,
    no_cutter,
    not_planned,
    plannable,
    without_lonely_ribs,
)
from trunnion.plan.panel.floor_cutters import FLOOR_WIDTH, quicker_floors
from trunnion.plan.panel.rules import NEEDED, SWARF, TASK_MAKERS
from trunnion.plan.panel.side_settings import SidesSettings
from trunnion.plan.panel.sides import shared_out
from trunnion.plan.panel.tabs import frame_at_edges, with_tabs
from trunnion.plan.panel.tasks import (
    DEPENDENT,
    REST,
    WALL_DISTANCE,
    OperationTask,
    PanelPlanState,
    floor_distance,
    with_falling_sizes,
)
from trunnion.plan.panel.webs import thin_webs
from trunnion.plan.prismatic.drive import FLOOR_ALLOWANCE, WALL_ALLOWANCE
from trunnion.plan.prismatic.regions import SectionSource, SetupSpace, parent_of
from trunnion.plan.prismatic.tabs import TabSettings
from trunnion.plan.process import process_of
from trunnion.plan.sequence import OrderedOperation, ordered
from trunnion.plan.settings import HALVES, RouteSettings
from trunnion.plan.setups import SetupSettings
from trunnion.plan.setups.flip import turned
from trunnion.plan.tool_choice import covered_by_few, depth_reached
from trunnion.plan.typical import typical_plan
from trunnion.progress import Progress
from trunnion.settings import Value, choose
from trunnion.shop import Shop, Stage
from trunnion.units import trimmed

__all__ = ["RouteSettings", "make_route"]

FACE_WIDTH, WALL_STEP = 0.75, 1.5
"""Width of a face mill's path and axial step of a wall, both over the diameter."""


ROUGHED, PATTERN = "plane.rough", "plane.rough.pattern"
"""The strategy that clears pockets in either pattern, and the key of the choice of one."""

SLOTTED = ("rough", "profile_rough", "rib_top", "island_top", "boss_top")
"""Kinds of operations whose layers are as deep and wide as slots let them be: they go slower in the slots that open a layer, or come from
free space."""


def make_route(
    recognition: Recognition,
    sizes: tuple[SizeEntry, ...],
    blank: Blank,
    setups: Sequence[Setup],
    shop: Shop,
    part: SectionSource,
    settings: RouteSettings,
    progress: Progress,
    *,
    choices: Mapping[str, Value] | None = None,
    curved: Callable[[Setup], SurfaceSpace] | None = None,
    leaning: Callable[[SurfaceSpace, Setup], ClearanceScene] | None = None,
) -> ProcessTree:
    """Return the process: operations in cutting order with tools numbered in the order of use, and findings on what is not planned.

    Features that the typical plan does not know, or whose walls a vertical cutter would gouge or leave, become findings
    (`route.not-planned`); their material stays and the proof counts it. A cutter that does not exist is an error (`route.no-cutter`), so
    is a blank that the machine can't take (`route.travel`; nothing is planned then). The process has the setups that cut anything: where
    only one is given, the part is turned over for what that one can't reach. `choices` are a session's settings by full key.
    `curved` returns the part's skin as a setup sees it: without it leaning walls and curved floors are not planned. `leaning` returns the
    clearance queries of leaning tools in a setup: without it none leans.
    """
    plan = typical_plan(shop, recognition.family, settings.plan, tuple(TASK_MAKERS))
    material = shop.material(blank.material)
    findings = too_large(blank, setups, shop)
    if findings:
        return ProcessTree(
            plan=plan.name, material=material.name, setups=tuple(setups), findings=tuple(findings)
        )
    progress.at(0.0, "what is to be cut")
    near = adjacent(recognition, part)
    words = choices or {}
    setup_settings = choose(SetupSettings, words)
    freeform = curved is not None and {s.cutter for s in plan.stages} >= NEEDED
    knows_swarf = {s.cutter for s in plan.stages} >= SWARF
    planned, refusals = without_lonely_ribs(
        *plannable(recognition, plan.stages, freeform=freeform), recognition, near
    )
    setups = with_edges(setups, planned, recognition, blank, shop, setup_settings)
    refusals |= lost_on_edges(planned, setups, recognition)
    planned = [f for f in planned if f.id not in refusals]
    findings = not_planned(refusals, recognition)
    states = [
        PanelPlanState(
            space=SetupSpace.of(part, recognition, blank, setup),
            recognition=recognition,
            material=material,
            machine=shop.machine(setup.machine),
            settings=settings,
            shop=shop,
            adjacent=near,
            choices=words,
            progress=progress,
            curved=partial(curved, setup) if curved is not None and freeform else None,
            leaning=_leaning_in(setup, leaning, shop) if knows_swarf else None,
        )
        for setup in both_sides(setups, blank, shop, setup_settings)
    ]
    operations: list[Operation] = []
    cut: list[Feature] = []
    for n, (state, mine) in enumerate(
        zip(states, shared_out(states, planned, plan.stages), strict=True)
    ):
        state.loaded = tuple(o.cutter for o in operations)
        share = progress.part(n / len(states), (n + 1) / len(states))
        state.progress = share
        made = _sequenced(state, _with_cutters(state, mine, plan.stages, share), plan.stages)
        made, notes = with_tabs(made, state.space, choose(TabSettings, words), share)
        state.findings += notes
        own = {id for o in made for id in o.all_features}
        here = [f for f in mine if f.id in own]
        findings += state.findings
        if made:
            findings += frame_at_edges(any(POSITIONS in o.choices for o in operations), state.space)
        if operations and made:
            findings.append(turned(states[0].space, state.space))
            findings += thin_webs(state.space, here, cut, choose(SidesSettings, words).thin_web)
        operations += made
        cut += here
    used = {o.setup for o in operations} or {states[0].space.setup.name}
    kept = [state.space.setup for state in states if state.space.setup.name in used]
    return process_of(operations, findings, plan=plan, material=material, setups=kept, shop=shop)


def _leaning_in(
    setup: Setup, leaning: Callable[[SurfaceSpace, Setup], ClearanceScene] | None, shop: Shop
) -> Callable[[SurfaceSpace], ClearanceScene] | None:
    """Return the clearance queries of leaning tools in a setup, None where its machine has no rotary axes."""
    if leaning is None or not shop.machine(setup.machine).rotary:
        return None
    return lambda space: leaning(space, setup)


def _with_cutters(
    state: PanelPlanState, features: Sequence[Feature], stages: Sequence[Stage], progress: Progress
) -> list[OperationTask]:
    """Return the tasks that have a cutter, chosen so that few cutters serve all; those that depend on another's cutter come last."""
    tasks: list[OperationTask] = []
    rounds = [
        [s for s in stages if s.cutter not in DEPENDENT],
        *([s] for s in stages if s.cutter in DEPENDENT),
    ]
    for done, together in enumerate(rounds):
        fits: dict[str, Sequence[Tool]] = {}
        progress.at(done / len(rounds), "what is to be cut")
        fresh = [
            task
            for stage in progress.each(together)
            for task in TASK_MAKERS[stage.cutter](state, stage, features)
        ]
        served: list[OperationTask] = []
        for n, wanted in enumerate(fresh):
            task = wanted
            progress.at((done + n / len(fresh)) / len(rounds), f"cutter for {task.id}")
            task, found = best_fit(state, task)
            if found.tools:
                fits[task.id] = found.tools
                served.append(task)
            elif task.stage.cutter not in REST:
                state.findings.append(no_cutter(task, found))
        state.tools |= covered_by_few(fits, [*state.loaded, *state.tools.values()])
        state.tools |= quicker_floors(state, served, fits)
        tasks += served
    with_floors_behind_roughing(state, tasks)
    return with_falling_sizes(state, tasks)


def _sequenced(
    state: PanelPlanState, tasks: Sequence[OperationTask], stages: Sequence[Stage]
) -> list[Operation]:
    rank = {stage.name: n for n, stage in enumerate(stages)}
    after = {w.id: _before(state, w, tasks) for w in tasks}
    jobs = [
        OrderedOperation(
            id=w.id,
            tool=state.tools[w.id].name,
            stage=rank[w.stage.name],
            position=w.position,
            after=after[w.id],
        )
        for w in tasks
    ]
    by_id = {w.id: w for w in tasks}
    return [_operation(state, by_id[id], after[id]) for id in ordered(jobs)]


def _before(
    state: PanelPlanState, task: OperationTask, tasks: Sequence[OperationTask]
) -> frozenset[str]:
    """Return the ids that come before a task: earlier stages on and beside its feature, larger cutters, the pocket it is sunk in."""
    kinds = {f.id: f.kind for f in state.recognition}
    near = {"blank", *task.all_features}
    for id in task.all_features:
        near |= {i for i in state.adjacent.get(id, ()) if kinds[i] != kinds[id]}
    own = next((f for f in state.recognition if f.id == task.feature), None)
    parent = parent_of(own, state.recognition) if own else None
    found: set[str] = set()
    for other in tasks:
        if other.stage.name in task.stage.after_all or (
            other.stage.name in task.stage.after and not near.isdisjoint(other.all_features)
        ):
            found.add(other.id)
        if (
            parent is not None
            and other.stage.name == task.stage.name
            and other.feature == parent.id
        ):
            found.add(other.id)
    found |= behind_rest_roughing(state, task, tasks)
    steps = [w.id for w in tasks if w.feature == task.feature and w.stage.name == task.stage.name]
    return frozenset(found | set(steps[: steps.index(task.id)]))


def _operation(state: PanelPlanState, task: OperationTask, after: frozenset[str]) -> Operation:
    tool, stage, settings, cutting = (
        state.tools[task.id],
        task.stage,
        state.settings,
        choose(CuttingSettings, {}),
    )
    choices: dict[str, Value] = (
        {}
        if stage.finish
        else {WALL_ALLOWANCE: settings.wall_allowance, FLOOR_ALLOWANCE: settings.floor_allowance}
    )
    if task.choices is not None:
        choices = dict(task.choices)
    if stage.kind == "floor":
        choices.setdefault(WALL_DISTANCE, floor_distance(settings.wall_allowance))
    if task.half:
        choices[HALVES] = True
    rules = (stage.rule, *_tool_rules(task, tool, settings))
    roughing = _roughing(state, task, tool, cutting)
    if roughing is not None:
        choices[PATTERN] = roughing.pattern
        rules = (*rules, roughing.rule)
    return Operation(
        id=task.id,
        kind=stage.kind,
        strategy=stage.strategy,
        feature=task.feature,
        setup=state.space.setup.name,
        tool=tool,
        group=stage.name,
        data=_data(state, task, tool, cutting) if roughing is None else roughing.data,
        faces=task.faces if stage.finish else (),
        choices=choices,
        rules=rules,
        after=tuple(sorted(after)),
        others=task.others,
    )


def _roughing(
    state: PanelPlanState, task: OperationTask, tool: Tool, cutting: CuttingSettings
) -> RoughingChoice | None:
    """Return how a pocket is roughed; None where the operation is another, or says itself how deep and wide it cuts."""
    if task.stage.kind != ROUGH or task.stage.strategy != ROUGHED or task.engagement is not None:
        return None
    return roughing_choice(
        tool, state.material, state.machine, cutting, task.height, state.settings.roughing
    )


def _data(
    state: PanelPlanState, task: OperationTask, tool: Tool, cutting: CuttingSettings
) -> CuttingData:
    """Return the cutting data that an operation begins with."""
    if is_on_holes(task.stage.kind, tool):
        return hole_data(task.stage.kind, tool, state.material, state.machine, state.shop, cutting)
    depth, width = _engagement(state, task, tool, cutting)
    return cutting_data(
        tool,
        state.material,
        state.machine,
        task.stage.kind,
        cutting,
        depth,
        width,
        _widest(task, state.settings),
    )


def _engagement(
    state: PanelPlanState, task: OperationTask, tool: Tool, cutting: CuttingSettings
) -> tuple[float, float]:
    """Return depth ap and width ae: roughing by material, even layers; finishing takes the allowance in steps that the flutes bear."""
    if task.engagement is not None:
        return task.engagement(tool)
    kind, allowance = task.stage.kind, state.settings.wall_allowance
    bears = layer_depth if kind in SLOTTED else roughing_depth
    rough_depth = even_depth(task.height, bears(tool, state.material, cutting))
    takes = layer_width if kind in SLOTTED else roughing_width
    rough_width = takes(tool, state.material, cutting)
    if kind == "face":
        return even_depth(task.height, min(tool.flute_length / 2, rough_depth)), min(
            FACE_WIDTH * tool.diameter, task.width
        )
    if kind == "floor":
        return max(state.settings.floor_allowance, tolerance.SEW), FLOOR_WIDTH * (
            tool.diameter - 2 * tool.corner_radius
        )
    if kind in ("wall", "corner_finish", "profile_finish"):
        return even_depth(
            task.height, min(tool.flank_step(task.height), WALL_STEP * tool.diameter)
        ), max(allowance, tolerance.SEW)
    if kind == "foot":
        return task.height, task.height
    if kind == "corner" and state.material.bears_deep_slots:
        # A rest's section is less than that of constant engagement where it is no wider.
        flank = even_depth(task.height, engaged_depth(tool, state.material, cutting))
        return flank, min(rough_width, engaged_width(tool, state.material, cutting, flank))
    if kind in ("rib_top", "island_top", "boss_top"):
        return rough_depth, min(rough_width, task.width + 2 * allowance)
    if kind == "profile_rough":
        strip = max(task.width - allowance, tolerance.SEW)
        return strip_engagement(
            tool, state.material, state.machine, cutting, kind, task.height, strip
        )
    return rough_depth, rough_width


def _widest(task: OperationTask, settings: RouteSettings) -> float:
    """Return how wide what is in front of the cutter can be at once, in mm: a face's shorter side, a rib with its walls' allowance; 0
    where the area doesn't say."""
    if task.stage.kind == "face":
        return task.width
    return (
        task.width + 2.0 * settings.wall_allowance
        if task.stage.kind == "rib_top" and math.isfinite(task.width)
        else 0.0
    )


def _tool_rules(task: OperationTask, tool: Tool, settings: RouteSettings) -> tuple[str, ...]:
    requirement = task.requirement
    if task.why:
        return (f"{tool.name}: {task.why}",)
    notes = [
        f"{tool.name}: reaches {trimmed(depth_reached(tool), 2)} mm, {trimmed(requirement.depth, 2)} mm and "
        f"{trimmed(settings.reach_clearance, 2)} mm clearance are needed."
    ]
    if requirement.radius:
        notes.append(
            f"Its radius {trimmed(tool.radius, 2)} mm is at most {trimmed(requirement.radius, 2)} mm, "
            f"{trimmed(100 * settings.corner_share, 0)} % of the corner's."
        )
    exact = (
        "is that of the floor fillet."
        if requirement.exact
        else f"is at most that of the floor fillet, {trimmed(requirement.corner_radius, 2)} mm."
    )
    notes.append(f"Its corner radius {trimmed(tool.corner_radius, 2)} mm {exact}")
    if not task.stage.finish:
        notes.append(
            f"It leaves {trimmed(settings.wall_allowance, 2)} mm on walls and {trimmed(settings.floor_allowance, 2)} mm on floors."
        )
    notes.append("Among the cutters that fit it is the one that serves most operations.")
    return tuple(notes)
