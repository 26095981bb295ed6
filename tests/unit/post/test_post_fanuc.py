"""Fanuc texts word by word: what is written for each cycle and each way to hold the tool, and what is refused in one line."""

from __future__ import annotations

import numpy as np
import pytest
from pytest import approx

from leaning_paths import HEADER, TABLE, lean, path_of, program, standing
from programs import BULL_10, FLAT_16, S1, section
from random_programs import cycle
from trunnion.findings import BadInput
from trunnion.model.motion.cycle import CycleKind
from trunnion.model.motion.drilling import drilled
from trunnion.model.motion.program import Program
from trunnion.post.dialects.fanuc import FanucDialect
from trunnion.post.settings import PostSettings

START = "O1\nG21 G54\nT1 M6\nS9000 M3\nG0 X0 Y0\nG43 H1 Z50.\n"
TILTED = (
    "G21 G54\nT1 M6\nS9000 M3\nG68.2 X0. Y0. Z0. I90. J30. K0.\nG53.1\nG0 X0 Y0\nG43 H1 Z300.\n"
)
TIP = "G21 G54\nT1 M6\nS9000 M3\nG43.5 H1 P1\nG0 X0 Y0 Z50. I0 J0 K1.\n"


def lines_of(made: Program, places=None) -> list[str]:
    """Return the lines of a program without their numbers and without comments."""
    text = FanucDialect().write([made], HEADER, PostSettings(), places or {})
    return [line.partition(" ")[2] for line in text.splitlines() if line.startswith("N")]


def holes(kind: CycleKind, lift: float = 0.0) -> Program:
    """Return a program of two holes 7 mm deep from Z2, fed at 480 mm/min, 384 1/min: 1.25 mm a revolution."""
    tops = np.array([[10.0, 5.0, 2.0], [30.0, 5.0, 2.0]])
    path = drilled(np.array([0.0, 0.0, 50.0]), tops, cycle(kind, lift=lift), 480.0)
    return Program(name="B1.S1", setup=S1, sections=(section("holes", FLAT_16, path, 384.0),))


def read(body: str, start: str = START, place=None) -> Program:
    places = {} if place is None else {"S1": place}
    (found,) = FanucDialect().read(start + body + "\nM30\n", (FLAT_16, BULL_10), [S1], places)
    return found


def refusal(body: str, start: str = START, place=None) -> str:
    with pytest.raises(BadInput) as refused:
        read(body, start, place)
    return str(refused.value)


@pytest.mark.parametrize(
    ("kind", "line"),
    [
        (CycleKind.DRILL, "G99 G81 X10. Y5. Z-5. R2. F480."),
        (CycleKind.DWELL, "G99 G82 X10. Y5. Z-5. R2. P500 F480."),
        (CycleKind.PECK, "G99 G83 X10. Y5. Z-5. R2. Q3. F480."),
        (CycleKind.CHIP_BREAK, "G99 G73 X10. Y5. Z-5. R2. Q3. F480."),
        (CycleKind.REAM, "G99 G85 X10. Y5. Z-5. R2. F480."),
        (CycleKind.BORE, "G99 G89 X10. Y5. Z-5. R2. P500 F480."),
        (CycleKind.TAP, "G99 G84 X10. Y5. Z-5. R2. F480."),
    ],
)
def test_a_cycle_is_a_line_a_hole(kind, line):
    lines = lines_of(holes(kind))
    k = lines.index(line)
    assert lines[k : k + 3] == [line, "X30. Y5.", "G80"]


def test_boring_that_goes_out_further_at_the_feed_is_written_out():
    assert not any("G89" in line for line in lines_of(holes(CycleKind.BORE, lift=48.0)))


def test_every_number_has_its_point_but_counts_and_milliseconds():
    text = FanucDialect().write([holes(CycleKind.DWELL)], HEADER, PostSettings())
    blocks = [line for line in text.splitlines() if line.startswith("N")]
    words = [w for line in blocks for w in line.split() if w[0] in "XYZABCIJKRQF"]
    assert words and all("." in w for w in words)


def test_the_program_stands_between_two_percent_signs_with_its_number_first():
    lines = FanucDialect().write([holes(CycleKind.DRILL)], HEADER, PostSettings()).splitlines()
    k = lines.index("%")
    assert lines[k + 1] == "O0001 (B1.S1)" and lines[-1] == "%"
    assert all(line.startswith("(") for line in lines[:k])


def test_a_tool_that_turns_is_followed_by_vectors():
    path = path_of(
        ((0.0, 0.0, 300.0), lean(20.0)), ((0.0, 0.0, 0.0), lean(20.0)), ((9.0, 0.0, 0.0), lean(0.0))
    )
    lines = lines_of(program(path), {"S1": standing(TABLE)})
    k = lines.index("G43.5 H1 P1")
    assert lines[k - 1] in ("G0 A-20. C-90.", "G0 A20. C90.")
    assert lines[k + 1 : k + 5] == [
        "G0 X0. Y0. Z300. I0.342020143 J0. K0.939692621",
        "G1 Z0. F1200.",
        "X9. I0. J0. K1.",
        "G49",
    ]


def test_a_direction_that_stays_is_a_plane():
    path = path_of(((0.0, 0.0, 300.0), lean(30.0, 90.0)), ((0.0, 0.0, 0.0), lean(30.0, 90.0)))
    lines = lines_of(program(path), {"S1": standing(TABLE)})
    # Towards +y: half a turn about Z brings x to -x, then 30 degrees about it lean z towards +y.
    k = lines.index("G68.2 X0. Y0. Z0. I180. J30. K0.")
    assert lines[k + 1] == "G53.1" and lines[k + 2].startswith("G0 G43 H1 X0. Y")


@pytest.mark.parametrize(
    ("body", "message"),
    [
        ("G1 X20 F100.", "line 7: X20 without a point counts in the least increment; write X20."),
        ("G1 X1. F9. (a", "line 7: a comment's brackets don't match"),
        ("#1=5", "line 7: parameters (#) are not understood; write the numbers themselves"),
        ("O2", "line 7: a program's number stands once, before its first block; remove it"),
        ("%\nG0 X1.", "line 7: a % in the middle of the program ends it there; remove it"),
        ("G91", "line 7: G91: incremental moves are not understood; use G90"),
        ("G43.4 H1", "line 7: G43.4: angles of rotary axes under tip control are not understood"),
        ("G43.5 H1 P1", "line 7: G43.5 on mill-3-axis, a machine without rotary axes; remove it"),
        ("G28 Z0", "line 7: G28: the place of G28 is not known here; use G53 G0 Z0."),
        ("G54.1 P1", "line 7: G54.1: further work offsets are not understood; use G54 to G59"),
        ("M98 P1000", "line 7: M98: macros and subprograms are not understood"),
        ("G76 X1. Z-5. R2. Q0.5 F9.", "line 7: G76: this cycle is not understood"),
        (
            "G0 Z1.\nG81 X1. Z-5. R2. F9.",
            "line 8: G81 begins below its plane R; lift the tool first",
        ),
        ("G43 H7", "line 7: H7 is the length of another tool than T1 in the spindle; use H1"),
    ],
)
def test_what_it_does_not_understand_is_refused_in_one_line(body, message):
    assert refusal(body).startswith(message)


@pytest.mark.parametrize(
    ("start", "body", "message"),
    [
        (TIP, "G53 G0 Z0", "line 6: G53 under G43.5 is not understood; put G49 first"),
        (TIP, "G68.2 X0 Y0 Z0 I0 J9. K0", "line 6: G68.2 under G43.5 is not understood"),
        (TIP, "G1 X5. F9. I0 J0 K-1.", "line 6: the tool turns straight back in one block"),
        (TIP, "G2 X5. R9. F9. I1. J0 K0", "line 6: an arc of a tool that leans or turns"),
        (TIP, "G49\nG43 H1 G0 X5.", "line 7: it is not known where the rotary axes stand"),
        (TILTED, "G43.5 H1 P1", "line 8: G43.5 in a tilted plane is not understood; put G69 first"),
        (TILTED, "G43.5 H1", "line 8: G43.5 without P1 turns the tool another way"),
        (TILTED, "G68.2 X0 Y0 Z0 I0 J5. K0\nG0 X1.", "line 9: a move after G68.2 without G53.1"),
        (TILTED, "G68.2 X0 Y0 Z0 I0 J5. K0\nG53.1", "line 9: G53.1 turns the tool while it is at"),
        (TILTED, "G68.2 X5. Y0 Z0 I0 J5. K0", "line 8: of G68.2 only X0. Y0. Z0. and the angles"),
        (TILTED, "G53.1", "line 8: G53.1 without a plane; put G68.2 before it"),
    ],
)
def test_what_it_does_not_understand_of_five_axes_is_refused_in_one_line(start, body, message):
    assert refusal(body, start, standing(TABLE)).startswith(message)


def test_a_plane_is_read_by_eulers_angles():
    # 90 about Z takes x to y; 30 about the new X, the old y, leans the tool towards x.
    path = read("G1 Z0 F9.", TILTED, standing(TABLE)).sections[0].path
    assert path.axis[-1] == approx([0.5, 0.0, np.sqrt(0.75)])


def test_a_text_without_its_closing_percent_sign_is_refused():
    with pytest.raises(BadInput, match="the program has no closing %: is the text complete?"):
        read("G1 X1. F9.", "%\n" + START)
