"""How LinuxCNC and CL texts give speeds and feeds: by the minute, by the revolution, in inverse time, at a constant surface speed."""

from __future__ import annotations

from dataclasses import replace

import pytest
from pytest import approx

import programs
from programs import (
    CCW,
    FLAT_16,
    S1,
    TURNING,
    WALL,
    process_tree,
    program_1,
    section,
    session,
)
from trunnion.findings import BadInput
from trunnion.model.motion.listing import listing
from trunnion.model.motion.program import Program, section_of
from trunnion.model.operation import CuttingData
from trunnion.model.spindle import FeedMode, SpindleMode
from trunnion.post.dialects.apt import AptDialect
from trunnion.post.dialects.linuxcnc import LinuxCncDialect
from trunnion.post.header import Header
from trunnion.post.readers.linuxcnc import read_linuxcnc
from trunnion.post.settings import PostSettings
from trunnion.report.html import feed, spindle

HEADER = Header(name="B1", part="B1", part_digest="ab12", plan_digest="cd34")
START = "G21 G90 G54\nT1 M6\nS9000 M3\nG0 G43 H1 X0 Y0 Z50\n"
FACING = replace(
    section(
        "face",
        TURNING,
        programs.FACING,
        spindle=2500.0,
    ),
    surface_speed=180.0,
    feed_mode=FeedMode.REVOLUTION,
)


def program(*sections):
    return Program(name="B1.S1", setup=S1, sections=sections)


def text_of(made, dialect=LinuxCncDialect, **settings):
    return dialect().write([made], HEADER, PostSettings(**settings))


def words_of(text):
    return [line.split(" ", 1)[1] for line in text.split("\n") if line.startswith("N")]


def given_by(mode):
    return replace(section("wall", FLAT_16, WALL), feed_mode=mode)


def read(body):
    return read_linuxcnc(f"{START}{body}\nM30\n", (FLAT_16,), S1)


def test_a_feed_by_the_revolution_is_that_by_the_minute_over_the_turns():
    assert "G95 G1 X33.3333 F0.066667" in words_of(text_of(program(given_by(FeedMode.REVOLUTION))))


def test_a_feed_in_inverse_time_is_one_over_the_minutes_of_its_block():
    # 33.3333 mm at 800 mm/min.
    assert "G93 G1 X33.3333 F24" in words_of(text_of(program(given_by(FeedMode.INVERSE))))


def test_the_next_section_feeds_by_the_minute_again():
    words = words_of(text_of(program(given_by(FeedMode.REVOLUTION), given_by(FeedMode.MINUTE))))
    after = words[words.index("G95 G1 X33.3333 F0.066667") :]
    assert "G90 G91.1 G17 G40 G94 G54" in after and "G1 X33.3333 F800" in after


def test_a_text_with_none_of_it_is_what_it_was():
    text = text_of(program_1())
    assert not any(word in text for word in ("G93", "G95", "G96", "G97"))


@pytest.mark.parametrize("mode", FeedMode)
def test_linuxcnc_reads_back_what_a_feed_is_given_by(mode):
    made = program(given_by(mode))
    assert listing(read_linuxcnc(text_of(made), (FLAT_16,), S1), marks=False) == listing(
        made, marks=False
    )


def test_the_listing_tells_what_is_given():
    told = listing(program(FACING, given_by(FeedMode.INVERSE)))
    assert "spindle surface 180 highest 2500 coolant flood feeds by revolution" in told
    assert "spindle 12000 coolant flood feeds in inverse time" in told
    # 180 m/min at a diameter of 120 mm are 477.46 1/min.
    assert "feed 0.4000 a revolution" in told


def test_a_surface_speed_is_written_with_the_highest_spindle_speed():
    words = words_of(text_of(program(FACING, section("wall", FLAT_16, WALL))))
    assert "G96 D2500 S180 M3" in words
    assert "G97 S12000 M3" in words
    assert "G96 D2500 S590.6 M3" in words_of(text_of(program(FACING), units="inch"))


def test_cl_text_has_the_words_of_its_standard():
    text = text_of(program(FACING), AptDialect)
    assert "SPINDL/SMM,180,CLW,MAXRPM,2500" in text
    assert "FEDRAT/0.400029,MMPR" in text


def test_an_arc_in_inverse_time_lasts_as_long_as_its_way():
    path = read("G93 G3 X0 Y0 I-10 J0 F2").sections[0].path
    assert path.motion[-1] == CCW
    assert path.feed[-1] == approx(2.0 * path.lengths()[-1])


@pytest.mark.parametrize(
    ("body", "says"),
    [
        ("G95 G1 X5", "line 5: a feed move without a feed; give F"),
        ("S0 M3\nG95 G1 X5 F0.1", "line 6: a feed by the revolution while the spindle stands"),
        ("G95 G1 X5 F900", "out of range; allowed is 0.001 to 500000 mm or inch a minute"),
        ("G95 G1 X5 F5000", "line 5: F5000 is out of range; allowed is 0 to 1000 mm or inch a rev"),
        ("G93 G1 X5 F10\nX6", r"line 6: a feed move in inverse time \(G93\) needs an F word"),
        ("G93 G95", "line 5: G93 and G95 can't stand in one line"),
        ("G96 S100 M3", "line 5: G96 needs S above zero, .* and D above zero"),
        ("G96 D2000 M3", "line 5: G96 needs S above zero"),
        ("G1 X5 F100 D3", "line 5: D without G96; remove it"),
        ("G96 D2000 S100\nG97", "line 6: G97 without S; give the spindle speed in its line"),
        ("G96 D2000 S100\nG1 X5 F100", "line 6: a constant surface speed with T1, a tool that rot"),
    ],
)
def test_what_says_no_feed_or_speed_is_refused(body, says):
    with pytest.raises(BadInput, match=says):
        read(body)


def test_the_feed_follows_the_spindle_by_the_revolution():
    sections = read("G95 G1 X5 F0.1\nS3000\nX9").sections
    assert [s.path.feed[-1] for s in sections] == approx([900.0, 300.0])


def test_a_feed_by_the_minute_stands_where_ways_are_mixed():
    assert read("G95 G1 X5 F0.1\nG94 G1 X9 F100").sections[0].feed_mode is FeedMode.MINUTE


def surface(**changes) -> CuttingData:
    return replace(
        process_tree().operations[0].data,
        spindle_mode=SpindleMode.SURFACE,
        highest_spindle=9000.0,
        **changes,
    )


def test_a_rotating_tools_surface_speed_is_posted_as_its_spindle_speed():
    tree = process_tree()
    made = section_of(replace(tree.operations[0], data=surface(speed=226.195)), WALL)
    # 226.195 m/min at 16 mm.
    assert made.spindle == approx(4500.0, abs=0.01) and made.surface_speed == 0.0
    assert "S4500 M3" in words_of(text_of(program(made)))


def test_the_setup_sheet_says_what_programs_give():
    operation = session().process.operations[0]
    data = operation.data
    assert (spindle(operation), feed(data)) == ("12000", "3600")
    assert spindle(replace(operation, data=surface())) == "500 m/min, at most 9000"
    assert feed(replace(data, feed_mode=FeedMode.REVOLUTION)) == "0.300 mm a revolution"
