"""Levels of waterlines: how far apart the passes of a cutter lie over triangles of steep faces.

Upright walls want few levels, a flank's height apart, leaning ones as many as their scallops ask for: where it pays each kind gets its
own levels.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.model.tool import Tool
from trunnion.toolpath.contact_passes.stepover.spacing import FacetSlopes, level_spacing, marched
from trunnion.toolpath.contact_passes.upright.foot_heights import FOOT, UPWARD, WallFoot

BELOW_TOP = 0.1
"""Of a step: how far the last level lies below the highest position."""
FLANK = 0.8
"""Of the flutes' length over the corner: the largest step beside an upright wall."""
OPEN = 100.0
"""mm of feed that leads and links of a level cost which is open because upright walls have levels of their own."""


@dataclass(frozen=True, slots=True, eq=False)
class WallLevels:
    """Triangles that have their levels, heights of the tip (p,) upwards, in common."""

    slopes: FacetSlopes
    levels: Floats


def with_levels(
    slopes: FacetSlopes, feet: WallFoot, tool: Tool, height: float, step: float
) -> list[WallLevels]:
    """Return the triangles with their levels: those of leaning faces and those of upright ones on levels of their own where that saves
    more than the passes cost that end where the two meet.

    The flank of a cutter finishes an upright wall over all its flutes, a leaning one it leaves steps on. Upright ones come first: what
    stands on them would meet the neck of a cutter that goes down a leaning wall beside them, which itself is wider the higher it is.
    """
    together = WallLevels(slopes, _levels(slopes, feet, tool, height, step))
    upright = slopes.normal[:, 2] <= -UPWARD
    if step > 0.0 or upright.all() or not upright.any():
        return [together]
    apart = [
        WallLevels(some, _levels(some, feet.some(which, highest), tool, height, step))
        for which, highest in ((upright, feet.highest_foot), (~upright, -np.inf))
        for some in (slopes.some(which),)
    ]
    ends = OPEN * len(apart[1].levels)
    return apart if _run(together) > sum(_run(w) for w in apart) + ends else [together]


def _run(walls: WallLevels) -> float:
    """Return about how long in mm the level lines on some triangles are: each adds its area, seen from the side, over the step there."""
    low, high = walls.slopes.tips[:, :, 2].min(axis=1), walls.slopes.tips[:, :, 2].max(axis=1)
    levels = walls.levels
    if len(levels) < 2:
        return 0.0
    row = np.clip(np.searchsorted(levels, 0.5 * (low + high)), 1, len(levels) - 1)
    side = np.sqrt(np.maximum(1.0 - walls.slopes.normal[:, 2] ** 2, 0.0))
    return float((walls.slopes.area * side / np.diff(levels)[row - 1]).sum())


def _levels(slopes: FacetSlopes, feet: WallFoot, tool: Tool, height: float, step: float) -> Floats:
    """Return the heights of the tip (p,) upwards, from the lowest position that is touched. Feet that lie higher have passes of their own,
    brought down from the level above them (`wall_foot`): there is one over the highest foot."""
    low, high = slopes.tips[:, :, 2].min(axis=1), slopes.tips[:, :, 2].max(axis=1)
    spacing = np.full(len(low), step) if step > 0.0 else level_spacing(slopes, tool, height)
    spacing = np.minimum(
        spacing, FLANK * max(tool.flute_length - tool.corner_radius, tool.corner_radius)
    )
    levels = marched(low, high, spacing, float(feet.low.min()), float(high.max()))
    if len(levels) > 1:
        if not (slopes.normal[high > levels[-2], 2] > -UPWARD).any():
            # The flank of the level below goes up an upright wall to its top.
            levels = levels[:-1]
        else:
            # At its own height the last one would only pass over the top.
            levels[-1] -= BELOW_TOP * (levels[-1] - levels[-2])
    if feet.highest_foot > levels[-1] + FOOT:
        # A flank that is longer than the wall is high needs no second level, but from the lowest foot the floor keeps it off the others.
        levels = np.append(levels, feet.highest_foot)
    return levels
