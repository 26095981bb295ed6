"""Which directions hidden places are roughed from."""

from __future__ import annotations

import numpy as np

from trunnion.plan.freeform.roughing.directions import selected, shared_out


def seen(*runs):
    """Return what directions see of 100 places, each a run of them from a first to before a last one."""
    return np.array([[first <= k < last for k in range(100)] for first, last in runs])


def test_one_tilted_direction_that_sees_all_is_taken_before_two_level_ones():
    found = selected(seen((0, 55), (45, 100), (0, 100)), np.array([False, False, True]))
    assert found == [2]


def test_a_level_direction_is_taken_where_a_tilted_one_sees_hardly_more():
    assert selected(seen((0, 96), (0, 100)), np.array([False, True])) == [0]


def test_a_direction_that_adds_little_is_not_worth_its_turn():
    assert selected(seen((0, 90), (90, 100)), np.array([False, False])) == [0]
    assert selected(seen((0, 80), (70, 100)), np.array([False, False])) == [0, 1]


def test_a_place_is_left_to_the_direction_that_it_lies_least_deep_from():
    across = np.linspace(0.0, 60.0, 100)
    own = shared_out(seen((0, 100), (40, 90)), np.array([across, 60.0 - across]))
    assert own[1].nonzero()[0].tolist() == list(range(50, 90))
    assert (own.sum(axis=0) == 1).all()
