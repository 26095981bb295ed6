"""A bundle of z columns, each known by its top alone: the fast path while every cut comes straight from above."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats
from trunnion.model.blank import Blank

Part = tuple[NDArray, ...]
"""A tile's copy: heights of columns, or of rays how many intervals each has, and all their lower and upper ends, closely packed."""
UP = 2
"""The axis along whose rays the engagement is measured."""
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
    def of(blank: Blank, pitch: float, box: tuple[Floats, Floats]) -> Field | None:
        """Return what is of a blank in a box (low, high) of its frame as a field; None where a column is not solid from the box's floor up.

        A column of the last row or column whose middle lies beside the box is as high as at the box's side.
        """
        low, high = box
        columns, rows = cells_along((high - low)[:2], pitch)
        x, y = (
            np.minimum(low[k] + (np.arange(n) + 0.5) * pitch, high[k])
            for k, n in enumerate((columns, rows))
        )
        inside = blank.grid_intervals(UP, x, y, (low[2], high[2]))
        lifted = inside.low[:, 0] > low[2] + tolerance.PARAMETRIC
        if (inside.count > 1).any() or (lifted & (inside.count > 0)).any():
            return None
        return Field(inside.tops(float(low[2])).reshape(rows, columns), pitch, low, high)

    @property
    def volume(self) -> float:
        """Volume in mm3, by the columns."""
        return float((self.top - self.low[2]).sum()) * self.pitch**2

    def contains(self, points: Floats) -> Bools:
        """Return for points (k, 3) in the blank's box whether the nearest column reaches as high."""
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
