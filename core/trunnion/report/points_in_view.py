"""Which points of a part an eye sees: the others are on its far side, and a label there would lie over something else."""

from __future__ import annotations

import numpy as np

from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.mesh import Mesh

SKIN = 0.1
"""mm before a point from where on something is in front of it: its own face, and what bends beside it, is not."""
EDGE = 1e-9
"""Of a triangle's sides: a line so near to one of them crosses it, so that none goes through between two triangles."""
PARALLEL = 1e-12
"""Of a triangle's size: a line that crosses it no steeper goes along it."""


def seen_from(eye: Floats, points: Floats, mesh: Mesh) -> Bools:
    """Return which points (k, 3) on a part can be seen from an eye (3,): no triangle crosses the line between them.

    The crossing is that of Moeller and Trumbore, Fast, minimum storage ray-triangle intersection, 1997.
    """
    first, second, third = np.moveaxis(mesh.corners(), 1, 0)
    along, across = second - first, third - first
    seen = np.zeros(len(points), bool)
    for k, point in enumerate(points):
        line = eye - point
        length = float(np.linalg.norm(line))
        line = line / length
        square = np.cross(line, across)
        size = (along * square).sum(axis=1)
        crossed = np.abs(size) > PARALLEL * (np.abs(along) + np.abs(across)).max(initial=0.0) ** 2
        inverse = np.divide(1.0, size, out=np.zeros(len(size)), where=crossed)
        away = point - first
        u = (away * square).sum(axis=1) * inverse
        turned = np.cross(away, along)
        v = (turned @ line) * inverse
        at = (across * turned).sum(axis=1) * inverse
        inside = (u >= -EDGE) & (v >= -EDGE) & (u + v <= 1.0 + EDGE)
        hit = crossed & inside & (at > SKIN) & (at < length)
        seen[k] = not hit.any()
    return seen
