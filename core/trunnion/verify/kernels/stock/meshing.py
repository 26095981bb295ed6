"""Compiled triangulation of a height field as a closed solid, with merged patches and vertical walls.

Every cell has a top with four corners of its own; where the surface continues over a cell's edge
the corners of both sides are the same, the mean of the cells around them, elsewhere a vertical wall
stands between. Neighbouring cells of one height, and small blocks of nearly flat ones, become one
patch (greedy merging). A corner of the lattice that no patch has as a corner and where no wall
begins, ends or changes is left out on all sides of it at once, so the mesh stays closed (no
T-junctions); a wall's upright sides have a point at every height that any cell has there.

Cells without material have the floor's height and neither top nor bottom. Plain reference: the same
heights as separate blocks. mm; lattice corners (rows + 1, columns + 1), cells between them.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Bools, Floats, Ints

STEP = 2.5
"""A jump is a wall when it is this many times larger than the jumps on both sides of it in the same direction."""
FINE = 0.02
"""A jump of less than this many cells is never a wall."""
SLOTS = 5
"""Most heights at one corner: four cells and the floor."""
# Where a cell's corners are from its own row and column, anticlockwise.
CORNER_ROW = (0, 0, 1, 1)
CORNER_COLUMN = (0, 1, 1, 0)


@njit(cache=True, nogil=True, inline="always")
def _is_continuous(before: float, a: float, b: float, after: float, fine: float) -> bool:
    """Return whether the surface continues from a cell of height a to its neighbour of height b, the
    cells before and after them given too.

    A jump is a wall when it is larger than `fine` (mm) and than STEP times both jumps beside it: a
    slope jumps alike at every cell.
    """
    jump = abs(b - a)
    return jump <= fine or jump <= STEP * max(abs(a - before), abs(b - after))


@njit(cache=True, nogil=True)
def corner_heights(top: Floats, floor: float, pitch: float) -> Floats:
    """Return the heights of each cell's corners, anticlockwise from the lowest row and column, as (rows + 2, columns + 2, 4).

    Around the field there is a border of cells; those and the empty ones have the floor's height.
    """
    rows, columns = top.shape
    fine = FINE * pitch
    # right, up: whether the surface continues to the cell at the right, and to the one above.
    right, up = np.zeros((rows, columns), np.bool_), np.zeros((rows, columns), np.bool_)
    for j in range(rows):
        for i in range(columns):
            a = top[j, i]
            if a <= floor:
                continue
            if i + 1 < columns and top[j, i + 1] > floor:
                before, after = (
                    top[j, i - 1] if i > 0 else a,
                    top[j, i + 2] if i + 2 < columns else top[j, i + 1],
                )
                right[j, i] = _is_continuous(before, a, top[j, i + 1], after, fine)
            if j + 1 < rows and top[j + 1, i] > floor:
                before, after = (
                    top[j - 1, i] if j > 0 else a,
                    top[j + 2, i] if j + 2 < rows else top[j + 1, i],
                )
                up[j, i] = _is_continuous(before, a, top[j + 1, i], after, fine)
    out = np.full((rows + 2, columns + 2, 4), floor)
    for j in range(rows):
        for i in range(columns):
            for q in range(4):
                out[j + 1, i + 1, q] = max(top[j, i], floor)
    # At each lattice corner the cells around it that continue into each other form groups: union by
    # relabelling, as there are only four. A group's corners get its mean height.
    label, h, linked = np.empty(4, np.int64), np.empty(4), np.empty(4, np.bool_)
    for j in range(rows + 1):
        for i in range(columns + 1):
            if 0 < j < rows and 0 < i < columns:
                z = top[j, i]
                if top[j - 1, i - 1] == z and top[j - 1, i] == z and top[j, i - 1] == z:
                    continue
            # Cells around the corner, anticlockwise from below left, and whether each goes on to the next.
            linked[0] = j > 0 and 0 < i < columns and right[j - 1, i - 1]
            linked[1] = 0 < j < rows and i < columns and up[j - 1, i]
            linked[2] = j < rows and 0 < i < columns and right[j, i - 1]
            linked[3] = 0 < j < rows and i > 0 and up[j - 1, i - 1]
            if not (linked[0] or linked[1] or linked[2] or linked[3]):
                continue
            for q in range(4):
                label[q] = q
                y, x = j - 1 + (q >= 2), i - 1 + (q == 1 or q == 2)
                h[q] = top[y, x] if 0 <= y < rows and 0 <= x < columns else floor
            for q in range(4):
                if linked[q]:
                    old, new = label[(q + 1) % 4], label[q]
                    for p in range(4):
                        if label[p] == old:
                            label[p] = new
            for q in range(4):
                y, x = j - 1 + (q >= 2), i - 1 + (q == 1 or q == 2)
                if not (0 <= y < rows and 0 <= x < columns and top[y, x] > floor):
                    continue
                # As a difference from one member, so that equal heights give exactly that height.
                total, count = 0.0, 0
                for p in range(4):
                    if label[p] == label[q]:
                        total += h[p] - h[label[q]]
                        count += 1
                out[y + 1, x + 1, (q + 2) % 4] = h[label[q]] + total / count
    return out


@njit(cache=True, nogil=True)
def _largest_rectangle(free: Bools, top: Floats, j: int, i: int, same: bool) -> tuple[int, int]:
    """Return the row and column after a rectangle of free cells (of one height, where required) that
    begins at cell (j, i): as wide as its first row goes, then as deep."""
    rows, columns = top.shape
    i1 = i + 1
    while i1 < columns and free[j, i1] and (not same or top[j, i1] == top[j, i]):
        i1 += 1
    j1 = j + 1
    while j1 < rows:
        for k in range(i, i1):
            if not free[j1, k] or (same and top[j1, k] != top[j, i]):
                return j1, i1
        j1 += 1
    return j1, i1


@njit(cache=True, nogil=True)
def _is_one_surface(free: Bools, corners: Floats, j: int, i: int, size: int, bound: float) -> bool:
    """Return whether a size x size block of free cells is one surface, everywhere within a bound (mm)
    of what its four corners span."""
    rows, columns = free.shape
    if j + size > rows or i + size > columns:
        return False
    # One surface: shared corners agree on every inner edge.
    for y in range(j, j + size):
        for x in range(i, i + size):
            if not free[y, x]:
                return False
            own, right, over = corners[y + 1, x + 1], corners[y + 1, x + 2], corners[y + 2, x + 1]
            if x + 1 < i + size and (own[1] != right[0] or own[2] != right[3]):
                return False
            if y + 1 < j + size and (own[3] != over[0] or own[2] != over[1]):
                return False
    # Every lattice corner of the block against the bilinear patch of the block's corners.
    e = size - 1
    y, x = j + size, i + size
    a, b, c, d = (
        corners[j + 1, i + 1, 0],
        corners[j + 1, x, 1],
        corners[y, x, 2],
        corners[y, i + 1, 3],
    )
    for y in range(size + 1):
        v = y / size
        for x in range(size + 1):
            u = x / size
            cell_y, cell_x = min(y, e), min(x, e)
            q = (1 if x > e else 0) if y <= e else (2 if x > e else 3)
            wanted = (1 - v) * ((1 - u) * a + u * b) + v * ((1 - u) * d + u * c)
            if abs(corners[j + cell_y + 1, i + cell_x + 1, q] - wanted) > bound:
                return False
    return True


@njit(cache=True, nogil=True)
def patches(top: Floats, floor: float, corners: Floats, bound: float) -> tuple[Ints, int, int]:
    """Return rectangles of cells (k, 4) as first row, first column, row after, column after: first those of the tops, then of the bottom;
    and how many of each. Tops: level ones as large as they go, blocks of 4 and 2 cells that are even within a bound, single cells."""
    rows, columns = top.shape
    free, level = np.zeros((rows, columns), np.bool_), np.zeros((rows, columns), np.bool_)
    for j in range(rows):
        for i in range(columns):
            h = top[j, i]
            free[j, i] = h > floor
            own = corners[j + 1, i + 1]
            level[j, i] = free[j, i] and own[0] == h and own[1] == h and own[2] == h and own[3] == h
    there = free.copy()
    found = np.empty((2 * rows * columns, 4), np.int32)
    n = 0
    # Stages: level rectangles, even blocks of 4, even blocks of 2 and single cells, then the
    # bottom.
    for stage in range(4):
        if stage == 3:
            tops = n
        for j in range(rows):
            for i in range(columns):
                if stage == 3:
                    if not there[j, i]:
                        continue
                    j1, i1 = _largest_rectangle(there, top, j, i, False)
                elif stage == 0:
                    if not level[j, i]:
                        continue
                    j1, i1 = _largest_rectangle(level, top, j, i, True)
                elif not free[j, i]:
                    continue
                elif stage == 1:
                    if (
                        j % 4 != 0
                        or i % 4 != 0
                        or not _is_one_surface(free, corners, j, i, 4, bound)
                    ):
                        continue
                    j1, i1 = j + 4, i + 4
                elif j % 2 == 0 and i % 2 == 0 and _is_one_surface(free, corners, j, i, 2, bound):
                    j1, i1 = j + 2, i + 2
                else:
                    j1, i1 = j + 1, i + 1
                found[n, 0], found[n, 1], found[n, 2], found[n, 3] = j, i, j1, i1
                n += 1
                for y in range(j, j1):
                    for x in range(i, i1):
                        if stage == 3:
                            there[y, x] = False
                        else:
                            free[y, x], level[y, x] = False, False
    return found[:n].astype(np.int64), tops, n - tops


@njit(cache=True, nogil=True)
def _needed(
    floor: float, corners: Floats, patch: Ints, tops: int
) -> tuple[Bools, Bools, Bools, Bools]:
    """Return at which corners of the lattice (rows + 1, columns + 1) tops and bottom must have points, and where walls stand: from each
    corner along its row, and along its column."""
    rows, columns = corners.shape[0] - 2, corners.shape[1] - 2
    above, below = (
        np.zeros((rows + 1, columns + 1), np.bool_),
        np.zeros((rows + 1, columns + 1), np.bool_),
    )
    along, across = (
        np.zeros((rows + 1, columns + 1), np.bool_),
        np.zeros((rows + 1, columns + 1), np.bool_),
    )
    # The corners of patches.
    for k in range(len(patch)):
        mark = above if k < tops else below
        for q in range(4):
            mark[
                patch[k, 2] if CORNER_ROW[q] else patch[k, 0],
                patch[k, 3] if CORNER_COLUMN[q] else patch[k, 1],
            ] = True
    # A wall stands along an edge of the lattice where the corners of both sides differ.
    for j in range(rows + 1):
        for i in range(columns + 1):
            # With the border, the cell above right of a corner is (j + 1, i + 1).
            own, left, under = corners[j + 1, i + 1], corners[j + 1, i], corners[j, i + 1]
            along[j, i] = own[0] != under[3] or own[1] != under[2]
            across[j, i] = own[0] != left[1] or own[3] != left[2]
    # Where walls begin, end, meet or change height.
    for j in range(rows + 1):
        for i in range(columns + 1):
            ahead, behind = along[j, i], i > 0 and along[j, i - 1]
            up, down = across[j, i], j > 0 and across[j - 1, i]
            if not (ahead or behind or up or down):
                continue
            a, b, c, d = corners[j, i], corners[j, i + 1], corners[j + 1, i + 1], corners[j + 1, i]
            grounded = a[2] == floor or b[3] == floor or c[0] == floor or d[1] == floor
            # A wall that runs on straight and level needs no points here, unless a patch beside it has one.
            if ahead and behind and not (up or down):
                plain = (
                    a[3] == a[2]
                    and a[2] == b[3]
                    and b[3] == b[2]
                    and d[0] == d[1]
                    and d[1] == c[0]
                    and c[0] == c[1]
                )
            elif up and down and not (ahead or behind):
                plain = (
                    a[1] == a[2]
                    and a[2] == d[1]
                    and d[1] == d[2]
                    and b[0] == b[3]
                    and b[3] == c[0]
                    and c[0] == c[3]
                )
            else:
                plain = False
            if not plain or above[j, i] or (grounded and below[j, i]):
                above[j, i] = True
                below[j, i] = below[j, i] or grounded
    return above, below, along, across


@njit(cache=True, nogil=True)
def _slots(floor: float, corners: Floats, above: Bools, below: Bools) -> tuple[Floats, Ints]:
    """Return the heights (mm) at each corner of the lattice, downwards (n,), and where each corner's
    begin (corners + 1,).

    One mesh point a slot. Equal heights share a slot, which is what joins the patches.
    """
    rows, columns = corners.shape[0] - 2, corners.shape[1] - 2
    count = (rows + 1) * (columns + 1)
    start = np.zeros(count + 1, np.int64)
    heights = np.empty(SLOTS * (np.count_nonzero(above) + np.count_nonzero(below)))
    n = 0
    for j in range(rows + 1):
        for i in range(columns + 1):
            first = n
            for q in range(5):
                if q == 4:
                    if not below[j, i]:
                        continue
                    z = floor
                else:
                    if not above[j, i]:
                        continue
                    z = corners[j + (q >= 2), i + (q == 1 or q == 2), (q + 2) % 4]
                # Insertion in descending order, without duplicates.
                k = first
                while k < n and heights[k] > z:
                    k += 1
                if k < n and heights[k] == z:
                    continue
                for m in range(n, k, -1):
                    heights[m] = heights[m - 1]
                heights[k] = z
                n += 1
            start[j * (columns + 1) + i + 1] = n
    return heights[:n].copy(), start


@njit(cache=True, nogil=True, inline="always")
def _point(heights: Floats, start: Ints, corner: int, z: float) -> int:
    """Return the mesh point of a lattice corner at a height, which must be one of its slots."""
    k = start[corner]
    while heights[k] != z:
        k += 1
    return k


@njit(cache=True, nogil=True)
def _wall(
    heights: Floats,
    start: Ints,
    p: int,
    ap: float,
    bp: float,
    q: int,
    aq: float,
    bq: float,
    triangles: Ints,
    n: int,
    write: bool,
) -> int:
    """Add the triangles of the wall between cell A and cell B over the edge from corner p to corner q,
    which A's top has in this order; return the new count.

    ap, bp, aq, bq: heights (mm) of A and B at p and q. The strip between both uprights is
    triangulated by advancing on one of them at a time, so every slot is used and the walls beside
    it fit. Without `write` only counted.
    """
    at_p, to_p, at_q, to_q = (
        _point(heights, start, p, ap),
        _point(heights, start, p, bp),
        _point(heights, start, q, aq),
        _point(heights, start, q, bq),
    )
    step_p, step_q = 1 if to_p > at_p else -1, 1 if to_q > at_q else -1
    while at_p != to_p or at_q != to_q:
        # The side whose next point is less far from where both began goes on first.
        first = at_p != to_p and (
            at_q == to_q or abs(heights[at_p + step_p] - ap) <= abs(heights[at_q + step_q] - aq)
        )
        following = at_p + step_p if first else at_q + step_q
        if write:
            triangles[n, 0], triangles[n, 1], triangles[n, 2] = (
                (at_q, at_p, following) if first else (following, at_q, at_p)
            )
        n += 1
        if first:
            at_p = following
        else:
            at_q = following
    return n


@njit(cache=True, nogil=True)
def _faces(
    floor: float,
    corners: Floats,
    patch: Ints,
    tops: int,
    above: Bools,
    below: Bools,
    along: Bools,
    across: Bools,
    heights: Floats,
    start: Ints,
    centres: Floats,
    triangles: Ints,
    write: bool,
) -> tuple[int, int]:
    """Add all triangles, of patches and of walls; return how many, and how many patches got a point in
    their middle (centres (k, 3): column, row, height).

    Without `write` only counted: the same code first gives the sizes of the arrays, then fills
    them.
    """
    rows, columns = corners.shape[0] - 2, corners.shape[1] - 2
    wide = columns + 1
    n, middles = 0, 0
    ring = np.empty(2 * (rows + columns) + 8, np.int64)
    for k in range(len(patch)):
        j0, i0, j1, i1 = patch[k]
        is_top = k < tops
        mark = above if is_top else below
        m = 0
        # The patch's outline at the points that the lattice keeps, anticlockwise seen from above.
        for side in range(4):
            length = i1 - i0 if side % 2 == 0 else j1 - j0
            for s in range(length):
                if side == 0:
                    j, i, y, x, q = j0, i0 + s, j0, i0 + s, 0
                elif side == 1:
                    j, i, y, x, q = j0 + s, i1, j0 + s, i1 - 1, 1
                elif side == 2:
                    j, i, y, x, q = j1, i1 - s, j1 - 1, i1 - s - 1, 2
                else:
                    j, i, y, x, q = j1 - s, i0, j1 - s - 1, i0, 3
                if mark[j, i]:
                    ring[m] = _point(
                        heights, start, j * wide + i, corners[y + 1, x + 1, q] if is_top else floor
                    )
                    m += 1
        if m == 4:
            # A quadrangle is cut along the diagonal whose ends differ less in height.
            flip = (
                1
                if abs(heights[ring[0]] - heights[ring[2]])
                > abs(heights[ring[1]] - heights[ring[3]])
                else 0
            )
            if write:
                for t in range(2):
                    a, b, c = ring[flip], ring[(flip + 1 + t) % 4], ring[(flip + 2 + t) % 4]
                    triangles[n + t, 0], triangles[n + t, 1], triangles[n + t, 2] = (
                        (a, b, c) if is_top else (a, c, b)
                    )
            n += 2
            continue
        if write:
            middle = len(heights) + middles
            y, x = (j0 + j1) // 2, (i0 + i1) // 2
            single = j1 - j0 == 1 or i1 - i0 == 1
            z = floor
            if is_top:
                z = (
                    corners[y + 1, x + 1, 0]
                    if not single
                    else (
                        corners[j0 + 1, i0 + 1, 0]
                        + corners[j0 + 1, i1, 1]
                        + corners[j1, i1, 2]
                        + corners[j1, i0 + 1, 3]
                    )
                    / 4.0
                )
            if single:
                centres[middles, 0], centres[middles, 1], centres[middles, 2] = (
                    0.5 * (i0 + i1),
                    0.5 * (j0 + j1),
                    z,
                )
            else:
                centres[middles, 0], centres[middles, 1], centres[middles, 2] = x, y, z
            for s in range(m):
                a, b = ring[s], ring[(s + 1) % m]
                triangles[n + s, 0], triangles[n + s, 1], triangles[n + s, 2] = (
                    (middle, a, b) if is_top else (middle, b, a)
                )
        middles += 1
        n += m
    # Walls from each kept corner along its row and its column to the next kept one.
    for j in range(rows + 1):
        for i in range(columns + 1):
            if not above[j, i]:
                continue
            own = corners[j + 1, i + 1]
            if along[j, i]:
                e = i + 1
                while not above[j, e]:
                    e += 1
                n = _wall(
                    heights,
                    start,
                    j * wide + e,
                    corners[j, e, 2],
                    corners[j + 1, e, 1],
                    j * wide + i,
                    corners[j, i + 1, 3],
                    own[0],
                    triangles,
                    n,
                    write,
                )
            if across[j, i]:
                e = j + 1
                while not above[e, i]:
                    e += 1
                n = _wall(
                    heights,
                    start,
                    j * wide + i,
                    corners[j + 1, i, 1],
                    own[0],
                    e * wide + i,
                    corners[e, i, 2],
                    corners[e, i + 1, 3],
                    triangles,
                    n,
                    write,
                )
    return n, middles


@njit(cache=True, nogil=True)
def mesh_zmap(
    top: Floats, low_x: float, low_y: float, floor: float, pitch: float, bound: float
) -> tuple[Floats, Ints]:
    """Return points (v, 3) mm and triangles (t, 3), anticlockwise from outside, of the solid between a
    field of heights and its floor.

    top (rows, columns); low_x, low_y the field's corner; cells as high as the floor are empty.
    `bound`: how far (mm) a patch may be from the corners it leaves out.
    """
    rows, columns = top.shape
    corners = corner_heights(top, floor, pitch)
    patch, tops, _ = patches(top, floor, corners, bound)
    above, below, along, across = _needed(floor, corners, patch, tops)
    heights, start = _slots(floor, corners, above, below)
    n, middles = _faces(
        floor,
        corners,
        patch,
        tops,
        above,
        below,
        along,
        across,
        heights,
        start,
        np.empty((0, 3)),
        np.empty((0, 3), np.int64),
        False,
    )
    triangles, centres = np.empty((n, 3), np.int64), np.empty((middles, 3))
    _faces(
        floor,
        corners,
        patch,
        tops,
        above,
        below,
        along,
        across,
        heights,
        start,
        centres,
        triangles,
        True,
    )
    points = np.empty((len(heights) + middles, 3))
    for corner in range((rows + 1) * (columns + 1)):
        for k in range(start[corner], start[corner + 1]):
            points[k, 0] = low_x + (corner % (columns + 1)) * pitch
            points[k, 1] = low_y + (corner // (columns + 1)) * pitch
            points[k, 2] = heights[k]
    for k in range(middles):
        points[len(heights) + k, 0] = low_x + centres[k, 0] * pitch
        points[len(heights) + k, 1] = low_y + centres[k, 1] * pitch
        points[len(heights) + k, 2] = centres[k, 2]
    return points, triangles
