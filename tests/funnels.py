"""Skins of pockets whose four plane walls lean, in closed form."""

from __future__ import annotations

import math

import numpy as np

from surface_drives import joined
from trunnion.geometry.arrays import Floats
from trunnion.geometry.sheet.skin import Skin

HEIGHT = 30.0
SIDES = ((40.0, 0.0), (0.0, 30.0), (-40.0, 0.0), (0.0, -30.0))
"""From corner to corner of a pocket's foot, anticlockwise: what is free is on the left."""


def planes(leans: tuple[float, ...], size: float = 1.0) -> tuple[Floats, Floats]:
    """Return a point and the outward normal (4, 3) of each wall of a pocket; it leans away from what is free by its angle, degrees."""
    start = size * np.cumsum(np.vstack([[0.0, 0.0], SIDES[:-1]]), axis=0)
    normals = []
    for (dx, dy), lean in zip(SIDES, leans, strict=True):
        inside = np.array([-dy, dx]) / math.hypot(dx, dy)
        a = math.radians(lean)
        normals.append([*(math.cos(a) * inside), math.sin(a)])
    return np.column_stack([start, np.zeros(4)]), np.array(normals)


def edges(normals: Floats) -> Floats:
    """Return the unit directions (4, 3) upwards of the edges in which each wall meets the one before."""
    found = np.cross(np.roll(normals, 1, axis=0), normals)
    found *= np.sign(found[:, 2:])
    return np.asarray(found / np.linalg.norm(found, axis=1, keepdims=True))


def funnel(leans: tuple[float, ...], size: float = 1.0, height: float = HEIGHT) -> Skin:
    """Return the skin of the walls of such a pocket of a height in mm, tags 1 to 4."""
    foot, normals = planes(leans, size)
    up = edges(normals)
    rim = foot + height / up[:, 2:] * up
    quads = []
    for k in range(4):
        n = (k + 1) % 4
        points = np.array([foot[k], foot[n], rim[n], rim[k]])
        quads.append(
            Skin(
                points=points,
                normals=np.broadcast_to(normals[k], points.shape),
                triangles=np.array([[0, 1, 2], [0, 2, 3]]),
                face=np.full(2, k + 1),
                bound=0.0,
            )
        )
    return joined(*quads)
