"""Compiled bounds of what a piece of a tool sweeps in a span: where rays need to be looked at, and where on them. mm, rad.

A span is a short piece of a move, in the coordinates (u, v, w) of a bundle whose rays run along w.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Floats
from trunnion.verify.kernels.body import R_MAX, Z_HIGH, Z_LOW

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
"""mm that a capsule is wider by: what its rows are rounded by where its axis runs nearly along them."""
ALONG = 1e-16
"""Squared sine of the angle between a ray and a tool axis below which the ray runs along it: over a metre that is EDGE."""
CYLINDER = 10
"""Columns of a cylinder: a point on its axis (3) and the axis's direction (3); the squared radius, negative for no bound; from where to
where along the axis, from that point; the squared sine of the angle between axis and rays."""


@njit(cache=True, nogil=True)
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


@njit(cache=True, nogil=True)
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


@njit(cache=True, nogil=True)
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


@njit(cache=True, nogil=True)
def cell_range(
    low: float, high: float, origin: float, pitch: float, first: int, last: int
) -> tuple[int, int]:
    """Return the first cell and the one after the last whose centres lie between two coordinates (mm),
    of those from `first` to `last`."""
    a = int(math.ceil((low - origin) / pitch - 0.5))
    b = int(math.floor((high - origin) / pitch - 0.5)) + 1
    return max(a, first), min(b, last)


@njit(cache=True, nogil=True)
def swept_cylinder(cylinder: Floats, span: Floats, piece: Floats, turns: bool) -> None:
    """Write cylinder (CYLINDER,) within which all lies that a piece sweeps in a span; none for an arc that is one span.

    Its axis is the tool's half-way. A point of the tool axis leaves it by half of its way across it at
    most; along it, the piece reaches as far as it does at one of both times, as its points run straight.
    """
    cylinder[6] = -1.0
    if span[ARC_RADIUS] != 0.0:
        return
    size = 0.0
    for m in range(3):
        cylinder[3 + m] = span[FRAME0 + 6 + m] + span[FRAME1 + 6 + m]
        size += cylinder[3 + m] ** 2
    # A tool that turns right over has no axis half-way.
    if size < 1.0:
        return
    size = math.sqrt(size)
    for m in range(3):
        cylinder[3 + m] /= size
        cylinder[m] = 0.5 * (span[TIP0 + m] + span[TIP1 + m])
    way, low, high = 0.0, np.inf, -np.inf
    for end in range(2):
        z, square, forward = piece[Z_LOW] if end == 0 else piece[Z_HIGH], 0.0, 0.0
        for m in range(3):
            moved = (
                span[TIP1 + m] - span[TIP0 + m] + z * (span[FRAME1 + 6 + m] - span[FRAME0 + 6 + m])
            )
            square += moved * moved
            forward += moved * cylinder[3 + m]
        way = max(way, square - forward * forward)
        tip, axis = (TIP0, FRAME0 + 6) if end == 0 else (TIP1, FRAME1 + 6)
        along, lean = 0.0, 0.0
        for m in range(3):
            along += (span[tip + m] - cylinder[m]) * cylinder[3 + m]
            lean += span[axis + m] * cylinder[3 + m]
        aside = piece[R_MAX] * math.sqrt(max(1.0 - lean * lean, 0.0))
        low = min(low, along + piece[Z_LOW] * lean - aside)
        high = max(high, along + piece[Z_HIGH] * lean + aside)
    more = (BENT if turns else 0.0) + EDGE
    cylinder[6] = (piece[R_MAX] + 0.5 * math.sqrt(max(way, 0.0)) + more) ** 2
    cylinder[7], cylinder[8] = low - more, high + more
    cylinder[9] = cylinder[3] ** 2 + cylinder[4] ** 2


@njit(cache=True, nogil=True, inline="always")
def cylinder_interval(cylinder: Floats, u: float, v: float) -> tuple[float, float]:
    """Return from where to where (w) the ray at (u, v) is in a cylinder, low > high where it misses it.

    With d the axis, k and z the parts along d in plan and of w, a point's square across the axis is
    x^2 + y^2 + z^2 - (k + z d_w)^2: a quadratic in z.
    """
    if cylinder[6] < 0.0:
        return -np.inf, np.inf
    x, y = u - cylinder[0], v - cylinder[1]
    k, d = x * cylinder[3] + y * cylinder[4], cylinder[5]
    low, high, beyond = -np.inf, np.inf, x * x + y * y - k * k - cylinder[6]
    if cylinder[9] > ALONG:
        root = k * k * d * d - cylinder[9] * beyond
        if root < 0.0:
            return np.inf, -np.inf
        root = math.sqrt(root)
        low, high = (k * d - root) / cylinder[9] - EDGE, (k * d + root) / cylinder[9] + EDGE
    elif beyond > 0.0:
        return np.inf, -np.inf
    if abs(d) > EDGE:
        a, b = (cylinder[7] - k) / d, (cylinder[8] - k) / d
        low, high = max(low, min(a, b)), min(high, max(a, b))
    return cylinder[2] + low, cylinder[2] + high
