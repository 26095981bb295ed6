"""Triangles of sheets made fit for a field: flips against a plain reference, short edges collapsed, slivers split into even triangles."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from surface_forms import cylinder, joined, plane
from trunnion.geometry.kernels.collapses import (
    apart,
    apart_loop,
    shortest_edges,
    shortest_edges_loop,
)
from trunnion.geometry.kernels.edge_numbers import FEW, numbered_edges, numbered_edges_loop
from trunnion.geometry.sheet.edge_collapses import SHORT, TURN, collapsed
from trunnion.geometry.sheet.edge_flips import OBTUSE, ROUNDS, flipped
from trunnion.geometry.sheet.refine_sheet import split_finely, split_where
from trunnion.geometry.sheet.sheet import SMOOTH, edges_of, sheet_of


def in_mm(a, a_normal, b, b_normal):
    return np.linalg.norm(b - a, axis=1)


def wavy(a, a_normal, b, b_normal):
    """A measure that is long across the sheet at some places: what is obtuse in it is not what looks so."""
    middle = 0.5 * (a + b)
    return np.hypot((2.0 + np.sin(3.0 * middle[:, 1])) * (b - a)[:, 0], (b - a)[:, 1:].sum(axis=1))


def lopsided(seed: int, n: int = 9):
    """A level sheet of points at random in a grid's cells, its diagonals running as they may, in two faces."""
    rng = np.random.default_rng(seed)
    sheet = sheet_of(joined(plane(3.0, 4.0, n), plane(3.0, 4.0, n, tag=2, start=3.0)), (1, 2))
    points = sheet.points.copy()
    inner = (points[:, 0] % 3.0 > 0.0) & (points[:, 1] > 0.0) & (points[:, 1] < 4.0)
    points[inner, :2] += rng.uniform(-0.6, 0.6, (inner.sum(), 2)) / (n - 1)
    return points, sheet.normals, sheet.triangles, sheet.face


@settings(deadline=None)
@given(
    st.integers(3, 12).flatmap(
        lambda n: st.lists(
            st.permutations(range(n)).map(lambda corners: corners[:3]), min_size=0, max_size=30
        )
    )
)
def test_edges_are_numbered_as_by_the_plain_reference(triangles) -> None:
    corners = np.array(triangles, np.int64).reshape(-1, 3)
    expected, found = numbered_edges(corners, 12), numbered_edges_loop(corners, 12)
    assert all(np.array_equal(a, b) for a, b in zip(expected, found, strict=True))


def test_edges_of_a_fan_of_many_triangles_are_numbered_as_by_the_plain_reference() -> None:
    rim = np.random.default_rng(0).permutation(np.arange(1, 4 * FEW))
    fan = np.column_stack([np.zeros(len(rim) - 1, np.int64), rim[:-1], rim[1:]])
    expected, found = numbered_edges(fan, 4 * FEW), numbered_edges_loop(fan, 4 * FEW)
    assert all(np.array_equal(a, b) for a, b in zip(expected, found, strict=True))


def plainly_flipped(points, normals, triangles, face, measure):
    """The same flips edge by edge, every triangle looked at anew in every round."""
    triangles = [tuple(t) for t in triangles.tolist()]

    @cache
    def measured(a, b):
        return float(measure(points[[a]], normals[[a]], points[[b]], normals[[b]])[0]) ** 2

    def size(a, b):
        return measured(min(a, b), max(a, b))

    def upright(t):
        a, b, c = points[list(t)]
        normal = np.cross(b - a, c - a)
        normal = normal / np.linalg.norm(normal)
        return all(float(normal @ normals[k]) > SMOOTH for k in t)

    for _ in range(ROUNDS):
        sides = {}
        for row, t in enumerate(triangles):
            for k in range(3):
                sides.setdefault(tuple(sorted((t[k], t[(k + 1) % 3]))), []).append((row, k))
        wrong = []
        for key in sorted(sides):
            if len(sides[key]) == 2:
                (one, i), (two, j) = sides[key]
                lean = 0.0
                for row, k in ((one, i), (two, j)):
                    t = triangles[row]
                    q = [size(t[m], t[(m + 1) % 3]) for m in range(3)]
                    total = sum(q)
                    area = math.sqrt(max(total**2 - 2.0 * sum(x * x for x in q), 1e-24 * total**2))
                    lean += (total - 2.0 * q[k]) / area
                if lean < -OBTUSE and face[one] == face[two]:
                    wrong.append((lean, key, one, i, two, j))
        wrong.sort(key=lambda w: w[0])
        best = {}
        for n, w in enumerate(wrong):
            for row in (w[2], w[4]):
                best.setdefault(row, n)
        changed = False
        for n, (_, _, one, i, two, j) in enumerate(wrong):
            if best[one] != n or best[two] != n:
                continue
            a, b, c = (triangles[one][(i + k) % 3] for k in range(3))
            d = triangles[two][(j + 2) % 3]
            if tuple(sorted((c, d))) not in sides and upright((a, d, c)) and upright((d, b, c)):
                triangles[one], triangles[two], changed = (a, d, c), (d, b, c), True
        if not changed:
            break
    return np.array(triangles)


@pytest.mark.examples(30)
@pytest.mark.parametrize("measure", [in_mm, wavy])
@settings(deadline=None)
@given(seed=st.integers(0, 10_000))
def test_flips_are_those_of_the_plain_reference(measure, seed) -> None:
    points, normals, triangles, face = lopsided(seed, 5)
    found = flipped(points, normals, triangles, face, measure)
    assert (found == plainly_flipped(points, normals, triangles, face, measure)).all()


def test_flips_leave_hardly_an_obtuse_pair_and_the_line_between_faces() -> None:
    points, normals, triangles, face = lopsided(3, 25)
    before = edges_of(triangles, len(points))[0]
    found = flipped(points, normals, triangles, face, in_mm)
    between = (points[before, 0] == 3.0).all(axis=1)
    after = {tuple(e) for e in edges_of(found, len(points))[0].tolist()}
    assert between.any() and {tuple(e) for e in before[between].tolist()} <= after
    a, b, c = np.moveaxis(points[found], 1, 0)
    assert np.cross(b - a, c - a)[:, 2].sum() == pytest.approx(2.0 * 6.0 * 4.0, abs=1e-9)
    assert (np.cross(b - a, c - a)[:, 2] > 0.0).all()


def test_short_edges_are_collapsed_and_rims_stay() -> None:
    sheet = sheet_of(joined(plane(3.0, 4.0, 31), plane(3.0, 4.0, 31, tag=2, start=3.0)), (1, 2))
    triangles, face = collapsed(
        sheet.points, sheet.normals, sheet.triangles, sheet.face, in_mm, 1.0, 1.4
    )
    assert len(triangles) < 0.6 * len(sheet.triangles)
    ends, side = edges_of(triangles, len(sheet.points))
    uses = np.bincount(side.ravel())
    assert uses.max() == 2
    length = np.linalg.norm(np.diff(sheet.points[ends], axis=1)[:, 0], axis=1)
    assert length.max() <= 1.4
    # Each face keeps its own area, whole and without folds, and all of the points on its rim.
    a, b, c = np.moveaxis(sheet.points[triangles], 1, 0)
    double = np.cross(b - a, c - a)[:, 2]
    assert (double > 0.0).all()
    for tag in (1, 2):
        assert double[face == tag].sum() == pytest.approx(2.0 * 12.0, abs=1e-9)
    rim = {tuple(e) for e in ends[uses == 1].tolist()}
    whole = sheet.edges()
    assert rim == {tuple(e) for e in whole[0][np.bincount(whole[1].ravel()) == 1].tolist()}


def test_a_collapse_turns_no_edge_by_more_than_a_cubic_bears() -> None:
    sheet = sheet_of(cylinder(radius=2.0, length=4.0, angle=1.2, n=241), (1,))
    fine = split_finely(sheet, in_mm, 0.5)
    triangles, _ = collapsed(fine.points, fine.normals, fine.triangles, fine.face, in_mm, 2.0, 2.8)
    assert len(triangles) < len(fine.triangles)
    a, b = fine.normals[edges_of(triangles, len(fine.points))[0].T]
    assert (a * b).sum(axis=1).min() >= TURN - 1e-12


def test_long_slivers_become_even_triangles_and_no_point_leaves_the_face() -> None:
    # Strips 0.02 mm wide along a cylinder, as a mesh within half a micron has them beside a small fillet.
    sheet = sheet_of(cylinder(radius=2.0, length=40.0, angle=0.6, n=121), (1,))
    plainly, evenly = split_finely(sheet, in_mm, 0.2), split_finely(sheet, in_mm, 0.2, evenly=True)
    # Some times as many as even triangles with sides of 0.2 mm would be: rims keep their points, and halving leaves shorter edges.
    even = plainly.area().sum() / (0.25 * math.sqrt(3.0) * 0.2**2)
    assert len(evenly.triangles) < min(6.0 * even, 0.5 * len(plainly.triangles))
    ends = evenly.edges()[0]
    length = np.linalg.norm(np.diff(evenly.points[ends], axis=1)[:, 0], axis=1)
    assert np.quantile(length, 0.999) <= 0.2 * 1.05
    assert np.median(length) > SHORT * 0.2
    # Chords of a length c on a radius r leave (c / r)^2 / 24 of the area out.
    area = evenly.area().sum()
    assert area == pytest.approx(plainly.area().sum(), rel=(0.2 / 2.0) ** 2 / 24.0)
    from_axis = np.hypot(evenly.points[:, 1], evenly.points[:, 2])
    assert from_axis == pytest.approx(np.full(len(from_axis), 2.0), abs=2e-5)


@given(st.integers(0, 1000), st.floats(0.05, 0.3))
def test_wanted_edges_alone_get_short_and_neighbours_share_theirs(seed, longest) -> None:
    sheet = sheet_of(plane(8.0, 5.0, 3), (1,))
    at = np.random.default_rng(seed).uniform([0.0, 0.0], [8.0, 5.0])

    def near(middle, length):
        return np.hypot(*(middle[:, :2] - at).T) < 0.5 + 0.5 * length

    fine = split_where(sheet, near, longest)
    ends, side = edges_of(fine.triangles, len(fine.points))
    a, b = fine.points[ends].transpose(1, 0, 2)
    length, middle = np.linalg.norm(b - a, axis=1), 0.5 * (a + b)
    # A flip may make an edge a little longer again.
    close = np.hypot(*(middle[:, :2] - at).T) < 0.5
    assert close.any() and length[close].max() <= 1.5 * longest
    assert length.max() > 1.0 and len(fine.triangles) < 60.0 / longest**2
    # No point lies on a side of a triangle that hasn't it for a corner: each side is of two triangles, or on the rim.
    count = np.bincount(side.ravel())
    rim = length[count == 1].sum()
    assert count.max() == 2 and rim == pytest.approx(26.0)
    assert fine.area().sum() == pytest.approx(40.0)


def test_nothing_wanted_leaves_a_sheet_as_it_is() -> None:
    sheet = sheet_of(plane(8.0, 5.0, 3), (1,))
    same = split_where(sheet, lambda middle, length: np.zeros(len(length), dtype=bool), 0.1)
    assert np.array_equal(same.points, sheet.points)
    assert len(same.triangles) == len(sheet.triangles)


corners_at_random = st.integers(3, 14).flatmap(
    lambda n: st.lists(st.permutations(range(n)).map(lambda c: c[:3]), min_size=1, max_size=30)
)


@settings(deadline=None)
@given(corners_at_random, st.permutations(range(14)), st.integers(0, 14))
def test_points_go_together_as_by_the_plain_reference(triangles, order, count) -> None:
    corners, order = np.array(triangles, np.int64), np.array(order[:count], np.int64)
    found = apart_loop(corners, order, 14)
    assert np.array_equal(found, apart(corners, order, 14))
    # None of their triangles share a corner, and every other one has a corner in common with one of theirs.
    stars = {p: set(corners[(corners == p).any(axis=1)].ravel().tolist()) for p in order.tolist()}
    gone = order[found].tolist()
    assert all(not stars[p] & stars[q] for p in gone for q in gone if p != q)
    assert all(any(stars[p] & stars[q] for q in gone) for p in order[~found].tolist())


@settings(deadline=None)
@given(corners_at_random, st.lists(st.integers(1, 6), min_size=90, max_size=90), st.integers(1, 7))
def test_the_shortest_edges_are_those_of_the_plain_reference(triangles, sizes, limit) -> None:
    ends = edges_of(np.array(triangles, np.int64), 14)[0]
    size = np.array(sizes[: len(ends)], float)
    found = shortest_edges_loop(ends, size, float(limit), 14)
    assert np.array_equal(found, shortest_edges(ends, size, float(limit), 14))
