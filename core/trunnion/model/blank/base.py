"""What every blank answers: its box, its volume, where rays are inside it, how deep points are in it, its sides.

Nothing outside this package asks what kind a blank is. A kind gives what is abstract here; all else follows.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import ClassVar, Protocol, TypeVar

import numpy as np
import shapely

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.frame import Frame
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.region import Region
from trunnion.geometry.rays import Intervals, stacked

S = TypeVar("S", covariant=True)
RAYS = 500_000
"""Rays sent through a blank together: some tens of MB of tables."""
FINER = 2
"""Positions looked at along a side of a cell when the highest material over it is sought, beside its edges'."""


class Builder(Protocol[S]):
    """Who makes a shape of a blank, one method a kind; frames and points in the part's coordinates."""

    def box(self, frame: Frame, low: Floats, high: Floats) -> S:
        """Return the box between two corners (3,) in a frame."""

    def revolved(self, frame: Frame, outline: Floats) -> S:
        """Return the solid of an outline (k, 2) of radius and height that turns about a frame's z axis."""

    def faceted(self, points: Floats, triangles: Ints) -> S:
        """Return the solid inside closed triangles (t, 3) of points (v, 3)."""


class BlankBase(ABC):
    """A solid in a frame of its own. `low`, `high` (3,) mm: its box in `frame`; `material` a catalogue name; `density` kg/dm3; `source` the
    digest of the file that it was read from, empty for none; `is_box`: what lies between its own corners lies in it.
    """

    __slots__ = ()
    KIND: ClassVar[str]
    is_box: ClassVar[bool] = False
    frame: Frame
    low: Floats
    high: Floats
    density: float
    kind: str

    def checked_kind(self) -> None:
        """Raise `ValueError` when a file calls the blank another kind."""
        if self.kind != self.KIND:
            raise ValueError(f"blank: a {self.KIND} can't be of kind {self.kind}")

    @property
    def size(self) -> Floats:
        """Length, width and height (3,) mm of its box."""
        return self.high - self.low

    @property
    @abstractmethod
    def volume(self) -> float:
        """Volume in mm3."""

    @property
    def mass(self) -> float:
        """Mass in kg."""
        return self.volume * self.density * 1e-6

    @abstractmethod
    def measures(self) -> tuple[tuple[str, float], ...]:
        """Return its sizes in mm in the order they are called, each with the sign before it (a diameter's)."""

    def corners(self, frame: Frame) -> Floats:
        """Return the eight corners (8, 3) of its own box in a frame, which may stand askew in it."""
        (x0, y0, z0), (x1, y1, z1) = self.low, self.high
        own = np.array([[x, y, z] for x in (x0, x1) for y in (y0, y1) for z in (z0, z1)])
        return frame.to_local(self.frame.to_world(own))

    def box_in(self, frame: Frame) -> tuple[Floats, Floats]:
        """Return the lowest and the highest corner (3,) of a box in a frame that holds it: of its own box's corners."""
        if frame is self.frame:
            return self.low, self.high
        corners = self.corners(frame)
        return corners.min(axis=0), corners.max(axis=0)

    def reach(self, point: Floats, frame: Frame) -> float:
        """Return the distance in mm from a point (3,) of a frame that no point of it exceeds: that of its box's farthest corner."""
        return float(np.linalg.norm(self.corners(frame) - point, axis=1).max())

    @abstractmethod
    def intervals(self, start: Floats, direction: Floats) -> Intervals:
        """Return where rays from `start` (n, 3) along a unit `direction` (3,), both in its own frame, are inside."""

    def grid_intervals(
        self, axis: int, u: Floats, v: Floats, ends: tuple[float, float]
    ) -> Intervals:
        """Return where rays along an axis (0, 1, 2) of its own frame are inside, between two ends of that axis.

        Ray row * columns + column stands at u[column] on the axis after it and v[row] on the one after that.
        """
        direction, rows = np.eye(3)[axis], max(1, RAYS // len(u))
        parts = []
        for first in range(0, len(v), rows):
            some = v[first : first + rows]
            start = np.zeros((len(some) * len(u), 3))
            start[:, (axis + 1) % 3] = np.tile(u, len(some))
            start[:, (axis + 2) % 3] = np.repeat(some, len(u))
            parts.append(self.intervals(start, direction).clipped(*ends))
        return stacked(parts)

    def depth(self, points: Floats, frame: Frame) -> Floats:
        """Return how far below its surface points (n, 3) in a frame are at most (n,) mm, 0 outside: material left uncut on them."""
        return np.maximum(self.inward(self.own(points, frame)), 0.0)

    @abstractmethod
    def inward(self, points: Floats) -> Floats:
        """Return how far below its surface points (n, 3) in its own frame are (n,) mm, at most; negative outside, at least so far."""

    @abstractmethod
    def sides(self, points: Floats, near: float, sag: float = 0.0) -> Bools:
        """Return for points (n, 3) in its own frame in which of its s sides each lies within `near` mm (n, s); `sag` more on curved
        ones."""

    @abstractmethod
    def shell(self) -> tuple[Floats, Ints]:
        """Return points (v, 3) in its own frame and triangles (t, 3), anticlockwise from outside: to be drawn."""

    @abstractmethod
    def built(self, builder: Builder[S]) -> S:
        """Return the shape that a builder makes of it."""

    def own(self, points: Floats, frame: Frame) -> Floats:
        """Return points (n, 3) of another frame in its own one."""
        return points if frame is self.frame else self.frame.to_local(frame.to_world(points))

    def plan_area(self, frame: Frame) -> Region:
        """Return an area of a frame's plan that holds it, seen along the frame's z: the hull of its shell."""
        plan = frame.to_local(self.frame.to_world(self.shell()[0]))[:, :2]
        hull = shapely.MultiPoint(plan).convex_hull
        return Region.of([Curve.polygon(shapely.get_coordinates(hull)[:-1])])

    def tops(
        self, frame: Frame, corner: Floats, cell: float, shape: tuple[int, int], lowest: float
    ) -> Floats:
        """Return how high it stands over each cell (nx, ny) of a grid in a frame's plan, the first at `corner` (2,); `lowest` beside it.

        Looked at in places all over each cell and taken higher by what a slope rises between two of them: on the side of material.
        """
        positions = [
            c + np.arange(FINER * n + 1) * (cell / FINER)
            for c, n in zip(corner, shape, strict=True)
        ]
        grid = np.stack(np.meshgrid(*positions, indexing="ij"), axis=-1).reshape(-1, 2)
        start = np.column_stack([grid, np.zeros(len(grid))])
        direction = self.frame.local_direction(frame.z)
        seen = self.intervals(self.own(start, frame), _exact(direction)).tops(-np.inf)
        seen = seen.reshape(len(positions[0]), len(positions[1])) + cell / FINER
        over = np.full(shape, -np.inf)
        for i in range(FINER + 1):
            for j in range(FINER + 1):
                over = np.maximum(
                    over,
                    seen[
                        i : i + FINER * shape[0] : FINER,
                        j : j + FINER * shape[1] : FINER,
                    ],
                )
        return np.clip(over, lowest, float(self.box_in(frame)[1][2]))


def _exact(direction: Floats) -> Floats:
    """Return a unit direction without the noise of a turn: zeros where it is along an axis."""
    return np.where(np.abs(direction) < tolerance.PARAMETRIC, 0.0, direction)
