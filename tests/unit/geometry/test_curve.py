"""Curves of lines and arcs: lengths, areas, places on them, distances, pieces."""

from __future__ import annotations

import math

import numpy as np
import pytest
from pytest import approx

from trunnion.geometry.kernels import distance as plain
from trunnion.geometry.kernels import distance_compiled as compiled
from trunnion.geometry.plane.curve import Curve, joined

HALF = math.tan(math.pi / 4.0)
QUARTER = math.tan(math.pi / 8.0)


def slot() -> Curve:
    """A slot 30 long and 10 wide: two lines of 20 and two half circles of radius 5."""
    return Curve(
        np.array([[0.0, 0.0], [20.0, 0.0], [20.0, 10.0], [0.0, 10.0]]),
        np.array([0.0, HALF, 0.0, HALF]),
        True,
    )


def hook() -> Curve:
    """A line of 10, a quarter circle of radius 5 to the left, a line of 10."""
    return Curve(
        np.array([[0.0, 0.0], [10.0, 0.0], [15.0, 5.0], [15.0, 15.0]]),
        np.array([0.0, QUARTER, 0.0, 0.0]),
        False,
    )


def test_a_slot_has_the_length_and_area_worked_out_by_hand():
    assert slot().length == approx(40.0 + 10.0 * math.pi, abs=1e-12)
    assert slot().area == approx(200.0 + 25.0 * math.pi, abs=1e-12)


def test_an_area_keeps_its_digits_far_from_the_origin():
    assert slot().moved(1e5, -1e5).area == approx(200.0 + 25.0 * math.pi, abs=1e-7)


def test_reversing_a_closed_curve_negates_its_area_and_keeps_its_start():
    assert slot().reversed().area == approx(-slot().area)
    assert slot().reversed().start == approx(slot().start)


def test_reversing_an_open_curve_swaps_its_ends():
    back = hook().reversed()
    assert back.start == approx([15.0, 15.0])
    assert back.end == approx([0.0, 0.0])
    assert back.length == approx(hook().length)


def test_the_area_of_an_open_curve_is_refused():
    with pytest.raises(ValueError, match="open"):
        _ = hook().area


def test_a_box_reaches_to_the_tops_of_arcs():
    low, high = slot().box()
    assert low == approx([-5.0, 0.0])
    assert high == approx([25.0, 10.0])


def test_segments_tell_centre_radius_and_sweep():
    segments = slot().segments()
    assert segments.centre[1] == approx([20.0, 5.0])
    assert segments.radius[1] == approx(5.0, abs=1e-12)
    assert segments.sweep == approx([0.0, math.pi, 0.0, math.pi])
    assert np.isnan(segments.radius[0])


def test_at_gives_the_point_and_the_direction_along_an_arc():
    point, tangent = hook().at(10.0 + 5.0 * math.pi / 4.0)
    assert point == approx([10.0 + 5.0 * math.sqrt(0.5), 5.0 - 5.0 * math.sqrt(0.5)])
    assert tangent == approx([math.sqrt(0.5), math.sqrt(0.5)])


def test_at_wraps_on_a_closed_curve():
    assert slot().at(slot().length + 3.0)[0] == approx([3.0, 0.0])


def test_nearest_is_the_inverse_of_at():
    for s in np.linspace(0.5, hook().length - 0.5, 20):
        assert hook().nearest(hook().at(s)[0]) == approx(s, abs=1e-9)


def test_nearest_of_a_point_beyond_an_arc_is_the_arcs_end():
    arc = Curve(np.array([[5.0, 0.0], [0.0, 5.0]]), np.array([QUARTER, 0.0]), False)
    assert arc.nearest([-3.0, 5.5]) == approx(arc.length)
    assert arc.nearest([6.0, -3.0]) == approx(0.0)


def test_a_piece_across_the_start_of_a_closed_curve_runs_on():
    piece = slot().split(slot().length - 5.0, 5.0)
    assert piece.length == approx(10.0)
    assert piece.end == approx([5.0, 0.0])


def test_splitting_from_a_place_to_itself_opens_a_closed_curve_there():
    piece = slot().split(7.0, 7.0)
    assert not piece.closed
    assert piece.length == approx(slot().length)
    assert piece.start == approx(piece.end)


def test_a_part_of_an_arc_keeps_its_radius_and_centre():
    piece = hook().split(11.0, 14.0)
    assert piece.segments().radius == approx([5.0], abs=1e-12)
    assert piece.segments().centre[0] == approx([10.0, 5.0])


def test_an_empty_piece_of_an_open_curve_is_refused():
    with pytest.raises(ValueError, match="nothing lies between"):
        hook().split(5.0, 5.0)


def test_pieces_joined_give_the_curve_back():
    again = joined([hook().split(0.0, 12.0), hook().split(12.0, hook().length)])
    assert again.length == approx(hook().length)
    assert again.end == approx(hook().end)


def test_joining_round_to_the_start_closes_the_curve():
    again = joined([slot().split(0.0, 30.0), slot().split(30.0, slot().length)])
    assert again.closed
    assert again.area == approx(slot().area)


def test_joining_curves_that_do_not_meet_is_refused():
    with pytest.raises(ValueError, match="does not meet"):
        joined([hook(), hook()])


def test_sampled_chords_stay_within_the_chord_error():
    points = slot().sampled(0.01)
    middles = 0.5 * (points[1:] + points[:-1])
    assert slot().distance(points).max() < 1e-12
    assert 0.001 < slot().distance(middles).max() <= 0.01
    assert points[0] == approx(points[-1])


def test_distances_are_worked_out_on_lines_arcs_and_ends():
    away = hook().distance([[5.0, 3.0], [10.0, 5.0], [-3.0, 4.0], [15.0, 20.0], [12.0, 5.0]])
    assert away == approx([3.0, 5.0, 5.0, 5.0, 3.0])


def test_a_full_circle_is_two_arcs():
    circle = Curve.circle((1.0, 2.0), 3.0)
    assert circle.n_segments == 2
    assert circle.area == approx(9.0 * math.pi)
    assert circle.segments().centre == approx(np.array([[1.0, 2.0], [1.0, 2.0]]))


def test_turning_and_mirroring_keep_lengths():
    assert slot().rotated(1.0, (3.0, 4.0)).area == approx(slot().area)
    assert slot().mirrored().area == approx(-slot().area)


@pytest.mark.parametrize(
    ("points", "bulges", "closed", "message"),
    [
        ([[0.0, 0.0]], [0.0], False, "too few"),
        ([[0.0, 0.0], [1.0, 0.0]], [0.0, 0.0], True, "too few"),
        ([[0.0, 0.0], [1.0, 0.0]], [0.0, 1.0], False, "must be 0"),
        ([[0.0, 0.0], [math.nan, 0.0]], [0.0, 0.0], False, "finite"),
        ([[0.0, 0.0], [1.0, 0.0]], [0.0], False, "shape"),
    ],
)
def test_curves_that_are_none_are_refused(points, bulges, closed, message):
    with pytest.raises(ValueError, match=message):
        Curve(np.array(points), np.array(bulges), closed)


def test_a_circle_without_radius_and_a_flat_rectangle_are_refused():
    with pytest.raises(ValueError, match="above 0"):
        Curve.circle((0.0, 0.0), 0.0)
    with pytest.raises(ValueError, match="second corner"):
        Curve.rectangle(0.0, 0.0, 5.0, 0.0)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_compiled_loops_give_what_the_plain_ones_give(seed):
    numbers = np.random.default_rng(seed)
    curve = Curve(
        numbers.integers(-9, 9, (40, 2)).astype(float),
        numbers.choice([0.0, 0.0, 0.4, -0.7, 1.0, -2.0], 40),
        True,
    )
    s = curve.segments()
    rows = (s.start, s.end, s.centre, s.radius, s.sweep)
    points = np.concatenate(
        [
            numbers.uniform(-12.0, 12.0, (500, 2)),
            numbers.integers(-9, 9, (500, 2)).astype(float),
            s.start,
        ]
    )
    away, nearest = plain.nearest_segment(points, *rows)
    compiled_away, compiled_nearest = compiled.nearest_segment(points, *rows)
    assert (compiled_away == away).all()
    same = compiled_nearest == nearest
    assert same[:500].all()
    off = points[away > 1e-9]
    around = compiled.winding_numbers(off, *rows)
    assert (plain.winding_numbers(off, *rows) == around).all()
    alone = [compiled.winding_numbers(off[k : k + 1], *rows)[0] for k in range(len(off))]
    assert (around == alone).all()
    assert compiled.nearest_segment.py_func(points[:20], *rows)[0] == approx(away[:20], abs=1e-12)


@pytest.mark.parametrize("seed", [1, 2])
def test_the_nearest_of_many_segments_is_found_among_their_boxes(seed):
    numbers = np.random.default_rng(seed)
    curve = Curve(
        np.cumsum(numbers.uniform(-2.0, 2.0, (600, 2)), axis=0).round(1),
        numbers.choice([0.0, 0.0, 0.0, 0.2, -0.5, 1.0, -2.0], 600),
        True,
    )
    s = curve.segments()
    rows = (s.start, s.end, s.centre, s.radius, s.sweep)
    low, high = s.start.min(axis=0), s.start.max(axis=0)
    points = np.concatenate([numbers.uniform(low - 5.0, high + 5.0, (300, 2)).round(1), s.start])
    away, nearest = plain.nearest_segment(points, *rows)
    compiled_away, compiled_nearest = compiled.nearest_segment(points, *rows)
    assert (compiled_away == away).all()
    assert (compiled_nearest == nearest).all()


def test_many_points_at_once_are_as_far_away_as_each_alone(monkeypatch):
    points = np.random.default_rng(4).uniform(-10.0, 30.0, (50, 2))
    alone = slot().distance(points)
    monkeypatch.setattr("trunnion.geometry.plane.curve.COMPILED_FROM", 1)
    assert (slot().distance(points) == alone).all()
