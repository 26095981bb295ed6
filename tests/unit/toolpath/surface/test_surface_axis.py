"""Where tool axes should lean by a field, and how a contact way runs between its contacts."""

from __future__ import annotations

import math

import numpy as np
import pytest
from pytest import approx

from trunnion.findings import BadInput
from trunnion.geometry.sphere import angle_between
from trunnion.toolpath.contact_passes.axis_fields import (
    eased,
    fixed,
    from_curve,
    from_point,
    interpolated,
    leaning,
)
from trunnion.toolpath.contact_passes.contacts import Contacts, axis_between, between

POINT, UP, FEED = (
    np.array([[5.0, 0.0, 0.0]]),
    np.array([[0.0, 0.0, 1.0]]),
    np.array([[1.0, 0.0, 0.0]]),
)


def axis_of(field, point=POINT):
    n = len(point)
    return field(point, np.repeat(UP, n, axis=0), np.repeat(FEED, n, axis=0))


def test_a_lead_leans_towards_the_feed_and_a_tilt_to_the_left_of_it() -> None:
    assert axis_of(leaning(math.radians(30.0), 0.0))[0] == approx([0.5, 0.0, math.sqrt(0.75)])
    assert axis_of(leaning(0.0, math.radians(30.0)))[0] == approx([0.0, 0.5, math.sqrt(0.75)])


def test_a_fixed_axis_is_the_same_everywhere_and_of_length_one() -> None:
    assert axis_of(fixed([0.0, 3.0, 4.0]), np.zeros((2, 3))) == approx(
        np.array([[0.0, 0.6, 0.8]] * 2)
    )


def test_axes_point_away_from_a_place_or_towards_it() -> None:
    assert axis_of(from_point([5.0, 0.0, -9.0]))[0] == approx([0.0, 0.0, 1.0])
    assert axis_of(from_point([5.0, 3.0, 4.0], away=False))[0] == approx([0.0, 0.6, 0.8])


def test_axes_point_away_from_the_nearest_place_of_a_curve() -> None:
    spine = [[-10.0, 0.0, -3.0], [5.0, 0.0, -3.0], [5.0, 90.0, -3.0]]
    field = from_curve(spine)
    assert axis_of(field, np.array([[0.0, 4.0, 0.0], [9.0, 40.0, 0.0]])) == approx(
        np.array([[0.0, 0.8, 0.6], [0.8, 0.0, 0.6]])
    )


def test_a_place_on_the_faces_gives_no_axis_and_says_so() -> None:
    with pytest.raises(BadInput, match="off the faces"):
        axis_of(from_point(POINT[0]))


def test_axes_between_vectors_are_those_at_their_places_and_halfway_in_between() -> None:
    field = interpolated([[0.0, 0.0, 0.0], [10.0, 0.0, 0.0]], [[0.0, 0.0, 2.0], [0.0, 5.0, 0.0]])
    found = axis_of(field, np.array([[0.0, 0.0, 0.0], [5.0, 0.0, 0.0], [10.0, 0.0, 0.0]]))
    assert found == approx(
        np.array([[0.0, 0.0, 1.0], [0.0, math.sqrt(0.5), math.sqrt(0.5)], [0.0, 1.0, 0.0]])
    )


def turning(angles):
    return np.column_stack([np.sin(angles), np.zeros(len(angles)), np.cos(angles)])


def test_easing_keeps_what_does_not_turn_and_both_ends() -> None:
    still = np.repeat(turning(np.array([0.3])), 9, axis=0)
    assert eased(still, 2.0) == approx(still)
    axis = turning(np.radians([0.0, 0.0, 20.0, 20.0, 60.0, 60.0, 80.0]))
    assert eased(axis, 1.0)[[0, -1]] == approx(axis[[0, -1]], abs=1e-9)


def test_easing_turns_no_faster_than_what_is_eased() -> None:
    axis = turning(np.radians([0, 0, 0, 10, 10, 20, 20, 20, 30, 30, 20, 20, 10, 10, 10]))
    smooth = eased(axis, 2.0)
    assert angle_between(smooth[1:], smooth[:-1]).max() < math.radians(10.0)
    assert angle_between(smooth[1:], smooth[:-1])[4:8].max() < math.radians(6.0)


def round_way(radius, step, count):
    angle = step * np.arange(count)
    out = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(count)])
    return Contacts(point=radius * out, normal=out)


def test_between_contacts_on_a_round_face_the_way_stays_on_it() -> None:
    way = round_way(2.0, math.radians(20.0), 7)
    place = np.linspace(1.0, 5.0, 81)
    point, normal = between(way.point, way.normal, way.feed, place)
    assert np.abs(np.linalg.norm(point, axis=1) - 2.0).max() < 2e-6
    assert (point / 2.0 * normal).sum(axis=1).min() > 1.0 - 1e-6


def test_the_feed_runs_along_the_face_and_round_a_closed_way() -> None:
    angle = np.linspace(0.0, 2.0 * np.pi, 37)
    out = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(37)])
    closed = Contacts(point=3.0 * out, normal=out, closed=True)
    assert closed.feed == approx(
        np.column_stack([-np.sin(angle), np.cos(angle), np.zeros(37)]), abs=1e-9
    )
    assert round_way(3.0, 0.1, 5).feed[2] == approx([-math.sin(0.2), math.cos(0.2), 0.0])


def test_travel_is_what_a_cutter_of_a_radius_goes() -> None:
    way = round_way(2.0, math.radians(1.0), 91)
    assert way.travel(0.0)[-1] == approx(math.pi, rel=1e-4)
    assert way.travel(3.0)[-1] == approx(2.5 * math.pi, rel=1e-4)


def test_axes_turn_evenly_from_place_to_place() -> None:
    axis = turning(np.radians([0.0, 30.0, 90.0]))
    assert axis_between(axis, np.array([0.5, 1.25])) == approx(turning(np.radians([15.0, 45.0])))
