"""How a part is turned between setups, in numbers and in words."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pytest import approx

from trunnion.geometry.frame import WORLD, Frame
from trunnion.model.setup import Setup
from trunnion.plan.setups.flip import turn_between, turn_words

ORIGIN = np.zeros(3)


def setup(name: str, x: tuple[float, ...], z: tuple[float, ...]) -> Setup:
    return Setup(
        name=name,
        frame=Frame(ORIGIN, np.array(x), np.array(z)),
        work_offset="G54",
        clearance=20.0,
        machine="Mill 1200",
    )


FIRST = setup("S1", (1, 0, 0), (0, 0, 1))


@pytest.mark.parametrize(
    ("x", "z", "words"),
    [
        ((1, 0, 0), (0, 0, -1), "180 degrees about X of S1"),
        ((-1, 0, 0), (0, 0, -1), "180 degrees about Y of S1"),
        ((-1, 0, 0), (0, 0, 1), "180 degrees about Z of S1"),
        ((1, 0, 0), (0, -1, 0), "90 degrees about minus X of S1"),
        ((1, 0, 0), (0, 1, 0), "90 degrees about X of S1"),
        ((1, 0, 0), (0, 0, 1), "lies as in S1"),
    ],
)
def test_the_turn_is_said_about_an_axis_of_the_first_setup(x, z, words):
    assert words in turn_words(FIRST, setup("S2", x, z))


def test_a_turn_about_no_axis_names_its_direction():
    assert "direction (0, 0.7071, 0.7071)" in turn_words(FIRST, setup("S2", (-1, 0, 0), (0, 1, 0)))


@given(
    st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda v: np.linalg.norm(v) > 0.1),
    st.floats(0.01, math.pi),
)
def test_axis_and_angle_make_the_same_turn(direction, angle):
    axis = np.array(direction) / np.linalg.norm(direction)
    turn = rotation(axis, angle)
    found, about = turn_between(WORLD, Frame(ORIGIN, turn.T[:, 0], turn.T[:, 2]))
    assert rotation(found, about) == approx(turn, abs=5e-3)


def rotation(axis: np.ndarray, angle: float) -> np.ndarray:
    """Return the rotation matrix of a turn (Rodrigues)."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross
