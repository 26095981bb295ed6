"""Triangles of a solid, each with the tag of its face."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.BRepTools import BRepTools
from OCP.TopAbs import TopAbs_REVERSED
from OCP.TopLoc import TopLoc_Location

from trunnion.geometry.mesh import Mesh
from trunnion.part.identity import Shape


def tessellated(shape: Shape, faces: Mapping[int, Shape], chord: float, angle: float) -> Mesh:
    """Return the triangles of a solid's faces (by tag), anticlockwise seen from outside.

    `chord` (mm) and `angle` (radians) bound the distance from the surface and the turn from chord to chord. A face that the mesher
    can't do is missing from the mesh; `Mesh.face` tells which are there.
    """
    BRepTools.Clean_s(shape)
    BRepMesh_IncrementalMesh(shape, chord, False, angle, False)
    points, triangles, owners, count = [], [], [], 0
    for tag in sorted(faces):
        p, t = _face_triangles(faces[tag])
        points.append(p)
        triangles.append(t + count)
        owners.append(np.full(len(t), tag))
        count += len(p)
    BRepTools.Clean_s(shape)
    return Mesh(np.concatenate(points), np.concatenate(triangles), np.concatenate(owners))


def _face_triangles(face: Shape) -> tuple[np.ndarray, np.ndarray]:
    place = TopLoc_Location()
    found = BRep_Tool.Triangulation_s(face, place)
    if found is None:
        return np.empty((0, 3)), np.empty((0, 3), dtype=np.int64)
    points = np.array([found.Node(n).Coord() for n in range(1, found.NbNodes() + 1)])
    rows = np.array([found.Triangle(n).Get() for n in range(1, found.NbTriangles() + 1)], dtype=np.int64) - 1
    move = place.Transformation()
    if not place.IsIdentity():
        turn = np.array([[move.Value(r, c) for c in range(1, 5)] for r in range(1, 4)])
        points = points @ turn[:, :3].T + turn[:, 3]
    if (face.Orientation() == TopAbs_REVERSED) != move.IsNegative():
        rows = rows[:, ::-1]
    return points, rows
