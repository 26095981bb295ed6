"""What a cutter would scrape on its way out: stock beside its neck that the wider flutes below do not pass by.

A cutter may have come there from the side. The field of heights can't tell: beside walls it is too high, and what flutes went by underneath
counts as gone. So points on the flutes' circle are asked, which lie in no cell, and each cut takes off no more than its flutes reach over.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import reduce

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.model.motion.toolpath import Toolpath
from trunnion.model.tool import Tool
from trunnion.toolpath.stock.column_cuts import ColumnCuts, circle
from trunnion.toolpath.stock.heightfield import ARC_CHORD, PlanningStock

INSIDE = 2.0 * ARC_CHORD + tolerance.RAPID_DEPTH
"""mm that the circle is smaller than the flutes: arcs are cut as chords, by a cutter that is smaller by as much as they are off."""


@dataclass(slots=True, eq=False)
class StockOverFlutes:
    """What stands over the flutes of a tool within their width, in the stock that its path is planned on."""

    stock: PlanningStock
    tool: Tool
    _earlier: list[ColumnCuts] | None = field(default=None, init=False)

    def may_be_there(self, tip: Floats) -> bool:
        """Return whether anything may stand over the flutes of the tool at a tip (3,), whatever its own path has cut."""
        return self.stock.height(tip, tip, self.tool.core_radius) > tip[2] + self.tool.flute_length

    def top(self, tip: Floats, path: Toolpath) -> float:
        """Return the height (mm) of what stands over the flutes of the tool at a tip (3,) after its own path; -inf where nothing does."""
        radius = self.tool.core_radius - INSIDE
        if radius <= 0.0:
            return -math.inf
        points = tip[:2] + circle(radius)
        uncut = self.stock.heights_at(points)
        own = ColumnCuts.of(path, self.tool, self.stock.widths)
        over = tip[2] + self.tool.flute_length
        # Earlier cuts only lower what the own ones begin with: where these are enough, nobody asks for them.
        if (own.lowered(uncut, points) <= over).all():
            return -math.inf
        if self._earlier is None:
            self._earlier = [
                ColumnCuts.of(p, t, self.stock.widths) for p, t in self.stock.exact_cuts
            ]
        heights = reduce(
            lambda left, cuts: cuts.lowered(left, points), [*self._earlier, own], uncut
        )
        return float(heights[heights > over].max(initial=-math.inf))
