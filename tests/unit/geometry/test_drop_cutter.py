"""Dropping cutters on triangles: closed forms, and the compiled loops beside the plain ones."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from long_mark import mostly_long
from trunnion.geometry.kernels.cutter_contact.drop_cutter import drop_cutter, height_at
from trunnion.geometry.kernels.cutter_contact.free_run import free_run
from trunnion.geometry.kernels.cutter_contact.push_cutter import push_cutter
from trunnion.geometry.kernels.cutter_contact.push_cutter_compiled import triangle_push
from trunnion.geometry.lattice import lattice_of
from trunnion.geometry.surface.drop_surface import CHUNK, DropSurface

FLAT = np.array([[0.0, 8.0, 0.0, 0.0, 0.0, 0.0]])
BALL = np.array([[0.0, 3.0, 1.0, 0.0, 3.0, 3.0]])
BULL = np.array([[0.0, 5.0, 0.0, 0.0, 0.0, 0.0], [5.0, 8.0, 1.0, 5.0, 3.0, 3.0]])
CONE = np.array([[0.0, 6.0, 0.0, 0.0, 0.5, 0.0]])
LEAN = math.radians(10.0)
TAPER = np.array(
    [
        [0.0, math.cos(LEAN), 1.0, 0.0, 1.0, 1.0],
        [math.cos(LEAN), 4.0, 0.0, 1.0 - math.sin(LEAN), 1.0 / math.tan(LEAN), 0.0],
    ]
)
BARREL = np.array([[0.0, 2.0, 1.0, 0.0, 3.0, 3.0], [2.0, 5.0, 1.0, -45.0, 40.0, 50.0]])
BARREL[1, 4] = height_at(BARREL[:1], np.array([2.0]))[0] + math.sqrt(50.0**2 - 47.0**2)
CUTTERS = {"flat": FLAT, "ball": BALL, "bull": BULL, "cone": CONE, "taper": TAPER, "barrel": BARREL}
LOWEST = -100.0


def wavy(n: int, size: float = 60.0):
    along = np.linspace(0.0, size, n + 1)
    x, y = np.meshgrid(along, along, indexing="ij")
    points = np.column_stack(
        [x.ravel(), y.ravel(), (8.0 * np.sin(x / 9.0) * np.cos(y / 12.0) + 0.1 * x).ravel()]
    )
    a = np.arange(n * (n + 1)).reshape(n, n + 1)[:, :-1].ravel()
    return points, np.vstack(
        [np.column_stack([a, a + n + 1, a + n + 2]), np.column_stack([a, a + n + 2, a + 1])]
    )


def dropped(points, triangles, at, cutter):
    return DropSurface.of(np.array(points, dtype=float), np.array(triangles)).drop(
        np.atleast_2d(np.array(at, dtype=float)), cutter, LOWEST
    )


def test_a_ball_stands_on_a_slope_where_its_side_is_as_steep() -> None:
    slope = math.tan(math.radians(30.0))
    points = [
        [-50, -50, -50 * slope],
        [50, -50, 50 * slope],
        [50, 50, 50 * slope],
        [-50, 50, -50 * slope],
    ]
    found = dropped(points, [[0, 1, 2], [0, 2, 3]], (4.0, 0.0), BALL)
    assert found == pytest.approx([4.0 * slope + 3.0 / math.cos(math.radians(30.0)) - 3.0])


def test_a_flat_end_stands_on_the_highest_corner_under_it() -> None:
    assert dropped(
        [[0, 0, 0], [7, 0, 5], [0, 7, 2]], [[0, 1, 2]], (0.0, 0.0), FLAT
    ) == pytest.approx([5.0])


def test_a_bull_end_stands_on_an_edge_beside_it() -> None:
    # A level edge 6.5 mm beside the axis: 1.5 mm out on a corner of 3 mm.
    found = dropped([[6.5, -40, 1], [6.5, 40, 1], [60, 0, -90]], [[0, 1, 2]], (0.0, 0.0), BULL)
    assert found == pytest.approx([1.0 - (3.0 - math.sqrt(9.0 - 1.5**2))])


def test_where_nothing_is_under_the_cutter_it_goes_to_the_lowest_height() -> None:
    assert dropped([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], (30.0, 30.0), BALL).tolist() == [
        LOWEST
    ]


def test_an_upright_triangle_is_met_on_its_upper_edge() -> None:
    assert dropped(
        [[0, -9, 0], [0, 9, 0], [0, 0, 6]], [[0, 1, 2]], (0.0, 0.0), BALL
    ) == pytest.approx([6.0])


@pytest.mark.parametrize("name", CUTTERS)
def test_the_compiled_loops_find_what_every_triangle_for_every_point_finds(name: str) -> None:
    points, triangles = wavy(14)
    at = np.vstack([np.random.default_rng(3).uniform(-6.0, 66.0, (120, 2)), points[::9, :2]])
    found = DropSurface.of(points, triangles).drop(at, CUTTERS[name], LOWEST)
    assert np.abs(found - drop_cutter(at, points[triangles], CUTTERS[name], LOWEST)).max() < 1e-9


@pytest.mark.examples(12)
@settings(deadline=None, max_examples=30)
@given(st.integers(0, 10_000), st.sampled_from(sorted(CUTTERS)))
def test_loose_triangles_of_any_kind(seed: int, name: str) -> None:
    rng = np.random.default_rng(seed)
    corners = rng.uniform(-12.0, 12.0, (8, 3, 3)) * rng.choice([0.02, 1.0], (8, 1, 3))
    at = rng.uniform(-10.0, 10.0, (6, 2))
    found = DropSurface.of(corners.reshape(-1, 3), np.arange(24).reshape(-1, 3)).drop(
        at, CUTTERS[name], LOWEST
    )
    assert np.abs(found - drop_cutter(at, corners, CUTTERS[name], LOWEST)).max() < 1e-9


@pytest.mark.parametrize("name", mostly_long(CUTTERS, "flat", "barrel"))
def test_pushing_is_blocked_just_where_dropping_would_lift_the_tip(name: str) -> None:
    corners = np.array(
        [
            [[-6.0, -3.0, -1.0], [7.0, 1.0, 4.0], [1.0, 6.0, 1.5]],
            [[-2.0, 1.0, -3.0], [2.5, 2.0, 2.0], [-1.0, -1.5, 6.0]],
        ]
    )
    lines = np.array([[0.5, 0.3]])
    plain = push_cutter(lines, corners, CUTTERS[name])
    found = [
        [
            [way * triangle_push(CUTTERS[name], t.ravel(), *lines[0], way) for way in (-1.0, 1.0)]
            for t in corners
        ]
    ]
    assert np.array(found) == pytest.approx(plain, abs=1e-9)


def test_spans_that_meet_are_one() -> None:
    points, triangles = (
        [[0, -1, 5], [4, -1, 5], [2, 3, 5], [30, -1, 5], [34, -1, 5], [32, 3, 5]],
        [[0, 1, 2], [3, 4, 5]],
    )
    surface = DropSurface.of(np.array(points, dtype=float), np.array(triangles))
    start, spans = surface.push(np.array([[0.0, 1.0], [0.0, 9.0]]), FLAT)
    # The ends that stand a millimetre beside the line block a disc of 8 mm by the root of 63.
    assert start.tolist() == [0, 2, 2]
    assert spans == pytest.approx(
        np.array(
            [
                [-math.sqrt(63.0), 4.0 + math.sqrt(63.0)],
                [30.0 - math.sqrt(63.0), 34.0 + math.sqrt(63.0)],
            ]
        )
    )


def test_a_lattice_lists_every_box_in_each_cell_it_touches() -> None:
    g = lattice_of(
        np.array([[0.0, 0.0], [2.5, 0.5], [0.0, 2.2]]),
        np.array([[1.0, 0.5], [3.5, 1.5], [3.5, 2.8]]),
        1.0,
    )
    cells = [g.rows[a:b].tolist() for a, b in zip(g.start[:-1], g.start[1:], strict=True)]
    assert (g.shape.tolist(), cells) == (
        [4, 3],
        [[0], [0], [1], [1], [], [], [1], [1], [2], [2], [2], [2]],
    )


def test_heights_agree_with_opencamlib() -> None:
    import opencamlib as ocl

    points, triangles = wavy(14)
    surface = ocl.STLSurf()
    corners = [[ocl.Point(*map(float, points[k])) for k in t] for t in triangles]
    for c in corners:
        surface.addTriangle(ocl.Triangle(*c))
    at = np.random.default_rng(5).uniform(8.0, 52.0, (60, 2))
    for cutter, theirs in (
        (FLAT, ocl.CylCutter(16.0, 60.0)),
        (BALL, ocl.BallCutter(6.0, 60.0)),
        (BULL, ocl.BullCutter(16.0, 3.0, 60.0)),
    ):
        batch = ocl.BatchDropCutter()
        batch.setSTL(surface)
        batch.setCutter(theirs)
        for x, y in at:
            batch.appendPoint(ocl.CLPoint(float(x), float(y), LOWEST))
        batch.run()
        z = np.array([p.z for p in batch.getCLPoints()])
        assert np.abs(DropSurface.of(points, triangles).drop(at, cutter, LOWEST) - z).max() < 1e-4


@pytest.mark.parametrize("name", CUTTERS)
def test_a_touch_lies_on_its_triangle_and_on_the_cutter(name: str) -> None:
    points, triangles = wavy(14)
    at = np.random.default_rng(7).uniform(2.0, 58.0, (80, 2))
    z, facet, contact = DropSurface.of(points, triangles).contacts(at, CUTTERS[name], LOWEST)
    away = np.hypot(*(contact[:, :2] - at).T)
    assert away.max() <= CUTTERS[name][-1, 1] + 1e-9
    assert contact[:, 2] - height_at(
        CUTTERS[name], np.minimum(away, CUTTERS[name][-1, 1])
    ) == pytest.approx(z, abs=1e-9)
    a, b, c = np.moveaxis(points[triangles[facet]], 1, 0)
    parts = [
        np.linalg.norm(np.cross(p - contact, q - contact), axis=1)
        for p, q in ((a, b), (b, c), (c, a))
    ]
    assert sum(parts) == pytest.approx(np.linalg.norm(np.cross(b - a, c - a), axis=1), abs=1e-9)


def test_over_nothing_no_triangle_is_touched() -> None:
    surface = DropSurface.of(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.0]]), np.array([[0, 1, 2]]))
    z, facet, contact = surface.contacts(np.array([[30.0, 30.0], [0.2, 0.2]]), BALL, LOWEST)
    assert (z.tolist(), facet.tolist()) == ([LOWEST, 0.0], [-1, 0]) and np.isnan(contact[0]).all()


@pytest.mark.examples(7)
@settings(deadline=None, max_examples=20)
@given(st.integers(0, 10_000), st.sampled_from(sorted(CUTTERS)))
def test_points_along_a_way_find_what_loose_points_find(seed: int, name: str) -> None:
    rng = np.random.default_rng(seed)
    corners = rng.uniform(-12.0, 12.0, (40, 3, 3)) * rng.choice(
        [0.02, 0.3, 1.0], (40, 1, 3)
    ) + rng.uniform(-9.0, 9.0, (40, 1, 3))
    way = np.column_stack([np.linspace(-15.0, 15.0, 60), np.linspace(-9.0, 12.0, 60)])
    found = DropSurface.of(corners.reshape(-1, 3), np.arange(120).reshape(-1, 3)).drop(
        way, CUTTERS[name], LOWEST
    )
    assert np.abs(found - drop_cutter(way, corners, CUTTERS[name], LOWEST)).max() < 1e-9


def test_each_point_may_have_its_own_height_to_begin_with() -> None:
    points, triangles = wavy(14)
    surface, at = (
        DropSurface.of(points, triangles),
        np.random.default_rng(9).uniform(2.0, 58.0, (60, 2)),
    )
    z = surface.drop(at, BALL, LOWEST)
    floor = z + np.where(np.arange(60) % 2 == 0, 1.0, -0.1)
    found, facet, _ = surface.contacts(at, BALL, floor)
    assert np.array_equal(found, np.maximum(z, floor)) and np.array_equal(
        facet >= 0, np.arange(60) % 2 == 1
    )


def test_all_facets_of_a_node_lie_in_its_box_and_below_its_plane() -> None:
    points, triangles = wavy(14)
    surface = DropSurface.of(points, triangles)
    leaves = len(surface.start) - 1
    assert sorted(surface.row) == list(range(len(triangles)))
    for node, (box, plane) in enumerate(zip(surface.boxes, surface.planes[0], strict=True)):
        width = leaves >> (node + 1).bit_length() - 1
        leaf = (node + 1) * width - leaves
        corners = points[
            triangles[surface.row[surface.start[leaf] : surface.start[leaf + width]]]
        ].reshape(-1, 3)
        assert box == pytest.approx([*corners[:, :2].min(axis=0), *corners.max(axis=0)])
        assert (corners[:, 2] - corners[:, :2] @ plane[:2]).max() == pytest.approx(plane[2])


@pytest.mark.parametrize("name", mostly_long(CUTTERS, "flat", "bull", "barrel"))
def test_a_wall_of_small_facets_beside_large_ones_lifts_as_its_plain_form_does(name: str) -> None:
    turn, up = np.meshgrid(
        np.linspace(0.0, 0.5 * math.pi, 12), np.linspace(0.0, 0.48 * math.pi, 40), indexing="ij"
    )
    away = 9.0 - 3.2 * (1.0 - np.cos(up))
    fillet = np.stack(
        [away * np.cos(turn), away * np.sin(turn), 3.2 * np.sin(up) - 3.2], axis=-1
    ).reshape(-1, 3)
    a = (np.arange(11)[:, None] * 40 + np.arange(39)).ravel()
    triangles = np.vstack(
        [
            [[480, 481, 482]],
            np.column_stack([a, a + 40, a + 41]),
            np.column_stack([a, a + 41, a + 1]),
        ]
    )
    points = np.vstack([fillet, [[-60.0, -60.0, -3.0], [70.0, -60.0, -3.0], [0.0, 80.0, -3.0]]])
    at = np.random.default_rng(2).uniform(0.0, 14.0, (80, 2))
    found = DropSurface.of(points, triangles).drop(at, CUTTERS[name], LOWEST)
    assert np.abs(found - drop_cutter(at, points[triangles], CUTTERS[name], LOWEST)).max() < 1e-9


def test_a_drop_ends_at_the_highest_height_that_is_asked_for() -> None:
    points, triangles = wavy(30)
    at = np.random.default_rng(6).uniform(0.0, 60.0, (300, 2))
    surface = DropSurface.of(points, triangles)
    whole = surface.drop(at, BULL, LOWEST)
    for highest in (2.0, np.linspace(-8.0, 8.0, 300)):
        found = surface.drop(at, BULL, LOWEST, highest=highest)
        assert (found == np.minimum(whole, highest)).all()
        assert (found < whole).any() and (found == whole).any()


@pytest.mark.parametrize("name", CUTTERS)
def test_few_points_at_a_time_find_the_same_as_many_at_once(name: str) -> None:
    points, triangles = wavy(40)
    rng = np.random.default_rng(11)
    at = rng.uniform(-5.0, 65.0, (2 * CHUNK, 2))
    at_once = DropSurface.of(points, triangles).contacts(at, CUTTERS[name], LOWEST)
    # Few points fill in only what they meet of how triangles lift the cutter; many need all of it, whatever is known by then.
    surface = DropSurface.of(points, triangles)
    few = surface.contacts(at[:300], CUTTERS[name], LOWEST)
    lifts = next(iter(surface._lifts.values()))
    known = (lifts.own != 0.0).any(axis=1)
    assert 0.0 < known.mean() < 1.0 and not lifts.is_whole
    many = surface.contacts(at, CUTTERS[name], LOWEST)
    assert lifts.is_whole and (lifts.own != 0.0).any(axis=1).all()
    for found, some, whole in zip(many, few, at_once, strict=True):
        assert np.array_equal(found, whole, equal_nan=True)
        assert np.array_equal(some[:1], whole[:1], equal_nan=True)
    assert few[0] == pytest.approx(at_once[0][:300], abs=1e-12)


CLOSE = 1e-6
EAST = np.array([[1.0, 0.0]])


def ran(points, triangles, start, height, most, cutter, direction=EAST):
    """How far one tip goes, and whether it comes free."""
    surface = DropSurface.of(np.array(points, dtype=float), np.array(triangles))
    run, found = surface.free_run(
        np.array([start], dtype=float),
        direction,
        np.array([height]),
        np.array([most]),
        cutter,
        CLOSE,
    )
    return float(run[0]), bool(found[0])


WALL = ([[10, -50, -5], [10, 50, -5], [10, 50, 5], [10, -50, 5]], [[0, 1, 2], [0, 2, 3]])
"""An upright wall at x = 10, from z = -5 up to 5."""


def test_a_flat_end_comes_free_of_a_wall_its_radius_away_from_it() -> None:
    run, found = ran(*WALL, (7.0, 0.0), 0.0, 30.0, FLAT)
    assert found and run == pytest.approx(10.0 + 8.0 - 7.0, abs=2.0 * CLOSE)


def test_a_ball_comes_free_nearer_to_a_wall_whose_top_is_under_its_middle() -> None:
    # The top is 1 mm above the tip of a ball of 3 mm: sqrt(9 - 4) beside its axis.
    run, found = ran(*WALL, (10.0, 0.0), 4.0, 30.0, BALL)
    assert found and run == pytest.approx(math.sqrt(5.0), abs=2.0 * CLOSE)


def test_what_is_free_where_it_stands_has_no_way_to_go() -> None:
    assert ran(*WALL, (30.0, 0.0), 0.0, 30.0, FLAT) == (0.0, False)


def test_what_is_still_blocked_at_its_distance_does_not_come_free() -> None:
    assert ran(*WALL, (7.0, 0.0), 0.0, 10.9, FLAT) == (0.0, False)
    assert ran(*WALL, (7.0, 0.0), 0.0, 11.1, FLAT)[1]


def test_a_second_wall_behind_the_first_one_is_gone_past_too() -> None:
    points, triangles = WALL
    both = [*points, *([x + 15.0, y, z] for x, y, z in points)]
    far = [*triangles, *([k + 4 for k in t] for t in triangles)]
    # 15 mm apart, less than twice the radius: no place between them is free.
    run, found = ran(both, far, (7.0, 0.0), 0.0, 60.0, FLAT)
    assert found and run == pytest.approx(25.0 + 8.0 - 7.0, abs=2.0 * CLOSE)


@pytest.mark.parametrize("name", mostly_long(CUTTERS, "bull", "cone"))
def test_the_compiled_loop_finds_what_the_plain_one_does(name: str) -> None:
    points, triangles = wavy(2)
    rng = np.random.default_rng(4)
    start, turn = rng.uniform(5.0, 55.0, (4, 2)), rng.uniform(0.0, 2.0 * math.pi, 4)
    direction = np.column_stack([np.cos(turn), np.sin(turn)])
    surface = DropSurface.of(points, triangles)
    # Some way under where they would stand: blocked; the last one above: free.
    height = surface.drop(start, CUTTERS[name], -100.0) - [0.2, 1.0, 2.0, -0.5]
    most = np.full(4, 40.0)
    run, found = surface.free_run(start, direction, height, most, CUTTERS[name], CLOSE)
    plain, plainly = free_run(start, direction, height, most, points[triangles], CUTTERS[name])
    assert found.tolist() == plainly.tolist() and 1 < found.sum() < 4
    assert np.abs(run - plain).max() < 10.0 * CLOSE


@pytest.mark.parametrize("name", ["bull", "ball"])
def test_it_is_free_at_the_end_and_blocked_just_before(name: str) -> None:
    points, triangles = wavy(40)
    rng = np.random.default_rng(8)
    n = CHUNK + 100
    start, turn = rng.uniform(5.0, 55.0, (n, 2)), rng.uniform(0.0, 2.0 * math.pi, n)
    direction = np.column_stack([np.cos(turn), np.sin(turn)])
    surface = DropSurface.of(points, triangles)
    height = surface.drop(start, CUTTERS[name], -100.0) - rng.uniform(0.01, 2.0, n)
    run, found = surface.free_run(start, direction, height, np.full(n, 20.0), CUTTERS[name], CLOSE)
    assert found.mean() > 0.5
    for at, is_blocked in ((run, False), (run - 3.0 * CLOSE, True)):
        over = surface.drop(start + at[:, None] * direction, CUTTERS[name], -100.0)
        assert ((over > height)[found] == is_blocked).all()


def test_the_order_of_tips_changes_nothing() -> None:
    points, triangles = wavy(20)
    rng = np.random.default_rng(9)
    start = rng.uniform(5.0, 55.0, (200, 2))
    surface = DropSurface.of(points, triangles)
    height = surface.drop(start, BULL, -100.0) - 1.0
    direction = np.broadcast_to(EAST, (200, 2))
    most = np.full(200, 20.0)
    run, found = surface.free_run(start, direction, height, most, BULL, CLOSE)
    back = surface.free_run(start[::-1], direction, height[::-1], most, BULL, CLOSE)
    assert (back[1][::-1] == found).all() and np.abs(back[0][::-1] - run).max() < 3.0 * CLOSE
