"""How high a cutter's tip is lifted over tabs: to their top beside them, and by ramps up to it and down from it.

The lowest tip is a function of the position in plan alone: with d the distance from a tab's bridge and r the cutter's radius it is the
tab's top less (d - r) tan(ramp), no more than its top. So a path of any form rises before a tab and comes down after it, no steeper than
the ramp, and no flat end comes into the bridge below its top.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.model.tabs import Tab

SPACING = 0.25
"""mm between the positions of a move that are looked at for where it begins to rise; those are then found to `tolerance.SHORT_MOVE`."""


class TabLift:
    """The lowest tips of a cutter of a radius (mm) over tabs."""

    def __init__(self, tabs: Sequence[Tab], radius: float) -> None:
        self._tabs = tuple(tabs)
        self._radius = radius
        self._top = max((t.top for t in tabs), default=-math.inf)

    def lowest(self, points: Floats) -> Floats:
        """Return the lowest tip (k,) at positions (k, 2), mm; -inf without tabs."""
        heights = [t.top - self._beyond(t, points) * math.tan(t.ramp) for t in self._tabs]
        return np.max(heights, axis=0) if heights else np.full(len(points), -math.inf)

    def breaks(
        self, position: Callable[[Floats], Floats], length: float, lowest: float
    ) -> Floats | None:
        """Return the shares (m,) of a move, ascending and ending with 1, between which its lifted tip rises evenly; None where no tab is.

        `position` returns the tips (k, 3) of the move that is wanted at shares (k,) of it, `length` is its length in mm, and `lowest` the
        lowest of its heights.
        """
        if lowest >= self._top - tolerance.COINCIDENT:
            return None
        share = np.linspace(0.0, 1.0, max(2, math.ceil(length / SPACING) + 1))
        signs = self._signs(position(share))
        if not (signs[0] > 0.0).any():
            return None
        found = [np.array([1.0])]
        for k, row in enumerate(signs):
            changes = np.flatnonzero((row[1:] > 0.0) != (row[:-1] > 0.0))
            low, high, starts_above = share[changes], share[changes + 1], row[changes] > 0.0
            while len(low) and float((high - low).max()) * length > tolerance.SHORT_MOVE:
                middle = 0.5 * (low + high)
                same = (self._signs(position(middle))[k] > 0.0) == starts_above
                low, high = np.where(same, middle, low), np.where(same, high, middle)
            # The end that is outside: a tip is at the top before it comes beside the bridge, and as long as it is.
            found.append(np.where(starts_above, high, low))
        every = np.unique(np.concatenate(found))
        return every[every > 0.0]

    def _signs(self, tips: Floats) -> Floats:
        """Return functions of tips (k, 3) as rows, positive: where the tip is to be lifted, and where it is beside each tab."""
        lifted = self.lowest(tips[:, :2]) - tips[:, 2] - tolerance.COINCIDENT
        return np.array([lifted, *(self._radius - t.distance(tips[:, :2]) for t in self._tabs)])

    def _beyond(self, tab: Tab, points: Floats) -> Floats:
        return np.maximum(tab.distance(points) - self._radius, 0.0)
