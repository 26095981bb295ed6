"""The operations that each stage of a typical plan requests: for every feature the requirement that a
cutter must fit, by the rule that the stage names."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from trunnion import tolerance
from trunnion.findings import Finding, Refused, face_tags, warning
from trunnion.geometry.plane.region import EMPTY_REGION, Region, union_all
from trunnion.model.feature import Feature, Recognition
from trunnion.model.material import Machine, Material
from trunnion.model.tool import Tool
from trunnion.plan.allowances import allowance_of
from trunnion.plan.clearance import ClearanceScene
from trunnion.plan.freeform.space import SurfaceSpace
from trunnion.plan.prismatic.regions import (
    Band,
    SetupSpace,
    floor_fillet,
    number,
    parent_of,
    touching,
)
from trunnion.plan.settings import RouteSettings
from trunnion.plan.tool_choice import (
    Candidates,
    ToolRequirement,
    candidates,
    depth_reached,
    fits_through,
)
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.settings import Value
from trunnion.shop import Shop, Stage
from trunnion.units import trimmed

SPARE = 2.0
"""Radii of a roughing cutter that should fit from the rim to the middle of a pocket where it is widest: space for a helix and a turn."""

NEAR_ROUGH, NEAR_WALL, NEAR_FLOOR = 0.9, 0.6, 0.5
"""How much smaller than the largest that fits a cutter may be, over its diameter, when it serves other operations too."""

STRIP_OVERLAP = 0.5
"""mm that the strip of a floor finished by the wall's cutter and the part finished by the floor's cutter have in common."""

FLOOR_DISTANCE = 0.1
"""mm that a floor's cutter keeps from what roughing left on the walls."""

SHARP = 0.02
"""Share of a pocket that corners sharper than the one its cutter is chosen for may keep: no cutter gets into them, the proof counts it."""

FOOT_RING = 0.5
"""mm around an island that the cutter of its foot has to get to, all round."""

WALL_DISTANCE = "plane.floor.wall_distance"
"""Key of a floor's choice that holds what its cutter keeps from finished walls, mm."""

REST = ("rest", "rest_layers", "outline_rest")
"""Rules for the cutters of rest roughing: without one what is left stays to finishing."""

DEPENDENT = ("rest", "rest_layers", "corner", "foot", "outline_rest", "outline_corner")
"""Rules for cutters that depend on the cutter of another stage."""

BEFORE = {
    "rest": "rough",
    "corner": "wall",
    "outline_rest": "profile_rough",
    "outline_corner": "profile_finish",
}
"""Kind of operation whose cutter has left corners to that of a rule."""


@dataclass(frozen=True, slots=True, kw_only=True)
class OperationTask:
    """An operation that is wanted: its id, stage, feature and requirement; the cutter comes later. `height` is what it goes down in all.

    Of equal holes one task serves several: `others` are the further features, `found` the tools that fit them all, and `why` says so.
    `half`: it cuts the nearer half, the rest is cut from the other side.
    `choices` are the operation's own where the route's allowances are none of its business, `engagement` returns depth and width of cut
    (mm) with a cutter where its kind does not say them.
    """

    id: str
    stage: Stage
    feature: str
    position: tuple[float, float]
    requirement: ToolRequirement
    faces: tuple[int, ...]
    height: float
    width: float
    others: tuple[str, ...] = ()
    found: Candidates | None = None
    why: str = ""
    half: bool = False
    choices: Mapping[str, Value] | None = None
    engagement: Callable[[Tool], tuple[float, float]] | None = None

    @property
    def all_features(self) -> tuple[str, ...]:
        """The ids of all features that it machines."""
        return (self.feature, *self.others)


@dataclass(slots=True)
class PanelPlanState:
    """What is known while one setup is planned; `loaded` are the tools of the setups before, `progress` is looked at on the way, `choices`
    are a session's settings by full key, `holes` what the stages on holes have found out. Ids of features that two setups share: `halved`
    of those cut half from here and half from the other side, `both_ends` of holes that both widen, `bored` of those bored in the other,
    `slopes` of those of which only what leans, and looks up here, is cut here too. `narrow` are those that are roughed by an end mill for
    narrow slots.
    `curved` returns the part's skin as the setup sees it, None where nobody has it; `freeform` is what the stages on leaning walls and
    curved floors have found out. `leaning` returns the clearance queries of leaning tools among these faces, None where none may lean."""

    space: SetupSpace
    recognition: Recognition
    material: Material
    machine: Machine
    settings: RouteSettings
    shop: Shop
    adjacent: Mapping[str, frozenset[str]]
    loaded: tuple[Tool, ...] = ()
    bands: dict[str, tuple[Band, ...]] = field(default_factory=dict)
    findings: list[Finding] = field(default_factory=list)
    tools: dict[str, Tool] = field(default_factory=dict)
    choices: Mapping[str, Value] = field(default_factory=dict)
    holes: Any = None
    halved: set[str] = field(default_factory=set)
    both_ends: set[str] = field(default_factory=set)
    bored: set[str] = field(default_factory=set)
    slopes: set[str] = field(default_factory=set)
    narrow: set[str] = field(default_factory=set)
    curved: Callable[[], SurfaceSpace] | None = None
    freeform: Any = None
    leaning: Callable[[SurfaceSpace], ClearanceScene] | None = None
    progress: Progress = NO_PROGRESS

    def task_id(self, stage: Stage, feature: Feature) -> str:
        """Return the name of a stage's operation on a feature; what both sides cut has the setup's name in it."""
        return self.operation_id(stage.kind, feature.id)

    def operation_id(self, kind: str, feature: str) -> str:
        """Return the name of an operation of a kind on a feature by its id."""
        own = f"{kind}-{feature}"
        shared = feature in self.halved | self.both_ends | self.slopes
        return f"{own}-{self.space.setup.name}" if shared else own

    def tool_before(self, rule: str, feature: str) -> Tool | None:
        """Return the cutter that was in a feature's corners before that of a rule; None where there was none."""
        return self.tools.get(self.operation_id(BEFORE[rule], feature)) if rule in BEFORE else None


def floor_distance(wall_allowance: float) -> float:
    """Return what a floor's cutter keeps from the finished walls (mm): it must not meet their allowance."""
    return wall_allowance + FLOOR_DISTANCE


def catalogue(state: PanelPlanState, stage: Stage) -> tuple[Tool, ...]:
    """Return the cutters that a stage may choose from."""
    use = "face" if stage.cutter == "face" else "finish" if stage.finish else "rough"
    tools = state.shop.tools_for(state.material.iso_group, use)
    return (
        tools
        if stage.cutter == "face"
        else tuple(t for t in tools if t.diameter <= state.settings.largest)
    )


def narrow_cutters(state: PanelPlanState) -> tuple[Tool, ...]:
    """Return the small cutters for what no other one gets into."""
    return state.shop.tools_for(state.material.iso_group, "narrow")


def _face_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    space = state.space
    height = float(space.blank_high[2]) - space.top
    # Edges are cut with the outline, from above.
    if height <= tolerance.SEW or space.is_on_edge:
        return []
    tops = tuple(
        tag
        for f in state.recognition
        for tag in f.with_role("top", "bottom")
        if abs(space.centre(tag)[2] - space.top) < tolerance.SEW
    )
    middle = 0.5 * (space.blank_low + space.blank_high)
    requirement = ToolRequirement(
        depth=0.0,
        envelope_area=space.around(),
        wanted=space.blank_area(),
        corner_radius=0.0,
        near=1.0,
    )
    return [
        OperationTask(
            id=f"face-{space.setup.name}",
            stage=stage,
            feature="blank",
            position=(float(middle[0]), float(middle[1])),
            requirement=requirement,
            faces=tops,
            height=height,
            width=float(np.min(space.blank_high[:2] - space.blank_low[:2])),
        )
    ]


def _pocket_tasks(
    state: PanelPlanState,
    stage: Stage,
    features: Sequence[Feature],
    make: Callable[[Feature, tuple[Band, ...]], OperationTask | None],
) -> list[OperationTask]:
    """Return the tasks for the pockets of a stage; a pocket without free space over its floor is told of once and left out."""
    found = []
    for feature in state.progress.each(features):
        if feature.kind not in stage.on or state.space.is_freeform(feature):
            continue
        if feature.id not in state.bands:
            try:
                state.bands[feature.id] = state.space.bands_of(feature)
            except Refused as reason:
                state.bands[feature.id] = ()
                state.findings.append(
                    warning("route.not-planned", str(reason), feature.id, *face_tags(feature.tags))
                )
        if state.bands[feature.id]:
            task = make(feature, state.bands[feature.id])
            if task is not None:
                found.append(task)
    return found


def _rough_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    def make(feature: Feature, bands: tuple[Band, ...]) -> OperationTask:
        is_open = feature.kind == "open_pocket"
        distance = state.settings.wall_allowance + _wider_foot(state, feature)
        requirement = ToolRequirement(
            depth=_depth(state, bands),
            envelope_area=_kept_off(bands[-1].boundary, distance),
            wanted=_kept_off(bands[-1].wanted, distance),
            corner_radius=floor_fillet(feature),
            missable=state.settings.missable,
            spare=1.0 if is_open else SPARE,
            near=NEAR_ROUGH,
            others=_higher(bands, distance),
        )
        if not is_open and not any(
            bands[-1].boundary.offset(-SPARE * t.radius) for t in catalogue(state, stage)
        ):
            requirement = replace(requirement, spare=1.0)
        return _task(stage, feature, bands, requirement, ())

    return _pocket_tasks(state, stage, features, make)


def _rest_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    def make(feature: Feature, bands: tuple[Band, ...]) -> OperationTask | None:
        before = state.tools.get(f"rough-{feature.id}")
        corner = number(feature, "corner_radius")
        if before is None:
            return None
        requirement = replace(_wall_task(state, feature, bands), exact=False)
        if not 0.0 < corner < before.radius and fits_through(
            requirement, before, catalogue(state, stage)
        ):
            return None
        return _task(stage, feature, bands, requirement, ())

    return _pocket_tasks(state, stage, features, make)


def _floor_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    def make(feature: Feature, bands: tuple[Band, ...]) -> OperationTask | None:
        if not feature.with_role("floor"):
            return None
        # The wall's last pass finishes a strip of the floor as wide as its cutter's reach from the wall.
        tools, clearance = catalogue(state, stage), state.settings.reach_clearance
        walling = _wall_task(state, feature, bands)
        walls = (
            candidates(walling, tools, clearance, state.progress).tools
            or candidates(replace(walling, exact=False), tools, clearance, state.progress).tools
        )
        strip = min((t.diameter - t.corner_radius for t in walls), default=0.0) - STRIP_OVERLAP
        inner = bands[-1].wanted.offset(-strip)
        distance = floor_distance(state.settings.wall_allowance) + _wider_foot(state, feature)
        whole = ToolRequirement(
            depth=_depth(state, bands),
            envelope_area=_kept_off(bands[-1].boundary, distance),
            wanted=_kept_off(bands[-1].wanted, distance),
            corner_radius=floor_fillet(feature),
            missable=state.settings.missable,
            near=NEAR_FLOOR,
            others=_higher(bands, distance),
        )
        rest = replace(
            whole,
            envelope_area=bands[-1].boundary,
            wanted=inner,
            keep=distance,
            missable=0.0,
            others=tuple((b.boundary, b.wanted.offset(-strip)) for b in bands[:-1]),
        )
        requirement = (
            rest if inner and candidates(rest, tools, clearance, state.progress).tools else whole
        )
        return _task(stage, feature, bands, requirement, feature.with_role("floor"))

    return _pocket_tasks(state, stage, features, make)


def _wall_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    def make(feature: Feature, bands: tuple[Band, ...]) -> OperationTask:
        islands = [
            tag
            for island in state.space.islands_of(feature)
            for tag in island.with_role("wall", "corner", "floor_fillet")
        ]
        faces = (*feature.with_role("wall", "corner", "floor_fillet"), *islands)
        if feature.sizes.get("corner_radius") == 0.0:
            state.findings.append(
                warning(
                    "route.sharp-corner",
                    f"{feature.id}: two of its walls meet in a sharp inner edge; the cutter leaves its radius there",
                    feature.id,
                    *face_tags(feature.with_role("wall")),
                    remedy="give the corner a radius, or finish it by other means",
                )
            )
        requirement = _with_known_fillet(state, stage, feature, _wall_task(state, feature, bands))
        fine = candidates(
            requirement, catalogue(state, stage), state.settings.reach_clearance, state.progress
        ).tools
        if all(t.stickout / t.diameter > state.settings.slender for t in fine):
            stiff = replace(requirement, radius=0.0, missable=state.settings.missable, cusps=False)
            larger = candidates(
                stiff, catalogue(state, stage), state.settings.reach_clearance, state.progress
            ).tools
            if any(not fine or t.stickout / t.diameter <= state.settings.slender for t in larger):
                requirement = stiff
        return _task(stage, feature, bands, requirement, faces)

    return _pocket_tasks(state, stage, features, make)


def _corner_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    def make(feature: Feature, bands: tuple[Band, ...]) -> OperationTask | None:
        wall, corner = state.tools.get(f"wall-{feature.id}"), number(feature, "corner_radius")
        is_sharp = feature.sizes.get("corner_radius") == 0.0
        if (
            wall is None
            or (corner <= 0.0 and not is_sharp)
            or wall.radius <= corner * state.settings.corner_share + tolerance.COINCIDENT
        ):
            return None
        requirement = _with_known_fillet(state, stage, feature, _wall_task(state, feature, bands))
        if is_sharp:
            requirement = replace(requirement, radius=_smallest(state, stage, requirement))
            if requirement.radius >= wall.radius:
                return None
        return _task(stage, feature, bands, requirement, feature.with_role("corner"))

    return _pocket_tasks(state, stage, features, make)


def _foot_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    """Ask for the feet of islands that are sharper than the foot of the pocket's walls, whose cutter leaves its corner there."""

    def make(feature: Feature, bands: tuple[Band, ...]) -> OperationTask | None:
        wall = state.tools.get(f"wall-{feature.id}")
        sharper = [
            i
            for i in state.space.islands_of(feature)
            if wall is not None and floor_fillet(i) < wall.corner_radius - tolerance.COINCIDENT
        ]
        if not sharper:
            return None
        islands = union_all([_seen_from_above(state, i) for i in state.space.islands_of(feature)])
        rounder = floor_fillet(feature)
        requirement = ToolRequirement(
            depth=_depth(state, bands),
            envelope_area=bands[-1].boundary.union(islands).offset(-rounder).minus(islands),
            wanted=union_all([_seen_from_above(state, i) for i in sharper])
            .offset(FOOT_RING)
            .minus(islands),
            corner_radius=min(map(floor_fillet, sharper)),
            missable=SHARP,
            near=NEAR_FLOOR,
        )
        faces = tuple(tag for i in sharper for tag in i.with_role("wall", "corner", "floor_fillet"))
        return replace(_task(stage, feature, bands, requirement, faces), height=rounder)

    return _pocket_tasks(state, stage, features, make)


def _seen_from_above(state: PanelPlanState, island: Feature) -> Region:
    """Return the plan area of an island, by its top."""
    frame = state.space.setup.frame
    return union_all([state.space.part.face_outline(frame, t) for t in island.with_role("top")])


def _top_tasks(
    state: PanelPlanState, stage: Stage, features: Sequence[Feature]
) -> list[OperationTask]:
    found = []
    for feature in features:
        tops = feature.with_role("top")
        if feature.kind not in stage.on or not tops:
            continue
        z = float(state.space.centre(tops[0])[2])
        if state.space.top - z <= tolerance.SEW:
            continue
        try:
            envelope_area, wanted = _top_areas(state, feature, z, tops)
        except Refused as reason:
            state.findings.append(
                warning("route.not-planned", str(reason), feature.id, *face_tags(tops))
            )
            continue
        position = state.space.centre(tops[0])
        requirement = ToolRequirement(
            depth=state.space.top - z,
            envelope_area=envelope_area,
            wanted=wanted,
            corner_radius=0.0,
            near=NEAR_FLOOR,
        )
        found.append(
            OperationTask(
                id=f"{stage.kind}-{feature.id}",
                stage=stage,
                feature=feature.id,
                position=(float(position[0]), float(position[1])),
                requirement=requirement,
                faces=tops,
                height=state.space.top - z,
                width=number(feature, "thickness", math.inf),
            )
        )
    return found


def _top_areas(
    state: PanelPlanState, feature: Feature, z: float, tops: Sequence[int]
) -> tuple[Region, Region]:
    """Return where a cutter may be at a top's height, and the top itself."""
    space, wanted = state.space, EMPTY_REGION
    for tag in tops:
        wanted = wanted.union(space.part.face_outline(space.setup.frame, tag))
    pocket = parent_of(feature, state.recognition)
    if feature.kind != "island" or (pocket is not None and space.is_freeform(pocket)):
        free = touching(space.free_near(z + tolerance.OFF_PLANE, wanted), wanted)
        # Under a wall that leans over its end no cutter gets to a top.
        seen = wanted.minus(space.hanging_over(z + tolerance.OFF_PLANE, wanted))
        if not seen:
            raise Refused(f"{feature.id}: the part hangs over all of its top; cut it by hand")
        return free, seen
    over = (
        [b for b in state.bands.get(pocket.id, ()) if b.bottom <= z + tolerance.SEW]
        if pocket
        else []
    )
    if not over:
        raise Refused(
            f"{feature.id} stands in a pocket that is not planned; machine its top by hand"
        )
    return over[0].boundary, wanted


PLANE_TASK_MAKERS: Mapping[
    str, Callable[[PanelPlanState, Stage, Sequence[Feature]], list[OperationTask]]
] = {
    "face": _face_tasks,
    "rough": _rough_tasks,
    "rest": _rest_tasks,
    "top": _top_tasks,
    "floor": _floor_tasks,
    "wall": _wall_tasks,
    "corner": _corner_tasks,
    "foot": _foot_tasks,
}
"""The rule behind each word that a typical plan gives for the cutter of a stage on pockets, tops and the face."""


def _task(
    stage: Stage,
    feature: Feature,
    bands: tuple[Band, ...],
    requirement: ToolRequirement,
    faces: tuple[int, ...],
) -> OperationTask:
    low, high = bands[-1].wanted.box()
    middle = 0.5 * (low + high)
    return OperationTask(
        id=f"{stage.kind}-{feature.id}",
        stage=stage,
        feature=feature.id,
        position=(float(middle[0]), float(middle[1])),
        requirement=requirement,
        faces=faces,
        height=bands[0].top - bands[-1].bottom,
        width=float(np.min(high - low)),
    )


def _kept_off(area: Region, distance: float) -> Region:
    """Return what is left of an area off its walls by what an operation keeps from them; the area itself where nothing is."""
    return (area.offset(-distance) if distance > 0.0 else area) or area


def _wider_foot(state: PanelPlanState, feature: Feature) -> float:
    """Return by how much the widest fillet at a pocket's floors is wider than its own: where pockets run into one another, a sharp foot of
    one may stand for a filleted one of another."""
    feet = [state.space.fillet_at(feature, z) for z in state.space.floors_of(feature).values()]
    return max(max(feet, default=0.0) - floor_fillet(feature), 0.0)


def _higher(bands: tuple[Band, ...], distance: float) -> tuple[tuple[Region, Region], ...]:
    """Return the areas at the floors above the lowest, kept off their walls: pockets that run into one another have passages of their own
    at each height."""
    return tuple(
        (_kept_off(b.boundary, distance), _kept_off(b.wanted, distance)) for b in bands[:-1]
    )


def _depth(state: PanelPlanState, bands: tuple[Band, ...]) -> float:
    """Return how deep below the part's top a pocket's lowest floor lies: the walls around may stand as high as that."""
    return state.space.top - bands[-1].bottom


def _wall_task(state: PanelPlanState, feature: Feature, bands: tuple[Band, ...]) -> ToolRequirement:
    distance, kept = _wider_foot(state, feature), allowance_of(feature).wall_allowance
    return ToolRequirement(
        depth=_depth(state, bands),
        envelope_area=_kept_off(bands[-1].boundary, distance),
        wanted=_kept_off(bands[-1].wanted, distance),
        corner_radius=floor_fillet(feature),
        exact=True,
        radius=max(number(feature, "corner_radius") - kept, 0.0) * state.settings.corner_share,
        missable=SHARP,
        near=NEAR_WALL,
        cusps=True,
        others=_higher(bands, distance),
    )


def _with_known_fillet(
    state: PanelPlanState, stage: Stage, feature: Feature, requirement: ToolRequirement
) -> ToolRequirement:
    """Return a wall's requirement with the fillet that cutters have: when none has it exactly, the next smaller, and a finding."""
    radii = {
        t.corner_radius
        for t in catalogue(state, stage)
        if not requirement.radius or t.radius <= requirement.radius + tolerance.COINCIDENT
    }
    if not radii or any(abs(r - requirement.corner_radius) <= tolerance.COINCIDENT for r in radii):
        return requirement
    next_smaller = max((r for r in radii if r < requirement.corner_radius), default=0.0)
    state.findings.append(
        warning(
            "route.fillet",
            f"{feature.id}: no cutter has a corner radius of {trimmed(requirement.corner_radius, 3)} mm; "
            f"its floor fillet is stepped with {trimmed(next_smaller, 3)} mm",
            feature.id,
            *face_tags(feature.with_role("floor_fillet")),
            remedy="add a cutter with the fillet's radius to the tools folder",
        )
    )
    return replace(requirement, corner_radius=next_smaller)


def _smallest(state: PanelPlanState, stage: Stage, requirement: ToolRequirement) -> float:
    """Return the radius of the smallest cutter that gets to the foot of a wall."""
    found = candidates(
        replace(requirement, missable=1.0, cusps=False, near=0.0),
        catalogue(state, stage),
        state.settings.reach_clearance,
        state.progress,
    ).tools
    return min((t.radius for t in found), default=math.inf)


def with_falling_sizes(
    state: PanelPlanState, tasks: Sequence[OperationTask]
) -> list[OperationTask]:
    """Return the tasks with cutters put in where a corner's cutter is much smaller than the one that was there before."""
    out: list[OperationTask] = []
    for task in tasks:
        before, n = state.tool_before(task.stage.cutter, task.feature), 1
        while (
            before is not None
            and before.diameter > state.settings.falling * state.tools[task.id].diameter
        ):
            step = _between(state, task, before)
            if step is None:
                break
            more = replace(task, id=f"{task.id}-{n}")
            state.tools[more.id] = before = step
            out.append(more)
            n += 1
        out.append(task)
    return out


def _between(state: PanelPlanState, task: OperationTask, before: Tool) -> Tool | None:
    goal = state.tools[task.id]
    fits = [
        t
        for t in catalogue(state, task.stage)
        if goal.diameter < t.diameter <= before.diameter / state.settings.falling**0.5
        and t.corner_radius <= goal.corner_radius
        and depth_reached(t) >= task.requirement.depth + state.settings.reach_clearance
    ]
    return max(
        fits, key=lambda t: (t.diameter, -depth_reached(t), t.corner_radius, t.name), default=None
    )
