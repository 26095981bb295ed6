"""Sheets, distances in a metric, level lines, ridges and blends: against closed forms and plain loops."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from pytest import approx

from surface_forms import cylinder, grid, joined, plane, saddle, zone
from trunnion.findings import Refused
from trunnion.geometry.kernels.shortest_paths import fast_marching, fast_marching_compiled
from trunnion.geometry.sheet import refine_sheet
from trunnion.geometry.sheet.contours import chains, whole_levels
from trunnion.geometry.sheet.fields import Metric, beyond, blend, distances, turns_about
from trunnion.geometry.sheet.refine_sheet import split_finely
from trunnion.geometry.sheet.ridges import ridged
from trunnion.geometry.sheet.sheet import sheet_of


def in_mm(a, a_normal, b, b_normal):
    return np.linalg.norm(b - a, axis=1)


def plain(sheet) -> Metric:
    ends, _ = sheet.edges()
    return Metric.of(
        sheet, np.linalg.norm(sheet.points[ends[:, 0]] - sheet.points[ends[:, 1]], axis=1)
    )


def fine(skin, size=0.2, faces=(1,)):
    return split_finely(sheet_of(skin, faces), in_mm, size)


def test_smooth_neighbours_become_one_sheet() -> None:
    sheet = sheet_of(joined(plane(tag=1), plane(tag=2, start=6.0)), (1, 2))
    assert (len(sheet.points), len(sheet.components()), len(sheet.rims())) == (6, 1, 1)


def test_a_sharp_edge_parts_a_sheet() -> None:
    wall = grid(
        lambda u, v: np.column_stack([0 * u, v, u]),
        lambda u, v: np.column_stack([0 * u + 1.0, 0 * u, 0 * u]),
        np.linspace(0.0, 3.0, 2),
        np.linspace(0.0, 4.0, 2),
        2,
    )
    assert len(sheet_of(joined(plane(), wall), (1, 2)).components()) == 2


def test_splitting_keeps_area_and_rim_and_stays_on_a_sphere() -> None:
    coarse = sheet_of(zone(n=40, m=6), (1,))
    sheet = split_finely(coarse, in_mm, 0.3)
    ends, side = sheet.edges()
    assert np.linalg.norm(np.diff(sheet.points[ends], axis=1)[:, 0], axis=1).max() < 0.4
    assert (np.bincount(side.ravel()) <= 2).all()
    assert sheet.area().sum() == approx(
        2.0 * math.pi * 100.0 * (math.cos(0.2) - math.cos(0.5)), rel=5e-3
    )
    # Edges of 0.8 mm, a turn of 0.08: their cubics leave the sphere by less than a hundredth of a micron a halving.
    assert np.linalg.norm(sheet.points, axis=1) == approx(
        np.full(len(sheet.points), 10.0), abs=1e-4
    )


def test_long_triangles_are_split_into_round_ones() -> None:
    sheet = fine(plane(20.0, 1.0))
    a, b, c = np.moveaxis(sheet.points[sheet.triangles], 1, 0)
    longest = np.max([np.linalg.norm(q - p, axis=1) for p, q in ((a, b), (b, c), (c, a))], axis=0)
    assert np.median(sheet.area() / longest**2) > 0.1


def test_too_many_triangles_are_refused(monkeypatch) -> None:
    monkeypatch.setattr(refine_sheet, "MOST_TRIANGLES", 100)
    with pytest.raises(Refused, match="higher scallop"):
        fine(plane(), 0.05)


def test_a_distance_from_a_straight_rim_is_exact() -> None:
    sheet = fine(plane())
    time, foot = distances(plain(sheet), np.flatnonzero(sheet.points[:, 0] == 0.0))
    assert time == approx(sheet.points[:, 0], abs=1e-9)
    assert foot[:, 0] == approx(np.zeros(len(foot)), abs=1e-9)


def test_a_distance_from_all_rims_of_a_rectangle() -> None:
    sheet = fine(plane(), 0.1)
    time, _ = distances(plain(sheet), np.concatenate(sheet.rims()))
    x, y = sheet.points[:, 0], sheet.points[:, 1]
    assert np.abs(time - np.minimum(np.minimum(x, 6.0 - x), np.minimum(y, 4.0 - y))).max() < 0.03


def test_a_distance_down_a_sphere_is_its_arc() -> None:
    sheet = fine(zone(), 0.2)
    time, _ = distances(
        plain(sheet), np.flatnonzero(sheet.points[:, 2] > 10.0 * math.cos(0.2) - 1e-6)
    )
    arc = 10.0 * (
        np.arctan2(np.hypot(sheet.points[:, 0], sheet.points[:, 1]), sheet.points[:, 2]) - 0.2
    )
    assert np.abs(time - arc).max() < 0.03


def test_nothing_is_reached_beyond_the_farthest() -> None:
    sheet = fine(plane())
    time, _ = distances(plain(sheet), np.flatnonzero(sheet.points[:, 0] == 0.0), farthest=2.0)
    assert (np.isinf(time) == (sheet.points[:, 0] > 2.0 + 1e-9)).all()


@pytest.mark.parametrize("skin", [plane(), cylinder(n=13), saddle(n=9), zone(n=24, m=4, turn=1.5)])
def test_compiled_marching_does_what_the_plain_one_does(skin) -> None:
    sheet = split_finely(sheet_of(skin, (1,)), in_mm, 0.6)
    metric, across = plain(sheet), beyond(sheet)
    found = [
        module.stencils(sheet.triangles, metric.lengths, across)
        for module in (fast_marching, fast_marching_compiled)
    ]
    assert (found[0][0] == found[1][0]).all() and found[0][1] == approx(found[1][1])
    points, sizes = found[0]
    order = np.argsort(points[:, 1:].ravel(), kind="stable")
    start = np.concatenate(
        [[0], np.cumsum(np.bincount(points[:, 1:].ravel(), minlength=len(sheet.points)))]
    )
    times = []
    for module in (fast_marching, fast_marching_compiled):
        time, foot = np.full(len(sheet.points), np.inf), sheet.points.copy()
        time[[0, 5]] = 0.0, 0.3
        module.fast_march(points, sizes, start, order // 2, time, foot, np.inf)
        times.append((time, foot))
    assert times[0][0] == approx(times[1][0], abs=1e-12) and times[0][1] == approx(
        times[1][1], abs=1e-9
    )


def test_chains_plain_and_compiled() -> None:
    follows = np.array([3, 2, 1, -1, 4, 6, 7, 5])
    order, start, closed = chains(follows)
    plain_order, plain_start, plain_closed = (
        np.empty(16, np.int64),
        np.zeros(9, np.int64),
        np.zeros(8, bool),
    )
    count = fast_marching.chain_loop(follows, plain_order, plain_start, plain_closed)
    assert [order[a:b].tolist() for a, b in pairwise(start)] == [
        [0, 3],
        [1, 2, 1],
        [4, 4],
        [5, 6, 7, 5],
    ]
    assert closed.tolist() == plain_closed[:count].tolist() == [False, True, True, True]
    assert order.tolist() == plain_order[: start[-1]].tolist()


def test_level_lines_have_the_greater_values_on_their_left() -> None:
    sheet = fine(plane())
    lines = whole_levels(sheet, sheet.points[:, 0].copy())
    assert [line.level for line in lines] == [0, 1, 2, 3, 4, 5]
    points, normals = sheet.on_edges(lines[2].ends, lines[2].share)
    assert points[:, 0] == approx(np.full(len(points), 2.0)) and normals[:, 2] == approx(
        np.ones(len(points))
    )
    assert points[0, 1] == approx(4.0) and points[-1, 1] == approx(0.0) and not lines[2].closed


def test_ridges_of_a_rectangle_are_its_roof() -> None:
    sheet = fine(plane(), 0.1)
    metric = plain(sheet)
    found = ridged(metric, *distances(metric, np.concatenate(sheet.rims())), 0.1)
    points = found.sheet.points[np.concatenate(found.ridges)]
    x, y = points[:, 0], points[:, 1]
    near = np.minimum(np.minimum(x, 6.0 - x), np.minimum(y, 4.0 - y))
    second = np.sort(np.column_stack([x, 6.0 - x, y, 4.0 - y]), axis=1)[:, 1]
    assert np.abs(near - second).max() < 0.05
    assert found.sheet.area().sum() == approx(24.0) and found.time.max() == approx(2.0, abs=0.02)
    size = sum(
        np.linalg.norm(np.diff(found.sheet.points[r], axis=0), axis=1).sum() for r in found.ridges
    )
    assert size == approx(4.0 * 2.0 * math.sqrt(2.0) + 2.0, rel=0.03)


def test_a_blend_between_opposite_sides_is_even() -> None:
    sheet = fine(plane())
    x = sheet.points[:, 0]
    field = blend(plain(sheet), np.flatnonzero(x == 0.0), np.flatnonzero(x == 6.0))
    assert field == approx(x / 6.0, abs=1e-9)


def test_a_blend_over_a_zone_is_nearly_even_where_a_harmonic_one_crowds() -> None:
    sheet = fine(zone(top=0.1, bottom=0.6), 0.3)
    metric, rims = plain(sheet), sheet.rims()
    slope = metric.slope(blend(metric, rims[0], rims[1]))
    # A harmonic one is as steep as the circles are short: sin 0.6 / sin 0.1, over five times.
    assert np.percentile(slope, 98) < 1.6 * np.percentile(slope, 2)


@pytest.mark.parametrize("seed", range(3))
def test_a_blend_stays_between_its_guides_where_triangles_are_folded_or_flat(seed) -> None:
    sheet, random = fine(plane()), np.random.default_rng(seed)
    x, (ends, side) = sheet.points[:, 0], sheet.edges()
    share = np.ones(len(ends))
    some = random.choice(len(ends), len(ends) // 10, replace=False)
    share[some] = random.choice([0.02, 30.0], len(some))
    metric = plain(sheet)
    crooked = replace(metric, lengths=metric.lengths * share[side])
    field = blend(crooked, np.flatnonzero(x == 0.0), np.flatnonzero(x == 6.0))
    assert (field.min(), field.max()) == (0.0, 1.0)
    assert field[x == 6.0] == approx(1.0) and field[x == 0.0] == approx(0.0)


def test_turns_about_a_tube_grow_by_one_on_the_way_round() -> None:
    sheet = fine(zone(n=60), 0.5)
    field, turns = turns_about(plain(sheet), *sheet.rims())
    slope = plain(sheet).slope(field, turns)
    radius = np.hypot(*sheet.points[sheet.triangles].mean(axis=1)[:, :2].T)
    assert slope == approx(1.0 / (2.0 * math.pi * radius), rel=0.1)
