"""One planning stock for each direction that a tool comes from, and what each knows of what the others have cut.

A field of heights says that everything above it is gone. Seen from another direction that leaves, column by column, the highest position in
the blank that no field has above it: taken over in steps of a cell, always on the side of material.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.ndimage import maximum_filter

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.geometry.frame import Frame
from trunnion.model.blank import Blank
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.settings import digest
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.toolpath.stock.remaining import RemainingStock

NEIGHBOURHOOD = 3
"""Cells that a position is compared with in another field, in each of its directions: the cells it may lie in for all of its own cell."""


class StockViews:
    """The stock as the directions of all setups see it: it goes from one setup to the next."""

    def __init__(self, blank: Blank) -> None:
        self._blank = blank
        self._stocks: dict[str, PlanningStock] = {}
        self._frames: dict[str, Frame] = {}
        self._known: dict[tuple[str, str], str] = {}

    def seen(self, setup: Setup) -> PlanningStock:
        """Return the stock in the frame of a setup (a cutting frame is one), with all that was cut from other directions."""
        name = digest(setup.frame)
        if name not in self._stocks:
            self._stocks[name], self._frames[name] = (
                PlanningStock.of(self._blank, setup),
                setup.frame,
            )
        for other, stock in list(self._stocks.items()):
            if other != name and self._known.get((name, other)) != stock.digest:
                self._known[name, other] = stock.digest
                lowest = _lowest(self._blank, setup.frame)
                foot = _lowest(self._blank, self._frames[other])
                self._stocks[name] = _lowered(
                    self._stocks[name], setup.frame, stock, self._frames[other], lowest, foot
                )
        return self._stocks[name]

    def remaining_stock(self, frame: Frame) -> RemainingStock:
        """Return what stands of the blank by all directions together, in a frame."""
        fields = [(stock, self._frames[name]) for name, stock in self._stocks.items()]
        return RemainingStock.of(self._blank, frame, fields)

    def cut(
        self, setup: Setup, path: Toolpath, tool: Tool, progress: Progress = NO_PROGRESS
    ) -> None:
        """Take a path in the frame of a setup off its stock. A leaning tool takes nothing off: the stock is then higher than it is."""
        if len(path) and bool(
            (path.axis[path.motion != Motion.RAPID, 2] > 1.0 - tolerance.PARAMETRIC).all()
        ):
            name = digest(setup.frame)
            self._stocks[name] = self._stocks[name].after(path, tool, progress)


def _lowered(
    stock: PlanningStock,
    frame: Frame,
    other: PlanningStock,
    other_frame: Frame,
    lowest: float,
    foot: float,
) -> PlanningStock:
    """Return a stock without what another one, seen from elsewhere, knows to be gone; nothing is lower than `lowest`, nor the other one's
    blank than `foot`."""
    # Cut down to the blank's underside nothing is left, on either side of that height.
    remaining = np.where(other.heights > foot + tolerance.COINCIDENT, other.heights, -np.inf)
    material = maximum_filter(remaining, NEIGHBOURHOOD, mode="nearest")
    positions, heights = _centres(stock), stock.heights.ravel().copy()
    step, last = stock.cell, np.array(material.shape) - 1
    rows = np.flatnonzero(heights > lowest)
    while len(rows):
        # The middle of the uppermost step of each column: gone when all around it is.
        there = other_frame.to_local(
            frame.to_world(np.column_stack([positions[rows], heights[rows] - 0.5 * step]))
        )
        cell = np.floor((there[:, :2] - other.corner) / other.cell).astype(np.int64)
        outside = ((cell < 0) | (cell > last)).any(axis=1)
        gone = outside | (there[:, 2] - step > material[tuple(np.clip(cell, 0, last).T)])
        rows = rows[gone]
        heights[rows] -= step
        rows = rows[heights[rows] > lowest]
    kept = np.maximum(heights, lowest).reshape(stock.heights.shape)
    return replace(stock, heights=_fixed(kept), digest=digest(stock.digest, other.digest))


def _lowest(blank: Blank, frame: Frame) -> float:
    return float(blank.box_in(frame)[0][2])


def _centres(stock: PlanningStock) -> Floats:
    rows = np.argwhere(np.ones(stock.heights.shape, dtype=bool))
    return np.asarray(stock.corner + (rows + 0.5) * stock.cell)


def _fixed(array: Floats) -> Floats:
    array.setflags(write=False)
    return array
