"""Least-cost path through a table, one column a row: dynamic programming over a trellis (Viterbi,
1967; Bellman, 1957). Plain reference.

Rows are positions along a path in order, columns what may be chosen there (tool axes, for one).
From row to row the choice moves to a column that is listed as near, at the cost of that turn, or
leaps to any other at a constant extra cost. An infinite cost forbids a choice. A row that has
nothing to choose ends the path; a new one begins behind it.
"""

from __future__ import annotations

import numpy as np

from trunnion.geometry.arrays import Bools, Floats, Ints


def least_cost_path(cost: Floats, near: Ints, turn: Floats, leap: float) -> tuple[Ints, Bools]:
    """Return the chosen column of each row (k,), -1 where there is none, and whether the row is
    reached by a leap (k,).

    cost (k, m) of each choice; near (m, q) the columns that each may be reached from, -1 for none,
    and turn (m, q) what that costs; leap: what any other costs. All costs in one unit. Of equal
    ones the first is taken; a near column is preferred to a leap.
    """
    k, m = cost.shape
    total, back, leapt = np.full((k, m), np.inf), np.full((k, m), -1), np.zeros((k, m), bool)
    for row in range(k):
        # Bellman's recursion: total[row, c] = cost[row, c] + min over predecessors p of total[row -
        # 1, p] + step(p, c). The cheapest leap comes from the cheapest column of the row before.
        fresh = row == 0 or not np.isfinite(total[row - 1]).any()
        best = int(np.argmin(total[row - 1])) if not fresh else -1
        for column in range(m):
            if not np.isfinite(cost[row, column]):
                continue
            if fresh:
                total[row, column] = cost[row, column]
                continue
            least, source, jumped = total[row - 1, best] + leap, best, True
            for neighbour, angle in zip(near[column], turn[column], strict=True):
                price = total[row - 1, neighbour] + angle if neighbour >= 0 else np.inf
                if price < least or (jumped and price == least < np.inf):
                    least, source, jumped = price, int(neighbour), False
            total[row, column], back[row, column], leapt[row, column] = (
                cost[row, column] + least,
                source,
                jumped,
            )
    return trace_back(total, back, leapt)


def trace_back(total: Floats, back: Ints, leapt: Bools) -> tuple[Ints, Bools]:
    """Return the path that ends cheapest in each run of rows, traced back; arguments (k, m): total
    costs, predecessors, whether by a leap."""
    k = len(total)
    columns, leaps = np.full(k, -1), np.zeros(k, bool)
    following = -1
    for row in range(k - 1, -1, -1):
        column = following if following >= 0 else int(np.argmin(total[row]))
        if not np.isfinite(total[row, column]):
            following = -1
            continue
        columns[row], leaps[row], following = column, leapt[row, column], back[row, column]
    return columns, leaps
