"""A body of revolution: round bar, disc, ring, turned envelope."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
import shapely

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints, floats
from trunnion.geometry.frame import Frame
from trunnion.geometry.plane.region import Region
from trunnion.geometry.rays import Intervals
from trunnion.geometry.revolved import (
    revolved_depth,
    revolved_intervals,
    revolved_volume,
    run_distances,
    smooth_runs,
    surface_rows,
)
from trunnion.model.blank.base import BlankBase, Builder, S

AXES = ("x", "y", "z")
ROUND = 96
"""Facets of a picture's circle: of a bar of 200 mm they are 0.05 mm from it."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Revolved(BlankBase):
    """What a closed outline sweeps about an axis of `frame`, the one that `axis` names.

    outline (k, 2): rows of radius and place along the axis in mm, anticlockwise with the radius to the right, the last joined to the first
    by a line.
    """

    source: ClassVar[str] = ""
    KIND: ClassVar[str] = "revolved"
    frame: Frame
    outline: Floats
    material: str
    density: float
    axis: str = "z"
    kind: str = "revolved"
    low: Floats = field(init=False)
    high: Floats = field(init=False)

    def __post_init__(self) -> None:
        self.checked_kind()
        if self.axis not in AXES:
            raise ValueError(f"blank: its axis is one of {', '.join(AXES)}, not {self.axis}")
        object.__setattr__(self, "outline", floats(self.outline, (None, 2), "blank outline"))
        if len(self.outline) < 3 or (self.outline[:, 0] < 0.0).any():
            raise ValueError("blank: an outline has three points or more, none beyond the axis")
        if revolved_volume(self.outline) <= 0.0 or not shapely.Polygon(self.outline).is_valid:
            raise ValueError("blank: an outline goes round anticlockwise and does not cross itself")
        wide, (bottom, top) = self.radius, (self.outline[:, 1].min(), self.outline[:, 1].max())
        low, high = np.array([-wide, -wide, bottom]), np.array([wide, wide, top])
        object.__setattr__(self, "low", floats(self._back(low), (3,), "blank low"))
        object.__setattr__(self, "high", floats(self._back(high), (3,), "blank high"))

    @staticmethod
    def cylinder(
        frame: Frame,
        radius: float,
        ends: tuple[float, float],
        material: str,
        density: float,
        axis: str = "z",
    ) -> Revolved:
        """Return a round bar about an axis of a frame, between two ends along it."""
        low, high = ends
        outline = np.array([[0.0, low], [radius, low], [radius, high], [0.0, high]])
        return Revolved(frame=frame, outline=outline, material=material, density=density, axis=axis)

    def _turned(self, points: Floats) -> Floats:
        """Return points or directions (..., 3) of the frame with the axis as the last of three."""
        k = AXES.index(self.axis)
        return points[..., [(k + 1) % 3, (k + 2) % 3, k]]

    def _back(self, points: Floats) -> Floats:
        """Return points (..., 3) with the axis last as points of the frame."""
        return np.roll(points, AXES.index(self.axis) + 1, axis=-1)

    @property
    def radius(self) -> float:
        """The largest radius in mm."""
        return float(self.outline[:, 0].max())

    @property
    def volume(self) -> float:
        """Volume in mm3."""
        return revolved_volume(self.outline)

    def measures(self) -> tuple[tuple[str, float], ...]:
        """Return the largest diameter and the length."""
        return (("\N{DIAMETER SIGN}", 2.0 * self.radius), ("", float(np.ptp(self.outline[:, 1]))))

    def box_in(self, frame: Frame) -> tuple[Floats, Floats]:
        """See `BlankBase`; as small as it can be: a circle about an axis reaches r sin(angle) along a direction."""
        axis = frame.local_direction(self._direction())
        origin = frame.to_local(self.frame.origin)
        reach = self.outline[:, :1] * np.sqrt(np.clip(1.0 - axis**2, 0.0, None))
        along = self.outline[:, 1:] * axis
        return origin + (along - reach).min(axis=0), origin + (along + reach).max(axis=0)

    def reach(self, point: Floats, frame: Frame) -> float:
        """See `BlankBase`; exact: the farthest point of a circle lies across the axis from the point."""
        at = self._turned(self.frame.to_local(frame.to_world(point)))
        across = self.outline[:, 0] + np.hypot(at[0], at[1])
        return float(np.hypot(across, self.outline[:, 1] - at[2]).max())

    def _direction(self) -> Floats:
        """Return the axis (3,) in the part's coordinates."""
        return self.frame.axes[AXES.index(self.axis)]

    def intervals(self, start: Floats, direction: Floats) -> Intervals:
        """See `BlankBase`."""
        return revolved_intervals(self.outline, self._turned(start), self._turned(direction))

    def inward(self, points: Floats) -> Floats:
        """See `BlankBase`."""
        return revolved_depth(self.outline, self._turned(points))

    def sides(self, points: Floats, near: float, sag: float = 0.0) -> Bools:
        """See `BlankBase`: a side for each run of the outline's lines without a corner, but for those on the axis; level ones are flat."""
        rows = np.array([run[0] for run in smooth_runs(self.outline)])
        points, along = self._turned(points), self.outline[:, 1]
        flat = np.abs(np.roll(along, -1) - along)[rows] <= tolerance.COINCIDENT
        off_plane = np.abs(points[:, 2, None] - along[rows])
        away = run_distances(self.outline, points)
        # Where cells follow a rim in steps they stand out of it, still in the end's plane.
        return (away <= near + sag) & (~flat | (off_plane <= near))

    def shell(self) -> tuple[Floats, Ints]:
        """See `BlankBase`: flat facets round the axis, from outside of the circles."""
        angle = 2.0 * np.pi * np.arange(ROUND) / ROUND
        around = np.column_stack([np.cos(angle), np.sin(angle)]) / np.cos(np.pi / ROUND)
        r, z = self.outline.T
        points = np.dstack(
            [r[:, None] * around[:, 0], r[:, None] * around[:, 1], np.tile(z[:, None], ROUND)]
        )
        k, n = len(r), np.arange(ROUND)
        # A point on the axis is one, not a circle of them.
        row_of = np.where(r[:, None] > 0.0, n, 0) + ROUND * np.arange(k)[:, None]
        triangles = []
        for row in surface_rows(self.outline):
            a, b = row_of[row], row_of[(row + 1) % k]
            if r[row] > 0.0:
                triangles.append(np.column_stack([a, np.roll(a, -1), b]))
            if r[(row + 1) % k] > 0.0:
                triangles.append(np.column_stack([np.roll(a, -1), np.roll(b, -1), b]))
        used, rows = np.unique(np.vstack(triangles), return_inverse=True)
        return self._back(points.reshape(-1, 3)[used]), rows.reshape(-1, 3).astype(np.int64)

    def built(self, builder: Builder[S]) -> S:
        """See `BlankBase`."""
        x = self.frame.axes[(AXES.index(self.axis) + 1) % 3]
        return builder.revolved(Frame(self.frame.origin, x, self._direction()), self.outline)

    def plan_area(self, frame: Frame) -> Region:
        """See `BlankBase`; seen along its axis a disc."""
        if abs(self._direction() @ frame.z) > 1.0 - tolerance.PARAMETRIC:
            return Region.circle(frame.to_local(self.frame.origin)[:2], self.radius)
        return BlankBase.plan_area(self, frame)
