"""Compiled material removal on a height field (z-map, a dexel model with one interval a column) by
swept upright cutters.

One column stands at each cell centre and keeps the height of its top (van Hook, Real-time shaded NC
milling display, 1986; Anderson, Detecting and eliminating collisions in NC machining, 1978). A move
lowers a column to the lower envelope of the cutter along the move,

    cut(x, y) = min over t of z(t) + g(|(x, y) - tip(t)|)

with g(rho) the height above the tip at which the cutter begins at the distance rho from its axis.
For level moves of any form and slopes of plain ones this minimum is taken in closed form, so a move
is not sampled: only space is, at the cell centres. Between columns nothing is known here (see
`_boundary_cells`).

A level line or arc is cut in one pass over the rows that its sweep covers: within a row only the
cells that the sweep reaches, less those that the move before has already cut to this height.

A height field holds the whole truth while nothing is left above a cut. Where a column stands higher
than the height OPEN up to which the cutter gets no thinner (`verify/profile.py`), it is left as it
is and counted: the caller goes on with bundles of intervals (`kernels/stock/dexels.py`) from there.

Frame: the blank's, tool axis +z; mm, rad. top (rows, columns) float64 heights; cell (j, i) has its
centre at origin + ((i + 0.5) pitch, (j + 0.5) pitch). At a column the height is exact, but for the
chords of a helix, which leave it by a stated error to either side.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.verify.kernels.body import (
    CLOSED_FIRST,
    CLOSED_LAST,
    R_MAX,
    Z_HIGH,
    Z_LOW,
    depth_in_body,
    heights_at,
)
from trunnion.verify.kernels.body import FIRST as PIECE_FIRST
from trunnion.verify.kernels.body import LAST as PIECE_LAST
from trunnion.verify.kernels.stock.engagement import engagement_in_zmap

# Columns of a move, as in `kernels/contact/strips.py`; the engines share the layout of their input, not their loops.
KIND, X0, Y0, X1, Y1, CX, CY, ARC_RADIUS, MX, MY, COS_HALF, START_ANGLE, SWEEP, Z_START, Z_END = (
    range(15)
)
# Columns of a tool's profile, see `verify/profile.py`.
RADIUS, CORNER, OPEN, PLAIN, FIRST, LAST = range(6)
STILL = 1e-9
"""mm; a move shorter than this in plan has no direction."""
SHRINK = 2e-3
"""mm; by how much what the move before has cut is taken smaller: where it was an arc, its posted ends are off it by up to this."""


@njit(cache=True, nogil=True, inline="always")
def _arc_distance_squared(qx: float, qy: float, move: Floats) -> float:
    """Return the squared plan distance (mm2) of a point to a move's arc.

    Inside the arc's sector it is (|v| - radius)^2, v from the centre; outside of it an end is
    nearest.
    """
    vx, vy = qx - move[CX], qy - move[CY]
    length = math.sqrt(vx * vx + vy * vy)
    if vx * move[MX] + vy * move[MY] >= length * move[COS_HALF]:
        return (length - move[ARC_RADIUS]) ** 2
    ax, ay, bx, by = qx - move[X0], qy - move[Y0], qx - move[X1], qy - move[Y1]
    return min(ax * ax + ay * ay, bx * bx + by * by)


@njit(cache=True, nogil=True, inline="always")
def _segment_distance_squared(
    qx: float, qy: float, x0: float, y0: float, dx: float, dy: float, square: float
) -> float:
    """Return the squared plan distance (mm2) of a point to a segment from (x0, y0) by (dx, dy),
    `square` its squared length; 0 makes it a point."""
    t = 0.0
    if square > 0.0:
        t = min(max(((qx - x0) * dx + (qy - y0) * dy) / square, 0.0), 1.0)
    ex, ey = qx - x0 - t * dx, qy - y0 - t * dy
    return ex * ex + ey * ey


@njit(cache=True, nogil=True)
def profile_height(square: float, profile: Floats, arcs: Floats, pieces: Floats) -> float:
    """Return g (mm), the height above the tip at which a cutter of any form begins at a squared
    distance `square` (mm2) from its axis; infinite outside of it.

    The least over its convex bodies, rows FIRST to LAST of pieces.
    """
    rho, best = math.sqrt(square), np.inf
    for k in range(int(profile[FIRST]), int(profile[LAST])):
        if rho < pieces[k, R_MAX]:
            low, high = heights_at(
                arcs,
                int(pieces[k, PIECE_FIRST]),
                int(pieces[k, PIECE_LAST]),
                pieces[k, Z_LOW],
                pieces[k, Z_HIGH],
                rho,
            )
            if low <= high:
                best = min(best, low)
    return best


@njit(cache=True, nogil=True, inline="always")
def _bull_height(square: float, inner: float, corner: float) -> float:
    """Return g (mm) of a plain cutter at a squared distance inside its radius: 0 under the level end,
    a quarter circle of radius `corner` around it.

    inner = radius - corner; g = corner - sqrt(corner^2 - (rho - inner)^2).
    """
    if square <= inner * inner or corner == 0.0:
        return 0.0
    out = math.sqrt(square) - inner
    return corner - math.sqrt(max(corner * corner - out * out, 0.0))


@njit(cache=True, nogil=True, inline="always")
def first_cell(low: float, origin: float, pitch: float) -> int:
    """Return the first cell, 0 at least, whose centre is not below the coordinate `low` (mm)."""
    return max(int(math.ceil((low - origin) / pitch - 0.5)), 0)


@njit(cache=True, nogil=True, inline="always")
def last_cell(high: float, origin: float, pitch: float, count: int) -> int:
    """Return the last cell, count - 1 at most, whose centre is not above the coordinate `high` (mm)."""
    return min(int(math.floor((high - origin) / pitch - 0.5)), count - 1)


@njit(cache=True, nogil=True)
def _swept_box(move: Floats, radius: float) -> tuple[float, float, float, float]:
    """Return the plan box (x low, y low, x high, y high) of a move, wider by `radius` (mm) on all
    sides."""
    x0, y0 = min(move[X0], move[X1]), min(move[Y0], move[Y1])
    x1, y1 = max(move[X0], move[X1]), max(move[Y0], move[Y1])
    if move[KIND] != 0.0:
        # A quadrant point of the circle counts where the arc's sector holds it; the tolerance only
        # makes the box larger.
        c = move[COS_HALF] - 1e-12
        if move[MX] >= c:
            x1 = max(x1, move[CX] + move[ARC_RADIUS])
        if -move[MX] >= c:
            x0 = min(x0, move[CX] - move[ARC_RADIUS])
        if move[MY] >= c:
            y1 = max(y1, move[CY] + move[ARC_RADIUS])
        if -move[MY] >= c:
            y0 = min(y0, move[CY] - move[ARC_RADIUS])
    return x0 - radius, y0 - radius, x1 + radius, y1 + radius


@njit(cache=True, nogil=True, inline="always")
def _lower(row: Floats, i: int, cut: float, upper: float) -> tuple[float, int]:
    """Lower cell i of a row to the height `cut` (mm) where it is higher; return the removed height
    (mm) and 1 where the cell is higher than `upper` and so is left standing, else 0.

    Inlined: in five alternating runs of level, sloped, arc and helix moves no kind got slower than by
    0.4 % against writing it out (`tests/bench/proof.py`, field).
    """
    h = row[i]
    if cut >= h:
        return 0.0, 0
    if h > upper:
        return 0.0, 1
    row[i] = cut
    return h - cut, 0


@njit(cache=True, nogil=True)
def _zmap_cut_row(
    row: Floats,
    px: float,
    py: float,
    pitch: float,
    dx: float,
    dy: float,
    inverse: float,
    z: float,
    floor: float,
    upper: float,
    radius: float,
    corner: float,
) -> tuple[float, int]:
    """Lower the cells of a row under a plain cutter on a level line; return the removed height (mm,
    summed) and how many columns were left standing.

    row (k,) a view of the heights; px, py the first cell's centre relative to the line's start;
    inverse: 1 / squared length, 0 for a standing cutter; z of the tip; floor: no column goes below
    it; upper: a higher column is left and counted.
    """
    removed, uncut = 0.0, 0
    inner, limit, bottom = radius - corner, radius * radius, max(z, floor)
    flat = inner * inner
    for i in range(len(row)):
        h = row[i]
        if h > bottom:
            x = px + i * pitch
            # Nearest point of the segment; d is the squared distance of the cell's centre to it.
            t = min(max((x * dx + py * dy) * inverse, 0.0), 1.0)
            ex, ey = x - t * dx, py - t * dy
            d = ex * ex + ey * ey
            if d < limit:
                cut = bottom
                if d > flat:
                    out = math.sqrt(d) - inner
                    cut = max(
                        z + (corner - math.sqrt(max(corner * corner - out * out, 0.0))), floor
                    )
                r, s = _lower(row, i, cut, upper)
                removed, uncut = removed + r, uncut + s
    return removed, uncut


@njit(cache=True, nogil=True)
def _zmap_cut_row_formed(
    row: Floats,
    px: float,
    py: float,
    pitch: float,
    dx: float,
    dy: float,
    inverse: float,
    z: float,
    floor: float,
    upper: float,
    profile: Floats,
    arcs: Floats,
    pieces: Floats,
) -> tuple[float, int]:
    """Lower the cells of a row under a cutter of any form on a level line; arguments and results as
    for `_zmap_cut_row`."""
    removed, uncut = 0.0, 0
    limit, bottom = profile[RADIUS] * profile[RADIUS], max(z, floor)
    for i in range(len(row)):
        h = row[i]
        if h > bottom:
            x = px + i * pitch
            t = min(max((x * dx + py * dy) * inverse, 0.0), 1.0)
            ex, ey = x - t * dx, py - t * dy
            d = ex * ex + ey * ey
            if d < limit:
                cut = max(z + profile_height(d, profile, arcs, pieces), floor)
                r, s = _lower(row, i, cut, upper)
                removed, uncut = removed + r, uncut + s
    return removed, uncut


@njit(cache=True, nogil=True, fastmath={"reassoc", "nsz", "contract", "nnan"})
def _zmap_cut_row_ball(
    row: Floats,
    px: float,
    py: float,
    pitch: float,
    dx: float,
    dy: float,
    inverse: float,
    z: float,
    floor: float,
    upper: float,
    radius: float,
) -> tuple[float, int]:
    """Lower the cells of a row under a ball end on a level line, as `_zmap_cut_row` does; without
    branches, so that it is vectorised.

    Most cells ahead of a ball get lower at every move: computing them all is faster than a
    branch. Reassociation moves a height by a few units in the last place.
    """
    removed, uncut = 0.0, 0.0
    limit = radius * radius
    for i in range(len(row)):
        h = row[i]
        x = px + i * pitch
        t = (x * dx + py * dy) * inverse
        t = 0.0 if t < 0.0 else t
        t = 1.0 if t > 1.0 else t
        ex, ey = x - t * dx, py - t * dy
        gap = limit - (ex * ex + ey * ey)
        cut = z + (radius - math.sqrt(gap if gap > 0.0 else 0.0))
        cut = cut if cut > floor else floor
        inside = (gap > 0.0) & (cut < h)
        new = cut if inside & (h <= upper) else h
        # Counted in floats: a whole number beside them would keep the loop from being done several cells at a time.
        uncut += 1.0 if inside & (h > upper) else 0.0
        removed += h - new
        row[i] = new
    return removed, int(uncut)


@njit(cache=True, nogil=True, inline="always")
def _capsule_row(
    y: float,
    x0: float,
    y0: float,
    x1: float,
    y1: float,
    radius: float,
    sx: float,
    sy: float,
    inv_dy: float,
    dx: float,
) -> tuple[float, float]:
    """Return the x range in which the row at y meets a disc swept along a segment (a capsule); low >
    high where it does not.

    (sx, sy): from the segment to its left side, `radius` long; inv_dy: 1 / dy, 0 for a segment
    along x. The hull of both end discs' chords and of the crossings with both straight sides: a
    capsule is convex, so that is the whole range.
    """
    low, high = np.inf, -np.inf
    gap = radius * radius - (y - y0) ** 2
    if gap >= 0.0:
        half = math.sqrt(gap)
        low, high = x0 - half, x0 + half
    gap = radius * radius - (y - y1) ** 2
    if gap >= 0.0:
        half = math.sqrt(gap)
        low, high = min(low, x1 - half), max(high, x1 + half)
    if inv_dy != 0.0:
        t = (y - y0 - sy) * inv_dy
        if 0.0 <= t <= 1.0:
            x = x0 + sx + t * dx
            low, high = min(low, x), max(high, x)
        t = (y - y0 + sy) * inv_dy
        if 0.0 <= t <= 1.0:
            x = x0 - sx + t * dx
            low, high = min(low, x), max(high, x)
    return low, high


@njit(cache=True, nogil=True)
def _zmap_cut_line(
    top: Floats,
    origin: Floats,
    pitch: float,
    floor: float,
    x0: float,
    y0: float,
    x1: float,
    y1: float,
    z: float,
    upper: float,
    joined: bool,
    profile: Floats,
    arcs: Floats,
    pieces: Floats,
) -> tuple[float, int]:
    """Cut a level line, or a standing or plunging cutter at its lowest; return the removed height (mm,
    summed) and how many columns were left standing.

    `joined`: the same cutter has just arrived at the start at this height. Then the cells behind
    the start's perpendicular are done, and so is the disc of the cutter's level end around the
    start: both are skipped. The level disc is taken smaller by SHRINK along the row, so that posted
    ends which lie off their arc do not leave its rim standing.
    """
    radius, corner = profile[RADIUS], profile[CORNER]
    plain, ball = profile[PLAIN] != 0.0, profile[PLAIN] != 0.0 and corner == radius
    dx, dy = x1 - x0, y1 - y0
    square = dx * dx + dy * dy
    moves = square > STILL * STILL
    inverse = 1.0 / square if moves else 0.0
    length = math.sqrt(square)
    sx, sy = (-radius * dy / length, radius * dx / length) if moves else (0.0, 0.0)
    inv_dy = 1.0 / dy if abs(dy) > STILL else 0.0
    slant = dy / dx if abs(dx) > STILL else 0.0
    level = radius - corner if plain and joined else 0.0
    removed, uncut = 0.0, 0
    columns, cell, first_x = top.shape[1], 1.0 / pitch, origin[0] + 0.5 * pitch
    x = first_x - x0
    for j in range(
        first_cell(min(y0, y1) - radius, origin[1], pitch),
        last_cell(max(y0, y1) + radius, origin[1], pitch, top.shape[0]) + 1,
    ):
        y = origin[1] + (j + 0.5) * pitch
        py = y - y0
        low, high = _capsule_row(y, x0, y0, x1, y1, radius, sx, sy, inv_dy, dx)
        # Cells ahead of the perpendicular: (x - x0) dx + (y - y0) dy >= 0, solved for x on this
        # row.
        if joined and moves:
            if dx > STILL:
                low = max(low, x0 - py * slant)
            elif dx < -STILL:
                high = min(high, x0 - py * slant)
            elif py * dy < 0.0:
                continue
        if low > high:
            continue
        # One cell more on each side than the range holds: the row functions decide by distance.
        a, b = (
            max(int(math.floor((low - first_x) * cell)), 0),
            min(int(math.ceil((high - first_x) * cell)), columns - 1),
        )
        # The cells from c to d lie under the level end at the start and are done; c > d: none.
        c, d = b + 1, b
        gap = level * level - py * py
        if gap > SHRINK:
            half = math.sqrt(gap) - SHRINK
            c, d = (
                int(math.ceil((x0 - half - first_x) * cell)),
                int(math.floor((x0 + half - first_x) * cell)),
            )
            if c > d:
                c, d = b + 1, b
        for side in range(2):
            p, q = (a, min(b, c - 1)) if side == 0 else (max(a, d + 1), b)
            if p > q:
                continue
            row, px = top[j, p : q + 1], x + p * pitch
            if ball:
                r, s = _zmap_cut_row_ball(
                    row, px, py, pitch, dx, dy, inverse, z, floor, upper, radius
                )
            elif plain:
                r, s = _zmap_cut_row(
                    row, px, py, pitch, dx, dy, inverse, z, floor, upper, radius, corner
                )
            else:
                r, s = _zmap_cut_row_formed(
                    row, px, py, pitch, dx, dy, inverse, z, floor, upper, profile, arcs, pieces
                )
            removed, uncut = removed + r, uncut + s
    return removed, uncut


@njit(cache=True, nogil=True)
def _zmap_cut_arc_row(
    row: Floats,
    first: int,
    last: int,
    first_x: float,
    y: float,
    pitch: float,
    move: Floats,
    z: float,
    floor: float,
    upper: float,
    profile: Floats,
    arcs: Floats,
    pieces: Floats,
) -> tuple[float, int]:
    """Lower cells `first` to `last` of a row under a level arc; results as for `_zmap_cut_row`. left:
    x of the row's first cell centre, y of the row."""
    removed, uncut = 0.0, 0
    corner, inner, limit = profile[CORNER], profile[RADIUS] - profile[CORNER], profile[RADIUS] ** 2
    bottom = max(z, floor)
    for i in range(first, last + 1):
        h = row[i]
        if h > bottom:
            d = _arc_distance_squared(first_x + i * pitch, y, move)
            if d < limit:
                # g over the squared distance to the arc: quarter circle of a plain cutter, else its bodies.
                if profile[PLAIN] != 0.0:
                    cut = max(z + _bull_height(d, inner, corner), floor)
                else:
                    cut = max(z + profile_height(d, profile, arcs, pieces), floor)
                r, s = _lower(row, i, cut, upper)
                removed, uncut = removed + r, uncut + s
    return removed, uncut


@njit(cache=True, nogil=True)
def _zmap_cut_arc(
    top: Floats,
    origin: Floats,
    pitch: float,
    floor: float,
    move: Floats,
    z: float,
    upper: float,
    profile: Floats,
    arcs: Floats,
    pieces: Floats,
) -> tuple[float, int]:
    """Cut a level arc: in each row of its box, the cells between the outer and the inner circle of its
    rim; results as for `_zmap_cut_row`.

    The inner circle, of radius arc radius - cutter radius, is never reached and is skipped with a
    margin. The sector is not tested here: `_arc_distance_squared` measures to the arc itself.
    """
    radius = profile[RADIUS]
    x0, y0, x1, y1 = _swept_box(move, radius)
    first_x = origin[0] + 0.5 * pitch
    outer, hollow = move[ARC_RADIUS] + radius, max(move[ARC_RADIUS] - radius, 0.0)
    i0, i1 = first_cell(x0, origin[0], pitch), last_cell(x1, origin[0], pitch, top.shape[1])
    removed, uncut = 0.0, 0
    for j in range(
        first_cell(y0, origin[1], pitch), last_cell(y1, origin[1], pitch, top.shape[0]) + 1
    ):
        y = origin[1] + (j + 0.5) * pitch
        py = y - move[CY]
        half = math.sqrt(max(outer * outer - py * py, 0.0))
        a = max(i0, int(math.floor((move[CX] - half - first_x) / pitch)))
        b = min(i1, int(math.ceil((move[CX] + half - first_x) / pitch)))
        gap = hollow * hollow - py * py
        if gap > SHRINK:
            half = math.sqrt(gap) - SHRINK
            c, d = (
                int(math.ceil((move[CX] - half - first_x) / pitch)),
                int(math.floor((move[CX] + half - first_x) / pitch)),
            )
            if c <= d:
                r, s = _zmap_cut_arc_row(
                    top[j],
                    a,
                    min(b, c - 1),
                    first_x,
                    y,
                    pitch,
                    move,
                    z,
                    floor,
                    upper,
                    profile,
                    arcs,
                    pieces,
                )
                removed, uncut = removed + r, uncut + s
                a = max(a, d + 1)
        r, s = _zmap_cut_arc_row(
            top[j], a, b, first_x, y, pitch, move, z, floor, upper, profile, arcs, pieces
        )
        removed, uncut = removed + r, uncut + s
    return removed, uncut


@njit(cache=True, nogil=True)
def _rim_slope(wanted: float, across: float, inner: float, corner: float) -> float:
    """Return the slope p of a bull end's rim, in its axial plane, where its slope along the direction
    of motion equals `wanted` >= 0.

    At the distance `across` beside the path and rho from the axis, a rim that rises by p per mm
    outwards rises by p sqrt(1 - across^2 / rho^2) along the path, with rho = inner + corner p /
    sqrt(1 + p^2). This grows with p, so the root is unique: Newton's method, safeguarded by
    bisection of a bracket. Infinite where the path passes the rim's widest circle.
    """
    # Below `low` the rim is nearer to the axis than `across`, or its slope along the path too
    # small.
    out = min(max(across - inner, 0.0) / corner, 1.0)
    if out >= 1.0:
        return np.inf
    low = max(out / math.sqrt(1.0 - out * out), wanted)
    high = 2.0 * low + 1.0
    # Widen the bracket until the slope along the path reaches what is wanted.
    for _ in range(60):
        rho = inner + corner * high / math.sqrt(1.0 + high * high)
        if high * math.sqrt(max(1.0 - (across / rho) ** 2, 0.0)) >= wanted or high > 1e9:
            break
        low, high = high, 4.0 * high
    p = low + 0.1 * (high - low)
    # d/dp of p seen(p): seen + p across^2 rho' / (rho^3 seen), with rho' = corner / (1 +
    # p^2)^(3/2).
    for _ in range(60):
        q = 1.0 / math.sqrt(1.0 + p * p)
        rho = inner + corner * p * q
        seen = math.sqrt(max(1.0 - (across / rho) ** 2, 0.0))
        excess = p * seen - wanted
        if excess > 0.0:
            high = p
        else:
            low = p
        if abs(excess) <= 1e-10 * (1.0 + wanted) or high - low <= 1e-13 * high:
            return p
        slope = seen + (
            p * across * across * corner * q * q * q / (rho**3 * seen) if seen > 0.0 else 1.0
        )
        p -= excess / slope
        if not low < p < high:
            p = 0.5 * (low + high)
    return p


@njit(cache=True, nogil=True)
def _profile_on_slope(
    across: float,
    low: float,
    high: float,
    slope: float,
    profile: Floats,
    arcs: Floats,
    pieces: Floats,
) -> float:
    """Return the least of slope w + g(sqrt(across^2 + w^2)) (mm) over w from `low` to `high`, for a
    cutter of any form; infinite where it never covers the column.

    w (mm) runs along the path from the column's foot. Each convex body has a convex lower side, so
    golden section finds its minimum; the least over the bodies is taken. 48 sections leave 1e-10 of
    the interval, and what is returned is attained: it errs towards standing material.
    """
    best = np.inf
    for k in range(int(profile[FIRST]), int(profile[LAST])):
        gap = pieces[k, R_MAX] ** 2 - across * across
        if gap <= 0.0:
            continue
        # A chord of the body's disc, a hair shorter so that rounding does not step outside of it.
        half = math.sqrt(gap) * (1.0 - 1e-12)
        a, b = max(low, -half), min(high, half)
        if a > b:
            continue
        p, q = int(pieces[k, PIECE_FIRST]), int(pieces[k, PIECE_LAST])
        # Golden section (Kiefer, 1953) on slope w + g, convex in w on one body.
        for _ in range(48):
            c, d = a + 0.382 * (b - a), a + 0.618 * (b - a)
            hc = heights_at(
                arcs, p, q, pieces[k, Z_LOW], pieces[k, Z_HIGH], math.sqrt(across * across + c * c)
            )[0]
            hd = heights_at(
                arcs, p, q, pieces[k, Z_LOW], pieces[k, Z_HIGH], math.sqrt(across * across + d * d)
            )[0]
            if slope * c + hc < slope * d + hd:
                b = d
            else:
                a = c
        w = 0.5 * (a + b)
        best = min(
            best,
            slope * w
            + heights_at(
                arcs, p, q, pieces[k, Z_LOW], pieces[k, Z_HIGH], math.sqrt(across * across + w * w)
            )[0],
        )
    return best


@njit(cache=True, nogil=True, inline="always")
def _height_derivative(w: float, square: float, inner: float, corner: float) -> float:
    """Return the derivative by w of a bull end's height g at w along the path, with `square` the
    squared distance beside it; infinite at its rim."""
    rho = math.sqrt(square + w * w)
    out = rho - inner
    if out <= 0.0:
        return 0.0
    if out >= corner:
        return np.inf if w > 0.0 else -np.inf
    return out / math.sqrt(corner * corner - out * out) * w / rho


@njit(cache=True, nogil=True)
def _bull_on_slope(
    along: float,
    across: float,
    length: float,
    z0: float,
    slope: float,
    radius: float,
    corner: float,
) -> float:
    """Return the lowest height (mm) of a plain cutter over a column while it moves along a slope;
    infinite when it never covers it.

    along, across: the column's plan coordinates (mm) from the start, along and beside the path; z0
    tip at the start; slope: rise per mm in plan. With w the position of the axis from the column's
    foot the height is base + slope w + g(sqrt(across^2 + w^2)), convex in w; its minimum over w in
    [low, high] is found in closed form for flat and ball ends and by `_rim_slope` for a bull end.
    """
    square = across * across
    gap = radius * radius - square
    if gap <= 0.0:
        return np.inf
    half = math.sqrt(gap)
    # w runs along the path, from the column's foot on it: there the cutter's axis is.
    low, high = max(-half, -along), min(half, length - along)
    if low > high:
        return np.inf
    base, inner = z0 + along * slope, radius - corner
    # Flat end: g = 0, linear in w.
    if corner == 0.0:
        return base + min(low * slope, high * slope)
    # Ball end: slope + w / sqrt(half^2 - w^2) = 0.
    if inner <= 0.0:
        w = min(max(-slope * half / math.sqrt(1.0 + slope * slope), low), high)
    # The height over w is convex: where it rises at the low end already, that is the lowest; on short moves nearly everywhere.
    elif slope + _height_derivative(low, square, inner, corner) >= 0.0:
        w = low
    elif slope + _height_derivative(high, square, inner, corner) <= 0.0:
        w = high
    else:
        # Inside: the rim's slope along the path equals minus the path's slope.
        p = _rim_slope(abs(slope), abs(across), inner, corner)
        rho = inner + corner * p / math.sqrt(1.0 + p * p)
        w = math.sqrt(max(rho * rho - square, 0.0))
        w = min(max(-w if slope > 0.0 else w, low), high)
    return base + w * slope + _bull_height(min(square + w * w, radius * radius), inner, corner)


@njit(cache=True, nogil=True)
def _zmap_cut_slope(
    top: Floats,
    origin: Floats,
    pitch: float,
    floor: float,
    x0: float,
    y0: float,
    z0: float,
    x1: float,
    y1: float,
    z1: float,
    upper: float,
    joined: bool,
    profile: Floats,
    arcs: Floats,
    pieces: Floats,
) -> tuple[float, int]:
    """Cut a sloped line; results as for `_zmap_cut_row`.

    A column behind the start of a joined line that climbs is done: the cutter only moves up and
    away from it, and stood at the start when the move before ended.
    """
    dx, dy, radius, corner = x1 - x0, y1 - y0, profile[RADIUS], profile[CORNER]
    length = math.sqrt(dx * dx + dy * dy)
    slope, plain = (z1 - z0) / length, profile[PLAIN] != 0.0
    ux, uy = dx / length, dy / length
    sx, sy = -radius * uy, radius * ux
    inv_dy = 1.0 / dy if abs(dy) > STILL else 0.0
    done_behind = joined and z1 >= z0
    # No column at or below the lowest tip is lowered; a bound from below that saves most of the
    # work.
    lowest, removed, uncut = max(min(z0, z1), floor), 0.0, 0
    first_x = origin[0] + 0.5 * pitch
    for j in range(
        first_cell(min(y0, y1) - radius, origin[1], pitch),
        last_cell(max(y0, y1) + radius, origin[1], pitch, top.shape[0]) + 1,
    ):
        y = origin[1] + (j + 0.5) * pitch
        low, high = _capsule_row(y, x0, y0, x1, y1, radius, sx, sy, inv_dy, dx)
        if low > high:
            continue
        py = y - y0
        first = max(int(math.floor((low - first_x) / pitch)), 0)
        row = top[j, first : min(int(math.ceil((high - first_x) / pitch)), top.shape[1] - 1) + 1]
        # Invariant: no column of the row ends below the envelope of the cutter along the line.
        for i in range(len(row)):
            h = row[i]
            if h <= lowest:
                continue
            px = first_x + (first + i) * pitch - x0
            along, across = px * ux + py * uy, px * uy - py * ux
            if done_behind and along < 0.0:
                continue
            # cut = min over the line of z + g: closed form for plain cutters, golden section for others.
            if plain:
                cut = max(_bull_on_slope(along, across, length, z0, slope, radius, corner), floor)
            else:
                low, high = -along, length - along
                cut = max(
                    z0
                    + along * slope
                    + _profile_on_slope(abs(across), low, high, slope, profile, arcs, pieces),
                    floor,
                )
            r, s = _lower(row, i, cut, upper)
            removed, uncut = removed + r, uncut + s
    return removed, uncut


@njit(cache=True, nogil=True)
def _zmap_cut_helix(
    top: Floats,
    origin: Floats,
    pitch: float,
    floor: float,
    move: Floats,
    radius: float,
    opening: float,
) -> tuple[float, int]:
    """Cut a helix by a level disc of a radius (mm), exactly; results as for `_zmap_cut_row`.

    A column at the distance rho from the helix's centre is covered while the tip's angle is within
    `half` of its own, by the law of cosines rho^2 + arm^2 - 2 rho arm cos(half) = radius^2; on the
    way down the last covered moment is the lowest, on the way up the first. Windows a turn apart hold
    every covered moment, as many as the sweep has turns, and one before. `opening`: OPEN of the
    tool's profile.
    """
    x0, y0, x1, y1 = _swept_box(move, radius)
    arm, sweep, z0, z1 = move[ARC_RADIUS], abs(move[SWEEP]), move[Z_START], move[Z_END]
    turn = 1.0 if move[SWEEP] > 0.0 else -1.0
    turns = int(math.floor(sweep / math.tau)) + 1
    lowest, removed, uncut = max(min(z0, z1), floor), 0.0, 0
    i0, i1 = first_cell(x0, origin[0], pitch), last_cell(x1, origin[0], pitch, top.shape[1])
    for j in range(
        first_cell(y0, origin[1], pitch), last_cell(y1, origin[1], pitch, top.shape[0]) + 1
    ):
        y = origin[1] + (j + 0.5) * pitch - move[CY]
        for i in range(i0, i1 + 1):
            h = top[j, i]
            if h <= lowest:
                continue
            x = origin[0] + (i + 0.5) * pitch - move[CX]
            rho = math.sqrt(x * x + y * y)
            # The disc never comes as near.
            if abs(rho - arm) >= radius:
                continue
            z = np.inf
            # Always covered, at every angle.
            if rho + arm < radius:
                z = min(z0, z1)
            else:
                half = math.acos(
                    min(
                        max((rho * rho + arm * arm - radius * radius) / (2.0 * rho * arm), -1.0),
                        1.0,
                    )
                )
                # The column's angle from the start in the direction of travel, 0 to a turn.
                nearest = (turn * (math.atan2(y, x) - move[START_ANGLE])) % math.tau
                for round_ in range(-1, turns + 1):
                    a = max(nearest + round_ * math.tau - half, 0.0)
                    b = min(nearest + round_ * math.tau + half, sweep)
                    if a < b:
                        z = min(z, z0 + (b if z1 < z0 else a) / sweep * (z1 - z0))
            cut = max(z, floor)
            r, s = _lower(top[j], i, cut, z + opening)
            removed, uncut = removed + r, uncut + s
    return removed, uncut


@njit(cache=True, nogil=True)
def zmap_cut_move(
    top: Floats,
    origin: Floats,
    pitch: float,
    floor: float,
    move: Floats,
    joined: bool,
    profile: Floats,
    arcs: Floats,
    pieces: Floats,
    chord: float,
) -> tuple[float, int]:
    """Cut one upright feed move into the field; return the removed height (mm) summed over columns,
    and how many columns were left standing.

    top (rows, columns) heights, changed; origin (2,) the field's corner; floor its lowest height;
    joined as `joins` says. Level moves and sloped lines have a closed form. A helix is cut by the
    level end exactly, then by its rounded rim as slopes along chords that leave the helix by at
    most `chord` (mm).
    """
    z0, z1 = move[Z_START], move[Z_END]
    lowest = min(z0, z1)
    upper = lowest + profile[OPEN]
    line = move[KIND] == 0.0
    if z0 == z1 and not line:
        return _zmap_cut_arc(top, origin, pitch, floor, move, lowest, upper, profile, arcs, pieces)
    dx, dy = move[X1] - move[X0], move[Y1] - move[Y0]
    still = line and dx * dx + dy * dy <= STILL * STILL
    if still or z0 == z1:
        # On its way down a cutter passes all of a column up to where it came from.
        return _zmap_cut_line(
            top,
            origin,
            pitch,
            floor,
            move[X0],
            move[Y0],
            move[X1],
            move[Y1],
            lowest,
            max(z0, z1) + profile[OPEN],
            joined and not still,
            profile,
            arcs,
            pieces,
        )
    # A sloped line: the lower envelope in closed form.
    if line:
        return _zmap_cut_slope(
            top,
            origin,
            pitch,
            floor,
            move[X0],
            move[Y0],
            z0,
            move[X1],
            move[Y1],
            z1,
            upper,
            joined,
            profile,
            arcs,
            pieces,
        )
    removed, uncut, level = 0.0, 0, profile[RADIUS] - profile[CORNER]
    if profile[PLAIN] != 0.0 and level > 0.0 and move[ARC_RADIUS] > STILL:
        # The rounded rim then finds little left to do under the level part.
        removed, uncut = _zmap_cut_helix(top, origin, pitch, floor, move, level, profile[OPEN])
        if profile[CORNER] == 0.0:
            return removed, uncut
    # Sagitta of a chord over the angle `step`: arm step^2 / 8 = chord.
    step = math.sqrt(8.0 * chord / max(move[ARC_RADIUS], chord))
    count = max(1, int(math.ceil(abs(move[SWEEP]) / step)))
    px, py, pz = move[X0], move[Y0], z0
    for k in range(1, count + 1):
        t = k / count
        angle = move[START_ANGLE] + t * move[SWEEP]
        qx, qy = (
            move[CX] + move[ARC_RADIUS] * math.cos(angle),
            move[CY] + move[ARC_RADIUS] * math.sin(angle),
        )
        qz = z0 + t * (z1 - z0)
        if (qx - px) ** 2 + (qy - py) ** 2 > STILL * STILL:
            r, s = _zmap_cut_slope(
                top,
                origin,
                pitch,
                floor,
                px,
                py,
                pz,
                qx,
                qy,
                qz,
                min(pz, qz) + profile[OPEN],
                k > 1,
                profile,
                arcs,
                pieces,
            )
            removed, uncut = removed + r, uncut + s
        px, py, pz = qx, qy, qz
    return removed, uncut


@njit(cache=True, nogil=True, inline="always")
def joins(moves: Floats, rapid: Bools, tool: Ints, n: int) -> bool:
    """Return whether a feed move continues where a feed move of the same tool has just ended: exactly
    the same tip."""
    return (
        n > 0
        and not rapid[n - 1]
        and not rapid[n]
        and tool[n] == tool[n - 1]
        and moves[n, X0] == moves[n - 1, X1]
        and moves[n, Y0] == moves[n - 1, Y1]
        and moves[n, Z_START] == moves[n - 1, Z_END]
    )


@njit(cache=True, nogil=True)
def _profile_depth(
    rho: float, h: float, arcs: Floats, first: int, last: int, z_low: float, z_high: float
) -> float:
    """Return the depth (mm) in one closed body of the material at a distance rho from the axis, from
    below up to the height h above the tip.

    The depth is concave over the height: golden section between the body's lower end and h. What is
    returned is attained, so it errs low by less than 1e-7 of the body's length.
    """
    low, high = z_low, max(min(h, z_high), z_low)
    for _ in range(40):
        a, b = low + 0.382 * (high - low), low + 0.618 * (high - low)
        if (
            depth_in_body(arcs, first, last, rho, a)[0]
            > depth_in_body(arcs, first, last, rho, b)[0]
        ):
            high = b
        else:
            low = a
    return min(depth_in_body(arcs, first, last, rho, 0.5 * (low + high))[0], h - z_low)


@njit(cache=True, nogil=True)
def _column_depth(square: float, h: float, profile: Floats, arcs: Floats, pieces: Floats) -> float:
    """Return how deep (mm) a column at a squared distance from the axis, its top h above the tip, lies
    in the cutter; negative outside.

    Of a plain cutter the signed distance to an endless cylinder with a rounded lower end; as the
    flutes' top is left out it errs deep. Other forms: the deepest of their bodies.
    """
    rho = math.sqrt(square)
    if profile[PLAIN] != 0.0:
        corner = profile[CORNER]
        qx, qy = rho - (profile[RADIUS] - corner), corner - h
        if qx > 0.0 and qy > 0.0:
            return corner - math.sqrt(qx * qx + qy * qy)
        return corner - max(qx, qy)
    best = -np.inf
    for k in range(int(profile[FIRST]), int(profile[LAST])):
        if rho < pieces[k, R_MAX] and h > pieces[k, Z_LOW]:
            best = max(
                best,
                _profile_depth(
                    rho,
                    h,
                    arcs,
                    int(pieces[k, CLOSED_FIRST]),
                    int(pieces[k, CLOSED_LAST]),
                    pieces[k, Z_LOW],
                    pieces[k, Z_HIGH],
                ),
            )
    return best


@njit(cache=True, nogil=True)
def _max_depth_line(
    top: Floats,
    origin: Floats,
    pitch: float,
    floor: float,
    x0: float,
    y0: float,
    x1: float,
    y1: float,
    z: float,
    profile: Floats,
    arcs: Floats,
    pieces: Floats,
) -> tuple[float, int]:
    """Return the greatest depth (mm) of a column in a cutter along a level line at z, and its flat
    cell index, -1 without one.

    A column at the floor is empty: a cutter below the blank's bottom is not in it.
    """
    radius = profile[RADIUS]
    i0 = first_cell(min(x0, x1) - radius, origin[0], pitch)
    i1 = last_cell(max(x0, x1) + radius, origin[0], pitch, top.shape[1])
    dx, dy = x1 - x0, y1 - y0
    square, limit, best, cell = dx * dx + dy * dy, radius * radius, -np.inf, -1
    for j in range(
        first_cell(min(y0, y1) - radius, origin[1], pitch),
        last_cell(max(y0, y1) + radius, origin[1], pitch, top.shape[0]) + 1,
    ):
        y = origin[1] + (j + 0.5) * pitch
        for i in range(i0, i1 + 1):
            # A column that ends below the tip is clear of the cutter.
            if top[j, i] <= z or top[j, i] <= floor:
                continue
            d = _segment_distance_squared(origin[0] + (i + 0.5) * pitch, y, x0, y0, dx, dy, square)
            if d < limit:
                depth = _column_depth(d, top[j, i] - z, profile, arcs, pieces)
                if depth > best:
                    best, cell = depth, j * top.shape[1] + i
    return best, cell


@njit(cache=True, nogil=True)
def _boundary_cells(
    top: Floats,
    origin: Floats,
    pitch: float,
    x0: float,
    y0: float,
    x1: float,
    y1: float,
    z: float,
    radius: float,
    rims: Ints,
    count: int,
) -> int:
    """Append to `rims` the cells whose area a level sweep may touch; return the new count.

    A cell is listed when it or a neighbour stands higher than z, as -1 - cell when none does: there
    only a fin between the columns could stand. The sweep is widened by half a cell's diagonal, so
    every cell with any point under the disc is listed. A full `rims` drops the rest: the caller
    takes it as overflow.
    """
    reach = radius + pitch * 0.7072
    i0, i1 = (
        first_cell(min(x0, x1) - reach, origin[0], pitch),
        last_cell(max(x0, x1) + reach, origin[0], pitch, top.shape[1]),
    )
    j0, j1 = (
        first_cell(min(y0, y1) - reach, origin[1], pitch),
        last_cell(max(y0, y1) + reach, origin[1], pitch, top.shape[0]),
    )
    dx, dy = x1 - x0, y1 - y0
    square = dx * dx + dy * dy
    for j in range(j0, j1 + 1):
        y = origin[1] + (j + 0.5) * pitch
        for i in range(i0, i1 + 1):
            d = _segment_distance_squared(origin[0] + (i + 0.5) * pitch, y, x0, y0, dx, dy, square)
            if d >= reach * reach:
                continue
            # The cell and its eight neighbours: does any column stand above the sweep?
            is_higher = False
            for b in range(max(j - 1, 0), min(j + 1, top.shape[0] - 1) + 1):
                for a in range(max(i - 1, 0), min(i + 1, top.shape[1] - 1) + 1):
                    is_higher = is_higher or top[b, a] > z
            if count < len(rims):
                cell = j * top.shape[1] + i
                rims[count] = cell if is_higher else -1 - cell
                count += 1
    return count


@njit(cache=True, nogil=True)
def _cone_depth(d: float, h: float, cone: Floats) -> float:
    """Return how deep (mm) a column, at a squared distance d, its top h above the tip, lies in a
    truncated cone row (5,): to its side along the radius, or to a free lower face.

    The radial distance to a leaning side is at least the true one: it errs deep.
    """
    r0, r1, z0, z1 = cone[0], cone[1], cone[2], cone[3]
    if h <= z0:
        return -np.inf
    side = max(r0, r0 + (r1 - r0) / (z1 - z0) * (min(h, z1) - z0)) - math.sqrt(d)
    return min(side, h - z0) if cone[4] != 0.0 else side


@njit(cache=True, nogil=True)
def _max_cone_depth(
    top: Floats,
    origin: Floats,
    pitch: float,
    floor: float,
    highest: float,
    move: Floats,
    line: Floats,
    z: float,
    cones: Floats,
    first: int,
    last: int,
) -> float:
    """Return the greatest depth (mm) of a column in truncated cones `first` to `last` along a level
    plan curve: the move's arc, or a line (4,) x, y to x, y.

    floor: a column at it is empty; highest: no column stands higher. A sloped arc is judged at its
    lowest z all along: it errs deep.
    """
    best = -np.inf
    dx, dy = line[2] - line[0], line[3] - line[1]
    square = dx * dx + dy * dy
    for k in range(first, last):
        if highest - z <= cones[k, 2]:
            continue
        radius = max(cones[k, 0], cones[k, 1])
        if move[KIND] != 0.0:
            x0, y0, x1, y1 = _swept_box(move, radius)
        else:
            x0, y0 = min(line[0], line[2]) - radius, min(line[1], line[3]) - radius
            x1, y1 = max(line[0], line[2]) + radius, max(line[1], line[3]) + radius
        i0, i1 = first_cell(x0, origin[0], pitch), last_cell(x1, origin[0], pitch, top.shape[1])
        # Only columns that reach above the cone's lower end can enter it.
        low = max(z + cones[k, 2], floor)
        for j in range(
            first_cell(y0, origin[1], pitch), last_cell(y1, origin[1], pitch, top.shape[0]) + 1
        ):
            y = origin[1] + (j + 0.5) * pitch
            for i in range(i0, i1 + 1):
                if top[j, i] > low:
                    x = origin[0] + (i + 0.5) * pitch
                    d = (
                        _arc_distance_squared(x, y, move)
                        if move[KIND] != 0.0
                        else _segment_distance_squared(x, y, line[0], line[1], dx, dy, square)
                    )
                    if d < radius * radius:
                        best = max(best, _cone_depth(d, top[j, i] - z, cones[k]))
    return best


@njit(cache=True, nogil=True)
def _collision_depth(
    top: Floats,
    origin: Floats,
    pitch: float,
    floor: float,
    highest: float,
    move: Floats,
    is_rapid: bool,
    profile: Floats,
    arcs: Floats,
    pieces: Floats,
    cones: Floats,
    first: int,
    last: int,
    allowed: float,
) -> tuple[float, int, float]:
    """Return how deep (mm) a move's cutter (rapids only) and what is above its flutes enter the field
    as it stands, and the cell of the former.

    Branch and bound over the path: a sloped line is judged at the lowest z of a part of it, which
    bounds the depth from above; the part is halved while that bound is above both `allowed` and the
    deepest so far and the part still drops by more than `allowed`. So depths err deep: by less than
    `allowed` on lines, by up to the whole drop on sloped arcs, which are not divided.
    """
    depth, cell, body = -np.inf, -1, -np.inf
    lowest = np.inf
    # Clear of everything: the field is below the lowest point of what is judged.
    for k in range(first, last):
        lowest = min(lowest, cones[k, 2])
    if highest <= min(move[Z_START], move[Z_END]) + (0.0 if is_rapid else lowest):
        return depth, cell, body
    line, spans = np.empty(4), np.empty((64, 2))
    spans[0, 0], spans[0, 1] = 0.0, 1.0
    dx, dy, dz = move[X1] - move[X0], move[Y1] - move[Y0], move[Z_END] - move[Z_START]
    still = dx == 0.0 and dy == 0.0
    n = 1
    while n > 0:
        n -= 1
        t0, t1 = spans[n, 0], spans[n, 1]
        line[0], line[1] = move[X0] + t0 * dx, move[Y0] + t0 * dy
        line[2], line[3] = move[X0] + t1 * dx, move[Y0] + t1 * dy
        z = move[Z_START] + min(t0 * dz, t1 * dz)
        if highest <= z:
            continue
        d, c, b = -np.inf, -1, -np.inf
        if is_rapid:
            d, c = _max_depth_line(
                top,
                origin,
                pitch,
                floor,
                line[0],
                line[1],
                line[2],
                line[3],
                z,
                profile,
                arcs,
                pieces,
            )
        b = _max_cone_depth(top, origin, pitch, floor, highest, move, line, z, cones, first, last)
        # Where the stack is full the part is not halved: its bound counts as it is.
        worth = d > max(depth, allowed) or b > max(body, allowed)
        if (
            worth
            and not still
            and move[KIND] == 0.0
            and (t1 - t0) * abs(dz) > allowed
            and n + 2 < len(spans)
        ):
            middle = 0.5 * (t0 + t1)
            spans[n, 0], spans[n, 1] = t0, middle
            spans[n + 1, 0], spans[n + 1, 1] = middle, t1
            n += 2
            continue
        if d > depth:
            depth, cell = d, c
        body = max(body, b)
    return depth, cell, body


@njit(cache=True, nogil=True)
def zmap_cut_loop(
    first: int,
    last: int,
    top: Floats,
    origin: Floats,
    pitch: float,
    floor: float,
    highest: float,
    moves: Floats,
    rapid: Bools,
    tool: Ints,
    profiles: Floats,
    arcs: Floats,
    pieces: Floats,
    cones: Floats,
    cone_start: Ints,
    chord: float,
    allowed: float,
    removed: Floats,
    depth: Floats,
    cell: Ints,
    body_depth: Floats,
    rims: Ints,
    rim_start: Ints,
    probe_start: Ints,
    circle: Floats,
    rings: Floats,
    counted: Ints,
    spans: Floats,
) -> tuple[int, int]:
    """Run upright moves `first` to `last` in order: cut the field with feed moves, judge rapids and
    what is above the flutes against it as it then stands.

    top (rows, columns) heights, changed; origin (2,) of the field's corner, `highest` its height at
    the start. moves (n, 15); tool (n,) rows of profiles (t, 6), see `verify/profile.py`; arcs,
    pieces of the bodies of all tools; cones (k, 5) above the flutes, cone_start (t + 1,). chord,
    allowed in mm.

    removed (n,) gets the summed height that a move takes off; depth (n,) and cell (n,) how deep a
    rapid enters and where; body_depth (n,) how deep what is above the flutes enters stock; rims
    gets the cells that a low rapid grazes as `_boundary_cells` lists them, rim_start (n + 1,) their
    beginnings. probe_start (n + 1,), circle, rings, counted and spans: see `kernels/stock/engagement.py`.

    Returns the row after the last one done and why it ended early: 1 when `rims` is full, 2 when
    that row's move has to leave columns standing that a field can't show: removed has what it took
    off, the rest is for the bundles with intervals.
    """
    for n in range(first, last):
        move, profile = moves[n], profiles[tool[n]]
        z = min(move[Z_START], move[Z_END])
        count = rim_start[n]
        # The engagement is measured before the move cuts, the body's depth after it.
        if not rapid[n]:
            engagement_in_zmap(
                top,
                origin,
                pitch,
                floor,
                move,
                rings[tool[n]],
                circle,
                probe_start[n],
                probe_start[n + 1],
                counted,
                spans,
            )
            took, uncut = zmap_cut_move(
                top,
                origin,
                pitch,
                floor,
                move,
                joins(moves, rapid, tool, n),
                profile,
                arcs,
                pieces,
                chord,
            )
            removed[n] += took
            if uncut > 0:
                return n, 2
        # A move straight up leaves through the column that its own cut has opened.
        straight = move[KIND] == 0.0 and move[X0] == move[X1] and move[Y0] == move[Y1]
        if not (straight and move[Z_END] > move[Z_START]):
            depth[n], cell[n], body_depth[n] = _collision_depth(
                top,
                origin,
                pitch,
                floor,
                highest,
                move,
                rapid[n],
                profile,
                arcs,
                pieces,
                cones,
                cone_start[tool[n]],
                cone_start[tool[n] + 1],
                allowed,
            )
            if rapid[n] and depth[n] <= allowed and z + allowed < highest:
                count = _boundary_cells(
                    top,
                    origin,
                    pitch,
                    move[X0],
                    move[Y0],
                    move[X1],
                    move[Y1],
                    z + allowed,
                    profile[RADIUS],
                    rims,
                    count,
                )
                if count >= len(rims):
                    return n, 1
        rim_start[n + 1] = count
    return last, 0
