"""The operations that stages on holes request: one for all equal holes that one tool serves."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from trunnion.findings import Refused
from trunnion.geometry.plane.region import EMPTY_REGION
from trunnion.model.feature import Feature
from trunnion.model.tool import Tool
from trunnion.plan.holes.drive import (
    FINE_BORE,
    MILL_THREAD,
    REAM,
    TAP,
    THREADING,
    no_tool,
    not_reached,
)
from trunnion.plan.holes.finish_tools import (
    BoreFinish,
    FinishSettings,
    bore_finish,
    drill_tolerance,
)
from trunnion.plan.holes.hole import (
    HoleShape,
    PlannedHole,
    hole_in,
    is_wider_behind,
    nearer_half,
)
from trunnion.plan.holes.settings import (
    MILL_ALLOWANCE,
    DrillSettings,
    HoleSettings,
)
from trunnion.plan.holes.thread_mills import threaded
from trunnion.plan.holes.tools import HoleSpace, drills_for, either, mills_of, pilots_for, sinks_for
from trunnion.plan.panel.tasks import OperationTask, PanelPlanState
from trunnion.plan.tool_choice import Candidates, ToolRequirement
from trunnion.settings import choose
from trunnion.shop import Stage
from trunnion.units import trimmed

SAME_SIZE = 3
"""Decimals of mm by which sizes of holes are held against each other: CAD files carry more than is meant."""


@dataclass(frozen=True, slots=True, kw_only=True)
class HoleFit:
    """A hole, or the part of one that a stage cuts, with its feature and the tools that fit it; `faces` that are finished, None: all of the
    hole's own."""

    feature: Feature
    hole: PlannedHole
    found: Candidates
    faces: tuple[int, ...] | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class HoleReach:
    """A hole as a setup reaches it, with the drills for its bore, or the end mills where no drill fits, and what its demand asks for after
    these: `before` is the bore as they make it."""

    shape: HoleShape
    drills: Candidates
    mills: Candidates | None
    before: PlannedHole
    finish: BoreFinish | None

    @property
    def has_tools(self) -> bool:
        """Whether a tool makes the bore."""
        return bool(self.drills.tools or (self.mills is not None and self.mills.tools))


@dataclass(slots=True, kw_only=True)
class HolePlanning:
    """What is known of a setup's holes while it is planned: their shapes, the drills for each, the bores as these make them, what comes
    after that, and what stands around them."""

    shapes: dict[str, HoleShape]
    around: HoleSpace
    settings: HoleSettings
    drilling: DrillSettings
    drills: dict[str, Candidates]
    mills: dict[str, Candidates]
    bores: dict[str, PlannedHole] = field(default_factory=dict)
    finishes: dict[str, BoreFinish] = field(default_factory=dict)
    reaches: dict[tuple[str, bool], HoleReach] = field(default_factory=dict)


def hole_reach(state: PanelPlanState, feature: Feature, half: bool = False) -> HoleReach:
    """Return how a setup reaches a hole, or the half of it that lies nearer; raise `Refused` with why where it does not."""
    known = _known(state)
    if (feature.id, half) not in known.reaches:
        shape = hole_in(feature, state.space.recognition.frame, state.space.setup.frame)
        if not known.around.is_open((shape.bore, *shape.counterbores)[-1]):
            raise Refused(
                f"{feature.id}: the part covers its mouth; it needs a setup that sees it open"
            )
        if half:
            shape = nearer_half(shape)

        def tools_of(use: str) -> Sequence[Tool]:
            return state.shop.tools_for(state.material.iso_group, use)

        finishing = FinishSettings.of(state.choices)
        finish = bore_finish(
            feature,
            shape,
            tools_of,
            known.around,
            finishing,
            state.material,
            state.shop,
        )
        finish = threaded(
            finish,
            shape,
            tools_of,
            known.around,
            known.settings,
            finishing.thread_milling,
        )
        before = shape.bore if finish is None else finish.before
        drills = drills_for(
            before,
            state.shop.tools_for(state.material.iso_group, "drill"),
            known.around,
            drill_tolerance(finish, known.settings),
            known.drilling.breakthrough,
        )
        mills = None if drills.tools else _mills(state, known, before, before.top)
        known.reaches[feature.id, half] = HoleReach(
            shape=shape, drills=drills, mills=mills, before=before, finish=finish
        )
    return known.reaches[feature.id, half]


def _known(state: PanelPlanState) -> HolePlanning:
    if state.holes is None:
        state.holes = HolePlanning(
            shapes={},
            around=HoleSpace(space=state.space, clearance=state.settings.reach_clearance),
            settings=choose(HoleSettings, state.choices),
            drilling=choose(DrillSettings, state.choices),
            drills={},
            mills={},
        )
    known: HolePlanning = state.holes
    return known


def _planning(state: PanelPlanState, stage: Stage, features: Sequence[Feature]) -> HolePlanning:
    """Return what is known of the holes of a stage; a hole that the setup does not reach is told of once and left out."""
    known = _known(state)
    for feature in state.progress.each(features):
        if feature.kind not in stage.on or feature.id in known.drills:
            continue
        known.drills[feature.id] = Candidates(tools=())
        try:
            reached = hole_reach(state, feature, feature.id in state.halved)
        except Refused as reason:
            state.findings.append(not_reached(feature, str(reason)))
            continue
        known.shapes[feature.id] = reached.shape
        if is_wider_behind(feature) and feature.id not in state.both_ends:
            state.findings.append(
                not_reached(
                    feature,
                    f"{feature.id}: the wider part at its far end opens away from the tool",
                )
            )
        if feature.id in state.bored:
            continue
        known.drills[feature.id] = reached.drills
        known.bores[feature.id] = reached.before
        if reached.finish is not None:
            known.finishes[feature.id] = reached.finish
        if reached.mills is not None:
            known.mills[feature.id] = reached.mills
    return known


def _bored_here(
    state: PanelPlanState, known: HolePlanning, stage: Stage, features: Sequence[Feature]
) -> list[tuple[Feature, HoleShape]]:
    """Return the holes of a stage whose bores this setup makes."""
    return [(f, s) for f, s in _of_stage(known, stage, features) if f.id not in state.bored]


def _mills(state: PanelPlanState, known: HolePlanning, hole: PlannedHole, top: float) -> Candidates:
    group = state.material.iso_group
    return mills_of(state.shop, group, hole, known.around, top, known.drilling.breakthrough)


def _of_stage(
    known: HolePlanning, stage: Stage, features: Sequence[Feature]
) -> list[tuple[Feature, HoleShape]]:
    return [
        (f, known.shapes[f.id]) for f in features if f.kind in stage.on and f.id in known.shapes
    ]


def _spot_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    known = _planning(state, stage, features)
    if not known.settings.spot:
        return []
    tools = sorted(
        state.shop.tools_for(state.material.iso_group, "spot"), key=lambda t: (-t.diameter, t.name)
    )
    found = Candidates(
        tools=tuple(tools),
        reason="the catalogue has no spotting drill for this material",
        remedy="add one to the tools folder",
    )
    fitted = [
        HoleFit(feature=f, hole=known.bores[f.id], found=found)
        for f, _ in _bored_here(state, known, stage, features)
        if known.drills[f.id].tools
    ]
    # One spotting drill serves holes of all sizes: its cone says how wide.
    return _tasks(state, stage, fitted, lambda hole: ("spot",), _no_faces)


def _drill_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    known = _planning(state, stage, features)
    # A hole without a drill is milled where an end mill gets into it; where none does, both reasons are told.
    fitted = [
        HoleFit(
            feature=f,
            hole=known.bores[f.id],
            found=either(known.drills[f.id], known.mills.get(f.id, Candidates(tools=()))),
            faces=_bored_faces(known, f),
        )
        for f, _ in _bored_here(state, known, stage, features)
        if known.drills[f.id].tools or not known.mills[f.id].tools
    ]
    return _tasks(
        state, stage, fitted, lambda hole: (*_size(hole), _deep_class(hole, known.drilling)), _own
    )


def _pilot_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    """Ask for drills that leave the cone of blind bores which are milled after them."""
    known = _planning(state, stage, features)
    drills = state.shop.tools_for(state.material.iso_group, "drill")
    fitted = [
        HoleFit(
            feature=f,
            hole=known.bores[f.id],
            found=pilots_for(
                shape.bore,
                known.bores[f.id].diameter,
                drills,
                known.around,
                known.drilling.breakthrough,
            ),
            faces=f.with_role("bottom"),
        )
        for f, shape in _bored_here(state, known, stage, features)
        if f.id in known.mills and known.mills[f.id].tools
    ]
    # Without one the helix is enough: the cone that stays is told.
    return _tasks(
        state,
        stage,
        [one for one in fitted if one.found.tools],
        lambda hole: (*_size(hole), _deep_class(hole, known.drilling)),
        _own,
    )


def _mill_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    known = _planning(state, stage, features)
    fitted = [
        HoleFit(
            feature=f,
            hole=known.bores[f.id],
            found=known.mills[f.id],
            faces=_bored_faces(known, f),
        )
        for f, _ in _bored_here(state, known, stage, features)
        if f.id in known.mills and known.mills[f.id].tools
    ]
    return _milled(state, known, stage, fitted)


def _milled(
    state: PanelPlanState, known: HolePlanning, stage: Stage, fitted: Iterable[HoleFit]
) -> list[OperationTask]:
    """Return the tasks of milling bores: what is reamed after it keeps its allowance."""

    def allowance(feature: str) -> float:
        return 0.5 * (known.shapes[feature].bore.diameter - known.bores[feature].diameter)

    tasks = _tasks(state, stage, fitted, lambda hole: (*_size(hole), allowance(hole.feature)), _own)
    return [
        replace(t, choices={MILL_ALLOWANCE: left}) if (left := allowance(t.feature)) > 0.0 else t
        for t in tasks
    ]


def _bored_faces(known: HolePlanning, feature: Feature) -> tuple[int, ...] | None:
    """Return the faces that making a bore finishes, None: all of its own; of one that is reamed after it not its side."""
    finish = known.finishes.get(feature.id)
    if finish is None or finish.kind in THREADING or not finish.found.tools:
        return None
    return feature.with_role("bottom")


def _finish_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    """Ask for the reaming, boring or threading of bores that a stage is for."""
    known = _planning(state, stage, features)
    fitted = [
        HoleFit(
            feature=f,
            hole=shape.narrow,
            found=known.finishes[f.id].found,
            faces=f.with_role("side"),
        )
        for f, shape in _bored_here(state, known, stage, features)
        if f.id in known.finishes and known.finishes[f.id].kind == stage.kind
    ]
    return _tasks(
        state, stage, fitted, lambda hole: (*_size(hole), known.shapes[hole.feature].thread), _own
    )


def _floor_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    """Ask for the flat floors of holes that drills have left their point in."""
    known = _planning(state, stage, features)
    fitted = [
        HoleFit(
            feature=f,
            hole=shape.bore,
            found=_mills(state, known, known.bores[f.id], shape.bore.top),
            faces=f.with_role("bottom"),
        )
        for f, shape in _bored_here(state, known, stage, features)
        if shape.bore.is_flat and known.drills[f.id].tools
    ]
    return _milled(state, known, stage, fitted)


def _counterbore_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    known = _planning(state, stage, features)
    fitted = [
        HoleFit(
            feature=f,
            hole=shape.counterbores[0],
            found=_mills(state, known, shape.counterbores[0], shape.bore.top),
            faces=shape.counterbores[0].faces,
        )
        for f, shape in _of_stage(known, stage, features)
        if shape.counterbores
    ]
    # What gets down to the deepest step of a hole mills the others too.
    return _tasks(state, stage, fitted, _size, _own)


def _countersink_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    known = _planning(state, stage, features)
    tools = state.shop.tools_for(state.material.iso_group, "countersink")
    fitted = [
        HoleFit(
            feature=f,
            hole=replace(shape.bore, diameter=shape.countersink.diameter),
            found=sinks_for(shape.bore, shape.countersink, tools, known.around),
            faces=f.with_role("countersink"),
        )
        for f, shape in _of_stage(known, stage, features)
        if shape.countersink is not None
    ]
    # Cones of one angle are cut by one tool, however wide: it goes as deep as each asks for.
    angles = {f.feature.id: _sink_angle(known, f.feature.id) for f in fitted}
    groups = [
        [f for f in fitted if angles[f.feature.id] == a] for a in dict.fromkeys(angles.values())
    ]
    return [
        # The narrowest that serves them all: a larger one would turn slower, and needs more space.
        replace(task, found=replace(task.found, tools=task.found.tools[:1]))
        for group in groups
        for task in _tasks(state, stage, group, lambda hole: ("sink",), _own)
        if task.found is not None
    ]


def _sink_angle(known: HolePlanning, id: str) -> float:
    sink = known.shapes[id].countersink
    return 0.0 if sink is None else round(sink.angle, 1)


def _size(hole: PlannedHole) -> tuple[object, ...]:
    return (round(hole.diameter, SAME_SIZE), hole.through, round(hole.point_angle, SAME_SIZE))


def _deep_class(hole: PlannedHole, settings: DrillSettings) -> int:
    """Return which of the ways of drilling a hole's depth asks for: at once, with chips broken, with chips brought out."""
    times = hole.depth / hole.diameter
    return int(times >= settings.chip_break_from) + int(times >= settings.peck_from)


def _own(fitted: HoleFit) -> tuple[int, ...]:
    return fitted.hole.faces if fitted.faces is None else fitted.faces


def _no_faces(fitted: HoleFit) -> tuple[int, ...]:
    return ()


def _tasks(
    state: PanelPlanState,
    stage: Stage,
    fitted: Iterable[HoleFit],
    size_of: Callable[[PlannedHole], tuple[object, ...]],
    faces_of: Callable[[HoleFit], tuple[int, ...]],
) -> list[OperationTask]:
    """Return a task for all holes of one size that one tool serves; holes that no tool fits become findings, one for each reason."""
    groups: dict[tuple[bool, *tuple[object, ...]], list[HoleFit]] = {}
    missing: dict[Candidates, list[HoleFit]] = {}
    for one in fitted:
        if one.found.tools:
            is_half = one.feature.id in state.halved
            groups.setdefault((is_half, *size_of(one.hole)), []).append(one)
        else:
            missing.setdefault(one.found, []).append(one)
    state.findings += [
        no_tool(stage, [h.feature for h in holes], (t for h in holes for t in faces_of(h)), found)
        for found, holes in missing.items()
    ]
    return [
        _task(state, stage, holes, tools, faces_of)
        for group in groups.values()
        for holes, tools in _served(group)
    ]


def _served(group: Sequence[HoleFit]) -> list[tuple[list[HoleFit], tuple[Tool, ...]]]:
    """Return equal holes with the tools that serve them: all together where one does, else those together that the same tools fit."""
    first = group[0].found.tools
    common = tuple(t for t in first if all(t in one.found.tools for one in group))
    if common:
        return [(list(group), common)]
    parts: dict[tuple[str, ...], list[HoleFit]] = {}
    for one in group:
        parts.setdefault(tuple(t.name for t in one.found.tools), []).append(one)
    return [(holes, holes[0].found.tools) for holes in parts.values()]


def _task(
    state: PanelPlanState,
    stage: Stage,
    holes: Sequence[HoleFit],
    tools: tuple[Tool, ...],
    faces_of: Callable[[HoleFit], tuple[int, ...]],
) -> OperationTask:
    first, hole = holes[0], holes[0].hole
    deepest = max(h.hole.depth for h in holes)
    requirement = ToolRequirement(
        depth=deepest, envelope_area=EMPTY_REGION, wanted=EMPTY_REGION, corner_radius=0.0
    )
    number = f"{len(holes)} holes" if len(holes) > 1 else "one hole"
    return OperationTask(
        id=state.task_id(stage, first.feature),
        half=first.feature.id in state.halved,
        stage=stage,
        feature=first.feature.id,
        others=tuple(h.feature.id for h in holes[1:]),
        position=(hole.x, hole.y),
        requirement=requirement,
        faces=tuple(tag for h in holes for tag in faces_of(h)),
        height=deepest,
        width=hole.diameter,
        found=Candidates(tools=tools),
        why=f"{number} of D {trimmed(hole.diameter, 3)}, up to {trimmed(deepest, 2)} mm deep: it reaches their bottoms, and "
        "shank and holder keep clear of what stands around them.",
    )


HOLE_TASK_MAKERS: Mapping[
    str, Callable[[PanelPlanState, Stage, Sequence[Feature]], list[OperationTask]]
] = {
    "spot": _spot_tasks,
    "drill": _drill_tasks,
    "pilot": _pilot_tasks,
    "hole_mill": _mill_tasks,
    "hole_floor": _floor_tasks,
    "counterbore": _counterbore_tasks,
    "countersink": _countersink_tasks,
    REAM: _finish_tasks,
    FINE_BORE: _finish_tasks,
    TAP: _finish_tasks,
    MILL_THREAD: _finish_tasks,
}
"""The rule behind each word that a typical plan gives for the tool of a stage on holes."""
