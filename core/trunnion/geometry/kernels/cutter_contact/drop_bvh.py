"""A complete binary bounding volume hierarchy over facets for dropping cutters: each node halved by
median across the longest side of its box.

The tree is complete and in the order of a heap: the children of node k are 2 k + 1 and 2 k + 2, the
leaves are its last level. Facets lie in the order of the leaves, so that each node has a run of
them. The median split of a kd-tree (Bentley, 1975), each level in linear time. mm, tool axis +z.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.kernels.kernel_arrays import BORROWED

X0, Y0, X1, Y1, Z1 = range(5)
"""A node's box, which has no lower end: only what is above can lift a cutter."""
BOX_COLUMNS = 5


@njit(**BORROWED)
def bvh_sort_loop(centres: Floats, start: Ints, order: Ints) -> None:
    """Sort order (t,) in place so that each node's run of the centres (t, 3) is halved across its
    longest side; start (leaves + 1,) the runs of the leaves."""
    leaves = len(start) - 1
    width = leaves
    # From the root down, a level at a time; `width` leaves lie below a node.
    while width > 1:
        for leaf in range(0, leaves, width):
            first, last = start[leaf], start[leaf + width]
            axis, longest = 0, -1.0
            for k in range(3):
                low, high = np.inf, -np.inf
                for n in range(first, last):
                    low, high = min(low, centres[order[n], k]), max(high, centres[order[n], k])
                if high - low > longest:
                    axis, longest = k, high - low
            _partition(centres, axis, order, first, last - 1, start[leaf + width // 2])
        width //= 2


@njit(**BORROWED)
def _partition(centres: Floats, axis: int, order: Ints, first: int, last: int, middle: int) -> None:
    """Order order[first:last + 1] along an axis so far that the one at `middle` has no larger ones
    before and no smaller ones after it (quickselect: Hoare, 1961)."""
    while first < last:
        pivot = centres[order[(first + last) // 2], axis]
        i, j = first, last
        while i <= j:
            # Hoare's partition: then everything up to j is at most the pivot, everything from i on
            # at least; only the side that holds the middle goes on.
            while centres[order[i], axis] < pivot:
                i += 1
            while centres[order[j], axis] > pivot:
                j -= 1
            if i <= j:
                order[i], order[j] = order[j], order[i]
                i += 1
                j -= 1
        if middle <= j:
            last = j
        elif middle >= i:
            first = i
        else:
            return


@njit(**BORROWED)
def bvh_bounds_loop(corners: Floats, start: Ints, boxes: Floats, planes: Floats) -> None:
    """Fill boxes (nodes, 5) of the facets' corners (t, 9), and the planes' (nodes, 3) last column: the
    height over (0, 0) of the lowest plane with the slopes of the first two that nothing of the node
    is above."""
    leaves = len(start) - 1
    node, width = 0, leaves
    while width > 0:
        for leaf in range(0, leaves, width):
            # The plane through the corner that stands highest over the slopes: z - g_x x - g_y y.
            x0, y0, x1, y1, z1, top = np.inf, np.inf, -np.inf, -np.inf, -np.inf, -np.inf
            for n in range(start[leaf], start[leaf + width]):
                for k in range(0, 9, 3):
                    x, y, z = corners[n, k], corners[n, k + 1], corners[n, k + 2]
                    x0, y0, x1, y1, z1 = min(x0, x), min(y0, y), max(x1, x), max(y1, y), max(z1, z)
                    top = max(top, z - planes[node, 0] * x - planes[node, 1] * y)
            boxes[node, X0], boxes[node, Y0], boxes[node, X1], boxes[node, Y1], boxes[node, Z1] = (
                x0,
                y0,
                x1,
                y1,
                z1,
            )
            planes[node, 2] = top
            node += 1
        width //= 2
