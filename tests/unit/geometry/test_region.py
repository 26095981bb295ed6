"""Plane regions: what is inside, and what joining and cutting leaves."""

from __future__ import annotations

import math
import pickle
import subprocess
import sys

import numpy as np
import pytest
from pytest import approx

from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.region import EMPTY_REGION, Piece, Region, union_all

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


def ring() -> Region:
    return Region.of([Curve.circle((0.0, 0.0), 5.0), Curve.circle((0.0, 0.0), 10.0)])


def radii(region: Region) -> list[float]:
    found = region.segments().radius
    return sorted(found[~np.isnan(found)].tolist())


def test_nested_curves_are_filled_by_turns():
    region = Region.of([Curve.circle((0.0, 0.0), r) for r in (3.0, 10.0, 5.0)])
    assert len(region.pieces) == 2
    assert region.area == approx((100.0 - 25.0 + 9.0) * math.pi)


def test_a_region_of_an_open_curve_is_refused():
    with pytest.raises(ValueError, match="closed"):
        Region.of([Curve.polyline([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]])])


def test_a_piece_that_goes_the_wrong_way_round_is_refused():
    with pytest.raises(ValueError, match="anticlockwise"):
        Piece(Curve.rectangle(0.0, 0.0, 1.0, 1.0).reversed())
    with pytest.raises(ValueError, match="clockwise"):
        Piece(Curve.rectangle(0.0, 0.0, 9.0, 9.0), (Curve.rectangle(1.0, 1.0, 2.0, 2.0),))


def test_material_is_on_the_left_of_every_loop():
    outer, hole = ring().curves()
    assert outer.area > 0.0 > hole.area


def test_distances_are_positive_inside():
    assert ring().signed_distance([[7.0, 0.0], [0.0, 0.0], [0.0, 12.0]]) == approx(
        [2.0, -5.0, -2.0]
    )


def test_containing_asks_for_a_margin():
    assert ring().contains([[7.0, 0.0], [5.5, 0.0], [1.0, 0.0]]).tolist() == [True, True, False]
    assert ring().contains([[7.0, 0.0], [5.5, 0.0], [4.8, 0.0]], margin=1.0).tolist() == [
        True,
        False,
        False,
    ]
    assert ring().contains([[4.8, 0.0], [4.0, 0.0]], margin=-0.5).tolist() == [True, False]


def test_a_point_level_with_corners_and_on_chords_of_arcs_is_placed_right():
    slot = Region.of(
        [
            Curve(
                np.array([[0.0, 0.0], [20.0, 0.0], [20.0, 10.0], [0.0, 10.0]]),
                np.array([0.0, 1.0, 0.0, 1.0]),
                True,
            )
        ]
    )
    assert slot.contains([[20.0, 5.0], [0.0, 5.0], [24.0, 5.0], [-4.0, 5.0]]).all()
    disc = Region.circle((0.0, 0.0), 2.0)
    assert disc.contains([[0.0, 0.0], [1.0, 0.0], [-1.0, 0.0]]).all()
    assert not disc.contains([[3.0, 0.0], [-3.0, 0.0]]).any()


def test_the_empty_region_is_false_and_holds_nothing():
    assert not EMPTY_REGION
    assert EMPTY_REGION.area == 0.0
    assert not EMPTY_REGION.contains([[0.0, 0.0]]).any()
    assert EMPTY_REGION.signed_distance([[0.0, 0.0]]) == approx([-math.inf])
    with pytest.raises(ValueError, match="empty"):
        EMPTY_REGION.box()


def test_operations_with_nothing_are_what_one_expects():
    disc = Region.circle((0.0, 0.0), 2.0)
    assert disc.union(EMPTY_REGION) is disc
    assert EMPTY_REGION.union(disc) is disc
    assert disc.minus(EMPTY_REGION) is disc
    assert not EMPTY_REGION.minus(disc)
    assert not disc.intersect(EMPTY_REGION)
    assert not EMPTY_REGION.offset(3.0)


def test_a_bar_and_a_disc_meet_at_exact_points():
    """The circle of radius 10 meets y = 5 at x = sqrt(75)."""
    both = Region.circle((0.0, 0.0), 10.0).intersect(Region.rectangle(0.0, -5.0, 30.0, 5.0))
    corners = both.pieces[0].outer.points
    assert np.abs(corners - [math.sqrt(75.0), 5.0]).max(axis=1).min() < 1e-12
    assert radii(both) == approx([10.0], abs=1e-12)
    assert both.area == approx(25.0 * math.sqrt(3.0) + 100.0 * math.pi / 6.0, abs=1e-9)


def test_two_discs_meet_at_exact_points():
    lens = Region.circle((0.0, 0.0), 5.0).intersect(Region.circle((6.0, 0.0), 5.0))
    assert sorted(map(tuple, lens.pieces[0].outer.points.round(12).tolist())) == [
        (3.0, -4.0),
        (3.0, 4.0),
    ]


def test_rectangles_that_share_a_wall_become_one_without_a_seam():
    both = Region.rectangle(0.0, 0.0, 10.0, 10.0).union(Region.rectangle(10.0, 0.0, 20.0, 10.0))
    assert [c.n_segments for c in both.curves()] == [4]
    assert both.area == 200.0


def test_cutting_along_a_shared_rounded_wall_leaves_no_slivers():
    pocket = Region.of([rounded(0.0, 0.0, 40.0, 30.0, 6.0)])
    half = pocket.intersect(Region.rectangle(-1.0, -1.0, 20.0, 40.0))
    rest = pocket.minus(half)
    assert len(rest.pieces) == 1
    assert rest.area == approx(half.area, abs=1e-9)
    assert not pocket.minus(half).minus(rest)
    assert [c.n_segments for c in half.union(rest).curves()] == [8]


def test_walls_that_differ_by_less_than_a_point_leave_no_slivers():
    a, b = rounded(0.0, 0.0, 40.0, 30.0, 6.0), rounded(1e-7, -1e-7, 40.0, 30.0, 6.0 + 1e-7)
    assert not Region.of([a]).minus(Region.of([b]))
    assert Region.of([a]).union(Region.of([b])).area == approx(a.area, abs=1e-4)


def test_an_island_cut_out_and_put_back_disappears():
    island = Region.circle((20.0, 15.0), 4.0)
    pocket = Region.of([rounded(0.0, 0.0, 40.0, 30.0, 6.0)])
    assert len(pocket.minus(island).curves()) == 2
    assert [c.n_segments for c in pocket.minus(island).union(island).curves()] == [8]


def test_cutting_a_region_from_itself_leaves_nothing():
    assert not ring().minus(ring())
    assert ring().union(ring()).area == approx(ring().area, abs=1e-12)


def test_regions_far_apart_stay_two_pieces():
    a, b = Region.rectangle(0.0, 0.0, 1.0, 1.0), Region.circle((9.0, 9.0), 1.0)
    assert len(a.union(b).pieces) == 2
    assert a.minus(b) is a
    assert not a.intersect(b)


def test_a_chain_of_regions_is_joined_at_once():
    chain = union_all([Region.rectangle(float(n), 0.0, n + 1.0, 2.0) for n in range(5)])
    assert chain.area == 10.0
    assert [c.n_segments for c in chain.curves()] == [4]
    assert not union_all([])


def test_filled_holes_swallow_the_pieces_inside_them():
    region = Region.of([Curve.circle((0.0, 0.0), r) for r in (3.0, 10.0, 5.0)])
    assert region.holes_filled().area == approx(100.0 * math.pi)
    assert len(region.holes_filled().pieces) == 1


def test_split_gives_a_region_a_piece():
    parts = Region.of(
        [Curve.rectangle(0.0, 0.0, 1.0, 1.0), Curve.rectangle(2.0, 0.0, 5.0, 1.0)]
    ).split()
    assert sorted(p.area for p in parts) == approx([1.0, 3.0])


def test_motions_keep_the_area_and_the_direction_of_loops():
    for moved in (
        ring().moved(3.0, 4.0),
        ring().rotated(0.7, (1.0, 2.0)),
        ring().mirrored(),
        ring().mirrored(1),
    ):
        assert moved.area == approx(ring().area)
        assert moved.curves()[0].area > 0.0 > moved.curves()[1].area


def test_gaps_below_a_point_between_ends_do_no_harm():
    points = np.array([[0.0, 0.0], [20.0, 1e-7], [20.0 + 1e-7, 10.0], [-1e-7, 10.0 - 1e-7]])
    almost = Region.of([Curve.polygon(points)])
    assert almost.intersect(Region.rectangle(0.0, 0.0, 20.0, 10.0)).area == approx(200.0, abs=1e-4)


def test_a_hole_that_touches_the_wall_stays_a_hole_in_later_operations():
    plate = Region.rectangle(0.0, 0.0, 40.0, 40.0).minus(Region.circle((5.0, 20.0), 5.0))
    assert plate.area == approx(1600.0 - 25.0 * math.pi, abs=1e-6)
    left, right = (
        plate.intersect(Region.rectangle(0.0, 0.0, 20.0, 40.0)),
        plate.minus(Region.rectangle(0.0, 0.0, 20.0, 40.0)),
    )
    assert left.area + right.area == approx(plate.area, abs=1e-6)


def test_a_region_survives_the_way_to_another_process():
    again = pickle.loads(pickle.dumps(ring()))
    assert again.area == ring().area
    assert (again.segments().start == ring().segments().start).all()


def test_plane_geometry_does_without_the_compiler_until_it_pays():
    code = (
        "import sys; from trunnion.geometry.plane.region import Region; Region.circle((0, 0), 5).offset(-1).contains([[0, 0]]); "
        "sys.exit(any(m in sys.modules for m in ('numba', 'scipy')))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
