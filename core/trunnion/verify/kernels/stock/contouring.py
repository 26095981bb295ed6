"""Compiled extraction of a closed mesh from a tri-dexel stock by dual contouring (Ju, Losasso,
Schaefer, Warren, Dual contouring of Hermite data, 2002).

The rays cross at the nodes of a lattice. A node is in material or not, by the z rays; on an edge
between two that differ, the ray along it gives where material ends, and its neighbours how the
surface leans there (Hermite data). Each box of eight nodes that differ gets one point, as near as
can be to the planes through its edges' ends, so edges and corners of the stock stay sharp; around
each such edge four points make a face. Two layers of nodes and points are held at a time. Where a
bundle is missing, its edges end half way.

For display and comparison of stock, no bound of the proof. mm, the frame of the stock.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Bools, Floats, Ints

REACH = 3.0
"""How many cells apart the ends of neighbouring rays may be to belong to one surface."""
BEND = 0.5
"""Slopes on both sides of a ray that differ by more are those of an edge between two surfaces: the smaller one firsts."""
CALM = 0.01
"""How strongly a point is held where its planes leave it free, beside the planes' own pull."""

Firsts = tuple[Ints, Ints, Ints]
Ends = tuple[Floats, Floats, Floats]


@njit(cache=True, nogil=True)
def _nearest_crossing(first: Ints, ends: Floats, ray: int, position: float, reach: float) -> float:
    """Return the end of material (mm) on a ray that is nearest to a position, NaN where none is within
    `reach` (mm)."""
    best, found = reach, np.nan
    for k in range(first[ray], first[ray + 1]):
        away = abs(ends[k] - position)
        if away <= best:
            best, found = away, ends[k]
    return found


@njit(cache=True, nogil=True)
def _edge_crossing(
    axis: int,
    cell: Ints,
    leaves: bool,
    firsts: Firsts,
    lows: Ends,
    highs: Ends,
    cells: Ints,
    origin: Floats,
    pitch: float,
    step: int,
    has: Bools,
    position: Floats,
    normal: Floats,
) -> None:
    # The two other axes in cyclic order: ray v * cells[u] + u.
    """Fill position (3,) and normal (3,) with where the surface crosses a lattice edge along `axis` from
    the node of a cell (3,), and its outward unit normal there.

    `leaves`: material ends upwards along the edge. Without a bundle or an end on its ray the
    crossing is half way and the normal along the edge.
    """
    u, v = (axis + 1) % 3, (axis + 2) % 3
    half = 0.5 * step * pitch
    for c in range(3):
        position[c], normal[c] = origin[c] + (cell[c] + 0.5) * pitch, 0.0
    normal[axis] = 1.0 if leaves else -1.0
    position[axis] += half
    if not has[axis]:
        return
    first, ends = firsts[axis], highs[axis] if leaves else lows[axis]
    end = _nearest_crossing(
        first, ends, cell[v] * cells[u] + cell[u], position[axis], half * (1.0 + 1e-9)
    )
    if np.isnan(end):
        return
    position[axis] = end
    # Slopes across the edge from the ends of neighbouring rays: their mean where both sides agree,
    # else the smaller, as the other is beyond an edge of the stock.
    for side in range(2):
        across, slope, sides = u if side == 0 else v, 0.0, 0
        for sense in range(-1, 2, 2):
            neighbour = cell[across] + sense
            if not 0 <= neighbour < cells[across]:
                continue
            ray = cell[v] * cells[u] + neighbour if side == 0 else neighbour * cells[u] + cell[u]
            other = _nearest_crossing(first, ends, ray, end, REACH * pitch)
            if np.isnan(other):
                continue
            rise = (other - end) / (sense * pitch)
            if sides == 0:
                slope = rise
            elif abs(rise - slope) <= BEND:
                slope = 0.5 * (rise + slope)
            elif abs(rise) < abs(slope):
                slope = rise
            sides += 1
        # The surface a = end + slope * across has the normal (1, -slope), signed outwards.
        normal[across] = -slope * normal[axis]
    size = math.sqrt(normal[0] ** 2 + normal[1] ** 2 + normal[2] ** 2)
    for c in range(3):
        normal[c] /= size


@njit(cache=True, nogil=True)
def _classify_layer(
    k: int,
    first: Ints,
    low: Floats,
    high: Floats,
    cells: Ints,
    nodes: Ints,
    origin: Floats,
    pitch: float,
    step: int,
    inside: Bools,
) -> None:
    """Fill inside (rows, columns, each with a border of nodes outside) with which nodes of layer k are
    in material."""
    inside[:] = False
    if not 0 <= k < nodes[2]:
        return
    begin = step // 2
    z = origin[2] + (begin + k * step + 0.5) * pitch
    for j in range(nodes[1]):
        for i in range(nodes[0]):
            ray = (begin + j * step) * cells[0] + begin + i * step
            for m in range(first[ray], first[ray + 1]):
                if low[m] <= z <= high[m]:
                    inside[j + 1, i + 1] = True
                    break


@njit(cache=True, nogil=True)
def _solve_cramer(a: Floats, b: Floats, out: Floats) -> None:
    """Solve a symmetric positive definite system of three, a (3, 3), b (3,), by Cramer's rule into out
    (3,)."""
    c00, c01, c02 = (
        a[1, 1] * a[2, 2] - a[1, 2] ** 2,
        a[0, 2] * a[1, 2] - a[0, 1] * a[2, 2],
        a[0, 1] * a[1, 2] - a[0, 2] * a[1, 1],
    )
    c11, c12, c22 = (
        a[0, 0] * a[2, 2] - a[0, 2] ** 2,
        a[0, 1] * a[0, 2] - a[0, 0] * a[1, 2],
        a[0, 0] * a[1, 1] - a[0, 1] ** 2,
    )
    size = a[0, 0] * c00 + a[0, 1] * c01 + a[0, 2] * c02
    out[0] = (c00 * b[0] + c01 * b[1] + c02 * b[2]) / size
    out[1] = (c01 * b[0] + c11 * b[1] + c12 * b[2]) / size
    out[2] = (c02 * b[0] + c12 * b[1] + c22 * b[2]) / size


@njit(cache=True, nogil=True)
def _dual_vertex(
    i: int,
    j: int,
    k: int,
    lower: Bools,
    upper: Bools,
    firsts: Firsts,
    lows: Ends,
    highs: Ends,
    cells: Ints,
    origin: Floats,
    pitch: float,
    step: int,
    has: Bools,
    work: Floats,
    cell: Ints,
    out: Floats,
) -> None:
    """Fill out (3,) with the point of the box whose lowest node is (i, j, k) of the lattice with its
    border.

    Least squares of the planes' distances (a quadratic error function), relative to the mean of the
    crossings: sum n n^T x = sum n (n . (position - mean)), with CALM added on the diagonal (Tikhonov),
    so that a flat or straight surface keeps its point at the mean. The point is held within its
    box.
    """
    a, b, mean, position, normal, offset = work[0:3], work[3], work[4], work[5], work[6], work[7]
    a[:], b[:], mean[:] = 0.0, 0.0, 0.0
    begin, total = step // 2, 0
    # First round: mean of the crossings; second round: the normal equations about it.
    for again in range(2):
        for axis in range(3):
            for corner in range(4):
                d = (corner & 1, corner >> 1)
                # The edge's lower node in the box: 0 along the axis, d across it.
                x, y, z = (
                    (0, d[0], d[1])
                    if axis == 0
                    else (d[1], 0, d[0])
                    if axis == 1
                    else (d[0], d[1], 0)
                )
                one = (upper if z else lower)[j + y, i + x]
                x1, y1, z1 = x + (axis == 0), y + (axis == 1), z + (axis == 2)
                if one == (upper if z1 else lower)[j + y1, i + x1]:
                    continue
                cell[0], cell[1], cell[2] = (
                    begin + (i + x - 1) * step,
                    begin + (j + y - 1) * step,
                    begin + (k + z - 1) * step,
                )
                _edge_crossing(
                    axis,
                    cell,
                    one,
                    firsts,
                    lows,
                    highs,
                    cells,
                    origin,
                    pitch,
                    step,
                    has,
                    position,
                    normal,
                )
                if again == 0:
                    total += 1
                    for c in range(3):
                        mean[c] += position[c]
                    continue
                away = 0.0
                for c in range(3):
                    away += normal[c] * (position[c] - mean[c])
                for c in range(3):
                    b[c] += normal[c] * away
                    for e in range(3):
                        a[c, e] += normal[c] * normal[e]
        if again == 0:
            for c in range(3):
                mean[c] /= total
    for c in range(3):
        a[c, c] += CALM * total
    _solve_cramer(a, b, offset)
    for c in range(3):
        low = origin[c] + (begin + ((i, j, k)[c] - 1) * step + 0.5) * pitch
        out[c] = min(max(mean[c] + offset[c], low), low + step * pitch)


@njit(cache=True, nogil=True)
def count_dual_mesh(
    firsts: Firsts, lows: Ends, highs: Ends, cells: Ints, origin: Floats, pitch: float, step: int
) -> tuple[int, int]:
    """Return how many points and how many faces of four points the mesh of `dual_contour` has; arguments
    as there."""
    nodes = (cells - step // 2 + step - 1) // step
    lower, upper = (
        np.zeros((nodes[1] + 2, nodes[0] + 2), np.bool_),
        np.zeros((nodes[1] + 2, nodes[0] + 2), np.bool_),
    )
    points, faces = 0, 0
    # Layer by layer from below: only two layers of nodes are kept at a time.
    for k in range(nodes[2] + 1):
        _classify_layer(k, firsts[2], lows[2], highs[2], cells, nodes, origin, pitch, step, upper)
        for j in range(nodes[1] + 1):
            for i in range(nodes[0] + 1):
                # A box whose eight nodes differ has a point; an edge whose nodes differ has a face.
                some = (
                    int(lower[j, i])
                    + lower[j, i + 1]
                    + lower[j + 1, i]
                    + lower[j + 1, i + 1]
                    + upper[j, i]
                    + upper[j, i + 1]
                    + upper[j + 1, i]
                    + upper[j + 1, i + 1]
                )
                points += 1 if 0 < some < 8 else 0
                faces += (
                    int(lower[j, i] != lower[j, i + 1])
                    + int(lower[j, i] != lower[j + 1, i])
                    + int(lower[j, i] != upper[j, i])
                )
        lower, upper = upper, lower
    return points, faces


@njit(cache=True, nogil=True)
def _add_quad(
    a: int, b: int, c: int, d: int, turned: bool, points: Floats, triangles: Ints, n: int
) -> int:
    """Add the two triangles of a face of four points, cut along its shorter diagonal, to triangles
    from row n on; return the next row. `turned` reverses the orientation."""
    first, second = 0.0, 0.0
    for e in range(3):
        first += (points[a, e] - points[c, e]) ** 2
        second += (points[b, e] - points[d, e]) ** 2
    if second < first:
        a, b, c, d = b, c, d, a
    if turned:
        b, d = d, b
    triangles[n, 0], triangles[n, 1], triangles[n, 2] = a, b, c
    triangles[n + 1, 0], triangles[n + 1, 1], triangles[n + 1, 2] = a, c, d
    return n + 2


@njit(cache=True, nogil=True)
def dual_contour(
    firsts: Firsts,
    lows: Ends,
    highs: Ends,
    has: Bools,
    cells: Ints,
    origin: Floats,
    pitch: float,
    step: int,
    n_points: int,
    n_faces: int,
) -> tuple[Floats, Ints]:
    """Return points (v, 3) and triangles (t, 3), anticlockwise from outside, of the stock that three
    bundles of rays hold.

    firsts, lows, highs: of the bundles along x, y, z, the intervals of all rays in a row: ray c has
    those from first[c] to first[c + 1]; ray v * cells[u] + u stands in cell (u, v) of the two other
    axes, in cyclic order. has (3,): which bundles there are (z always); cells (3,)
    along each axis from origin (3,), `pitch` wide; a lattice of every `step`-th ray; n_points,
    n_faces: what `count_dual_mesh` says.
    """
    nodes = (cells - step // 2 + step - 1) // step
    wide, deep = nodes[0] + 2, nodes[1] + 2
    lower, upper = np.zeros((deep, wide), np.bool_), np.zeros((deep, wide), np.bool_)
    under, over = np.full((deep, wide), -1), np.full((deep, wide), -1)
    points, triangles = np.empty((n_points, 3)), np.empty((2 * n_faces, 3), np.int64)
    work, cell = np.empty((8, 3)), np.empty(3, np.int64)
    v, n = 0, 0
    # Layer by layer from below: only two layers of nodes are kept at a time.
    for k in range(nodes[2] + 1):
        _classify_layer(k, firsts[2], lows[2], highs[2], cells, nodes, origin, pitch, step, upper)
        for j in range(deep - 1):
            for i in range(wide - 1):
                some = (
                    int(lower[j, i])
                    + lower[j, i + 1]
                    + lower[j + 1, i]
                    + lower[j + 1, i + 1]
                    + upper[j, i]
                    + upper[j, i + 1]
                    + upper[j + 1, i]
                    + upper[j + 1, i + 1]
                )
                if 0 < some < 8:
                    _dual_vertex(
                        i,
                        j,
                        k,
                        lower,
                        upper,
                        firsts,
                        lows,
                        highs,
                        cells,
                        origin,
                        pitch,
                        step,
                        has,
                        work,
                        cell,
                        points[v],
                    )
                    over[j, i] = v
                    v += 1
        # Faces around edges along z, between the two layers of nodes: four boxes of the upper layer
        # of points (`over`).
        for j in range(1, deep - 1):
            for i in range(1, wide - 1):
                # The face's sense of rotation follows which of both nodes is in material.
                here = lower[j, i]
                if here != upper[j, i]:
                    n = _add_quad(
                        over[j - 1, i - 1],
                        over[j - 1, i],
                        over[j, i],
                        over[j, i - 1],
                        not here,
                        points,
                        triangles,
                        n,
                    )
        # Faces around edges along x and y in the lower layer of nodes: two boxes below (`under`)
        # and two above (`over`).
        for j in range(deep - 1):
            for i in range(wide - 1):
                here = lower[j, i]
                if here != lower[j, i + 1]:
                    n = _add_quad(
                        under[j - 1, i],
                        under[j, i],
                        over[j, i],
                        over[j - 1, i],
                        not here,
                        points,
                        triangles,
                        n,
                    )
                if here != lower[j + 1, i]:
                    n = _add_quad(
                        under[j, i - 1],
                        over[j, i - 1],
                        over[j, i],
                        under[j, i],
                        not here,
                        points,
                        triangles,
                        n,
                    )
        lower, upper = upper, lower
        under, over = over, under
    return points, triangles[:n]
