"""From lines and arcs to chords and back: how shapely's answers about plane areas become exact again.

Shapely finds topology on chords. Every chord remembers the carrier it came from, a line or a circle. In shapely's answer each
edge is such a chord or a part of one; runs of edges on one carrier become one line or arc again, old vertices keep their
coordinates, and new ones are the exact meeting points of their two carriers.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.curve import FULL, Curve, Segments, chord_counts, segment_boxes, turn

CLOSE = tolerance.COINCIDENT
"""Two ends of segments that are this close in x and in y are one point."""


@dataclass(frozen=True, slots=True, eq=False)
class Chords:
    """Segments opened into chords that remember where they came from.

    `points` (p, 2): the chord points of all segments one after another; segment i has the points first[i] to first[i + 1],
    both of its ends among them. `source`: the segments, their ends pulled together; `carrier` (m,): equal for
    segments on the same line or circle; `is_bridge` (m,): segments that only close gaps and are no part of an answer.
    """

    points: Floats
    first: Ints
    source: Segments
    carrier: Ints
    is_bridge: Bools


def chorded(source: Segments, is_bridge: Bools | None = None, chord: float = tolerance.PLANE_REGION) -> Chords:
    """Return segments opened into chords so that places where they lie on each other get the same chords."""
    m = len(source)
    ends = pulled_together(np.concatenate([source.start, source.end]))
    start, end = ends[:m], ends[m:]
    pairs = _meeting_boxes(source)
    centre, radius, carrier = _shared_carriers(start, end, source, pairs)
    joined = Segments(start, end, centre, radius, source.sweep, source.length)
    bridges = np.zeros(m, dtype=bool) if is_bridge is None else is_bridge
    carrier = np.where(bridges, m + np.arange(m), carrier)
    inner_row, inner_key, inner_point = _inner_points(joined, chord)
    meet_row, meet_key, meet_point = crossings(joined, pairs)
    row = np.concatenate([np.arange(m), np.arange(m), inner_row, meet_row])
    key = np.concatenate([np.zeros(m), np.ones(m), inner_key, meet_key])
    exact = pulled_together(np.concatenate([ends, meet_point]))
    point = np.concatenate([exact[:2 * m], inner_point, exact[2 * m:]])
    order = np.lexsort([key, row])
    row, point, is_inner = row[order], point[order], (order >= 2 * m) & (order < 2 * m + len(inner_row))
    # A chord point on a circle gives way to a vertex, and of equal vertices one is enough.
    close = (row[1:] == row[:-1]) & (np.abs(point[1:] - point[:-1]).max(axis=1) <= CLOSE)
    same = close & (point[1:] == point[:-1]).all(axis=1)
    keep = np.ones(len(row), dtype=bool)
    keep[1:] &= ~(same | (close & is_inner[1:]))
    keep[:-1] &= ~(close & is_inner[:-1])
    row, point = row[keep], point[keep]
    first = np.searchsorted(row, np.arange(m + 1))
    return Chords(point, first, joined, carrier, bridges)


def pulled_together(points: Floats) -> Floats:
    """Return points (n, 2) in which those that are one point within the coincidence tolerance have the coordinates of the first."""
    _, first, back = np.unique(points[:, 0] + 1j * points[:, 1], return_index=True, return_inverse=True)
    apart = points[first]
    free = _crowded(apart)
    free = free[np.argsort(first[free])]
    owner = np.arange(len(apart))
    while len(free) > 1:
        near = np.abs(apart[free] - apart[free[0]]).max(axis=1) <= CLOSE
        owner[free[near]] = free[0]
        free = free[~near]
    return apart[owner[back]]


def _crowded(points: Floats) -> Ints:
    """Return the rows of points that may have another one within the coincidence tolerance: they share a cell of one of four grids."""
    cell = (points - points.min(axis=0)) / (4.0 * CLOSE)
    crowded = np.zeros(len(points), dtype=bool)
    for shift in ((0.0, 0.0), (0.5, 0.0), (0.0, 0.5), (0.5, 0.5)):
        x, y = np.floor(cell + shift).astype(np.int64).T
        # Two cells may share a number; that only costs a look.
        number = x * 1000003 + y
        order = np.argsort(number)
        same = np.flatnonzero(number[order[1:]] == number[order[:-1]])
        crowded[order[same]] = crowded[order[same + 1]] = True
    return np.flatnonzero(crowded)


def _shared_carriers(start: Floats, end: Floats, s: Segments, pairs: tuple[Ints, Ints]) -> tuple[Floats, Floats, Ints]:
    """Number the carriers, and give arcs that lie on the same circle within the coincidence tolerance its centre and radius."""
    centre, radius = s.centre.copy(), s.radius.copy()
    carrier = np.arange(len(s))
    i, j = pairs
    with np.errstate(invalid="ignore"):
        arcs = (np.abs(radius[i] - radius[j]) <= CLOSE) & (np.abs(centre[i] - centre[j]).max(axis=1) <= CLOSE)
    line = s.sweep == 0.0
    along = end - start
    size = np.hypot(along[:, 0], along[:, 1])
    same = line[i] & line[j] & (size[i] > 0.0) & (size[j] > 0.0)
    for one, other in ((i, j), (j, i)):
        for point in (start, end):
            to = point[other] - start[one]
            same &= np.abs(along[one, 0] * to[:, 1] - along[one, 1] * to[:, 0]) <= CLOSE * size[one]
    for k in np.flatnonzero(arcs | same):
        carrier[j[k]] = carrier[i[k]]
        centre[j[k]], radius[j[k]] = centre[i[k]], radius[i[k]]
    return centre, radius, carrier


def _inner_points(s: Segments, chord: float) -> tuple[Ints, Floats, Floats]:
    """Return the chord points inside arcs at angles that depend on the circle alone, as rows, keys in 0..1 and points."""
    arcs = np.flatnonzero(s.sweep != 0.0)
    if len(arcs) == 0:
        return np.empty(0, dtype=np.int64), np.empty(0), np.empty((0, 2))
    radius, sweep = s.radius[arcs], s.sweep[arcs]
    around = Segments(s.start[arcs], s.end[arcs], s.centre[arcs], radius, np.full(len(arcs), FULL), radius)
    parts = np.maximum(8, chord_counts(around, chord))
    step = FULL / parts
    ray = s.start[arcs] - s.centre[arcs]
    begin = np.arctan2(ray[:, 1], ray[:, 0])
    low, high = np.minimum(begin, begin + sweep), np.maximum(begin, begin + sweep)
    # A grid point closer to an end than a hundredth of a step gives way to it.
    first = np.ceil(low / step + 0.01).astype(np.int64)
    last = np.floor(high / step - 0.01).astype(np.int64)
    count = np.maximum(0, last - first + 1)
    row = np.repeat(np.arange(len(arcs)), count)
    number = first[row] + np.arange(len(row)) - np.repeat(np.cumsum(count) - count, count)
    angle = (number % parts[row]) * step[row]
    point = s.centre[arcs][row] + radius[row, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    key = (number * step[row] - begin[row]) / sweep[row]
    return arcs[row], key, point


def restored(geometry: shapely.Geometry, chords: Chords) -> list[tuple[Curve, list[Curve]]]:
    """Return the polygons of a shapely answer as exact outer curves (anticlockwise), each with its holes (clockwise).

    Pieces and holes that are too small or too narrow to be more than noise are left out.
    """
    polygons = [p for p in shapely.get_parts(geometry) if p.geom_type == "Polygon" and not p.is_empty]
    if not polygons:
        return []
    rings, owner = shapely.get_rings(polygons, return_index=True)
    coords, ring = shapely.get_coordinates(rings, return_index=True)
    edges = _Edges(coords, ring, chords)
    answer: list[tuple[Curve, list[Curve]]] = []
    previous = -1
    outer_kept = False
    for n, piece in enumerate(owner):
        curve = edges.curve(n)
        is_outer, previous = piece != previous, piece
        if is_outer:
            outer_kept = curve is not None
            if curve is not None:
                answer.append((curve if curve.area > 0.0 else curve.reversed(), []))
        elif curve is not None and outer_kept:
            answer[-1][1].append(curve if curve.area < 0.0 else curve.reversed())
    return answer


class _Edges:
    """The edges of rings, matched to the carriers they lie on."""

    def __init__(self, coords: Floats, ring: Ints, chords: Chords) -> None:
        self.chords = chords
        self.coords = coords
        bounds = np.flatnonzero(np.diff(ring)) + 1
        self.begin = np.concatenate([[0], bounds])
        self.stop = np.concatenate([bounds, [len(coords)]])
        table, place = np.unique(chords.points[:, 0] + 1j * chords.points[:, 1], return_inverse=True)
        z = coords[:, 0] + 1j * coords[:, 1]
        at = np.minimum(np.searchsorted(table, z), len(table) - 1)
        self.is_old: Bools = table[at] == z
        rows = np.repeat(np.arange(len(chords.source)), np.diff(chords.first))
        is_chord = np.ones(len(rows), dtype=bool)
        is_chord[chords.first[1:] - 1] = False
        head = np.flatnonzero(is_chord)
        self.row = np.full(len(coords), -1)
        is_edge = np.ones(len(coords), dtype=bool)
        is_edge[self.stop - 1] = False
        edge = np.flatnonzero(is_edge)
        known = np.minimum(place[head], place[head + 1]) * len(table) + np.maximum(place[head], place[head + 1])
        # A bridge that lies on a real chord must not hide it.
        order = np.lexsort([chords.is_bridge[rows[head]], known])
        known = known[order]
        asked = np.minimum(at[edge], at[edge + 1]) * len(table) + np.maximum(at[edge], at[edge + 1])
        slot = np.minimum(np.searchsorted(known, asked), len(known) - 1)
        hit = (known[slot] == asked) & self.is_old[edge] & self.is_old[edge + 1]
        chord = np.full(len(edge), -1)
        chord[hit] = head[order[slot[hit]]]
        if not hit.all():
            lost = edge[~hit]
            real = head[np.argsort(chords.is_bridge[rows[head]], kind="stable")]
            chord[~hit] = real[_nearest_chord(coords[lost], coords[lost + 1], chords.points[real], chords.points[real + 1])]
        along = coords[edge + 1] - coords[edge]
        source = chords.points[chord + 1] - chords.points[chord]
        sign = np.where((along * source).sum(axis=1) >= 0.0, 1, -1)
        self.row[edge] = rows[chord]
        sweep = chords.source.sweep[rows[chord]]
        # Which way round the circle an edge goes; for lines which way along the carrier does not matter.
        self.turn = np.zeros(len(coords), dtype=np.int64)
        self.turn[edge] = np.sign(sweep).astype(np.int64) * sign
        self.carrier = np.where(self.row >= 0, chords.carrier[self.row], -1)

    def curve(self, n: int) -> Curve | None:
        """Return ring n as an exact curve, or None when it is too small or too narrow."""
        begin, stop = int(self.begin[n]), int(self.stop[n])
        points = self.coords[begin:stop]
        area, around = _ring_size(points)
        if area < tolerance.AREA or 2.0 * area < tolerance.SLIVER * around:
            return None
        carrier, turned = self.carrier[begin:stop - 1], self.turn[begin:stop - 1]
        change = _changes(carrier, turned)
        if len(change) == 0:
            return _round(self.chords.source, int(self.row[begin]), int(turned[0]), points[0])
        runs = [_Run(int(self.row[begin + k]), int(turned[k]), points[k], bool(self.is_old[begin + k])) for k in change]
        return _closed_curve(self.chords, runs)


def _changes(carrier: Ints, turned: Ints) -> Ints:
    """Return the places in a ring where another carrier, or the same one in the other direction, begins."""
    before_carrier, before_turned = np.concatenate([carrier[-1:], carrier[:-1]]), np.concatenate([turned[-1:], turned[:-1]])
    return np.flatnonzero((carrier != before_carrier) | (turned != before_turned))


def _nearest_chord(start: Floats, end: Floats, a: Floats, b: Floats) -> Ints:
    """Return the chord (row of a, b) on which each edge (start, end) lies."""
    middle = 0.5 * (start + end)
    best = np.empty(len(middle), dtype=np.int64)
    d = b - a
    square = np.maximum((d * d).sum(axis=1), np.finfo(float).tiny)
    unit_d = d / np.sqrt(square)[:, None]
    for k, m in enumerate(middle):
        to = m - a
        share = np.clip((to * d).sum(axis=1) / square, 0.0, 1.0)
        away = np.hypot(*(to - share[:, None] * d).T)
        near = np.flatnonzero(away <= away.min() + tolerance.COINCIDENT)
        edge = end[k] - start[k]
        along = np.abs(unit_d[near] @ edge) / max(math.hypot(*edge), np.finfo(float).tiny)
        best[k] = near[np.argmax(along >= along.max() - tolerance.COINCIDENT)]
    return best


def _ring_size(points: Floats) -> tuple[float, float]:
    p = points - points[0]
    area = 0.5 * abs(float(np.sum(p[:-1, 0] * p[1:, 1] - p[1:, 0] * p[:-1, 1])))
    return area, float(np.hypot(*(p[1:] - p[:-1]).T).sum())


@dataclass(slots=True)
class _Run:
    """Edges on one carrier: the source row, the way round (0 for a line), the point where it starts, and whether that is an old one."""

    row: int
    turned: int
    start: Floats
    is_exact: bool


def _round(source: Segments, row: int, turned: int, at: Floats) -> Curve:
    centre = source.centre[row]
    ray = at - centre
    ray = ray * (source.radius[row] / math.hypot(ray[0], ray[1]))
    return Curve(np.stack([centre + ray, centre - ray]), np.full(2, float(turned)), True)


def _closed_curve(chords: Chords, runs: list[_Run]) -> Curve | None:
    """Return the exact curve of runs round a ring, or None when nothing is left of it."""
    source = chords.source
    runs = _without_specks(chords, runs)
    starts = [run.start for run in runs]
    while len(runs) > 1:
        starts = [run.start if run.is_exact else meeting(source, before.row, run.row, run.start)
                  for before, run in zip([runs[-1], *runs[:-1]], runs, strict=True)]
        turned_back = _turned_back(source, runs, starts)
        if turned_back < 0:
            break
        runs[(turned_back + 1) % len(runs)].is_exact = False
        del runs[turned_back]
        runs = _joined(chords, runs)
    if len(runs) == 0 or (len(runs) == 1 and not runs[0].turned):
        return None
    if len(runs) == 1:
        return _round(source, runs[0].row, runs[0].turned, runs[0].start)
    points, bulges = [], []
    for run, start, end in zip(runs, starts, [*starts[1:], starts[0]], strict=True):
        new_points, new_bulges = _arc_or_line(source, run, start, end)
        points += new_points
        bulges += new_bulges
    if len(points) == 2 and not any(bulges):
        return None
    return Curve(np.array(points), np.array(bulges), True)


def _without_specks(chords: Chords, runs: list[_Run]) -> list[_Run]:
    """Drop bridges and runs shorter than two points can be apart, and join what then lies on one carrier."""
    kept: list[_Run] = []
    for n, run in enumerate(runs):
        after = runs[(n + 1) % len(runs)]
        is_speck = math.dist(after.start, run.start) <= CLOSE and not _goes_round(chords.source, run, after)
        if is_speck or chords.is_bridge[run.row]:
            after.is_exact = False
        else:
            kept.append(run)
    return _joined(chords, kept)


def _joined(chords: Chords, runs: list[_Run]) -> list[_Run]:
    """Join neighbours on one carrier."""
    carrier = chords.carrier
    joined: list[_Run] = []
    for run in runs:
        if not joined or carrier[joined[-1].row] != carrier[run.row] or joined[-1].turned != run.turned:
            joined.append(run)
    while len(joined) > 1 and carrier[joined[0].row] == carrier[joined[-1].row] and joined[0].turned == joined[-1].turned:
        joined.pop(0)
    return joined


def _turned_back(source: Segments, runs: list[_Run], starts: list[Floats]) -> int:
    """Return the first run that its exact ends turn round, so that it was only an error of the chords, or -1."""
    for n, run in enumerate(runs):
        after = (n + 1) % len(runs)
        if run.is_exact and runs[after].is_exact:
            continue
        if run.turned:
            wide = abs(_sweep(source, run, starts[n], starts[after]))
            if wide > math.pi and wide > abs(_sweep(source, run, run.start, runs[after].start)) + math.pi:
                return n
        elif (starts[after] - starts[n]) @ (runs[after].start - run.start) <= 0.0:
            return n
    return -1


def _goes_round(source: Segments, run: _Run, after: _Run) -> bool:
    """Say whether a run whose ends meet is nearly a full circle rather than a speck."""
    return bool(run.turned) and abs(_sweep(source, run, run.start, after.start)) > math.pi


def _sweep(source: Segments, run: _Run, start: Floats, end: Floats) -> float:
    """Return the signed angle in radians that an arc's run goes round from start to end."""
    a, b = start - source.centre[run.row], end - source.centre[run.row]
    angle = run.turned * math.atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1])
    return run.turned * (angle % FULL)


def _arc_or_line(source: Segments, run: _Run, start: Floats, end: Floats) -> tuple[list[Floats], list[float]]:
    if not run.turned:
        return [start], [0.0]
    sweep = _sweep(source, run, start, end)
    if abs(sweep) <= 1.5 * math.pi:
        return [start], [math.tan(0.25 * sweep)]
    # A bulge says little about a nearly full circle, so that is given in two arcs.
    half = source.centre[run.row] + turn(start - source.centre[run.row], 0.5 * sweep)
    return [start, half], [math.tan(0.125 * sweep)] * 2


def meeting(source: Segments, a: int, b: int, near: Floats) -> Floats:
    """Return the point where the carriers of two segments meet, the one nearest to a point.

    Carriers that only nearly touch meet where they are closest; parallel lines meet at the given point's foot on the first.
    """
    if source.sweep[a] == 0.0 and source.sweep[b] == 0.0:
        return _line_line(source, a, b, near)
    if source.sweep[a] == 0.0:
        return _line_circle(source.start[a], source.end[a], source.centre[b], float(source.radius[b]), near)
    if source.sweep[b] == 0.0:
        return _line_circle(source.start[b], source.end[b], source.centre[a], float(source.radius[a]), near)
    return _circle_circle(source.centre[a], float(source.radius[a]), source.centre[b], float(source.radius[b]), near)


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


def polygons_of(chords: Chords, loops: Sequence[Sequence[range]]) -> shapely.Geometry:
    """Return the shapely area of pieces given as rows of the chords' segments: for each piece its outer loop, then its holes."""
    polygons = []
    for piece in loops:
        rings = [np.concatenate([chords.points[chords.first[i]: chords.first[i + 1] - 1] for i in loop]) for loop in piece]
        rings = [ring for ring in rings if len(ring) >= 3]
        if rings:
            polygons.append(shapely.Polygon(rings[0], rings[1:]))
    area = shapely.MultiPolygon(polygons)
    return area if area.is_valid else shapely.make_valid(area, method="structure", keep_collapsed=False)


def joined_runs(chords: Chords) -> Curve | None:
    """Return one closed loop of segments with specks dropped and neighbours on one carrier joined; None when nothing is left."""
    source = chords.source
    turned = np.sign(source.sweep).astype(np.int64)
    rows = np.arange(len(source))
    change = _changes(chords.carrier, turned)
    if len(change) == 0:
        return _round(source, 0, int(turned[0]), source.start[0]) if turned[0] else None
    return _closed_curve(chords, [_Run(int(rows[k]), int(turned[k]), source.start[k], True) for k in change])


def crossings(s: Segments, pairs: tuple[Ints, Ints] | None = None) -> tuple[Ints, Floats, Floats]:
    """Return where segments meet each other: rows (k,), shares of their length from 0 to 1 (k,) and points (k, 2).

    Every meeting is given for both, with the same point. The ends of one that lie inside the other are among them. `pairs` are
    the pairs of segments that can meet, when they are known.
    """
    i, j = _meeting_boxes(s) if pairs is None else pairs
    line = s.sweep == 0.0
    rows, keys, points = [], [], []
    for kind, solve in ((line[i] & line[j], _lines_meet), (line[i] & ~line[j], _line_meets_circle),
                        (~line[i] & line[j], _circle_meets_line), (~line[i] & ~line[j], _circles_meet)):
        a, b = i[kind], j[kind]
        for point in solve(s, a, b) if len(a) else ():
            on_a, on_b = place_on(s, a, point), place_on(s, b, point)
            real = ~np.isnan(on_a) & ~np.isnan(on_b)
            rows += [a[real], b[real]]
            keys += [on_a[real], on_b[real]]
            points += [point[real], point[real]]
    # Ends that lie on another segment cut it too, which also covers segments that lie on each other.
    row, point = np.concatenate([i, i, j, j]), np.concatenate([s.start[j], s.end[j], s.start[i], s.end[i]])
    touches = _off_carrier(s, row, point) <= CLOSE
    row, point = row[touches], point[touches]
    key = place_on(s, row, point)
    inside = ~np.isnan(key)
    return np.concatenate([*rows, row[inside]]), np.concatenate([*keys, key[inside]]), np.concatenate([*points, point[inside]])


def _meeting_boxes(s: Segments) -> tuple[Ints, Ints]:
    """Return the pairs of segments, the smaller row first, whose boxes come within the coincidence tolerance."""
    low, high = segment_boxes(s)
    low = low - 2.0 * CLOSE
    meet = (low[:, None, 0] <= high[None, :, 0]) & (low[None, :, 0] <= high[:, None, 0])
    meet &= (low[:, None, 1] <= high[None, :, 1]) & (low[None, :, 1] <= high[:, None, 1])
    i, j = np.nonzero(np.triu(meet, 1))
    return i, j


def _off_carrier(s: Segments, rows: Ints, points: Floats) -> Floats:
    """Return how far points (k, 2) are from the line or circle on which the segments `rows` lie."""
    along = s.end[rows] - s.start[rows]
    size = np.hypot(along[:, 0], along[:, 1])
    to = points - s.start[rows]
    off = np.abs(along[:, 0] * to[:, 1] - along[:, 1] * to[:, 0]) / np.where(size > 0.0, size, 1.0)
    ray = points - s.centre[rows]
    return np.where(s.sweep[rows] == 0.0, off, np.abs(np.hypot(ray[:, 0], ray[:, 1]) - s.radius[rows]))


def place_on(s: Segments, rows: Ints, points: Floats) -> Floats:
    """Return the shares (k,) of the length at which points (k, 2) lie inside segments `rows`; NaN at the ends and beyond."""
    place = np.full(len(rows), np.nan)
    line = s.sweep[rows] == 0.0
    a = rows[line]
    along = (s.end[a] - s.start[a]) / np.maximum(s.length[a], np.finfo(float).tiny)[:, None]
    place[line] = ((points[line] - s.start[a]) * along).sum(axis=1)
    a = rows[~line]
    if len(a):
        ray, q = s.start[a] - s.centre[a], points[~line] - s.centre[a]
        angle = np.sign(s.sweep[a]) * np.arctan2(ray[:, 0] * q[:, 1] - ray[:, 1] * q[:, 0], (ray * q).sum(axis=1)) % FULL
        place[~line] = angle * s.radius[a]
    length = s.length[rows]
    with np.errstate(invalid="ignore"):
        place[(place <= CLOSE) | (place >= length - CLOSE)] = np.nan
        return place / length


def _lines_meet(s: Segments, a: Ints, b: Ints) -> list[Floats]:
    d, e = s.end[a] - s.start[a], s.end[b] - s.start[b]
    across = d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0]
    to = s.start[b] - s.start[a]
    ok = np.abs(across) > tolerance.COINCIDENT * s.length[a] * s.length[b]
    share = np.divide(to[:, 0] * e[:, 1] - to[:, 1] * e[:, 0], across, out=np.full(len(a), np.nan), where=ok)
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
    along = 0.5 * (apart + np.divide((ra - rb) * (ra + rb), apart, out=np.zeros_like(apart), where=ok))
    half = np.sqrt(np.maximum((ra - along) * (ra + along), 0.0))[:, None]
    middle = s.centre[a] + np.clip(along, -ra, ra)[:, None] * d
    across = np.stack([-d[:, 1], d[:, 0]], axis=1)
    return [middle + half * across, middle - half * across]
