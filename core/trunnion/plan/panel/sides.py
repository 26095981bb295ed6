"""Which setup makes a feature: the first that reaches it. What goes through belongs to the first setup, unless that can't reach it: then to
the one turned over, or half to each. What opens at an edge belongs to the setup on the other one."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from trunnion import tolerance
from trunnion.findings import Refused
from trunnion.model.feature import Feature, Recognition
from trunnion.plan.holes.hole import is_plain_through, is_wider_behind
from trunnion.plan.panel.edges import number_on_edge
from trunnion.plan.panel.freeform.slope_tasks import slopes_of
from trunnion.plan.panel.hole_tasks import hole_reach
from trunnion.plan.panel.outline_tasks import OUTLINE_TASK_MAKERS
from trunnion.plan.panel.side_settings import SidesSettings
from trunnion.plan.panel.tasks import PanelPlanState, catalogue
from trunnion.plan.prismatic.regions import SectionSource
from trunnion.plan.setups import from_below
from trunnion.plan.tool_choice import candidates
from trunnion.settings import choose
from trunnion.shop import Stage

LEVEL = math.sin(tolerance.ANGLE)
"""Least height of a unit normal that looks up or down."""
PROFILE_RULES = ("profile_rough", "profile_finish")
"""Cutter rules of the stages that cut an outline, which goes through like a hole."""
HOLE_RULES = ("drill", "hole_mill")
"""Cutter rules of the stages that make the bore of a hole."""


def shared_out(
    states: Sequence[PanelPlanState], features: Sequence[Feature], stages: Sequence[Stage]
) -> list[list[Feature]]:
    """Return the features that each setup cuts, in order; the states are told which of them are cut from both sides."""
    upright = [n for n, s in enumerate(states) if not s.space.is_on_edge]
    own: list[list[Feature]] = [[] for _ in states]
    rest: list[Feature] = []
    setups = [state.space.setup for state in states]
    for feature in features:
        number = number_on_edge(feature, setups, states[0].recognition)
        if number is None:
            rest.append(feature)
        else:
            own[number].append(feature)
    for n, mine in zip(
        upright, _between_sides([states[n] for n in upright], rest, stages), strict=True
    ):
        own[n] += mine
    return own


def _between_sides(
    states: Sequence[PanelPlanState], features: Sequence[Feature], stages: Sequence[Stage]
) -> list[list[Feature]]:
    """Return the features that the upper and the lower side cut; the states are told which of them are cut from both."""
    bored = {kind for s in stages if s.cutter in HOLE_RULES for kind in s.on}
    outlines = {kind for s in stages if s.cutter in PROFILE_RULES for kind in s.on}
    own: list[list[Feature]] = [[] for _ in states]
    for feature in features:
        if len(states) < 2:
            numbers: tuple[int, ...] = (0,)
        elif feature.kind in bored:
            numbers = _of_hole(feature, states)
        elif feature.kind in outlines:
            numbers = _of_outline(feature, states, stages)
            if numbers == (0,) and 1 in _of_slopes(feature, states):
                states[1].slopes.add(feature.id)
                numbers = (0, 1)
        elif slopes_of(feature):
            numbers = _of_slopes(feature, states) or (0,)
            for n in numbers[1:]:
                states[n].slopes.add(feature.id)
        else:
            recognition, part = states[0].recognition, states[0].space.part
            numbers = (int(is_from_below(feature, recognition, part)),)
        for n in numbers:
            own[n].append(feature)
    return own


def is_from_below(feature: Feature, recognition: Recognition, part: SectionSource) -> bool:
    """Return whether a feature is reached from under the part: as it says itself, else as its floor or top looks; one that stands upright,
    as the back of a pit does, does not say."""
    tags = feature.with_role("floor", "top")
    if "direction" in feature.attributes or not tags:
        return from_below(feature)
    up = float(recognition.frame.local_direction(part.graph().normal[tags[0] - 1])[2])
    return up < -LEVEL


def _of_hole(feature: Feature, states: Sequence[PanelPlanState]) -> tuple[int, ...]:
    """Return the setups that make a hole: a plain one that goes through the first that has tools for it, or two for half of it each; one
    that is wider at both ends both, the first of which bores it."""
    first = int(from_below(feature))
    if is_wider_behind(feature) and all(_is_reached(s, feature) for s in states):
        for state in states:
            state.both_ends.add(feature.id)
        states[1].bored.add(feature.id)
        return (0, 1)
    if not is_plain_through(feature):
        return (first,)
    for n, state in enumerate(states):
        if _has_tools(state, feature):
            return (n,)
    if _allows_halves(states[0]) and all(_has_tools(s, feature, half=True) for s in states):
        return _halved(feature, states)
    return (0,)


def _is_reached(state: PanelPlanState, feature: Feature) -> bool:
    try:
        hole_reach(state, feature)
    except Refused:
        return False
    return True


def _has_tools(state: PanelPlanState, feature: Feature, half: bool = False) -> bool:
    return _is_reached(state, feature) and hole_reach(state, feature, half).has_tools


def _of_outline(
    feature: Feature, states: Sequence[PanelPlanState], stages: Sequence[Stage]
) -> tuple[int, ...]:
    """Return the setups that cut an outline: the first, or both where no cutter is long enough for more than half of it."""
    if _fits_outline(states[0], feature, stages) or not _allows_halves(states[0]):
        return (0,)
    numbers = _halved(feature, states)
    if all(_fits_outline(state, feature, stages) for state in states):
        return numbers
    for state in states:
        state.halved.discard(feature.id)
    return (0,)


def _of_slopes(feature: Feature, states: Sequence[PanelPlanState]) -> tuple[int, ...]:
    """Return the setups that see what of a feature leans, or some of it where it winds to either side."""
    graph = states[0].space.part.graph()
    mine = np.isin(graph.sample_face, [t - 1 for t in slopes_of(feature)])
    normals = graph.sample_normal[mine]
    return tuple(
        n
        for n, state in enumerate(states)
        if (state.space.setup.frame.local_direction(normals)[:, 2] > LEVEL).any()
    )


def _fits_outline(state: PanelPlanState, feature: Feature, stages: Sequence[Stage]) -> bool:
    """Return whether every stage on an outline has a cutter for it."""
    return all(
        candidates(
            task.requirement,
            catalogue(state, stage),
            state.settings.reach_clearance,
            state.progress,
        ).tools
        for stage in stages
        if stage.cutter in PROFILE_RULES
        for task in OUTLINE_TASK_MAKERS[stage.cutter](state, stage, [feature])
    )


def _halved(feature: Feature, states: Sequence[PanelPlanState]) -> tuple[int, ...]:
    for state in states:
        state.halved.add(feature.id)
    return tuple(range(len(states)))


def _allows_halves(state: PanelPlanState) -> bool:
    return choose(SidesSettings, state.choices).halves
