"""A face as its CAD surface has it: exact points, normals and bends at positions of its own two parameters, and what its trim holds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from trunnion.findings import BadInput
from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.frame import Frame

if TYPE_CHECKING:
    from trunnion.part.part import Part

FREE_FORM = 2.0
"""What second derivatives of a free-form surface may grow to inside a cell, over those at its middle."""
ROUND = 1.1
"""The same for cones and tori; planes have none, and those of cylinders and spheres are the same everywhere."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ExactPoints:
    """Points of a face at k positions: point, outward unit normal (k, 3), their derivatives by the face's parameters du, dv and normal_du,
    normal_dv (k, 3), and the lengths of the point's second derivatives bend (k, 3): by u twice, by both, by v twice; those with what they
    may grow to nearby."""

    point: Floats
    normal: Floats
    du: Floats
    dv: Floats
    normal_du: Floats
    normal_dv: Floats
    bend: Floats


class ExactFace:
    """One trimmed face of a part, evaluated in a frame."""

    def __init__(self, part: Part, tag: int, frame: Frame) -> None:
        from OCP.GeomAbs import GeomAbs_SurfaceType as Kind

        from trunnion.part.shape.evaluate import evaluator_of
        from trunnion.part.topology.faces import TrimmedFace
        from trunnion.part.topology.trim import Trim

        shape = part.face_shape(tag)
        if shape is None:
            raise BadInput(f"face {tag} is not a face of the chosen solid of {part.name}")
        self.tag, self._frame, self._view = tag, frame, TrimmedFace(shape, tag - 1)
        self._evaluate, self._trim = evaluator_of(self._view.adaptor), Trim(self._view)
        kind = self._view.adaptor.GetType()
        known = (
            Kind.GeomAbs_Plane,
            Kind.GeomAbs_Cylinder,
            Kind.GeomAbs_Sphere,
            Kind.GeomAbs_Cone,
            Kind.GeomAbs_Torus,
        )
        self._growth = ROUND if kind in known else FREE_FORM

    def bounds(self) -> tuple[float, float, float, float]:
        """Return the least and greatest u and v of the trimmed area."""
        return self._view.bounds()

    def inside(self, uv: Floats) -> Bools:
        """Return which uv (k, 2) lie inside the trim."""
        return self._trim.holds(np.asarray(uv, dtype=np.float64))

    def rim(self, count: int) -> Floats:
        """Return points (k, 3) along the face's edges, `count` on each, both ends among them."""
        from OCP.BRepAdaptor import BRepAdaptor_Curve

        from trunnion.part.topology.identity import edges_of

        found = []
        for edge in edges_of(self._view.face):
            curve = BRepAdaptor_Curve(edge)
            along = np.linspace(curve.FirstParameter(), curve.LastParameter(), count)
            found.append([curve.Value(t).Coord() for t in along.tolist()])
        return self._frame.to_local(np.array(found, dtype=np.float64).reshape(-1, 3))

    def at(self, uv: Floats) -> ExactPoints:
        """Return the surface at uv (k, 2)."""
        rows = self._evaluate(np.asarray(uv, dtype=np.float64)).reshape(-1, 18)
        along, across, twice_u, both, twice_v = (
            self._frame.local_direction(rows[:, c : c + 3]) for c in range(3, 18, 3)
        )
        # Frames keep hands, so the normal's side is the same in all of them.
        normal, size = _scaled(self._view.side * np.cross(along, across))
        for row in np.flatnonzero(size[:, 0] <= 0.0).tolist():
            normal[row] = self._frame.local_direction(self._view.at(*uv[row])[1])
        turns = (
            np.cross(twice_u, across) + np.cross(along, both),
            np.cross(both, across) + np.cross(along, twice_v),
        )
        turned = [
            _over(self._view.side * (t - (t * normal).sum(axis=1, keepdims=True) * normal), size)
            for t in turns
        ]
        bend = np.column_stack([np.linalg.norm(d, axis=1) for d in (twice_u, both, twice_v)])
        return ExactPoints(
            point=self._frame.to_local(rows[:, :3]),
            normal=normal,
            du=along,
            dv=across,
            normal_du=turned[0],
            normal_dv=turned[1],
            bend=self._growth * bend,
        )


def _scaled(vectors: Floats) -> tuple[Floats, Floats]:
    size = np.linalg.norm(vectors, axis=1, keepdims=True)
    return _over(vectors, size), size


def _over(vectors: Floats, size: Floats) -> Floats:
    return np.divide(vectors, size, out=np.zeros_like(vectors), where=size > 0.0)
