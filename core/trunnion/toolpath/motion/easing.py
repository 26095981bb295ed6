"""Feeds eased where more material is in front of the cutter than its feed was chosen for: nearly full width, corners, links through stock.

What a path removes is known only when it is whole: it is cut into short pieces, run through the stock it was planned on, and where a piece
takes off more than a full slot would at the slot feed, it goes slower by as much.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints, items_of
from trunnion.model.motion.toolpath import Mark, Motion, Toolpath
from trunnion.model.operation import CuttingData
from trunnion.model.tool import Tool
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.toolpath.stock.heightfield import PlanningStock, positions_on

PIECE = 0.5
"""Of the cutter's radius: length of the pieces that a path is looked at in."""
STEPS = 20
"""Feeds are eased in so many steps, always down: a block for every breath of the load would serve nobody."""
LEAST = 0.25
"""Share of the feed below which a cutter rubs."""
FULL_WIDTH, FULL_DEPTH = 0.6, 0.5
"""A finishing cutter that meets leftovers: share of the feed that it takes a full slot at, and the slot's depth over the diameter."""


def eased(
    path: Toolpath,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    slot: float,
    progress: Progress = NO_PROGRESS,
) -> Toolpath:
    """Return a path with slower feeds where it removes more than a full slot of the operation's depth would at `slot` times its feed.

    `stock` is what the path is planned on. Blocks are cut where the feed changes; positions and marks stay what they are.
    """
    return _eased(path, tool, data.feed, stock, slot * tool.diameter * data.depth, progress)


def eased_finish(
    path: Toolpath,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    progress: Progress = NO_PROGRESS,
) -> Toolpath:
    """Return a finishing path as `eased`, where leftovers weigh as much as a slot that the cutter bears."""
    return _eased(path, tool, data.feed, stock, slot_of_finish(tool, data), progress)


def slot_of_finish(tool: Tool, data: CuttingData) -> float:
    """Return the cross-section in mm2 that a finishing cutter takes at its whole feed."""
    return (
        FULL_WIDTH * data.slot_share * tool.diameter * min(data.depth, FULL_DEPTH * tool.diameter)
    )


def _eased(
    path: Toolpath,
    tool: Tool,
    full_feed: float,
    stock: PlanningStock,
    most: float,
    progress: Progress,
) -> Toolpath:
    if not len(path):
        return path
    cuts = (path.motion != Motion.RAPID) & (path.mark != Mark.ENTRY)
    pieces, block = in_pieces(path, PIECE * tool.radius, cuts)
    length = pieces.lengths()
    # A piece's own front is partly opened by the one before: over a diameter's length that evens out.
    section = _evened(pieces, length, stock.working().lower(pieces, tool, progress), tool.diameter)
    # A link may go faster than the feed, and meet as much less.
    highest = np.maximum(pieces.feed / full_feed, 1.0)
    share = np.divide(most, section, out=highest.copy(), where=section * highest > most)
    share = np.maximum(share, LEAST)
    share = np.floor(share * STEPS + tolerance.COINCIDENT) / STEPS
    cuts = (pieces.motion != Motion.RAPID) & (pieces.mark != Mark.ENTRY)
    feed = np.where(cuts, np.minimum(pieces.feed, full_feed * share), pieces.feed)
    last = np.append((np.diff(block) != 0) | (np.diff(feed) != 0.0), True)
    return replace(
        pieces,
        **{
            name: getattr(pieces, name)[last]
            for name in ("position", "axis", "motion", "centre", "mark")
        },
        feed=feed[last],
        dwell=None if pieces.dwell is None else pieces.dwell[last],
    )


def in_pieces(path: Toolpath, piece: float, cuts: Bools) -> tuple[Toolpath, Ints]:
    """Return a path with some blocks, `cuts` (n,), in pieces no longer than `piece` mm, and the block (m,) that each is of."""
    count = np.where(cuts, np.maximum(np.ceil(path.lengths() / piece), 1.0), 1.0).astype(np.int64)
    rows, step_index = items_of(count)
    position = positions_on(path, rows, (step_index + 1) / count[rows])
    ends = step_index + 1 == count[rows]
    position[ends] = path.position[rows[ends]]
    return replace(
        path,
        position=position,
        axis=path.axis[rows],
        motion=path.motion[rows],
        centre=path.centre[rows],
        feed=path.feed[rows],
        mark=path.mark[rows],
        dwell=path.dwell_of(rows),
        cycles=(),
    ), rows


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
