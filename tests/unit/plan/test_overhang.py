"""What of a skin hangs over: told by the faces' own normals."""

from __future__ import annotations

import numpy as np

from trunnion.geometry.sheet.skin import Skin
from trunnion.plan.freeform.finishing.rest import overhanging


def plates(side: int) -> Skin:
    """Return a level top at z = 10 with a sliver along its border that is turned over, and beside it a level face at z = 5 that looks up
    (1) or down (-1)."""
    top = np.array([[0.0, 0.0], [100.0, 0.0], [100.0, 50.0], [0.0, 50.0], [50.0, 1e-3]])
    low = top[:4] + [120.0, 0.0]
    points = np.vstack(
        [np.column_stack([top, np.full(5, 10.0)]), np.column_stack([low, np.full(4, 5.0)]), [[0.0, 0.0, -1.0]]]
    )  # fmt: skip
    normals = np.tile([0.0, 0.0, 1.0], (len(points), 1))
    normals[5:9, 2] = side
    lower = [[5, 6, 7], [5, 7, 8]] if side > 0 else [[5, 7, 6], [5, 8, 7]]
    return Skin(
        points=points,
        normals=normals,
        triangles=np.array([[4, 1, 2], [4, 2, 3], [0, 4, 3], [0, 4, 1], *lower]),
        face=np.array([1, 1, 1, 1, 2, 2]),
        bound=0.0,
    )


def test_a_sliver_that_is_turned_over_is_no_overhang() -> None:
    """Level ground was taken for an overhang all along it: pockets beside it stayed unfinished."""
    skin = plates(1)
    corners = skin.points[skin.triangles]
    assert np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[3, 2] < 0.0
    assert overhanging(skin) is None


def test_a_face_that_looks_down_above_the_lowest_height_hangs_over() -> None:
    found = overhanging(plates(-1))
    assert found is not None and len(found.facets) == 2
