"""Rotary axes that are wound up turn by turn begin anew before they come to their end."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from pytest import approx

from own_shop import own_shop
from trunnion.findings import Refused
from trunnion.shop import load_shop
from trunnion.shop.kinematics import WorkPosition
from trunnion.shop.rotary_angles import followed

TRUNNION = own_shop().machines["Trunnion 650"]


def place(turns):
    """A place on a trunnion whose table turns so many times each way."""
    axes = tuple(
        replace(a, low=-360.0 * turns, high=360.0 * turns) if a.name == "C" else a
        for a in TRUNNION.axes
    )
    return WorkPosition(
        machine=replace(TRUNNION, axes=axes), foot=np.zeros(3), centre=np.zeros(3), radius=60.0
    )


def spiral(turns):
    """Level axes that go round so many times."""
    angle = np.radians(np.arange(0.0, 360.0 * turns + 1.0, 5.0))
    return np.column_stack([np.cos(angle), np.sin(angle), np.zeros(len(angle))])


def test_a_spiral_goes_on_from_where_the_one_before_ended() -> None:
    first = followed(spiral(4), place(20), None, 1e-3, "one")
    second = followed(spiral(4), place(20), first[-1], 1e-3, "two")
    assert second[0] == approx(first[-1]) and abs(second[-1, 1] - first[0, 1]) == approx(
        np.radians(8 * 360.0)
    )


def test_where_an_axis_has_no_turns_left_it_begins_near_the_middle() -> None:
    first = followed(spiral(12), place(20), None, 1e-3, "one")
    second = followed(spiral(12), place(20), first[-1], 1e-3, "two")
    assert np.abs(second[:, 1]).max() <= np.radians(20 * 360.0 + 1e-3)
    assert abs(second[0, 1] - first[-1, 1]) > np.radians(3 * 360.0)


def test_more_turns_than_the_axis_has_are_refused() -> None:
    with pytest.raises(Refused, match="can't be reached from the block before"):
        followed(spiral(5), place(2), None, 1e-3, "one")


@pytest.mark.parametrize("around", [-170.0, -95.0, -10.0, 60.0, 120.0, 180.0])
def test_a_head_leans_to_one_side_wherever_the_tool_comes_from(around: float) -> None:
    """The nearer turn of the table would lean it to the other side for half of them, and X would travel twice as far."""
    universal = WorkPosition(
        machine=load_shop().machines["Universal 1250"],
        foot=np.zeros(3),
        centre=np.zeros(3),
        radius=200.0,
    )
    turn = np.radians(around)
    axis = np.array([[np.cos(turn), np.sin(turn), -0.2]])
    angles = followed(axis / np.linalg.norm(axis), universal, None, 1e-3, "one")
    assert 0.0 < angles[0, 0] < np.radians(105.0)
