"""Sinumerik texts word by word: what is written for each cycle and each way to hold the tool, and what is refused in one line."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from pytest import approx

from leaning_paths import FORK, HEAD_AND_TABLE, HEADER, TABLE, lean, path_of, program, standing
from programs import BULL_10, FLAT_16, S1, program_1, section
from random_programs import cycle
from trunnion.findings import BadInput
from trunnion.model.motion.cycle import CycleKind
from trunnion.model.motion.drilling import drilled
from trunnion.model.motion.program import Program
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.post.dialects.sinumerik import SinumerikDialect
from trunnion.post.release import is_program_of
from trunnion.post.settings import PostSettings
from trunnion.post.ticks import TickScale
from trunnion.post.writer.tilted_plane import plane_across

START = "G710 G54\nT1 M6\nS9000 M3\nG0 X0 Y0\nD1 Z50\n"
TILTED = (
    'G710 G54\nT1 M6\nS9000 M3\nD1\nCYCLE800(0,"",0,57,0,0,0,0,30,0,0,0,0,1,0,1)\nG0 X0 Y0\nZ50\n'
)
TIP = "G710 G54\nT1 M6\nS9000 M3\nD1\nTRAORI\nORIWKS ORIVECT\nG0 X0 Y0 Z50 A3=0 B3=0 C3=1\n"


def lines_of(made: Program, places=None, **chosen) -> list[str]:
    """Return the lines of a program without their numbers and without comments."""
    text = SinumerikDialect().write([made], HEADER, PostSettings(**chosen), places or {})
    return [line.partition(" ")[2] for line in text.splitlines() if line.startswith("N")]


def holes(kind: CycleKind, lift: float = 0.0) -> Program:
    """Return a program of two holes 7 mm deep from Z2, fed at 480 mm/min, 384 1/min: 1.25 mm a revolution."""
    tops = np.array([[10.0, 5.0, 2.0], [30.0, 5.0, 2.0]])
    path = drilled(np.array([0.0, 0.0, 50.0]), tops, cycle(kind, lift=lift), 480.0)
    return Program(name="B1.S1", setup=S1, sections=(section("holes", FLAT_16, path, 384.0),))


def read(body: str, start: str = START, place=None, end: str = "\nM30\n") -> Program:
    places = {} if place is None else {"S1": place}
    (found,) = SinumerikDialect().read(start + body + end, (FLAT_16, BULL_10), [S1], places)
    return found


def refusal(body: str, start: str = START, place=None) -> str:
    with pytest.raises(BadInput) as refused:
        read(body, start, place)
    return str(refused.value)


@pytest.mark.parametrize(
    ("kind", "call"),
    [
        (CycleKind.DRILL, "MCALL CYCLE81(2,2,0,-5)"),
        (CycleKind.DWELL, "MCALL CYCLE82(2,2,0,-5,,0.5)"),
        (CycleKind.PECK, "MCALL CYCLE83(2,2,0,-5,,-1,,0,0,0,1,1,3,0,,0,0.254)"),
        (CycleKind.CHIP_BREAK, "MCALL CYCLE83(2,2,0,-5,,-1,,0,0,0,1,0,3,0,0.254)"),
        (CycleKind.REAM, "MCALL CYCLE85(2,2,0,-5,,0,480,480)"),
        (CycleKind.BORE, "MCALL CYCLE89(2,2,0,-5,,0.5)"),
        (CycleKind.TAP, "MCALL CYCLE84(2,2,0,-5,,0,3,,1.25,0,384,384)"),
    ],
)
def test_a_cycle_is_called_once_for_all_its_holes(kind, call):
    lines = lines_of(holes(kind))
    k = lines.index(call)
    assert lines[k - 1 : k + 4] == ["F480", call, "G0 X10 Y5", "G0 X30 Y5", "MCALL"]


def test_a_cycle_that_ends_higher_says_so_by_its_retraction_plane():
    assert "MCALL CYCLE81(20,2,0,-5)" in lines_of(holes(CycleKind.DRILL, lift=18.0))


def test_boring_that_goes_out_further_at_the_feed_is_written_out():
    assert not any("CYCLE89" in line for line in lines_of(holes(CycleKind.BORE, lift=18.0)))


def test_the_suffix_is_mpf():
    assert SinumerikDialect().suffix == "MPF"
    assert is_program_of("B1", "B1.S1.MPF") and is_program_of("B1", "B1.S1.REJECTED.MPF")


@pytest.mark.parametrize(
    ("offset", "written"), [("G54", True), ("G505", True), ("G599", True), ("G58", False)]
)
def test_work_offsets_are_g54_to_g57_and_g505_to_g599(offset, written):
    assert (offset in SinumerikDialect().words.work_offsets) is written


def test_a_direction_that_stays_is_a_plane_and_its_arcs_stay_arcs():
    tilt, centre = lean(30.0, 90.0), np.array([10.0, 5.0, 0.0])
    across, ahead = np.array([1.0, 0.0, 0.0]), np.cross(tilt, [1.0, 0.0, 0.0])
    around = [centre + 8.0 * (np.cos(a) * across + np.sin(a) * ahead) for a in (0.0, 0.7)]
    path = Toolpath(
        position=[around[0] + 300.0 * tilt, around[0], around[1]],
        axis=[tilt] * 3,
        motion=[Motion.RAPID, Motion.LINE, Motion.ARC_CCW],
        feed=[0.0, 500.0, 800.0],
        mark=[0] * 3,
        centre=[[np.nan] * 3, [np.nan] * 3, centre],
    )
    lines = lines_of(program(path), {"S1": standing(TABLE)})
    # The tool leans towards +y: the plane turns by -30 degrees about X.
    k = lines.index('CYCLE800(0,"",200000,57,0,0,0,-30,0,0,0,0,0,-1,0,1)')
    assert lines[k - 1] == "D1" and lines[k + 3].startswith("G3 ")
    (found,) = read_back(program(path), standing(TABLE))
    assert found.motion.tolist()[1:4] == [Motion.LINE, Motion.ARC_CCW, Motion.RAPID][:3]
    assert found.centre[2] == approx(centre, abs=1e-3)


def read_back(made: Program, place) -> list[Toolpath]:
    text = SinumerikDialect().write([made], HEADER, PostSettings(), {"S1": place})
    (found,) = SinumerikDialect().read(text, (FLAT_16,), [S1], {"S1": place})
    return [s.path for s in found.sections]


def test_a_cycle_in_a_tilted_plane_is_called_too():
    axis = lean(40.0, 200.0)
    tops = np.array([[10.0, 5.0, 2.0], [20.0, 5.0, 3.0]])
    path = drilled(tops[0] + 300.0 * axis, tops, cycle(CycleKind.DRILL, lift=20.0), 480.0, axis)
    made = program(path)
    assert sum("CYCLE81" in line for line in lines_of(made, {"S1": standing(TABLE)})) == 2
    (found,) = read_back(made, standing(TABLE))
    deep = found.position[found.motion == Motion.LINE]
    assert deep == approx(tops - 7.0 * axis, abs=2e-4)


def test_a_tool_that_turns_is_followed_and_its_axes_are_placed_before():
    path = path_of(
        ((0.0, 0.0, 300.0), lean(20.0)), ((0.0, 0.0, 0.0), lean(20.0)), ((9.0, 0.0, 0.0), lean(0.0))
    )
    lines = lines_of(program(path), {"S1": standing(TABLE)})
    k = lines.index("TRAORI")
    assert lines[k - 2 : k + 2] == ["D1", "G0 A-20 C-90", "TRAORI", "ORIWKS ORIVECT"] or lines[
        k - 2 : k + 2
    ] == ["D1", "G0 A20 C90", "TRAORI", "ORIWKS ORIVECT"]
    assert lines[k + 2 :] == [
        "G0 X0 Y0 Z300 A3=0.342020143 B3=0 C3=0.939692621",
        "G1 Z0 F1200",
        "X9 A3=0 B3=0 C3=1",
        "TRAFOOF",
        "M5 M9",
        "SUPA G0 Z0 D0",
        "M30",
    ]


def test_an_arc_of_a_head_that_leans_stays_an_arc():
    tilt = lean(30.0)
    path = Toolpath(
        position=[np.array([0.0, 5.0, 0.0]) + 300.0 * tilt, [0.0, 5.0, 0.0], [0.0, -5.0, 0.0]],
        axis=[tilt] * 3,
        motion=[Motion.RAPID, Motion.LINE, Motion.ARC_CW],
        centre=[[np.nan] * 3, [np.nan] * 3, [0.0, 0.0, 0.0]],
        feed=[0.0, 500.0, 500.0],
        mark=[0] * 3,
    )
    assert any(line.startswith("G2 ") for line in lines_of(program(path), {"S1": standing(FORK)}))


def test_the_next_operation_goes_over_the_top_when_it_begins_in_another_direction():
    first = path_of(((0.0, 0.0, 300.0), lean(20.0)), ((0.0, 0.0, 0.0), lean(20.0)))
    second = path_of(((0.0, 0.0, 300.0), lean(20.0, 90.0)), ((0.0, 0.0, 0.0), lean(20.0, 90.0)))
    lines = lines_of(program(first, second), {"S1": standing(TABLE)})
    k = [n for n, line in enumerate(lines) if line.startswith("CYCLE800(0")][1]
    assert lines[k - 3 : k] == ["CYCLE800()", "SUPA G0 Z0 D0", "D1"]


def test_a_swivel_between_two_leans_goes_as_the_axes_of_the_machine_do():
    # An even turn between two directions 98 degrees off z, 120 degrees apart, leans by up to 105.7: more than the head does.
    paths = [
        path_of(((0.0, 0.0, 300.0), lean(98.0, turned)), ((0.0, 0.0, 0.0), lean(98.0, turned)))
        for turned in (0.0, 120.0)
    ]
    found = read_back(program(*paths), standing(HEAD_AND_TABLE))
    axes = np.vstack([p.axis for p in found])
    assert axes[:, 2].min() >= lean(98.0)[2] - 1e-6
    assert np.linalg.norm(np.diff(axes, axis=0), axis=1).max() < 0.1


@pytest.mark.parametrize("order", ["XYZ", "ZXZ"])
def test_a_plane_has_its_z_along_the_tool(order):
    degrees = TickScale(unit=1.0, decimals=7, feed_decimals=1)
    for axis in (
        lean(0.0),
        lean(90.0),
        lean(90.0, 90.0),
        lean(33.0, 217.0),
        lean(120.0, 10.0),
        -lean(0.0),
    ):
        plane = plane_across(axis, order, degrees)
        assert plane.matrix[:, 2] == approx(axis, abs=2e-9)
        assert plane.matrix.T @ plane.matrix == approx(np.eye(3), abs=1e-12)
        assert np.linalg.det(plane.matrix) == approx(1.0)


def test_helices_of_several_turns_and_radii_are_read():
    path = read("G1 Z0 F300\nX10\nG3 X-10 Z-5 I-10 J0 TURN=2\nG2 X0 Y10 CR=10").sections[0].path
    assert path.position[-4:, 2] == approx([-2.0, -4.0, -5.0, -5.0])
    assert path.centre[-1] == approx([0.0, 0.0, -5.0])


def test_a_shop_may_have_its_tools_called_by_name():
    dialect = SinumerikDialect()
    dialect.words = replace(dialect.words, tool_change=("SUPA G0 Z0 D0", 'T="{name}" M6'))
    text = dialect.write([program_1()], HEADER, PostSettings())
    assert 'T="flat 16" M6' in text
    (found,) = dialect.read(text, (FLAT_16, BULL_10), [S1])
    assert [s.tool.number for s in found.sections] == [1, 1, 7]


def test_a_helix_of_several_turns_is_one_block():
    # 2.5 turns about (0, 0) from (8, 0) down by 1 mm a turn, then a flat turn and a half more.
    ends = [(8.0, -1.0), (8.0, -2.0), (-8.0, -2.5), (-8.0, -2.5), (8.0, -2.5)]
    n = len(ends)
    path = Toolpath(
        position=[
            (8.0, 0.0, 50.0),
            (8.0, 0.0, 0.0),
            *((x, 0.0, z) for x, z in ends),
            (8.0, 0.0, 50.0),
        ],
        axis=[[0.0, 0.0, 1.0]] * (n + 3),
        motion=[Motion.RAPID, Motion.LINE, *[Motion.ARC_CCW] * n, Motion.RAPID],
        centre=[[np.nan] * 3] * 2 + [[0.0, 0.0, 0.0]] * n + [[np.nan] * 3],
        feed=[0.0, 500.0, *[800.0] * n, 0.0],
        mark=[0] * (n + 3),
    )
    made = Program(name="B1.S1", setup=S1, sections=(section("bore", FLAT_16, path),))
    arcs = [line for line in lines_of(made) if "J0" in line]
    assert arcs == ["G3 X-8 Y0 Z-2.5 I-8 J0 F800 TURN=2", "X8 Y0 I8 J0 TURN=1"]
    text = SinumerikDialect().write([made], HEADER, PostSettings())
    (found,) = SinumerikDialect().read(text, (FLAT_16,), [S1])[0].sections
    assert found.path.position == approx(path.position, abs=1e-9)


def test_a_tool_may_be_called_by_its_name():
    assert [
        s.tool.number
        for s in read(
            'G1 Z1 F9\nSUPA G0 Z0 D0\nT="BULL_10_R1" M6\nM3\nG0 X0 Y0\nD1 Z50\nG1 Z2'
        ).sections
    ] == [1, 7]


@pytest.mark.parametrize(
    ("body", "message"),
    [
        (
            "G1 X1 F100 (slowly)",
            "line 6: brackets that are no call with its arguments; write comments after a semicolon",
        ),
        ("R1=5", "line 6: parameters (R1=) are not understood; write the numbers themselves"),
        (
            "X=R1",
            "line 6: X= is not followed by a number; parameters and expressions are not understood, write the number itself",
        ),
        (
            "X=IC(5)",
            "line 6: X= is not followed by a number; parameters and expressions are not understood, write the number itself",
        ),
        (
            "G1 X1 F100 R5",
            "line 6: the word R is not understood by a three-axis program; remove it",
        ),
        (
            "IF R1 > 5 GOTOF END",
            "line 6: > is not understood; a word is a letter and a number, or a name",
        ),
        (
            "GOTOF LABEL1",
            "line 6: GOTOF: programs with jumps, subprograms or variables are not understood; write the motions out",
        ),
        (
            "MYSUB(1,2)",
            "line 6: MYSUB is not understood; remove it or write what it does in known words",
        ),
        (
            "G41 G1 X1 F9",
            "line 6: G41: cutter compensation changes the path at the machine; write the tool centre's path under G40",
        ),
        ("G91", "line 6: G91: incremental moves are not understood; use G90"),
        ("G70", "line 6: G70: it leaves feeds in mm while lengths are in inches; use G700"),
        (
            "G641",
            "line 6: G641: G641 rounds corners off by values that are not in the text; use G642 and CYCLE832",
        ),
        (
            "ROT Z30",
            "line 6: ROT: ROT moves or turns the program's zero; use CYCLE800 or write the moves out",
        ),
        ("G55", "line 6: G55 is not the work offset of setup S1, G54; use that"),
        ("D2", "line 6: D2 is a cutting edge that the tool list does not have; use D1"),
        (
            'T="DRILL 5" M6',
            'line 6: T="DRILL 5" is not in the tool list; it has flat 16, bull 10 R1',
        ),
        (
            "CYCLE832(0.05,_FINISH,1)",
            "line 6: CYCLE832 leaves the path by 0.05, more than 0.02 mm; give a smaller tolerance",
        ),
        (
            "CYCLE832(0.01,_ORI_FINISH,0.8)",
            "line 6: CYCLE832 turns the tool by 0.8 degrees, more than 0.05; give a smaller tolerance",
        ),
        ("TRAORI", "line 6: TRAORI on mill-3-axis, a machine without rotary axes; remove it"),
        ("CYCLE800()", "line 6: CYCLE800 on mill-3-axis, a machine without rotary axes; remove it"),
        ("G1 F100\nG2 X2 CR=0.0001", "line 7: an arc without a radius; check its centre or CR="),
        (
            "G1 F100\nG3 X0 Y0 I5 J0 TURN=1.5",
            "line 7: TURN=1.5 must be a whole number, and not in inverse time (G93)",
        ),
        ("G1 X1 F100 TURN=2", "line 6: TURN= without an arc; remove it"),
        ("G4 S3", "line 6: a dwell of turns (G4 S) is not understood; use G4 F"),
        ("G4", "line 6: G4 without G4 F; say how many seconds"),
        (
            "SUPA G0 X0 Y0 D0",
            "line 6: of SUPA only SUPA G0 Z0 D0, straight up to the top of the machine, is understood",
        ),
        (
            "F9\nCYCLE81(5,0,2,-8) X5",
            "line 7: CYCLE81 with other words in its line; write two lines",
        ),
        (
            "F9\nCYCLE81(5,0,2)",
            "line 7: CYCLE81 needs its depth once: DP, or DPR below the reference plane",
        ),
        (
            "F9\nCYCLE81(1,0,2,-8)",
            "line 7: CYCLE81 with its retraction plane RTP below the plane where it begins to feed; check RTP",
        ),
        (
            "F9\nCYCLE81(5,0,2,3)",
            "line 7: CYCLE81 with its depth at or above the plane where it begins to feed; check RFP, SDIS and DP",
        ),
        (
            "F9\nCYCLE81(5,0,2,R1)",
            "line 7: CYCLE81: DP is R1; parameters and expressions are not understood, write the number itself",
        ),
        (
            "F9\nCYCLE81(5,0,2,-8,,0,0,1)",
            "line 7: CYCLE81 has 8 parameters, the first 5 are understood: RTP, RFP, SDIS, DP, DPR",
        ),
        (
            "F9\nCYCLE83(5,0,1,-9,,-3,,1,0,0,1,1)",
            "line 7: CYCLE83: DAM 1 is not understood; write 0",
        ),
        (
            "CYCLE84(5,0,2,-8,,,4,,1.25,0,400)",
            "line 6: CYCLE84: SDAC 4 is not understood; write 3 or 5",
        ),
        ("CYCLE81(5,0,2,-8)", "line 6: a feed move without a feed; give F"),
        (
            "F9\nMCALL CYCLE81(5,0,2,-8)\nSUPA G0 Z0 D0",
            "line 8: SUPA while CYCLE81 is in force; put MCALL first",
        ),
        ("POCKET3(1,2,3)", "line 6: POCKET3: this cycle is not understood; write the moves out"),
        (
            "/G0 X5",
            "line 6: block skip (/): whether the line runs depends on a switch; remove the / or the line",
        ),
        ("M17", "line 6: M17: a subprogram's end is not understood; end with M30"),
    ],
)
def test_what_it_does_not_understand_is_refused_in_one_line(body, message):
    assert refusal(body).startswith(message)


@pytest.mark.parametrize(
    ("start", "body", "message"),
    [
        (
            "G710 G54\nT1 M6\nS9 M3\nD1\n",
            "G0 X0 Y0",
            "line 5: it is not known where the rotary axes stand; put CYCLE800 with the plane, or TRAORI, first",
        ),
        (
            "G710 G54\nT1 M6\nS9 M3\nD1\nTRAORI\n",
            "G0 X0 Y0 Z50",
            "line 6: it is not known where the tool points; begin with a rapid that has A3= B3= C3=",
        ),
        (
            "G710 G54\nT1 M6\nS9 M3\nD1\nTRAORI\n",
            "G0 X0 Y0 A3=1",
            "line 6: it is not known where the tool is; begin with a rapid to X, Y and Z in one line",
        ),
        (
            "G710 G54\nT1 M6\nS9 M3\n",
            'CYCLE800(0,"",0,57,0,0,0,0,0,0,0,0,0,1,0,1)',
            "line 4: CYCLE800 without the tool's length; put D1 first",
        ),
        (TILTED, "A3=0 B3=0 C3=1", "line 8: A3= B3= C3= without TRAORI; put TRAORI first"),
        (
            TILTED,
            "TRAORI",
            "line 8: TRAORI in a tilted plane is not understood; put CYCLE800() first",
        ),
        (
            TILTED,
            'CYCLE800(0,"",0,57,0,0,0,0,40,0,0,0,0,1,0,1)',
            "line 8: CYCLE800 turns the tool while it is at the work; put SUPA G0 Z0 D0 first",
        ),
        (
            TILTED,
            'CYCLE800(1,"",0,57,0,0,0,0,30,0,0,0,0,1,0,1)',
            "line 8: CYCLE800: FR 1 is not understood; write 0",
        ),
        (
            TILTED,
            'CYCLE800(0,"",1,57,0,0,0,0,30,0,0,0,0,1,0,1)',
            "line 8: CYCLE800: ST 1 adds to a plane before; write 0 as its last digit",
        ),
        (
            TILTED,
            'CYCLE800(0,"",0,57,5,0,0,0,30,0,0,0,0,1,0,1)',
            "line 8: CYCLE800: X0 5 is not understood; write 0",
        ),
        (
            TILTED,
            'CYCLE800(0,"",0,192,0,0,0,0,30,0,0,0,0,1,0,1)',
            "line 8: CYCLE800: MODE 192 is not understood; write 57 or ",
        ),
        (
            TILTED,
            "G0 A5 C0",
            "line 8: A and C are understood in a rapid of their own at the top of the machine",
        ),
        (TILTED, "CYCLE800()\nG0 X5", "line 9: it is not known where the rotary axes stand"),
        (
            TIP,
            "G1 X5 F9 A3=0 B3=0 C3=0",
            "line 8: A3= B3= C3= is no direction; give a vector of length 1",
        ),
        (
            TIP,
            "G1 X5 F9 A3=0 B3=0 C3=-1",
            "line 8: the tool turns straight back in one block; write several",
        ),
        (
            TIP,
            "G1 X5 F9 A3=1\nG2 X9 I2 J0",
            "line 9: an arc of a tool that leans or turns is not understood; write lines, or use CYCLE800",
        ),
        (TIP, "SUPA G0 Z0 D0", "line 8: SUPA under TRAORI is not understood; put TRAFOOF first"),
        (TIP, "CYCLE800()", "line 8: CYCLE800 under TRAORI is not understood; put TRAFOOF first"),
        (TIP, "TRAFOOF\nG0 X5", "line 9: it is not known where the rotary axes stand"),
        (TIP, "ORIAXES", "line 8: ORIAXES: the tool axis turns another way; use ORIWKS ORIVECT"),
        (
            TIP,
            "G1 X5 A3=1 F9\nCYCLE81(90,60,2,50)",
            "line 9: CYCLE81 while the work turns, in inverse time or with a leaning tool",
        ),
    ],
)
def test_what_it_does_not_understand_of_five_axes_is_refused_in_one_line(start, body, message):
    assert refusal(body, start, standing(TABLE)).startswith(message)


def test_a_leaning_plane_is_read_whatever_the_order_of_its_turns():
    # 39 turns about Z, X, Y: 90 about Z takes x to y; then 30 about the new X, the old y, leans the tool towards x.
    text = 'G710 G54\nT1 M6\nS9 M3\nD1\nCYCLE800(0,"",0,39,0,0,0,90,30,0,0,0,0,1,0,1)\nG0 X0 Y0\nZ300\n'
    path = read("G1 Z0 F9", text, standing(TABLE)).sections[0].path
    assert path.axis[-1] == approx([0.5, 0.0, np.sqrt(0.75)])


def test_inverse_time_is_read_under_traori():
    path = read("G93 G1 X20 A3=0 B3=0 C3=1 F4", TIP, standing(TABLE)).sections[0].path
    assert path.feed[-1] == approx(80.0)


def test_upright_programs_on_a_machine_with_rotary_axes_are_those_of_three_axes():
    lines = lines_of(program_1(), {"S1": standing(TABLE)})
    level = 'CYCLE800(0,"",200000,57,0,0,0,0,0,0,0,0,0,-1,0,1)'
    assert lines.count(level) == len(program_1().sections)
    tapping = replace(program_1(), sections=program_1().sections[:1])
    bare = [
        line for line in lines_of(tapping, {"S1": standing(TABLE)}) if line not in (level, "D1")
    ]
    assert [line.replace(" D1", "") for line in lines_of(tapping)] == bare
