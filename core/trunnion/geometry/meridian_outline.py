"""The outline of what triangles sweep when they turn about an axis: a turned part's own meridian, recesses of its ends included.

Seen in the meridian plane (radius to the right, the axis upwards) a triangle lies inside the triangle of its corners, or nearer to the
axis: the distance from the axis is convex along a straight line. The outline goes round all of these triangles. Points of the part lie on
it exactly: what is between two of them is left to the chord error.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints

LINE = 1e-4
"""mm: a triangle that is flatter than this in the meridian is one of a surface of revolution, seen as lines."""
HALF_WIDTH = 1e-6
"""mm that such lines are made wide to each side, so that what they join has no gaps."""
ANGLES = np.array([0.3, 1.7, 2.9, 4.1, 5.3])
"""rad about the axis at which surfaces of revolution are looked at."""
ALIKE = 1e-5
"""Relative difference of area up to which two faces count as one that is repeated about the axis."""
OUTSIDE = 1e-3
"""mm outside of what rims enclose from which triangles are added to it."""
ON_OUTLINE = 1.5 * tolerance.CHORD
"""mm from the outline within which a point of the part lies on it: chords are that far off its arcs."""
SPACING = 0.05
"""mm between points of the outline at least, but for its corners: far more than they may be off it, so that it never crosses itself."""
SIMPLE, STRAIGHT = 3e-4, 1e-3
"""mm that points may lie off the line between their neighbours to be left out, before the part's own are taken in and after."""


def meridian_outline(points: Floats, triangles: Ints, face: Ints) -> Floats:
    """Return the outline (k, 2) in mm, anticlockwise, of what triangles (t, 3) of points (v, 3) sweep about z; `face` (t,) are their tags.

    Raises `ValueError` where it is in several pieces: the triangles are no connected part's.
    """
    meridian = np.column_stack([np.hypot(points[:, 0], points[:, 1]), points[:, 2]])
    corners = meridian[triangles]
    # What the rims of all faces enclose lies inside; beside it stand the triangles that bulge over them.
    thin = _some_around(points, triangles, face, _thin(corners))
    sides = np.vstack([_rims(points, triangles, face), _sides(triangles[thin])])
    outline = _filled(_lines(meridian[sides]))
    used = np.unique(triangles)
    beyond = np.zeros(len(points), dtype=bool)
    beyond[used] = _outside(outline, meridian[used])
    bulging = corners[beyond[triangles].any(axis=1)]
    if len(bulging):
        outline = _filled([outline, *_made(shapely.polygons(bulging[~_thin(bulging)]))])
    whole = [g for g in _polygons(outline) if g.area > LINE**2]
    if len(whole) != 1:
        raise ValueError(f"the meridian is in {len(whole)} pieces")
    ring = _polygons(shapely.orient_polygons(whole[0].simplify(SIMPLE)))[0].exterior
    return _through(ring, meridian[used])


def _rims(points: Floats, triangles: Ints, face: Ints) -> Ints:
    """Return the sides (s, 2) of triangles along the rims of faces; of faces that are
    equally large those of one: they are repeated about the axis, and what is not bulges."""
    side = points[triangles]
    area = 0.5 * np.linalg.norm(np.cross(side[:, 1] - side[:, 0], side[:, 2] - side[:, 0]), axis=1)
    row = np.unique(face, return_inverse=True)[1]
    whole = np.bincount(row, area)
    order = np.argsort(whole, kind="stable")
    new = np.diff(whole[order], prepend=-1.0) > ALIKE * whole[order]
    some = np.isin(row, order[new])
    sides = np.column_stack([np.tile(row[some], 3), np.sort(_sides(triangles[some]), axis=1)])
    found, count = np.unique(sides, axis=0, return_counts=True)
    return np.asarray(found[count == 1][:, 1:])


def _filled(shapes: Sequence[shapely.Geometry]) -> shapely.Geometry:
    """Return shapes together, without holes."""
    return shapely.union_all(
        [shapely.Polygon(g.exterior) for g in _polygons(shapely.union_all(shapes))]
    )


def _outside(outline: shapely.Geometry, points: Floats) -> Bools:
    wide = shapely.buffer(outline, OUTSIDE, quad_segs=1)
    shapely.prepare(wide)
    return ~shapely.contains_xy(wide, points)


def _some_around(points: Floats, triangles: Ints, face: Ints, rows: Bools) -> Bools:
    """Return those of some rows of triangles that `ANGLES` pass, and all of a face that none of them passes: the meridian of a surface of
    revolution is the same all around."""
    turned = points[:, :2] @ np.column_stack([np.cos(ANGLES), np.sin(ANGLES)]).T
    across = points[:, :2] @ np.column_stack([-np.sin(ANGLES), np.cos(ANGLES)]).T
    corner_across, ahead = across[triangles], turned[triangles].max(axis=1) > 0.0
    passed = (corner_across.min(axis=1) <= 0.0) & (corner_across.max(axis=1) >= 0.0) & ahead
    some = rows & passed.any(axis=1)
    return np.asarray(some | (rows & ~np.isin(face, np.unique(face[some]))))


def _sides(triangles: Ints) -> Ints:
    """Return the sides (3 t, 2) of triangles (t, 3)."""
    return np.vstack([triangles[:, [k, (k + 1) % 3]] for k in range(3)])


def _thin(corners: Floats) -> Bools:
    """Return which triangles (t, 3, 2) of the meridian are lines there."""
    sides = np.stack([corners[:, k] - corners[:, (k + 1) % 3] for k in range(3)], axis=1)
    longest = np.linalg.norm(sides, axis=2).max(axis=1)
    twice = np.abs(sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0])
    return np.asarray(twice <= LINE * longest)


def _lines(ends: Floats) -> list[shapely.Geometry]:
    """Return lines (s, 2, 2) of the meridian as thin polygons, each once: the same one comes from all around the axis."""
    ends = np.round(ends, 6)
    swapped = (ends[:, 0, 0] > ends[:, 1, 0]) | (
        (ends[:, 0, 0] == ends[:, 1, 0]) & (ends[:, 0, 1] > ends[:, 1, 1])
    )
    ends[swapped] = ends[swapped][:, ::-1]
    ends = np.unique(ends.reshape(-1, 4), axis=0).reshape(-1, 2, 2)
    ends = ends[np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) > HALF_WIDTH]
    lines = shapely.linestrings(ends)
    return _made(shapely.buffer(lines, HALF_WIDTH, cap_style="square", join_style="mitre"))


def _made(shapes: object) -> list[shapely.Geometry]:
    """Return an array of shapes as a list."""
    return [g for g in np.ravel(np.asarray(shapes, dtype=object)) if g is not None]


def _polygons(shape: shapely.Geometry) -> list[shapely.Polygon]:
    return [g for g in shapely.get_parts(shape) if isinstance(g, shapely.Polygon)]


def _through(ring: shapely.LinearRing, points: Floats) -> Floats:
    """Return a ring's corners and, between them in their order, those points (v, 2) that lie on it."""
    corners = np.asarray(ring.coords)[:-1]
    shapely.prepare(ring)
    near = points[shapely.dwithin(ring, shapely.points(points), ON_OUTLINE)]
    near = np.unique(np.round(near, 6), axis=0)
    at_corner = shapely.line_locate_point(ring, shapely.points(corners))
    at = shapely.line_locate_point(ring, shapely.points(near))
    order = np.argsort(np.concatenate([at_corner, at]), kind="stable")
    positions = np.concatenate([at_corner, at])[order]
    is_corner = (np.arange(len(positions)) < len(corners))[order]
    rows = np.vstack([corners, near])[order]
    kept: list[int] = []
    for k in range(len(rows)):
        if kept and not is_corner[k] and positions[k] - positions[kept[-1]] < SPACING:
            continue
        while (
            kept
            and is_corner[k]
            and not is_corner[kept[-1]]
            and positions[k] - positions[kept[-1]] < SPACING
        ):
            kept.pop()
        kept.append(k)
    while len(kept) > 1 and not is_corner[kept[-1]] and ring.length - positions[kept[-1]] < SPACING:
        kept.pop()
    plain = _polygons(shapely.Polygon(rows[kept]).simplify(STRAIGHT))[0]
    return np.asarray(plain.exterior.coords)[:-1]
