"""Rapids over ground that is laid flat, kept over it.

A circle about a cone's axis is an arc over its plane, so a straight way between two places far apart round the cone comes nearer to its tip
than either: out of the ground, over flanges and bosses that nothing has looked at. Such a rapid goes up to where it is clear of all that
stands on the ground, round on circles, and down again.
"""

from __future__ import annotations

import math

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.geometry.development import Development
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.plan.contract import RollingGround
from trunnion.tolerance import SHORT_MOVE

MOST_TURN = math.radians(2.0)
"""rad about the axis: the longest straight piece of a way round. On a circle of a metre it is 0.15 mm off, far less than it stays clear."""


def over_ground(path: Toolpath, ground: RollingGround, clearance: float) -> Toolpath:
    """Return a path over the plane of a development whose rapids stay between the places that are `known`, at height `clearance` (mm) where
    they would not; one with drilling cycles as it is."""
    if len(path) < 2 or path.cycles:
        return path
    start = path.starts()
    start[0] = path.position[0]
    nearest = ground.development.nearest_tip(start, path.position)
    ends = [ground.development.along_and_turn(p)[0] for p in (start, path.position)]
    low = np.minimum(ground.known[0], np.minimum(*ends))
    high = np.maximum(ground.known[1], np.maximum(*ends))
    leaves = (path.motion == Motion.RAPID) & ((nearest < low) | (nearest > high))
    if not leaves.any():
        return path
    pieces = [
        _around(start[row], path.position[row], ground.development, clearance)
        if leaves[row]
        else path.position[row : row + 1]
        for row in range(len(path))
    ]
    row = np.repeat(np.arange(len(path)), [len(p) for p in pieces])
    return Toolpath(
        position=np.concatenate(pieces),
        axis=path.axis[row],
        motion=path.motion[row],
        centre=path.centre[row],
        feed=path.feed[row],
        mark=path.mark[row],
    )


def _around(start: Floats, end: Floats, development: Development, clearance: float) -> Floats:
    """Return the positions (k, 3) of a way from one (3,) to another: up, round with place and angle changing evenly, down."""
    along, turns = development.along_and_turn(np.stack([start, end]))
    count = max(1, math.ceil(abs(turns[1] - turns[0]) / MOST_TURN))
    share = np.arange(count + 1) / count
    around = development.at(
        along[0] + share * (along[1] - along[0]), turns[0] + share * (turns[1] - turns[0])
    )
    around[[0, -1]] = start[:2], end[:2]
    height = max(clearance, float(start[2]), float(end[2]))
    raised = np.column_stack([around, np.full(len(around), height)])
    first = 0 if height - start[2] > SHORT_MOVE else 1
    return np.vstack([raised[first:], *([end[None]] if height - end[2] > SHORT_MOVE else [])])
