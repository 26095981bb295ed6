"""Compiled loop of the rotary axes: of two ways to stand, take the nearer one, block by block."""

from __future__ import annotations

import math

from numba import njit

from trunnion.geometry.arrays import Bools, Floats

TURN = 2.0 * math.pi


@njit(cache=True, nogil=True)
def nearest(value: float, before: float, low: float, high: float) -> float:
    """Return the angle equal to `value` up to whole turns that is nearest to `before`, inside the limits when one is."""
    near = value + TURN * round((before - value) / TURN)
    if near > high:
        near -= TURN * math.ceil((near - high) / TURN)
    elif near < low:
        near += TURN * math.ceil((low - near) / TURN)
    return near


@njit(cache=True, nogil=True)
def follow(angles: Floats, free: Bools, low: Floats, high: Floats, first: int, slack: float, chosen: Floats) -> tuple[float, int]:
    """Fill `chosen` (m, a) with the rotary angles of poses, each near the one before; return the whole way turned and how many poses are
    outside the limits.

    angles (m, 2, a) rad: both ways to stand; free (m, 2, a): that axis may stand anywhere. low, high (a,); `first` is the way that the
    first pose takes; an angle is outside when it passes its limit by more than `slack`.
    """
    m, ways, axes = angles.shape
    turned, outside = 0.0, 0
    for k in range(m):
        best, best_out, best_way = math.inf, axes + 1, 0
        for way in range(ways):
            if k == 0 and way != first:
                continue
            cost, out = 0.0, 0
            for a in range(axes):
                before = chosen[k - 1, a] if k else 0.0
                angle = before if free[k, way, a] else nearest(angles[k, way, a], before, low[a], high[a])
                cost += abs(angle - before)
                out += angle < low[a] - slack or angle > high[a] + slack
            if out < best_out or (out == best_out and cost < best):
                best, best_out, best_way = cost, out, way
        for a in range(axes):
            before = chosen[k - 1, a] if k else 0.0
            chosen[k, a] = before if free[k, best_way, a] else nearest(angles[k, best_way, a], before, low[a], high[a])
        turned += best
        outside += best_out > 0
    return turned, outside
