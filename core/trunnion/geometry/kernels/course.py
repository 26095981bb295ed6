"""The cheapest course through a table: one column of each row, from row to row to a column that is near, or by a leap that costs extra.

Dynamic programming (Viterbi). Rows are places along a way, columns what may be chosen there; a cost of infinity forbids a choice. A row
that has nothing to choose ends the course; a new one begins behind it.
"""

from __future__ import annotations

import numpy as np

from trunnion.geometry.arrays import Bools, Floats, Ints


def course(cost: Floats, near: Ints, turn: Floats, leap: float) -> tuple[Ints, Bools]:
    """Return the chosen column of each row (k,), -1 where there is none, and whether the row is reached by a leap (k,).

    cost (k, m); near (m, q) the columns that each may come from, -1 for none, and turn (m, q) what that costs; leap: what any other costs.
    Of equal ones the first is taken; a near column goes before a leap.
    """
    k, m = cost.shape
    total, back, leapt = np.full((k, m), np.inf), np.full((k, m), -1), np.zeros((k, m), bool)
    for row in range(k):
        fresh = row == 0 or not np.isfinite(total[row - 1]).any()
        best = int(np.argmin(total[row - 1])) if not fresh else -1
        for column in range(m):
            if not np.isfinite(cost[row, column]):
                continue
            if fresh:
                total[row, column] = cost[row, column]
                continue
            least, source, jumped = total[row - 1, best] + leap, best, True
            for way, angle in zip(near[column], turn[column], strict=True):
                price = total[row - 1, way] + angle if way >= 0 else np.inf
                if price < least or (jumped and price == least < np.inf):
                    least, source, jumped = price, int(way), False
            total[row, column], back[row, column], leapt[row, column] = cost[row, column] + least, source, jumped
    return traced(total, back, leapt)


def traced(total: Floats, back: Ints, leapt: Bools) -> tuple[Ints, Bools]:
    """Return the course that ends cheapest in each run of rows, read backwards."""
    k = len(total)
    chosen, leaps = np.full(k, -1), np.zeros(k, bool)
    following = -1
    for row in range(k - 1, -1, -1):
        column = following if following >= 0 else int(np.argmin(total[row]))
        if not np.isfinite(total[row, column]):
            following = -1
            continue
        chosen[row], leaps[row], following = column, leapt[row, column], back[row, column]
    return chosen, leaps
