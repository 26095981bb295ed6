"""How a tool gets out of a gap and back while the table turns: as fast as its axis may, from rest to rest.

t = L / v + v / a  where L >= v^2 / a,  else 2 sqrt(L / a)
"""

from __future__ import annotations

import math

import numpy as np

from trunnion.geometry.arrays import Floats


def travel_time(length: float, speed: float, acceleration: float) -> float:
    """Return the time in s for a length (mm) from rest to rest, with a highest speed (mm/s) and an acceleration (mm/s2).

    >>> travel_time(10.0, 100.0, 1000.0), travel_time(4.0, 1000.0, 100.0)
    (0.2, 0.4)
    """
    if length >= speed**2 / acceleration:
        return length / speed + speed / acceleration
    return 2.0 * math.sqrt(length / acceleration)


def travelled(times: Floats, length: float, speed: float, acceleration: float) -> Floats:
    """Return how far (mm) a length from rest to rest is gone after times (s), which lie within what it takes."""
    whole = travel_time(length, speed, acceleration)
    most = min(speed, math.sqrt(length * acceleration))
    rising = most / acceleration
    late = whole - times
    even = 0.5 * most * rising + most * (times - rising)
    return np.where(
        times < rising,
        0.5 * acceleration * times**2,
        np.where(late < rising, length - 0.5 * acceleration * late**2, even),
    )
