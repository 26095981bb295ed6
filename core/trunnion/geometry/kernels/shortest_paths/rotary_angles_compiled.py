"""The dynamic programme of `kernels.shortest_paths.rotary_angles` compiled; same arguments and answers."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Bools, Floats

TURN = 2.0 * math.pi


@njit(cache=True, nogil=True)
def _nearest_congruent(angle: float, before: float, low: float, high: float, slack: float) -> float:
    """Return the angle congruent to `angle` modulo a full turn (rad) that is nearest to the one before
    and inside the limits within slack; infinity where none is."""
    turns = round((before - angle) / TURN)
    least, most = math.ceil((low - slack - angle) / TURN), math.floor((high + slack - angle) / TURN)
    if least > most:
        return math.inf
    return angle + TURN * min(max(turns, least), most)


@njit(cache=True, nogil=True)
def choose_angles(
    angles: Floats,
    free: Bools,
    through: Bools,
    low: Floats,
    high: Floats,
    slack: float,
    start: Floats,
    result: Floats,
) -> tuple[int, float]:
    """Fill result (m, a) with rotary angles (rad); return how many poses could be followed and how far
    (rad) the axes turned; see `kernels.shortest_paths.rotary_angles.choose_angles`."""
    m, solutions, axes = angles.shape
    unwound = np.zeros((m, solutions, axes))
    cost = np.full((m, solutions), math.inf)
    origin = np.zeros((m, solutions), np.int8)
    there = np.zeros(axes)
    # cost[k, way]: least turning to reach pose k by a solution; infinite: not at all. The first
    # pose has no predecessor but the start.
    for k in range(m):
        for solution in range(solutions):
            for other in range(solutions):
                if (k == 0 and other != solution) or (
                    k > 0
                    and (cost[k - 1, other] == math.inf or (solution != other and not through[k]))
                ):
                    continue
                spent = cost[k - 1, other] if k else 0.0
                for a in range(axes):
                    before = unwound[k - 1, other, a] if k else start[a]
                    there[a] = (
                        before
                        if free[k, solution, a]
                        else _nearest_congruent(
                            angles[k, solution, a], before, low[a], high[a], slack
                        )
                    )
                    turn = abs(there[a] - before)
                    # Beyond half a turn the machine would swing the tool round between two
                    # neighbouring poses.
                    spent += math.inf if k > 0 and turn > math.pi + slack else turn
                if spent < cost[k, solution]:
                    cost[k, solution], origin[k, solution] = spent, other
                    unwound[k, solution] = there
        if min(cost[k, 0], cost[k, 1]) == math.inf:
            return k, math.inf
    if m == 0:
        return 0, 0.0
    # Trace back from the cheaper end.
    last = 0 if cost[m - 1, 0] <= cost[m - 1, 1] else 1
    spent = cost[m - 1, last]
    for k in range(m - 1, -1, -1):
        result[k] = unwound[k, last]
        last = origin[k, last]
    return m, spent
