"""The development of a cylinder or a cone: its surface laid flat without stretching, and what stands on it over that plane.

Source: do Carmo, Differential Geometry of Curves and Surfaces, 5-3 (developable surfaces). A point of the plane has the coordinates u along
the circles, v along the straight lines from the surface's reference circle, and h along the normal. A straight body of radius R whose axis
is a normal stays, to the second order in R over the radius of the surface, inside of the upright cylinder of that radius over the plane:
what it keeps clear of in the development it keeps clear of in space, where the surface bulges towards it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.geometry.frame import Frame

CYLINDRICAL = 1e-7
"""Sine of a cone's half angle below which it is laid flat as a cylinder: 0.1 um on a metre."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Development:
    """A cylinder or cone about a frame's z: its `radius` mm at a `height` mm, by how much the radius changes over the height (`slope`),
    and the angle (rad) about z that the plane's middle, u = 0, lies at. The surface's outside is above the plane."""

    frame: Frame
    radius: float
    height: float
    slope: float
    middle: float

    @property
    def _along(self) -> tuple[float, float]:
        """The unit direction of the straight lines: away from the axis, and along it."""
        size = math.hypot(1.0, self.slope)
        return self.slope / size, 1.0 / size

    @property
    def half_turn(self) -> float:
        """Half the angle (rad) that the surface takes of the plane: pi times the sine of its half angle, 0 for a cylinder."""
        return math.pi * abs(self._along[0])

    def radius_at(self, v: Floats) -> Floats:
        """Return the radius (mm) of the surface at places v along its straight lines."""
        return np.asarray(self.radius + self._along[0] * np.asarray(v))

    def least_width(self, v: Floats, h: Floats) -> float:
        """Return the least width that a straight body with its axis along a normal has over the plane, as a share of its own, at places v
        (n,) and heights h (n,) mm: on a circle of radius R it spans the angle 2 asin(r / (R + h)), over the plane R times that."""
        radius = self.radius_at(v)
        return float((radius / (radius + np.maximum(h, 0.0) * self._along[1])).min())

    def to_local(self, points: Floats) -> Floats:
        """Return u, v, h (..., 3) of points in the part's coordinates."""
        local = self.frame.to_local(points)
        turn = np.arctan2(local[..., 1], local[..., 0]) - self.middle
        turn = np.mod(turn + np.pi, 2.0 * np.pi) - np.pi
        return self.from_cylindrical(np.hypot(local[..., 0], local[..., 1]), turn, local[..., 2])

    def from_cylindrical(self, radius: Floats, turn: Floats, height: Floats) -> Floats:
        """Return u, v, h (..., 3) of points by radius, angle (rad) from the plane's middle, which may pass half a turn, and height."""
        across, along = self._along
        dr, dz = radius - self.radius, height - self.height
        y, h = dr * across + dz * along, dr * along - dz * across
        if abs(across) < CYLINDRICAL:
            return np.stack([self.radius * turn, y, h], axis=-1)
        apex = self.radius / across
        return np.stack(
            [(apex + y) * np.sin(turn * across), (apex + y) * np.cos(turn * across) - apex, h],
            axis=-1,
        )

    def at(self, along: Floats, turns: Floats) -> Floats:
        """Return the plane's points u, v (..., 2) at places along the straight lines and angles (rad) about the axis from its middle."""
        across, _ = self._along
        if abs(across) < CYLINDRICAL:
            return np.stack([self.radius * turns, along], axis=-1)
        apex = self.radius / across
        return np.stack(
            [
                (apex + along) * np.sin(turns * across),
                (apex + along) * np.cos(turns * across) - apex,
            ],
            axis=-1,
        )

    def nearest_tip(self, start: Floats, end: Floats) -> Floats:
        """Return the places (k,) along the straight lines where straight ways over the plane, from points to others (k, 3), come nearest to
        a cone's tip; of a cylinder's plane, where they end."""
        across, _ = self._along
        if abs(across) < CYLINDRICAL:
            return np.asarray(end[:, 1])
        a, way = start[:, :2] + [0.0, self.radius / across], end[:, :2] - start[:, :2]
        square = np.maximum((way * way).sum(axis=1), np.finfo(float).tiny)
        share = np.clip(-(a * way).sum(axis=1) / square, 0.0, 1.0)
        return self.along_and_turn(start + share[:, None] * (end - start))[0]

    def to_world(self, flat: Floats) -> Floats:
        """Return points (..., 3) in the part's coordinates of u, v, h."""
        y, turn = self.along_and_turn(flat)
        return self.points_about_axis(y, turn, flat[..., 2])

    def points_about_axis(self, along: Floats, turns: Floats, heights: Floats) -> Floats:
        """Return points (..., 3) in the part's coordinates at places along the straight lines, angles (rad) about the axis from the plane's
        middle, which may pass half a turn, and heights (mm) over the surface."""
        across, up = self._along
        radius = self.radius + along * across + heights * up
        height = self.height + along * up - heights * across
        turn = turns + self.middle
        return self.frame.to_world(
            np.stack([radius * np.cos(turn), radius * np.sin(turn), height], axis=-1)
        )

    def normals(self, flat: Floats) -> Floats:
        """Return the unit normals (..., 3) out of the surface, in the part's coordinates, over u, v, h."""
        return self.normals_about_axis(self.along_and_turn(flat)[1])

    def normals_about_axis(self, turns: Floats) -> Floats:
        """Return the unit normals (..., 3) out of the surface, in the part's coordinates, at angles (rad) about the axis from the plane's
        middle."""
        across, along = self._along
        turn = turns + self.middle
        level = np.full(turn.shape, -across)
        return self.frame.world_direction(
            np.stack([along * np.cos(turn), along * np.sin(turn), level], axis=-1)
        )

    def turns(self, flat: Floats) -> Floats:
        """Return the angles (...,) rad about the axis, from the plane's middle, of u, v, h."""
        return self.along_and_turn(flat)[1]

    def along_and_turn(self, flat: Floats) -> tuple[Floats, Floats]:
        """Return the places (...,) mm along the straight lines and the angles (...,) rad from the plane's middle of u, v, h."""
        across, _ = self._along
        u, v = flat[..., 0], flat[..., 1]
        if abs(across) < CYLINDRICAL:
            return np.asarray(v), np.asarray(u / self.radius)
        apex = self.radius / across
        sign = math.copysign(1.0, apex)
        far = sign * np.hypot(u, v + apex)
        return far - apex, np.arctan2(sign * u, sign * (v + apex)) / across
