"""Compiled construction of a bounding volume hierarchy of axis-parallel boxes, top down by the binned
surface area heuristic.

A node is split where count x surface, summed over both halves, is least: the expected number of
boxes that a random query enters (Goldsmith and Salmon, Automatic creation of object hierarchies for
ray tracing, 1987). Cuts are tried at `BINS` equal steps of the boxes' centres along each axis
(Wald, On fast construction of SAH-based bounding volume hierarchies, 2007). Boxes in mm, in the
frame of the input.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Floats, Ints

BINS = 16
"""Positions along each side where a cut is tried."""
DEEPEST = 128


@njit(cache=True, nogil=True)
def build_bvh(
    low: Floats,
    high: Floats,
    face: Ints,
    leaf: int,
    order: Ints,
    boxes: Floats,
    skip: Ints,
    leaves: Ints,
    node_face: Ints,
) -> int:
    """Build the tree over boxes low, high (t, 3), t >= 1, with at most `leaf` rows a leaf, and return
    the number of nodes m.

    Nodes stand in preorder, in arrays of at least 2 t rows: boxes (m, 6) centre and half sides;
    skip (m,) the node that follows the subtree, so that a traversal needs no stack; leaves (m, 2)
    first position in `order` and count, 0 for an inner node; node_face (m,) the face (t,) of all
    rows below it, -1 when they differ. order (t,) gets the rows in the order of the leaves.

    Invariant: every node owns the contiguous run order[a:b], and its box holds the boxes of that
    run.
    """
    order[:] = np.arange(len(low))
    middle, keep = 0.5 * (low + high), np.zeros(len(low), np.int64)
    stack = np.zeros((DEEPEST, 2), np.int64)
    stack[0, 1] = len(low)
    top, count = 1, 0
    # A node is written when it is taken off the stack, the lower half on top: that is preorder.
    while top > 0:
        top -= 1
        a, b = stack[top, 0], stack[top, 1]
        node, count = count, count + 1
        node_face[node] = _fill_node_box(order[a:b], low, high, face, boxes[node])
        # A chain deeper than any sensible tree ends in one large leaf.
        if b - a <= leaf or top + 2 > DEEPEST:
            leaves[node, 0], leaves[node, 1] = a, b - a
            continue
        leaves[node, 0], leaves[node, 1] = a, 0
        cut = a + _partition_rows(order[a:b], low, high, middle, keep)
        stack[top, 0], stack[top, 1] = cut, b
        stack[top + 1, 0], stack[top + 1, 1] = a, cut
        top += 2
    # From the back: the right child of an inner node begins where the left child's subtree ends,
    # and the node's own subtree ends where the right child's does.
    for node in range(count - 1, -1, -1):
        skip[node] = node + 1 if leaves[node, 1] > 0 else skip[skip[node + 1]]
    return count


@njit(cache=True, nogil=True)
def _fill_node_box(rows: Ints, low: Floats, high: Floats, face: Ints, box: Floats) -> int:
    """Fill a node's box (6,), centre and half sides, around the boxes of some rows, and return their
    common face, -1 when there are several."""
    same = face[rows[0]]
    for r in rows:
        if face[r] != same:
            same = -1
    for k in range(3):
        least, most = np.inf, -np.inf
        for r in rows:
            least, most = min(least, low[r, k]), max(most, high[r, k])
        box[k], box[k + 3] = 0.5 * (least + most), 0.5 * (most - least)
    return same


@njit(cache=True, nogil=True)
def _partition_rows(rows: Ints, low: Floats, high: Floats, middle: Floats, keep: Ints) -> int:
    """Partition rows in place by the cheapest cut, each half in the order it had (stable), and return
    the size of the first half, 1 to len(rows) - 1.

    middle (t, 3): centres of the boxes; keep (t,): workspace.
    """
    cost, along, at, least, size = np.inf, -1, 0, 0.0, 0.0
    for k in range(3):
        first, last = np.inf, -np.inf
        for r in rows:
            first, last = min(first, middle[r, k]), max(last, middle[r, k])
        if last > first:
            weight, position = _cheapest_split(rows, low, high, middle[:, k], first, last - first)
            if weight < cost:
                cost, along, at, least, size = weight, k, position, first, last - first
    if along < 0:
        # All are about one position: halved by count.
        return len(rows) // 2
    cut = rest = 0
    for r in rows:
        if _bin(middle[r, along], least, size) < at:
            rows[cut] = r
            cut += 1
        else:
            keep[rest] = r
            rest += 1
    rows[cut:] = keep[:rest]
    return cut


@njit(cache=True, nogil=True)
def _cheapest_split(
    rows: Ints, low: Floats, high: Floats, middle: Floats, least: float, size: float
) -> tuple[float, int]:
    """Return the cost of the cheapest cut across one axis, and the bin that it lies below (1 to BINS -
    1).

    middle (t,): the centres' coordinate on that axis; `least` and `size` > 0: its range over the
    rows.
    """
    # Count and bounding box of each bin.
    bin_low, bin_high, number = (
        np.full((BINS, 3), np.inf),
        np.full((BINS, 3), -np.inf),
        np.zeros(BINS, np.int64),
    )
    for r in rows:
        c = _bin(middle[r], least, size)
        number[c] += 1
        for j in range(3):
            bin_low[c, j], bin_high[c, j] = (
                min(bin_low[c, j], low[r, j]),
                max(bin_high[c, j], high[r, j]),
            )
    # Sweep from the high end: above[c] = count x surface of bins c and higher.
    above = np.full(BINS, np.inf)
    box, count = np.array([np.inf, np.inf, np.inf, -np.inf, -np.inf, -np.inf]), 0
    for c in range(BINS - 1, 0, -1):
        count += _merge_box(box, bin_low[c], bin_high[c], number[c])
        if count:
            above[c] = count * _half_surface_area(box)
    # Sweep from the low end adds the other half; a cut with an empty side costs infinity.
    box[:3], box[3:], count = np.inf, -np.inf, 0
    cost, at = np.inf, 0
    for c in range(BINS - 1):
        count += _merge_box(box, bin_low[c], bin_high[c], number[c])
        if count and count * _half_surface_area(box) + above[c + 1] < cost:
            cost, at = count * _half_surface_area(box) + above[c + 1], c + 1
    return cost, at


@njit(cache=True, nogil=True, inline="always")
def _bin(middle: float, least: float, size: float) -> int:
    """Return the bin (0 to BINS - 1) of a centre's coordinate within least to least + size."""
    return min(int(BINS * ((middle - least) / size)), BINS - 1)


@njit(cache=True, nogil=True)
def _merge_box(box: Floats, low: Floats, high: Floats, number: int) -> int:
    """Extend a box (6,), low and high corner, by another one in place; return `number` unchanged, so
    that a sweep reads as one line."""
    for j in range(3):
        box[j], box[j + 3] = min(box[j], low[j]), max(box[j + 3], high[j])
    return number


@njit(cache=True, nogil=True)
def _half_surface_area(box: Floats) -> float:
    """Return half the surface (mm2) of a box (6,), low and high corner; the constant factor cancels in
    a comparison."""
    a, b, c = box[3] - box[0], box[4] - box[1], box[5] - box[2]
    return a * b + b * c + c * a
