"""What an earlier cutter left of faces, as an area of its own: triangles that it does not reach, and a little around them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.skin import Skin
from trunnion.model.tool import Tool
from trunnion.plan.surface.cutter import lower_side, tip_at

LIFTED = 0.5 * tolerance.GOUGE
"""mm: a cutter that other faces lift by no more than this still finishes a place."""
AROUND = 0.3
"""mm that the area goes on past what was left, so that no seam stays."""
LEFT = 1_000_000
"""Added to a face's tag for the part of it that was left: more than any part has faces."""


def left_by(skin: Skin, tags: tuple[int, ...], earlier: Tool, lowest: float) -> tuple[Skin, tuple[int, ...]]:
    """Return the skin with what an upright cutter leaves of faces given tags of their own, and those tags."""
    rows = np.flatnonzero(skin.of(tags))
    middle, normal = _middles(skin, rows)
    middle = middle + 2.0 * skin.bound * normal
    up = normal[:, 2] > 0.0
    left = np.ones(len(rows), dtype=bool)
    tip = tip_at(earlier, middle[up], normal[up], np.tile([0.0, 0.0, 1.0], (int(up.sum()), 1)))
    left[up] = skin.drop.drop(tip[:, :2], lower_side(earlier), lowest) - tip[:, 2] > LIFTED
    left = _with_those_near(middle, left)
    face = skin.face.copy()
    face[rows[left]] += LEFT
    return replace(skin, face=face), tuple(int(t) for t in np.unique(face[rows[left]]))


def _middles(skin: Skin, rows: Ints) -> tuple[Floats, Floats]:
    """Return the middles (k, 3) of triangles and the faces' unit normals there."""
    corners = skin.triangles[rows]
    normal = skin.normals[corners].mean(axis=1)
    return skin.points[corners].mean(axis=1), normal / np.linalg.norm(normal, axis=1, keepdims=True)


def _with_those_near(middle: Floats, left: Bools) -> Bools:
    if not left.any() or left.all():
        return left
    away = cKDTree(middle[left]).query(middle, distance_upper_bound=AROUND)[0]
    return np.asarray(left | np.isfinite(away))
