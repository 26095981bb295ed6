"""The faces of a casing in its frame: which are turned about the main axis, which belong to holes, and how they touch.

Adjacency is read with blends suppressed: a fillet between a side and what it stands on counts as the concave edge it replaces.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.facegraph import CONCAVE, CONVEX, SMOOTH, FaceGraph
from trunnion.geometry.frame import WORLD
from trunnion.recognize.grow import samples
from trunnion.recognize.holes.sweep import arcs, swept
from trunnion.tolerance import COINCIDENT, TANGENT

HALF = np.pi + TANGENT
"""Radians: what sweeps more than half a turn about the main axis runs round the casing and is no side of a boss."""
ALIGNED = 0.5
"""Cosine between the normals of a boss's top and of what it stands on from which on one lies on the other: tops tilt and lean by the
half width of the boss, together less than 45 degrees; its sides stay above that."""
BLENDS = ("torus", "revolution", "spline", "other")
"""Surfaces of fillets that may be turned about the main axis: those of the straight edges of a boss that lie across it."""


@dataclass(frozen=True, eq=False, kw_only=True)
class CasingFaces:
    """A casing's face graph in its frame, z along the main axis: which are `turned` (n,), and in `holes` the rows of holes' faces."""

    graph: FaceGraph
    turned: Bools
    holes: frozenset[int]

    @cached_property
    def present(self) -> tuple[int, ...]:
        """The rows of all faces that are there."""
        return tuple(np.flatnonzero(self.graph.area > 0.0).tolist())

    @cached_property
    def sweep(self) -> Floats:
        """How much of a turn (n,) the edges of each turned face sweep about the main axis, radians; a whole one for faces without edges."""
        found = np.zeros(len(self.graph))
        for row in np.flatnonzero(self.turned).tolist():
            edges = self.graph.edges_of[row]
            found[row] = swept(arcs(self.graph, edges, WORLD)) if edges else 2.0 * np.pi
        return found

    @cached_property
    def across(self) -> Bools:
        """Which faces (n,) are turned planes, square to the main axis."""
        return self.turned & (np.array(self.graph.surface) == "plane")

    def runs_round(self, row: int) -> bool:
        """Return whether a face is turned and sweeps more than half a turn."""
        return bool(self.turned[row] and self.sweep[row] > HALF)

    def is_blend(self, row: int) -> bool:
        """Return whether a face may be a fillet at the foot of a boss: hollow or doubly bent, and not running round the casing."""
        if row in self.holes or self.runs_round(row) or self.graph.bend[row] > 0:
            return False
        return (not self.turned[row] or self.graph.surface[row] in BLENDS) and self.graph.surface[
            row
        ] != "plane"

    def is_root(self, row: int) -> bool:
        """Return whether a blend runs smoothly into turned ground."""
        return self.is_blend(row) and any(
            self._is_ground(n) for n in self.graph.neighbours(row, SMOOTH)
        )

    @cached_property
    def ground_of(self) -> tuple[frozenset[int], ...]:
        """Rows of the turned faces that each face meets in a concave edge, or in a fillet."""
        graph = self.graph
        found: list[set[int]] = [set() for _ in graph.surface]
        for row in self.present:
            if row in self.holes:
                continue
            for edge in graph.edges_of[row]:
                other = graph.across(edge, row)
                if other in self.holes:
                    continue
                if graph.convexity[edge] == CONCAVE:
                    if self._is_ground(other):
                        found[row].add(other)
                elif graph.convexity[edge] == SMOOTH and self.is_blend(other):
                    found[row] |= {
                        beyond
                        for beyond in graph.neighbours(other, SMOOTH)
                        if beyond != row and self._is_ground(beyond)
                    }
        return tuple(frozenset(f) for f in found)

    def _is_ground(self, row: int) -> bool:
        """Return whether a boss may stand on a face: it is turned, and no fillet of a boss."""
        return bool(self.turned[row]) and row not in self.holes and not self._is_turned_fillet(row)

    def _is_turned_fillet(self, row: int) -> bool:
        return self.is_blend(row) and any(
            not self.turned[n] or (self.across[n] and not self.runs_round(n))
            for n in self.graph.neighbours(row, SMOOTH)
        )

    @cached_property
    def meridian_normals(self) -> Floats:
        """Mean outward normal (n, 2) of each face in the half plane through the axis: away from it, and along it; not of unit length."""
        graph = self.graph
        away = graph.sample_point[:, :2]
        away = away / np.maximum(np.linalg.norm(away, axis=1), COINCIDENT)[:, None]
        parts = np.column_stack(
            [(graph.sample_normal[:, :2] * away).sum(axis=1), graph.sample_normal[:, 2]]
        )
        total = np.zeros((len(graph), 2))
        np.add.at(total, graph.sample_face, parts)
        size = np.linalg.norm(total, axis=1)
        return np.asarray(total / np.maximum(size, COINCIDENT)[:, None])

    def alignment(self, row: int, ground: int) -> float:
        """Return the smallest cosine between the normals of a face and that of turned ground, turned to beside them."""
        point, normal = samples(self.graph, row)
        if not len(point):
            return -1.0
        away = point[:, :2] / np.maximum(np.linalg.norm(point[:, :2], axis=1), COINCIDENT)[:, None]
        out, up = self.meridian_normals[ground]
        return float(((normal[:, :2] * away).sum(axis=1) * out + normal[:, 2] * up).min())

    def convex(self, row: int) -> Iterable[int]:
        """Yield the faces across the convex edges of a face, those of holes left out."""
        return (n for n in self.graph.neighbours(row, CONVEX) if n not in self.holes)
