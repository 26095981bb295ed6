"""Points of the plane that are one point within a tolerance: the plain loop; `point_groups_compiled.py` has the same compiled. mm."""

from __future__ import annotations

import numpy as np

from trunnion.geometry.arrays import Floats, Ints


def first_of_group(points: Floats, close: float) -> Ints:
    """Return for each point (n, 2) the first one that it is one with (n,): that is within `close` of it in x and in y, and is one with none
    before itself."""
    first = np.arange(len(points))
    free = first.copy()
    while len(free):
        near = np.abs(points[free] - points[free[0]]).max(axis=1) <= close
        first[free[near]] = free[0]
        free = free[~near]
    return first
