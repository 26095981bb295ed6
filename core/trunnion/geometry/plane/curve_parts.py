"""Parts of a plane curve: positions along it, and where something holds of them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats, items_of
from trunnion.geometry.plane.curve import Curve, segment_boxes
from trunnion.geometry.plane.region import Region

SPACING = 0.5
"""mm between the positions of a curve that are looked at; the ends of its parts are then found to `END`."""

CLIP_SPACING = 1.0
"""mm between the positions that are looked at where a part's ends need not be exact: a clip is wider than what is wanted."""

END = tolerance.SHORT_MOVE
"""mm: how exactly the end of a part of a curve is found."""

SHORTEST = 0.05
"""mm: a part of a curve shorter than this is not worth a cut."""


def points_along(curve: Curve, spacing: float = SPACING) -> tuple[Floats, Floats]:
    """Return arc lengths (k,) no farther apart than `spacing`, every vertex among them, and the points (k, 2) there.

    Of a closed curve the first point does not come again.
    """
    seg = curve.segments()
    count = np.maximum(np.ceil(seg.length / spacing), 1).astype(np.int64)
    rows, number = items_of(count)
    share = number / count[rows]
    before = np.cumsum(seg.length) - seg.length
    lengths = before[rows] + share * seg.length[rows]
    points = seg.at(rows, share * seg.length[rows])
    if curve.closed:
        return lengths, points
    return np.append(lengths, seg.length.sum()), np.vstack([points, seg.end[-1:]])


def parts_where(
    curve: Curve, keep: Callable[[Floats], Floats], spacing: float = SPACING
) -> list[Curve]:
    """Return the parts of a curve where `keep` of its points (k, 2) is at least 0, in order; the curve itself when that is everywhere."""
    s, points = points_along(curve, spacing)
    inside = keep(points) >= 0.0
    if inside.all():
        return [curve]
    if not inside.any():
        return []
    total = curve.length
    if curve.closed:
        s, inside = np.append(s, total), np.append(inside, inside[0])
    changes = np.flatnonzero(inside[1:] != inside[:-1])
    low, high, starts_inside = s[changes], s[changes + 1], inside[changes]
    while float((high - low).max()) > END:
        middle = 0.5 * (low + high)
        same = (keep(_points_at(curve, middle)) >= 0.0) == starts_inside
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    # The end that lies inside, so that a part never stands out of where it may be.
    ends = np.where(starts_inside, low, high)
    marks = list(ends)
    if curve.closed:
        if starts_inside[0]:
            marks = marks[1:] + [marks[0] + total]
    else:
        marks = ([0.0] if inside[0] else []) + marks + ([total] if inside[-1] else [])
    return [
        curve.split(a, b) for a, b in zip(marks[::2], marks[1::2], strict=True) if b - a > SHORTEST
    ]


def parts_near(curve: Curve, clip: Region, keep: Callable[[Floats], Floats]) -> list[Curve]:
    """Return the parts of a curve where `keep` is at least 0, which it nowhere is outside the box of a clip."""
    low, high = clip.box()
    first, last = segment_boxes(curve.segments())
    if ((first > high) | (last < low)).any(axis=1).all():
        return []
    return parts_where(curve, keep, CLIP_SPACING)


def _points_at(curve: Curve, lengths: Floats) -> Floats:
    seg = curve.segments()
    ends = np.cumsum(seg.length)
    rows = np.minimum(np.searchsorted(ends, lengths, side="right"), len(seg) - 1)
    return seg.at(rows, lengths - (ends[rows] - seg.length[rows]))
