"""What an earlier cutter left of faces, as an area of its own: triangles that it does not reach, and a little around them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.sheet import edges_of
from trunnion.geometry.skin import Skin
from trunnion.model.tool import Tool
from trunnion.plan.surface.cutter import lower_side, tip_at
from trunnion.plan.surface.scallop import stepover_on_plane

LIFTED = 0.5 * tolerance.GOUGE
"""mm: a cutter that other faces lift by no more than this still reaches a place."""
UNSEEN = 0.1
"""Of the scallop height: a cutter that is lifted by no more than this finishes a place."""
AROUND = 0.3
"""mm at least that the area goes on past what was left, so that no seam stays; as far as passes are apart where that is more."""
BETWEEN = 0.25
"""Of a triangle's longest side: how far a place of its sides is from the nearest that is asked."""
LEFT = 1_000_000
"""Added to a face's tag for the part of it that was left: more than any part has faces."""


def left_by(skin: Skin, tags: tuple[int, ...], earlier: Tool, lowest: float, height: float) -> tuple[Skin, tuple[int, ...]]:
    """Return the skin with what an upright cutter leaves of faces given tags of their own, and those tags; `height` is the scallop height
    in mm that is wanted."""
    rows = np.flatnonzero(skin.of(tags))
    place, normal, of = _places(skin, rows)
    place = place + 2.0 * skin.bound * normal
    lifted = np.ones(len(place), dtype=bool)
    up = normal[:, 2] > 0.0
    tip = tip_at(earlier, place[up], normal[up], np.tile([0.0, 0.0, 1.0], (int(up.sum()), 1)))
    lifted[up] = skin.drop.drop(tip[:, :2], lower_side(earlier), lowest) - tip[:, 2] > min(UNSEEN * height, LIFTED)
    left = _with_those_near(place, of, lifted, max(AROUND, stepover_on_plane(earlier.corner_radius, height)))
    face = skin.face.copy()
    face[rows[left]] += LEFT
    return replace(skin, face=face), tuple(int(t) for t in np.unique(face[rows[left]]))


def _places(skin: Skin, rows: Ints) -> tuple[Floats, Floats, Ints]:
    """Return places (p, 3) on triangles, the faces' unit normals there, and which of them (k, 7) are the corners, the middles of the sides
    and the middle of each triangle: what a cutter leaves beside a rim may be narrower than a triangle."""
    used, corners = np.unique(skin.triangles[rows], return_inverse=True)
    corners = corners.reshape(-1, 3)
    ends, side = edges_of(corners, len(used))
    parts = [(x, x[ends].mean(axis=1), x[corners].mean(axis=1)) for x in (skin.points[used], skin.normals[used])]
    place, normal = (np.concatenate(part) for part in parts)
    of = np.column_stack([corners, len(used) + side, len(used) + len(ends) + np.arange(len(rows))])
    return place, normal / np.linalg.norm(normal, axis=1, keepdims=True), of


def _with_those_near(place: Floats, of: Ints, lifted: Bools, around: float) -> Bools:
    """Say which triangles, with places (k, 7) of all (p, 3), come as near as that to a lifted place (p,): wide ones may between theirs."""
    if not lifted.any():
        return np.zeros(len(of), dtype=bool)
    away = np.asarray(cKDTree(place[lifted]).query(place)[0])
    corners = place[of[:, :3]]
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    return np.asarray(away[of].min(axis=1) <= around + BETWEEN * longest)
