"""The passes that clear a wanted area inside a boundary: rings beside the walls, clipped to what is wanted where the area is open."""

from __future__ import annotations

from dataclasses import dataclass

from trunnion.geometry.plane.region import Region
from trunnion.model.tool import Tool
from trunnion.toolpath.axis_region import OPEN_MARGIN, AxisRegion
from trunnion.toolpath.offsetting.rings import OffsetRing, ring_tree

OVERRUN = 1.0
"""mm that the whole cutter runs past an open side."""

FAR = 10_000.0
"""mm: farther than any boundary, so that passes are parallel to walls and to nothing else."""


@dataclass(frozen=True, slots=True, eq=False)
class ClearingPasses:
    """The axis region, its rings, and the clip of an open area (None: closed all round)."""

    axis_region: AxisRegion
    rings: tuple[OffsetRing, ...]
    clip: Region | None


def passes_over(
    wanted: Region,
    boundary: Region,
    tool: Tool,
    distance: float,
    step: float,
    *,
    mitred: bool = False,
) -> ClearingPasses:
    """Return the passes of a cutter whose axis keeps `distance` from the boundary's rim; none when it fits nowhere.

    `mitred`: the walls have a fillet at their foot, which `AxisRegion.of` must keep whole at sharp edges.
    """
    closed = not boundary.minus(wanted.offset(OPEN_MARGIN))
    axis_region = AxisRegion.of(boundary, distance, mitred=mitred and closed)
    if not axis_region.region or not wanted:
        return ClearingPasses(axis_region, (), None)
    if closed:
        return ClearingPasses(axis_region, ring_tree(axis_region.region, step), None)
    clip = wanted.offset(tool.radius + OVERRUN)
    near = clip.offset(distance + OVERRUN)
    walls = near.minus(boundary)
    if not walls:
        return ClearingPasses(axis_region, ring_tree(axis_region.region, step, clip), clip)
    low, high = near.box()
    everywhere = Region.rectangle(low[0] - FAR, low[1] - FAR, high[0] + FAR, high[1] + FAR)
    return ClearingPasses(
        axis_region, ring_tree(everywhere.minus(walls.offset(distance)), step, clip), clip
    )
