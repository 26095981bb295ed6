"""Where a machine's axes stand, how long it takes, and what it can't do."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from pytest import approx

from own_shop import own_shop
from trunnion.model.material import Axis
from trunnion.model.motion.program import ProgramSection
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.verify.kernels.rotary import choose_angles_greedy
from trunnion.verify.kernels.timing import block_times
from trunnion.verify.machine.kinematics import (
    UP,
    axis_positions,
    linear_positions,
    poses_of,
    rotary_angles,
    turned,
    turned_axes,
)
from trunnion.verify.machine.limits import limit_findings
from trunnion.verify.machine.times import times_of
from trunnion.verify.motion import moves_of
from verify_tools import MACHINE, flat

SHOP = own_shop()
TABLE, FORK = SHOP.machine("Trunnion 650"), SHOP.machine("Gantry 6000 fork")
HEAD_AND_TABLE = replace(
    MACHINE,
    axes=(
        *MACHINE.axes,
        Axis(
            name="B",
            kind="rotary",
            low=-100.0,
            high=100.0,
            rapid=9000.0,
            acceleration=600.0,
            direction=(0.0, 1.0, 0.0),
            carries="tool",
        ),
        Axis(
            name="C",
            kind="rotary",
            low=-720.0,
            high=720.0,
            rapid=9000.0,
            acceleration=600.0,
            direction=(0.0, 0.0, -1.0),
            carries="work",
        ),
    ),
)


def leaning(*stops, feed=1000.0, spindle=10000.0):
    """Return a section of (tip, axis) stops, the first a rapid."""
    n = len(stops)
    axis = np.array([s[1] for s in stops], dtype=float)
    path = Toolpath(
        position=[s[0] for s in stops],
        axis=axis / np.linalg.norm(axis, axis=1, keepdims=True),
        motion=[Motion.RAPID, *[Motion.LINE] * (n - 1)],
        centre=np.full((n, 3), np.nan),
        feed=[0.0, *[feed] * (n - 1)],
        mark=[0] * n,
    )
    return ProgramSection(operation="op", tool=flat(10.0)(flute=25.0), spindle=spindle, path=path)


def lean(degrees, around=0.0):
    """Return the axis that leans from z towards a direction in plan."""
    a, b = math.radians(degrees), math.radians(around)
    return math.sin(a) * math.cos(b), math.sin(a) * math.sin(b), math.cos(a)


def said(section, machine):
    moves = moves_of((section,))
    return limit_findings(
        "S1", (section,), moves, axis_positions(moves, machine, np.zeros(3)), machine
    )


def test_a_fork_leans_the_tool_by_its_own_angles():
    angles, good = rotary_angles(np.array([UP, (0.0, -math.sin(0.5), math.cos(0.5))]), FORK)
    assert good.all()
    assert angles[1] == approx([0.0, 0.5], abs=1e-12)


def test_a_table_leans_the_work_the_other_way_and_names_the_same_angle():
    # A at -30 degrees: what stood upright in the work now leans towards -y, so the upright spindle leans towards +y in the work.
    angles, _ = rotary_angles(np.array([UP, (0.0, 0.5, math.sqrt(0.75))]), TABLE)
    assert np.degrees(angles[1]) == approx([-30.0, 0.0], abs=1e-9)


@pytest.mark.parametrize("machine", [TABLE, FORK, HEAD_AND_TABLE], ids=lambda m: m.name)
def test_the_angles_bring_the_spindle_onto_the_axis(machine):
    rng = np.random.default_rng(1)
    axis = rng.normal(size=(200, 3)) + [0.0, 0.0, 2.0]
    axis = np.vstack([UP, axis / np.linalg.norm(axis, axis=1, keepdims=True)])
    angles, good = rotary_angles(axis, machine)
    work, tool = axis, np.broadcast_to(UP, axis.shape)
    for k in reversed(range(2)):
        if machine.rotary[k].carries == "work":
            work = turned(work, machine.rotary[k], angles[:, k])
        else:
            tool = turned(tool, machine.rotary[k], angles[:, k])
    assert good.all()
    assert work == approx(tool, abs=1e-9)


def test_a_cone_of_axes_is_followed_the_short_way_through_several_turns():
    axis = np.array([lean(20.0, 10.0 * k) for k in range(109)])
    angles, _ = rotary_angles(axis, TABLE)
    assert np.degrees(np.abs(np.diff(angles[:, 1]))) == approx(10.0)
    assert abs(math.degrees(angles[-1, 1] - angles[0, 1])) == approx(1080.0)


def test_the_axis_keeps_c_where_it_stands_while_the_tool_is_upright():
    angles, _ = rotary_angles(np.array([UP, lean(10.0, 40.0), UP, lean(10.0, 40.0)]), FORK)
    assert angles[2, 0] == approx(angles[1, 0])
    assert np.abs(np.diff(angles[1:, 0])).max() == approx(0.0, abs=1e-9)


def test_a_fork_swings_its_pivot_around_a_tip_that_stands():
    # Pivot 220 above the spindle's face, gauge 100: an arm of 320. At A 30 the pivot is 320 sin 30 beside, 320 (1 - cos 30) lower.
    angle = np.array([[0.0, 0.0], [0.0, math.radians(30.0)]])
    place = linear_positions(np.zeros((2, 3)), np.full(2, 100.0), angle, FORK)
    assert place[1] - place[0] == approx([0.0, -160.0, -320.0 * (1.0 - math.sqrt(0.75))])


def test_a_table_swings_the_tip_around_its_pivot():
    # The tip stands 50 above the table's A axis, which lies 50 above the table: at A 90 about -x it comes to y + 50, z - 50.
    place = linear_positions(
        np.array([[0.0, 0.0, 100.0]] * 2),
        np.zeros(2),
        np.array([[0.0, 0.0], [math.pi / 2, 0.0]]),
        TABLE,
    )
    assert place[1] - place[0] == approx([0.0, 50.0, -50.0])


def test_poses_along_an_arc_lie_on_its_circle():
    path = Toolpath(
        position=[(10.0, 0.0, 0.0), (0.0, 10.0, 4.0)],
        axis=[UP, UP],
        motion=[Motion.RAPID, Motion.ARC_CCW],
        centre=[(np.nan,) * 3, (0.0, 0.0, 0.0)],
        feed=[0.0, 100.0],
        mark=[0, 0],
    )
    _, tip, _ = poses_of(moves_of((replace(leaning(((0, 0, 0), UP)), path=path),)))
    assert len(tip) > 40
    assert np.hypot(tip[:, 0], tip[:, 1]) == approx(10.0)
    assert tip[-1] == approx([0.0, 10.0, 4.0])


def test_the_axis_turns_evenly_in_the_plane_of_both_ends():
    start, end = np.array([lean(0.0)]), np.array([lean(60.0)])
    assert turned_axes(start, end, np.array([math.pi / 3]), np.array([0.25]))[0] == approx(
        lean(15.0)
    )


def test_turning_about_the_tip_takes_what_the_rotary_axis_needs():
    # 60 degrees at 150 degrees/s and 600 degrees/s2 about the A axis, on which the tip stands: 60/150 + 150/600 s.
    section = leaning(((0.0, 0.0, 50.0), lean(0.0)), ((0.0, 0.0, 50.0), lean(60.0, 90.0)))
    moves = moves_of((section,))
    times = times_of(moves, axis_positions(moves, TABLE, np.zeros(3)), TABLE)
    assert times.seconds.sum() == approx(0.65, abs=1e-6)


def test_a_long_cut_takes_its_length_over_the_feed_and_the_ramps():
    # 200 mm at 6000 mm/min = 100 mm/s with 3000 mm/s2: 2 s and one ramp's 1/30 s.
    moves = moves_of((leaning(((0.0, 0.0, 0.0), UP), ((200.0, 0.0, 0.0), UP), feed=6000.0),))
    times = times_of(moves, axis_positions(moves, MACHINE, np.zeros(3)), MACHINE)
    assert times.seconds.sum() == approx(2.0 + 1.0 / 30.0)
    assert times.speed.max() == approx(100.0)


def test_an_arc_is_no_faster_than_its_radius_allows():
    # Radius 1 mm at 3000 mm/s2: sqrt(3000) mm/s at most, though the feed asks for 200.
    path = Toolpath(
        position=[(1.0, 0.0, 0.0), (1.0, 0.0, 0.0)],
        axis=[UP, UP],
        motion=[Motion.RAPID, Motion.ARC_CCW],
        centre=[(np.nan,) * 3, (0.0, 0.0, 0.0)],
        feed=[0.0, 12000.0],
        mark=[0, 0],
    )
    moves = moves_of((replace(leaning(((0, 0, 0), UP)), path=path),))
    assert times_of(
        moves, axis_positions(moves, MACHINE, np.zeros(3)), MACHINE
    ).speed.max() == approx(math.sqrt(3000.0))


def test_three_axes_refuse_a_leaning_tool_in_words():
    (finding,) = said(leaning(((0, 0, 0), lean(12.0)), ((5, 0, 0), lean(12.0))), MACHINE)
    assert (finding.code, finding.severity) == ("verify.rotary", "error")
    assert "leans the tool axis by 12.0 degrees where test mill has no rotary axes" in finding.text


def test_a_lean_beyond_the_rotary_axis_is_an_error_and_one_within_it_is_not():
    short = replace(
        TABLE,
        axes=tuple(replace(a, low=-20.0, high=20.0) if a.name == "A" else a for a in TABLE.axes),
    )
    (finding,) = said(leaning(((0, 0, 0), lean(0.0)), ((5, 0, 0), lean(25.0, 90.0))), short)
    assert (
        finding.code == "verify.rotary"
        and "needs A" in finding.text
        and "has -20 to 20" in finding.text
    )
    assert not said(leaning(((0, 0, 0), lean(0.0)), ((5, 0, 0), lean(15.0, 90.0))), short)


def test_leaning_a_high_tip_takes_travel_that_the_same_path_upright_does_not():
    def path(axis):
        return leaning(((0, 0, 600), UP), ((5, 0, 600), axis))

    assert not said(path(UP), TABLE)
    # 550 above the pivot the tip swings 550 (1 - cos 110) = 738 mm in Z.
    (finding,) = said(path(lean(110.0, 90.0)), TABLE)
    assert finding.code == "verify.travel" and "needs 738 mm of Z" in finding.text


def test_each_pose_takes_the_nearer_of_both_ways_as_a_plain_search_does():
    rng = np.random.default_rng(5)
    angles, free = rng.uniform(-math.pi, math.pi, (60, 2, 2)), rng.random((60, 2, 2)) < 0.1
    low, high, chosen = np.array([-2.0, -20.0]), np.array([2.0, 20.0]), np.zeros((60, 2))
    turned_by, outside = choose_angles_greedy(angles, free, low, high, 1, 1e-9, chosen)
    before, turned_plain, outside_plain = np.zeros(2), 0.0, 0
    for k in range(60):
        tried = []
        for way in (0, 1) if k else (1,):
            turns = [
                [before[a]]
                if free[k, way, a]
                else angles[k, way, a] + 2 * math.pi * np.arange(-9, 10)
                for a in (0, 1)
            ]
            best = [
                min(
                    t,
                    key=lambda v, a=a: (
                        max(low[a] - v, v - high[a], 0.0) > 1e-9,
                        abs(v - before[a]),
                    ),
                )
                for a, t in enumerate(turns)
            ]
            out = sum(not low[a] - 1e-9 <= best[a] <= high[a] + 1e-9 for a in (0, 1))
            tried.append((out, sum(abs(b - p) for b, p in zip(best, before, strict=True)), best))
        out, cost, best = min(tried, key=lambda t: t[:2])
        assert out or chosen[k] == approx(best)
        before, turned_plain, outside_plain = (
            chosen[k].copy(),
            turned_plain + cost,
            outside_plain + (out > 0),
        )
    assert outside == outside_plain
    assert outside or turned_by == approx(turned_plain)


def test_block_times_are_those_of_a_plain_look_ahead_on_a_fine_way():
    rng = np.random.default_rng(2)
    length, speed = rng.uniform(0.5, 20.0, 12), rng.uniform(5.0, 200.0, 12)
    times, top, push = np.zeros(12), np.zeros(12), 1500.0
    block_times(length, speed, np.concatenate([[0.0], np.ones(11)]), push, times, top)
    edges, step = np.concatenate([[0.0], np.cumsum(length)]), 2e-4
    at = np.arange(0.0, edges[-1], step)
    square = speed[np.searchsorted(edges, at, side="right") - 1] ** 2
    square[[0, -1]] = 0.0
    for k in range(1, len(at)):
        square[k] = min(square[k], square[k - 1] + 2 * push * step)
    for k in range(len(at) - 2, -1, -1):
        square[k] = min(square[k], square[k + 1] + 2 * push * step)
    way = np.sqrt(square)
    assert times.sum() == approx((2 * step / (way[1:] + way[:-1])).sum(), rel=1e-3)
    assert top == approx([way[(at >= a) & (at < b)].max() for a, b in pairwise(edges)], rel=1e-2)
