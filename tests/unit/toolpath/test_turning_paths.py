"""Turning work: its paths, what posts write of it, and operations that hold turning tools."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from lxml import etree
from pytest import approx

import programs
from leaning_paths import TABLE, standing
from programs import (
    CCW,
    FACING,
    FLAT_16,
    LINE,
    RAPID,
    S1,
    TURNING,
    WALL,
    process_tree,
    section,
    session,
    turned_path,
)
from random_programs import cycle
from trunnion.findings import BadInput, Refused
from trunnion.model.motion.cycle import CycleKind
from trunnion.model.motion.drilling import drilled
from trunnion.model.motion.listing import listing
from trunnion.model.motion.program import Program, section_of
from trunnion.model.motion.toolpath import Toolpath
from trunnion.model.session import Session
from trunnion.model.spindle import FeedMode, SpindleMode
from trunnion.post.dialects.linuxcnc import LinuxCncDialect
from trunnion.post.header import Header
from trunnion.post.readers.linuxcnc import read_linuxcnc
from trunnion.post.settings import PostSettings
from trunnion.shop import load_shop
from trunnion.shop.kinematics import NO_WORK_POSITIONS
from trunnion.store.mapping import Members, from_xml, to_xml
from trunnion.store.process import write_process
from trunnion.verify.motion import moves_of
from verify_tools import program_section, proof

HEADER = Header(name="B1", part="B1", part_digest="ab12", plan_digest="cd34")
FACE = section("face", TURNING, FACING, 900.0)
START = "G21 G90 G54 G18 G7\nT3 M6\nS400 M3\nG0 X100\nG0 G43 H3 Z50\n"


def program(*sections) -> Program:
    return Program(name="B1.S1", setup=S1, sections=sections)


def text_of(made: Program, places=NO_WORK_POSITIONS) -> str:
    return LinuxCncDialect().write([made], HEADER, PostSettings(), places)


def words_of(made: Program) -> list[str]:
    return [line.split(" ", 1)[1] for line in text_of(made).split("\n") if line.startswith("N")]


def read(body: str, start: str = START):
    return read_linuxcnc(f"{start}{body}\nM30\n", (TURNING, FLAT_16), S1).sections[0].path


def turning_operation(**changes):
    """Return an operation with a turning tool that keeps its surface speed."""
    first = process_tree().operations[0]
    data = replace(
        first.data,
        spindle_mode=SpindleMode.SURFACE,
        highest_spindle=2500.0,
        feed_mode=FeedMode.REVOLUTION,
    )
    return replace(first, id="turn-01", strategy="turn.face", tool=TURNING, data=data, **changes)


def test_arcs_of_turning_go_about_the_axis_across_its_plane():
    # From z to x is anticlockwise about +y: a quarter about (0, 0) with radius 5.
    path = turned_path((RAPID, 0.0, 5.0), (CCW, 5.0, 0.0, 0.0, 0.0, 100.0))
    assert path.sweeps()[1] == approx(math.pi / 2)
    assert path.lengths()[1] == approx(2.5 * math.pi)


@pytest.mark.parametrize(
    "changes",
    [
        {"position": FACING.position + [0.0, 0.1, 0.0]},
        {"axis": np.tile([0.0, 0.0, 1.0], (len(FACING), 1))},
        {"axis": -FACING.axis},
    ],
)
def test_turning_out_of_its_plane_is_refused(changes):
    with pytest.raises(ValueError, match="turning goes in the plane y = 0"):
        replace(FACING, **changes)


def test_turning_holds_no_drilling_cycle_and_joins_no_milling():
    holes = drilled(np.array([0, 0, 9.0]), np.zeros((1, 3)), cycle(CycleKind.DRILL), 100.0)
    about = np.tile([0.0, 1.0, 0.0], (len(holes), 1))
    with pytest.raises(ValueError, match="no drilling cycle|not the motions"):
        replace(holes, axis=about, work_turns=True)
    with pytest.raises(ValueError, match="the work turns all along a path or not at all"):
        Toolpath.join([WALL, FACING])
    assert Toolpath.join([FACING, FACING]).work_turns


def test_linuxcnc_turns_in_its_own_plane_with_x_as_a_diameter():
    words = words_of(program(FACE, section("wall", FLAT_16, WALL)))
    assert "(X IS A DIAMETER WHILE THE WORK TURNS)" in text_of(program(FACE))
    start = words.index("G18 G7")
    assert words[start : start + 12] == [
        "G18 G7",
        "S900 M3",
        "M8",
        "G0 X120",
        "G0 G43 H3 Z50",
        "Z5",
        "G1 Z-1 F191",
        "X20 F500",
        "G2 Z-6 X10 K-5 I0 F700",
        "G3 Z-11 X0 K0 I-5",
        "G0 Z50",
        "M5 M9",
    ]
    assert "G8" in words[start + 12 :]


def test_a_program_that_turns_nothing_says_nothing_of_it():
    text = text_of(program(section("wall", FLAT_16, WALL)))
    assert not any(word in text for word in ("G18", "G7 ", "G8\n", "DIAMETER"))


def test_what_is_read_is_what_was_written():
    made = program(
        replace(FACE, surface_speed=180.0, feed_mode=FeedMode.REVOLUTION, spindle=2500.0),
        section("wall", FLAT_16, WALL),
    )
    again = read_linuxcnc(text_of(made), (TURNING, FLAT_16), S1)
    told = listing(made, marks=False)
    assert "feeds by revolution turning" in told
    assert "centre x 10.0000 z -6.0000" in told
    assert listing(again, marks=False) == told


def test_x_may_be_a_radius_and_an_arc_be_given_by_its_own():
    path = read("G8 G1 X20 F100\nG2 X15 Z45 R5")
    assert path.position[-1].tolist() == [15.0, 0.0, 45.0]
    assert path.position[-2].tolist() == [20.0, 0.0, 50.0]
    assert path.centre[-1] == approx([20.0, 0.0, 45.0])


@pytest.mark.parametrize(
    ("body", "says"),
    [
        ("G1 X5 Y1 F100", "line 6: Y while the work turns; it is not of the plane ZX"),
        ("G2 X5 Z5 J5 F100", "line 6: J while the work turns"),
        ("G17 G1 X5 F100", "line 6: T3 is a turning tool; put G18 first"),
        ("T1 M6\nG0 X5", "line 7: G18 with T1, a tool that rotates; arcs in the plane ZX are of"),
        ("G81 X5 Z-3 R2 F100", "line 6: G81 while the work turns is not understood"),
    ],
)
def test_what_is_not_turning_is_refused(body, says):
    with pytest.raises(BadInput, match=says):
        read(body)


def test_a_k_without_turning_is_refused():
    start = "G21 G90 G54\nT1 M6\nS400 M3\nG0 G43 H1 X0 Y0 Z50\n"
    with pytest.raises(BadInput, match="line 5: K while arcs are in XY"):
        read("G2 X5 I2.5 K1 F100", start)


def test_turning_is_not_written_for_a_machine_with_rotary_axes():
    with pytest.raises(Refused, match="no words for work that turns on a machine with rotary"):
        text_of(program(FACE), {"S1": standing(TABLE)})


def test_an_operation_may_hold_a_turning_tool():
    operation = turning_operation()
    made = section_of(operation, FACING)
    assert (made.spindle, made.surface_speed) == (2500.0, 500.0)
    with pytest.raises(BadInput, match="operation turn-01: DCLNR CNMG120408 is a turning tool"):
        _ = operation.cutter


def test_a_plan_with_a_turning_tool_comes_back_from_its_files(tmp_path):
    plain = session()
    tree = replace(plain.process, operations=(*plain.process.operations, turning_operation()))
    changed = replace(
        plain,
        process=tree,
        paths=(*plain.paths, replace(plain.paths[0], operation="turn-01", path=FACING)),
    )
    write_process(changed, tmp_path / "a.xml")
    root, tool = etree.parse(tmp_path / "a.xml").getroot(), turning_operation().tool
    (element,) = root.findall("turning-tool")
    (operation,) = (o for o in root.findall("operation") if o.get("id") == "turn-01")
    assert operation.get("tool") == element.get("number") == str(tool.number)
    assert float(element.find("insert").get("nose-radius")) == tool.insert.nose_radius
    members = Members()
    again = from_xml(to_xml(changed, Session, "session", members), Session, members)
    assert again.process.operations == tree.operations
    assert again.paths[-1].path.work_turns
    told = json.loads(json.dumps([t.as_dict() for t in tree.tools()]))
    assert [t["form"] for t in told] == ["flat", "turning"]


def test_the_catalogue_gives_turning_tools_by_name():
    shop = load_shop()
    assert shop.turning_tool("DCLNR2525M12 CNMG120408").insert.nose_radius == 0.8
    with pytest.raises(BadInput, match="unknown turning tool X; known: "):
        shop.turning_tool("X")


def test_the_setup_sheet_shows_turning_tools(tmp_path):
    from trunnion.report.html import report_html

    plain = programs.session()
    tree = replace(plain.process, operations=(*plain.process.operations, turning_operation()))
    page = report_html(replace(plain, process=tree), "B1", (), tmp_path)
    assert "500 m/min, at most 2500" in page and "DCLNR2525M12" in page


def test_the_proof_of_milling_takes_no_turning():
    milled = program_section(FLAT_16, [(0.0, 0.0, 30.0), (9.0, 0.0, 30.0)])
    with pytest.raises(BadInput, match="operation face turns the work: a setup turns all along"):
        proof(FACE)
    with pytest.raises(BadInput, match="operation face turns the work"):
        moves_of((milled, FACE))
    # Neither does a turning tool in milling motions, or a mill in turning ones.
    for tool, path in ((TURNING, WALL), (FLAT_16, FACING)):
        with pytest.raises(BadInput, match="turns the work"):
            moves_of((section("odd", tool, path),))


def test_turning_is_timed_by_its_feeds():
    from trunnion.toolpath.motion.time import machining_time

    path = turned_path((RAPID, 60.0, 5.0), (LINE, 10.0, 5.0, 600.0))
    # 50 mm at 10 mm/s, and little for acceleration.
    assert machining_time(path, load_shop().machine("Mill 1200")) == approx(5.0, rel=0.02)
