"""Builds the attributed face graph of a solid: what every face is, and how faces meet at their edges."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Curve2d
from OCP.BRepGProp import BRepGProp
from OCP.BRepTools import BRepTools
from OCP.GCPnts import GCPnts_AbscissaPoint
from OCP.GeomAbs import GeomAbs_Plane
from OCP.gp import gp_Pnt, gp_Pnt2d, gp_Vec, gp_Vec2d
from OCP.GProp import GProp_GProps
from OCP.TopAbs import TopAbs_EDGE, TopAbs_REVERSED, TopAbs_WIRE
from OCP.TopExp import TopExp, TopExp_Explorer
from OCP.TopoDS import TopoDS
from OCP.TopTools import TopTools_IndexedMapOfShape

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.geometry.facegraph import CONCAVE, CONVEX, SMOOTH, FaceGraph
from trunnion.part.topology.canonical import (
    PLAIN,
    CanonicalCurve,
    CanonicalSurface,
    recognised,
    recognised_curve,
)
from trunnion.part.topology.extent import edge_extremes, face_box
from trunnion.part.topology.faces import TrimmedFace
from trunnion.part.topology.identity import Shape
from trunnion.part.topology.measure import ACCURACY
from trunnion.progress import NO_PROGRESS, Progress

_GRIDS, _PLANE_GRIDS = (5, 13, 31), (4, 13, 31)
_MIN_SAMPLES, _MIN_PLANE_SAMPLES = 9, 4
_ALONG_EDGE = 7
_DOMINATES = 2.0


@dataclass(slots=True, eq=False)
class Coedge:
    """One edge as a face uses it: its number, direction (+1 as the curve runs, -1 against it) and loop (0 the outer one)."""

    edge: int
    sense: float
    loop: int


@dataclass(slots=True, eq=False)
class TopologyEdge:
    """An edge with its curve and who uses it. `points` (7, 3) run along it, `extremes` (k, 3) include its farthest along x, y, z."""

    edge: Shape
    adaptor: Any = field(init=False)
    middle: float = field(init=False)
    points: Floats = field(init=False)
    extremes: Floats = field(init=False)
    users: list[tuple[TrimmedFace, float, int]] = field(init=False, default_factory=list)

    def __post_init__(self) -> None:
        self.adaptor = BRepAdaptor_Curve(self.edge)
        first, last = self.adaptor.FirstParameter(), self.adaptor.LastParameter()
        self.middle = 0.5 * (first + last)
        self.points = np.array(
            [self.adaptor.Value(t).Coord() for t in np.linspace(first, last, _ALONG_EDGE)]
        )
        self.extremes = edge_extremes(self.adaptor, self.points)


def face_graph(
    shape: Shape, faces: Mapping[int, Shape], n_faces: int, progress: Progress = NO_PROGRESS
) -> FaceGraph:
    """Return the graph of a solid's faces (by tag); rows of tags that aren't there have area 0, no samples and no edges.

    The normal bend of a torus is that of its tube; of a free-form face the one that is at least twice as sharp as the other.
    """
    progress.doing("looking at faces and edges")
    views = {tag: TrimmedFace(face, tag - 1) for tag, face in progress.each(sorted(faces.items()))}
    edges, rims = _edges(shape, views, progress)
    rows = {
        tag - 1: _face_row(view, rims[tag - 1], progress)
        for tag, view in progress.each(views.items())
    }
    columns = [rows.get(n, _ABSENT) for n in range(n_faces)]
    joints = [joint for edge in progress.each(edges) for joint in _joints(edge)]
    samples = [(n, c) for n, c in enumerate(columns) if len(c.points)]

    def column(name: str) -> np.ndarray:
        return np.array([getattr(c, name) for c in columns])

    def of_surface(name: str) -> np.ndarray:
        return np.array([getattr(c.surface, name) for c in columns])

    def of_joint(name: str) -> np.ndarray:
        return np.array([getattr(j, name) for j in joints])

    return FaceGraph(
        surface=tuple(c.surface.kind for c in columns),
        area=column("area"),
        centre=column("centre"),
        normal=column("normal"),
        axis_point=of_surface("axis_point"),
        axis=of_surface("axis"),
        radius=of_surface("radius"),
        minor=of_surface("minor"),
        bend=column("bend"),
        box_low=column("low"),
        box_high=column("high"),
        sample_face=np.concatenate([np.full(len(c.points), n) for n, c in samples]),
        sample_point=np.concatenate([c.points for _, c in samples]),
        sample_normal=np.concatenate([c.normals for _, c in samples]),
        edge_face=of_joint("faces").reshape(-1, 2),
        convexity=of_joint("convexity"),
        dihedral=of_joint("dihedral"),
        length=of_joint("length"),
        edge_loop=of_joint("loops").reshape(-1, 2),
        curve=tuple(j.curve.kind for j in joints),
        start=_points(j.view.points[0] for j in joints),
        middle=_points(j.view.points[_ALONG_EDGE // 2] for j in joints),
        end=_points(j.view.points[-1] for j in joints),
        curve_centre=_points(j.curve.centre for j in joints),
        curve_axis=_points(j.curve.axis for j in joints),
        curve_radius=np.array([j.curve.radius for j in joints]),
        open_edges=sum(len(e.users) == 1 for e in edges),
    )


def _points(rows: Any) -> Floats:
    return np.array(list(rows)).reshape(-1, 3)


# Edges


def _edges(
    shape: Shape, views: Mapping[int, TrimmedFace], progress: Progress
) -> tuple[list[TopologyEdge], dict[int, list[TopologyEdge]]]:
    """Return the edges with their users (a seam has its face twice), and by face row the edges around it."""
    index = TopTools_IndexedMapOfShape()
    TopExp.MapShapes_s(shape, TopAbs_EDGE, index)
    edges = {
        n: TopologyEdge(edge)
        for n in progress.each(range(1, index.Extent() + 1))
        if not BRep_Tool.Degenerated_s(edge := TopoDS.Edge_s(index.FindKey(n)))
    }
    rims: dict[int, list[TopologyEdge]] = {}
    for view in progress.each(views.values()):
        rim = rims.setdefault(view.row, [])
        for coedge in coedges(view.face, index):
            if coedge.edge in edges:
                edges[coedge.edge].users.append((view, coedge.sense, coedge.loop))
                rim.append(edges[coedge.edge])
    return list(edges.values()), rims


def coedges(face: Shape, index: TopTools_IndexedMapOfShape) -> list[Coedge]:
    """Return the edges around a face, its material on their left seen from outside; numbers are those of an index of edges."""
    outer = BRepTools.OuterWire_s(face)
    found, inner = [], 0
    wires = TopExp_Explorer(face, TopAbs_WIRE)
    while wires.More():
        wire = wires.Current()
        loop = 0
        if outer.IsNull() or not wire.IsSame(outer):
            inner += 1
            loop = inner
        around = TopExp_Explorer(wire, TopAbs_EDGE)
        while around.More():
            edge = around.Current()
            found.append(
                Coedge(
                    index.FindIndex(edge),
                    -1.0 if edge.Orientation() == TopAbs_REVERSED else 1.0,
                    loop,
                )
            )
            around.Next()
        wires.Next()
    return found


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FaceAdjacency:
    """Two faces meeting at an edge."""

    view: TopologyEdge
    faces: tuple[int, int]
    loops: tuple[int, int]
    convexity: int
    dihedral: float
    length: float
    curve: CanonicalCurve


def _joints(edge: TopologyEdge) -> list[FaceAdjacency]:
    pairs = [
        (a, b) for n, a in enumerate(edge.users) for b in edge.users[n + 1 :] if a[0] is not b[0]
    ]
    if not pairs:
        return []
    curve, tangent = recognised_curve(edge.adaptor), _tangent(edge)
    length = _length(edge, curve)
    found = []
    for (a, sense, loop_a), (b, _, loop_b) in pairs:
        normal_a, normal_b = _normal_at_edge(edge, a), _normal_at_edge(edge, b)
        turn = math.atan2(
            float(np.cross(normal_a, normal_b) @ tangent) * sense, float(normal_a @ normal_b)
        )
        convexity = SMOOTH if abs(turn) < tolerance.TANGENT else CONVEX if turn > 0.0 else CONCAVE
        found.append(
            FaceAdjacency(
                view=edge,
                faces=(a.row, b.row),
                loops=(loop_a, loop_b),
                convexity=convexity,
                dihedral=math.pi - turn,
                length=length,
                curve=curve,
            )
        )
    return found


def _tangent(edge: TopologyEdge) -> Floats:
    point, along = gp_Pnt(), gp_Vec()
    edge.adaptor.D1(edge.middle, point, along)
    tangent = np.array(along.Coord())
    size = float(np.linalg.norm(tangent))
    if size <= tolerance.PARAMETRIC:
        middle = _ALONG_EDGE // 2
        tangent = edge.points[middle + 1] - edge.points[middle - 1]
        size = float(np.linalg.norm(tangent)) or 1.0
    return tangent / size


def _normal_at_edge(edge: TopologyEdge, view: TrimmedFace) -> Floats:
    if view.plane_normal is not None:
        return view.plane_normal
    uv = BRepAdaptor_Curve2d(edge.edge, view.face).Value(edge.middle)
    return view.at(uv.X(), uv.Y())[1]


def _length(edge: TopologyEdge, curve: CanonicalCurve) -> float:
    if edge.adaptor.GetType() != 0 and curve.kind == "line":
        return float(np.linalg.norm(np.diff(edge.points, axis=0), axis=1).sum())
    return float(GCPnts_AbscissaPoint.Length_s(edge.adaptor))


# Faces


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FaceAttributes:
    """What the graph says of one face."""

    surface: CanonicalSurface
    area: float
    centre: Floats
    normal: Floats
    bend: int
    low: Floats
    high: Floats
    points: Floats
    normals: Floats


_ORIGIN = np.zeros(3)
_ABSENT = FaceAttributes(
    surface=replace(PLAIN, kind="other"),
    area=0.0,
    centre=_ORIGIN,
    normal=_ORIGIN,
    bend=0,
    low=_ORIGIN,
    high=_ORIGIN,
    points=np.empty((0, 3)),
    normals=np.empty((0, 3)),
)


def _face_row(view: TrimmedFace, rim: list[TopologyEdge], progress: Progress) -> FaceAttributes:
    points, normals = _samples(view, progress)
    surface = recognised(view.adaptor, lambda: view.evaluated(view.grid(_GRIDS[0])))
    best = _deepest(points, np.concatenate([e.points for e in rim]) if rim else np.empty((0, 3)))
    low, high = face_box(
        view,
        surface,
        np.concatenate([e.extremes for e in rim]) if rim else np.empty((0, 3)),
        progress,
    )
    surface = _anchored(surface, points[best])
    return FaceAttributes(
        surface=surface,
        area=_area(view),
        centre=points[best],
        normal=normals[best],
        bend=_bend(surface, points, normals, best),
        low=low,
        high=high,
        points=points,
        normals=normals,
    )


def _samples(view: TrimmedFace, progress: Progress) -> tuple[Floats, Floats]:
    """Return points spread over the trimmed area and their outward normals; at least one even on the thinnest face."""
    most: list[tuple[float, float]] = []
    is_plane = view.adaptor.GetType() == GeomAbs_Plane
    wanted = _MIN_PLANE_SAMPLES if is_plane else _MIN_SAMPLES
    for steps in _PLANE_GRIDS if is_plane else _GRIDS:
        found = [uv for uv in progress.each(view.grid(steps)) if view.holds(*uv)]
        most = found if len(found) > len(most) else most
        if len(most) >= wanted:
            break
    if len(most) > _GRIDS[0] ** 2:
        most = most[:: math.ceil(len(most) / _GRIDS[0] ** 2)]
    if len(most) < wanted:
        most = most + _near_rim(view, wanted - len(most))
    if not most:
        u0, u1, v0, v1 = view.bounds()
        most = [(0.5 * (u0 + u1), 0.5 * (v0 + v1))]
    return view.evaluated(most)


def _near_rim(view: TrimmedFace, wanted: int) -> list[tuple[float, float]]:
    """Return up to `wanted` positions (u, v) a little inside the boundary: a thin face falls between the cells of any grid."""
    found: list[tuple[float, float]] = []
    around = TopExp_Explorer(view.face, TopAbs_EDGE)
    u0, u1, v0, v1 = view.bounds()
    while around.More() and len(found) < wanted:
        curve = BRepAdaptor_Curve2d(TopoDS.Edge_s(around.Current()), view.face)
        first, last = curve.FirstParameter(), curve.LastParameter()
        for t in (0.5, 0.3, 0.7):
            here, along = gp_Pnt2d(), gp_Vec2d()
            curve.D1(first + t * (last - first), here, along)
            across = np.array([-along.Y() * (u1 - u0) ** 2, along.X() * (v1 - v0) ** 2])
            size = math.hypot(across[0] / ((u1 - u0) or 1.0), across[1] / ((v1 - v0) or 1.0)) or 1.0
            for step in (0.2, -0.2, 0.05, -0.05, 0.01, -0.01, 0.002, -0.002, 0.0002, -0.0002):
                u, v = here.X() + step * across[0] / size, here.Y() + step * across[1] / size
                if view.holds(u, v):
                    found.append((u, v))
                    break
        around.Next()
    return found


def _deepest(points: Floats, boundary: Floats) -> int:
    """Return the row of the point farthest from the boundary."""
    if not len(boundary):
        return 0
    away = np.linalg.norm(points[:, None, :] - boundary[None, :, :], axis=2).min(axis=1)
    return int(np.argmax(np.round(away, 9)))


def _area(view: TrimmedFace) -> float:
    found = GProp_GProps()
    if view.adaptor.GetType() == GeomAbs_Plane:
        BRepGProp.SurfaceProperties_s(view.face, found)
    else:
        BRepGProp.SurfaceProperties_s(view.face, found, ACCURACY)
    return abs(float(found.Mass()))


def _anchored(surface: CanonicalSurface, near: Floats) -> CanonicalSurface:
    """Return the surface with its axis point beside a point of the face, so that it doesn't depend on how the file wrote it."""
    if surface.kind not in ("cylinder", "cone"):
        return surface
    along = float((near - surface.axis_point) @ surface.axis)
    radius = (
        surface.radius + along * math.tan(surface.minor)
        if surface.kind == "cone"
        else surface.radius
    )
    return replace(surface, axis_point=surface.axis_point + along * surface.axis, radius=radius)


def _bend(surface: CanonicalSurface, points: Floats, normals: Floats, best: int) -> int:
    point, normal = points[best], normals[best]
    if surface.kind == "plane":
        return 0
    if surface.kind in ("cylinder", "cone", "sphere", "torus"):
        away = point - surface.axis_point
        if surface.kind != "sphere":
            away = away - (away @ surface.axis) * surface.axis
        if surface.kind == "torus":
            away = point - surface.axis_point - surface.radius * away / np.linalg.norm(away)
        return 1 if float(away @ normal) > 0.0 else -1
    step = points[:, None] - points[None]
    square = (step * step).sum(axis=2)
    turn = ((normals[:, None] - normals[None]) * step).sum(axis=2)
    curvature = np.divide(
        turn, square, out=np.zeros_like(turn), where=square > tolerance.COINCIDENT**2
    )
    out, hollow = max(float(curvature.max()), 0.0), max(-float(curvature.min()), 0.0)
    if max(out, hollow) * math.sqrt(float(square.max())) < tolerance.ANGLE:
        return 0
    return 1 if out > _DOMINATES * hollow else -1 if hollow > _DOMINATES * out else 0
