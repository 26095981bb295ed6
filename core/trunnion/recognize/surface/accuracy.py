"""What points on the boundary cost and how exact the feature size is then (quick segmentation, figure 8)."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trunnion.findings import BadInput
from trunnion.geometry.arrays import Floats, Ints
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.recognize.contract import Bounded
from trunnion.recognize.surface.size import Parts, box_sides, repaired

COUNTS = (0, 1, 3, 7, 15, 31, 63, 127, 255, 500)
"""Points on an edge that the table of size errors is made for; the paper's figure 8 ends with 500."""
REPAIR, EXACT = -1, -2
"""Stand in place of a number of points for the paper's repair and for the exact boxes."""
MOST_POINTS = 10_000
"""Points on an edge beyond which nothing is learned any more."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SizeError:
    """How exact the feature sizes are, and what they cost, with so many points put on each edge.

    `on_edge` counts the points between an edge's ends, `REPAIR` where the paper's repair chooses them, `EXACT` where they are the places
    where an edge reaches farthest along an axis; `points` counts all points of all patches;
    `largest` and `mean` are the errors of the box's diagonal as a share of the exact one, over the patches; `seconds` wall time.
    """

    on_edge: int
    points: int
    largest: float
    mean: float
    seconds: float

    def as_dict(self) -> dict[str, float]:
        """Return the figures as the JSON that other programs rely on."""
        return {
            "points_on_edge": self.on_edge,
            "points": self.points,
            "largest_error": self.largest,
            "mean_error": self.mean,
            "seconds": self.seconds,
        }


def size_errors(
    bounded: Bounded, tags: Sequence[int], counts: Sequence[int], progress: Progress = NO_PROGRESS
) -> tuple[SizeError, ...]:
    """Return the error and the cost of the feature sizes of some patches for every number of points on an edge, then those of the paper's
    repair and of the exact boxes.

    Measured against the exact boxes. Raises `BadInput` for a number that is no count.
    """
    wrong = [n for n in counts if not 0 <= n <= MOST_POINTS]
    if wrong:
        raise BadInput(f"points on an edge must be from 0 to {MOST_POINTS}; got {wrong[0]}")
    # The first time the curves are taken from the part, which is no cost of either way.
    exact, *_ = _diagonals(bounded, tags, None)
    found = []
    for n in progress.over((*counts, REPAIR, EXACT), "measuring"):
        diagonal, points, seconds = _diagonals(bounded, tags, _parts_of(bounded, n))
        error = np.abs(diagonal - exact) / exact
        found.append(
            SizeError(
                on_edge=n,
                points=points,
                largest=float(error.max()),
                mean=float(error.mean()),
                seconds=seconds,
            )
        )
    return tuple(found)


def _parts_of(bounded: Bounded, on_edge: int) -> Parts | None:
    """Return into how many parts edges are cut for a row; None for the exact boxes."""
    if on_edge == EXACT:
        return None
    return repaired(bounded) if on_edge == REPAIR else _in_pieces(on_edge + 1)


def _in_pieces(parts: int) -> Parts:
    def pieces(length: Floats) -> Ints:
        return np.full(len(length), parts)

    return pieces


def _diagonals(
    bounded: Bounded, tags: Sequence[int], parts: Parts | None
) -> tuple[Floats, int, float]:
    began = time.perf_counter()
    boundary = bounded.boundary(parts)
    diagonal = np.linalg.norm(box_sides(boundary, tags), axis=1)
    return diagonal, len(boundary.point), time.perf_counter() - began
