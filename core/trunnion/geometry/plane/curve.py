"""Curves of lines and arcs in the plane: where they go, how long they are, how far a point is from them.

A curve is a row of points with one bulge a segment, as polylines of DXF have it: the bulge is tan(sweep / 4), positive for an
anticlockwise arc and 0 for a line. Arcs are never opened into chords here.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from types import ModuleType

import numpy as np
from numpy.typing import ArrayLike

from trunnion import tolerance
from trunnion.geometry.arrays import Floats, Ints, floats, items_of
from trunnion.geometry.kernels import distance as distance_kernels

FULL = 2.0 * math.pi

COMPILED_FROM = 1 << 21
"""Work, in points times segments, after which the compiled loops are loaded: the plain ones have taken 0.2 s then, as loading does."""

QUESTION = 1 << 10
"""What every question to the plain loops costs besides, in the same measure."""


@dataclass(frozen=True, slots=True, eq=False)
class Segments:
    """The lines and arcs of a curve, in order, as arrays of one row each.

    `start`, `end` (m, 2) mm; `centre` (m, 2) and `radius` (m,) NaN for lines; `sweep` (m,) radians, positive anticlockwise,
    0 for lines; `length` (m,) mm.
    """

    start: Floats
    end: Floats
    centre: Floats
    radius: Floats
    sweep: Floats
    length: Floats

    def __len__(self) -> int:
        return len(self.start)

    def __getitem__(self, rows: slice | Ints) -> Segments:
        return Segments(
            self.start[rows],
            self.end[rows],
            self.centre[rows],
            self.radius[rows],
            self.sweep[rows],
            self.length[rows],
        )

    def at(self, rows: Ints, s: Floats) -> Floats:
        """Return the points (k, 2) at arc lengths `s` (k,) from the start of the segments `rows` (k,)."""
        start, length = self.start[rows], self.length[rows]
        share = np.divide(s, length, out=np.zeros_like(length), where=length > 0.0)
        on_line = start + share[:, None] * (self.end[rows] - start)
        is_arc = self.sweep[rows] != 0.0
        if not is_arc.any():
            return on_line
        centre = self.centre[rows]
        turned = centre + turn(start - centre, share * self.sweep[rows])
        return np.where(is_arc[:, None], turned, on_line)

    def directions(self, rows: Ints, s: Floats) -> Floats:
        """Return the unit tangents (k, 2) at arc lengths `s` (k,) from the start of the segments `rows` (k,)."""
        chord = self.end[rows] - self.start[rows]
        angle = np.arctan2(chord[:, 1], chord[:, 0])
        length = self.length[rows]
        share = np.divide(s, length, out=np.zeros_like(length), where=length > 0.0)
        angle = angle + (share - 0.5) * self.sweep[rows]
        return np.stack([np.cos(angle), np.sin(angle)], axis=1)


def segments_of(start: Floats, end: Floats, bulge: Floats) -> Segments:
    """Return the lines and arcs between points `start` and `end` (m, 2) with bulges (m,)."""
    chord = end - start
    size = np.hypot(chord[:, 0], chord[:, 1])
    is_arc = np.abs(bulge) > tolerance.PARAMETRIC
    b = np.where(is_arc, bulge, np.nan)
    across = np.stack([-chord[:, 1], chord[:, 0]], axis=1)
    centre = 0.5 * (start + end) + across * ((1.0 - b * b) / (4.0 * b))[:, None]
    radius = size * (1.0 + b * b) / (4.0 * np.abs(b))
    sweep = np.where(is_arc, 4.0 * np.arctan(bulge), 0.0)
    length = np.where(is_arc, radius * np.abs(sweep), size)
    return Segments(start, end, centre, radius, sweep, length)


def join_segments(parts: Iterable[Segments]) -> Segments:
    """Return the segments of several curves in one."""
    rows = list(parts)
    if not rows:
        nothing = np.empty((0, 2))
        return Segments(nothing, nothing, nothing, np.empty(0), np.empty(0), np.empty(0))
    return Segments(*(np.concatenate([getattr(r, n) for r in rows]) for n in Segments.__slots__))


def turn(vectors: Floats, angles: Floats | float) -> Floats:
    """Return vectors (k, 2) turned anticlockwise by angles (k,) in radians."""
    c, s = np.cos(angles), np.sin(angles)
    return np.stack(
        [c * vectors[..., 0] - s * vectors[..., 1], s * vectors[..., 0] + c * vectors[..., 1]],
        axis=-1,
    )


@dataclass(frozen=True, slots=True, eq=False)
class Curve:
    """A curve of lines and arcs, open or closed.

    `points` (n, 2) mm; `bulges` (n,): bulge i belongs to the segment from point i to point i + 1, of a closed curve the last
    one leads back to the first point, of an open curve the last one is 0. Raises `ValueError` when there are too few points
    (2 for an open curve, 2 for a closed one with an arc, else 3) or a number isn't finite.
    """

    points: Floats
    bulges: Floats
    closed: bool = False
    _segments: list[Segments] = field(init=False, repr=False, default_factory=list)
    _area: list[float] = field(init=False, repr=False, default_factory=list)
    _box: list[tuple[Floats, Floats]] = field(init=False, repr=False, default_factory=list)

    def __post_init__(self) -> None:
        points = floats(self.points, (None, 2), "curve points")
        bulges = floats(self.bulges, (len(points),), "curve bulges")
        if len(points) < 2 or (self.closed and len(points) < 3 and not bulges.any()):
            raise ValueError(
                f"curve points: {len(points)} are too few for {'a closed' if self.closed else 'an open'} curve"
            )
        if not self.closed and bulges[-1] != 0.0:
            raise ValueError(
                "curve bulges: the last one of an open curve belongs to no segment and must be 0"
            )
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "bulges", bulges)

    @staticmethod
    def circle(centre: ArrayLike, radius: float) -> Curve:
        """Return a full circle, anticlockwise, as two half circles from its rightmost point."""
        if not radius > 0.0:
            raise ValueError(f"circle radius: must be above 0, got {radius}")
        x, y = np.asarray(centre, dtype=np.float64)
        return Curve(np.array([[x + radius, y], [x - radius, y]]), np.ones(2), True)

    @staticmethod
    def rectangle(x0: float, y0: float, x1: float, y1: float) -> Curve:
        """Return a rectangle, anticlockwise from its lowest corner."""
        if not (x1 > x0 and y1 > y0):
            raise ValueError(
                f"rectangle: the second corner must be above and right of the first, got ({x0}, {y0}) and ({x1}, {y1})"
            )
        return Curve.polygon([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])

    @staticmethod
    def polygon(points: ArrayLike) -> Curve:
        """Return the closed curve of straight lines through points (n, 2)."""
        array = np.asarray(points, dtype=np.float64)
        return Curve(array, np.zeros(len(array)), True)

    @staticmethod
    def polyline(points: ArrayLike) -> Curve:
        """Return the open curve of straight lines through points (n, 2)."""
        array = np.asarray(points, dtype=np.float64)
        return Curve(array, np.zeros(len(array)), False)

    @property
    def n_segments(self) -> int:
        """The number of lines and arcs."""
        return len(self.points) if self.closed else len(self.points) - 1

    @property
    def start(self) -> Floats:
        """The first point (2,)."""
        return self.points[0]

    @property
    def end(self) -> Floats:
        """The last point (2,); of a closed curve the first one."""
        return self.points[0] if self.closed else self.points[-1]

    @property
    def length(self) -> float:
        """The arc length in mm."""
        return float(self.segments().length.sum())

    @property
    def area(self) -> float:
        """The enclosed area in mm2, positive anticlockwise; raises `ValueError` for an open curve."""
        if not self.closed:
            raise ValueError("area: the curve is open")
        if not self._area:
            self._area.append(self._measured_area())
        return self._area[0]

    def _measured_area(self) -> float:
        # From the first point, so that a small curve far from the origin loses no digits.
        s = self.segments()
        a, b = s.start - self.points[0], s.end - self.points[0]
        straight = 0.5 * float(np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]))
        arcs = s.sweep != 0.0
        return straight + 0.5 * float(
            np.sum(s.radius[arcs] ** 2 * (s.sweep[arcs] - np.sin(s.sweep[arcs])))
        )

    def segments(self) -> Segments:
        """Return the lines and arcs as arrays."""
        if not self._segments:
            p, b = self.points, self.bulges
            last = np.roll(p, -1, axis=0) if self.closed else p[1:]
            self._segments.append(
                segments_of(p if self.closed else p[:-1], last, b if self.closed else b[:-1])
            )
        return self._segments[0]

    def box(self) -> tuple[Floats, Floats]:
        """Return the lowest and highest corner of the box around the curve."""
        if not self._box:
            low, high = segment_boxes(self.segments())
            self._box.append((low.min(axis=0), high.max(axis=0)))
        return self._box[0]

    def reversed(self) -> Curve:
        """Return the same curve in the other direction; a closed one still starts at its first point."""
        if self.closed:
            return Curve(np.roll(self.points[::-1], 1, axis=0), -self.bulges[::-1], True)
        return Curve(self.points[::-1], np.append(-self.bulges[-2::-1], 0.0), False)

    def moved(self, dx: float, dy: float) -> Curve:
        """Return the curve moved by a vector."""
        return replace(self, points=self.points + np.array([dx, dy]))

    def rotated(self, angle: float, centre: ArrayLike = (0.0, 0.0)) -> Curve:
        """Return the curve turned anticlockwise by an angle in radians about a point."""
        c = np.asarray(centre, dtype=np.float64)
        return replace(self, points=c + turn(self.points - c, angle))

    def mirrored(self, axis: int = 0) -> Curve:
        """Return the curve with the coordinate `axis` (0: x, 1: y) negated; an anticlockwise curve becomes clockwise."""
        sign = np.ones(2)
        sign[axis] = -1.0
        return replace(self, points=self.points * sign, bulges=-self.bulges)

    def at(self, s: float) -> tuple[Floats, Floats]:
        """Return the point (2,) and the unit tangent (2,) at an arc length; it wraps on a closed curve and is clipped on an open one."""
        row, rest = self._locate(s)
        rows = np.array([row])
        segments = self.segments()
        return segments.at(rows, np.array([rest]))[0], segments.directions(rows, np.array([rest]))[
            0
        ]

    def split(self, s0: float, s1: float) -> Curve:
        """Return the open piece from arc length `s0` to `s1`.

        On a closed curve it runs forward and wraps; `s1 <= s0` then means the next time round (equal: the whole curve opened
        there). On an open curve both are clipped and `ValueError` is raised when nothing is left between.
        """
        total = self.length
        if self.closed:
            s0 = s0 % total
            span = (s1 - s0) % total
            span = total if span <= tolerance.PARAMETRIC * total else span
        else:
            s0, s1 = min(max(s0, 0.0), total), min(max(s1, 0.0), total)
            span = s1 - s0
            if span <= 0.0:
                raise ValueError(f"split: nothing lies between {s0} and {s1}")
        return self._piece(s0, span)

    def _piece(self, s0: float, span: float) -> Curve:
        seg = self.segments()
        starts = np.concatenate([[0.0], np.cumsum(seg.length)])
        total = starts[-1]
        twice = np.concatenate([starts[:-1], starts[:-1] + total]) if self.closed else starts[:-1]
        low, high = (
            np.maximum(twice, s0),
            np.minimum(twice + np.tile(seg.length, len(twice) // len(seg)), s0 + span),
        )
        kept = np.flatnonzero(high - low > tolerance.PARAMETRIC)
        if len(kept) == 0:
            raise ValueError(f"split: the piece of {span} mm is too short")
        rows = kept % len(seg)
        first, last = low[kept] - twice[kept], high[kept] - twice[kept]
        whole = (first <= tolerance.PARAMETRIC) & (last >= seg.length[rows] - tolerance.PARAMETRIC)
        begin = np.where(
            (first <= tolerance.PARAMETRIC)[:, None], seg.start[rows], seg.at(rows, first)
        )
        end = np.where(
            (last >= seg.length[rows] - tolerance.PARAMETRIC)[:, None],
            seg.end[rows],
            seg.at(rows, last),
        )
        share = np.where(whole, 1.0, (last - first) / seg.length[rows])
        bulges = np.tan(0.25 * share * seg.sweep[rows])
        return Curve(np.concatenate([begin, end[-1:]]), np.append(bulges, 0.0), False)

    def sampled(self, chord: float) -> Floats:
        """Return points (k, 2) on the curve with chords no farther than `chord` mm from it, every vertex among them.

        Of a closed curve the first point comes again at the end.
        """
        seg = self.segments()
        count = chord_counts(seg, chord)
        rows, step = items_of(count)
        inner = seg.at(rows, step / count[rows] * seg.length[rows])
        inner[step == 0] = seg.start
        return np.concatenate([inner, seg.end[-1:]])

    def distance(self, points: ArrayLike) -> Floats:
        """Return the exact distances (k,) of points (k, 2) from the curve."""
        return distance_to(self.segments(), np.atleast_2d(np.asarray(points, dtype=np.float64)))

    def nearest(self, point: ArrayLike) -> float:
        """Return the arc length of the position on the curve that is nearest to a point (2,)."""
        p = np.asarray(point, dtype=np.float64)
        seg = self.segments()
        row = int(_loops(seg, p[None, :]).nearest_segment(p[None, :], *_rows(seg))[1][0])
        before = float(seg.length[:row].sum())
        start, sweep, length = seg.start[row], float(seg.sweep[row]), float(seg.length[row])
        if sweep == 0.0:
            along = (seg.end[row] - start) / max(length, tolerance.PARAMETRIC)
            return before + min(max(float((p - start) @ along), 0.0), length)
        a, b = start - seg.centre[row], p - seg.centre[row]
        angle = (
            math.copysign(1.0, sweep) * math.atan2(a[0] * b[1] - a[1] * b[0], float(a @ b)) % FULL
        )
        if angle > abs(sweep):
            return before + (
                length if np.hypot(*(p - seg.end[row])) < np.hypot(*(p - start)) else 0.0
            )
        return before + angle * float(seg.radius[row])

    def _locate(self, s: float) -> tuple[int, float]:
        length = self.segments().length
        ends = np.cumsum(length)
        s = s % ends[-1] if self.closed else min(max(s, 0.0), float(ends[-1]))
        row = min(int(np.searchsorted(ends, s, side="right")), len(ends) - 1)
        return row, float(s - (ends[row] - length[row]))


def chord_counts(segments: Segments, chord: float) -> Ints:
    """Return how many chords (m,) open each segment so that none is farther than `chord` mm from its arc."""
    if not chord > 0.0:
        raise ValueError(f"chord: must be above 0, got {chord}")
    arcs = segments.sweep != 0.0
    count = np.ones(len(segments), dtype=np.int64)
    step = 2.0 * np.arccos(np.clip(1.0 - chord / segments.radius[arcs], 0.5, 1.0))
    count[arcs] = np.maximum(1, np.ceil(np.abs(segments.sweep[arcs]) / step)).astype(np.int64)
    return count


def segment_boxes(segments: Segments) -> tuple[Floats, Floats]:
    """Return the lowest and highest corners (m, 2) of the boxes around each line and arc."""
    low, high = np.minimum(segments.start, segments.end), np.maximum(segments.start, segments.end)
    arcs = np.flatnonzero(segments.sweep != 0.0)
    if len(arcs) == 0:
        return low, high
    centre, radius, sweep = segments.centre[arcs], segments.radius[arcs], segments.sweep[arcs]
    ray = segments.start[arcs] - centre
    first = np.arctan2(ray[:, 1], ray[:, 0])
    for quarter, (axis, side) in enumerate(((0, 1.0), (1, 1.0), (0, -1.0), (1, -1.0))):
        ahead = np.sign(sweep) * (quarter * 0.5 * math.pi - first) % FULL
        reached = ahead <= np.abs(sweep)
        at = centre[reached, axis] + side * radius[reached]
        rows = arcs[reached]
        if side > 0.0:
            high[rows, axis] = np.maximum(high[rows, axis], at)
        else:
            low[rows, axis] = np.minimum(low[rows, axis], at)
    return low, high


def distance_to(segments: Segments, points: Floats) -> Floats:
    """Return the exact distances (k,) of points (k, 2) from the nearest line or arc."""
    return _loops(segments, points).nearest_segment(points, *_rows(segments))[0]


def winding(segments: Segments, points: Floats) -> Ints:
    """Return how often closed loops, given by all their segments, go round points (k, 2), anticlockwise counted positive."""
    return _loops(segments, points).winding_numbers(points, *_rows(segments))


def signed_distance(segments: Segments, points: Floats) -> Floats:
    """Return the distances (k,) of points (k, 2) from closed loops, given by all their segments, positive on the left of them."""
    return np.where(winding(segments, points) > 0, 1.0, -1.0) * distance_to(segments, points)


_work = 0


def compiled_pays(work: int) -> bool:
    """Return whether plain loops have done so much, with some work more, that loading the compiled ones pays: both give the very same
    numbers."""
    global _work
    if _work < COMPILED_FROM:
        _work += QUESTION + work
    return _work >= COMPILED_FROM


def _loops(segments: Segments, points: Floats) -> ModuleType:
    """Return the plain loops until loading the compiled ones pays, then those."""
    if not compiled_pays(len(segments) * len(points)):
        return distance_kernels
    from trunnion.geometry.kernels import distance_compiled

    return distance_compiled


def _rows(s: Segments) -> tuple[Floats, Floats, Floats, Floats, Floats]:
    return s.start, s.end, s.centre, s.radius, s.sweep


def joined(curves: Sequence[Curve]) -> Curve:
    """Return open curves put end to end as one; closed when the last end meets the first start.

    Raises `ValueError` when two neighbours do not meet within the coincidence tolerance or there is none.
    """
    if not curves:
        raise ValueError("joined: there is no curve to join")
    for n, (a, b) in enumerate(pairwise(curves)):
        if a.closed or b.closed or np.hypot(*(a.end - b.start)) > tolerance.COINCIDENT:
            raise ValueError(
                f"joined: the end of curve {n + 1} does not meet the start of the next one"
            )
    if len(curves) == 1 and curves[0].closed:
        return curves[0]
    points = np.concatenate([c.points[:-1] for c in curves] + [curves[-1].points[-1:]])
    bulges = np.concatenate([c.bulges[:-1] for c in curves] + [np.zeros(1)])
    if len(points) > 2 and np.hypot(*(points[-1] - points[0])) <= tolerance.COINCIDENT:
        return Curve(points[:-1], bulges[:-1], True)
    return Curve(points, bulges, False)
