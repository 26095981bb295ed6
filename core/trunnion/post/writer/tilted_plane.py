"""Plane positioning: the stretch of a path whose tool keeps one direction, in the coordinates of a plane tilted to it."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.post.ticks import TickScale
from trunnion.shop.kinematics import UPRIGHT

_UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TiltedPlane:
    """A plane through the origin of the setup: `ticks` are its three angles as they are written, `matrix` (3, 3) has its axes as
    columns."""

    ticks: tuple[int, int, int]
    matrix: Floats

    @property
    def upright(self) -> bool:
        """Whether it is the plane XY of the setup itself."""
        return self.ticks == (0, 0, 0)

    def local(self, points: Floats) -> Floats:
        """Return points (..., 3) of the setup frame in the plane's coordinates."""
        return np.asarray(points @ self.matrix)


def plane_across(axis: Floats, order: str, degrees: TickScale) -> TiltedPlane:
    """Return the plane across a tool axis (3,), by angles that are rounded as they are written: what is told to the control is exact."""
    x, y, z = axis.tolist()
    if order == "XYZ":
        angles = [math.atan2(-y, z), math.asin(max(-1.0, min(1.0, x))), 0.0]
        if math.hypot(y, z) < UPRIGHT:
            angles[0] = 0.0
    elif order == "ZYX":
        about_y = math.atan2(x, z) if math.hypot(x, z) > UPRIGHT else 0.0
        angles = [0.0, about_y, -math.asin(max(-1.0, min(1.0, y)))]
    else:
        lean = math.atan2(math.hypot(x, y), z)
        angles = [math.atan2(x, -y) if lean > UPRIGHT else 0.0, lean, 0.0]
    ticks = tuple(degrees.ticks(np.degrees(angles)).tolist())
    turns = zip(order, np.radians(np.array(ticks) / 10.0**degrees.decimals).tolist(), strict=True)
    matrix = np.linalg.multi_dot([_about(letter, angle) for letter, angle in turns])
    return TiltedPlane(ticks=ticks, matrix=matrix)


def plane_rows(path: Toolpath) -> tuple[int, int] | None:
    """Return the first and the last row of the stretch in which a tool feeds and keeps one direction; None where it turns as it feeds.

    What lies outside of the stretch are rapids that turn the tool to it or away from it.
    """
    feeds = np.flatnonzero(path.motion != Motion.RAPID)
    axis = path.axis[feeds[0]] if len(feeds) else path.axis[0]
    same = np.linalg.norm(path.axis - axis, axis=1) <= UPRIGHT
    rows = np.flatnonzero(same)
    first, last = int(rows[0]), int(rows[-1])
    whole = same[first : last + 1].all() and path.motion[first] == Motion.RAPID
    if not len(feeds):
        return (first, last) if whole and len(rows) == len(path) else None
    return (first, last) if whole and first < feeds[0] and feeds[-1] <= last else None


def in_plane_of(path: Toolpath, rows: tuple[int, int], plane: TiltedPlane) -> Toolpath:
    """Return the rows of a path in the coordinates of a plane, the tool along its z."""
    first, last = rows
    part = slice(first, last + 1)
    cycles = tuple(
        replace(c, first=c.first - first, last=c.last - first)
        for c in path.cycles
        if c.first > first and c.last <= last
    )
    return Toolpath(
        position=plane.local(path.position[part]),
        axis=np.tile(_UP, (last + 1 - first, 1)),
        motion=path.motion[part],
        centre=plane.local(path.centre[part]),
        feed=path.feed[part],
        mark=path.mark[part],
        dwell=None if path.dwell is None else path.dwell[part],
        cycles=cycles,
    )


def _about(letter: str, angle: float) -> Floats:
    """Return the matrix (3, 3) that turns right-handed about a coordinate axis."""
    c, s = math.cos(angle), math.sin(angle)
    i, j = {"X": (1, 2), "Y": (2, 0), "Z": (0, 1)}[letter]
    matrix = np.eye(3)
    matrix[i, i] = matrix[j, j] = c
    matrix[i, j], matrix[j, i] = -s, s
    return matrix
