"""The loops of `kernels.cutter_contact.push_cutter` compiled: the plane in closed form, edges by golden section of a concave
function, corners directly.

Everything is seen relative to the line: x along it, y across, z above it; a search towards -x
mirrors x. A point of a triangle at (x, y, z) blocks the tip up to x + sqrt(r(z)^2 - y^2), r(z) the
cutter's radius at the height z above its tip: the cutter pushed from +x stops where the largest of
these over the triangle is.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.kernels.cutter_contact.drop_cutter import RHO0, RHO1, ROUND, A, B, C
from trunnion.geometry.kernels.cutter_contact.drop_cutter_compiled import (
    HIGH_Y,
    HIGH_Z,
    LOW_Y,
    _contact_radius,
    _profile_height,
)
from trunnion.geometry.kernels.kernel_arrays import BORROWED

GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)
STEPS = 80
"""Steps of a golden section: to the last digit of where, so far below it of how far."""
HALVINGS = 60


@njit(**BORROWED)
def _profile_radius(pieces: Floats, height: float) -> float:
    """Return the radius (mm) to which the cutter extends at a height above its tip, -1 below it; where
    it is level, its outer radius."""
    if height < 0.0:
        return -1.0
    radius = 0.0
    for k in range(len(pieces)):
        if pieces[k, ROUND] != 0.0:
            if height < pieces[k, B] - math.sqrt(
                max(pieces[k, C] ** 2 - (pieces[k, RHO0] - pieces[k, A]) ** 2, 0.0)
            ):
                return radius
            up = pieces[k, B] - height
            r = (
                pieces[k, A] + math.sqrt(max(pieces[k, C] * pieces[k, C] - up * up, 0.0))
                if up > 0.0
                else pieces[k, RHO1]
            )
            radius = min(max(r, pieces[k, RHO0]), pieces[k, RHO1])
        else:
            if height < pieces[k, A]:
                return radius
            if pieces[k, B] > 0.0:
                radius = min(
                    pieces[k, RHO0] + (height - pieces[k, A]) / pieces[k, B], pieces[k, RHO1]
                )
            else:
                radius = pieces[k, RHO1]
        if radius < pieces[k, RHO1]:
            return radius
    return radius


@njit(**BORROWED, inline="always")
def _disc_margin(pieces: Floats, across: float, height: float) -> float:
    """Return by how much (mm) the cutter's disc extends over a point beside the line; negative where
    it doesn't. Concave along an edge."""
    return _profile_radius(pieces, height) - abs(across)


@njit(**BORROWED)
def _vertex_push(pieces: Floats, x: float, across: float, height: float) -> float:
    """Return how far (x, mm) a point blocks the line towards +x; -inf where the cutter passes beside
    or above it."""
    r = _profile_radius(pieces, height)
    square = r * r - across * across
    return x + math.sqrt(square) if r >= 0.0 and square >= 0.0 else -np.inf


@njit(**BORROWED)
def _edge_push(
    pieces: Floats, x0: float, y0: float, z0: float, x1: float, y1: float, z1: float, best: float
) -> float:
    """Return the larger of `best` and how far (x, mm) an edge, relative to the line, blocks it towards
    +x.

    Two golden sections (Kiefer, 1953): one of the room, to find any position that the cutter extends
    over, one of the blocked x, which is concave over the stretch between the first and the last
    such position.
    """
    dx, dy, dz = x1 - x0, y1 - y0, z1 - z0
    radius = pieces[len(pieces) - 1, RHO1]
    if (
        max(x0, x1) + radius <= best
        or max(z0, z1) < 0.0
        or min(y0, y1) > radius
        or max(y0, y1) < -radius
    ):
        return best
    # The stretch of the edge above the tip's height.
    low, high = 0.0, 1.0
    if z0 < 0.0:
        low = -z0 / dz
    elif z1 < 0.0:
        high = -z0 / dz
    a, b = low, high
    top = -1.0
    for _ in range(STEPS):
        p, q = b - GOLDEN * (b - a), a + GOLDEN * (b - a)
        if _disc_margin(pieces, y0 + p * dy, z0 + p * dz) < _disc_margin(
            pieces, y0 + q * dy, z0 + q * dz
        ):
            a = p
        else:
            b = q
        if b - a < 1e-15:
            break
    inside = 0.5 * (a + b)
    # An end may be better than the interior optimum: the room drops to -1 below the tip.
    for t in (low, high):
        if _disc_margin(pieces, y0 + t * dy, z0 + t * dz) > _disc_margin(
            pieces, y0 + inside * dy, z0 + inside * dz
        ):
            inside = t
    top = _disc_margin(pieces, y0 + inside * dy, z0 + inside * dz)
    if top < 0.0:
        return best
    # Both ends of the stretch that the cutter extends over, by bisection; then the furthest x on
    # it.
    low = _edge_margin_end(pieces, y0, z0, dy, dz, inside, low)
    high = _edge_margin_end(pieces, y0, z0, dy, dz, inside, high)
    a, b = low, high
    for _ in range(STEPS):
        p, q = b - GOLDEN * (b - a), a + GOLDEN * (b - a)
        if _vertex_push(pieces, x0 + p * dx, y0 + p * dy, z0 + p * dz) < _vertex_push(
            pieces, x0 + q * dx, y0 + q * dy, z0 + q * dz
        ):
            a = p
        else:
            b = q
        if b - a < 1e-15:
            break
    for t in (low, 0.5 * (a + b), high):
        best = max(best, _vertex_push(pieces, x0 + t * dx, y0 + t * dy, z0 + t * dz))
    return best


@njit(**BORROWED)
def _edge_margin_end(
    pieces: Floats, y0: float, z0: float, dy: float, dz: float, inside: float, end: float
) -> float:
    """Return the last place of an edge, from one that the cutter extends over towards an end, that it
    still extends over."""
    if _disc_margin(pieces, y0 + end * dy, z0 + end * dz) >= 0.0:
        return end
    for _ in range(HALVINGS):
        middle = 0.5 * (inside + end)
        if _disc_margin(pieces, y0 + middle * dy, z0 + middle * dz) >= 0.0:
            inside = middle
        else:
            end = middle
    return inside


@njit(**BORROWED)
def _facet_push(pieces: Floats, c: Floats, y: float, z: float, mirror: float, best: float) -> float:
    """Return the larger of `best` and how far the inside of a triangle, corners c (9,), blocks a line
    towards +x of the mirrored space.

    The cutter touches the plane where its lower side has the plane's slope: at the distance rho
    from its axis, against the plane's horizontal normal.
    """
    ax, ay, az = mirror * c[0], c[1] - y, c[2] - z
    bx, by, bz = mirror * c[3], c[4] - y, c[5] - z
    cx, cy, cz = mirror * c[6], c[7] - y, c[8] - z
    nx = (by - ay) * (cz - az) - (bz - az) * (cy - ay)
    ny = (bz - az) * (cx - ax) - (bx - ax) * (cz - az)
    nz = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    size = math.sqrt(nx * nx + ny * ny + nz * nz)
    if size == 0.0 or nx == 0.0:
        return best
    # The side that the cutter comes from looks towards +x, and upwards: its lower side touches nothing else.
    sign = 1.0 / size if nx > 0.0 else -1.0 / size
    nx, ny, nz = nx * sign, ny * sign, nz * sign
    if nz <= 0.0:
        return best
    level = math.sqrt(nx * nx + ny * ny)
    rho = _contact_radius(pieces, level / nz)
    sx, sy, sz = -rho * nx / level, -rho * ny / level, _profile_height(pieces, rho)
    # The tip is on the line, at (x, 0, 0), and what touches is the tip and s.
    x = ax + (ny * (ay - sy) + nz * (az - sz)) / nx - sx
    if x <= best:
        return best
    px, py, pz = x + sx, sy, sz
    # The touching point must lie inside the triangle: on the same side of all three edges.
    for k in range(3):
        if k == 0:
            ux, uy, uz, vx, vy, vz = bx - ax, by - ay, bz - az, px - ax, py - ay, pz - az
        elif k == 1:
            ux, uy, uz, vx, vy, vz = cx - bx, cy - by, cz - bz, px - bx, py - by, pz - bz
        else:
            ux, uy, uz, vx, vy, vz = ax - cx, ay - cy, az - cz, px - cx, py - cy, pz - cz
        turn = (uy * vz - uz * vy) * nx + (uz * vx - ux * vz) * ny + (ux * vy - uy * vx) * nz
        if turn * sign < 0.0:
            return best
    return x


@njit(**BORROWED)
def triangle_push(pieces: Floats, c: Floats, y: float, z: float, mirror: float) -> float:
    """Return how far (x, mm) a triangle, corners c (9,), blocks the line at (y, z) towards +x (mirror
    1) or -x (mirror -1, negated); -inf where it doesn't.

    The largest over its corners, edges and inside.
    """
    best = -np.inf
    for k in range(3):
        a, b = 3 * k, 3 * ((k + 1) % 3)
        best = max(best, _vertex_push(pieces, mirror * c[a], c[a + 1] - y, c[a + 2] - z))
        best = _edge_push(
            pieces,
            mirror * c[a],
            c[a + 1] - y,
            c[a + 2] - z,
            mirror * c[b],
            c[b + 1] - y,
            c[b + 2] - z,
            best,
        )
    return _facet_push(pieces, c, y, z, mirror, best)


@njit(cache=True, nogil=True)
def push_cutter_loop(
    first: int,
    last: int,
    lines: Floats,
    facets: Floats,
    low: Floats,
    pitch: float,
    shape: Ints,
    start: Ints,
    rows: Ints,
    pieces: Floats,
    count: Ints,
    spans: Floats,
) -> bool:
    """List the intervals that facets (t, 19) of a lattice block along lines[first:last] (n, 2) of y
    and z, in the order of the lattice.

    low (2,), pitch, shape (2,), start, rows: the lattice over the facets' boxes. count (n,) how
    many of each line; spans (last - first, k, 2) from x to x. Returns whether k was enough.
    """
    radius = pieces[len(pieces) - 1, RHO1]
    seen = np.full(len(facets), -1)
    for n in range(first, last):
        y, z = lines[n, 0], lines[n, 1]
        count[n] = 0
        # Rows of the lattice within a radius of the line; a facet in several cells is judged once.
        j0, j1 = (
            int(math.floor((y - radius - low[1]) / pitch)),
            int(math.floor((y + radius - low[1]) / pitch)),
        )
        for j in range(max(j0, 0), min(j1, shape[1] - 1) + 1):
            for i in range(shape[0]):
                cell = j * shape[0] + i
                for c in range(start[cell], start[cell + 1]):
                    r = rows[c]
                    f = facets[r]
                    if (
                        seen[r] == n
                        or f[HIGH_Z] < z
                        or f[LOW_Y] > y + radius
                        or f[HIGH_Y] < y - radius
                    ):
                        continue
                    seen[r] = n
                    right = triangle_push(pieces, f, y, z, 1.0)
                    if right == -np.inf:
                        continue
                    if count[n] >= spans.shape[1]:
                        return False
                    spans[n - first, count[n], 0], spans[n - first, count[n], 1] = (
                        -triangle_push(pieces, f, y, z, -1.0),
                        right,
                    )
                    count[n] += 1
    return True
