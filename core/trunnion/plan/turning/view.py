"""The plane through the work's axis, seen so that every turning operation looks alike: fed towards +u, the work below, the tool above."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from trunnion.geometry.arrays import Floats
from trunnion.model.tool import TurningTool


class TurningSide(StrEnum):
    """From where a turning tool comes to the work."""

    OUTSIDE = "outside"
    """Along the axis, on what looks away from it."""
    INSIDE = "inside"
    """Along the axis, on what looks to it."""
    FACE = "face"
    """Across the axis, on the upper end."""


@dataclass(frozen=True, slots=True)
class PassView:
    """Coordinates u along the feed and v away from the work, of points (r, z) mm: rows of the matrix are u and v.

    It is a quarter turn or a mirror image: its inverse is its transpose.
    """

    rows: tuple[tuple[float, float], tuple[float, float]]

    @staticmethod
    def of(side: TurningSide, tool: TurningTool) -> PassView:
        """Return how a tool's passes from a side are seen: a right-hand tool is fed down the axis, or inwards over a face."""
        if side is TurningSide.FACE:
            return PassView(((-1.0, 0.0), (0.0, 1.0)))
        down = -1.0 if tool.hand == "right" else 1.0
        away = -1.0 if side is TurningSide.INSIDE else 1.0
        return PassView(((0.0, down), (away, 0.0)))

    @property
    def matrix(self) -> Floats:
        """The matrix (2, 2) from (r, z) to (u, v)."""
        return np.array(self.rows)

    def seen(self, points: Floats) -> Floats:
        """Return points (n, 2) of r and z as u and v."""
        return np.asarray(points @ self.matrix.T)

    def back(self, points: Floats) -> Floats:
        """Return points (n, 2) of u and v as r and z."""
        return np.asarray(points @ self.matrix)

    def shape_seen(self, shape: BaseGeometry) -> BaseGeometry:
        """Return a shape in r and z as one in u and v."""
        return shapely.transform(shape, self.seen)

    def shape_back(self, shape: BaseGeometry) -> BaseGeometry:
        """Return a shape in u and v as one in r and z."""
        return shapely.transform(shape, self.back)
