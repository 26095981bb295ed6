"""Compiled loops of the stock engine: a field of z columns cut by swept cutters, exactly at every column.

Columns stand at cell centres. A level line or arc is cut in one pass over the rows that its sweep covers, the cells of a row by their
exact plan distance; a slope by the lowest height over the part of the line that a column sees. All that call each other live here.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Bools, Floats, Ints

# Columns of a move, as in `kernels/contact.py`; the engines share the layout of their input, not their loops.
KIND, X0, Y0, X1, Y1, CX, CY, RADIUS, MX, MY, COS_HALF, START_ANGLE, SWEEP, Z_START, Z_END = range(15)


@njit(cache=True, nogil=True, inline="always")
def _segment_square(qx: float, qy: float, x0: float, y0: float, dx: float, dy: float, square: float) -> float:
    t = 0.0
    if square > 0.0:
        t = min(max(((qx - x0) * dx + (qy - y0) * dy) / square, 0.0), 1.0)
    ex, ey = qx - x0 - t * dx, qy - y0 - t * dy
    return ex * ex + ey * ey


@njit(cache=True, nogil=True)
def _arc_square(qx: float, qy: float, move: Floats) -> float:
    vx, vy = qx - move[CX], qy - move[CY]
    length = math.sqrt(vx * vx + vy * vy)
    if vx * move[MX] + vy * move[MY] >= length * move[COS_HALF]:
        return (length - move[RADIUS]) ** 2
    ax, ay, bx, by = qx - move[X0], qy - move[Y0], qx - move[X1], qy - move[Y1]
    return min(ax * ax + ay * ay, bx * bx + by * by)


@njit(cache=True, nogil=True, inline="always")
def _height(square: float, inner: float, corner: float) -> float:
    """Return how high above the tip a cutter begins at a squared distance from its axis (inside its radius)."""
    if square <= inner * inner or corner == 0.0:
        return 0.0
    out = math.sqrt(square) - inner
    return corner - math.sqrt(max(corner * corner - out * out, 0.0))


@njit(cache=True, nogil=True)
def _lowest_on_slope(qx: float, qy: float, x0: float, y0: float, dx: float, dy: float, square: float, z0: float, dz: float,
                     radius: float, inner: float, corner: float) -> float:
    """Return the lowest height of a cutter over a column while it runs along a slope; infinite when it never covers it."""
    along = ((qx - x0) * dx + (qy - y0) * dy) / square
    ex, ey = qx - x0 - along * dx, qy - y0 - along * dy
    gap = radius * radius - ex * ex - ey * ey
    if gap < 0.0:
        return np.inf
    half = math.sqrt(gap / square)
    low, high = max(along - half, 0.0), min(along + half, 1.0)
    if low > high:
        return np.inf
    if corner == 0.0:
        return min(z0 + low * dz, z0 + high * dz)
    across = ex * ex + ey * ey
    for _ in range(40):
        a, b = low + 0.382 * (high - low), low + 0.618 * (high - low)
        za = z0 + a * dz + _height(across + (a - along) ** 2 * square, inner, corner)
        zb = z0 + b * dz + _height(across + (b - along) ** 2 * square, inner, corner)
        if za < zb:
            high = b
        else:
            low = a
    t = 0.5 * (low + high)
    return z0 + t * dz + _height(across + (t - along) ** 2 * square, inner, corner)


@njit(cache=True, nogil=True, inline="always")
def _depth(square: float, h: float, radius: float, corner: float) -> float:
    """Return how deep a point at a squared distance from the axis and a height above the tip is in the cutter."""
    qx, qy = math.sqrt(square) - (radius - corner), corner - h
    if qx > 0.0 and qy > 0.0:
        return corner - math.sqrt(qx * qx + qy * qy)
    return corner - max(qx, qy)


@njit(cache=True, nogil=True)
def _span(low: float, high: float, origin: float, pitch: float, count: int) -> tuple[int, int]:
    """Return the first and the last cell whose centre lies between two coordinates."""
    first = int(math.ceil((low - origin) / pitch - 0.5))
    last = int(math.floor((high - origin) / pitch - 0.5))
    return max(first, 0), min(last, count - 1)


@njit(cache=True, nogil=True)
def _box(move: Floats, radius: float) -> tuple[float, float, float, float]:
    x0, y0 = min(move[X0], move[X1]), min(move[Y0], move[Y1])
    x1, y1 = max(move[X0], move[X1]), max(move[Y0], move[Y1])
    if move[KIND] != 0.0:
        c = move[COS_HALF] - 1e-12
        if move[MX] >= c:
            x1 = max(x1, move[CX] + move[RADIUS])
        if -move[MX] >= c:
            x0 = min(x0, move[CX] - move[RADIUS])
        if move[MY] >= c:
            y1 = max(y1, move[CY] + move[RADIUS])
        if -move[MY] >= c:
            y0 = min(y0, move[CY] - move[RADIUS])
    return x0 - radius, y0 - radius, x1 + radius, y1 + radius


@njit(cache=True, nogil=True)
def _cut_level(top: Floats, origin: Floats, pitch: float, floor: float, move: Floats, z: float, radius: float, corner: float) -> float:
    """Cut a level (or standing) move whose lowest tip is z; return the removed height summed over columns."""
    x0, y0, x1, y1 = _box(move, radius)
    i0, i1 = _span(x0, x1, origin[0], pitch, top.shape[1])
    j0, j1 = _span(y0, y1, origin[1], pitch, top.shape[0])
    inner, limit, removed = radius - corner, radius * radius, 0.0
    dx, dy = move[X1] - move[X0], move[Y1] - move[Y0]
    square = dx * dx + dy * dy
    arc = move[KIND] != 0.0
    for j in range(j0, j1 + 1):
        y = origin[1] + (j + 0.5) * pitch
        a, b = i0, i1
        if not arc:
            # The capsule's width in this row: the part of the line within the radius in y, widened by the radius.
            t0, t1 = 0.0, 1.0
            if abs(dy) > 1e-12:
                p, q = (y - radius - move[Y0]) / dy, (y + radius - move[Y0]) / dy
                t0, t1 = max(min(p, q), 0.0), min(max(p, q), 1.0)
            xa, xb = move[X0] + t0 * dx, move[X0] + t1 * dx
            a, b = _span(min(xa, xb) - radius, max(xa, xb) + radius, origin[0], pitch, top.shape[1])
        for i in range(a, b + 1):
            h = top[j, i]
            if h <= z:
                continue
            x = origin[0] + (i + 0.5) * pitch
            d = _arc_square(x, y, move) if arc else _segment_square(x, y, move[X0], move[Y0], dx, dy, square)
            if d < limit:
                cut = max(z + _height(d, inner, corner), floor)
                if cut < h:
                    removed += h - cut
                    top[j, i] = cut
    return removed


@njit(cache=True, nogil=True)
def _cut_slope(top: Floats, origin: Floats, pitch: float, floor: float, x0: float, y0: float, z0: float, x1: float, y1: float, z1: float,
               radius: float, corner: float) -> float:
    dx, dy = x1 - x0, y1 - y0
    square = dx * dx + dy * dy
    i0, i1 = _span(min(x0, x1) - radius, max(x0, x1) + radius, origin[0], pitch, top.shape[1])
    j0, j1 = _span(min(y0, y1) - radius, max(y0, y1) + radius, origin[1], pitch, top.shape[0])
    lowest, removed = min(z0, z1), 0.0
    for j in range(j0, j1 + 1):
        y = origin[1] + (j + 0.5) * pitch
        for i in range(i0, i1 + 1):
            if top[j, i] <= lowest:
                continue
            x = origin[0] + (i + 0.5) * pitch
            cut = max(_lowest_on_slope(x, y, x0, y0, dx, dy, square, z0, z1 - z0, radius, radius - corner, corner), floor)
            if cut < top[j, i]:
                removed += top[j, i] - cut
                top[j, i] = cut
    return removed


@njit(cache=True, nogil=True)
def cut_move(top: Floats, origin: Floats, pitch: float, floor: float, move: Floats, radius: float, corner: float, chord: float) -> float:
    """Cut one move into the field; return the removed height summed over columns. A helix is cut as slopes within a chord error."""
    z0, z1 = move[Z_START], move[Z_END]
    still = move[KIND] == 0.0 and move[X0] == move[X1] and move[Y0] == move[Y1]
    if z0 == z1 or still:
        return _cut_level(top, origin, pitch, floor, move, min(z0, z1), radius, corner)
    if move[KIND] == 0.0:
        return _cut_slope(top, origin, pitch, floor, move[X0], move[Y0], z0, move[X1], move[Y1], z1, radius, corner)
    step = math.sqrt(8.0 * chord / max(move[RADIUS], chord))
    count = max(1, int(math.ceil(abs(move[SWEEP]) / step)))
    removed, px, py, pz = 0.0, move[X0], move[Y0], z0
    for k in range(1, count + 1):
        t = k / count
        angle = move[START_ANGLE] + t * move[SWEEP]
        qx, qy = move[CX] + move[RADIUS] * math.cos(angle), move[CY] + move[RADIUS] * math.sin(angle)
        qz = z0 + t * (z1 - z0)
        removed += _cut_slope(top, origin, pitch, floor, px, py, pz, qx, qy, qz, radius, corner)
        px, py, pz = qx, qy, qz
    return removed


@njit(cache=True, nogil=True)
def _deepest(top: Floats, origin: Floats, pitch: float, x0: float, y0: float, x1: float, y1: float, z: float, radius: float,
             corner: float) -> tuple[float, int]:
    """Return how deep the tops of columns are in a cutter along a level line, and the cell."""
    i0, i1 = _span(min(x0, x1) - radius, max(x0, x1) + radius, origin[0], pitch, top.shape[1])
    j0, j1 = _span(min(y0, y1) - radius, max(y0, y1) + radius, origin[1], pitch, top.shape[0])
    dx, dy = x1 - x0, y1 - y0
    square, limit, best, cell = dx * dx + dy * dy, radius * radius, -np.inf, -1
    for j in range(j0, j1 + 1):
        y = origin[1] + (j + 0.5) * pitch
        for i in range(i0, i1 + 1):
            if top[j, i] <= z:
                continue
            d = _segment_square(origin[0] + (i + 0.5) * pitch, y, x0, y0, dx, dy, square)
            if d < limit:
                depth = _depth(d, top[j, i] - z, radius, corner)
                if depth > best:
                    best, cell = depth, j * top.shape[1] + i
    return best, cell


@njit(cache=True, nogil=True)
def _rims(top: Floats, origin: Floats, pitch: float, x0: float, y0: float, x1: float, y1: float, z: float, radius: float, rims: Ints,
          count: int) -> int:
    """List the cells that a level sweep touches and on or beside which material stands above z."""
    reach = radius + pitch * 0.7072
    i0, i1 = _span(min(x0, x1) - reach, max(x0, x1) + reach, origin[0], pitch, top.shape[1])
    j0, j1 = _span(min(y0, y1) - reach, max(y0, y1) + reach, origin[1], pitch, top.shape[0])
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
            if stands and count < len(rims):
                rims[count] = j * top.shape[1] + i
                count += 1
    return count


@njit(cache=True, nogil=True)
def _body_depth(d: float, h: float, body: Floats) -> float:
    """Return how deep a column whose top is h above the tip is in a truncated cone, by its nearest free side."""
    r0, r1, z0, z1 = body[1], body[2], body[3], body[4]
    if h <= z0:
        return -np.inf
    rho = math.sqrt(d)
    slope = (r1 - r0) / (z1 - z0)
    at = min(h, z1)
    widest = max(r0, r0 + slope * (at - z0))
    side = widest - rho
    return min(side, h - z0) if body[5] != 0.0 else side


@njit(cache=True, nogil=True)
def _bodies(top: Floats, origin: Floats, pitch: float, highest: float, move: Floats, line: Floats, z: float, bodies: Floats, first: int,
            last: int) -> float:
    """Return how deep the truncated cones enter columns along a level plan curve: the move's arc, or a line (4,)."""
    best = -np.inf
    dx, dy = line[2] - line[0], line[3] - line[1]
    square = dx * dx + dy * dy
    for k in range(first, last):
        if highest - z <= bodies[k, 3]:
            continue
        radius = max(bodies[k, 1], bodies[k, 2])
        if move[KIND] != 0.0:
            x0, y0, x1, y1 = _box(move, radius)
        else:
            x0, y0 = min(line[0], line[2]) - radius, min(line[1], line[3]) - radius
            x1, y1 = max(line[0], line[2]) + radius, max(line[1], line[3]) + radius
        i0, i1 = _span(x0, x1, origin[0], pitch, top.shape[1])
        j0, j1 = _span(y0, y1, origin[1], pitch, top.shape[0])
        for j in range(j0, j1 + 1):
            y = origin[1] + (j + 0.5) * pitch
            for i in range(i0, i1 + 1):
                h = top[j, i] - z
                if h > bodies[k, 3]:
                    x = origin[0] + (i + 0.5) * pitch
                    d = _arc_square(x, y, move) if move[KIND] != 0.0 else _segment_square(x, y, line[0], line[1], dx, dy, square)
                    if d < radius * radius:
                        best = max(best, _body_depth(d, h, bodies[k]))
    return best


@njit(cache=True, nogil=True)
def _judge(top: Floats, origin: Floats, pitch: float, highest: float, move: Floats, is_rapid: bool, radius: float, corner: float,
           bodies: Floats, first: int, last: int, allowed: float) -> tuple[float, int, float]:
    """Return how deep a move's cutter (of rapids) and its body enter the field as it is, and the cell of the former.

    A slope is halved until its pieces are clear or lower by less than `allowed` from end to end.
    """
    depth, cell, body = -np.inf, -1, -np.inf
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
            d, c = _deepest(top, origin, pitch, line[0], line[1], line[2], line[3], z, radius, corner)
        b = _bodies(top, origin, pitch, highest, move, line, z, bodies, first, last)
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
               rapid: Bools, cutter: Floats, bodies: Floats, body_start: Ints, tool: Ints, chord: float, allowed: float, removed: Floats,
               depth: Floats, cell: Ints, body_depth: Floats, rims: Ints, rim_start: Ints) -> int:
    """Run moves `first` to `last`: judge rapids against the field as it is, and cut with the others.

    top (rows, columns) heights of columns, changed; origin (2,) of the field's corner, `highest` its height at the start. cutter (n, 3);
    bodies (k, 7) the truncated cones above the flutes of all tools, body_start (t + 1,), tool (n,).
    removed (n,) gets the summed height that a move takes off; depth (n,) and cell (n,) how deep a rapid goes and where; body_depth
    (n,) how deep what is above the flutes goes into stock; rims gets the cells that a low rapid grazes, rim_start (n + 1,) their
    beginnings.
    Returns the row after the last one done: early when `rims` is full.
    """
    for n in range(first, last):
        move = moves[n]
        radius, corner = cutter[n, 0], cutter[n, 1]
        z = min(move[Z_START], move[Z_END])
        count = rim_start[n]
        if not rapid[n]:
            removed[n] = cut_move(top, origin, pitch, floor, move, radius, corner, chord)
        # A move straight up leaves through the column that its own cut has opened.
        straight = move[KIND] == 0.0 and move[X0] == move[X1] and move[Y0] == move[Y1]
        if not (straight and move[Z_END] > move[Z_START]):
            depth[n], cell[n], body_depth[n] = _judge(top, origin, pitch, highest, move, rapid[n], radius, corner, bodies,
                                                      body_start[tool[n]], body_start[tool[n] + 1], allowed)
            if rapid[n] and depth[n] <= allowed and z + allowed < highest:
                count = _rims(top, origin, pitch, move[X0], move[Y0], move[X1], move[Y1], z + allowed, radius, rims, count)
                if count >= len(rims):
                    return n
        rim_start[n + 1] = count
    return last


