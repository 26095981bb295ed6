"""Bundles of rays along an axis of the blank: where material is on each, as sorted intervals in flat arrays."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.model.blank import Blank
from trunnion.verify.kernels.stock.intervals import COUNT, FIRST, Rays
from trunnion.verify.stock.field import UP, Field, Part, cells_along, tiles_of

AXES = ("x", "y", "z")
SPARE = 2
"""Intervals that a ray may have where it stands at first."""
POOL = 0.5
"""Free rows of a tile over those of its rays at first: rays that are full move there."""
RAGGED = 2 * SPARE
"""Rays of more intervals are cut in many pieces."""
RAY_BYTES = round(8 * (3 + 2 * SPARE * (1.0 + POOL)))
"""Bytes that a ray takes at first: the number, place and capacity of its intervals, both ends of those, and its share of what is free."""


@dataclass(slots=True, eq=False)
class Bundle:
    """Rays along one axis through a box in a blank's frame.

    Coordinates (u, v, w) of a bundle are the blank's turned in a cycle, w along the rays: (y, z, x) for x, (z, x, y) for y, (x, y, z)
    for z.
    Rays stand at the centres of rows (v) of columns (u) of cells, `pitch` wide, from the blank's corner `origin` (u, v). Ray c = row *
    columns + column has its own row in `ray` (rays, 3): where its intervals, upwards, begin in `ends` (m, 2), how many it has, and how many
    it may have there. `free` (tiles, 2): the first row of `ends` that no ray of a tile has yet, and the one after the tile's last.
    """

    axis: int
    pitch: float
    rows: int
    columns: int
    origin: Floats
    ray: Ints
    ends: Floats
    free: Ints

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
        count = inside.count * _in_box(rows, columns, pitch, (last - first)[turned[:2]])
        there = np.arange(inside.low.shape[1]) < count[:, None]
        return Bundle._made(
            axis, pitch, (rows, columns), origin, (count, inside.low[there], inside.high[there])
        )

    @staticmethod
    def of_field(field: Field) -> Bundle:
        """Return a height field as rays along z."""
        rows, columns = field.top.shape
        top = field.top.ravel()
        count = _in_box(rows, columns, field.pitch, (field.high - field.low)[:2]) * (
            top > field.low[2]
        )
        high = top[count > 0]
        return Bundle._made(
            UP,
            field.pitch,
            (rows, columns),
            field.low[:2],
            (count, np.full(len(high), field.low[2]), high),
        )

    @staticmethod
    def _made(
        axis: int, pitch: float, size: tuple[int, int], origin: Floats, intervals: Part
    ) -> Bundle:
        """Return rows and columns (`size`) of rays with intervals: how many (rays,), and where all of them begin and end (m,)."""
        none = np.zeros((0, 3), np.int64)
        made = Bundle(axis, pitch, *size, origin.copy(), none, np.zeros((0, 2)), none)
        made._lay_out(intervals, np.full(len(made.tiles()), POOL))
        return made

    def _lay_out(self, intervals: Part, pool: Floats, most: int | None = None) -> bool:
        """Give every ray rows for its intervals with some to spare, tile by tile, and return whether that is done.

        It is not where the bundle would take more than `most` bytes. `pool` (tiles,): what is free behind a tile's rays over their own.
        """
        count, low, high = intervals
        # Powers of two, as rays take them when they are full.
        capacity = SPARE * 2 ** np.ceil(np.log2(np.maximum(count / SPARE, 1.0))).astype(np.int64)
        edges = np.array([first for first, _ in self.tiles()]) * self.columns
        own = np.add.reduceat(capacity, edges)
        free = np.maximum(
            np.ceil(pool * own).astype(np.int64), 2 * np.maximum.reduceat(capacity, edges)
        )
        ends = np.cumsum(own + free)
        # Asked before anything is allocated: the old intervals are still there.
        if most is not None and 8 * (2 * int(ends[-1]) + 3 * len(capacity) + 2 * len(free)) > most:
            return False
        shift = np.repeat(np.cumsum(free) - free, np.diff(np.append(edges, len(capacity))))
        self.ray = np.column_stack([np.cumsum(capacity) - capacity + shift, count, capacity])
        self.free = np.column_stack([ends - free, ends])
        self.ends = np.zeros((int(ends[-1]), 2))
        self.ends[_in_a_row(self.ray)] = np.column_stack([low, high])
        return True

    @property
    def nbytes(self) -> int:
        """Bytes that it takes."""
        return self.ray.nbytes + self.ends.nbytes + self.free.nbytes

    @property
    def count(self) -> Ints:
        """How many intervals each ray (rays,) has."""
        return self.ray[:, COUNT]

    @property
    def volume(self) -> float:
        """Volume in mm3 as these rays see it."""
        _, low, high = self.packed()
        return float((high - low).sum()) * self.pitch**2

    def tiles(self) -> list[tuple[int, int]]:
        """Return the first row and the one after the last of each tile."""
        return tiles_of(self.rows)

    def rays(self, tile: int) -> Rays:
        """Return the rays as kernels have them, with what is free of a tile by its number."""
        return Rays(self.ray, self.ends, self.free[tile])

    def packed(self) -> tuple[Ints, Floats, Floats]:
        """Return all intervals in a row: where each ray's begin and the last one's end among them (rays + 1,), and where they begin and end
        (m,) mm."""
        low, high = self.ends[_in_a_row(self.ray)].T.copy()
        return np.concatenate([[0], np.cumsum(self.count)]), low, high

    def parts(self) -> list[Part]:
        """Return a copy of each tile."""
        found: list[Part] = []
        for first, last in self.tiles():
            own = self.ray[first * self.columns : last * self.columns]
            low, high = self.ends[_in_a_row(own)].T.copy()
            found.append((own[:, COUNT].copy(), low, high))
        return found

    def put(self, parts: Sequence[Part]) -> None:
        """Become what copies of all tiles say."""
        count, low, high = (np.concatenate([p[k] for p in parts]) for k in range(3))
        self._lay_out((count, low, high), np.full(len(parts), POOL))

    def grow(self, tiles: Collection[int], most: int) -> bool:
        """Give tiles, by their numbers, as many free rows as their rays have, and return whether that is done: not where the bundle would
        take more than `most` bytes."""
        _, low, high = self.packed()
        return self._grown((self.count, low, high), tiles, most)

    def fill_gaps(self, longest: float, tiles: Collection[int], most: int) -> bool:
        """Fill gaps of at most a length (mm) between the intervals of rays that are cut in many pieces, then grow.

        Rays are a cell apart: gaps shorter than that along one are no more than the stock can tell across them. What is filled counts as
        material: nothing that stands is lost.
        """
        bounds, low, high = self.packed()
        begins = np.ones(len(low), bool)
        begins[1:] = low[1:] - high[:-1] > longest
        begins[bounds[:-1][self.count > 0]] = True
        begins |= np.repeat(self.count <= RAGGED, self.count)
        kept = np.diff(np.concatenate([[0], np.cumsum(begins)])[bounds])
        # The k-th interval that begins ends where the one before the next that begins does.
        ends = np.append(begins[1:], True)[: len(high)]
        return self._grown((kept, low[begins], high[ends]), tiles, most)

    def _grown(self, intervals: Part, tiles: Collection[int], most: int) -> bool:
        pool = np.full(len(self.free), POOL)
        pool[list(tiles)] = 1.0
        return self._lay_out(intervals, pool, most)

    def contains(self, points: Floats) -> Bools:
        """Return for points (k, 3) in the blank's frame whether the nearest ray has material there."""
        u, v, w = points[:, cycle(self.axis)].T
        column = np.clip(
            np.floor((u - self.origin[0]) / self.pitch).astype(np.int64), 0, self.columns - 1
        )
        row = np.clip(
            np.floor((v - self.origin[1]) / self.pitch).astype(np.int64), 0, self.rows - 1
        )
        own = self.ray[row * self.columns + column]
        point = np.repeat(np.arange(len(own)), own[:, COUNT])
        low, high = self.ends[_in_a_row(own)].T
        within = (low <= w[point]) & (w[point] <= high)
        return np.bincount(point[within], minlength=len(own)) > 0


def _in_a_row(ray: Ints) -> Ints:
    """Return the rows of all intervals (m,) of some rays (c, 3), ray by ray."""
    count = ray[:, COUNT]
    ends = np.cumsum(count)
    return np.repeat(ray[:, FIRST] - (ends - count), count) + np.arange(int(count.sum()))


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
