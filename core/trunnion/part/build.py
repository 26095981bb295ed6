"""Shapes that the program makes itself: those of blanks, and several as one."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.frame import Frame
from trunnion.part.topology.identity import Shape


def box_blank(frame: Frame, low: ArrayLike, high: ArrayLike) -> Shape:
    """Return the solid box between two corners (3,) given in a frame, placed in the part's coordinates.

    Raises `BadInput` when the box has no thickness.
    """
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox
    from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt

    low, size = (
        np.asarray(low, dtype=np.float64),
        np.asarray(high, dtype=np.float64) - np.asarray(low, dtype=np.float64),
    )
    if not (size > 0.0).all():
        raise BadInput(
            "a blank needs length, width and height: "
            + " x ".join(f"{s:g}" for s in size)
            + " mm is not a box"
        )
    corner = gp_Ax2(
        gp_Pnt(*frame.to_world(low).tolist()), gp_Dir(*frame.z.tolist()), gp_Dir(*frame.x.tolist())
    )
    return BRepPrimAPI_MakeBox(corner, *size.tolist()).Solid()


def revolved_blank(frame: Frame, outline: Floats) -> Shape:
    """Return the solid of a closed outline (k, 2) of radius and height mm that turns about a frame's z axis."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakePolygon
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeRevol
    from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt

    polygon = BRepBuilderAPI_MakePolygon()
    half_plane = np.column_stack([outline[:, 0], np.zeros(len(outline)), outline[:, 1]])
    for point in frame.to_world(half_plane).tolist():
        polygon.Add(gp_Pnt(*point))
    polygon.Close()
    axis = gp_Ax1(gp_Pnt(*frame.origin.tolist()), gp_Dir(*frame.z.tolist()))
    return BRepPrimAPI_MakeRevol(BRepBuilderAPI_MakeFace(polygon.Wire()).Face(), axis).Shape()


def faceted_blank(points: Floats, triangles: Ints) -> Shape:
    """Return the solid inside closed triangles (t, 3) of points (v, 3): a plane face each.

    Raises `BadInput` when they can't be sewn to a solid.
    """
    from OCP.BRepBuilderAPI import (
        BRepBuilderAPI_MakeFace,
        BRepBuilderAPI_MakePolygon,
        BRepBuilderAPI_MakeSolid,
        BRepBuilderAPI_Sewing,
    )
    from OCP.gp import gp_Pnt
    from OCP.TopAbs import TopAbs_SHELL
    from OCP.TopoDS import TopoDS

    sewing = BRepBuilderAPI_Sewing(tolerance.COINCIDENT)
    for corners in points[triangles].tolist():
        polygon = BRepBuilderAPI_MakePolygon(*(gp_Pnt(*c) for c in corners), True)
        sewing.Add(BRepBuilderAPI_MakeFace(polygon.Wire(), True).Face())
    sewing.Perform()
    sewn = sewing.SewedShape()
    if sewn.ShapeType() != TopAbs_SHELL:
        raise BadInput("the blank's triangles make no single solid; write its own file instead")
    return BRepBuilderAPI_MakeSolid(TopoDS.Shell_s(sewn)).Solid()


def compound(shapes: Iterable[Shape]) -> Shape:
    """Return shapes as one compound."""
    from OCP.BRep import BRep_Builder
    from OCP.TopoDS import TopoDS_Compound

    made, builder = TopoDS_Compound(), BRep_Builder()
    builder.MakeCompound(made)
    for shape in shapes:
        builder.Add(made, shape)
    return made


class ShapeBuilder:
    """Makes the shape of a blank, whatever its kind: see `model.blank.Builder`."""

    def box(self, frame: Frame, low: Floats, high: Floats) -> Shape:
        """See `box_blank`."""
        return box_blank(frame, low, high)

    def revolved(self, frame: Frame, outline: Floats) -> Shape:
        """See `revolved_blank`."""
        return revolved_blank(frame, outline)

    def faceted(self, points: Floats, triangles: Ints) -> Shape:
        """See `faceted_blank`."""
        return faceted_blank(points, triangles)
