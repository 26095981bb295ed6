"""The box around a trimmed face, exact for plain surfaces: the kernel's own boxes are loose or take 10 ms a face (measured)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.GeomAbs import GeomAbs_Circle, GeomAbs_Line
from OCP.gp import gp_Pnt
from OCP.ShapeAnalysis import ShapeAnalysis_Surface

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats
from trunnion.part.shape.evaluate import evaluator_of
from trunnion.part.topology.canonical import CanonicalSurface
from trunnion.part.topology.faces import TrimmedFace
from trunnion.part.topology.trim import Trim
from trunnion.progress import NO_PROGRESS, Progress

_GRID, _ZOOM, _ZOOMS, _STEPS = 13, 3, 12, 65
_SIX = np.hstack([np.eye(3), -np.eye(3)])
"""The directions (3, 6) in which a box has its sides, as columns."""
Box = tuple[Floats, Floats]


def edge_extremes(adaptor: Any, points: Floats) -> Floats:
    """Return points (k, 3) of an edge that include its farthest ones along x, y and z; `points` run along it."""
    kind = adaptor.GetType()
    if kind == GeomAbs_Line:
        return points[[0, -1]]
    first, last = adaptor.FirstParameter(), adaptor.LastParameter()
    if kind != GeomAbs_Circle:
        return _with_turns(adaptor, np.linspace(first, last, _STEPS))
    circle = adaptor.Circle()
    x, y = (
        np.array(circle.XAxis().Direction().Coord()),
        np.array(circle.YAxis().Direction().Coord()),
    )
    angle = np.arctan2(y, x)
    angle = np.concatenate([angle, angle + math.pi])
    angle = first + np.mod(angle - first, 2.0 * math.pi)
    angle = angle[angle < last, None]
    round_points = np.array(circle.Location().Coord()) + circle.Radius() * (
        np.cos(angle) * x + np.sin(angle) * y
    )
    return np.concatenate([points[[0, -1]], round_points])


def _with_turns(adaptor: Any, parameters: Floats) -> Floats:
    """Return points (k, 3) of a free edge at parameters, and those where its x, y or z turn between them: the vertex of the parabola
    through the farthest sample and two beside it, which is off the edge's own by the fourth power of their distance."""
    points = np.array([adaptor.Value(t).Coord() for t in parameters.tolist()])
    rows = np.concatenate([points.argmin(axis=0), points.argmax(axis=0)])
    rows = np.unique(np.clip(rows, 1, len(points) - 2))
    before, here, after = points[rows - 1], points[rows], points[rows + 1]
    bend = before - 2.0 * here + after
    share = np.divide(0.5 * (before - after), bend, out=np.zeros_like(bend), where=bend != 0.0)
    turns = parameters[rows, None] + np.clip(share, -1.0, 1.0) * (parameters[1] - parameters[0])
    more = [adaptor.Value(t).Coord() for t in turns.ravel().tolist()]
    return np.concatenate([points, np.array(more).reshape(-1, 3)])


def face_box(
    view: TrimmedFace, surface: CanonicalSurface, boundary: Floats, progress: Progress = NO_PROGRESS
) -> Box:
    """Return the lowest and highest corner around a face; `boundary` (k, 3) holds its edges' extremes.

    Planes, cylinders and cones are ruled, so their extremes lie on the boundary. Free-form faces are searched by sampling.
    """
    if surface.kind in ("plane", "cylinder", "cone") and len(boundary):
        return boundary.min(axis=0), boundary.max(axis=0)
    if surface.kind in ("sphere", "torus"):
        return _with_candidates(view, boundary, np.array(list(_candidates(surface))))
    return _searched(view, boundary, progress)


def _candidates(surface: CanonicalSurface) -> Iterator[Floats]:
    """Yield the points of a whole sphere or torus that are farthest along x, y and z, either way."""
    for direction in np.concatenate([np.eye(3), -np.eye(3)]):
        if surface.kind == "sphere":
            yield surface.axis_point + surface.radius * direction
            continue
        across = direction - (direction @ surface.axis) * surface.axis
        size = float(np.linalg.norm(across))
        if size < tolerance.ANGLE:
            across = np.cross(surface.axis, np.eye(3)[np.argmin(np.abs(surface.axis))])
            size = float(np.linalg.norm(across))
        for sense in (1.0, -1.0):
            yield (
                surface.axis_point
                + sense * surface.radius * across / size
                + surface.minor * direction
            )


def _with_candidates(view: TrimmedFace, boundary: Floats, points: Floats) -> Box:
    low = boundary.min(axis=0) if len(boundary) else np.full(3, np.inf)
    high = boundary.max(axis=0) if len(boundary) else np.full(3, -np.inf)
    beyond = ((points < low - tolerance.COINCIDENT) | (points > high + tolerance.COINCIDENT)).any(
        axis=1
    )
    if beyond.any():
        projection = ShapeAnalysis_Surface(BRep_Tool.Surface_s(view.face))
        for point in points[beyond]:
            uv = projection.ValueOfUV(gp_Pnt(*point.tolist()), tolerance.COINCIDENT)
            if projection.Gap() < tolerance.FITTED and view.holds(uv.X(), uv.Y()):
                low, high = np.minimum(low, point), np.maximum(high, point)
    return low, high


def _searched(view: TrimmedFace, boundary: Floats, progress: Progress) -> Box:
    """Return the box of samples, each of the six farthest ones followed by a finer and finer search around it."""
    u0, u1, v0, v1 = view.bounds()
    step = np.array([(u1 - u0) / _GRID, (v1 - v0) / _GRID])
    trim, evaluate = Trim(view, progress), evaluator_of(view.adaptor)

    def inside(uv: Floats) -> tuple[Floats, Floats, Bools]:
        held = trim.holds(uv, with_rim=True)
        return uv[held], evaluate(uv[held])[:, 0], held

    grid, points, _ = inside(np.array(view.grid(_GRID)))
    found = [boundary, points]
    if len(points):
        share = np.linspace(-1.0, 1.0, _ZOOM)
        pattern = np.stack(np.meshgrid(share, share), axis=-1).reshape(-1, 2)
        centre = grid[(points @ _SIX).argmax(axis=0)]
        for zoom in range(_ZOOMS):
            around = centre[:, None] + pattern * (step * 0.5**zoom)
            uv = np.clip(around.reshape(-1, 2), [u0, v0], [u1, v1])
            _, points, held = inside(uv)
            if not len(points):
                break
            found.append(points)
            own = np.flatnonzero(held) // len(pattern)
            far = np.full((len(centre), len(pattern)), -np.inf)
            far.ravel()[held] = (points @ _SIX)[np.arange(len(own)), own]
            has_points = np.isfinite(far).any(axis=1)
            centre[has_points] = uv.reshape(len(centre), -1, 2)[
                has_points, far[has_points].argmax(axis=1)
            ]
    cloud = np.concatenate(
        [f for f in found if len(f)] or [np.array([view.at(0.5 * (u0 + u1), 0.5 * (v0 + v1))[0]])]
    )
    return cloud.min(axis=0), cloud.max(axis=0)
