"""Rotary axis angles along a whole sequence of poses: least total turning within the limits, by
dynamic programming. Plain reference.

The inverse kinematics of a five-axis machine have two solutions for a tool axis, each repeated
every full turn of an axis. Where the tool lies along an axis that axis is free: it stays. From one
solution to the other the machine can pass only through the pole (singularity), where both are the
same. Two states a pose, so the dynamic programme (Bellman, 1957) is exact over the two solutions;
of the turns of an angle the nearest is taken.
"""

from __future__ import annotations

import math

import numpy as np

from trunnion.geometry.arrays import Bools, Floats

TURN = 2.0 * math.pi


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
    """Fill result (m, a) with rotary angles in rad; return how many poses could be followed and how
    far (rad) the axes turned in all.

    angles (m, 2, a): both solutions of each pose, rad; free (m, 2, a): that axis may stand
    anywhere; through (m,): the pole lies on the path to that pose. low, high (a,) are the limits,
    passed by at most `slack`; the first pose is reached from `start` (a,) by any turn, each other
    by half a turn at most. Where a pose can be followed by neither solution it ends, and `result`
    is left as it was.
    """
    m, _, axes = angles.shape
    unwound: list[list[list[float] | None]] = []
    cost: list[list[float]] = []
    origin: list[list[int]] = []
    for k in range(m):
        unwound.append([None, None])
        cost.append([math.inf, math.inf])
        origin.append([0, 0])
        # cost[k][way]: least turning to reach pose k by a solution, over both of the pose before.
        for solution in range(2):
            for other in range(2) if k else (solution,):
                before = unwound[k - 1][other] if k else [float(s) for s in start]
                if before is None or (k and solution != other and not through[k]):
                    continue
                there = [
                    before[a]
                    if free[k, solution, a]
                    else nearest_congruent(
                        angles[k, solution, a], before[a], low[a], high[a], slack
                    )
                    for a in range(axes)
                ]
                turns = [abs(t - b) for t, b in zip(there, before, strict=True)]
                if not all(math.isfinite(t) for t in turns) or (k and max(turns) > math.pi + slack):
                    continue
                spent = (cost[k - 1][other] if k else 0.0) + sum(turns)
                if spent < cost[k][solution]:
                    unwound[k][solution], cost[k][solution], origin[k][solution] = (
                        there,
                        spent,
                        other,
                    )
        if unwound[k] == [None, None]:
            return k, math.inf
    if not m:
        return 0, 0.0
    # Trace back from the cheaper end.
    solution = int(np.argmin(cost[-1]))
    spent = cost[-1][solution]
    for k in reversed(range(m)):
        result[k] = unwound[k][solution]
        solution = origin[k][solution]
    return m, spent


def nearest_congruent(angle: float, before: float, low: float, high: float, slack: float) -> float:
    """Return the angle congruent to `angle` modulo a full turn that is nearest to the one before and
    inside the limits (rad, within slack); infinity where none is."""
    middle = round((before - angle) / TURN)
    least, most = math.ceil((low - slack - angle) / TURN), math.floor((high + slack - angle) / TURN)
    inside = [angle + TURN * n for n in (middle, least, most) if least <= n <= most]
    return min(inside, key=lambda t: abs(t - before)) if inside else math.inf
