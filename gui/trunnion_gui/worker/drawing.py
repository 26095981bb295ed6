"""What the window needs to draw a mesh, worked out in the worker so that opening a part does not hold the window up. No Qt, no VTK."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from trunnion.geometry.mesh import Mesh
from trunnion.report.deviation import DeviationMap
from trunnion.report.palette import load_palette


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DrawnMesh:
    """A mesh with the normal at every point (v, 3) float32, its faces' borders as rows of points (e, 2), and whose border each is (e,).

    `hull` has the points (k, 3), mm, that a view of the part is fitted by: the corners of its convex hull.
    """

    mesh: Mesh
    normals: np.ndarray
    borders: np.ndarray
    owners: np.ndarray
    hull: np.ndarray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DrawnMap:
    """A deviation map with the normal (v, 3) float32 and the colour (v, 3) uint8 at every point."""

    map: DeviationMap
    normals: np.ndarray
    colours: np.ndarray


def drawn_map(shown: DeviationMap) -> DrawnMap:
    """Return a map ready to be drawn."""
    return DrawnMap(
        map=shown,
        normals=normals_of(shown.points, shown.triangles),
        colours=load_palette().deviation.at(shown.value, shown.low, shown.high, shown.limit),
    )


def drawing_of(mesh: Mesh) -> DrawnMesh:
    """Return a mesh ready to be drawn."""
    borders, owners = border_edges(mesh)
    return DrawnMesh(
        mesh=mesh,
        normals=normals_of(mesh.points, mesh.triangles),
        borders=borders,
        owners=owners,
        hull=hull_of(mesh.points),
    )


def hull_of(points: np.ndarray) -> np.ndarray:
    """Return the corners (k, 3) of the convex hull of points (v, 3); all points where they lie in a plane."""
    from scipy.spatial import ConvexHull, QhullError

    try:
        return points[ConvexHull(points).vertices]
    except (QhullError, ValueError):  # ValueError: no points at all
        return points


def border_edges(mesh: Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Return the edges around the faces (e, 2) as rows of points, and the tag of the face each belongs to (e,).

    Points are shared inside a face and not across faces, so an edge of one triangle only is a face's border.
    """
    pairs = np.concatenate(
        [mesh.triangles[:, [0, 1]], mesh.triangles[:, [1, 2]], mesh.triangles[:, [2, 0]]]
    )
    owner = np.tile(mesh.face, 3)
    ordered = np.sort(pairs, axis=1)
    _, first, count = np.unique(
        ordered[:, 0] * len(mesh.points) + ordered[:, 1], return_index=True, return_counts=True
    )
    rows = first[count == 1]
    return pairs[rows], owner[rows]


def normals_of(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Return the normal at every point (v, 3), smooth inside a face and sharp across its border."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    across = np.cross(b - a, c - a)
    n, rows = len(points), triangles.T.ravel()
    total = np.stack(
        [np.bincount(rows, weights=np.tile(across[:, k], 3), minlength=n) for k in range(3)], axis=1
    )
    length = np.linalg.norm(total, axis=1, keepdims=True)
    return np.divide(total, length, out=np.zeros_like(total), where=length > 0).astype(np.float32)


def point_on(mesh: Mesh, tags: Iterable[int]) -> tuple[float, float, float]:
    """Return a position near the middle of the largest of some faces, on it."""
    area = np.bincount(mesh.face, weights=mesh.areas())
    rows = np.flatnonzero(mesh.face == max(tags, key=lambda t: area[t] if t < len(area) else 0.0))
    if not len(rows):
        return (0.0, 0.0, 0.0)
    middles = mesh.corners()[rows].mean(axis=1)
    weights = mesh.areas()[rows, None]
    middle = (middles * weights).sum(axis=0) / max(float(weights.sum()), 1e-12)
    x, y, z = middles[np.argmin(np.linalg.norm(middles - middle, axis=1))]
    return float(x), float(y), float(z)


def box_of(mesh: Mesh, tag: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the lowest and highest corner of the box around a face."""
    points = mesh.points[mesh.triangles[mesh.face == tag].ravel()]
    return points.min(axis=0), points.max(axis=0)


def plane_line(
    mesh: Mesh, tag: int, position: Sequence[float], normal: Sequence[float]
) -> np.ndarray:
    """Return the pieces (k, 2, 3) of the line in which a plane meets a face."""
    corners = mesh.corners()[mesh.face == tag]
    height = (corners - np.asarray(position)) @ np.asarray(normal)
    above = height > 0.0
    met = np.flatnonzero(above.any(axis=1) & ~above.all(axis=1))
    corners, height, above = corners[met], height[met], above[met]
    # The corner that lies alone on its side: the line crosses both edges that begin there.
    alone = np.where(above.sum(axis=1) == 1, above.argmax(axis=1), (~above).argmax(axis=1))
    row = np.arange(len(met))
    ends = []
    for step in (1, 2):
        other = (alone + step) % 3
        share = height[row, alone] / (height[row, alone] - height[row, other])
        ends.append(
            corners[row, alone] + share[:, None] * (corners[row, other] - corners[row, alone])
        )
    return np.stack(ends, axis=1)


def sampled(positions: Sequence[Sequence[float]], pieces: int) -> np.ndarray:
    """Return points (k, 3) along straight lines through places, so many between two of them; the ends are there too."""
    given = np.asarray(positions, dtype=float).reshape(-1, 3)
    at = np.linspace(0.0, len(given) - 1.0, (len(given) - 1) * pieces + 1)
    return np.column_stack([np.interp(at, np.arange(len(given)), given[:, k]) for k in range(3)])
