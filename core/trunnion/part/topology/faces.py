"""A trimmed face with its queries: points, outward normals, what is inside."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepTopAdaptor import BRepTopAdaptor_FClass2d
from OCP.GeomAbs import GeomAbs_Plane
from OCP.gp import gp_Pnt, gp_Pnt2d, gp_Vec
from OCP.TopAbs import TopAbs_IN, TopAbs_REVERSED

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.part.topology.identity import Shape


@dataclass(slots=True, eq=False)
class TrimmedFace:
    """A trimmed face whose kernel objects are kept between queries."""

    face: Shape
    row: int
    adaptor: Any = field(init=False)
    side: float = field(init=False)
    inside: Any = field(init=False)
    plane_normal: Floats | None = field(init=False)

    def __post_init__(self) -> None:
        self.adaptor = BRepAdaptor_Surface(self.face)
        self.side = -1.0 if self.face.Orientation() == TopAbs_REVERSED else 1.0
        self.inside = BRepTopAdaptor_FClass2d(self.face, tolerance.COINCIDENT)
        is_plane = self.adaptor.GetType() == GeomAbs_Plane
        self.plane_normal = (
            self.at(self.adaptor.FirstUParameter(), self.adaptor.FirstVParameter())[1]
            if is_plane
            else None
        )

    def bounds(self) -> tuple[float, float, float, float]:
        """Return the least and greatest u and v of the trimmed area."""
        a = self.adaptor
        return a.FirstUParameter(), a.LastUParameter(), a.FirstVParameter(), a.LastVParameter()

    def holds(self, u: float, v: float) -> bool:
        """Return whether (u, v) lies inside the trimmed area."""
        return bool(self.inside.Perform(gp_Pnt2d(u, v)) == TopAbs_IN)

    def at(self, u: float, v: float) -> tuple[Floats, Floats]:
        """Return the point and the outward unit normal at (u, v); beside a pole, where the surface has none, the normal next to it."""
        point, du, dv = gp_Pnt(), gp_Vec(), gp_Vec()
        self.adaptor.D1(u, v, point, du, dv)
        normal = du.Crossed(dv)
        size = normal.Magnitude()
        if size <= tolerance.PARAMETRIC * max(du.Magnitude(), dv.Magnitude(), tolerance.COINCIDENT):
            u0, u1, v0, v1 = self.bounds()
            nearby = (
                u + tolerance.ANGLE * (0.5 * (u0 + u1) - u),
                v + tolerance.ANGLE * (0.5 * (v0 + v1) - v),
            )
            self.adaptor.D1(*nearby, gp_Pnt(), du, dv)
            normal = du.Crossed(dv)
            size = normal.Magnitude() or 1.0
        return np.array(point.Coord()), np.array(normal.Coord()) * (self.side / size)

    def evaluated(self, uv: list[tuple[float, float]]) -> tuple[Floats, Floats]:
        """Return points and outward unit normals (k, 3) at uv (u, v)."""
        if self.plane_normal is not None:
            return np.array([self.adaptor.Value(u, v).Coord() for u, v in uv]), np.tile(
                self.plane_normal, (len(uv), 1)
            )
        both = [self.at(u, v) for u, v in uv]
        return np.array([p for p, _ in both]), np.array([n for _, n in both])

    def grid(self, steps: int) -> list[tuple[float, float]]:
        """Return (u, v) at the middles of steps x steps cells of the bounds."""
        u0, u1, v0, v1 = self.bounds()
        share = (np.arange(steps) + 0.5) / steps
        return [
            (float(u), float(v)) for u in u0 + share * (u1 - u0) for v in v0 + share * (v1 - v0)
        ]
