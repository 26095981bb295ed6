"""LinuxCNC: what the text says, and that it says the same motions when it is read again."""

from __future__ import annotations

import re
import time
from dataclasses import replace

import numpy as np
import pytest

import programs
from programs import BULL_10, CCW, CW, FLAT_16, LINE, RAPID, S1, path_of, program_1, section
from trunnion.findings import BadInput, Refused
from trunnion.model.motion.listing import listing
from trunnion.model.motion.program import Program
from trunnion.model.motion.toolpath import Motion
from trunnion.post.dialects.linuxcnc import LinuxCncDialect
from trunnion.post.header import STAMP_LINES, Header
from trunnion.post.readers.linuxcnc import read_linuxcnc
from trunnion.post.settings import PostSettings

HEADER = Header(
    name="B1",
    part="B1",
    part_digest="ab12",
    plan_digest="cd34",
    material="al-7075",
    date="2026-01-02",
)
TOOLS = (FLAT_16, BULL_10)
START = "G21 G90 G17 G40 G94 G54\nT1 M6\nS9000 M3\nG0 G43 H1 X0 Y0 Z50\n"
END = "\nM30\n"


def text_of(program: Program, **settings) -> str:
    return LinuxCncDialect().write([program], HEADER, PostSettings(**settings))


def one(path, tool=FLAT_16) -> Program:
    return Program(name="B1.S1", setup=S1, sections=(section("op-1", tool, path),))


def read(body: str) -> Program:
    return read_linuxcnc(START + body + END, TOOLS, S1)


def blocks(program: Program) -> list[str]:
    return [
        line
        for line in listing(program, marks=False).splitlines()
        if not line.startswith(("setup", "operation"))
    ]


def test_a_program_read_again_moves_the_same():
    assert listing(read_linuxcnc(text_of(program_1()), TOOLS, S1), marks=False) == listing(
        program_1(), marks=False
    )


def test_a_program_in_inches_read_again_moves_the_same_within_its_decimals():
    again = read_linuxcnc(text_of(program_1(), units="inch"), TOOLS, S1)
    for first, second in zip(program_1().sections, again.sections, strict=True):
        assert np.abs(first.path.position - second.path.position).max() < 0.5 * 25.4e-5 + 1e-9
        assert list(first.path.motion) == list(second.path.motion)


def test_same_program_same_bytes():
    assert text_of(program_1()) == text_of(program_1())


def test_each_block_knows_its_line():
    text = text_of(program_1())
    sections = read_linuxcnc(text, TOOLS, S1).sections
    lines = text.split("\n")
    assert lines[sections[0].block_lines[3] - 1].split(" ", 1)[1] == "G3 X20 Y10 Z-2.5 I-5 J0 F600"


def test_the_text_begins_with_the_stamp_and_a_safe_start():
    lines = text_of(program_1()).split("\n")
    assert lines[:STAMP_LINES] == [
        "(TRUNNION PROGRAM B1.S1)",
        "(REJECTED: DO NOT RUN)",
        "(VERDICT: NONE)",
        "(REASON: not proven)",
        "(DATE: 2026-01-02)",
    ]
    numbered = [line for line in lines if line.startswith("N")]
    assert numbered[:4] == [
        "N10 G21",
        "N20 G90 G91.1 G17 G40 G49 G80 G94",
        "N30 G64 P0.005",
        "N40 G54",
    ]
    assert numbered[-1].endswith("M30")


def test_every_operation_is_a_restart_point_with_its_whole_state():
    text = text_of(program_1())
    lines = text.split("\n")
    at = lines.index("(OPERATION wall-01)")
    assert lines[at + 1] == "(RESTART POINT N220 TOOL 1 flat 16)"
    assert [line.split(" ", 1)[1] for line in lines[at + 2 : at + 7]] == [
        "G90 G91.1 G17 G40 G94 G54",
        "S14000 M3",
        "M8",
        "G43 H1",
        "G0 X0 Y0 Z50",
    ]


def test_after_a_tool_change_the_tool_goes_over_the_start_before_it_goes_down():
    text = text_of(program_1())
    after = text[text.index("T7 M6") :].split("\n")
    assert [line.split(" ", 1)[1] for line in after[4:6]] == ["G0 X0 Y0", "G0 G43 H7 Z50"]


def test_mist_is_off_before_flood_when_the_tool_stays():
    wall = programs.WALL
    program = Program(
        name="B1.S1",
        setup=S1,
        sections=(section("a", FLAT_16, wall, coolant="mist"), section("b", FLAT_16, wall)),
    )
    text = text_of(program)
    assert text.index("M7") < text.index(" M9\n", text.index("M7")) < text.index("M8")


def test_a_full_turn_ends_where_the_text_says_it_starts():
    path = path_of(
        (RAPID, 10.00005, 0, 50),
        (LINE, 10.00005, 0, -1, 100),
        (CCW, 10.00005, 0, -1, 0, 0, 100),
        (RAPID, 10, 0, 50),
    )
    again = read_linuxcnc(text_of(one(path)), TOOLS, S1)
    assert again.sections[0].path.sweeps()[2] == pytest.approx(2 * np.pi)


def test_an_arc_shorter_than_a_decimal_never_becomes_a_full_turn():
    start, end = (10.0, 0.00001), (10.0, 0.00004)
    path = path_of(
        (RAPID, *start, 50), (LINE, *start, -1, 100), (CCW, *end, -2, 0, 0, 100), (RAPID, *end, 50)
    )
    again = read_linuxcnc(text_of(one(path)), TOOLS, S1)
    assert list(again.sections[0].path.motion) == [RAPID, LINE, LINE, RAPID]


def test_an_arc_that_nearly_closes_stays_nearly_a_full_turn():
    end = (10.0, -0.00004)
    path = path_of(
        (RAPID, 10, 0, 50), (LINE, 10, 0, -1, 100), (CCW, *end, -1, 0, 0, 100), (RAPID, *end, 50)
    )
    again = read_linuxcnc(text_of(one(path)), TOOLS, S1)
    assert again.sections[0].path.sweeps()[2] == pytest.approx(2 * np.pi, abs=1e-4)


def test_moves_below_the_last_decimal_do_not_add_up():
    steps = [(LINE, 0.00004 * n, 0, 0, 100) for n in range(1, 1001)]
    path = path_of((RAPID, 0, 0, 50), (LINE, 0, 0, 0, 100), *steps, (RAPID, 0.04, 0, 50))
    again = read_linuxcnc(text_of(one(path)), TOOLS, S1)
    assert again.sections[0].path.position[-1, 0] == 0.04


def test_a_tilted_axis_is_refused():
    path = path_of((RAPID, 0, 0, 50), (LINE, 0, 0, 0, 100))
    tilted = replace(path, axis=np.tile([0.6, 0.0, 0.8], (2, 1)))
    with pytest.raises(Refused, match=r"operation op-1, block 1: a tilted tool axis"):
        text_of(one(tilted))


def test_an_arc_whose_ends_lie_at_two_radii_is_refused():
    path = path_of((RAPID, 10, 0, 50), (CW, 0, 10.01, 50, 0, 0, 100))
    with pytest.raises(Refused, match=r"block 2: the arc's ends lie at radii 0\.0100 mm apart"):
        text_of(one(path))


def test_an_unknown_work_offset_is_refused():
    with pytest.raises(Refused, match="has no work offset G70; it has G54, G55"):
        text_of(replace(program_1(), setup=replace(S1, work_offset="G70")))


def test_an_id_that_no_comment_holds_is_refused():
    with pytest.raises(Refused, match="its id can't stand in a comment"):
        text_of(
            Program(name="B1.S1", setup=S1, sections=(section("a (b)", FLAT_16, programs.WALL),))
        )


def test_hand_edited_text_may_be_lower_case_spaced_and_commented():
    again = read("g 1 x 1 0.5 (to the right) f 2 00 ; slowly\n  y5 (op) z-1")
    assert blocks(again)[1:] == [
        "line    x 10.5000 y 0.0000 z 50.0000 feed 200.0",
        "line    x 10.5000 y 5.0000 z -1.0000 feed 200.0",
    ]


def test_line_ends_of_another_system_are_read():
    assert blocks(read_linuxcnc(text_of(program_1()).replace("\n", "\r\n"), TOOLS, S1)) == blocks(
        program_1()
    )


def test_an_arc_by_radius_has_the_centre_of_the_shorter_way():
    again = read("G1 X0 Y0 F100\nG2 X10 Y10 R10")
    assert (
        blocks(again)[2]
        == "arc-cw  x 10.0000 y 10.0000 z 50.0000 centre x 10.0000 y 0.0000 feed 100.0"
    )


def test_a_negative_radius_goes_the_longer_way():
    again = read("G1 X0 Y0 F100\nG3 X10 Y10 R-10")
    assert blocks(again)[2].split("centre")[1] == " x 10.0000 y 0.0000 feed 100.0"
    assert again.sections[0].path.sweeps()[2] == pytest.approx(1.5 * np.pi)


def test_an_operation_without_our_comment_is_called_by_its_line():
    assert read("G1 X5 F100").sections[0].operation == "line 4"


def test_an_operation_that_begins_low_is_judged_from_where_it_is():
    again = read("G1 Z-5 F100\n(OPERATION next)\nG0 X30\nG0 Z50")
    first = again.sections[1]
    assert first.operation == "next"
    assert first.path.position[:2].tolist() == [[0.0, 0.0, -5.0], [30.0, 0.0, -5.0]]


def test_a_first_rapid_that_goes_straight_into_the_work_comes_from_above():
    text = "G21 G90 G54\nT1 M6\nS9000 M3\nG0 X5 Y6\nG0 G43 H1 Z-3\nM30\n"
    again = read_linuxcnc(text, TOOLS, S1)
    assert again.sections[0].path.position.tolist() == [[5.0, 6.0, 50.0], [5.0, 6.0, -3.0]]


def test_going_up_for_a_tool_change_is_a_rapid_like_any_other():
    again = read("G1 Z-5 F100\nG53 G0 Z0")
    assert blocks(again)[-1] == "rapid   x 0.0000 y 0.0000 z 50.0000"


def test_another_spindle_speed_begins_a_section_of_the_same_operation():
    again = read("(OPERATION a)\nG1 Z-5 F100\nS4000\nG1 X9")
    assert [(s.operation, s.spindle) for s in again.sections] == [
        ("line 4", 9000.0),
        ("a", 9000.0),
        ("a", 4000.0),
    ]
    assert again.sections[2].path.position.tolist() == [[0.0, 0.0, -5.0], [9.0, 0.0, -5.0]]


def test_a_part_of_a_circle_in_inches_is_in_mm():
    text = "G20 G90 G54\nT1 M6\nS9000 M3\nG0 G43 H1 X1 Y0 Z2\nG3 X-1 I-1 F10\nM2\n"
    path = read_linuxcnc(text, TOOLS, S1).sections[0].path
    assert path.position[-1].tolist() == [-25.4, 0.0, 50.8]
    assert path.centre[-1].tolist() == [0.0, 0.0, 50.8]
    assert path.feed[-1] == 254.0


def test_reading_costs_little_more_than_finding_the_numbers_of_the_lines():
    """The bound is a ratio, because seconds say more of the machine than of the reader."""
    body = "\n".join(f"N{10 * n} X{n % 977}.{n % 7} Y{n % 31}.25" for n in range(1, 100_001))
    began = time.process_time()
    words = [dict(re.findall(r"([A-Z])([-+]?[0-9.]+)", line)) for line in body.split("\n")]
    numbers = [{letter: float(number) for letter, number in line.items()} for line in words]
    between = time.process_time()
    again = read("G1 F100\n" + body)
    assert time.process_time() - between < 9.0 * (between - began)
    assert again.n_blocks() == len(numbers) + 1


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (
            "Z-5 I-5",
            "Z-5 I-6",
            "line 31: the arc starts at radius 6.0000 and ends at 4.0000 mm; check its end or its centre",
        ),
        ("T7 M6", "T8 M6", "T8 is not in the tool list; it has 1, 7"),
        (
            "G43 H7 Z50",
            "G43 H1 Z50",
            "H1 is the length of another tool than T7 in the spindle; use H7",
        ),
        ("S18000 M3", "S18000", "a feed move while the spindle stands"),
        ("N430 G49\nN440 M30", "", r"no end \(M30 or M2\): is the text complete"),
    ],
)
def test_damage_by_hand_is_refused_in_words(old, new, words):
    text = text_of(program_1())
    assert old in text
    with pytest.raises(BadInput, match=words):
        read_linuxcnc(text.replace(old, new, 1), TOOLS, S1)


def test_five_lines_out_of_order_are_refused():
    lines = text_of(program_1()).split("\n")
    at = next(n for n, line in enumerate(lines) if line.startswith("N170"))
    moved = lines[:at] + lines[at + 4 : at + 5] + lines[at : at + 4] + lines[at + 5 :]
    with pytest.raises(BadInput, match=r"line \d+: N170 comes after N\d+: lines are out of order"):
        read_linuxcnc("\n".join(moved), TOOLS, S1)


def test_a_text_made_for_another_tool_of_the_number_is_refused():
    other = replace(FLAT_16, diameter=15.0)
    with pytest.raises(
        BadInput,
        match="line 12: the text was made for another tool 1 than the tool list has; post the program anew",
    ):
        read_linuxcnc(text_of(program_1()), (other, BULL_10), S1)


def test_an_operation_that_goes_up_before_its_tool_comes_keeps_its_name():
    again = read(
        "G1 Z-5 F100\n(OPERATION next)\nG53 G0 Z0\nT7 M6\nS9000 M3\nG0 G43 H7 X1 Y1 Z50\nG1 Z-1"
    )
    assert [(s.operation, s.tool.number) for s in again.sections] == [
        ("line 4", 1),
        ("next", 1),
        ("next", 7),
    ]


def test_a_spindle_that_stands_is_not_written():
    with pytest.raises(Refused, match="operation a: a spindle speed of 0 turns nothing"):
        text_of(
            Program(name="B1.S1", setup=S1, sections=(section("a", FLAT_16, programs.WALL, 0.0),))
        )


def test_motions_are_the_ones_the_words_name():
    assert LinuxCncDialect().words.motions[Motion.ARC_CCW] == "G3"
