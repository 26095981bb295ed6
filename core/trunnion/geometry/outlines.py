"""Closed outlines in a plane, with point-in-polygon queries for many points at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Floats, Ints, items_of
from trunnion.geometry.kernels.outline import points_in_polygon_loop


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Outlines:
    """Pieces (s, 4) from x, y to x, y of outlines that close, listed by strips of y; `near`: how near a point is too near to classify."""

    pieces: Floats
    near: float
    low: float
    pitch: float
    start: Ints
    rows: Ints

    @staticmethod
    def of(pieces: Floats, near: float) -> Outlines:
        """Return outlines ready for queries; at least one piece."""
        bottom, top = pieces[:, [1, 3]].min(axis=1) - near, pieces[:, [1, 3]].max(axis=1) + near
        low = float(bottom.min())
        count = max(1, min(4 * len(pieces), 4096))
        pitch = max(float(top.max()) - low, near) / count * (1.0 + 1e-9)
        first, last = (np.floor((y - low) / pitch).astype(np.int64) for y in (bottom, top))
        piece, number = items_of(last - first + 1)
        strip = first[piece] + number
        order = np.argsort(strip, kind="stable")
        start = np.searchsorted(strip[order], np.arange(count + 1))
        return Outlines(
            pieces=pieces,
            near=near,
            low=low,
            pitch=pitch,
            start=start,
            rows=piece[order],
        )

    def within(self, positions: Floats) -> Ints:
        """Return `OUT`, `IN` or `NEAR` of `kernels.outline` (k,) for positions (k, 2)."""
        out = np.empty(len(positions), np.int64)
        positions = np.ascontiguousarray(positions, dtype=np.float64)
        points_in_polygon_loop(
            positions, self.pieces, self.near, self.low, self.pitch, self.start, self.rows, out
        )
        return out
