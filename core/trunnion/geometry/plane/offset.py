"""Parallels of curves and regions: lines stay lines, arcs stay arcs about the same centre, convex corners get round joins.

Every segment moves to its side and neighbours are connected: by an arc about a convex corner, by a bridge over a concave one.
The boundary of the result is a part of these raw curves. They cut the plane into faces, each wholly nearer to the source than
the distance or wholly farther, so one exact distance a face decides (`grown`); an open curve is cut at the crossings
themselves (`parallel_curves`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.plane.chords import Chords, chorded
from trunnion.geometry.plane.curve import (
    Curve,
    Segments,
    distance_to,
    join_segments,
    signed_distance,
)
from trunnion.geometry.plane.intersections import CLOSE, crossings

MEETS = 4.0 * CLOSE
"""Pieces of a parallel that were cut at one crossing meet within this: each may have moved by the tolerance on two sides."""


@dataclass(frozen=True, slots=True, eq=False)
class RawCurve:
    """The parallels of a curve's segments and what connects them, in order; a bridge (`is_bridge`) is never part of an answer."""

    segments: Segments
    is_bridge: Bools


ROUNDING = 1e-7
"""mm: grid that points of chords are rounded to where they can't be cut exactly."""


def grown(boundary: Segments, loops: Ints, distance: float) -> tuple[shapely.Geometry, Chords]:
    """Return the area left of closed loops grown (positive) or shrunk (negative) by a distance in mm, and the chords it consists of.

    `boundary` (m,) are the segments of all loops, one loop after another, and `loops` (m,) says of each which one it belongs to.
    """
    raw = raw_parallel(boundary, loops, -distance)
    chords = chorded(raw.segments, raw.is_bridge)
    count = np.diff(chords.first)
    owner = np.repeat(np.arange(len(count)), count)
    real = count[owner] > 1
    _, line = np.unique(owner[real], return_inverse=True)
    lines = np.asarray(shapely.linestrings(chords.points[real], indices=line))
    faces = shapely.get_parts(shapely.polygonize(_noded(lines)))
    if len(faces) == 0:
        return shapely.MultiPolygon(), chords
    return shapely.union_all(faces[_margin(boundary, distance, faces) > 0.0]), chords


def _noded(lines: NDArray[np.object_]) -> NDArray[np.object_]:
    """Return lines (1,) cut where they meet. Where the exact way does not come to an end, as between nearly parallel chords, their
    points are rounded to a grid far below any tolerance: that always does."""
    try:
        noded = np.asarray([shapely.node(shapely.multilinestrings(lines))])
    except shapely.errors.GEOSException:
        noded = np.asarray([shapely.union_all(lines, grid_size=ROUNDING)])
    return noded


def _margin(boundary: Segments, distance: float, faces: NDArray[np.object_]) -> Floats:
    """Return how much deeper than the offset distance a point inside each face lies, the clearest of several points where one is close to
    it."""
    margin = (
        signed_distance(boundary, shapely.get_coordinates(shapely.point_on_surface(faces)))
        + distance
    )
    # A point may lie on the ridge of the distances, such as the middle of a groove, where a whole face seems to be an edge.
    for n in np.flatnonzero(
        (np.abs(margin) < tolerance.SLIVER) & (shapely.area(faces) > tolerance.AREA)
    ):
        triangles = shapely.get_parts(shapely.constrained_delaunay_triangles(faces[n]))
        probes = shapely.get_coordinates(shapely.centroid(triangles))
        found = signed_distance(boundary, probes) + distance
        margin[n] = found[np.argmax(np.abs(found))]
    return margin


def raw_parallel(s: Segments, loop: Ints, distance: float, closed: bool = True) -> RawCurve:
    """Return the parallels to the left of curves by a distance, uncut, with round joins at convex corners and bridges elsewhere.

    `s` (m,) are the segments of curves, one curve after another, and `loop` (m,) says of each which curve it belongs to.
    """
    rows = np.flatnonzero(s.length > tolerance.COINCIDENT)
    s, loop = s[rows], loop[rows]
    begin, finish = _end_tangents(s)
    start = s.start + distance * np.stack([-begin[:, 1], begin[:, 0]], axis=1)
    end = s.end + distance * np.stack([-finish[:, 1], finish[:, 0]], axis=1)
    before, after = _neighbours(loop, closed)
    open_joint = np.abs(end[before] - start[after]).max(axis=1) > tolerance.PARAMETRIC
    start[after[~open_joint]] = end[before[~open_joint]]
    # An anticlockwise arc has its centre on the left: its parallel there is smaller, and gone beyond the centre.
    radius = s.radius - np.sign(s.sweep) * distance
    is_arc = s.sweep != 0.0
    gone = is_arc & (radius <= tolerance.COINCIDENT)
    stays_arc = is_arc & ~gone
    main = Segments(
        start,
        end,
        np.where(stays_arc[:, None], s.centre, np.nan),
        np.where(stays_arc, radius, np.nan),
        np.where(stays_arc, s.sweep, 0.0),
        np.where(stays_arc, radius * np.abs(s.sweep), _apart(start, end)),
    )
    bend = _bends(s, before, after, finish[before], begin[after])
    convex = bend * distance < 0.0
    size = abs(distance)
    joins = Segments(
        end[before],
        start[after],
        np.where(convex[:, None], s.end[before], np.nan),
        np.where(convex, size, np.nan),
        np.where(convex, bend, 0.0),
        np.where(convex, size * np.abs(bend), _apart(end[before], start[after])),
    )
    order = np.argsort(np.concatenate([2 * np.arange(len(s)), 2 * before[open_joint] + 1]))
    return RawCurve(
        join_segments([main, joins[np.flatnonzero(open_joint)]])[order],
        np.concatenate([gone, ~convex[open_joint]])[order],
    )


def _apart(a: Floats, b: Floats) -> Floats:
    d = b - a
    return np.hypot(d[:, 0], d[:, 1])


def _neighbours(loop: Ints, closed: bool) -> tuple[Ints, Ints]:
    """Return the rows of segments that have a next one, and the rows of those next ones."""
    m = len(loop)
    last = np.flatnonzero(np.append(loop[1:] != loop[:-1], True))
    if not closed:
        before = np.setdiff1d(np.arange(m), last)
        return before, before + 1
    after = np.arange(1, m + 1)
    after[last] = np.concatenate([[0], last[:-1] + 1])
    return np.arange(m), after


def _bends(s: Segments, before: Ints, after: Ints, u: Floats, v: Floats) -> Floats:
    """Return the signed turns (k,) from the directions `u` at the ends of segments `before` to `v` at the starts of `after`."""
    bend = np.arctan2(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0], (u * v).sum(axis=1))
    # At a cusp the directions alone can't distinguish a left turn from a right one; the curvatures can.
    curvature = np.sign(s.sweep) / np.where(s.sweep != 0.0, s.radius, np.inf)
    side = -(curvature[before] + curvature[after])
    cusp = (np.abs(bend) > np.pi - tolerance.ANGLE) & (side != 0.0)
    return np.where(cusp, np.copysign(np.abs(bend), side), bend)


def _end_tangents(s: Segments) -> tuple[Floats, Floats]:
    rows = np.arange(len(s))
    return s.directions(rows, np.zeros(len(s))), s.directions(rows, s.length)


def parallel_curves(curve: Curve, distance: float) -> list[Curve]:
    """Return the curves that run beside a curve at a distance to its left (negative: to its right), in the order of the curve.

    Convex corners get round joins about the corner, concave ones are trimmed; what would come nearer to the curve than the
    distance is left out, so the result may be empty or in several pieces. Arcs stay arcs.
    """
    if abs(distance) <= tolerance.PARAMETRIC:
        return [curve]
    raw = raw_parallel(
        curve.segments(), np.zeros(curve.n_segments, dtype=np.int64), distance, curve.closed
    )
    real = raw.segments[np.flatnonzero(~raw.is_bridge)]
    # What lies round the end of an open curve is nearer to it than the distance and cuts too.
    ends = () if curve.closed else (curve.start, curve.end)
    caps = [Curve.circle(end, abs(distance)).segments() for end in ends]
    rows, low, high = cut_at_crossings(join_segments([real, *caps]))
    own = rows < len(real)
    rows, low, high = rows[own], low[own], high[own]
    middle = real.at(rows, 0.5 * (low + high))
    kept = distance_to(curve.segments(), middle) >= abs(distance) - CLOSE
    return _strung(real, rows[kept], low[kept], high[kept])


def cut_at_crossings(s: Segments) -> tuple[Ints, Floats, Floats]:
    """Return the pieces of segments between their crossings: rows (k,) and arc lengths from and to (k,) in order."""
    row, share, _ = crossings(s)
    m = len(s)
    row = np.concatenate([np.arange(m), np.arange(m), row])
    position = np.concatenate([np.zeros(m), s.length, share * s.length[row[2 * m :]]])
    order = np.lexsort([position, row])
    row, position = row[order], position[order]
    real = (row[1:] == row[:-1]) & (position[1:] - position[:-1] > CLOSE)
    return row[:-1][real], position[:-1][real], position[1:][real]


def _strung(s: Segments, rows: Ints, low: Floats, high: Floats) -> list[Curve]:
    """Put pieces end to end; a row of pieces that comes back to its start gives a closed curve."""
    if len(rows) == 0:
        return []
    start, end = s.at(rows, low), s.at(rows, high)
    bulge = np.tan(0.25 * np.divide(high - low, s.length[rows]) * s.sweep[rows])
    breaks = np.flatnonzero(np.abs(end[:-1] - start[1:]).max(axis=1) > MEETS) + 1
    curves = []
    for chain in _chains(np.split(np.arange(len(rows)), breaks), start, end):
        points, bulges = (
            np.concatenate([start[chain], end[chain[-1:]]]),
            np.append(bulge[chain], 0.0),
        )
        if np.abs(points[-1] - points[0]).max() <= MEETS and (
            len(chain) > 2 or (len(chain) == 2 and bulges.any())
        ):
            curves.append(Curve(points[:-1], bulges[:-1], True))
        else:
            curves.append(Curve(points, bulges, False))
    return curves


def _chains(runs: list[Ints], start: Floats, end: Floats) -> list[Ints]:
    """Join runs of pieces where one ends and another one starts; a run that closes on itself stays as it is."""
    first, last = start[[run[0] for run in runs]], end[[run[-1] for run in runs]]
    meets = np.abs(last[:, None, :] - first[None, :, :]).max(axis=2) <= MEETS
    closes = meets.diagonal().copy()
    meets[closes, :], meets[:, closes] = False, False
    after = np.where(meets.any(axis=1), np.argmax(meets, axis=1), -1)
    heads = [n for n in range(len(runs)) if n not in set(after.tolist())]
    chains: list[Ints] = []
    used: set[int] = set()
    for head in [*heads, *range(len(runs))]:
        chain = []
        while head >= 0 and head not in used:
            used.add(head)
            chain.append(runs[head])
            head = int(after[head])
        if chain:
            chains.append(np.concatenate(chain))
    return sorted(chains, key=lambda chain: int(chain.min()))
