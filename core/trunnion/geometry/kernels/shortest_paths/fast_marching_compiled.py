"""The loops of `kernels.shortest_paths.fast_marching` compiled, with an indexed binary heap.

The heap holds each waiting point once and knows its position, so a lowered time moves the entry up
instead of adding another. Equal times are ordered by the point's row: the same result every time.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.kernels.shortest_paths.fast_marching import UNFOLDED


@njit(cache=True, nogil=True)
def stencils(triangles: Ints, lengths: Floats, across: Ints) -> tuple[Ints, Floats]:
    """Return stencils: points (s, 3) and lengths |ca|, |cb|, |ab| (s, 3); see
    `kernels.shortest_paths.fast_marching.stencils`."""
    points, sizes, n = (
        np.empty((6 * len(triangles), 3), np.int64),
        np.empty((6 * len(triangles), 3)),
        0,
    )
    for t in range(len(triangles)):
        for k in range(3):
            c, a, b = triangles[t, k], triangles[t, (k + 1) % 3], triangles[t, (k + 2) % 3]
            ca, ab, bc = lengths[t, k], lengths[t, (k + 1) % 3], lengths[t, (k + 2) % 3]
            d, cd, ad, bd = -1, 0.0, 0.0, 0.0
            # Obtuse at c, by the law of cosines: two stencils on both sides of the unfolded point.
            if ca * ca + bc * bc < ab * ab:
                d, cd, ad, bd = _split_obtuse(triangles, lengths, across, t, k)
            if d < 0:
                points[n, 0], points[n, 1], points[n, 2] = c, a, b
                sizes[n, 0], sizes[n, 1], sizes[n, 2] = ca, bc, ab
                n += 1
            else:
                points[n, 0], points[n, 1], points[n, 2] = c, a, d
                sizes[n, 0], sizes[n, 1], sizes[n, 2] = ca, cd, ad
                points[n + 1, 0], points[n + 1, 1], points[n + 1, 2] = c, d, b
                sizes[n + 1, 0], sizes[n + 1, 1], sizes[n + 1, 2] = cd, bc, bd
                n += 2
    return points[:n], sizes[:n]


@njit(cache=True, nogil=True)
def _split_obtuse(
    triangles: Ints, lengths: Floats, across: Ints, t: int, k: int
) -> tuple[int, float, float, float]:
    """Return the point that divides an obtuse corner k, and its distances from the corner and from
    both ends of the opposite side; -1 where there is none. See `kernels.shortest_paths.fast_marching._split_obtuse`."""
    ca, ab, bc = lengths[t, k], lengths[t, (k + 1) % 3], lengths[t, (k + 2) % 3]
    bx = (ca * ca + bc * bc - ab * ab) / (2.0 * ca)
    by = math.sqrt(max(bc * bc - bx * bx, 0.0))
    lx, ly, rx, ry, side = ca, 0.0, bx, by, across[t, (k + 1) % 3]
    # Invariant: (lx, ly) and (rx, ry) are the ends of the side through which the free sector leaves
    # the unfolded triangles.
    for _ in range(UNFOLDED):
        if side < 0:
            break
        u, j = side // 3, side % 3
        along, rest, back = lengths[u, j], lengths[u, (j + 1) % 3], lengths[u, (j + 2) % 3]
        x = (along * along + back * back - rest * rest) / (2.0 * along)
        y = math.sqrt(max(back * back - x * x, 0.0))
        ex, ey = (lx - rx) / along, (ly - ry) / along
        px, py = rx + x * ex - y * ey, ry + x * ey + y * ex
        # Both dot products positive: within a right angle of both sides.
        over_first, over_last = px * ca > 0.0, px * bx + py * by > 0.0
        if over_first and over_last:
            return (
                triangles[u, (j + 2) % 3],
                math.hypot(px, py),
                math.hypot(px - ca, py),
                math.hypot(px - bx, py - by),
            )
        if over_first:
            lx, ly, side = px, py, across[u, (j + 2) % 3]
        elif over_last:
            rx, ry, side = px, py, across[u, (j + 1) % 3]
        else:
            break
    return -1, 0.0, 0.0, 0.0


@njit(cache=True, nogil=True, inline="always")
def arrival_time(ta: float, tb: float, ca: float, cb: float, ab: float) -> tuple[float, float]:
    """Return when a planar front through a and b, at times ta and tb, reaches c, and from where
    between them; see `kernels.shortest_paths.fast_marching.arrival_time`."""
    best, share = ta + ca, 0.0
    if tb + cb < best:
        best, share = tb + cb, 1.0
    if math.isinf(ta) or math.isinf(tb) or ab <= 0.0:
        return best, share
    slope = (tb - ta) / ab
    if abs(slope) >= 1.0:
        return best, share
    # Slope of the front along the side ab and across it; beyond 1 no front of speed 1 passes both.
    rise = math.sqrt(1.0 - slope * slope)
    x = (ca * ca - cb * cb + ab * ab) / (2.0 * ab)
    y = math.sqrt(max(ca * ca - x * x, 0.0))
    foot = x - y * slope / rise
    if 0.0 <= foot <= ab:
        time = ta + slope * x + rise * y
        if time < best:
            return time, foot / ab
    return best, share


@njit(cache=True, nogil=True)
def fast_march(
    points: Ints,
    sizes: Floats,
    start: Ints,
    rows: Ints,
    time: Floats,
    foot: Floats,
    farthest: float,
) -> None:
    """Fill in times (v,) at which fronts reach points, and the feet (v, 3) from where they came; see
    `kernels.shortest_paths.fast_marching.fast_march`."""
    n = len(time)
    done, heap_index, heap, size = (
        np.zeros(n, np.bool_),
        np.full(n, -1, np.int64),
        np.empty(n, np.int64),
        0,
    )
    for v in range(n):
        if time[v] <= farthest:
            heap_index[v], heap[size] = size, v
            size += 1
            _sift_up(heap, heap_index, time, heap_index[v])
    # The least of all waiting times is final (Dijkstra's invariant); the points beyond it are
    # updated from final ones only.
    while size > 0:
        v = heap[0]
        size -= 1
        heap[0] = heap[size]
        heap_index[heap[0]] = 0
        _sift_down(heap, heap_index, time, 0, size)
        done[v] = True
        for r in range(start[v], start[v + 1]):
            s = rows[r]
            c, a, b = points[s, 0], points[s, 1], points[s, 2]
            if done[c]:
                continue
            new, share = arrival_time(
                time[a] if done[a] else math.inf,
                time[b] if done[b] else math.inf,
                sizes[s, 0],
                sizes[s, 1],
                sizes[s, 2],
            )
            if new < time[c] and new <= farthest:
                time[c] = new
                for k in range(3):
                    near = foot[a, k] if share < 1.0 else foot[b, k]
                    foot[c, k] = (
                        near if share == 0.0 or share == 1.0 else near + share * (foot[b, k] - near)
                    )
                if heap_index[c] < 0:
                    heap_index[c], heap[size] = size, c
                    size += 1
                _sift_up(heap, heap_index, time, heap_index[c])


@njit(cache=True, nogil=True)
def _sift_up(heap: Ints, heap_index: Ints, time: Floats, at: int) -> None:
    """Move the entry `at` up the heap while it is before its parent; heap_index (v,) is where each point
    stands."""
    v = heap[at]
    while at > 0:
        above = (at - 1) // 2
        if not _before(time, v, heap[above]):
            break
        heap[at] = heap[above]
        heap_index[heap[at]] = at
        at = above
    heap[at] = v
    heap_index[v] = at


@njit(cache=True, nogil=True)
def _sift_down(heap: Ints, heap_index: Ints, time: Floats, at: int, size: int) -> None:
    """Move the entry `at` down the heap of `size` while a child is before it."""
    if size == 0:
        return
    v = heap[at]
    while 2 * at + 1 < size:
        below = 2 * at + 1
        if below + 1 < size and _before(time, heap[below + 1], heap[below]):
            below += 1
        if not _before(time, heap[below], v):
            break
        heap[at] = heap[below]
        heap_index[heap[at]] = at
        at = below
    heap[at] = v
    heap_index[v] = at


@njit(cache=True, nogil=True, inline="always")
def _before(time: Floats, v: int, w: int) -> bool:
    """Return whether point v comes before w: by time, of equal ones by row."""
    return time[v] < time[w] or (time[v] == time[w] and v < w)


@njit(cache=True, nogil=True)
def chain_loop(follows: Ints, order: Ints, start: Ints, closed: Bools) -> int:
    """Return how many chains there are of nodes that each name the one that follows (n,), -1 for none;
    see `kernels.shortest_paths.fast_marching.chain_loop`."""
    n = len(follows)
    used, first_of, count, at = np.zeros(n, np.bool_), np.ones(n, np.bool_), 0, 0
    for node in range(n):
        if follows[node] >= 0:
            first_of[follows[node]] = False
    # Open chains first, then loops.
    for turn in range(2):
        for first in range(n):
            if used[first] or first_of[first] != (turn == 0):
                continue
            node = first
            while node >= 0 and not used[node]:
                used[node] = True
                order[at] = node
                node = follows[node]
                at += 1
            closed[count] = node == first
            if node == first:
                order[at] = first
                at += 1
            count += 1
            start[count] = at
    return count
