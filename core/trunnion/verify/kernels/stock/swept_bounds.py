"""Compiled bounds of what a piece of a tool sweeps in a span: where rays need to be looked at, and where on them. mm, rad.

A span is a short piece of a move, in the coordinates (u, v, w) of a bundle whose rays run along w.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Floats
from trunnion.geometry.kernels.kernel_arrays import BORROWED
from trunnion.verify.kernels.body import (
    CLOSED_FIRST,
    CLOSED_LAST,
    R_MAX,
    Z_HIGH,
    Z_LOW,
    radius_at,
)

# Columns of a span: tip and tool frame (its rows: two axes across, the tool axis) at both ends,
# then the boxes of what cuts, of all and of the tip's path. Of an arc that runs level about an axis
# of the blank, the whole is one span: centre, direction of its middle, then radius and cosine of
# half its angle (each three times, so that turning coordinates changes nothing); the radius is 0
# for all others.
TIP0, FRAME0, TIP1, FRAME1, CUT_BOX, ALL_BOX, MOTION_BOX, CENTRE, MIDDLE, ARC_RADIUS, COS_HALF = (
    0,
    3,
    12,
    15,
    24,
    30,
    36,
    42,
    45,
    48,
    51,
)
SPAN_COLUMNS = 54
BENT = 0.01
"""mm that boxes are wider by where a tool turns: its points leave the straight ways between both ends by a few micrometres."""
EDGE = 1e-5
"""mm that capsules and frusta are wider by: what is rounded where their axes run nearly along rows or rays."""
ALONG = 1e-16
"""Squared sine of the angle between a ray and a tool axis below which the ray runs along it: over a metre that is EDGE."""
FRUSTUM = 11
"""Columns of a frustum: a point on its axis (3) and the axis's direction (3); its radius at that point, and by how much that grows along
the axis; from where to where along it, from that point; the squared sine of the angle between axis and rays, negative for no bound."""
FLANK = 0.01
"""Share of a piece's height over which the slope of its flank at its upper end is measured."""


@njit(**BORROWED)
def swept_box(box: Floats, span: Floats, piece: Floats, turns: bool) -> None:
    """Write box (6,), low and high of u, v, w, of what a piece sweeps in a span.

    Across a direction that the axis leans to by a, a disc of radius r reaches r sqrt(1 - a^2). With
    `turns` wider by BENT.
    """
    r, more = piece[R_MAX], BENT if turns else 0.0
    if span[ARC_RADIUS] != 0.0:
        for m in range(3):
            a = span[FRAME0 + 6 + m]
            across, p, q = r * math.sqrt(max(1.0 - a * a, 0.0)), a * piece[Z_LOW], a * piece[Z_HIGH]
            box[m], box[3 + m] = (
                span[MOTION_BOX + m] + min(p, q) - across,
                span[MOTION_BOX + 3 + m] + max(p, q) + across,
            )
        return
    for m in range(3):
        low, high = np.inf, -np.inf
        for end in range(2):
            tip = span[TIP0 + m] if end == 0 else span[TIP1 + m]
            a = span[FRAME0 + 6 + m] if end == 0 else span[FRAME1 + 6 + m]
            across = r * math.sqrt(max(1.0 - a * a, 0.0)) + more
            p, q = tip + a * piece[Z_LOW], tip + a * piece[Z_HIGH]
            low, high = min(low, min(p, q) - across), max(high, max(p, q) + across)
        box[m], box[3 + m] = low, high


@njit(**BORROWED)
def swept_capsule(capsule: Floats, span: Floats, piece: Floats, turns: bool) -> None:
    """Write capsule (5,): the (u, v) of both ends of a piece's axis half-way through a span, and the radius (mm)
    within which all lies that the piece sweeps; infinite for an arc that is one span.

    Between both times a point of the axis runs straight: nowhere farther from its middle than half its way.
    """
    capsule[4] = np.inf
    if span[ARC_RADIUS] != 0.0:
        return
    way = 0.0
    for end in range(2):
        z, square = piece[Z_LOW] if end == 0 else piece[Z_HIGH], 0.0
        for m in range(2):
            p = span[TIP0 + m] + z * span[FRAME0 + 6 + m]
            q = span[TIP1 + m] + z * span[FRAME1 + 6 + m]
            capsule[2 * end + m] = 0.5 * (p + q)
            square += (q - p) * (q - p)
        way = max(way, math.sqrt(square))
    capsule[4] = piece[R_MAX] + 0.5 * way + (BENT if turns else 0.0) + EDGE


@njit(**BORROWED)
def capsule_row(capsule: Floats, v: float) -> tuple[float, float]:
    """Return the least and the greatest u of a capsule at some v, the least greater where it is not there.

    A disc about the point at s = v - y of the axis reaches u = x -+ sqrt(rho^2 - s^2). With k = dx / dy of the axis both
    ends are convex in s, extreme where s = +- rho k / sqrt(1 + k^2), or at the end of the axis before.
    """
    rho = capsule[4]
    if rho == np.inf:
        return -np.inf, np.inf
    dx, dy = capsule[2] - capsule[0], capsule[3] - capsule[1]
    begin = v - capsule[1]
    if abs(dy) < EDGE:
        if abs(begin) > rho:
            return np.inf, -np.inf
        half = math.sqrt(rho * rho - begin * begin) + EDGE
        return min(capsule[0], capsule[2]) - half, max(capsule[0], capsule[2]) + half
    first, last = max(min(begin, begin - dy), -rho), min(max(begin, begin - dy), rho)
    if first > last:
        return np.inf, -np.inf
    k = dx / dy
    extreme = rho * k / math.sqrt(1.0 + k * k)
    a, b = min(max(extreme, first), last), min(max(-extreme, first), last)
    return (
        capsule[0] + (begin - a) * k - math.sqrt(rho * rho - a * a) - EDGE,
        capsule[0] + (begin - b) * k + math.sqrt(rho * rho - b * b) + EDGE,
    )


@njit(**BORROWED)
def cell_range(
    low: float, high: float, origin: float, pitch: float, first: int, last: int
) -> tuple[int, int]:
    """Return the first cell and the one after the last whose centres lie between two coordinates (mm),
    of those from `first` to `last`."""
    a = int(math.ceil((low - origin) / pitch - 0.5))
    b = int(math.floor((high - origin) / pitch - 0.5)) + 1
    return max(a, first), min(b, last)


@njit(**BORROWED)
def enclosing_frustum(arcs: Floats, piece: Floats) -> tuple[float, float]:
    """Return radius (mm) at the tip and growth a mm of height of a frustum about the tool axis that holds a piece.

    The line through its flank near its upper end, as the piece is convex; a cylinder where the piece is not widest there.
    Between both positions of the line a flank that bends is outside of it by twice as much as half-way, at most.
    """
    first, last = int(piece[CLOSED_FIRST]), int(piece[CLOSED_LAST])
    top, step = piece[Z_HIGH], max(FLANK * (piece[Z_HIGH] - piece[Z_LOW]), EDGE)
    r, halfway, below = (
        radius_at(arcs, first, last, top),
        radius_at(arcs, first, last, top - 0.5 * step),
        radius_at(arcs, first, last, top - step),
    )
    if r < piece[R_MAX] - EDGE or below < 0.0 or below >= r:
        return piece[R_MAX], 0.0
    grows, bulge = (r - below) / step, 2.0 * max(halfway - 0.5 * (r + below), 0.0)
    return piece[R_MAX] - grows * top + bulge + EDGE, grows


@njit(**BORROWED)
def swept_frustum(
    frustum: Floats, span: Floats, piece: Floats, radius: float, grows: float, turns: bool
) -> None:
    """Write frustum (FRUSTUM,) within which all lies that a piece, itself within a frustum about its axis, sweeps in a span; none
    for an arc that is one span.

    Its axis is the tool's half-way. A point of the tool axis leaves it by half of its way across it at
    most, which between both ends of the piece is no more than a straight line has it; along it, the
    piece reaches as far as it does at one of both times, as its points run straight.
    """
    frustum[10] = -1.0
    if span[ARC_RADIUS] != 0.0:
        return
    size = 0.0
    for m in range(3):
        frustum[3 + m] = span[FRAME0 + 6 + m] + span[FRAME1 + 6 + m]
        size += frustum[3 + m] ** 2
    # A tool that turns right over has no axis half-way.
    if size < 1.0:
        return
    size = math.sqrt(size)
    for m in range(3):
        frustum[3 + m] /= size
        frustum[m] = 0.5 * (span[TIP0 + m] + span[TIP1 + m])
    low, high, beside, least = np.inf, -np.inf, 0.0, 1.0
    first, last = 0.0, 0.0
    for end in range(2):
        z, square, forward = piece[Z_LOW] if end == 0 else piece[Z_HIGH], 0.0, 0.0
        tip, axis = (TIP0, FRAME0 + 6) if end == 0 else (TIP1, FRAME1 + 6)
        along, lean = 0.0, 0.0
        for m in range(3):
            moved = (
                span[TIP1 + m] - span[TIP0 + m] + z * (span[FRAME1 + 6 + m] - span[FRAME0 + 6 + m])
            )
            square += moved * moved
            forward += moved * frustum[3 + m]
            along += (span[tip + m] - frustum[m]) * frustum[3 + m]
            lean += span[axis + m] * frustum[3 + m]
        wide = radius + grows * z + 0.5 * math.sqrt(max(square - forward * forward, 0.0))
        first, last = (wide, last) if end == 0 else (first, wide)
        aside = piece[R_MAX] * math.sqrt(max(1.0 - lean * lean, 0.0))
        low = min(low, along + piece[Z_LOW] * lean - aside)
        high = max(high, along + piece[Z_HIGH] * lean + aside)
        beside, least = max(beside, abs(along) + aside), min(least, lean)
    height = piece[Z_HIGH] - piece[Z_LOW]
    slope = (last - first) / height if height > EDGE else 0.0
    # What is at a height of the tool is not quite as far along the frustum's axis.
    beside += max(abs(piece[Z_LOW]), abs(piece[Z_HIGH])) * (1.0 / least - 1.0)
    more = (BENT if turns else 0.0) + EDGE
    start = first - slope * piece[Z_LOW] if height > EDGE else max(first, last)
    start += abs(slope) * (beside + more) + more
    frustum[7], frustum[8], frustum[9] = slope, low - more, high + more
    frustum[6] = start
    if min(start + slope * frustum[8], start + slope * frustum[9]) > 0.0:
        frustum[10] = frustum[3] ** 2 + frustum[4] ** 2


@njit(**BORROWED, inline="always")
def frustum_interval(frustum: Floats, u: float, v: float) -> tuple[float, float]:
    """Return from where to where (w) the ray at (u, v) is in a frustum, low > high where it misses it.

    With d the axis, k a point's part along d in plan and z its part of w, it is s = k + z d_w along the
    axis, and its square across it is x^2 + y^2 + z^2 - s^2: with that of the radius a quadratic in z,
    a z^2 - 2 b z + c <= 0.
    """
    if frustum[10] < 0.0:
        return -np.inf, np.inf
    x, y = u - frustum[0], v - frustum[1]
    k, d, grows = x * frustum[3] + y * frustum[4], frustum[5], frustum[7]
    low, high = -np.inf, np.inf
    if abs(d) > EDGE:
        # Between its ends the frustum has no second nappe.
        p, q = (frustum[8] - k) / d, (frustum[9] - k) / d
        low, high = min(p, q), max(p, q)
    r = frustum[6] + grows * k
    a = frustum[10] - grows * grows * d * d
    b, c = (k + r * grows) * d, x * x + y * y - k * k - r * r
    if abs(a) <= ALONG:
        # Nearly linear: the ray runs along the axis of a cylinder, or along a frustum's side.
        if abs(b) <= ALONG:
            return (np.inf, -np.inf) if c > 0.0 else (frustum[2] + low, frustum[2] + high)
        return frustum[2] + low, frustum[2] + high
    root = b * b - a * c
    if root < 0.0:
        return (np.inf, -np.inf) if a > 0.0 else (frustum[2] + low, frustum[2] + high)
    # Both roots without a difference of near numbers.
    root = b + math.sqrt(root) if b >= 0.0 else b - math.sqrt(root)
    first = root / a
    second = c / root if root != 0.0 else first
    first, second = min(first, second), max(first, second)
    if a > 0.0:
        low, high = max(low, first - EDGE), min(high, second + EDGE)
    elif grows * d > 0.0:
        low = max(low, second - EDGE)
    else:
        high = min(high, first + EDGE)
    return frustum[2] + low, frustum[2] + high
