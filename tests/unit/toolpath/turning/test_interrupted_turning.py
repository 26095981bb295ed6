"""Interrupted turning: the table never stops, the tool is down in gaps alone, and no axis is asked for more than it has."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gap_turning import BUTTON_12, SETTINGS, SETUP, drive, gap_data, ground, slower, two_gaps
from trunnion.model.motion.toolpath import Mark, Motion
from trunnion.plan.turning.gap_drive import GapPass
from trunnion.plan.turning.retract import travel_time, travelled
from trunnion.progress import NO_PROGRESS
from trunnion.toolpath.turning.interrupted import interrupted


def laid(made, settings=SETTINGS, data=None):
    """Return the path of a drive, and the places along its ground, the angles as they grow and the heights of its tips."""
    path = interrupted(made, BUTTON_12, data or gap_data(), None, SETUP, settings, NO_PROGRESS).path
    flat = made.development.to_local(path.position)
    along, turns = made.development.along_and_turn(flat)
    return path, along, np.unwrap(turns), flat[:, 2]


def passes():
    """Return a strategy of passes over ground: gaps that don't overlap, all long enough."""

    @st.composite
    def made(draw):
        count = draw(st.integers(1, 3))
        low = draw(st.floats(-math.pi, math.pi))
        sizes = [draw(st.floats(0.9, 1.6)) for _ in range(count)]
        free = (2.0 * math.pi - sum(sizes)) / count
        gaps, at = [], low
        for size in sizes:
            gaps.append((at, at + size))
            at += size + free
        lift = draw(st.floats(4.0, 12.0))
        rows = draw(st.integers(1, 4))
        return [GapPass(along=0.5 * k, lift=lift, gaps=tuple(gaps)) for k in range(rows)]

    return made()


@given(passes(), st.sampled_from([-0.4, 0.0, 0.25]), st.floats(10.0, 40.0))
def test_the_table_turns_one_way_at_one_speed(rows, slope, speed):
    made = drive(*rows, on=ground(slope=slope))
    data = gap_data(speed)
    path, along, turns, _ = laid(made, data=data)
    assert (np.diff(turns) >= -1e-9).all()
    fed = np.flatnonzero(path.motion == Motion.LINE)
    length = np.linalg.norm(path.position[fed] - path.position[fed - 1], axis=1)
    seconds = 60.0 * length / path.feed[fed]
    radius = made.development.radius_at(along[fed])
    assert (turns[fed] - turns[fed - 1]) * radius / seconds == pytest.approx(
        np.full(len(fed), speed * 1000.0 / 60.0), rel=1e-6
    )


@given(passes(), st.sampled_from([-0.4, 0.0, 0.25]))
def test_the_tool_is_down_in_every_gap_and_nowhere_else(rows, slope):
    made = drive(*rows, on=ground(slope=slope))
    path, along, turns, heights = laid(made)
    lift, data = rows[0].lift, gap_data()
    for each in rows:
        own = np.abs(along - each.along) < 1e-9
        for start, end in each.gaps:
            radius = float(made.development.radius_at(np.array([each.along]))[0])
            off = SETTINGS.motion.end(data.speed, lift) / radius
            inside = own & (path.mark == Mark.CUT)
            at = (turns[inside] - start) % (2.0 * math.pi)
            cut = at[at < end - start]
            # All of the gap but its ends is cut, in blocks that are no longer than their chords allow.
            assert cut.min() - off < 0.02 and end - start - off - cut.max() < 1e-6
    low = heights < lift - 1e-6
    inside = np.zeros(len(turns), bool)
    for each in rows:
        for start, end in each.gaps:
            inside |= (turns - start) % (2.0 * math.pi) <= end - start
    assert (inside | ~low).all()
    assert heights.min() == pytest.approx(0.5 * SETTINGS.chord)


@given(passes(), st.floats(3.0, 30.0), st.floats(800.0, 6000.0))
def test_the_retracting_axis_keeps_its_speed_and_acceleration(rows, speed, acceleration):
    settings = slower(SETTINGS, speed, acceleration)
    made = drive(*rows)
    path, _, _, heights = laid(made, settings, gap_data(10.0))
    # Between two of these blocks' ends the axis goes at an even rate: it is the mean of what it may do.
    for mark in (Mark.ENTRY, Mark.LEAD):
        rows_of = np.flatnonzero((path.mark == mark) & (path.motion == Motion.LINE))
        length = np.linalg.norm(path.position[rows_of] - path.position[rows_of - 1], axis=1)
        rate = (heights[rows_of] - heights[rows_of - 1]) / (60.0 * length / path.feed[rows_of])
        assert np.abs(rate).max() <= speed * 1000.0 / 60.0 * (1.0 + 1e-6)
        seconds = 60.0 * length / path.feed[rows_of]
        same = np.diff(rows_of) == 1
        change = np.abs(np.diff(rate))[same] / seconds[1:][same]
        assert change.max(initial=0.0) <= acceleration * (1.0 + 1e-3)


def test_ground_between_two_blocks_is_off_its_circle_by_half_the_chord_error_on_either_side():
    path, _, _, _ = laid(drive(two_gaps(0.0)))
    cut = np.flatnonzero(path.mark == Mark.CUT)
    tips = path.position[cut]
    middle = 0.5 * (tips + path.position[cut - 1])
    assert np.hypot(tips[:, 0], tips[:, 1]).max() - 200.0 <= 0.5 * SETTINGS.chord + 1e-9
    assert np.hypot(middle[:, 0], middle[:, 1]).min() - 200.0 >= -0.5 * SETTINGS.chord - 1e-9


def test_it_begins_and_ends_clear_of_all():
    made = drive(two_gaps(0.0), two_gaps(0.5))
    path, _, _, heights = laid(made)
    assert heights[[0, -1]] == pytest.approx([60.0, 60.0])
    assert (path.motion[[0, 1, -1]] == Motion.RAPID).all()
    assert (path.motion[2:-1] == Motion.LINE).all()


@given(st.floats(0.5, 60.0), st.floats(50.0, 800.0), st.floats(500.0, 8000.0))
def test_a_way_from_rest_to_rest_takes_its_time_and_no_more_acceleration(length, speed, most):
    whole = travel_time(length, speed, most)
    times = np.linspace(0.0, whole, 4001)
    gone = travelled(times, length, speed, most)
    assert gone[0] == 0.0 and gone[-1] == pytest.approx(length)
    rate = np.diff(gone) / np.diff(times)
    assert rate.min() >= -1e-6 and rate.max() <= speed * (1.0 + 1e-6)
    # Rates of neighbours change by what the acceleration allows in the time between their middles.
    assert np.abs(np.diff(rate)).max() <= most * whole / 4000.0 * (1.0 + 1e-4)
