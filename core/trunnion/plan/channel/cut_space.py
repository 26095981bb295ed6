"""What a ball cutter has cut on its path: the space of its ball and its flanks at close poses, in which no material is left."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.spatial import cKDTree

from trunnion.geometry.arrays import Bools, Floats, items_of, unit
from trunnion.geometry.frame import Frame
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.model.tool import Tool

RIDGE = 0.01
"""mm: the height of the ridges between the balls of two poses that are looked at: these lie so far apart."""
NEAREST = 16
"""Poses near a position that may hold it; where none of them does it counts as not cut."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CutSpace:
    """Poses of a tapered ball or ball: centres of its ball and axes (n, 3), its `radius` mm, the `flank`'s angle to the axis in rad, and
    how far above the centre it cuts, mm."""

    centre: Floats
    axis: Floats
    radius: float
    flank: float
    above: float
    _tree: list[cKDTree] = field(init=False, repr=False, default_factory=list)

    @staticmethod
    def of(path: Toolpath, tool: Tool) -> CutSpace:
        """Return what a ball or tapered ball cuts on the moves at feed of a path, in the path's frame."""
        radius = tool.corner_radius
        centre = path.position + radius * path.axis
        fed = np.flatnonzero(path.motion[1:] != Motion.RAPID)
        # Balls at a distance s leave ridges of s^2 / (8 R) between them.
        step = math.sqrt(8.0 * radius * RIDGE)
        run = np.linalg.norm(centre[fed + 1] - centre[fed], axis=1)
        count = np.maximum(np.ceil(run / step), 1.0).astype(np.int64)
        of, number = items_of(count)
        rows = fed[of]
        share = ((number + 1.0) / count[of])[:, None]
        return CutSpace(
            centre=centre[rows] + share * (centre[rows + 1] - centre[rows]),
            axis=unit(path.axis[rows] + share * (path.axis[rows + 1] - path.axis[rows])),
            radius=radius,
            flank=math.radians(tool.taper_angle) if tool.form == "taper" else 0.0,
            above=max(tool.flute_length - radius, 0.0),
        )

    def moved(self, frame: Frame, other: Frame) -> CutSpace:
        """Return the same space, given in one frame, in another one."""
        return replace(
            self,
            centre=other.to_local(frame.to_world(self.centre)),
            axis=other.local_direction(frame.world_direction(self.axis)),
        )

    def holds(self, points: Floats, within: float) -> Bools:
        """Return which points (k, 3) the cutter has cut at one of the poses near them, or missed by `within` mm at most."""
        found = np.zeros(len(points), dtype=bool)
        if not len(points) or not len(self.centre):
            return found
        if not self._tree:
            self._tree.append(cKDTree(self.centre))
        count = min(NEAREST, len(self.centre))
        near = self._tree[0].query(points, k=count)[1].reshape(len(points), count)
        rise = math.tan(self.flank)
        wide = self.radius / math.cos(self.flank)
        for row in near.T:
            away = points - self.centre[row]
            up = (away * self.axis[row]).sum(axis=1)
            off = np.linalg.norm(away - up[:, None] * self.axis[row], axis=1)
            in_ball = np.hypot(up, off) <= self.radius + within
            # The flank is a cone that touches the ball: R / cos(a) wide at its centre.
            in_flank = (up > 0.0) & (up <= self.above) & (off <= wide + rise * up + within)
            found |= in_ball | in_flank
        return found
