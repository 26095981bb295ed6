"""The operations on the holes of a part: along their own axes, one for all equal holes of one direction.

What the setup does not reach, such as the lower flange's bolt circle under a casing's upper flange, or the bolt holes in a wheel's back, is
made with the part turned over.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from trunnion import tolerance
from trunnion.findings import Refused
from trunnion.geometry.arrays import Floats
from trunnion.model.feature import Feature
from trunnion.plan.holes.axis_clearance import SkinGroups
from trunnion.plan.holes.cutting_data import hole_data
from trunnion.plan.holes.drive import (
    BORE,
    COUNTERBORE,
    COUNTERSINK,
    DRILL,
    FINE_BORE,
    FLOOR,
    MILL_THREAD,
    REAM,
    SPOT,
    TAP,
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
    hole_direction,
    hole_in,
    hole_size,
    is_plain_through,
)
from trunnion.plan.holes.settings import (
    MILL_ALLOWANCE,
    DrillSettings,
    HoleSettings,
)
from trunnion.plan.holes.thread_mills import threaded
from trunnion.plan.holes.tools import HoleSpace, drills_for, either, mills_of, sinks_for
from trunnion.plan.prismatic.regions import SetupSpace
from trunnion.plan.setups.frames import Direction, cutting_setup
from trunnion.plan.setups.state import SetupPlanState
from trunnion.plan.tool_choice import Candidates
from trunnion.settings import Value, choose
from trunnion.shop import Stage
from trunnion.units import trimmed

SAME_SIZE = 3
"""Decimals of mm, and of a direction, by which holes are held to be equal."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SetupHole:
    """A hole seen along its own axis in the setup that makes it (`state`), with the drills for its bore, or the mills where no drill fits,
    and what its demand asks for after these: `before` is the bore as they make it.

    `breakthrough` is how far (mm) a tool goes on past the end of a through hole.
    """

    feature: Feature
    state: SetupPlanState
    direction: Direction
    shape: HoleShape
    around: HoleSpace
    drills: Candidates
    mills: Candidates
    before: PlannedHole
    finish: BoreFinish | None
    settings: HoleSettings
    breakthrough: float

    @property
    def allowance(self) -> float:
        """What a milled bore keeps on its side for the reamer, mm."""
        return 0.5 * (self.shape.bore.diameter - self.before.diameter)

    def bored_faces(self) -> tuple[int, ...]:
        """Return the faces that making the bore finishes: of one that is reamed after it not its side."""
        return self.feature.with_role("bottom") if self.allowance > 0.0 else self.before.faces

    def mills_for(self, part: PlannedHole) -> Candidates:
        """Return the end mills that mill a part of the hole, gone down from its mouth."""
        shop, group = self.state.shop, self.state.material.iso_group
        return mills_of(shop, group, part, self.around, self.shape.bore.top, self.breakthrough)


def reached_holes(state: SetupPlanState, holes: Sequence[Feature]) -> tuple[SetupHole, ...]:
    """Return those of some holes that are reached along their own axes, in the setup or with the part turned over; tell of the others."""
    if not holes:
        return ()
    found = list[SetupHole]()
    planning = _Planning(
        groups=SkinGroups.of(state.context.skin(tolerance.CHORD, state.progress)),
        settings=choose(HoleSettings, state.choices),
        drilling=choose(DrillSettings, state.choices),
        finishing=FinishSettings.of(state.choices),
    )
    other = state.turned_over()
    for feature in state.progress.each(holes):
        try:
            found.append(planning.reached(state, feature))
        except Refused as reason:
            try:
                if other is None:
                    raise
                found.append(planning.reached(other, feature))
            except Refused:
                state.findings.append(not_reached(feature, str(reason)))
    return tuple(found)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Planning:
    """What is known while it is looked at how holes are reached: the part's triangles in `groups`, and by setup and direction what stands
    around holes there."""

    groups: SkinGroups
    settings: HoleSettings
    drilling: DrillSettings
    finishing: FinishSettings
    spaces: dict[tuple[str, Direction], HoleSpace] = field(default_factory=dict)

    def reached(self, state: SetupPlanState, feature: Feature) -> SetupHole:
        """Return a hole as a setup makes it; raise `Refused` where the part is in the way."""
        direction = _outward(state, feature)
        around = self._space(state, direction)
        shape = hole_in(feature, state.recognition.frame, around.space.setup.frame)
        if not around.is_open((shape.bore, *shape.counterbores)[-1]):
            raise Refused(f"{feature.id}: the part covers its mouth")
        finish = bore_finish(
            feature,
            shape,
            state.cutters,
            around,
            self.finishing,
            state.material,
            state.shop,
        )
        finish = threaded(
            finish, shape, state.cutters, around, self.settings, self.finishing.thread_milling
        )
        before = shape.bore if finish is None else finish.before
        hole = SetupHole(
            feature=feature,
            state=state,
            direction=direction,
            shape=shape,
            around=around,
            drills=drills_for(
                before,
                state.cutters("drill"),
                around,
                drill_tolerance(finish, self.settings),
                self.drilling.breakthrough,
            ),
            mills=Candidates(tools=()),
            before=before,
            finish=finish,
            settings=self.settings,
            breakthrough=self.drilling.breakthrough,
        )
        if hole.drills.tools:
            return hole
        hole = replace(hole, mills=hole.mills_for(before))
        if hole.drills.hindered and not hole.mills.tools:
            raise Refused(f"{feature.id}: {hole.drills.reason}")
        return hole

    def _space(self, state: SetupPlanState, direction: Direction) -> HoleSpace:
        key = (state.setup.name, direction)
        if key not in self.spaces:
            setup = cutting_setup(state.setup, direction, state.blank)
            self.spaces[key] = HoleSpace(
                space=SetupSpace.of(state.part, state.recognition, state.blank, setup),
                clearance=state.route.reach_clearance,
                groups=self.groups,
            )
        return self.spaces[key]


def _outward(state: SetupPlanState, feature: Feature) -> Direction:
    """Return the way out of a hole in the setup's frame; of a through hole along the axis the end that looks up."""
    world = state.recognition.frame.world_direction(outward_direction(feature))
    x, y, z = state.direction(world)
    if z < -1.0 + 10.0**-SAME_SIZE:
        return state.direction(-world)
    return (x, y, z)


def outward_direction(feature: Feature) -> Floats:
    """Return the unit direction (3,) in the recognition's frame that a tool leaves a hole in: of a through hole as wide at both ends that
    away from the frame's axis, where nothing stands across from it."""
    out = hole_direction(feature)
    if is_plain_through(feature):
        x, y, depth = (hole_size(feature, name) for name in ("x", "y", "depth"))
        middle = np.array([x, y]) - 0.5 * depth * out[:2]
        if float(out[:2] @ middle) < -tolerance.SEW:
            return -out
    return out


def plan_holes(state: SetupPlanState, stage: Stage, holes: Sequence[SetupHole]) -> None:
    """Add the operations of a stage on holes: all equal ones of one direction that a tool fits together."""
    rule = RULES[stage.kind]
    groups: dict[tuple[object, ...], list[tuple[SetupHole, PlannedHole, Candidates]]] = {}
    missing: dict[Candidates, list[tuple[SetupHole, PlannedHole]]] = {}
    for hole in holes:
        made = rule(hole)
        if made is None:
            continue
        part, found = made
        if not found.tools:
            missing.setdefault(found, []).append((hole, part))
            continue
        key = (
            hole.state.setup.name,
            tuple(round(v, 2 * SAME_SIZE) for v in hole.direction),
            round(part.diameter, SAME_SIZE),
            round(part.depth, SAME_SIZE),
            part.through,
            found.tools[0].name,
            hole.allowance,
            hole.shape.thread,
        )
        groups.setdefault(key, []).append((hole, part, found))
    state.findings += [
        no_tool(stage, [h.feature for h, _ in these], (t for _, p in these for t in p.faces), found)
        for found, these in missing.items()
    ]
    for group in groups.values():
        _add(stage, group)


def _add(stage: Stage, group: Sequence[tuple[SetupHole, PlannedHole, Candidates]]) -> None:
    first, part, found = group[0]
    state, tool = first.state, found.tools[0]
    deepest = max(p.depth for _, p, _ in group)
    number = f"{len(group)} holes" if len(group) > 1 else "one hole"
    state.add(
        stage,
        first.feature.id,
        first.feature.id,
        tool,
        data=hole_data(stage.kind, tool, state.material, state.machine, state.shop, state.cutting),
        faces=tuple(t for _, p, _ in group for t in p.faces),
        why=f"{number} of D {trimmed(part.diameter, 3)}, {trimmed(deepest, 2)} mm deep: {tool.name} reaches their bottoms and "
        "keeps clear of what stands around them.",
        choices=_own_choices(stage, first),
        direction=first.direction,
        others=tuple(h.feature.id for h, _, _ in group[1:]),
    )


def _own_choices(stage: Stage, hole: SetupHole) -> dict[str, Value]:
    """Return the settings that an operation has for itself: what milling a bore leaves for the reamer."""
    if stage.kind in (BORE, FLOOR) and hole.allowance > 0.0:
        return {MILL_ALLOWANCE: hole.allowance}
    return {}


Made = tuple[PlannedHole, Candidates] | None


def _spotted(hole: SetupHole) -> Made:
    """Return a hole to be drilled with the spotting drills, the widest first: its cone says how wide the spot is."""
    if not hole.settings.spot or not hole.drills.tools:
        return None
    drills = sorted(hole.state.cutters("spot"), key=lambda t: (-t.diameter, t.name))
    return replace(hole.before, faces=()), Candidates(
        tools=tuple(drills),
        reason="the catalogue has no spotting drill for this material",
        remedy="add one to the tools folder",
    )


def _drilled(hole: SetupHole) -> Made:
    if hole.mills.tools:
        return None
    bore = replace(hole.before, faces=hole.bored_faces())
    return bore, either(hole.drills, hole.mills)


def _milled(hole: SetupHole) -> Made:
    if not hole.mills.tools:
        return None
    return replace(hole.before, faces=hole.bored_faces()), hole.mills


def _floored(hole: SetupHole) -> Made:
    """Return the flat floor that a drill has left its point over."""
    bore = hole.before
    if not bore.is_flat or not hole.drills.tools:
        return None
    return replace(bore, faces=hole.feature.with_role("bottom")), hole.mills_for(bore)


def _counterbored(hole: SetupHole) -> Made:
    """Return the deepest step: what gets down to it mills the others too."""
    if not hole.shape.counterbores:
        return None
    part = hole.shape.counterbores[0]
    return part, hole.mills_for(part)


def _sunk(hole: SetupHole) -> Made:
    sink = hole.shape.countersink
    if sink is None:
        return None
    found = sinks_for(hole.shape.bore, sink, hole.state.cutters("countersink"), hole.around)
    faces = hole.feature.with_role("countersink")
    return replace(hole.shape.bore, diameter=sink.diameter, faces=faces), found


def _finished(kind: str) -> Callable[[SetupHole], Made]:
    """Return the rule of reaming, boring or threading: the bore whose demand asks for it."""

    def rule(hole: SetupHole) -> Made:
        if hole.finish is None or hole.finish.kind != kind:
            return None
        part = replace(hole.shape.narrow, faces=hole.feature.with_role("side"))
        return part, hole.finish.found

    return rule


RULES: dict[str, Callable[[SetupHole], Made]] = {
    SPOT: _spotted,
    DRILL: _drilled,
    BORE: _milled,
    FLOOR: _floored,
    COUNTERBORE: _counterbored,
    COUNTERSINK: _sunk,
    REAM: _finished(REAM),
    FINE_BORE: _finished(FINE_BORE),
    TAP: _finished(TAP),
    MILL_THREAD: _finished(MILL_THREAD),
}
"""What a stage of a kind cuts of a hole, with the tools for it."""
