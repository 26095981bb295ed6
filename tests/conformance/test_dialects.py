"""What every registered dialect must do, whoever wrote it: ours, and those of packages in `tests/dialects` and `tests/families`."""

from __future__ import annotations

import datetime
import time
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from leaning_paths import TABLE, lean, standing
from leaning_paths import path_of as leaning_path
from own_packages import all_dialects
from programs import (
    BULL_10,
    FACING,
    FLAT_16,
    RAPID,
    S1,
    TURNING,
    WALL,
    path_of,
    program_1,
    section,
    verdict,
)
from random_programs import (
    coordinates,
    cycle,
    cycles,
    farthest,
    program_of,
    programs,
    same,
    spoils,
    track,
)
from trunnion.findings import BadCall, BadInput, Refused
from trunnion.model.motion.cycle import WAITING, CycleKind
from trunnion.model.motion.drilling import drilled
from trunnion.model.motion.listing import listing
from trunnion.model.motion.program import Program
from trunnion.model.motion.toolpath import EMPTY, Motion, Toolpath
from trunnion.model.spindle import FeedMode
from trunnion.model.verdict import Outcome
from trunnion.post.contract import Dialect
from trunnion.post.header import REJECTED, STAMP_LINES, Header
from trunnion.post.linearize import lines_for_arcs
from trunnion.post.release import is_released
from trunnion.post.settings import PostSettings
from trunnion.shop.kinematics import NO_WORK_POSITIONS, WorkPositions
from trunnion.units import MM_PER_INCH

HEADER = Header(name="B1", part="B1", part_digest="ab12", plan_digest="cd34")
PASSED = replace(HEADER, verdict=verdict())
TOOLS = (FLAT_16, BULL_10)
DIALECTS = all_dialects()
OFFSETS = ("G54", "G57", "G58", "G59.3", "G70", "X5", "")
TURNS = 400.0
"""Spindle speed in 1/min of random cycles."""
some_tops = st.lists(st.tuples(coordinates, coordinates, coordinates), min_size=1, max_size=4)
starts = st.tuples(coordinates, coordinates)
by_name = pytest.mark.parametrize("name", DIALECTS)


@pytest.fixture(params=DIALECTS)
def dialect(request) -> Dialect:
    return DIALECTS[request.param]()


def written(
    dialect: Dialect, program: Program, places: WorkPositions = NO_WORK_POSITIONS, **chosen
) -> str:
    return dialect.write([program], HEADER, PostSettings(**chosen), places)


def again(
    dialect: Dialect, program: Program, places: WorkPositions = NO_WORK_POSITIONS, **chosen
) -> Program:
    (read,) = dialect.read(
        written(dialect, program, places, **chosen), TOOLS, [program.setup], places
    )
    return read


def one(*sections, setup=S1) -> Program:
    return Program(name="B1.S1", setup=setup, sections=sections)


def holes(kind: CycleKind, lift: float) -> Toolpath:
    """Return a path of three holes, the last one lower, with a feed of 480 mm/min: 1.25 mm a revolution at 384 1/min."""
    tops = np.array([[10.0, 5.0, 2.0], [30.0, 5.0, 2.0], [30.0, 25.0, -4.5]])
    return lifted(drilled(np.array([0.0, 0.0, 50.0]), tops, cycle(kind, lift=lift), 480.0))


def is_the_controls_own(kind: CycleKind, lift: float, read: Toolpath, planned: Toolpath) -> bool:
    """Say whether a control cuts a hole a little other than planned, along the same line: it may feed where chips are broken instead of
    going in rapid, and leave a thread's last stroke out at the retract plane."""
    if len(read) == len(planned) and (read.motion == planned.motion).all():
        return False
    assert kind is CycleKind.CHIP_BREAK or (kind is CycleKind.TAP and lift > 0.0)
    assert max(farthest(track(read), track(planned)), farthest(track(planned), track(read))) <= 1e-3
    if kind is CycleKind.CHIP_BREAK:
        changed = read.motion != planned.motion
        assert (read.motion[changed] == Motion.LINE).all()
    return True


def opened(path: Toolpath) -> np.ndarray:
    """Return the points (n, 3) of a path with its arcs as lines within 1 um."""
    arcs = np.flatnonzero(path.motion >= Motion.ARC_CW)
    return lines_for_arcs(path, arcs, 1e-3)[0].position


def lifted(path: Toolpath) -> Toolpath:
    """Return a path that ends at the clearance height."""
    x, y, _ = path.position[-1]
    return Toolpath.join([path, path_of((RAPID, x, y, 50.0))])


def test_a_dialect_of_ones_own_is_among_them():
    assert {"apt", "linuxcnc", "kestrel", "turner"} <= set(DIALECTS)


def test_it_has_the_name_that_it_is_registered_under():
    assert {name: kind().name for name, kind in DIALECTS.items()} == {
        name: name for name in DIALECTS
    }
    assert all(kind().suffix.isalnum() for kind in DIALECTS.values())


def test_what_it_writes_it_reads_as_the_same_motions(dialect):
    assert listing(again(dialect, program_1()), marks=False) == listing(program_1(), marks=False)


@pytest.mark.parametrize(
    ("units", "decimals"), [("mm", 3), ("mm", 4), ("mm", 6), ("inch", 4), ("inch", 6)]
)
def test_what_it_writes_is_the_same_within_its_decimals(dialect, units, decimals):
    half = 0.5 * 10.0**-decimals * (MM_PER_INCH / 10.0 if units == "inch" else 1.0)
    for first, second in zip(
        program_1().sections,
        again(dialect, program_1(), units=units, decimals=decimals).sections,
        strict=True,
    ):
        assert np.abs(first.path.position - second.path.position).max() <= half + 1e-9
        assert list(first.path.motion) == list(second.path.motion)
        assert (first.operation, first.tool, first.spindle, first.coolant) == (
            second.operation,
            second.tool,
            second.spindle,
            second.coolant,
        )


@pytest.mark.examples(20)
@by_name
@settings(deadline=None, max_examples=60)
@given(parts=programs)
def test_whatever_the_motions_they_are_read_as_the_same(name, parts):
    program = program_of(parts)
    same(program, again(DIALECTS[name](), program), 5e-4)


def test_it_writes_the_same_bytes_twice_and_ends_with_a_line_end(dialect):
    first, second = (
        kind.write([program_1()], PASSED, PostSettings()) for kind in (dialect, type(dialect)())
    )
    assert first == second
    assert first.endswith("\n")


def test_it_needs_no_clock(dialect, monkeypatch):
    def refuse(*_, **__):
        raise AssertionError("a dialect must not look at the clock: the date comes in the header")

    for clock in ("time", "time_ns", "localtime", "gmtime", "strftime", "ctime"):
        monkeypatch.setattr(time, clock, refuse)
    for clock in ("datetime", "date"):
        monkeypatch.setattr(
            datetime, clock, type(clock, (), {"now": refuse, "today": refuse, "utcnow": refuse})
        )
    assert listing(again(dialect, program_1()), marks=False) == listing(program_1(), marks=False)


def test_a_program_does_not_change_what_the_next_one_says(dialect):
    first = written(dialect, program_1())
    written(dialect, one(section("other", BULL_10, WALL, 900.0, "off")), units="inch")
    assert written(dialect, program_1()) == first


def test_its_text_begins_with_its_stamp(dialect):
    text = dialect.write([program_1()], PASSED, PostSettings())
    assert len(dialect.stamp("B1", PASSED)) == STAMP_LINES
    assert text.split("\n")[1:STAMP_LINES] == list(dialect.stamp("B1", PASSED)[1:])
    assert any("PLAN cd34" in line for line in text.split("\n")[STAMP_LINES : STAMP_LINES + 2])


def test_only_a_verdict_that_releases_makes_its_text_look_released(dialect):
    for header in (HEADER, replace(HEADER, verdict=verdict(Outcome.FAILED))):
        text = dialect.write([program_1()], header, PostSettings())
        assert not is_released(text)
        assert REJECTED in text.split("\n")[1]
    assert is_released(dialect.write([program_1()], PASSED, PostSettings()))


def test_every_block_knows_a_line_of_the_text(dialect):
    text = written(dialect, program_1())
    for part in again(dialect, program_1()).sections:
        assert len(part.block_lines) == len(part.path)
        assert list(part.block_lines) == sorted(part.block_lines)
        assert 0 < part.block_lines[0] <= part.block_lines[-1] <= text.count("\n")


def test_it_refuses_what_it_cannot_write(dialect):
    for bad in (
        section("op", FLAT_16, EMPTY),
        section("op", FLAT_16, WALL, coolant="steam"),
        section("", FLAT_16, WALL),
        section("op", FLAT_16, WALL, spindle=0.0),
    ):
        with pytest.raises(Refused):
            written(dialect, one(bad))


@pytest.mark.parametrize("offset", OFFSETS)
def test_a_work_offset_is_written_so_that_it_is_read_or_refused(dialect, offset):
    program = replace(program_1(), setup=replace(S1, work_offset=offset))
    try:
        text = written(dialect, program)
    except Refused as refused:
        assert repr(offset).strip("'") in str(refused) and "\n" not in str(refused)
        return
    assert offset.startswith("G5") or dialect.name == "apt"
    (read,) = dialect.read(text, TOOLS, [program.setup])
    assert listing(read, marks=False) == listing(program, marks=False)


@pytest.mark.parametrize("coolant", ["flood", "mist", "off", "through", "FLOOD"])
def test_a_coolant_is_written_so_that_it_is_read_or_refused(dialect, coolant):
    program = one(section("a", FLAT_16, WALL), section("b", FLAT_16, WALL, coolant=coolant))
    try:
        read = again(dialect, program)
    except Refused as refused:
        assert coolant in str(refused) and coolant not in ("flood", "off")
        return
    assert [s.coolant for s in read.sections] == ["flood", coolant]


@pytest.mark.parametrize("mode", FeedMode)
@pytest.mark.parametrize("units", ["mm", "inch"])
def test_feeds_are_the_same_whatever_they_are_given_by(dialect, mode, units):
    program = program_1()
    given_so = replace(
        program, sections=tuple(replace(s, feed_mode=mode) for s in program.sections)
    )
    for planned, read in zip(
        program.sections, again(dialect, given_so, units=units).sections, strict=True
    ):
        # By the minute a feed has a decimal of mm or two of inches, in inverse time six digits.
        assert read.path.feed == pytest.approx(planned.path.feed, abs=0.13, rel=2e-5)
        assert read.feed_mode in (mode, FeedMode.MINUTE)


@pytest.mark.parametrize("kind", CycleKind)
@pytest.mark.parametrize("lift", [0.0, 18.0, 48.0])
@pytest.mark.parametrize("units", ["mm", "inch"])
def test_a_cycle_is_written_so_that_its_motions_are_read_or_refused(dialect, kind, lift, units):
    program = one(section("holes", FLAT_16, holes(kind, lift), 384.0))
    try:
        read = again(dialect, program, units=units).sections[0]
    except Refused as refused:
        assert "has no words for a dwell" in str(refused) and kind in WAITING
        return
    planned = program.sections[0].path
    feeds = read.path.feed[read.path.motion != Motion.RAPID]
    assert feeds == pytest.approx(np.full(len(feeds), 480.0), abs=0.13)
    assert read.dwell == pytest.approx(planned.dwells().sum())
    if is_the_controls_own(kind, lift, read.path, planned):
        return
    assert np.abs(read.path.position - planned.position).max() <= 1e-3
    assert read.path.feed == pytest.approx(planned.feed, abs=0.13)
    assert list(read.path.motion) == list(planned.motion)
    assert read.path.dwells() == pytest.approx(planned.dwells())


@pytest.mark.examples(20)
@by_name
@settings(deadline=None, max_examples=60)
@given(made=cycles(), tops=some_tops, start=starts)
def test_whatever_the_cycles_their_motions_are_read_as_the_same(name, made, tops, start):
    high = np.array([*start, 50.0])
    path = lifted(drilled(high, np.array(tops), made, TURNS * (made.pitch or 1.2)))
    program = one(section("holes", FLAT_16, path, TURNS))
    try:
        read = again(DIALECTS[name](), program)
    except Refused as refused:
        assert "has no words for a dwell" in str(refused) and made.kind in WAITING
        return
    # A peck is written with as many decimals as a length: so many of them go so far astray.
    same(program, read, 5e-4 + 5e-5 * made.pecks)
    assert read.sections[0].dwell == pytest.approx(path.dwells().sum(), abs=6e-4 * len(tops))


def test_a_dwell_is_written_so_that_it_is_read_or_refused(dialect):
    path = replace(WALL, dwell=np.array([0.0, 0.0, 1.5, 0.25]))
    try:
        read = again(dialect, one(section("wall", FLAT_16, path))).sections[0]
    except Refused as refused:
        assert "has no words for a dwell" in str(refused)
        return
    assert read.path.dwells().tolist() == [0.0, 0.0, 1.5, 0.25]


def test_tapping_at_another_feed_than_its_pitch_is_refused(dialect):
    tapped = holes(CycleKind.TAP, 0.0)
    with pytest.raises(Refused, match=r"tapping at 480 mm/min is not 1.25 mm a revolution at 400"):
        written(dialect, one(section("holes", FLAT_16, tapped, 400.0)))


@pytest.mark.parametrize("units", ["mm", "inch"])
def test_a_constant_surface_speed_is_written_so_that_it_is_read_or_refused(dialect, units):
    facing = replace(
        section("face", TURNING, FACING, 2500.0), surface_speed=180.0, feed_mode=FeedMode.REVOLUTION
    )
    program = one(facing, section("wall", FLAT_16, WALL))
    try:
        text = written(dialect, program, units=units)
    except Refused as refused:
        assert "no words for work that turns" in str(refused)
        return
    (read,) = dialect.read(text, (TURNING, FLAT_16), [S1])
    assert [(s.spindle, s.feed_mode) for s in read.sections] == [
        (2500.0, FeedMode.REVOLUTION),
        (12000.0, FeedMode.MINUTE),
    ]
    assert [s.surface_speed for s in read.sections] == pytest.approx([180.0, 0.0], abs=0.02)
    assert read.sections[0].path.feed.max() == pytest.approx(700.0, abs=0.5)


@pytest.mark.parametrize("units", ["mm", "inch"])
def test_work_that_turns_is_written_so_that_it_is_read_or_refused(dialect, units):
    program = one(section("face", TURNING, FACING, 900.0), section("wall", FLAT_16, WALL))
    try:
        text = written(dialect, program, units=units)
    except Refused as refused:
        assert "no words for work that turns" in str(refused)
        return
    (read,) = dialect.read(text, (TURNING, FLAT_16), [S1])
    turned, milled = (s.path for s in read.sections)
    assert turned.work_turns and not milled.work_turns
    assert np.abs(turned.position[-1] - FACING.position[-1]).max() <= 1e-3
    # A dialect may write arcs as lines.
    first, second = opened(FACING), opened(turned)
    assert max(farthest(first, second), farthest(second, first)) <= 6e-3
    assert farthest(track(milled), track(WALL)) <= 1e-3


def test_a_tool_of_the_other_kind_is_refused(dialect):
    for tool, path in ((FLAT_16, FACING), (TURNING, WALL)):
        with pytest.raises(Refused, match="choose another tool|no words for work that turns"):
            written(dialect, one(section("op", tool, path)))


@pytest.mark.parametrize(
    "places", [NO_WORK_POSITIONS, {"S1": standing(TABLE)}], ids=["three axes", "rotary axes"]
)
def test_a_leaning_tool_is_written_so_that_it_is_read_or_refused(dialect, places):
    path = leaning_path(
        ((0.0, 0.0, 40.0), lean(20.0, 30.0)),
        ((0.0, 0.0, 0.0), lean(20.0, 30.0)),
        ((9.0, 2.0, 0.0), lean(20.0, 30.0)),
    )
    try:
        read = again(dialect, one(section("op", FLAT_16, path)), places).sections[0].path
    except Refused as refused:
        assert "axis" in str(refused) or "axes" in str(refused)
        return
    cut = read.motion != 0
    assert np.abs(read.position[cut] - path.position[1:]).max() <= 3e-4
    assert np.abs(read.axis[cut] - path.axis[1:]).max() <= 3e-7


def test_a_text_cut_short_is_refused(dialect):
    lines = written(dialect, program_1()).split("\n")
    for keep in (0, 5, len(lines) // 2, len(lines) - 2):
        with pytest.raises(BadInput):
            dialect.read("\n".join(lines[:keep]), TOOLS, [S1])


def test_a_text_made_for_other_tools_is_refused(dialect):
    other = replace(FLAT_16, diameter=15.0)
    with pytest.raises(BadInput, match=r"line \d+: the text was made for another tool 1"):
        dialect.read(written(dialect, program_1()), (other, BULL_10), [S1])


def test_no_program_at_all_is_a_bad_call(dialect):
    with pytest.raises(BadCall):
        dialect.write([], HEADER, PostSettings())


@pytest.mark.examples(50)
@by_name
@settings(deadline=None, max_examples=150)
@given(places=spoils)
def test_a_spoiled_text_is_read_or_refused_in_one_line(name, places):
    dialect = DIALECTS[name]()
    text = list(written(dialect, program_1()))
    for share, letter in places:
        text[int(share * len(text))] = letter
    try:
        dialect.read("".join(text), TOOLS, [S1])
    except BadInput as refused:
        assert "\n" not in str(refused)
