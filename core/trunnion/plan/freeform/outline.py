"""Plane drives of upright walls that stand free: along the outline that the part makes from their foot up.

The outline is the plan area of the part's triangles, which is nowhere smaller than the part's and a little larger; before the walls it ends
at their own plan curves, which are exact at all heights.
"""

from __future__ import annotations

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.curve_parts import parts_where
from trunnion.geometry.plane.plan_area import EVEN, LAP
from trunnion.geometry.plane.region import Piece, Region
from trunnion.geometry.sheet.skin import Skin
from trunnion.model.operation import Operation
from trunnion.plan.freeform.space import SurfaceSpace
from trunnion.plan.freeform.wall_curves import WallCurve, strip_before, wall_curves
from trunnion.plan.prismatic.drive import DriveLevel, PlaneDrive, WallGuide


def outline_drive(operation: Operation, space: SurfaceSpace) -> PlaneDrive:
    """Return the outline of the part from the foot of an operation's faces up, as walls along these faces up to their top; nothing of the
    part that is higher than their foot is within the level's boundary.

    Faces round a hole through the part there are walls too: a cutter stands free in it.
    """
    skin = space.skin
    z = skin.points[skin.triangles[skin.of(operation.faces)], 2]
    # Equal faces all round a wheel have the same heights but for noise, and then the same plan area.
    bottom, top = (
        round(float(h) / tolerance.COINCIDENT) * tolerance.COINCIDENT for h in (z.min(), z.max())
    )
    curves = wall_curves(skin, operation.faces)
    outline = _outline(space, curves, bottom)
    around, blank = space.around(), space.blank_area()
    level = DriveLevel(
        top=top, bottom=bottom, wanted=blank.minus(outline), boundary=around.minus(outline)
    )
    guides = [part for rim in outline.curves() for part in _along(rim.reversed(), curves)]
    return PlaneDrive(
        feature=operation.feature,
        kind=operation.kind,
        levels=(level,),
        walls=tuple(
            WallGuide(curve=curve, top=top, bottom=bottom, fillet=0.0, faces=operation.faces)
            for curve in guides
        ),
        stock_top=top,
        faces=operation.faces,
    )


def _outline(space: SurfaceSpace, curves: list[WallCurve], bottom: float) -> Region:
    """Return the plan area of the part above a height up to walls, holes in it filled but those that walls go round."""
    # What is no higher over the foot than this is not before the walls (`on_outline`).
    whole = space.plan_above(bottom + tolerance.SEW)
    found = whole.minus(strip_before(curves, 2.0 * _apart(space.skin)))
    open_holes = [
        Piece(hole.reversed())
        for piece in found.pieces
        for hole in piece.holes
        if _along(hole, curves)
    ]
    filled = found.holes_filled()
    if not open_holes:
        return filled
    holes = Region(tuple(open_holes))
    return filled.minus(holes).union(found.intersect(holes))


def _apart(skin: Skin) -> float:
    """Return how far in mm the plan area of triangles may stand out of the part."""
    return 2.0 * (skin.bound + LAP + EVEN)


def _along(curve: Curve, walls: list[WallCurve]) -> list[Curve]:
    """Return the parts of a closed curve that run along walls and end where these do; the curve itself where that is all of it."""
    near = tolerance.ON_REGION
    own = [part for wall in walls if (part := wall.shortened(near, walls)) is not None]

    def margin(points: Floats) -> Floats:
        return np.max([near - part.distance(points) for part in own], axis=0)

    return parts_where(curve, margin) if own else []
