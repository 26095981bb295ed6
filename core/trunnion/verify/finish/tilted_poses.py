"""Leaning poses that touch a point of the part: what a machine with rotary axes may try where no upright cutter gets."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats
from trunnion.model.tool import Tool
from trunnion.verify.machine.kinematics import UP

LEANS = np.radians([15.0, 30.0, 60.0, 90.0])
AROUND = 8
"""Directions of a lean."""


def leaning_axes(normal: Floats) -> Iterator[Floats]:
    """Yield tool axes (k, 3) to try at points with outward normals (k, 3): the normal itself, leans from it, and leans from upright."""
    yield normal
    for about in (normal, np.broadcast_to(UP, normal.shape)):
        x = np.where(np.abs(about[:, :1]) < 0.9, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
        x = x - (x * about).sum(axis=1, keepdims=True) * about
        x /= np.linalg.norm(x, axis=1, keepdims=True)
        y = np.cross(about, x)
        for lean in LEANS:
            for turn in 2.0 * np.pi * np.arange(AROUND) / AROUND:
                yield np.cos(lean) * about + np.sin(lean) * (np.cos(turn) * x + np.sin(turn) * y)


def touching_tips(tool: Tool, point: Floats, normal: Floats, axis: Floats) -> tuple[Floats, Bools]:
    """Return the tips (k, 3) of a plain cutter that touches points from outside with its axis as given, and where that makes sense.

    It touches with its end's corner, or with the middle of its flank where the face runs along the axis.
    """
    along = (normal * axis).sum(axis=1)
    across = normal - along[:, None] * axis
    size = np.linalg.norm(across, axis=1)
    square, is_flank = size < np.sin(tolerance.ANGLE), np.abs(along) < np.sin(tolerance.ANGLE)
    out = np.divide(across, size[:, None], out=np.zeros_like(across), where=~square[:, None])
    tips = point + tool.corner_radius * (normal - axis) + (tool.radius - tool.corner_radius) * out
    tips -= (0.5 * (tool.flute_length - tool.corner_radius) * is_flank)[:, None] * axis
    return tips, along > -np.sin(tolerance.ANGLE)
