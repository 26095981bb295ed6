"""Parts made of the CAD kernel's own shapes, without a file."""

from __future__ import annotations

from typing import Any

from trunnion.part.part import Part, PartMetadata
from trunnion.part.read.heal import bodies_of


def part_of_shape(shape: Any, name: str = "shape") -> Part:
    """Return the part that reading a file with this one body would give."""
    (body,), _ = bodies_of(shape)
    facts = PartMetadata(
        path="",
        name=name,
        digest="",
        unit="mm",
        n_faces=len(body.tags),
        n_solids=1,
        solid=1,
        is_closed=body.is_closed,
        area=body.area,
        volume=body.volume,
        tags=body.tags,
    )
    return Part(facts, body.shape, shape)


def cylinder(radius: float, height: float) -> Part:
    """Return a cylinder that stands on the origin; face 1 is its side."""
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeCylinder

    return part_of_shape(BRepPrimAPI_MakeCylinder(radius, height).Shape(), "cylinder")


def sphere(radius: float) -> Part:
    """Return a sphere about the origin."""
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeSphere

    return part_of_shape(BRepPrimAPI_MakeSphere(radius).Shape(), "sphere")


def torus(major: float, minor: float) -> Part:
    """Return a ring about z."""
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeTorus

    return part_of_shape(BRepPrimAPI_MakeTorus(major, minor).Shape(), "torus")


def plate(width: float, depth: float, height: float, hole: float = 0.0) -> Part:
    """Return a plate from the origin up, with a round hole through its middle when a radius is given."""
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder
    from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt

    shape = BRepPrimAPI_MakeBox(width, depth, height).Shape()
    if hole:
        axis = gp_Ax2(gp_Pnt(width / 2.0, depth / 2.0, -1.0), gp_Dir(0.0, 0.0, 1.0))
        shape = BRepAlgoAPI_Cut(
            shape, BRepPrimAPI_MakeCylinder(axis, hole, height + 2.0).Shape()
        ).Shape()
    return part_of_shape(shape, "plate")


def rounded_plate(width: float, depth: float, height: float, radius: float) -> Part:
    """Return a plate whose upper edges are rounded."""
    from OCP.BRepFilletAPI import BRepFilletAPI_MakeFillet
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox

    from trunnion.part.topology.identity import edges_of

    shape = BRepPrimAPI_MakeBox(width, depth, height).Shape()
    made = BRepFilletAPI_MakeFillet(shape)
    for edge in edges_of(shape):
        if _heights(edge) == (height, height):
            made.Add(radius, edge)
    return part_of_shape(made.Shape(), "rounded plate")


def bowl(width: float, depth: float, height: float, radius: float) -> Part:
    """Return a plate with a round hollow of the radius of a ball whose middle is at the plate's top."""
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeSphere
    from OCP.gp import gp_Pnt

    ball = BRepPrimAPI_MakeSphere(gp_Pnt(width / 2.0, depth / 2.0, height), radius).Shape()
    return part_of_shape(
        BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(width, depth, height).Shape(), ball).Shape(), "bowl"
    )


def face_towards(part: Part, x: float, y: float, z: float) -> int:
    """Return the tag of the plane face that looks in a direction."""
    graph = part.graph()
    return next(
        t
        for t in part.tags
        if graph.surface[t - 1] == "plane" and graph.normal[t - 1] @ (x, y, z) > 0.999
    )


def _heights(edge: Any) -> tuple[float, float]:
    from OCP.BRepAdaptor import BRepAdaptor_Curve

    curve = BRepAdaptor_Curve(edge)
    return round(curve.Value(curve.FirstParameter()).Z(), 6), round(
        curve.Value(curve.LastParameter()).Z(), 6
    )
