"""Meridians of blanks and parts in the plane through the work's axis, as a turning setup sees them: r from the axis, z along it."""

from __future__ import annotations

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from trunnion import tolerance
from trunnion.findings import Refused
from trunnion.geometry.arrays import Floats
from trunnion.geometry.frame import Frame
from trunnion.model.blank import Blank, Revolved

SIMPLE = 2e-4
"""mm: points of a stock's meridian that lie off the line between their neighbours by less are left out."""


def seen_from(outline: Floats, frame: Frame, other: Frame) -> Floats:
    """Return an outline (k, 2) of r and z about a frame's z as it is about the z of another one on the same axis."""
    up = float(other.z @ frame.z)
    along = float(other.to_local(frame.origin)[2])
    return np.column_stack([outline[:, 0], along + np.sign(up) * outline[:, 1]])


def meridian_in(blank: Blank, frame: Frame) -> BaseGeometry:
    """Return the meridian of a blank of revolution about a setup's z; raise `Refused` for a blank that is none about it."""
    if not isinstance(blank, Revolved) or blank.axis != "z" or not on_one_axis(blank.frame, frame):
        raise Refused(
            "only a blank of revolution about the setup's z is turned: choose blank.kind = turned"
        )
    return shapely.Polygon(seen_from(blank.outline, blank.frame, frame))


def on_one_axis(frame: Frame, other: Frame) -> bool:
    """Return whether the z axes of two frames are one line."""
    away = other.to_local(frame.origin)[:2]
    across = float(np.linalg.norm(np.cross(frame.z, other.z)))
    return float(np.hypot(*away)) < tolerance.SLIVER and across < tolerance.ANGLE


def turned_to(blank: Revolved, frame: Frame, left: BaseGeometry) -> Revolved:
    """Return a blank with what is left of its meridian, which is given about a setup's z; of several pieces the largest."""
    parts = [p for p in shapely.get_parts(left) if p.geom_type == "Polygon"]
    kept = shapely.orient_polygons(max(parts, key=lambda p: p.area).simplify(SIMPLE))
    outline = seen_from(shapely.get_coordinates(kept.exterior)[:-1], frame, blank.frame)
    if float(frame.z @ blank.frame.z) < 0.0:
        outline = outline[::-1]
    return Revolved(
        frame=blank.frame,
        outline=np.maximum(outline, [0.0, -np.inf]),
        material=blank.material,
        density=blank.density,
    )
