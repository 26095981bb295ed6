"""Points that are one point: the compiled loop against the plain one."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from trunnion import tolerance
from trunnion.geometry.kernels.point_groups import first_of_group
from trunnion.geometry.kernels.point_groups_compiled import first_of_group_loop
from trunnion.geometry.plane.chords import pulled_together

CLOSE = tolerance.COINCIDENT


@settings(deadline=None)
@given(
    st.lists(st.tuples(st.integers(-3, 3), st.integers(-3, 3)), max_size=40),
    st.sampled_from([0.4, 0.5, 0.7, 1.0, 1.3]),
)
def test_the_compiled_loop_finds_the_first_ones_of_the_plain_one(
    cells: list[tuple[int, int]], step: float
) -> None:
    """On a grid of about the tolerance, where points hang together in chains."""
    points = np.array(cells, dtype=np.float64).reshape(-1, 2) * step * CLOSE
    order = np.argsort(points[:, 0], kind="stable")
    made = first_of_group_loop(points, order, CLOSE)
    assert (made == first_of_group(points, CLOSE)).all()


def test_points_that_are_one_get_the_coordinates_of_the_first() -> None:
    near = 0.4 * CLOSE
    points = np.array([[5.0, 5.0], [0.0, 0.0], [5.0 + near, 5.0 - near], [5.0, 5.0 + 3.0 * CLOSE]])
    made = pulled_together(points)
    assert (made[2] == points[0]).all()
    assert (made[[0, 1, 3]] == points[[0, 1, 3]]).all()


def test_no_point_is_none() -> None:
    assert pulled_together(np.empty((0, 2))).shape == (0, 2)
