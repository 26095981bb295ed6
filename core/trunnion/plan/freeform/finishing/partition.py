"""Parts of faces near certain places as areas of their own, with rims that passes can follow: a rim is a level line of a distance, drawn
through triangles that are parted along it, and narrow necks and bays are filled."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from scipy.spatial import cKDTree

from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.plane.region import Region
from trunnion.geometry.sheet.refine_sheet import in_mm, split_finely, split_where
from trunnion.geometry.sheet.sheet import Sheet, edges_of, sheet_of
from trunnion.geometry.sheet.skin import Skin
from trunnion.progress import NO_PROGRESS, Progress

FILLED = 1.0
"""Of the width around positions: what is narrower than twice this between two parts of the area belongs to it, and no bay of its rim is
rounder."""
FINENESS = 0.5
"""Of that width: the longest edge of the triangles that the rim is drawn through."""
COARSER = 4.0
"""By how much edges get shorter in each step down to that."""
ENOUGH = 50_000
"""Triangles of faces whose rim is looked for: with more of them they get no finer, and the rim is as exact as they are."""
DENSE = 0.5
"""Of a triangle's longest side: how far any place of it is at most from one that is queried."""
NEAR_END = 0.05
"""Share of an edge: how near its ends the rim crosses it at most."""
BETWEEN = 0.25
"""Of a triangle's longest side: how far a position of its sides is from the nearest that is queried."""
WITHIN, ACROSS = 2.0, 0.01
"""mm: the longest edge of triangles that are parted at the rim of a plan area; and how far a face may run out of it unparted."""
PART = 1_000_000
"""Added to a face's tag for a part of it: more than any part has faces."""


def parted_near(
    skin: Skin,
    tags: tuple[int, ...],
    over: Callable[[Floats, Floats], Floats],
    around: float,
    longest: float = 0.0,
    progress: Progress = NO_PROGRESS,
    everywhere: bool = False,
) -> tuple[Skin, tuple[int, ...]]:
    """Return the skin with what of faces lies within `around` mm of certain places given tags of its own, and those tags.

    `over` says for positions (p, 3) with outward unit normals (p, 3) how much (p,) there is of what it is about: positions above nothing
    count. With `longest` mm the faces as a whole get triangles with such edges: what is not near hangs together as it did. Without it only
    what is near gets finer ones, and triangles beside it no longer share all their corners with it. With both, places are looked for
    `everywhere` on these finer triangles: they may lie within one of the skin's.
    """
    rows = np.flatnonzero(skin.of(tags))
    position, normal, of = progress.aside(lambda _: _positions(skin, rows), "Parting the faces")
    certain = over(position, normal) > 0.0
    near = rows[
        progress.aside(lambda _: _with_those_near(position, of, certain, (1.0 + FILLED) * around))
    ]
    if not (len(near) or everywhere):
        return skin, ()
    if longest > 0.0:
        near = rows
    face = skin.face.copy()
    face[near] += PART
    whole = sheet_of(replace(skin, face=face), tuple(int(t) for t in np.unique(face[near])))
    if longest > 0.0:
        fine = progress.aside(lambda own: split_finely(whole, in_mm, longest, own))
    else:
        fine = _fine_at_rim(whole, over, around, progress)
    above = over(fine.points, fine.normals)
    if everywhere and not (above > 0.0).any():
        return skin, ()
    inside, outside = progress.aside(lambda _: _cut(fine, _past_rim(fine, above, around)))
    kept = np.setdiff1d(np.arange(len(face)), near)
    found = _with_parts(skin, kept, (inside, 0), (outside, PART))
    return found, tuple(int(t) for t in np.unique(inside.face))


def with_shorter_edges(
    skin: Skin, tags: tuple[int, ...], longest: float, progress: Progress = NO_PROGRESS
) -> Skin:
    """Return the skin with triangles of faces whose edges are no longer than `longest` mm."""
    rows = np.flatnonzero(skin.of(tags))
    corners = skin.points[skin.triangles[rows]]
    sides = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2)
    if not len(rows) or float(sides.max()) <= longest:
        return skin
    whole = sheet_of(skin, tags)
    fine = progress.aside(lambda own: split_finely(whole, in_mm, longest, own))
    return _with_parts(skin, np.setdiff1d(np.arange(len(skin.face)), rows), (fine, 0))


def parted_within(skin: Skin, tags: tuple[int, ...], area: Region) -> tuple[Skin, tuple[int, ...]]:
    """Return the skin with what of faces lies within a plan area given tags of its own where a face runs out of it, and the tags of
    all that is within."""
    rows = np.flatnonzero(skin.of(tags))
    outside = ~area.contains(skin.points[skin.triangles[rows]].reshape(-1, 3)[:, :2], -ACROSS)
    crossing = np.unique(skin.face[rows][outside.reshape(-1, 3).any(axis=1)])
    if not len(crossing):
        return skin, tags
    some = tuple(int(t) for t in crossing)
    face = skin.face.copy()
    mine = np.isin(face, crossing)
    face[mine] += PART
    fine = split_finely(
        sheet_of(replace(skin, face=face), tuple(t + PART for t in some)), in_mm, WITHIN
    )
    inside, beyond = _cut(fine, area.signed_distance(fine.points[:, :2]))
    found = _with_parts(skin, np.flatnonzero(~mine), (inside, 0), (beyond, PART))
    parts = tuple(int(t) for t in np.unique(inside.face))
    return found, (*(t for t in tags if t not in some), *parts)


def _fine_at_rim(
    sheet: Sheet, over: Callable[[Floats, Floats], Floats], around: float, progress: Progress
) -> Sheet:
    """Return a sheet with fine triangles where the rim `around` certain places may be: what is all certain stays as it is, and so does what
    none is near.

    Triangles get there by steps, each of which knows better than the one before where that is: walls are long, what is left at their foot
    is narrow.
    """
    reach, finest = (1.0 + FILLED) * around, FINENESS * around
    step = float(_lengths(sheet).max(initial=finest))
    while step > finest and len(sheet.triangles) < ENOUGH:
        position, normal, _ = progress.aside(partial(_positions_on, sheet), "Parting the faces")
        certain = over(position, normal) > 0.0
        if not certain.any() or certain.all():
            break
        before, step = step, max(step / COARSER, finest)
        near = _NearRim(
            cKDTree(position[certain]), cKDTree(position[~certain]), reach, DENSE * before
        )
        sheet = progress.aside(partial(split_where, sheet, near.holds, step))
    return sheet


def _positions_on(sheet: Sheet, _: Progress) -> tuple[Floats, Floats, Ints]:
    """Return `_positions` of all triangles of a sheet."""
    return _positions(sheet, np.arange(len(sheet.triangles)))


@dataclass(frozen=True, slots=True, eq=False)
class _NearRim:
    """Positions on faces that are certain places and such as are none, how far in mm from the former a rim may be, and how dense they are:
    the distance in mm from any place to the next of them."""

    certain: cKDTree
    other: cKDTree
    reach: float
    dense: float

    def holds(self, middle: Floats, length: Floats) -> Bools:
        """Return which edges (k,), given by their middles (k, 3) and lengths (k,), may be near a rim."""
        wide = self.dense + 0.5 * length
        inside, outside = (
            tree.query(
                middle, distance_upper_bound=float(np.nextafter(limit.max(initial=0.0), np.inf))
            )[0]
            <= limit
            for tree, limit in ((self.certain, self.reach + wide), (self.other, wide))
        )
        return np.asarray(inside & outside)


def _lengths(sheet: Sheet) -> Floats:
    """Return the lengths (e,) in mm of a sheet's edges."""
    a, b = sheet.points[sheet.edges()[0]].transpose(1, 0, 2)
    return np.asarray(np.linalg.norm(b - a, axis=1))


def _with_parts(skin: Skin, kept: Ints, *parts: tuple[Sheet, int]) -> Skin:
    """Return a skin of the triangles that are kept (k,) and of sheets, each with what was added to the tags that its faces get back."""
    points, normals, triangles, tag = (
        [skin.points],
        [skin.normals],
        [skin.triangles[kept]],
        [skin.face[kept]],
    )
    for part, added in parts:
        triangles.append(part.triangles + sum(len(p) for p in points))
        points.append(part.points)
        normals.append(part.normals)
        tag.append(part.face - added)
    return replace(
        skin,
        points=np.concatenate(points),
        normals=np.concatenate(normals),
        triangles=np.concatenate(triangles),
        face=np.concatenate(tag),
    )


def _past_rim(sheet: Sheet, over: Floats, around: float) -> Floats:
    """Return for a sheet's points how far (v,) mm they are inside the rim, negative outside: `around` mm past where the values `over`
    (v,) are above nothing, bays and necks filled."""
    bay = FILLED * around
    away = _distance(sheet, over, around + bay)
    inside = _distance(sheet, away - around - bay, bay)
    return inside - bay


def _distance(sheet: Sheet, value: Floats, most: float) -> Floats:
    """Return how far (v,) mm a sheet's points are from where values (v,) are above nothing; infinite where these are nowhere, and where
    they are more than an edge farther than `most`: no edge that crosses the line at `most` ends there."""
    above = value > 0.0
    if not above.any():
        return np.full(len(value), np.inf)
    ends = sheet.edges()[0]
    longest = float(_lengths(sheet).max())
    ends = ends[above[ends[:, 0]] != above[ends[:, 1]]]
    border = sheet.on_edges(ends, _crossing(value, ends))[0]
    tree = cKDTree(np.concatenate([sheet.points[above], border]))
    found = np.asarray(tree.query(sheet.points, distance_upper_bound=most + 1.01 * longest)[0])
    found[above] = 0.0
    return found


def _crossing(value: Floats, ends: Ints) -> Floats:
    """Return the share of the distance along edges (k, 2) where values (v,) of different signs are nothing; the middle where one is
    infinite."""
    a, b = value[ends].T
    even = np.isfinite(a) & np.isfinite(b)
    return np.where(even, np.divide(a, a - b, out=np.full(len(a), 0.5), where=even & (a != b)), 0.5)


def _cut(sheet: Sheet, inside: Floats) -> tuple[Sheet, Sheet]:
    """Return what of a sheet is inside and what outside of the line on which values (v,) of its points are nothing."""
    ends, side = sheet.edges()
    isin = inside >= 0.0
    crossed = np.flatnonzero(isin[ends[:, 0]] != isin[ends[:, 1]])
    parted, _ = sheet.parted(
        ends, side, crossed, np.clip(_crossing(inside, ends[crossed]), NEAR_END, 1.0 - NEAR_END)
    )
    # New points are on the line: the others of a triangle are all on one side of it.
    signs = np.concatenate([np.where(isin, 1, -1), np.zeros(len(crossed), np.int64)])
    within = signs[parted.triangles].sum(axis=1) > 0
    return parted.of(within), parted.of(~within)


def _positions(skin: Skin | Sheet, rows: Ints) -> tuple[Floats, Floats, Ints]:
    """Return positions (p, 3) on triangles, the faces' unit normals there, and which of them (k, 7) are the corners, the middles of the
    sides and the middle of each triangle: what a cutter leaves beside a rim may be narrower than a triangle."""
    used, corners = np.unique(skin.triangles[rows], return_inverse=True)
    corners = corners.reshape(-1, 3)
    ends, side = edges_of(corners, len(used))
    parts = [
        (x, x[ends].mean(axis=1), x[corners].mean(axis=1))
        for x in (skin.points[used], skin.normals[used])
    ]
    position, normal = (np.concatenate(part) for part in parts)
    of = np.column_stack([corners, len(used) + side, len(used) + len(ends) + np.arange(len(rows))])
    return position, normal / np.linalg.norm(normal, axis=1, keepdims=True), of


def _with_those_near(position: Floats, of: Ints, certain: Bools, around: float) -> Bools:
    """Return which triangles, with positions (k, 7) of all (p, 3), come as near as that to a certain position (p,): wide ones may between
    theirs."""
    if not certain.any():
        return np.zeros(len(of), dtype=bool)
    corners = position[of[:, :3]]
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    limit = around + BETWEEN * longest
    farthest = np.nextafter(limit.max(), np.inf)
    away = np.asarray(cKDTree(position[certain]).query(position, distance_upper_bound=farthest)[0])
    return np.asarray(away[of].min(axis=1) <= limit)
