"""Plane distance of points to lines and arcs, and winding numbers of loops made of them. Plain numpy
reference.

mm, rad. Segments as rows of `Segments`: start, end, centre (m, 2), radius (m,), sweep (m,) signed,
0 for a line.
"""

from __future__ import annotations

import numpy as np

from trunnion.geometry.arrays import Floats, Ints

BATCH = 1 << 18
"""Points times segments that are looked at together, so that the tables between stay in the processor's cache."""


def nearest_segment(
    points: Floats, start: Floats, end: Floats, centre: Floats, radius: Floats, sweep: Floats
) -> tuple[Floats, Ints]:
    """Return the distance (k,) mm from each point (k, 2) to the nearest segment, and its row (k,); of
    equal ones the first."""
    best = np.empty(len(points))
    row = np.empty(len(points), dtype=np.int64)
    step = max(1, BATCH // max(1, len(start)))
    for first in range(0, len(points), step):
        block = slice(first, first + step)
        away = _distances(points[block], start, end, centre, radius, sweep)
        row[block] = np.argmin(away, axis=1)
        best[block] = np.take_along_axis(away, row[block][:, None], axis=1)[:, 0]
    return best, row


def _distances(
    points: Floats, start: Floats, end: Floats, centre: Floats, radius: Floats, sweep: Floats
) -> Floats:
    """Return the distance (k, m) of each point to each segment.

    A line: to the foot of the perpendicular, its share held to 0 to 1. An arc: | |q| - radius |
    where the point's direction from the centre lies in its sector, else to the nearer end.
    """
    away = np.empty((len(points), len(start)))
    lines, arcs = np.flatnonzero(sweep == 0.0), np.flatnonzero(sweep != 0.0)
    px, py = points[:, :1], points[:, 1:]
    if len(lines):
        ax, ay = start[lines].T
        dx, dy = (end[lines] - start[lines]).T
        square = dx * dx + dy * dy
        share = ((px - ax) * dx + (py - ay) * dy) / np.where(square > 0.0, square, 1.0)
        share = np.clip(share, 0.0, 1.0)
        away[:, lines] = _length(px - ax - share * dx, py - ay - share * dy)
    if len(arcs):
        cx, cy = centre[arcs].T
        turned = np.sign(sweep[arcs])
        (ax, ay), (bx, by) = (start[arcs] - centre[arcs]).T, (end[arcs] - centre[arcs]).T
        # The sector by two cross products: within the half-planes of both ends, of either one where
        # the sweep is more than half a turn.
        qx, qy = px - cx, py - cy
        after_start = turned * (ax * qy - ay * qx) >= 0.0
        before_end = turned * (qx * by - qy * bx) >= 0.0
        wide = np.abs(sweep[arcs]) > np.pi
        in_sector = np.where(wide, after_start | before_end, after_start & before_end)
        to_end = np.minimum(_length(qx - ax, qy - ay), _length(qx - bx, qy - by))
        away[:, arcs] = np.where(in_sector, np.abs(_length(qx, qy) - radius[arcs]), to_end)
    return away


def _length(x: Floats, y: Floats) -> Floats:
    """Return the length of plane vectors."""
    # As the compiled loops have it: which of the two answers must not show in a single digit.
    return np.sqrt(x * x + y * y)


def winding_numbers(
    points: Floats, start: Floats, end: Floats, centre: Floats, radius: Floats, sweep: Floats
) -> Ints:
    """Return the winding number (k,) of the loops made of all the segments about each point (k, 2),
    anticlockwise positive.

    Loops of chords are counted by the signed crossings of a ray towards +x (Sunday, Inclusion of a
    point in a polygon, 2001); an arc adds the cap between its chord and itself: +1 inside the
    circle on the arc's side of the chord.
    """
    total = np.zeros(len(points), dtype=np.int64)
    step = max(1, BATCH // max(1, len(start)))
    (ax, ay), (bx, by) = start.T, end.T
    arcs = np.flatnonzero(sweep != 0.0)
    for first in range(0, len(points), step):
        block = slice(first, first + step)
        px, py = points[block, :1], points[block, 1:]
        # Twice the signed area of chord and point: above 0 the point is to the left. A crossing
        # takes in the lower end and leaves out the upper one, so a corner counts once.
        side = (bx - ax) * (py - ay) - (px - ax) * (by - ay)
        up = (ay <= py) & (by > py) & (side > 0.0)
        down = (ay > py) & (by <= py) & (side < 0.0)
        count = up.sum(axis=1) - down.sum(axis=1)
        if len(arcs):
            inside = _length(px - centre[arcs, 0], py - centre[arcs, 1]) < radius[arcs]
            # A point on the chord's line belongs to the side that the crossings above gave it to.
            level = side[:, arcs] == 0.0
            left = (side[:, arcs] > 0.0) | (level & ((by < ay) | ((by == ay) & (bx > ax)))[arcs])
            count += (inside & (sweep[arcs] > 0.0) & ~left).sum(axis=1)
            count -= (inside & (sweep[arcs] < 0.0) & left).sum(axis=1)
        total[block] = count
    return total
