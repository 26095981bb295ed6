"""A panel as it is seen from one side: the graph with z towards the eye, its classes and blends, and the slices.

A side is named by its direction out of the part in the frame of recognition: `ABOVE`, `BELOW`, or level for what opens at an edge of the
panel. Heights of features are those of the recognition's frame for the first two, along their own direction for the others.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely

from trunnion.geometry.arrays import Floats
from trunnion.geometry.facegraph import FaceGraph
from trunnion.model.feature import Size
from trunnion.recognize.grow import samples
from trunnion.recognize.panel.classes import FaceClass, FaceClasses
from trunnion.recognize.panel.pockets.blends import floor_fillets, is_corner
from trunnion.recognize.panel.settings import PanelSettings
from trunnion.recognize.panel.slicing.slices import Slices
from trunnion.recognize.panel.slicing.tree import SpaceTree, build_tree
from trunnion.tolerance import SLIVER
from trunnion.units import radians, rounded

FREE_FORM = ("spline", "revolution", "extrusion", "other")
"""Surfaces of fringes: sides between two curves, ruled as they may be."""
Direction = tuple[float, float, float]
ABOVE: Direction = (0.0, 0.0, 1.0)
BELOW: Direction = (0.0, 0.0, -1.0)
ON_RIM = 0.05
"""mm: a face whose samples are this near to the outline lies on it (the slices are on chords)."""


@dataclass(frozen=True, eq=False, kw_only=True)
class PanelSide:
    """One side of a panel, z up to it, seen from a `direction` in the frame of recognition; `height` of the part that way, and `bottom`,
    where it begins along the direction from the frame's origin; `holes` are the rows of the faces of holes, which make no pocket."""

    graph: FaceGraph
    classes: FaceClasses
    slices: Slices
    height: float
    settings: PanelSettings
    direction: Direction = ABOVE
    bottom: float = 0.0
    holes: frozenset[int] = frozenset()

    @property
    def below(self) -> bool:
        """Whether it is the side that the recognition's z points away from."""
        return self.direction == BELOW

    @property
    def is_level(self) -> bool:
        """Whether it is seen along the panel, at one of its edges."""
        return self.direction not in (ABOVE, BELOW)

    @property
    def attributes(self) -> dict[str, Size]:
        """What a feature says of the side that it opens to: nothing where that is above."""
        return {} if self.direction == ABOVE else {"direction": self.direction}

    def named_height(self, z: float) -> float:
        """Return a height of this view as sizes give it."""
        return rounded(self.height - z if self.below else self.bottom + z)

    @cached_property
    def fillets(self) -> frozenset[int]:
        """The rows of the floor fillets."""
        return floor_fillets(self.graph, self.classes)

    @cached_property
    def tree(self) -> SpaceTree:
        """The relationship tree of the spaces."""
        return build_tree(self.slices)

    @cached_property
    def profile(self) -> tuple[int, ...]:
        """The rows of the vertical faces that lie on the outline seen from above."""
        return tuple(r for r in self.classes.rows(FaceClass.VERTICAL) if self._on_rim(r))

    @cached_property
    def leaning_profile(self) -> tuple[int, ...]:
        """The rows of the steep faces that lean and look out of the part; free-form ones are fringes."""
        return tuple(
            int(r)
            for r in np.flatnonzero(self.classes.steep)
            if self.classes.kind[r] is not FaceClass.VERTICAL
            and self.graph.surface[r] not in FREE_FORM
            and self.looks_outwards(int(r))
        )

    def looks_outwards(self, row: int) -> bool:
        """Return whether a face that leans has nothing but air before its middle, in the slice that is nearest: no pocket, and no opening.

        The slice lies a little over or under the middle: as far as the face may have come forward there, nothing counts.
        """
        layers, point, normal = (
            self.slices.layers,
            self.graph.centre[row],
            self.graph.normal[row][:2],
        )
        flat = float(np.hypot(*normal))
        if not layers or flat < SLIVER:
            return False
        layer = min(layers, key=lambda s: (abs(s.z - float(point[2])), s.z))
        aside = abs(layer.z - float(point[2])) * float(np.tan(radians(self.settings.beta))) + ON_RIM
        before = shapely.Point(*(point[:2] + aside / flat * normal))
        return not any(
            shapely.Polygon(piece.exterior).contains(before)
            for piece in shapely.get_parts(layer.material)
            if piece.geom_type == "Polygon"
        )

    @cached_property
    def corners(self) -> frozenset[int]:
        """The rows of the blends between two steep faces."""
        return frozenset(
            int(r)
            for r in np.flatnonzero(self.classes.rising)
            if is_corner(self.graph, self.classes, int(r))
        )

    def z(self, face: int) -> float:
        """Return the height of a horizontal face, of others that of their lowest point."""
        return float(
            self.graph.centre[face][2]
            if self.classes.kind[face] is FaceClass.UP
            else self.graph.box_low[face][2]
        )

    def points(self, face: int) -> Floats:
        """Return points (k, 3) inside a face."""
        return np.vstack([self.graph.centre[face], samples(self.graph, face)[0]])

    def undercut(self, face: int) -> bool:
        """Return whether material stands over the whole of a face: it can't be reached from this side."""
        return all(self._covered(face))

    def is_clear(self, face: int) -> bool:
        """Return whether material stands over nothing of a face."""
        return not any(self._covered(face))

    def _covered(self, face: int) -> Iterator[bool]:
        """Yield for points in a face whether material stands over them."""
        layers = [s for s in self.slices.layers if s.z > self.graph.box_high[face][2] + SLIVER]
        for point in self.points(face):
            spot = shapely.Point(point[0], point[1])
            yield any(s.material.contains(spot) for s in layers)

    def _on_rim(self, face: int) -> bool:
        points = self.points(face)
        return all(self.slices.rim.distance(shapely.Point(p[0], p[1])) < ON_RIM for p in points)
