"""Points gathered in boxes of two sizes, so that a search passes over most of them by the balls about these."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.kernels.bodies import bodies_hold

SMALL, LARGE = 4, 4
"""A small box is so many spacings of the points wide, a large one so many small ones: 64 points, and 64 small boxes, of a full lattice."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PointGroups:
    """Points (m, 3) in the order of their boxes, mm: small ones from start (s + 1,) on, with the ball about each (s, 4), middle and radius;
    large ones of small ones from `large_start` (l + 1,) on, each with its ball (l, 4).
    """

    points: Floats
    start: Ints
    ball: Floats
    large_start: Ints
    large_ball: Floats

    @staticmethod
    def of(points: Floats, spacing: float) -> PointGroups:
        """Return points (m, 3) that are about a spacing (mm) apart in their groups."""
        if not len(points):
            none, balls = np.zeros(1, np.int64), np.zeros((0, 4))
            return PointGroups(
                points=points, start=none, ball=balls, large_start=none, large_ball=balls
            )
        small = np.floor((points - points.min(axis=0)) / (SMALL * spacing)).astype(np.int64)
        keys = np.column_stack([small // LARGE, small])
        order = np.lexsort(keys.T[::-1])
        keys, points = keys[order], np.ascontiguousarray(points[order])
        first = np.flatnonzero(_changes(keys))
        large_first = np.flatnonzero(_changes(keys[first][:, :3]))
        start, large_start = np.append(first, len(points)), np.append(large_first, len(first))
        return PointGroups(
            points=points,
            start=start,
            ball=_balls(points, start),
            large_start=large_start,
            large_ball=_balls(points, start[large_start]),
        )

    def held_by(self, rows: Floats, tip: Floats, axis: Floats) -> Bools:
        """Return at which tips (k, 3) with axes (k, 3) a body of cones (r, 4), as `kernels/bodies.py` has them, holds any of the points."""
        held = np.zeros(len(tip), dtype=bool)
        bodies_hold(
            self.points,
            self.start,
            self.ball,
            self.large_start,
            self.large_ball,
            np.ascontiguousarray(tip),
            np.ascontiguousarray(axis),
            rows,
            held,
        )
        return held


def _changes(keys: Ints) -> Bools:
    """Return where rows of keys (n, k) differ from the one before (n,); the first does."""
    return np.append(True, (np.diff(keys, axis=0) != 0).any(axis=1))


def _balls(points: Floats, start: Ints) -> Floats:
    """Return the balls (g, 4) about the boxes of points that begin at start (g + 1,)."""
    low, high = (f.reduceat(points, start[:-1], axis=0) for f in (np.minimum, np.maximum))
    return np.column_stack([0.5 * (low + high), 0.5 * np.linalg.norm(high - low, axis=1)])
