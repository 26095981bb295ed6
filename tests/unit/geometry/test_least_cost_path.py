"""The cheapest course through a table, and the directions over the sphere that it is chosen from."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from trunnion.geometry.kernels.shortest_paths import least_cost_path as plain
from trunnion.geometry.kernels.shortest_paths.least_cost_path_compiled import least_cost_path
from trunnion.geometry.sphere import angle_between, directions, neighbours

INF = math.inf
LINE = np.array([[0, 1, -1], [1, 0, 2], [2, 1, 3], [3, 2, -1]])
"""Four columns in a row: each is near itself and those beside it."""
FREE = np.zeros((4, 3))


def test_a_course_goes_where_it_is_cheapest() -> None:
    cost = np.array([[1.0, 0.0, 1.0, 1.0], [1.0, 1.0, 0.0, 1.0], [1.0, 1.0, 1.0, 0.0]])
    chosen, leap = least_cost_path(cost, LINE, FREE, 9.0)
    assert chosen.tolist() == [1, 2, 3] and not leap.any()


def test_a_course_goes_round_what_is_forbidden() -> None:
    cost = np.array(
        [[0.0, 5.0, 9.0, 9.0], [INF, 5.0, 9.0, 9.0], [INF, 5.0, 9.0, 9.0], [0.0, 5.0, 9.0, 9.0]]
    )
    assert least_cost_path(cost, LINE, FREE, 99.0)[0].tolist() == [0, 1, 1, 0]


def test_turning_costs_so_that_a_course_stays_where_little_is_gained() -> None:
    cost = np.array([[0.0, 1.0, 9.0, 9.0], [1.0, 0.0, 9.0, 9.0], [0.0, 1.0, 9.0, 9.0]])
    turn = np.array([[0.0, 2.0, 0.0], [0.0, 2.0, 2.0], [0.0, 2.0, 2.0], [0.0, 2.0, 0.0]])
    assert least_cost_path(cost, LINE, turn, 99.0)[0].tolist() == [0, 0, 0]


def test_a_course_leaps_where_nothing_near_goes_on() -> None:
    cost = np.array([[0.0, INF, INF, INF], [INF, INF, INF, 0.0]])
    chosen, leap = least_cost_path(cost, LINE, FREE, 9.0)
    assert chosen.tolist() == [0, 3] and leap.tolist() == [False, True]


def test_a_row_without_choice_ends_a_course_and_another_begins_behind_it() -> None:
    cost = np.array([[0.0, 1.0, 1.0, 1.0], [INF] * 4, [1.0, 1.0, 1.0, 0.0]])
    chosen, leap = least_cost_path(cost, LINE, FREE, 9.0)
    assert chosen.tolist() == [0, -1, 3] and not leap.any()


@settings(deadline=None, max_examples=60)
@given(st.integers(1, 9), st.integers(2, 7), st.integers(0, 2**31))
def test_the_compiled_loop_answers_as_the_plain_one(k: int, m: int, seed: int) -> None:
    some = np.random.default_rng(seed)
    cost = some.integers(0, 4, (k, m)).astype(float)
    cost[some.random((k, m)) < 0.3] = INF
    column = np.arange(m)
    near = np.column_stack([column, (column + 1) % m, np.where(column > 0, column - 1, -1)])
    turn = some.integers(0, 3, (m, 3)).astype(float)
    for mine, theirs in zip(
        least_cost_path(cost, near, turn, 3.0),
        plain.least_cost_path(cost, near, turn, 3.0),
        strict=True,
    ):
        assert (mine == theirs).all()


def test_directions_are_unit_even_and_lie_between_their_parents() -> None:
    point, parents = directions(3)
    assert point.shape == (642, 3) and np.allclose(np.linalg.norm(point, axis=1), 1.0)
    late = slice(12, None)
    to_parents = [angle_between(point[late], point[parents[late, k]]) for k in (0, 1)]
    assert np.allclose(to_parents[0], to_parents[1])
    nearest = np.sort(np.arccos(np.clip(point @ point.T, -1.0, 1.0)), axis=1)[:, 1]
    assert math.degrees(nearest.min()) > 7.9 and math.degrees(nearest.max()) < 9.5


def test_neighbours_are_all_within_reach_and_begin_with_the_direction_itself() -> None:
    point, _ = directions(2)
    rows, angle = neighbours(point, math.radians(20.0))
    assert (rows[:, 0] == np.arange(len(point))).all()
    assert set((rows >= 0).sum(axis=1).tolist()) == {6, 7}
    assert angle.max() <= math.radians(20.0)
