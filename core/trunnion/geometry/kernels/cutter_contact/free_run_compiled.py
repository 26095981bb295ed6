"""`kernels.cutter_contact.free_run` compiled: from one triangle that blocks the tip to the end of what it blocks, until none does.

The height that a triangle lifts a tip to is concave along a line: what it blocks is one interval, whose end is found by
halving drops on that triangle alone. The tree (`drop_bvh`) is searched for any triangle that blocks, and no further: mostly the
whole search is needed once, to know that nothing does. mm, tool axis +z.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.kernels.cutter_contact.drop_cutter import RHO1
from trunnion.geometry.kernels.cutter_contact.drop_cutter_compiled import (
    ALL,
    DEEPEST,
    HIGH_X,
    HIGH_Y,
    LOW_X,
    LOW_Y,
    OWNS,
    SECANT,
    _node_bound,
    _plane_lift,
    _triangle_drop,
)
from trunnion.geometry.kernels.kernel_arrays import BORROWED

MOST_BLOCKING = 2000
"""Triangles that block a tip one after the other, at most; then it counts as not free within its distance."""


@njit(**BORROWED)
def _blocking_row(
    px: float,
    py: float,
    height: float,
    facets: Floats,
    start: Ints,
    boxes: Floats,
    node_planes: Floats,
    planes: Floats,
    node_lifts: Floats,
    lifts: Floats,
    pieces: Floats,
    ball: float,
    nodes: Ints,
    reaches: Floats,
) -> int:
    """Return the row of a facet that lifts a tip over (px, py) above a height (mm), -1 where none does; the arrays are those of
    `drop_cutter_loop`, nodes and reaches (`DEEPEST`,) room for the search."""
    radius = pieces[len(pieces) - 1, RHO1]
    inner = len(start) - 2
    nodes[0], reaches[0] = 0, np.inf
    waiting = 1
    # Depth first, the more promising child first. Invariant: what may block is on the stack.
    while waiting > 0:
        waiting -= 1
        node, reach = nodes[waiting], reaches[waiting]
        while node < inner and reach > height:
            a, b = 2 * node + 1, 2 * node + 2
            if node_lifts[a, SECANT] == 0.0:
                _plane_lift(node_planes[a], pieces, node_lifts[a])
            if node_lifts[b, SECANT] == 0.0:
                _plane_lift(node_planes[b], pieces, node_lifts[b])
            reach = _node_bound(px, py, boxes[a], node_lifts[a], pieces, radius, ball, height)
            other = _node_bound(px, py, boxes[b], node_lifts[b], pieces, radius, ball, height)
            node = a
            if other > reach:
                node, b = b, a
                reach, other = other, reach
            if other > height:
                nodes[waiting], reaches[waiting] = b, other
                waiting += 1
        if reach > height:
            for r in range(start[node - inner], start[node - inner + 1]):
                if lifts[r, SECANT] == 0.0:
                    _plane_lift(planes[r], pieces, lifts[r])
                owns = int(facets[r, OWNS])
                lifted = _triangle_drop(
                    px, py, facets[r], lifts[r], owns, pieces, radius, ball, height
                )
                if lifted > height:
                    return r
    return -1


@njit(**BORROWED)
def _blocked_end(
    px: float,
    py: float,
    dx: float,
    dy: float,
    low: float,
    most: float,
    height: float,
    f: Floats,
    lift: Floats,
    pieces: Floats,
    ball: float,
    close: float,
) -> float:
    """Return where (mm along the direction) a facet (19,) that blocks at `low` blocks no more, no more than `close` behind its end; `most`
    where it still blocks there."""
    radius = pieces[len(pieces) - 1, RHO1]
    # Out of its box by more than the cutter's radius nothing is blocked.
    high = most
    if dx > 0.0:
        high = min(high, (f[HIGH_X] + radius - px) / dx)
    elif dx < 0.0:
        high = min(high, (f[LOW_X] - radius - px) / dx)
    if dy > 0.0:
        high = min(high, (f[HIGH_Y] + radius - py) / dy)
    elif dy < 0.0:
        high = min(high, (f[LOW_Y] - radius - py) / dy)
    high = max(high, low + close)
    if high >= most:
        high = most
        x, y = px + high * dx, py + high * dy
        if _triangle_drop(x, y, f, lift, ALL, pieces, radius, ball, height) > height:
            return most
    while high - low > close:
        middle = 0.5 * (low + high)
        x, y = px + middle * dx, py + middle * dy
        if _triangle_drop(x, y, f, lift, ALL, pieces, radius, ball, height) > height:
            low = middle
        else:
            high = middle
    return high


@njit(cache=True, nogil=True)
def free_run_loop(
    first: int,
    last: int,
    points: Floats,
    direction: Floats,
    heights: Floats,
    most: Floats,
    close: float,
    facets: Floats,
    start: Ints,
    boxes: Floats,
    node_planes: Floats,
    planes: Floats,
    node_lifts: Floats,
    lifts: Floats,
    pieces: Floats,
    ball: float,
    out: Floats,
    found: Bools,
) -> None:
    """Fill out[first:last] with how far (mm) tips over plan points (n, 2), at heights (n,), go along unit directions (n, 2) until no facet
    blocks them, no more than `close` farther than they need, and found (n,) with whether they come free no farther than most (n,); 0
    for those that don't, and for those that nothing blocks. Facets and their tree as `drop_cutter_loop` has them.

    What a tip came free of last mostly blocks the next one too.
    """
    radius = pieces[len(pieces) - 1, RHO1]
    nodes, reaches = np.empty(DEEPEST, np.int64), np.empty(DEEPEST)
    before = -1
    for n in range(first, last):
        px, py, dx, dy = points[n, 0], points[n, 1], direction[n, 0], direction[n, 1]
        height, end = heights[n], most[n] + close
        at, row, is_free = 0.0, -1, False
        if before >= 0:
            f, lift = facets[before], lifts[before]
            if _triangle_drop(px, py, f, lift, ALL, pieces, radius, ball, height) > height:
                row = before
        for _ in range(MOST_BLOCKING):
            if row < 0:
                row = _blocking_row(
                    px + at * dx,
                    py + at * dy,
                    height,
                    facets,
                    start,
                    boxes,
                    node_planes,
                    planes,
                    node_lifts,
                    lifts,
                    pieces,
                    ball,
                    nodes,
                    reaches,
                )
                if row < 0:
                    is_free = True
                    break
            at = _blocked_end(
                px, py, dx, dy, at, end, height, facets[row], lifts[row], pieces, ball, close
            )
            before, row = row, -1
            if at >= end:
                break
        found[n] = is_free and at > 0.0
        out[n] = at if found[n] else 0.0
