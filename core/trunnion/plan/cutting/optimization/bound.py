"""The bound of an operation: the highest removal rate that spindle, cutter and material allow, whatever its depth and width of cut.

Time over bound says how much a better strategy or other engagements could gain, where the optimiser of speed and feed has done its part.
"""

from __future__ import annotations

import numpy as np

from trunnion.model.material import Machine, Material
from trunnion.model.operation import Engagement, Operation
from trunnion.plan.cutting.milling import ROUGHING, slenderness
from trunnion.plan.cutting.optimization.operation import (
    OptimizationSettings,
    problem_at,
)
from trunnion.units import MM_PER_METRE

SPEEDS, WIDTHS, DEPTHS = 33, 12, 12
"""Spindle speeds, widths and depths of cut that are looked at."""


def removal_bound(
    operation: Operation, material: Material, machine: Machine, settings: OptimizationSettings
) -> float:
    """Return the highest removal rate in cm3/min that keeps the constraints in steady cutting; 0 where none does.

    Roughing may take any width up to the diameter and any depth up to the flutes, as far as its stickout leaves of them; a finishing pass
    has the depth and width that its surface asks for.
    """
    tool, data = operation.cutter, operation.data
    widths, depths = np.array([data.width]), np.array([data.depth])
    if operation.kind in ROUGHING:
        share = slenderness(tool, settings.cutting)
        widths = tool.diameter * np.arange(1, WIDTHS + 1) / WIDTHS
        depths = share * tool.flute_length * np.arange(1, DEPTHS + 1) / DEPTHS
    best = 0.0
    for width in widths:
        for depth in depths:
            met = Engagement(width=float(width), depth=float(depth), share=1.0, at="")
            problem = problem_at(operation, met, met, material, machine, settings)
            spindle = np.geomspace(*problem.spindle, SPEEDS)
            feed = problem.largest_feed(spindle) * problem.teeth * spindle
            rate = width * depth * np.nan_to_num(feed).max() / MM_PER_METRE
            best = max(best, float(rate))
    return best
