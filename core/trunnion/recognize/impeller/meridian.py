"""The meridian of a hub: which way the flow goes along it, and where blades stand off it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.recognize.impeller.coordinates import CylindricalSamples


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HubMeridian:
    """Points (k, 2) of a hub's meridian, radius and height in mm from inlet to outlet, with unit normals (k, 2) off the hub, and how far
    along it each lies (k,) mm."""

    point: Floats
    normal: Floats
    along: Floats

    @staticmethod
    def of(samples: CylindricalSamples, hub: tuple[int, ...], inlet: float) -> HubMeridian:
        """Return the meridian that samples and edges of the hub's faces show; the inlet lies along (1) or against (-1) the axis."""
        mine = samples.of_all(hub)
        point, normal = samples.meridian[mine], samples.normal[mine][:, [0, 2]]
        normal = normal / np.linalg.norm(normal, axis=1)[:, None]
        order = np.argsort(point[:, 0] - inlet * point[:, 1], kind="stable")
        point, normal = point[order], normal[order]
        step = np.linalg.norm(np.diff(point, axis=0), axis=1)
        return HubMeridian(
            point=point, normal=normal, along=np.concatenate([[0.0], np.cumsum(step)])
        )

    def directions(self, points: Floats) -> tuple[Floats, Floats]:
        """Return the directions (k, 2) of the flow and off the hub beside points (k, 2) of the meridian: those at the nearest point of the
        hub."""
        up = self.normal[self._nearest(points)]
        turn = np.column_stack([up[:, 1], -up[:, 0]])
        return turn * self._sense(), up

    def progress(self, points: Floats) -> Floats:
        """Return how far along the hub, mm from its first point, points (k, 2) of the meridian stand."""
        nearest = self._nearest(points)
        flow = self.directions(points)[0]
        past = np.einsum("ij,ij->i", points - self.point[nearest], flow)
        return np.asarray(self.along[nearest] + past)

    def _sense(self) -> float:
        turn = np.column_stack([self.normal[:, 1], -self.normal[:, 0]])
        chord = self.point[-1] - self.point[0]
        return 1.0 if float((turn @ chord).sum()) >= 0.0 else -1.0

    def _nearest(self, points: Floats) -> np.ndarray:
        gap = np.linalg.norm(points[:, None] - self.point[None], axis=2)
        return np.asarray(np.argmin(gap, axis=1))
