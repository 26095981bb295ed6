"""Class 3: a side of the pocket (flange, rib) as the other side of a gap beside a boss.

The side is milled with the boss's direction there: the axis is taken from the boss that owns the restrict face, and between bosses it is
interpolated along the side.
"""

from __future__ import annotations

import numpy as np
import shapely

from trunnion.geometry.arrays import Floats
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.region import Region
from trunnion.plan.casing.uncut.throat import CHORD, Milled, _dense
from trunnion.recognize.casing.meridian import Meridian

BEYOND = 5.0
"""mm: how deep a wall counts as solid behind its face: more than any cutter enters it."""
FURTHER = 2.0
"""How much further than a boss, in its half widths, its wall is looked at on both sides."""
STEPS = 200


def milled_wall(
    boss: Milled,
    z: float,
    rise: float,
    up: bool,
    meridian: Meridian,
    radius: float,
    allowance: float,
    owner: str,
) -> Milled:
    """Return the wall at a height `z` (mm) beside a boss as a side of a gap, seen along the boss's direction.

    It rises `rise` mm from the ground; `up` says whether the wall is at the upper end of the bottom, its material above it.
    """
    angle = np.arctan2(boss.foot[:, 1], boss.foot[:, 0])
    middle = float(np.arctan2(boss.foot[:, 1].mean(), boss.foot[:, 0].mean()))
    half = float(np.abs((angle - middle + np.pi) % (2.0 * np.pi) - np.pi).max())
    along = middle + np.linspace(-FURTHER, FURTHER, STEPS) * half
    ground = float(meridian.radius(np.array([z]))[0])
    deep = BEYOND + 2.0 * radius

    def arc(at: Floats, r: float, height: float) -> Floats:
        return np.column_stack([r * np.cos(at), r * np.sin(at), np.full(len(at), height)])

    beyond = z + (deep if up else -deep)
    top = ground + meridian.outward * rise
    outer = [arc(along, r, h) for r in (ground, top) for h in (z, beyond)]
    parts = []
    for k in range(STEPS - 1):
        corners = np.vstack([o[k : k + 2] for o in outer])
        parts.append(shapely.MultiPoint(boss.flat(corners)).convex_hull)
    solid = shapely.union_all(parts)
    polygon = max(shapely.get_parts(solid), key=lambda g: g.area)
    area = Region.of([Curve.polygon(shapely.get_coordinates(polygon.exterior)[:-1])])
    around = polygon.buffer(radius + allowance, quad_segs=64).exterior
    return Milled(
        owner=owner,
        frame=boss.frame,
        area=area,
        axis=_dense(shapely.get_coordinates(around.simplify(CHORD)), True),
        foot=arc(along[np.abs(along - middle) <= half], ground, z),
        height=rise,
    )
