"""The feature size of every patch: what distinguishes equal patches from others (quick segmentation, section on feature size)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.boundary import Boundary
from trunnion.recognize.contract import Bounded

Parts = Callable[[Floats], Ints]
"""From the lengths of edges to how many pieces each is cut into."""
REPAIR = ((0.7, 8), (0.5, 6), (0.3, 4), (0.1, 2))
"""The paper's boundary repair: an edge longer than this share of the datum length is cut into so many equal parts."""
FEW = 2
"""Parts of every edge for the first estimate of the largest feature size."""
SPREAD, LEAST = 500, 24
"""Where the largest distance of two boundary points is wanted: points along the longest edge, and the fewest on any."""
RUN = 8
"""Neighbouring points that are looked at as one while the largest distance is searched."""
BLOCK = 1000
"""Rows of a table of distances that are looked at together."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PatchSizes:
    """Sizes of the patches, a row a tag: sides (n, 3) and diagonal (n,) of the axis-aligned box of the boundary, diameter (n,) its
    largest distance of two points, length (n,) of the boundary, mm; area (n,) mm2. outline has the points the diameters are from."""

    tag: Ints
    sides: Floats
    diagonal: Floats
    diameter: Floats
    length: Floats
    area: Floats
    outline: Boundary

    @property
    def width(self) -> Floats:
        """Mean width (n,): that of a long rectangle of the same area and boundary, mm."""
        return np.asarray(
            np.divide(
                2.0 * self.area, self.length, out=np.zeros_like(self.area), where=self.length > 0.0
            )
        )


def patch_sizes(bounded: Bounded, tags: Sequence[int], area: Floats, *, exact: bool) -> PatchSizes:
    """Return the sizes of patches, given by tag with their area (n,) mm2; by the paper's points on the edges unless `exact`."""
    boxes = bounded.boundary(None if exact else repaired(bounded))
    spread = bounded.boundary(
        lambda length: np.maximum(np.ceil(SPREAD * length / length.max(initial=1.0)), LEAST).astype(
            np.int64
        )
    )
    sides = box_sides(boxes, tags)
    return PatchSizes(
        tag=np.array(tags, dtype=np.int64),
        sides=sides,
        diagonal=np.linalg.norm(sides, axis=1),
        diameter=np.array([diameter(spread.points_of(t)) for t in tags]),
        length=np.array([boxes.length_of(t) for t in tags]),
        area=np.asarray(area, dtype=np.float64),
        outline=spread,
    )


def box_sides(boundary: Boundary, tags: Sequence[int]) -> Floats:
    """Return the sides (n, 3) of the axis-aligned box of each patch's boundary points."""
    return np.array(
        [np.ptp(p, axis=0) if len(p) else np.zeros(3) for p in map(boundary.points_of, tags)]
    ).reshape(-1, 3)


def repaired(bounded: Bounded) -> Parts:
    """Return the paper's rule for how many parts each edge is cut into.

    Its datum length, the estimated largest feature size, is the largest diagonal that a few points on each edge give.
    """
    few = bounded.boundary(lambda length: np.full(len(length), FEW))
    datum = float(
        np.linalg.norm(box_sides(few, np.unique(few.face).tolist()), axis=1).max(initial=0.0)
    )

    def parts(length: Floats) -> Ints:
        found = np.ones(len(length), dtype=np.int64)
        for above, count in reversed(REPAIR):
            found[length > above * datum] = count
        return found

    return parts


def diameter(points: Floats) -> float:
    """Return the largest distance of two points (k, 3): of runs of points first, then only where two runs may hold the farthest pair."""
    if not len(points):
        return 0.0
    points = points - 0.5 * (points.min(axis=0) + points.max(axis=0))
    points = np.vstack([points, np.repeat(points[-1:], -len(points) % RUN, axis=0)])
    runs = points.reshape(-1, RUN, 3)
    centre = runs.mean(axis=1)
    reach = np.linalg.norm(runs - centre[:, None], axis=2).max(axis=1)
    away = np.linalg.norm(points, axis=1)
    best = float(np.linalg.norm(points - points[away.argmax()], axis=1).max())
    # Whoever beats it comes from a run that reaches beyond what the farthest point leaves of it.
    far = np.linalg.norm(centre, axis=1) + reach + away.max() > best
    runs, centre, reach = runs[far], centre[far], reach[far]
    for start in range(0, len(runs), BLOCK):
        rows = slice(start, start + BLOCK)
        bound = np.sqrt(_squares(centre[rows], centre)) + reach[rows, None] + reach
        a, b = np.nonzero(bound > best * (1.0 + tolerance.PARAMETRIC))
        a, b = a[a + start <= b] + start, b[a + start <= b]
        for k in range(0, len(a), BLOCK):
            apart = runs[a[k : k + BLOCK], :, None] - runs[b[k : k + BLOCK], None]
            best = max(best, float(np.sqrt((apart**2).sum(axis=3).max(initial=0.0))))
    return best


def _squares(a: Floats, b: Floats) -> Floats:
    return np.asarray(
        np.maximum((a**2).sum(axis=1)[:, None] + (b**2).sum(axis=1) - 2.0 * a @ b.T, 0.0)
    )
