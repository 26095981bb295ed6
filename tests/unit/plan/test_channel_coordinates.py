"""Coordinates between blades: meridian, cambers, lines along the stream."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import wheels
from trunnion.plan.channel.blade_channel import begins_of
from trunnion.plan.channel.meridian import MeridianSpline, cylindrical, in_space
from trunnion.toolpath.contact_passes.channel_lines import (
    CLEARANCE,
    between_toes,
    between_walls,
    hub_of,
    level_of,
    lines_between,
)

SHARES = st.floats(0.0, 1.0)


@settings(deadline=None)
@given(SHARES, SHARES)
def test_coordinates_of_a_place_are_those_it_was_made_from(u, w):
    meridian = wheels.meridian()
    found = meridian.coordinates(meridian.at(np.array([u]), np.array([w])))
    assert found[0] == pytest.approx([u, w], abs=1e-6)


def test_the_shroud_is_as_far_from_the_hub_as_their_circles():
    height = wheels.meridian().height(np.linspace(0.0, 1.0, 7))
    assert height == pytest.approx(wheels.HUB_RADIUS - wheels.SHROUD_RADIUS, abs=1e-3)


def test_a_curve_is_found_from_points_in_any_order():
    rows = wheels.quarter(wheels.HUB_RADIUS).rows
    mixed = rows[np.random.default_rng(1).permutation(len(rows))]
    found = MeridianSpline.through(mixed)
    assert found.length == pytest.approx(0.5 * np.pi * wheels.HUB_RADIUS, rel=1e-4)
    assert found.rows[0] == pytest.approx(rows[0])


def test_a_curve_goes_straight_on_beyond_its_ends():
    curve = wheels.quarter(10.0)
    point, along = curve.at(np.array([1.5]))
    # The quarter ends level, at (40, 22): half its length farther out.
    assert point[0] == pytest.approx([40.0 + 0.25 * np.pi * 10.0, 22.0], abs=1e-3)
    assert along[0] == pytest.approx([1.0, 0.0], abs=1e-3)


@settings(deadline=None)
@given(SHARES, SHARES)
def test_the_hub_of_a_gap_lies_on_the_hub_and_its_normal_points_at_the_shroud(u, v):
    channel = wheels.channel()
    point, normal = channel.hub(np.array([u]), np.array([v]))
    rz, _ = cylindrical(point)
    assert np.hypot(rz[0, 0] - 40.0, rz[0, 1] - 32.0) == pytest.approx(wheels.HUB_RADIUS, abs=1e-3)
    inner = channel.at(np.array([u]), np.array([v]), np.array([0.5]))
    assert (inner - point)[0] @ normal[0] > 0.99 * np.linalg.norm(inner - point)


def test_rulings_run_from_hub_to_shroud_at_the_same_angle():
    channel = wheels.channel()
    u, v = np.array([0.4]), np.array([0.3])
    ends = [channel.at(u, v, np.array([w])) for w in (0.0, 1.0)]
    expected = (ends[1] - ends[0])[0] / np.linalg.norm(ends[1] - ends[0])
    assert channel.rulings(u, v)[0] == pytest.approx(expected)
    assert cylindrical(ends[0])[1] == pytest.approx(cylindrical(ends[1])[1])


def test_places_off_the_walls_are_as_far_off_them_as_was_wanted():
    channel, off = wheels.channel(), 1.0
    u = np.linspace(0.0, 1.0, 201)
    w = np.full_like(u, 0.5)
    low, _ = between_walls(channel, u, w, off)
    at = channel.at(u, low, w)
    wide = np.linspace(-0.1, 1.1, 4001)
    wall = in_space(
        channel.meridian.at(wide, np.full_like(wide, 0.5)),
        channel.lower.side(1, wide, np.full_like(wide, 0.5)),
    )
    away = np.linalg.norm(at[10:-10, None] - wall[None], axis=2).min(axis=1)
    assert away.min() == pytest.approx(off + CLEARANCE, abs=0.06)
    assert away.max() == pytest.approx(off + CLEARANCE, abs=0.06)


def test_before_a_splitter_lines_come_up_to_its_camber_and_go_round_its_nose():
    whole, off, begin = wheels.channel(count=14), 4.0, 0.4
    splitter = replace(whole.upper, begins=np.array([[0.0, begin], [1.0, begin]]))
    channel = replace(whole, upper=splitter)
    u = np.linspace(-0.2, 1.0, 481)
    w = np.full_like(u, 0.5)
    low, high = between_walls(channel, u, w, off)
    same = between_walls(whole, u, w, off)
    run = channel.meridian.hub.run
    reach = 2.5 * (off + CLEARANCE + wheels.HALF_THICK * 40.0)
    assert high[u < begin - reach / run] == pytest.approx(1.0)
    assert high[u >= begin] == pytest.approx(same[1][u >= begin], abs=1e-2)
    assert low == pytest.approx(same[0])
    nose = in_space(
        channel.meridian.at(np.array([begin]), w[:1]), splitter.at(np.array([begin]), w[:1])
    )
    mine = (u > 0.0) & (u < begin)
    away = np.linalg.norm(channel.at(u, high, w)[mine] - nose, axis=1)
    assert away.min() > off


def test_a_camber_tells_where_its_walls_begin():
    nodes, w = np.linspace(-0.25, 1.25, 61), np.linspace(0.0, 1.0, 9)
    seen = np.where((nodes > 0.4)[:, None] & (w > 0.1), 1.0, np.nan)
    rows = begins_of([seen, seen], nodes, w)
    assert rows[:, 0] == pytest.approx(w[1:])
    assert rows[:, 1] == pytest.approx(nodes[nodes <= 0.4].max())


@pytest.mark.parametrize("stepover", (0.4, 1.5, 6.0))
def test_no_two_lines_lie_farther_apart_than_a_stepover(stepover):
    channel = wheels.channel()
    u = np.linspace(0.0, 1.0, 81)
    low, high = between_toes(channel, u)
    sets = lines_between(hub_of(channel), u, low, high, stepover)
    places = np.vstack([line.point for some in sets for line in some])
    for k in (0, 40, 80):
        across = channel.hub(np.full(400, u[k]), np.linspace(low[k], high[k], 400))[0]
        away = np.linalg.norm(across[:, None] - places[None], axis=2).min(axis=1)
        assert away.max() <= 0.5 * stepover * 1.05


def test_lines_are_no_closer_than_a_third_of_a_stepover_where_the_gap_is_narrow():
    channel = wheels.channel()
    u = np.linspace(0.0, 1.0, 81)
    sets = lines_between(hub_of(channel), u, *between_toes(channel, u), 0.5)
    inlet = sum(bool(np.hypot(*line.point[0, :2]) < 10.1) for some in sets[1:] for line in some)
    radius = 10.0
    width = radius * (2.0 * np.pi / 9)
    assert width / 0.5 <= inlet + 1 <= 3.0 * width / 0.5


def test_where_walls_leave_no_room_there_is_no_line():
    channel = wheels.channel()
    u = np.linspace(0.0, 1.0, 21)
    low, high = between_walls(channel, u, np.zeros_like(u), 50.0)
    assert lines_between(level_of(channel, lambda x: 0.0 * x, 1.0, 0.0), u, low, high, 1.0) == []
