"""The deviation map: divided where something deviates, never painting over a gouge, in colours that tell gouges from what is left."""

from __future__ import annotations

import numpy as np
import pytest

from trunnion.geometry.mesh import Mesh
from trunnion.model.verdict import NO_DEVIATION, Deviation
from trunnion.report.deviation import MOST_TRIANGLES, deviation_map
from trunnion.report.palette import load_palette
from trunnion.report.pictures import deviation_legend, fine_length

SIDE, APART = 60.0, 3.0


@pytest.fixture
def mesh():
    """Two squares of 60 mm side by side, faces 1 and 2, two triangles each."""
    points = [
        (x, y, 0.0)
        for left in (0.0, SIDE)
        for x, y in ((left, 0), (left + SIDE, 0), (left + SIDE, SIDE), (left, SIDE))
    ]
    return Mesh(
        np.array(points),
        np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]]),
        np.array([1, 1, 2, 2]),
    )


def samples(gouge=(), left=()) -> Deviation:
    """Return samples 3 mm apart on both faces: finished, but 50 µm too deep or 30 µm too high at the samples nearest to some places."""
    x, y = (
        a.ravel() for a in np.meshgrid(np.arange(1.5, 2 * SIDE, APART), np.arange(1.5, SIDE, APART))
    )
    point = np.column_stack([x, y, np.zeros(x.size)])
    value = np.zeros(x.size)
    for places, depth in ((gouge, -0.05), (left, 0.03)):
        for place in places:
            value[np.argmin(np.hypot(x - place[0], y - place[1]))] = depth
    return Deviation(face=np.where(x < SIDE, 1, 2), point=point, deviation=value)


def longest_edge(shown, face) -> float:
    corners = shown.points[shown.triangles[shown.face == face]]
    return float(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max())


def areas(shown) -> np.ndarray:
    a, b, c = np.moveaxis(shown.points[shown.triangles], 1, 0)
    return 0.5 * np.cross(b - a, c - a)[:, 2]


def test_only_a_face_that_deviates_is_divided(mesh):
    shown = deviation_map(mesh, samples(gouge=[(30, 30)]), 0.02)
    assert longest_edge(shown, 1) <= APART
    assert longest_edge(shown, 2) == pytest.approx(SIDE * np.sqrt(2))


def test_dividing_keeps_the_area_and_the_side_that_is_outside(mesh):
    shown = deviation_map(mesh, samples(gouge=[(30, 30)]), 0.02)
    assert (areas(shown) > 0.0).all()
    assert areas(shown).sum() == pytest.approx(2 * SIDE**2)
    assert areas(shown)[shown.face == 1].sum() == pytest.approx(SIDE**2)


def test_a_gouge_of_one_sample_is_on_the_map_where_it_is(mesh):
    shown = deviation_map(mesh, samples(gouge=[(30, 30)]), 0.02)
    deep = shown.points[shown.value == -0.05]
    assert len(deep) >= 1
    assert np.linalg.norm(deep[:, :2] - 30.0, axis=1).max() < 2 * APART
    assert (shown.value == 0.0).sum() > 0.95 * len(shown.value)


def test_a_gouge_is_not_painted_over_by_what_is_left_beside_it(mesh):
    shown = deviation_map(
        mesh, samples(gouge=[(30, 30)], left=[(33, 30), (27, 30), (30, 33), (30, 27)]), 0.02
    )
    assert (shown.value == -0.05).any() and (shown.value == 0.03).any()


def test_a_face_takes_no_value_from_its_neighbour(mesh):
    shown = deviation_map(mesh, samples(gouge=[(SIDE - 1, 30)]), 0.02)
    assert (shown.value[np.unique(shown.triangles[shown.face == 2])] == 0.0).all()


def test_the_worst_places_come_in_order_gouges_first(mesh):
    shown = deviation_map(mesh, samples(gouge=[(10, 10), (90, 20)], left=[(40, 40)]), 0.02)
    assert [(w.face, w.deviation) for w in shown.worst] == [(1, -0.05), (2, -0.05), (1, 0.03)]
    assert shown.worst[0].point == pytest.approx((10, 10, 0), abs=APART)


def test_without_samples_all_is_finished(mesh):
    shown = deviation_map(mesh, NO_DEVIATION, 0.02)
    assert len(shown.triangles) == 4 and not shown.value.any() and shown.worst == ()


def test_an_allowance_is_no_deviation(mesh):
    assert deviation_map(mesh, samples(left=[(30, 30)]), 0.02, allowance=0.05).worst == ()


def test_gouges_are_red_what_is_left_is_blue_and_the_finished_is_grey():
    colours = load_palette().deviation
    deep, gouge, finished, left, much = colours.at(
        np.array([-0.06, -0.021, 0.0, 0.021, 0.06]), -0.02, 0.02, 0.05
    ).astype(int)
    assert gouge[0] > gouge[2] + 40 and deep[0] > deep[2] + 40
    assert left[2] > left[0] + 40 and much[2] > much[0] + 40
    assert np.ptp(finished) < 10
    assert deep.sum() < gouge.sum() and much.sum() < left.sum()


def test_within_the_tolerance_there_is_one_colour():
    found = load_palette().deviation.at(np.linspace(-0.02, 0.02, 9), -0.02, 0.02, 0.05)
    assert len(np.unique(found, axis=0)) == 1


def test_the_legend_of_the_picture_says_where_the_colours_begin_and_end(mesh):
    words = list(deviation_legend(deviation_map(mesh, samples(), 0.02), load_palette()))
    assert words == [
        "+50 µm or more left",
        "+35 µm",
        "+20 µm left",
        "finished",
        "-20 µm gouge",
        "-35 µm",
        "-50 µm or deeper",
    ]


@pytest.mark.parametrize(
    ("value", "words"), [(-0.05, "-50 µm"), (0.0123, "+12 µm"), (1.5, "+1.50 mm")]
)
def test_small_lengths_are_in_microns(value, words):
    assert fine_length(value) == words


def test_samples_in_close_pairs_do_not_divide_a_face_without_end(mesh):
    found = samples(gouge=[(30, 30)])
    beside = found.point + [1e-3, 0.0, 0.0]
    pairs = Deviation(
        face=np.tile(found.face, 2),
        point=np.vstack([found.point, beside]),
        deviation=np.tile(found.deviation, 2),
    )
    shown = deviation_map(mesh, pairs, 0.02)
    assert longest_edge(shown, 1) <= APART
    assert len(shown.triangles) < 20 * len(pairs.face)


def test_slivers_along_a_round_face_do_not_become_millions_of_triangles():
    n, height = 20_000, 400.0
    turn = np.linspace(0.0, 2.0 * np.pi, n, endpoint=False)
    ring = 300.0 * np.column_stack([np.cos(turn), np.sin(turn)])
    points = np.vstack([np.column_stack([ring, np.full(n, z)]) for z in (0.0, height)])
    low, after = np.arange(n), np.roll(np.arange(n), -1)
    triangles = np.concatenate(
        [np.column_stack([low, after, low + n]), np.column_stack([after, after + n, low + n])]
    )
    around, up = (a.ravel() for a in np.meshgrid(turn[:: n // 300], np.arange(2.0, height, 4.0)))
    found = Deviation(
        face=np.ones(len(up), np.int64),
        point=np.column_stack([300.0 * np.cos(around), 300.0 * np.sin(around), up]),
        deviation=np.where(np.arange(len(up)) == 0, -0.05, 0.0),
    )
    shown = deviation_map(Mesh(points, triangles, np.ones(2 * n, np.int64)), found, 0.02)
    assert 2 * n < len(shown.triangles) < 3 * MOST_TRIANGLES
    assert (shown.value == -0.05).any()
