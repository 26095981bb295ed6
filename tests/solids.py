"""Cutters and their sweeps as solids of manifold3d: an oracle for volumes that shares nothing with the engines but the outlines."""

from __future__ import annotations

import math
from itertools import pairwise

import manifold3d as m3
import numpy as np

from trunnion.verify.cutter import outline_of

ROUND = 160
"""Segments around a cutter: a circle loses 0.03 % of its area."""


def box_solid(low, high):
    """Return a box."""
    return m3.Manifold.cube(np.subtract(high, low)).translate(low)


def cutter_solid(tool):
    """Return what cuts, upright with its tip in the origin."""
    points = [(0.0, 0.0)]
    for r0, z0, r1, z1, cr, cz, radius in outline_of(tool):
        points.append((r0, z0))
        if radius:
            a, b = math.atan2(z0 - cz, r0 - cr), math.atan2(z1 - cz, r1 - cr)
            turn = math.remainder(b - a, math.tau)
            points += [
                (
                    cr + abs(radius) * math.cos(a + turn * t),
                    cz + abs(radius) * math.sin(a + turn * t),
                )
                for t in np.linspace(0.0, 1.0, 24)[1:-1]
            ]
        points.append((r1, z1))
    points.append((0.0, points[-1][1]))
    clean = [p for k, p in enumerate(points) if k == 0 or math.dist(p, points[k - 1]) > 1e-9]
    return m3.Manifold.revolve(m3.CrossSection([clean], m3.FillRule.NonZero), ROUND)


def stood(solid, tip, axis):
    """Return an upright solid with its tip at a place and its axis along a direction."""
    z = np.asarray(axis) / np.linalg.norm(axis)
    x = np.eye(3)[np.abs(z).argmin()]
    x = x - (x @ z) * z
    x /= np.linalg.norm(x)
    return solid.transform(np.column_stack([x, np.cross(z, x), z, tip]))


def swept(solid, tips, axes):
    """Return a convex solid swept from pose to pose: the hulls of neighbours, exact where the axis keeps still."""
    poses = [stood(solid, t, a) for t, a in zip(tips, axes, strict=True)]
    hulls = [m3.Manifold.batch_hull([a, b]) for a, b in pairwise(poses)] or poses
    return m3.Manifold.batch_boolean(hulls, m3.OpType.Add)
