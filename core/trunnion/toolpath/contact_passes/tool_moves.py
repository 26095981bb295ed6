"""Moves of a tool that are straight for the tip and even for the axis: how far they go, and poses along them."""

from __future__ import annotations

import numpy as np

from trunnion.geometry.arrays import Floats, Ints, items_of
from trunnion.geometry.sphere import angle_between
from trunnion.toolpath.contact_passes.contacts import slerp


class ToolMoves:
    """Straight ways of tips (k, 3) whose axes (k, 3) turn evenly: how far they `travel`, mm, and `turn`, rad (k,)."""

    def __init__(self, start_tip: Floats, start_axis: Floats, tip: Floats, axis: Floats) -> None:
        self._ends = (start_tip, start_axis, tip, axis)
        self.travel = np.linalg.norm(tip - start_tip, axis=1)
        self.turn = angle_between(start_axis, axis)

    def of(self, rows: Ints) -> ToolMoves:
        """Return some of the moves."""
        return ToolMoves(*(v[rows] for v in self._ends))

    def poses(self, pieces: Floats) -> tuple[Ints, Floats, Floats]:
        """Return the poses that part each way in so many equal pieces (k,), its ends among them: its number (p,), tips and axes (p, 3)."""
        way, share = self.shares(pieces)
        return way, *self.at(way, share)

    def shares(self, pieces: Floats) -> tuple[Ints, Floats]:
        """Return where `poses` are: the number (p,) of the way of each, and its share (p,) of that."""
        count = np.maximum(pieces, 1.0).astype(np.int64)
        way, number = items_of(count + 1)
        return way, number / count[way]

    def middles(self, pieces: Floats) -> tuple[Ints, Floats, Floats]:
        """Return the poses in the middles of so many equal pieces (k,) of each way: its number (p,), tips and axes (p, 3)."""
        count = np.maximum(pieces, 1.0).astype(np.int64)
        way, number = items_of(count)
        return way, *self.at(way, (number + 0.5) / count[way])

    def at(self, way: Ints, share: Floats) -> tuple[Floats, Floats]:
        """Return tips and axes (p, 3) at shares (p,) of ways by their numbers (p,)."""
        start_tip, start_axis, tip, axis = (v[way] for v in self._ends)
        tips = start_tip + share[:, None] * (tip - start_tip)
        return tips, slerp(start_axis, axis, share)
