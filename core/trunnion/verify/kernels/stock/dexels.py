"""Compiled material removal on a tri-dexel stock: bundles of parallel rays, cut by convex bodies of
revolution that move and turn.

A ray (dexel) keeps its material as sorted disjoint intervals; up to three bundles along x, y and z
represent the stock (van Hook, 1986; Benouamer and Michelucci, Bridging the gap between CSG and Brep
via a triple ray representation, 1997). A bundle's rays run along w and stand at cell centres in (u,
v): its coordinates are the blank's, turned in a cycle.

A span is a short piece of a move: within it the tool's tip runs straight, and so does every point
seen from the tool, up to an error that `stock/spans.py` keeps below `tolerance.STOCK_CHORD`. What a
body sweeps in a span takes from a ray the set of w with

    F(w) = max over t in [0, 1] of D(w, t) > 0,

D the depth of the ray's point at w in the body (`kernels/body.py`). D is concave in w and, at one
w, in t: tangents bound it from above. So one evaluation at the end of the material that is nearest
rejects most rays, and the ends of what is cut are found by Newton steps from outside, which never
overshoot a concave function. Nothing is sampled over time: the envelope leaves no ridges.

Where the tool turns, D is concave in w at every t but F need not be: a tool that swings about its
middle sweeps two lobes with a gap between them. There an entry is bisected where Newton overshoots,
and what lies between both entries is taken away only where that is certain: between two positions that
are in the body at one time, since D is concave along the ray at that time. Bodies are taken smaller
by SHRINK, so cuts err towards standing material; a gap that is nowhere deeper than 3 GAP may be
taken with its lobes. mm, rad.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.kernels.kernel_arrays import BORROWED
from trunnion.verify.kernels.body import (
    CLOSED_FIRST,
    CLOSED_LAST,
    KIND,
    Z_HIGH,
    depth_in_body,
    radius_at,
)
from trunnion.verify.kernels.stock.engagement import engagement_in_dexels
from trunnion.verify.kernels.stock.intervals import (
    COUNT,
    FIRST,
    NOISE,
    SHRINK,
    THIN,
    Rays,
    has_capacity,
    ray_misses,
    subtract_from_ray,
    subtract_interval,
)
from trunnion.verify.kernels.stock.swept_bounds import (
    ALL_BOX,
    ARC_RADIUS,
    CENTRE,
    COS_HALF,
    CUT_BOX,
    FRAME0,
    FRAME1,
    FRUSTUM,
    MIDDLE,
    TIP0,
    TIP1,
    capsule_row,
    cell_range,
    enclosing_frustum,
    frustum_interval,
    swept_box,
    swept_capsule,
    swept_frustum,
)

# A ray in the tool frames of a span: foot (3) and direction (3) at the start, what both gain until
# the end (3, 3), by how much the direction turns, how much smaller the body is taken, and room to
# sort places on it.
TWIST, SMALLER, MARKS = 12, 13, 14
RAY_COLUMNS = 22
MOST_GRAZED = 64
"""Positions that a rapid may be suspected at."""
NO_GUESS = -1.0
"""Instead of a time of a span: nothing is known of when a position is deepest."""
GAP = 2e-4
"""mm: between two lobes of a tool that swings, what is less than three times this outside may be taken too, within a third of
`tolerance.STOCK_CHORD`."""
SURE = 1e-3
"""mm: how far the depth found in a body that turns may be below the deepest: a tenth of what a rapid is judged by."""
LEVEL = 1e-9
"""An axis this close (its sine) lies along rays or across them, and a move this close (mm) is level."""

_in_body = njit(nogil=True, inline="always")(depth_in_body.py_func)
"""Written into its callers, as are those marked so below: calls of their own take half as long again (measured)."""


@njit(**BORROWED, inline="always")
def _body_depth(
    arcs: Floats, first: int, last: int, limit: float, ray: Floats, w: float, t: float
) -> tuple[float, float, float]:
    """Return the depth D (mm) of a ray's point at w in a body at the time t, and the slopes along w
    and t.

    The point is foot + w direction + t (gain of the foot + w gain of the direction), in the tool
    frame. `limit`: a level end face at that height, infinite for none.
    """
    gx, gy, gz = ray[6] + w * ray[9], ray[7] + w * ray[10], ray[8] + w * ray[11]
    x, y, h = (
        ray[0] + w * ray[3] + t * gx,
        ray[1] + w * ray[4] + t * gy,
        ray[2] + w * ray[5] + t * gz,
    )
    rho = math.sqrt(x * x + y * y)
    depth, nr, nz = _in_body(arcs, first, last, rho, h)
    # The flutes' top is one more half-plane: depth at most limit - h.
    if limit - h < depth:
        depth, nr, nz = limit - h, 0.0, 1.0
    nx, ny = 0.0, 0.0
    if rho > 0.0:
        nx, ny = nr * x / rho, nr * y / rho
    along = -(
        nx * (ray[3] + t * ray[9]) + ny * (ray[4] + t * ray[10]) + nz * (ray[5] + t * ray[11])
    )
    return depth - ray[SMALLER], along, -(nx * gx + ny * gy + nz * gz)


@njit(**BORROWED)
def _swept_depth(
    arcs: Floats, first: int, last: int, limit: float, ray: Floats, w: float, guess: float
) -> tuple[float, float, float]:
    """Return F(w), the largest depth (mm) of a ray's point over a span, a slope with which it bounds F
    along the ray from above, and a time at which the point is as deep.

    The value is an upper bound, within `NOISE` of F, or within a twentieth of it where the point is
    outside: it errs deep. `guess` is a time at which the point may be deepest, as the position
    before was, `NO_GUESS` for none: what is found does not hang on it, only how soon.
    """
    t0, t1, s0, s1 = 0.0, 1.0, -1.0, 1.0
    f0 = slope0 = f1 = slope1 = 0.0
    if 0.0 < guess < 1.0:
        # The tangent plane there bounds all times: at best it is level.
        f, slope, s = _body_depth(arcs, first, last, limit, ray, w, guess)
        gap = s * (1.0 - guess) if s > 0.0 else -s * guess
        if gap <= NOISE or (f + gap < 0.0 and gap <= -0.05 * (f + gap)):
            return f + gap, slope, guess
        if s > 0.0:
            t0, f0, slope0, s0 = guess, f, slope, s
        else:
            t1, f1, slope1, s1 = guess, f, slope, s
    # A concave function that falls at the start, or rises at the end, is greatest there.
    if guess >= 1.0:
        f1, slope1, s1 = _body_depth(arcs, first, last, limit, ray, w, 1.0)
        if s1 >= 0.0:
            return f1, slope1, 1.0
    if s0 < 0.0:
        f0, slope0, s0 = _body_depth(arcs, first, last, limit, ray, w, 0.0)
        if s0 <= 0.0:
            return f0, slope0, 0.0
    if s1 > 0.0:
        f1, slope1, s1 = _body_depth(arcs, first, last, limit, ray, w, 1.0)
        if s1 >= 0.0:
            return f1, slope1, 1.0
    # Cutting planes in time (Kelley, 1960). Invariant: D rises at t0 and falls at t1. The mixture
    # of both tangent planes that is level in time bounds D for all times, and its slope along the
    # ray bounds F.
    most, slope = f0, slope0
    for step in range(60):
        # Two tangent planes, one rising over time and one falling: where they meet bounds all times.
        share = s0 / (s0 - s1)
        t = (f1 - f0 + s0 * t0 - s1 * t1) / (s0 - s1)
        most, slope = f0 + s0 * (t - t0), slope0 + share * (slope1 - slope0)
        gap = most - max(f0, f1)
        if gap <= NOISE or (most < 0.0 and gap <= -0.05 * most):
            break
        # Every other step at the slopes' balance and never at an end of the bracket: so it always
        # shrinks.
        if step % 2:
            t = t0 + (t1 - t0) * share
        t = min(max(t, t0 + 1e-3 * (t1 - t0)), t1 - 1e-3 * (t1 - t0))
        f, along, s = _body_depth(arcs, first, last, limit, ray, w, t)
        if s > 0.0:
            t0, f0, slope0, s0 = t, f, along, s
        elif s < 0.0:
            t1, f1, slope1, s1 = t, f, along, s
        else:
            return f, along, t
    return most, slope, t0 if f0 > f1 else t1


@njit(**BORROWED)
def _bisect_entry(
    arcs: Floats, first: int, last: int, limit: float, ray: Floats, outside: float, inside: float
) -> float:
    """Return where a ray enters what is swept, between a position outside and one inside, to within THIN
    (mm); the inner side, so not too much is cut."""
    while abs(inside - outside) > THIN:
        w = 0.5 * (inside + outside)
        if _swept_depth(arcs, first, last, limit, ray, w, NO_GUESS)[0] > 0.0:
            inside = w
        else:
            outside = w
    return inside


@njit(**BORROWED)
def _newton_entry(
    arcs: Floats,
    first: int,
    last: int,
    limit: float,
    ray: Floats,
    w: float,
    end: float,
    guess: float,
    f: float,
    slope: float,
) -> tuple[float, float]:
    """Return where a ray that runs from w towards `end` enters what is swept, NaN when it doesn't
    before, and a time to try first for it in the body.

    Newton's method on F from outside: F(w) + slope (w' - w) bounds F, so its root is not beyond the
    entry. `guess` as for `_swept_depth`; 0 says that f and slope are known to be those at w, where
    the point is deepest at the start.
    """
    sense = 1.0 if end > w else -1.0
    before, t = w, guess
    for step in range(100):
        if step > 0 or guess != 0.0:
            f, slope, t = _swept_depth(arcs, first, last, limit, ray, w, t)
        if f > 1e-5 and step > 0:
            # Only where the body turns is the depth not quite concave, and a step too long.
            return _bisect_entry(arcs, first, last, limit, ray, before, w), 0.5
        # What is only touched to begin with, and left behind, was cut before.
        if f > NOISE or (f >= -NOISE and step > 0):
            return w, t
        # F no longer rises towards the end: concave, so it never becomes positive.
        slope *= sense
        if slope <= 1e-12:
            return np.nan, 0.5
        before = w
        w += sense * max(-f / slope, NOISE)
        if (end - w) * sense < 0.0:
            return np.nan, 0.5
    return np.nan, 0.5


@njit(**BORROWED, inline="always")
def _depth_bound(
    arcs: Floats, first: int, last: int, limit: float, ray: Floats, w: float, end: float
) -> tuple[float, float, float, float]:
    """Return an upper bound (mm) of the depth between two positions over a span, from one evaluation at w
    and t = 0, and that: depth, and slopes along w and t.

    Tangents in w and t, plus the bilinear term: TWIST is how far a unit of w is turned over the
    span.
    """
    f, slope, s = _body_depth(arcs, first, last, limit, ray, w, 0.0)
    bound = f + max(slope * (end - w), 0.0) + max(s, 0.0) + ray[TWIST] * abs(end - w)
    return bound, f, slope, s


@njit(**BORROWED)
def _max_depth_turning(
    arcs: Floats,
    first: int,
    last: int,
    limit: float,
    ray: Floats,
    low: float,
    high: float,
    enough: float,
) -> tuple[float, float]:
    """Return the largest depth (mm) between two positions of a ray over a span, and its position; attained,
    within 1e-5 mm, where the tool turns within SURE. One of at most `enough` need not be the largest.

    A tangent at w bounds F from above at w' by F(w) + slope (w' - w) + TWIST |w' - w|, the last for
    the bilinear term where the tool turns. So from the lower end on each tangent bounds how far on
    nothing can be deeper than what is known by more than SURE (Piyavskii, 1972, with slopes).
    """
    best, position = _max_depth(arcs, first, last, limit, ray, low, high)
    if ray[TWIST] == 0.0:
        return best, position
    w = low
    while w < high:
        f, slope, _t = _swept_depth(arcs, first, last, limit, ray, w, NO_GUESS)
        if f > best:
            best, position = f, w
        steep = slope + ray[TWIST]
        if steep <= 0.0:
            break
        w += (max(best, enough) + SURE - f) / steep
    return best, position


@njit(**BORROWED)
def _max_depth(
    arcs: Floats, first: int, last: int, limit: float, ray: Floats, low: float, high: float
) -> tuple[float, float]:
    """Return the largest depth (mm) between two positions of a ray over a span, and its position; attained,
    within 1e-5 mm where the tool keeps its axis, else perhaps one of several peaks.

    Cutting planes along w, as `_swept_depth` has them along t.
    """
    f0, s0, _t = _swept_depth(arcs, first, last, limit, ray, low, NO_GUESS)
    f1, s1, _t = _swept_depth(arcs, first, last, limit, ray, high, NO_GUESS)
    best, position = (f0, low) if f0 >= f1 else (f1, high)
    if s0 <= 0.0 or s1 >= 0.0:
        return best, position
    for step in range(60):
        w = (f1 - f0 + s0 * low - s1 * high) / (s0 - s1)
        if f0 + s0 * (w - low) - best <= 1e-5:
            break
        if step % 2:
            w = low + (high - low) * s0 / (s0 - s1)
        w = min(max(w, low + 1e-3 * (high - low)), high - 1e-3 * (high - low))
        f, s, _t = _swept_depth(arcs, first, last, limit, ray, w, NO_GUESS)
        if f > best:
            best, position = f, w
        if s > 0.0:
            low, f0, s0 = w, f, s
        else:
            high, f1, s1 = w, f, s
    return best, position


@njit(**BORROWED, inline="always")
def _ray_in_tool_frame(ray: Floats, span: Floats, u: float, v: float) -> None:
    """Write the ray at (u, v) into the tool frames of a span: foot and direction at the start, and
    what both gain until the end.

    A ray along the axis of a tool that moves level needs no time: its points are deepest when the
    axis is nearest (the depth falls with rho alone), so its foot is set there and its gains to 0.
    """
    for m in range(3):
        a, b = FRAME0 + 3 * m, FRAME1 + 3 * m
        foot = (
            span[a] * (u - span[TIP0])
            + span[a + 1] * (v - span[TIP0 + 1])
            - span[a + 2] * span[TIP0 + 2]
        )
        after = (
            span[b] * (u - span[TIP1])
            + span[b + 1] * (v - span[TIP1 + 1])
            - span[b + 2] * span[TIP1 + 2]
        )
        ray[m], ray[3 + m] = foot, span[a + 2]
        ray[6 + m], ray[9 + m] = after - foot, span[b + 2] - span[a + 2]
    if abs(ray[3]) + abs(ray[4]) + abs(ray[8]) + ray[TWIST] >= LEVEL:
        return
    # Along the axis of a tool that moves level, all of a ray is deepest when the axis comes nearest.
    if span[ARC_RADIUS] != 0.0:
        ray[0], ray[1] = _arc_distance(span, u, v, span[CENTRE + 2]), 0.0
    else:
        square = ray[6] * ray[6] + ray[7] * ray[7]
        t = (
            min(max(-(ray[0] * ray[6] + ray[1] * ray[7]) / square, 0.0), 1.0)
            if square > 0.0
            else 0.0
        )
        ray[0], ray[1] = ray[0] + t * ray[6], ray[1] + t * ray[7]
    ray[6], ray[7] = 0.0, 0.0


@njit(**BORROWED)
def _arc_distance(span: Floats, u: float, v: float, w: float) -> float:
    """Return how far (mm) a point (u, v, w) is from the tool axis that moves along an arc, across the
    axis: to the circle in the arc's sector, else to the nearer end."""
    a, b, c = span[FRAME0 + 6], span[FRAME0 + 7], span[FRAME0 + 8]
    x, y, z = u - span[CENTRE], v - span[CENTRE + 1], w - span[CENTRE + 2]
    along = a * x + b * y + c * z
    away = math.sqrt(max(x * x + y * y + z * z - along * along, 0.0))
    if x * span[MIDDLE] + y * span[MIDDLE + 1] + z * span[MIDDLE + 2] >= away * span[COS_HALF]:
        return abs(away - span[ARC_RADIUS])
    nearest = np.inf
    for end in range(2):
        tip = TIP0 if end == 0 else TIP1
        x, y, z = u - span[tip], v - span[tip + 1], w - span[tip + 2]
        along = a * x + b * y + c * z
        nearest = min(nearest, x * x + y * y + z * z - along * along)
    return math.sqrt(max(nearest, 0.0))


@njit(**BORROWED)
def _disc_radius(arcs: Floats, first: int, last: int, limit: float, h: float) -> float:
    """Return the radius (mm) of what a body cuts at a height, less SHRINK; 0 where it cuts nothing."""
    if h > limit - SHRINK or depth_in_body(arcs, first, last, 0.0, h)[0] <= SHRINK:
        return 0.0
    return radius_at(arcs, first, last, h) - SHRINK


@njit(**BORROWED)
def _swept_disc_interval(
    arcs: Floats, first: int, last: int, limit: float, ray: Floats
) -> tuple[float, float]:
    """Return from where to where (w, mm) a ray across the axis lies in a body that moves level: in a
    disc swept along a line; low > high where it does not.

    A capsule is convex, so the hull of the ray's stretches in both end discs and between the
    straight sides is exact.
    """
    r = _disc_radius(arcs, first, last, limit, ray[2])
    if r <= 0.0:
        return 1.0, 0.0
    # The disc's middle in the plane of ray and motion: along the ray from w0 on by dw, beside it from c0 on by dc.
    w0, c0 = -(ray[0] * ray[3] + ray[1] * ray[4]), ray[0] * ray[4] - ray[1] * ray[3]
    dw, dc = -(ray[6] * ray[3] + ray[7] * ray[4]), ray[6] * ray[4] - ray[7] * ray[3]
    low, high = np.inf, -np.inf
    for end in range(2):
        w, c = w0 + end * dw, c0 + end * dc
        if abs(c) < r:
            half = math.sqrt(r * r - c * c)
            low, high = min(low, w - half), max(high, w + half)
    length = math.sqrt(dw * dw + dc * dc)
    if abs(dc) > LEVEL and length > LEVEL:
        # Between the ends: within r of the line, and beside it.
        a, b = w0 - (c0 * dw + r * length) / dc, w0 - (c0 * dw - r * length) / dc
        a, b = min(a, b), max(a, b)
        if abs(dw) > LEVEL:
            p, q = w0 + c0 * dc / dw, w0 + (length * length + c0 * dc) / dw
            a, b = max(a, min(p, q)), min(b, max(p, q))
        elif not 0.0 <= -c0 * dc <= length * length:
            return low, high
        if a < b:
            low, high = min(low, a), max(high, b)
    return low, high


@njit(**BORROWED)
def _insert_sorted(ray: Floats, n: int, w: float) -> int:
    """Insert a position into those marked on a ray, in order; return how many there are."""
    k = MARKS + n
    while k > MARKS and ray[k - 1] > w:
        ray[k] = ray[k - 1]
        k -= 1
    ray[k] = w
    return n + 1


@njit(**BORROWED)
def _tridexel_cut_arc(
    arcs: Floats,
    first: int,
    last: int,
    limit: float,
    ray: Floats,
    span: Floats,
    u: float,
    v: float,
    rays: Rays,
    cell: int,
    bottom: float,
    top: float,
) -> tuple[float, bool]:
    """Cut a ray across the axis by a body that moves level along an arc: by a disc swept; return as
    `_tridexel_cut_ray` does.

    The sweep is not convex. All its boundary points on the ray are marked, on the outer and the
    inner circle and on both end discs, and each stretch between two marks is tested at its middle.
    """
    r, radius = _disc_radius(arcs, first, last, limit, ray[2]), span[ARC_RADIUS]
    if r <= 0.0:
        return 0.0, True
    # In the plane across the axis, the ray's position nearest to the centre, and how far beside it the ray passes.
    x, y = span[CENTRE] - u, span[CENTRE + 1] - v
    along = span[FRAME0 + 6] * x + span[FRAME0 + 7] * y
    lateral, middle = math.sqrt(max(x * x + y * y - along * along, 0.0)), span[CENTRE + 2]
    # The ray passes outside of the outer circle, or has no material within it.
    if lateral >= radius + r:
        return 0.0, True
    half = math.sqrt((radius + r) ** 2 - lateral * lateral)
    if ray_misses(rays.ray, rays.ends, cell, max(bottom, middle - half), min(top, middle + half)):
        return 0.0, True
    n = 0
    for circle in (radius + r, radius - r):
        if circle > lateral:
            half = math.sqrt(circle * circle - lateral * lateral)
            n = _insert_sorted(ray, _insert_sorted(ray, n, middle - half), middle + half)
    for end in range(2):
        x, y, w = (
            (span[TIP0], span[TIP0 + 1], span[TIP0 + 2])
            if end == 0
            else (span[TIP1], span[TIP1 + 1], span[TIP1 + 2])
        )
        x, y = x - u, y - v
        along = span[FRAME0 + 6] * x + span[FRAME0 + 7] * y
        square = r * r - (x * x + y * y - along * along)
        if square > 0.0:
            half = math.sqrt(square)
            n = _insert_sorted(ray, _insert_sorted(ray, n, w - half), w + half)
    # Neighbouring stretches inside are taken away together.
    gone, open_at = 0.0, np.nan
    for k in range(n):
        inside = (
            k + 1 < n and _arc_distance(span, u, v, 0.5 * (ray[MARKS + k] + ray[MARKS + k + 1])) < r
        )
        if inside and math.isnan(open_at):
            open_at = ray[MARKS + k]
        elif not inside and not math.isnan(open_at):
            more, whole = subtract_from_ray(
                rays, cell, max(open_at, bottom), min(ray[MARKS + k], top)
            )
            gone, open_at = gone + more, np.nan
            if not whole:
                return gone, False
    return gone, True


@njit(**BORROWED)
def _both_inside_at(
    arcs: Floats, first: int, last: int, limit: float, ray: Floats, a: float, b: float, t: float
) -> bool:
    """Return whether two positions of a ray are in a body at a time, to within GAP (mm)."""
    return (
        _body_depth(arcs, first, last, limit, ray, a, t)[0] >= -GAP
        and _body_depth(arcs, first, last, limit, ray, b, t)[0] >= -GAP
    )


@njit(**BORROWED)
def _inside_together(
    arcs: Floats, first: int, last: int, limit: float, ray: Floats, a: float, b: float
) -> bool:
    """Return whether two positions of a ray are found in a body, to within GAP (mm), at one time of a span:
    then all between them is, as the depth is concave along the ray at any time.

    The depth of each position is concave in time. Where it is below -GAP at t, its tangent keeps all
    times of that position on one side of t, and at least so far away; the two sides meet, or leave
    none. Undecided after 30 steps counts as no.
    """
    t0, t1, t = 0.0, 1.0, 0.5
    for _ in range(30):
        inside = True
        for k in range(2):
            f, _along, s = _body_depth(arcs, first, last, limit, ray, a if k == 0 else b, t)
            if f >= -GAP:
                continue
            inside = False
            if s == 0.0:
                return False
            # Where the tangent reaches -GAP.
            reach = t + (-GAP - f) / s
            if s > 0.0:
                t0 = max(t0, reach)
            else:
                t1 = min(t1, reach)
        if inside:
            return True
        if t0 > t1:
            return False
        t = 0.5 * (t0 + t1)
    return False


@njit(**BORROWED)
def _certain_interval(
    arcs: Floats, first: int, last: int, limit: float, ray: Floats, a: float, b: float
) -> tuple[float, float]:
    """Return up to where from a on, towards b, a ray lies in what is swept for certain, and a position
    behind that, at most b, where it doesn't; that is NaN when all up to b does.

    Both positions are inside to within GAP (mm). Steps are halved until two positions are in the body at
    one time, or so near that the turn hardly counts: without the bilinear term about the middle of
    a step, at most TWIST step / 4, F is concave, so in a step of 4 GAP / TWIST it is at most 2 GAP
    below its ends.
    """
    short = 4.0 * GAP / ray[TWIST]
    while a < b:
        step = b - a
        while step > short and not _inside_together(arcs, first, last, limit, ray, a, a + step):
            step *= 0.5
            if _swept_depth(arcs, first, last, limit, ray, a + step, NO_GUESS)[0] < -GAP:
                return a, a + step
        if step >= b - a:
            break
        a += step
    return b, np.nan


@njit(**BORROWED)
def _tridexel_cut_turning(
    arcs: Floats,
    first: int,
    last: int,
    limit: float,
    ray: Floats,
    a: float,
    b: float,
    rays: Rays,
    cell: int,
) -> tuple[float, bool]:
    """Cut a ray between two positions that a body which turns reaches, but for the gaps between its
    lobes; return as `_tridexel_cut_ray` does."""
    gone = 0.0
    while a < b:
        end, gap = _certain_interval(arcs, first, last, limit, ray, a, b)
        if not math.isnan(gap):
            # The lobe's end lies before the gap. If yet another gap hides there, the rest stays.
            edge = _bisect_entry(arcs, first, last, limit, ray, gap, end)
            if math.isnan(_certain_interval(arcs, first, last, limit, ray, end, edge)[1]):
                end = edge
        more, whole = subtract_from_ray(rays, cell, a, end)
        gone += more
        if math.isnan(gap) or not whole:
            return gone, whole
        a = _bisect_entry(arcs, first, last, limit, ray, gap, b)
    return gone, True


@njit(**BORROWED)
def _tridexel_cut_ray(
    arcs: Floats,
    first: int,
    last: int,
    limit: float,
    ray: Floats,
    span: Floats,
    u: float,
    v: float,
    rays: Rays,
    cell: int,
    w_low: float,
    w_high: float,
) -> tuple[float, bool]:
    """Cut a ray between two positions by a piece within a span; return the length (mm) that is gone, and whether the ray had
    room for all that is left.

    A closed form where the ray lies across the axis of a tool that moves level; else each interval
    of material is searched from both ends.
    """
    table, ends = rays.ray, rays.ends
    if abs(ray[5]) + abs(ray[8]) + ray[TWIST] < LEVEL:
        if span[ARC_RADIUS] == 0.0:
            a, b = _swept_disc_interval(arcs, first, last, limit, ray)
            return subtract_from_ray(rays, cell, max(a, w_low), min(b, w_high))
        return _tridexel_cut_arc(
            arcs, first, last, limit, ray, span, u, v, rays, cell, w_low, w_high
        )
    gone = 0.0
    middle = 0.5 * (w_low + w_high)
    k = 0
    while k < table[cell, COUNT]:
        m = table[cell, FIRST] + k
        a, b = max(ends[m, 0], w_low), min(ends[m, 1], w_high)
        if b <= a:
            k += 1
            continue
        # From the end nearer to the middle of the body's box: there the bound rejects most.
        near, far = (a, b) if abs(a - middle) < abs(b - middle) else (b, a)
        bound, f, slope, s = _depth_bound(arcs, first, last, limit, ray, near, far)
        if bound <= NOISE:
            k += 1
            continue
        # For a still axis F is concave: no entry from one end means none at all. Where the tool
        # turns, the other end is tried too, and an entry that one side overshot is bisected.
        turns = ray[TWIST] > 0.0
        guess = 0.0 if s <= 0.0 else 1.0
        from_near, t_near = _newton_entry(arcs, first, last, limit, ray, near, far, guess, f, slope)
        guess = t_near if t_near > 0.0 else NO_GUESS
        from_far, t_far = (
            (np.nan, t_near)
            if math.isnan(from_near) and not turns
            else _newton_entry(arcs, first, last, limit, ray, far, near, guess, 0.0, 0.0)
        )
        if math.isnan(from_near) and math.isnan(from_far):
            k += 1
            continue
        if math.isnan(from_near):
            from_near = _bisect_entry(arcs, first, last, limit, ray, near, from_far)
        elif math.isnan(from_far):
            from_far = _bisect_entry(arcs, first, last, limit, ray, far, from_near)
        from_a, from_b = min(from_near, from_far), max(from_near, from_far)
        if (from_far - from_near) * (far - near) <= 0.0:
            k += 1
            continue
        # A cut may need one more interval, a gap another; the caller enlarges the rays and resumes.
        before = table[cell, COUNT]
        # Of a tool that turns, both entries in the body at one of their times show that all between is.
        if turns and not (
            _both_inside_at(arcs, first, last, limit, ray, from_far, from_near, t_near)
            or _both_inside_at(arcs, first, last, limit, ray, from_near, from_far, t_far)
        ):
            more, whole = _tridexel_cut_turning(
                arcs, first, last, limit, ray, from_a, from_b, rays, cell
            )
            gone += more
            if not whole:
                return gone, False
        elif not has_capacity(rays, cell):
            return gone, False
        else:
            gone += subtract_interval(rays, cell, k, from_a, from_b)
        k += 1 + table[cell, COUNT] - before
    return gone, True


@njit(**BORROWED)
def _neighbour_material(
    rays: Rays,
    columns: int,
    row: int,
    end_row: int,
    i: int,
    j: int,
    a: float,
    b: float,
    thick: float,
) -> float:
    """Return a position (w) between a and b where a ray of a cell, or of one beside it in the tile, has
    material thicker than `thick`; NaN when none has."""
    table, ends = rays.ray, rays.ends
    for y in range(max(j - 1, row), min(j + 2, end_row)):
        for x in range(max(i - 1, 0), min(i + 2, columns)):
            cell = y * columns + x
            for m in range(table[cell, FIRST], table[cell, FIRST] + table[cell, COUNT]):
                c, d = max(a, ends[m, 0]), min(b, ends[m, 1])
                if d - c > NOISE and ends[m, 1] - ends[m, 0] > thick:
                    return 0.5 * (c + d)
    return np.nan


@njit(**BORROWED)
def _may_hide(
    arcs: Floats,
    first: int,
    last: int,
    ray: Floats,
    rays: Rays,
    columns: int,
    row: int,
    end_row: int,
    i: int,
    j: int,
    pitch: float,
    box: Floats,
) -> bool:
    """Return whether somewhere in a cell a body may be in material that is as the rays around have it;
    `ray` is the cell's middle.

    The tangent at the deepest position bounds the depth across the cell: its gradient has length 1 at
    most, so with `slope` along the ray it grows by sqrt(1 - slope^2) times half a diagonal at most.
    """
    table, ends = rays.ray, rays.ends
    for y in range(max(j - 1, row), min(j + 2, end_row)):
        for x in range(max(i - 1, 0), min(i + 2, columns)):
            cell = y * columns + x
            for m in range(table[cell, FIRST], table[cell, FIRST] + table[cell, COUNT]):
                a, b = max(box[2], ends[m, 0]), min(box[5], ends[m, 1])
                if b <= a:
                    continue
                deepest, w = _max_depth_turning(
                    arcs, first, last, np.inf, ray, a, b, -0.7072 * pitch
                )
                if deepest > -0.7072 * pitch:
                    # Across rays the depth grows by what its slope along them leaves, up to half a diagonal.
                    slope = _swept_depth(arcs, first, last, np.inf, ray, w, NO_GUESS)[1]
                    if deepest + 0.7072 * pitch * math.sqrt(max(1.0 - slope * slope, 0.0)) > 0.0:
                        return True
    return False


@njit(cache=True, nogil=True)
def _graze_candidates(
    arcs: Floats,
    first: int,
    last: int,
    span: Floats,
    ray: Floats,
    rays: Rays,
    columns: int,
    row: int,
    end_row: int,
    origin: Floats,
    pitch: float,
    box: Floats,
    fine: int,
    positions: Floats,
) -> None:
    """List in positions (r, 4), u, v, w and depth, where a body may be in material between the rays of a
    bundle, going by the material of the rays around.

    Within a suspicious cell fine x fine rays are tested, and the deepest of each quarter is kept.
    ray[SMALLER] is what is allowed, so only deeper contact is listed. A suspicion:
    `stock/graze_check.py` confirms it.
    """
    i0, i1 = cell_range(box[0] - 0.5 * pitch, box[3] + 0.5 * pitch, origin[0], pitch, 0, columns)
    j0, j1 = cell_range(box[1] - 0.5 * pitch, box[4] + 0.5 * pitch, origin[1], pitch, row, end_row)
    # Behind what earlier spans have listed.
    listed = 0
    while listed < len(positions) and positions[listed, 3] > 0.0:
        listed += 1
    best = np.zeros((4, 4))
    for j in range(j0, j1):
        for i in range(i0, i1):
            _ray_in_tool_frame(
                ray, span, origin[0] + (i + 0.5) * pitch, origin[1] + (j + 0.5) * pitch
            )
            if not _may_hide(arcs, first, last, ray, rays, columns, row, end_row, i, j, pitch, box):
                continue
            best[:, 3] = 0.0
            for m in range(fine * fine):
                x, y = m % fine, m // fine
                u, v = (
                    origin[0] + (i + (x + 0.5) / fine) * pitch,
                    origin[1] + (j + (y + 0.5) / fine) * pitch,
                )
                _ray_in_tool_frame(ray, span, u, v)
                a, _t = _newton_entry(
                    arcs, first, last, np.inf, ray, box[2], box[5], NO_GUESS, 0.0, 0.0
                )
                if math.isnan(a):
                    continue
                b, _t = _newton_entry(
                    arcs, first, last, np.inf, ray, box[5], box[2], NO_GUESS, 0.0, 0.0
                )
                if math.isnan(b) or b <= a:
                    continue
                w = _neighbour_material(rays, columns, row, end_row, i, j, a, b, ray[SMALLER])
                if not math.isnan(w):
                    deep = (
                        _swept_depth(arcs, first, last, np.inf, ray, w, NO_GUESS)[0] + ray[SMALLER]
                    )
                    quarter = 2 * (2 * y // fine) + 2 * x // fine
                    if deep > best[quarter, 3]:
                        best[quarter, 0], best[quarter, 1], best[quarter, 2], best[quarter, 3] = (
                            u,
                            v,
                            w,
                            deep,
                        )
            for m in range(4):
                if best[m, 3] > 0.0 and listed < len(positions):
                    positions[listed] = best[m]
                    listed += 1


@njit(**BORROWED)
def _flute_limit(piece: Floats, p: int, last: int) -> float:
    """Return the height (mm) where a tool's flutes end, for the last piece that cuts: its closed body
    reaches beyond into the next one. Infinite for others."""
    if piece[p, KIND] == 0.0 and p + 1 < last and piece[p + 1, KIND] != 0.0:
        return piece[p, Z_HIGH]
    return np.inf


@njit(**BORROWED)
def _cut_by_piece(
    arcs: Floats,
    first: int,
    last: int,
    limit: float,
    span: Floats,
    rays: Rays,
    columns: int,
    row: int,
    end_row: int,
    origin: Floats,
    pitch: float,
    ray: Floats,
    box: Floats,
    capsule: Floats,
    frustum: Floats,
    begin: Ints,
) -> tuple[float, bool]:
    """Cut a tile's rays by a piece within a span, between its bounds, from the row and column `begin` (2,) on; return the length (mm)
    that is gone, and whether all is done: else `begin` is where a ray had no room."""
    table, ends = rays.ray, rays.ends
    gone = 0.0
    j0, j1 = cell_range(box[1], box[4], origin[1], pitch, row, end_row)
    for j in range(max(j0, begin[0]), j1):
        v = origin[1] + (j + 0.5) * pitch
        least, most = capsule_row(capsule, v)
        if least > most:
            continue
        i0, i1 = cell_range(max(box[0], least), min(box[3], most), origin[0], pitch, 0, columns)
        for i in range(max(i0, begin[1]) if j == begin[0] else i0, i1):
            cell = j * columns + i
            if ray_misses(table, ends, cell, box[2], box[5]):
                continue
            u = origin[0] + (i + 0.5) * pitch
            low, high = frustum_interval(frustum, u, v)
            low, high = max(low, box[2]), min(high, box[5])
            if low >= high or ray_misses(table, ends, cell, low, high):
                continue
            _ray_in_tool_frame(ray, span, u, v)
            more, whole = _tridexel_cut_ray(
                arcs, first, last, limit, ray, span, u, v, rays, cell, low, high
            )
            gone += more
            if not whole:
                begin[0], begin[1] = j, i
                return gone, False
    return gone, True


@njit(**BORROWED)
def _deepest_of_piece(
    arcs: Floats,
    first: int,
    last: int,
    span: Floats,
    rays: Rays,
    columns: int,
    row: int,
    end_row: int,
    origin: Floats,
    pitch: float,
    ray: Floats,
    box: Floats,
    capsule: Floats,
    best: float,
    position: Floats,
) -> float:
    """Return how deep (mm) a piece is in a tile's material within a span, at least `best`; where it is deeper, position (3,) gets the place
    (u, v, w)."""
    table, ends = rays.ray, rays.ends
    j0, j1 = cell_range(box[1], box[4], origin[1], pitch, row, end_row)
    for j in range(j0, j1):
        v = origin[1] + (j + 0.5) * pitch
        least, most = capsule_row(capsule, v)
        if least > most:
            continue
        i0, i1 = cell_range(max(box[0], least), min(box[3], most), origin[0], pitch, 0, columns)
        for i in range(i0, i1):
            cell = j * columns + i
            if ray_misses(table, ends, cell, box[2], box[5]):
                continue
            u = origin[0] + (i + 0.5) * pitch
            # Only the deepest of a move is wanted: an interval that cannot be deeper than what is known is skipped.
            _ray_in_tool_frame(ray, span, u, v)
            for m in range(table[cell, FIRST], table[cell, FIRST] + table[cell, COUNT]):
                a, b = max(ends[m, 0], box[2]), min(ends[m, 1], box[5])
                # What is thin is nowhere deeper in a body than it is thick.
                thick = ends[m, 1] - ends[m, 0]
                if (
                    b <= a
                    or thick <= best
                    or _depth_bound(arcs, first, last, np.inf, ray, a, b)[0] <= best
                ):
                    continue
                deepest, w = _max_depth_turning(arcs, first, last, np.inf, ray, a, b, best)
                deepest = min(deepest, thick)
                if deepest > best:
                    best = deepest
                    position[0], position[1], position[2] = u, v, w
    return best


@njit(cache=True, nogil=True)
def tridexel_cut_tile(
    last: int,
    span: Floats,
    span_start: Ints,
    arcs: Floats,
    piece: Floats,
    piece_start: Ints,
    tool: Ints,
    rapid: Bools,
    rays: Rays,
    columns: int,
    row: int,
    end_row: int,
    origin: Floats,
    pitch: float,
    resume: Ints,
    removed: Floats,
    depth: Floats,
    position: Floats,
    body: Floats,
    motion: Floats,
    rings: Floats,
    flute: Floats,
    circle: Floats,
    probe_start: Ints,
    counted: Ints,
    seen: Floats,
    fine: int,
    allowed: float,
    grazed: Floats,
) -> bool:
    """Run moves up to `last` through a tile of a bundle: cut with feed moves, and judge rapids and
    what doesn't cut against what stands.

    span (s, `SPAN_COLUMNS`) in the bundle's coordinates, span_start (n + 1,); arcs, piece,
    piece_start, tool (n,) as `Bodies` has them; rays: the bundle's, with what is free of the tile,
    whose rows are those from `row` to `end_row`, `columns` cells each; origin (2,) of the cells.

    resume (6,): move, span, piece, row and column to begin with, and whether that move has been
    looked at; changed. removed (n,) gets the length (mm) that is gone, depth (n,) and position (n, 3)
    how deep a rapid's cutter is in material and where (u, v, w), body (n,) how deep what doesn't
    cut is; neither is deeper than the material is thick along a ray. motion (n, 16): start, end, both
    axes, centre and sweep as `Moves` has them; rings, flute,
    circle, probe_start (n + 1,), counted and seen: see `kernels/stock/engagement.py`; without probes
    nothing is looked at. fine: rays along each side of a cell where a rapid may go deeper than
    `allowed` in between, 0 for none; grazed (r, 4) gets such positions (u, v, w) and depths,
    `MOST_GRAZED` rows for each rapid in turn, depth 0 where there is none.

    Returns whether all is done: when rays have no room for one more interval, `resume` says where
    to continue. Tiles are independent, so the result doesn't depend on how many run at a time.
    """
    table, ends = rays.ray, rays.ends
    ray, box, capsule, corner = np.zeros(RAY_COLUMNS), np.empty(6), np.empty(5), np.empty(2)
    frustum, enclosing = np.empty(FRUSTUM), np.empty((len(piece), 2))
    begin, nowhere = np.zeros(2, np.int64), np.empty(3)
    for p in range(len(piece)):
        enclosing[p, 0], enclosing[p, 1] = enclosing_frustum(arcs, piece[p])
    ray[SMALLER] = SHRINK
    # Range of w that holds the tile's material: what lies outside of it is skipped.
    bottom, top = np.inf, -np.inf
    for cell in range(row * columns, end_row * columns):
        if table[cell, COUNT] > 0:
            first = table[cell, FIRST]
            bottom = min(bottom, ends[first, 0])
            top = max(top, ends[first + table[cell, COUNT] - 1, 1])
    v_low, v_high = origin[1] + row * pitch, origin[1] + end_row * pitch
    # Rapids are counted from the first move on, as `grazed` has rows for each.
    rapids = 0
    for n in range(resume[0]):
        rapids += rapid[n]
    for n in range(resume[0], last):
        rapids += rapid[n]
        resumes = n == resume[0]
        p0, p1 = piece_start[tool[n]], piece_start[tool[n] + 1]
        # Feed move: engagement first, as the stock stood before; then every piece that cuts takes
        # its sweep away, span by span.
        if not rapid[n]:
            if (
                probe_start[n + 1] > probe_start[n]
                and not (resumes and resume[5] != 0)
                and _spans_meet(
                    span, span_start[n], span_start[n + 1], v_low - pitch, v_high + pitch
                )
            ):
                a, b = row * columns, end_row * columns
                corner[0], corner[1] = origin[0], v_low
                engagement_in_dexels(
                    Rays(table[a:b], rays.ends, rays.free),
                    corner,
                    pitch,
                    end_row - row,
                    columns,
                    motion[n, 0:3],
                    motion[n, 3:6],
                    motion[n, 6:9],
                    motion[n, 9:12],
                    motion[n, 12:15],
                    motion[n, 15],
                    rings[tool[n]],
                    flute[tool[n]],
                    circle,
                    probe_start[n],
                    probe_start[n + 1],
                    counted,
                    seen,
                )
            for s in range(
                max(resume[1], span_start[n]) if resumes else span_start[n], span_start[n + 1]
            ):
                resumes = resumes and s == resume[1]
                own = span[s]
                if (
                    span[s, CUT_BOX + 1] > v_high
                    or span[s, CUT_BOX + 4] < v_low
                    or span[s, CUT_BOX + 2] > top
                    or span[s, CUT_BOX + 5] < bottom
                ):
                    continue
                ray[TWIST] = _ray_turn(own)
                for p in range(max(resume[2], p0) if resumes else p0, p1):
                    resumes = resumes and p == resume[2]
                    if piece[p, KIND] != 0.0:
                        break
                    swept_box(box, own, piece[p], ray[TWIST] > 0.0)
                    if box[2] > top or box[5] < bottom:
                        continue
                    first, end = int(piece[p, CLOSED_FIRST]), int(piece[p, CLOSED_LAST])
                    limit = _flute_limit(piece, p, p1)
                    swept_capsule(capsule, own, piece[p], ray[TWIST] > 0.0)
                    swept_frustum(
                        frustum,
                        own,
                        piece[p],
                        enclosing[p, 0],
                        enclosing[p, 1],
                        ray[TWIST] > 0.0,
                    )
                    begin[0], begin[1] = (resume[3], resume[4]) if resumes else (0, 0)
                    gone, whole = _cut_by_piece(
                        arcs,
                        first,
                        end,
                        limit,
                        own,
                        rays,
                        columns,
                        row,
                        end_row,
                        origin,
                        pitch,
                        ray,
                        box,
                        capsule,
                        frustum,
                        begin,
                    )
                    removed[n] += gone
                    if not whole:
                        resume[0], resume[1], resume[2], resume[3], resume[4], resume[5] = (
                            n,
                            s,
                            p,
                            begin[0],
                            begin[1],
                            1,
                        )
                        return False
        # Then what must not be in material: of rapids all of the tool, of feed moves what doesn't
        # cut, against the stock as it now stands.
        for s in range(span_start[n], span_start[n + 1]):
            own = span[s]
            if (
                span[s, ALL_BOX + 1] > v_high
                or span[s, ALL_BOX + 4] < v_low
                or span[s, ALL_BOX + 2] > top
                or span[s, ALL_BOX + 5] < bottom
            ):
                continue
            ray[TWIST] = _ray_turn(own)
            if span[s, ARC_RADIUS] != 0.0 and abs(span[s, FRAME0 + 8]) < 0.5:
                # Of an arc that is one span, the rays along the axis give its depth.
                continue
            for p in range(p0, p1):
                cuts = piece[p, KIND] == 0.0
                if cuts and not rapid[n]:
                    continue
                swept_box(box, own, piece[p], ray[TWIST] > 0.0)
                if box[2] > top or box[5] < bottom:
                    continue
                first, end = int(piece[p, CLOSED_FIRST]), int(piece[p, CLOSED_LAST])
                swept_capsule(capsule, own, piece[p], ray[TWIST] > 0.0)
                deepest = _deepest_of_piece(
                    arcs,
                    first,
                    end,
                    own,
                    rays,
                    columns,
                    row,
                    end_row,
                    origin,
                    pitch,
                    ray,
                    box,
                    capsule,
                    depth[n] if cuts else body[n],
                    position[n] if cuts else nowhere,
                )
                if cuts:
                    depth[n] = deepest
                else:
                    body[n] = deepest
                # Rapids that miss the rays may still enter between them.
                if cuts and fine > 0 and depth[n] <= allowed:
                    ray[SMALLER] = allowed
                    _graze_candidates(
                        arcs,
                        first,
                        end,
                        own,
                        ray,
                        rays,
                        columns,
                        row,
                        end_row,
                        origin,
                        pitch,
                        box,
                        fine,
                        grazed[(rapids - 1) * MOST_GRAZED : rapids * MOST_GRAZED],
                    )
                    ray[SMALLER] = SHRINK
    return True


@njit(**BORROWED)
def _spans_meet(span: Floats, first: int, last: int, v_low: float, v_high: float) -> bool:
    """Return whether what cuts comes between two coordinates v (mm) in spans `first` to `last`."""
    near = False
    for s in range(first, last):
        near = near or (span[s, CUT_BOX + 1] <= v_high and span[s, CUT_BOX + 4] >= v_low)
    return near


@njit(**BORROWED)
def _ray_turn(span: Floats) -> float:
    """Return how far the direction of rays turns in a span as the tool sees it (the length of its
    change); 0 when the axis keeps still."""
    x = span[FRAME1 + 2] - span[FRAME0 + 2]
    y = span[FRAME1 + 5] - span[FRAME0 + 5]
    z = span[FRAME1 + 8] - span[FRAME0 + 8]
    return math.sqrt(x * x + y * y + z * z)
