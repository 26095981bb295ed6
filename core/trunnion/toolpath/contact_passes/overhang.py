"""What hangs over beside an upright tool: on its way straight up it comes nearer to it, and to the stock that is left on it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.geometry.sheet.skin import Skin
from trunnion.model.tool import Tool
from trunnion.plan.freeform.cutters.cutter import lower_side
from trunnion.plan.freeform.finishing.rest import overhanging


def overhang_tops(skin: Skin, tool: Tool, thickness: float) -> Callable[[Floats], float]:
    """Return a function that says for a tip (3,) how high in mm an upright cutter has to rise there to be over all that hangs over, with a
    thickness (mm) on it: -inf where nothing does. What is lower than the tip is never asked for."""
    surface = overhanging(skin)
    if surface is None:
        return lambda tip: -np.inf
    cutter, lowest = lower_side(tool, thickness), float(skin.points[:, 2].min())

    def top(tip: Floats) -> float:
        found = float(surface.drop(tip[None, :2], cutter, lowest - thickness)[0]) + thickness
        return found if found > lowest else -np.inf

    return top
