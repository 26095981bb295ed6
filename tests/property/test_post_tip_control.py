"""Programs of tips and directions: whatever way a tool turns, on every machine, the text says its poses as they were planned."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from five_axis import five_axis_case
from leaning_paths import HEADER, again, path_of, program, standing, text_of
from own_shop import own_shop
from programs import FLAT_16, S1
from trunnion import registry
from trunnion.findings import BadInput, Refused
from trunnion.model.motion.toolpath import Motion
from trunnion.model.spindle import FeedMode
from trunnion.post.settings import PostSettings
from trunnion.shop.kinematics import axes_of, rotary_solutions

MACHINES = [m for m in own_shop().machines.values() if m.rotary]
DIALECTS = ["sinumerik", "fanuc", "heidenhain"]
TIP, AXIS = 1e-3, math.radians(1e-3)
"""mm and rad that a pose may be off, beside what decimals round: 1 um and a thousandth of a degree."""
ROUNDED = 0.5e-4 * math.sqrt(3.0)
places = st.integers(-600_000, 600_000).map(lambda n: n / 10_000)
leans = st.one_of(st.just(0.0), st.floats(0.0, 30.0), st.floats(0.0, 0.01))
poses = st.tuples(
    places, places, st.integers(0, 400_000).map(lambda n: n / 10_000), leans, st.floats(0.0, 360.0)
)
by_machine = pytest.mark.parametrize("machine", MACHINES, ids=lambda m: m.name)
by_dialect = pytest.mark.parametrize("name", DIALECTS)


def winds_on(machine) -> bool:
    """Whether an axis of a machine turns as often as a path does."""
    return any(a.high - a.low > 3600.0 for a in machine.rotary)


@st.composite
def ways(draw):
    """Return a path of poses anywhere, upright ones and ones next to upright among them."""
    stops = draw(st.lists(poses, min_size=2, max_size=8))
    return path_of(
        *[
            ((x, y, z), (math.sin(a) * math.cos(b), math.sin(a) * math.sin(b), math.cos(a)))
            for x, y, z, a, b in ((*p[:3], math.radians(p[3]), math.radians(p[4])) for p in stops)
        ],
        feed=draw(st.floats(10.0, 5000.0)),
    )


def posted(name, place, *paths, **chosen):
    """Return the text of paths in a dialect, and the paths read back."""
    dialect, made = registry.get("dialects", name)(), program(*paths)
    text = dialect.write([made], HEADER, PostSettings(**chosen), {"S1": place})
    (read,) = dialect.read(text, (FLAT_16,), [S1], {"S1": place})
    return text, [s.path for s in read.sections]


def cut_of(path):
    """Return the positions and axes (n, 3) from where a path begins to feed on, without blocks that go nowhere."""
    feeds = np.flatnonzero(path.motion != Motion.RAPID)
    rows = np.arange(feeds[0] - 1, feeds[-1] + 1)
    position, axis = path.position[rows], path.axis[rows]
    moves = (np.abs(np.diff(position, axis=0)).max(axis=1) > 1.2e-4) | (
        np.abs(np.diff(axis, axis=0)).max(axis=1) > 1.2e-7
    )
    kept = np.concatenate([[True], moves])
    return position[kept], axis[kept]


def off(planned, read):
    """Return how far tips (mm) and axes (rad) of a path read back are from those planned, at most."""
    tips, axes = cut_of(planned)
    found, directions = cut_of(read)
    assert len(tips) == len(found)
    return (
        float(np.linalg.norm(tips - found, axis=1).max()),
        float(np.linalg.norm(axes - directions, axis=1).max()),
    )


@pytest.mark.examples(5)
@by_dialect
@by_machine
@settings(deadline=None, max_examples=15)
@given(path=ways())
def test_tips_and_axes_are_read_as_they_were_planned(name, machine, path):
    tips, _ = cut_of(path)
    assume(
        len(tips) == len(path) and (np.linalg.norm(np.diff(path.axis, axis=0), axis=1) < 1.9).all()
    )
    try:
        _, (read,) = posted(name, standing(machine), path)
    except Refused as refused:
        # Only what the machine itself can't follow: the fork's C has an end.
        assert machine.title in str(refused)
        return
    tip, axis = off(path, read)
    assert tip <= TIP + ROUNDED and axis <= AXIS


@by_dialect
@by_machine
def test_every_degree_of_both_rotary_axes_is_read_as_it_was_planned(name, machine):
    place = standing(machine)
    low, high = ([getattr(a, end) for a in machine.rotary] for end in ("low", "high"))
    low, high = np.maximum(low, -180.0), np.minimum(high, 180.0)
    for swept in (0, 1):
        for at in (0.0, 17.0, 30.0):
            degrees = np.arange(math.ceil(low[swept]), math.floor(high[swept]) + 1.0)
            angle = np.full((len(degrees), 2), at)
            angle[:, swept] = degrees
            axis = axes_of(place, np.radians(angle))
            tips = np.column_stack([0.25 * degrees, 10.0 + 0.0 * degrees, 0.125 * np.abs(degrees)])
            path = path_of(*zip(tips, axis, strict=True))
            _, (read,) = posted(name, place, path)
            tip, turn = off(path, read)
            assert tip <= TIP + ROUNDED and turn <= AXIS
            # What is read stands at the angles that were swept, in one of both ways.
            both = rotary_solutions(machine, cut_of(read)[1])[0]
            assert np.abs(axes_of(place, both[:, 0]) - cut_of(path)[1]).max() <= AXIS


@by_dialect
@by_machine
def test_a_plane_tilted_to_any_degree_is_read_as_it_was_planned(name, machine):
    place = standing(machine)
    low, high = ([getattr(a, end) for a in machine.rotary] for end in ("low", "high"))
    for swept in (0, 1):
        degrees = np.arange(
            math.ceil(max(low[swept], -180.0)), math.floor(min(high[swept], 180.0)) + 1.0, 10.0
        )
        angle = np.full((len(degrees), 2), 17.0)
        angle[:, swept] = degrees
        axes = axes_of(place, np.radians(angle))
        ends = [(0.0, 0.0, 40.0), (0.25, 10.0, 0.125), (7.0, 11.0, 0.5)]
        paths = [path_of(*((end, axis) for end in ends)) for axis in axes]
        text, read = posted(name, place, *paths)
        assert len(read) == len(paths) and " TRAORI" not in text
        for planned, found in zip(paths, read, strict=True):
            tip, turn = off(planned, found)
            assert tip <= TIP + ROUNDED and turn <= AXIS


@by_machine
def test_linuxcnc_says_every_degree_of_both_rotary_axes_too(machine):
    place = standing(machine)
    low, high = ([getattr(a, end) for a in machine.rotary] for end in ("low", "high"))
    for swept in (0, 1):
        degrees = np.arange(
            math.ceil(max(low[swept], -180.0)), math.floor(min(high[swept], 180.0)) + 1.0
        )
        angle = np.full((len(degrees), 2), 17.0)
        angle[:, swept] = degrees
        axis = axes_of(place, np.radians(angle))
        tips = np.column_stack([0.02 * degrees, 10.0 + 0.0 * degrees, 20.0 + 0.0 * degrees])
        path = path_of(*zip(tips, axis, strict=True))
        try:
            text = text_of(program(path), place, straying=0.02)
        except Refused as refused:
            assert machine.title in str(refused)
            continue
        read = again(text, place).sections[0].path
        for tip, direction in zip(path.position, path.axis, strict=True):
            off_tip = np.linalg.norm(read.position - tip, axis=1)
            k = int(off_tip.argmin())
            assert off_tip[k] <= TIP and np.linalg.norm(read.axis[k] - direction) <= AXIS


@by_dialect
@settings(deadline=None, max_examples=40)
@given(
    spoils=st.lists(
        st.tuples(
            st.floats(0, 1, exclude_max=True),
            st.sampled_from(list('GMXYZACFNRT0123456789.-= (),;"\n\x00')),
        ),
        min_size=1,
        max_size=5,
    )
)
def test_a_spoiled_text_of_five_axes_is_read_or_refused_in_one_line(name, spoils):
    place = standing(MACHINES[0])
    turning = path_of(((0.0, 0.0, 40.0), (0.0, 0.1, 0.9)), ((5.0, 0.0, 3.0), (0.2, 0.1, 0.9)))
    still = path_of(((0.0, 0.0, 40.0), (0.0, 0.1, 0.9)), ((5.0, 0.0, 3.0), (0.0, 0.1, 0.9)))
    dialect = registry.get("dialects", name)()
    text = list(dialect.write([program(turning, still)], HEADER, PostSettings(), {"S1": place}))
    for share, letter in spoils:
        text[int(share * len(text))] = letter
    try:
        dialect.read("".join(text), (FLAT_16,), [S1], {"S1": place})
    except BadInput as refused:
        assert "\n" not in str(refused)


@by_dialect
@pytest.mark.parametrize("machine", [m for m in MACHINES if winds_on(m)], ids=lambda m: m.name)
def test_a_finishing_path_is_read_row_by_row(name, machine):
    case = five_axis_case(400, 500)
    made = program(case.section.path, tool=case.section.tool)
    place = standing(machine, foot=(100.0, 100.0, -30.0))
    dialect = registry.get("dialects", name)()
    text = dialect.write([made], HEADER, PostSettings(), {"S1": place})
    (found,) = dialect.read(text, (case.section.tool,), [S1], {"S1": place})[0].sections
    tip, axis = off(case.section.path, found.path)
    assert tip <= TIP + ROUNDED and axis <= AXIS
    feeds = [p.feed[p.motion != Motion.RAPID] for p in (case.section.path, found.path)]
    assert feeds[0] == pytest.approx(feeds[1], abs=0.06)


@by_dialect
@pytest.mark.parametrize("units", ["mm", "inch"])
@pytest.mark.parametrize("mode", FeedMode)
def test_units_and_feed_modes_change_nothing_of_what_is_said(name, units, mode):
    place, dialect = standing(MACHINES[0]), registry.get("dialects", name)()
    turning = path_of(((0.0, 0.0, 300.0), (0.0, 0.1, 0.9)), ((5.0, 0.0, 3.0), (0.2, 0.1, 0.9)))
    still = path_of(((0.0, 0.0, 300.0), (0.3, 0.1, 0.9)), ((5.0, 0.0, 3.0), (0.3, 0.1, 0.9)))
    still = replace(still, dwell=np.array([0.0, 0.25]))
    made = program(turning, still)
    given_so = replace(made, sections=tuple(replace(s, feed_mode=mode) for s in made.sections))
    text = dialect.write([given_so], HEADER, PostSettings(units=units), {"S1": place})
    (read,) = dialect.read(text, (FLAT_16,), [S1], {"S1": place})
    for planned, found in zip(made.sections, read.sections, strict=True):
        tip, axis = off(planned.path, found.path)
        assert tip <= TIP + ROUNDED and axis <= AXIS
        cut = found.path.motion != Motion.RAPID
        assert found.path.feed[cut] == pytest.approx(1200.0, rel=2e-4)
        assert found.path.dwells().sum() == pytest.approx(planned.path.dwells().sum())


@by_dialect
def test_a_tool_that_goes_on_in_its_direction_stays_at_the_work(name):
    place = standing(MACHINES[0])
    lean = (0.3, 0.1, 0.9)
    first = path_of(((0.0, 0.0, 300.0), lean), ((5.0, 0.0, 3.0), lean))
    second = path_of(((5.0, 0.0, 3.0), lean), ((9.0, 1.0, 3.0), lean))
    turning = path_of(((9.0, 1.0, 3.0), lean), ((9.0, 9.0, 3.0), (0.0, 0.0, 1.0)))
    text, read = posted(name, place, first, second, turning)
    top = registry.get("dialects", name)().words.top
    # At the tool change, before the tool is followed out of a tilted plane, at the end.
    assert text.count(top) == 3
    # Each begins where the one before has left the tool; the last is lifted at the end.
    assert [len(path) for path in read[1:]] == [3, 6]
    for path, planned in zip(read, (first, second, turning), strict=True):
        assert max(off(planned, path)) <= TIP
