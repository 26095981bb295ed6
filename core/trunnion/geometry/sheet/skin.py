"""The skin of a part for surface strategies: fine triangles with the surfaces' own normals, the tag of each one's face, ready for drops."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from trunnion.geometry.arrays import Bools, Floats, Ints, floats, ints
from trunnion.geometry.frame import Frame
from trunnion.geometry.surface.drop_surface import DropSurface
from trunnion.progress import Progress


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Skin:
    """Triangles of a part's faces in a frame.

    points (v, 3) mm on the faces; normals (v, 3) the faces' own outward unit normals there; triangles (t, 3) rows of points, anticlockwise
    seen from outside; face (t,) 1-based tags. Points are shared inside a face, not across faces; where faces meet, their points coincide.
    bound: how far the triangles may be from the faces that were wanted fine, mm; others are within `tolerance.CHORD`.
    avoid (k, 5): boxes that no tip is dropped into, as `DropSurface` has them.
    """

    points: Floats
    normals: Floats
    triangles: Ints
    face: Ints
    bound: float
    avoid: Floats = field(default_factory=lambda: np.zeros((0, 5)))
    _drop: list[DropSurface] = field(init=False, repr=False, default_factory=list)
    _plan_boxes: list[tuple[Floats, Floats]] = field(init=False, repr=False, default_factory=list)

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", floats(self.points, (None, 3), "skin points"))
        object.__setattr__(
            self, "normals", floats(self.normals, (len(self.points), 3), "skin normals")
        )
        object.__setattr__(self, "triangles", ints(self.triangles, (None, 3), "skin triangles"))
        object.__setattr__(self, "face", ints(self.face, (len(self.triangles),), "skin face"))

    @property
    def drop(self) -> DropSurface:
        """The whole skin ready for dropping cutters along -z; made on first use."""
        if not self._drop:
            made = DropSurface.of(self.points, self.triangles)
            self._drop.append(replace(made, avoid=self.avoid) if len(self.avoid) else made)
        return self._drop[0]

    def made_ready(self, progress: Progress) -> None:
        """Make the whole skin ready for dropping cutters, which takes a second for a million triangles, with looks at cancel."""
        if not self._drop:
            progress.aside(lambda _: self.drop)

    def of(self, tags: tuple[int, ...]) -> Bools:
        """Return which triangles (t,) lie on faces of some tags."""
        return np.isin(self.face, tags)

    def near(self, low: Floats, high: Floats) -> Skin:
        """Return the skin without the triangles that lie beside a box in plan with corners (2,): what is in it or over and under it."""
        if not self._plan_boxes:
            self._plan_boxes.append(_plan_boxes(self.points[:, :2], self.triangles))
        lowest, highest = self._plan_boxes[0]
        inside = (
            (highest[0] >= low[0])
            & (highest[1] >= low[1])
            & (lowest[0] <= high[0])
            & (lowest[1] <= high[1])
        )
        used, rows = np.unique(self.triangles[inside], return_inverse=True)
        return replace(
            self,
            points=self.points[used],
            normals=self.normals[used],
            triangles=rows.reshape(-1, 3),
            face=self.face[inside],
        )

    def areas(self, rows: Bools | slice = slice(None)) -> Floats:
        """Return the areas (k,) of some triangles in mm2, of all without rows."""
        a, b, c = np.moveaxis(self.points[self.triangles[rows]], 1, 0)
        return np.asarray(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1))

    def moved(self, frame: Frame, other: Frame) -> Skin:
        """Return the same skin, given in one frame, in another one."""
        if frame is other:
            return self
        return replace(
            self,
            points=other.to_local(frame.to_world(self.points)),
            normals=other.local_direction(frame.world_direction(self.normals)),
        )

    def box(self) -> tuple[Floats, Floats]:
        """Return the lowest and highest corner (3,)."""
        return self.points.min(axis=0), self.points.max(axis=0)


def _plan_boxes(points: Floats, triangles: Ints) -> tuple[Floats, Floats]:
    """Return the lowest and the highest x and y (2, t) of triangles (t, 3) of plan points (v, 2)."""
    low, high = np.empty((2, len(triangles))), np.empty((2, len(triangles)))
    for axis in range(2):
        first, second, third = (points[:, axis][triangles[:, n]] for n in range(3))
        low[axis] = np.minimum(np.minimum(first, second), third)
        high[axis] = np.maximum(np.maximum(first, second), third)
    return low, high
