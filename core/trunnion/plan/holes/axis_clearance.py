"""How near a part's triangles come to an upright axis from a height on: bounds that leave little to sections of the part itself."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.frame import Frame
from trunnion.geometry.sheet.skin import Skin

TOGETHER = 64
"""Triangles in a row, near each other on their faces, that one ball stands for."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SkinGroups:
    """Triangles of a skin in groups of so many in a row, in a ball each, `centre` (b, 3) and `radius` (b,) mm: few are near an axis."""

    skin: Skin
    centre: Floats
    radius: Floats

    @staticmethod
    def of(skin: Skin) -> SkinGroups:
        """Return the triangles of a skin in groups."""
        first = np.arange(0, len(skin.triangles), TOGETHER)
        corners = skin.points[skin.triangles]
        count = np.diff(np.append(first, len(skin.triangles)))
        low = np.minimum.reduceat(corners.min(axis=1), first, axis=0)
        high = np.maximum.reduceat(corners.max(axis=1), first, axis=0)
        centre = 0.5 * (low + high)
        away = np.linalg.norm(corners - np.repeat(centre, count, axis=0)[:, None], axis=2)
        return SkinGroups(
            skin=skin, centre=centre, radius=np.maximum.reduceat(away.max(axis=1), first)
        )

    def near(self, frame: Frame, axis: Floats, within: float) -> Ints:
        """Return the rows of triangles whose ball comes `within` mm of an axis (2,), upright in a frame."""
        plan = frame.to_local(self.centre)[:, :2] - axis
        hit = np.flatnonzero(np.linalg.norm(plan, axis=1) <= self.radius + within)
        rows = (hit[:, None] * TOGETHER + np.arange(TOGETHER)).ravel()
        return rows[rows < len(self.skin.triangles)]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class AxisClearance:
    """Triangles near an upright axis: their corners (t, 3, 3) in mm about it in plan, the heights (t,) of the highest ones, and how far
    they may be from the part's faces, mm."""

    corners: Floats
    top: Floats
    bound: float

    @staticmethod
    def near(
        groups: SkinGroups, bound: float, frame: Frame, axis: Floats, within: float
    ) -> AxisClearance:
        """Return the triangles of a skin in the part's coordinates that come `within` mm of an axis (2,), upright in a frame."""
        skin = groups.skin
        triangles = skin.triangles[groups.near(frame, axis, within)]
        corners = frame.to_local(skin.points[triangles])
        corners[:, :, :2] -= axis
        plan = corners[:, :, :2]
        near = ((plan.min(axis=1) <= within) & (plan.max(axis=1) >= -within)).all(axis=1)
        corners = corners[near]
        return AxisClearance(
            corners=corners, top=corners[:, :, 2].max(axis=1, initial=-np.inf), bound=bound
        )

    def distance_from(self, z: float) -> tuple[float, float]:
        """Return bounds (mm) on the distance of the axis from all of the part that is at a height or over it, at least and at most;
        infinite for none.

        The part ends somewhere over the axis, so where its material is near from some height on, its surface is too.
        """
        least = max(self._nearest(z - self.bound) - self.bound, 0.0)
        return least, self._nearest(z + self.bound) + self.bound

    def _nearest(self, z: float) -> float:
        """Return the distance in plan of the axis from what the triangles have over a height."""
        corners = self.corners[self.top > z]
        if not len(corners):
            return np.inf
        start, end = corners, np.roll(corners, -1, axis=1)
        if _covers(corners, z).any():
            return 0.0
        # Of each edge the part over z; where it crosses z it ends, and from one crossing to the other the cut runs.
        rise = end[..., 2] - start[..., 2]
        at = (z - start[..., 2]) / np.where(rise != 0.0, rise, 1.0)
        crosses = (start[..., 2] > z) != (end[..., 2] > z)
        crossing = start + np.clip(at, 0.0, 1.0)[..., None] * (end - start)
        over = (start[..., 2] > z) | (end[..., 2] > z)
        first = np.where((crosses & (start[..., 2] <= z))[..., None], crossing, start)
        last = np.where((crosses & (end[..., 2] <= z))[..., None], crossing, end)
        nearest = _distance(first[..., :2], last[..., :2])[over].min(initial=np.inf)
        two = crosses.sum(axis=1) == 2
        if two.any():
            cut = crossing[two][crosses[two]].reshape(-1, 2, 3)
            nearest = min(nearest, float(_distance(cut[:, 0, :2], cut[:, 1, :2]).min()))
        return float(nearest)


def _covers(corners: Floats, z: float) -> Bools:
    """Return which triangles (t, 3, 3) are over the axis at 0 in plan, at a height over z there."""
    plan, edge = corners[..., :2], np.roll(corners[..., :2], -1, axis=1) - corners[..., :2]
    # Twice the signed areas of the triangles that the axis makes with each edge: the weights of the corner across from it.
    turn = edge[..., 1] * plan[..., 0] - edge[..., 0] * plan[..., 1]
    inside = (turn > 0.0).all(axis=1) | (turn < 0.0).all(axis=1)
    weight = np.roll(turn, -1, axis=1)
    whole = np.where(inside, weight.sum(axis=1), 1.0)
    height = (weight * corners[..., 2]).sum(axis=1) / whole
    return np.asarray(inside & (height > z))


def _distance(start: Floats, end: Floats) -> Floats:
    """Return the distances (…) of the axis at 0 from pieces (…, 2) in plan."""
    edge = end - start
    square = np.maximum((edge**2).sum(axis=-1), np.finfo(float).tiny)
    share = np.clip(-(start * edge).sum(axis=-1) / square, 0.0, 1.0)
    return np.asarray(np.linalg.norm(start + share[..., None] * edge, axis=-1))
