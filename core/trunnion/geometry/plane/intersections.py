"""Where lines and arcs meet: all crossings of many segments at once, and the one meeting of two carriers near a position."""

from __future__ import annotations

import math

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats, Ints, items_of
from trunnion.geometry.plane.curve import FULL, Segments, segment_boxes

CLOSE = tolerance.COINCIDENT
"""Two ends of segments that are this close in x and in y are one point."""


def crossings(s: Segments, pairs: tuple[Ints, Ints] | None = None) -> tuple[Ints, Floats, Floats]:
    """Return where segments meet each other: rows (k,), shares of their length from 0 to 1 (k,) and points (k, 2).

    Every meeting is given for both, with the same point. The ends of one that lie inside the other are among them. `pairs` are
    the pairs of segments that can meet, when they are known.
    """
    i, j = overlapping_boxes(s) if pairs is None else pairs
    line = s.sweep == 0.0
    rows, points = [], []
    for kind, solve in (
        (line[i] & line[j], _lines_meet),
        (line[i] & ~line[j], _line_meets_circle),
        (~line[i] & line[j], _circle_meets_line),
        (~line[i] & ~line[j], _circles_meet),
    ):
        a, b = i[kind], j[kind]
        for point in solve(s, a, b) if len(a) else ():
            rows += [a, b]
            points += [point, point]
    # Ends that lie on another segment cut it too, which also covers segments that lie on each other.
    row, point = (
        np.concatenate([i, i, j, j]),
        np.concatenate([s.start[j], s.end[j], s.start[i], s.end[i]]),
    )
    on_carrier = _off_carrier(s, row, point) <= CLOSE
    row, point = (
        np.concatenate([*rows, row[on_carrier]]),
        np.concatenate([*points, point[on_carrier]]),
    )
    key = share_on(s, row, point)
    real = ~np.isnan(key)
    # A meeting is one only when it lies inside both.
    begin = 0
    for a in rows[::2]:
        first, second = slice(begin, begin + len(a)), slice(begin + len(a), begin + 2 * len(a))
        real[first] = real[second] = real[first] & real[second]
        begin += 2 * len(a)
    return row[real], key[real], point[real]


def overlapping_boxes(s: Segments) -> tuple[Ints, Ints]:
    """Return the pairs of segments, the smaller row first, whose boxes come within the coincidence tolerance."""
    low, high = segment_boxes(s)
    low = low - 2.0 * CLOSE
    # In the order of their left sides a box meets those that begin before it ends, and none before itself that it was not held against.
    order = np.argsort(low[:, 0], kind="stable")
    begin = np.arange(1, len(s) + 1)
    count = np.searchsorted(low[order, 0], high[order, 0], side="right") - begin
    one, number = items_of(count)
    other = begin[one] + number
    one, other = order[one], order[other]
    meet = (low[one, 1] <= high[other, 1]) & (low[other, 1] <= high[one, 1])
    i, j = np.minimum(one, other)[meet], np.maximum(one, other)[meet]
    rows = np.lexsort([j, i])
    return i[rows], j[rows]


def _off_carrier(s: Segments, rows: Ints, points: Floats) -> Floats:
    """Return how far points (k, 2) are from the line or circle on which the segments `rows` lie."""
    along = s.end[rows] - s.start[rows]
    size = np.hypot(along[:, 0], along[:, 1])
    to = points - s.start[rows]
    off = np.abs(along[:, 0] * to[:, 1] - along[:, 1] * to[:, 0]) / np.where(size > 0.0, size, 1.0)
    ray = points - s.centre[rows]
    return np.where(
        s.sweep[rows] == 0.0, off, np.abs(np.hypot(ray[:, 0], ray[:, 1]) - s.radius[rows])
    )


def share_on(s: Segments, rows: Ints, points: Floats) -> Floats:
    """Return the shares (k,) of the length at which points (k, 2) lie inside segments `rows`; NaN at the ends and beyond."""
    position = np.full(len(rows), np.nan)
    line = s.sweep[rows] == 0.0
    a = rows[line]
    along = (s.end[a] - s.start[a]) / np.maximum(s.length[a], np.finfo(float).tiny)[:, None]
    position[line] = ((points[line] - s.start[a]) * along).sum(axis=1)
    a = rows[~line]
    if len(a):
        ray, q = s.start[a] - s.centre[a], points[~line] - s.centre[a]
        angle = (
            np.sign(s.sweep[a])
            * np.arctan2(ray[:, 0] * q[:, 1] - ray[:, 1] * q[:, 0], (ray * q).sum(axis=1))
            % FULL
        )
        position[~line] = angle * s.radius[a]
    length = s.length[rows]
    with np.errstate(invalid="ignore"):
        position[(position <= CLOSE) | (position >= length - CLOSE)] = np.nan
        return position / length


def _lines_meet(s: Segments, a: Ints, b: Ints) -> list[Floats]:
    d, e = s.end[a] - s.start[a], s.end[b] - s.start[b]
    across = d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0]
    to = s.start[b] - s.start[a]
    ok = np.abs(across) > tolerance.COINCIDENT * s.length[a] * s.length[b]
    share = np.divide(
        to[:, 0] * e[:, 1] - to[:, 1] * e[:, 0], across, out=np.full(len(a), np.nan), where=ok
    )
    return [s.start[a] + share[:, None] * d]


def _line_meets_circle(s: Segments, a: Ints, b: Ints) -> list[Floats]:
    d = (s.end[a] - s.start[a]) / np.maximum(s.length[a], np.finfo(float).tiny)[:, None]
    foot = s.start[a] + ((s.centre[b] - s.start[a]) * d).sum(axis=1)[:, None] * d
    off = np.hypot(*(foot - s.centre[b]).T)
    square = (s.radius[b] - off) * (s.radius[b] + off)
    half = np.sqrt(np.where(off <= s.radius[b] + CLOSE, np.maximum(square, 0.0), np.nan))[:, None]
    return [foot + half * d, foot - half * d]


def _circle_meets_line(s: Segments, a: Ints, b: Ints) -> list[Floats]:
    return _line_meets_circle(s, b, a)


def _circles_meet(s: Segments, a: Ints, b: Ints) -> list[Floats]:
    d = s.centre[b] - s.centre[a]
    apart = np.hypot(d[:, 0], d[:, 1])
    ra, rb = s.radius[a], s.radius[b]
    ok = (apart > CLOSE) & (apart <= ra + rb + CLOSE) & (apart >= np.abs(ra - rb) - CLOSE)
    d = np.divide(d, apart[:, None], out=np.full_like(d, np.nan), where=ok[:, None])
    along = 0.5 * (
        apart + np.divide((ra - rb) * (ra + rb), apart, out=np.zeros_like(apart), where=ok)
    )
    half = np.sqrt(np.maximum((ra - along) * (ra + along), 0.0))[:, None]
    middle = s.centre[a] + np.clip(along, -ra, ra)[:, None] * d
    across = np.stack([-d[:, 1], d[:, 0]], axis=1)
    return [middle + half * across, middle - half * across]


def intersection(source: Segments, a: int, b: int, near: Floats) -> Floats:
    """Return the point where the carriers of two segments meet, the one nearest to a point.

    Carriers that only nearly touch meet where they are closest; parallel lines meet at the given point's foot on the first.
    """
    if source.sweep[a] == 0.0 and source.sweep[b] == 0.0:
        return _line_line(source, a, b, near)
    if source.sweep[a] == 0.0:
        return _line_circle(
            source.start[a], source.end[a], source.centre[b], float(source.radius[b]), near
        )
    if source.sweep[b] == 0.0:
        return _line_circle(
            source.start[b], source.end[b], source.centre[a], float(source.radius[a]), near
        )
    return _circle_circle(
        source.centre[a], float(source.radius[a]), source.centre[b], float(source.radius[b]), near
    )


def _line_line(source: Segments, a: int, b: int, near: Floats) -> Floats:
    d, e = source.end[a] - source.start[a], source.end[b] - source.start[b]
    d, e = d / math.hypot(*d), e / math.hypot(*e)
    across = d[0] * e[1] - d[1] * e[0]
    if abs(across) <= tolerance.COINCIDENT:
        return source.start[a] + ((near - source.start[a]) @ d) * d
    to = source.start[b] - source.start[a]
    return source.start[a] + ((to[0] * e[1] - to[1] * e[0]) / across) * d


def _line_circle(start: Floats, end: Floats, centre: Floats, radius: float, near: Floats) -> Floats:
    d = end - start
    d = d / math.hypot(*d)
    foot = start + ((centre - start) @ d) * d
    off = math.hypot(*(foot - centre))
    if off >= radius:
        return foot if off <= 0.0 else 0.5 * (foot + centre + (foot - centre) * (radius / off))
    half = math.sqrt((radius - off) * (radius + off))
    return foot + math.copysign(half, float((near - foot) @ d)) * d


def _circle_circle(a: Floats, ra: float, b: Floats, rb: float, near: Floats) -> Floats:
    d = b - a
    apart = math.hypot(*d)
    if apart <= tolerance.COINCIDENT:
        ray = near - a
        return a + ray * (ra / math.hypot(*ray))
    d = d / apart
    along = 0.5 * (apart + (ra - rb) * (ra + rb) / apart)
    square = (ra - along) * (ra + along)
    if square <= 0.0:
        return a + math.copysign(ra, along) * d
    across = np.array([-d[1], d[0]])
    return a + along * d + math.copysign(math.sqrt(square), float((near - a) @ across)) * across
