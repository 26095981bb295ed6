"""What is left of a part's surroundings when all that turning reaches is turned: the outline that its points sweep about an axis.

From outside a turning tool comes as close to the axis as the farthest point of the part at each height lets it, from inside as far as the
nearest one. Faces of revolution lie in that outline exactly where nothing stands out of them.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import shapely

from trunnion.geometry.arrays import Bools, Floats, Ints, items_of
from trunnion.tolerance import CHORD, COINCIDENT

STEP = 2.0
"""mm between heights where what is no face of revolution is looked at: a boss stands free of its envelope by no more along the axis."""
SHARES = (0.0, 0.25, 0.5, 0.75, 1.0)
"""Where on an edge it is compared with the round faces."""
EVEN = 1.0
"""mm that the rings which stand for bosses may be wider than what turning could leave."""
DECIMALS = 6
"""Decimals of a height in mm to which points of a face are at one height."""


def turned_state(
    points: Floats, triangles: Ints, face: Ints, round_faces: Ints, straight_faces: Ints
) -> Floats:
    """Return the outline (k, 2) of radius and height, anticlockwise, that all triangles (t, 3) of points (v, 3) sweep about z.

    face (t,) are tags; those of `round_faces` are of revolution about z, and have a straight meridian when in `straight_faces`. The outline
    is exact on them, elsewhere nowhere inside of the part. What is closed to straight cuts from outside and inside stays filled.
    """
    pieces = [
        _meridian(points[triangles[face == tag]].reshape(-1, 3), tag in straight_faces)
        for tag in round_faces.tolist()
    ]
    exact = np.vstack([np.zeros((0, 4)), *pieces])
    others = points[triangles[~np.isin(face, round_faces)]]
    heights = points[np.unique(triangles), 2]
    level = _levels(exact, float(heights.min()), float(heights.max()))
    outer, inner = _limits(exact, others, level)
    rows = np.arange(len(level) - 1)
    out = np.column_stack([outer.ravel(), np.column_stack([level[rows], level[rows + 1]]).ravel()])
    back = np.column_stack([inner.ravel(), np.column_stack([level[rows], level[rows + 1]]).ravel()])
    return _straightened(np.vstack([out, back[::-1]]))


def _meridian(points: Floats, is_straight: bool) -> Floats:
    """Return the pieces (k, 4) of a round face's meridian: heights z0 < z1 and the radii there. A level face has none."""
    first = np.unique(points[:, 2].round(DECIMALS), return_index=True)[1]
    radius = np.hypot(points[first, 0], points[first, 1])
    exact = points[first, 2]
    if is_straight:
        exact, radius = exact[[0, -1]], radius[[0, -1]]
    ends = [(a, b, p, q) for (a, b), (p, q) in zip(pairwise(exact), pairwise(radius), strict=True)]
    return np.array([e for e in ends if e[1] - e[0] > COINCIDENT]).reshape(-1, 4)


def _levels(exact: Floats, low: float, high: float) -> Floats:
    """Return heights from low to high: the ends of the exact pieces, and steps between them."""
    ends = np.unique(np.concatenate([[low, high], exact[:, 0], exact[:, 1]]))
    ends = ends[np.diff(ends, prepend=-np.inf) > COINCIDENT]
    found = [
        np.linspace(a, b, max(2, int(np.ceil((b - a) / STEP - COINCIDENT)) + 1))[:-1]
        for a, b in pairwise(ends)
    ]
    return np.concatenate([*found, ends[-1:]])


def _limits(exact: Floats, others: Floats, level: Floats) -> tuple[Floats, Floats]:
    """Return the largest and the least radius at both ends of each span between levels, (k, 2) each."""
    outer, inner = _exact_limits(exact, level)
    before, bore = outer.copy(), inner.copy()
    sides = np.vstack([others[:, [k, (k + 1) % 3]] for k in range(3)])
    high = sides[~_keeps_to(sides, level, before, 1.0)]
    low = sides[~_keeps_to(sides, level, bore, -1.0)]
    _take_edges(high[:, 0], high[:, 1], level, outer, bore.copy())
    _take_edges(low[:, 0], low[:, 1], level, before.copy(), inner)
    # What stands out of the round faces in neighbouring spans becomes one even ring.
    proud = np.asarray((outer > before + COINCIDENT).all(axis=1))
    edges = np.flatnonzero(np.diff(np.concatenate([[False], proud, [False]]).astype(np.int64)))
    for first, last in edges.reshape(-1, 2).tolist():
        outer[first:last] = _evened(outer[first:last], level[first : last + 1])
    return outer, np.where(np.isfinite(inner), inner, 0.0)


def _evened(radius: Floats, level: Floats) -> Floats:
    """Return the limits (k, 2) of spans that stand out of the round faces as those of an even ring of few straight pieces, nowhere inside:
    a shop turns no more of a ring than it needs to."""
    most = np.concatenate(
        [radius[:1, 0], np.maximum(radius[:-1, 1], radius[1:, 0]), radius[-1:, 1]]
    )
    line = shapely.simplify(shapely.linestrings(np.column_stack([level, most])), EVEN)
    z, r = shapely.get_coordinates(line).T
    even = np.interp(level, z, r)
    even += max(0.0, float((most - even).max()))
    return np.column_stack([even[:-1], even[1:]])


def _exact_limits(exact: Floats, level: Floats) -> tuple[Floats, Floats]:
    """Return the limits of the exact pieces alone."""
    count = len(level) - 1
    outer, inner = np.zeros((count, 2)), np.full((count, 2), np.inf)
    for z0, z1, r0, r1 in exact:
        first, last = np.searchsorted(level, [z0 + COINCIDENT, z1 - COINCIDENT])
        rows = np.arange(max(first - 1, 0), min(last, count))
        at = np.clip(np.column_stack([level[rows], level[rows + 1]]), z0, z1)
        radius = r0 + (r1 - r0) * (at - z0) / (z1 - z0)
        outer[rows] = np.maximum(outer[rows], radius)
        inner[rows] = np.minimum(inner[rows], radius)
    return outer, inner


def _keeps_to(edges: Floats, level: Floats, limits: Floats, sense: float) -> Bools:
    """Return which edges (n, 2, 3) nowhere pass limits (k, 2) outwards (sense 1) or inwards (-1), but for the chord error: rims of holes
    in a round face are no more than it."""
    keeps = np.ones(len(edges), dtype=bool)
    for share in SHARES:
        at = edges[:, 0] + share * (edges[:, 1] - edges[:, 0])
        # Heights that are one but for rounding, as in a part that stands askew in its file, are at the same level.
        row = np.searchsorted(level, at[:, 2] + COINCIDENT, side="right") - 1
        row = np.clip(row, 0, len(limits) - 1)
        part = (at[:, 2] - level[row]) / (level[row + 1] - level[row])
        limit = limits[row, 0] + part * (limits[row, 1] - limits[row, 0])
        # At the very height between two spans either one may hold.
        below = np.where(part < COINCIDENT, limits[np.maximum(row - 1, 0), 1], limit)
        limit = np.maximum(limit, below) if sense > 0.0 else np.minimum(limit, below)
        keeps &= sense * (np.hypot(at[:, 0], at[:, 1]) - limit) <= CHORD
    return keeps


def _take_edges(a: Floats, b: Floats, level: Floats, outer: Floats, inner: Floats) -> None:
    """Widen the limits by edges from points (n, 3) to others: the radius is convex along each, so that of its ends bounds it outside; its
    own least distance from the axis inside."""
    swap = a[:, 2] > b[:, 2]
    a, b = np.where(swap[:, None], b, a), np.where(swap[:, None], a, b)
    r0, r1 = (np.hypot(p[:, 0], p[:, 1]) for p in (a, b))
    step = (b - a)[:, :2]
    share = -(a[:, :2] * step).sum(axis=1) / np.maximum((step * step).sum(axis=1), COINCIDENT**2)
    least = np.linalg.norm(a[:, :2] + np.clip(share, 0.0, 1.0)[:, None] * step, axis=1)
    # An edge between points of a bore dips inside of it by the mesh's chord error, the part doesn't.
    least = np.minimum(least + CHORD, np.minimum(r0, r1))
    low, high = a[:, 2] + COINCIDENT, b[:, 2] - COINCIDENT
    first = np.clip(np.searchsorted(level, low, side="right") - 1, 0, len(outer) - 1)
    last = np.clip(np.searchsorted(level, high, side="left") - 1, first, len(outer) - 1)
    size = last - first + 1
    edge, number = items_of(size)
    row = number + first[edge]
    rise = np.maximum(b[:, 2] - a[:, 2], COINCIDENT)[edge]
    ends = [
        r0[edge] + (r1 - r0)[edge] * np.clip((level[row + k] - a[edge, 2]) / rise, 0.0, 1.0)
        for k in (0, 1)
    ]
    whole = (level[row] >= a[edge, 2] - COINCIDENT) & (level[row + 1] <= b[edge, 2] + COINCIDENT)
    most = np.maximum(*ends)
    for k in (0, 1):
        np.maximum.at(outer[:, k], row, np.where(whole, ends[k], most))
        np.minimum.at(inner[:, k], row, least[edge])


def _straightened(outline: Floats) -> Floats:
    """Return an outline without points that repeat, or that lie on the line between their neighbours."""
    kept = outline
    while True:
        fresh = np.linalg.norm(kept - np.roll(kept, 1, axis=0), axis=1) > COINCIDENT
        kept = kept[fresh]
        along = np.roll(kept, -1, axis=0) - np.roll(kept, 1, axis=0)
        step = kept - np.roll(kept, 1, axis=0)
        off = np.abs(along[:, 0] * step[:, 1] - along[:, 1] * step[:, 0])
        bent = off > COINCIDENT * np.maximum(np.linalg.norm(along, axis=1), COINCIDENT)
        if bent.all() and fresh.all():
            return kept
        kept = kept[bent]


def round_and_straight(turned: Bools, surface: tuple[str, ...]) -> tuple[Ints, Ints]:
    """Return the tags of faces of revolution, and of those with a straight meridian, from a face graph's masks and surfaces."""
    tags = np.flatnonzero(turned) + 1
    straight = [t for t in tags.tolist() if surface[t - 1] in ("plane", "cylinder", "cone")]
    return tags, np.array(straight, dtype=np.int64)
