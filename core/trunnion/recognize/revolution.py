"""The main axis of a part and the faces of revolution about it, read from its face graph whatever surfaces they are written as."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.facegraph import FaceGraph
from trunnion.tolerance import COINCIDENT, SLIVER
from trunnion.units import radians

ROUND = ("cylinder", "cone", "torus", "revolution")
"""Surfaces that carry an axis."""
CANDIDATES = 8
"""Lines that are tried as the main axis: those that most area and most circular edges turn about."""
SAME_LINE = 2e-3
"""Distance of two lines over the part's size up to which they are one axis: rims and fits of imported files scatter by less."""
SAME_DIRECTION = radians(0.5)
"""The same for their angle, in radians."""
OUT_OF_MERIDIAN = radians(1.5)
"""A face is of revolution when no normal of its samples leaves the plane through the axis by more than this, in radians: fitted
surfaces stay far below, a blade or a flat pad leaves it by several degrees."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RevolutionAxis:
    """A line in the part's coordinates: a point (3,) in mm and a unit direction (3,)."""

    point: Floats
    direction: Floats

    def height(self, points: Floats) -> Floats:
        """Return where points (n, 3) lie along the axis, mm."""
        return (points - self.point) @ self.direction

    def away(self, points: Floats) -> Floats:
        """Return the vectors (n, 3) from the axis to points, perpendicular to it."""
        return points - self.point - np.outer(self.height(points), self.direction)


def reach(graph: FaceGraph) -> float:
    """Return the diagonal of the part's box in mm, the length that tolerances on lines are relative to."""
    present = graph.area > 0.0
    return float(
        np.linalg.norm(graph.box_high[present].max(axis=0) - graph.box_low[present].min(axis=0))
    )


def main_axis(graph: FaceGraph) -> RevolutionAxis | None:
    """Return the axis that the most area is of revolution about, None for a part without round faces and round edges."""
    found = _lines(graph) if (graph.area > 0.0).any() else []
    return max(
        found, key=lambda axis: float(graph.area[of_revolution(graph, axis)].sum()), default=None
    )


def of_revolution(graph: FaceGraph, axis: RevolutionAxis) -> Bools:
    """Return which faces (n,) are of revolution about an axis: planes across it, cylinders, cones and any other surface whose normals
    lie in the planes through it."""
    away = axis.away(graph.sample_point)
    # The normal's line passes the axis at (r x n) . d over the sine of their angle; r / |r| makes it the sine of leaving the meridian.
    moment = np.abs(np.cross(away, graph.sample_normal) @ axis.direction)
    outside = moment > np.sin(OUT_OF_MERIDIAN) * np.linalg.norm(away, axis=1) + SLIVER
    strange = np.zeros(len(graph), dtype=bool)
    strange[graph.sample_face[outside]] = True
    sampled = np.zeros(len(graph), dtype=bool)
    sampled[graph.sample_face] = True
    return np.asarray(sampled & ~strange & (graph.area > 0.0))


def _lines(graph: FaceGraph) -> list[RevolutionAxis]:
    """Return the lines that most of the round faces and edges share, the heaviest first."""
    faces = np.flatnonzero(
        np.isin(graph.surface, ROUND) & np.isfinite(graph.axis).all(axis=1) & (graph.area > 0.0)
    )
    edges = np.flatnonzero(np.isfinite(graph.curve_radius))
    point = np.vstack([graph.axis_point[faces], graph.curve_centre[edges]])
    direction = np.vstack([graph.axis[faces], graph.curve_axis[edges]])
    weight = np.concatenate([graph.area[faces], graph.length[edges] * graph.curve_radius[edges]])
    middle, size = _middle(graph), reach(graph)
    foot = point + np.einsum("ij,ij->i", middle - point, direction)[:, None] * direction
    near = SAME_LINE * size
    found: list[RevolutionAxis] = []
    # A slightly bent edge may be an arc about a line far out of the part.
    remaining = (weight > COINCIDENT**2) & (np.linalg.norm(foot - middle, axis=1) < 0.5 * size)
    while remaining.any() and len(found) < CANDIDATES:
        most = int(np.argmax(np.where(remaining, weight, -1.0)))
        same = remaining & _same(foot, direction, most, near)
        found.append(
            RevolutionAxis(
                point=foot[most], direction=direction[most] / np.linalg.norm(direction[most])
            )
        )
        remaining &= ~same
    return found


def _same(foot: Floats, direction: Floats, row: int, near: float) -> Bools:
    along = np.abs(direction @ direction[row])
    return np.asarray(
        (along > np.cos(SAME_DIRECTION)) & (np.linalg.norm(foot - foot[row], axis=1) < near)
    )


def _middle(graph: FaceGraph) -> Floats:
    present = graph.area > 0.0
    return 0.5 * (graph.box_high[present].max(axis=0) + graph.box_low[present].min(axis=0))
