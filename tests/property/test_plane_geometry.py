"""What holds for any rounded outline with islands: sets add up, offsets keep their distance, motions change nothing."""

from __future__ import annotations

import math

import numpy as np
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.offset import parallel_curves
from trunnion.geometry.plane.region import Region

few = settings(deadline=None, max_examples=25)


def outline(centre: tuple[float, float], size: float, rays: list[float], radius: float) -> Curve:
    """A star-shaped outline with one corner a ray, rounded where the sides have room for it."""
    n = len(rays)
    angle = 2.0 * math.pi * np.arange(n) / n
    corners = np.array(centre) + size * np.array(rays)[:, None] * np.stack(
        [np.cos(angle), np.sin(angle)], axis=1
    )
    points: list[np.ndarray] = []
    bulges: list[float] = []
    for i in range(n):
        before, p, after = corners[i - 1], corners[i], corners[(i + 1) % n]
        u, v = (before - p) / np.hypot(*(before - p)), (after - p) / np.hypot(*(after - p))
        between = math.acos(float(np.clip(u @ v, -1.0, 1.0)))
        back = radius / math.tan(0.5 * between)
        if radius == 0.0 or back > 0.4 * min(np.hypot(*(before - p)), np.hypot(*(after - p))):
            points.append(p)
            bulges.append(0.0)
        else:
            sweep = math.copysign(math.pi - between, v[0] * u[1] - v[1] * u[0])
            points += [p + u * back, p + v * back]
            bulges += [math.tan(0.25 * sweep), 0.0]
    return Curve(np.array(points), np.array(bulges), True)


rays = st.lists(st.integers(10, 20).map(lambda k: k / 20.0), min_size=4, max_size=9)
corner = st.sampled_from([0.0, 1.0, 2.0, 3.0])
place = st.tuples(st.integers(-20, 20).map(float), st.integers(-20, 20).map(float))
outers = st.builds(outline, st.just((0.0, 0.0)), st.just(50.0), rays, corner)
islands = st.one_of(
    st.builds(outline, place, st.sampled_from([5.0, 8.0]), rays, corner),
    st.builds(Curve.circle, place, st.sampled_from([2.0, 5.0])),
)


@st.composite
def regions(draw: st.DrawFn) -> Region:
    region = Region.of([draw(outers)])
    for island in draw(st.lists(islands, max_size=3)):
        region = region.minus(Region.of([island]))
    assume(bool(region))
    return region


def as_shapely(region: Region) -> shapely.MultiPolygon:
    chord = 1e-4
    return shapely.MultiPolygon(
        [
            shapely.Polygon(p.outer.sampled(chord), [h.sampled(chord) for h in p.holes])
            for p in region.pieces
        ]
    )


def probes(region: Region, margin: float) -> np.ndarray:
    low, high = region.box()
    xs, ys = (np.linspace(low[k] - margin, high[k] + margin, 61) for k in (0, 1))
    return np.stack(np.meshgrid(xs, ys), axis=-1).reshape(-1, 2)


@few
@given(regions(), regions(), place)
def test_areas_of_union_and_intersection_add_up(a, b, move):
    b = b.moved(*move)
    common, both = a.intersect(b).area, a.union(b).area
    assert abs(both + common - a.area - b.area) < 1e-3
    assert abs(a.minus(b).area + common - a.area) < 1e-3


@few
@given(regions(), regions(), place)
def test_set_operations_agree_with_dense_chords(a, b, move):
    b = b.moved(*move)
    dense_a, dense_b = as_shapely(a), as_shapely(b)
    assert abs(a.minus(b).area - dense_a.difference(dense_b).area) < 0.1
    assert abs(a.union(b).area - dense_a.union(dense_b).area) < 0.1


@few
@given(regions(), st.sampled_from([-6.0, -3.0, -2.0, -1.0, -0.37, 0.5, 1.0, 2.0, 5.0]))
def test_every_point_of_an_offset_has_the_distance(region, distance):
    moved = region.offset(distance)
    assume(bool(moved))
    s = moved.segments()
    rows = np.arange(len(s))
    for share in (0.0, 0.3, 0.5, 0.8):
        assert np.abs(-region.signed_distance(s.at(rows, share * s.length)) - distance).max() < 2e-6


@few
@given(regions(), st.sampled_from([-6.0, -3.0, -2.0, -1.0, 0.5, 2.0, 5.0]))
def test_an_offset_holds_exactly_the_points_that_are_near_enough(region, distance):
    at = probes(region, max(distance, 0.0) + 1.0)
    depth = region.signed_distance(at) + distance
    clear = np.abs(depth) > 5e-3
    assert (region.offset(distance).contains(at) == (depth > 0.0))[clear].all()


@few
@given(regions(), st.sampled_from([-3.0, -1.0, 2.0]))
def test_arcs_of_an_offset_have_exact_radii(region, distance):
    own = region.segments().radius
    known = np.concatenate(
        [[abs(distance)], own[~np.isnan(own)] + distance, own[~np.isnan(own)] - distance]
    )
    found = region.offset(distance).segments().radius
    found = found[~np.isnan(found)]
    assert all(np.abs(known - r).min() < 1e-9 for r in found)


@few
@given(regions(), st.sampled_from([1.0, 2.0, 4.0]))
def test_opening_twice_is_opening_once_and_stays_inside(region, radius):
    once = region.opened(radius)
    assert abs(once.opened(radius).area - once.area) < 1e-3
    assert once.minus(region).area < 1e-2


@few
@given(regions(), st.floats(0.0, 6.0), place, st.sampled_from([-3.0, -1.0, 2.0]))
def test_a_motion_before_or_after_an_offset_is_the_same(region, angle, move, distance):
    first = region.rotated(angle).moved(*move).offset(distance)
    after = region.offset(distance).rotated(angle).moved(*move)
    assert abs(first.area - after.area) < 1e-3
    assert len(first.pieces) == len(after.pieces)


@few
@given(regions(), place)
def test_distance_to_a_curve_is_the_distance_to_its_nearest_point(region, point):
    for curve in region.curves():
        at, _ = curve.at(curve.nearest(point))
        assert abs(float(np.hypot(*(at - point))) - curve.distance([point])[0]) < 1e-9


@few
@given(regions(), st.floats(0.0, 1.0), st.floats(0.01, 0.99))
def test_a_curve_cut_in_two_keeps_its_length(region, start, share):
    for curve in region.curves():
        s0, span = start * curve.length, share * curve.length
        assert abs(curve.split(s0, s0 + span).length - span) < 1e-9 * curve.length + 1e-8


@few
@given(outers, st.sampled_from([-4.0, -1.0, 1.0, 3.0]))
def test_parallels_of_an_open_curve_keep_their_distance(outer, distance):
    open_curve = outer.split(0.0, 0.8 * outer.length)
    for beside in parallel_curves(open_curve, distance):
        assert open_curve.distance(beside.sampled(0.01)).min() > abs(distance) - 1e-5
