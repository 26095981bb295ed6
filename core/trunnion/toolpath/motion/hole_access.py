"""Whether a tool gets to the bottom of a hole past what still stands around it, and past fixtures."""

from __future__ import annotations

import numpy as np

from trunnion import tolerance
from trunnion.findings import Finding, warning
from trunnion.plan.holes.hole import PlannedHole
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.link import RIM
from trunnion.units import trimmed

KEPT_OFF = "hole.kept-off"
"""Code of the finding on a hole that shank, holder or a fixture keeps the tool from."""


def kept_off(
    builder: PathBuilder, hole: PlannedHole, tip: float, aside: float = 0.0
) -> Finding | None:
    """Return the finding on a hole whose bottom a tool can't get to, None where it can.

    Its tip goes down to a height `tip`, its axis up to `aside` mm off the hole's.
    """
    tool, stock, at = builder.tool, builder.stock(), hole.position
    for above, radius in tool.rings()[1:]:
        # Cells at the rim may straddle a wall that the tool was chosen to pass.
        seen = max(radius + aside - RIM * stock.cell, stock.cell)
        high = float(stock.height(at, at, seen)) - (tip + above)
        if high > tolerance.COINCIDENT:
            return _kept_off(
                builder, hole, f"what stands around it is {trimmed(high, 2)} mm too high"
            )
    if builder.fixtures is not None:
        across = aside * np.eye(2)
        low = max(builder.fixtures.lowest_tip(tool, at - side, at + side) for side in across)
        if low > tip + tolerance.COINCIDENT:
            return _kept_off(
                builder, hole, f"a fixture keeps the tip {trimmed(low - tip, 2)} mm up"
            )
    return None


def _kept_off(builder: PathBuilder, hole: PlannedHole, why: str) -> Finding:
    return warning(
        KEPT_OFF,
        f"{hole.feature} is not cut: {builder.tool.name} does not get to its bottom, {why}",
        hole.feature,
        remedy="choose a longer tool, clear what stands there before, or move the fixture",
    )
