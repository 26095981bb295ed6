"""A path in short pieces, and how wide a cut each is by what it takes off the stock."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from trunnion.geometry.arrays import Bools, Floats, Ints, items_of
from trunnion.model.motion.toolpath import Toolpath
from trunnion.model.tool import Tool
from trunnion.toolpath.stock.heightfield import positions_on

PIECE = 0.5
"""Of the cutter's radius: length of the pieces that a path is looked at in."""


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


def cut_width(section: Floats, square: Floats, tool: Tool) -> Floats:
    """Return the width (n,) mm of cuts of a section (n,) mm2 whose heights' squares sum up to `square` (n,) mm3 across.

    Of heights h it is (sum of h)^2 / (sum of h^2), that of one even layer: thin films beside a cut don't widen it.
    """
    width = np.divide(section**2, square, out=np.zeros(len(section)), where=square > 0.0)
    return np.clip(width, section / tool.flute_length, tool.core_diameter)
