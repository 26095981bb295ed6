"""Geodesic distance over triangles whose sides have lengths of any metric: fast marching (Kimmel and
Sethian, Computing geodesic paths on manifolds, 1998). Plain reference.

A stencil is a point and two others before it: (c, a, b) with the lengths |ca|, |cb| and |ab|. A
front that passes a and b as a straight line reaches c between them; where a triangle is obtuse at
c, its neighbours are unfolded into its plane until a point lies in the sector that both sides leave
free (causality requires acute stencils), and two stencils represent one. Lengths and times in one
unit: the front has speed 1.
"""

from __future__ import annotations

import heapq
import math

import numpy as np

from trunnion.geometry.arrays import Floats, Ints

UNFOLDED = 12
"""Triangles that are unfolded at most to part an obtuse corner."""


def stencils(triangles: Ints, lengths: Floats, across: Ints) -> tuple[Ints, Floats]:
    """Return stencils: points (s, 3) and lengths |ca|, |cb|, |ab| (s, 3).

    lengths (t, 3): of the sides from corner k to the next; across (t, 3): side number 3 * triangle + side beyond each side, -1: none.
    """
    points, sizes = [], []
    for t in range(len(triangles)):
        for k in range(3):
            c, a, b = (int(triangles[t, (k + j) % 3]) for j in range(3))
            ca, ab, bc = (float(lengths[t, (k + j) % 3]) for j in range(3))
            parted = (
                _split_obtuse(triangles, lengths, across, t, k)
                if ca * ca + bc * bc < ab * ab
                else None
            )
            if parted is None:
                points.append((c, a, b))
                sizes.append((ca, bc, ab))
            else:
                d, cd, ad, bd = parted
                points += [(c, a, d), (c, d, b)]
                sizes += [(ca, cd, ad), (cd, bc, bd)]
    return np.array(points, dtype=np.int64).reshape(-1, 3), np.array(sizes).reshape(-1, 3)


def _split_obtuse(
    triangles: Ints, lengths: Floats, across: Ints, t: int, k: int
) -> tuple[int, float, float, float] | None:
    """Return the point that divides an obtuse corner k, and how far it is from the corner and from
    both ends of the opposite side; None where none is found within `UNFOLDED` triangles."""
    ca, ab, bc = (float(lengths[t, (k + j) % 3]) for j in range(3))
    # In the triangle's plane: the corner at the origin, the one end of the opposite side along x,
    # the other by its two lengths.
    x = (ca * ca + bc * bc - ab * ab) / (2.0 * ca)
    first, last = (ca, 0.0), (x, math.sqrt(max(bc * bc - x * x, 0.0)))
    left, right, side = first, last, int(across[t, (k + 1) % 3])
    for _ in range(UNFOLDED):
        if side < 0:
            return None
        u, j = divmod(side, 3)
        # Seen from beyond, side j runs from right to left.
        along, rest, back = (float(lengths[u, (j + n) % 3]) for n in range(3))
        x = (along * along + back * back - rest * rest) / (2.0 * along)
        y = math.sqrt(max(back * back - x * x, 0.0))
        ex, ey = (left[0] - right[0]) / along, (left[1] - right[1]) / along
        apex = (right[0] + x * ex - y * ey, right[1] + x * ey + y * ex)
        # The free sector: directions within a right angle of both sides.
        over_first = apex[0] * first[0] + apex[1] * first[1] > 0.0
        over_last = apex[0] * last[0] + apex[1] * last[1] > 0.0
        if over_first and over_last:
            return (
                int(triangles[u, (j + 2) % 3]),
                math.hypot(*apex),
                math.dist(apex, first),
                math.dist(apex, last),
            )
        if not over_first and not over_last:
            return None
        # The free sector lies on the side of the far end that the apex does not see.
        if over_first:
            left, side = apex, int(across[u, (j + 2) % 3])
        else:
            right, side = apex, int(across[u, (j + 1) % 3])
    return None


def arrival_time(ta: float, tb: float, ca: float, cb: float, ab: float) -> tuple[float, float]:
    """Return when a front that passes a and b at times ta and tb reaches c, and from where between
    them (0: a, 1: b).

    The planar front has the slope (tb - ta) / |ab| along the side and sqrt(1 - slope^2) across it,
    so that its speed is 1; its ray to c must cross the side. Else the front runs along a side:
    Dijkstra's update.
    """
    # Both along the sides first: always possible.
    best, share = (ta + ca, 0.0) if ta + ca <= tb + cb else (tb + cb, 1.0)
    if math.isinf(ta) or math.isinf(tb) or ab <= 0.0:
        return best, share
    slope = (tb - ta) / ab
    if abs(slope) >= 1.0:
        return best, share
    rise = math.sqrt(1.0 - slope * slope)
    # c from the side ab: x along it, y beside it; the ray meets the side at `foot`.
    x = (ca * ca - cb * cb + ab * ab) / (2.0 * ab)
    y = math.sqrt(max(ca * ca - x * x, 0.0))
    foot = x - y * slope / rise
    if 0.0 <= foot <= ab:
        time = ta + slope * x + rise * y
        if time < best:
            return time, foot / ab
    return best, share


def fast_march(
    points: Ints,
    sizes: Floats,
    start: Ints,
    rows: Ints,
    time: Floats,
    foot: Floats,
    farthest: float,
) -> None:
    """Fill in times (v,) at which fronts reach points, and the feet (v, 3) from where they came, by
    stencils.

    points (s, 3), sizes (s, 3): stencils. start (v + 1,), rows: the stencils that name each point
    as a or b. `time` holds the starts, infinite elsewhere, `foot` their feet. Nothing is reached
    after `farthest`.
    """
    done = np.zeros(len(time), bool)
    heap = [(float(t), v) for v, t in enumerate(time) if t <= farthest]
    heapq.heapify(heap)
    # Dijkstra's order: a point's time is final when it is the least of all that wait. Outdated
    # entries of the heap are dropped.
    while heap:
        t, v = heapq.heappop(heap)
        if done[v] or t > time[v]:
            continue
        done[v] = True
        for s in rows[start[v] : start[v + 1]]:
            c, a, b = points[s]
            if done[c]:
                continue
            ta, tb = (time[p] if done[p] else math.inf for p in (a, b))
            new, share = arrival_time(ta, tb, *sizes[s])
            if new < time[c] and new <= farthest:
                time[c] = new
                foot[c] = (
                    foot[a]
                    if share == 0.0
                    else foot[b]
                    if share == 1.0
                    else (1.0 - share) * foot[a] + share * foot[b]
                )
                heapq.heappush(heap, (new, int(c)))


def chain_loop(follows: Ints, order: Ints, start: Ints, closed: Ints) -> int:
    """Return how many chains there are of nodes that each name the one that follows, -1 for none:
    follows (n,); see `geometry.contours`.

    order gets the nodes chain by chain, start[c + 1] where chain c ends, closed (c,) which are
    loops; a loop's first node is repeated at its end. Open chains first, each from its first node,
    then loops from their lowest node.
    """
    used, count, at = np.zeros(len(follows), bool), 0, 0
    first_of = np.ones(len(follows), bool)
    first_of[follows[follows >= 0]] = False
    for first in [*np.flatnonzero(first_of), *np.flatnonzero(~first_of)]:
        if used[first]:
            continue
        node = first
        while node >= 0 and not used[node]:
            used[node] = True
            order[at], node, at = node, follows[node], at + 1
        closed[count] = node == first
        if node == first:
            order[at], at = first, at + 1
        count += 1
        start[count] = at
    return count
