"""The loops of `kernels.drop` compiled: closed forms, each edge and corner once, and only triangles that could be higher."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.kernels.drop import RHO0, RHO1, ROUND, A, B, C

(AX, AY, AZ, BX, BY, BZ, CX, CY, CZ, GX, GY, STEEP, TURN, LOW_X, LOW_Y, HIGH_X, HIGH_Y, HIGH_Z, OWNS) = range(19)
"""A triangle's row: corners; slope of its plane along x and y, how steep that is, twice its signed plan area; its box; and which edges
(bits 0 to 2, from the corner of that number on) and corners (bits 3 to 5) it looks after."""
FACET_COLUMNS = 19
LIFT_X, LIFT_Y, LIFT, OUT_X, OUT_Y, HEIGHT = range(6)
"""How a triangle's plane lifts a cutter over (x, y): LIFT_X x + LIFT_Y y + LIFT (infinite: it stands upright), touching it OUT away;
HEIGHT is its own over (0, 0)."""
LIFT_COLUMNS = 6
ALL = 63
"""The bits of all edges and corners."""
STEPS = 60
"""Most steps of a search that mostly ends after four."""
_TINY, _ROUNDING, _SLACK = 1e-300, 1e-13, 1e-10


@njit(cache=True, nogil=True, inline="always")
def _height(pieces: Floats, rho: float) -> float:
    k = 0
    while k < len(pieces) - 1 and rho > pieces[k, RHO1]:
        k += 1
    if pieces[k, ROUND] != 0.0:
        out = rho - pieces[k, A]
        return pieces[k, B] - math.sqrt(max(pieces[k, C] * pieces[k, C] - out * out, 0.0))
    return pieces[k, A] + pieces[k, B] * (rho - pieces[k, RHO0])


@njit(cache=True, nogil=True, inline="always")
def _slope(pieces: Floats, rho: float) -> float:
    k = 0
    while k < len(pieces) - 1 and rho > pieces[k, RHO1]:
        k += 1
    if pieces[k, ROUND] == 0.0:
        return pieces[k, B]
    out = rho - pieces[k, A]
    return out / math.sqrt(max(pieces[k, C] * pieces[k, C] - out * out, _TINY))


@njit(cache=True, nogil=True)
def _touching(pieces: Floats, steep: float) -> float:
    """Return the largest distance from the axis at which the lower side is not steeper than a plane."""
    if steep == 0.0:
        return 0.0
    rho = 0.0
    for k in range(len(pieces)):
        if pieces[k, ROUND] != 0.0:
            at = pieces[k, A] + pieces[k, C] * steep / math.sqrt(1.0 + steep * steep)
            if at < pieces[k, RHO1]:
                return max(at, rho)
        elif pieces[k, B] >= steep:
            return rho
        rho = pieces[k, RHO1]
    return rho


@njit(cache=True, nogil=True)
def _steepest(pieces: Floats, beside: float, rise: float, reach: float) -> float:
    """Return how far from the foot of the axis (0 to `reach`) an edge that climbs by `rise` >= 0 touches, at a distance beside the axis."""
    low = 0.0
    for k in range(len(pieces)):
        if pieces[k, RHO1] <= beside:
            continue
        high = min(math.sqrt(pieces[k, RHO1] * pieces[k, RHO1] - beside * beside), reach)
        rho = math.sqrt(beside * beside + high * high)
        if pieces[k, ROUND] != 0.0:
            out = rho - pieces[k, A]
            root = math.sqrt(max(pieces[k, C] * pieces[k, C] - out * out, 0.0))
            steeper = out * high >= rise * root * rho
        else:
            steeper = pieces[k, B] * high >= rise * rho
        if steeper:
            return _within(pieces[k], beside, rise, low, high)
        low = high
    return reach


@njit(cache=True, nogil=True)
def _within(piece: Floats, beside: float, rise: float, low: float, high: float) -> float:
    """Return where one piece is as steep along an edge as the edge climbs, between two distances from the foot."""
    if piece[ROUND] == 0.0:
        square = piece[B] * piece[B] - rise * rise
        return min(max(rise * beside / math.sqrt(square), low), high) if square > 0.0 else high
    a, c = piece[A], piece[C]
    if a == 0.0:
        return min(max(rise * math.sqrt(max((c * c - beside * beside) / (1.0 + rise * rise), 0.0)), low), high)
    u = 0.5 * (low + high)
    for _ in range(STEPS):
        rho = math.sqrt(beside * beside + u * u)
        out = rho - a
        root = math.sqrt(max(c * c - out * out, _TINY))
        k = out / root
        value = k * u / rho - rise
        if value > 0.0:
            high = u
        else:
            low = u
        bend = c * c / (root * root * root) * (u / rho) ** 2 + k * beside * beside / (rho * rho * rho)
        step = u - value / bend if bend > 0.0 else low
        nearer = step if low < step < high else 0.5 * (low + high)
        if abs(nearer - u) <= _ROUNDING * max(1.0, u):
            return nearer
        u = nearer
    return u


@njit(cache=True, nogil=True)
def _edge(px: float, py: float, ax: float, ay: float, az: float, bx: float, by: float, bz: float, pieces: Floats, radius: float,
          best: float) -> float:
    dx, dy = bx - ax, by - ay
    square = dx * dx + dy * dy
    if square == 0.0:
        return best
    cross = (ax - px) * dy - (ay - py) * dx
    if cross * cross > radius * radius * square or max(az, bz) - _height(pieces, min(abs(cross) / math.sqrt(square), radius)) <= best:
        return best
    length = math.sqrt(square)
    beside, foot = abs(cross) / length, -((ax - px) * dx + (ay - py) * dy) / length
    reach = math.sqrt(max(radius * radius - beside * beside, 0.0))
    rise = (bz - az) / length
    low, high = max(-foot, -reach), min(length - foot, reach)
    if low > high:
        return best
    # The tip's height along an edge is concave: its tangent in the middle bounds it, and most edges need no more.
    middle = 0.5 * (low + high)
    rho = math.sqrt(beside * beside + middle * middle)
    fall = _slope(pieces, rho) * middle / rho if rho > 0.0 else 0.0
    if az + rise * (foot + middle) - _height(pieces, min(rho, radius)) + abs(rise - fall) * 0.5 * (high - low) <= best:
        return best
    u = _steepest(pieces, beside, abs(rise), reach)
    if rise < 0.0:
        u = -u
    if u < -foot:
        u = -foot
    if u > length - foot:
        u = length - foot
    if abs(u) > reach:
        return best
    rho = min(math.sqrt(beside * beside + u * u), radius)
    return max(best, az + rise * (foot + u) - _height(pieces, rho))


@njit(cache=True, nogil=True)
def _corner(px: float, py: float, x: float, y: float, z: float, pieces: Floats, radius: float, best: float) -> float:
    square = (x - px) * (x - px) + (y - py) * (y - py)
    if z <= best or square > radius * radius:
        return best
    return max(best, z - _height(pieces, math.sqrt(square)))


@njit(cache=True, nogil=True)
def _plane(px: float, py: float, f: Floats, pieces: Floats, best: float) -> float:
    turn = f[TURN]
    if turn == 0.0:
        return best
    rho = _touching(pieces, f[STEEP])
    x, y = px, py
    if f[STEEP] > 0.0:
        x, y = px + rho * f[GX] / f[STEEP], py + rho * f[GY] / f[STEEP]
    z = f[AZ] + (x - f[AX]) * f[GX] + (y - f[AY]) * f[GY] - _height(pieces, rho)
    if z <= best:
        return best
    side = 1.0 if turn > 0.0 else -1.0
    if side * ((f[BX] - f[AX]) * (y - f[AY]) - (f[BY] - f[AY]) * (x - f[AX])) < 0.0:
        return best
    if side * ((f[CX] - f[BX]) * (y - f[BY]) - (f[CY] - f[BY]) * (x - f[BX])) < 0.0:
        return best
    if side * ((f[AX] - f[CX]) * (y - f[CY]) - (f[AY] - f[CY]) * (x - f[CX])) < 0.0:
        return best
    return z


@njit(cache=True, nogil=True)
def lift_loop(planes: Floats, pieces: Floats, lifts: Floats) -> None:
    """Fill lifts (n, 6), as `LIFT_X` to `HEIGHT` name it, with how planes (n, 3) lift a cutter: slopes and height over (0, 0)."""
    for n in range(len(planes)):
        gx, gy, height = planes[n, 0], planes[n, 1], planes[n, 2]
        steep = math.sqrt(gx * gx + gy * gy)
        lifts[n, LIFT_X], lifts[n, LIFT_Y], lifts[n, OUT_X], lifts[n, OUT_Y] = gx, gy, 0.0, 0.0
        rho = _touching(pieces, steep)
        if steep > 0.0:
            lifts[n, OUT_X], lifts[n, OUT_Y] = rho * gx / steep, rho * gy / steep
        lifts[n, HEIGHT] = height
        lifts[n, LIFT] = height + rho * steep - _height(pieces, rho)


@njit(cache=True, nogil=True, inline="always")
def _most(px: float, py: float, lift: Floats, x0: float, y0: float, x1: float, y1: float, pieces: Floats, radius: float,
          roundness: float) -> float:
    """Return a height that nothing below a plane and inside a box lifts the cutter over."""
    top = lift[LIFT_X] * px + lift[LIFT_Y] * py + lift[LIFT]
    if top < np.inf:
        if roundness > 0.0:
            # By the round of the cutter it is less away from where that touches the plane.
            x, y = px + lift[OUT_X], py + lift[OUT_Y]
            gx, gy = max(max(x0 - x, x - x1), 0.0), max(max(y0 - y, y - y1), 0.0)
            top -= 0.5 * roundness * (gx * gx + gy * gy)
        else:
            top = min(top, _below_tangent(px, py, lift, x0, y0, x1, y1, pieces, radius))
    return top


@njit(cache=True, nogil=True)
def _below_tangent(px: float, py: float, lift: Floats, x0: float, y0: float, x1: float, y1: float, pieces: Floats, radius: float) -> float:
    """Return `_most` by the tangent plane of the lower side over the middle of the box: it is nowhere below that."""
    x, y = 0.5 * (x0 + x1) - px, 0.5 * (y0 + y1) - py
    rho = math.sqrt(x * x + y * y)
    if rho >= radius:
        return np.inf
    fall = _slope(pieces, rho) / rho if rho > 0.0 else 0.0
    gx, gy = abs(lift[LIFT_X] - fall * x), abs(lift[LIFT_Y] - fall * y)
    middle = lift[HEIGHT] + lift[LIFT_X] * (px + x) + lift[LIFT_Y] * (py + y) - _height(pieces, rho)
    return middle + 0.5 * (gx * (x1 - x0) + gy * (y1 - y0))


@njit(cache=True, nogil=True)
def _touch(px: float, py: float, f: Floats, lift: Floats, owns: int, pieces: Floats, radius: float, roundness: float,
           best: float) -> float:
    """Return the larger of `best` and how high a facet, with the edges and corners that `owns` has bits of, lifts the cutter."""
    if _most(px, py, lift, f[LOW_X], f[LOW_Y], f[HIGH_X], f[HIGH_Y], pieces, radius, roundness) <= best - _SLACK:
        return best
    if f[TURN] != 0.0:
        # Where the plane touches inside the facet, that is the most of all of it; else it is less by how far that is from an edge.
        x, y = px + lift[OUT_X], py + lift[OUT_Y]
        side = 1.0 if f[TURN] > 0.0 else -1.0
        out = 0.0
        for k in range(3):
            a, b = 3 * k, 3 * ((k + 1) % 3)
            dx, dy = f[b] - f[a], f[b + 1] - f[a + 1]
            cross = side * (dx * (y - f[a + 1]) - dy * (x - f[a]))
            if cross < 0.0:
                out = max(out, cross * cross / (dx * dx + dy * dy))
        top = lift[LIFT_X] * px + lift[LIFT_Y] * py + lift[LIFT]
        if out == 0.0:
            return max(best, top)
        if top - 0.5 * roundness * out <= best - _SLACK:
            return best
    gx, gy = max(max(f[LOW_X] - px, px - f[HIGH_X]), 0.0), max(max(f[LOW_Y] - py, py - f[HIGH_Y]), 0.0)
    near = gx * gx + gy * gy
    if near > radius * radius or f[HIGH_Z] <= best or f[HIGH_Z] - _height(pieces, math.sqrt(near)) <= best:
        return best
    for k in range(3):
        a, b = 3 * k, 3 * ((k + 1) % 3)
        if owns & (1 << k):
            best = _edge(px, py, f[a], f[a + 1], f[a + 2], f[b], f[b + 1], f[b + 2], pieces, radius, best)
        if owns & (8 << k):
            best = _corner(px, py, f[a], f[a + 1], f[a + 2], pieces, radius, best)
    return best


@njit(cache=True, nogil=True)
def _edge_place(px: float, py: float, f: Floats, k: int, pieces: Floats, radius: float) -> float:
    """Return at which share of its k-th edge, 0 to 1, a facet lifts the cutter most."""
    a, b = 3 * k, 3 * ((k + 1) % 3)
    dx, dy = f[b] - f[a], f[b + 1] - f[a + 1]
    length = math.sqrt(dx * dx + dy * dy)
    if length == 0.0:
        return 0.0 if f[a + 2] > f[b + 2] else 1.0
    beside, foot = abs((f[a] - px) * dy - (f[a + 1] - py) * dx) / length, -((f[a] - px) * dx + (f[a + 1] - py) * dy) / length
    if beside > radius:
        return 0.0
    rise = (f[b + 2] - f[a + 2]) / length
    u = _steepest(pieces, beside, abs(rise), math.sqrt(max(radius * radius - beside * beside, 0.0)))
    if rise < 0.0:
        u = -u
    return min(max(foot + u, 0.0), length) / length


@njit(cache=True, nogil=True)
def _place(px: float, py: float, f: Floats, pieces: Floats, radius: float, at: Floats) -> None:
    """Fill at (3,) with where a facet lifts the cutter most."""
    best = -np.inf
    rho = _touching(pieces, f[STEEP])
    if _plane(px, py, f, pieces, best) > best:
        x, y = px, py
        if f[STEEP] > 0.0:
            x, y = px + rho * f[GX] / f[STEEP], py + rho * f[GY] / f[STEEP]
        at[0], at[1], at[2] = x, y, f[AZ] + (x - f[AX]) * f[GX] + (y - f[AY]) * f[GY]
        best = at[2] - _height(pieces, rho)
    for k in range(3):
        t = _edge_place(px, py, f, k, pieces, radius)
        a, b = 3 * k, 3 * ((k + 1) % 3)
        x, y, z = f[a] + t * (f[b] - f[a]), f[a + 1] + t * (f[b + 1] - f[a + 1]), f[a + 2] + t * (f[b + 2] - f[a + 2])
        away = math.sqrt((x - px) * (x - px) + (y - py) * (y - py))
        if away <= radius * (1.0 + _ROUNDING) and z - _height(pieces, min(away, radius)) > best:
            best = z - _height(pieces, min(away, radius))
            at[0], at[1], at[2] = x, y, z


@njit(cache=True, nogil=True)
def touch_loop(first: int, last: int, points: Floats, facets: Floats, low: Floats, pitch: float, shape: Ints, start: Ints, rows: Ints,
               summit: Floats, block: int, lifts: Floats, cell_lifts: Floats, block_lifts: Floats, pieces: Floats, roundness: float,
               lowest: float, out: Floats, facet: Ints, contact: Floats) -> None:
    """Fill out[first:last] with the tip's height over plan points (n, 2) when the cutter touches facets (t, 19) listed in a lattice.

    summit (cells,) is how high the facets of each cell reach; lifts (t, 6), cell_lifts (cells, 6) and block_lifts (6 a square of `block` by
    `block` cells) as `lift_loop` makes them, of planes that nothing of a facet, a cell's or a square's facets is above; roundness 1/mm: the
    least curvature of the lower side in any direction. facet (n,) gets the row of the one that is touched, -1 over none, contact (n, 3)
    where. What the cutter touched last mostly lies under it at the next point too: a height to begin with that leaves little to look at.
    """
    radius = pieces[len(pieces) - 1, RHO1]
    square = radius * radius
    side = block * pitch
    blocks = (shape[0] + block - 1) // block
    seen = np.full(len(facets), -1)
    touched = -1
    for n in range(first, last):
        px, py = points[n, 0], points[n, 1]
        best, own = lowest, -1
        moved = abs(px - points[n - 1, 0]) + abs(py - points[n - 1, 1]) if n > first else np.inf
        if touched >= 0:
            seen[touched] = n
            better = _touch(px, py, facets[touched], lifts[touched], ALL, pieces, radius, roundness, best)
            if better > best:
                best, own = better, touched
        i0, i1 = int(math.floor((px - radius - low[0]) / pitch)), int(math.floor((px + radius - low[0]) / pitch))
        j0, j1 = int(math.floor((py - radius - low[1]) / pitch)), int(math.floor((py + radius - low[1]) / pitch))
        i0, i1, j0, j1 = max(i0, 0), min(i1, shape[0] - 1), max(j0, 0), min(j1, shape[1] - 1)
        # Where the planes of the middle say that it touches comes first: most of the rest is then too low to matter.
        mi, mj = int(math.floor((px - low[0]) / pitch)), int(math.floor((py - low[1]) / pitch))
        if (own < 0 or moved > pitch) and i0 <= mi <= i1 and j0 <= mj <= j1:
            middle = cell_lifts[mj * shape[0] + mi]
            ti, tj = int(math.floor((px + middle[OUT_X] - low[0]) / pitch)), int(math.floor((py + middle[OUT_Y] - low[1]) / pitch))
            if i0 <= ti <= i1 and j0 <= tj <= j1:
                cell = tj * shape[0] + ti
                for c in range(start[cell], start[cell + 1]):
                    r = rows[c]
                    if seen[r] != n:
                        seen[r] = n
                        better = _touch(px, py, facets[r], lifts[r], int(facets[r, OWNS]), pieces, radius, roundness, best)
                        if better > best:
                            best, own = better, r
        for bj in range(j0 // block, j1 // block + 1):
            by = low[1] + bj * side
            for bi in range(i0 // block, i1 // block + 1):
                bx = low[0] + bi * side
                if _most(px, py, block_lifts[bj * blocks + bi], bx, by, bx + side, by + side, pieces, radius,
                         roundness) <= best - _SLACK:
                    continue
                for j in range(max(j0, bj * block), min(j1, bj * block + block - 1) + 1):
                    y = low[1] + j * pitch
                    gy = max(max(y - py, py - y - pitch), 0.0)
                    for i in range(max(i0, bi * block), min(i1, bi * block + block - 1) + 1):
                        cell = j * shape[0] + i
                        if summit[cell] <= best:
                            continue
                        x = low[0] + i * pitch
                        gx = max(max(x - px, px - x - pitch), 0.0)
                        near = gx * gx + gy * gy
                        # A facet that is nearer to the axis than this cell is listed in a nearer cell as well.
                        if near > square or summit[cell] - _height(pieces, math.sqrt(near)) <= best:
                            continue
                        if _most(px, py, cell_lifts[cell], x, y, x + pitch, y + pitch, pieces, radius, roundness) <= best - _SLACK:
                            continue
                        for c in range(start[cell], start[cell + 1]):
                            r = rows[c]
                            if seen[r] != n:
                                seen[r] = n
                                better = _touch(px, py, facets[r], lifts[r], int(facets[r, OWNS]), pieces, radius, roundness, best)
                                if better > best:
                                    best, own = better, r
        out[n], facet[n] = best, own
        contact[n, 0], contact[n, 1], contact[n, 2] = np.nan, np.nan, np.nan
        if own >= 0:
            _place(px, py, facets[own], pieces, radius, contact[n])
            touched = own
