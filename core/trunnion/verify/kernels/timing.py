"""Compiled machining time of a block sequence: trapezoidal velocity profiles with two-pass look-ahead.

The usual look-ahead of a control with constant acceleration: a forward pass limits the entry speed
of each block by what the blocks before it can reach, a backward pass by what the blocks after it
can still stop from, both by v1^2 = v0^2 + 2 a s; within a block the speed ramps up, holds and ramps
down.
"""

from __future__ import annotations

import math

from numba import njit

from trunnion.geometry.arrays import Floats


@njit(cache=True, nogil=True)
def block_times(
    length: Floats, speed: Floats, turn: Floats, acceleration: float, times: Floats, top: Floats
) -> None:
    """Fill times (n,) in s and top (n,) in mm/s, the peak speed, for blocks of length (n,) mm at a
    programmed speed (n,) mm/s.

    turn (n,): cosine of the angle between a block's start and the end of the block before it. A
    corner is passed at the lower of both speeds times that cosine; at 90 degrees and beyond the
    axes stop. Speeds change by `acceleration` mm/s2. The sequence starts and ends at rest. A block
    without length or speed takes no time.
    """
    n = len(length)
    # Forward pass: what the corner allows and what acceleration since the last block's entry
    # reaches.
    entry = times.copy()
    before = 0.0
    for k in range(n):
        corner = min(speed[k], speed[k - 1] if k else 0.0) * max(turn[k], 0.0)
        entry[k] = min(
            corner, math.sqrt(before * before + 2.0 * acceleration * (length[k - 1] if k else 0.0))
        )
        before = entry[k]
    # Backward pass: what can still be braked within this block to the entry speed of the next.
    after = 0.0
    for k in range(n - 1, -1, -1):
        entry[k] = min(entry[k], math.sqrt(after * after + 2.0 * acceleration * length[k]))
        v0, v1 = entry[k], after
        after = entry[k]
        if length[k] <= 0.0 or speed[k] <= 0.0:
            times[k], top[k] = 0.0, 0.0
            continue
        # Triangle or trapezoid: the ramps meet at peak^2 = (v0^2 + v1^2) / 2 + a s, unless the
        # programmed speed is reached before.
        peak = min(speed[k], math.sqrt(0.5 * (v0 * v0 + v1 * v1) + acceleration * length[k]))
        ramps = (2.0 * peak * peak - v0 * v0 - v1 * v1) / (2.0 * acceleration)
        times[k] = (2.0 * peak - v0 - v1) / acceleration + max(length[k] - ramps, 0.0) / peak
        top[k] = peak
