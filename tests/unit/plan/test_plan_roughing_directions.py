"""Which directions hidden places are roughed from."""

from __future__ import annotations

import numpy as np

from trunnion.plan.freeform.roughing.directions import selected


def seen(*runs):
    """Return what directions see of 100 places, each a run of them from a first to before a last one."""
    return np.array([[first <= k < last for k in range(100)] for first, last in runs])


def rows(found):
    return [row for row, _ in found]


def test_one_tilted_direction_that_sees_all_is_taken_before_two_level_ones():
    found = selected(seen((0, 55), (45, 100), (0, 100)), np.array([False, False, True]))
    assert rows(found) == [2]


def test_a_level_direction_is_taken_where_a_tilted_one_sees_hardly_more():
    assert rows(selected(seen((0, 96), (0, 100)), np.array([False, True]))) == [0]


def test_a_direction_that_adds_little_is_not_worth_its_turn():
    found = selected(seen((0, 90), (90, 100)), np.array([False, False]))
    assert rows(found) == [0] and found[0][1].sum() == 90
    assert rows(selected(seen((0, 80), (70, 100)), np.array([False, False]))) == [0, 1]
