"""Stock beside passes of a flank while they are cut in their order: all above its flutes goes where flutes have been, or over the stock.

Flutes clear what a neck needs only as far as passes go: at the end of one, and on a lead that runs on past it, none above may have cut.
Points of neck, shank and holder are asked, each on its own; what is told of earlier leaning tools counts as cut.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.frame import WORLD, Frame
from trunnion.model.tool import Tool
from trunnion.plan.clearance import LeaningCutQuery
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.toolpath.contact_passes.passes import Pass
from trunnion.toolpath.contact_passes.tool_moves import ToolMoves
from trunnion.toolpath.stock.flute_cuts import INSIDE, STEP, FluteCuts, ring
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.toolpath.stock.leaning_cuts import flutes_of

ROUND = 48
"""Points round a body at one height."""
SLIMMER = tolerance.GOUGE
"""mm that bodies count as slimmer by: a shank as wide as the flutes goes where these have been, though it touches all round."""
APART = 1.0
"""mm between two heights of points on a neck, and of those on wider bodies a quarter of their radius at least."""
WITHIN = (1.0, 0.5)
"""Shares of a body's radius that points are at."""
EARLIER = -1
"""The number of what was cut before all passes."""


class FlankStock:
    """What stands beside passes of a tool that are cut in their order (`linking.parameters.PassStock`), in the stock before them.

    `earlier` are the cuts of other leaning tools, `frame` is the cutting frame, in which passes and stock are."""

    def __init__(
        self,
        passes: Sequence[Pass],
        tool: Tool,
        stock: PlanningStock,
        earlier: Iterable[LeaningCutQuery] = (),
        frame: Frame = WORLD,
    ) -> None:
        self._tool, self._stock, self._count = tool, stock, 0
        self._body = _body(tool)
        self._flutes = flutes_of(tool, INSIDE)
        self._cuts = FluteCuts.within(*_box(passes, tool, stock), tool.radius)
        for cut in earlier:
            self._cuts.add(*cut.poses_in(frame, STEP), cut.flutes(INSIDE), EARLIER)

    @staticmethod
    def after(
        passes: Sequence[Pass],
        tool: Tool,
        stock: PlanningStock,
        earlier: Iterable[LeaningCutQuery] = (),
        frame: Frame = WORLD,
    ) -> FlankStock:
        """Return the stock beside passes that may all be cut."""
        found = FlankStock(passes, tool, stock, earlier, frame)
        for one in passes:
            found.add(one)
        return found

    def add(self, one: Pass) -> None:
        """Put the next pass into the order; it is one of those that this was made with, or a piece of one."""
        moves = moves_of(one)
        _, tips, axes = moves.poses(pieces(moves, self._tool, STEP))
        self._cuts.add(tips, axes, self._flutes, self._count)
        self._count += 1

    def is_free(
        self, tips: Floats, axes: Floats, cut: Ints, progress: Progress = NO_PROGRESS
    ) -> Bools:
        """Return at which tips (k, 3) with axes (k, 3) nothing above the flutes meets stock when so many passes (k,) are cut."""
        return self._cuts.is_free(self._body, self._stock, tips, axes, cut, progress)

    def tops(self, tips: Floats, cut: Ints) -> Floats:
        """Return that nothing stands over a flank's flutes: it goes out along its axis, where these have been or cut."""
        return np.full(len(tips), -np.inf)


def moves_of(one: Pass) -> ToolMoves:
    """Return the moves of a pass."""
    return ToolMoves(one.tip[:-1], one.axis[:-1], one.tip[1:], one.axis[1:])


def pieces(moves: ToolMoves, tool: Tool, step: float) -> Floats:
    """Return in how many pieces (k,) no place of a tool's flutes goes farther than a step (mm) on moves."""
    return np.ceil((moves.travel + tool.flute_length * moves.turn) / step)


def _body(tool: Tool) -> Floats:
    """Return points (p, 3) on and in all that is above the flutes, the tip at the origin, its axis z."""
    round_it, found = ring(ROUND), [np.zeros((0, 3))]
    for z0, r0, z1, r1 in tool.profile():
        count = max(1, math.ceil((z1 - z0) / max(APART, 0.25 * max(r0, r1))))
        for share in np.linspace(0.0, 1.0, count + 1).tolist():
            z, r = z0 + share * (z1 - z0), r0 + share * (r1 - r0) - SLIMMER
            # The flutes' own top is nothing to ask for.
            up = np.full(ROUND, max(z, tool.flute_length + INSIDE))
            found += [np.column_stack([s * r * round_it, up]) for s in WITHIN]
    return np.vstack(found)


def _box(passes: Sequence[Pass], tool: Tool, stock: PlanningStock) -> tuple[Floats, Floats]:
    """Return the lowest and the highest corner (3,) of the box in which a tool on passes may meet stock above its flutes."""
    if not passes:
        return np.zeros(3), np.zeros(3)
    tips, axes = (np.vstack([getattr(p, name) for p in passes]) for name in ("tip", "axis"))
    ends = np.vstack([tips + tool.flute_length * axes, tips + tool.gauge_length * axes])
    widest = max((max(r0, r1) for _, r0, _, r1 in tool.profile()), default=tool.radius)
    low, high = ends.min(axis=0) - widest, ends.max(axis=0) + widest
    high[2] = min(high[2], float(stock.heights.max()))
    return low, np.maximum(high, low)
