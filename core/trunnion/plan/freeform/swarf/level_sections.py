"""Level sections of faces: where a plane cuts the triangles of some faces, as lines with the faces' own normals."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from trunnion import tolerance
from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.sheet.skin import Skin

JOIN = 10.0 * tolerance.COINCIDENT
"""mm: ends of crossings that are no farther apart are one position."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SectionLine:
    """A line along which a level plane cuts faces, the material on its right: points (k, 3) mm with the outward unit normals (k, 3) and the
    tags (k,) of the faces. Where it runs from one face to the next a position is there twice, with the normal and the tag of either.

    A `closed` line begins where it runs from one face to another, if it does so anywhere, and ends where it begins.
    """

    point: Floats
    normal: Floats
    face: Ints
    closed: bool

    def runs(self) -> list[slice]:
        """Return the rows of each stretch on one face."""
        edges = np.flatnonzero(np.diff(self.face)) + 1
        ends = [0, *edges.tolist(), len(self.face)]
        return [slice(a, b) for a, b in pairwise(ends)]


def level_sections(skin: Skin, faces: tuple[int, ...], z: float) -> list[SectionLine]:
    """Return the lines along which the plane at a height z (mm) cuts faces; those with most crossings first."""
    start, end, face = _crossings(skin, faces, z)
    if not len(face):
        return []
    node = _joined(np.vstack([start[0], end[0]]))
    first, last = node[: len(face)], node[len(face) :]
    real = first != last
    chains = _chains(first[real], last[real])
    rows = np.flatnonzero(real)
    found = [_line(rows[chain], (*start, *end), face, closed=closed) for chain, closed in chains]
    return sorted(found, key=lambda line: (-len(line.face), *line.point[0].tolist()))


def _crossings(
    skin: Skin, faces: tuple[int, ...], z: float
) -> tuple[tuple[Floats, Floats], tuple[Floats, Floats], Ints]:
    """Return for each triangle that is cut where the section enters and leaves it, as points and normals (k, 3), and the tag (k,)."""
    rows = np.flatnonzero(skin.of(faces))
    heights = skin.points[skin.triangles[rows], 2]
    # A plane through a corner cuts just above it.
    above = heights > z
    cut = above.any(axis=1) & ~above.all(axis=1)
    rows, above = rows[cut], above[cut]
    corners, at = skin.triangles[rows], np.arange(len(rows))
    lone = np.argmax(above == (above.sum(axis=1) == 1)[:, None], axis=1)
    one, other = (
        _crossing(skin, corners[at, lone], corners[at, (lone + k) % 3], z) for k in (1, 2)
    )
    # The material on the right: along n x z.
    normal = one[1] + other[1]
    way = np.column_stack([normal[:, 1], -normal[:, 0]])
    swapped = (((other[0] - one[0])[:, :2] * way).sum(axis=1) < 0.0)[:, None]
    start, end = (
        (np.where(swapped, b[0], a[0]), np.where(swapped, b[1], a[1]))
        for a, b in ((one, other), (other, one))
    )
    return start, end, skin.face[rows]


def _crossing(skin: Skin, one: Ints, other: Ints, z: float) -> tuple[Floats, Floats]:
    """Return where edges between rows (k,) of points cross a height, and the unit normals there; the same to the last bit from either
    triangle beside an edge, for it is gone along upwards."""
    is_lower = skin.points[one, 2] < skin.points[other, 2]
    low, high = np.where(is_lower, one, other), np.where(is_lower, other, one)
    bottom, top = skin.points[low], skin.points[high]
    share = ((z - bottom[:, 2]) / (top[:, 2] - bottom[:, 2]))[:, None]
    point = bottom + share * (top - bottom)
    point[:, 2] = z
    normal = skin.normals[low] + share * (skin.normals[high] - skin.normals[low])
    return point, normal / np.linalg.norm(normal, axis=1, keepdims=True)


def _joined(points: Floats) -> Ints:
    """Return a number for each position (k, 3), the same for those that coincide."""
    pairs = cKDTree(points).query_pairs(JOIN, output_type="ndarray")
    links = coo_matrix((np.ones(len(pairs)), pairs.T), shape=(len(points),) * 2)
    return np.asarray(connected_components(links, directed=False)[1])


def _chains(first: Ints, last: Ints) -> list[tuple[Ints, bool]]:
    """Return the rows of crossings, from a node (k,) to a node (k,) each, one after the other, and whether they come back."""
    from_node: dict[int, list[int]] = {}
    for row, node in enumerate(first.tolist()):
        from_node.setdefault(node, []).append(row)
    coming = set(last.tolist())
    ends = [row for row, node in enumerate(first.tolist()) if node not in coming]
    used, found = np.zeros(len(first), bool), list[tuple[Ints, bool]]()
    for begin in [*ends, *range(len(first))]:
        chain, row = list[int](), begin
        while row >= 0 and not used[row]:
            used[row] = True
            chain.append(row)
            row = next((r for r in from_node.get(int(last[row]), []) if not used[r]), -1)
        if chain:
            found.append((np.array(chain), bool(last[chain[-1]] == first[chain[0]])))
    return found


def _line(
    chain: Ints, ends: tuple[Floats, Floats, Floats, Floats], face: Ints, *, closed: bool
) -> SectionLine:
    """Return the line through crossings, each position once a face."""
    own = face[chain]
    if closed and (own[0] == own[-1]) and (changes := np.flatnonzero(np.diff(own))).size:
        chain = np.roll(chain, -int(changes[0]) - 1)
        own = face[chain]
    start_point, start_normal, end_point, end_normal = (v[chain] for v in ends)
    begins = np.concatenate([[True], own[1:] != own[:-1]])
    order = np.sort(np.concatenate([2 * np.flatnonzero(begins), 2 * np.arange(len(own)) + 1]))
    at, is_end = order // 2, (order % 2 == 1)[:, None]
    return SectionLine(
        point=np.where(is_end, end_point[at], start_point[at]),
        normal=np.where(is_end, end_normal[at], start_normal[at]),
        face=own[at],
        closed=closed,
    )
