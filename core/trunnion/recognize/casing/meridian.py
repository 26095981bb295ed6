"""The meridian of turned ground: its radius over the height, as straight pieces, exact on cylinders and cones."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator

from trunnion.geometry.arrays import Floats
from trunnion.recognize.casing.faces import CasingFaces
from trunnion.recognize.grow import samples
from trunnion.tolerance import COINCIDENT, FITTED

STRAIGHT = ("cylinder", "cone")
SAME_HEIGHT = 3
"""Decimals of mm to which points of a face are at one height."""
STEPS = 24
"""Straight pieces that stand for a bent meridian: 0.02 mm off on a quarter turn of 10 mm radius."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Meridian:
    """Radius over height: from each of `z` (k + 1,) to the next the radius goes straight from `low` (k,) to `high` (k,), mm.

    `outward` is +1 where the material is inside (an outer side), -1 on the inner side of a casing.
    """

    z: Floats
    low: Floats
    high: Floats
    outward: float

    @staticmethod
    def of(faces: CasingFaces, rows: Sequence[int]) -> Meridian:
        """Return the meridian of turned faces; heights are in the casing's frame."""
        spans: list[tuple[float, float, float, float]] = []
        for row in rows:
            spans += (
                _straight(faces, row) if faces.graph.surface[row] in STRAIGHT else _bent(faces, row)
            )
        merged = _merged(sorted(spans))
        outward = float(np.sign(np.mean([faces.meridian_normals[r][0] for r in rows])) or 1.0)
        return Meridian(
            z=np.array([merged[0][0], *(s[1] for s in merged)]),
            low=np.array([s[2] for s in merged]),
            high=np.array([s[3] for s in merged]),
            outward=outward,
        )

    @staticmethod
    def straight(
        ends: tuple[float, float], radii: tuple[float, float], outward: float = 1.0
    ) -> Meridian:
        """Return the meridian of one cylinder or cone between two heights."""
        return Meridian(
            z=np.array(ends), low=np.array([radii[0]]), high=np.array([radii[1]]), outward=outward
        )

    @property
    def slope(self) -> Floats:
        """Change of the radius over the height (k,) on each piece."""
        return np.asarray((self.high - self.low) / np.maximum(np.diff(self.z), COINCIDENT))

    @property
    def ends(self) -> tuple[float, float]:
        """The lowest and the highest height, mm."""
        return float(self.z[0]), float(self.z[-1])

    def piece(self, height: Floats) -> np.ndarray:
        """Return the numbers of the pieces at heights; the first and the last go on beyond the ends."""
        return np.clip(np.searchsorted(self.z, height, side="right") - 1, 0, len(self.low) - 1)

    def radius(self, height: Floats) -> Floats:
        """Return the radius (mm) at heights."""
        k = self.piece(np.asarray(height))
        return np.asarray(self.low[k] + self.slope[k] * (height - self.z[k]))

    def normal(self, height: Floats) -> Floats:
        """Return the unit normals (n, 2) out of the material at heights: away from the axis, and along it."""
        k = self.slope[self.piece(np.asarray(height))]
        size = self.outward / np.hypot(1.0, k)
        return np.column_stack([size, -k * size])

    def length(self, first: float, last: float) -> float:
        """Return the length (mm) of the meridian between two heights."""
        at = np.unique(np.clip(np.concatenate([[first, last], self.z]), first, last))
        return float(np.hypot(np.diff(at), np.diff(self.radius_inside(at))).sum())

    def area(self, first: float, last: float, angle: float) -> float:
        """Return the area (mm2) of what sweeps an angle (radians) between two heights, by Guldin's rule on each piece."""
        at = np.unique(np.clip(np.concatenate([[first, last], self.z]), first, last))
        radius = self.radius_inside(at)
        step = np.hypot(np.diff(at), np.diff(radius))
        return float(angle * (0.5 * (radius[1:] + radius[:-1]) * step).sum())

    def radius_inside(self, at: Floats) -> Floats:
        """Return the radius at ascending heights, at the last one as the piece below it has it."""
        if len(at) < 2:
            return self.radius(at)
        inside = self.radius(at)
        k = self.piece(np.array([0.5 * (at[-2] + at[-1])]))[0]
        inside[-1] = self.low[k] + self.slope[k] * (at[-1] - self.z[k])
        return inside

    def foot(self, points: Floats, along: Floats, offset: float = 0.0) -> Floats:
        """Return how far (n,) mm it is from points (n, 3) against a direction (3,) to the ground, or to what is `offset` above it.

        On each piece |p - s n| across the axis equals r + k (z - s n_z), a square equation in s; the first hit counts. NaN where the
        line misses.
        """
        flat, rise = points[:, :2], points[:, 2]
        across, climb = along[:2], float(along[2])
        best = np.full(len(points), np.nan)
        last = len(self.low) - 1
        for n, slope in enumerate(self.slope):
            k, start = float(slope), float(self.z[n])
            base = self.low[n] + k * (rise - start) + self.outward * offset * np.hypot(1.0, k)
            step = -k * climb
            a = float(across @ across) - step**2
            b = -2.0 * (flat @ across) - 2.0 * base * step
            c = (flat**2).sum(axis=1) - base**2
            for s in _roots(a, b, c):
                height = rise - s * climb
                inside = (n == 0) | (height >= start - FITTED)
                inside = inside & ((n == last) | (height <= self.z[n + 1] + FITTED))
                fits = inside & np.isfinite(s) & (s > -abs(offset) - 1.0) & (base + s * step > 0.0)
                best = np.where(fits & ~(best <= s), s, best)
        return best


def _roots(a: float, b: Floats, c: Floats) -> tuple[Floats, Floats]:
    """Return the two roots of a s^2 + b s + c, NaN where there is none."""
    if abs(a) < COINCIDENT:
        with np.errstate(divide="ignore", invalid="ignore"):
            root = -c / b
        return root, np.full(len(b), np.nan)
    with np.errstate(invalid="ignore"):
        square = np.sqrt(b * b - 4.0 * a * c)
    return (-b - square) / (2.0 * a), (-b + square) / (2.0 * a)


def _straight(faces: CasingFaces, row: int) -> list[tuple[float, float, float, float]]:
    """Return the piece of a cylinder or cone, from its lowest to its highest edge."""
    graph = faces.graph
    edges = list(graph.edges_of[row])
    points = np.concatenate(
        [graph.start[edges], graph.middle[edges], graph.end[edges], samples(graph, row)[0]]
    )
    low, high = float(points[:, 2].min()), float(points[:, 2].max())
    if graph.surface[row] == "cylinder":
        return [(low, high, float(graph.radius[row]), float(graph.radius[row]))]
    slope = np.tan(graph.minor[row]) * np.sign(graph.axis[row, 2])
    at = float(graph.axis_point[row, 2])
    radii = [float(graph.radius[row] + slope * (h - at)) for h in (low, high)]
    return [(low, high, radii[0], radii[1])]


def _bent(faces: CasingFaces, row: int) -> list[tuple[float, float, float, float]]:
    """Return straight pieces along a bent meridian: of a torus exactly, else through the radii of the face's points over their heights."""
    graph = faces.graph
    edges = list(graph.edges_of[row])
    points = np.concatenate(
        [graph.start[edges], graph.middle[edges], graph.end[edges], samples(graph, row)[0]]
    )
    height, radius = points[:, 2], np.linalg.norm(points[:, :2], axis=1)
    low, high = float(height.min()), float(height.max())
    if graph.surface[row] == "torus":
        centre, major, minor = graph.axis_point[row], graph.radius[row], graph.minor[row]
        at = np.linspace(low, high, STEPS + 1)
        side = 1.0 if np.median(radius) > major else -1.0
        r = major + side * np.sqrt(np.maximum(minor**2 - (at - centre[2]) ** 2, 0.0))
    else:
        at = np.linspace(low, high, STEPS + 1)
        known, number = np.unique(height.round(SAME_HEIGHT), return_inverse=True)
        mean = np.bincount(number, weights=radius) / np.bincount(number)
        r = PchipInterpolator(known, mean)(at) if len(known) > 1 else np.full(len(at), mean[0])
    return [
        (float(a), float(b), float(p), float(q))
        for a, b, p, q in zip(at[:-1], at[1:], r[:-1], r[1:], strict=True)
    ]


def _merged(
    spans: Sequence[tuple[float, float, float, float]],
) -> list[tuple[float, float, float, float]]:
    """Return pieces that follow each other, those of one surface once; a piece that another one covers is left out."""
    found: list[tuple[float, float, float, float]] = []
    for z0, z1, r0, r1 in spans:
        if z1 - z0 < COINCIDENT:
            continue
        if found and z0 < found[-1][1] - FITTED:
            before = found[-1]
            slope = (before[3] - before[2]) / (before[1] - before[0])
            if z1 <= before[1] + FITTED:
                continue
            if abs(before[3] + slope * (z1 - before[1]) - r1) < 10.0 * FITTED:
                found[-1] = (before[0], z1, before[2], r1)
                continue
            own = (r1 - r0) / (z1 - z0)
            z0, r0 = before[1], r0 + own * (before[1] - z0)
        found.append((z0, z1, r0, r1))
    return found or [(spans[0][0], spans[0][0] + COINCIDENT, spans[0][2], spans[0][3])]
