"""Which plain surface or curve it is, however the file wrote it.

The same cylinder is a cylinder in a STEP file, a surface of revolution or a B-spline in an IGES file. What the file doesn't say is found by
fitting samples within `tolerance.FITTED`: planes by their points, surfaces of revolution by the axis that all normals meet
(H. Pottmann, T. Randrup, "Rotational and helical surface approximation for reverse engineering", Computing 60, 1998).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from OCP.GeomAbs import (
    GeomAbs_Circle,
    GeomAbs_Cone,
    GeomAbs_Cylinder,
    GeomAbs_Ellipse,
    GeomAbs_Line,
    GeomAbs_Plane,
    GeomAbs_Sphere,
    GeomAbs_SurfaceOfExtrusion,
    GeomAbs_SurfaceOfRevolution,
    GeomAbs_Torus,
)

from trunnion import tolerance
from trunnion.geometry.arrays import Floats

NOWHERE = np.full(3, np.nan)
_STEPS = 9


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CanonicalSurface:
    """A surface's kind (a name of `facegraph.SURFACES`) and its axis, radius and second radius or half angle; NaN where it has none.

    A cone's axis points to where it widens, and `radius` is the one at `axis_point`.
    """

    kind: str
    axis_point: Floats
    axis: Floats
    radius: float = math.nan
    minor: float = math.nan


PLAIN = CanonicalSurface(kind="plane", axis_point=NOWHERE, axis=NOWHERE)


def recognised(adaptor: Any, samples: Callable[[], tuple[Floats, Floats]]) -> CanonicalSurface:
    """Return the plain surface under a face's adaptor; `samples` gives points and normals (k, 3) of it for what has to be fitted."""
    kind = adaptor.GetType()
    if kind == GeomAbs_Plane:
        return PLAIN
    if kind == GeomAbs_Cylinder:
        found = adaptor.Cylinder()
        return CanonicalSurface(kind="cylinder", **_axis(found), radius=found.Radius())
    if kind == GeomAbs_Cone:
        return _cone(adaptor.Cone())
    if kind == GeomAbs_Sphere:
        found = adaptor.Sphere()
        return CanonicalSurface(
            kind="sphere", axis_point=xyz(found.Location()), axis=NOWHERE, radius=found.Radius()
        )
    if kind == GeomAbs_Torus:
        found = adaptor.Torus()
        return CanonicalSurface(
            kind="torus", **_axis(found), radius=found.MajorRadius(), minor=found.MinorRadius()
        )
    if kind == GeomAbs_SurfaceOfRevolution:
        found = adaptor.AxeOfRevolution()
        point, axis = xyz(found.Location()), xyz(found.Direction())
        return _of_meridian(samples()[0], point, axis) or CanonicalSurface(
            kind="revolution", axis_point=point, axis=axis
        )
    fallback = CanonicalSurface(
        kind="extrusion" if kind == GeomAbs_SurfaceOfExtrusion else "spline",
        axis_point=NOWHERE,
        axis=NOWHERE,
    )
    return fitted_surface(*samples()) or fallback


def fitted_surface(points: Floats, normals: Floats) -> CanonicalSurface | None:
    """Return the plane, sphere, cylinder, cone or torus that samples (k, 3) with unit normals lie on, or None."""
    middle = points.mean(axis=0)
    flat = np.linalg.svd(points - middle)[2][2]
    if np.abs((points - middle) @ flat).max() < tolerance.FITTED:
        return PLAIN
    return _sphere(points) or _revolved(points, normals)


def _sphere(points: Floats) -> CanonicalSurface | None:
    centre, radius = _ball(points)
    if (
        not np.isfinite(radius)
        or np.abs(np.linalg.norm(points - centre, axis=1) - radius).max() > tolerance.FITTED
    ):
        return None
    return CanonicalSurface(kind="sphere", axis_point=centre, axis=NOWHERE, radius=radius)


def _revolved(points: Floats, normals: Floats) -> CanonicalSurface | None:
    middle = points.mean(axis=0)
    size = float(np.abs(points - middle).max())
    p = (points - middle) / size
    # An axis (direction a, moment m) meets the normal at p when n.m + a.(p x n) = 0; with a cylinder there is a second solution, a = 0.
    candidates = [np.linalg.svd(normals)[2][2]]
    values, rows = np.linalg.svd(np.hstack([normals, np.cross(p, normals)]))[1:]
    moment, direction = rows[5][:3], rows[5][3:]
    if values[4] > values[5] and np.linalg.norm(direction) > tolerance.PARAMETRIC:
        candidates.append(direction / np.linalg.norm(direction))
    for n, axis in enumerate(candidates):
        if n == 0:
            foot = _cylinder_foot(points, axis)
        else:
            foot = middle + size * np.cross(axis, moment / np.linalg.norm(direction))
        found = None if foot is None else _of_meridian(points, foot, axis)
        if found is not None:
            return found
    return None


def _cylinder_foot(points: Floats, axis: Floats) -> Floats | None:
    x = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    x /= np.linalg.norm(x)
    y = np.cross(axis, x)
    centre, radius = _ball(np.stack([points @ x, points @ y], axis=1))
    return centre[0] * x + centre[1] * y if np.isfinite(radius) else None


def _of_meridian(points: Floats, foot: Floats, axis: Floats) -> CanonicalSurface | None:
    """Return the cylinder, cone, sphere, torus or plane that points lie on when turned into one half plane of an axis, or None."""
    height = (points - foot) @ axis
    rho = np.linalg.norm(points - foot - height[:, None] * axis, axis=1)
    if np.ptp(height) < tolerance.FITTED:
        return PLAIN
    if np.ptp(rho) < tolerance.FITTED:
        return CanonicalSurface(
            kind="cylinder", axis_point=foot, axis=axis, radius=float(rho.mean())
        )
    slope, start = np.polyfit(height, rho, 1)
    if np.abs(rho - start - slope * height).max() < tolerance.FITTED:
        sense = 1.0 if slope > 0.0 else -1.0
        return CanonicalSurface(
            kind="cone",
            axis_point=foot,
            axis=sense * axis,
            radius=float(start),
            minor=math.atan(abs(slope)),
        )
    profile = np.stack([rho, height], axis=1)
    centre, radius = _ball(profile)
    if (
        not np.isfinite(radius)
        or np.abs(np.linalg.norm(profile - centre, axis=1) - radius).max() > tolerance.FITTED
    ):
        return None
    at = foot + centre[1] * axis
    if abs(centre[0]) < tolerance.FITTED:
        return CanonicalSurface(kind="sphere", axis_point=at, axis=NOWHERE, radius=radius)
    return CanonicalSurface(
        kind="torus", axis_point=at, axis=axis, radius=float(centre[0]), minor=radius
    )


def _ball(points: Floats) -> tuple[Floats, float]:
    """Return centre and radius of the circle (k, 2) or sphere (k, 3) nearest to points in the algebraic sense; radius inf when flat."""
    middle = points.mean(axis=0)
    p = points - middle
    size = float(np.abs(p).max()) or 1.0
    p = p / size
    matrix = np.hstack([2.0 * p, np.ones((len(p), 1))])
    solved, _, rank, _ = np.linalg.lstsq(matrix, (p * p).sum(axis=1), rcond=tolerance.PARAMETRIC)
    if rank < matrix.shape[1]:
        return middle, math.inf
    return middle + size * solved[:-1], size * math.sqrt(
        max(float(solved[-1] + solved[:-1] @ solved[:-1]), 0.0)
    )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CanonicalCurve:
    """A curve's kind (a name of `facegraph.CURVES`) and a circle's centre, axis and radius; NaN where it has none."""

    kind: str
    centre: Floats
    axis: Floats
    radius: float = math.nan


_LINE = CanonicalCurve(kind="line", centre=NOWHERE, axis=NOWHERE)


def recognised_curve(adaptor: Any) -> CanonicalCurve:
    """Return the plain curve under an edge's adaptor."""
    kind = adaptor.GetType()
    if kind == GeomAbs_Line:
        return _LINE
    if kind == GeomAbs_Circle:
        found = adaptor.Circle()
        return CanonicalCurve(
            kind="circle",
            centre=xyz(found.Location()),
            axis=xyz(found.Axis().Direction()),
            radius=found.Radius(),
        )
    if kind == GeomAbs_Ellipse:
        return CanonicalCurve(kind="ellipse", centre=NOWHERE, axis=NOWHERE)
    first, last = adaptor.FirstParameter(), adaptor.LastParameter()
    return fitted_curve(
        np.array([adaptor.Value(t).Coord() for t in np.linspace(first, last, _STEPS)])
    )


def fitted_curve(points: Floats) -> CanonicalCurve:
    """Return the line or circle that points (k, 3) along a curve lie on, else a spline."""
    chord = points[-1] - points[0]
    length = float(np.linalg.norm(chord))
    if length > tolerance.COINCIDENT:
        away = points - points[0]
        away -= (away @ chord)[:, None] * chord / length**2
        if np.linalg.norm(away, axis=1).max() < tolerance.FITTED:
            return _LINE
    middle = points.mean(axis=0)
    x, y, axis = np.linalg.svd(points - middle)[2]
    if np.abs((points - middle) @ axis).max() < tolerance.FITTED:
        flat = np.stack([(points - middle) @ x, (points - middle) @ y], axis=1)
        centre, radius = _ball(flat)
        if (
            np.isfinite(radius)
            and np.abs(np.linalg.norm(flat - centre, axis=1) - radius).max() < tolerance.FITTED
        ):
            return CanonicalCurve(
                kind="circle",
                centre=middle + centre[0] * x + centre[1] * y,
                axis=axis,
                radius=radius,
            )
    return CanonicalCurve(kind="spline", centre=NOWHERE, axis=NOWHERE)


def _cone(found: Any) -> CanonicalSurface:
    angle, axes = found.SemiAngle(), _axis(found)
    sense = 1.0 if angle > 0.0 else -1.0
    return CanonicalSurface(
        kind="cone",
        axis_point=axes["axis_point"],
        axis=sense * axes["axis"],
        radius=found.RefRadius(),
        minor=abs(angle),
    )


def _axis(found: Any) -> dict[str, Any]:
    return {"axis_point": xyz(found.Axis().Location()), "axis": xyz(found.Axis().Direction())}


def xyz(thing: Any) -> Floats:
    """Return the coordinates (3,) of a point, vector or direction of the CAD kernel."""
    return np.array([thing.X(), thing.Y(), thing.Z()])
