"""Compiled contact of a moving body of revolution with triangles, for axes that lean or turn: branch
and bound over space and time.

A task is a piece of a triangle in a piece of time, the span. In the frame that turns with the tool
the triangle's three corners at both ends of the span are six points; all that the triangle does in
between lies in their convex hull, up to the sag of `kernels/tool_motion.py` (angle^2 distance / 8 + angle
length / 4, and an arc's own bulge). The depth D in a convex body is concave with slope 1 at most,
so every affine function that bounds D from above bounds it over the whole hull by its values at the
six points:

* the half-space of the body against the triangle's own normal, s(n) - n . p: exact where the
  contact is inside the triangle, however large that is;
* tangents of D at the hull's middle and at the position nearest to the body's core: exact where the
  contact is on an edge or a corner;
* any mixture of two of them, (1 - m) one + m other with m from 0 to 1, which may be lower than
  both.

What these leave open is halved, in time or across an edge, until the bound is at most the stated
error above a depth that is attained (branch and bound with affine upper bounds; Horst and Tuy,
Global Optimization, 1990). Boxes of a bounding volume hierarchy are pruned by a tangent too. Every
approximation (hull, sag, boxes) errs deep; nothing is sampled, so a sharp rim that touches between
two positions is found.

mm, rad, the frame of the moves. Bodies are closed ones as in `kernels/body.py`.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.kernels.kernel_arrays import BORROWED
from trunnion.verify.kernels.body import (
    A0R,
    A0Z,
    A1R,
    A1Z,
    CLOSED_FIRST,
    CLOSED_LAST,
    CR,
    CZ,
    KIND,
    R_MAX,
    R,
    depth_in_body,
    support,
)
from trunnion.verify.kernels.tool_motion import (
    END_COLUMNS,
    FLAT,
    MOTION_COLUMNS,
    S_ANGLE,
    S_AXIS,
    S_FROM,
    S_TO,
    SPAN_COLUMNS,
    axis_at,
    chord_sag,
    fill_swept_segment,
    fill_tool_motion,
    point_in_tool_frame,
    segment_count,
    tip_at,
)

# A piece of a triangle in a piece of time, waiting to be looked at.
CORNERS, T_FROM, T_TO, UPPER, HALVE = 0, 9, 10, 11, 12
TASK_COLUMNS = 13
TASKS = 160
"""More than are ever waiting: each halving adds one, and some sixty bring the largest part below the bound."""

DEEP = 1.0
"""mm: depths beyond this need not be known."""


@njit(**BORROWED)
def _depth_and_normal(
    arcs: Floats,
    first: int,
    last: int,
    ax: float,
    ay: float,
    az: float,
    x: float,
    y: float,
    z: float,
) -> tuple[float, float, float, float]:
    """Return the signed depth (mm) of a point relative to the tip, and the outward unit normal (3) of
    the nearest side; (ax, ay, az) the unit tool axis.

    On the axis itself the radial part of the normal is 0: a supergradient still, by symmetry.
    """
    h = x * ax + y * ay + z * az
    ex, ey, ez = x - h * ax, y - h * ay, z - h * az
    rho = math.sqrt(ex * ex + ey * ey + ez * ez)
    depth, nr, nh = depth_in_body(arcs, first, last, rho, h)
    share = nr / rho if rho > FLAT else 0.0
    return depth, share * ex + nh * ax, share * ey + nh * ay, share * ez + nh * az


@njit(**BORROWED)
def swept_depth_at(
    motion: Floats, t: float, arcs: Floats, first: int, last: int, px: float, py: float, pz: float
) -> float:
    """Return the depth (mm) of a point of space in a body at a share t of the block: exact, so
    attained."""
    ax, ay, az = axis_at(motion, t)
    cx, cy, cz = tip_at(motion, t)
    return _depth_and_normal(arcs, first, last, ax, ay, az, px - cx, py - cy, pz - cz)[0]


@njit(**BORROWED)
def _curvature_centre(
    arcs: Floats,
    first: int,
    last: int,
    ax: float,
    ay: float,
    az: float,
    x: float,
    y: float,
    z: float,
) -> tuple[float, float, float]:
    """Return the point (relative to the tip) about which the body's nearest side is curved: an arc's
    centre ring, or the axis beside a straight flank.

    The contact of a triangle with that side is near the triangle's point nearest to the core. Only
    a guess of where to put the next tangent: no bound depends on it.
    """
    h = x * ax + y * ay + z * az
    ex, ey, ez = x - h * ax, y - h * ay, z - h * az
    rho = math.sqrt(ex * ex + ey * ey + ez * ez)
    best, cr, ch = np.inf, rho, h
    for k in range(first, last):
        dr, dz = rho - arcs[k, CR], h - arcs[k, CZ]
        c0 = arcs[k, A0R] * dz - arcs[k, A0Z] * dr
        c1 = dr * arcs[k, A1Z] - dz * arcs[k, A1R]
        # As in `depth_in_body`: inside an arc's cone its centre counts, outside of it the flank's
        # foot.
        if (
            c0 >= 0.0
            and c1 >= 0.0
            and (dr * (arcs[k, A0R] + arcs[k, A1R]) + dz * (arcs[k, A0Z] + arcs[k, A1Z])) > 0.0
        ):
            depth, r, up = arcs[k, R] - math.sqrt(dr * dr + dz * dz), arcs[k, CR], arcs[k, CZ]
        else:
            d0, d1 = dr * arcs[k, A0R] + dz * arcs[k, A0Z], dr * arcs[k, A1R] + dz * arcs[k, A1Z]
            nr, nz = (arcs[k, A0R], arcs[k, A0Z]) if d0 >= d1 else (arcs[k, A1R], arcs[k, A1Z])
            depth = arcs[k, R] - max(d0, d1)
            # A flank that looks out more than along is followed inwards to the axis; a level one
            # straight up or down by 1 mm.
            r, up = (0.0, h - rho * nz / nr) if nr > 0.5 else (rho, h - nz)
        if depth < best:
            best, cr, ch = depth, r, up
    share = cr / rho if rho > FLAT else 0.0
    return share * ex + ch * ax, share * ey + ch * ay, share * ez + ch * az


@njit(**BORROWED)
def _minimax_combination(one: Floats, other: Floats) -> float:
    """Return the least over m in [0, 1] of the greatest over six points of (1 - m) one + m other (each
    (6,), mm).

    A linear programme in one variable: from m = 0 the upper envelope of six lines is followed
    downhill from crossing to crossing. Any m gives a valid bound, so ending early only loosens it.
    """
    share, top = 0.0, 0
    # The line that is on top just after m = 0.
    for i in range(1, 6):
        if one[i] > one[top] or (one[i] == one[top] and other[i] > other[top]):
            top = i
    value = one[top]
    for _ in range(6):
        slope = other[top] - one[top]
        if slope >= 0.0:
            return value
        step, after = 1.0 - share, -1
        for i in range(6):
            # The first line that overtakes the one on top, by its greater slope.
            steeper = other[i] - one[i] - slope
            if steeper > 0.0:
                reach = (value - one[i] - share * (other[i] - one[i])) / steeper
                if reach < step or (
                    reach == step and after >= 0 and other[i] - one[i] > other[after] - one[after]
                ):
                    step, after = max(reach, 0.0), i
        share += step
        value += step * slope
        if after < 0:
            return value
        top = after
    return value


@njit(**BORROWED, inline="always")
def _safe_ratio(part: float, whole: float) -> float:
    """Return part / whole, 0 where the whole is not positive: triangles without area or with an edge
    of no length."""
    return part / whole if whole > 0.0 else 0.0


@njit(**BORROWED)
def _closest_point_on_triangle(p: Floats, x: float, y: float, z: float) -> tuple[float, float]:
    """Return the position (v, w) of the point a + v (b - a) + w (c - a) of a triangle (3, 3) that is
    nearest to a point.

    By the Voronoi regions of corners, edges and face (Ericson, Real-Time Collision Detection, 2005,
    5.1.5).
    """
    abx, aby, abz = p[1, 0] - p[0, 0], p[1, 1] - p[0, 1], p[1, 2] - p[0, 2]
    acx, acy, acz = p[2, 0] - p[0, 0], p[2, 1] - p[0, 1], p[2, 2] - p[0, 2]
    apx, apy, apz = x - p[0, 0], y - p[0, 1], z - p[0, 2]
    d1, d2 = abx * apx + aby * apy + abz * apz, acx * apx + acy * apy + acz * apz
    # Corner a, corner b, edge ab, corner c, edge ac, edge bc, face: in this order.
    if d1 <= 0.0 and d2 <= 0.0:
        return 0.0, 0.0
    bb, bc, cc = (
        abx * abx + aby * aby + abz * abz,
        abx * acx + aby * acy + abz * acz,
        acx * acx + acy * acy + acz * acz,
    )
    d3, d4 = d1 - bb, d2 - bc
    if d3 >= 0.0 and d4 <= d3:
        return 1.0, 0.0
    vc = d1 * d4 - d3 * d2
    if vc <= 0.0 and d1 >= 0.0 and d3 <= 0.0 and d1 > d3:
        return _safe_ratio(d1, d1 - d3), 0.0
    d5, d6 = d1 - bc, d2 - cc
    if d6 >= 0.0 and d5 <= d6:
        return 0.0, 1.0
    vb = d5 * d2 - d1 * d6
    if vb <= 0.0 and d2 >= 0.0 and d6 <= 0.0 and d2 > d6:
        return 0.0, _safe_ratio(d2, d2 - d6)
    va = d3 * d6 - d5 * d4
    if va <= 0.0 and d4 - d3 >= 0.0 and d5 - d6 >= 0.0 and d4 - d3 + d5 - d6 > 0.0:
        w = _safe_ratio(d4 - d3, (d4 - d3) + (d5 - d6))
        return 1.0 - w, w
    # A triangle without area may get here by rounding: any of its points is as good.
    total = va + vb + vc
    return (vb / total, vc / total) if total != 0.0 else (0.0, 0.0)


@njit(**BORROWED)
def _raise_attained(
    motion: Floats,
    t: float,
    arcs: Floats,
    first: int,
    last: int,
    px: float,
    py: float,
    pz: float,
    found: Floats,
) -> None:
    """Raise found (4,), depth and position, to the depth of a point of space at a share of the block
    where that is deeper."""
    depth = swept_depth_at(motion, t, arcs, first, last, px, py, pz)
    if depth > found[0]:
        found[0], found[1], found[2], found[3] = depth, px, py, pz


@njit(**BORROWED)
def _task_bound(
    task: Floats,
    normal: Floats,
    motion: Floats,
    arcs: Floats,
    first: int,
    last: int,
    enough: float,
    bound: float,
    found: Floats,
    ends: Floats,
    span: Floats,
    six: Floats,
    cuts: Floats,
    flat: Floats,
) -> float:
    """Return an upper bound (mm) on the depth of a task (13,), -inf when that is settled: at most
    `enough`, or at most `bound` above what is attained.

    found (4,), depth and position, is raised to what is attained at the position looked at; the task gets
    its bound (UPPER) and how to halve it (HALVE). ends, span: the cached span, filled anew where
    the task's time differs; six (6, 3), cuts (3, 6) the bounds at the six points, flat (3, 3):
    workspace.
    """
    if span[S_FROM] != task[T_FROM] or span[S_TO] != task[T_TO]:
        fill_swept_segment(motion, task[T_FROM], task[T_TO], ends, span)
    # True positions lie within `drift` of the hull and D has slope 1: the hull's bound must be
    # below the queried depth by that much.
    ax, ay, az = span[S_AXIS], span[S_AXIS + 1], span[S_AXIS + 2]
    drift = _corners_in_tool_frame(task, ends, span, six)
    settled = max(enough, found[0] + bound) - drift
    # First bound: the half-space against the triangle's normal.
    upper = _half_space_bound(arcs, first, last, ax, ay, az, normal, six, cuts[0])
    if upper <= settled:
        return -np.inf
    # Second bound: the tangent at the middle of the six points; and its best mixture with the
    # first.
    x = y = z = 0.0
    for i in range(6):
        x, y, z = x + six[i, 0] / 6.0, y + six[i, 1] / 6.0, z + six[i, 2] / 6.0
    least = _tangent_plane_bound(arcs, first, last, ax, ay, az, x, y, z, six, cuts[1])
    if least <= settled:
        return -np.inf
    upper = min(upper, least, _minimax_combination(cuts[0], cuts[1]))
    if upper <= settled:
        return -np.inf
    # Third: the tangent at the position and time of the triangle nearest to the body's core there. The
    # depth attained there, on the true motion, raises what is known.
    cx, cy, cz = _curvature_centre(arcs, first, last, ax, ay, az, x, y, z)
    v, w, s = _closest_point_and_share(six, cx, cy, cz, flat)
    u, r = 1.0 - v - w, 1.0 - s
    x = r * (u * six[0, 0] + v * six[1, 0] + w * six[2, 0]) + s * (
        u * six[3, 0] + v * six[4, 0] + w * six[5, 0]
    )
    y = r * (u * six[0, 1] + v * six[1, 1] + w * six[2, 1]) + s * (
        u * six[3, 1] + v * six[4, 1] + w * six[5, 1]
    )
    z = r * (u * six[0, 2] + v * six[1, 2] + w * six[2, 2]) + s * (
        u * six[3, 2] + v * six[4, 2] + w * six[5, 2]
    )
    least = _tangent_plane_bound(arcs, first, last, ax, ay, az, x, y, z, six, cuts[2])
    a, b, c = CORNERS, CORNERS + 3, CORNERS + 6
    _raise_attained(
        motion,
        task[T_FROM] + s * (task[T_TO] - task[T_FROM]),
        arcs,
        first,
        last,
        u * task[a] + v * task[b] + w * task[c],
        u * task[a + 1] + v * task[b + 1] + w * task[c + 1],
        u * task[a + 2] + v * task[b + 2] + w * task[c + 2],
        found,
    )
    settled = max(enough, found[0] + bound) - drift
    upper = min(
        upper, least, _minimax_combination(cuts[0], cuts[2]), _minimax_combination(cuts[1], cuts[2])
    )
    if upper <= settled:
        return -np.inf
    # Time where the drift is more than half of what is open, else the longest extent.
    task[HALVE] = _choose_split(task, six, drift > 0.5 * (upper - settled))
    task[UPPER] = upper + drift
    return upper + drift


@njit(**BORROWED)
def _corners_in_tool_frame(task: Floats, ends: Floats, span: Floats, six: Floats) -> float:
    """Fill six (6, 3) with a task's corners as the tool sees them at both ends of the span, and return
    the sag (mm): how far the triangle may leave their hull in between.

    A point of the triangle keeps within `far` of the tip: its distance is convex over the chord and
    over the triangle.
    """
    far = 0.0
    for i in range(6):
        c = CORNERS + 3 * (i % 3)
        x, y, z = point_in_tool_frame(ends, i // 3, task[c], task[c + 1], task[c + 2])
        six[i, 0], six[i, 1], six[i, 2] = x, y, z
        far = max(far, x * x + y * y + z * z)
    return chord_sag(span, math.sqrt(far))


@njit(**BORROWED)
def _half_space_bound(
    arcs: Floats,
    first: int,
    last: int,
    ax: float,
    ay: float,
    az: float,
    normal: Floats,
    six: Floats,
    out: Floats,
) -> float:
    """Fill out (6,) with s(n) - n . p (mm) at six points for n against a triangle's unit normal, and
    return the greatest.

    Valid for any n; the part's outward normal points at the tool, so the body reaches into the part
    along -normal.
    """
    nx, ny, nz = -normal[0], -normal[1], -normal[2]
    nh = nx * ax + ny * ay + nz * az
    reach = support(arcs, first, last, math.sqrt(max(1.0 - nh * nh, 0.0)), nh)
    most = -np.inf
    for i in range(6):
        out[i] = reach - nx * six[i, 0] - ny * six[i, 1] - nz * six[i, 2]
        most = max(most, out[i])
    return most


@njit(**BORROWED)
def _closest_point_and_share(
    six: Floats, cx: float, cy: float, cz: float, flat: Floats
) -> tuple[float, float, float]:
    """Return the position (v, w) in the triangle and the share s of the span at which it is nearest to a
    point.

    Two rounds of alternating minimisation, triangle then time, from the span's middle: a guess, as
    for `_curvature_centre`.
    """
    s = 0.5
    v = w = 0.0
    for _ in range(2):
        for i in range(3):
            for k in range(3):
                flat[i, k] = six[i, k] + s * (six[i + 3, k] - six[i, k])
        v, w = _closest_point_on_triangle(flat, cx, cy, cz)
        dot = square = 0.0
        for k in range(3):
            one = six[0, k] + v * (six[1, k] - six[0, k]) + w * (six[2, k] - six[0, k])
            other = six[3, k] + v * (six[4, k] - six[3, k]) + w * (six[5, k] - six[3, k])
            gap = (cx if k == 0 else cy if k == 1 else cz) - one
            dot, square = dot + gap * (other - one), square + (other - one) * (other - one)
        if square <= FLAT:
            break
        s = min(max(dot / square, 0.0), 1.0)
    return v, w, s


@njit(**BORROWED)
def _tangent_plane_bound(
    arcs: Floats,
    first: int,
    last: int,
    ax: float,
    ay: float,
    az: float,
    x: float,
    y: float,
    z: float,
    six: Floats,
    out: Floats,
) -> float:
    """Fill out (6,) with the tangent plane of the depth at a point, at six points (mm), and return its
    greatest value: D(p) - n . (q - p)."""
    depth, nx, ny, nz = _depth_and_normal(arcs, first, last, ax, ay, az, x, y, z)
    most = -np.inf
    for i in range(6):
        out[i] = depth - nx * (six[i, 0] - x) - ny * (six[i, 1] - y) - nz * (six[i, 2] - z)
        most = max(most, out[i])
    return most


@njit(**BORROWED)
def _choose_split(task: Floats, six: Floats, is_drift: bool) -> float:
    """Return what to halve: 0 the time, 1 to 3 the edge that begins at that corner; the longest of
    edges and corners' paths, or time where the sag is what is left open."""
    if is_drift:
        return 0.0
    longest, at = 0.0, 0
    for i in range(3):
        j = (i + 1) % 3
        square = length = 0.0
        for k in range(3):
            square += (task[CORNERS + 3 * j + k] - task[CORNERS + 3 * i + k]) ** 2
            length += (six[i + 3, k] - six[i, k]) ** 2
        if square > longest:
            longest, at = square, i + 1
        if length > longest:
            longest, at = length, 0
    return float(at)


@njit(cache=True, nogil=True)
def _split_task(task: Floats, one: Floats, other: Floats) -> None:
    """Write both halves of a task: its time at the middle, or its triangle across the middle of an
    edge."""
    one[:] = task
    other[:] = task
    what = int(task[HALVE])
    if what == 0:
        one[T_TO] = other[T_FROM] = 0.5 * (task[T_FROM] + task[T_TO])
        return
    i, j = CORNERS + 3 * (what - 1), CORNERS + 3 * (what % 3)
    for k in range(3):
        one[j + k] = other[i + k] = 0.5 * (task[i + k] + task[j + k])


@njit(**BORROWED)
def _accept_bound(task: Floats, found: Floats) -> None:
    """Raise found (4,), depth and position, to a task's bound, at the middle of its triangle."""
    found[0] = task[UPPER]
    for k in range(3):
        found[1 + k] = (task[CORNERS + k] + task[CORNERS + 3 + k] + task[CORNERS + 6 + k]) / 3.0


@njit(cache=True, nogil=True)
def triangle_contact(
    corners: Floats,
    normal: Floats,
    motion: Floats,
    t0: float,
    t1: float,
    arcs: Floats,
    first: int,
    last: int,
    enough: float,
    bound: float,
    settle: float,
    found: Floats,
    tasks: Floats,
    task: Floats,
    ends: Floats,
    span: Floats,
    six: Floats,
    cuts: Floats,
    flat: Floats,
) -> None:
    """Raise found (4,), depth (mm) and position, to the deepest that a body enters a triangle between two
    shares of a block.

    corners (9,), normal (3,) unit. What it ends with is attained and at most `bound` below the
    deepest, or anything when the deepest is at most `enough`; beyond `settle` it may be any depth
    larger than that. `found` as given counts as known: only what is deeper by more than `bound` is
    searched for. tasks (k, 13) wait; where they have no room for both halves of one, its bound
    counts as the depth: that errs deep. The rest is workspace, see `_task_bound`.
    """
    tasks[0, CORNERS : CORNERS + 9] = corners
    tasks[0, T_FROM], tasks[0, T_TO] = t0, t1
    if (
        _task_bound(
            tasks[0],
            normal,
            motion,
            arcs,
            first,
            last,
            enough,
            bound,
            found,
            ends,
            span,
            six,
            cuts,
            flat,
        )
        == -np.inf
    ):
        return
    # Depth first. Invariant: all that may be deeper than max(enough, found + bound) is in
    # tasks[:top].
    top = 1
    while top > 0 and found[0] <= settle:
        top -= 1
        task[:] = tasks[top]
        if task[UPPER] <= max(enough, found[0] + bound):
            continue
        if top + 2 > len(tasks):
            _accept_bound(task, found)
            continue
        _split_task(task, tasks[top], tasks[top + 1])
        one = _task_bound(
            tasks[top],
            normal,
            motion,
            arcs,
            first,
            last,
            enough,
            bound,
            found,
            ends,
            span,
            six,
            cuts,
            flat,
        )
        other = _task_bound(
            tasks[top + 1],
            normal,
            motion,
            arcs,
            first,
            last,
            enough,
            bound,
            found,
            ends,
            span,
            six,
            cuts,
            flat,
        )
        # The more promising half is looked at next.
        if one > other:
            task[:] = tasks[top]
            tasks[top] = tasks[top + 1]
            tasks[top + 1] = task
            one, other = other, one
        if one == -np.inf:
            tasks[top] = tasks[top + 1]
        top += (one > -np.inf) + (other > -np.inf)


@njit(**BORROWED)
def box_depth_bound(
    box: Floats, ends: Floats, span: Floats, arcs: Floats, first: int, last: int
) -> float:
    """Return an upper bound (mm) on the depth of any point of a box, centre (3,) and half sides (3,),
    in a body during a span.

    The tangent of the depth at the middle of the centre's chord, plus what the chord, the half
    sides and the sag add along its normal.
    """
    ax, ay, az = span[S_AXIS], span[S_AXIS + 1], span[S_AXIS + 2]
    x0, y0, z0 = point_in_tool_frame(ends, 0, box[0], box[1], box[2])
    x1, y1, z1 = point_in_tool_frame(ends, 1, box[0], box[1], box[2])
    depth, nx, ny, nz = _depth_and_normal(
        arcs, first, last, ax, ay, az, 0.5 * (x0 + x1), 0.5 * (y0 + y1), 0.5 * (z0 + z1)
    )
    depth += 0.5 * abs(nx * (x1 - x0) + ny * (y1 - y0) + nz * (z1 - z0))
    if span[S_ANGLE] == 0.0:
        return depth + abs(nx) * box[3] + abs(ny) * box[4] + abs(nz) * box[5] + chord_sag(span, 0.0)
    # The box turns against the normal: half sides at the end where they reach further, and the sag
    # of its furthest corner.
    most = 0.0
    for e in range(2):
        m = ends[e]
        most = max(
            most,
            abs(m[0] * nx + m[3] * ny + m[6] * nz) * box[3]
            + abs(m[1] * nx + m[4] * ny + m[7] * nz) * box[4]
            + abs(m[2] * nx + m[5] * ny + m[8] * nz) * box[5],
        )
    half = math.sqrt(box[3] * box[3] + box[4] * box[4] + box[5] * box[5])
    far = math.sqrt(max(x0 * x0 + y0 * y0 + z0 * z0, x1 * x1 + y1 * y1 + z1 * z1)) + half
    return depth + most + chord_sag(span, far)


@njit(cache=True, nogil=True)
def triangle_contact_loop(
    first: int,
    last: int,
    rows: Ints,
    start: Floats,
    end: Floats,
    axis: Floats,
    end_axis: Floats,
    centre: Floats,
    sweep: Floats,
    tool: Ints,
    arcs: Floats,
    pieces: Floats,
    piece_start: Ints,
    boxes: Floats,
    skip: Ints,
    leaves: Ints,
    node_face: Ints,
    corners: Floats,
    normals: Floats,
    face: Ints,
    n_faces: int,
    bound: Floats,
    enough: Floats,
    settle: float,
    depth: Floats,
    which: Ints,
    position: Floats,
    face_depth: Floats,
    face_move: Ints,
) -> None:
    """Measure the moves of rows[first:last] against all triangles.

    start, end, axis, end_axis, centre (n, 3), sweep (n,) rad, tool (n,): moves; arcs, pieces,
    piece_start as in `kernels/body.py`. boxes (m, 6), skip (m,), leaves (m, 2), node_face (m,): the
    tree, as `tree.py` has it, over triangles in its order: corners (t, 9), normals (t, 3), face
    (t,). bound (k,) mm: how far a depth may be below the true one; enough (k,) mm: depths up to it
    are not reported.

    Fills depth (k, 2) mm, of what cuts and what does not, which (k, 2) faces, position (k, 2, 3), and
    face_depth, face_move (f, 2). A move deeper than `settle` may stop there, and depths beyond
    `DEEP` are only known to be at least that.
    """
    motion, ends, span = (
        np.zeros(MOTION_COLUMNS),
        np.zeros((2, END_COLUMNS)),
        np.zeros(SPAN_COLUMNS),
    )
    near_ends, near = np.zeros((2, END_COLUMNS)), np.zeros(SPAN_COLUMNS)
    tasks, task, found = np.zeros((TASKS, TASK_COLUMNS)), np.zeros(TASK_COLUMNS), np.zeros(4)
    six, cuts, flat = np.zeros((6, 3)), np.zeros((3, 6)), np.zeros((3, 3))
    best, best_position, stamp = (
        np.full((n_faces, 2), -np.inf),
        np.zeros((n_faces, 2, 3)),
        np.full(n_faces, -1),
    )
    reached = np.zeros(n_faces, np.int64)
    for k in range(first, last):
        n = rows[k]
        fill_tool_motion(start[n], end[n], axis[n], end_axis[n], centre[n], sweep[n], motion)
        # What was filled for the move before is not this one's, though its shares be the same.
        near[S_FROM] = near[S_TO] = -1.0
        n_reached, done = 0, False
        for p in range(piece_start[tool[n]], piece_start[tool[n] + 1]):
            a, b = int(pieces[p, CLOSED_FIRST]), int(pieces[p, CLOSED_LAST])
            column = 0 if pieces[p, KIND] == 0.0 else 1
            count = segment_count(motion, pieces[p, R_MAX])
            for q in range(count):
                fill_swept_segment(motion, q / count, (q + 1) / count, ends, span)
                node = 0
                # Preorder traversal; a subtree is skipped when its box cannot be entered by more
                # than `enough`, or all of it is one face that is already known to be `DEEP`.
                while node < len(boxes) and not done:
                    f = node_face[node]
                    known = f >= 0 and stamp[f] == k and best[f, column] >= DEEP
                    if known or box_depth_bound(boxes[node], ends, span, arcs, a, b) <= enough[k]:
                        node = skip[node]
                        continue
                    for m in range(leaves[node, 0], leaves[node, 0] + leaves[node, 1]):
                        f = face[m]
                        if stamp[f] != k:
                            stamp[f], best[f, 0], best[f, 1] = k, -np.inf, -np.inf
                            reached[n_reached] = f
                            n_reached += 1
                        # The face's depth so far is the one to beat: triangles of a face share it.
                        found[0] = before = best[f, column]
                        if before >= DEEP:
                            continue
                        triangle_contact(
                            corners[m],
                            normals[m],
                            motion,
                            q / count,
                            (q + 1) / count,
                            arcs,
                            a,
                            b,
                            enough[k],
                            bound[k],
                            min(settle, DEEP),
                            found,
                            tasks,
                            task,
                            near_ends,
                            near,
                            six,
                            cuts,
                            flat,
                        )
                        if found[0] > before:
                            best[f, column] = found[0]
                            best_position[f, column] = found[1:]
                            if found[0] > settle:
                                done = True
                                break
                    node += 1
        # Of equal depths the lower face row: the result doesn't depend on the order of the tree.
        for i in range(n_reached):
            f = reached[i]
            for column in range(2):
                d = best[f, column]
                if d <= enough[k]:
                    continue
                if d > depth[k, column] or (d == depth[k, column] and f < which[k, column]):
                    depth[k, column], which[k, column] = d, f
                    position[k, column] = best_position[f, column]
                if d > face_depth[f, column]:
                    face_depth[f, column], face_move[f, column] = d, n
