"""Plane drives of upright walls that stand free: along the outline that the part makes from their foot up.

The outline is what the part's sections make, exact where walls are upright. Where what lies between the sections stands out of them (a
blade that twists or leans), it is the plan area of the part's triangles there, which is nowhere smaller than the part's.
"""

from __future__ import annotations

import numpy as np
import shapely

from trunnion import tolerance
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.curve_parts import parts_where
from trunnion.geometry.plane.plan_area import EVEN, LAP, region_of
from trunnion.geometry.plane.region import EMPTY_REGION, Region, union_all
from trunnion.geometry.sheet.skin import Skin
from trunnion.model.operation import Operation
from trunnion.plan.freeform.reach import samples_on
from trunnion.plan.freeform.space import SurfaceSpace
from trunnion.plan.prismatic.drive import DriveLevel, PlaneDrive, WallGuide

SECTIONS, OVER = (3, 5, 9, 17, 33), 4
"""Sections over the height of the walls, as few as do, and from there up to the part's top, both ends included."""
FEW = 400
"""Positions on walls that say whether sections have all of their plan."""
QUARTER = 2
"""Sides of a quarter circle: how round the ends of a strip a few hundredths of a millimetre wide are."""


def outline_drive(operation: Operation, space: SurfaceSpace) -> PlaneDrive:
    """Return the outline of the part from the foot of an operation's faces up, as walls along these faces up to their top; nothing of the
    part that is higher than their foot is within the level's boundary."""
    skin = space.skin
    z = skin.points[skin.triangles[skin.of(operation.faces)], 2]
    bottom, top = float(z.min()), float(z.max())
    outline = _outline(space, operation.faces, bottom, top)
    around, blank = space.around(), space.blank_area()
    level = DriveLevel(
        top=top, bottom=bottom, wanted=blank.minus(outline), boundary=around.minus(outline)
    )
    guides = [
        part
        for piece in outline.pieces
        for part in _along(piece.outer.reversed(), skin, operation.faces)
    ]
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


def _outline(space: SurfaceSpace, tags: tuple[int, ...], bottom: float, top: float) -> Region:
    """Return the plan area of the part above a height, its sections' where that is all of it; along upright faces it is always theirs."""
    skin = space.skin
    # Equal faces all round a wheel have the same heights but for noise, and then the same sections.
    bottom, top = (round(z / tolerance.COINCIDENT) * tolerance.COINCIDENT for z in (bottom, top))
    outline = _of_sections(space, tags, bottom, top)
    whole = space.plan_above(bottom + tolerance.OFF_PLANE)
    apart = _apart(skin)
    beyond = whole.minus(outline.offset(apart))
    if not beyond:
        return outline
    # What is grown stands out of the walls a little: there their sections say where they are.
    walls = region_of(shapely.buffer(_plan_of(skin, tags), 2.0 * apart, quad_segs=QUARTER))
    overhang = beyond.offset(2.0 * apart).intersect(whole).minus(walls)
    return outline.union(overhang).holes_filled()


def _of_sections(space: SurfaceSpace, tags: tuple[int, ...], bottom: float, top: float) -> Region:
    """Return what sections of the part above a height make together: so many over the height of upright faces, which end at `top`, that
    all of the faces' plan is on its rim."""
    skin, margin = space.skin, tolerance.OFF_PLANE
    highest = float(skin.points[:, 2].max())
    over = [*np.linspace(top, highest, OVER)[1:-1], highest - margin]
    on_walls = samples_on(skin, tags, FEW).point[:, :2]
    outline = EMPTY_REGION
    for count in SECTIONS:
        heights = [*np.linspace(bottom + margin, top - margin, count), *over]
        sections = [
            space.part.section(space.frame, h).holes_filled()
            for h in heights
            if bottom < h < highest
        ]
        outline = union_all([s for s in sections if s]).holes_filled()
        if outline and (np.abs(outline.signed_distance(on_walls)) <= _apart(skin)).all():
            break
    return outline


def _apart(skin: Skin) -> float:
    """Return how far in mm the plan area of triangles may stand out of sections that have all of the part."""
    return 2.0 * (skin.bound + LAP + EVEN)


def _plan_of(skin: Skin, tags: tuple[int, ...]) -> shapely.Geometry:
    """Return the edges of faces' triangles in plan."""
    corners = skin.points[skin.triangles[skin.of(tags)], :2]
    return shapely.multilinestrings(list(np.concatenate([corners, corners[:, :1]], axis=1)))


def _along(curve: Curve, skin: Skin, tags: tuple[int, ...]) -> list[Curve]:
    """Return the parts of a closed curve that run along the plan of upright faces; the curve itself where that is all of it."""
    plan, near = _plan_of(skin, tags), _apart(skin)
    shapely.prepare(plan)
    return parts_where(
        curve, lambda points: np.asarray(near - shapely.distance(shapely.points(points), plan))
    )
