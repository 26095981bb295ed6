"""What stands on ground laid flat, above heights."""

from __future__ import annotations

import numpy as np
import pytest

from trunnion.geometry.plane.plan_area import plan_area_above
from trunnion.plan.development.ground import GROWN, GroundObstacle

HEIGHTS = (-0.5, 0.005, 0.3, 2.0, 4.9, 5.1, 7.5, 9.9, 10.0, 12.0)


def boss() -> GroundObstacle:
    """Return a round boss with a flat top at z = 10 on a fillet of 4 mm, its triangles about as many as a mesh has."""
    lean = np.linspace(0.0, 0.5 * np.pi, 24)
    rim = np.column_stack([16.0 - 4.0 * np.sin(lean), 4.0 - 4.0 * np.cos(lean)])
    rim = np.vstack([rim, [12.0, 10.0], [0.0, 10.0]])
    turn = np.linspace(0.0, 2.0 * np.pi, 65)
    points = np.stack(
        [
            rim[:, None, 0] * np.cos(turn),
            rim[:, None, 0] * np.sin(turn),
            np.repeat(rim[:, 1:], len(turn), axis=1),
        ],
        axis=-1,
    )
    a, b, c, d = points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]
    corners = np.concatenate(
        [np.stack(t, axis=2).reshape(-1, 3, 3) for t in ((a, b, c), (a, c, d))]
    )
    return GroundObstacle(corners=corners, closed=False)


@pytest.mark.parametrize("z", HEIGHTS)
def test_an_obstacle_is_as_wide_above_a_height_as_all_its_triangles(z):
    made = boss()
    found, whole = made.over(z), plan_area_above(made.corners, z, GROWN)
    assert found.area == pytest.approx(whole.area, abs=1e-3 * whole.area)
    assert whole.minus(found).area < 0.01 * max(whole.area, 1.0)
    assert bool(found) is (z < 10.0)


def test_the_area_above_a_height_does_not_depend_on_what_was_asked_before():
    first, second = boss(), boss()
    up = {z: first.over(z) for z in HEIGHTS}
    down = {z: second.over(z) for z in HEIGHTS[::-1]}
    for z in HEIGHTS:
        assert up[z].area == down[z].area and bool(up[z]) is bool(down[z])
        assert not up[z] or np.array_equal(up[z].box(), down[z].box())
