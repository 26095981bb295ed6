"""Axes with space around them, and paths round a wheel."""

from __future__ import annotations

import math

import numpy as np
import pytest

from leaning_tools import cutter
from trunnion.model.motion.toolpath import Mark, Motion
from trunnion.toolpath.contact_passes.linking.sphere_links import copied, linked_round
from trunnion.toolpath.contact_passes.open_axes import open_axes
from trunnion.toolpath.contact_passes.passes import Pass
from wheels import SPHERE, links_round


def within(low: float, high: float):
    """Return a query that is clear while the axis leans between two angles (degrees) from z towards x."""

    def query(tip, axis, *, start_tip=None, start_axis=None):
        angle = np.degrees(np.arctan2(axis[:, 0], axis[:, 2]))
        return (low < angle) & (angle < high)

    return query


def found(low, high, wanted=(0.0, 0.0, 1.0)):
    point = np.column_stack([np.arange(5.0), np.zeros(5), np.zeros(5)])
    normal = np.tile([0.0, 0.0, 1.0], (5, 1))
    axis = np.tile(np.array(wanted) / np.linalg.norm(wanted), (5, 1))
    return open_axes(
        point, normal, axis, cutter("ball", 6.0, 3.0), within(low, high), math.radians(85.0)
    )


def test_the_wanted_axis_stays_where_nothing_is_near():
    assert found(-90.0, 90.0).axis == pytest.approx(np.tile([0.0, 0.0, 1.0], (5, 1)))


def test_between_two_walls_the_axis_keeps_off_both():
    angle = np.degrees(np.arctan2(*found(10.0, 30.0).axis[:, [0, 2]].T))
    assert (angle >= 14.9).all() and (angle <= 25.1).all()


def test_where_no_axis_is_free_none_is_given():
    assert not found(120.0, 130.0).free.any()
    with pytest.raises(ValueError, match="no place has a free axis"):
        found(120.0, 130.0).field()


def test_the_field_at_a_place_is_its_axis():
    some = found(10.0, 30.0)
    assert some.field()(some.point, some.normal, some.normal) == pytest.approx(some.axis, abs=1e-6)


def straight(y: float) -> Pass:
    tip = np.column_stack([np.linspace(20.0, 30.0, 5), np.full(5, y), np.zeros(5)])
    axis = np.tile([0.0, 0.6, 0.8], (5, 1))
    return Pass(tip=tip, axis=axis, normal=axis)


def test_passes_side_by_side_are_linked_at_feed():
    path = linked_round([straight(0.0), straight(1.0).reversed()], links_round(2.0))
    assert (path.mark == Mark.LINK).sum() == 1
    rapid = path.motion == Motion.RAPID
    assert rapid.tolist() == [True, True, *[False] * (len(path) - 3), True]


def test_passes_of_other_groups_are_not():
    path = linked_round([straight(0.0), straight(1.0).reversed()], links_round(2.0), [0, 1])
    assert (path.mark == Mark.LINK).sum() == 0


def test_rapids_turn_the_tool_only_outside_of_the_sphere():
    one = linked_round([straight(0.0), straight(20.0)], links_round(2.0))
    path = copied(one, (0.0, 2.0, 4.0), SPHERE)
    turned = np.flatnonzero(np.linalg.norm(np.diff(path.axis, axis=0), axis=1) > 1e-9) + 1
    for rows in (turned - 1, turned):
        along = (path.position[rows] * path.axis[rows]).sum(axis=1)
        assert (along >= SPHERE.radius - 1e-6).all()
    assert (path.motion[turned] == Motion.RAPID).all()


def test_copies_are_the_path_turned_about_the_axis_from_upright_to_upright():
    one = linked_round([straight(0.0)], links_round(2.0))
    path = copied(one, (0.0, 0.5 * math.pi), SPHERE)
    cut = path.position[path.mark == Mark.CUT]
    half = len(cut) // 2
    turned = np.column_stack([-cut[:half, 1], cut[:half, 0], cut[:half, 2]])
    assert cut[half:] == pytest.approx(turned)
    assert path.axis[[0, -1]] == pytest.approx(np.tile([0.0, 0.0, 1.0], (2, 1)))
    assert path.position[[0, -1], 2] == pytest.approx(SPHERE.radius)
