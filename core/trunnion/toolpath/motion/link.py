"""Links through the air: up as far as what is certainly gone demands, across, down to just above what may be there, then feed.

A rapid changes either the height or the position, never both, and is measured against everything on the spindle: cutter, neck, shank,
holder.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.model.motion.toolpath import Mark
from trunnion.toolpath.axis_region import AxisRegion
from trunnion.toolpath.motion.builder import PathBuilder

RIM = 2.0
"""Cells at the cutter's rim that may straddle a wall."""

SKIN = 0.6
"""mm of material that a cutter may go straight down into: what roughing leaves on a floor."""

ASIDE = 1.5
"""mm that a cutter steps aside from a wall before it is lifted."""


def lowest_tip(builder: PathBuilder, start: ArrayLike, end: ArrayLike) -> float:
    """Return how low the tip may go between two positions (2,) without anything touching stock or fixtures that may be there; -inf over
    nothing."""
    stock, tool = builder.stock(), builder.tool
    lowest = stock.height(start, end, tool.radius)
    for z0, r0, _, r1 in tool.profile():
        if max(r0, r1) > tool.radius:
            lowest = max(
                lowest, stock.height(start, end, max(r0, r1) + builder.safety) - z0 + builder.safety
            )
    if builder.fixtures is not None:
        a, b = (np.asarray(v, dtype=np.float64)[:2] for v in (start, end))
        lowest = max(lowest, builder.fixtures.lowest_tip(tool, a, b))
    return lowest


def is_free(builder: PathBuilder, start: ArrayLike, z: float, end: ArrayLike | None = None) -> bool:
    """Return whether the cutter, fed at height `z` to a position or straight from one to another, meets nothing but the skin of walls."""
    return top_under(builder, start, 0.0, end) <= z + tolerance.COINCIDENT


def top_under(
    builder: PathBuilder, start: ArrayLike, radius: float = 0.0, end: ArrayLike | None = None
) -> float:
    """Return the top of the material under the cutter at a position, circling with `radius` there, or on its way to another.

    Good for feeds only: the field's cells on the rim, which a wall beside the cutter keeps high, are left out.
    """
    stock = builder.stock()
    return stock.height(
        start,
        start if end is None else end,
        max(builder.tool.radius + radius - RIM * stock.cell, stock.cell),
    )


def may_plunge(builder: PathBuilder, position: ArrayLike, z: float) -> bool:
    """Return whether so little material is under the cutter at a position that it may go straight down to height `z`."""
    return top_under(builder, position) - z <= SKIN


def travel(builder: PathBuilder, position: ArrayLike, z: float) -> None:
    """Bring the tip to a position (2,) at height `z`: rapid as far as it is safe, then feed down.

    The feed is the plunge feed where material may be in the way.
    """
    x, y = (float(v) for v in np.asarray(position, dtype=np.float64)[:2])
    below = lowest_tip(builder, (x, y), (x, y))
    near = min(max(below, z) + builder.safety, builder.clearance)
    if builder.here is None:
        builder.rapid((x, y, builder.clearance))
    else:
        here = builder.here
        if _apart(here, (x, y)):
            across = min(
                max(lowest_tip(builder, here, (x, y)) + builder.safety, here[2], z),
                builder.clearance,
            )
            if across > here[2] + tolerance.SHORT_MOVE:
                builder.rapid((here[0], here[1], across))
            builder.rapid((x, y, max(across, here[2])))
        elif near > here[2]:
            near = float(here[2])
    at = builder.here
    if at is not None and near < at[2] - tolerance.SHORT_MOVE:
        builder.rapid((x, y, near))
    blocked = not is_free(builder, (x, y), z)
    builder.line(
        (x, y, z),
        builder.data.plunge_feed if blocked else builder.data.feed,
        Mark.ENTRY if blocked else Mark.LEAD,
    )


def step_aside(
    builder: PathBuilder, tangent: ArrayLike, axis_region: AxisRegion, mark: Mark = Mark.LEAD
) -> None:
    """Leave the wall on the right: feed a little to the left of the direction just cut, where there is space."""
    if builder.here is None:
        return
    t = np.asarray(tangent, dtype=np.float64)
    left = np.array([-t[1], t[0]])
    for share in (1.0, 0.5):
        to = builder.here[:2] + share * ASIDE * left
        if axis_region.holds_line(builder.here[:2], to):
            builder.line((to[0], to[1], builder.here[2]), builder.data.feed, mark)
            return


def _apart(here: Floats, position: tuple[float, float]) -> bool:
    return max(abs(here[0] - position[0]), abs(here[1] - position[1])) > tolerance.SHORT_MOVE
