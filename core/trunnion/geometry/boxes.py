"""A few boxes around many points: what is near in plan goes together, where that takes in the least plan area between."""

from __future__ import annotations

import numpy as np

from trunnion.geometry.arrays import Floats, Ints

CELLS = 64
"""Cells along the longer side of what points cover in plan: a ring's sides come apart from each other, and few boxes have to be joined."""
SMALLEST = 1.0
"""mm: side of a cell at least."""


def boxes_around(points: Floats, most: int) -> Floats:
    """Return the lowest and highest corners (b, 6) of at most `most` boxes that hold all points (n, 3), sorted.

    Points in neighbouring cells of a lattice in plan are joined along rows, and equal rows with each other; then two boxes at a time, those
    whose common one takes in the least plan area that neither has.
    """
    if not len(points):
        return np.zeros((0, 6))
    plan = points[:, :2] - points[:, :2].min(axis=0)
    cell = max(float(plan.max()) / CELLS, SMALLEST)
    _, group = np.unique(np.floor(plan / cell).astype(np.int64), axis=0, return_inverse=True)
    boxes = _bounds(points, _rows(np.floor(plan / cell).astype(np.int64))[group.ravel()])
    while len(boxes) > most:
        boxes = _joined(boxes)
    return boxes[np.lexsort(boxes.T[::-1])]


def _rows(cells: Ints) -> Ints:
    """Return for each of the different cells (n, 2) of a lattice, sorted, the group it is in: runs along y, equal ones beside each other
    in one."""
    cells = np.unique(cells, axis=0)
    breaks = (np.diff(cells[:, 0]) != 0) | (np.diff(cells[:, 1]) != 1)
    run = np.concatenate([[0], np.cumsum(breaks)])
    first, last = np.flatnonzero(np.r_[True, breaks]), np.flatnonzero(np.r_[breaks, True])
    group: dict[tuple[int, int, int], int] = {}
    groups = np.empty(len(first), np.int64)
    for k, (a, b) in enumerate(zip(first.tolist(), last.tolist(), strict=True)):
        x, low, high = (int(v) for v in (*cells[a], cells[b, 1]))
        groups[k] = group[x, low, high] = group.get((x - 1, low, high), k)
    return groups[run]


def _bounds(points: Floats, group: Ints) -> Floats:
    """Return the boxes (b, 6) of points (n, 3) by their groups (n,)."""
    order = np.argsort(group, kind="stable")
    starts = np.flatnonzero(np.r_[True, np.diff(group[order]) != 0])
    low, high = (f.reduceat(points[order], starts) for f in (np.minimum, np.maximum))
    return np.hstack([low, high])


def _joined(boxes: Floats) -> Floats:
    """Return boxes (b, 6) of which two are one: those that take in the least plan area that neither has, of equal ones the first."""
    low, high = boxes[:, :3], boxes[:, 3:]
    lowest = np.minimum(low[:, None], low[None])
    highest = np.maximum(high[:, None], high[None])
    own = (high - low)[:, :2].prod(axis=1)
    more = (highest - lowest)[:, :, :2].prod(axis=2) - own[:, None] - own[None]
    more[np.tril_indices(len(boxes))] = np.inf
    a, b = divmod(int(np.argmin(more)), len(boxes))
    both = np.concatenate([lowest[a, b], highest[a, b]])
    return np.vstack([np.delete(boxes, (a, b), axis=0), both])
