"""Few arcs through many points of a smooth plane curve."""

from __future__ import annotations

import math

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.geometry.kernels import arc_fitting

_BETWEEN = np.arange(4) / 4.0


def along_arcs(points: Floats, headings: Floats) -> Floats:
    """Return points (4 k - 3, 2) along the arcs that join points (k, 2) with given directions (k, 2), the given ones among them.

    Where the directions at both ends differ from the chord's by unlike angles, the arc takes their mean.
    """
    chord = np.diff(points, axis=0)
    first, last = _turn(headings[:-1], chord), _turn(chord, headings[1:])
    half = 0.5 * (first + last)[:, None]
    share = _BETWEEN[None, :]
    # A point at a share of an arc with half sweep h, seen from its start: the chord to it is shorter by sin(share h) / sin(h) and turned.
    length = np.where(
        np.abs(half) > tolerance.PARAMETRIC,
        np.sin(share * half) / np.where(half == 0.0, 1.0, np.sin(half)),
        share,
    )
    angle = (share - 1.0) * half
    x, y = length * np.cos(angle), length * np.sin(angle)
    on = np.stack(
        [x * chord[:, :1] - y * chord[:, 1:], y * chord[:, :1] + x * chord[:, 1:]], axis=-1
    )
    return np.concatenate([(points[:-1, None] + on).reshape(-1, 2), points[-1:]])


def _turn(a: Floats, b: Floats) -> Floats:
    return np.arctan2(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], (a * b).sum(axis=1))


def arcs_through(
    points: Floats, within: float = tolerance.FITTED, *, chords: bool = False
) -> tuple[Floats, Floats]:
    """Return points (m, 2) out of `points` (k, 2), first and last among them, and bulges (m - 1,) of arcs that pass all within a distance.

    Every arc goes through its two ends and the point in the middle between them, and is as long as the distance allows. With `chords` the
    straight lines between points count too: an arc does not stand for a corner between two of them.
    """
    kept, bulges, at = [0], [], 0
    while at < len(points) - 1:
        best, bulge, step = at + 1, 0.0, 2
        while True:
            end = min(at + step, len(points) - 1)
            found = _arc(points[at : end + 1], within, chords) if end > at + 1 else None
            if found is None:
                break
            best, bulge = end, found
            if end == len(points) - 1:
                break
            step *= 2
        low, high = best, min(at + step, len(points) - 1)
        while high - low > 1:
            middle = (low + high) // 2
            found = _arc(points[at : middle + 1], within, chords)
            if found is None:
                high = middle
            else:
                low, best, bulge = middle, middle, found
        kept.append(best)
        bulges.append(bulge)
        at = best
    return points[kept], np.array(bulges)


def arcs_through_many(points: Floats, within: float) -> tuple[Floats, Floats]:
    """Return what `arcs_through` does with `chords`, by a compiled loop: for thousands of points. Arcs of over ten metres are lines."""
    kept, bulges = np.empty(len(points), dtype=np.int64), np.empty(len(points))
    count = arc_fitting.arcs_through_loop(
        np.ascontiguousarray(points), within, tolerance.COINCIDENT, kept, bulges
    )
    return points[kept[: count + 1]], bulges[:count]


def _arc(points: Floats, within: float, chords: bool) -> float | None:
    """Return the bulge of the line or arc from first to last point that passes all points, or their chords too, within a distance, or
    None."""
    start, end = points[0], points[-1]
    chord = end - start
    size = math.hypot(*chord)
    if size < tolerance.COINCIDENT:
        return None
    along, across = chord / size, np.array([-chord[1], chord[0]]) / size
    flat = np.stack([(points - start) @ along, (points - start) @ across], axis=1)
    if np.abs(flat[:, 1]).max() < 0.1 * within:
        return 0.0
    x, y = flat[len(flat) // 2]
    # Circle through (0, 0), (size, 0) and (x, y); its centre is (size / 2, k).
    if abs(y) < tolerance.PARAMETRIC:
        return None
    k = (x * x + y * y - size * x) / (2.0 * y)
    radius = math.hypot(0.5 * size, k)
    held = np.vstack([flat, 0.5 * (flat[1:] + flat[:-1])]) if chords else flat
    if np.abs(np.hypot(held[:, 0] - 0.5 * size, held[:, 1] - k) - radius).max() > within:
        return None
    angles = np.unwrap(np.arctan2(flat[:, 1] - k, flat[:, 0] - 0.5 * size))
    sweep = float(angles[-1] - angles[0])
    turns = np.diff(angles)
    if abs(sweep) > math.pi or ((turns > 0.0).any() and (turns < 0.0).any()):
        return None
    return math.tan(0.25 * sweep)
