"""Which face of a mesh points lie on."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.mesh import Mesh


def nearest_faces(mesh: Mesh, points: Floats, tags: Iterable[int], within: float) -> Ints:
    """Return which of some faces (tags) each point (n, 3) is nearest to, the lowest of equally near ones; 0 where none is `within` mm.

    >>> corners = np.array([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]])
    >>> mesh = Mesh(corners, np.array([[0, 1, 2]]), np.array([7]))
    >>> nearest_faces(mesh, np.array([[1.0, 1.0, 0.5], [1.0, 1.0, 2.0]]), [7], 1.0).tolist()
    [7, 0]
    """
    found, least = np.zeros(len(points), dtype=np.int64), np.full(len(points), within)
    known = np.unique(np.fromiter(tags, dtype=np.int64))
    rows_of = np.flatnonzero(np.isin(mesh.face, known))
    corners, face = mesh.points[mesh.triangles[rows_of]], mesh.face[rows_of]
    for tag in known.tolist():
        own = corners[face == tag]
        if not len(own):
            continue
        low, high = own.min(axis=(0, 1)) - within, own.max(axis=(0, 1)) + within
        rows = np.flatnonzero(((points >= low) & (points <= high)).all(axis=1))
        for row in rows.tolist():
            distance = float(triangle_distances(points[row], own).min())
            if distance < least[row]:
                found[row], least[row] = tag, distance
    return found


def triangle_distances(point: Floats, corners: Floats) -> Floats:
    """Return how far a point (3,) is from each of some triangles (t, 3, 3), mm: from its plane where the foot lies inside of all three
    edges, else from the nearest edge."""
    to_point, edges = point - corners, np.roll(corners, -1, axis=1) - corners
    normal = np.cross(edges[:, 0], edges[:, 1])
    size = np.linalg.norm(normal, axis=1)
    unit = np.divide(normal, size[:, None], out=np.zeros_like(normal), where=size[:, None] > 0.0)
    beside = np.einsum("tej,tej->te", np.cross(edges, to_point), unit[:, None, :])
    inside = (beside >= 0.0).all(axis=1) & (size > 0.0)
    squared = np.einsum("tej,tej->te", edges, edges)
    share = np.divide(
        np.einsum("tej,tej->te", to_point, edges),
        squared,
        out=np.zeros_like(squared),
        where=squared > 0.0,
    )
    away = to_point - np.clip(share, 0.0, 1.0)[:, :, None] * edges
    off_edges = np.linalg.norm(away, axis=2).min(axis=1)
    off_plane = np.abs(np.einsum("tj,tj->t", to_point[:, 0], unit))
    nearest: Floats = np.where(inside, off_plane, off_edges)
    return nearest
