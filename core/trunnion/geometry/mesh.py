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
