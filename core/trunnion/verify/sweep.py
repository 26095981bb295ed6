"""The cutting moves of a setup, listed by plan cells: which of them come near a point, and how near their flutes come to it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.progress import QUIET, Progress
from trunnion.verify.contact import Grid, grid_of
from trunnion.verify.kernels import left as kernel
from trunnion.verify.kernels import strips as columns
from trunnion.verify.motion import Moves

CELL = 4.0
"""mm, pitch of the cells: a few samples each, and few enough cells a move."""
CHUNK = 4000
"""Samples between two looks at cancel."""


@dataclass(frozen=True, slots=True, eq=False)
class Sweep:
    """The feed moves of a setup, made ready for questions about points. `near` is how far beside a cutter its move is still listed, mm."""

    moves: Moves
    cutter: Floats
    low: Floats
    grid: Grid
    near: float

    @staticmethod
    def of(moves: Moves, near: float) -> Sweep:
        """Return the sweep of a setup's feed moves."""
        cutter = moves.cutters
        low = np.minimum(moves.row[:, columns.Z_START], moves.row[:, columns.Z_END])
        feeds = np.flatnonzero(~moves.rapid)
        order = feeds[np.argsort(low[feeds], kind="stable")]
        boxes = kernel.move_boxes(moves.row, cutter[:, 0] + near)
        grid = grid_of(boxes, CELL, order) if len(order) else grid_of(boxes[:0], CELL)
        return Sweep(moves, cutter, low, grid, near)

    def left(self, points: Floats, most: Floats, progress: Progress = QUIET) -> tuple[Floats, Ints]:
        """Return the smallest signed distance (s,) of points (s, 3) to the fluted cutter over all feed moves, and the move (-1: none).

        Distances above `most` (s,) come back as it.
        """
        left, nearest = np.array(most, dtype=np.float64), np.full(len(points), -1)
        # Neighbours in plan look at the same moves: visiting them together keeps those in the cache.
        g = self.grid
        cell = np.floor((points[:, :2] - g.frame[:2]) / g.frame[2])
        order = np.lexsort((cell[:, 0], cell[:, 1]))
        for first in range(0, len(points), CHUNK):
            progress.at(first / len(points), "Measuring material left")
            kernel.left_loop(first, min(first + CHUNK, len(points)), points, order, self.moves.row, self.cutter, self.low, g.start, g.rows,
                             g.frame, g.shape, tolerance.CONTACT_BOUND / 4, left, nearest)
        return left, nearest

    def cut_before(self, points: Floats, move: int) -> Bools:
        """Say for each point (s, 3) whether a feed move before a row has removed it and all above it."""
        out, g = np.zeros(len(points), bool), self.grid
        kernel.is_cut(points, move, self.moves.row, self.cutter, self.low, g.start, g.rows, g.frame, g.shape,
                      tolerance.CONTACT_BOUND / 4, out)
        return out
