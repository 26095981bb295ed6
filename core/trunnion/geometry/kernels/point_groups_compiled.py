"""Points of the plane that are one point within a tolerance, compiled: each looks only at those beside it in order of x.

Plain reference `point_groups.first_of_group`. mm.
"""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
def first_of_group_loop(points, order, close):  # type: ignore[no-untyped-def]  # pragma: no cover - compiled
    """The same as `first_of_group`; `order` (n,) are the points by their x."""
    n = len(points)
    rank = np.empty(n, np.int64)
    for k in range(n):
        rank[order[k]] = k
    first = np.full(n, -1)
    # Invariant: a point without a first one when its turn comes is one with none before it.
    for i in range(n):
        if first[i] >= 0:
            continue
        first[i] = i
        x, y = points[i, 0], points[i, 1]
        for step in (-1, 1):
            k = rank[i] + step
            while 0 <= k < n and abs(points[order[k], 0] - x) <= close:
                j = order[k]
                if first[j] < 0 and abs(points[j, 1] - y) <= close:
                    first[j] = i
                k += step
    return first
