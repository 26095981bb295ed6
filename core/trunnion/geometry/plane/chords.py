"""Lines and arcs opened into chords that remember where they came from, so that shapely can find the topology of plane areas.

Every chord knows its carrier, the line or circle it came from. Segments are cut at the exact points where they meet, and arcs on
one circle are opened at the same angles, so that walls that lie on each other get the very same chords.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints, items_of
from trunnion.geometry.kernels.point_groups import first_of_group
from trunnion.geometry.plane.curve import FULL, Segments, chord_counts, compiled_pays
from trunnion.geometry.plane.intersections import CLOSE, crossings, overlapping_boxes

GROUPED = 1 << 6
"""What one point costs the plain loop, in the measure of `compiled_pays`."""


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


def chorded(
    source: Segments, is_bridge: Bools | None = None, chord: float = tolerance.PLANE_REGION
) -> Chords:
    """Return segments opened into chords so that positions where they lie on each other get the same chords."""
    m = len(source)
    ends = pulled_together(np.concatenate([source.start, source.end]))
    start, end = ends[:m], ends[m:]
    pairs = overlapping_boxes(source)
    centre, radius, carrier = _shared_carriers(start, end, source, pairs)
    joined = Segments(start, end, centre, radius, source.sweep, source.length)
    bridges = np.zeros(m, dtype=bool) if is_bridge is None else is_bridge
    carrier = np.where(bridges, m + np.arange(m), carrier)
    inner_row, inner_key, inner_point = _inner_points(joined, chord)
    meet_row, meet_key, meet_point = crossings(joined, pairs)
    row = np.concatenate([np.arange(m), np.arange(m), inner_row, meet_row])
    key = np.concatenate([np.zeros(m), np.ones(m), inner_key, meet_key])
    exact = pulled_together(np.concatenate([ends, meet_point]))
    point = np.concatenate([exact[: 2 * m], inner_point, exact[2 * m :]])
    order = np.lexsort([key, row])
    row, point, is_inner = (
        row[order],
        point[order],
        (order >= 2 * m) & (order < 2 * m + len(inner_row)),
    )
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
    if not compiled_pays(GROUPED * len(points)):
        return points[first_of_group(points, CLOSE)]
    from trunnion.geometry.kernels.point_groups_compiled import first_of_group_loop

    order = np.argsort(points[:, 0], kind="stable")
    return points[first_of_group_loop(points, order, CLOSE)]


def _shared_carriers(
    start: Floats, end: Floats, s: Segments, pairs: tuple[Ints, Ints]
) -> tuple[Floats, Floats, Ints]:
    """Number the carriers, and give arcs that lie on the same circle within the coincidence tolerance its centre and radius."""
    centre, radius = s.centre.copy(), s.radius.copy()
    carrier = np.arange(len(s))
    i, j = pairs
    with np.errstate(invalid="ignore"):
        arcs = (np.abs(radius[i] - radius[j]) <= CLOSE) & (
            np.abs(centre[i] - centre[j]).max(axis=1) <= CLOSE
        )
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
    around = Segments(
        s.start[arcs], s.end[arcs], s.centre[arcs], radius, np.full(len(arcs), FULL), radius
    )
    parts = np.maximum(8, chord_counts(around, chord))
    step = FULL / parts
    ray = s.start[arcs] - s.centre[arcs]
    begin = np.arctan2(ray[:, 1], ray[:, 0])
    low, high = np.minimum(begin, begin + sweep), np.maximum(begin, begin + sweep)
    # A grid point closer to an end than a hundredth of a step gives way to it.
    first = np.ceil(low / step + 0.01).astype(np.int64)
    last = np.floor(high / step - 0.01).astype(np.int64)
    count = np.maximum(0, last - first + 1)
    row, number = items_of(count)
    number = first[row] + number
    angle = (number % parts[row]) * step[row]
    point = s.centre[arcs][row] + radius[row, None] * np.stack(
        [np.cos(angle), np.sin(angle)], axis=1
    )
    key = (number * step[row] - begin[row]) / sweep[row]
    return arcs[row], key, point


def polygons_of(chords: Chords, loops: Sequence[Sequence[range]]) -> shapely.Geometry:
    """Return the shapely area of pieces given as rows of the chords' segments: for each piece its outer loop, then its holes."""
    polygons = []
    for piece in loops:
        rings = [
            np.concatenate([chords.points[chords.first[i] : chords.first[i + 1] - 1] for i in loop])
            for loop in piece
        ]
        rings = [ring for ring in rings if len(ring) >= 3]
        if rings:
            polygons.append(shapely.Polygon(rings[0], rings[1:]))
    area = shapely.MultiPolygon(polygons)
    return (
        area
        if area.is_valid
        else shapely.make_valid(area, method="structure", keep_collapsed=False)
    )
