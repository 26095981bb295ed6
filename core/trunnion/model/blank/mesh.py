"""A triangulated blank: forging, casting, near-net block, the stock that another shop left."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from trunnion.geometry.arrays import Bools, Floats, Ints, floats, ints
from trunnion.geometry.frame import Frame
from trunnion.geometry.mesh import enclosed, open_edges
from trunnion.geometry.rays import Intervals, mesh_intervals
from trunnion.model.blank.base import BlankBase, Builder, S


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Faceted(BlankBase):
    """The inside of closed triangles.

    points (v, 3) mm in `frame`; triangles (t, 3) rows of points, anticlockwise from outside, each edge shared by two (or by pairs).
    `source`: the digest of the file that it was read from, empty for none.
    """

    KIND: ClassVar[str] = "mesh"
    frame: Frame
    points: Floats
    triangles: Ints
    material: str
    density: float
    source: str = ""
    kind: str = "mesh"
    low: Floats = field(init=False)
    high: Floats = field(init=False)

    def __post_init__(self) -> None:
        self.checked_kind()
        object.__setattr__(self, "points", floats(self.points, (None, 3), "blank points"))
        object.__setattr__(self, "triangles", ints(self.triangles, (None, 3), "blank triangles"))
        if not len(self.triangles):
            raise ValueError("blank: a mesh has triangles")
        if self.triangles.min() < 0 or self.triangles.max() >= len(self.points):
            raise ValueError("blank: a triangle names a point that is not there")
        lone = open_edges(self.triangles)
        if lone:
            raise ValueError(f"blank: the mesh is not closed, {lone} edges have no partner")
        if self.volume <= 0.0:
            raise ValueError("blank: the mesh encloses nothing, its triangles look inwards")
        used = self.points[np.unique(self.triangles)]
        object.__setattr__(self, "low", floats(used.min(axis=0), (3,), "blank low"))
        object.__setattr__(self, "high", floats(used.max(axis=0), (3,), "blank high"))

    @property
    def volume(self) -> float:
        """Volume in mm3."""
        return enclosed(self.points, self.triangles)

    def measures(self) -> tuple[tuple[str, float], ...]:
        """Return length, width and height of its box."""
        return tuple(("", float(v)) for v in self.size)

    def reach(self, point: Floats, frame: Frame) -> float:
        """See `BlankBase`; exact."""
        at = self.frame.to_local(frame.to_world(point))
        return float(np.linalg.norm(self.points - at, axis=1).max())

    def intervals(self, start: Floats, direction: Floats) -> Intervals:
        """See `BlankBase`."""
        return mesh_intervals(self.points, self.triangles, start, direction)

    def inward(self, points: Floats) -> Floats:
        """See `BlankBase`: as far as the surface is along the axes, which is never less than the distance to it."""
        away, inside = self._along_axes(points)
        return np.where(inside, away, -away)

    def sides(self, points: Floats, near: float, sag: float = 0.0) -> Bools:
        """See `BlankBase`: all of it is one side."""
        return self._along_axes(points)[0][:, None] <= near + sag

    def _along_axes(self, points: Floats) -> tuple[Floats, Bools]:
        """Return how far the surface is from points (n, 3) along the axes, the nearest way (n,), and whether they are inside (n,)."""
        away, inside = np.full(len(points), np.inf), np.zeros(len(points), bool)
        for direction in np.eye(3):
            found = self.intervals(points, direction)
            there = np.arange(found.low.shape[1]) < found.count[:, None]
            for ends in (found.low, found.high):
                away = np.minimum(away, np.where(there, np.abs(ends), np.inf).min(axis=1))
            inside |= (there & (found.low <= 0.0) & (found.high >= 0.0)).any(axis=1)
        return away, inside

    def shell(self) -> tuple[Floats, Ints]:
        """See `BlankBase`."""
        return self.points, self.triangles

    def built(self, builder: Builder[S]) -> S:
        """See `BlankBase`."""
        return builder.faceted(self.frame.to_world(self.points), self.triangles)
