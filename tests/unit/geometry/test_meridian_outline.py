"""The meridian of a turned part, from its triangles."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely

import samples
from seeded.impellers import small_impeller
from trunnion.geometry.meridian_outline import meridian_outline

AROUND = 24


def swept(rows, tags):
    """Return points, triangles and faces of what rows (k, 2) of radius and height make when they turn about z, a face for each line."""
    rows = np.asarray(rows, dtype=float)
    angle = 2.0 * math.pi * np.arange(AROUND) / AROUND
    points = np.concatenate(
        [
            np.column_stack([r * np.cos(angle), r * np.sin(angle), np.full(AROUND, z)])
            for r, z in rows
        ]
    )
    n, after = np.arange(AROUND), np.roll(np.arange(AROUND), -1)
    triangles, face = [], []
    for k in range(len(rows)):
        a, b = k * AROUND, (k + 1) % len(rows) * AROUND
        triangles += [np.column_stack([a + n, a + after, b + n])]
        triangles += [np.column_stack([a + after, b + after, b + n])]
        face += [tags[k]] * 2 * AROUND
    return points, np.vstack(triangles), np.array(face)


def outline_of(rows, tags=None):
    found = meridian_outline(*swept(rows, tags or list(range(1, len(rows) + 1))))
    return shapely.Polygon(found)


def test_a_ring_has_its_four_corners():
    made = outline_of([(5.0, 0.0), (20.0, 0.0), (20.0, 8.0), (5.0, 8.0)])
    assert made.area == pytest.approx(15.0 * 8.0, abs=1e-3)
    assert made.bounds == pytest.approx((5.0, 0.0, 20.0, 8.0), abs=1e-5)


def test_a_recess_of_an_end_stays_open():
    rows = [(5.0, 0.0), (10.0, 0.0), (10.0, 2.0), (15.0, 2.0), (15.0, 0.0), (20.0, 0.0)]
    made = outline_of([*rows, (20.0, 8.0), (5.0, 8.0)])
    assert made.area == pytest.approx(15.0 * 8.0 - 5.0 * 2.0, abs=1e-3)


def test_it_goes_round_anticlockwise():
    found = meridian_outline(*swept([(5.0, 0.0), (9.0, 0.0), (9.0, 4.0)], [1, 2, 3]))
    assert shapely.LinearRing(found).is_ccw


def test_two_parts_apart_are_refused():
    first = swept([(5.0, 0.0), (9.0, 0.0), (9.0, 4.0)], [1, 2, 3])
    second = swept([(5.0, 10.0), (9.0, 10.0), (8.0, 14.0)], [4, 5, 6])
    both = (
        np.vstack([first[0], second[0]]),
        np.vstack([first[1], second[1] + len(first[0])]),
        np.concatenate([first[2], second[2]]),
    )
    with pytest.raises(ValueError, match="2 pieces"):
        meridian_outline(*both)


def test_a_wheel_lies_within_its_outline_and_touches_it_with_its_tips():
    part = samples.read(small_impeller())
    mesh = part.mesh()
    made = shapely.Polygon(meridian_outline(mesh.points, mesh.triangles, mesh.face))
    meridian = np.column_stack([np.hypot(*mesh.points[:, :2].T), mesh.points[:, 2]])
    assert shapely.contains_xy(made.buffer(0.01), meridian).all()
    # Its widest place, the outlet, and its highest, the front.
    assert made.bounds[2:] == pytest.approx((20.0, 13.0), abs=1e-3)
    assert made.bounds[:2] == pytest.approx((2.5, -3.0), abs=1e-3)
