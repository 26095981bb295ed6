"""What a turning tool reaches: the positions of its point at which nothing of it enters what must stand.

In the coordinates of `PassView` what must stand is closed downwards: a tool that is clear stays clear as it is lifted away from the work.
The positions that are forbidden are the Minkowski sum of what must stand and the tool turned about its point; they lie below a ceiling, and
the ceiling itself is the way of a finishing pass: nose radius and edges are in it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.model.tool import TurningTool
from trunnion.plan.turning.view import PassView, TurningSide
from trunnion.units import radians

DEEP = 1e4
"""mm: how far down what must stand is taken to go."""
TURNED_FREE = radians(2.0)
"""How far an insert is turned about its nose to either side for what it must keep clear of: its edges cut no wall that is as steep as they
are, they would rub."""
HOLDER_CLEARANCE = 0.5
"""mm that the holder is kept from what must stand."""
NOSE_CHORD, COARSE = 2e-4, 5e-3
"""mm: chord errors of the nose that paths are worked out with, and that stock is looked at with: what is left is at most so much more."""
ROUNDS = 4
"""Times that what the insert leaves is looked at again for the holder's sake: each round leaves more, and less of it is new."""
THINNEST, SAME_AREA = 0.05, 0.1
"""mm: stock thinner than twice this is in no holder's way; mm2: a ceiling that grows by less is the same."""
SHORT = 1e-6
"""mm: parts of an outline shorter than this along the feed are steep: they have no top."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TurningLimits:
    """Heights z mm in the setup's frame: nothing of the tool goes below `floor`, its point not below `lowest`."""

    floor: float
    lowest: float


@dataclass(frozen=True, eq=False, kw_only=True)
class TurningReach:
    """Where the point of a tool may be: above the ceiling (k, 2) of u and v, u growing, and at u between the two `ends`."""

    view: PassView
    tool: TurningTool
    ceiling: Floats
    ends: tuple[float, float]

    @cached_property
    def forbidden(self) -> BaseGeometry:
        """The positions below the ceiling."""
        first, last = self.ceiling[0], self.ceiling[-1]
        return shapely.Polygon([*self.ceiling, (last[0], -DEEP), (first[0], -DEEP)]).buffer(0.0)

    @cached_property
    def insert(self) -> Floats:
        """The insert (m, 2) as u and v from the point."""
        return self.view.seen(self.tool.insert_profile(NOSE_CHORD))

    @cached_property
    def coarse(self) -> Floats:
        """The insert in few points, nowhere larger."""
        return self.view.seen(self.tool.insert_profile(COARSE))

    @property
    def size(self) -> float:
        """How far the insert reaches from the point along u at most."""
        return float(np.abs(self.insert[:, 0]).max())

    def cut_from(self, stock: BaseGeometry) -> BaseGeometry:
        """Return what is left of stock (r, z) when the insert has been everywhere that it may be."""
        way = self.allowed_ceiling()
        if len(way) < 2:
            return stock
        swept = swept_upwards(self.coarse, way)
        left = self.view.shape_seen(stock).difference(swept)
        return self.view.shape_back(left)

    def allowed_ceiling(self) -> Floats:
        """Return the ceiling (k, 2) between the ends."""
        return self.between(*self.ends)

    def between(self, first: float, last: float) -> Floats:
        """Return the ceiling (k, 2) from one u to another, none where these are too close."""
        if last - first < SHORT:
            return np.zeros((0, 2))
        u, v = self.ceiling.T
        inner = self.ceiling[(u > first) & (u < last)]
        ends = np.interp([first, last], u, v)
        points = np.vstack([[first, ends[0]], inner, [last, ends[1]]])
        return points[changes(points)]

    def is_clear(self, way: Floats) -> bool:
        """Return whether the point may go straight from point to point (k, 2)."""
        inner = self.forbidden.buffer(-SHORT)
        return not shapely.intersects(shapely.LineString(way), inner)

    def intervals(self, level: float) -> list[tuple[float, float]]:
        """Return the stretches of u, in order, along which the point may go at a height v."""
        low, high = self.ends
        if high - low < SHORT:
            return []
        line = shapely.LineString([(low, level), (high, level)]).difference(self.forbidden)
        found = [shapely.get_coordinates(p)[:, 0] for p in shapely.get_parts(line)]
        return sorted(
            (float(u.min()), float(u.max())) for u in found if len(u) and np.ptp(u) > SHORT
        )


def reach_of(
    tool: TurningTool,
    side: TurningSide,
    part: BaseGeometry,
    limits: TurningLimits,
    stock: BaseGeometry,
    *,
    allowance: float = 0.0,
) -> TurningReach:
    """Return where a tool's point may be beside a part's meridian (r, z), which keeps an allowance (mm), to turn stock.

    Its holder keeps clear of the part and of what the insert leaves of the stock. Nowhere does the tool go down more steeply along its feed
    than the edge behind its nose allows, less what it is turned free by.
    """
    view = PassView.of(side, tool)
    grown = view.shape_seen(part)
    if allowance > 0.0:
        grown = grown.buffer(allowance, quad_segs=32)
    shapes = _shapes(view, tool)
    size = float(np.abs(np.vstack(shapes)[:, 0]).max())
    # Beyond its ends the part is taken to go on as high as it is there: passes run straight out.
    top = _prolonged(ceiling_of(grown)[1:-1], 3.0 * size)
    blocked = shapely.union_all([_blocked(top, shape) for shape in shapes])
    ends = _ends(view, np.vstack(shapes), limits, (top[0, 0] + 2.0 * size, top[-1, 0] - 2.0 * size))
    seen = view.shape_seen(stock)
    steepest = radians(tool.end_angle) - TURNED_FREE
    for _ in range(ROUNDS):
        ceiling = _eased(ceiling_of(blocked)[1:-1], steepest)
        if side is TurningSide.FACE:
            # Heights are v here: the ceiling itself is lifted to what the limits leave.
            lowest = float(np.vstack(shapes)[:, 1].min())
            least = max(limits.lowest, limits.floor - lowest)
            ceiling = np.column_stack([ceiling[:, 0], np.maximum(ceiling[:, 1], least)])
        reach = TurningReach(view=view, tool=tool, ceiling=ceiling, ends=ends)
        way = reach.allowed_ceiling()
        if len(way) > 1 and _in_stock(seen, reach.insert + way[0]):
            # Where the limits let a tool begin in the midst of stock only, it goes down into it from the top.
            walled = np.vstack([[ends[0], seen.bounds[3]], way])
            reach = replace(reach, ceiling=_eased(walled, steepest))
            way = reach.allowed_ceiling()
        left = seen.difference(swept_upwards(reach.coarse, way)) if len(way) > 1 else seen
        thick = left.buffer(-THINNEST)
        if thick.is_empty:
            break
        remaining_top = ceiling_of(thick)
        more = shapely.union_all(
            [blocked, *(_blocked(remaining_top, shape) for shape in shapes[1:])]
        )
        if more.area - blocked.area <= SAME_AREA:
            break
        blocked = more
    return reach


def _in_stock(stock: BaseGeometry, insert: Floats) -> bool:
    """Return whether an insert (m, 2) where it is enters stock by more than what is thin."""
    return bool(shapely.intersects(shapely.Polygon(insert), stock.buffer(-THINNEST)))


def _shapes(view: PassView, tool: TurningTool) -> list[Floats]:
    """Return what must keep clear, convex, as u and v about the point: the insert, turned a little, then head and shank, grown."""
    insert = view.seen(tool.insert_profile(NOSE_CHORD))
    holder = (_grown(view.seen(h), HOLDER_CLEARANCE) for h in tool.holder_profiles())
    return [_freed(insert, tool), *holder]


def _eased(ceiling: Floats, steepest: float) -> Floats:
    """Return a ceiling (k, 2) that nowhere falls by more than an angle (rad) as u grows."""
    slope = np.tan(max(steepest, 0.0))
    u, v = ceiling.T
    # v + slope u never falls along a ceiling that is gentle enough: its running maximum makes any one so.
    highest = np.maximum.accumulate(v + slope * u)
    eased = [[float(u[0]), float(v[0])]]
    for k in range(1, len(u)):
        line = highest[k - 1]
        if highest[k] <= line + SHORT:
            eased.append([float(u[k]), float(line - slope * u[k])])
            continue
        # Where the ceiling comes up through the slope: a corner of its own.
        v0, v1 = float(v[k - 1]), float(v[k])
        under = line - slope * u[k - 1] - v0
        rise = (v1 - v0) + slope * (u[k] - u[k - 1])
        if under > SHORT and rise > SHORT:
            share = under / rise
            eased.append([float(u[k - 1] + share * (u[k] - u[k - 1])), v0 + share * (v1 - v0)])
        eased.append([float(u[k]), v1])
    return np.array(eased)


def _ends(
    view: PassView, shape: Floats, limits: TurningLimits, widest: tuple[float, float]
) -> tuple[float, float]:
    """Return the least and the largest u that the point may have: past the work as far as `widest`, and within the limits."""
    low, high = (float(u) for u in widest)
    along = view.matrix[0]
    if along[1] < 0.0:
        # u is -z: going on lowers the tool, whose lowest place is where its u is largest.
        return low, min(high, -limits.lowest, -limits.floor - float(shape[:, 0].max()))
    if along[1] > 0.0:
        return max(low, limits.lowest, limits.floor - float(shape[:, 0].min())), high
    return low, high


def ceiling_of(shape: BaseGeometry) -> Floats:
    """Return the upper outline (k, 2) of shapes closed downwards, u growing; steep parts are two points above each other.

    What no shape lies under is as low as `DEEP`.
    """
    polygons = []
    for ring in (p.exterior for p in shapely.get_parts(shape) if p.geom_type == "Polygon"):
        a = shapely.get_coordinates(ring)
        rows = np.flatnonzero(np.abs(np.diff(a[:, 0])) > SHORT)
        low = np.full(len(rows), -DEEP)
        quads = np.stack(
            [
                a[rows],
                a[rows + 1],
                np.column_stack([a[rows + 1, 0], low]),
                np.column_stack([a[rows, 0], low]),
            ],
            axis=1,
        )
        polygons.append(shapely.union_all(shapely.polygons(quads)))
    closed = shapely.union_all(polygons)
    parts = sorted(
        (p for p in shapely.get_parts(closed) if p.geom_type == "Polygon"),
        key=lambda p: p.bounds[0],
    )
    found: list[Floats] = []
    for part in parts:
        ring = shapely.get_coordinates(shapely.orient_polygons(part).exterior)[:-1]
        upper = ring[:, 1] > -0.5 * DEEP
        # Anticlockwise the upper points follow each other from right to left.
        start = int(np.flatnonzero(upper & ~np.roll(upper, 1))[0])
        line = np.roll(ring, -start, axis=0)[: int(upper.sum())][::-1]
        found += [np.array([[line[0, 0], -DEEP]]), line, np.array([[line[-1, 0], -DEEP]])]
    return np.vstack(found)


def touching(stock: BaseGeometry, insert: Floats) -> BaseGeometry:
    """Return the positions at which an insert (m, 2) touches stock: their Minkowski sum, the insert turned about its point."""
    parts = [shapely.transform(stock, lambda p: p - insert[0])]
    for ring in shapely.get_rings(shapely.get_parts(stock)):
        a = shapely.get_coordinates(ring)
        parts.append(shapely.union_all(_hulls([a[:-1, None] - insert, a[1:, None] - insert])))
    return shapely.union_all(parts)


def swept_upwards(insert: Floats, way: Floats) -> BaseGeometry:
    """Return what an insert (m, 2) takes that goes along a way (k, 2), with all above it."""
    a, b = way[:-1, None] + insert, way[1:, None] + insert
    up = np.array([0.0, DEEP])
    return shapely.union_all(_hulls([a, b, a + up, b + up]))


def swept_along(insert: Floats, way: Floats) -> BaseGeometry:
    """Return what an insert (m, 2) takes that goes along a way (k, 2)."""
    return shapely.union_all(_hulls([way[:-1, None] + insert, way[1:, None] + insert]))


def _blocked(top: Floats, shape: Floats) -> BaseGeometry:
    """Return the Minkowski sum of what lies under a ceiling (k, 2) and a convex shape (m, 2) turned about the origin."""
    real = (top[:-1, 1] > -0.5 * DEEP) & (top[1:, 1] > -0.5 * DEEP)
    a, b = top[:-1][real][:, None] - shape, top[1:][real][:, None] - shape
    down = np.array([0.0, DEEP])
    return shapely.union_all(_hulls([a, b, a - down, b - down]))


def _hulls(points: list[Floats]) -> list[BaseGeometry]:
    """Return the convex hulls of points (n, m, 2) that several arrays hold together."""
    # As lines through the points, which are made five times as fast as points and have the same hulls.
    hulls = shapely.convex_hull(shapely.linestrings(np.concatenate(points, axis=1)))
    return [h for h in np.ravel(np.asarray(hulls, dtype=object)) if h is not None]


def _freed(insert: Floats, tool: TurningTool) -> Floats:
    """Return an insert with what it passes when it is turned a little about its nose, its edges' clearance."""
    nose = np.sign(insert.mean(axis=0)) * tool.insert.nose_radius
    parts = [insert]
    for angle in (-TURNED_FREE, TURNED_FREE):
        c, s = np.cos(angle), np.sin(angle)
        parts.append(nose + (insert - nose) @ np.array([[c, s], [-s, c]]))
    return _convex(np.vstack(parts))


def _grown(shape: Floats, clearance: float) -> Floats:
    """Return a convex shape grown all round."""
    corners = np.array([[-1, -1], [-1, 1], [1, 1], [1, -1]]) * clearance
    return _convex((shape[:, None] + corners).reshape(-1, 2))


def _convex(points: Floats) -> Floats:
    return shapely.get_coordinates(shapely.convex_hull(shapely.multipoints(points)))[:-1]


def _prolonged(line: Floats, by: float) -> Floats:
    """Return a line (k, 2) that goes on level at both ends, from the top of what is steep there."""
    ends = [
        [u + step, line[np.abs(line[:, 0] - u) < SHORT, 1].max()]
        for u, step in ((line[0, 0], -by), (line[-1, 0], by))
    ]
    return np.vstack(
        [ends[:1], [[line[0, 0], ends[0][1]]], line, [[line[-1, 0], ends[1][1]]], ends[1:]]
    )


def changes(points: Floats) -> np.ndarray:
    """Return which points (n,) differ from the one before."""
    step = np.linalg.norm(np.diff(points, axis=0), axis=1)
    return np.concatenate([[True], step > tolerance.COINCIDENT])
