"""Compiled loop of the proof's own machining time: speeds under limits of feed, acceleration and corners."""

from __future__ import annotations

import math

from numba import njit

from trunnion.geometry.arrays import Floats


@njit(cache=True, nogil=True)
def block_times(length: Floats, speed: Floats, turn: Floats, acceleration: float, times: Floats, top: Floats) -> None:
    """Fill `times` (n,) in s and `top` (n,) in mm/s, the greatest speed reached, for blocks of a length (n,) mm and a speed (n,) mm/s.

    turn (n,) is the cosine of the angle between a block's beginning and the end of the one before it: the tool passes a bend at the speed
    times that cosine, and stops where it turns back. Speeds change by `acceleration` mm/s2.
    """
    n = len(length)
    entry = times.copy()
    before = 0.0
    for k in range(n):
        corner = min(speed[k], speed[k - 1] if k else 0.0) * max(turn[k], 0.0)
        entry[k] = min(corner, math.sqrt(before * before + 2.0 * acceleration * (length[k - 1] if k else 0.0)))
        before = entry[k]
    after = 0.0
    for k in range(n - 1, -1, -1):
        entry[k] = min(entry[k], math.sqrt(after * after + 2.0 * acceleration * length[k]))
        v0, v1 = entry[k], after
        after = entry[k]
        if length[k] <= 0.0 or speed[k] <= 0.0:
            times[k], top[k] = 0.0, 0.0
            continue
        peak = min(speed[k], math.sqrt(0.5 * (v0 * v0 + v1 * v1) + acceleration * length[k]))
        ramps = (2.0 * peak * peak - v0 * v0 - v1 * v1) / (2.0 * acceleration)
        times[k] = (2.0 * peak - v0 - v1) / acceleration + max(length[k] - ramps, 0.0) / peak
        top[k] = peak
