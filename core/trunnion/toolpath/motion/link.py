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

OFF_WALL = (0.5, 1.0, 1.5, 2.0, 3.0)
"""mm that a cutter is fed on, off a wall, where it can then go over to the next pass without being lifted over the wall."""

RAPID_COST = 0.4
"""Of a feed's way: what a lift and the descent after it cost at rapid."""

NEAR_BY = 2.0
"""Safety distances: a position no farther away is fed to rather than reached by a lift and a descent."""


def lowest_tip(builder: PathBuilder, start: ArrayLike, end: ArrayLike) -> float:
    """Return how low the tip may go between two positions (2,) without anything touching stock or fixtures that may be there; -inf over
    nothing."""
    stock, tool = builder.stock(), builder.tool
    lowest = stock.height(start, end, tool.radius)
    for above, radius in tool.rings()[1:]:
        top = stock.height(start, end, radius + builder.safety)
        lowest = max(lowest, top - above + builder.safety)
    if builder.fixtures is not None:
        a, b = (np.asarray(v, dtype=np.float64)[:2] for v in (start, end))
        lowest = max(lowest, builder.fixtures.lowest_tip(tool, a, b))
    return lowest


def is_free(builder: PathBuilder, start: ArrayLike, z: float, end: ArrayLike | None = None) -> bool:
    """Return whether the cutter, fed at height `z` to a position or straight from one to another, meets nothing but the skin of walls."""
    return top_under(builder, start, 0.0, end) <= z + tolerance.COINCIDENT


def is_off(builder: PathBuilder, position: ArrayLike, z: float) -> bool:
    """Return whether nothing of the tool at height `z` at a position can touch material, the skin of walls included."""
    return lowest_tip(builder, position, position) <= z + tolerance.COINCIDENT


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


def descent(builder: PathBuilder, position: ArrayLike, z: float) -> float:
    """Return how far in mm the tip has to be fed down to height `z` at a position (2,): what `travel` does not do at rapid."""
    return _near(builder, lowest_tip(builder, position, position), z) - z


def travel(
    builder: PathBuilder, position: ArrayLike, z: float, axis_region: AxisRegion | None = None
) -> None:
    """Bring the tip to a position (2,) at height `z`: rapid as far as it is safe, then feed down.

    Where nothing is left down to `safety` below `z`, the rapid goes down to `z`; the feed is the plunge feed where material may be in the
    way. Within an axis region the tip may first be fed off a wall, or all the way, when that saves a lift.
    """
    x, y = (float(v) for v in np.asarray(position, dtype=np.float64)[:2])
    near = _near(builder, lowest_tip(builder, (x, y), (x, y)), z)
    if builder.here is None:
        builder.rapid((x, y, builder.clearance))
    elif _apart(builder.here, (x, y)):
        _cross(builder, (x, y), z, axis_region)
    elif near > builder.here[2]:
        near = float(builder.here[2])
    at = builder.here
    if at is not None and near < at[2] - tolerance.SHORT_MOVE:
        builder.rapid((x, y, near))
    blocked = not is_free(builder, (x, y), z)
    builder.line(
        (x, y, z),
        builder.data.plunge_feed if blocked else builder.data.feed,
        Mark.ENTRY if blocked else Mark.LEAD,
    )


def _near(builder: PathBuilder, below: float, z: float) -> float:
    """Return down to where a rapid may go over what is `below`: to `z` itself where that is deeper by the safety distance."""
    known = below if np.isfinite(below) else z
    return min(max(known + builder.safety, z), builder.clearance)


def _cross(
    builder: PathBuilder, position: tuple[float, float], z: float, axis_region: AxisRegion | None
) -> None:
    """Bring the tip over a position (2,), at a height of at least `z` from which it may go down."""
    if axis_region is not None:
        if _feeds_over(builder, position, z, axis_region):
            return
        _off_the_wall(builder, position, axis_region)
    here = builder.here
    assert here is not None  # a way across begins where the tool is
    across = max(here[2] + _lift(builder, here, position), z)
    if across > here[2] + tolerance.SHORT_MOVE:
        builder.lift(across)
    builder.rapid((*position, across))


def _lift(builder: PathBuilder, here: Floats, position: ArrayLike) -> float:
    """Return how far in mm the tip has to go up before a rapid straight over to a position."""
    highest = min(lowest_tip(builder, here, position) + builder.safety, builder.clearance)
    return max(highest - float(here[2]), 0.0)


def _feeds_over(
    builder: PathBuilder, position: tuple[float, float], z: float, axis_region: AxisRegion
) -> bool:
    """Feed straight over to a near position, at height `z` or above it, where a rapid would have to be lifted; say whether."""
    here = builder.here
    assert here is not None  # a way across begins where the tool is
    if (
        here[2] < z - tolerance.SHORT_MOVE
        or np.hypot(*(position - here[:2])) > NEAR_BY * builder.safety
        or _lift(builder, here, position) <= 0.0
        or not is_free(builder, here, float(here[2]), position)
        or not axis_region.holds_line(here, position)
    ):
        return False
    builder.line((*position, here[2]), builder.data.feed, Mark.LINK)
    return True


def _off_the_wall(
    builder: PathBuilder, position: tuple[float, float], axis_region: AxisRegion
) -> None:
    """Feed on in the direction just cut where the tool then needs less of a lift than where it is, beside a wall."""
    here, heading = builder.here, builder.heading()
    assert here is not None  # a way across begins where the tool is
    lift = _lift(builder, here, position)
    tried = [(lift * RAPID_COST, 0.0)]
    for way in OFF_WALL if lift > builder.safety and heading.any() else ():
        to = here + way * np.array([*heading, 0.0])
        if not axis_region.holds_line(here, to) or not is_free(builder, here, float(here[2]), to):
            break
        tried.append((_lift(builder, to, position) * RAPID_COST + way, way))
    _, way = min(tried)
    if way > 0.0:
        to = here[:2] + way * heading
        builder.line((*to, here[2]), builder.data.feed, Mark.LEAD)


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
