"""Plan areas of what triangles have above a height."""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import NDArray

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.region import EMPTY_REGION, Region

LAP, EVEN = 1e-3, 0.02
"""mm: how far pieces of an area lap over one another, and how far its rim is evened."""
TILE, MOST, FITS = 100.0, 200.0, 1e-9
"""Triangles that are joined at once, tiles along an area, and by what share of its area what is joined may be off."""
FEW = 8
"""Pieces that are not looked at in halves where they can't be joined."""


def plan_area_above(corners: Floats, z: float, grown: float = 0.0) -> Region:
    """Return the plan area of what triangles, corners (t, 3, 3), have above a height, each grown by some mm and the rim evened outwards.

    Of a closed mesh that is the plan area of all that it encloses there.
    """
    corners = corners[corners[:, :, 2].max(axis=1) > z]
    if not len(corners):
        return EMPTY_REGION
    whole = corners[:, :, 2].min(axis=1) >= z
    pieces = np.concatenate(
        [np.atleast_1d(shapely.polygons(corners[whole][:, :, :2])), _cut_off(corners[~whole], z)]
    )
    facing = np.concatenate([_signed_areas(corners[whole]), _signed_areas(corners[~whole])])
    is_thin = shapely.area(pieces) < tolerance.AREA
    area = _grown_union(tiled(pieces[~is_thin], facing[~is_thin] >= 0.0), grown + LAP)
    # Upright faces are lines seen from above, most of them on the rim of what is wide there.
    shapely.prepare(area)
    beside = pieces[is_thin]
    beside = beside[~shapely.covers(area, beside)]
    if len(beside):
        area = shapely.union(area, _grown_union(beside, grown + LAP))
    return region_of(
        shapely.simplify(shapely.buffer(area, EVEN, join_style="mitre", mitre_limit=2.0), EVEN)
    )


def _grown_union(pieces: NDArray[np.object_], grown: float) -> shapely.Geometry:
    """Return the union of pieces (n,), each grown by itself: then neighbours overlap, where they would only touch along edges that are not
    quite the same."""
    return shapely.union_all(shapely.buffer(pieces, grown, quad_segs=1))


def tiled(pieces: NDArray[np.object_], facing: Bools) -> NDArray[np.object_]:
    """Return plan areas (n,) of a mesh's triangles, none of them a line, with those that face one way (n,) and lie in one tile joined along
    the edges they share.

    That takes a small part of the time of a union. Where edges do not fit, or areas overlap, the area of what was joined says so, and the
    pieces stay as they are.
    """
    area, found = shapely.area(pieces), [pieces[:0]]
    for side in (True, False):
        mine = np.flatnonzero(facing == side)
        if not len(mine):
            continue
        middle = shapely.get_coordinates(shapely.centroid(pieces[mine]))
        low, size = middle.min(axis=0), np.ptp(middle, axis=0)
        edge = max(float(np.sqrt(np.prod(size) * TILE / len(mine))), float(size.max()) / MOST, LAP)
        column, row = np.floor((middle - low) / edge).astype(np.int64).T
        order = np.lexsort((row, column))
        ends = np.flatnonzero(np.diff(column[order]) | np.diff(row[order])) + 1
        for tile in np.split(order, ends):
            found += _joined_by_halves(pieces[mine[tile]], area[mine[tile]], middle[tile])
    return np.concatenate(found)


def _joined_by_halves(
    pieces: NDArray[np.object_], area: Floats, middle: Floats
) -> list[NDArray[np.object_]]:
    """Return pieces joined along shared edges, given their areas (n,) and middles (n, 2); where they can't be, those of each half are, and
    so on, down to `FEW`, which stay as they are: only pieces beside the place where edges do not fit are kept apart."""
    joined = _joined(pieces, float(area.sum()))
    if joined is not None:
        return [np.array([joined])]
    if len(pieces) <= FEW:
        return [pieces]
    order = np.argsort(middle[:, int(np.ptp(middle, axis=0).argmax())], kind="stable")
    return [
        one
        for half in np.array_split(order, 2)
        for one in _joined_by_halves(pieces[half], area[half], middle[half])
    ]


def _joined(pieces: NDArray[np.object_], area: float) -> shapely.Geometry | None:
    """Return pieces joined along shared edges; None where that is not all of their `area` (mm2), or no area at all."""
    try:
        joined = shapely.coverage_union_all(pieces)
    except shapely.errors.GEOSException:
        return None
    is_whole = abs(float(shapely.area(joined)) - area) <= FITS * area
    return joined if is_whole and bool(shapely.is_valid(joined)) else None


def _signed_areas(corners: Floats) -> Floats:
    """Return the signed plan areas (t,) of triangles (t, 3, 3), positive seen anticlockwise."""
    a, b = corners[:, 1, :2] - corners[:, 0, :2], corners[:, 2, :2] - corners[:, 0, :2]
    return np.asarray(0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]))


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


def _cut_off(corners: Floats, z: float) -> NDArray[np.object_]:
    """Return the plan of what each of some triangles (t, 3, 3), which all cross a height, has above it."""
    above = corners[:, :, 2] >= z
    # Beginning with the corner that is alone on its side of the height: the two edges beside it cross it.
    alone = np.where(above.sum(axis=1) == 1, np.argmax(above, axis=1), np.argmin(above, axis=1))
    order = (alone[:, None] + np.arange(3)) % 3
    first, second, third = np.moveaxis(np.take_along_axis(corners, order[:, :, None], axis=1), 1, 0)
    upper = np.take_along_axis(above, alone[:, None], axis=1)[:, 0]

    def crossing(other: Floats) -> Floats:
        # From the lower corner up in both triangles beside an edge: then they meet there to the last bit and can be joined.
        low, high = np.where(upper[:, None], other, first), np.where(upper[:, None], first, other)
        share = (z - low[:, 2]) / (high[:, 2] - low[:, 2])
        return np.asarray(low + share[:, None] * (high - low))

    one, two = crossing(second), crossing(third)
    tips = np.stack([first, one, two], axis=1)[upper, :, :2]
    rests = np.stack([one, second, third, two], axis=1)[~upper, :, :2]
    found = [np.asarray(shapely.polygons(p)) for p in (tips, rests) if len(p)]
    return np.asarray(shapely.convex_hull(np.concatenate(found or [np.empty(0, dtype=object)])))
