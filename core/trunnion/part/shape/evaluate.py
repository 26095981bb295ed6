"""Surfaces of faces evaluated at many positions at once: closed forms, B-splines as arrays, and the CAD kernel one by one for what is
left."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from OCP.GeomAbs import GeomAbs_SurfaceType as Kind

from trunnion.geometry.arrays import Floats
from trunnion.geometry.surface.spline import SplineSurface

Evaluator = Callable[[Floats], Floats]
"""From uv (k, 2) to (k, 6, 3): point, derivatives by u and v, second ones by u twice, by both, by v twice."""


def evaluator_of(adaptor: Any) -> Evaluator:
    """Return what evaluates a face's surface, given its `BRepAdaptor_Surface`, in the part's coordinates."""
    kind = adaptor.GetType()
    if kind in _PLAIN:
        return _PLAIN[kind](adaptor)
    if kind == Kind.GeomAbs_BSplineSurface:
        return spline_of(adaptor.BSpline()).at
    if kind == Kind.GeomAbs_BezierSurface:
        from OCP.GeomConvert import GeomConvert

        return spline_of(GeomConvert.SurfaceToBSplineSurface_s(adaptor.Bezier())).at
    return _one_by_one(adaptor)


def spline_of(surface: Any) -> SplineSurface:
    """Return a `Geom_BSplineSurface` as arrays."""
    spans = surface.Bounds()
    period = (
        spans[1] - spans[0] if surface.IsUPeriodic() else 0.0,
        spans[3] - spans[2] if surface.IsVPeriodic() else 0.0,
    )
    if any(period):
        surface = surface.Copy()
        if period[0]:
            surface.SetUNotPeriodic()
        if period[1]:
            surface.SetVNotPeriodic()
    rational = surface.IsURational() or surface.IsVRational()
    poles = np.array(
        [
            [
                (*surface.Pole(i, j).Coord(), surface.Weight(i, j) if rational else 1.0)
                for j in range(1, surface.NbVPoles() + 1)
            ]
            for i in range(1, surface.NbUPoles() + 1)
        ]
    )
    poles[..., :3] *= poles[..., 3:]
    knots = [
        np.repeat([knot(k) for k in range(1, count + 1)], [times(k) for k in range(1, count + 1)])
        for knot, times, count in (
            (surface.UKnot, surface.UMultiplicity, surface.NbUKnots()),
            (surface.VKnot, surface.VMultiplicity, surface.NbVKnots()),
        )
    ]
    return SplineSurface(
        knots_u=knots[0],
        knots_v=knots[1],
        degree_u=surface.UDegree(),
        degree_v=surface.VDegree(),
        poles=poles,
        period=period,
    )


def _axes(position: Any) -> tuple[Floats, Floats, Floats, Floats]:
    """Return origin, x, y and z of a surface's own axes; they may be left-handed."""
    return (
        np.array(position.Location().Coord()),
        np.array(position.XDirection().Coord()),
        np.array(position.YDirection().Coord()),
        np.array(position.Direction().Coord()),
    )


def _plane(adaptor: Any) -> Evaluator:
    origin, x, y, _ = _axes(adaptor.Plane().Position())

    def at(uv: Floats) -> Floats:
        out = np.zeros((len(uv), 6, 3))
        out[:, 0] = origin + uv[:, :1] * x + uv[:, 1:] * y
        out[:, 1], out[:, 2] = x, y
        return out

    return at


def _turned(
    origin: Floats, x: Floats, y: Floats, z: Floats, u: Floats, out_: Floats, up: Floats
) -> Floats:
    """Return a surface of revolution: out_, up (k, 3) are the distance from the axis and the height along it with their first and second
    derivatives by v."""
    outward, around = (
        np.cos(u)[:, None] * x + np.sin(u)[:, None] * y,
        np.cos(u)[:, None] * y - np.sin(u)[:, None] * x,
    )
    r, h = out_[:, :, None], up[:, :, None]
    return np.stack(
        [
            origin + r[:, 0] * outward + h[:, 0] * z,
            r[:, 0] * around,
            r[:, 1] * outward + h[:, 1] * z,
            -r[:, 0] * outward,
            r[:, 1] * around,
            r[:, 2] * outward + h[:, 2] * z,
        ],
        axis=1,
    )


def _cylinder(adaptor: Any) -> Evaluator:
    axes, radius = _axes(adaptor.Cylinder().Position()), adaptor.Cylinder().Radius()

    def at(uv: Floats) -> Floats:
        u, v = uv.T
        zero, one = np.zeros_like(v), np.ones_like(v)
        return _turned(
            *axes, u, np.column_stack([radius * one, zero, zero]), np.column_stack([v, one, zero])
        )

    return at


def _cone(adaptor: Any) -> Evaluator:
    cone = adaptor.Cone()
    axes, radius, sine, cosine = (
        _axes(cone.Position()),
        cone.RefRadius(),
        np.sin(cone.SemiAngle()),
        np.cos(cone.SemiAngle()),
    )

    def at(uv: Floats) -> Floats:
        u, v = uv.T
        zero, one = np.zeros_like(v), np.ones_like(v)
        return _turned(
            *axes,
            u,
            np.column_stack([radius + v * sine, sine * one, zero]),
            np.column_stack([v * cosine, cosine * one, zero]),
        )

    return at


def _round(axes: tuple[Floats, Floats, Floats, Floats], major: float, minor: float) -> Evaluator:
    def at(uv: Floats) -> Floats:
        u, v = uv.T
        c, s = minor * np.cos(v), minor * np.sin(v)
        return _turned(*axes, u, np.column_stack([major + c, -s, -c]), np.column_stack([s, c, -s]))

    return at


def _sphere(adaptor: Any) -> Evaluator:
    return _round(_axes(adaptor.Sphere().Position()), 0.0, adaptor.Sphere().Radius())


def _torus(adaptor: Any) -> Evaluator:
    torus = adaptor.Torus()
    return _round(_axes(torus.Position()), torus.MajorRadius(), torus.MinorRadius())


_PLAIN: dict[Any, Callable[[Any], Evaluator]] = {
    Kind.GeomAbs_Plane: _plane,
    Kind.GeomAbs_Cylinder: _cylinder,
    Kind.GeomAbs_Cone: _cone,
    Kind.GeomAbs_Sphere: _sphere,
    Kind.GeomAbs_Torus: _torus,
}


def _one_by_one(adaptor: Any) -> Evaluator:
    from OCP.gp import gp_Pnt, gp_Vec

    point, du, dv, duu, dvv, duv = gp_Pnt(), gp_Vec(), gp_Vec(), gp_Vec(), gp_Vec(), gp_Vec()

    def at(uv: Floats) -> Floats:
        rows = np.empty((len(uv), 18))
        for k, (u, v) in enumerate(uv.tolist()):
            adaptor.D2(u, v, point, du, dv, duu, dvv, duv)
            rows[k] = (
                *point.Coord(),
                *du.Coord(),
                *dv.Coord(),
                *duu.Coord(),
                *duv.Coord(),
                *dvv.Coord(),
            )
        return rows.reshape(-1, 6, 3)

    return at
