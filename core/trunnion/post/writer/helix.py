"""Helices of several turns as one block, for controls that have a word for whole turns."""

from __future__ import annotations

import math

import numpy as np

from trunnion.model.motion.toolpath import Motion
from trunnion.post.ticks import WrittenPath
from trunnion.post.writer.modal import Block

_SLACK = 1.0
"""Ticks that a turn's end may be off an even climb: it was rounded by itself."""


def last_of_helix(path: WrittenPath, row: int) -> int:
    """Return the last row of the helix that an arc begins: whole turns, then a part of one or another whole one, climbing evenly."""
    last = row
    while last + 1 < len(path.motion) and _is_whole(path, last) and _goes_on(path, last):
        if not _climbs_evenly(path, row, last + 1):
            break
        last += 1
    return last


def last_of_winding(path: WrittenPath, row: int, most: float) -> int:
    """Return the last row of the arcs about one centre that an arc begins, any parts of turns that climb evenly with their angle, together
    by `most` rad; an arc that doesn't climb stays by itself."""
    last, turned = row, [0.0, sweep_of(path, row)]
    while last + 1 < len(path.motion) and path.dwell[last] == 0.0 and _goes_on(path, last):
        turned.append(turned[-1] + sweep_of(path, last + 1))
        height = path.point[row - 1 : last + 2, 2].astype(np.float64)
        climb = height[-1] - height[0]
        even = height[0] + np.array(turned) / turned[-1] * climb
        if turned[-1] > most or climb == 0.0 or (np.abs(height - even) > _SLACK).any():
            break
        last += 1
    return last


def block_of(path: WrittenPath, row: int) -> Block:
    """Return one row of a path as `WrittenPath.blocks` yields it."""
    point, centre = path.point[row].tolist(), path.centre[row].tolist()
    return point, centre, int(path.motion[row]), float(path.feed[row])


def sweep_of(path: WrittenPath, row: int) -> float:
    """Return how far an arc turns, rad: a whole turn where it ends where it starts."""
    if (path.point[row, :2] == path.point[row - 1, :2]).all():
        return math.tau
    (ax, ay), (bx, by) = (
        (path.point[k, :2] - path.centre[row, :2]).tolist() for k in (row - 1, row)
    )
    turn = math.atan2(by, bx) - math.atan2(ay, ax)
    return (turn if path.motion[row] == Motion.ARC_CCW else -turn) % math.tau


def _is_whole(path: WrittenPath, row: int) -> bool:
    return bool((path.point[row, :2] == path.point[row - 1, :2]).all()) and path.dwell[row] == 0.0


def _goes_on(path: WrittenPath, row: int) -> bool:
    """Whether the row after an arc is one about the same centre at the same feed."""
    after = row + 1
    same = path.motion[row] == path.motion[after] and path.feed[row] == path.feed[after]
    about = (path.centre[row, :2] == path.centre[after, :2]).all()
    return bool(same and about and (path.more[row] == path.more[after]).all())


def _climbs_evenly(path: WrittenPath, first: int, last: int) -> bool:
    turns = math.tau * np.arange(1, last - first + 1)
    total = math.tau * (last - first) + sweep_of(path, last)
    start, end = float(path.point[first - 1, 2]), float(path.point[last, 2])
    even = start + turns / total * (end - start)
    return bool((np.abs(path.point[first:last, 2] - even) <= _SLACK).all())
