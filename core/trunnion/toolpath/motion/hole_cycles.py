"""One path of cycles from hole to hole: retract planes over what stands there, and ways between them that meet nothing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.model.motion.cycle import Cycle
from trunnion.model.motion.drilling import drilled
from trunnion.model.motion.toolpath import Mark, Motion, Toolpath
from trunnion.plan.holes.hole import PlannedHole
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.link import lowest_tip


@dataclass(frozen=True, slots=True, kw_only=True)
class HoleCycle:
    """A hole with its cycle and the height of its retract plane, mm; how high the cycle lifts the tool is the path's to say."""

    hole: PlannedHole
    plane: float
    cycle: Cycle


def retract_plane(builder: PathBuilder, hole: PlannedHole) -> float:
    """Return the height from which a hole is fed into: over it and all that may stand there."""
    over = max(lowest_tip(builder, hole.position, hole.position), hole.top)
    return min(over + builder.safety, builder.clearance)


def top_at(builder: PathBuilder, hole: PlannedHole) -> float:
    """Return how high the stock stands on a hole's axis, at least where the hole begins."""
    stock = builder.stock()
    return max(hole.top, float(stock.height(hole.position, hole.position, stock.cell)))


def cycle_path(
    builder: PathBuilder, cycles: Sequence[HoleCycle], feed: float | None = None
) -> Toolpath:
    """Return the path from the clearance height over the first hole to that over the last, at a feed (mm/min), else at that of the data.

    The tool stays as low between holes as stock and fixtures let it: on the retract planes where these are free from hole to hole, else on
    one level over all of the way, as cycles know it (G98).
    """
    level = max(c.plane for c in cycles)
    stays_low = True
    for a, b in pairwise(cycles):
        needed = lowest_tip(builder, a.hole.position, b.hole.position) + builder.safety
        stays_low = stays_low and needed <= max(a.plane, b.plane) + tolerance.COINCIDENT
        level = max(level, needed)
    level = min(level, builder.clearance)
    first, last = cycles[0].hole.position, cycles[-1].hole.position
    path = drilled(
        np.append(first, level),
        np.array([np.append(c.hole.position, c.plane) for c in cycles]),
        [replace(c.cycle, lift=0.0 if stays_low else level - c.plane) for c in cycles],
        builder.data.feed if feed is None else feed,
    )
    pieces = [path, _rapid(np.append(last, builder.clearance))]
    if builder.clearance > level + tolerance.SHORT_MOVE:
        pieces.insert(0, _rapid(np.append(first, builder.clearance)))
    return Toolpath.join(pieces)


def _rapid(position: Floats) -> Toolpath:
    return Toolpath(
        position=position[None],
        axis=np.array([[0.0, 0.0, 1.0]]),
        motion=np.array([Motion.RAPID]),
        centre=np.full((1, 3), np.nan),
        feed=np.zeros(1),
        mark=np.array([Mark.RETRACT]),
    )
