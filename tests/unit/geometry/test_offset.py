"""Offsets: what grows and shrinks keeps its lines and arcs, and what vanishes, splits or merges does so cleanly."""

from __future__ import annotations

import math

import numpy as np
import pytest
from pytest import approx

from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.offset import parallel_curves
from trunnion.geometry.plane.region import Region

QUARTER = math.tan(math.pi / 8.0)


def rounded(x0: float, y0: float, x1: float, y1: float, r: float) -> Curve:
    """An anticlockwise rectangle with corners of radius r."""
    points = [
        [x0 + r, y0],
        [x1 - r, y0],
        [x1, y0 + r],
        [x1, y1 - r],
        [x1 - r, y1],
        [x0 + r, y1],
        [x0, y1 - r],
        [x0, y0 + r],
    ]
    return Curve(np.array(points), np.array([0.0, QUARTER] * 4), True)


def pocket() -> Region:
    """A pocket 100 by 60 with corners of 8, a round island of 10 and a rounded square one."""
    return Region.of(
        [
            rounded(0.0, 0.0, 100.0, 60.0, 8.0),
            Curve.circle((30.0, 30.0), 10.0),
            rounded(60.0, 20.0, 80.0, 40.0, 3.0),
        ]
    )


def radii(region: Region) -> list[float]:
    found = region.segments().radius
    return sorted(found[~np.isnan(found)].tolist())


def worst_kink(region: Region) -> float:
    """The largest change of direction, in degrees, between neighbours of the region's loops."""
    worst = 0.0
    for curve in region.curves():
        s = curve.segments()
        rows = np.arange(len(s))
        u, v = s.directions(rows, s.length), np.roll(s.directions(rows, 0.0 * s.length), -1, axis=0)
        worst = max(
            worst,
            float(
                np.degrees(
                    np.abs(np.arctan2(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0], (u * v).sum(axis=1)))
                ).max()
            ),
        )
    return worst


def test_shrinking_moves_every_wall_and_radius_by_the_distance():
    small = pocket().offset(-5.0)
    assert radii(small) == approx([3.0] * 4 + [8.0] * 4 + [15.0] * 2, abs=1e-12)
    assert small.area == approx(
        90.0 * 50.0 - (4.0 - math.pi) * 9.0 - 225.0 * math.pi - (900.0 - (4.0 - math.pi) * 64.0)
    )


def test_shrinking_and_growing_back_gives_the_rounded_pocket():
    again = pocket().offset(-5.0).offset(5.0)
    assert [c.n_segments for c in again.curves()] == [8, 8, 2]
    assert again.area == approx(pocket().area, abs=1e-9)
    assert pocket().segments().radius[1] == approx(again.segments().radius[1], abs=1e-12)
    assert np.abs(pocket().signed_distance(again.segments().start)).max() < 1e-9


def test_tangent_joins_stay_tangent():
    assert worst_kink(pocket().offset(-5.0)) < 1e-6
    assert worst_kink(pocket().offset(2.0)) < 1e-6


def test_an_offset_of_exactly_the_corner_radius_gives_sharp_corners():
    inner = Region.of([rounded(0.0, 0.0, 100.0, 60.0, 8.0)]).offset(-8.0)
    assert inner.pieces[0].outer.n_segments == 4
    assert inner.area == approx(84.0 * 44.0, abs=1e-9)


def test_an_offset_beyond_the_corner_radius_keeps_sharp_corners():
    inner = Region.of([rounded(0.0, 0.0, 100.0, 60.0, 8.0)]).offset(-20.0)
    assert sorted(map(tuple, inner.pieces[0].outer.points.round(9).tolist())) == [
        (20.0, 20.0),
        (20.0, 40.0),
        (80.0, 20.0),
        (80.0, 40.0),
    ]


def test_growing_a_rectangle_rounds_its_corners():
    grown = Region.rectangle(0.0, 0.0, 10.0, 20.0).offset(3.0)
    assert radii(grown) == approx([3.0] * 4, abs=1e-12)
    assert grown.area == approx(200.0 + 60.0 * 3.0 + 9.0 * math.pi)


def test_opening_a_sharp_pocket_leaves_the_corners_a_cutter_can_not_reach():
    opened = Region.rectangle(0.0, 0.0, 50.0, 30.0).opened(8.0)
    assert opened.area == approx(1500.0 - (4.0 - math.pi) * 64.0)


def test_closing_fills_a_slot_that_is_narrower_than_the_disc():
    block = Region.rectangle(0.0, 0.0, 50.0, 30.0).minus(Region.rectangle(20.0, 10.0, 24.0, 40.0))
    assert block.closed(3.0).area > block.area + 60.0
    assert block.closed(1.0).area == approx(block.area + (2.0 - 0.5 * math.pi), abs=1e-9)


def test_a_neck_narrower_than_twice_the_offset_splits_a_region():
    dumbbell = Region.rectangle(0.0, 0.0, 20.0, 20.0).union(Region.rectangle(40.0, 0.0, 60.0, 20.0))
    dumbbell = dumbbell.union(Region.rectangle(10.0, 8.0, 50.0, 12.0))
    assert len(dumbbell.offset(-1.5).pieces) == 1
    into_the_neck = 2.0 * (3.0 * 2.0 - (math.sqrt(5.0) + 4.5 * math.asin(2.0 / 3.0)))
    assert [p.area for p in dumbbell.offset(-3.0).pieces] == approx([196.0 + into_the_neck] * 2)


def test_a_neck_of_exactly_twice_the_offset_leaves_no_hair():
    dumbbell = Region.rectangle(0.0, 0.0, 20.0, 20.0).union(Region.rectangle(40.0, 0.0, 60.0, 20.0))
    dumbbell = dumbbell.union(Region.rectangle(10.0, 8.0, 50.0, 12.0))
    split = dumbbell.offset(-2.0)
    assert [p.area for p in split.pieces] == approx([256.0 + 2.0 * (4.0 - math.pi)] * 2, abs=1e-3)


def test_an_island_that_grows_into_the_wall_opens_the_ring():
    region = Region.rectangle(0.0, 0.0, 60.0, 40.0).minus(Region.circle((30.0, 12.0), 6.0))
    assert len(region.offset(-2.0).curves()) == 2
    assert len(region.offset(-4.0).curves()) == 1


def test_islands_that_grow_together_become_one():
    plate = Region.rectangle(0.0, 0.0, 100.0, 100.0)
    plate = plate.minus(Region.circle((40.0, 50.0), 5.0)).minus(Region.circle((56.0, 50.0), 5.0))
    assert len(plate.offset(-2.0).curves()) == 3
    merged = plate.offset(-5.0)
    assert len(merged.curves()) == 2
    assert set(np.round(radii(merged), 9).tolist()) == {10.0}
    assert np.abs(merged.curves()[1].points - [48.0, 56.0]).max(axis=1).min() < 1e-9


@pytest.mark.parametrize("distance", [-30.0, -30.5, -500.0, -29.9999])
def test_a_region_that_is_too_narrow_vanishes(distance):
    assert not Region.of([rounded(0.0, 0.0, 100.0, 60.0, 8.0)]).offset(distance)


def test_a_disc_shrinks_and_grows_as_a_circle():
    assert radii(Region.circle((3.0, 4.0), 10.0).offset(-4.0)) == approx([6.0, 6.0], abs=1e-12)
    assert radii(Region.circle((3.0, 4.0), 10.0).offset(4.0)) == approx([14.0, 14.0], abs=1e-12)
    assert not Region.circle((3.0, 4.0), 10.0).offset(-10.0)


def test_a_hole_that_is_grown_over_disappears():
    plate = Region.rectangle(0.0, 0.0, 50.0, 50.0).minus(Region.circle((25.0, 25.0), 3.0))
    assert len(plate.offset(2.0).curves()) == 2
    assert len(plate.offset(3.0).curves()) == 1


def test_a_cusp_beside_a_wall_is_rounded_when_it_grows():
    """A spike between a line and the arc tangent to it: growing goes round its tip by half a circle."""
    points = [[0.0, 0.0], [20.0, 0.0], [20.0, 20.0], [10.0, 10.0], [0.0, 10.0]]
    spike = Region.of([Curve(np.array(points), np.array([0.0, 0.0, 0.0, 0.0, 0.0]), True)])
    cusp = spike.minus(Region.circle((10.0, 20.0), 10.0))
    assert cusp.offset(1.0).contains([[20.7, 20.5], [20.0, 20.9]]).all()


def test_an_offset_of_nothing_is_the_region_itself():
    region = pocket()
    assert region.offset(0.0) is region


def test_many_small_steps_inward_come_to_the_same_as_one():
    region = pocket()
    for _ in range(12):
        region = region.offset(-0.75)
    once = pocket().offset(-9.0)
    assert region.area == approx(once.area, abs=1e-6)
    assert radii(region) == approx(radii(once), abs=1e-9)


def test_walls_that_are_tangent_only_to_a_thousandth_are_followed():
    points = rounded(0.0, 0.0, 100.0, 60.0, 8.0).points + np.random.default_rng(1).uniform(
        -1e-3, 1e-3, (8, 2)
    )
    rough = Region.of([Curve(points, np.array([0.0, QUARTER] * 4), True)])
    for distance in (-12.0, -8.0, -3.0, 3.0):
        s = rough.offset(distance).segments()
        assert (
            np.abs(-rough.signed_distance(s.at(np.arange(len(s)), 0.5 * s.length)) - distance).max()
            < 2e-6
        )


def test_a_straight_parallel_lies_to_the_left():
    (beside,) = parallel_curves(Curve.polyline([[0.0, 0.0], [10.0, 0.0]]), 2.0)
    assert beside.points == approx(np.array([[0.0, 2.0], [10.0, 2.0]]))


def test_a_parallel_is_trimmed_inside_a_corner_and_rounded_outside():
    corner = Curve.polyline([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]])
    (inside,), (outside,) = parallel_curves(corner, 3.0), parallel_curves(corner, -3.0)
    assert inside.points == approx(np.array([[0.0, 3.0], [7.0, 3.0], [7.0, 10.0]]))
    assert outside.length == approx(20.0 + 1.5 * math.pi)
    assert outside.segments().radius[1] == approx(3.0)


def test_parallels_of_an_arc_keep_its_centre():
    arc = Curve(np.array([[5.0, 0.0], [0.0, 5.0]]), np.array([QUARTER, 0.0]), False)
    (inside,), (outside,) = parallel_curves(arc, 2.0), parallel_curves(arc, -2.0)
    assert inside.segments().radius == approx([3.0], abs=1e-12)
    assert outside.segments().radius == approx([7.0], abs=1e-12)
    assert not parallel_curves(arc, 5.0)


def test_a_closed_parallel_is_closed():
    (inside,) = parallel_curves(Curve.rectangle(0.0, 0.0, 10.0, 10.0), 2.0)
    assert inside.closed
    assert inside.area == approx(36.0)
    assert parallel_curves(Curve.rectangle(0.0, 0.0, 10.0, 10.0), -2.0)[0].area == approx(
        100.0 + 80.0 + 4.0 * math.pi
    )


def test_a_parallel_into_a_narrow_groove_leaves_the_groove_out():
    groove = Curve.polyline(
        [[0.0, 0.0], [10.0, 0.0], [10.0, -8.0], [13.0, -8.0], [13.0, 0.0], [23.0, 0.0]]
    )
    (beside,) = parallel_curves(groove, 2.0)
    assert beside.box()[0][1] > 1.0
    assert groove.distance(beside.sampled(0.01)).min() > 2.0 - 1e-6


def test_a_closed_parallel_of_a_dumbbell_falls_into_two():
    points = [
        [0, 0],
        [20, 0],
        [20, 8],
        [40, 8],
        [40, 0],
        [60, 0],
        [60, 20],
        [40, 20],
        [40, 12],
        [20, 12],
        [20, 20],
        [0, 20],
    ]
    halves = parallel_curves(Curve.polygon(points), 3.0)
    assert [c.closed for c in halves] == [True, True]
    into_the_neck = 2.0 * (3.0 * 2.0 - (math.sqrt(5.0) + 4.5 * math.asin(2.0 / 3.0)))
    assert [c.area for c in halves] == approx([196.0 + into_the_neck] * 2)
