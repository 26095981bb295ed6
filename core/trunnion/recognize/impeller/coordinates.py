"""The samples of a face graph in the cylindrical coordinates of a wheel: where they are in the meridian and how their normals lie."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.facegraph import FaceGraph
from trunnion.recognize.revolution import RevolutionAxis

ON_AXIS = 1e-9
"""mm: a point nearer to the axis has no direction away from it."""


@dataclass(frozen=True, eq=False, kw_only=True)
class CylindricalSamples:
    """Samples (s) of a graph about an axis: radius and height (s, 2) mm in the meridian, and normals (s, 3) away from the axis, round it
    (right-handed) and along it."""

    graph: FaceGraph
    axis: RevolutionAxis

    @cached_property
    def meridian(self) -> Floats:
        """Radius and height of each sample (s, 2) mm."""
        point = self.graph.sample_point
        return np.column_stack(
            [np.linalg.norm(self.axis.away(point), axis=1), self.axis.height(point)]
        )

    @cached_property
    def normal(self) -> Floats:
        """Outward normals (s, 3) away from the axis, round it and along it."""
        n, away = self.graph.sample_normal, self.axis.away(self.graph.sample_point)
        out = away / np.maximum(np.linalg.norm(away, axis=1), ON_AXIS)[:, None]
        around = np.cross(self.axis.direction, out)
        return np.column_stack(
            [
                np.einsum("ij,ij->i", n, out),
                np.einsum("ij,ij->i", n, around),
                n @ self.axis.direction,
            ]
        )

    @cached_property
    def _starts(self) -> tuple[Ints, Ints]:
        order = np.argsort(self.graph.sample_face, kind="stable")
        starts = np.searchsorted(self.graph.sample_face[order], np.arange(len(self.graph) + 1))
        return order, starts

    def of(self, row: int) -> Ints:
        """Return the numbers of the samples on a face."""
        order, starts = self._starts
        return order[starts[row] : starts[row + 1]]

    def of_all(self, rows: tuple[int, ...]) -> Ints:
        """Return the numbers of the samples on some faces."""
        return np.concatenate([self.of(r) for r in rows] or [np.zeros(0, dtype=np.int64)])

    def meridian_of(self, points: Floats) -> Floats:
        """Return radius and height (k, 2) of points (k, 3)."""
        return np.column_stack(
            [np.linalg.norm(self.axis.away(points), axis=1), self.axis.height(points)]
        )

    def angles_of(self, points: Floats) -> Floats:
        """Return the angles (k,) of points (k, 3) about the axis, radians, from the direction that `zero` gives."""
        away, x = self.axis.away(points), self.zero
        return np.arctan2(away @ np.cross(self.axis.direction, x), away @ x)

    @cached_property
    def zero(self) -> Floats:
        """The direction (3,) across the axis that angles begin at: nearest to the file's x, or to its y where that is along the axis."""
        return across(self.axis.direction)


def across(direction: Floats) -> Floats:
    """Return the unit direction across a direction that is nearest to the file's x, or to its y where x is within 60 degrees of it."""
    for base in np.eye(3)[:2]:
        rest = base - (base @ direction) * direction
        length = float(np.linalg.norm(rest))
        if length > 0.5:
            return np.asarray(rest / length)
    raise AssertionError("no direction is along x and y at once")
