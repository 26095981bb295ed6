"""Free tool axes along contact passes: near what is wanted, clear of everything, turning no faster than allowed."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from pytest import approx

from leaning_tools import contact_of, cutter
from surface_drives import DATA, driven, grid, roughed
from trunnion.findings import Refused
from trunnion.geometry.sphere import angle_between
from trunnion.pipeline.planning.clearance import ToolClearanceQuery
from trunnion.plan.freeform.cutters.cutter import tip_at
from trunnion.progress import NO_PROGRESS
from trunnion.settings import choose
from trunnion.toolpath.contact_passes.axis_fields import fixed, leaning
from trunnion.toolpath.contact_passes.axis_search import (
    AxisSearch,
    LeanLimits,
    free_axes,
    leaned,
    thickened,
)
from trunnion.toolpath.contact_passes.contacts import Contacts, slerp
from trunnion.toolpath.contact_passes.passes import UPRIGHT, Pass
from trunnion.toolpath.surface.parallel import ParallelSettings, parallel

BALL = cutter("ball", diameter=6.0, corner=3.0, flute=12.0)
WANTED = leaning(math.radians(10.0), 0.0)


class Boxes:
    """Boxes to touch, and the lowest direction that a machine can hold."""

    def __init__(self, *boxes, lowest=-1.0):
        self._contact, self._lowest, self.asked = contact_of(*boxes), lowest, 0

    def holds(self, axis):
        return axis[:, 2] >= self._lowest

    def clear(self, moves):
        self.asked += len(moves)
        return self._contact.clear(moves, 0.005)


def asker(*boxes, tool=BALL, lowest=-1.0):
    return ToolClearanceQuery(Boxes(*boxes, lowest=lowest), thickened(tool, 0.2))


def straight(length=30.0, n=61, y=0.0):
    x = np.linspace(0.0, length, n)
    return Contacts(
        point=np.column_stack([x, np.full(n, y), np.zeros(n)]), normal=np.tile(UPRIGHT, (n, 1))
    )


def edge(radius=0.5, length=15.0, n=60):
    """Along a floor, round an edge and back underneath: what a blade's edge asks of a tool."""
    angle = np.linspace(0.0, np.pi, n)
    out = np.column_stack([np.sin(angle), np.zeros(n), np.cos(angle)])
    flat = np.linspace(-length, 0.0, n)[:-1]
    above = np.column_stack([flat, np.zeros(n - 1), np.full(n - 1, radius)])
    normal = np.vstack(
        [np.tile([0.0, 0.0, 1.0], (n - 1, 1)), out, np.tile([0.0, 0.0, -1.0], (n - 1, 1))]
    )
    return Contacts(
        point=np.vstack([above, radius * out, above[::-1] * [1.0, 1.0, -1.0]]), normal=normal
    )


WALL = ((-50.0, 4.0, -5.0), (90.0, 20.0, 60.0))
"""Beside the way along x, higher than the tool is long."""


def poses(way, course, tool=BALL):
    at = np.clip(np.round(course.position).astype(int), 0, len(way) - 1)
    return tip_at(tool, way.point[at], way.normal[at], course.axis)


def test_without_anything_in_the_way_axes_are_as_wanted() -> None:
    way = straight()
    (course,) = free_axes(
        [way], WANTED, BALL, asker(((-99.0, -99.0, -9.0), (99.0, 99.0, 0.0))), LeanLimits()
    )
    assert course.free.all() and not course.leap[1:].any()
    assert course.axis == approx(
        np.tile(
            [math.sin(math.radians(10.0)), 0.0, math.cos(math.radians(10.0))], (len(course.axis), 1)
        )
    )


def test_beside_a_wall_the_tool_leans_away_from_it_and_no_further_than_needed() -> None:
    way, ask = straight(), asker(WALL)
    (course,) = free_axes([way], fixed([0.0, 0.0, 1.0]), BALL, ask, LeanLimits())
    assert course.free.all() and ask(poses(way, course), course.axis).all()
    lean = np.degrees(np.arccos(course.axis[:, 2]))
    # The holder, 32.5 mm thick about 32 mm up, stands against the wall: that is what it has to lean for.
    assert (course.axis[:, 1] < 0.0).all() and lean.min() > 20.0 and lean.max() < 60.0


def test_in_a_deep_slot_no_axis_is_free_and_the_pass_has_a_gap() -> None:
    slot = (((40.0, 4.0, -5.0), (60.0, 20.0, 60.0)), ((40.0, -20.0, -5.0), (60.0, -4.0, 60.0)))
    (course,) = free_axes(
        [straight(length=100.0, n=101)],
        WANTED,
        BALL,
        asker(*slot),
        LeanLimits(steepest=math.radians(30.0)),
    )
    gone = course.position[~course.free]
    assert 20.0 < gone.min() < 45.0 and 55.0 < gone.max() < 80.0
    assert len(course.runs()) == 2
    assert all(run.free.all() for run in course.runs())


def test_an_axis_that_the_machine_cannot_hold_is_never_chosen() -> None:
    way = edge()
    (course,) = free_axes(
        [way],
        WANTED,
        BALL,
        asker(((90.0, 90.0, 90.0), (91.0, 91.0, 91.0)), lowest=0.0),
        LeanLimits(),
    )
    assert (course.axis[course.free, 2] >= -1e-9).all()
    # Under the edge, where the face looks straight down, nothing from above reaches.
    assert not course.free[-3:].any()


def test_round_an_edge_axes_turn_no_faster_than_allowed() -> None:
    way, limits = edge(), LeanLimits(turn=math.radians(10.0))
    (course,) = free_axes([way], WANTED, BALL, None, limits)
    assert course.free.all() and not course.leap[1:].any()
    travel = np.interp(course.position, np.arange(len(way)), way.travel(3.0))
    rate = angle_between(course.axis[1:], course.axis[:-1]) / np.diff(travel)
    assert np.degrees(rate.max()) < 10.0
    at = np.clip(np.round(course.position).astype(int), 0, len(way) - 1)
    assert np.degrees(angle_between(course.axis, way.normal[at])).max() < 75.0 + 5.0


def test_what_lies_alike_is_asked_once() -> None:
    ways = [straight(y=0.1 * k) for k in range(8)]
    one, many = Boxes(WALL), Boxes(WALL)
    free_axes(ways[:1], WANTED, BALL, ToolClearanceQuery(one, thickened(BALL, 0.2)), LeanLimits())
    free_axes(ways, WANTED, BALL, ToolClearanceQuery(many, thickened(BALL, 0.2)), LeanLimits())
    assert many.asked < 3 * one.asked


def test_a_move_that_touches_makes_the_search_choose_others() -> None:
    search = AxisSearch(
        [straight()], WANTED, BALL, asker(((-99.0, -99.0, -9.0), (99.0, 99.0, 0.0))), LeanLimits()
    )
    (before,) = search.found_axes()
    for _ in range(4):
        search.met({0: np.array([30.5])})
        (after,) = search.found_axes()
    assert np.abs(after.axis - before.axis).max() > 0.05 and after.free.all()


def test_the_same_question_gives_the_same_axes() -> None:
    first, second = (
        free_axes([edge()], WANTED, BALL, asker(WALL), LeanLimits())[0] for _ in range(2)
    )
    assert (
        first.axis.tobytes() == second.axis.tobytes()
        and first.free.tobytes() == second.free.tobytes()
    )


def test_leaned_passes_of_a_ball_keep_its_centre_on_its_way() -> None:
    x = np.linspace(0.0, 30.0, 31)
    tip = np.column_stack([x, np.zeros(31), 0.02 * x * x])
    normal = np.column_stack([-0.04 * x, np.zeros(31), np.ones(31)])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    upright = Pass(tip=tip, axis=np.tile(UPRIGHT, (31, 1)), normal=normal)
    chord = 0.0005
    (one,) = leaned([upright], BALL, leaning(0.0, math.radians(30.0)), None, LeanLimits(), chord)
    share = np.linspace(0.0, 1.0, 11)
    for k in range(len(one) - 1):
        axis = slerp(np.tile(one.axis[k], (11, 1)), np.tile(one.axis[k + 1], (11, 1)), share)
        centre = one.tip[k] + share[:, None] * (one.tip[k + 1] - one.tip[k]) + 3.0 * axis
        height = np.interp(centre[:, 0], tip[:, 0], tip[:, 2] + 3.0)
        assert (
            np.abs(centre[:, 2] - height).max() < 1.1 * chord
            and np.abs(centre[:, 1]).max() < 1.1 * chord
        )
    assert one.tip[0] + 3.0 * one.axis[0] == approx(tip[0] + [0.0, 0.0, 3.0])


def test_leaned_passes_reach_beside_a_wall_where_upright_ones_touch() -> None:
    x = np.linspace(0.0, 20.0, 21)
    upright = Pass(
        tip=np.column_stack([x, np.zeros(21), np.zeros(21)]),
        axis=np.tile(UPRIGHT, (21, 1)),
        normal=np.tile(UPRIGHT, (21, 1)),
    )
    ask = asker(WALL)
    assert not ask(upright.tip, upright.axis).any()
    (one,) = leaned([upright], BALL, fixed([0.0, 0.0, 1.0]), ask, LeanLimits(), 0.001)
    assert ask(one.tip[1:], one.axis[1:], start_tip=one.tip[:-1], start_axis=one.axis[:-1]).all()


def over_a_floor(ask=None, tool=BALL, **chosen):
    floor = grid(lambda x, y: 0.0 * x, n=8, high=(20.0, 6.0))
    drive, setup, stock = driven(floor, height=0.1)
    return parallel(
        replace(drive, query_for=ask),
        tool,
        DATA,
        roughed(stock, floor),
        setup,
        choose(ParallelSettings, chosen),
        NO_PROGRESS,
    )


def test_parallel_passes_of_a_ball_lean_by_a_tilt_and_keep_their_centre() -> None:
    floor = ((0.0, 0.0, -9.0), (20.0, 6.0, 0.0))
    upright, plan = over_a_floor(), over_a_floor(lambda tool: asker(floor, tool=tool), tilt=20.0)
    cut, before = plan.path.mark == 0, upright.path.mark == 0
    assert np.degrees(np.arccos(plan.path.axis[cut, 2])) == approx(
        np.full(cut.sum(), 20.0), abs=0.01
    )
    centre = plan.path.position[cut] + 3.0 * plan.path.axis[cut]
    assert centre.min(axis=0) == approx(
        upright.path.position[before].min(axis=0) + [0.0, 0.0, 3.0], abs=0.002
    )
    assert not plan.findings


def test_a_lead_is_refused_on_three_axes_and_for_cutters_that_are_no_balls() -> None:
    with pytest.raises(Refused, match="rotary axes"):
        over_a_floor(lead=10.0)
    with pytest.raises(Refused, match="only passes of a ball"):
        over_a_floor(lambda tool: asker(WALL, tool=tool), cutter("bull", corner=2.0), lead=10.0)
