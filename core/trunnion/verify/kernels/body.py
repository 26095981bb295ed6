"""Compiled answers about one convex body of revolution: depth of a point, support, radius at a height, heights at a distance.

A body is a run of arcs in (rho, h): an arc about (CR, CZ) of radius R >= 0 covers the outward normals from (A0R, A0Z) to (A1R, A1Z),
anticlockwise from straight down over straight out to straight up, and lies on one side of straight out: it looks down or up. Where two
cones of neighbours meet there is a straight flank. What no arc covers (an open end) does not bound the body.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Floats

CR, CZ, R, A0R, A0Z, A1R, A1Z = range(7)
ARC_COLUMNS = 7
FIRST, LAST, Z_LOW, Z_HIGH, R_MAX, KIND, CLOSED_FIRST, CLOSED_LAST = range(8)
PIECE_COLUMNS = 8


@njit(cache=True, nogil=True)
def depth_in_body(arcs: Floats, first: int, last: int, rho: float, h: float) -> tuple[float, float, float]:
    """Return how deep a point is in a body, and the normal (n_rho, n_h) of the side that is nearest; negative outside.

    The depth is concave with the slope (-n_rho, -n_h), so tangents bound it from above.
    """
    best, nr, nz = np.inf, 1.0, 0.0
    for k in range(first, last):
        dr, dz = rho - arcs[k, CR], h - arcs[k, CZ]
        c0 = arcs[k, A0R] * dz - arcs[k, A0Z] * dr
        c1 = dr * arcs[k, A1Z] - dz * arcs[k, A1R]
        if c0 >= 0.0 and c1 >= 0.0 and (dr * (arcs[k, A0R] + arcs[k, A1R]) + dz * (arcs[k, A0Z] + arcs[k, A1Z])) > 0.0:
            far = math.sqrt(dr * dr + dz * dz)
            depth, a, b = arcs[k, R] - far, dr / far, dz / far
        else:
            d0, d1 = dr * arcs[k, A0R] + dz * arcs[k, A0Z], dr * arcs[k, A1R] + dz * arcs[k, A1Z]
            if d0 >= d1:
                depth, a, b = arcs[k, R] - d0, arcs[k, A0R], arcs[k, A0Z]
            else:
                depth, a, b = arcs[k, R] - d1, arcs[k, A1R], arcs[k, A1Z]
        if depth < best:
            best, nr, nz = depth, a, b
    return best, nr, nz


@njit(cache=True, nogil=True)
def swept_depth(arcs: Floats, piece: Floats, rho: float, h: float, rise: float) -> tuple[float, float, float]:
    """Return how deep a point is in a piece's open run that is swept upwards by `rise` along its axis, and the slopes (by rho, by h).

    What looks down is met at the lowest place of the sweep where the piece passes the point at all, what looks up at the highest. The
    depth is concave with these slopes and never grows with rho; rho below zero is taken as zero.
    """
    first, last = int(piece[FIRST]), int(piece[LAST])
    low, high = min(h, piece[Z_HIGH]), max(h - rise, piece[Z_LOW])
    r = max(rho, 0.0)
    best, nr, nz = np.inf, 1.0, 0.0
    for k in range(first, last):
        up = arcs[k, A0Z] + arcs[k, A1Z] > 0.0
        dr, dz = r - arcs[k, CR], (high if up else low) - arcs[k, CZ]
        d0, d1 = dr * arcs[k, A0R] + dz * arcs[k, A0Z], dr * arcs[k, A1R] + dz * arcs[k, A1Z]
        if dr * arcs[k, A1Z] >= dz * arcs[k, A1R] and dz * arcs[k, A0R] >= dr * arcs[k, A0Z] and d0 + d1 > 0.0:
            far = math.sqrt(dr * dr + dz * dz)
            depth, a, b = arcs[k, R] - far, dr / far, dz / far
        elif d0 >= d1:
            depth, a, b = arcs[k, R] - d0, arcs[k, A0R], arcs[k, A0Z]
        else:
            depth, a, b = arcs[k, R] - d1, arcs[k, A1R], arcs[k, A1Z]
        if depth < best:
            best, nr, nz = depth, a, b
    # A sweep goes on past a piece's own end without growing: there the height no longer counts.
    still = rise > 0.0 and (h > piece[Z_HIGH] if nz < 0.0 else h - rise < piece[Z_LOW])
    return best, (-nr if rho > 0.0 else 0.0), (0.0 if still else -nz)


@njit(cache=True, nogil=True)
def support(arcs: Floats, first: int, last: int, nr: float, nz: float) -> float:
    """Return how far a closed body reaches in a direction (nr >= 0 across the axis, nz along it), from its tip."""
    most = -np.inf
    for k in range(first, last):
        # Inside its cone an arc reaches furthest; elsewhere its nearer end stands for it.
        if arcs[k, A0R] * nz - arcs[k, A0Z] * nr >= 0.0 and nr * arcs[k, A1Z] - nz * arcs[k, A1R] >= 0.0:
            return arcs[k, CR] * nr + arcs[k, CZ] * nz + arcs[k, R]
        d0, d1 = arcs[k, A0R] * nr + arcs[k, A0Z] * nz, arcs[k, A1R] * nr + arcs[k, A1Z] * nz
        most = max(most, arcs[k, CR] * nr + arcs[k, CZ] * nz + arcs[k, R] * max(d0, d1))
    return most


@njit(cache=True, nogil=True)
def radius_at(arcs: Floats, first: int, last: int, h: float) -> float:
    """Return the body's radius at a height within its ends; negative where it has none."""
    least = np.inf
    for k in range(first, last):
        dz = h - arcs[k, CZ]
        r = arcs[k, R]
        # The height's place on the arc, if it has one; else the tangent at the nearer end of the cone.
        if r > 0.0 and arcs[k, A0Z] * r <= dz <= arcs[k, A1Z] * r:
            least = min(least, arcs[k, CR] + math.sqrt(max(r * r - dz * dz, 0.0)))
            continue
        for end in range(2):
            nr, nz = (arcs[k, A0R], arcs[k, A0Z]) if end == 0 else (arcs[k, A1R], arcs[k, A1Z])
            if nr > 1e-9:
                least = min(least, arcs[k, CR] + (r - dz * nz) / nr)
            elif dz * nz > r + 1e-12:
                return -1.0
    return least


@njit(cache=True, nogil=True)
def heights_at(arcs: Floats, first: int, last: int, z_low: float, z_high: float, rho: float) -> tuple[float, float]:
    """Return between which heights a body holds points at a distance from the axis; the first is larger where it holds none."""
    low, high = z_low, z_high
    for k in range(first, last):
        dr, r = rho - arcs[k, CR], arcs[k, R]
        if dr > r and arcs[k, A0Z] <= 0.0 <= arcs[k, A1Z]:
            return 1.0, 0.0
        in_cone_low = r > 0.0 and arcs[k, A0Z] < 0.0 and arcs[k, A0R] * r <= dr <= (arcs[k, A1R] * r if arcs[k, A1Z] < 0.0 else r)
        in_cone_high = r > 0.0 and arcs[k, A1Z] > 0.0 and arcs[k, A1R] * r <= dr <= (arcs[k, A0R] * r if arcs[k, A0Z] > 0.0 else r)
        if in_cone_low:
            low = max(low, arcs[k, CZ] - math.sqrt(max(r * r - dr * dr, 0.0)))
        if in_cone_high:
            high = min(high, arcs[k, CZ] + math.sqrt(max(r * r - dr * dr, 0.0)))
        for end in range(2):
            nr, nz = (arcs[k, A0R], arcs[k, A0Z]) if end == 0 else (arcs[k, A1R], arcs[k, A1Z])
            if nz < -1e-9:
                if not in_cone_low:
                    low = max(low, arcs[k, CZ] + (r - dr * nr) / nz)
            elif nz > 1e-9:
                if not in_cone_high:
                    high = min(high, arcs[k, CZ] + (r - dr * nr) / nz)
            elif dr * nr > r:
                return 1.0, 0.0
    return low, high
