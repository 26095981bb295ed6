"""The operations on the holes of a casing: along their own axes, one for all equal holes of one direction.

What the setup does not reach, such as the lower flange's bolt circle under the upper flange, is made with the part turned over.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from trunnion import tolerance
from trunnion.findings import Refused, error, face_tags
from trunnion.geometry.arrays import Floats
from trunnion.model.feature import Feature
from trunnion.model.tool import Tool
from trunnion.plan.casing.plan_state import CasingPlanState
from trunnion.plan.freeform.frames import Direction, cutting_setup
from trunnion.plan.holes.axis_clearance import SkinGroups
from trunnion.plan.holes.drive import BORE, COUNTERBORE, COUNTERSINK, DRILL, not_reached
from trunnion.plan.holes.hole import (
    HoleShape,
    PlannedHole,
    hole_direction,
    hole_in,
    hole_size,
    is_plain_through,
)
from trunnion.plan.holes.settings import DrillSettings, HoleSettings
from trunnion.plan.holes.tools import HoleSpace, drills_for, mills_for, sinks_for
from trunnion.plan.prismatic.regions import SetupSpace
from trunnion.plan.tool_choice import Candidates
from trunnion.recognize.casing.kinds import HOLE
from trunnion.settings import choose
from trunnion.shop import Stage
from trunnion.units import trimmed

SAME_SIZE = 3
"""Decimals of mm, and of a direction, by which holes are held to be equal."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CasingHole:
    """A hole seen along its own axis in the setup that makes it, with the drills for its bore, or the end mills where no drill fits."""

    feature: Feature
    setup: str
    direction: Direction
    shape: HoleShape
    around: HoleSpace
    drills: Candidates
    mills: Candidates


def casing_holes(state: CasingPlanState) -> tuple[CasingHole, ...]:
    """Return the holes that are reached along their own axes, in the setup or with the part turned over; tell of the others."""
    found = list[CasingHole]()
    other = state.turned_over()
    spaces: dict[tuple[str, Direction], HoleSpace] = {}
    groups = SkinGroups.of(state.context.skin(tolerance.CHORD, state.progress))
    for feature in state.progress.each(state.recognition.of_kind(HOLE)):
        try:
            found.append(_reached(state, feature, spaces, groups))
        except Refused as reason:
            try:
                if other is None:
                    raise
                found.append(_reached(other, feature, spaces, groups))
            except Refused:
                state.findings.append(not_reached(feature, str(reason)))
    return tuple(found)


def _reached(
    state: CasingPlanState,
    feature: Feature,
    spaces: dict[tuple[str, Direction], HoleSpace],
    groups: SkinGroups,
) -> CasingHole:
    """Return a hole as the setup makes it; `spaces` keeps what stands along directions, of the triangles in `groups`.

    Raises `Refused` where the part is in the way.
    """
    drilling, settings = choose(DrillSettings, {}), choose(HoleSettings, {})
    direction = _outward(state, feature)
    key = (state.setup.name, direction)
    if key not in spaces:
        setup = cutting_setup(state.setup, direction, state.blank)
        spaces[key] = HoleSpace(
            space=SetupSpace.of(state.part, state.recognition, state.blank, setup),
            clearance=state.route.reach_clearance,
            groups=groups,
        )
    around = spaces[key]
    shape = hole_in(feature, state.recognition.frame, around.space.setup.frame)
    if not around.is_open((shape.bore, *shape.counterbores)[-1]):
        raise Refused(f"{feature.id}: the part covers its mouth")
    drills = drills_for(
        shape.bore,
        state.cutters("drill"),
        around,
        settings.diameter_tolerance,
        drilling.breakthrough,
    )
    mills = (
        Candidates(tools=())
        if drills.tools
        else mills_for(
            shape.bore, state.cutters("finish"), around, shape.bore.top, drilling.breakthrough
        )
    )
    if drills.hindered and not mills.tools:
        raise Refused(f"{feature.id}: {drills.reason}")
    return CasingHole(
        feature=feature,
        setup=state.setup.name,
        direction=direction,
        shape=shape,
        around=around,
        drills=drills,
        mills=mills,
    )


def _outward(state: CasingPlanState, feature: Feature) -> Direction:
    """Return the way out of a hole in the setup's frame; of a through hole along the axis the end that looks up."""
    world = state.recognition.frame.world_direction(outward_direction(feature))
    x, y, z = state.direction(world)
    if z < -1.0 + 10.0**-SAME_SIZE:
        return state.direction(-world)
    return (x, y, z)


def outward_direction(feature: Feature) -> Floats:
    """Return the unit direction (3,) in the casing's frame that a tool leaves a hole in: of a through hole that is as wide at both ends the
    one away from the casing's axis, where nothing stands across from it."""
    out = hole_direction(feature)
    if is_plain_through(feature):
        x, y, depth = (hole_size(feature, name) for name in ("x", "y", "depth"))
        middle = np.array([x, y]) - 0.5 * depth * out[:2]
        if float(out[:2] @ middle) < -tolerance.SEW:
            return -out
    return out


def plan_holes(state: CasingPlanState, stage: Stage, holes: Sequence[CasingHole]) -> None:
    """Add the operations of a stage on holes: all equal ones of one direction that a tool fits together."""
    rule = RULES[stage.kind]
    groups: dict[tuple[object, ...], list[tuple[CasingHole, PlannedHole, Candidates]]] = {}
    for hole in holes:
        made = rule(state, hole)
        if made is None:
            continue
        part, found = made
        if not found.tools:
            state.findings.append(
                error(
                    "route.no-cutter",
                    f"{hole.feature.id}: {found.reason} ({stage.name})",
                    hole.feature.id,
                    *face_tags(part.faces),
                    remedy=found.remedy,
                )
            )
            continue
        key = (
            hole.setup,
            tuple(round(v, 2 * SAME_SIZE) for v in hole.direction),
            round(part.diameter, SAME_SIZE),
            round(part.depth, SAME_SIZE),
            part.through,
            found.tools[0].name,
        )
        groups.setdefault(key, []).append((hole, part, found))
    for group in groups.values():
        _add(state, stage, group)


def _add(
    state: CasingPlanState,
    stage: Stage,
    group: Sequence[tuple[CasingHole, PlannedHole, Candidates]],
) -> None:
    first, part, found = group[0]
    tool: Tool = found.tools[0]
    deepest = max(p.depth for _, p, _ in group)
    number = f"{len(group)} holes" if len(group) > 1 else "one hole"
    state.add(
        stage,
        first.feature.id,
        first.feature.id,
        tool,
        depth=min(deepest, tool.flute_length),
        width=part.diameter,
        faces=tuple(t for _, p, _ in group for t in p.faces),
        why=f"{number} of D {trimmed(part.diameter, 3)}, {trimmed(deepest, 2)} mm deep: {tool.name} reaches their bottoms and "
        "keeps clear of what stands around them.",
        direction=first.direction,
        others=tuple(h.feature.id for h, _, _ in group[1:]),
        setup=first.setup,
    )


Made = tuple[PlannedHole, Candidates] | None


def _drilled(state: CasingPlanState, hole: CasingHole) -> Made:
    if hole.mills.tools:
        return None
    return hole.shape.bore, hole.drills


def _milled(state: CasingPlanState, hole: CasingHole) -> Made:
    return (hole.shape.bore, hole.mills) if hole.mills.tools else None


def _counterbored(state: CasingPlanState, hole: CasingHole) -> Made:
    if not hole.shape.counterbores:
        return None
    drilling, part = choose(DrillSettings, {}), hole.shape.counterbores[0]
    found = mills_for(
        part, state.cutters("finish"), hole.around, hole.shape.bore.top, drilling.breakthrough
    )
    return part, found


def _sunk(state: CasingPlanState, hole: CasingHole) -> Made:
    sink = hole.shape.countersink
    if sink is None:
        return None
    found = sinks_for(hole.shape.bore, sink, state.cutters("countersink"), hole.around)
    faces = hole.feature.with_role("countersink")
    return replace(hole.shape.bore, diameter=sink.diameter, faces=faces), found


RULES: dict[str, Callable[[CasingPlanState, CasingHole], Made]] = {
    DRILL: _drilled,
    BORE: _milled,
    COUNTERBORE: _counterbored,
    COUNTERSINK: _sunk,
}
"""What a stage of a kind cuts of a hole, with the tools for it."""
