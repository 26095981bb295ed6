"""Few arcs through many points of a smooth plane curve; compiled. Plain reference: `trunnion.geometry.plane.arc_fitting.arcs_through`
with `chords`."""

from __future__ import annotations

import math

from numba import njit

from trunnion.geometry.arrays import Floats, Ints

NO_ARC = math.inf
"""In place of a bulge: no arc passes all points."""

LARGEST = 10_000.0
"""mm: radius from which on an arc is a straight line or none: controls refuse centres that are far away."""


@njit(cache=True, nogil=True)
def arc_bulge(points: Floats, first: int, last: int, within: float, coincident: float) -> float:
    """Return the bulge of the line or arc from one of points (k, 2) to another, through the one in the middle between.

    `NO_ARC` where it doesn't pass all between, and the lines that join them, within a distance, turns by more than half a turn, or the ends
    coincide.
    """
    ax, ay = points[first, 0], points[first, 1]
    cx, cy = points[last, 0] - ax, points[last, 1] - ay
    size = math.hypot(cx, cy)
    if size < coincident:
        return NO_ARC
    ux, uy = cx / size, cy / size
    highest = 0.0
    for k in range(first, last + 1):
        across = (points[k, 1] - ay) * ux - (points[k, 0] - ax) * uy
        highest = max(highest, abs(across))
    if highest < 0.1 * within:
        return 0.0
    middle = first + (last - first + 1) // 2
    px, py = points[middle, 0] - ax, points[middle, 1] - ay
    x, y = px * ux + py * uy, py * ux - px * uy
    if abs(y) < 1e-9:
        return NO_ARC
    # Circle through (0, 0), (size, 0) and (x, y); its centre is (size / 2, k).
    k0 = (x * x + y * y - size * x) / (2.0 * y)
    radius = math.hypot(0.5 * size, k0)
    if radius > LARGEST:
        return 0.0 if highest <= within else NO_ARC
    sweep, before, bx, by = 0.0, 0.0, 0.0, 0.0
    for k in range(first, last + 1):
        px, py = points[k, 0] - ax, points[k, 1] - ay
        x, y = px * ux + py * uy - 0.5 * size, py * ux - px * uy - k0
        if abs(math.hypot(x, y) - radius) > within:
            return NO_ARC
        now = math.atan2(y, x)
        if k > first:
            # The straight line between two points counts too: an arc doesn't stand for a corner between them.
            if abs(math.hypot(0.5 * (x + bx), 0.5 * (y + by)) - radius) > within:
                return NO_ARC
            turn = (now - before + math.pi) % math.tau - math.pi
            if turn * sweep < 0.0:
                return NO_ARC
            sweep += turn
        before, bx, by = now, x, y
    if abs(sweep) > math.pi:
        return NO_ARC
    return math.tan(0.25 * sweep)


@njit(cache=True, nogil=True)
def arcs_through_loop(
    points: Floats, within: float, coincident: float, kept: Ints, bulges: Floats
) -> int:
    """Fill `kept` (k,) with rows of points (k, 2), first and last among them, and `bulges` (k,) with those of the arcs between, as long as
    the distance allows; return how many arcs there are."""
    count, at, last = 0, 0, len(points) - 1
    kept[0] = 0
    while at < last:
        best, bulge, step = at + 1, 0.0, 2
        while True:
            end = min(at + step, last)
            found = arc_bulge(points, at, end, within, coincident) if end > at + 1 else NO_ARC
            if found == NO_ARC:
                break
            best, bulge = end, found
            if end == last:
                break
            step *= 2
        low, high = best, min(at + step, last)
        while high - low > 1:
            middle = (low + high) // 2
            found = arc_bulge(points, at, middle, within, coincident)
            if found == NO_ARC:
                high = middle
            else:
                low, best, bulge = middle, middle, found
        bulges[count] = bulge
        count += 1
        kept[count] = best
        at = best
    return count
