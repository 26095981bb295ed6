"""LinuxCNC's own interpreter reads what we write, and moves as we mean."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import rs274
from five_axis import five_axis_case
from leaning_paths import ENDLESS_FORK, TABLE, joint_rows, lean, standing, text_of
from leaning_paths import path_of as leaning_path
from leaning_paths import program as leaning_program
from programs import (
    BULL_10,
    CCW,
    CW,
    FLAT_16,
    LINE,
    RAPID,
    S1,
    TURNING,
    WALL,
    path_of,
    program_1,
    section,
    turned_path,
)
from random_programs import cycle
from trunnion.model.motion.cycle import CycleKind
from trunnion.model.motion.drilling import drilled
from trunnion.model.motion.program import Program
from trunnion.model.motion.toolpath import Toolpath
from trunnion.model.spindle import FeedMode
from trunnion.post.dialects.linuxcnc import LinuxCncDialect
from trunnion.post.header import Header
from trunnion.post.settings import PostSettings
from trunnion.toolpath.motion.reorient import ClearanceSphere, moved_over

HEADER = Header(name="B1", part="B1", part_digest="ab12", plan_digest="cd34")
TOOLS = (FLAT_16, BULL_10)
pytestmark = rs274.needs_rs274


def run(text: str, folder: Path) -> list[rs274.Call]:
    return rs274.run(text, TOOLS, folder)


def compare(program: Program, folder: Path, **settings) -> int:
    text = LinuxCncDialect().write([program], HEADER, PostSettings(**settings))
    return rs274.compare(
        text, TOOLS, S1, folder, scale=25.4 if settings.get("units") == "inch" else 1.0
    )


def test_rs274_moves_as_we_mean(tmp_path):
    assert compare(program_1(), tmp_path) == 18


def test_rs274_moves_as_we_mean_in_inches(tmp_path):
    assert compare(program_1(), tmp_path, units="inch") == 18


def test_rs274_takes_each_tool_with_its_length(tmp_path):
    calls = run(LinuxCncDialect().write([program_1()], HEADER, PostSettings()), tmp_path)
    changes = [int(numbers[0]) for _, name, numbers in calls if name == "SELECT_TOOL"]
    lengths = [
        numbers[2]
        for _, name, numbers in calls
        if name == "USE_TOOL_LENGTH_OFFSET" and any(numbers)
    ]
    assert changes == [1, 7]
    assert lengths == [140.5, 140.5, 120.25]


def test_rs274_turns_the_spindle_as_we_mean(tmp_path):
    calls = run(LinuxCncDialect().write([program_1()], HEADER, PostSettings()), tmp_path)
    assert [numbers[-1] for _, name, numbers in calls if name == "SET_SPINDLE_SPEED"] == [
        12000.0,
        14000.0,
        18000.0,
    ]
    assert sum(name == "START_SPINDLE_CLOCKWISE" for _, name, _ in calls) == 3


def test_rs274_feeds_as_we_mean(tmp_path):
    calls = run(LinuxCncDialect().write([program_1()], HEADER, PostSettings()), tmp_path)
    feeds = [
        numbers[-1] for _, name, numbers in calls if name == "SET_FEED_RATE" and numbers[-1] > 0.0
    ]
    assert feeds == [300.0, 600.0, 1200.0, 900.5, 800.0, 800.0]


@pytest.mark.parametrize("machine", [TABLE, ENDLESS_FORK], ids=["table", "fork"])
def test_rs274_moves_five_axes_as_we_mean(machine, tmp_path):
    place, case = standing(machine, foot=(100.0, 100.0, -30.0)), five_axis_case(60, 500)
    tilt = lean(35.0, 50.0)
    path = leaning_path(
        ((20.0, 10.0, 60.0), tilt), ((20.0, 10.0, 5.0), tilt), ((60.0, -20.0, 5.0), tilt)
    )
    made = leaning_program(
        case.section.path,
        moved_over(
            path,
            (case.section.path.position[-1], case.section.path.axis[-1]),
            ClearanceSphere(centre=place.centre, radius=250.0),
        ),
        tool=case.section.tool,
    )
    text, tools = text_of(made, place), (case.section.tool,)
    assert text.count("G93") > 0 and text.count("G94") > 2
    assert (
        rs274.compare_joints(text, joint_rows(text, place, tools), place.names, tools, tmp_path)
        > 1000
    )


def test_rs274_takes_inverse_time_as_we_mean(tmp_path):
    # It tells mm a minute along X, Y and Z: over the way of the axes that is the time that we have said.
    place = standing(TABLE)
    text = text_of(
        leaning_program(
            leaning_path(((0.0, 0.0, 10.0), lean(5.0)), ((40.0, 0.0, 10.0), lean(25.0)), feed=600.0)
        ),
        place,
    )
    (rows,) = joint_rows(text, place)
    calls, minutes, at = rs274.run(text, TOOLS, tmp_path), [], None
    for _, name, numbers in calls:
        if name == "SET_FEED_RATE":
            feed = numbers[-1]
        elif name in ("STRAIGHT_TRAVERSE", "STRAIGHT_FEED"):
            if name == "STRAIGHT_FEED":
                minutes.append(math.dist(at, numbers[:3]) / feed)
            at = numbers[:3]
    assert minutes == pytest.approx([m for m in rows.minutes if m > 0.0], rel=2e-3)


@pytest.mark.parametrize("lift", [0.0, 18.0, 48.0])
@pytest.mark.parametrize("kind", CycleKind)
def test_rs274_drills_as_we_mean(kind, lift, tmp_path):
    tops = np.array([[10.0, 5.0, 2.0], [30.0, 5.0, 2.0], [30.0, 25.0, -4.5]])
    path = drilled(np.array([0.0, 0.0, 50.0]), tops, cycle(kind, lift=lift), 500.0)
    x, y, _ = path.position[-1]
    whole = Toolpath.join([path, path_of((RAPID, x, y, 50.0))])
    program = Program(name="B1.S1", setup=S1, sections=(section("a", FLAT_16, whole, 400.0),))
    assert compare(program, tmp_path) >= 13


def test_rs274_drills_random_holes_one_after_the_other(tmp_path):
    rng, at, parts = np.random.default_rng(5), np.array([0.0, 0.0, 50.0]), []
    for _ in range(300):
        top = np.round(rng.uniform(-40, 40, 3), 4)
        # It ends at its retract plane, where it began, where the one before began, or elsewhere.
        ends = [top[2], at[2], parts[-1].position[0, 2] if parts else 0.0, 50.0]
        lift = max(float(np.round(ends[rng.integers(4)] - top[2], 4)), 0.0)
        kind = list(CycleKind)[rng.integers(7)] if rng.random() < 0.3 else CycleKind.DRILL
        parts.append(drilled(at, top[None], cycle(kind, float(rng.integers(1, 30)), lift), 500.0))
        at = parts[-1].position[-1]
    whole = Toolpath.join([*parts, path_of((RAPID, *at[:2], 50.0))])
    program = Program(name="B1.S1", setup=S1, sections=(section("a", FLAT_16, whole, 400.0),))
    text = LinuxCncDialect().write([program], HEADER, PostSettings())
    assert text.count("G98") > 20 and text.count("G80") > 50
    assert compare(program, tmp_path) > 900


@pytest.mark.parametrize(
    "body",
    [
        "G99 G81 X10 Y0 Z-5 R2 F100;G98 X20;X30;G99 X40;X50",
        "G99 G81 X10 Y0 Z-5 R2 F100;G98 X20 R5;X30 R-1",
        "G99 G81 X10 Y0 Z-5 R2 F100;X20 R5;X30 R1",
        "G0 Z-4;G98 G81 X10 Y0 Z-5 R2 F100;X20;X30 R5;X40 R0",
        "G0 Z-4;G99 G73 X10 Y0 Z-5 R2 Q1 F100;X20;G98 Y30",
        "G99 G81 X10 Y0 Z-5 R2 F100;G98 G82 X20 Z-5 R2 P0.1;G85 X30 Z-5 R2",
        "G98 G81 X10 Y0 Z-5 R2 F100;X20 R30;X30 R2;Z-9",
        "G99 G83 X10 Y0 Z-5 R2 Q2 F100;G80;G98 G84 X20 Y0 Z-5 R2",
    ],
)
def test_rs274_drills_hand_written_holes_as_we_read_them(body, tmp_path):
    lines = ["G21 G90 G54 G64 P0.005", "T1 M6", "S400 M3", "G0 G43 H1 X0 Y0 Z50", "G0 Z20"]
    lines += [*body.split(";"), "G0 Z50", "M30"]
    text = "\n".join(f"N{10 * k} {line}" for k, line in enumerate(lines, 1)) + "\n"
    assert rs274.compare(text, TOOLS, S1, tmp_path) > 7


def test_rs274_turns_as_we_mean(tmp_path):
    path = turned_path(
        *((b, x, z) for b, x, z in [(RAPID, 60, 50), (RAPID, 60, 5)]),
        (LINE, 60.0, -1.0, 191.0),
        (LINE, 10.0, -1.0, 500.0),
        (CW, 5.0, -6.0, 10.0, -6.0, 700.0),
        (CCW, 0.0, -11.0, 0.0, -6.0, 700.0),
        (RAPID, 0.0, 50.0),
    )
    made = replace(
        section("face", TURNING, path, 2500.0), surface_speed=180.0, feed_mode=FeedMode.REVOLUTION
    )
    program = Program(
        name="B1.S1", setup=S1, sections=(made, section("wall", FLAT_16, WALL, 8000.0))
    )
    text = LinuxCncDialect().write([program], HEADER, PostSettings())
    calls = rs274.run(text, (TURNING, FLAT_16), tmp_path)
    ends = [n for _, name, n in calls if name in ("STRAIGHT_TRAVERSE", "STRAIGHT_FEED")]
    assert [60.0, 0.0, 5.0] in [n[:3] for n in ends] and [10.0, 0.0, -1.0] in [n[:3] for n in ends]
    # In the plane ZX an arc is told by z and x of its end and its centre, its sense, and y.
    arcs = [n[:6] for _, name, n in calls if name == "ARC_FEED"]
    assert np.allclose(arcs, [[-6, 5, -6, 10, -1, 0], [-11, 0, -6, 0, 1, 0]])
    assert ("SET_SPINDLE_MODE", [0.0, 2500.0]) in [(name, n) for _, name, n in calls]
    # The wall after it is milled where it was meant.
    assert [33.3333, 0.0, -8.0] in [n[:3] for n in ends]


def test_rs274_feeds_by_the_revolution_as_we_mean(tmp_path):
    made = section("wall", FLAT_16, WALL, 8000.0)
    by_turns = replace(made, feed_mode=FeedMode.REVOLUTION)
    text = LinuxCncDialect().write(
        [Program(name="B1.S1", setup=S1, sections=(by_turns,))], HEADER, PostSettings()
    )
    calls = run(text, tmp_path)
    feeds = [n[-1] for _, name, n in calls if name == "SET_FEED_RATE" and n[-1] > 0.0]
    assert feeds == [0.1]
    assert any(name == "SET_FEED_MODE" and n[-1] == 1 for _, name, n in calls)


def test_rs274_takes_random_arcs_lines_and_helices(tmp_path):
    rng, at, blocks = (
        np.random.default_rng(11),
        np.array([0.0, 0.0, 0.0]),
        [(RAPID, 0, 0, 50), (LINE, 0, 0, 0, 500)],
    )
    for _ in range(3000):
        kind = rng.integers(0, 4)
        if kind < 2:
            at = at + rng.normal(size=3) * 10.0 ** rng.uniform(-4, 2)
            blocks.append(
                ((RAPID, LINE)[kind], *at) + (() if kind == 0 else (rng.uniform(1, 9000),))
            )
            continue
        radius, first, turn = (
            10.0 ** rng.uniform(-1, 3),
            rng.uniform(0, 2 * np.pi),
            rng.choice([1e-7, 1e-3, 1.0, 3.0, 6.0, 2 * np.pi]),
        )
        sign = 1.0 if kind == 3 else -1.0
        centre = at[:2] - radius * np.array([math.cos(first), math.sin(first)])
        end = centre + radius * np.array(
            [math.cos(first + sign * turn), math.sin(first + sign * turn)]
        )
        at = np.array([*(at[:2] if turn == 2 * np.pi else end), at[2] + rng.choice([0.0, -1.0])])
        blocks.append((CCW if kind == 3 else CW, *at, *centre, rng.uniform(1, 9000)))
    program = Program(
        name="B1.S1",
        setup=S1,
        sections=(section("random", FLAT_16, path_of(*blocks, (RAPID, *at[:2], 50.0))),),
    )
    assert compare(program, tmp_path) > 2800
