"""A short tour through positions: the nearest next from each start, the best of these improved by 2-opt.

2-opt (G. A. Croes, A method for solving traveling-salesman problems, Operations Research 6, 1958) turns pieces of the tour round while that
makes it shorter. The tour is open: a tool comes from above and leaves upwards. The same positions give the same tour.
"""

from __future__ import annotations

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats, Ints
from trunnion.progress import NO_PROGRESS, Progress

MOST_STARTS = 32
"""Positions that the nearest next is tried from: more find nothing shorter that 2-opt doesn't."""
MOST_ROUNDS = 50
"""Rounds of 2-opt: it ends by itself long before, in some five."""


def short_tour(positions: Floats, progress: Progress = NO_PROGRESS) -> Ints:
    """Return the order (n,) in which positions (n, 2) are visited.

    Among equals the lower row is taken; of the two directions the one that begins nearer to the lowest x and y.
    """
    n = len(positions)
    if n < 2:
        return np.arange(n)
    corner = positions.min(axis=0)
    far = np.linalg.norm(positions[:, None] - positions[None], axis=2)
    from_corner = np.linalg.norm(positions - corner, axis=1)
    starts = np.argsort(from_corner, kind="stable")[:MOST_STARTS]
    tours = [_nearest_next(far, int(start)) for start in progress.each(starts)]
    best = min(tours, key=lambda t: round(_length(far, t), 6))
    best = _turned_round(far, best, progress)
    return best if from_corner[best[0]] <= from_corner[best[-1]] else best[::-1]


def _nearest_next(far: Floats, start: int) -> Ints:
    remaining = np.ones(len(far), dtype=bool)
    order = [start]
    remaining[start] = False
    while remaining.any():
        away = np.where(remaining, far[order[-1]], np.inf)
        order.append(int(np.argmin(away)))
        remaining[order[-1]] = False
    return np.array(order)


def _turned_round(far: Floats, tour: Ints, progress: Progress) -> Ints:
    """Return the tour after pieces of it were turned round as long as that makes it shorter."""
    n = len(tour)
    for _ in progress.each(range(MOST_ROUNDS)):
        shorter = False
        for i in range(n - 1):
            # The piece i..j is turned: its ends change neighbours; an open tour has none at its own ends.
            j = np.arange(i + 1, n)
            before = far[tour[i - 1], tour[i]] if i else 0.0
            joined = far[tour[i - 1], tour[j]] if i else np.zeros(len(j))
            after = np.append(far[tour[j[:-1]], tour[j[:-1] + 1]], 0.0)
            rejoined = np.append(far[tour[i], tour[j[:-1] + 1]], 0.0)
            gain = before + after - joined - rejoined
            k = int(np.argmax(gain))
            if gain[k] > tolerance.COINCIDENT:
                tour[i : j[k] + 1] = tour[i : j[k] + 1][::-1].copy()
                shorter = True
        if not shorter:
            break
    return tour


def _length(far: Floats, tour: Ints) -> float:
    return float(far[tour[:-1], tour[1:]].sum())
