"""A bundle of z columns, each known by its top alone: the fast path while every cut comes straight from above."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.geometry.frame import Frame
from trunnion.model.blank import Blank


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

    def centre(self, cell: int) -> Floats:
        """Return the plan centre (2,) of a cell by its flat index."""
        row, column = divmod(cell, self.top.shape[1])
        return self.low[:2] + (np.array([column, row]) + 0.5) * self.pitch


def cells_along(size: Floats, pitch: float) -> tuple[int, ...]:
    """Return how many cells of a pitch cover each of some lengths."""
    return tuple(int(max(1, np.ceil(s / pitch - tolerance.PARAMETRIC))) for s in size)


def blank_box(blank: Blank, frame: Frame) -> tuple[Floats, Floats]:
    """Return the lowest and highest corner of a blank's box in a frame (of a frame turned by other than right angles: of its hull)."""
    corners = np.array([[x, y, z] for x in (blank.low[0], blank.high[0]) for y in (blank.low[1], blank.high[1])
                        for z in (blank.low[2], blank.high[2])])
    local = frame.to_local(blank.frame.to_world(corners))
    return local.min(axis=0), local.max(axis=0)
