"""Clamps as boxes, and how near paths come to them: what the tests of fixtures share."""

from __future__ import annotations

import numpy as np

from trunnion.geometry.mesh import Mesh
from trunnion.model.fixture import Fixture
from trunnion.toolpath.stock.heightfield import positions_on


def box_mesh(low, high):
    """Return a box as a mesh, anticlockwise from outside."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    points = [(x, y, z) for z in (z0, z1) for y in (y0, y1) for x in (x0, x1)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return Mesh(
        points, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))], np.ones(12, int)
    )


def clamp(low, high, setup="", name="clamp"):
    """Return a box from corner to corner, in the part's coordinates, as a fixture."""
    return Fixture(name=name, mesh=box_mesh(low, high), setup=setup)


def least_room(path, tool, frame, low, high, apart=0.5):
    """Return how near in mm an upright tool comes to a box of the part's coordinates on a path of a frame: in plan beside it, in height
    over it; of cutter and of all that is wider, on positions `apart` mm from each other."""
    corners = frame.to_local(np.array([low, high], dtype=float))
    low, high = corners.min(axis=0), corners.max(axis=0)
    size = np.linalg.norm(np.diff(path.position, axis=0, prepend=path.position[:1]), axis=1)
    count = np.maximum(np.ceil(size / apart).astype(int), 1)
    rows = np.repeat(np.arange(len(path)), count)
    share = (np.arange(len(rows)) - np.repeat(np.cumsum(count) - count, count) + 1) / count[rows]
    tip = positions_on(path, rows, share)
    gap = np.maximum(np.maximum(low[:2] - tip[:, :2], tip[:, :2] - high[:2]), 0.0)
    beside = np.hypot(*gap.T)
    rings = [(0.0, tool.radius), *((z, max(a, b)) for z, a, _, b in tool.profile())]
    return min(
        float(np.maximum(beside - radius, tip[:, 2] + above - high[2]).min())
        for above, radius in rings
    )
