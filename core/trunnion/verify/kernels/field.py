"""Compiled loops of the stock's height field: columns cut by swept upright cutters, exactly at every column.

Columns stand at cell centres; a column keeps the height of its top. A level line or arc is cut in one pass over the rows that its sweep
covers: within a row only the cells that the sweep reaches and that the move before has not cut already are looked at. A slope is cut by
the lowest height over the part of the line that a column sees. All that call each other live here, but for the bodies of revolution.

A field says all while nothing is left above a cut. Where a column stands higher than the height up to which the cutter gets no thinner
(`profile.open_height`), it is left as it is and the move says so: the bundles with intervals must go on from there.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.verify.kernels.body import CLOSED_FIRST, CLOSED_LAST, R_MAX, Z_HIGH, Z_LOW, depth_in_body, heights_at
from trunnion.verify.kernels.body import FIRST as PIECE_FIRST
from trunnion.verify.kernels.body import LAST as PIECE_LAST
from trunnion.verify.kernels.engagement import look_in_field

# Columns of a move, as in `kernels/strips.py`; the engines share the layout of their input, not their loops.
KIND, X0, Y0, X1, Y1, CX, CY, ARC_RADIUS, MX, MY, COS_HALF, START_ANGLE, SWEEP, Z_START, Z_END = range(15)
# Columns of a tool's profile, see `verify/profile.py`.
RADIUS, CORNER, OPEN, PLAIN, FIRST, LAST = range(6)
STILL = 1e-9
"""mm; a step shorter than this has no direction."""
SHRINK = 2e-3
"""mm; by how much what the move before has cut is taken smaller: where it was an arc, its posted ends are off it by up to this."""


@njit(cache=True, nogil=True, inline="always")
def _arc_square(qx: float, qy: float, move: Floats) -> float:
    vx, vy = qx - move[CX], qy - move[CY]
    length = math.sqrt(vx * vx + vy * vy)
    if vx * move[MX] + vy * move[MY] >= length * move[COS_HALF]:
        return (length - move[ARC_RADIUS]) ** 2
    ax, ay, bx, by = qx - move[X0], qy - move[Y0], qx - move[X1], qy - move[Y1]
    return min(ax * ax + ay * ay, bx * bx + by * by)


@njit(cache=True, nogil=True, inline="always")
def _segment_square(qx: float, qy: float, x0: float, y0: float, dx: float, dy: float, square: float) -> float:
    t = 0.0
    if square > 0.0:
        t = min(max(((qx - x0) * dx + (qy - y0) * dy) / square, 0.0), 1.0)
    ex, ey = qx - x0 - t * dx, qy - y0 - t * dy
    return ex * ex + ey * ey


@njit(cache=True, nogil=True)
def formed_height(square: float, profile: Floats, arcs: Floats, pieces: Floats) -> float:
    """Return how high above the tip a cutter of any form begins at a squared distance from its axis; infinite outside of it."""
    rho, best = math.sqrt(square), np.inf
    for k in range(int(profile[FIRST]), int(profile[LAST])):
        if rho < pieces[k, R_MAX]:
            low, high = heights_at(arcs, int(pieces[k, PIECE_FIRST]), int(pieces[k, PIECE_LAST]), pieces[k, Z_LOW], pieces[k, Z_HIGH], rho)
            if low <= high:
                best = min(best, low)
    return best


@njit(cache=True, nogil=True, inline="always")
def _round_height(square: float, inner: float, corner: float) -> float:
    """Return how high above the tip a plain cutter begins at a squared distance from its axis (inside its radius)."""
    if square <= inner * inner or corner == 0.0:
        return 0.0
    out = math.sqrt(square) - inner
    return corner - math.sqrt(max(corner * corner - out * out, 0.0))


@njit(cache=True, nogil=True, inline="always")
def first_cell(low: float, origin: float, pitch: float) -> int:
    """Return the first cell whose centre is not below a coordinate."""
    return max(int(math.ceil((low - origin) / pitch - 0.5)), 0)


@njit(cache=True, nogil=True, inline="always")
def last_cell(high: float, origin: float, pitch: float, count: int) -> int:
    """Return the last cell whose centre is not above a coordinate."""
    return min(int(math.floor((high - origin) / pitch - 0.5)), count - 1)


@njit(cache=True, nogil=True)
def _box(move: Floats, radius: float) -> tuple[float, float, float, float]:
    x0, y0 = min(move[X0], move[X1]), min(move[Y0], move[Y1])
    x1, y1 = max(move[X0], move[X1]), max(move[Y0], move[Y1])
    if move[KIND] != 0.0:
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


@njit(cache=True, nogil=True)
def _cut_row_plain(row: Floats, px: float, py: float, pitch: float, dx: float, dy: float, inverse: float, z: float, floor: float,
                   upper: float, radius: float, corner: float) -> tuple[float, int]:
    """Cut cells of a row that a plain cutter passes. px, py: the first cell's centre from the line's start; inverse: 1 / length squared."""
    removed, stands = 0.0, 0
    inner, limit, bottom = radius - corner, radius * radius, max(z, floor)
    flat = inner * inner
    for i in range(len(row)):
        h = row[i]
        if h > bottom:
            x = px + i * pitch
            t = min(max((x * dx + py * dy) * inverse, 0.0), 1.0)
            ex, ey = x - t * dx, py - t * dy
            d = ex * ex + ey * ey
            if d < limit:
                cut = bottom
                if d > flat:
                    out = math.sqrt(d) - inner
                    cut = max(z + (corner - math.sqrt(max(corner * corner - out * out, 0.0))), floor)
                if cut < h:
                    if h > upper:
                        stands += 1
                    else:
                        removed += h - cut
                        row[i] = cut
    return removed, stands


@njit(cache=True, nogil=True)
def _cut_row_formed(row: Floats, px: float, py: float, pitch: float, dx: float, dy: float, inverse: float, z: float, floor: float,
                    upper: float, profile: Floats, arcs: Floats, pieces: Floats) -> tuple[float, int]:
    """Cut cells of a row that a cutter of any form passes."""
    removed, stands = 0.0, 0
    limit, bottom = profile[RADIUS] * profile[RADIUS], max(z, floor)
    for i in range(len(row)):
        h = row[i]
        if h > bottom:
            x = px + i * pitch
            t = min(max((x * dx + py * dy) * inverse, 0.0), 1.0)
            ex, ey = x - t * dx, py - t * dy
            d = ex * ex + ey * ey
            if d < limit:
                cut = max(z + formed_height(d, profile, arcs, pieces), floor)
                if cut < h:
                    if h > upper:
                        stands += 1
                    else:
                        removed += h - cut
                        row[i] = cut
    return removed, stands


@njit(cache=True, nogil=True, fastmath={"reassoc", "nsz", "contract", "nnan"})
def _cut_row_ball(row: Floats, px: float, py: float, pitch: float, dx: float, dy: float, inverse: float, z: float, floor: float,
                  upper: float, radius: float) -> tuple[float, int]:
    """Cut cells of a row by a ball. Without branches: most cells before a ball get lower at every move, so computing all together wins."""
    removed, stands = 0.0, 0.0
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
        stands += 1.0 if inside & (h > upper) else 0.0
        removed += h - new
        row[i] = new
    return removed, int(stands)


@njit(cache=True, nogil=True, inline="always")
def _capsule_row(y: float, x0: float, y0: float, x1: float, y1: float, radius: float, sx: float, sy: float, inv_dy: float,
                 dx: float) -> tuple[float, float]:
    """Return where a row enters and leaves a disc swept along a line; (sx, sy) leads from the line to its left side."""
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
def _cut_level_line(top: Floats, origin: Floats, pitch: float, floor: float, x0: float, y0: float, x1: float, y1: float, z: float,
                    upper: float, joined: bool, profile: Floats, arcs: Floats, pieces: Floats) -> tuple[float, int]:
    """Cut a level (or standing) line; `joined`: the same cutter has just come to its start at this height.

    Then what is behind the start's perpendicular is done, and so is all that the level end of the cutter covers there.
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
    removed, stands = 0.0, 0
    columns, cell, left = top.shape[1], 1.0 / pitch, origin[0] + 0.5 * pitch
    x = left - x0
    for j in range(first_cell(min(y0, y1) - radius, origin[1], pitch), last_cell(max(y0, y1) + radius, origin[1], pitch, top.shape[0]) + 1):
        y = origin[1] + (j + 0.5) * pitch
        py = y - y0
        low, high = _capsule_row(y, x0, y0, x1, y1, radius, sx, sy, inv_dy, dx)
        if joined and moves:
            if dx > STILL:
                low = max(low, x0 - py * slant)
            elif dx < -STILL:
                high = min(high, x0 - py * slant)
            elif py * dy < 0.0:
                continue
        if low > high:
            continue
        a, b = max(int(math.floor((low - left) * cell)), 0), min(int(math.ceil((high - left) * cell)), columns - 1)
        # The cells from c to d are done.
        c, d = b + 1, b
        gap = level * level - py * py
        if gap > SHRINK:
            half = math.sqrt(gap) - SHRINK
            c, d = int(math.ceil((x0 - half - left) * cell)), int(math.floor((x0 + half - left) * cell))
            if c > d:
                c, d = b + 1, b
        for side in range(2):
            p, q = (a, min(b, c - 1)) if side == 0 else (max(a, d + 1), b)
            if p > q:
                continue
            row, px = top[j, p:q + 1], x + p * pitch
            if ball:
                r, s = _cut_row_ball(row, px, py, pitch, dx, dy, inverse, z, floor, upper, radius)
            elif plain:
                r, s = _cut_row_plain(row, px, py, pitch, dx, dy, inverse, z, floor, upper, radius, corner)
            else:
                r, s = _cut_row_formed(row, px, py, pitch, dx, dy, inverse, z, floor, upper, profile, arcs, pieces)
            removed, stands = removed + r, stands + s
    return removed, stands


@njit(cache=True, nogil=True)
def _cut_arc_cells(row: Floats, first: int, last: int, left: float, y: float, pitch: float, move: Floats, z: float, floor: float,
                   upper: float, profile: Floats, arcs: Floats, pieces: Floats) -> tuple[float, int]:
    removed, stands = 0.0, 0
    corner, inner, limit = profile[CORNER], profile[RADIUS] - profile[CORNER], profile[RADIUS] ** 2
    bottom = max(z, floor)
    for i in range(first, last + 1):
        h = row[i]
        if h > bottom:
            d = _arc_square(left + i * pitch, y, move)
            if d < limit:
                if profile[PLAIN] != 0.0:
                    cut = max(z + _round_height(d, inner, corner), floor)
                else:
                    cut = max(z + formed_height(d, profile, arcs, pieces), floor)
                if cut < h:
                    if h > upper:
                        stands += 1
                    else:
                        removed += h - cut
                        row[i] = cut
    return removed, stands


@njit(cache=True, nogil=True)
def _cut_level_arc(top: Floats, origin: Floats, pitch: float, floor: float, move: Floats, z: float, upper: float, profile: Floats,
                   arcs: Floats, pieces: Floats) -> tuple[float, int]:
    """Cut a level arc: within its box, the rows' cells between the circles that its rim draws."""
    radius = profile[RADIUS]
    x0, y0, x1, y1 = _box(move, radius)
    left = origin[0] + 0.5 * pitch
    outer, hollow = move[ARC_RADIUS] + radius, max(move[ARC_RADIUS] - radius, 0.0)
    i0, i1 = first_cell(x0, origin[0], pitch), last_cell(x1, origin[0], pitch, top.shape[1])
    removed, stands = 0.0, 0
    for j in range(first_cell(y0, origin[1], pitch), last_cell(y1, origin[1], pitch, top.shape[0]) + 1):
        y = origin[1] + (j + 0.5) * pitch
        py = y - move[CY]
        half = math.sqrt(max(outer * outer - py * py, 0.0))
        a = max(i0, int(math.floor((move[CX] - half - left) / pitch)))
        b = min(i1, int(math.ceil((move[CX] + half - left) / pitch)))
        gap = hollow * hollow - py * py
        if gap > SHRINK:
            half = math.sqrt(gap) - SHRINK
            c, d = int(math.ceil((move[CX] - half - left) / pitch)), int(math.floor((move[CX] + half - left) / pitch))
            if c <= d:
                r, s = _cut_arc_cells(top[j], a, min(b, c - 1), left, y, pitch, move, z, floor, upper, profile, arcs, pieces)
                removed, stands = removed + r, stands + s
                a = max(a, d + 1)
        r, s = _cut_arc_cells(top[j], a, b, left, y, pitch, move, z, floor, upper, profile, arcs, pieces)
        removed, stands = removed + r, stands + s
    return removed, stands


@njit(cache=True, nogil=True)
def _steepness(wanted: float, across: float, inner: float, corner: float) -> float:
    """Return the slope of a bull's rim, seen along its axial plane, where its slope along the way is `wanted`.

    A point `across` beside the way and `rho` from the axis, where the rim rises by p a mm, sees p sqrt(1 - across^2 / rho^2) along it.
    That grows with p: Newton's steps, halved where they leave the bracket.
    """
    out = min(max(across - inner, 0.0) / corner, 1.0)
    if out >= 1.0:
        return np.inf
    low = max(out / math.sqrt(1.0 - out * out), wanted)
    high = 2.0 * low + 1.0
    for _ in range(60):
        rho = inner + corner * high / math.sqrt(1.0 + high * high)
        if high * math.sqrt(max(1.0 - (across / rho) ** 2, 0.0)) >= wanted or high > 1e9:
            break
        low, high = high, 4.0 * high
    p = low + 0.1 * (high - low)
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
        slope = seen + (p * across * across * corner * q * q * q / (rho**3 * seen) if seen > 0.0 else 1.0)
        p -= excess / slope
        if not low < p < high:
            p = 0.5 * (low + high)
    return p


@njit(cache=True, nogil=True)
def _formed_on_slope(across: float, low: float, high: float, slope: float, profile: Floats, arcs: Floats, pieces: Floats) -> float:
    """Return the least of slope * w + height at the distance (across, w) over w from low to high, each convex body by itself."""
    best = np.inf
    for k in range(int(profile[FIRST]), int(profile[LAST])):
        gap = pieces[k, R_MAX] ** 2 - across * across
        if gap <= 0.0:
            continue
        half = math.sqrt(gap) * (1.0 - 1e-12)
        a, b = max(low, -half), min(high, half)
        if a > b:
            continue
        p, q = int(pieces[k, PIECE_FIRST]), int(pieces[k, PIECE_LAST])
        for _ in range(48):
            c, d = a + 0.382 * (b - a), a + 0.618 * (b - a)
            hc = heights_at(arcs, p, q, pieces[k, Z_LOW], pieces[k, Z_HIGH], math.sqrt(across * across + c * c))[0]
            hd = heights_at(arcs, p, q, pieces[k, Z_LOW], pieces[k, Z_HIGH], math.sqrt(across * across + d * d))[0]
            if slope * c + hc < slope * d + hd:
                b = d
            else:
                a = c
        w = 0.5 * (a + b)
        best = min(best, slope * w + heights_at(arcs, p, q, pieces[k, Z_LOW], pieces[k, Z_HIGH], math.sqrt(across * across + w * w))[0])
    return best


@njit(cache=True, nogil=True, inline="always")
def _rise(w: float, square: float, inner: float, corner: float) -> float:
    """Return how fast a bull's end rises along the way at w, a squared distance `square` beside it."""
    rho = math.sqrt(square + w * w)
    out = rho - inner
    if out <= 0.0:
        return 0.0
    if out >= corner:
        return np.inf if w > 0.0 else -np.inf
    return out / math.sqrt(corner * corner - out * out) * w / rho


@njit(cache=True, nogil=True)
def _lowest_on_slope(along: float, across: float, length: float, z0: float, slope: float, radius: float, corner: float) -> float:
    """Return the lowest height of a plain cutter over a column while it runs along a slope; infinite when it never covers it."""
    square = across * across
    gap = radius * radius - square
    if gap <= 0.0:
        return np.inf
    half = math.sqrt(gap)
    # w runs along the way, from the column's foot on it: there the cutter's axis is.
    low, high = max(-half, -along), min(half, length - along)
    if low > high:
        return np.inf
    base, inner = z0 + along * slope, radius - corner
    if corner == 0.0:
        return base + min(low * slope, high * slope)
    if inner <= 0.0:
        w = min(max(-slope * half / math.sqrt(1.0 + slope * slope), low), high)
    # The height over w is convex: where it rises at the low end already, that is the lowest; on short moves nearly everywhere.
    elif slope + _rise(low, square, inner, corner) >= 0.0:
        w = low
    elif slope + _rise(high, square, inner, corner) <= 0.0:
        w = high
    else:
        p = _steepness(abs(slope), abs(across), inner, corner)
        rho = inner + corner * p / math.sqrt(1.0 + p * p)
        w = math.sqrt(max(rho * rho - square, 0.0))
        w = min(max(-w if slope > 0.0 else w, low), high)
    return base + w * slope + _round_height(min(square + w * w, radius * radius), inner, corner)


@njit(cache=True, nogil=True)
def _cut_slope(top: Floats, origin: Floats, pitch: float, floor: float, x0: float, y0: float, z0: float, x1: float, y1: float, z1: float,
               upper: float, joined: bool, profile: Floats, arcs: Floats, pieces: Floats) -> tuple[float, int]:
    """Cut a slope. A column behind the start of a joined one that climbs is done: the cutter only goes up and away from it."""
    dx, dy, radius, corner = x1 - x0, y1 - y0, profile[RADIUS], profile[CORNER]
    length = math.sqrt(dx * dx + dy * dy)
    slope, plain = (z1 - z0) / length, profile[PLAIN] != 0.0
    ux, uy = dx / length, dy / length
    sx, sy = -radius * uy, radius * ux
    inv_dy = 1.0 / dy if abs(dy) > STILL else 0.0
    done_behind = joined and z1 >= z0
    lowest, removed, stands = max(min(z0, z1), floor), 0.0, 0
    left = origin[0] + 0.5 * pitch
    for j in range(first_cell(min(y0, y1) - radius, origin[1], pitch), last_cell(max(y0, y1) + radius, origin[1], pitch, top.shape[0]) + 1):
        y = origin[1] + (j + 0.5) * pitch
        low, high = _capsule_row(y, x0, y0, x1, y1, radius, sx, sy, inv_dy, dx)
        if low > high:
            continue
        py = y - y0
        first = max(int(math.floor((low - left) / pitch)), 0)
        row = top[j, first:min(int(math.ceil((high - left) / pitch)), top.shape[1] - 1) + 1]
        for i in range(len(row)):
            h = row[i]
            if h <= lowest:
                continue
            px = left + (first + i) * pitch - x0
            along, across = px * ux + py * uy, px * uy - py * ux
            if done_behind and along < 0.0:
                continue
            if plain:
                cut = max(_lowest_on_slope(along, across, length, z0, slope, radius, corner), floor)
            else:
                low, high = -along, length - along
                cut = max(z0 + along * slope + _formed_on_slope(abs(across), low, high, slope, profile, arcs, pieces), floor)
            if cut < h:
                if h > upper:
                    stands += 1
                else:
                    removed += h - cut
                    row[i] = cut
    return removed, stands


@njit(cache=True, nogil=True)
def _cut_helix(top: Floats, origin: Floats, pitch: float, floor: float, move: Floats, radius: float, opening: float) -> tuple[float, int]:
    """Cut a helix by a level end of a radius, exactly: a column keeps the height at which it was covered lowest.

    A column is covered while the tip is less than an angle away from its own about the centre; on the way down the last moment counts.
    """
    x0, y0, x1, y1 = _box(move, radius)
    arm, sweep, z0, z1 = move[ARC_RADIUS], abs(move[SWEEP]), move[Z_START], move[Z_END]
    turn = 1.0 if move[SWEEP] > 0.0 else -1.0
    lowest, removed, stands = max(min(z0, z1), floor), 0.0, 0
    i0, i1 = first_cell(x0, origin[0], pitch), last_cell(x1, origin[0], pitch, top.shape[1])
    for j in range(first_cell(y0, origin[1], pitch), last_cell(y1, origin[1], pitch, top.shape[0]) + 1):
        y = origin[1] + (j + 0.5) * pitch - move[CY]
        for i in range(i0, i1 + 1):
            h = top[j, i]
            if h <= lowest:
                continue
            x = origin[0] + (i + 0.5) * pitch - move[CX]
            rho = math.sqrt(x * x + y * y)
            if abs(rho - arm) >= radius:
                continue
            z = np.inf
            if rho + arm < radius:
                z = min(z0, z1)
            else:
                half = math.acos(min(max((rho * rho + arm * arm - radius * radius) / (2.0 * rho * arm), -1.0), 1.0))
                nearest = (turn * (math.atan2(y, x) - move[START_ANGLE])) % math.tau
                for round_ in range(-1, 2):
                    a = max(nearest + round_ * math.tau - half, 0.0)
                    b = min(nearest + round_ * math.tau + half, sweep)
                    if a < b:
                        z = min(z, z0 + (b if z1 < z0 else a) / sweep * (z1 - z0))
            cut = max(z, floor)
            if cut < h:
                if h > z + opening:
                    stands += 1
                else:
                    removed += h - cut
                    top[j, i] = cut
    return removed, stands


@njit(cache=True, nogil=True)
def cut_move(top: Floats, origin: Floats, pitch: float, floor: float, move: Floats, joined: bool, profile: Floats, arcs: Floats,
             pieces: Floats, chord: float) -> tuple[float, int]:
    """Cut one upright feed move into the field; return the removed height summed over columns, and how many columns were left standing.

    top (rows, columns) heights, changed; origin (2,) the field's corner; floor its lowest height; joined as `joins` says; a helix is cut as
    slopes within a chord error, by a level end exactly.
    """
    z0, z1 = move[Z_START], move[Z_END]
    lowest = min(z0, z1)
    upper = lowest + profile[OPEN]
    line = move[KIND] == 0.0
    if z0 == z1 and not line:
        return _cut_level_arc(top, origin, pitch, floor, move, lowest, upper, profile, arcs, pieces)
    dx, dy = move[X1] - move[X0], move[Y1] - move[Y0]
    still = line and dx * dx + dy * dy <= STILL * STILL
    if still or z0 == z1:
        # On its way down a cutter passes all of a column up to where it came from.
        return _cut_level_line(top, origin, pitch, floor, move[X0], move[Y0], move[X1], move[Y1], lowest, max(z0, z1) + profile[OPEN],
                               joined and not still, profile, arcs, pieces)
    if line:
        return _cut_slope(top, origin, pitch, floor, move[X0], move[Y0], z0, move[X1], move[Y1], z1, upper, joined, profile, arcs, pieces)
    removed, stands, level = 0.0, 0, profile[RADIUS] - profile[CORNER]
    if profile[PLAIN] != 0.0 and level > 0.0 and move[ARC_RADIUS] > STILL:
        # The rounded rim then finds little left to do under the level part.
        removed, stands = _cut_helix(top, origin, pitch, floor, move, level, profile[OPEN])
        if profile[CORNER] == 0.0:
            return removed, stands
    step = math.sqrt(8.0 * chord / max(move[ARC_RADIUS], chord))
    count = max(1, int(math.ceil(abs(move[SWEEP]) / step)))
    px, py, pz = move[X0], move[Y0], z0
    for k in range(1, count + 1):
        t = k / count
        angle = move[START_ANGLE] + t * move[SWEEP]
        qx, qy = move[CX] + move[ARC_RADIUS] * math.cos(angle), move[CY] + move[ARC_RADIUS] * math.sin(angle)
        qz = z0 + t * (z1 - z0)
        if (qx - px) ** 2 + (qy - py) ** 2 > STILL * STILL:
            r, s = _cut_slope(top, origin, pitch, floor, px, py, pz, qx, qy, qz, min(pz, qz) + profile[OPEN], k > 1, profile, arcs, pieces)
            removed, stands = removed + r, stands + s
        px, py, pz = qx, qy, qz
    return removed, stands


@njit(cache=True, nogil=True, inline="always")
def joins(moves: Floats, rapid: Bools, tool: Ints, n: int) -> bool:
    """Say whether a move goes on where a feed move of the same tool has just ended."""
    return (n > 0 and not rapid[n - 1] and not rapid[n] and tool[n] == tool[n - 1] and moves[n, X0] == moves[n - 1, X1]
            and moves[n, Y0] == moves[n - 1, Y1] and moves[n, Z_START] == moves[n - 1, Z_END])


@njit(cache=True, nogil=True)
def _formed_depth(rho: float, h: float, arcs: Floats, first: int, last: int, z_low: float, z_high: float) -> float:
    """Return how deep the material at a distance from the axis up to a height is in a body; the depth is concave over the height."""
    low, high = z_low, max(min(h, z_high), z_low)
    for _ in range(40):
        a, b = low + 0.382 * (high - low), low + 0.618 * (high - low)
        if depth_in_body(arcs, first, last, rho, a)[0] > depth_in_body(arcs, first, last, rho, b)[0]:
            high = b
        else:
            low = a
    return min(depth_in_body(arcs, first, last, rho, 0.5 * (low + high))[0], h - z_low)


@njit(cache=True, nogil=True)
def _depth(square: float, h: float, profile: Floats, arcs: Floats, pieces: Floats) -> float:
    """Return how deep a column at a squared distance from the axis, whose top is h above the tip, is in the cutter."""
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
            best = max(best, _formed_depth(rho, h, arcs, int(pieces[k, CLOSED_FIRST]), int(pieces[k, CLOSED_LAST]), pieces[k, Z_LOW],
                                           pieces[k, Z_HIGH]))
    return best


@njit(cache=True, nogil=True)
def _deepest(top: Floats, origin: Floats, pitch: float, x0: float, y0: float, x1: float, y1: float, z: float, profile: Floats,
             arcs: Floats, pieces: Floats) -> tuple[float, int]:
    """Return how deep columns are in a cutter along a level line, and the cell."""
    radius = profile[RADIUS]
    i0 = first_cell(min(x0, x1) - radius, origin[0], pitch)
    i1 = last_cell(max(x0, x1) + radius, origin[0], pitch, top.shape[1])
    dx, dy = x1 - x0, y1 - y0
    square, limit, best, cell = dx * dx + dy * dy, radius * radius, -np.inf, -1
    for j in range(first_cell(min(y0, y1) - radius, origin[1], pitch), last_cell(max(y0, y1) + radius, origin[1], pitch, top.shape[0]) + 1):
        y = origin[1] + (j + 0.5) * pitch
        for i in range(i0, i1 + 1):
            if top[j, i] <= z:
                continue
            d = _segment_square(origin[0] + (i + 0.5) * pitch, y, x0, y0, dx, dy, square)
            if d < limit:
                depth = _depth(d, top[j, i] - z, profile, arcs, pieces)
                if depth > best:
                    best, cell = depth, j * top.shape[1] + i
    return best, cell


@njit(cache=True, nogil=True)
def _rims(top: Floats, origin: Floats, pitch: float, x0: float, y0: float, x1: float, y1: float, z: float, radius: float, rims: Ints,
          count: int) -> int:
    """List the cells that a level sweep touches: those on or beside which material stands above z, and the others as -1 - cell."""
    reach = radius + pitch * 0.7072
    i0, i1 = first_cell(min(x0, x1) - reach, origin[0], pitch), last_cell(max(x0, x1) + reach, origin[0], pitch, top.shape[1])
    j0, j1 = first_cell(min(y0, y1) - reach, origin[1], pitch), last_cell(max(y0, y1) + reach, origin[1], pitch, top.shape[0])
    dx, dy = x1 - x0, y1 - y0
    square = dx * dx + dy * dy
    for j in range(j0, j1 + 1):
        y = origin[1] + (j + 0.5) * pitch
        for i in range(i0, i1 + 1):
            d = _segment_square(origin[0] + (i + 0.5) * pitch, y, x0, y0, dx, dy, square)
            if d >= reach * reach:
                continue
            stands = False
            for b in range(max(j - 1, 0), min(j + 1, top.shape[0] - 1) + 1):
                for a in range(max(i - 1, 0), min(i + 1, top.shape[1] - 1) + 1):
                    stands = stands or top[b, a] > z
            if count < len(rims):
                cell = j * top.shape[1] + i
                rims[count] = cell if stands else -1 - cell
                count += 1
    return count


@njit(cache=True, nogil=True)
def _cone_depth(d: float, h: float, cone: Floats) -> float:
    """Return how deep a column whose top is h above the tip is in a truncated cone, by its nearest free side."""
    r0, r1, z0, z1 = cone[0], cone[1], cone[2], cone[3]
    if h <= z0:
        return -np.inf
    side = max(r0, r0 + (r1 - r0) / (z1 - z0) * (min(h, z1) - z0)) - math.sqrt(d)
    return min(side, h - z0) if cone[4] != 0.0 else side


@njit(cache=True, nogil=True)
def _cones(top: Floats, origin: Floats, pitch: float, highest: float, move: Floats, line: Floats, z: float, cones: Floats, first: int,
           last: int) -> float:
    """Return how deep the truncated cones enter columns along a level plan curve: the move's arc, or a line (4,)."""
    best = -np.inf
    dx, dy = line[2] - line[0], line[3] - line[1]
    square = dx * dx + dy * dy
    for k in range(first, last):
        if highest - z <= cones[k, 2]:
            continue
        radius = max(cones[k, 0], cones[k, 1])
        if move[KIND] != 0.0:
            x0, y0, x1, y1 = _box(move, radius)
        else:
            x0, y0 = min(line[0], line[2]) - radius, min(line[1], line[3]) - radius
            x1, y1 = max(line[0], line[2]) + radius, max(line[1], line[3]) + radius
        i0, i1 = first_cell(x0, origin[0], pitch), last_cell(x1, origin[0], pitch, top.shape[1])
        low = z + cones[k, 2]
        for j in range(first_cell(y0, origin[1], pitch), last_cell(y1, origin[1], pitch, top.shape[0]) + 1):
            y = origin[1] + (j + 0.5) * pitch
            for i in range(i0, i1 + 1):
                if top[j, i] > low:
                    x = origin[0] + (i + 0.5) * pitch
                    d = _arc_square(x, y, move) if move[KIND] != 0.0 else _segment_square(x, y, line[0], line[1], dx, dy, square)
                    if d < radius * radius:
                        best = max(best, _cone_depth(d, top[j, i] - z, cones[k]))
    return best


@njit(cache=True, nogil=True)
def _judge(top: Floats, origin: Floats, pitch: float, highest: float, move: Floats, is_rapid: bool, profile: Floats, arcs: Floats,
           pieces: Floats, cones: Floats, first: int, last: int, allowed: float) -> tuple[float, int, float]:
    """Return how deep a move's cutter (of rapids) and what is above its flutes enter the field as it is, and the cell of the former.

    A slope is halved until its pieces are clear or lower by less than `allowed` from end to end.
    """
    depth, cell, body = -np.inf, -1, -np.inf
    lowest = np.inf
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
            d, c = _deepest(top, origin, pitch, line[0], line[1], line[2], line[3], z, profile, arcs, pieces)
        b = _cones(top, origin, pitch, highest, move, line, z, cones, first, last)
        worth = d > max(depth, allowed) or b > max(body, allowed)
        if worth and not still and move[KIND] == 0.0 and (t1 - t0) * abs(dz) > allowed and n + 2 < len(spans):
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
def stock_loop(first: int, last: int, top: Floats, origin: Floats, pitch: float, floor: float, highest: float, moves: Floats,
               rapid: Bools, tool: Ints, profiles: Floats, arcs: Floats, pieces: Floats, cones: Floats, cone_start: Ints, chord: float,
               allowed: float, removed: Floats, depth: Floats, cell: Ints, body_depth: Floats, rims: Ints, rim_start: Ints,
               probe_start: Ints, circle: Floats, rings: Floats, counted: Ints, spans: Floats) -> tuple[int, int]:
    """Run upright moves `first` to `last`: judge rapids against the field as it is, and cut with the others.

    top (rows, columns) heights of columns, changed; origin (2,) of the field's corner, `highest` its height at the start. tool (n,) rows of
    profiles (t, 6), see `verify/profile.py`; arcs, pieces of the bodies of all tools; cones (k, 5) above the flutes, cone_start (t + 1,).
    removed (n,) gets the summed height that a move takes off; depth (n,) and cell (n,) how deep a rapid goes and where; body_depth
    (n,) how deep what is above the flutes goes into stock; rims gets the cells that a low rapid grazes as `_rims` lists them,
    rim_start (n + 1,) their beginnings. probe_start (n + 1,), circle, rings, counted and spans: see `kernels/engagement.py`.
    Returns the row after the last one done and why it ended early: 1 when `rims` is full, 2 when that row's move has to leave columns
    standing that a field can't show: removed has what it took off, the rest is for the bundles with intervals.
    """
    for n in range(first, last):
        move, profile = moves[n], profiles[tool[n]]
        z = min(move[Z_START], move[Z_END])
        count = rim_start[n]
        if not rapid[n]:
            look_in_field(top, origin, pitch, floor, move, rings[tool[n]], circle, probe_start[n], probe_start[n + 1], counted, spans)
            took, standing = cut_move(top, origin, pitch, floor, move, joins(moves, rapid, tool, n), profile, arcs, pieces, chord)
            removed[n] += took
            if standing > 0:
                return n, 2
        # A move straight up leaves through the column that its own cut has opened.
        straight = move[KIND] == 0.0 and move[X0] == move[X1] and move[Y0] == move[Y1]
        if not (straight and move[Z_END] > move[Z_START]):
            depth[n], cell[n], body_depth[n] = _judge(top, origin, pitch, highest, move, rapid[n], profile, arcs, pieces, cones,
                                                      cone_start[tool[n]], cone_start[tool[n] + 1], allowed)
            if rapid[n] and depth[n] <= allowed and z + allowed < highest:
                count = _rims(top, origin, pitch, move[X0], move[Y0], move[X1], move[Y1], z + allowed, profile[RADIUS], rims, count)
                if count >= len(rims):
                    return n, 1
        rim_start[n + 1] = count
    return last, 0
