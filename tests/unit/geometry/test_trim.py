"""Places told inside or outside of outlines: the compiled loop beside the plain one, and faces beside the CAD kernel."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from samples import ball_shape, block_with_pocket_shape, oblique_cylinder_shape, read
from trunnion.geometry.frame import WORLD
from trunnion.geometry.kernels.outline import IN, NEAR, OUT, points_in_polygon
from trunnion.geometry.outlines import Outlines
from trunnion.part.shape.exact import ExactFace


def closed(corners):
    corners = np.array(corners, dtype=float)
    return np.hstack([corners, np.roll(corners, -1, axis=0)])


def test_a_hole_in_a_square_is_outside_and_beside_a_rim_nothing_is_told() -> None:
    outlines = Outlines.of(
        np.vstack(
            [closed([(0, 0), (9, 0), (9, 9), (0, 9)]), closed([(3, 3), (6, 3), (6, 6), (3, 6)])]
        ),
        0.1,
    )
    places = np.array(
        [(1, 1), (4.5, 4.5), (8.95, 4), (6.05, 5), (-3, 4), (4, 20), (3, 7)], dtype=float
    )
    assert outlines.within(places).tolist() == [IN, OUT, NEAR, NEAR, OUT, OUT, IN]


@settings(deadline=None, max_examples=30)
@given(st.integers(0, 10_000), st.integers(3, 40))
def test_strips_find_what_all_pieces_find(seed: int, corners: int) -> None:
    rng = np.random.default_rng(seed)
    pieces = closed(rng.uniform(0.0, 1.0, (corners, 2)).round(int(rng.integers(1, 4))))
    places = np.vstack([rng.uniform(-0.2, 1.2, (60, 2)), pieces[:5, :2]])
    assert (
        Outlines.of(pieces, 0.01).within(places) == points_in_polygon(places, pieces, 0.01)
    ).all()


@pytest.mark.parametrize("shape", [block_with_pocket_shape, ball_shape, oblique_cylinder_shape])
def test_many_places_at_once_are_told_as_the_kernel_tells_each(shape) -> None:
    part = read(shape())
    for tag in part.tags:
        face = ExactFace(part, tag, WORLD)
        u0, u1, v0, v1 = face.bounds()
        places = np.random.default_rng(tag).uniform(-0.05, 1.05, (200, 2)) * [u1 - u0, v1 - v0] + [
            u0,
            v0,
        ]
        places[:20, 0], places[20:40, 1] = u0, v1
        assert (face.inside(places) == [face.inside(p[None])[0] for p in places]).all()
