"""Which face of a mesh points lie on."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from trunnion.geometry.faces_of_points import nearest_faces, triangle_distances
from trunnion.geometry.mesh import Mesh

PLACES = st.lists(st.integers(-6, 6), min_size=3, max_size=3)
GRID = 40


def sampled_distance(point, corners) -> tuple[float, float]:
    """Return how far a point is from the nearest of many places on a triangle, and how far these are apart at most."""
    u, v = np.meshgrid(np.linspace(0.0, 1.0, GRID), np.linspace(0.0, 1.0, GRID))
    inside = u + v <= 1.0 + 1e-12
    u, v = u[inside][:, None], v[inside][:, None]
    a, b, c = corners
    places = a + u * (b - a) + v * (c - a)
    apart = max(np.linalg.norm(b - a), np.linalg.norm(c - a)) / (GRID - 1)
    return float(np.linalg.norm(places - point, axis=1).min()), float(2.0 * apart)


@given(PLACES, st.lists(PLACES, min_size=3, max_size=3))
def test_a_point_is_as_far_from_a_triangle_as_from_its_nearest_place(point, corners) -> None:
    place, triangle = np.array(point, float), np.array(corners, float)
    (found,) = triangle_distances(place, triangle[None])
    sampled, apart = sampled_distance(place, triangle)
    assert sampled - apart - 1e-9 <= found <= sampled + 1e-9


def two_walls() -> Mesh:
    """Return two walls that meet in an edge: face 1 in the plane y = 0, face 2 in x = 10, both 5 mm high."""
    points = np.array(
        [[0, 0, 0], [10, 0, 0], [10, 0, 5], [0, 0, 5]]
        + [[10, 0, 0], [10, 8, 0], [10, 8, 5], [10, 0, 5]],
        float,
    )
    triangles = np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]])
    return Mesh(points, triangles, np.array([1, 1, 2, 2]))


def test_points_are_on_the_nearest_of_the_faces_that_are_meant() -> None:
    points = np.array([[5.0, 0.1, 2.0], [9.9, 4.0, 2.0], [5.0, 3.0, 2.0], [9.8, 0.1, 1.0]])
    mesh = two_walls()
    assert nearest_faces(mesh, points, (1, 2), 0.5).tolist() == [1, 2, 0, 1]
    assert nearest_faces(mesh, points, (2,), 0.5).tolist() == [0, 2, 0, 2]
    assert nearest_faces(mesh, points, (3,), 0.5).tolist() == [0, 0, 0, 0]


@pytest.mark.parametrize("faces", [(), (1,)])
def test_no_points_are_on_no_face(faces) -> None:
    assert len(nearest_faces(two_walls(), np.zeros((0, 3)), faces, 1.0)) == 0
