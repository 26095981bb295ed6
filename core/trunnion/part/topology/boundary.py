"""What bounds the trimmed faces: edges with their lengths, points at equal arc length on them, and their exact boxes."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Curve2d, BRepAdaptor_Surface
from OCP.GCPnts import GCPnts_AbscissaPoint, GCPnts_QuasiUniformAbscissa
from OCP.GeomAbs import GeomAbs_Line
from OCP.gp import gp_Pnt, gp_Vec
from OCP.TopoDS import TopoDS
from scipy.spatial import cKDTree

from trunnion import tolerance
from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.boundary import Boundary
from trunnion.part.topology.identity import Shape, edges_of

_SAMPLES, _ROUNDS = 33, 24
"""Points an edge is searched at for its extremes, and how often the span around the best is narrowed at most."""
_NODES, _NEARER = 17, 4
"""Nodes on an edge, and steps towards the nearest point of its curve: they start beside it."""
_SHARES = (0.0, 0.25, 0.5, 0.75, 1.0)
"""Shares of a curve's parameters at which two curves in the same position are compared."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BoundaryCurves:
    """The curves that bound trimmed faces: owner (e,) the tag of the face that each one bounds, length (e,) mm. Seams and edges without
    length bound nothing."""

    owner: Ints
    curves: list[BRepAdaptor_Curve]
    length: Floats

    def points(self, parts: Callable[[Floats], Ints] | None) -> Boundary:
        """Return points on the curves, in the coordinates of the shape.

        `parts` says for edge lengths (e,) in mm into how many pieces of equal length each is cut; every edge gives its end points and the
        points between the pieces. Without it the points hold those of each face that are farthest along x, y and z, within a tenth of
        `tolerance.FITTED` of the true ones.
        """
        if parts is None:
            points = _farthest(self.curves, self.owner)
        else:
            points = [
                _spread(c, int(n)) for c, n in zip(self.curves, parts(self.length), strict=True)
            ]
        return Boundary(
            face=self.owner,
            length=self.length,
            edge=np.repeat(np.arange(len(points)), [len(p) for p in points]),
            point=np.vstack([np.zeros((0, 3)), *points]),
        )


def bounding_of(faces: Iterable[tuple[int, Shape]]) -> BoundaryCurves:
    """Return what bounds trimmed faces, given with their tags."""
    owner: list[int] = []
    curves: list[BRepAdaptor_Curve] = []
    for tag, face in faces:
        found = _bounding(face)
        curves += found
        owner += [tag] * len(found)
    length = np.array([GCPnts_AbscissaPoint.Length_s(c) for c in curves])
    return BoundaryCurves(owner=np.array(owner, dtype=np.int64), curves=curves, length=length)


def approximation_of(face: Shape) -> float:
    """Return how far a face's boundary curves are from its surface at most, in mm: the paper's approximation error.

    A node is a point of the trim on the surface; its distance is that to the nearest point of the curve in space.
    """
    surface, most = BRepAdaptor_Surface(face), 0.0
    for edge in edges_of(face):
        if BRep_Tool.Degenerated_s(edge):
            continue
        trim, curve = BRepAdaptor_Curve2d(edge, TopoDS.Face_s(face)), BRepAdaptor_Curve(edge)
        for t in np.linspace(trim.FirstParameter(), trim.LastParameter(), _NODES).tolist():
            uv = trim.Value(t)
            most = max(most, _distance(curve, np.array(surface.Value(uv.X(), uv.Y()).Coord()), t))
    return most


def _distance(curve: BRepAdaptor_Curve, node: Floats, t: float) -> float:
    """Return the distance of a node from a curve, searched from the parameter that both should share (Newton)."""
    point, along = gp_Pnt(), gp_Vec()
    nearest = np.inf
    for _ in range(_NEARER):
        curve.D1(t, point, along)
        away, tangent = node - np.array(point.Coord()), np.array(along.Coord())
        nearest = min(nearest, float(np.linalg.norm(away)))
        speed = float(tangent @ tangent)
        if speed <= 0.0:
            break
        t = min(
            max(t + float(away @ tangent) / speed, curve.FirstParameter()), curve.LastParameter()
        )
    return nearest


def _bounding(face: Shape) -> list[BRepAdaptor_Curve]:
    """Return the curves that bound a face, without its seams: one edge that is there twice, or (in IGES) two edges in the same position."""
    curves = [
        BRepAdaptor_Curve(e)
        for e in edges_of(face)
        if not BRep_Tool.Degenerated_s(e) and not BRep_Tool.IsClosed_s(e, TopoDS.Face_s(face))
    ]
    positions = np.array(
        [
            [
                c.Value(
                    c.FirstParameter() + share * (c.LastParameter() - c.FirstParameter())
                ).Coord()
                for share in _SHARES
            ]
            for c in curves
        ]
    ).reshape(-1, len(_SHARES), 3)
    seam = set()
    for a, b in (
        cKDTree(positions[:, len(_SHARES) // 2]).query_pairs(tolerance.SLIVER)
        if len(curves) > 1
        else ()
    ):
        if (
            min(
                np.abs(positions[a] - positions[b]).max(),
                np.abs(positions[a] - positions[b][::-1]).max(),
            )
            < tolerance.SLIVER
        ):
            seam |= {a, b}
    return [c for k, c in enumerate(curves) if k not in seam]


def _spread(curve: BRepAdaptor_Curve, parts: int) -> Floats:
    """Return the ends of an edge and the points that cut it into parts of equal length."""
    if parts <= 1:
        return np.array(
            [curve.Value(t).Coord() for t in (curve.FirstParameter(), curve.LastParameter())]
        )
    found = GCPnts_QuasiUniformAbscissa(curve, parts + 1)
    return np.array(
        [curve.Value(found.Parameter(k)).Coord() for k in range(1, found.NbPoints() + 1)]
    )


def _farthest(curves: list[BRepAdaptor_Curve], owner: Ints) -> list[Floats]:
    """Return points of every curve; where a face may reach farther between them, the farthest point too."""
    at = [
        np.linspace(
            c.FirstParameter(), c.LastParameter(), 2 if c.GetType() == GeomAbs_Line else _SAMPLES
        )
        for c in curves
    ]
    points = [np.array([c.Value(t).Coord() for t in ts]) for c, ts in zip(curves, at, strict=True)]
    # Between two points a curve is hardly longer than twice their distance: it can't reach farther than that.
    slack = np.array([np.abs(np.diff(p, axis=0)).max() if len(p) > 2 else 0.0 for p in points])
    for axis in range(3):
        for sign in (1.0, -1.0):
            most = np.array([(sign * p[:, axis]).max() for p in points])
            best = np.full(int(owner.max(initial=0)) + 1, -np.inf)
            np.maximum.at(best, owner, most)
            for k in np.flatnonzero((slack > 0.0) & (most + slack > best[owner])):
                n = int(np.argmax(sign * points[k][:_SAMPLES, axis]))
                found = _refined(
                    curves[k], at[k][max(n - 1, 0)], at[k][min(n + 1, _SAMPLES - 1)], axis, sign
                )
                points[k] = np.vstack([points[k], found])
    return points


def _refined(
    curve: BRepAdaptor_Curve, low: float, high: float, axis: int, sign: float
) -> tuple[float, float, float]:
    """Return the farthest point of a span that holds one extreme: there the curve runs across the axis (Newton, kept between halvings)."""
    point, along, bend = gp_Pnt(), gp_Vec(), gp_Vec()
    t = 0.5 * (low + high)
    for _ in range(_ROUNDS):
        curve.D2(t, point, along, bend)
        slope, turn = sign * along.Coord(axis + 1), sign * bend.Coord(axis + 1)
        low, high = (t, high) if slope > 0.0 else (low, t)
        step = t - slope / turn if turn < 0.0 else low
        step = step if low < step < high else 0.5 * (low + high)
        if abs(slope * (step - t)) < 0.01 * tolerance.FITTED:
            break
        t = step
    return point.Coord()
