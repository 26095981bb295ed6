"""The meridian of a bladed wheel: hub and shroud as curves of radius and height, and the places between them.

A place has two coordinates: `u` along the stream, 0 where the leading edge stands and 1 at the outlet, and `w` from the hub (0) to the
shroud (1). Both curves are followed by their length, and places between them lie on straight lines from one to the other.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.spatial import cKDTree

from trunnion.geometry.arrays import Floats, floats

KNOT = 0.3
"""mm between the points that a curve is carried through: at a bend of 5 mm radius the cubic is within 0.1 um."""
NEAR = 0.004
"""mm between the places of a curve that the nearest one is looked for among."""
STEPS_U, STEPS_W = 240, 60
"""Places of the net from which the nearest one is the first guess at what coordinates a point has."""
NEWTON = 4
"""Newton steps from there: the last one is below a nanometre on smooth curves."""
BEYOND = 0.25
"""How far beyond 0 and 1 the net reaches."""


@dataclass(frozen=True, slots=False, eq=False, kw_only=True)
class MeridianSpline:
    """A curve in the meridian plane: rows (k, 2) of radius and height in mm in the order of the stream, begun at a length mm along it.

    Lengths from `start` (u = 0) to `end` (u = 1) count; beyond its rows it goes straight on.
    """

    rows: Floats
    start: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "rows", floats(self.rows, (None, 2), "meridian curve"))

    @cached_property
    def _spline(self) -> CubicSpline:
        length = np.concatenate(
            [[0.0], np.cumsum(np.linalg.norm(np.diff(self.rows, axis=0), axis=1))]
        )
        return CubicSpline(length, self.rows, axis=0)

    @property
    def length(self) -> float:
        """Length mm of all of it."""
        return float(self._spline.x[-1])

    @property
    def run(self) -> float:
        """Length mm from u = 0 to u = 1."""
        return self.length - self.start

    def at(self, u: Floats) -> tuple[Floats, Floats]:
        """Return points (k, 2) and unit directions (k, 2) along the stream at coordinates u (k,)."""
        along = self.start + np.asarray(u, dtype=np.float64) * self.run
        inside = np.clip(along, 0.0, self.length)
        tangent = self._spline(inside, 1)
        tangent /= np.linalg.norm(tangent, axis=-1, keepdims=True)
        return self._spline(inside) + (along - inside)[..., None] * tangent, tangent

    def nearest(self, point: Floats) -> Floats:
        """Return the lengths mm (k,) along it of the places nearest to points (k, 2)."""
        length = np.linspace(0.0, self.length, max(2, int(self.length / NEAR)))
        return np.asarray(length[cKDTree(self._spline(length)).query(point)[1]])

    def places(self, along: Floats) -> Floats:
        """Return the points (k, 2) at lengths mm (k,) along it."""
        return np.asarray(self._spline(along))

    @staticmethod
    def through(points: Floats) -> MeridianSpline:
        """Return the curve through points (n, 2) of a surface of revolution, in any order: it is sorted from its top inwards end to its
        lower outer end, so along radius minus height, which grows along the stream of a centrifugal or mixed-flow wheel."""
        key = points[:, 0] - points[:, 1]
        points = points[np.argsort(key, kind="stable")]
        kept, last = [points[0]], points[-1]
        for point in points[1:]:
            if np.linalg.norm(point - kept[-1]) >= KNOT:
                kept.append(point)
        if np.linalg.norm(last - kept[-1]) < 0.5 * KNOT and len(kept) > 2:
            kept.pop()
        if np.linalg.norm(last - kept[-1]) > 0.0:
            kept.append(last)
        return MeridianSpline(rows=np.array(kept))


@dataclass(frozen=True, slots=False, eq=False, kw_only=True)
class WheelMeridian:
    """Hub and shroud of a wheel in the rotor's frame: its z is the axis, towards the inlet."""

    hub: MeridianSpline
    shroud: MeridianSpline

    def at(self, u: Floats, w: Floats) -> Floats:
        """Return radius and height (k, 2) of places with coordinates u and w (k,)."""
        share = np.asarray(w, dtype=np.float64)[..., None]
        return (1.0 - share) * self.hub.at(u)[0] + share * self.shroud.at(u)[0]

    def height(self, u: Floats) -> Floats:
        """Return how far (k,) mm the shroud is from the hub at coordinates u (k,)."""
        return np.asarray(np.linalg.norm(self.shroud.at(u)[0] - self.hub.at(u)[0], axis=-1))

    @cached_property
    def _net(self) -> tuple[Floats, cKDTree]:
        u = np.linspace(-BEYOND, 1.0 + BEYOND, STEPS_U)
        w = np.linspace(-BEYOND, 1.0 + BEYOND, STEPS_W)
        uw = np.stack(np.meshgrid(u, w, indexing="ij"), axis=-1).reshape(-1, 2)
        return uw, cKDTree(self.at(uw[:, 0], uw[:, 1]))

    def coordinates(self, point: Floats) -> Floats:
        """Return u and w (k, 2) of points (k, 2) given by radius and height: Newton's method from the nearest place of a net."""
        uw, tree = self._net
        found = uw[np.asarray(tree.query(point)[1])].copy()
        step = 1e-5
        for _ in range(NEWTON):
            here = self.at(found[:, 0], found[:, 1])
            by_u = (self.at(found[:, 0] + step, found[:, 1]) - here) / step
            by_w = (self.at(found[:, 0], found[:, 1] + step) - here) / step
            off = point - here
            det = by_u[:, 0] * by_w[:, 1] - by_u[:, 1] * by_w[:, 0]
            safe = np.where(np.abs(det) > 1e-9, det, 1.0)
            more = np.column_stack(
                [
                    (off[:, 0] * by_w[:, 1] - off[:, 1] * by_w[:, 0]) / safe,
                    (by_u[:, 0] * off[:, 1] - by_u[:, 1] * off[:, 0]) / safe,
                ]
            )
            found += np.clip(np.where(np.abs(det)[:, None] > 1e-9, more, 0.0), -0.05, 0.05)
        return found


def cylindrical(points: Floats) -> tuple[Floats, Floats]:
    """Return radius and height (k, 2), and the angle (k,) rad about z, of points (k, 3)."""
    return (
        np.column_stack([np.hypot(points[:, 0], points[:, 1]), points[:, 2]]),
        np.arctan2(points[:, 1], points[:, 0]),
    )


def in_space(meridian: Floats, angle: Floats) -> Floats:
    """Return points (k, 3) from radius and height (k, 2) and the angle (k,) rad about z."""
    return np.stack(
        [
            meridian[..., 0] * np.cos(angle),
            meridian[..., 0] * np.sin(angle),
            meridian[..., 1],
        ],
        axis=-1,
    )
