"""A curve drawn on a face: points projected onto its surface, a spline through them, its ends extended over the face's boundary."""

from __future__ import annotations

from typing import Any

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
from OCP.BRepLib import BRepLib
from OCP.BRepTools import BRepTools
from OCP.BRepTopAdaptor import BRepTopAdaptor_FClass2d
from OCP.Geom2d import Geom2d_TrimmedCurve
from OCP.Geom2dAPI import Geom2dAPI_Interpolate
from OCP.gp import gp_Pnt, gp_Pnt2d, gp_Vec2d
from OCP.ShapeAnalysis import ShapeAnalysis_Surface
from OCP.TColgp import TColgp_HArray1OfPnt2d
from OCP.TColStd import TColStd_HArray1OfReal
from OCP.TopAbs import TopAbs_IN, TopAbs_OUT, TopAbs_REVERSED

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.geometry.arrays import Floats
from trunnion.part.topology.identity import Shape

_BEYOND = 0.02
"""How far an end is led on outside the face, as a share of the face's parameters: clear of its boundary."""
_STEP = 0.01
"""Share of the face's parameters by which an end is led on until it is outside."""
_MORE = 3
"""Points before and after a curve round the surface that make it run on smoothly where it closes."""
_PROBE = 1e-4
"""Share of the face's parameters beside the curve at which pieces are looked up."""
_SAMPLES = 64
"""Points along the curve beside which pieces are looked up."""


class DrawnCurve:
    """The curve on the surface of one face through given points (k, 3) in order; one that returns to its start is closed.

    Raises `BadInput` for a position that is farther than `reach` from the surface.
    """

    def __init__(self, face: Shape, positions: Floats, reach: float, where: str) -> None:
        self._face = face
        self._surface = BRep_Tool.Surface_s(face)
        self._turned = -1.0 if face.Orientation() == TopAbs_REVERSED else 1.0
        u0, u1, v0, v1 = BRepTools.UVBounds_s(face)
        self._low, self._size = np.array([u0, v0]), np.array([u1 - u0, v1 - v0])
        at = self._brought(positions, reach, where)
        steps = np.linalg.norm(np.diff(positions, axis=0), axis=1)
        kept = np.concatenate([[True], steps > tolerance.COINCIDENT])
        at, steps = at[kept], steps[kept[1:]]
        if len(at) < 2:
            raise BadInput(f"{where}: the places of a drawn cut fall together")
        is_back = bool(np.linalg.norm(positions[-1] - positions[0]) < tolerance.COINCIDENT)
        is_loop = is_back and bool(
            np.abs(at[-1] - at[0]).max() < tolerance.PARAMETRIC * self._size.max()
        )
        if not is_back:
            at, steps = self._led_out(at, steps)
        along = np.concatenate([[0.0], np.cumsum(steps)])
        self._curve = (
            _around(at, along) if is_back and not is_loop else _through(at, along, is_loop)
        )
        if self._curve is None:
            raise BadInput(
                f"{where}: no smooth curve goes through the places of the drawn cut; draw it with fewer places"
            )

    def edge(self) -> Shape:
        """Return the path as an edge on the face's surface."""
        made = BRepBuilderAPI_MakeEdge(self._curve, self._surface)
        if not made.IsDone():
            raise BadInput("the drawn cut can't be laid on the face; draw it elsewhere")
        edge = made.Edge()
        BRepLib.BuildCurves3d_s(edge)
        return edge

    def is_left(self, piece: Shape) -> bool:
        """Return whether a piece of the face lies left of the path, seen from outside."""
        inside = BRepTopAdaptor_FClass2d(piece, tolerance.COINCIDENT)
        votes = 0
        for share in (np.arange(_SAMPLES) + 0.5) / _SAMPLES:
            t = self._curve.FirstParameter() + share * (
                self._curve.LastParameter() - self._curve.FirstParameter()
            )
            point, along = gp_Pnt2d(), gp_Vec2d()
            self._curve.D1(t, point, along)
            left = self._turned * np.array(
                [
                    -along.Y() * self._size[0] / self._size[1],
                    along.X() * self._size[1] / self._size[0],
                ]
            )
            left *= _PROBE / max(np.abs(left / self._size).max(), tolerance.PARAMETRIC)
            votes += inside.Perform(gp_Pnt2d(point.X() + left[0], point.Y() + left[1])) == TopAbs_IN
            votes -= inside.Perform(gp_Pnt2d(point.X() - left[0], point.Y() - left[1])) == TopAbs_IN
        return votes > 0

    def _brought(self, positions: Floats, reach: float, where: str) -> Floats:
        """Return the surface's parameters (k, 2) nearest to the positions, without jumps on surfaces that close on themselves."""
        nearest = ShapeAnalysis_Surface(self._surface)
        at = np.empty((len(positions), 2))
        for k, position in enumerate(positions.tolist()):
            found = nearest.ValueOfUV(gp_Pnt(*position), tolerance.COINCIDENT)
            if nearest.Gap() > reach:
                gap, there = nearest.Gap(), nearest.Value(found)
                raise BadInput(
                    f"{where}: place {k + 1} of the drawn cut is {gap:.3g} mm away from the face; {reach:g} mm are allowed, "
                    f"and its nearest place is {there.X():.3f} {there.Y():.3f} {there.Z():.3f}"
                )
            at[k] = found.X(), found.Y()
        for column, period in enumerate(self._periods()):
            if period:
                jumps = np.round(np.diff(at[:, column]) / period)
                at[1:, column] -= period * np.cumsum(jumps)
                at[:, column] -= period * np.round(
                    (at[:, column].mean() - self._low[column] - 0.5 * self._size[column]) / period
                )
        return at

    def _periods(self) -> tuple[float, float]:
        s = self._surface
        return (s.UPeriod() if s.IsUPeriodic() else 0.0), (s.VPeriod() if s.IsVPeriodic() else 0.0)

    def _led_out(self, at: Floats, steps: Floats) -> tuple[Floats, Floats]:
        """Return the positions (k, 2) of an open path and the steps between them (k - 1,), led straight on from both ends out of the
        face."""
        for _ in range(2):
            end = self._outside(at[-1], at[-1] - at[-2])
            if end is not None:
                share = np.linalg.norm((end - at[-1]) / self._size) / np.linalg.norm(
                    (at[-1] - at[-2]) / self._size
                )
                at, steps = (
                    np.vstack([at, end]),
                    np.append(steps, max(share, tolerance.ANGLE) * steps[-1]),
                )
            at, steps = at[::-1], steps[::-1]
        return at, steps

    def _outside(self, end: Floats, direction: Floats) -> Floats | None:
        """Return the position (2,) straight on from an end of the way that lies outside the face, None when the end does already."""
        inside: Any = BRepTopAdaptor_FClass2d(self._face, tolerance.COINCIDENT)
        if inside.Perform(gp_Pnt2d(*end.tolist())) == TopAbs_OUT:
            return None
        limits = self._limits()
        step = direction / max(np.abs(direction / self._size).max(), tolerance.PARAMETRIC) * _STEP
        at, beyond = end, 0.0
        while beyond < _BEYOND:
            further = np.clip(at + step, *limits)
            if np.abs((further - at) - step).max() > tolerance.PARAMETRIC * np.abs(step).max():
                return _onto(at, step, limits)
            at = further
            beyond += _STEP if inside.Perform(gp_Pnt2d(*at.tolist())) == TopAbs_OUT else 0.0
        return at

    def _limits(self) -> tuple[Floats, Floats]:
        """Return the least and greatest parameters at which there is a surface, but not far beyond the face."""
        u0, u1, v0, v1 = self._surface.Bounds()
        period = np.array(self._periods())
        low = np.where(period > 0.0, -np.inf, [u0, v0])
        high = np.where(period > 0.0, np.inf, [u1, v1])
        return np.maximum(low, self._low - self._size), np.minimum(
            high, self._low + 2.0 * self._size
        )


def _onto(at: Floats, step: Floats, limits: tuple[Floats, Floats]) -> Floats:
    """Return where a step first meets the limits."""
    ends = np.where(step > 0.0, limits[1], limits[0])
    share = np.divide(ends - at, step, out=np.full(2, np.inf), where=step != 0.0)
    return np.clip(at + max(float(share.min()), 0.0) * step, *limits)


def _around(at: Floats, along: Floats) -> Any:
    """Return the plane curve through positions (k, 2) that come back to the first one round a surface that closes on itself, or None."""
    round_trip, length = at[-1] - at[0], along[-1]
    more = min(_MORE, len(at) - 1)
    at = np.vstack([at[-1 - more : -1] - round_trip, at, at[1 : 1 + more] + round_trip])
    along = np.concatenate([along[-1 - more : -1] - length, along, along[1 : 1 + more] + length])
    curve = _through(at, along, False)
    return None if curve is None else Geom2d_TrimmedCurve(curve, 0.0, length)


def _through(at: Floats, along: Floats, is_loop: bool) -> Any:
    """Return the plane curve through positions (k, 2) at the parameters (k,), or None."""
    positions = TColgp_HArray1OfPnt2d(1, len(at) - is_loop)
    for n in range(len(at) - is_loop):
        positions.SetValue(n + 1, gp_Pnt2d(*at[n].tolist()))
    parameters = TColStd_HArray1OfReal(1, len(along))
    for n, t in enumerate(along.tolist(), 1):
        parameters.SetValue(n, t)
    made = Geom2dAPI_Interpolate(positions, parameters, is_loop, tolerance.PARAMETRIC)
    made.Perform()
    return made.Curve() if made.IsDone() else None
