"""How far walls go down along the rulings of a guide line: to the border of all faces that are milled together."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.geometry.sheet.skin import Skin
from trunnion.plan.freeform.swarf.guide_lines import GuideLine
from trunnion.plan.freeform.swarf.level_sections import JOIN

BESIDE = 0.5
"""mm: how far from a position's tangent plane the border that its ruling comes down to may be: walls may be hollow below."""
CHUNK = 256
"""Positions that are looked at together."""


def border_of(skin: Skin, faces: tuple[int, ...]) -> Floats:
    """Return the edges (k, 2, 3) at which triangles of faces end: edges between two of these faces are none."""
    corners = skin.points[skin.triangles[skin.of(faces)]]
    ends = np.stack([corners, corners[:, [1, 2, 0]]], axis=2).reshape(-1, 2, 3)
    if not len(ends):
        return ends
    tree = cKDTree(ends.reshape(-1, 3))
    # Points of neighbours coincide: all of a place go by the lowest row there.
    lowest = np.arange(2 * len(ends))
    pairs = tree.query_pairs(JOIN, output_type="ndarray")
    np.minimum.at(lowest, pairs[:, 1], pairs[:, 0])
    key = np.sort(lowest[lowest].reshape(-1, 2), axis=1)
    _, first, count = np.unique(key, axis=0, return_index=True, return_counts=True)
    return np.asarray(ends[np.sort(first[count == 1])])


def depths(line: GuideLine, border: Floats) -> Floats:
    """Return how far (k,) in mm the faces go down along the rulings of a line's positions, infinite where no border is below."""
    found = np.full(len(line), np.inf)
    for begin in range(0, len(line), CHUNK):
        some = slice(begin, begin + CHUNK)
        found[some] = _depths(line.point[some], line.normal[some], line.ruling[some], border)
    return found


def _depths(point: Floats, normal: Floats, ruling: Floats, border: Floats) -> Floats:
    # The curtain of a position holds its normal and its ruling; the border crosses it.
    across = np.cross(normal, ruling)
    side = [
        np.einsum("ec,kc->ke", border[:, n], across) - (point * across).sum(axis=1)[:, None]
        for n in (0, 1)
    ]
    crosses = (side[0] <= 0.0) != (side[1] <= 0.0)
    row, edge = np.nonzero(crosses)
    a, b = side[0][row, edge], side[1][row, edge]
    share = (a / (a - b))[:, None]
    at = border[edge, 0] + share * (border[edge, 1] - border[edge, 0])
    off = at - point[row]
    down = -(off * ruling[row]).sum(axis=1)
    near = (np.abs((off * normal[row]).sum(axis=1)) <= BESIDE) & (down > -tolerance.SEW)
    found = np.full(len(point), np.inf)
    np.minimum.at(found, row[near], down[near])
    return found
