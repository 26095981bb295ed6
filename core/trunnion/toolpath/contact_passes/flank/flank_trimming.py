"""Flank passes trimmed to where nothing above the flutes meets stock: into corners a pass goes no farther than those above it have cut."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.frame import WORLD, Frame
from trunnion.model.tool import Tool
from trunnion.plan.clearance import LeaningCutQuery
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.toolpath.contact_passes.contacts import slerp
from trunnion.toolpath.contact_passes.flank.flank_passes import stretches
from trunnion.toolpath.contact_passes.flank.flank_stock import FlankStock, moves_of, pieces
from trunnion.toolpath.contact_passes.passes import Pass
from trunnion.toolpath.stock.heightfield import PlanningStock

LOOK_STEP = 0.5
"""mm that no place of the flutes goes between two poses that are asked about."""


def passes_off_stock(
    passes: Sequence[Pass],
    tool: Tool,
    stock: PlanningStock,
    earlier: Iterable[LeaningCutQuery] = (),
    frame: Frame = WORLD,
    progress: Progress = NO_PROGRESS,
) -> tuple[tuple[Pass, ...], FlankStock]:
    """Return the pieces of passes, in their order, on which nothing above the flutes of a tool meets stock, and the stock beside them.

    `earlier` are the cuts of other leaning tools, `frame` is the cutting frame, in which passes and stock are.
    """
    beside, kept = FlankStock(passes, tool, stock, earlier, frame), list[Pass]()
    for one in progress.over(list(passes), "Looking for what stands in the way"):
        fine, own = _fine(one, tool)
        free = beside.is_free(fine.tip, fine.axis, np.full(len(fine), len(kept)))
        for rows, _ in stretches(free, closed=one.closed):
            piece = one
            if len(rows) < len(fine):
                ends = np.zeros(len(rows), dtype=bool)
                ends[[0, -1]] = True
                piece = fine.of(rows[own[rows] | ends])
            kept.append(piece)
            beside.add(piece)
    return tuple(kept), beside


def _fine(one: Pass, tool: Tool) -> tuple[Pass, Bools]:
    """Return a pass in poses that are asked about, and which of these (n,) are its own."""
    moves = moves_of(one)
    way, share = moves.shares(pieces(moves, tool, LOOK_STEP))
    # The end of a move is the start of the next one.
    once = (share < 1.0) | (way == len(one) - 2)
    way, share = way[once], share[once]
    tip, axis = moves.at(way, share)
    own = (share == 0.0) | (share == 1.0)
    normal = _normals(one.normal[way], one.normal[way + 1], share)
    return Pass(tip=tip, axis=axis, normal=normal, closed=one.closed), own


def _normals(start: Floats, end: Floats, share: Floats) -> Floats:
    """Return unit normals (k, 3) at shares (k,) of the turn from one to the next; the first where opposite ones have none half-way."""
    found = slerp(start, end, share)
    lost = np.abs((found * found).sum(axis=1) - 1.0) > 1e-6
    found[lost] = start[lost]
    return found
