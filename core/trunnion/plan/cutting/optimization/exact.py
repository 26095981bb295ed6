"""The exact search: along spindle speed, and at each speed between the smallest and the largest feed that keeps the constraints.

The largest feed is known in closed form (`CuttingProblem.largest_feed`), so every point that is looked at keeps all constraints, and an
optimum on one of them is met and not only come near to. The grid is drawn together around its best point until it is finer than any
control.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.plan.cutting.optimization.problem import (
    CuttingProblem,
    Optimum,
    optimum_at,
    weighted,
)

FIRST, SPEEDS, FEEDS = 129, 17, 9
"""Points of the grid along speed, at first and later, and along feed: the first one sees every kink of a spindle's power curve."""
ROUNDS = 9
"""Grids that are looked at: from a range of 100 to 1 the last one's points are some 1e-6 apart."""
KEPT = 2.0
"""Cells around the best point that the next grid covers, on either side."""

Value = Callable[[Floats, Floats], Floats]


def solve_exactly(problem: CuttingProblem, weight: float) -> Optimum | None:
    """Return the optimum of the weighted objective; None where no point keeps the constraints."""
    quickest = _best(problem, problem.time)
    if quickest is None:
        return None
    cheapest = _best(problem, problem.cost)
    assert cheapest is not None
    least_time = float(problem.time(*quickest))
    least_cost = float(problem.cost(*cheapest))
    if quickest == cheapest:
        return optimum_at(problem, *quickest, least_time, least_cost, weight)

    def value(spindle: Floats, feed: Floats) -> Floats:
        return weighted(
            problem.time(spindle, feed),
            problem.cost(spindle, feed),
            least_time,
            least_cost,
            weight,
        )

    best = _best(problem, value)
    assert best is not None
    return optimum_at(problem, *best, least_time, least_cost, weight)


def _best(problem: CuttingProblem, value: Value) -> tuple[float, float] | None:
    """Return the feasible point (spindle, feed per tooth) of the least value; None where there is none."""
    low, high = np.log(problem.spindle)
    bottom, top = 0.0, 1.0
    best: tuple[float, float, float] | None = None
    for count in (FIRST, *(ROUNDS - 1) * (SPEEDS,)):
        speeds = np.linspace(low, high, count)
        steps = np.linspace(bottom, top, FEEDS)
        spindle = np.clip(np.exp(speeds), *problem.spindle)
        kept = np.isfinite(problem.largest_feed(spindle))
        if not kept.any():
            return None
        grid = np.repeat(spindle, FEEDS)
        feed = problem.feed_between(grid, np.tile(steps, count))
        found = np.where(kept[:, None], value(grid, feed).reshape(count, FEEDS), np.inf)
        # Of equal values the first counts: the result is the same on every run.
        row, column = np.unravel_index(int(np.argmin(found)), found.shape)
        if best is None or found[row, column] < best[0]:
            at = row * FEEDS + column
            best = float(found[row, column]), float(grid[at]), float(feed[at])
        reach, width = KEPT * (high - low) / (count - 1), KEPT * (top - bottom) / (FEEDS - 1)
        low, high = max(speeds[row] - reach, low), min(speeds[row] + reach, high)
        bottom, top = max(steps[column] - width, 0.0), min(steps[column] + width, 1.0)
    return None if best is None else (best[1], best[2])
