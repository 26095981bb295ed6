"""Classes 2 and 3: what a cutter leaves between two bosses, or between a boss and a side of its pocket.

Milling the sides of A, the cutter's axis is parallel to A's direction and runs along A's outline grown by r + a, as far as the cutter
does not cut B: as far as the axis stays r + a away from B's shadow along A's direction. A point between them is left when no such
position of A, and none of B, covers it. The piece on the ground that touches both feet, with the columns over it, is the throat.

Positions are points of the grown outlines, the ground is looked at on a grid; what the cutter's cylinder bounds is taken from the
distances, not from cells, so the arcs of the swept cutter are kept.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import contourpy
import numpy as np
import shapely
from scipy import ndimage
from scipy.spatial import cKDTree

from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.frame import Frame
from trunnion.geometry.plane.region import Region
from trunnion.plan.casing.bottoms import CasingBoss
from trunnion.plan.casing.uncut.boss_pieces import outline_region
from trunnion.plan.casing.uncut.piece import BETWEEN, UncutPiece
from trunnion.recognize.casing.foot import foot_curve
from trunnion.recognize.casing.meridian import Meridian

CELL = 0.5
"""mm: side of the cells of ground; what lies in a cell at the rim of a piece is taken by its share."""
LAYER = 1.0
"""mm: height of the layers over the ground, from one to the next of which a piece changes by a hundredth."""
STEP = 0.1
"""mm: distance of positions along a grown outline; a cutter of 10 mm between two of them is 0.0003 mm short."""
CHORD = 0.002
"""mm: chords of outlines and shadows."""
LEAST = 1e-3
"""mm3: smaller pieces are noise."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Milled:
    """One side of a gap: the frame that its sides are milled along (z), in the casing's frame; its plane `area`, the `axis` points (k, 2)
    that the cutter's axis runs through, and its `foot` (k, 3) on the ground."""

    owner: str
    frame: Frame
    area: Region
    axis: Floats
    foot: Floats
    height: float

    def flat(self, points: Floats) -> Floats:
        """Return points (k, 3) of the casing's frame in the plane across the direction (k, 2)."""
        return np.asarray(self.frame.to_local(points)[..., :2])


def milled_boss(boss: CasingBoss, meridian: Meridian, radius: float, allowance: float) -> Milled:
    """Return a boss as one side of a gap for a cutter of a radius with an allowance, mm."""
    area = outline_region(boss.outline)
    around = area.offset(radius + allowance)
    share = np.linspace(0.0, 1.0, 49)
    foot = np.vstack(
        [foot_curve(boss.outline, p, meridian, share, toe=False) for p in boss.outline.pieces]
    )
    return Milled(
        owner=boss.id,
        frame=boss.outline.frame,
        area=area,
        axis=np.vstack([_dense(c.sampled(CHORD), c.closed) for c in around.curves()]),
        foot=foot[np.isfinite(foot).all(axis=1)],
        height=boss.height,
    )


def _dense(points: Floats, closed: bool) -> Floats:
    """Return points along a polyline at most a step apart."""
    if closed:
        points = np.vstack([points, points[:1]])
    length = np.linalg.norm(np.diff(points, axis=0), axis=1)
    at = np.concatenate([[0.0], np.cumsum(length)])
    steps = np.linspace(0.0, at[-1], max(2, int(np.ceil(at[-1] / STEP)) + 1))
    return np.column_stack([np.interp(steps, at, points[:, k]) for k in (0, 1)])


def shadow(of: Milled, onto: Milled) -> shapely.Geometry:
    """Return the shadow of one side along the direction of the other: of its top, its foot, and the walls between them."""
    rim = np.vstack([c.sampled(CHORD) for c in of.area.curves()[:1]])
    top = of.frame.to_world(np.column_stack([rim, np.zeros(len(rim))]))
    parts: list[Any] = [shapely.Polygon(onto.flat(top)).buffer(0.0)]
    foot = _under(of, rim)
    low, high = onto.flat(foot), onto.flat(top)
    parts.append(shapely.Polygon(low).buffer(0.0))
    after = np.roll(np.arange(len(rim)), -1)
    walls = np.stack([low, high, high[after], low[after]], axis=1)
    parts += np.asarray(shapely.convex_hull(shapely.polygons(walls))).tolist()
    return shapely.union_all(parts)


def _under(of: Milled, rim: Floats) -> Floats:
    """Return the points of the foot under points of the rim (k, 2): the nearest in the plane across the direction."""
    tree = cKDTree(of.flat(of.foot))
    _, near = tree.query(rim)
    depth = of.frame.to_local(of.foot)[near, 2]
    return of.frame.to_world(np.column_stack([rim, depth]))


def free_positions(side: Milled, other: Milled, keep_off: float) -> Bools:
    """Return at which of its axis points (k,) a cutter that mills one side stays off the other by its radius and allowance, mm."""
    points = shapely.points(side.axis)
    return np.asarray(shapely.distance(shadow(other, side), points) >= keep_off - CHORD)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BottomGrid:
    """Cells of ground around two feet: angles (m,) and heights (n,), and which cells (m, n) lie between the feet."""

    theta: Floats
    z: Floats
    between: Bools
    meridian: Meridian

    @staticmethod
    def of(feet: tuple[Floats, Floats], meridian: Meridian) -> BottomGrid:
        """Return the cells within the convex hull of two feet on the unrolled ground."""
        both = np.vstack(feet)
        zero = float(np.arctan2(both[:, 1].mean(), both[:, 0].mean()))
        angle = (np.arctan2(both[:, 1], both[:, 0]) - zero + np.pi) % (2.0 * np.pi) - np.pi
        radius = float(meridian.radius(both[:, 2]).mean())
        theta = zero + np.arange(angle.min(), angle.max() + CELL / radius, CELL / radius)
        z = np.arange(both[:, 2].min(), both[:, 2].max() + CELL, CELL)
        hull = shapely.MultiPoint(np.column_stack([zero + angle, both[:, 2]])).convex_hull
        t, h = np.meshgrid(theta, z, indexing="ij")
        shapely.prepare(hull)
        return BottomGrid(
            theta=theta, z=z, between=shapely.contains_xy(hull, t, h), meridian=meridian
        )

    def points(self, above: float) -> Floats:
        """Return the points (m, n, 3) of the cells so far outward (mm) from the ground, away from the axis or to it."""
        t, h = np.meshgrid(self.theta, self.z, indexing="ij")
        r = self.meridian.radius(h) + self.meridian.outward * above
        return np.stack([r * np.cos(t), r * np.sin(t), h], axis=-1)

    def cell_area(self, above: float) -> Floats:
        """Return the area (n,) of a cell at each height across the radius, mm2."""
        r = self.meridian.radius(self.z) + self.meridian.outward * above
        return np.asarray(r * (self.theta[1] - self.theta[0]) * (self.z[1] - self.z[0]))


def pieces_between(
    a: Milled,
    b: Milled,
    meridian: Meridian,
    diameter: float,
    allowance: float = 0.0,
    number: int = BETWEEN,
) -> tuple[UncutPiece, ...]:
    """Return what a cutter of a diameter leaves between two sides of a gap: the pieces that touch both."""
    radius = 0.5 * diameter
    grid = BottomGrid.of((a.foot, b.foot), meridian)
    if not grid.between.any():
        return ()
    keep = radius + allowance
    free = free_positions(a, b, keep), free_positions(b, a, keep)
    if all(f.all() for f in free) and _clear(a, b) >= 2.0 * keep:
        return ()
    trees = [
        cKDTree(side.axis[mine]) if mine.any() else None
        for side, mine in zip((a, b), free, strict=True)
    ]
    sides = (a, b)

    def left(points: Floats) -> tuple[Floats, list[Floats]]:
        """Return how far points (k, 3) are inside what is left (mm, positive inside), and their distances from both sides."""
        inside = np.full(len(points), np.inf)
        away = []
        for side, tree in zip(sides, trees, strict=True):
            flat = side.flat(points)
            off = -side.area.signed_distance(flat)
            away.append(off)
            inside = np.minimum(inside, off - allowance)
            if tree is not None:
                inside = np.minimum(inside, tree.query(flat)[0] - radius)
        return inside, away

    ground = grid.points(0.0)
    floor = np.full(grid.between.shape, -CELL)
    floor[grid.between], away = left(ground[grid.between])
    labels, count = ndimage.label(floor > 0.0)
    near = 1.5 * CELL + allowance
    at_both = [set(labels[grid.between][d < near].tolist()) for d in away]
    height = min(a.height, b.height)
    layers = max(1, int(np.ceil(height / LAYER)))
    clears = max(0.0, _clear(a, b) - 2.0 * allowance) if count else 0.0
    made = []
    for k in sorted(set(range(1, count + 1)) & at_both[0] & at_both[1]):
        mine = ndimage.binary_dilation(labels == k) & grid.between
        on_floor = np.clip(floor[mine] / CELL + 0.5, 0.0, 1.0)
        row = np.nonzero(mine)[1]
        volume = 0.0
        for n in range(layers):
            above = (n + 0.5) * height / layers
            share = np.clip(left(grid.points(above)[mine])[0] / CELL + 0.5, 0.0, 1.0)
            volume += float(
                (np.minimum(share, on_floor) * grid.cell_area(above)[row]).sum() * height / layers
            )
        made.append(
            UncutPiece(
                number=number,
                owners=(a.owner, b.owner),
                cutter=diameter,
                area=float((on_floor * grid.cell_area(0.0)[row]).sum()),
                volume=volume,
                boundary=_boundary(grid, np.where(mine, floor, -CELL)),
                clears=clears,
                end_lines=_end_lines(a, free[0], height) + _end_lines(b, free[1], height),
            )
        )
    return tuple(p for p in made if p.volume > LEAST)


def _clear(a: Milled, b: Milled) -> float:
    """Return the width (mm) of a gap as a cutter along either side's direction sees it, the smaller of the two."""
    return min(
        float(shapely.Polygon(side.area.curves()[0].sampled(CHORD)).distance(shadow(other, side)))
        for side, other in ((a, b), (b, a))
    )


def _boundary(grid: BottomGrid, inside: Floats) -> Floats:
    """Return the outline (k, 3) of the largest area on the ground where a field (m, n) is positive."""
    padded = np.pad(inside, 1, constant_values=-CELL)
    lines: list[Any] = list(contourpy.contour_generator(z=padded).lines(0.0))
    if not lines:
        return np.zeros((0, 3))
    longest = np.asarray(max(lines, key=len), dtype=np.float64)
    theta = np.interp(longest[:, 1] - 1.0, np.arange(len(grid.theta)), grid.theta)
    z = np.interp(longest[:, 0] - 1.0, np.arange(len(grid.z)), grid.z)
    r = grid.meridian.radius(z)
    return np.column_stack([r * np.cos(theta), r * np.sin(theta), z])


def _end_lines(side: Milled, free: Bools, height: float) -> tuple[tuple[Floats, Floats], ...]:
    """Return the cutter's generators through its contact with a side at the boundary points, where its way along that side ends."""
    ends = np.flatnonzero(free & ~(np.roll(free, 1) & np.roll(free, -1)))
    polygon = shapely.Polygon(side.area.curves()[0].sampled(CHORD))
    lines = []
    for n in ends:
        point = side.axis[n]
        contact = shapely.get_coordinates(
            shapely.shortest_line(polygon.exterior, shapely.Point(point))
        )[0]
        top = side.frame.to_world(np.array([contact[0], contact[1], 0.0]))
        lines.append((top - height * side.frame.z, top))
    return tuple(lines)
