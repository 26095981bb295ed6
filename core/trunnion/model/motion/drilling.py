"""Toolpaths of holes: a cycle on each, with the plain motions that everybody reads."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.model.motion.cycle import Cycle, Expansion, expanded
from trunnion.model.motion.toolpath import CycleBlock, Mark, Motion, Toolpath

UP = np.array([0.0, 0.0, 1.0])


def drilled(
    start: Floats,
    tops: Floats,
    cycle: Cycle | Sequence[Cycle],
    feed: float,
    axis: Floats = UP,
) -> Toolpath:
    """Return the path of a cycle, or of one a hole, on holes whose axes meet the retract plane at `tops` (n, 3), one after the other from
    a start (3,).

    `feed` mm/min, of a tap its pitch times the spindle speed; `axis` (3,) unit, from the tip to the spindle.
    """
    parts: list[Expansion] = []
    blocks: list[CycleBlock] = []
    at, row = np.asarray(start, dtype=np.float64), 1
    cycles = [cycle] * len(tops) if isinstance(cycle, Cycle) else cycle
    for top, own in zip(np.asarray(tops, dtype=np.float64), cycles, strict=True):
        part = expanded(own, at, top, axis)
        blocks.append(CycleBlock(first=row, last=row + len(part) - 1, cycle=own))
        parts.append(part)
        at, row = part.position[-1], row + len(part)
    rapid = np.concatenate([[True], *(p.rapid for p in parts)])
    return Toolpath(
        position=np.vstack([np.asarray(start)[None], *(p.position for p in parts)]),
        axis=np.tile(axis, (row, 1)),
        motion=np.where(rapid, Motion.RAPID, Motion.LINE),
        centre=np.full((row, 3), np.nan),
        feed=np.where(rapid, 0.0, feed),
        mark=np.where(rapid, Mark.RETRACT, Mark.CUT),
        dwell=np.concatenate([[0.0], *(p.dwell for p in parts)]),
        cycles=tuple(blocks),
    )
