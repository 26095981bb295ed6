"""Plan areas of what triangles have above a height."""

from __future__ import annotations

import numpy as np
import shapely

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.region import EMPTY_REGION, Region

LAP, EVEN = 1e-3, 0.02
"""mm: how far pieces of an area lap over one another, and how far its rim is evened."""


def plan_area_above(corners: Floats, z: float, grown: float = 0.0) -> Region:
    """Return the plan area of what triangles, corners (t, 3, 3), have above a height, each grown by some mm and the rim evened outwards.

    Of a closed mesh that is the plan area of all that it encloses there.
    """
    corners = corners[corners[:, :, 2].max(axis=1) > z]
    if not len(corners):
        return EMPTY_REGION
    whole = corners[:, :, 2].min(axis=1) >= z
    pieces = np.concatenate(
        [
            np.atleast_1d(shapely.polygons(corners[whole][:, :, :2])),
            [shapely.convex_hull(shapely.MultiPoint(_above(c, z))) for c in corners[~whole]],
        ]
    )
    # Each is grown by itself: then neighbours overlap, where they would only touch along an edge that is none the same.
    area = shapely.union_all(shapely.buffer(pieces, grown + LAP, quad_segs=1))
    return region_of(
        shapely.simplify(shapely.buffer(area, EVEN, join_style="mitre", mitre_limit=2.0), EVEN)
    )


def region_of(area: shapely.Geometry) -> Region:
    """Return a shapely area of straight edges as a region; what is smaller than noise is left out."""
    curves = []
    for polygon in shapely.get_parts(area):
        if polygon.geom_type == "Polygon" and polygon.area > tolerance.AREA:
            curves += [
                Curve.polygon(np.asarray(ring.coords)[:-1])
                for ring in (polygon.exterior, *polygon.interiors)
                if shapely.Polygon(ring).area > tolerance.AREA
            ]
    return Region.of(curves)


def _above(corners: Floats, z: float) -> Floats:
    """Return the plan (k, 2) of what of a triangle (3, 3) is above a height."""
    found = []
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        if a[2] >= z:
            found.append(a[:2])
        if (a[2] >= z) != (b[2] >= z):
            found.append(a[:2] + (z - a[2]) / (b[2] - a[2]) * (b - a)[:2])
    return np.array(found).reshape(-1, 2)
