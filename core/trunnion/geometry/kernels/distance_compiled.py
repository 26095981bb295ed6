"""The loops of `kernels.distance` compiled; same names, arguments and, to the last digit, answers.

Every operation is in the order of the reference, so that which of the two ran never shows.
"""

from __future__ import annotations

import math

import numpy as np
from numba import int64, njit, types

from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.kernels.kernel_arrays import BORROWED

# Any layout, read-only or not: without it every mixture of them that comes along is compiled anew, for a second each.
_PAIRS = types.Array(types.float64, 2, "A", readonly=True)
_NUMBERS = types.Array(types.float64, 1, "A", readonly=True)
_SIGNATURE = (_PAIRS, _PAIRS, _PAIRS, _PAIRS, _NUMBERS, _NUMBERS)

FEW_POINTS = 32
"""Points for which gathering the segments by height, or their boxes, would cost more than it spares."""
MOST_STRIPS = 1024
"""Strips of height that segments are gathered in: beyond it, most hold the same few segments."""
FLAT = 1e-6
"""rad: half the turn of an arc below which rounding hides where its circle meets its chord; the whole circle counts."""
ROUNDED = 1e-12
"""Of a circle's numbers: more than rounding can bring a point into it that lies over or under it."""
BLOCK = 16
"""Segments in a row that have a box together."""


@njit(**BORROWED)
def _length(x: float, y: float) -> float:
    """Return the length of a plane vector."""
    # Three times as fast as hypot, and these numbers neither overflow nor vanish.
    return math.sqrt(x * x + y * y)


@njit(cache=True, nogil=True)
def _boxes(
    start: Floats, end: Floats, centre: Floats, radius: Floats, sweep: Floats, size: int
) -> Floats:
    """Return the boxes (b, 4), low and high x, low and high y, that so many segments in a row are in, with all that rounding may add: an
    arc stays as near to its chord as r (1 - cos(sweep / 2)) up to half a turn."""
    count = (len(start) + size - 1) // size
    boxes = np.empty((count, 4))
    for n in range(count):
        boxes[n, 0], boxes[n, 1], boxes[n, 2], boxes[n, 3] = (
            math.inf,
            -math.inf,
            math.inf,
            -math.inf,
        )
        for i in range(n * size, min((n + 1) * size, len(start))):
            for axis in range(2):
                low = min(start[i, axis], end[i, axis])
                high = max(start[i, axis], end[i, axis])
                slack = ROUNDED * (abs(low) + abs(high) + 1.0)
                if sweep[i] != 0.0:
                    half = 0.5 * abs(sweep[i])
                    slack += ROUNDED * (abs(centre[i, axis]) + radius[i])
                    if FLAT < half < 0.5 * math.pi:
                        slack = radius[i] * (1.0 - math.cos(half)) + slack / math.sin(half)
                    else:
                        low, high = centre[i, axis] - radius[i], centre[i, axis] + radius[i]
                boxes[n, 2 * axis] = min(boxes[n, 2 * axis], low - slack)
                boxes[n, 2 * axis + 1] = max(boxes[n, 2 * axis + 1], high + slack)
    return boxes


@njit(types.Tuple((types.float64[::1], int64[::1]))(*_SIGNATURE), cache=True, nogil=True)
def nearest_segment(
    points: Floats, start: Floats, end: Floats, centre: Floats, radius: Floats, sweep: Floats
) -> tuple[Floats, Ints]:
    """Return the distance (k,) mm from each point (k, 2) to the nearest segment, and its row (k,); of
    equal ones the first.

    Of many segments those alone are looked at whose neighbours' box is no farther away than the nearest so far; a point begins with what
    was nearest to the one before it.
    """
    best = np.empty(len(points))
    row = np.empty(len(points), dtype=np.int64)
    size = BLOCK if len(points) >= FEW_POINTS else max(len(start), 1)
    boxes = _boxes(start, end, centre, radius, sweep, size)
    nearest = 0
    for k in range(len(points)):
        px, py = points[k]
        least = math.inf
        first = nearest // size
        for n in range(-1, len(boxes)):
            # The block of the point before comes first, and once.
            if n == first:
                continue
            block = first if n < 0 else n
            if n >= 0:
                aside = max(boxes[block, 0] - px, px - boxes[block, 1], 0.0)
                above = max(boxes[block, 2] - py, py - boxes[block, 3], 0.0)
                if _length(aside, above) > least:
                    continue
            for i in range(block * size, min((block + 1) * size, len(start))):
                if sweep[i] == 0.0:
                    # A line: the foot of the perpendicular, held to the segment. One of no length
                    # is a point.
                    dx, dy = end[i, 0] - start[i, 0], end[i, 1] - start[i, 1]
                    square = dx * dx + dy * dy
                    share = ((px - start[i, 0]) * dx + (py - start[i, 1]) * dy) / (
                        square if square > 0.0 else 1.0
                    )
                    share = min(max(share, 0.0), 1.0)
                    away = _length(px - start[i, 0] - share * dx, py - start[i, 1] - share * dy)
                else:
                    # An arc: in its sector the circle is nearest, else an end.
                    qx, qy = px - centre[i, 0], py - centre[i, 1]
                    ax, ay = start[i, 0] - centre[i, 0], start[i, 1] - centre[i, 1]
                    bx, by = end[i, 0] - centre[i, 0], end[i, 1] - centre[i, 1]
                    turned = 1.0 if sweep[i] > 0.0 else -1.0
                    after_start = turned * (ax * qy - ay * qx) >= 0.0
                    before_end = turned * (qx * by - qy * bx) >= 0.0
                    in_sector = (
                        after_start or before_end
                        if abs(sweep[i]) > math.pi
                        else after_start and before_end
                    )
                    if in_sector:
                        away = abs(_length(qx, qy) - radius[i])
                    else:
                        away = min(_length(qx - ax, qy - ay), _length(qx - bx, qy - by))
                if away < least or (away == least and i < nearest):
                    least, nearest = away, i
        best[k], row[k] = least, nearest
    return best, row


@njit(cache=True, nogil=True)
def _heights(
    start: Floats, end: Floats, centre: Floats, radius: Floats, sweep: Floats
) -> tuple[Floats, Floats]:
    """Return between which heights y (n,) a segment can count for a winding number: beyond them are neither its chord nor the cap between
    chord and arc, which rises over the chord by r (1 - cos(sweep / 2)) up to half a turn."""
    low, high = np.empty(len(start)), np.empty(len(start))
    for i in range(len(start)):
        low[i], high[i] = min(start[i, 1], end[i, 1]), max(start[i, 1], end[i, 1])
        if sweep[i] != 0.0:
            half, slack = 0.5 * abs(sweep[i]), ROUNDED * (abs(centre[i, 1]) + radius[i])
            if FLAT < half < 0.5 * math.pi:
                rise = radius[i] * (1.0 - math.cos(half)) + slack / math.sin(half)
                low[i], high[i] = low[i] - rise, high[i] + rise
            else:
                low[i] = centre[i, 1] - radius[i] - slack
                high[i] = centre[i, 1] + radius[i] + slack
    return low, high


@njit(cache=True, nogil=True)
def _in_strips(
    low: Floats, high: Floats, bottom: float, width: float, count: int
) -> tuple[Ints, Ints]:
    """Return the segments of each of some strips of height, one after the other, and where each strip's begin (count + 1,)."""
    begin = np.zeros(count + 1, dtype=np.int64)
    for i in range(len(low)):
        for s in range(
            _strip(low[i], bottom, width, count), _strip(high[i], bottom, width, count) + 1
        ):
            begin[s + 1] += 1
    begin = np.cumsum(begin)
    rows, filled = np.empty(begin[count], dtype=np.int64), begin.copy()
    for i in range(len(low)):
        for s in range(
            _strip(low[i], bottom, width, count), _strip(high[i], bottom, width, count) + 1
        ):
            rows[filled[s]] = i
            filled[s] += 1
    return rows, begin


@njit(**BORROWED)
def _strip(y: float, bottom: float, width: float, count: int) -> int:
    """Return the strip that a height is in; monotone in y, so that a point is in one of its segment's strips whatever is rounded."""
    return min(max(int((y - bottom) / width), 0), count - 1)


@njit(int64[::1](*_SIGNATURE), cache=True, nogil=True)
def winding_numbers(
    points: Floats, start: Floats, end: Floats, centre: Floats, radius: Floats, sweep: Floats
) -> Ints:
    """Return the winding number (k,) of the loops made of all the segments about each point (k, 2),
    anticlockwise positive.

    Of many points each is held against the segments at its height alone; the others count nothing.
    """
    total = np.zeros(len(points), dtype=np.int64)
    if len(start) == 0:
        return total
    low, high = _heights(start, end, centre, radius, sweep)
    bottom, top = low.min(), high.max()
    strips = 1 if len(points) < FEW_POINTS or not top > bottom else min(len(start), MOST_STRIPS)
    width = (top - bottom) / strips if strips > 1 else 1.0
    rows, begin = _in_strips(low, high, bottom, width, strips)
    for k in range(len(points)):
        px, py = points[k]
        if not bottom <= py <= top:
            continue
        strip, count = _strip(py, bottom, width, strips), 0
        for n in range(begin[strip], begin[strip + 1]):
            i = rows[n]
            ax, ay, bx, by = start[i, 0], start[i, 1], end[i, 0], end[i, 1]
            side = (bx - ax) * (py - ay) - (px - ax) * (by - ay)
            # Crossings of a ray towards +x with the chord, upwards +1, downwards -1.
            if ay <= py < by and side > 0.0:
                count += 1
            elif by <= py < ay and side < 0.0:
                count -= 1
            # The cap between chord and arc; a point on the chord's line belongs to the side that
            # the crossing above gave it to.
            if sweep[i] != 0.0 and _length(px - centre[i, 0], py - centre[i, 1]) < radius[i]:
                left = side > 0.0 or (side == 0.0 and (by < ay or (by == ay and bx > ax)))
                if sweep[i] > 0.0 and not left:
                    count += 1
                elif sweep[i] < 0.0 and left:
                    count -= 1
        total[k] = count
    return total
