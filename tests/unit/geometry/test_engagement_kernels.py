"""The loops of constant engagement beside plain references, and few arcs through many points."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.ndimage import map_coordinates

from trunnion.geometry.arrays import Floats
from trunnion.geometry.kernels import constant_engagement as kernels
from trunnion.geometry.kernels.arc_fitting import LARGEST
from trunnion.geometry.plane.arc_fitting import arcs_through, arcs_through_many
from trunnion.geometry.plane.curve import Curve

X0, Y0, CELL, RADIUS = -20.0, -15.0, 0.5, 8.0
SHAPE = (90, 80)
FAN = np.column_stack(
    [np.cos(np.linspace(0.0, math.pi, 48)), np.sin(np.linspace(0.0, math.pi, 48))]
)


def nodes() -> Floats:
    x, y = X0 + CELL * np.arange(SHAPE[0]), Y0 + CELL * np.arange(SHAPE[1])
    return np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1)


def full() -> Floats:
    return np.full(SHAPE, 1000.0)


@settings(deadline=None)
@given(st.floats(-30.0, 40.0), st.floats(-30.0, 40.0))
def test_a_field_is_bilinear_between_nodes_and_level_outside(x: float, y: float) -> None:
    field = np.random.default_rng(1).normal(size=SHAPE)
    at = np.clip([(x - X0) / CELL, (y - Y0) / CELL], 0.0, np.array(SHAPE) - 1.0)
    wanted = map_coordinates(field, at[:, None], order=1, mode="nearest")[0]
    assert kernels.field_value(field, X0, Y0, CELL, x, y) == pytest.approx(wanted, abs=1e-9)


@settings(max_examples=20, deadline=None)
@given(*(st.floats(-5.0, 15.0) for _ in range(4)))
def test_a_swept_disc_leaves_distances_about_its_rim(
    ax: float, ay: float, bx: float, by: float
) -> None:
    uncut = full()
    kernels.sweep_disc(uncut, X0, Y0, CELL, ax, ay, bx, by, RADIUS)
    start, way = np.array([ax, ay]), np.array([bx - ax, by - ay])
    share = (nodes() - start) @ way / max(float(way @ way), 1e-300)
    nearest = start + np.clip(share, 0.0, 1.0)[..., None] * way
    away = np.linalg.norm(nodes() - nearest, axis=-1) - RADIUS
    near = np.abs(away) < kernels.BAND * CELL * 0.9
    assert np.abs(uncut[near] - away[near]).max() < 1e-9
    assert (uncut >= away - 1e-9).all()


@pytest.mark.parametrize("width", [0.8, 4.0, 8.0, 12.0])
def test_a_straight_cut_has_the_contact_of_its_width(width: float) -> None:
    # Half a plane was cleared: the cutter's axis goes along x, `width` of it in material at its right.
    uncut = nodes()[..., 1] * -1.0 - 0.0
    y = RADIUS - width
    found = kernels.engagement_at(uncut, X0, Y0, CELL, 2.0, y, 0.0, RADIUS, FAN, 0.0, 1.0)
    assert found == pytest.approx(math.acos(1.0 - width / RADIUS), abs=math.radians(0.6))
    # Going the other way the material is at the left.
    assert kernels.engagement_at(
        uncut, X0, Y0, CELL, 2.0, y, math.pi, RADIUS, FAN, 0.0, -1.0
    ) == pytest.approx(found, abs=1e-6)


def test_a_march_along_a_straight_front_keeps_the_angle() -> None:
    uncut, depth = -nodes()[..., 1], full()
    path = np.empty((40, 4))
    start = np.array([-10.0, RADIUS - 4.0, 0.0])
    angle = math.radians(60.0)
    count, why = kernels.march_engaged(
        uncut,
        depth,
        X0,
        Y0,
        CELL,
        start,
        RADIUS,
        FAN,
        0.0,
        1.0,
        True,
        angle,
        0.05,
        0.5,
        0.1,
        5.0,
        5.0,
        path,
    )
    assert (count, why) == (40, kernels.LONG)
    assert np.abs(path[:, 1] - (RADIUS - 4.0)).max() < 0.05
    assert path[1:, 3].max() <= angle + 1e-9


def test_a_march_that_meets_nothing_ends_and_one_without_a_way_says_so() -> None:
    path = np.empty((400, 4))
    start = np.array([0.0, 0.0, 0.0])
    for depth, why in ((full(), kernels.NOTHING_MET), (-full(), kernels.STUCK)):
        found = kernels.march_engaged(
            -full(),
            depth,
            X0,
            Y0,
            CELL,
            start,
            RADIUS,
            FAN,
            0.0,
            1.0,
            True,
            1.0,
            0.05,
            0.5,
            0.1,
            5.0,
            5.0,
            path,
        )
        assert found[1] == why


def test_a_line_is_free_where_the_disc_clears_it() -> None:
    uncut, depth = full(), full()
    kernels.sweep_disc(uncut, X0, Y0, CELL, 0.0, 0.0, 10.0, 5.0, RADIUS)
    free = [
        kernels.line_is_free(uncut, depth, X0, Y0, CELL, 0.0, 0.0, x, y, RADIUS, FAN, 0.05)
        for x, y in ((10.0, 5.0), (5.0, 2.5), (10.0, 8.0), (14.0, 7.0))
    ]
    assert free == [True, True, False, False]


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**32 - 1))
@example(675)
def test_arcs_are_those_of_the_plain_loop(seed: int) -> None:
    pick = np.random.default_rng(seed)
    turns = np.repeat(pick.uniform(-0.1, 0.12, 8), pick.integers(3, 25, 8))
    headings = np.cumsum(turns)
    points = np.cumsum(np.column_stack([np.cos(headings), np.sin(headings)]) * 0.7, axis=0)
    within = 0.02
    plain, compiled = arcs_through(points, within, chords=True), arcs_through_many(points, within)
    assert len(compiled[0]) <= len(plain[0]) + 1
    curve = Curve(compiled[0], np.append(compiled[1], 0.0), False)
    assert curve.distance(points).max() <= within + 1e-6
    if len(compiled[0]) == len(plain[0]) and (compiled[0] == plain[0]).all():
        # A larger arc is a line to the compiled loop, as controls want it: its radius is the chord over four bulges.
        chord = np.linalg.norm(np.diff(plain[0], axis=0), axis=1)
        largest = np.abs(plain[1]) * 4.0 * LARGEST > chord * (1.0 - 1e-6)
        assert compiled[1] == pytest.approx(np.where(largest, plain[1], 0.0), abs=1e-7)


def test_an_arc_that_is_nearly_straight_is_a_line() -> None:
    x = np.linspace(0.0, 100.0, 200)
    points = np.column_stack([x, x**2 / (4.0 * LARGEST)])
    ends, bulges = arcs_through_many(points, 0.2)
    assert len(ends) == 2
    assert bulges == pytest.approx([0.0])
