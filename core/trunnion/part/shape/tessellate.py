"""Triangles of a solid, each with the tag of its face."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.BRepTools import BRepTools
from OCP.TopLoc import TopLoc_Location

from trunnion.geometry.mesh import Mesh
from trunnion.part.topology.faces import TrimmedFace
from trunnion.part.topology.identity import Shape
from trunnion.progress import NO_PROGRESS, Progress

MANY = 2000
"""Points or triangles taken from the kernel between two looks at cancel: some milliseconds."""


def tessellated(
    shape: Shape,
    faces: Mapping[int, Shape],
    chord: float,
    angle: float,
    progress: Progress = NO_PROGRESS,
) -> Mesh:
    """Return the triangles of a solid's faces (by tag), anticlockwise seen from outside.

    `chord` (mm) and `angle` (radians) bound the distance from the surface and the turn from chord to chord. A face that the mesher
    can't do is missing from the mesh; `Mesh.face` has those that are there.
    """
    BRepTools.Clean_s(shape)
    # Faces are meshed on both cores; each face alone, so the triangles are the same as on one.
    progress.doing("triangles of the faces")
    BRepMesh_IncrementalMesh(shape, chord, False, angle, isInParallel=True)
    points, triangles, owners, count = [], [], [], 0
    for tag in sorted(faces):
        progress.check()
        p, t = face_triangles(faces[tag], progress)
        points.append(p)
        triangles.append(t + count)
        owners.append(np.full(len(t), tag))
        count += len(p)
    BRepTools.Clean_s(shape)
    return Mesh(np.concatenate(points), np.concatenate(triangles), np.concatenate(owners))


def face_triangles(face: Shape, progress: Progress = NO_PROGRESS) -> tuple[np.ndarray, np.ndarray]:
    """Return the points (v, 3) and triangles (t, 3) that the mesher has left on a face, anticlockwise seen from outside."""
    location = TopLoc_Location()
    found = BRep_Tool.Triangulation_s(face, location)
    if found is None or not found.NbTriangles():
        return np.empty((0, 3)), np.empty((0, 3), dtype=np.int64)
    points = np.array([found.Node(n).Coord() for n in _numbers(found.NbNodes(), progress)])
    rows = (
        np.array(
            [found.Triangle(n).Get() for n in _numbers(found.NbTriangles(), progress)],
            dtype=np.int64,
        )
        - 1
    )
    if not location.IsIdentity():
        move = location.Transformation()
        turn = np.array([[move.Value(r, c) for c in range(1, 5)] for r in range(1, 4)])
        points = points @ turn[:, :3].T + turn[:, 3]
    return points, rows if _looks_out(face, found, points, rows) else rows[:, ::-1]


def _numbers(count: int, progress: Progress) -> Iterator[int]:
    """Yield the kernel's numbers from 1 to `count`, with looks at progress."""
    for n in range(1, count + 1):
        if n % MANY == 0:
            progress.check()
        yield n


def _looks_out(face: Shape, found: Any, points: np.ndarray, rows: np.ndarray) -> bool:
    """Return whether triangles run anticlockwise seen from outside: on surfaces of revolution the mesher's order doesn't show it
    (measured)."""
    corners = points[rows]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    largest = int(np.argmax((across * across).sum(axis=1)))
    location = np.mean([found.UVNode(int(n) + 1).Coord() for n in rows[largest]], axis=0)
    normal = TrimmedFace(face, 0).at(float(location[0]), float(location[1]))[1]
    return float(across[largest] @ normal) > 0.0
