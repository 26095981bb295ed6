"""Where a planning stock was looked at while a path was made: what is elsewhere the path does not depend on."""

from __future__ import annotations

import numpy as np

from trunnion.geometry.arrays import Floats

StockBox = tuple[float, ...]
"""Least x and y and greatest x and y in mm, or nothing for all there is."""
EVERYWHERE: StockBox = ()


class StockReads:
    """The box round all places that were looked at, in the frame of the stock."""

    def __init__(self) -> None:
        self._low, self._high = np.full(2, np.inf), np.full(2, -np.inf)
        self._everywhere = False

    def add(self, low: Floats, high: Floats) -> None:
        """Take in a box: its lowest and highest corner (2,)."""
        self._low, self._high = np.minimum(self._low, low), np.maximum(self._high, high)

    def add_everything(self) -> None:
        """Take in all of the stock."""
        self._everywhere = True

    def box(self, nowhere: Floats) -> StockBox:
        """Return the box; where nothing was looked at an empty one at a position (2,)."""
        if self._everywhere:
            return EVERYWHERE
        low, high = (
            (self._low, self._high) if (self._low <= self._high).all() else (nowhere, nowhere)
        )
        return (*low.tolist(), *high.tolist())
