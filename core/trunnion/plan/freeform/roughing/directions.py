"""From which directions a part is roughed where an upright tool doesn't come: the fewest that see what is hidden."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.clearance import ClearanceScene
from trunnion.plan.freeform.reach import AreaSamples, reached
from trunnion.plan.freeform.space import SurfaceSpace
from trunnion.plan.setups.frames import Direction
from trunnion.progress import Progress

TILTS = (math.radians(90.0), math.radians(60.0), math.radians(30.0))
"""How far from upright directions are tried, all round: from slightly tilted ones a tool comes to what leans over its own foot."""
ROUND = 8
"""Directions all round: the setup's axes first."""
WORTH = 0.1
"""Share of what is hidden that another direction must see to be worth its turn."""
EVEN = 0.05
"""Share of what is hidden by which a tilted direction must see more than a level one to be taken before it: level ones leave most space
for the spindle, and what they see lies in even layers."""
FACING = math.sin(math.radians(10.0))
"""Cosine of the angle from a direction from which on a position looks along it rather than at it: such a one says not how deep to go."""
OFF = 0.3
"""mm: how far from the faces it is looked whether a cutter comes there."""
PROBE = 6.0
"""mm: diameter of the cutter that says what a direction sees: about what comes after roughing."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RoughingDirection:
    """A direction that something is roughed from, and the height in its cutting frame down to which it is worth it."""

    space: SurfaceSpace
    bottom: float


def sides_for(
    space: SurfaceSpace,
    setup: Setup,
    around: ClearanceScene,
    hidden: AreaSamples,
    tools: Sequence[Tool],
    clearance: float,
    depth: Callable[[SurfaceSpace], float],
    progress: Progress,
) -> list[RoughingDirection]:
    """Return the directions that see hidden positions best, each the one that sees most of what those before it don't.

    `depth` returns how deep in mm under the blank's top a roughing cutter comes in a space: what lies deeper is not seen from there.
    Each position is left to the one of these directions that it lies least deep from, so none goes deeper than it must.
    """
    probe = max(
        (t for t in tools if t.diameter <= PROBE),
        key=lambda t: (t.diameter, t.reach, t.name),
        default=None,
    )
    directions = [d for d in _directions() if bool(around.holds(np.array([d]))[0])]
    if probe is None or not directions:
        return []
    seen, spaces, heights, facing, depths = [], [], [], [], []
    for n, direction in enumerate(directions):
        progress.at(n / len(directions), "looking from the sides")
        there = space.seen_from(setup, direction)
        # Roughing stays off the faces: what the cutter only grazes along its side is seen as well.
        shifted = hidden.point + OFF * hidden.normal
        local = AreaSamples(
            point=there.frame.to_local(space.frame.to_world(shifted)),
            face=hidden.face,
            area=hidden.area,
            normal=there.frame.local_direction(space.frame.world_direction(hidden.normal)),
        )
        below = float(there.high[2]) - local.point[:, 2]
        seen.append(reached(there, local, probe, clearance) & (below <= depth(there)))
        depths.append(below)
        spaces.append(there)
        heights.append(local.point[:, 2])
        facing.append(local.normal[:, 2] > FACING)
    tilted = np.array([d[2] > math.sin(tolerance.ANGLE) for d in directions])
    rows = selected(np.array(seen), tilted)
    found = []
    for row, own in zip(
        rows, shared_out(np.array(seen)[rows], np.array(depths)[rows]), strict=True
    ):
        faces = own & facing[row]
        if own.any():
            lowest = float(heights[row][faces if faces.any() else own].min())
            found.append(RoughingDirection(space=spaces[row], bottom=lowest))
    return found


def selected(seen: Bools, tilted: Bools) -> list[int]:
    """Return the rows of directions that see most of what those before them don't, from what each sees (d, k) and which are tilted
    (d,)."""
    found, remaining = [], np.ones(seen.shape[1], dtype=bool)
    while remaining.any():
        gained = (seen & remaining).sum(axis=1)
        row = int(np.argmax(gained - EVEN * len(remaining) * tilted))
        if gained[row] <= WORTH * len(remaining):
            break
        found.append(row)
        remaining &= ~seen[row]
    return found


def shared_out(seen: Bools, depths: Floats) -> Bools:
    """Return which positions (d, k) are each direction's own: of those that see a position (d, k), the one that it lies least deep (d, k)
    from."""
    least = np.where(seen, depths, np.inf)
    if not len(least):
        return seen
    return np.asarray(seen & (np.arange(len(seen))[:, None] == least.argmin(axis=0)))


def _directions() -> list[Direction]:
    """Return the directions that are tried, in the setup's frame."""
    order = sorted(range(ROUND), key=lambda k: (k % 2, k))
    return [
        (
            round(math.sin(tilt) * math.cos(a), 12),
            round(math.sin(tilt) * math.sin(a), 12),
            round(math.cos(tilt), 12),
        )
        for tilt in TILTS
        for k in order
        for a in (2.0 * math.pi * k / ROUND,)
    ]
