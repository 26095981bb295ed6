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
STEPS = 60
"""Most steps of a search that mostly ends after four."""
_TINY, _ROUNDING = 1e-300, 1e-13


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
def _touch(px: float, py: float, f: Floats, pieces: Floats, radius: float, best: float) -> float:
    gx, gy = max(f[LOW_X] - px, px - f[HIGH_X]), max(f[LOW_Y] - py, py - f[HIGH_Y])
    gx, gy = max(gx, 0.0), max(gy, 0.0)
    near = gx * gx + gy * gy
    if near > radius * radius or f[HIGH_Z] <= best or f[HIGH_Z] - _height(pieces, math.sqrt(near)) <= best:
        return best
    best = _plane(px, py, f, pieces, best)
    owns = int(f[OWNS])
    for k in range(3):
        a, b = 3 * k, 3 * ((k + 1) % 3)
        if owns & (1 << k):
            best = _edge(px, py, f[a], f[a + 1], f[a + 2], f[b], f[b + 1], f[b + 2], pieces, radius, best)
        if owns & (8 << k):
            best = _corner(px, py, f[a], f[a + 1], f[a + 2], pieces, radius, best)
    return best


@njit(cache=True, nogil=True)
def drop_loop(first: int, last: int, points: Floats, facets: Floats, low: Floats, pitch: float, shape: Ints, start: Ints, rows: Ints,
              summit: Floats, pieces: Floats, lowest: float, out: Floats) -> None:
    """Fill out[first:last] with the tip's height over plan points (n, 2) when the cutter touches facets (t, 19) listed in a lattice.

    summit (cells,) is how high the facets of each cell reach.
    """
    radius = pieces[len(pieces) - 1, RHO1]
    seen = np.full(len(facets), -1)
    for n in range(first, last):
        px, py = points[n, 0], points[n, 1]
        best = lowest
        i0, i1 = int(math.floor((px - radius - low[0]) / pitch)), int(math.floor((px + radius - low[0]) / pitch))
        j0, j1 = int(math.floor((py - radius - low[1]) / pitch)), int(math.floor((py + radius - low[1]) / pitch))
        i0, i1, j0, j1 = max(i0, 0), min(i1, shape[0] - 1), max(j0, 0), min(j1, shape[1] - 1)
        # The middle first: what stands there is mostly what is touched, and most of the rest is then too low to matter.
        mi, mj = int(math.floor((px - low[0]) / pitch)), int(math.floor((py - low[1]) / pitch))
        if i0 <= mi <= i1 and j0 <= mj <= j1:
            cell = mj * shape[0] + mi
            for c in range(start[cell], start[cell + 1]):
                seen[rows[c]] = n
                best = _touch(px, py, facets[rows[c]], pieces, radius, best)
        for j in range(j0, j1 + 1):
            gy = max(max(low[1] + j * pitch - py, py - low[1] - (j + 1) * pitch), 0.0)
            for i in range(i0, i1 + 1):
                cell = j * shape[0] + i
                if summit[cell] <= best:
                    continue
                gx = max(max(low[0] + i * pitch - px, px - low[0] - (i + 1) * pitch), 0.0)
                near = gx * gx + gy * gy
                # A facet that is nearer to the axis than this cell is listed in a nearer cell as well.
                if near > radius * radius or summit[cell] - _height(pieces, math.sqrt(near)) <= best:
                    continue
                for c in range(start[cell], start[cell + 1]):
                    if seen[rows[c]] != n:
                        seen[rows[c]] = n
                        best = _touch(px, py, facets[rows[c]], pieces, radius, best)
        out[n] = best
