"""The least tree that joins points: a lower bound on every tour through them."""

from __future__ import annotations

import numpy as np

from trunnion.geometry.arrays import Floats


def least_tree(points: Floats) -> float:
    """Return the length of a minimum spanning tree of points (n, d).

    R. C. Prim, Shortest connection networks and some generalizations, Bell System Technical Journal 36, 1957: n steps over n distances.
    A tour without its last edge is a tree, so none is shorter.
    """
    outside = np.ones(len(points), bool)
    outside[:1] = False
    near = np.linalg.norm(points - points[:1], axis=1)
    whole = 0.0
    while outside.any():
        k = int(np.argmin(np.where(outside, near, np.inf)))
        whole += float(near[k])
        outside[k] = False
        near = np.minimum(near, np.linalg.norm(points - points[k], axis=1))
    return whole
