"""Feeds that follow what is in front of the cutter: eased where it is more than they were chosen for, raised where it is less.

What a path removes is known only when it is whole: it is cut into short pieces and run through the stock it was planned on. Where a piece
takes off more than a full slot would at the slot feed (nearly full width, corners, links through stock), it goes slower by as much.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.model.motion.toolpath import Mark, Motion, Toolpath
from trunnion.model.operation import CuttingData
from trunnion.model.tool import Tool
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.toolpath.motion.load.chip_thinning import raised
from trunnion.toolpath.motion.load.pieces import PIECE, in_pieces
from trunnion.toolpath.stock.heightfield import PlanningStock

STEPS = 20
"""Feeds are eased in so many steps, always down: a block for every breath of the load would serve nobody."""
LEAST = 0.25
"""Share of the feed below which a cutter rubs."""
FULL_WIDTH, FULL_DEPTH = 0.6, 0.5
"""A finishing cutter that meets leftovers: share of the feed that it takes a full slot at, and the slot's depth over the diameter."""


def fed_by_load(
    path: Toolpath,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    slot: float,
    progress: Progress = NO_PROGRESS,
    *,
    spare: float = 1.0,
) -> Toolpath:
    """Return a roughing path with slower feeds where it removes more than a full slot of the operation's depth would at `slot` times its
    feed, and quicker ones where its chips are thinner than those that the feed was chosen for (`chip_thinning`).

    `stock` is what the path is planned on; what has to go slower does so by `spare` more, for what its field of heights doesn't see. Blocks
    are cut where the feed changes; positions and marks stay what they are.
    """
    if not len(path):
        return path
    taken = _Taken.by(path, tool, stock, progress)
    feed = taken.eased(tool, data.feed, slot * tool.diameter * data.depth, spare)
    return taken.joined(
        raised(taken.pieces, feed, tool, data, taken.volume, taken.squares, stock.cell)
    )


def eased_finish(
    path: Toolpath,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    progress: Progress = NO_PROGRESS,
) -> Toolpath:
    """Return a finishing path with slower feeds where leftovers weigh as much as a slot that the cutter bears.

    None is quicker where less stands: a surface shows where the feed changed.
    """
    if not len(path):
        return path
    taken = _Taken.by(path, tool, stock, progress)
    return taken.joined(taken.eased(tool, data.feed, slot_of_finish(tool, data)))


def slot_of_finish(tool: Tool, data: CuttingData) -> float:
    """Return the cross-section in mm2 that a finishing cutter takes at its whole feed."""
    return (
        FULL_WIDTH * data.slot_share * tool.diameter * min(data.depth, FULL_DEPTH * tool.diameter)
    )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Taken:
    """A path in pieces (n), the block (n,) that each is of, and what each takes off: `volume` (n,) mm3, and the squares of the heights
    summed over the area in plan, `squares` (n,) mm4."""

    pieces: Toolpath
    block: Ints
    volume: Floats
    squares: Floats

    @staticmethod
    def by(path: Toolpath, tool: Tool, stock: PlanningStock, progress: Progress) -> _Taken:
        """Return what a path takes off a stock, which stays what it is; entries are looked at as wholes."""
        pieces, block = in_pieces(path, PIECE * tool.radius, _fed(path))
        volume, squares = stock.working().taken(pieces, tool, progress)
        return _Taken(pieces=pieces, block=block, volume=volume, squares=squares)

    def eased(self, tool: Tool, full_feed: float, most: float, spare: float = 1.0) -> Floats:
        """Return the feeds (n,) at which no piece removes more than a section of `most` mm2 would at the full feed (mm/min), those that
        would `spare` times less."""
        pieces = self.pieces
        # A piece's own front is partly opened by the one before: over a diameter's length that evens out.
        section = _evened(pieces, pieces.lengths(), self.volume, tool.diameter)
        # A link may go faster than the feed, and meet as much less.
        highest = np.maximum(pieces.feed / full_feed, 1.0)
        share = np.divide(most, spare * section, out=highest.copy(), where=section * highest > most)
        share = np.maximum(share, LEAST)
        share = np.floor(share * STEPS + tolerance.COINCIDENT) / STEPS
        return np.where(_fed(pieces), np.minimum(pieces.feed, full_feed * share), pieces.feed)

    def joined(self, feed: Floats) -> Toolpath:
        """Return the path with feeds (n,), its pieces one block again where block and feed are the same."""
        pieces = self.pieces
        last = np.append((np.diff(self.block) != 0) | (np.diff(feed) != 0.0), True)
        return replace(
            pieces,
            **{
                name: getattr(pieces, name)[last]
                for name in ("position", "axis", "motion", "centre", "mark")
            },
            feed=feed[last],
            dwell=None if pieces.dwell is None else pieces.dwell[last],
        )


def _fed(path: Toolpath) -> Bools:
    """Return which blocks (n,) may get another feed."""
    return np.asarray((path.motion != Motion.RAPID) & (path.mark != Mark.ENTRY))


def _evened(pieces: Toolpath, length: Floats, gone: Floats, window: float) -> Floats:
    """Return the volume per way (n,) in mm2 that pieces take off, evened out over a window about each; rapids end a window."""
    run = np.concatenate(
        [[0.0], np.cumsum(np.where(pieces.motion == Motion.RAPID, window, length))]
    )
    total = np.concatenate([[0.0], np.cumsum(gone)])
    middle = 0.5 * (run[:-1] + run[1:])
    low, high = (
        np.interp(middle - 0.5 * window, run, total),
        np.interp(middle + 0.5 * window, run, total),
    )
    return np.asarray((high - low) / window)
