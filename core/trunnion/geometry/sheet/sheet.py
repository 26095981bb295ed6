"""A sheet: triangles of some faces of a skin, joined across patches wherever these run smoothly into each other.

Surface strategies lay fields over sheets (`fields.py`, `contours.py`) and cut along their lines. A sheet's triangles may be split until
they are fine enough for a field (`refine_sheet.py`); new points are put where the faces' own normals want them, on the cubic curve
through both ends of the edge (Vlachos, Curved PN Triangles), so that they leave the faces by the fourth power of an edge only.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.kernels.edge_numbers import numbered_edges_loop
from trunnion.geometry.sheet.skin import Skin

SMOOTH = np.cos(tolerance.SMOOTH_JOIN)
Measure = Callable[[Floats, Floats, Floats, Floats], Floats]
"""The lengths (e,) of edges from points (e, 3) with normals (e, 3) to points (e, 3) with normals (e, 3)."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Sheet:
    """Points (v, 3) mm and the faces' outward unit normals there (v, 3), triangles (t, 3) rows of points, anticlockwise from outside, and
    the tag of each one's face (t,). Points are shared across smooth joins of faces, not across sharp ones."""

    points: Floats
    normals: Floats
    triangles: Ints
    face: Ints
    _edges: list[tuple[Ints, Ints]] = field(init=False, repr=False, default_factory=list)

    def on_edges(self, ends: Ints, share: Floats) -> tuple[Floats, Floats]:
        """Return points and normals (k, 3) on the curved edges between points `ends` (k, 2), at shares (k,) of their way."""
        a, b = ends.T
        return between(self.points[a], self.normals[a], self.points[b], self.normals[b], share)

    def edges(self) -> tuple[Ints, Ints]:
        """Return the edges (e, 2), lower row of points first, and which of them the sides (t, 3) of the triangles are.

        Side k runs from a triangle's corner k to the next one.
        """
        if not self._edges:
            self._edges.append(edges_of(self.triangles, len(self.points)))
        return self._edges[0]

    def rims(self) -> list[Ints]:
        """Return the loops of points (k,) where the sheet ends, the sheet on their left; the longest one first."""
        n = len(self.points)
        start, end = self.triangles.ravel(), self.triangles[:, [1, 2, 0]].ravel()
        free = ~np.isin(start * n + end, end * n + start)
        start, end = start[free], end[free]
        order = np.argsort(start, kind="stable")
        start, end = start[order], end[order]
        used, loops = np.zeros(len(start), bool), []
        for first in range(len(start)):
            loop, row = [], first
            while not used[row]:
                used[row] = True
                loop.append(int(start[row]))
                low, high = np.searchsorted(start, [end[row], end[row] + 1])
                row = next((r for r in range(low, high) if not used[r]), first)
            if len(loop) > 2:
                loops.append(np.array(loop))
        return sorted(loops, key=self._round, reverse=True)

    def _round(self, loop: Ints) -> float:
        return float(
            np.linalg.norm(
                np.diff(self.points[loop], axis=0, append=self.points[loop[:1]]), axis=1
            ).sum()
        )

    def area(self) -> Floats:
        """Return the area of each triangle (t,) in mm2."""
        a, b, c = np.moveaxis(self.points[self.triangles], 1, 0)
        return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)

    def components(self) -> list[Sheet]:
        """Return the connected parts, those with the lowest face tags first."""
        t = self.triangles
        links = coo_matrix(
            (np.ones(2 * len(t)), (t[:, [0, 1]].ravel(), t[:, [1, 2]].ravel())),
            shape=(len(self.points),) * 2,
        )
        label = connected_components(links, directed=False)[1][t[:, 0]]
        parts = [self.of(label == part) for part in np.unique(label)]
        return sorted(parts, key=lambda s: (int(s.face.min()), *s.points[0].tolist()))

    def filled(self, holes: list[Ints]) -> Sheet:
        """Return the sheet with holes (k,), loops of `rims`, closed by triangles with the tag 0: a field may run on over them."""
        sheet = self
        for hole in holes:
            middle, n = len(sheet.points), len(hole)
            fan = np.column_stack([np.roll(hole, -1), hole, np.full(n, middle)])
            sheet = Sheet(
                points=np.vstack([sheet.points, sheet.points[hole].mean(axis=0)]),
                normals=np.vstack([sheet.normals, unit(sheet.normals[hole].sum(axis=0)[None])]),
                triangles=np.vstack([sheet.triangles, fan]),
                face=np.concatenate([sheet.face, np.zeros(n, np.int64)]),
            )
        return sheet

    def parted(self, ends: Ints, side: Ints, rows: Ints, share: Floats) -> tuple[Sheet, Ints]:
        """Return the sheet with some of its edges (`edges` gives ends and sides), rows (k,), parted at shares (k,) of their way, and for
        each edge the row of its new point, -1: none. New points come after the old ones, in the order of `rows`."""
        number = np.full(len(ends), -1)
        number[rows] = len(self.points) + np.arange(len(rows))
        points, normals = self.on_edges(ends[rows], share)
        triangles, face = _parted(self, number[side])
        made = Sheet(
            points=np.vstack([self.points, points]),
            normals=np.vstack([self.normals, normals]),
            triangles=triangles,
            face=face,
        )
        return made, number

    def of(self, rows: Bools) -> Sheet:
        """Return a part of the sheet: some triangles (t,) and the points they need."""
        used, triangles = np.unique(self.triangles[rows], return_inverse=True)
        return Sheet(
            points=self.points[used],
            normals=self.normals[used],
            triangles=triangles.reshape(-1, 3),
            face=self.face[rows],
        )


def _parted(sheet: Sheet, middle: Ints) -> tuple[Ints, Ints]:
    """Return triangles, and their faces, with the sides (t, 3) parted that have a middle, -1: none."""
    split = middle >= 0
    count = split.sum(axis=1)
    made, tags = [sheet.triangles[count == 0]], [sheet.face[count == 0]]
    for n, lone in ((1, True), (2, False), (3, True)):
        rows = np.flatnonzero(count == n)
        # Turned so that a lone middle is on the first side, and a lone side without one is the second side.
        k = (
            np.argmax(split[rows] == lone, axis=1)
            if n != 2
            else (np.argmax(~split[rows], axis=1) + 2) % 3
        )
        a, b, c = (sheet.triangles[rows, (k + j) % 3] for j in range(3))
        ab, bc, ca = (middle[rows, (k + j) % 3] for j in range(3))
        parts = {
            1: ((a, ab, c), (ab, b, c)),
            2: ((a, ab, ca), (ab, b, c), (ab, c, ca)),
            3: ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)),
        }[n]
        made += [np.column_stack(part) for part in parts]
        tags += [sheet.face[rows]] * len(parts)
    return np.vstack(made), np.concatenate(tags)


def sheet_of(skin: Skin, faces: tuple[int, ...]) -> Sheet:
    """Return the sheet of faces (tags) of a skin; no triangle when the skin has none of them."""
    rows = skin.of(faces)
    used, triangles = np.unique(skin.triangles[rows], return_inverse=True)
    triangles, points, normals = triangles.reshape(-1, 3), skin.points[used], skin.normals[used]
    joined = _joined(points, normals)
    firsts, label = np.unique(joined, return_index=True, return_inverse=True)[1:]
    normal = np.zeros((len(firsts), 3))
    np.add.at(normal, label, normals)
    triangles = label[triangles]
    real = (triangles != triangles[:, [1, 2, 0]]).all(axis=1)
    return Sheet(
        points=points[firsts],
        normals=unit(normal),
        triangles=triangles[real],
        face=skin.face[rows][real],
    )


def _joined(points: Floats, normals: Floats) -> Ints:
    """Return for each point the lowest row of those that coincide with it and face the same way."""
    n = len(points)
    pairs = (
        cKDTree(points).query_pairs(tolerance.JOINED_POINTS, output_type="ndarray")
        if n
        else np.zeros((0, 2), int)
    )
    pairs = pairs[(normals[pairs[:, 0]] * normals[pairs[:, 1]]).sum(axis=1) >= SMOOTH]
    label = connected_components(
        coo_matrix((np.ones(len(pairs)), pairs.T), shape=(n, n)), directed=False
    )[1]
    lowest = np.full(n, n)
    np.minimum.at(lowest, label, np.arange(n))
    return np.asarray(lowest[label])


def edges_of(triangles: Ints, n_points: int) -> tuple[Ints, Ints]:
    """Return the edges (e, 2) of triangles (t, 3), lower row of points first, and which of them the triangles' sides (t, 3) are."""
    ends, side = numbered_edges_loop(np.ascontiguousarray(triangles, dtype=np.int64), n_points)
    return np.asarray(ends), np.asarray(side)


def between(
    a: Floats, a_normal: Floats, b: Floats, b_normal: Floats, share: Floats
) -> tuple[Floats, Floats]:
    """Return points and normals (k, 3) at shares (k,) of the cubic curves that run from a to b square to the normals of both."""
    direction, s = b - a, share[:, None]
    out = direction - (direction * a_normal).sum(axis=1, keepdims=True) * a_normal
    into = direction - (direction * b_normal).sum(axis=1, keepdims=True) * b_normal
    point = (
        a + s * direction + s * (1.0 - s) * ((1.0 - s) * (out - direction) - s * (into - direction))
    )
    return point, unit((1.0 - s) * a_normal + s * b_normal)


def unit(vectors: Floats) -> Floats:
    """Return vectors (k, 3) at length 1; those without length stay."""
    size = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.divide(vectors, size, out=np.zeros_like(vectors), where=size > 0.0)
