"""How near a part's triangles come to an upright axis from a height on: a quick bound where nothing stands around a hole."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.geometry.frame import Frame
from trunnion.geometry.sheet.skin import Skin


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class AxisClearance:
    """Triangles near an upright axis: their corners (t, 3, 3) in mm about it in plan, the heights (t,) of the highest ones, and how far
    they may be from the part's faces, mm."""

    corners: Floats
    top: Floats
    bound: float

    @staticmethod
    def near(skin: Skin, bound: float, frame: Frame, axis: Floats, within: float) -> AxisClearance:
        """Return the triangles of a skin in the part's coordinates that come `within` mm of an axis (2,), upright in a frame."""
        points = frame.to_local(skin.points)
        points[:, :2] -= axis
        plan = points[:, :2][skin.triangles]
        near = ((plan.min(axis=1) <= within) & (plan.max(axis=1) >= -within)).all(axis=1)
        corners = points[skin.triangles[near]]
        return AxisClearance(
            corners=corners, top=corners[:, :, 2].max(axis=1, initial=-np.inf), bound=bound
        )

    def distance_from(self, z: float) -> float:
        """Return a lower bound (mm) on the distance of the axis from all of the part that is at a height or over it; infinite for none.

        The part ends somewhere over the axis, so where its material is near from some height on, its surface is too. A triangle that is
        partly higher counts with all of its shadow.
        """
        shadow = self.corners[self.top > z - self.bound, :, :2]
        if not len(shadow):
            return np.inf
        start, edge = shadow, np.roll(shadow, -1, axis=1) - shadow
        square = np.maximum((edge**2).sum(axis=2), np.finfo(float).tiny)
        share = np.clip(-(start * edge).sum(axis=2) / square, 0.0, 1.0)
        nearest = np.linalg.norm(start + share[..., None] * edge, axis=2).min(axis=1)
        turn = edge[..., 0] * start[..., 1] - edge[..., 1] * start[..., 0]
        inside = (turn > 0.0).all(axis=1) | (turn < 0.0).all(axis=1)
        return 0.0 if inside.any() else max(float(nearest.min()) - self.bound, 0.0)
