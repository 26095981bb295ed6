"""Compiled queries on one convex body of revolution, given by its support function: signed depth,
support, radius, axial extent.

The meridian of a body lies in the half-plane (rho, h): rho >= 0 mm from the axis, h mm along the
axis from the tool tip. It is the intersection of half-planes, one for each outward normal n =
(n_rho, n_h) with n_rho >= 0, and it is stored as a chain of arcs, rows (a, 7): an arc about (CR,
CZ) with radius R >= 0 (0 at a sharp corner) owns the cone of unit normals from (A0R, A0Z) to (A1R,
A1Z), anticlockwise from straight down (0, -1) over straight out (1, 0) to straight up (0, 1). Each
arc lies on one side of straight out, so it looks down or up and its cone spans at most a right
angle. The support function of the arc is s(n) = CR n_rho + CZ n_h + R over its cone. A straight
flank needs no row of its own: it is the normal at which two cones meet. Normals that no arc covers
(the open end of a piece) do not bound the body.

For a convex set the signed depth of a point p, positive inside, is

    depth(p) = min over n of s(n) - n . p

which is exact inside and outside where the normals are complete (a closed body), a concave function
of p with slope 1 at most, and never increases with rho because n_rho >= 0 (Rockafellar, Convex
Analysis, 1970, sections 13 and 23). All bounds of the proof rest on these three properties.

Rows of pieces (p, 8): FIRST, LAST the arcs of the open run; Z_LOW, Z_HIGH its ends in h; R_MAX its
largest radius; KIND 0 cuts, 1 does not; CLOSED_FIRST, CLOSED_LAST the arcs of the closed body.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Floats
from trunnion.geometry.kernels.kernel_arrays import BORROWED

CR, CZ, R, A0R, A0Z, A1R, A1Z = range(7)
ARC_COLUMNS = 7
FIRST, LAST, Z_LOW, Z_HIGH, R_MAX, KIND, CLOSED_FIRST, CLOSED_LAST = range(8)


@njit(**BORROWED)
def depth_in_body(
    arcs: Floats, first: int, last: int, rho: float, h: float
) -> tuple[float, float, float]:
    """Return the signed depth (mm) of a point (rho, h) in the body of arcs `first` to `last`, negative
    outside, and the nearest side's outward normal (n_rho, n_h).

    The depth is concave with supergradient (-n_rho, -n_h), so its tangent at any point bounds it
    from above everywhere. Exact for closed bodies; for an open run it is the depth in the
    half-planes that there are, so outside its two ends it is too deep, never too shallow.
    """
    best, nr, nz = np.inf, 1.0, 0.0
    # For the normals of one cone the least of R - n . (p - C) is R - |p - C| where p - C itself
    # lies in the cone, else it is at the cone's end that is nearer in angle.
    for k in range(first, last):
        dr, dz = rho - arcs[k, CR], h - arcs[k, CZ]
        c0 = arcs[k, A0R] * dz - arcs[k, A0Z] * dr
        c1 = dr * arcs[k, A1Z] - dz * arcs[k, A1R]
        # The third test separates the cone from its mirror image through C; it also keeps `far`
        # above 0.
        if (
            c0 >= 0.0
            and c1 >= 0.0
            and (dr * (arcs[k, A0R] + arcs[k, A1R]) + dz * (arcs[k, A0Z] + arcs[k, A1Z])) > 0.0
        ):
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


@njit(**BORROWED)
def swept_depth(
    arcs: Floats, piece: Floats, rho: float, h: float, rise: float
) -> tuple[float, float, float]:
    """Return the signed depth (mm) of a point in a piece's open run swept by `rise` (mm) along its own
    axis, and the depth's slopes by rho and by h.

    h is measured from the tip in its lowest position. The sweep is the Minkowski sum of a convex
    body and a segment, so its support function is s(n) + rise max(n_h, 0): half-planes that look
    down are met with the piece at the bottom of the sweep (local height h), those that look up at
    its top (local height h - rise). The local height is kept within Z_LOW to Z_HIGH, as the open
    run has no end faces.

    The depth is concave with these slopes and never increases with rho. A negative rho is taken as
    0: callers subtract a safety sag from a distance and may pass below the axis; constant below 0
    and non-increasing above it is still concave.
    """
    first, last = int(piece[FIRST]), int(piece[LAST])
    low, high = min(h, piece[Z_HIGH]), max(h - rise, piece[Z_LOW])
    r = max(rho, 0.0)
    # The greatest depth over the sweep for normals that look down, then for those that look up.
    best, nr, nz = np.inf, 1.0, 0.0
    for k in range(first, last):
        up = arcs[k, A0Z] + arcs[k, A1Z] > 0.0
        # n_h of one sign over the whole cone, so one of the two heights serves all of its normals.
        dr, dz = r - arcs[k, CR], (high if up else low) - arcs[k, CZ]
        d0, d1 = dr * arcs[k, A0R] + dz * arcs[k, A0Z], dr * arcs[k, A1R] + dz * arcs[k, A1Z]
        if (
            dr * arcs[k, A1Z] >= dz * arcs[k, A1R]
            and dz * arcs[k, A0R] >= dr * arcs[k, A0Z]
            and d0 + d1 > 0.0
        ):
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


@njit(**BORROWED)
def support(arcs: Floats, first: int, last: int, nr: float, nz: float) -> float:
    """Return the support s(n) (mm) of a closed body: how far it extends from the tip in the direction
    n = (nr across the axis, nz along it), nr >= 0, unit.

    Exact: every n lies in the cone of some arc. The fallback, for an n that rounding puts between
    two cones, is the furthest end of all arcs, which is s(n) again to the rounding.
    """
    most = -np.inf
    for k in range(first, last):
        # Inside its cone an arc reaches furthest; elsewhere its nearer end is taken.
        if (
            arcs[k, A0R] * nz - arcs[k, A0Z] * nr >= 0.0
            and nr * arcs[k, A1Z] - nz * arcs[k, A1R] >= 0.0
        ):
            return arcs[k, CR] * nr + arcs[k, CZ] * nz + arcs[k, R]
        d0, d1 = arcs[k, A0R] * nr + arcs[k, A0Z] * nz, arcs[k, A1R] * nr + arcs[k, A1Z] * nz
        most = max(most, arcs[k, CR] * nr + arcs[k, CZ] * nz + arcs[k, R] * max(d0, d1))
    return most


@njit(**BORROWED)
def radius_at(arcs: Floats, first: int, last: int, h: float) -> float:
    """Return the radius (mm) of a body at height h (mm), h within its ends; negative where it has
    none.

    The least radius that any half-plane n_rho (rho - CR) + n_h (h - CZ) <= R leaves, solved for
    rho.
    """
    least = np.inf
    for k in range(first, last):
        dz = h - arcs[k, CZ]
        r = arcs[k, R]
        # Where the level of h crosses the arc itself, the circle decides: rho = CR + sqrt(R^2 - (h
        # - CZ)^2). Elsewhere only the tangents at both ends of the cone can.
        if r > 0.0 and arcs[k, A0Z] * r <= dz <= arcs[k, A1Z] * r:
            least = min(least, arcs[k, CR] + math.sqrt(max(r * r - dz * dz, 0.0)))
            continue
        for end in range(2):
            nr, nz = (arcs[k, A0R], arcs[k, A0Z]) if end == 0 else (arcs[k, A1R], arcs[k, A1Z])
            # An end face (n_rho about 0) bounds h, not rho: above or below it there is no body.
            if nr > 1e-9:
                least = min(least, arcs[k, CR] + (r - dz * nz) / nr)
            elif dz * nz > r + 1e-12:
                return -1.0
    return least


@njit(**BORROWED)
def heights_at(
    arcs: Floats, first: int, last: int, z_low: float, z_high: float, rho: float
) -> tuple[float, float]:
    """Return the lowest and highest h (mm) at which a body holds points at the distance rho (mm) from
    its axis; low > high where it holds none.

    The meridian's vertical section at rho: each half-plane that looks down (n_h < 0) gives a lower
    end h >= CZ + (R - n_rho (rho - CR)) / n_h, each that looks up an upper end.
    """
    low, high = z_low, z_high
    for k in range(first, last):
        dr, r = rho - arcs[k, CR], arcs[k, R]
        # The cone holds the normal straight out: nothing of the body lies beyond CR + R.
        if dr > r and arcs[k, A0Z] <= 0.0 <= arcs[k, A1Z]:
            return 1.0, 0.0
        # Whether the section meets the arc itself on its lower or its upper quarter; else the
        # tangents at both ends of the cone bound it.
        in_cone_low = (
            r > 0.0
            and arcs[k, A0Z] < 0.0
            and arcs[k, A0R] * r <= dr <= (arcs[k, A1R] * r if arcs[k, A1Z] < 0.0 else r)
        )
        in_cone_high = (
            r > 0.0
            and arcs[k, A1Z] > 0.0
            and arcs[k, A1R] * r <= dr <= (arcs[k, A0R] * r if arcs[k, A0Z] > 0.0 else r)
        )
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
            # A vertical flank further in than rho.
            elif dr * nr > r:
                return 1.0, 0.0
    return low, high
