"""Plan curves of upright faces: exact at the corners of their triangles, arcs between them by the faces' own normals there."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import breadth_first_order

from trunnion import tolerance
from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.plane.arc_fitting import along_arcs, arcs_through
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.region import EMPTY_REGION, Region, union_all
from trunnion.geometry.sheet.skin import Skin

ENDS = 3.0
"""Widths of a strip that it goes on past free ends of its wall: what stands out of the part round an end is within that."""

VERTICAL = np.sin(np.radians(0.5))
"""Cosine of the angle from the tool's axis from which on a normal counts as level: the wall is upright then."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class WallCurve:
    """An upright face in plan: its curve, the material on the left; points (k, 2) on it in order, with outward unit normals (k, 2).

    The last point of a closed curve is not the first one again.
    """

    curve: Curve
    points: Floats
    normals: Floats

    def strip(self, width: float, others: list[WallCurve]) -> Region:
        """Return what lies within a width (mm) before the wall, longer past ends that no other wall turns into the free at."""
        outer = self.points + width * self.normals
        if self.curve.closed:
            return Region.of([self.curve, Curve.polygon(outer)])
        first, last = (self._past(end, width, others) * self._onwards(end) for end in (0, -1))
        inner = self.curve.points
        back = np.vstack([outer[-1:] + last, outer[::-1], outer[:1] + first])
        points = np.vstack([inner[:1] + first, inner, inner[-1:] + last, back])
        bulges = np.concatenate([[0.0], self.curve.bulges, np.zeros(len(back) + 1)])
        goes_on = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
        kept = goes_on > tolerance.COINCIDENT
        return Region.of([Curve(points[kept], bulges[kept], True)])

    def shortened(self, length: float, others: list[WallCurve]) -> Curve | None:
        """Return the curve without some mm at ends that no other wall meets; None where nothing is left of it."""
        curve = self.curve
        if curve.closed:
            return curve
        first, last = (0.0 if self._met(end, others) else length for end in (0, -1))
        if curve.length <= first + last + tolerance.SHORT_MOVE:
            return None
        return curve.split(first, curve.length - last)

    def _onwards(self, end: int) -> Floats:
        """Return the unit direction in which the wall would go on past its first (0) or last (-1) point."""
        x, y = self.normals[end]
        return np.array([-y, x]) if end else np.array([y, -x])

    def _past(self, end: int, width: float, others: list[WallCurve]) -> float:
        """Return how far past an end nothing of the part is before the wall that is none of its neighbour's (mm)."""
        length = ENDS * width
        for normal in self._met(end, others):
            if normal @ self._onwards(end) < -tolerance.PARAMETRIC:
                return 0.0
            # Round a corner as far as the strip is wide; where walls run into each other no farther than their strips part.
            turns = normal @ self.normals[end] < np.cos(tolerance.SMOOTH_JOIN)
            share = 1.0 if turns else max(float(normal @ self._onwards(end)), 0.0)
            length = min(length, share * width + tolerance.SHORT_MOVE)
        return length

    def _met(self, end: int, others: list[WallCurve]) -> list[Floats]:
        """Return the normals (2,) that other walls have where they begin or end at the first (0) or last (-1) point."""
        return [
            other.normals[theirs]
            for other in others
            if other is not self and not other.curve.closed
            for theirs in (0, -1)
            if np.linalg.norm(other.points[theirs] - self.points[end]) <= tolerance.SEW
        ]


def wall_curves(skin: Skin, tags: tuple[int, ...]) -> list[WallCurve]:
    """Return the plan curves of those of some faces that are upright, in the order of their tags."""
    found = [_of_face(skin, tag) for tag in tags if is_upright(skin, tag)]
    return [each for each in found if each is not None]


def is_upright(skin: Skin, tag: int) -> bool:
    """Return whether a face has the same plan curve at all its heights, but for what a finishing move may be off.

    One that leans or twists more has none that the side of a cutter could go along.
    """
    corners = np.unique(skin.triangles[skin.face == tag])
    if not len(corners) or np.abs(skin.normals[corners, 2]).max() >= VERTICAL:
        return False
    return _spread(skin.points[corners], skin.normals[corners]) <= tolerance.FINISH_GOUGE


def _spread(points: Floats, normals: Floats) -> float:
    """Return how far apart in mm the plan curves of a steep face, points and normals (k, 3) on it, may be at its several heights."""
    return float(np.abs(normals[:, 2]).max() * np.ptp(points[:, 2]))


def strip_before(curves: list[WallCurve], width: float) -> Region:
    """Return the plan area within a width (mm) before walls."""
    return union_all([each.strip(width, curves) for each in curves]) if curves else EMPTY_REGION


def _of_face(skin: Skin, tag: int) -> WallCurve | None:
    """Return the plan curve of an upright face; None where its plan is too short for one."""
    used, local = np.unique(skin.triangles[skin.face == tag], return_inverse=True)
    triangles = local.reshape(-1, 3)
    points, normals = skin.points[used, :2], skin.normals[used, :2]
    normals = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    along, around = _lengths(points, normals, triangles)
    order = _in_order(points, normals, along)
    points, normals = points[order], normals[order]
    if around and np.linalg.norm(points[-1] - points[0]) <= tolerance.SEW:
        points, normals = points[:-1], normals[:-1]
    if len(points) < 2:
        return None
    headings = np.column_stack([-normals[:, 1], normals[:, 0]])
    if around:
        points, headings = np.vstack([points, points[:1]]), np.vstack([headings, headings[:1]])
    within = tolerance.FITTED + _spread(skin.points[used], skin.normals[used])
    dense = along_arcs(points, headings)
    # Thirds of what is closed: an arc is no longer than half a circle, and a circle is made of three without a remainder.
    ends = np.linspace(0, len(dense) - 1, 4 if around else 2).astype(np.int64)
    parts = [arcs_through(dense[a : b + 1], within) for a, b in pairwise(ends.tolist())]
    bulges = np.concatenate([b for _, b in parts])
    kept = np.concatenate([p[:-1] for p, _ in parts])
    if around:
        return WallCurve(curve=Curve(kept, bulges, True), points=points[:-1], normals=normals)
    curve = Curve(np.vstack([kept, dense[-1:]]), np.append(bulges, 0.0), False)
    return WallCurve(curve=curve, points=points, normals=normals)


def _lengths(points: Floats, normals: Floats, triangles: Ints) -> tuple[Floats, bool]:
    """Return how far along the plan of an upright face each of its corners (v,) is, and whether the plan is closed."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    start, end = edges.T
    chord = points[end] - points[start]
    size = np.linalg.norm(chord, axis=1)
    middle = normals[start] + normals[end]
    heading = np.column_stack([-middle[:, 1], middle[:, 0]])
    step = np.where((chord * heading).sum(axis=1) >= 0.0, 1.0, -1.0) * size
    # The chord over the arc: both turn by half of what the normals at its ends do.
    turn = np.arccos(np.clip((normals[start] * normals[end]).sum(axis=1), -1.0, 1.0))
    step /= np.sinc(0.5 * turn / np.pi)
    links = coo_array((np.ones(2 * len(edges)), (np.append(start, end), np.append(end, start))))
    order, before = breadth_first_order(links.tocsr(), 0, directed=False)
    known = {(a, b): s for a, b, s in zip(start.tolist(), end.tolist(), step.tolist(), strict=True)}
    along = np.full(len(points), np.nan)
    along[order[0]] = 0.0
    for node in order[1:].tolist():
        last = int(before[node])
        forward = known.get((last, node))
        along[node] = along[last] + (-known[node, last] if forward is None else forward)
    off = np.abs(along[end] - along[start] - step)
    around = float(np.nanmax(off))
    if around > 0.5 * float(np.nanmax(size)) and around > tolerance.SEW:
        return np.mod(along, around), True
    reach = float(np.nanmax(along) - np.nanmin(along))
    first, last = int(np.nanargmin(along)), int(np.nanargmax(along))
    meets = np.linalg.norm(points[first] - points[last]) < tolerance.COINCIDENT
    return along, bool(meets and reach > tolerance.SEW)


def _in_order(points: Floats, normals: Floats, along: Floats) -> Ints:
    """Return the rows of points in the order of how far along they are, those left out that don't go on by more than `tolerance.SEW`."""
    kept: list[int] = []
    rows = np.argsort(along, kind="stable")
    rows = rows[np.isfinite(along[rows])]
    for row in rows.tolist():
        if not kept:
            kept.append(row)
            continue
        x, y = normals[kept[-1]]
        if (points[row] - points[kept[-1]]) @ np.array([-y, x]) > tolerance.SEW:
            kept.append(row)
    last = int(rows[-1])
    if len(kept) > 1 and kept[-1] != last:
        kept[-1] = last
    return np.array(kept)
