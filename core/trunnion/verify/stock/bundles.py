"""Bundles of rays along an axis of the blank: where material is on each, as sorted intervals in flat arrays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.model.blank import Blank
from trunnion.verify.stock.field import UP, Field, Part, cells_along, tiles_of

AXES = ("x", "y", "z")
SPARE = 4
"""Intervals that a ray has room for at first: two, and two more while it is cut."""


@dataclass(slots=True, eq=False)
class Bundle:
    """Rays along one axis through a box in a blank's frame.

    Coordinates (u, v, w) of a bundle are the blank's turned in a cycle, w along the rays: (y, z, x) for x, (z, x, y) for y, (x, y, z)
    for z.
    Rays stand at the centres of rows (v) of columns (u) of cells, `pitch` wide, from the blank's corner `origin` (u, v). Ray c = row *
    columns + column has material on count[c] intervals from low[c, k] to high[c, k], upwards; low, high (rays, room).
    """

    axis: int
    pitch: float
    rows: int
    columns: int
    origin: Floats
    count: Ints
    low: Floats
    high: Floats

    @staticmethod
    def of(blank: Blank, pitch: float, axis: int, box: tuple[Floats, Floats]) -> Bundle:
        """Return what is of a blank in a box (low, high) of its frame as rays along an axis (0, 1, 2)."""
        first, last = box
        turned = cycle(axis)
        columns, rows = cells_along((last - first)[turned[:2]], pitch)
        origin = first[turned[:2]]
        u, v = (
            o + (np.arange(n) + 0.5) * pitch for o, n in zip(origin, (columns, rows), strict=True)
        )
        inside = blank.grid_intervals(axis, u, v, (first[axis], last[axis]))
        capacity = max(SPARE, inside.low.shape[1])
        low, high = (
            np.pad(a, ((0, 0), (0, capacity - a.shape[1]))) for a in (inside.low, inside.high)
        )
        count = inside.count * _in_box(rows, columns, pitch, (last - first)[turned[:2]])
        return Bundle(axis, pitch, rows, columns, origin.copy(), count, low, high)

    @staticmethod
    def of_field(field: Field) -> Bundle:
        """Return a height field as rays along z."""
        rows, columns = field.top.shape
        low, high = np.zeros((rows * columns, SPARE)), np.zeros((rows * columns, SPARE))
        low[:, 0], high[:, 0] = field.low[2], field.top.ravel()
        count = _in_box(rows, columns, field.pitch, (field.high - field.low)[:2]) * (
            high[:, 0] > field.low[2]
        )
        return Bundle(UP, field.pitch, rows, columns, field.low[:2].copy(), count, low, high)

    @property
    def capacity(self) -> int:
        """Intervals that each ray can hold."""
        return self.low.shape[1]

    @property
    def nbytes(self) -> int:
        """Bytes that it takes."""
        return self.count.nbytes + self.low.nbytes + self.high.nbytes

    @property
    def volume(self) -> float:
        """Volume in mm3 as these rays see it."""
        there = np.arange(self.capacity) < self.count[:, None]
        return float(np.where(there, self.high - self.low, 0.0).sum()) * self.pitch**2

    def tiles(self) -> list[tuple[int, int]]:
        """Return the first row and the one after the last of each tile."""
        return tiles_of(self.rows)

    def parts(self) -> list[Part]:
        """Return a copy of each tile."""
        there = np.arange(self.capacity) < self.count[:, None]
        found: list[Part] = []
        for first, last in self.tiles():
            own = slice(first * self.columns, last * self.columns)
            found.append(
                (self.count[own].copy(), self.low[own][there[own]], self.high[own][there[own]])
            )
        return found

    def put(self, parts: Sequence[Part]) -> None:
        """Become what copies of all tiles say."""
        self.count = np.concatenate([p[0] for p in parts])
        while self.count.max(initial=0) > self.capacity:
            self.grow()
        there = np.arange(self.capacity) < self.count[:, None]
        self.low[there], self.high[there] = (np.concatenate([p[k] for p in parts]) for k in (1, 2))

    def grow(self) -> None:
        """Double the capacity of every ray."""
        self.low, self.high = (
            np.pad(a, ((0, 0), (0, self.capacity))) for a in (self.low, self.high)
        )

    def fill_gaps(self, longest: float) -> bool:
        """Fill gaps of at most a length (mm) between the intervals of rays that have no room left; return whether all have some then.

        Rays are a cell apart: gaps shorter than that along one are no more than the stock can tell across them. What is filled counts as
        material: nothing that stands is lost.
        """
        full = np.flatnonzero(self.count > self.capacity - 2)
        low, high, count = self.low[full], self.high[full], self.count[full]
        numbers = np.arange(self.capacity)
        there = numbers < count[:, None]
        begins = there.copy()
        begins[:, 1:] &= low[:, 1:] - high[:, :-1] > longest
        ends = there & np.column_stack([begins[:, 1:], np.zeros(len(full), bool)])
        ends[np.arange(len(full)), np.maximum(count - 1, 0)] = count > 0
        kept = begins.sum(axis=1)
        filled = numbers < kept[:, None]
        # Intervals of a ray stand in order: the k-th that begins ends with the k-th that ends.
        self.low[full], self.high[full] = 0.0, 0.0
        own = np.repeat(full, kept), np.nonzero(filled)[1]
        self.low[own], self.high[own] = low[begins], high[ends]
        self.count[full] = kept
        return bool((kept <= self.capacity - 2).all())

    def contains(self, points: Floats) -> Bools:
        """Return for points (k, 3) in the blank's frame whether the nearest ray has material there."""
        u, v, w = points[:, cycle(self.axis)].T
        column = np.clip(
            np.floor((u - self.origin[0]) / self.pitch).astype(np.int64), 0, self.columns - 1
        )
        row = np.clip(
            np.floor((v - self.origin[1]) / self.pitch).astype(np.int64), 0, self.rows - 1
        )
        cell = row * self.columns + column
        there = np.arange(self.capacity) < self.count[cell][:, None]
        return np.asarray(
            (there & (self.low[cell] <= w[:, None]) & (w[:, None] <= self.high[cell])).any(axis=1)
        )


def _in_box(rows: int, columns: int, pitch: float, size: Floats) -> Ints:
    """Return 1 for each ray that goes through a box, 0 for those of the last row or column that pass it."""
    across, along = (
        (np.arange(n) + 0.5) * pitch <= s + tolerance.PARAMETRIC
        for n, s in zip((columns, rows), size, strict=True)
    )
    return np.asarray((along[:, None] & across).astype(np.int64).ravel())


def cycle(axis: int) -> list[int]:
    """Return which of the blank's axes are a bundle's u, v, w."""
    return [(axis + 1) % 3, (axis + 2) % 3, axis]
