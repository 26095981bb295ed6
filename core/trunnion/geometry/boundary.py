"""The boundaries of faces as points on their edges. No CAD."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Floats, Ints, floats, ints


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Boundary:
    """Points on the edges that bound faces.

    face (e,) the tag of the face that each edge bounds (an edge between two faces is there twice), length (e,) mm; edge (k,) the row of
    the edge that each point (k, 3) lies on.
    """

    face: Ints
    length: Floats
    edge: Ints
    point: Floats

    def __post_init__(self) -> None:
        n, k = len(np.asarray(self.face)), len(np.asarray(self.edge))
        object.__setattr__(self, "face", ints(self.face, (n,), "boundary face"))
        object.__setattr__(self, "length", floats(self.length, (n,), "boundary length"))
        object.__setattr__(self, "edge", ints(self.edge, (k,), "boundary edge"))
        object.__setattr__(self, "point", floats(self.point, (k, 3), "boundary point"))

    def points_of(self, tag: int) -> Floats:
        """Return the points (k, 3) on the boundary of one face."""
        return self.point[self.face[self.edge] == tag]

    def length_of(self, tag: int) -> float:
        """Return the length of one face's boundary, mm."""
        return float(self.length[self.face == tag].sum())
