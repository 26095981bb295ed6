"""The stock of a piece of work, in the blank's frame: the same object goes from setup to setup."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trunnion.findings import OutOfMemory
from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.frame import Frame
from trunnion.model.blank import Blank
from trunnion.verify.stock.field import Field, cells_along

MOST_BYTES = 2_000_000_000
"""Most memory that the stock may take."""


@dataclass(slots=True, eq=False)
class Stock:
    """What is left of a blank: rays `pitch` apart through it along some of its axes (`bundles`), and where material is on them.

    The z bundle is a height field while every cut came from above.
    """

    blank: Blank
    pitch: float
    bundles: tuple[str, ...]
    field: Field

    @staticmethod
    def of(blank: Blank, pitch: float, bundles: Sequence[str] = ("z",)) -> Stock:
        """Return a whole blank; raise `OutOfMemory` when rays so close would need too much memory."""
        need = Stock.need(blank, pitch, bundles)
        if need > MOST_BYTES:
            least = math.ceil(100.0 * pitch * math.sqrt(need / MOST_BYTES)) / 100.0
            raise OutOfMemory(f"stock at cells of {pitch:g} mm would need {need / 1e6:.0f} MB: choose verify.cell of at least "
                              f"{least:.2f} mm")
        return Stock(blank, pitch, tuple(bundles), Field.of(blank, pitch))

    @staticmethod
    def need(blank: Blank, pitch: float, bundles: Sequence[str] = ("z",)) -> int:
        """Return the bytes that a stock takes at its beginning."""
        columns, rows = cells_along(blank.size[:2], pitch)
        return 8 * rows * columns

    @property
    def frame(self) -> Frame:
        """The blank's frame, in which all of it is."""
        return self.blank.frame

    @property
    def volume(self) -> float:
        """Volume in mm3."""
        return self.field.volume

    def contains(self, points: Floats) -> Bools:
        """Say for points (k, 3) in the blank's frame whether they are in material, as the nearest rays see it."""
        points = np.asarray(points, dtype=np.float64).reshape(-1, 3)
        inside = ((points >= self.blank.low) & (points <= self.blank.high)).all(axis=1)
        cell = np.floor((points[:, :2] - self.field.low[:2]) / self.pitch).astype(np.int64)
        rows, columns = self.field.top.shape
        top = self.field.top[np.clip(cell[:, 1], 0, rows - 1), np.clip(cell[:, 0], 0, columns - 1)]
        return np.asarray(inside & (points[:, 2] < top))

    def snapshot(self) -> Floats:
        """Return what `restore` goes back to."""
        return self.field.top.copy()

    def restore(self, snapshot: Floats) -> None:
        """Go back to a snapshot of this stock."""
        self.field.top[:] = snapshot
