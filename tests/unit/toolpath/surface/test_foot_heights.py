"""What stops a cutter at the foot of upright walls: asked at few places, the lowest and the highest are those of all places."""

from __future__ import annotations

import math

import numpy as np
import pytest

from trunnion.geometry.arrays import Floats
from trunnion.toolpath.contact_passes.upright import foot_heights
from trunnion.toolpath.contact_passes.upright.foot_heights import FOOT, stop_bounds

CLOSE = 0.04 * FOOT
"""mm: where heights around an extremum are the same, the one in between may be off by its curve over a hundredth of a millimetre."""


def walls_of(seed: int, count: int = 6000):
    """Return small triangles of a wall round a pocket of 30 x 20 mm, whose tips are from 0 to 8 mm high."""
    pick = np.random.default_rng(seed)
    along = np.sort(pick.uniform(0.0, 100.0, count))
    corner = np.array([[0.0, 0.0], [30.0, 0.0], [30.0, 20.0], [0.0, 20.0], [0.0, 0.0]])
    run = np.array([0.0, 30.0, 50.0, 80.0, 100.0])
    plan = np.column_stack([np.interp(along, run, corner[:, k]) for k in (0, 1)])
    rows = np.arange(count - 2)
    low = pick.uniform(0.0, 7.5, count - 2)
    return foot_heights._Walls(
        low=low,
        high=low + pick.uniform(0.05, 0.5, count - 2),
        places=plan,
        of=np.column_stack([rows, rows + 1, rows + 2]),
    )


def floors(seed: int):
    """Return the floor that stops the cutter: level, inclined, a bowl, waves, with a step."""
    pick = np.random.default_rng(1000 + seed)
    a, b, c = pick.uniform(-0.1, 0.1, 3) * pick.integers(0, 2, 3)
    step = pick.integers(0, 2) * pick.uniform(0.0, 3.0)
    wave = pick.integers(0, 2) * pick.uniform(0.0, 1.0)

    def height(places: Floats) -> Floats:
        x, y = places.T
        return (
            1.0
            + a * x
            + b * y
            + c * 0.05 * (x - 15.0) ** 2
            + wave * np.sin(0.7 * x)
            + step * (x > 21.37)
        )

    return height


@pytest.mark.parametrize("seed", range(24))
def test_the_lowest_stop_and_the_highest_foot_are_those_of_all_places(seed: int) -> None:
    walls, height = walls_of(seed), floors(seed)
    asked = []

    def stops(places: Floats) -> Floats:
        asked.append(len(places))
        return height(places)

    least, most = stop_bounds(walls, stops)
    exact = height(walls.places)
    assert (least <= exact + CLOSE).all() and (exact <= most + CLOSE).all()
    assert walls.lowest(least).min() == pytest.approx(walls.lowest(exact).min(), abs=CLOSE)
    assert walls.highest_foot(most) == pytest.approx(walls.highest_foot(exact), abs=CLOSE)
    assert sum(asked) < 0.5 * len(walls.places)


def test_over_a_level_floor_few_places_are_asked() -> None:
    walls, asked = walls_of(7), []

    def stops(places: Floats) -> Floats:
        asked.append(len(places))
        return np.full(len(places), 2.0)

    least, most = stop_bounds(walls, stops)
    assert (least == 2.0).all() and (most == 2.0).all()
    assert walls.highest_foot(most) == 2.0 and sum(asked) < 600


def test_places_that_are_alone_are_asked() -> None:
    walls = foot_heights._Walls(
        low=np.array([1.0]),
        high=np.array([9.0]),
        places=np.array([[0.0, 0.0], [10.0, 0.0], [20.0, 0.0]]),
        of=np.array([[0, 1, 2]]),
    )
    least, most = stop_bounds(walls, lambda places: 2.0 + 0.1 * places[:, 0])
    assert (least == most).all() and walls.highest_foot(most) == 4.0
    assert walls.lowest(least).tolist() == [2.0]


def test_where_nothing_stops_it_there_is_no_foot() -> None:
    walls = walls_of(3)
    least, most = stop_bounds(walls, lambda places: np.full(len(places), 50.0))
    assert walls.highest_foot(most) == -math.inf
    assert (walls.lowest(least) == walls.high).all()
