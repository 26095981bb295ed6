"""Cuts a solid by a plane: exact lines and arcs, chained by the edges that they end on.

The plane meets every edge in points (nodes). Between nodes the plane meets a face in a line (planes, cylinders along the plane), a circle
(whatever turns about an axis across the plane) or a general curve. What lies inside the trimmed face stays, and because every node belongs
to an edge and every edge to two faces, the pieces chain without any search by distance.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.GeomAbs import GeomAbs_Circle, GeomAbs_Line
from OCP.gp import gp_Pnt
from OCP.ShapeAnalysis import ShapeAnalysis_Surface
from OCP.TopAbs import TopAbs_EDGE
from OCP.TopExp import TopExp
from OCP.TopoDS import TopoDS
from OCP.TopTools import TopTools_IndexedMapOfShape

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.geometry.arrays import Floats
from trunnion.geometry.frame import Frame
from trunnion.geometry.plane.arc_fitting import along_arcs, arcs_through
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.region import Region
from trunnion.part.shape.plane_intersection import trace
from trunnion.part.topology.canonical import CanonicalSurface, recognised
from trunnion.part.topology.extent import edge_extremes, face_box
from trunnion.part.topology.faces import TrimmedFace
from trunnion.part.topology.graph import coedges
from trunnion.part.topology.identity import Shape
from trunnion.progress import NO_PROGRESS, Progress

_SAMPLES = 33
_TRIES = 50
_HALVINGS = 60
NEAR_EXTREMES = 0.01
"""Of how far an edge reaches across the plane: how much farther it may reach than its extremes tell."""
GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)
"""Golden section: the share of an interval that is kept where the least of something is looked for."""
_INSIDE = (0.5, 0.35, 0.65)
"""Shares of a line or an arc at which a face is asked whether it holds them, two of three: one alone may be wrong, as the kernel's
classifier is where the ray that it shoots goes through a corner of the face (the middle of an arc above one, say)."""
Node = tuple[int, int]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Plane:
    """A cutting plane in the part's coordinates: height above it is `normal @ point - offset`."""

    frame: Frame
    offset: float

    @staticmethod
    def at(frame: Frame, z: float) -> Plane:
        """Return the plane at a height of a frame."""
        return Plane(frame=frame, offset=float(frame.origin @ frame.z) + z)

    @property
    def normal(self) -> Floats:
        """The plane's unit normal (3,)."""
        return self.frame.z

    def above(self, points: Floats) -> Floats:
        """Return the heights of points (..., 3) above the plane."""
        return points @ self.normal - self.offset

    def flat(self, points: Floats) -> Floats:
        """Return the x and y (..., 2) of points in the frame."""
        return self.frame.to_local(points)[..., :2]


@dataclass(slots=True, eq=False)
class SectionEdge:
    """An edge of the solid: its curve, points that bound it, and samples along it when it is neither line nor circle."""

    shape: Shape
    adaptor: Any
    first: float
    last: float
    kind: Any
    points: Floats
    extremes: Floats


@dataclass(slots=True, eq=False)
class SectionFace:
    """A trimmed face with the surface under it, its edges' numbers and its box."""

    view: TrimmedFace
    surface: CanonicalSurface
    edges: tuple[int, ...]
    low: Floats
    high: Floats
    projection: Any = None

    def holds(self, point: Floats) -> bool:
        """Return whether a point on the surface lies inside the trimmed area."""
        if self.projection is None:
            self.projection = ShapeAnalysis_Surface(BRep_Tool.Surface_s(self.view.face))
        uv = self.projection.ValueOfUV(gp_Pnt(*point.tolist()), tolerance.COINCIDENT)
        return self.view.holds(uv.X(), uv.Y())

    def holds_most(self, points: Iterable[Floats]) -> bool:
        """Return whether two of three points on the surface, which lie all inside the trimmed area or all outside, are found inside."""
        first, second, third = points
        found = self.holds(first)
        return found if found == self.holds(second) else self.holds(third)


@dataclass(frozen=True, slots=True, eq=False)
class SectionPiece:
    """A piece of the section in plan, from node to node: points (k, 2) with bulges (k - 1,)."""

    start: Node
    end: Node
    points: Floats
    bulges: Floats


class SolidSlicer:
    """Answers sections of one solid; what doesn't depend on the plane is prepared once."""

    def __init__(
        self, shape: Shape, faces: Iterable[Shape], progress: Progress = NO_PROGRESS
    ) -> None:
        index = TopTools_IndexedMapOfShape()
        TopExp.MapShapes_s(shape, TopAbs_EDGE, index)
        shapes = [TopoDS.Edge_s(index.FindKey(n)) for n in range(1, index.Extent() + 1)]
        self.edges: dict[int, SectionEdge] = {}
        progress.doing("making ready to cut the part by planes")
        for n, s in enumerate(shapes, start=1):
            progress.check()
            if not BRep_Tool.Degenerated_s(s):
                self.edges[n] = _edge(s)
        self.faces = [self._face(face, index, progress) for face in faces]
        self._low = np.array([f.low for f in self.faces])
        self._high = np.array([f.high for f in self.faces])
        self._corners = np.concatenate([e.points[[0, -1]] for e in self.edges.values()])
        self._lines = np.array(
            [n for n, e in self.edges.items() if e.kind == GeomAbs_Line], dtype=np.int64
        )
        self._line_ends = np.array([self.edges[n].points[[0, -1]] for n in self._lines]).reshape(
            -1, 2, 3
        )
        self._others = [n for n, e in self.edges.items() if e.kind != GeomAbs_Line]

    def section(self, frame: Frame, z: float, progress: Progress = NO_PROGRESS) -> Region:
        """Return the material cut by the plane at a height of a frame, in the frame's x and y."""
        progress.check()
        plane = self._clear_of_corners(frame, z)
        nodes = self._nodes(plane)
        links: list[SectionPiece] = []
        loops: list[Curve] = []
        for face in self._crossed(plane):
            progress.check()
            own = [
                (node, point) for n in dict.fromkeys(face.edges) for node, point in nodes.get(n, ())
            ]
            seams = {n for n in face.edges if face.edges.count(n) > 1}
            found, closed = _cut(face, plane, own, seams)
            links += found
            loops += closed
        return Region.of(loops + _chained(links, f"z = {z:g}"))

    def _face(
        self, face: Shape, index: TopTools_IndexedMapOfShape, progress: Progress
    ) -> SectionFace:
        progress.check()
        view = TrimmedFace(face, 0)
        own = tuple(c.edge for c in coedges(face, index) if c.edge in self.edges)
        surface = recognised(view.adaptor, lambda: view.evaluated(view.grid(5)))
        boundary = (
            np.concatenate([self.edges[n].extremes for n in own]) if own else np.empty((0, 3))
        )
        low, high = face_box(view, surface, boundary, progress)
        return SectionFace(view, surface, own, low, high)

    def _clear_of_corners(self, frame: Frame, z: float) -> Plane:
        """Return the plane, moved up by small steps until no corner of the solid lies in it."""
        heights = np.sort(self._corners @ frame.z)
        for n in range(_TRIES):
            plane = Plane.at(frame, z + n * tolerance.SECTION_STEP)
            near = np.searchsorted(heights, plane.offset)
            near_heights = heights[max(near - 1, 0) : near + 1]
            if not (np.abs(near_heights - plane.offset) < 2.0 * tolerance.COINCIDENT).any():
                return plane
        raise BadInput(
            f"no section at z = {z:g}: the part has corners at every height there; choose another height"
        )

    def _crossed(self, plane: Plane) -> list[SectionFace]:
        middle, half = 0.5 * (self._low + self._high), 0.5 * (self._high - self._low)
        reach = half @ np.abs(plane.normal) + tolerance.COINCIDENT
        return [self.faces[n] for n in np.nonzero(np.abs(plane.above(middle)) <= reach)[0]]

    def _nodes(self, plane: Plane) -> dict[int, list[tuple[Node, Floats]]]:
        """Return by edge number where the plane meets the edges."""
        found: dict[int, list[tuple[Node, Floats]]] = {}
        if len(self._lines):
            heights = plane.above(self._line_ends)
            for k in np.nonzero((heights[:, 0] > 0.0) != (heights[:, 1] > 0.0))[0]:
                share = heights[k, 0] / (heights[k, 0] - heights[k, 1])
                n = int(self._lines[k])
                found[n] = [
                    (
                        (n, 0),
                        self._line_ends[k, 0]
                        + share * (self._line_ends[k, 1] - self._line_ends[k, 0]),
                    )
                ]
        for n in self._others:
            edge = self.edges[n]
            parameters = _parameters_on(edge, plane)
            if parameters:
                found[n] = [
                    ((n, k), np.array(edge.adaptor.Value(t).Coord()))
                    for k, t in enumerate(parameters)
                ]
        return found


def _edge(shape: Shape) -> SectionEdge:
    adaptor = BRepAdaptor_Curve(shape)
    first, last, kind = adaptor.FirstParameter(), adaptor.LastParameter(), adaptor.GetType()
    steps = 2 if kind in (GeomAbs_Line, GeomAbs_Circle) else _SAMPLES
    points = np.array([adaptor.Value(t).Coord() for t in np.linspace(first, last, steps)])
    return SectionEdge(shape, adaptor, first, last, kind, points, edge_extremes(adaptor, points))


def _parameters_on(edge: SectionEdge, plane: Plane) -> list[float]:
    """Return the parameters where a round or free edge meets the plane, ascending.

    A circle's points that are farthest along x, y and z may all lie on one side of a plane that leans: its own reach decides.
    """
    if edge.kind == GeomAbs_Circle:
        return _on_circle(edge, plane)
    heights = plane.above(edge.extremes)
    # Across the axes the extremes are those of samples.
    more = NEAR_EXTREMES * float(np.ptp(heights))
    return _on_curve(edge, plane) if heights.min() < more and heights.max() > -more else []


def _on_circle(edge: SectionEdge, plane: Plane) -> list[float]:
    """Return the parameters where a circular edge meets the plane, ascending."""
    circle = edge.adaptor.Circle()
    x, y = (
        np.array(circle.XAxis().Direction().Coord()),
        np.array(circle.YAxis().Direction().Coord()),
    )
    a, b = circle.Radius() * float(x @ plane.normal), circle.Radius() * float(y @ plane.normal)
    height, amplitude = float(plane.above(np.array(circle.Location().Coord()))), math.hypot(a, b)
    if abs(height) >= amplitude:
        return []
    middle, half = math.atan2(b, a), math.acos(-height / amplitude)
    turns = [
        edge.first + (t - edge.first) % (2.0 * math.pi) for t in (middle - half, middle + half)
    ]
    return sorted(t for t in turns if t < edge.last)


def _on_curve(edge: SectionEdge, plane: Plane) -> list[float]:
    """Return the parameters where a free edge meets the plane, ascending, by halving between samples of unlike side."""
    parameters = np.linspace(edge.first, edge.last, _SAMPLES)
    heights = plane.above(edge.points)
    for at, height in _turning(edge, plane, parameters, heights):
        row = int(np.searchsorted(parameters, at))
        parameters, heights = np.insert(parameters, row, at), np.insert(heights, row, height)
    found = []
    for k in np.nonzero((heights[:-1] > 0.0) != (heights[1:] > 0.0))[0]:
        low, high, was = float(parameters[k]), float(parameters[k + 1]), heights[k] > 0.0
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            if (_height(edge, plane, middle) > 0.0) == was:
                low = middle
            else:
                high = middle
        found.append(0.5 * (low + high))
    return found


def _turning(
    edge: SectionEdge, plane: Plane, parameters: Floats, heights: Floats
) -> list[tuple[float, float]]:
    """Return parameter and height where an edge, all of whose samples near by lie on one side, comes through the plane and turns back.

    Between samples a height goes past the one at its turn by an eighth of their second difference or so; what could meet the plane is
    looked at more closely, by golden sections.
    """
    # Beyond its ends an edge is taken to go back the way it came: it may turn right beside them.
    padded = np.pad(heights, 1, "reflect")
    before, here, after = np.abs(padded[:-2]), np.abs(heights), np.abs(padded[2:])
    turns = (np.sign(padded[:-2]) == np.sign(heights)) & (np.sign(padded[2:]) == np.sign(heights))
    turns &= (here <= before) & (here <= after) & (3.0 * here < before + after)
    found = []
    for k in np.flatnonzero(turns).tolist():
        sense = float(np.sign(heights[k]))
        low, high = (float(parameters[n]) for n in (max(k - 1, 0), min(k + 1, len(heights) - 1)))
        for _ in range(_HALVINGS):
            a, b = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
            if sense * _height(edge, plane, a) < sense * _height(edge, plane, b):
                high = b
            else:
                low = a
        at = 0.5 * (low + high)
        height = _height(edge, plane, at)
        if sense * height < 0.0:
            found.append((at, height))
    return found


def _height(edge: SectionEdge, plane: Plane, parameter: float) -> float:
    return float(plane.above(np.array(edge.adaptor.Value(parameter).Coord())))


Nodes = list[tuple[Node, Floats]]


def _cut(
    face: SectionFace, plane: Plane, own: Nodes, seams: set[int]
) -> tuple[list[SectionPiece], list[Curve]]:
    """Return the pieces and the whole loops in which a plane meets a face."""
    surface, normal = face.surface, plane.normal
    level = (
        abs(float(normal @ surface.axis))
        if surface.axis is not None and np.isfinite(surface.axis).all()
        else math.nan
    )
    if surface.kind == "plane":
        return (
            _on_line(face, plane, own, np.cross(_plane_normal(face), normal)) if own else []
        ), []
    if surface.kind == "cylinder" and level < tolerance.COINCIDENT:
        return (_on_line(face, plane, own, surface.axis) if own else []), []
    if surface.kind == "sphere" or (
        surface.kind in ("cylinder", "cone", "torus") and abs(level - 1.0) < tolerance.PARAMETRIC
    ):
        return _on_circles(face, plane, own, seams)
    return _traced(face, plane, own, seams)


def _plane_normal(face: SectionFace) -> Floats:
    return (
        face.view.plane_normal
        if face.view.plane_normal is not None
        else face.view.at(*face.view.grid(1)[0])[1]
    )


def _on_line(face: SectionFace, plane: Plane, own: Nodes, along: Floats) -> list[SectionPiece]:
    """Return the pieces of a line across a face, or of two parallel ones (a cylinder's)."""
    along = along / np.linalg.norm(along)
    across = np.cross(plane.normal, along)
    middle = (
        float(face.surface.axis_point @ across) if face.surface.kind == "cylinder" else -math.inf
    )
    tracks: tuple[Nodes, Nodes] = ([], [])
    for node, point in own:
        tracks[float(point @ across) > middle].append((node, point))
    links = []
    for track in tracks:
        track.sort(key=lambda item: float(item[1] @ along))
        for (a, p), (b, q) in pairwise(track):
            if len(track) == 2 or face.holds_most(p + share * (q - p) for share in _INSIDE):
                links.append(SectionPiece(a, b, plane.flat(np.stack([p, q])), np.zeros(1)))
    return links


def _circles(surface: CanonicalSurface, plane: Plane) -> list[tuple[Floats, float]]:
    """Return centre and radius of the circles in which a plane across its axis meets a whole surface of revolution."""
    height = float(plane.above(surface.axis_point))
    centre = surface.axis_point - height * plane.normal
    if surface.kind == "cylinder":
        return [(centre, surface.radius)]
    if surface.kind == "cone":
        along = -height * float(plane.normal @ surface.axis)
        return [(centre, abs(surface.radius + along * math.tan(surface.minor)))]
    rest = (surface.radius if surface.kind == "sphere" else surface.minor) ** 2 - height**2
    if rest <= 0.0:
        return []
    if surface.kind == "sphere":
        return [(centre, math.sqrt(rest))]
    radii = [surface.radius + math.sqrt(rest), surface.radius - math.sqrt(rest)]
    return [(centre, abs(r)) for r in radii if abs(r) > tolerance.COINCIDENT]


def _on_circles(
    face: SectionFace, plane: Plane, own: Nodes, seams: set[int]
) -> tuple[list[SectionPiece], list[Curve]]:
    links: list[SectionPiece] = []
    loops: list[Curve] = []
    circles = _circles(face.surface, plane)
    parts: dict[int, Nodes] = defaultdict(list)
    for node, point in own:
        gaps = [abs(float(np.linalg.norm(point - centre)) - radius) for centre, radius in circles]
        parts[int(np.argmin(gaps))].append((node, point)) if gaps else None
    for n, (centre, radius) in enumerate(circles):
        middle = plane.flat(centre)
        track = sorted(
            ((_angle(plane.flat(point) - middle), node, point) for node, point in parts[n]),
            key=lambda item: item[0],
        )
        if not [t for t in track if t[1][0] not in seams]:
            begin = track[0][0] if track else 0.5
            whole = (_on(plane, centre, radius, begin + 2.0 * math.pi * s) for s in _INSIDE)
            if face.holds_most(whole):
                loops.append(Curve.circle(middle, radius))
            continue
        # A seam is no boundary: arcs go on across it.
        across = [angle for angle, node, _ in track if node[0] in seams]
        track = [t for t in track if t[1][0] not in seams]
        for k, (angle, node, point) in enumerate(track):
            after, other, target = track[(k + 1) % len(track)]
            sweep = after - angle + (2.0 * math.pi if k + 1 == len(track) else 0.0)
            inside = _clear_of(across, angle, sweep)
            if face.holds_most(_on(plane, centre, radius, at) for at in inside):
                links.append(
                    _arc(
                        node,
                        other,
                        plane.flat(point),
                        plane.flat(target),
                        middle,
                        radius,
                        angle,
                        sweep,
                    )
                )
    return links, loops


def _clear_of(seams: list[float], angle: float, sweep: float) -> list[float]:
    """Return angles on an arc well inside it, farthest first from the seams, on which nobody can tell inside from outside."""
    inside = [angle + share * sweep for share in _INSIDE]
    return sorted(
        inside, key=lambda at: -min((abs(math.sin(0.5 * (at - s))) for s in seams), default=0.0)
    )


def _angle(vector: Floats) -> float:
    return math.atan2(float(vector[1]), float(vector[0]))


def _on(plane: Plane, centre: Floats, radius: float, angle: float) -> Floats:
    return centre + radius * (math.cos(angle) * plane.frame.x + math.sin(angle) * plane.frame.y)


def _arc(
    a: Node,
    b: Node,
    start: Floats,
    end: Floats,
    centre: Floats,
    radius: float,
    angle: float,
    sweep: float,
) -> SectionPiece:
    """Return an anticlockwise arc, in two pieces when it is more than half a circle, because its bulge would grow without bound."""
    if sweep <= math.pi:
        return SectionPiece(a, b, np.stack([start, end]), np.array([math.tan(0.25 * sweep)]))
    half = centre + radius * np.array(
        [math.cos(angle + 0.5 * sweep), math.sin(angle + 0.5 * sweep)]
    )
    return SectionPiece(a, b, np.stack([start, half, end]), np.full(2, math.tan(0.125 * sweep)))


def _traced(
    face: SectionFace, plane: Plane, own: Nodes, seams: set[int]
) -> tuple[list[SectionPiece], list[Curve]]:
    """Return the pieces of a general curve, followed over the surface and fitted by arcs."""
    links: list[SectionPiece] = []
    loops: list[Curve] = []
    for start, end, points, headings in trace(face.view, plane, own, seams, face.low, face.high):
        along = plane.frame.local_direction(headings)[:, :2]
        flat, bulges = arcs_through(along_arcs(plane.flat(points), along))
        if start is None or end is None:
            loops.append(Curve(flat[:-1], bulges, True))
        else:
            links.append(SectionPiece(start, end, flat, bulges))
    return links, loops


def _chained(links: list[SectionPiece], where: str) -> list[Curve]:
    """Return the closed curves of pieces that end at common nodes; raise `BadInput` when an end is left over."""
    at: dict[Node, list[int]] = defaultdict(list)
    for n, link in enumerate(links):
        at[link.start].append(n)
        at[link.end].append(n)
    if any(len(ends) != 2 for ends in at.values()):
        raise BadInput(
            f"the section at {where} does not close: the part has a gap or a fault there; heal it in the CAD system"
        )
    curves, used = [], [False] * len(links)
    for first, link in enumerate(links):
        if used[first]:
            continue
        points, bulges, here, n = [], [], link.start, first
        while not used[n]:
            used[n] = True
            piece = links[n]
            forward = piece.start == here
            points.append(piece.points[:-1] if forward else piece.points[:0:-1])
            bulges.append(piece.bulges if forward else -piece.bulges[::-1])
            here = piece.end if forward else piece.start
            n = next((k for k in at[here] if not used[k]), n)
        curves.append(Curve(np.concatenate(points), np.concatenate(bulges), True))
    return curves
