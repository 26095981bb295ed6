"""From chords back to lines and arcs: how shapely's answers about plane areas become exact again.

In shapely's answer each edge is a chord that was put in, or a part of one, and so has a carrier. Runs of edges on one carrier
become one line or arc again; old vertices keep their coordinates, and new ones are the exact meeting points of their carriers.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import shapely

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.plane.chords import Chords
from trunnion.geometry.plane.curve import FULL, Curve, Segments, turn
from trunnion.geometry.plane.intersections import CLOSE, intersection


def restored(geometry: shapely.Geometry, chords: Chords) -> list[tuple[Curve, list[Curve]]]:
    """Return the polygons of a shapely answer as exact outer curves (anticlockwise), each with its holes (clockwise).

    Pieces and holes that are too small or too narrow to be more than noise are left out.
    """
    polygons = [
        p for p in shapely.get_parts(geometry) if p.geom_type == "Polygon" and not p.is_empty
    ]
    if not polygons:
        return []
    rings, owner = shapely.get_rings(polygons, return_index=True)
    coords, ring = shapely.get_coordinates(rings, return_index=True)
    edges = _Edges(coords, ring, chords)
    found_curves: list[tuple[Curve, list[Curve]]] = []
    previous = -1
    outer_kept = False
    for n, piece in enumerate(owner):
        curve = edges.curve(n)
        is_outer, previous = piece != previous, piece
        if is_outer:
            outer_kept = curve is not None
            if curve is not None:
                found_curves.append((curve if curve.area > 0.0 else curve.reversed(), []))
        elif curve is not None and outer_kept:
            found_curves[-1][1].append(curve if curve.area < 0.0 else curve.reversed())
    return found_curves


class _Edges:
    """The edges of rings, matched to the carriers they lie on."""

    def __init__(self, coords: Floats, ring: Ints, chords: Chords) -> None:
        self.chords = chords
        self.coords = coords
        bounds = np.flatnonzero(np.diff(ring)) + 1
        self.begin = np.concatenate([[0], bounds])
        self.stop = np.concatenate([bounds, [len(coords)]])
        table, index = np.unique(
            chords.points[:, 0] + 1j * chords.points[:, 1], return_inverse=True
        )
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
        known = np.minimum(index[head], index[head + 1]) * len(table) + np.maximum(
            index[head], index[head + 1]
        )
        # A bridge that lies on a real chord must not hide it.
        order = np.lexsort([chords.is_bridge[rows[head]], known])
        known = known[order]
        queried = np.minimum(at[edge], at[edge + 1]) * len(table) + np.maximum(
            at[edge], at[edge + 1]
        )
        slot = np.minimum(np.searchsorted(known, queried), len(known) - 1)
        hit = (known[slot] == queried) & self.is_old[edge] & self.is_old[edge + 1]
        chord = np.full(len(edge), -1)
        chord[hit] = head[order[slot[hit]]]
        if not hit.all():
            lost = edge[~hit]
            real = head[np.argsort(chords.is_bridge[rows[head]], kind="stable")]
            chord[~hit] = real[
                _nearest_chord(
                    coords[lost], coords[lost + 1], chords.points[real], chords.points[real + 1]
                )
            ]
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
        carrier, turned = self.carrier[begin : stop - 1], self.turn[begin : stop - 1]
        change = _changes(carrier, turned)
        if len(change) == 0:
            return _round(self.chords.source, int(self.row[begin]), int(turned[0]), points[0])
        runs = [
            _Run(int(self.row[begin + k]), int(turned[k]), points[k], bool(self.is_old[begin + k]))
            for k in change
        ]
        return _closed_curve(self.chords, runs)


def _changes(carrier: Ints, turned: Ints) -> Ints:
    """Return the positions in a ring where another carrier, or the same one in the other direction, begins."""
    before_carrier, before_turned = (
        np.concatenate([carrier[-1:], carrier[:-1]]),
        np.concatenate([turned[-1:], turned[:-1]]),
    )
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
    """Edges on one carrier: the source row, the sense of rotation (0 for a line), the point where it starts, and whether that is an old
    one."""

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
        starts = [
            run.start if run.is_exact else intersection(source, before.row, run.row, run.start)
            for before, run in zip([runs[-1], *runs[:-1]], runs, strict=True)
        ]
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
        is_speck = math.dist(after.start, run.start) <= CLOSE and not _goes_round(
            chords.source, run, after
        )
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
        if (
            not joined
            or carrier[joined[-1].row] != carrier[run.row]
            or joined[-1].turned != run.turned
        ):
            joined.append(run)
    while (
        len(joined) > 1
        and carrier[joined[0].row] == carrier[joined[-1].row]
        and joined[0].turned == joined[-1].turned
    ):
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
            if (
                wide > math.pi
                and wide > abs(_sweep(source, run, run.start, runs[after].start)) + math.pi
            ):
                return n
        elif (starts[after] - starts[n]) @ (runs[after].start - run.start) <= 0.0:
            return n
    return -1


def _goes_round(source: Segments, run: _Run, after: _Run) -> bool:
    """Return whether a run whose ends meet is nearly a full circle rather than a speck."""
    return bool(run.turned) and abs(_sweep(source, run, run.start, after.start)) > math.pi


def _sweep(source: Segments, run: _Run, start: Floats, end: Floats) -> float:
    """Return the signed angle in radians that an arc's run goes round from start to end."""
    a, b = start - source.centre[run.row], end - source.centre[run.row]
    angle = run.turned * math.atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1])
    return run.turned * (angle % FULL)


def _arc_or_line(
    source: Segments, run: _Run, start: Floats, end: Floats
) -> tuple[list[Floats], list[float]]:
    if not run.turned:
        return [start], [0.0]
    sweep = _sweep(source, run, start, end)
    if abs(sweep) <= 1.5 * math.pi:
        return [start], [math.tan(0.25 * sweep)]
    # A bulge says little about a nearly full circle, so that is given in two arcs.
    half = source.centre[run.row] + turn(start - source.centre[run.row], 0.5 * sweep)
    return [start, half], [math.tan(0.125 * sweep)] * 2
