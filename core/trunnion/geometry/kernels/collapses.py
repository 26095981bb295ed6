"""Which points of triangles may be collapsed along short edges at once, compiled: the shortest edge of each point, and points that share no
triangle's corner.

Plain references `shortest_edges` and `apart`.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Bools, Floats, Ints


def shortest_edges(ends: Ints, size: Floats, limit: float, n_points: int) -> Ints:
    """Return the shortest of the edges (e, 2) at each of `n_points` points (n,) whose size (e,) is below a limit, of equal ones the first;
    -1 where none is."""
    found = np.full(n_points, -1)
    for row in np.argsort(size, kind="stable")[::-1]:
        if size[row] < limit:
            for point in ends[row]:
                if found[point] < 0 or (size[row], row) < (size[found[point]], found[point]):
                    found[point] = row
    return found


def apart(triangles: Ints, order: Ints, n_points: int) -> Bools:
    """Return which points, of some in an order (k,), can go together (k,): one after the other those whose triangles (t, 3) have no corner
    in common with the triangles of one that was taken before."""
    stars: dict[int, set[int]] = {}
    for triangle in triangles.tolist():
        for point in triangle:
            stars.setdefault(point, set()).update(triangle)
    taken: set[int] = set()
    goes = np.zeros(len(order), dtype=bool)
    for k, point in enumerate(order.tolist()):
        star = stars.get(point, set())
        if not star & taken:
            goes[k] = True
            taken |= star
    return goes


@njit(cache=True, nogil=True)
def shortest_edges_loop(ends, size, limit, n_points):  # type: ignore[no-untyped-def]  # pragma: no cover - compiled
    """The same as `shortest_edges`."""
    found = np.full(n_points, -1, np.int64)
    for row in range(len(ends)):
        if size[row] < limit:
            for k in range(2):
                point = ends[row, k]
                if found[point] < 0 or size[row] < size[found[point]]:
                    found[point] = row
    return found


@njit(cache=True, nogil=True)
def apart_loop(triangles, order, n_points):  # type: ignore[no-untyped-def]  # pragma: no cover - compiled
    """The same as `apart`."""
    wanted = np.zeros(n_points, np.bool_)
    for k in range(len(order)):
        wanted[order[k]] = True
    # The triangles at each wanted point, a bucket a point.
    first = np.zeros(n_points + 1, np.int64)
    for t in range(len(triangles)):
        for k in range(3):
            if wanted[triangles[t, k]]:
                first[triangles[t, k] + 1] += 1
    for p in range(n_points):
        first[p + 1] += first[p]
    at, rows = first[:-1].copy(), np.empty(first[n_points], np.int64)
    for t in range(len(triangles)):
        for k in range(3):
            p = triangles[t, k]
            if wanted[p]:
                rows[at[p]] = t
                at[p] += 1
    taken, goes = np.zeros(n_points, np.bool_), np.zeros(len(order), np.bool_)
    for k in range(len(order)):
        p, free = order[k], True
        for i in range(first[p], first[p + 1]):
            t = rows[i]
            if taken[triangles[t, 0]] or taken[triangles[t, 1]] or taken[triangles[t, 2]]:
                free = False
                break
        if free:
            goes[k] = True
            for i in range(first[p], first[p + 1]):
                for j in range(3):
                    taken[triangles[rows[i], j]] = True
    return goes
