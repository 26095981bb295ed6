"""APT CL: the words of ISO 4343, and the same motions when read again."""

from __future__ import annotations

from dataclasses import replace

import pytest

from programs import (
    BULL_10,
    CCW,
    FLAT_16,
    GUIDES,
    LINE,
    RAPID,
    S1,
    S2,
    path_of,
    program_1,
    program_2,
    section,
)
from trunnion.findings import BadCall, BadInput
from trunnion.model.motion.listing import listing
from trunnion.model.motion.program import Program
from trunnion.post.dialects.apt import AptDialect
from trunnion.post.header import Header
from trunnion.post.readers import read_program
from trunnion.post.readers.apt.interpreter import read_apt
from trunnion.post.settings import PostSettings

HEADER = Header(name="B1", part="B1", part_digest="ab12", plan_digest="cd34")
TOOLS = (FLAT_16, BULL_10)
START = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,9000,CLW\nRAPID\nGOTO/10,0,50\nFEDRAT/100,MMPM\n"


def text_of(*made: Program, **settings) -> str:
    return AptDialect().write(made, HEADER, PostSettings(**settings))


@pytest.mark.parametrize("units", ["mm", "inch"])
def test_programs_read_again_move_the_same(units):
    again = read_apt(text_of(program_1(), program_2(), units=units, decimals=6), TOOLS, [S1, S2])
    assert [p.setup.name for p in again] == ["S1", "S2"]
    for first, second in zip((program_1(), program_2()), again, strict=True):
        if units == "mm":
            assert listing(second, marks=False) == listing(first, marks=False)
        for a, b in zip(first.sections, second.sections, strict=True):
            assert abs(a.path.position - b.path.position).max() < 13e-7


def test_what_led_an_operation_is_remarked_before_its_motions_and_read_over():
    path = path_of((RAPID, 10, 0, 5), (LINE, 0, 10, 4, 100))
    led = replace(section("a", FLAT_16, path), guides=GUIDES)
    text = text_of(Program(name="B1.S1", setup=S1, sections=(led,)))
    lines = text.split("\n")
    at = lines.index("$$ GUIDE/WALL,OPEN")
    assert lines[at : at + 8] == [
        "$$ GUIDE/WALL,OPEN",
        "$$ TLLFT,GOFWD/FACE12,TO,FACE13",
        "$$ TLLFT,GOLFT/FACE13,PAST,NOFACE",
        "$$ TLLFT,GORGT/NOFACE",
        "$$ GUIDE/WALL,CLOSED",
        "$$ TLLFT,GOFWD/FACE15,TANTO,FACE15",
        "$$ GUIDE/AREA,CLOSED,FACE9",
        "RAPID",
    ]
    plain = "".join(f"{line}\n" for line in lines[:-1] if not line.startswith("$$"))
    assert plain == text_of(Program(name="B1.S1", setup=S1, sections=(replace(led, guides=()),)))
    one, other = (read_apt(t, TOOLS, [S1])[0] for t in (text, plain))
    assert listing(one, marks=False) == listing(other, marks=False)


def test_an_arc_is_a_circle_with_its_sense_and_the_goto_that_ends_it():
    path = path_of((RAPID, 10, 0, 5), (CCW, 0, 10, 4, 0, 0, 100))
    lines = text_of(Program(name="B1.S1", setup=S1, sections=(section("a", FLAT_16, path),))).split(
        "\n"
    )
    at = lines.index("FEDRAT/100,MMPM")
    assert lines[at + 1 : at + 3] == ["CIRCLE/0,0,5,0,0,1,10", "GOTO/0,10,4"]


def test_a_circle_back_to_its_start_is_a_full_turn():
    (program,) = read_apt(START + "CIRCLE/0,0,50,0,0,-1,10\nGOTO/10,0,50\nFINI\n", TOOLS, [S1])
    assert program.sections[0].path.sweeps()[1] == pytest.approx(-6.283185307)


def test_the_text_begins_with_partno_and_ends_with_fini():
    lines = text_of(program_1()).split("\n")
    assert lines[0] == "PARTNO/TRUNNION PROGRAM B1"
    assert lines[1] == "PPRINT/REJECTED: DO NOT RUN"
    assert lines[-2] == "FINI"


def test_one_setup_needs_no_name_in_the_text():
    assert read_program("apt", START + "GOTO/20,0,50\nFINI\n", TOOLS, S1).n_blocks() == 2


def test_the_same_setup_twice_is_refused():
    text = "\n".join(line for line in text_of(program_1()).split("\n"))
    body = text[text.index("PPRINT/SETUP S1 WORK") : text.index("SPINDL/OFF")]
    with pytest.raises(BadInput, match="setup S1 comes twice; put its operations together"):
        read_apt("UNITS/MM\n" + body + body + "FINI\n", TOOLS, [S1])


def test_two_tools_of_one_number_are_refused():
    with pytest.raises(BadInput, match="two tools have the number 1: flat 16 and other"):
        read_apt(START + "FINI\n", (FLAT_16, replace(FLAT_16, name="other")), [S1])


def test_nothing_to_write_is_a_bad_call():
    with pytest.raises(BadCall, match="no program to write"):
        text_of()


def test_feeds_stand_only_where_they_change():
    path = path_of(
        (RAPID, 0, 0, 5),
        (LINE, 1, 0, 5, 100),
        (LINE, 2, 0, 5, 100),
        (LINE, 3, 0, 5, 200.04),
        (RAPID, 0, 0, 5),
    )
    text = text_of(Program(name="B1.S1", setup=S1, sections=(section("a", FLAT_16, path),)))
    assert [line for line in text.split("\n") if line.startswith("FEDRAT")] == [
        "FEDRAT/100,MMPM",
        "FEDRAT/200,MMPM",
    ]
