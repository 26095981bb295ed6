"""Edges of triangles numbered in the order of their ends, compiled with a bucket a point in place of one long sort.

Plain reference `numbered_edges`.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Ints

FEW = 24
"""Sides of a bucket up to which they are sorted by insertion; a fan of many triangles about one point is sorted as a whole."""


def numbered_edges(triangles: Ints, n_points: int) -> tuple[Ints, Ints]:
    """Return the edges (e, 2) of triangles (t, 3) of `n_points` points, lower point first and in ascending order, and which of them the
    triangles' sides (t, 3) are."""
    start, end = triangles.ravel(), triangles[:, [1, 2, 0]].ravel()
    key, side = np.unique(
        np.minimum(start, end) * n_points + np.maximum(start, end), return_inverse=True
    )
    return np.column_stack([key // n_points, key % n_points]), side.reshape(-1, 3)


@njit(cache=True, nogil=True)
def numbered_edges_loop(triangles, n_points):  # type: ignore[no-untyped-def]  # pragma: no cover - compiled
    """The same as `numbered_edges`."""
    sides = 3 * len(triangles)
    first = np.zeros(n_points + 1, np.int64)
    for t in range(len(triangles)):
        for k in range(3):
            first[min(triangles[t, k], triangles[t, (k + 1) % 3]) + 1] += 1
    for p in range(n_points):
        first[p + 1] += first[p]
    # Sides by their lower point: `upper` their other one, `of` their rows.
    upper, of, at = np.empty(sides, np.int64), np.empty(sides, np.int64), first.copy()
    for t in range(len(triangles)):
        for k in range(3):
            a, b = triangles[t, k], triangles[t, (k + 1) % 3]
            low = min(a, b)
            upper[at[low]], of[at[low]] = max(a, b), 3 * t + k
            at[low] += 1
    ends, side, count = np.empty((sides, 2), np.int64), np.empty(sides, np.int64), 0
    for p in range(n_points):
        low, high = first[p], first[p + 1]
        if high - low > FEW:
            order = np.argsort(upper[low:high])
            upper[low:high], of[low:high] = upper[low:high][order], of[low:high][order]
        else:
            for i in range(low + 1, high):
                u, row, j = upper[i], of[i], i
                while j > low and upper[j - 1] > u:
                    upper[j], of[j] = upper[j - 1], of[j - 1]
                    j -= 1
                upper[j], of[j] = u, row
        for i in range(low, high):
            if i == low or upper[i] != upper[i - 1]:
                ends[count, 0], ends[count, 1] = p, upper[i]
                count += 1
            side[of[i]] = count - 1
    return ends[:count].copy(), side.reshape(-1, 3)
