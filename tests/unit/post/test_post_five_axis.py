"""Programs for machines with rotary axes: the words bring the tool where it was meant, and what is read is what the machine does."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from pytest import approx
from scipy.spatial import cKDTree

from five_axis import five_axis_case
from leaning_paths import (
    ENDLESS_FORK,
    FORK,
    HEADER,
    MACHINES,
    SHOP,
    TABLE,
    UP,
    again,
    joint_rows,
    lean,
    path_of,
    program,
    standing,
    text_of,
)
from programs import BULL_10, FLAT_16, S1, program_1
from trunnion.findings import BadInput, Refused
from trunnion.geometry.kernels.shortest_paths import rotary_angles, rotary_angles_compiled
from trunnion.model.motion.listing import listing
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.model.spindle import FeedMode
from trunnion.post.dialects.apt import AptDialect
from trunnion.post.dialects.linuxcnc import LinuxCncDialect
from trunnion.post.linearize import PathTolerance, even_turn, joint_path
from trunnion.post.readers.linuxcnc import read_linuxcnc
from trunnion.post.settings import PostSettings
from trunnion.shop.kinematics import SLACK, poses_of, rotary_solutions, words_of
from trunnion.shop.rotary_angles import followed
from trunnion.verify.machine.kinematics import linear_positions

BOTH = pytest.mark.parametrize("machine", [TABLE, ENDLESS_FORK], ids=["table", "fork"])
ALL = pytest.mark.parametrize("machine", MACHINES, ids=lambda m: m.name)


def axes(n: int, seed: int = 1) -> np.ndarray:
    made = np.random.default_rng(seed).normal(size=(n, 3)) + [0.0, 0.0, 1.5]
    return made / np.linalg.norm(made, axis=1, keepdims=True)


@ALL
def test_both_ways_to_stand_bring_the_tool_where_the_words_mean(machine):
    place, axis = standing(machine), np.vstack([UP, axes(300)])
    tip = np.random.default_rng(2).normal(size=(301, 3)) * 50.0
    angle, _, held = rotary_solutions(machine, axis)
    assert held.all() or machine.name == "nutating table"
    for way in range(2):
        words = words_of(place, tip, angle[:, way], 140.0)
        tips, found = poses_of(place, words, angle[:, way], 140.0)
        assert tips == approx(tip, abs=1e-9)
        assert found[held] == approx(axis[held], abs=1e-8)


@ALL
def test_the_words_differ_from_the_proofs_own_positions_by_the_work_offset_and_the_length_alone(
    machine,
):
    place, tip = standing(machine), np.random.default_rng(3).normal(size=(200, 3)) * 50.0
    angle = rotary_solutions(machine, axes(200))[0][:, 0]
    own = linear_positions(tip - place.foot, np.full(200, 140.0), angle, machine)
    assert own - words_of(place, tip, angle, 140.0) == approx(
        np.tile([0.0, 0.0, 140.0] - place.foot, (200, 1)), abs=1e-9
    )


def test_a_table_that_leans_swings_the_tip_about_its_axis():
    # The A axis lies 50 above the table, the tip 100 above it: at A-90 (about -x) it comes 50 towards -y and down to the axis.
    place = standing(TABLE, foot=(0.0, 0.0, 0.0))
    angle = np.radians([[0.0, 0.0], [-90.0, 0.0]])
    words = words_of(place, np.array([[0.0, 0.0, 100.0]] * 2), angle, 140.0)
    assert words == approx(np.array([[0.0, 0.0, 100.0], [0.0, -50.0, 50.0]]), abs=1e-9)


def test_a_fork_that_leans_takes_its_arm_along():
    # 220 from pivot to spindle and 140 of tool: at A30 the spindle is 360 sin 30 beside, 360 (1 - cos 30) lower.
    words = words_of(standing(FORK), np.zeros((1, 3)), np.radians([[0.0, 30.0]]), 140.0)
    assert words[0] == approx([0.0, -180.0, -360.0 * (1.0 - math.sqrt(0.75))], abs=1e-9)


def test_the_compiled_winding_is_the_plain_one():
    rng = np.random.default_rng(5)
    for n in range(40):
        angle = (
            rng.uniform(-math.pi, math.pi, (30, 2, 2))
            if n % 2
            else np.cumsum(rng.normal(0.0, 0.4, (30, 2, 2)), axis=0)
        )
        free, through = rng.uniform(size=(30, 2, 2)) < 0.1, rng.uniform(size=30) < 0.3
        low, high, start = np.array([-2.0, -7.0]), np.array([3.0, 7.0]), rng.uniform(-1.0, 1.0, 2)
        plain, fast = np.zeros((30, 2)), np.zeros((30, 2))
        said = rotary_angles.choose_angles(angle, free, through, low, high, SLACK, start, plain)
        assert rotary_angles_compiled.choose_angles(
            angle, free, through, low, high, SLACK, start, fast
        ) == approx(said)
        assert fast == approx(plain)


def test_the_winding_keeps_its_way_where_the_other_would_end_at_a_limit():
    # Over the pole to the other side: A may go to 30 only, so C turns half round there and A goes on below 0.
    path = path_of(
        *[((0.0, 0.0, 10.0), lean(abs(t), 90.0 if t < 0 else -90.0)) for t in range(-60, 61, 5)]
    )
    joints = joint_path(
        path, FLAT_16, standing(TABLE), None, PathTolerance(feed=0.002, rapid=0.5), "op"
    )
    angle = np.degrees(joints.angle)
    assert angle[:, 0].min() == approx(-60.0)
    assert angle[:, 0].max() <= 1e-6
    assert np.ptp(angle[:, 1]) == approx(180.0)


def test_an_axis_that_may_turn_for_ever_winds_up_and_one_that_may_not_is_refused():
    turns = path_of(*[((20.0, 0.0, 5.0), lean(25.0, 10.0 * k)) for k in range(109)])
    endless = joint_path(
        turns, FLAT_16, standing(TABLE), None, PathTolerance(feed=0.01, rapid=0.5), "op"
    )
    assert math.degrees(np.ptp(endless.angle[:, 1])) == approx(1080.0)
    with pytest.raises(
        Refused,
        match=r"operation op, block \d+: its tool axis needs .* has C -360 to 360, A -110 to 110",
    ):
        joint_path(turns, FLAT_16, standing(FORK), None, PathTolerance(feed=0.01, rapid=0.5), "op")


@pytest.mark.parametrize("name", ["Trunnion 650", "Cradle 800", "Trunnion 500 B", "Universal 1250"])
def test_a_table_winds_up_by_more_turns_than_a_finishing_pass_goes_round(name):
    turns = np.array([lean(25.0, 40.0 * k) for k in range(9 * 400 + 1)])
    wound = followed(turns, standing(SHOP.machine(name)), None, 1e-4, "op")
    assert math.degrees(np.ptp(wound[:, 1])) == approx(400 * 360.0)


def test_a_text_keeps_its_place_after_hundreds_of_turns():
    path = path_of(*[((20.0, 0.01 * k, 5.0), lean(25.0, 40.0 * k)) for k in range(9 * 200 + 1)])
    text = text_of(program(path), standing(TABLE))
    read = again(text, standing(TABLE)).sections[0].path
    away = np.linalg.norm(read.position - path.position[-1], axis=1)
    assert away.min() < 1e-3
    assert np.abs(read.axis[away.argmin()] - path.axis[-1]).max() < 2e-7


def test_a_way_begins_where_its_turns_fit_between_the_limits():
    # 600 degrees of C fit only from one end of a fork's 720.
    turns = path_of(*[((20.0, 0.0, 5.0), lean(25.0, 10.0 * k)) for k in range(61)])
    joints = joint_path(
        turns, FLAT_16, standing(FORK), None, PathTolerance(feed=0.01, rapid=0.5), "op"
    )
    assert math.degrees(np.ptp(joints.angle[:, 0])) == approx(600.0)
    assert np.degrees(np.abs(joints.angle[:, 0])).max() <= 360.0


def test_an_axis_that_the_machine_can_not_hold_is_refused_in_words():
    below = path_of(((0.0, 0.0, 50.0), lean(125.0)), ((0.0, 0.0, 0.0), lean(125.0)))
    with pytest.raises(
        Refused,
        match=r"operation op-1, block 1: its tool axis needs A-125.0 C-90.0 or A125.0 C90.0, .* A -120 to 30",
    ):
        text_of(program(below), standing(TABLE))


@ALL
def test_between_two_blocks_the_tool_stays_within_the_tolerance_of_its_way(machine):
    place = standing(machine)
    path = path_of(
        ((30.0, 10.0, 40.0), lean(10.0, 20.0)),
        ((30.0, 10.0, 2.0), lean(10.0, 20.0)),
        ((50.0, 20.0, 0.0), lean(35.0, 130.0)),
        ((20.0, -30.0, 5.0), lean(3.0, -120.0)),
        ((25.0, -25.0, 5.0), lean(3.0, 100.0)),
    )
    straying = PathTolerance(feed=0.002, rapid=0.5)
    joints = joint_path(path, FLAT_16, place, None, straying, "op")
    tip, axis = swept(place, joints.words, joints.angle, FLAT_16.gauge_length)
    assert farthest_from(path, tip, axis, 0.0) <= straying.feed
    assert farthest_from(path, tip, axis, FLAT_16.flute_length) <= 2.0 * straying.feed


def swept(place, words, angle, gauge, parts=4):
    """Return the tips and axes that a machine goes through when all its axes go evenly from block to block."""
    share = np.linspace(0.0, 1.0, parts, endpoint=False)[None, :, None]
    words = (words[:-1, None] + share * np.diff(words, axis=0)[:, None]).reshape(-1, 3)
    angle = (angle[:-1, None] + share * np.diff(angle, axis=0)[:, None]).reshape(-1, angle.shape[1])
    return poses_of(place, words, angle, gauge)


def farthest_from(path, tip, axis, reach):
    """Return how far points on a moving tool, `reach` above its tip, leave their planned way, each block of which is sampled finely."""
    points, off = tip + reach * axis, np.full(len(tip), np.inf)
    for k in range(1, len(path)):
        off = np.minimum(off, off_line(points, way_of(path, np.array([k]), 401, reach)))
    return float(off.max())


def way_of(path, blocks, parts, reach):
    """Return places `reach` above the tip along blocks, the axis turning evenly."""
    share = np.tile(np.linspace(0.0, 1.0, parts), len(blocks))
    row = np.repeat(blocks, parts)
    axis = even_turn(path.axis[row - 1], path.axis[row], share)
    return (
        path.position[row - 1]
        + share[:, None] * (path.position[row] - path.position[row - 1])
        + reach * axis
    )


def off_line(points, line):
    """Return how far points are from a line of points that nowhere turns sharply back."""
    line = line[np.concatenate([[True], np.linalg.norm(np.diff(line, axis=0), axis=1) > 1e-9])]
    near = np.clip(cKDTree(line).query(points)[1], 1, len(line) - 2)
    return np.minimum(
        off_segment(points, line[near - 1], line[near]),
        off_segment(points, line[near], line[near + 1]),
    )


def off_segment(points, a, b):
    """Return how far points (k, 3) are from segments (k, 3) each."""
    run = b - a
    share = np.clip(
        ((points - a) * run).sum(axis=1) / np.maximum((run * run).sum(axis=1), 1e-30), 0.0, 1.0
    )
    return np.linalg.norm(points - a - share[:, None] * run, axis=1)


@BOTH
def test_what_is_read_back_is_what_the_machine_does_between_the_blocks(machine):
    place, case = standing(machine, foot=(100.0, 100.0, -30.0)), five_axis_case(20, 500)
    made = program(case.section.path, tool=case.section.tool)
    text = text_of(made, place)
    (rows,), (section,) = (
        joint_rows(text, place, (case.section.tool,)),
        again(text, place, (case.section.tool,)).sections,
    )
    points = np.array(rows.point)[3:-2]
    tip, axis = swept(
        place, points[:, :3], np.radians(points[:, 3:]), case.section.tool.gauge_length
    )
    for reach in (0.0, case.section.tool.flute_length):
        way = way_of(section.path, np.arange(3, len(section.path) - 2), 3, reach)
        assert off_line(tip + reach * axis, way).max() <= 0.0011
    assert set(section.block_lines) == set(rows.line)
    assert list(section.block_lines) == sorted(section.block_lines)


@BOTH
def test_every_planned_pose_is_passed_and_the_feed_is_kept(machine):
    place, case = standing(machine, foot=(100.0, 100.0, -30.0)), five_axis_case(200, 500)
    slowly = np.where(case.section.path.feed > 0.0, 200.0, 0.0)
    made = program(replace(case.section.path, feed=slowly), tool=case.section.tool)
    path = again(text_of(made, place), place, (case.section.tool,)).sections[0].path
    for tip, axis in zip(made.sections[0].path.position, made.sections[0].path.axis, strict=True):
        k = int(np.linalg.norm(path.position - tip, axis=1).argmin())
        assert path.position[k] == approx(tip, abs=2e-4)
        assert path.axis[k] == approx(axis, abs=3e-7)
    cutting, fed = path.motion != Motion.RAPID, path.lengths()
    spent = float((fed[cutting] / path.feed[cutting]).sum())
    assert path.feed.max() <= 200.0
    assert spent == approx(float(made.sections[0].path.lengths()[1:-1].sum()) / 200.0, rel=0.02)


def test_an_upright_program_on_a_machine_with_rotary_axes_says_that_they_stand_at_0():
    place = standing(TABLE)
    text = text_of(program_1(), place)
    plain = LinuxCncDialect().write([program_1()], HEADER, PostSettings())
    assert "G0 A0 C0" in text
    assert listing(again(text, place, (FLAT_16, BULL_10)), marks=False) == listing(
        program_1(), marks=False
    )
    moves = [
        [w for w in line.split()[1:] if w not in ("A0", "C0")]
        for line in text.splitlines()
        if line.startswith("N")
    ]
    assert [m for m in moves if m != ["G0"]] == [
        line.split()[1:] for line in plain.splitlines() if line.startswith("N")
    ]


def test_where_no_rotary_axis_turns_the_feed_is_in_mm_a_minute_and_arcs_stay_arcs():
    tilt = lean(30.0, 40.0)
    across = np.cross(tilt, [0.0, 0.0, 1.0])
    across /= np.linalg.norm(across)
    ahead, centre = np.cross(tilt, across), np.array([10.0, 5.0, 0.0])
    around = [centre + 8.0 * (math.cos(a) * across + math.sin(a) * ahead) for a in (0.0, 0.7, 2.5)]
    path = Toolpath(
        position=[around[0] + 30.0 * tilt, around[0], around[1], around[2]],
        axis=[tilt] * 4,
        motion=[Motion.RAPID, Motion.LINE, Motion.ARC_CCW, Motion.ARC_CCW],
        feed=[0.0, 500.0, 800.0, 800.0],
        mark=[0] * 4,
        centre=[[np.nan] * 3, [np.nan] * 3, centre, centre],
    )
    text = text_of(program(path), standing(TABLE))
    assert text.count(" G3 ") == 1
    assert "G93" not in text
    read = again(text, standing(TABLE)).sections[0].path
    assert read.motion.tolist()[-4:-1] == [Motion.LINE, Motion.ARC_CCW, Motion.ARC_CCW]
    assert read.position[-4:-1] == approx(path.position[-3:], abs=2e-4)
    assert read.centre[-2] == approx(centre, abs=3e-4)
    assert read.feed[-4:-1].tolist() == [500.0, 800.0, 800.0]


def test_a_fork_that_leans_cuts_an_arc_in_lines():
    tilt = lean(30.0)
    start, end = np.array([0.0, 5.0, 0.0]), np.array([0.0, -5.0, 0.0])
    path = Toolpath(
        position=[start + 20.0 * tilt, start, end],
        axis=[tilt] * 3,
        motion=[Motion.RAPID, Motion.LINE, Motion.ARC_CW],
        centre=[[np.nan] * 3, [np.nan] * 3, [0.0, 0.0, 0.0]],
        feed=[0.0, 500.0, 500.0],
        mark=[0] * 3,
    )
    text = text_of(program(path), standing(FORK))
    read = again(text, standing(FORK)).sections[0].path
    assert " G2" not in text.split("OPERATION")[1]
    around = read.position[2:-1]
    assert np.linalg.norm(around, axis=1) == approx(5.0, abs=3e-4)
    middle = 0.5 * (around[:-1] + around[1:])
    assert np.linalg.norm(middle, axis=1).min() >= 5.0 - 0.0022


def test_a_block_that_turns_takes_the_time_that_its_tip_needs_at_its_feed():
    # 10 mm at 600 mm/min: a second, a sixtieth of a minute, over all pieces that the block is written in.
    path = path_of(((0.0, 0.0, 10.0), lean(5.0)), ((10.0, 0.0, 10.0), lean(25.0)), feed=600.0)
    (rows,) = joint_rows(text_of(program(path), standing(TABLE)), standing(TABLE))
    assert sum(rows.minutes) == approx(1.0 / 60.0, rel=1e-4)


def test_a_block_is_never_faster_than_its_axes():
    # The tip moves 0.1 mm while C turns by 90 degrees: 18000 degrees a minute are its most.
    path = path_of(
        ((0.0, 0.0, 10.0), lean(20.0, 0.0)), ((0.1, 0.0, 10.0), lean(20.0, 90.0)), feed=5000.0
    )
    (rows,) = joint_rows(text_of(program(path), standing(TABLE)), standing(TABLE))
    assert sum(rows.minutes) >= 90.0 / 18000.0 - 1e-9


@pytest.mark.parametrize("mode", FeedMode)
def test_the_tip_has_its_feed_whatever_feeds_are_given_by(mode):
    place = standing(TABLE)
    path = path_of(
        ((0.0, 0.0, 10.0), lean(5.0)),
        ((20.0, 0.0, 10.0), lean(5.0)),
        ((40.0, 0.0, 10.0), lean(25.0)),
        ((40.0, 30.0, 10.0), lean(25.0)),
        feed=600.0,
    )
    made = program(replace(path, dwell=np.array([0.0, 0.0, 0.5, 0.0])))
    given_so = replace(made, sections=(replace(made.sections[0], feed_mode=mode),))
    (again,) = read_linuxcnc(text_of(given_so, place), (FLAT_16,), S1, place).sections
    fed = again.path.motion != Motion.RAPID
    assert again.path.feed[fed] == pytest.approx(600.0, rel=1e-2)
    waits = np.flatnonzero(again.path.dwells())
    assert again.path.dwells()[waits].tolist() == [0.5]
    assert again.path.position[waits[0]] == pytest.approx([40.0, 0.0, 10.0], abs=1e-3)


def test_a_block_in_inverse_time_that_turns_nothing_has_its_feed_too():
    # 30 mm in a twentieth of a minute.
    place = standing(TABLE)
    text = text_of(program(path_of(((0, 0, 10), lean(0.0)), ((30, 0, 10), lean(0.0)))), place)
    assert "G1 X30 F1200" in text
    (again,) = read_linuxcnc(
        text.replace("G1 X30 F1200", "G93 G1 X30 F20"), (FLAT_16,), S1, place
    ).sections
    assert again.path.feed[-2] == pytest.approx(600.0)


def test_an_operation_that_begins_in_another_direction_is_refused_unless_it_was_led_there():
    first, second = (
        path_of(((0.0, 0.0, 40.0), lean(a)), ((0.0, 0.0, 0.0), lean(a))) for a in (10.0, 50.0)
    )
    with pytest.raises(Refused, match="op-2 begins with the tool in another direction"):
        text_of(program(first, second), standing(TABLE))


def test_axes_that_must_unwind_between_two_operations_do_so_at_the_top_of_the_machine():
    once = path_of(*[((20.0, 0.0, 5.0), lean(25.0, 90.0 + 10.0 * k)) for k in range(73)])
    text = text_of(program(once, once), standing(FORK))
    lines = text.split("OPERATION op-2")[1].splitlines()
    first = next(n for n, line in enumerate(lines) if "G53 G0 Z0" in line)
    assert [w[0] for w in lines[first + 1].split()[1:]] == ["G", "C", "A"]
    assert [w[0] for w in lines[first + 2].split()[1:]] == ["G", "X", "Y"]
    assert len(again(text, standing(FORK)).sections) == 2


def test_an_axis_wound_up_to_its_limit_begins_again_near_home():
    turns = np.array([lean(25.0, 10.0 * k) for k in range(181)])
    short = replace(
        TABLE, axes=(*TABLE.axes[:4], replace(TABLE.axes[4], low=-36000.0, high=36000.0))
    )
    wound = followed(turns, standing(short), np.radians([-25.0, 35990.0]), 1e-4, "op")
    assert np.abs(np.degrees(wound[0, 1])) < 1500.0
    assert math.degrees(np.ptp(wound[:, 1])) == approx(1800.0)


def test_a_text_is_not_read_for_work_that_stands_elsewhere():
    text = text_of(
        program(path_of(((0.0, 0.0, 40.0), lean(10.0)), ((0.0, 0.0, 0.0), lean(10.0)))),
        standing(TABLE),
    )
    with pytest.raises(
        BadInput, match=r"line \d+: the text was made for work that stands elsewhere"
    ):
        again(text, standing(TABLE, foot=(10.0, 5.0, -41.0)))


START = "G21 G90 G17 G94 G64 P0.005\nG54\nT1 M6\nS9000 M3\n"


@pytest.mark.parametrize(
    ("body", "message"),
    [
        ("G0 X0 Y0\nG43 H1 Z50\n", "line 6: it is not known where A and C stand"),
        ("G0 X0 Y0\nG43 H1 Z50 A0 C0\n", "line 6: turn A and C at the top of the machine"),
        ("G0 A0 C0\nG0 X0 Y0\nG43 H1 Z50\nG93 G1 X5\n", "line 8: a feed move without a feed"),
        (
            "G0 A0 C0\nG0 X0 Y0\nG43 H1 Z50\nG93 G1 X5 F100\nX6\n",
            r"line 9: a feed move in inverse time \(G93\) needs an F word",
        ),
        (
            "G0 A0 C0\nG0 X0 Y0\nG43 H1 Z50\nG1 X5 B3 F100\n",
            "line 8: the word B is not understood by a program for the axes XYZAC",
        ),
        (
            "G0 A0 C0\nG0 X0 Y0\nG43 H1 Z50\nG2 X5 Y0 I2.5 J0 C10 F100\n",
            "line 8: an arc in which a rotary axis turns",
        ),
        ("G0 A0 C0\nG0 X0 Y0\nG43 H1 Z50\nG53 G0 Z0 A0\n", "line 8: of G53 only G53 G0 Z0"),
    ],
)
def test_what_is_not_clear_is_refused_with_its_line(body, message):
    with pytest.raises(BadInput, match=message):
        again(START + body + "M30\n", standing(TABLE))


def test_a_feed_in_degrees_is_that_of_the_axis_that_turns():
    body = "G0 A0 C0\nG0 X10 Y5\nG43 H1 Z50\nG1 C90 F1800\nM30\n"
    (rows,) = joint_rows(START + body, standing(TABLE))
    assert rows.minutes[-1] == approx(90.0 / 1800.0)


def test_a_turn_of_the_table_is_read_as_the_arc_that_the_tip_draws_on_the_work():
    # The middle of the table is at (10, 5): a tip 20 beside it goes round a quarter of a circle of 20 mm.
    body = "G0 A0 C0\nG0 X30 Y5\nG43 H1 Z50\nG1 C90 F1800\nM30\n"
    path = again(START + body, standing(TABLE)).sections[0].path
    assert np.linalg.norm(path.position[:, :2] - [10.0, 5.0], axis=1) == approx(20.0, abs=1e-9)
    assert path.lengths().sum() == approx(10.0 * math.pi, rel=1e-4)


def test_a_leaning_tool_comes_from_its_change_along_its_axis_from_clear_of_the_work():
    path = path_of(((10.0, 5.0, 30.0), lean(40.0)), ((10.0, 5.0, 0.0), lean(40.0)))
    place = standing(TABLE)
    read = again(text_of(program(path), place), place).sections[0].path
    assert (read.position[0] - place.centre) @ lean(40.0) == approx(place.radius, abs=1e-3)
    assert read.position[1] == approx([10.0, 5.0, 30.0], abs=2e-4)
    assert read.axis == approx(np.tile(lean(40.0), (len(read), 1)), abs=2e-7)


def test_apt_says_tips_and_axes_and_reads_them_back():
    case = five_axis_case(100, 500)
    made = program(case.section.path, tool=case.section.tool)
    text = AptDialect().write([made], HEADER, PostSettings())
    (read,) = AptDialect().read(text, (case.section.tool,), [S1])
    assert "MULTAX/ON" in text
    assert read.sections[0].path.position == approx(made.sections[0].path.position, abs=1e-4)
    assert read.sections[0].path.axis == approx(made.sections[0].path.axis, abs=1e-8)
    assert read.sections[0].path.feed == approx(made.sections[0].path.feed)


def test_without_the_machine_a_leaning_tool_is_refused():
    path = path_of(((0.0, 0.0, 40.0), lean(10.0)), ((0.0, 0.0, 0.0), lean(10.0)))
    with pytest.raises(Refused, match="a tilted tool axis"):
        LinuxCncDialect().write([program(path)], HEADER, PostSettings())


def test_the_same_program_gives_the_same_bytes():
    place, case = standing(TABLE), five_axis_case(60, 500)
    made = program(case.section.path, tool=case.section.tool)
    assert text_of(made, place) == text_of(made, place)
    assert text_of(replace(made, name="B1.S1"), place, units="inch") != text_of(made, place)
