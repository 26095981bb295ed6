"""Speeds and feeds: the closed forms between the ways of giving them, and texts that give them in each."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pytest import approx

from trunnion.model.operation import CuttingData
from trunnion.model.spindle import (
    FeedMode,
    SpindleMode,
    feed_of_inverse,
    inverse_feed,
    limited_turns,
    per_minute,
    per_revolution,
    surface_speed,
    turns_of,
)
from trunnion.settings import digest, unwritten

above_zero = st.floats(1e-3, 1e5)
DATA = CuttingData(
    speed=120.0,
    spindle=2000.0,
    feed_per_tooth=0.1,
    feed=600.0,
    plunge_feed=200.0,
    depth=1.0,
    width=2.0,
    removal_rate=1.2,
    power=0.5,
    power_limit=10.0,
    torque=2.4,
)


def test_a_hundred_millimetres_at_a_thousand_turns():
    assert surface_speed(1000.0, 100.0) == approx(100.0 * math.pi)
    assert turns_of(100.0 * math.pi, 100.0) == approx(1000.0)
    assert per_revolution(600.0, 2000.0) == approx(0.3)
    # 5 mm at 600 mm/min take half a second.
    assert inverse_feed(600.0, 5.0) == approx(60.0 / 0.5)


@given(speed=above_zero, diameter=above_zero)
def test_turns_and_surface_speed_undo_each_other(speed, diameter):
    assert surface_speed(turns_of(speed, diameter), diameter) == approx(speed)


@given(feed=above_zero, turns=above_zero, length=above_zero)
def test_the_ways_of_giving_a_feed_undo_each_other(feed, turns, length):
    assert per_minute(per_revolution(feed, turns), turns) == approx(feed)
    assert feed_of_inverse(inverse_feed(feed, length), length) == approx(feed)


@given(speed=above_zero, highest=above_zero, diameter=st.floats(0.0, 1e5))
def test_the_spindle_keeps_the_surface_speed_up_to_its_highest(speed, highest, diameter):
    (turns,) = limited_turns(speed, np.array([diameter]), highest)
    assert turns <= highest
    if turns < highest * (1.0 - 1e-12):
        assert surface_speed(turns, diameter) == approx(speed)
    else:
        assert surface_speed(turns, diameter) <= speed * (1.0 + 1e-9)


def test_a_rotating_tool_has_its_surface_at_its_own_diameter():
    data = replace(DATA, spindle_mode=SpindleMode.SURFACE, highest_spindle=9000.0)
    assert data.spindle_at(10.0) == approx(120_000.0 / (10.0 * math.pi))
    assert data.spindle_at(1.0) == 9000.0
    assert DATA.spindle_at(1.0) == 2000.0


def test_a_constant_surface_speed_needs_a_highest_spindle_speed():
    with pytest.raises(ValueError, match="needs a highest spindle speed"):
        replace(DATA, spindle_mode=SpindleMode.SURFACE)


def test_what_is_not_used_leaves_digests_and_json_as_they_were():
    before = DATA.as_dict()
    assert list(before)[-1] == "routed_depth"
    assert unwritten(DATA) == {
        "spindle_mode",
        "highest_spindle",
        "feed_mode",
        "entry_angle",
        "handbook_spindle",
        "handbook_feed",
        "bound_by",
        "ramp_share",
        "layer_depth",
        "layer_width",
        "layer_share",
        "fastest_link",
        "link_share",
        "thin_share",
    }
    assert digest(DATA) == "90568a01d1978e9b"
    by_turns = replace(DATA, feed_mode=FeedMode.REVOLUTION)
    assert by_turns.as_dict() == before | {"feed_mode": "revolution"}
    assert digest(by_turns) != digest(DATA)
