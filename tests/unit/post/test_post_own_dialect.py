"""A control with other words than LinuxCNC's is read by the same state machine: its own words mean what they mean on it."""

from __future__ import annotations

import pytest
from pytest import approx

from leaning_paths import TABLE, standing
from own_packages import FOLDER, all_dialects
from programs import BULL_10, FLAT_16, S1
from trunnion.findings import BadInput
from trunnion.model.motion.program import Program
from trunnion.model.motion.toolpath import Motion

KESTREL = all_dialects()["kestrel"]
MOST_LINES = 120
START = "%HAND\nG71 G90 G162 G54\nT1\nS9000 M3\nG0 X0 Y0\nD1 Z50\n"


def read(body: str, start: str = START, end: str = "\nM2\n") -> Program:
    (program,) = KESTREL().read(start + body + end, (FLAT_16, BULL_10), [S1])
    return program


def refusal(body: str, **parts: str) -> str:
    with pytest.raises(BadInput) as refused:
        read(body, **parts)
    return str(refused.value)


def test_a_dialect_is_small():
    assert (
        sum(len(module.read_text().splitlines()) for module in (FOLDER / "kestrel").glob("*.py"))
        <= MOST_LINES
    )


def test_centres_count_from_the_zero_of_the_work_offset():
    path = read("G1 X20 Y10 F100\nG3 X10 I15 J10").sections[0].path
    assert path.motion[-1] == Motion.ARC_CCW
    assert path.centre[-1] == approx([15.0, 10.0, 50.0])


def test_a_centre_that_is_half_given_has_the_other_half_of_the_start():
    assert read("G1 X20 Y10 F100\nG3 X10 I15").sections[0].path.centre[-1] == approx(
        [15.0, 10.0, 50.0]
    )


def test_a_radius_has_a_letter_of_its_own():
    assert read("G1 X0 Y0 F100\nG2 X10 Y10 U10").sections[0].path.centre[-1] == approx(
        [10.0, 0.0, 50.0]
    )


def test_a_tool_comes_at_its_t_word():
    sections = read("G1 Z-1 F100\nG153 G0 Z0\nT7\nS900 M3\nG0 X1 Y1\nG0 D7 Z50\nG1 Z-2").sections
    assert [s.tool.number for s in sections] == [1, 7]


def test_inches_are_g70():
    path = (
        read("G1 X1 F10", start=START.replace("G71", "G70").replace("Z50", "Z2")).sections[0].path
    )
    assert path.position[-1] == approx([25.4, 0.0, 50.8])
    assert path.feed[-1] == approx(254.0)


@pytest.mark.parametrize(
    ("body", "message"),
    [
        (
            "G2 X10 Y10 R10",
            "line 7: the word R is not understood by a three-axis program; remove it",
        ),
        ("G1 X1 U5 F100", "line 7: I, J or U without an arc; put G2 or G3 first"),
        ("G1 X1 F100\nG2 X2 U9 I5", "line 8: an arc with U and with I or J; keep one of them"),
        ("G1 F100\nG2 X2 U0.0001", "line 8: an arc without a radius; check its centre or U"),
        ("G1 F100\nG2 X5", "line 8: an arc without I, J or U"),
        ("D0\nG1 X1 F100", "line 8: a move without the tool's length; put D1 first"),
        ("D7", "line 7: D7 is the length of another tool than T1 in the spindle; use D1"),
        ("D-1", "line 7: D-1 is out of range; allowed is 0 to 99999"),
        ("T9", "line 7: T9 is not in the tool list; it has 1, 7"),
        (
            "T7\nG1 X1 F100",
            "line 8: a feed move before it is known where the tool is; begin with a rapid to X, Y and Z",
        ),
        ("T7\nG0 X1 Y1 Z50", "line 8: a move in Z without the tool's length; put D7 first"),
        (
            "G153 G0 Z5",
            "line 7: of G153 only G153 G0 Z0, straight up to the top of the machine, is understood",
        ),
        (
            "G53 G0 Z0",
            "line 7: G53 is not understood; remove it or write what it does in known words",
        ),
        (
            "G93 G1 X1 F9",
            "line 7: G93 is not understood; remove it or write what it does in known words",
        ),
        ("G163", "line 7: G163: arc centres from the start are not understood; use G162"),
        ("G1 X1 F100\nG70", "line 8: the units change in the middle of the program; keep one"),
        ("G55", "line 7: G55 is not the work offset of setup S1, G54; use that"),
        ("G71 G70", "line 7: G71 and G70 can't stand in one line; keep one"),
        ("M3 M5", "line 7: M3 and M5 can't stand in one line; keep one"),
        (
            "G1 X1 (slowly) F100",
            "line 7: brackets are not understood on this control; write comments after a semicolon",
        ),
        ("%AGAIN", "line 7: a program's name stands once, before its first block; remove it"),
        ("M30", "line 7: M30 is not understood; remove it or write what it does in known words"),
        ("M2\nG1 X1", "line 8: stands after the end of the program; remove it or the M2 before it"),
    ],
)
def test_what_it_does_not_say_is_refused_in_its_own_words(body, message):
    assert refusal(body) == message


@pytest.mark.parametrize(
    ("start", "message"),
    [
        (
            "G71 G54\nS9000 M3\nG0 X0 Y0\n",
            "line 3: a move before a tool is in the spindle; put T first",
        ),
        ("G71 G54\nD1\n", "line 2: D before a tool is in the spindle; put T first"),
        ("G54\nT1\nG0 X0 Y0\n", "line 3: a move before its unit is said; put G71 or G70 first"),
        ("G71 G54\nT1\nM3\n", "line 3: M3 without a spindle speed; give S"),
        (
            "G71 G54\nT1\nG0 X0 Y0\nD1 Z50\nG1 X1 F100\n",
            "line 5: a feed move while the spindle stands; give S and M3 first",
        ),
        ("G71 G54\nT1\nX0 Y0\n", "line 3: a position without G0, G1, G2 or G3"),
    ],
)
def test_what_is_missing_is_asked_for_in_its_own_words(start, message):
    assert refusal("", start=start) == message


def test_a_text_without_its_end_is_refused():
    assert refusal("G1 X1 F100", end="\n") == "the program has no end (M2): is the text complete?"


def test_a_machine_with_rotary_axes_is_refused():
    with pytest.raises(
        BadInput,
        match="setup S1: Kestrel 8 has no words for the rotary axes of .*; choose another control or machine",
    ):
        KESTREL().read(START + "G1 X1 F100\nM2\n", (FLAT_16,), [S1], {"S1": standing(TABLE)})
