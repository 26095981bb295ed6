"""One planning stock for each direction that a tool comes from, and what each knows of what the others have cut.

A field of heights says that everything above it is gone. Seen from another direction that leaves, column by column, the highest position in
the blank that no field has above it: taken over in steps of a cell, always on the side of material. What leaning tools have cut no field
knows; it is remembered move by move, for those that ask what stands by positions.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.ndimage import maximum_filter

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.geometry.development import Development
from trunnion.geometry.frame import Frame
from trunnion.geometry.sheet.skin import Skin
from trunnion.model.blank import Blank
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.contract import RollingGround
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.settings import digest
from trunnion.toolpath.stock.heightfield import CELL, MOST_CELLS, PlanningStock
from trunnion.toolpath.stock.leaning_cuts import LeaningCut
from trunnion.toolpath.stock.remaining import NEAR, RemainingStock
from trunnion.toolpath.stock.voxels import StockVoxels

NEIGHBOURHOOD = 3
"""Cells that a position is compared with in another field, in each of its directions: the cells it may lie in for all of its own cell."""


class StockViews:
    """The stock as the directions of all setups see it: it goes from one setup to the next."""

    def __init__(self, blank: Blank) -> None:
        self._blank = blank
        self._stocks: dict[str, PlanningStock] = {}
        self._frames: dict[str, Frame] = {}
        self._known: dict[tuple[str, str], str] = {}
        self._grounds: dict[str, tuple[Development, PlanningStock]] = {}
        self._leaning: list[LeaningCut] = []
        self._voxels: StockVoxels | None = None

    def seen(self, setup: Setup, cell: float = 0.0) -> PlanningStock:
        """Return the stock in the frame of a setup (a cutting frame is one), with all that was cut from other directions; in cells of
        a side in mm where it is first looked at so, 0: the usual one."""
        name = digest(setup.frame)
        if name not in self._stocks:
            self._stocks[name], self._frames[name] = (
                PlanningStock.of(self._blank, setup, cell or CELL),
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
        for key, (development, stock) in self._grounds.items():
            if self._known.get((name, key)) != stock.digest:
                self._known[name, key] = stock.digest
                self._stocks[name] = _lowered_over(
                    self._stocks[name],
                    setup.frame.to_world,
                    stock,
                    development,
                    _lowest(self._blank, setup.frame),
                )
        return self._stocks[name]

    def over_ground(self, ground: RollingGround) -> PlanningStock:
        """Return the stock over the plane of a development, with all that was cut over it, and over the ground that it is sunk into."""
        name = digest(ground.development)
        if name not in self._grounds:
            self._grounds[name] = (ground.development, _over(ground))
        if ground.upper is not None:
            self._lower(name, ground.development, ground.upper)
        return self._grounds[name][1]

    def _lower(self, name: str, development: Development, upper: RollingGround) -> None:
        """Take what was cut over an upper ground off the stock over a development."""
        cut, key = self.over_ground(upper), digest(upper.development)
        if self._known.get((name, key)) != cut.digest:
            self._known[name, key] = cut.digest
            lowered = _lowered_over(
                self._grounds[name][1], development.to_world, cut, upper.development, 0.0
            )
            self._grounds[name] = (development, lowered)

    def cut_over(
        self,
        ground: RollingGround,
        path: Toolpath,
        tool: Tool,
        progress: Progress = NO_PROGRESS,
    ) -> None:
        """Take a path over the plane of a development off the stock there."""
        stock = self.over_ground(ground).after(path, tool, progress)
        self._grounds[digest(ground.development)] = (ground.development, stock)

    def remaining_stock(
        self,
        frame: Frame,
        part: Callable[[], Skin],
        *,
        leaning: bool = False,
        progress: Progress = NO_PROGRESS,
    ) -> RemainingStock:
        """Return what stands of the blank by all directions together, off the part, whose skin in its own coordinates `part`
        makes, in a frame; with `leaning` without what leaning tools have cut that left an allowance."""
        if self._voxels is None:
            self._voxels = StockVoxels.of(self._blank, part(), NEAR, progress)
        for name, stock in self._stocks.items():
            self._voxels.lower(name, stock, self._frames[name])
        if leaning:
            cuts = [c for c in self._leaning if c.allowance > 0.0]
            for cut in cuts[self._voxels.cuts :]:
                self._voxels.cut(cut, progress)
        return self._voxels.remaining(frame, leaning=leaning)

    def leaning_cuts(self, feature: str) -> tuple[LeaningCut, ...]:
        """Return what leaning tools have cut for a feature, in their order."""
        return tuple(c for c in self._leaning if c.feature == feature)

    def cut(
        self,
        setup: Setup,
        path: Toolpath,
        tool: Tool,
        progress: Progress = NO_PROGRESS,
        *,
        feature: str = "",
        allowance: float = 0.0,
    ) -> bool:
        """Take a path in the frame of a setup off its stock; return whether anything was. A leaning tool takes nothing off: the stock is
        then higher than it is. What it cuts for a feature, leaving an allowance (mm) or 0, is kept for those that ask."""
        if not len(path):
            return False
        upright = path.axis[path.motion != Motion.RAPID, 2] > 1.0 - tolerance.PARAMETRIC
        if not upright.all():
            self._leaning.append(LeaningCut(path, tool, setup.frame, feature, allowance))
            return False
        name = digest(setup.frame)
        self._stocks[name] = self._stocks[name].after(path, tool, progress)
        return True


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
    return replace(stock, field=_fixed(kept), digest=digest(stock.digest, other.digest))


def _lowered_over(
    stock: PlanningStock,
    to_world: Callable[[Floats], Floats],
    other: PlanningStock,
    development: Development,
    lowest: float,
) -> PlanningStock:
    """Return a stock without what the one over a development knows to be gone: beside that plane, and under it, nothing is known.
    `to_world` takes positions over the stock's own plane (n, 3) to the part's coordinates."""
    material = maximum_filter(other.heights, NEIGHBOURHOOD, mode="nearest")
    positions, heights = _centres(stock), stock.heights.ravel().copy()
    step, last = stock.cell, np.array(material.shape) - 1
    rows = np.flatnonzero(heights > lowest)
    while len(rows):
        at = np.column_stack([positions[rows], heights[rows] - 0.5 * step])
        there = development.to_local(to_world(at))
        cell = np.floor((there[:, :2] - other.corner) / other.cell).astype(np.int64)
        known = ((cell >= 0) & (cell <= last)).all(axis=1)
        gone = known & (there[:, 2] - step > material[tuple(np.clip(cell, 0, last).T)])
        rows = rows[gone]
        heights[rows] -= step
        rows = rows[heights[rows] > lowest]
    kept = np.maximum(heights, lowest).reshape(stock.heights.shape)
    return replace(stock, field=_fixed(kept), digest=digest(stock.digest, other.digest))


def _over(ground: RollingGround) -> PlanningStock:
    """Return the uncut stock over a development: each cell as high as the blank is anywhere near it along the straight lines."""
    size = ground.high - ground.low
    cell = max(CELL, float(np.sqrt(size[0] * size[1] / MOST_CELLS)))
    shape = tuple(np.ceil(size / cell).astype(int))
    rows = np.argwhere(np.ones(shape, dtype=bool))
    middle = np.column_stack([ground.low + (rows + 0.5) * cell, np.zeros(len(rows))])
    along = ground.development.along_and_turn(middle)[0]
    v, high = ground.profile.T
    spread = max(1, math.ceil(cell / float(v[1] - v[0])))
    highest = maximum_filter(high, 2 * spread + 1, mode="nearest")
    row = np.clip(np.round((along - v[0]) / (v[1] - v[0])).astype(np.int64), 0, len(v) - 1)
    heights = highest[row].reshape(shape)
    return PlanningStock(
        field=_fixed(heights),
        corner=_fixed(ground.low.copy()),
        cell=cell,
        digest=digest(ground.development, shape, cell, ground.profile, ground.widths),
        widths=ground.widths,
    )


def _lowest(blank: Blank, frame: Frame) -> float:
    return float(blank.box_in(frame)[0][2])


def _centres(stock: PlanningStock) -> Floats:
    rows = np.argwhere(np.ones(stock.heights.shape, dtype=bool))
    return np.asarray(stock.corner + (rows + 0.5) * stock.cell)


def _fixed(array: Floats) -> Floats:
    array.setflags(write=False)
    return array
