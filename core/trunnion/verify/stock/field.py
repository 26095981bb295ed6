"""A bundle of z columns, each known by its top alone: the fast path while every cut comes straight from above."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.frame import Frame
from trunnion.model.blank import Blank

Part = tuple[NDArray, ...]
"""A tile's copy: heights of columns, or of rays how many intervals each has, and all their lower and upper ends, closely packed."""
TILES = 16
"""Bands of rows that a bundle is cut in; fixed, so that nothing depends on the number of threads."""


@dataclass(frozen=True, slots=True, eq=False)
class Field:
    """Heights of columns: top (rows, columns) mm, cells of `pitch` from the blank's corner `low` (3,) up to `high` (3,)."""

    top: Floats
    pitch: float
    low: Floats
    high: Floats

    @staticmethod
    def of(blank: Blank, pitch: float) -> Field:
        """Return a blank as a field in its own frame."""
        columns, rows = cells_along(blank.size[:2], pitch)
        return Field(np.full((rows, columns), blank.high[2]), pitch, blank.low, blank.high)

    @property
    def volume(self) -> float:
        """Volume in mm3, by the columns."""
        return float((self.top - self.low[2]).sum()) * self.pitch**2

    def contains(self, points: Floats) -> Bools:
        """Say for points (k, 3) in the blank's box whether the nearest column reaches as high."""
        column, row = np.floor((points[:, :2] - self.low[:2]) / self.pitch).astype(np.int64).T
        rows, columns = self.top.shape
        return np.asarray(
            points[:, 2] < self.top[np.clip(row, 0, rows - 1), np.clip(column, 0, columns - 1)]
        )

    def parts(self) -> list[Part]:
        """Return a copy of each tile."""
        return [(self.top[first:last].copy(),) for first, last in tiles_of(len(self.top))]

    def put(self, parts: Sequence[Part]) -> None:
        """Become what copies of all tiles say."""
        self.top[:] = np.vstack([p[0] for p in parts])

    def centre(self, cell: int) -> Floats:
        """Return the plan centre (2,) of a cell by its flat index."""
        row, column = divmod(cell, self.top.shape[1])
        return self.low[:2] + (np.array([column, row]) + 0.5) * self.pitch


def cells_along(size: Floats, pitch: float) -> tuple[int, ...]:
    """Return how many cells of a pitch cover each of some lengths."""
    return tuple(int(max(1, np.ceil(s / pitch - tolerance.PARAMETRIC))) for s in size)


def tiles_of(rows: int) -> list[tuple[int, int]]:
    """Return the first row and the one after the last of each tile of some rows."""
    edges = np.linspace(0, rows, min(TILES, rows) + 1).round().astype(int)
    return [(int(a), int(b)) for a, b in pairwise(edges)]


def blank_box(blank: Blank, frame: Frame) -> tuple[Floats, Floats]:
    """Return the lowest and highest corner of a blank's box in a frame (of a frame turned by other than right angles: of its hull)."""
    corners = np.array(
        [
            [x, y, z]
            for x in (blank.low[0], blank.high[0])
            for y in (blank.low[1], blank.high[1])
            for z in (blank.low[2], blank.high[2])
        ]
    )
    local = frame.to_local(blank.frame.to_world(corners))
    return local.min(axis=0), local.max(axis=0)
