"""Lines over a sheet where a field crosses whole numbers: level lines of a distance, flow lines of a blend, turns of a spiral."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Bools, Floats, Ints, items_of
from trunnion.geometry.kernels.shortest_paths.fast_marching_compiled import chain_loop
from trunnion.geometry.sheet.sheet import Sheet


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SheetLine:
    """One line over a sheet: it crosses edges between points `ends` (k, 2) at shares (k,) of their way. A closed line's last crossing is
    its first one again. `level` is the whole number that the field has on it (of a field with a turn, where it begins)."""

    ends: Ints
    share: Floats
    closed: bool
    level: int

    def value(self, field: Floats) -> Floats:
        """Return another field (v, ...) of the sheet's points on the line (k, ...)."""
        share = self.share.reshape(-1, *([1] * (field.ndim - 1)))
        return np.asarray((1.0 - share) * field[self.ends[:, 0]] + share * field[self.ends[:, 1]])

    def of(self, rows: Bools | Ints | slice) -> SheetLine:
        """Return a part of the line, open."""
        return SheetLine(
            ends=self.ends[rows], share=self.share[rows], closed=False, level=self.level
        )


def pieces_over(lines: Sequence[SheetLine], sheet: Sheet, wanted: Bools) -> list[SheetLine]:
    """Return the pieces of lines over triangles that are wanted (t,), both of whose ends are on their sides."""
    if wanted.all():
        return list(lines)
    n = len(sheet.points)
    ends, side = sheet.edges()
    real = np.zeros(len(ends), bool)
    real[side[wanted]] = True
    key = ends[:, 0] * n + ends[:, 1]
    found = []
    for line in lines:
        crossed = np.searchsorted(key, line.ends.min(axis=1) * n + line.ends.max(axis=1))
        found += _pieces(line, real[crossed])
    return found


def _pieces(line: SheetLine, on: Bools) -> list[SheetLine]:
    """Return the pieces of a line of two and more crossings (k,) that are wanted."""
    if on.all():
        return [line]
    rows = np.arange(len(on))
    if line.closed:
        first = int(np.flatnonzero(~on)[0])
        rows = np.append(np.roll(rows[:-1], -first), first)
    edges = np.flatnonzero(np.diff(on[rows].astype(np.int8), prepend=0, append=0)).reshape(-1, 2)
    return [line.of(rows[a:b]) for a, b in edges.tolist() if b - a > 1]


def whole_levels(sheet: Sheet, field: Floats, turns: Ints | None = None) -> list[SheetLine]:
    """Return the lines on which a field (v,) is a whole number, the greater values on their left, those of low levels first.

    `turns` (t, 3): whole numbers that the corners of the triangles add to the field, for one that goes up by whole numbers on the way
    round a tube: a line that winds around it is one line.
    """
    triangles = sheet.triangles
    turns = np.zeros_like(triangles) if turns is None else turns
    value = field[triangles] + turns
    low = np.ceil(value.min(axis=1)).astype(np.int64)
    count = np.maximum(np.ceil(value.max(axis=1)).astype(np.int64) - low, 0)
    row, number = items_of(count)
    level = low[row] + number
    above = field[triangles[row]] > level[:, None] - turns[row]
    after = above[:, [1, 2, 0]]
    real = above.any(axis=1) & ~above.all(axis=1)
    row, level, above, after = row[real], level[real], above[real], after[real]
    falls, climbs = np.argmax(above & ~after, axis=1), np.argmax(~above & after, axis=1)
    ends, side = sheet.edges()
    rise = np.empty(len(ends))
    for k in range(3):
        forth = np.where(triangles[:, k] == ends[side[:, k], 0], 1.0, -1.0)
        rise[side[:, k]] = forth * (value[:, (k + 1) % 3] - value[:, k])
    # A crossing is known by its edge and its level as seen from the edge's lower end, whatever turns the triangles beside it add.
    node = [
        np.column_stack(
            [
                side[row, k],
                level
                - np.where(
                    triangles[row, k] == ends[side[row, k], 0],
                    turns[row, k],
                    turns[row, (k + 1) % 3],
                ),
            ]
        )
        for k in (falls, climbs)
    ]
    nodes, first, number = np.unique(
        np.concatenate(node), axis=0, return_index=True, return_inverse=True
    )
    follows = np.full(len(nodes), -1)
    follows[number.ravel()[: len(row)]] = number.ravel()[len(row) :]
    edge, seen = nodes.T
    share = np.clip((seen - field[ends[edge, 0]]) / rise[edge], 0.0, 1.0)
    order, start, closed = chains(follows)
    lines = []
    for begin, end, is_closed in zip(start[:-1], start[1:], closed):
        at = order[begin:end]
        lines.append(
            SheetLine(
                ends=ends[edge[at]],
                share=share[at],
                closed=bool(is_closed),
                level=int(level[first[at[0]] % len(row)]),
            )
        )
    return sorted(lines, key=lambda line: line.level)


def chains(follows: Ints) -> tuple[Ints, Ints, Bools]:
    """Return the chains of nodes of which each names the one that follows it (n,), -1: none: nodes in order, where each chain starts
    (c + 1,), and whether it is closed (c,): then its last node is its first one again. No node follows two others."""
    order, start, closed = (
        np.empty(2 * len(follows), np.int64),
        np.zeros(len(follows) + 1, np.int64),
        np.zeros(len(follows), np.bool_),
    )
    count = chain_loop(np.ascontiguousarray(follows), order, start, closed)
    return order[: start[count]], start[: count + 1], closed[:count]
