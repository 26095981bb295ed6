"""The outline of a level plane face, in plan."""

from __future__ import annotations

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.BRepTools import BRepTools_WireExplorer
from OCP.TopAbs import TopAbs_REVERSED, TopAbs_WIRE
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.geometry.arrays import Floats
from trunnion.geometry.frame import Frame
from trunnion.geometry.plane.arc_fitting import arcs_through
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.region import Region
from trunnion.part.topology.canonical import recognised, recognised_curve
from trunnion.part.topology.faces import TrimmedFace
from trunnion.part.topology.identity import Shape

_STEPS = 65


def outline(face: Shape, frame: Frame, words: str) -> Region:
    """Return the plan projection of a plane face in a frame's x and y; `words` name the face.

    Raises `BadInput` when the face is not plane or leans by more than `tolerance.TANGENT`.
    """
    view = TrimmedFace(face, 0)
    surface = recognised(view.adaptor, lambda: view.evaluated(view.grid(5)))
    normal = view.evaluated(view.grid(1))[1][0]
    if surface.kind != "plane" or abs(float(normal @ frame.z)) < np.cos(tolerance.TANGENT):
        raise BadInput(f"{words} is not level, so it has no plan outline")
    wires, curves = TopExp_Explorer(face, TopAbs_WIRE), []
    while wires.More():
        curves.append(_loop(TopoDS.Wire_s(wires.Current()), face, frame))
        wires.Next()
    return Region.of(curves)


def _loop(wire: Shape, face: Shape, frame: Frame) -> Curve:
    points: list[Floats] = []
    bulges: list[Floats] = []
    around = BRepTools_WireExplorer(wire, face)
    while around.More():
        flat, bulge = _piece(BRepAdaptor_Curve(around.Current()), frame)
        if around.Current().Orientation() == TopAbs_REVERSED:
            flat, bulge = flat[::-1], -bulge[::-1]
        points.append(flat[:-1])
        bulges.append(bulge)
        around.Next()
    return Curve(np.concatenate(points), np.concatenate(bulges), True)


def _piece(adaptor: object, frame: Frame) -> tuple[Floats, Floats]:
    """Return points and bulges of one edge in plan, in the direction of its curve."""
    curve = recognised_curve(adaptor)
    first, last = adaptor.FirstParameter(), adaptor.LastParameter()  # type: ignore[attr-defined]
    steps = 2 if curve.kind == "line" else _STEPS
    parameters = np.linspace(first, last, steps)
    flat = frame.to_local(np.array([adaptor.Value(t).Coord() for t in parameters]))[:, :2]  # type: ignore[attr-defined]
    if curve.kind == "line":
        return flat, np.zeros(1)
    if curve.kind == "circle":
        centre = frame.to_local(curve.centre)[:2]
        angles = np.unwrap(np.arctan2(flat[:, 1] - centre[1], flat[:, 0] - centre[0]))
        halves = (
            [0, _STEPS // 2, _STEPS - 1] if abs(angles[-1] - angles[0]) > np.pi else [0, _STEPS - 1]
        )
        return flat[halves], np.tan(0.25 * np.diff(angles[halves]))
    return arcs_through(flat)
