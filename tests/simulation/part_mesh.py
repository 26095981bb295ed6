"""Triangles of the part in a STEP file, as the CAD kernel reads it."""

from __future__ import annotations

from pathlib import Path

import numpy as np

CHORD = 4e-3
"""mm: how far the triangles may be from the part's faces."""
ANGLE = 0.2
"""rad: most turn from triangle to triangle."""


def triangles(file: Path) -> np.ndarray:
    """Return the corners (n, 3, 3) of a STEP file's triangles in mm."""
    import cadquery as cq
    from OCP.BRep import BRep_Tool
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.TopLoc import TopLoc_Location

    shape = cq.importers.importStep(str(file))
    found = []
    for solid in shape.vals():
        BRepMesh_IncrementalMesh(solid.wrapped, CHORD, False, ANGLE, False)
        for face in solid.Faces():
            place = TopLoc_Location()
            mesh = BRep_Tool.Triangulation_s(face.wrapped, place)
            turn = place.Transformation()
            points = [mesh.Node(n + 1).Transformed(turn) for n in range(mesh.NbNodes())]
            nodes = np.array([(p.X(), p.Y(), p.Z()) for p in points])
            corners = [mesh.Triangle(n + 1).Get() for n in range(mesh.NbTriangles())]
            found.append(nodes[np.array(corners) - 1])
    return np.concatenate(found)


def area(triangles: np.ndarray) -> float:
    """Return the area in mm2 of triangles (n, 3, 3)."""
    sides = triangles[:, 1:] - triangles[:, :1]
    return float(0.5 * np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1).sum())
