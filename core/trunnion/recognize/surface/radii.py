"""How patches bend, as a help for choosing cutters: the smallest hollow and bulging radius, and the radius of fillets."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.facegraph import SMOOTH, FaceGraph
from trunnion.geometry.surface.curvature import FaceCurvature
from trunnion.recognize.contract import Bounded
from trunnion.recognize.surface.size import PatchSizes

EVEN = 1.1
"""A fillet's radius is the same all along it: that of all but a fifth of its positions lies within this ratio."""
OTHER = 1.02
"""A fillet runs out smoothly into faces of another radius, different by more than this ratio; a cylinder in two halves does not."""
ALIKE = 1e-4
"""Patches whose length, area and diameter differ by less than this share are one patch in several positions."""
FLAT = 1e-9
"""1/mm: a bend below this is noise of the arithmetic."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PatchRadii:
    """Radii of the patches, a row a tag, in mm, NaN where there is none: the smallest where the patch is hollow (concave) and where it
    bulges (convex), and the one of a fillet in an inner corner or of a rounded outer one. hollow (n,) is the middle of the hollow
    curvature all over the patch, 1/mm, 0 where most of it is not hollow."""

    concave: Floats
    convex: Floats
    fillet: Floats
    rounding: Floats
    hollow: Floats

    def sizes(self, rows: Ints) -> dict[str, float]:
        """Return the smallest radii of some patches by the names of sizes; those that are nowhere are left out."""
        found = {
            "concave_radius": self.concave,
            "convex_radius": self.convex,
            "fillet_radius": self.fillet,
            "rounding_radius": self.rounding,
        }
        return {
            name: float(np.nanmin(radii[rows]))
            for name, radii in found.items()
            if not np.isnan(radii[rows]).all()
        }


def patch_bends(bounded: Bounded, graph: FaceGraph, sizes: PatchSizes) -> PatchRadii:
    """Return how patches bend; of patches that are alike in every size one is measured."""
    kinds = _kinds(graph, sizes)
    first = np.unique(kinds, return_index=True)[1]
    bends = [bounded.bend(int(tag)) for tag in sizes.tag[first]]
    even = dict(
        zip(
            sizes.tag.tolist(),
            np.array([_even(b) for b in bends]).reshape(-1, 2)[kinds].tolist(),
            strict=True,
        )
    )
    blends = np.array([_blend(graph, int(tag), even) for tag in sizes.tag[first]]).reshape(-1, 2)[
        kinds
    ]
    concave, convex = (
        _radius(np.array(extreme))[kinds]
        for extreme in ([-b.least for b in bends], [b.most for b in bends])
    )
    return PatchRadii(
        concave=concave,
        convex=convex,
        fillet=blends[:, 0],
        rounding=blends[:, 1],
        hollow=np.array([_hollow(b) for b in bends])[kinds],
    )


def _hollow(bend: FaceCurvature) -> float:
    return max(0.0, -float(np.median(bend.spread[:, 0]))) if len(bend.spread) else 0.0


def _kinds(graph: FaceGraph, sizes: PatchSizes) -> Ints:
    """Return a number (n,) for every patch, the same for those that are alike: sizes, kind of surface and the side they bulge to."""
    rows = sizes.tag - 1
    surface = np.unique(np.array(graph.surface)[rows], return_inverse=True)[1]
    size = np.column_stack([sizes.length, sizes.area, sizes.diameter])
    words = np.column_stack([surface, graph.bend[rows]])
    order = np.lexsort((sizes.area, sizes.length, words[:, 1], words[:, 0]))
    unlike = (np.abs(np.diff(size[order], axis=0)) > ALIKE * size[order[1:]]).any(axis=1) | (
        np.diff(words[order], axis=0) != 0
    ).any(axis=1)
    kinds = np.empty(len(rows), dtype=np.int64)
    kinds[order] = np.concatenate([[0], np.cumsum(unlike)])
    return kinds


def _radius(curvature: Floats) -> Floats:
    return np.asarray(
        np.divide(1.0, curvature, out=np.full(len(curvature), np.nan), where=curvature > FLAT)
    )


def _even(bend: FaceCurvature) -> tuple[float, float]:
    """Return the hollow and the bulging radius that a face has all over, NaN where it varies."""
    return _all_over(-bend.spread[:, 0]), _all_over(bend.spread[:, 1])


def _all_over(curvature: Floats) -> float:
    if not len(curvature) or curvature.min() <= FLAT:
        return float("nan")
    least, middle, most = np.percentile(curvature, (10.0, 50.0, 90.0))
    return float(1.0 / middle) if most <= EVEN * least else float("nan")


def _blend(graph: FaceGraph, tag: int, even: Mapping[int, Sequence[float]]) -> tuple[float, float]:
    """Return the radius of a face as a fillet and as a rounding: those it has all over and leaves smoothly on two sides at least."""
    adjacent = [even.get(row + 1, (np.nan, np.nan)) for row in graph.neighbours(tag - 1, SMOOTH)]
    found = []
    for k, radius in enumerate(even[tag]):
        same = sum(radius / OTHER <= other[k] <= radius * OTHER for other in adjacent)
        found.append(radius if len(adjacent) - same >= 2 else float("nan"))
    return found[0], found[1]
