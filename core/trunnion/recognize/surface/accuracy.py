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
MOST_POINTS = 10_000
"""Points on an edge beyond which nothing is learned any more."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SizeError:
    """How exact the feature sizes are, and what they cost, with so many points put on each edge.

    `on_edge` counts the points between an edge's ends, -1 where the paper's repair chooses them; `points` all points of all patches;
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
    """Return the error and the cost of the feature sizes of some patches for every number of points on an edge, the paper's repair last.

    Measured against the exact boxes. Raises `BadInput` for a number that is no count.
    """
    wrong = [n for n in counts if not 0 <= n <= MOST_POINTS]
    if wrong:
        raise BadInput(f"points on an edge must be from 0 to {MOST_POINTS}; got {wrong[0]}")
    exact, *_ = _diagonals(bounded, tags, None)
    found = []
    for n in progress.over((*counts, -1), "measuring"):
        diagonal, points, seconds = _diagonals(
            bounded, tags, repaired(bounded) if n < 0 else _in_pieces(n + 1)
        )
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
