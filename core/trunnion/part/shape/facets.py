"""A part's faces as triangles, for whatever has no closed form: free-form faces, and tools whose axis leans or turns.

Planes come as few triangles; on curved faces only the chord error counts, never an angle, which makes them as few as that error allows
(`part.opening`); `Facets.bound` says what was measured.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats, Ints, floats, ints
from trunnion.geometry.frame import Frame
from trunnion.part.shape.refine_mesh import opened
from trunnion.progress import NO_PROGRESS, Progress

if TYPE_CHECKING:
    from trunnion.part.part import Part


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Facets:
    """Triangles of trimmed faces in a frame. f faces in rows, v points, t triangles.

    tag (f,) as `Surfaces.tag`; points (v, 3) mm; triangles (t, 3) rows of points, anticlockwise seen from outside; face (t,) rows of tag.
    bound: how far the triangles may be from the faces, mm. whole: no face was left out.
    """

    tag: Ints
    points: Floats
    triangles: Ints
    face: Ints
    bound: float = 0.0
    whole: bool = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "tag", ints(self.tag, (None,), "facets tag"))
        object.__setattr__(self, "points", floats(self.points, (None, 3), "facets points"))
        object.__setattr__(self, "triangles", ints(self.triangles, (None, 3), "facets triangles"))
        object.__setattr__(self, "face", ints(self.face, (len(self.triangles),), "facets face"))

    @staticmethod
    def of_mesh(
        points: Floats, triangles: Ints, face: Ints, tag: Ints, bound: float = 0.0
    ) -> Facets:
        """Return facets of a mesh, as of fixtures: points (v, 3), triangles (t, 3), face (t,) rows of tag (f,)."""
        return Facets(tag=tag, points=points, triangles=triangles, face=face, bound=bound)

    def moved(self, frame: Frame, other: Frame) -> Facets:
        """Return the same facets, given in one frame, in another one."""
        return replace(self, points=other.to_local(frame.to_world(self.points)))

    def of_faces(self, rows: Ints) -> Facets:
        """Return the facets of some faces; all faces keep their rows."""
        keep = np.isin(self.face, rows)
        return replace(self, triangles=self.triangles[keep], face=self.face[keep], whole=False)


def facets_of(
    part: Part,
    frame: Frame,
    chord: float = tolerance.FACET_CHORD,
    progress: Progress = NO_PROGRESS,
    only: Collection[int] | None = None,
) -> Facets:
    """Return a part's faces as triangles in a frame, curved ones within a chord error (mm).

    Rows are those of `Surfaces.tag`; with `only`, faces of other tags come without triangles. Raises `BadInput` for a face that the mesher
    can't do and `OutOfMemory` for more triangles than fit.
    """
    wanted = [tag for tag in part.tags if only is None or tag in only]
    made = opened(part, dict.fromkeys(wanted, chord), progress)
    return Facets(
        tag=np.array(part.tags),
        points=frame.to_local(made.points),
        triangles=made.triangles,
        face=np.searchsorted(part.tags, made.tag)[made.face],
        bound=float(made.bound.max(initial=0.0)),
        whole=len(wanted) == len(part.tags),
    )


def facet_samples(
    facets: Facets, rows: Ints, spacing: float, progress: Progress = NO_PROGRESS
) -> tuple[Ints, Floats, Floats, Floats]:
    """Return samples of some faces about `spacing` mm apart: face (s,) rows, point and outward normal (s, 3), area (s,) mm2.

    Triangles wider than that are cut into equal ones; of those that share a cell of a grid one represents all.
    """
    found = [
        _face_samples(facets, int(row), spacing, progress)
        for row in progress.each(np.intersect1d(rows, facets.face))
    ] or [_none_sampled()]
    face, point, normal, area = (np.concatenate(columns) for columns in zip(*found, strict=True))
    return face, point, normal, area


def _none_sampled() -> tuple[Ints, Floats, Floats, Floats]:
    return np.zeros(0, np.int64), np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0)


def _face_samples(
    facets: Facets, row: int, spacing: float, progress: Progress
) -> tuple[Ints, Floats, Floats, Floats]:
    """Return the samples of one face."""
    own = facets.face == row
    corners, face = facets.points[facets.triangles[own]], facets.face[own]
    normal, area = _normals(corners)
    width = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2).max(axis=1, initial=0.0)
    cuts = np.maximum(np.ceil(width / spacing), 1.0).astype(np.int64)
    parts = [_middles(corners[cuts == n], int(n)) for n in progress.each(np.unique(cuts))]
    owner = np.concatenate(
        [
            np.zeros(0, np.int64),
            *(np.repeat(np.flatnonzero(cuts == n), n * n) for n in np.unique(cuts)),
        ]
    )
    point, share = np.vstack([np.zeros((0, 3)), *parts]), (area / cuts**2)[owner]
    progress.check()
    first, total = represented(point, share, spacing, progress)
    return face[owner[first]], point[first], normal[owner[first]], total


def represented(
    point: Floats, area: Floats, spacing: float, progress: Progress = NO_PROGRESS
) -> tuple[Ints, Floats]:
    """Return the rows (k,) of the points (s, 3) that represent all in their cell of a grid, and how much area (k,) each stands for.

    The one nearest to the middle of its cell's area represents it.
    """
    group = grouped(np.floor(point / spacing).astype(np.int64))
    progress.check()
    total: Floats = np.bincount(group, area).astype(np.float64)
    middle = np.column_stack(
        [np.bincount(group, area * point[:, k]).astype(np.float64) for k in range(3)]
    )
    middle = middle / np.maximum(total, tolerance.COINCIDENT**2)[:, None]
    away = np.linalg.norm(point - middle[group], axis=1)
    order = np.lexsort((away, group))
    return order[np.flatnonzero(np.diff(group[order], prepend=-1))], total


def grouped(rows: Ints) -> Ints:
    """Return for each row (k, n) which of the distinct ones it is (k,), these in lexical order; lets go of the interpreter's lock."""
    order = np.lexsort(rows.T[::-1])
    fresh = (np.diff(rows[order], axis=0) != 0).any(axis=1)
    group = np.empty(len(rows), np.int64)
    group[order] = np.concatenate([np.zeros(min(len(rows), 1), np.int64), np.cumsum(fresh)])
    return group


def _normals(corners: Floats) -> tuple[Floats, Floats]:
    """Return unit normals (t, 3) and areas (t,) of triangles (t, 3, 3)."""
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(across, axis=1)
    return across / np.maximum(size, tolerance.COINCIDENT**2)[:, None], 0.5 * size


def _middles(corners: Floats, n: int) -> Floats:
    """Return the middles (t n n, 3) of the n n equal triangles that each of t triangles (t, 3, 3) is cut into."""
    i, j = (a.ravel() for a in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    up = i + j < n
    # Upright ones at (i, j) with i + j < n; the others stand on their heads in between.
    v = np.concatenate([i[up] + 1.0 / 3.0, i[i + j < n - 1] + 2.0 / 3.0]) / n
    w = np.concatenate([j[up] + 1.0 / 3.0, j[i + j < n - 1] + 2.0 / 3.0]) / n
    shares = np.column_stack([1.0 - v - w, v, w])
    return np.einsum("sk,tkd->tsd", shares, corners).reshape(-1, 3)
