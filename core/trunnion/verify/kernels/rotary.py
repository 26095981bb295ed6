"""Compiled choice of rotary axis angles along a sequence of poses: greedy, each pose next to the one
before.

The inverse kinematics of a five-axis machine have two solutions for a tool axis, each repeated
every full turn of an axis. From pose to pose the solution within the limits that turns the axes
least is taken (nearest-neighbour; the planner's `geometry/kernels/shortest_paths/rotary_angles.py` optimises over the
whole path, this one represents a control that looks one block ahead). Angles in rad.
"""

from __future__ import annotations

import math

from numba import njit

from trunnion.geometry.arrays import Bools, Floats

TURN = 2.0 * math.pi


@njit(cache=True, nogil=True)
def nearest_congruent(value: float, before: float, low: float, high: float) -> float:
    """Return the angle congruent to `value` modulo a full turn that is nearest to `before` (rad),
    shifted by whole turns into low to high where that is possible.

    Where no congruent angle lies within the limits the result lies outside of them, by less than a
    turn.
    """
    # Nearest of all, then as few whole turns as bring it back inside the limit that it passed.
    near = value + TURN * round((before - value) / TURN)
    if near > high:
        near -= TURN * math.ceil((near - high) / TURN)
    elif near < low:
        near += TURN * math.ceil((low - near) / TURN)
    return near


@njit(cache=True, nogil=True)
def choose_angles_greedy(
    angles: Floats, free: Bools, low: Floats, high: Floats, first: int, slack: float, result: Floats
) -> tuple[float, int]:
    """Fill result (m, a) with the rotary angles of m poses and return the total angle turned (rad,
    summed over axes) and the number of poses outside the limits.

    angles (m, 2, a) rad: both solutions of each pose; free (m, 2, a): that axis is arbitrary (the
    tool lies along it) and stays where it is. low, high (a,) rad; an angle counts as outside when
    it passes its limit by more than `slack`. `first`: the solution taken by the first pose, which
    starts from 0 on every axis.
    """
    m, solutions, axes = angles.shape
    turned, outside = 0.0, 0
    for k in range(m):
        # Fewest axes outside their limits first, then the least turning; of equals the first
        # solution.
        best, best_out, best_solution = math.inf, axes + 1, 0
        for solution in range(solutions):
            if k == 0 and solution != first:
                continue
            cost, out = 0.0, 0
            for a in range(axes):
                before = result[k - 1, a] if k else 0.0
                angle = (
                    before
                    if free[k, solution, a]
                    else nearest_congruent(
                        angles[k, solution, a], before, low[a] - slack, high[a] + slack
                    )
                )
                cost += abs(angle - before)
                out += angle < low[a] - slack or angle > high[a] + slack
            if out < best_out or (out == best_out and cost < best):
                best, best_out, best_solution = cost, out, solution
        for a in range(axes):
            before = result[k - 1, a] if k else 0.0
            result[k, a] = (
                before
                if free[k, best_solution, a]
                else nearest_congruent(
                    angles[k, best_solution, a], before, low[a] - slack, high[a] + slack
                )
            )
        turned += best
        outside += best_out > 0
    return turned, outside
