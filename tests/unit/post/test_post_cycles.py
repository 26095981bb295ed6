"""Drilling cycles in LinuxCNC's words: what is written, what is read, what is refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from pytest import approx

from leaning_paths import TABLE, standing
from programs import FLAT_16, RAPID, S1, path_of, section
from random_programs import cycle
from trunnion.findings import BadInput
from trunnion.model.motion.cycle import BACK_OFF, CycleKind
from trunnion.model.motion.drilling import drilled
from trunnion.model.motion.listing import listing
from trunnion.model.motion.program import Program
from trunnion.model.motion.toolpath import Toolpath
from trunnion.model.spindle import FeedMode
from trunnion.post.dialects.linuxcnc import LinuxCncDialect
from trunnion.post.header import Header
from trunnion.post.readers.linuxcnc import read_linuxcnc
from trunnion.post.settings import PostSettings
from trunnion.shop.kinematics import NO_WORK_POSITIONS

HEADER = Header(name="B1", part="B1", part_digest="ab12", plan_digest="cd34")
START = "G21 G90 G54\nT1 M6\nS400 M3\nG0 G43 H1 X0 Y0 Z50\nG0 Z10\n"
TOPS = np.array([[10.0, 5.0, 2.0], [30.0, 5.0, 2.0]])
HIGH = np.array([0.0, 0.0, 50.0])


def program(path: Toolpath, **changes) -> Program:
    """Return a program of a path that is lifted to the clearance height at its end."""
    x, y, _ = path.position[-1]
    whole = Toolpath.join([path, path_of((RAPID, x, y, 50.0))])
    made = replace(section("holes", FLAT_16, whole, 400.0), **changes)
    return Program(name="B1.S1", setup=S1, sections=(made,))


def words_of(made: Program, places=NO_WORK_POSITIONS):
    text = LinuxCncDialect().write([made], HEADER, PostSettings(), places)
    lines = [line.split(" ", 1)[1] for line in text.split("\n") if line.startswith("N")]
    return lines[lines.index("M8") + 3 : lines.index("M5 M9", lines.index("M8"))]


def cycled(kind: str, feed=500.0, **changes):
    return words_of(program(drilled(HIGH, TOPS, cycle(CycleKind(kind)), feed), **changes))


def read(body):
    return read_linuxcnc(f"{START}{body}\nG0 Z50\nM30\n", (FLAT_16,), S1)


def moves(body):
    """Return what a text does after its start, as (F or R, x, y, z)."""
    path = read(body).sections[0].path
    return [
        ("R" if motion == RAPID else "F", *np.round(at, 4).tolist())
        for motion, at in zip(path.motion[2:-1], path.position[2:-1], strict=True)
    ]


@pytest.mark.parametrize(
    ("kind", "line"),
    [
        ("drill", "G99 G81 X10 Y5 Z-5 R2 F500"),
        ("dwell", "G99 G82 X10 Y5 Z-5 R2 P0.5 F500"),
        ("peck", "G99 G83 X10 Y5 Z-5 R2 Q3 F500"),
        ("chip-break", "G99 G73 X10 Y5 Z-5 R2 Q3 F500"),
        ("ream", "G99 G85 X10 Y5 Z-5 R2 F500"),
        ("bore", "G99 G89 X10 Y5 Z-5 R2 P0.5 F500"),
        ("tap", "G99 G84 X10 Y5 Z-5 R2 F500"),
    ],
)
def test_each_kind_has_its_code_and_is_cancelled(kind, line):
    assert cycled(kind) == [line, "X30 Y5", "G80", "G0 Z50"]


def test_a_cycle_that_ends_where_it_began_returns_there():
    high = drilled(HIGH, TOPS, cycle(CycleKind.DRILL, lift=48.0), 500.0)
    assert words_of(program(high))[:2] == ["G98 G81 X10 Y5 Z-5 R2 F500", "X30 Y5"]


def test_an_end_that_no_return_reaches_is_written_out():
    path = drilled(HIGH, TOPS[:1], cycle(CycleKind.DRILL, lift=8.0), 500.0)
    assert words_of(program(path)) == [
        "X10 Y5",
        "Z2",
        "G1 Z-5 F500",
        "G0 Z10",
        "Z50",
    ]


def test_a_return_to_where_the_series_began_is_not_left_to_a_control_that_goes_there_aslant():
    low = drilled(HIGH, TOPS[:1], cycle(CycleKind.DRILL), 500.0)
    last = drilled(low.position[-1], TOPS[1:], cycle(CycleKind.DRILL, lift=48.0), 500.0)
    path = Toolpath.join([low, last])
    assert words_of(program(path)) == [
        "G99 G81 X10 Y5 Z-5 R2 F500",
        "G80",
        "G0 X30",
        "G1 Z-5",
        "G0 Z50",
    ]


def test_a_hole_whose_plane_is_higher_begins_a_series():
    tops = np.array([[10.0, 5.0, 2.0], [30.0, 5.0, 4.0]])
    path = drilled(HIGH, tops, cycle(CycleKind.DRILL), 500.0)
    assert words_of(program(path))[:3] == [
        "G99 G81 X10 Y5 Z-5 R2 F500",
        "G80",
        "G81 X30 Y5 Z-3 R4",
    ]


def test_another_kind_is_a_series_of_its_own():
    first = drilled(HIGH, TOPS[:1], cycle(CycleKind.DRILL), 500.0)
    second = drilled(first.position[-1], TOPS[1:], cycle(CycleKind.REAM), 300.0)
    assert words_of(program(Toolpath.join([first, second]))) == [
        "G99 G81 X10 Y5 Z-5 R2 F500",
        "G80",
        "G85 X30 Y5 Z-5 R2 F300",
        "G80",
        "G0 Z50",
    ]


def test_a_tap_is_fed_by_its_pitch_a_revolution():
    assert cycled("tap", feed_mode=FeedMode.REVOLUTION)[0] == "G95 G99 G84 X10 Y5 Z-5 R2 F1.25"


def test_cycles_are_written_out_in_inverse_time_and_on_rotary_axes():
    assert not any("G81" in line for line in cycled("drill", feed_mode=FeedMode.INVERSE))
    made = program(drilled(HIGH, TOPS, cycle(CycleKind.DWELL), 500.0))
    text = LinuxCncDialect().write([made], HEADER, PostSettings(), {"S1": standing(TABLE)})
    assert "G82" not in text and text.count("G4 P0.5") == 2


@pytest.mark.parametrize("kind", CycleKind)
def test_the_listing_of_what_is_read_is_that_of_the_plan(kind):
    made = program(drilled(HIGH, TOPS, cycle(kind), 500.0))
    text = LinuxCncDialect().write([made], HEADER, PostSettings())
    assert listing(read_linuxcnc(text, (FLAT_16,), S1), marks=False) == listing(made, marks=False)


def test_a_cycle_goes_on_at_each_position_until_another_motion():
    assert moves("G99 G81 X5 Y0 Z-3 R2 F100\nY7\nG0 X0") == [
        ("R", 5, 0, 10),
        ("R", 5, 0, 2),
        ("F", 5, 0, -3),
        ("R", 5, 0, 2),
        ("R", 5, 7, 2),
        ("F", 5, 7, -3),
        ("R", 5, 7, 2),
        ("R", 0, 7, 2),
    ]


def test_without_a_word_for_it_cycles_return_to_where_they_began():
    assert moves("G81 X5 Y0 Z-3 R2 F100\nY7")[-1] == ("R", 5, 7, 10)
    assert moves("G99 G81 X5 Y0 Z-3 R2 F100\nG98 Y7")[-1] == ("R", 5, 7, 10)
    assert moves("G99 G81 X5 Y0 Z-3 R2 F100\nG80\nG98 G81 Y7 Z-3 R2")[-1] == ("R", 5, 7, 2)


def test_a_hole_is_come_to_as_the_control_does_not_as_one_would_wish():
    # Back to the level where the series began, from the retract plane: up and across at once.
    assert moves("G99 G81 X5 Y0 Z-3 R2 F100\nG98 X9")[4] == ("R", 9, 0, 10)
    # A plane above the tool: up and across at once.
    assert moves("G99 G81 X5 Y0 Z-3 R2 F100\nX9 R4")[4:6] == [("R", 9, 0, 4), ("F", 9, 0, -3)]
    # A series that began below its plane: down to the next plane before it goes across.
    down = moves("G0 Z-4\nG81 X5 Y0 Z-5 R5 F100\nX9 R0")
    assert down[5:8] == [("R", 5, 0, 0), ("R", 9, 0, 0), ("F", 9, 0, -5)]


def test_chips_are_broken_by_the_back_off():
    heights = [z for _, _, _, z in moves("G99 G73 X5 Y0 Z-3 R2 Q3 F100")]
    assert heights == approx([10, 2, -1, -1 + BACK_OFF, -3, 2])


def test_a_cycle_in_inches_is_in_mm():
    text = START.replace("G21", "G20").replace("Z50", "Z2").replace("Z10", "Z1")
    body = "G99 G83 X1 Y0 Z-0.1 R0.1 Q0.15 F10\nG0 Z2\nM30\n"
    path = read_linuxcnc(text + body, (FLAT_16,), S1).sections[0].path
    assert path.position[:, 2].min() == approx(-2.54)
    assert path.feed.max() == approx(254.0)
    assert sorted(set(np.round(path.position[:, 2], 4)))[1:3] == approx([-1.27, -1.016])


def test_the_dwell_of_a_cycle_is_in_the_time_of_its_operation():
    part = read("G99 G82 X5 Y0 Z-3 R2 P0.5 F100\nY7").sections[0]
    assert part.dwell == 1.0
    assert part.path.dwells().tolist().count(0.5) == 2


@pytest.mark.parametrize(
    ("body", "says"),
    [
        ("G81 X5 Z-3 F100", "line 6: G81 needs Z, the bottom, and R, the plane"),
        ("G81 X5 R2 F100", "line 6: G81 needs Z"),
        ("G81 X5 Z3 R2 F100", "line 6: G81 with its bottom Z at or above its plane R"),
        ("G81 X5 Z-3 R2", "line 6: a feed move without a feed; give F"),
        ("M5\nG81 X5 Z-3 R2 F100", "line 7: a feed move while the spindle stands"),
        ("G83 X5 Z-3 R2 F100", "line 6: G83 needs Q above zero"),
        ("G83 X5 Z-3 R2 Q0.2 F100", "line 6: G83: cycle peck: a peck is deeper than the back-off"),
        ("G83 X5 Z-30000 R2 Q0.3 F100", "line 6: G83: cycle peck: .* pecks are more than 1000"),
        ("G82 X5 Z-3 R2 F100", "line 6: G82 needs P, seconds at the bottom"),
        ("G82 X5 Z-3 R2 P-1 F100", "line 6: P-1 is out of range"),
        ("G81 X5 Z-3 R2 F100 P1", "line 6: P without G4, G64, G82, G89 or an arc; remove it"),
        ("G81 X5 Z-3 R2 F100 L3", "line 6: the word L is not understood"),
        ("G81 X5 Z-3 R2 F100\nR3", "line 7: a hole of G81 is given by X, Y or Z"),
        ("G81 X5 Z-3 R2 F100\nG80\nX9", "line 8: a position without G0"),
        ("G81 G0 X5 Z-3 R2 F100", "line 6: G81 and G0 can't stand in one line"),
        ("G93 G81 X5 Z-3 R2 F10", "line 6: a cycle with G93 or a turning axis is not understood"),
        ("S0\nG84 X5 Z-3 R2 F100", "line 7: G84: cycle tap: tapping has a pitch above 0"),
        ("G53 G0 Z0\nG81 X5 Z-3 R2 F100", "line 7: a cycle before it is known where the tool is"),
        ("G86 X5 Z-3 R2 F100", "line 6: G86: this cycle is not understood; write the moves out"),
    ],
)
def test_what_drills_no_hole_is_refused(body, says):
    with pytest.raises(BadInput, match=says):
        read(body)
