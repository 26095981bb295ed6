"""The dynamic programme of `kernels.shortest_paths.least_cost_path` compiled: same arguments and, to the last digit, the same
answer.

Total costs are kept for two rows only; predecessors (int16, so at most 32767 columns) and leaps for
all.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Bools, Floats, Ints


@njit(cache=True, nogil=True)
def least_cost_path(cost: Floats, near: Ints, turn: Floats, leap: float) -> tuple[Ints, Bools]:
    """Return the chosen column of each row (k,), -1 where there is none, and whether the row is
    reached by a leap (k,); see `kernels.shortest_paths.least_cost_path`."""
    k, m = cost.shape
    back, leapt = np.full((k, m), -1, np.int16), np.zeros((k, m), np.bool_)
    before, total = np.full(m, np.inf), np.full(m, np.inf)
    ends = np.full(k, -1, np.int64)
    for row in range(k):
        # The cheapest end so far: where a leap would come from. Infinite: the path begins anew at
        # this row.
        best = 0
        for column in range(m):
            if before[column] < before[best]:
                best = column
        fresh = not np.isfinite(before[best])
        for column in range(m):
            total[column] = np.inf
            if not np.isfinite(cost[row, column]):
                continue
            if fresh:
                total[column] = cost[row, column]
                continue
            # Bellman's recursion: a leap first, then the near columns, which are listed before any
            # -1.
            least, source, jumped = before[best] + leap, best, True
            for q in range(near.shape[1]):
                neighbour = near[column, q]
                if neighbour < 0:
                    break
                price = before[neighbour] + turn[column, q]
                if price < least or (jumped and price == least):
                    least, source, jumped = price, neighbour, False
            total[column], back[row, column], leapt[row, column] = (
                cost[row, column] + least,
                source,
                jumped,
            )
        # Where a path would end if the next row has nothing to choose.
        last = 0
        for column in range(m):
            if total[column] < total[last]:
                last = column
        ends[row] = last if np.isfinite(total[last]) else -1
        before, total = total, before
    # Trace back from the cheapest end of each run of rows.
    columns, leaps = np.full(k, -1, np.int64), np.zeros(k, np.bool_)
    following = -1
    for row in range(k - 1, -1, -1):
        column = following if following >= 0 else ends[row]
        if column < 0:
            following = -1
            continue
        columns[row], leaps[row], following = column, leapt[row, column], back[row, column]
    return columns, leaps
