"""Wheels with root fillets, made one period at a time: rounding the roots of a whole wheel crashes the CAD kernel.

A blade and the splitters behind it, with round noses, stand on a hub that runs on before the inlet and beyond the outlet, so that
the chains of their roots' edges end at one plain rim; they are rounded there, turned to size, and cut out along the middles of the
channels beside them. Their faces are turned to all places and sewn. The kernel may still crash: `rounded_wheel` runs it in a process
of its own.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass
from itertools import pairwise
from math import cos, degrees, hypot, inf, pi, sin
from pathlib import Path
from typing import Any

import cadquery as cq
from OCP.BRep import BRep_Builder
from OCP.BRepAlgoAPI import BRepAlgoAPI_Splitter
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_Sewing
from OCP.BRepTools import BRepTools
from OCP.Geom import Geom_BezierCurve, Geom_Curve
from OCP.GeomAPI import GeomAPI_Interpolate
from OCP.gp import gp_Pnt, gp_Vec
from OCP.ShapeUpgrade import ShapeUpgrade_UnifySameDomain
from OCP.TColgp import TColgp_Array1OfPnt, TColgp_HArray1OfPnt
from OCP.TColStd import TColStd_HArray1OfReal
from OCP.TopoDS import TopoDS_Shape
from OCP.TopTools import TopTools_ListOfShape

BEFORE, PAST_BLADE, PAST_RIM = -0.1, 1.13, 1.06
"""Where hub and blades are rounded: from a place before the inlet to a rim, both beyond the wheel, in shares of its meridian and radius."""
STATIONS, SIDE_STATIONS = 13, 9
"""Points along a blade's curves, and along those of each face between two periods."""
BELOW, ABOVE = -0.35, 1.2
"""Where the rulings begin and end, in shares of the way from hub to shroud."""
WEDGE = 300.0
"""Degrees of the hub that one blade is rounded on: no seam is near it."""
CLEAR = 0.06
"""Share of the meridian before the last splitter at which the end of a period lies in the middle of its channel."""
NOSE = 0.67
"""Of a blade's thickness: how far the poles of its nose go ahead; half a circle would have two thirds."""
SEWN = 1e-4
"""mm within which edges of neighbours are one."""
LONGEST_S = 120.0
"""Seconds after which the making of a wheel is given up."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WheelForm:
    """What a wheel with root fillets is made of, mm and radians.

    Meridians of hub and shroud are curves of the second degree by three points (radius, height) each and go slightly beyond the outlet
    `radius`; blades stand in `starts` (one for each row, shares of the meridian), `count` in each row, evenly; they go round the axis by
    `wrap` from inlet to outlet (its sign is the sense), are `thick`, and their walls have so many `pieces`. The front lies at `height`, the
    back at `back`; `bore` is a radius. Where the faces of the lathe are not `joined`, they lie in one sector for each blade.
    """

    radius: float
    height: float
    back: float
    bore: float
    hub_points: tuple[tuple[float, float], ...]
    shroud_points: tuple[tuple[float, float], ...]
    starts: tuple[float, ...]
    count: int
    wrap: float
    thick: float
    pieces: int
    fillet: float
    joined: bool = False

    def hub(self, s: float) -> tuple[float, float]:
        """Return radius and height of the hub at a share of its meridian."""
        return _quadratic(self.hub_points, s)

    def shroud(self, s: float) -> tuple[float, float]:
        """Return radius and height of the shroud at a share of its meridian."""
        return _quadratic(self.shroud_points, s)

    @property
    def pitch(self) -> float:
        """Angle from one main blade to the next."""
        return 2.0 * pi / self.count

    def beside(self, s: float) -> float:
        """Return the angle from the main blade to the end of the period before it: half the pitch where it stands alone, and half the
        way to the last splitter where that stands."""
        share = min(max(s / (self.starts[-1] - CLEAR), 0.0), 1.0)
        alone, among = 0.5 * self.pitch, 0.5 * self.pitch / len(self.starts)
        return -alone + (alone - among) * share * share * (3.0 - 2.0 * share)

    def at_radius(self, radius: float) -> float:
        """Return where the hub has a radius, as a share of its meridian."""
        low, high = 0.0, 1.5
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if self.hub(middle)[0] < radius else (low, middle)
        return low

    def least_room(self) -> float:
        """Return the least distance in mm of walls along the hub, square to the flow, where blades begin and at the outlet."""
        found = []
        for row, start in enumerate(self.starts):
            for s in (start, 0.5 * (start + 1.0), 1.0):
                (r, z), (r1, z1) = self.hub(s), self.hub(s + 1e-4)
                along = hypot(r1 - r, z1 - z) / 1e-4
                lean = along / hypot(along, r * self.wrap)
                found.append(2.0 * pi * r * lean / (self.count * (row + 1)) - self.thick)
        return min(found)


def _quadratic(points: Sequence[tuple[float, float]], s: float) -> tuple[float, float]:
    a, b, c = (1.0 - s) ** 2, 2.0 * s * (1.0 - s), s * s
    (r0, z0), (r1, z1), (r2, z2) = points
    return a * r0 + b * r1 + c * r2, a * z0 + b * z1 + c * z2


def rounded_wheel(form: WheelForm) -> cq.Shape | None:
    """Return the solid of a wheel, made in a process of its own; None where the kernel crashes, hangs or makes no valid solid."""
    with tempfile.TemporaryDirectory() as made:
        path = Path(made) / "wheel.brep"
        try:
            done = subprocess.run(
                [sys.executable, str(Path(__file__)), str(path)],
                input=json.dumps(asdict(form)),
                capture_output=True,
                text=True,
                timeout=LONGEST_S,
                check=False,
            )
        except subprocess.TimeoutExpired:
            return None
        if done.returncode or not path.exists():
            return None
        shape = TopoDS_Shape()
        BRepTools.Read_s(shape, str(path), BRep_Builder())
    return cq.Shape.cast(shape)


def wheel_solid(form: WheelForm) -> cq.Shape:
    """Return the solid of a wheel with root fillets. Raises `ValueError` where it is none, and the kernel's own errors."""
    sewing = BRepBuilderAPI_Sewing(SEWN)
    faces = _period(form)
    for k in range(form.count):
        for face in faces:
            sewing.Add(face.rotate(*AXIS, 360.0 * k / form.count).wrapped)
    sewing.Perform()
    shell = cq.Shape.cast(sewing.SewedShape())
    if sewing.NbFreeEdges() or not isinstance(shell, cq.Shell):
        raise ValueError(f"{sewing.NbFreeEdges()} edges of the periods have no neighbour")
    solid = cq.Solid.makeSolid(shell).fix()
    solid = _joined(form, solid) if form.joined else solid
    if not solid.isValid() or solid.Volume() <= 0.0:
        raise ValueError("the periods make no valid solid")
    return solid


def _joined(form: WheelForm, solid: cq.Shape) -> cq.Shape:
    """Return a solid whose planes and cylinders are whole, but for the trailing edges on the rim."""
    union = ShapeUpgrade_UnifySameDomain(solid.wrapped)
    for face in solid.Faces():
        if _is_outlet(form, face):
            for edge in face.Edges():
                if edge.geomType() == "CIRCLE":
                    union.KeepShape(edge.wrapped)
    union.Build()
    return cq.Shape.cast(union.Shape()).Solids()[0]


AXIS = (cq.Vector(0, 0, 0), cq.Vector(0, 0, 1))


def _period(form: WheelForm) -> list[cq.Face]:
    """Return the outer faces of one blade, its splitters, their root fillets and their share of the wheel's body."""
    end = form.at_radius(form.radius * PAST_BLADE)
    blades = [
        _blade(form, start, end).rotate(*AXIS, degrees(form.pitch * row / len(form.starts)))
        for row, start in enumerate(form.starts)
    ]
    rim = cq.Solid.makeCylinder(
        PAST_RIM * form.radius, 8.0 * form.radius, cq.Vector(0, 0, -4.0 * form.radius)
    )
    whole = _hub(form, form.radius * PAST_BLADE).fuse(*blades)
    whole = whole.intersect(rim.rotate(*AXIS, 180.0 + _middle(form)))
    solid = whole.Solids()[0]
    rounded = solid.fillet(form.fillet, _roots(solid))
    if not rounded.isValid():
        raise ValueError("the root fillets are not valid")
    sides = _side(form)
    sides += [face.rotate(*AXIS, degrees(form.pitch)) for face in sides]
    piece, dropped = _split(rounded.intersect(_envelope(form)), sides, _inside(form))
    return [
        part
        for face in piece.Faces()
        if not any(face.wrapped.IsSame(other) for other in dropped)
        for part in _outlet_parts(form, face)
    ]


def _middle(form: WheelForm) -> float:
    """Return where the middle of a period stands, degrees."""
    return 0.5 * degrees(form.wrap + form.pitch * (1.0 - 1.0 / len(form.starts)))


def _hub(form: WheelForm, radius: float) -> cq.Shape:
    """Return the hub's solid out to a radius, longer than the wheel's at the inlet and behind."""
    low, high = BEFORE, form.at_radius(radius)
    curve = [form.hub(low + (high - low) * k / 32.0) for k in range(33)]
    below = 3.0 * form.back
    return _turned(form, [(0.0, below), (0.0, curve[0][1])], curve, [(curve[-1][0], below)], WEDGE)


def _envelope(form: WheelForm) -> cq.Shape:
    """Return all that the wheel is turned to: front, shroud, outlet, back and bore."""
    points = [form.shroud(1.1 * k / 32.0) for k in range(33)]
    last = next(k for k, p in enumerate(points) if p[0] >= form.radius)
    (r0, z0), (r1, z1) = points[last - 1], points[last]
    share = (form.radius - r0) / (r1 - r0)
    curve = [*points[:last], (form.radius, z0 + share * (z1 - z0))]
    before = [(form.bore, form.back), (form.bore, form.height)]
    return _turned(form, before, curve, [(form.radius, form.back)], WEDGE + 20.0)


def _turned(
    form: WheelForm,
    before: Sequence[tuple[float, float]],
    curve: Sequence[tuple[float, float]],
    after: Sequence[tuple[float, float]],
    turn: float,
) -> cq.Shape:
    """Return the solid that an outline (radius, height) sweeps over a wedge (degrees) about the middle of a blade; a spline goes through
    `curve`."""
    sheet = cq.Workplane("XZ").moveTo(*before[0])
    for point in [*before[1:], curve[0]]:
        sheet = sheet.lineTo(*point)
    sheet = sheet.spline([*curve[1:]], includeCurrent=True)
    for point in after:
        sheet = sheet.lineTo(*point)
    swept = sheet.close().revolve(turn, (0, 0, 0), (0, 1, 0)).val()
    return swept.rotate(*AXIS, _middle(form) - 0.5 * turn)


def _blade(form: WheelForm, start: float, end: float) -> cq.Shape:
    """Return a blade's solid, its walls ruled and its nose round, from below the hub to above the shroud."""
    steps = [start + (end - start) * k / (STATIONS - 1) for k in range(STATIONS)]
    rails = {
        (span, side): _interpolated([_place(form, s, span, side) for s in steps], steps)
        for span in (BELOW, ABOVE)
        for side in (1.0, -1.0)
    }
    speeds = [_first(rail)[1].Magnitude() for rail in rails.values()]
    ahead = NOSE * form.thick * len(speeds) / sum(speeds)
    noses = {span: _nose(rails[span, 1.0], rails[span, -1.0], ahead) for span in (BELOW, ABOVE)}
    ends = [start + (1.0 - start) * k / form.pieces for k in range(form.pieces)] + [end]
    faces = [cq.Face.makeRuledSurface(noses[BELOW], noses[ABOVE])]
    rims = {span: [noses[span]] for span in (BELOW, ABOVE)}
    for low, high in pairwise(ends):
        for side in (1.0, -1.0):
            edges = {span: _edge(rails[span, side], low, high) for span in (BELOW, ABOVE)}
            faces.append(cq.Face.makeRuledSurface(edges[BELOW], edges[ABOVE]))
            for span in (BELOW, ABOVE):
                rims[span].append(edges[span])
    corners = {key: _place(form, end, *key) for key in rails}
    lines = [cq.Edge.makeLine(corners[BELOW, k], corners[ABOVE, k]) for k in (1.0, -1.0)]
    faces.append(cq.Face.makeRuledSurface(*lines))
    for span, rim in rims.items():
        closing = cq.Edge.makeLine(corners[span, 1.0], corners[span, -1.0])
        faces.append(cq.Face.makeNSidedSurface([*rim, closing], []))
    sewing = BRepBuilderAPI_Sewing(SEWN)
    for face in faces:
        sewing.Add(face.wrapped)
    sewing.Perform()
    return cq.Solid.makeSolid(cq.Shell(sewing.SewedShape())).fix()


def _place(form: WheelForm, s: float, span: float, side: float) -> cq.Vector:
    """Return the place on a wall (`side` 1 or -1) or the camber (0) of the first blade."""
    (r0, z0), (r1, z1) = form.hub(s), form.shroud(s)
    r, z = r0 + span * (r1 - r0), z0 + span * (z1 - z0)
    angle = form.wrap * s + side * 0.5 * form.thick / max(r, 0.3 * r1)
    return cq.Vector(r * cos(angle), r * sin(angle), z)


def _interpolated(points: Sequence[cq.Vector], steps: Sequence[float]) -> Geom_Curve:
    """Return the spline through points at given parameters."""
    places = TColgp_HArray1OfPnt(1, len(points))
    parameters = TColStd_HArray1OfReal(1, len(points))
    for k, (point, s) in enumerate(zip(points, steps, strict=True), 1):
        places.SetValue(k, point.toPnt())
        parameters.SetValue(k, s)
    made = GeomAPI_Interpolate(places, parameters, False, 1e-9)
    made.Perform()
    return made.Curve()


def _first(curve: Geom_Curve) -> tuple[gp_Pnt, gp_Vec]:
    point, speed = gp_Pnt(), gp_Vec()
    curve.D1(curve.FirstParameter(), point, speed)
    return point, speed


def _nose(first: Geom_Curve, second: Geom_Curve, ahead: float) -> cq.Edge:
    """Return the edge that leads from the start of one wall's rail round to that of the other, running on smoothly from both: the same
    share of each rail's speed makes the ruled nose smooth to both walls."""
    (a, leaves), (b, arrives) = _first(first), _first(second)
    poles = TColgp_Array1OfPnt(1, 4)
    for k, pole in enumerate(
        (a, a.Translated(leaves.Multiplied(-ahead)), b.Translated(arrives.Multiplied(-ahead)), b), 1
    ):
        poles.SetValue(k, pole)
    return _edge(Geom_BezierCurve(poles))


def _edge(curve: Geom_Curve, *ends: float) -> cq.Edge:
    return cq.Edge(BRepBuilderAPI_MakeEdge(curve, *ends).Edge())


def _roots(solid: cq.Shape) -> list[cq.Edge]:
    """Return the edges at which a blade stands on its hub."""
    hub = {
        edge.hashCode()
        for face in solid.Faces()
        if face.geomType() == "REVOLUTION"
        for edge in face.Edges()
    }
    found = {
        edge.hashCode(): edge
        for face in solid.Faces()
        if face.geomType() == "BSPLINE"
        for edge in face.Edges()
        if edge.hashCode() in hub
    }
    return list(found.values())


def _side(form: WheelForm) -> list[cq.Face]:
    """Return the faces at which a period begins: along the middle of the channel, ruled as blades are, from inside of bore and back
    to outside of the shroud."""
    low, high = BEFORE, form.at_radius(1.1 * form.radius)
    inner, bottom = 0.7 * form.bore, 2.0 * form.back

    def down(s: float) -> tuple[float, float]:
        """How far a blade's ruling goes on below the hub to the radius and the height at which faces end, in shares of its span."""
        (r0, z0), (r1, z1) = form.hub(s), form.shroud(s)
        return (
            (r0 - inner) / (r1 - r0) if r1 > r0 else inf,
            (z0 - bottom) / (z1 - z0) if z1 > z0 else inf,
        )

    first, last = low, high
    for _ in range(60):
        corner = 0.5 * (first + last)
        to_radius, to_height = down(corner)
        first, last = (corner, last) if to_radius < to_height else (first, corner)

    def inside(s: float) -> tuple[float, float]:
        (r0, z0), (r1, z1) = form.hub(s), form.shroud(s)
        span = min(down(s))
        return r0 - span * (r1 - r0), z0 - span * (z1 - z0)

    def outside(s: float) -> tuple[float, float]:
        (r0, z0), (r1, z1) = form.hub(s), form.shroud(s)
        return r0 + ABOVE * (r1 - r0), z0 + ABOVE * (z1 - z0)

    def rail(at: Callable[[float], tuple[float, float]], first: float, last: float) -> cq.Edge:
        steps = [first + (last - first) * k / (SIDE_STATIONS - 1) for k in range(SIDE_STATIONS)]
        places = []
        for s in steps:
            r, z = at(s)
            angle = form.wrap * s + form.beside(s)
            places.append(cq.Vector(r * cos(angle), r * sin(angle), z))
        return _edge(_interpolated(places, steps))

    return [
        cq.Face.makeRuledSurface(rail(inside, *part), rail(outside, *part))
        for part in ((low, corner), (corner, high))
    ]


def _inside(form: WheelForm) -> cq.Vector:
    """Return a place inside of the first period: below the middle of its camber."""
    (r, z), angle = form.hub(0.6), 0.6 * form.wrap
    return cq.Vector(r * cos(angle), r * sin(angle), 0.5 * (z + form.back))


def _split(
    shape: cq.Shape, tools: Iterable[cq.Face], inside: cq.Vector
) -> tuple[cq.Solid, list[TopoDS_Shape]]:
    """Return the piece of a shape, cut along faces, that holds a place, and the faces of the cut."""
    cut = _splitter(shape, tools)
    pieces = [s for s in cq.Shape.cast(cut.Shape()).Solids() if s.isInside(inside)]
    if len(pieces) != 1:
        raise ValueError(f"{len(pieces)} pieces hold the middle of the period")
    return pieces[0], [face for tool in tools for face in cut.Modified(tool.wrapped)]


def _splitter(shape: cq.Shape, tools: Iterable[cq.Face]) -> BRepAlgoAPI_Splitter:
    cut = BRepAlgoAPI_Splitter()
    given = TopTools_ListOfShape(), TopTools_ListOfShape()
    given[0].Append(shape.wrapped)
    for tool in tools:
        given[1].Append(tool.wrapped)
    cut.SetArguments(given[0])
    cut.SetTools(given[1])
    cut.Build()
    return cut


def _outlet_parts(form: WheelForm, face: cq.Face) -> list[cq.Face]:
    """Return a face, that of the outlet parted in the rim of the wheel and the blade's trailing edge, as files have it."""
    level = form.hub(form.at_radius(form.radius))[1]
    box = face.BoundingBox()
    if not _is_outlet(form, face) or not box.zmin + SEWN < level < box.zmax - SEWN:
        return [face]
    size = 4.0 * form.radius
    plane = cq.Face.makePlane(size, size, cq.Vector(0, 0, level), cq.Vector(0, 0, 1))
    return cq.Shape.cast(_splitter(face, [plane]).Shape()).Faces()


def _is_outlet(form: WheelForm, face: cq.Face) -> bool:
    """Return whether a face lies on the cylinder of the outlet."""
    at = face.Vertices()[0].toTuple()
    return bool(face.geomType() == "CYLINDER" and hypot(at[0], at[1]) > 0.9 * form.radius)


def main() -> None:
    """Write the wheel of the form that is given on standard input."""
    told: dict[str, Any] = json.loads(sys.stdin.read())
    for key in ("hub_points", "shroud_points"):
        told[key] = tuple(tuple(point) for point in told[key])
    told["starts"] = tuple(told["starts"])
    solid = wheel_solid(WheelForm(**told))
    BRepTools.Write_s(solid.wrapped, sys.argv[1])


if __name__ == "__main__":
    main()
