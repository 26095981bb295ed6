"""Triangles that remember which face of the part they belong to."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Floats, Ints, floats, ints


@dataclass(frozen=True, slots=True, eq=False)
class Mesh:
    """A triangle mesh.

    `points` (v, 3) mm; `triangles` (t, 3) rows of points, anticlockwise seen from outside; `face` (t,) 1-based face tags.
    Points are shared inside a face, not across faces.
    """

    points: Floats
    triangles: Ints
    face: Ints

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", floats(self.points, (None, 3), "mesh points"))
        object.__setattr__(self, "triangles", ints(self.triangles, (None, 3), "mesh triangles"))
        object.__setattr__(self, "face", ints(self.face, (len(self.triangles),), "mesh face"))

    def corners(self) -> Floats:
        """Return the corners of every triangle (t, 3, 3)."""
        return self.points[self.triangles]

    def areas(self) -> Floats:
        """Return the area of every triangle (t,) in mm2."""
        a, b, c = np.moveaxis(self.corners(), 1, 0)
        return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)

    def normals(self) -> Floats:
        """Return the outward unit normal of every triangle (t, 3); zero for a degenerate one."""
        a, b, c = np.moveaxis(self.corners(), 1, 0)
        across = np.cross(b - a, c - a)
        length = np.linalg.norm(across, axis=1, keepdims=True)
        return np.divide(across, length, out=np.zeros_like(across), where=length > 0.0)

    def box(self) -> tuple[Floats, Floats]:
        """Return the lowest and highest corner of the box around the mesh."""
        return self.points.min(axis=0), self.points.max(axis=0)


def enclosed(points: Floats, triangles: Ints) -> float:
    """Return the volume in mm3 that closed triangles (t, 3) of points (v, 3) enclose: positive when they look outwards."""
    a, b, c = np.moveaxis(points[triangles] - points[triangles[0, 0]], 1, 0)
    return float((a * np.cross(b, c)).sum()) / 6.0


def open_edges(triangles: Ints) -> int:
    """Return how many edges of triangles (t, 3) aren't gone along as often one way as the other: none where the mesh is closed."""
    edges = np.vstack([triangles[:, [k, (k + 1) % 3]] for k in range(3)])
    forward = (edges[:, 0] < edges[:, 1]).astype(np.int64)
    _, row = np.unique(np.sort(edges, axis=1), axis=0, return_inverse=True)
    balance = np.bincount(row.ravel(), 2 * forward - 1)
    return int(np.count_nonzero(balance))


def welded(mesh: Mesh, within: float) -> tuple[Floats, Ints]:
    """Return points (v, 3) and triangles (t, 3) of a mesh with points nearer than `within` mm made one; what is flat then is left out."""
    # Imported late: every window and every process that computes imports this module at its start, and these take half a second.
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    pairs = cKDTree(mesh.points).query_pairs(within, output_type="ndarray")
    links = coo_matrix((np.ones(len(pairs)), pairs.T), shape=(len(mesh.points),) * 2)
    n, label = connected_components(links, directed=False)
    first = np.full(n, len(label))
    np.minimum.at(first, label, np.arange(len(label)))
    triangles = label[mesh.triangles].astype(np.int64)
    a, b, c = triangles.T
    return mesh.points[first], triangles[(a != b) & (b != c) & (c != a)]
