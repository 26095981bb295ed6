"""Klartext word by word: what is written for each cycle and each way to hold the tool, what is read, what is refused in one line."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from pytest import approx

from leaning_paths import HEADER, TABLE, lean, path_of, program, standing
from programs import BULL_10, CCW, CW, FLAT_16, LINE, RAPID, S1, program_1, section, verdict
from programs import path_of as flat_path
from random_programs import cycle
from trunnion.findings import BadInput, Refused
from trunnion.model.motion.cycle import CycleKind
from trunnion.model.motion.drilling import drilled
from trunnion.model.motion.program import Program
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.model.spindle import FeedMode
from trunnion.post.dialects.heidenhain import HeidenhainDialect
from trunnion.post.header import STAMP_LINES, units_of
from trunnion.post.release import is_released
from trunnion.post.settings import PostSettings

PLACES = {"S1": standing(TABLE)}
START = """BEGIN PGM A MM
CYCL DEF 247 DATUM SETTING Q339=+1
TOOL CALL 1 Z S400
M3
L X+0 Y+0 FMAX
L Z+50 FMAX
"""
LINES = START.count("\n")
TIP = """BEGIN PGM A MM
CYCL DEF 247 DATUM SETTING Q339=+1
TOOL CALL 1 Z S400 F300
M3
FUNCTION TCPM F TCP AXIS SPAT PATHCTRL VECTOR
LN X+0 Y+0 Z+50 TX+0 TY+0 TZ+1 FMAX
"""
PLANE = """BEGIN PGM A MM
CYCL DEF 247 DATUM SETTING Q339=+1
TOOL CALL 1 Z S400 F300
M3
PLANE SPATIAL SPA+30 SPB+0 SPC+0 TURN FMAX SEQ- TABLE ROT
L X+0 Y+0 Z+300 FMAX
"""
DRILL = "Q200=+2 Q201=-8 Q206=+200 Q202=+8 Q203=+0 Q204=+10"


def lines_of(made: Program, places=None, **chosen) -> list[str]:
    """Return the blocks of a program, each with the lines it goes on in, without numbers and comments."""
    text = HeidenhainDialect().write([made], HEADER, PostSettings(**chosen), places or {})
    blocks = text.replace("~\n    ", "").splitlines()
    return [line.partition(" ")[2] for line in blocks if not line.partition(" ")[2].startswith(";")]


def one(*blocks, spindle=400.0, **changes) -> Program:
    made = replace(section("op", FLAT_16, flat_path(*blocks), spindle), **changes)
    return Program(name="B1.S1", setup=S1, sections=(made,))


def holes(kind: CycleKind, lift: float = 0.0) -> Program:
    """Return a program of two holes 7 mm deep from Z2, fed at 480 mm/min, 384 1/min: 1.25 mm a revolution."""
    tops = np.array([[10.0, 5.0, 2.0], [30.0, 5.0, 2.0]])
    path = drilled(np.array([0.0, 0.0, 50.0]), tops, cycle(kind, lift=lift), 480.0)
    return Program(name="B1.S1", setup=S1, sections=(section("holes", FLAT_16, path, 384.0),))


def read(body: str, start: str = START, places=None) -> Program:
    text = f"{start}{body}\nM30\nEND PGM A {start.split()[3]}\n"
    (found,) = HeidenhainDialect().read(text, (FLAT_16, BULL_10), [S1], places or {})
    return found


def moves(body: str, start: str = START, places=None) -> list[tuple]:
    """Return what a text does after its start, as (F or R, x, y, z)."""
    path = read(body, start, places).sections[0].path
    return [
        ("R" if motion == RAPID else "F", *np.round(at, 4).tolist())
        for motion, at in zip(path.motion[1:], path.position[1:], strict=True)
    ]


def refusal(body: str, start: str = START, places=None) -> str:
    with pytest.raises(BadInput) as refused:
        read(body, start, places)
    return str(refused.value)


@pytest.mark.parametrize(
    ("kind", "words"),
    [
        (
            CycleKind.DRILL,
            "200 Q200=+0.0 Q201=-7.0 Q206=+480 Q202=+7.0 Q210=+0.0 Q203=+2.0 Q204=+0.0 Q211=+0.0 Q395=+0",
        ),
        (
            CycleKind.DWELL,
            "200 Q200=+0.0 Q201=-7.0 Q206=+480 Q202=+7.0 Q210=+0.0 Q203=+2.0 Q204=+0.0 Q211=+0.5 Q395=+0",
        ),
        (
            CycleKind.PECK,
            "205 Q200=+0.0 Q201=-7.0 Q206=+480 Q202=+3.0 Q203=+2.0 Q204=+0.0 Q212=+0.0 Q205=+0.0 Q258=+0.254 Q259=+0.254 "
            "Q257=+0.0 Q256=+0.254 Q211=+0.0 Q379=+0.0 Q253=+750 Q208=+99999 Q395=+0",
        ),
        (
            CycleKind.CHIP_BREAK,
            "203 Q200=+0.0 Q201=-7.0 Q206=+480 Q202=+3.0 Q210=+0.0 Q203=+2.0 Q204=+0.0 Q212=+0.0 Q213=+3 Q205=+0.0 Q211=+0.0 "
            "Q208=+99999 Q256=+0.254 Q395=+0",
        ),
        (
            CycleKind.REAM,
            "201 Q200=+0.0 Q201=-7.0 Q206=+480 Q211=+0.0 Q208=+480 Q203=+2.0 Q204=+0.0",
        ),
        (
            CycleKind.BORE,
            "201 Q200=+0.0 Q201=-7.0 Q206=+480 Q211=+0.5 Q208=+480 Q203=+2.0 Q204=+0.0",
        ),
        (CycleKind.TAP, "207 Q200=+0.0 Q201=-7.0 Q239=+1.25 Q203=+2.0 Q204=+0.0"),
    ],
)
def test_a_cycle_is_defined_once_and_called_at_each_hole(kind, words):
    lines = lines_of(holes(kind))
    k = next(n for n, line in enumerate(lines) if line.startswith(f"CYCL DEF {words[:3]}"))
    assert [w for w in lines[k].split() if w.startswith("Q")] == words.split()[1:]
    assert lines[k + 1 : k + 3] == ["L X+10.0 Y+5.0 R0 FMAX M99", "L X+30.0 Y+5.0 R0 FMAX M99"]


def test_a_cycle_that_ends_above_its_plane_goes_to_its_second_clearance():
    assert any("Q204=+48.0" in line for line in lines_of(holes(CycleKind.DRILL, lift=48.0)))


def test_boring_that_goes_out_further_at_the_feed_is_written_out():
    assert not any("CYCL DEF 201" in line for line in lines_of(holes(CycleKind.BORE, lift=48.0)))


def test_blocks_are_numbered_one_by_one_from_the_first_to_the_last():
    text = HeidenhainDialect().write([holes(CycleKind.PECK)], HEADER, PostSettings())
    blocks = text.replace("~\n", "").splitlines()
    assert [line.split()[0] for line in blocks] == [str(n) for n in range(len(blocks))]
    assert blocks[0] == "0 BEGIN PGM S1 MM" and blocks[-1].endswith("END PGM S1 MM")
    restart = next(line for line in blocks if "RESTART POINT" in line)
    k = int(restart.split("BLOCK ")[1].split()[0])
    assert blocks[k] == f"{k} M5 M9"


def test_a_comment_can_not_join_the_next_line():
    header = replace(HEADER, part="panel~")
    text = HeidenhainDialect().write([holes(CycleKind.DRILL)], header, PostSettings())
    assert "; PART panel- SHA256" in text


def test_the_stamp_has_the_unit_of_the_text_and_releases_it():
    dialect, passed = HeidenhainDialect(), replace(HEADER, verdict=verdict())
    text = dialect.write([program_1()], passed, PostSettings(units="inch"))
    lines = text.split("\n")
    assert units_of(lines) == "inch" and is_released(text)
    stamp = dialect.stamp("other.S1", replace(passed, units=units_of(lines)))
    assert list(stamp) == lines[:STAMP_LINES] and lines[0] == "0 BEGIN PGM S1 INCH"


def test_feeds_in_inches_are_in_tenths_of_an_inch():
    made = one((RAPID, 0, 0, 50), (LINE, 0, 0, 0, 254.0), (RAPID, 0, 0, 50))
    assert "L Z+0.0 R0 F100" in lines_of(made, units="inch")
    assert "L Z+0.0 R0 F254" in lines_of(made)
    start = START.replace("MM", "INCH").replace("Z+50", "Z+2")
    path = read("L Z+0 F100\nL Z+2 FMAX", start).sections[0].path
    assert path.feed.max() == approx(254.0) and path.position[:, 2].max() == approx(50.8)


@pytest.mark.parametrize("offset", ["G54", "G56", "G59.3"])
def test_a_work_offset_is_a_preset(offset):
    made = replace(holes(CycleKind.DRILL), setup=replace(S1, work_offset=offset))
    number = {"G54": 1, "G56": 3, "G59.3": 9}[offset]
    assert f"CYCL DEF 247 DATUM SETTING Q339=+{number} ;DATUM NUMBER" in lines_of(made)


def test_arcs_are_by_their_centre_and_whole_circles_by_their_angle():
    made = one(
        (RAPID, 0, 0, 50),
        (LINE, 0, 0, -1, 300.0),
        (CCW, 10, 10, -1, 0, 10, 300.0),
        (CW, 10, 10, -1, 5, 10, 300.0),
        (RAPID, 10, 10, 50),
    )
    lines = lines_of(made)
    k = lines.index("CC X+0.0 Y+10.0")
    assert lines[k + 1 : k + 4] == [
        "C X+10.0 Y+10.0 DR+ R0",
        "CC X+5.0 Y+10.0",
        "CP IPA-360.0 DR- R0",
    ]


def helix(turns: int, last: float = math.tau, radius: float = 5.0) -> Program:
    """Return a program of a helix anticlockwise about the origin, 1 mm a turn."""
    blocks = [(RAPID, radius, 0, 50), (LINE, radius, 0, 0, 300.0)]
    blocks += [(CCW, radius, 0, -k, 0, 0, 300.0) for k in range(1, turns + 1)]
    x, y, z = radius * math.cos(last), radius * math.sin(last), -turns - last / math.tau
    blocks += [(CCW, x, y, z, 0, 0, 300.0), (RAPID, x, y, 50)]
    return one(*blocks)


def test_a_helix_of_several_turns_is_one_block():
    lines = lines_of(helix(3, math.pi / 2))
    assert "CP IPA+1170.0 IZ-3.25 DR+ R0" in lines
    # It ends where its angle says: the next block gives both again.
    assert lines[lines.index("CP IPA+1170.0 IZ-3.25 DR+ R0") + 1] == "L X+0.0 Y+5.0 Z+50.0 R0 FMAX"


def test_a_helix_of_more_turns_than_a_block_takes_is_several():
    angles = [line.split()[1] for line in lines_of(helix(31)) if line.startswith("CP")]
    assert angles == ["IPA+5400.0", "IPA+5400.0", "IPA+720.0"]


def test_parts_of_turns_that_climb_evenly_are_one_block():
    halves = [(CCW, (-1) ** k * 5.0, 0, -0.5 * k, 0, 0, 300.0) for k in range(1, 6)]
    blocks = [(RAPID, 5, 0, 50), (LINE, 5, 0, 0, 300.0), *halves, (RAPID, -5, 0, 50)]
    assert "CP IPA+900.0 IZ-2.5 DR+ R0" in lines_of(one(*blocks))
    steeper = (CCW, 5, 0, -3.5, 0, 0, 300.0)
    lines = lines_of(one(*blocks[:-1], steeper, (RAPID, 5, 0, 50)))
    k = lines.index("CP IPA+900.0 IZ-2.5 DR+ R0")
    assert lines[k + 1] == "CP IPA+180.0 IZ-1.0 DR+ R0"


def test_arcs_about_one_centre_that_do_not_climb_stay_arcs():
    halves = [(CCW, (-1) ** k * 5.0, 0, 0, 0, 0, 300.0) for k in (1, 2)]
    lines = lines_of(one((RAPID, 5, 0, 50), (LINE, 5, 0, 0, 300.0), *halves, (RAPID, 5, 0, 50)))
    k = lines.index("C X-5.0 Y+0.0 DR+ R0")
    assert lines[k + 1] == "C X+5.0 Y+0.0 DR+ R0"


def test_a_centre_is_said_where_it_changes_and_after_a_rapid():
    quarter = [(CCW, 0, 5, 0, 0, 0, 300.0), (CCW, -5, 0, 0, 0, 0, 300.0)]
    away = [(RAPID, -5, 0, 9), (LINE, -5, 0, 0, 300.0), (CCW, 0, -5, 0, 0, 0, 300.0)]
    blocks = [(RAPID, 5, 0, 50), (LINE, 5, 0, 0, 300.0), *quarter, *away, (RAPID, 0, -5, 50)]
    assert lines_of(one(*blocks)).count("CC X+0.0 Y+0.0") == 2


def test_helices_in_a_row_do_not_lead_the_tool_astray():
    # Quarters to and fro whose radii are rounded differently: each leads a little beside, never more than two units of the last decimal.
    blocks, at, z = [(RAPID, 0, 0, 50), (LINE, 0, 0, 0, 300.0)], np.zeros(2), 0.0
    rng = np.random.default_rng(7)
    for _ in range(60):
        first, turn, radius = (
            rng.uniform(0, math.tau),
            rng.uniform(0.3, 5.0),
            rng.uniform(1.0, 40.0),
        )
        centre = at - radius * np.array([math.cos(first), math.sin(first)])
        at = centre + radius * np.array([math.cos(first + turn), math.sin(first + turn)])
        z -= 0.01
        blocks.append((CCW, *at.tolist(), z, *centre.tolist(), 300.0))
    made = one(*blocks, (RAPID, *at.tolist(), 50.0))
    (found,) = HeidenhainDialect().read(
        HeidenhainDialect().write([made], HEADER, PostSettings(decimals=3)), (FLAT_16,), [S1]
    )
    ends = found.sections[0].path.position
    for end in made.sections[0].path.position:
        assert np.linalg.norm(ends - end, axis=1).min() <= 2e-3 + 1e-3


def test_the_speed_is_said_anew_only_where_it_changes():
    path = flat_path((RAPID, 0, 0, 50), (LINE, 0, 0, 0, 300.0), (RAPID, 0, 0, 50))
    parts = [section(f"op-{n}", FLAT_16, path, s) for n, s in enumerate((400.0, 400.0, 500.0))]
    lines = lines_of(Program(name="B1.S1", setup=S1, sections=tuple(parts)))
    assert [line for line in lines if line.startswith("TOOL CALL")] == [
        "TOOL CALL 1 Z S400",
        "TOOL CALL S500",
    ]


def test_dwells_are_the_older_cycle():
    path = flat_path((RAPID, 0, 0, 50), (LINE, 0, 0, 0, 300.0), (RAPID, 0, 0, 50))
    waits = section("op", FLAT_16, replace(path, dwell=np.array([0.0, 1.25, 0.0])), 400.0)
    lines = lines_of(Program(name="B1.S1", setup=S1, sections=(waits,)))
    k = lines.index("CYCL DEF 9.0 DWELL TIME")
    assert lines[k + 1] == "CYCL DEF 9.1 DWELL 1.25"


def test_feeds_by_the_revolution_are_written_by_the_minute():
    path = ((RAPID, 0, 0, 50), (LINE, 0, 0, 0, 300.0), (RAPID, 0, 0, 50))
    assert "L Z+0.0 R0 F300" in lines_of(one(*path, feed_mode=FeedMode.REVOLUTION))


def turning() -> Toolpath:
    return path_of(
        ((0.0, 0.0, 300.0), lean(20.0)), ((0.0, 0.0, 0.0), lean(20.0)), ((9.0, 0.0, 0.0), lean(0.0))
    )


def test_a_tool_that_turns_is_followed_by_vectors():
    lines = lines_of(program(turning()), PLACES)
    k = lines.index("FUNCTION TCPM F TCP AXIS SPAT PATHCTRL VECTOR")
    assert lines[k - 1] in ("L A-20.0 C-90.0 R0 FMAX", "L A+20.0 C+90.0 R0 FMAX")
    assert lines[k + 1 : k + 5] == [
        "LN X+0.0 Y+0.0 Z+300.0 TX+0.34202014 TY+0.0 TZ+0.93969262 R0 FMAX",
        "LN X+0.0 Y+0.0 Z+0.0 TX+0.34202014 TY+0.0 TZ+0.93969262 R0 F1200",
        "LN X+9.0 Y+0.0 Z+0.0 TX+0.0 TY+0.0 TZ+1.0 R0",
        "FUNCTION RESET TCPM",
    ]


def test_tip_control_ends_before_a_new_speed_and_goes_on_without_a_move():
    made = program(turning(), path_of(((9.0, 0.0, 0.0), lean(0.0)), ((9.0, 5.0, 0.0), lean(10.0))))
    faster = replace(made.sections[1], spindle=9500.0)
    lines = lines_of(replace(made, sections=(made.sections[0], faster)), PLACES)
    k = lines.index("TOOL CALL S9500")
    assert lines[k - 1] == "FUNCTION RESET TCPM"
    after = lines[k + 1 : lines.index("FUNCTION TCPM F TCP AXIS SPAT PATHCTRL VECTOR", k)]
    assert after == ["M3", "M8"]


def test_a_direction_that_stays_is_a_plane():
    path = path_of(((0.0, 0.0, 300.0), lean(30.0, 90.0)), ((0.0, 0.0, 0.0), lean(30.0, 90.0)))
    lines = lines_of(program(path), PLACES)
    # Towards +y: 30 degrees about x, backwards, lean z towards +y.
    assert any(
        line.startswith("PLANE SPATIAL SPA-30.0 SPB+0.0 SPC+0.0 TURN FMAX SEQ") for line in lines
    )
    assert lines[lines.index("M30") - 3] == "PLANE RESET STAY"


def test_an_upright_tool_says_no_side():
    path = path_of(((0.0, 0.0, 300.0), lean(0.0)), ((0.0, 0.0, 0.0), lean(0.0)))
    assert "PLANE SPATIAL SPA+0.0 SPB+0.0 SPC+0.0 TURN FMAX TABLE ROT" in lines_of(
        program(path), PLACES
    )


def test_spatial_angles_are_about_z_the_new_y_and_the_new_x():
    # 90 about Z takes x to y; 30 about the new X, the old y, leans the tool from z towards x.
    start = PLANE.replace("SPA+30 SPB+0 SPC+0", "SPA+30 SPB+0 SPC+90")
    path = read("L Z+0 F9", start, PLACES).sections[0].path
    assert path.axis[-1] == approx([0.5, 0.0, math.sqrt(0.75)])
    start = PLANE.replace("SPA+30 SPB+0 SPC+0", "SPA+0 SPB+30 SPC+90")
    assert read("L Z+0 F9", start, PLACES).sections[0].path.axis[-1] == approx(
        [0.0, 0.5, math.sqrt(0.75)]
    )


def test_functions_in_a_block_work_before_or_after_its_move():
    path = read("L Z+0 F100 M8\nL X+5 M9\nL X+9\nL Z+50 FMAX").sections
    assert [s.coolant for s in path] == ["flood", "off"]
    assert "the spindle stands" in refusal("L Z+0 F100 M5\nL X+5")
    assert read("M5\nL Z+0 F100 M3").sections[0].path.feed.max() == 100.0


def test_a_rapid_leaves_the_feed_as_it_was():
    path = read("L Z+0 F100\nL Z+5 FMAX\nL Z+1").sections[0].path
    assert path.feed[path.motion == Motion.LINE].tolist() == [100.0, 100.0]


def test_a_whole_turn_of_a_helix_ends_where_it_began():
    path = read("CC X-5 Y+0\nCP IPA+720 IZ-2 DR+ F100").sections[0].path
    assert path.position[-2].tolist() == [0.0, 0.0, 49.0]
    assert path.position[-1].tolist() == [0.0, 0.0, 48.0]


def test_a_cycle_in_a_tilted_plane_goes_along_its_z():
    path = read(f"CYCL DEF 200 {DRILL}\nL X+0 Y+0 FMAX M99", PLANE, PLACES).sections[0].path
    bottom = path.position[path.motion == Motion.LINE][-1]
    assert bottom == approx(-8.0 * np.array([0.0, -0.5, math.sqrt(0.75)]))


@pytest.mark.parametrize(
    ("body", "message"),
    [
        ("L IX+5 FMAX", "IX+5: incremental moves are not understood; write absolute positions"),
        ("L X+5 RL F9", "RL: radius compensation changes the path at the machine"),
        ("L X+Q5 F9", "X+Q5: parameters are not understood; write the numbers themselves"),
        ("Q5 = +9", "Q5: parameters are not understood"),
        ("FN 0: Q1 = +5", "FN: parameters are not understood"),
        ("LBL 1", "LBL: labels, subprograms and repeats are not understood"),
        ("CALL LBL 1 REP 5", "CALL: labels, subprograms and repeats are not understood"),
        ("APPR LCT X+1 Y+1 R2 RL F9", "APPR: approach and departure with radius compensation"),
        ("FL X+1", "FL: free contour programming (FK) is not understood; write the moves out"),
        ("RND R2", "RND: chamfers and roundings of corners are not understood"),
        ("CR X+5 Y+5 R+5 DR+", "CR: this arc is not understood; use CC and C"),
        ("LP PR+5 PA+10 F9", "LP: polar positions are not understood; write X and Y"),
        ("L X+5 FU0.1", "FU0.1: FU0.1 is no feed by the minute; write F"),
        ("L X+5 FMAX F9", "F and FMAX in one block; keep one"),
        ("L X+5 X+6 FMAX", "two X words; keep one"),
        ("L X+5", "a feed move without a feed; give F or FMAX"),
        ("L X+5 TX+1 FMAX", "TX+1 is not understood in this block; known are X, Y, Z, A, B, C"),
        ("L FMAX", "a move to nowhere; give X, Y or Z"),
        ("L X+5 F9 M128", "M128: use FUNCTION TCPM F TCP AXIS SPAT PATHCTRL VECTOR"),
        ("L X+5 F9 M4", "M4: it turns the cutter backwards; use M3"),
        ("M13", "M13: write M3 and M8"),
        ("M77", "M77 is not understood; remove it"),
        ("M99", "M99 without L is not understood; remove it"),
        ("L X+5 FMAX M99", "a cycle is called, and none is defined; put CYCL DEF first"),
        ("L Z+5 FMAX M91", "of M91 only L Z+0.0 R0 FMAX M91"),
        ("C X+5 Y+5 DR+ F9", "C without a centre; put CC first"),
        ("CC X+5 Y+0\nC X+10 Y+0 F9", "C needs DR+ or DR-, and no FMAX"),
        ("CC X+5 Y+0\nC X+10 Y+0 Z+1 DR+ F9", "C needs X or Y, and climbs not"),
        ("CC X+5 Y+0\nC X+11 Y+0 DR+ F9", "the arc starts at radius 5.0000 and ends at 6.0000 mm"),
        (
            "CC X+5 Y+0\nCP IPA+90 DR- F9",
            "CP needs IPA, the angle it turns by, with the sign of DR",
        ),
        ("CC X+5 Y+0\nCP IPA+9000 DR+ F9", "IPA9000 is out of range; allowed is -5400 to 5400"),
        ("CC X+5", "CC needs X and Y, and nothing else"),
        ("TOOL CALL 9 Z S100", "tool 9 is not in the tool list; it has 1, 7"),
        ("TOOL CALL 1 S100", "TOOL CALL needs Z after the tool's number, its axis"),
        ("TOOL CALL 1 Z S100 DL+0.5", "DL+0.5 is not understood in TOOL CALL"),
        ("CYCL DEF 247 DATUM SETTING Q339=+2", "cycle 247 must set the preset of setup S1: G54"),
        ("CYCL DEF 7.0 DATUM SHIFT", "CYCL DEF 7.0 is not understood; write the moves out"),
        ("CYCL DEF 202 BORING Q200=2", "CYCL DEF 202 is not understood, known are 200, 201, 203"),
        ("CYCL DEF 9.0 DWELL TIME\nL X+5 FMAX", "CYCL DEF 9.1 must come here"),
        ("CYCL DEF 32.0 TOLERANCE\nCYCL DEF 32.1 T0.1", "cycle 32 with T0.1 rounds corners off"),
        ("CYCL DEF 200 Q200=+2 Q201=-8", "cycle 200 needs Q203"),
        (f"CYCL DEF 200 {DRILL} Q240=+1", "cycle 200 has no Q240; remove it"),
        (f"CYCL DEF 200 {DRILL} Q395=+1", "cycle 200 with Q395 other than 0 is not understood"),
        (
            f"CYCL DEF 200 {DRILL}".replace("-8", "+8"),
            "cycle 200 with its bottom at or above the surface",
        ),
        ("PLANE RESET TURN FMAX", "PLANE on mill-3-axis, a machine without rotary axes; remove it"),
        ("BEGIN PGM B MM", "a program begins with BEGIN PGM, its name, and MM or INCH, once"),
        ("M30\nL X+5 FMAX", "stands after the end of the program; remove it"),
        ("END PGM B MM", "the program ends with END PGM A MM"),
        ("CC X-5 Y+0\nCP IPA+360.000001 DR+ F9", "the arc ends "),
        ("CC X+0 Y+0\nCP IPA+90 DR+ F9", "an arc without a radius; check its centre or CC"),
        (
            "CYCL DEF 32.2 HSC-MODE:0 TA0.1",
            "cycle 32 with TA0.1 lets the tool lean by more than 0.05",
        ),
        (
            "TOOL CALL 7 Z S500\nL X+0 Y+0 Z+5 FMAX\nL Z+0 F9",
            "a feed move while the spindle stands; give S in TOOL CALL, and M3, first",
        ),
        ("5 L X+5 FMAX\n5 L X+6 FMAX", "block 5 comes after block 5: blocks are out of order"),
        ("5 L X+5 FMAX\n4 L X+6 FMAX", "block 4 comes after block 5: blocks are out of order"),
    ],
)
def test_what_it_does_not_understand_is_refused_in_one_line(body, message):
    line = LINES + 1 + body.count("\n")
    assert refusal(body).startswith(f"line {line}: {message}")


@pytest.mark.parametrize(
    ("start", "body", "message"),
    [
        (TIP, "L Z+0 R0 FMAX M91", "M91 under tip control is not understood"),
        (TIP, "TOOL CALL S500", "TOOL CALL under tip control is not understood"),
        (TIP, "PLANE SPATIAL SPA+1 SPB+0 SPC+0 TURN FMAX TABLE ROT", "PLANE under tip control"),
        (TIP, "LN X+5 Y+0 Z+0 TX+0 TY+0 TZ-1", "the tool turns straight back in one block"),
        (TIP, "LN X+5 Y+0 Z+0 TX+0 TY+0", "LN needs TX TY TZ"),
        (TIP, "LN X+5 Y+0 Z+0 TX+0 TY+0 TZ+0", "TX TY TZ is no direction; give a vector"),
        (TIP, "L A+5 C+0 FMAX", "A and C are understood in a rapid of their own at the top"),
        (TIP, f"CYCL DEF 200 {DRILL}\nL X+1 FMAX M99", "a cycle under tip control"),
        (TIP, "FUNCTION RESET TCPM\nL X+5", "it is not known where the rotary axes stand"),
        (
            TIP,
            "LN X+5 Y+0 Z+0 TX+1 TY+0 TZ+1\nCC X+0 Y+0\nC X+5 Y+0 DR+",
            "an arc of a tool that leans is not understood",
        ),
        (TIP, "FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS", "this FUNCTION is not understood"),
        (PLANE, "LN X+5 Y+0 Z+0 TX+0 TY+0 TZ+1", "TX TY TZ without tip control; put FUNCTION TCPM"),
        (PLANE, "L Z+0 R0 FMAX M91", "M91 in a tilted plane is not understood; put PLANE RESET"),
        (PLANE, "FUNCTION TCPM F TCP AXIS SPAT PATHCTRL VECTOR", "FUNCTION TCPM in a tilted plane"),
        (
            PLANE,
            "PLANE SPATIAL SPA+5 SPB+0 SPC+0 TURN FMAX TABLE ROT",
            "PLANE SPATIAL turns the tool while it is at the work; put L Z+0.0 R0 FMAX M91 first",
        ),
        (
            PLANE,
            "PLANE SPATIAL SPA+30 SPB+0 SPC+0 MOVE DIST50 F9 TABLE ROT",
            "of PLANE SPATIAL only TURN FMAX, SEQ or SYM, and TABLE ROT are understood",
        ),
        (PLANE, "PLANE SPATIAL SPA+30 SPC+0 TURN FMAX TABLE ROT", "PLANE SPATIAL needs SPA, SPB"),
        (PLANE, "PLANE EULER EULPR0 EULNU30 EULROT0 TURN FMAX", "this PLANE is not understood"),
        (PLANE, "TOOL CALL 1 Z S400\nL A+5 C+0 FMAX", "A and C are understood in a rapid"),
        (
            PLANE,
            f"CC X+5 Y+0\n{PLANE.splitlines()[4]}\nC X+10 Y+0 DR+",
            "C without a centre; put CC first",
        ),
        (PLANE, "PLANE RESET STAY\nL X+5", "it is not known where the rotary axes stand"),
    ],
)
def test_what_it_does_not_understand_of_five_axes_is_refused_in_one_line(start, body, message):
    line = start.count("\n") + 1 + body.count("\n")
    assert refusal(body, start, PLACES).startswith(f"line {line}: {message}")


def test_a_block_that_goes_on_at_the_end_is_refused():
    text = START + "CYCL DEF 200 DRILLING ~"
    with pytest.raises(BadInput, match=r"line 7: a block that goes on \(~\) after the last line"):
        HeidenhainDialect().read(text, (FLAT_16,), [S1])


def test_a_text_without_its_last_block_is_refused():
    with pytest.raises(BadInput, match=r"the program has no end \(END PGM\)"):
        HeidenhainDialect().read(START + "M30\n", (FLAT_16,), [S1])


def test_a_preset_that_the_control_has_not_is_refused():
    made = replace(holes(CycleKind.DRILL), setup=replace(S1, work_offset="G505"))
    with pytest.raises(Refused, match="Heidenhain TNC 640 has no work offset G505"):
        lines_of(made)
