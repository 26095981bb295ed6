"""Compiled contact of an upright tool with trimmed faces in closed form: depth of a swept body by
branch and bound.

The tool axis is +z. A face is a bundle of *strips* (`part/shape/surfaces.py`): a profile (w, z) carried
along a guide in plan, a line or an arc about a vertical axis, trimmed at both ends. The tool moves
along a line or an arc in plan, the path. For a body of revolution swept along the path at one
height the deepest contact with the level curve of a strip at the profile parameter u is

    depth(u) = D(rho(u), z(u)),  rho(u) = plan distance between path and guide at u,

with D the concave depth of `kernels/body.py`. rho is exact (curve to curve), so only u, one number,
is searched, by branch and bound with an upper bound over an interval [u0, u1]:

* D is concave in (rho, h) and never increases with rho: tangents at both ends of a straight piece
  bound it from above, and a rho that is too small only makes the bound larger;
* rho as a function of w has slope 1 at most, so it lies below the chord of two evaluations by at
  most (span^2 - step^2) / (2 span), the depth of a V of slopes 1 (Piyavskii, 1972; Shubert, 1972);
  and where it bends upwards its second derivative is at most 1 over the distance, so it lies below
  the chord by at most span^2 / (8 distance). The smaller of the two is the sag;
* a circular profile leaves its chord by its sagitta, and D has slope 1 at most.

Every approximation errs deep in the bound; what is reported is a depth that is attained, at most
the stated bound below the deepest. Columns of strips (m, 37) as in `part/shape/surfaces.py`; mm, rad; the
frame of the moves. Guides use the columns of a move's plan curve.

Bodies come from `kernels/body.py`: a cached caller does not notice a change there, so after one the
cache is to be emptied.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Floats, Ints
from trunnion.part.shape.surfaces import (
    BX0,
    BX1,
    BY0,
    BY1,
    BZ0,
    BZ1,
    DX,
    DY,
    ECX,
    ECY,
    ERADIUS,
    EX0,
    EX1,
    EY0,
    EY1,
    FIXED,
    GUIDE,
    H_COS,
    L_COS,
    L_KIND,
    L_SIGN,
    L_SIN,
    LA,
    LB,
    LC,
    M_COS,
    M_SIN,
    OX,
    OY,
    PROFILE,
    PW0,
    PW1,
    PZ0,
    PZ1,
    R_COS,
    R_KIND,
    R_SIGN,
    R_SIN,
    RA,
    RB,
    RC,
    U0,
    U1,
)
from trunnion.verify.kernels.body import KIND as PIECE_KIND
from trunnion.verify.kernels.body import R_MAX, Z_HIGH, Z_LOW, swept_depth

# Columns of a move: its plan curve first (shared with guides), then heights.
KIND, X0, Y0, X1, Y1, CX, CY, RADIUS, MX, MY, COS_HALF = range(11)
"""Plan curve: kind (0 line, 1 arc), ends, centre, radius, unit direction of an arc's middle, cosine of
half its sweep (-1: a full circle)."""
START_ANGLE, SWEEP, Z_START, Z_END = range(11, 15)
MOVE_COLUMNS = 15

_TINY = 1e-12


@njit(cache=True, nogil=True, inline="always")
def _point_point(ax: float, ay: float, bx: float, by: float) -> float:
    """Return the plan distance (mm) of two points."""
    return math.sqrt((ax - bx) * (ax - bx) + (ay - by) * (ay - by))


@njit(cache=True, nogil=True)
def _point_segment(qx: float, qy: float, c: Floats) -> float:
    """Return the plan distance (mm) of a point to a line curve; of no length it is a point."""
    dx, dy = c[X1] - c[X0], c[Y1] - c[Y0]
    square = dx * dx + dy * dy
    t = 0.0
    if square > 0.0:
        t = ((qx - c[X0]) * dx + (qy - c[Y0]) * dy) / square
        t = min(max(t, 0.0), 1.0)
    return _point_point(qx, qy, c[X0] + t * dx, c[Y0] + t * dy)


@njit(cache=True, nogil=True, inline="always")
def _on_arc(vx: float, vy: float, length: float, c: Floats) -> bool:
    """Return whether the direction (vx, vy), of a length, lies in an arc's sector: v . middle >= |v|
    cos(half sweep).

    The tolerance takes in points just beyond an end: there the distance comes out smaller, on the
    deep side.
    """
    return vx * c[MX] + vy * c[MY] >= length * c[COS_HALF] - _TINY


@njit(cache=True, nogil=True)
def _point_arc(qx: float, qy: float, c: Floats) -> float:
    """Return the plan distance (mm) of a point to an arc: | |v| - radius | in its sector, else to the
    nearer end; the radius from its centre."""
    vx, vy = qx - c[CX], qy - c[CY]
    length = math.sqrt(vx * vx + vy * vy)
    if length < _TINY:
        return c[RADIUS]
    if _on_arc(vx, vy, length, c):
        return abs(length - c[RADIUS])
    return min(_point_point(qx, qy, c[X0], c[Y0]), _point_point(qx, qy, c[X1], c[Y1]))


@njit(cache=True, nogil=True)
def point_distance(qx: float, qy: float, c: Floats) -> float:
    """Return the plan distance (mm) of a point to a curve, line or arc."""
    if c[KIND] == 0.0:
        return _point_segment(qx, qy, c)
    return _point_arc(qx, qy, c)


@njit(cache=True, nogil=True)
def _segments(a: Floats, b: Floats) -> float:
    """Return the least plan distance (mm) of two lines: 0 where they cross, else from an end of one to
    the other."""
    ax, ay = a[X1] - a[X0], a[Y1] - a[Y0]
    bx, by = b[X1] - b[X0], b[Y1] - b[Y0]
    ex, ey = b[X0] - a[X0], b[Y0] - a[Y0]
    cross = ax * by - ay * bx
    if cross != 0.0:
        s = (ex * by - ey * bx) / cross
        t = (ex * ay - ey * ax) / cross
        if 0.0 <= s <= 1.0 and 0.0 <= t <= 1.0:
            return 0.0
    return min(
        min(_point_segment(a[X0], a[Y0], b), _point_segment(a[X1], a[Y1], b)),
        min(_point_segment(b[X0], b[Y0], a), _point_segment(b[X1], b[Y1], a)),
    )


@njit(cache=True, nogil=True)
def _segment_arc(a: Floats, b: Floats) -> float:
    """Return the least plan distance (mm) of the line a and the arc b.

    The least is at an end of either, at the foot of the arc's centre on the line, or 0 at a
    crossing with the circle.
    """
    dx, dy = a[X1] - a[X0], a[Y1] - a[Y0]
    square = dx * dx + dy * dy
    best = min(
        min(_point_arc(a[X0], a[Y0], b), _point_arc(a[X1], a[Y1], b)),
        min(_point_segment(b[X0], b[Y0], a), _point_segment(b[X1], b[Y1], a)),
    )
    if square == 0.0:
        return best
    # Foot of the centre on the line, at the share t.
    t = ((b[CX] - a[X0]) * dx + (b[CY] - a[Y0]) * dy) / square
    fx, fy = a[X0] + t * dx, a[Y0] + t * dy
    if 0.0 <= t <= 1.0:
        best = min(best, _point_arc(fx, fy, b))
    # Crossings lie half a chord, in shares of the line, on both sides of the foot; a crossing
    # outside the arc's sector counts with its distance.
    gap = b[RADIUS] * b[RADIUS] - (fx - b[CX]) * (fx - b[CX]) - (fy - b[CY]) * (fy - b[CY])
    if gap >= 0.0:
        half = math.sqrt(gap / square)
        for sign in (-1.0, 1.0):
            k = t + sign * half
            if 0.0 <= k <= 1.0:
                best = min(best, _point_arc(a[X0] + k * dx, a[Y0] + k * dy, b))
    return best


@njit(cache=True, nogil=True)
def _arcs(a: Floats, b: Floats) -> float:
    """Return the least plan distance (mm) of two arcs.

    The least is at an end of either, on the line through both centres, or 0 at a crossing of the
    circles. Concentric arcs that face each other have an end of one opposite to the other.
    """
    best = min(
        min(_point_arc(a[X0], a[Y0], b), _point_arc(a[X1], a[Y1], b)),
        min(_point_arc(b[X0], b[Y0], a), _point_arc(b[X1], b[Y1], a)),
    )
    vx, vy = b[CX] - a[CX], b[CY] - a[CY]
    length = math.sqrt(vx * vx + vy * vy)
    if length < _TINY:
        return best
    vx, vy = vx / length, vy / length
    # Points of the one arc on the line of centres, on both sides.
    for sign in (-1.0, 1.0):
        if _on_arc(sign * vx, sign * vy, 1.0, a):
            best = min(
                best, _point_arc(a[CX] + sign * a[RADIUS] * vx, a[CY] + sign * a[RADIUS] * vy, b)
            )
    # Crossings of the circles, by their radical line at `along` from the first centre.
    along = (length * length + a[RADIUS] * a[RADIUS] - b[RADIUS] * b[RADIUS]) / (2.0 * length)
    square = a[RADIUS] * a[RADIUS] - along * along
    if square >= 0.0:
        across = math.sqrt(square)
        for sign in (-1.0, 1.0):
            qx, qy = along * vx - sign * across * vy, along * vy + sign * across * vx
            if _on_arc(qx, qy, a[RADIUS], a):
                best = min(best, _point_arc(a[CX] + qx, a[CY] + qy, b))
    return best


@njit(cache=True, nogil=True)
def curve_distance(a: Floats, b: Floats) -> float:
    """Return the least plan distance (mm) between two curves, each a line or an arc; 0 where they
    meet."""
    if a[KIND] == 0.0:
        if b[KIND] == 0.0:
            return _segments(a, b)
        return _segment_arc(a, b)
    if b[KIND] == 0.0:
        return _segment_arc(b, a)
    return _arcs(a, b)


@njit(cache=True, nogil=True, inline="always")
def _profile_w(s: Floats, u: float) -> float:
    """Return w (mm) of a strip's profile at the parameter u; an arc's parameter is its angle (rad)."""
    if s[PROFILE] == 0.0:
        return s[PW0] + (s[PW1] - s[PW0]) * (
            (u - s[U0]) / (s[U1] - s[U0]) if s[U1] > s[U0] else 0.0
        )
    return s[PW0] + s[PW1] * math.cos(u)


@njit(cache=True, nogil=True, inline="always")
def _profile_z(s: Floats, u: float) -> float:
    """Return z (mm) of a strip's profile at the parameter u."""
    if s[PROFILE] == 0.0:
        return s[PZ0] + (s[PZ1] - s[PZ0]) * (
            (u - s[U0]) / (s[U1] - s[U0]) if s[U1] > s[U0] else 0.0
        )
    return s[PZ0] + s[PW1] * math.sin(u)


@njit(cache=True, nogil=True)
def _profile_u(s: Floats, z: float) -> float:
    """Return the parameter at which a profile, monotone in z, passes a height inside its range."""
    if s[PROFILE] == 0.0:
        return s[U0] + (s[U1] - s[U0]) * (z - s[PZ0]) / (s[PZ1] - s[PZ0])
    middle = 0.5 * (s[U0] + s[U1])
    # asin gives the branch of the right half; then the whole turns that bring it next to the
    # profile's middle.
    u = math.asin(min(max((z - s[PZ0]) / s[PW1], -1.0), 1.0))
    if math.cos(middle) < 0.0:
        u = math.pi - u
    u += 2.0 * math.pi * math.floor((middle - u) / (2.0 * math.pi) + 0.5)
    return min(max(u, s[U0]), s[U1])


@njit(cache=True, nogil=True)
def _trim_end(kind: float, a: float, b: float, c: float, sign: float, u: float, u0: float) -> float:
    """Return the guide coordinate s (mm, on arcs rad) at which a strip ends at the parameter u: a line
    in (s, u), or a circle about (a, c) of radius b."""
    if kind == 0.0:
        return a + b * (u - u0)
    return a + sign * math.sqrt(max(b * b - (u - c) * (u - c), 0.0))


@njit(cache=True, nogil=True)
def _guide_curve(s: Floats, w: float, u0: float, u1: float, out: Floats) -> None:
    """Fill out (15,) with the guide's plan curve at offset w, trimmed as wide as it is anywhere
    between two profile parameters.

    The ends are monotone in u, so the widest trim is that of an interval's end. A wider guide can
    only be nearer to the path: the distance errs small, the depth bound deep. At u0 = u1 the guide
    is exact.
    """
    out[KIND] = s[GUIDE]
    if s[FIXED] != 0.0:
        low, high = s[LA], s[RA]
    else:
        low = min(
            _trim_end(s[L_KIND], s[LA], s[LB], s[LC], s[L_SIGN], u0, s[U0]),
            _trim_end(s[L_KIND], s[LA], s[LB], s[LC], s[L_SIGN], u1, s[U0]),
        )
        high = max(
            _trim_end(s[R_KIND], s[RA], s[RB], s[RC], s[R_SIGN], u0, s[U0]),
            _trim_end(s[R_KIND], s[RA], s[RB], s[RC], s[R_SIGN], u1, s[U0]),
        )
        high = max(high, low)
    if s[GUIDE] == 0.0:
        px, py = s[OX] - w * s[DY], s[OY] + w * s[DX]
        out[X0], out[Y0] = px + low * s[DX], py + low * s[DY]
        out[X1], out[Y1] = px + high * s[DX], py + high * s[DY]
        return
    out[CX], out[CY], out[RADIUS] = s[OX], s[OY], abs(w)
    if s[FIXED] != 0.0:
        out[X0], out[Y0] = s[OX] + w * s[L_COS], s[OY] + w * s[L_SIN]
        out[X1], out[Y1] = s[OX] + w * s[R_COS], s[OY] + w * s[R_SIN]
        out[MX], out[MY], out[COS_HALF] = s[M_COS], s[M_SIN], s[H_COS]
    else:
        middle, half = 0.5 * (low + high), min(0.5 * (high - low), math.pi)
        out[X0], out[Y0] = s[OX] + w * math.cos(low), s[OY] + w * math.sin(low)
        out[X1], out[Y1] = s[OX] + w * math.cos(high), s[OY] + w * math.sin(high)
        out[MX], out[MY], out[COS_HALF] = math.cos(middle), math.sin(middle), math.cos(half)


@njit(cache=True, nogil=True)
def _depth_at(
    s: Floats,
    u: float,
    path: Floats,
    z_low: float,
    rise: float,
    arcs: Floats,
    piece: Floats,
    guide: Floats,
) -> float:
    """Return the depth (mm) that is attained at one profile parameter, for a tip along `path` from
    z_low to z_low + rise."""
    _guide_curve(s, _profile_w(s, u), u, u, guide)
    depth, _r, _h = swept_depth(
        arcs, piece, curve_distance(path, guide), _profile_z(s, u) - z_low, rise
    )
    return depth


@njit(cache=True, nogil=True)
def strip_depth(
    s: Floats,
    path: Floats,
    z_low: float,
    rise: float,
    arcs: Floats,
    piece: Floats,
    enough: float,
    bound: float,
    guide: Floats,
    stack: Floats,
) -> tuple[float, float]:
    """Return the deepest (mm) that one piece enters one strip while its tip follows a plan path
    between z_low and z_low + rise, and the profile parameter there.

    The move is level or vertical, so that the whole rise counts everywhere on the path. The depth
    is attained and at most `bound` below the deepest; strips that enter by `enough` at most may
    come back with anything up to `enough`, or -inf. guide (15,), stack (k, 2): workspace. Where the
    stack is full, or an interval can't be divided any further, its bound counts as the depth: that
    errs deep.
    """
    # Only heights that the piece passes count: the profile is cut to them, since its open run has
    # no end faces.
    z_from, z_to = z_low + piece[Z_LOW], z_low + rise + piece[Z_HIGH]
    if s[BZ1] < z_from or s[BZ0] > z_to:
        return -np.inf, s[U0]
    low, high = s[U0], s[U1]
    if s[BZ1] > s[BZ0]:
        rising = _profile_z(s, high) > _profile_z(s, low)
        if s[BZ0] < z_from:
            cut = _profile_u(s, z_from)
            low, high = (cut, high) if rising else (low, cut)
        if s[BZ1] > z_to:
            cut = _profile_u(s, z_to)
            low, high = (low, cut) if rising else (cut, high)
    best, where = -np.inf, low
    # Invariant: every u that may be deeper than max(enough, best + bound) lies in an interval on
    # the stack.
    r_path = path[RADIUS] if path[KIND] != 0.0 else np.inf
    stack[0, 0], stack[0, 1] = low, high
    top = 1
    while top > 0:
        top -= 1
        u0, u1 = stack[top, 0], stack[top, 1]
        w0, w1, z0, z1 = _profile_w(s, u0), _profile_w(s, u1), _profile_z(s, u0), _profile_z(s, u1)
        # Both ends with the interval's widest guide: then w alone moves the guide.
        _guide_curve(s, w0, u0, u1, guide)
        rho0 = curve_distance(path, guide)
        rho1, sag = rho0, 0.0
        span = abs(w1 - w0)
        if span > 0.0:
            _guide_curve(s, w1, u0, u1, guide)
            rho1 = curve_distance(path, guide)
            # Sag of the distance below its chord: by its slope of 1; and, where the curves cannot
            # touch in between (`nearest` bounds the distance from below), by its second derivative.
            step = rho1 - rho0
            sag = max(span * span - step * step, 0.0) / (2.0 * span)
            nearest = 0.5 * (rho0 + rho1 - span)
            if nearest > 0.0:
                sag = min(sag, 0.125 * span * span / min(nearest, r_path))
        # Sagitta of a circular profile.
        arch = s[PW1] * (1.0 - math.cos(0.5 * (u1 - u0))) if s[PROFILE] != 0.0 else 0.0
        d0, r0, h0 = swept_depth(arcs, piece, rho0 - sag, z0 - z_low, rise)
        d1, r1, h1 = swept_depth(arcs, piece, rho1 - sag, z1 - z_low, rise)
        # Slopes of the tangents along the interval, from 0 at u0 to 1 at u1. A falling start or a
        # rising end is itself the greatest of a concave function; else the tangents' crossing
        # bounds it.
        m0 = r0 * (rho1 - rho0) + h0 * (z1 - z0)
        m1 = r1 * (rho1 - rho0) + h1 * (z1 - z0)
        share, most = 0.5, d0
        if m0 <= 0.0:
            share = 0.0
        elif m1 >= 0.0:
            share, most = 1.0, d1
        else:
            share = min(max((d1 - d0 - m1) / (m0 - m1), 0.0), 1.0)
            most = d0 + m0 * share
        most += arch
        if most <= max(enough, best + bound):
            continue
        # A candidate at the position where the bound is greatest.
        at = u0 + share * (u1 - u0)
        depth = _depth_at(s, at, path, z_low, rise, arcs, piece, guide)
        if depth > best:
            best, where = depth, at
        if most <= max(enough, best + bound):
            continue
        # Cut at the candidate, unless that leaves a sliver.
        split = at if 0.1 <= share <= 0.9 else 0.5 * (u0 + u1)
        if top + 2 > len(stack) or not u0 < split < u1:
            best, where = most, at
            continue
        stack[top, 0], stack[top, 1] = u0, split
        stack[top + 1, 0], stack[top + 1, 1] = split, u1
        top += 2
    return best, where


@njit(cache=True, nogil=True)
def part_of_move(move: Floats, t0: float, t1: float, out: Floats) -> tuple[float, float]:
    """Fill out (15,) with the plan curve of a move between two shares of it, and return its lowest and
    highest z (mm).

    Equal shares give a line of no length.
    """
    za = move[Z_START] + t0 * (move[Z_END] - move[Z_START])
    zb = move[Z_START] + t1 * (move[Z_END] - move[Z_START])
    out[KIND] = move[KIND]
    if move[KIND] == 0.0 or t0 == t1:
        out[KIND] = 0.0
        if move[KIND] == 0.0:
            dx, dy = move[X1] - move[X0], move[Y1] - move[Y0]
            out[X0], out[Y0] = move[X0] + t0 * dx, move[Y0] + t0 * dy
            out[X1], out[Y1] = move[X0] + t1 * dx, move[Y0] + t1 * dy
        else:
            angle = move[START_ANGLE] + t0 * move[SWEEP]
            out[X0] = move[CX] + move[RADIUS] * math.cos(angle)
            out[Y0] = move[CY] + move[RADIUS] * math.sin(angle)
            out[X1], out[Y1] = out[X0], out[Y0]
        return min(za, zb), max(za, zb)
    a, b = move[START_ANGLE] + t0 * move[SWEEP], move[START_ANGLE] + t1 * move[SWEEP]
    m, half = 0.5 * (a + b), 0.5 * abs(b - a)
    out[CX], out[CY], out[RADIUS] = move[CX], move[CY], move[RADIUS]
    out[X0], out[Y0] = move[CX] + move[RADIUS] * math.cos(a), move[CY] + move[RADIUS] * math.sin(a)
    out[X1], out[Y1] = move[CX] + move[RADIUS] * math.cos(b), move[CY] + move[RADIUS] * math.sin(b)
    out[MX], out[MY], out[COS_HALF] = math.cos(m), math.sin(m), math.cos(min(half, math.pi))
    return min(za, zb), max(za, zb)


@njit(cache=True, nogil=True, inline="always")
def is_sloped(move: Floats) -> bool:
    """Return whether a move climbs or falls while it moves in plan."""
    level = move[Z_START] == move[Z_END]
    upright = move[KIND] == 0.0 and move[X0] == move[X1] and move[Y0] == move[Y1]
    return not (level or upright)


@njit(cache=True, nogil=True)
def move_depth(
    s: Floats,
    move: Floats,
    arcs: Floats,
    piece: Floats,
    enough: float,
    bound: float,
    path: Floats,
    guide: Floats,
    stack: Floats,
    spans: Floats,
) -> tuple[float, float]:
    """Return the deepest (mm) that one piece enters one strip along a whole move, and the profile
    parameter there.

    Level and vertical moves go to `strip_depth`. A ramp or helix is divided by time: over a part of
    it the body swept by the part's whole rise, all along the part's path, contains the true motion
    and bounds its depth from above; a level position at the middle gives a depth that is attained.
    The result is within twice `bound` of the deepest: once for the search over the strip, once for
    the search over time.
    """
    if not is_sloped(move):
        return strip_depth(
            s,
            move,
            min(move[Z_START], move[Z_END]),
            abs(move[Z_END] - move[Z_START]),
            arcs,
            piece,
            enough,
            bound,
            guide,
            stack,
        )
    best, where = -np.inf, s[U0]
    spans[0, 0], spans[0, 1] = 0.0, 1.0
    top = 1
    while top > 0:
        top -= 1
        t0, t1 = spans[top, 0], spans[top, 1]
        z_low, z_high = part_of_move(move, t0, t1, path)
        most, u = strip_depth(
            s, path, z_low, z_high - z_low, arcs, piece, max(enough, best), bound, guide, stack
        )
        # Not deeper than what is known: the part is done.
        if most <= max(enough, best):
            continue
        # The swept body itself represents the part once its rise is a fraction of the bound. Not a
        # larger one: where a trim leans more than the move climbs, the contact moves faster than
        # the tip.
        if z_high - z_low <= 0.125 * bound or top + 2 > len(spans):
            best, where = most, u
            continue
        middle = 0.5 * (t0 + t1)
        z, _z = part_of_move(move, middle, middle, path)
        depth, u = strip_depth(s, path, z, 0.0, arcs, piece, best, bound, guide, stack)
        if depth > best:
            best, where = depth, u
        if most <= best + bound:
            continue
        spans[top, 0], spans[top, 1] = t0, middle
        spans[top + 1, 0], spans[top + 1, 1] = middle, t1
        top += 2
    return best, where


@njit(cache=True, nogil=True)
def move_box(move: Floats) -> tuple[float, float, float, float]:
    """Return the plan box of a move's tip (x low, y low, x high, y high), mm."""
    x0, y0 = min(move[X0], move[X1]), min(move[Y0], move[Y1])
    x1, y1 = max(move[X0], move[X1]), max(move[Y0], move[Y1])
    if move[KIND] != 0.0:
        # Quadrant points that lie on the arc.
        for k in range(4):
            qx, qy = (1.0, 0.0, -1.0, 0.0)[k], (0.0, 1.0, 0.0, -1.0)[k]
            if _on_arc(qx, qy, 1.0, move):
                px, py = move[CX] + move[RADIUS] * qx, move[CY] + move[RADIUS] * qy
                x0, y0, x1, y1 = min(x0, px), min(y0, py), max(x1, px), max(y1, py)
    return x0, y0, x1, y1


@njit(cache=True, nogil=True)
def _inside(x: float, y: float, outline: Floats) -> bool:
    """Return whether a point is inside a closed outline (k, 7) of lines and arcs, by parity.

    A ray towards +x crosses each chord or not (Sunday, Inclusion of a point in a polygon, 2001); an
    arc, of less than half a turn, changes the parity once more in the cap between its chord and
    itself. Both go by the same side of the chord, so that one rounding serves both: the chord
    itself, far inside of a face, is nothing to the result.
    """
    odd = False
    for k in range(len(outline)):
        xa, ya, xb, yb = outline[k, EX0], outline[k, EY0], outline[k, EX1], outline[k, EY1]
        radius = outline[k, ERADIUS]
        across = (ya > y) != (yb > y)
        if not across and radius == 0.0:
            continue
        # Left of the chord; on its line, as a point a little further in x, and much less in y.
        side = (xb - xa) * (y - ya) - (x - xa) * (yb - ya)
        left = side > 0.0 or (side == 0.0 and (yb < ya or (yb == ya and xb > xa)))
        if across and left == (yb > ya):
            odd = not odd
        if radius != 0.0 and left == (radius < 0.0):
            dx, dy = x - outline[k, ECX], y - outline[k, ECY]
            if dx * dx + dy * dy < radius * radius:
                odd = not odd
    return odd


@njit(cache=True, nogil=True)
def _level_depth(arcs: Floats, piece: Floats, h: float, rise: float) -> float:
    """Return how deep (mm) a point on a piece's axis lies in it, at the height h above the tip in its
    lowest position; -inf beyond its ends."""
    if h < piece[Z_LOW] or h > piece[Z_HIGH] + rise:
        return -np.inf
    depth, _r, _h = swept_depth(arcs, piece, 0.0, h, rise)
    return depth


@njit(cache=True, nogil=True)
def deepest_height(arcs: Floats, piece: Floats) -> float:
    """Return the height (mm) between a piece's ends at which a point on its axis is deepest in it, to
    within 1e-4 mm.

    Bisection on the sign of the slope: the depth along the axis is concave.
    """
    low, high = piece[Z_LOW], piece[Z_HIGH]
    while high - low > 1e-4:
        middle = 0.5 * (low + high)
        _depth, _r, slope = swept_depth(arcs, piece, 0.0, middle, 0.0)
        if slope > 0.0:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


@njit(cache=True, nogil=True)
def region_depth(
    z: float, box: Floats, outline: Floats, move: Floats, arcs: Floats, piece: Floats, path: Floats
) -> tuple[float, float]:
    """Return how deep (mm) one piece enters a level face where its axis passes over or under it, and
    at which share of the move.

    z of the face, box (4,) its plan box, outline (k, 7) its edges. Only the face's inside is judged
    here, where the nearest point of the face to the axis is on the axis itself (rho = 0); its
    boundary is among the strips. Along a path over the face the axis depth is constant
    (level move) or concave in time, and where the axis crosses the outline the boundary's strip is
    as deep: so the ends of the move count, and of a sloped one the moment at which the piece is
    deepest.

    Lines and arcs of the outline are those of the boundary's strips, with ends joined within
    `tolerance.COINCIDENT`: an axis is over the face or beside its boundary, and its distance to
    that is exact to as much.
    """
    z_low, rise = min(move[Z_START], move[Z_END]), abs(move[Z_END] - move[Z_START])
    if not is_sloped(move):
        if (
            z - z_low < piece[Z_LOW]
            or z - z_low > piece[Z_HIGH] + rise
            or not _point_in_region(move[X0], move[Y0], box, outline)
        ):
            return -np.inf, 0.0
        return _level_depth(arcs, piece, z - z_low, rise), 0.0
    most, when = -np.inf, 0.0
    climb = move[Z_END] - move[Z_START]
    # Start, the moment of greatest depth, end.
    for moment in range(3):
        t = 0.5 * moment
        if moment == 1:
            t = (z - deepest_height(arcs, piece) - move[Z_START]) / climb
            if not 0.0 < t < 1.0:
                continue
        tip, _z = part_of_move(move, t, t, path)
        if _point_in_region(path[X0], path[Y0], box, outline):
            depth = _level_depth(arcs, piece, z - tip, 0.0)
            if depth > most:
                most, when = depth, t
    return most, when


@njit(cache=True, nogil=True, inline="always")
def _point_in_region(x: float, y: float, box: Floats, outline: Floats) -> bool:
    """Return whether a plan point lies in a region, by its box (4,) first."""
    return box[0] <= x <= box[2] and box[1] <= y <= box[3] and _inside(x, y, outline)


@njit(cache=True, nogil=True)
def _near_cell(
    i: int,
    j: int,
    z: Floats,
    grid: Floats,
    x0: float,
    y0: float,
    x1: float,
    y1: float,
    z_low: float,
    rise: float,
    pieces: Floats,
) -> bool:
    """Return whether some piece comes near a cell (i, j) of a grid whose strips stand between two
    heights z (2,), from a move's plan box.

    By the distance of two boxes and the ranges of height: it errs towards near.
    """
    low_x, low_y = grid[0] + i * grid[2], grid[1] + j * grid[2]
    gx, gy = (
        max(max(low_x - x1, x0 - low_x - grid[2]), 0.0),
        max(max(low_y - y1, y0 - low_y - grid[2]), 0.0),
    )
    gap = math.sqrt(gx * gx + gy * gy)
    for p in range(len(pieces)):
        if (
            z[1] >= z_low + pieces[p, Z_LOW]
            and z[0] <= z_low + rise + pieces[p, Z_HIGH]
            and gap < pieces[p, R_MAX]
        ):
            return True
    return False


@njit(cache=True, nogil=True)
def strip_contact_loop(
    first: int,
    last: int,
    rows: Ints,
    moves: Floats,
    tool: Ints,
    arcs: Floats,
    pieces: Floats,
    piece_start: Ints,
    strips: Floats,
    strip_face: Ints,
    cell_start: Ints,
    cell_strip: Ints,
    cell_z: Floats,
    grid: Floats,
    shape: Ints,
    region_z: Floats,
    region_face: Ints,
    region_box: Floats,
    region_start: Ints,
    outlines: Floats,
    enough: float,
    bound: float,
    settle: float,
    depth: Floats,
    which: Ints,
    where: Floats,
    face_depth: Floats,
    face_move: Ints,
) -> None:
    """Measure the moves of rows `first` to `last` against every strip and every level region near
    them.

    rows (k,) into moves (n, 15) and tool (n,), which is into piece_start; arcs and pieces as in
    `kernels/body.py`. strips (m, 37), strip_face (m,). grid (3,) is x, y of the strips' grid and
    its pitch, shape (2,) its cells, cell_start and cell_strip its lists, cell_z (cells, 2) how low
    and how high the strips of each cell are. region_z, region_face (r,), region_box (r, 4),
    region_start (r + 1,) into outlines (c, 7): level faces. enough, bound, settle in mm.

    Fills depth (k, 2) mm for what cuts and for what does not; which (k, 2) strip rows or -2 -
    region; where (k, 2) profile parameters, of a region the share of the move; face_depth (f, 2)
    and face_move (f, 2), rows of moves. Depths up to `enough` are not reported. A move found deeper
    than `settle` is not searched further: its depth is then only known to be above that.

    All that is skipped is skipped by a bound: depth <= h over the tool's lowest tip, depth <= R_MAX
    - rho, and the distance of boxes is never above the true one.
    """
    guide, path = np.zeros(MOVE_COLUMNS), np.zeros(MOVE_COLUMNS)
    stack, spans = np.zeros((96, 2)), np.zeros((96, 2))
    seen = np.full(len(strips), -1)
    for k in range(first, last):
        n = rows[k]
        move = moves[n]
        z_low, rise = min(move[Z_START], move[Z_END]), abs(move[Z_END] - move[Z_START])
        p0, p1 = piece_start[tool[n]], piece_start[tool[n] + 1]
        widest = 0.0
        for p in range(p0, p1):
            widest = max(widest, pieces[p, R_MAX])
        # Cells under the move's plan box, widened by the tool's largest radius.
        x0, y0, x1, y1 = move_box(move)
        i0, i1 = (
            int(math.floor((x0 - widest - grid[0]) / grid[2])),
            int(math.floor((x1 + widest - grid[0]) / grid[2])),
        )
        j0, j1 = (
            int(math.floor((y0 - widest - grid[1]) / grid[2])),
            int(math.floor((y1 + widest - grid[1]) / grid[2])),
        )
        for j in range(max(j0, 0), min(j1, shape[1] - 1) + 1):
            for i in range(max(i0, 0), min(i1, shape[0] - 1) + 1):
                cell = j * shape[0] + i
                if cell_z[cell, 1] - z_low <= enough:
                    continue
                if not _near_cell(
                    i, j, cell_z[cell], grid, x0, y0, x1, y1, z_low, rise, pieces[p0:p1]
                ):
                    continue
                for c in range(cell_start[cell], cell_start[cell + 1]):
                    m = cell_strip[c]
                    # A strip is listed by several cells; `seen` holds the last move that judged it.
                    if seen[m] == n:
                        continue
                    seen[m] = n
                    s = strips[m]
                    if s[BZ1] - z_low <= enough or depth[k, 0] > settle or depth[k, 1] > settle:
                        continue
                    gx, gy = (
                        max(max(s[BX0] - x1, x0 - s[BX1]), 0.0),
                        max(max(s[BY0] - y1, y0 - s[BY1]), 0.0),
                    )
                    gap = math.sqrt(gx * gx + gy * gy)
                    for p in range(p0, p1):
                        piece = pieces[p]
                        if (
                            s[BZ1] < z_low + piece[Z_LOW]
                            or s[BZ0] > z_low + rise + piece[Z_HIGH]
                            or gap >= piece[R_MAX] - enough
                        ):
                            continue
                        d, u = move_depth(
                            s, move, arcs, piece, enough, bound, path, guide, stack, spans
                        )
                        if d > enough:
                            kind = int(piece[PIECE_KIND])
                            if d > depth[k, kind]:
                                depth[k, kind], which[k, kind], where[k, kind] = d, m, u
                            if d > face_depth[strip_face[m], kind]:
                                face_depth[strip_face[m], kind], face_move[strip_face[m], kind] = (
                                    d,
                                    n,
                                )
        # Level faces: their inside, as `region_depth` has it.
        for r in range(len(region_z)):
            if region_z[r] - z_low <= enough or depth[k, 0] > settle or depth[k, 1] > settle:
                continue
            if (
                x1 < region_box[r, 0]
                or x0 > region_box[r, 2]
                or y1 < region_box[r, 1]
                or y0 > region_box[r, 3]
            ):
                continue
            outline = outlines[region_start[r] : region_start[r + 1]]
            for p in range(p0, p1):
                d, t = region_depth(
                    region_z[r], region_box[r], outline, move, arcs, pieces[p], path
                )
                if d > enough:
                    kind = int(pieces[p, PIECE_KIND])
                    if d > depth[k, kind]:
                        depth[k, kind], which[k, kind], where[k, kind] = d, -2 - r, t
                    if d > face_depth[region_face[r], kind]:
                        face_depth[region_face[r], kind], face_move[region_face[r], kind] = d, n


@njit(cache=True, nogil=True)
def guide_point(s: Floats, u: float, share: float) -> tuple[float, float, float]:
    """Return the point (x, y, z) of a strip at one profile parameter, at a share of its guide from the
    left end to the right one."""
    low = _trim_end(s[L_KIND], s[LA], s[LB], s[LC], s[L_SIGN], u, s[U0])
    high = _trim_end(s[R_KIND], s[RA], s[RB], s[RC], s[R_SIGN], u, s[U0])
    at, w = low + share * (high - low), _profile_w(s, u)
    if s[GUIDE] != 0.0:
        return s[OX] + w * math.cos(at), s[OY] + w * math.sin(at), _profile_z(s, u)
    return s[OX] - w * s[DY] + at * s[DX], s[OY] + w * s[DX] + at * s[DY], _profile_z(s, u)


@njit(cache=True, nogil=True)
def contact_points(
    rows: Ints,
    moves: Floats,
    which: Ints,
    where: Floats,
    strips: Floats,
    strip_face: Ints,
    region_z: Floats,
    region_face: Ints,
    face: Ints,
    position: Floats,
) -> None:
    """Fill face (k, 2) and position (k, 2, 3) with where `strip_contact_loop` found its depths.

    On a guide the nearest to the path of 65 even points is taken: a position to show, not part of any
    bound.
    """
    path = np.zeros(MOVE_COLUMNS)
    for k in range(len(rows)):
        move = moves[rows[k]]
        for kind in range(2):
            found, u = which[k, kind], where[k, kind]
            if found < -1:
                part_of_move(move, u, u, path)
                face[k, kind] = region_face[-2 - found]
                position[k, kind, 0], position[k, kind, 1], position[k, kind, 2] = (
                    path[X0],
                    path[Y0],
                    region_z[-2 - found],
                )
            elif found >= 0:
                face[k, kind], nearest = strip_face[found], np.inf
                for n in range(65):
                    x, y, z = guide_point(strips[found], u, n / 64.0)
                    distance = point_distance(x, y, move)
                    if distance < nearest:
                        nearest = distance
                        position[k, kind, 0], position[k, kind, 1], position[k, kind, 2] = x, y, z


@njit(cache=True, nogil=True)
def fill_cells(
    boxes: Floats, grid: Floats, shape: Ints, counts: Ints, start: Ints, rows: Ints
) -> None:
    """Count or list the boxes (n, 4), x low, y low, x high, y high, that touch each cell of a grid;
    counts (cells,) is filled either way.

    rows empty: count only; else rows gets the boxes of each cell from start (cells + 1,) on.
    """
    counts[:] = 0
    listing = len(rows) > 0
    for n in range(len(boxes)):
        i0 = max(int(math.floor((boxes[n, 0] - grid[0]) / grid[2])), 0)
        j0 = max(int(math.floor((boxes[n, 1] - grid[1]) / grid[2])), 0)
        i1 = min(int(math.floor((boxes[n, 2] - grid[0]) / grid[2])), shape[0] - 1)
        j1 = min(int(math.floor((boxes[n, 3] - grid[1]) / grid[2])), shape[1] - 1)
        for j in range(j0, j1 + 1):
            for i in range(i0, i1 + 1):
                cell = j * shape[0] + i
                if listing:
                    rows[start[cell] + counts[cell]] = n
                counts[cell] += 1
