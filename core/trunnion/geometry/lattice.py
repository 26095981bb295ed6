"""Boxes listed by the cells of a plane grid: an index for proximity queries."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Floats, Ints, items_of

MOST_CELLS = 4_000_000
"""Most cells of a lattice; its pitch grows when a surface is larger than that."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Lattice:
    """low (2,) corner and pitch in mm, shape (2,) cells along x and y; rows[start[c]:start[c + 1]] are the boxes, ascending, that touch
    cell c = j * shape[0] + i."""

    low: Floats
    pitch: float
    shape: Ints
    start: Ints
    rows: Ints


def lattice_of(low: Floats, high: Floats, pitch: float) -> Lattice:
    """Return the lattice over boxes given by corners (n, 2)."""
    corner, end = low.min(axis=0), high.max(axis=0)
    pitch = max(
        pitch,
        float(np.sqrt(np.prod(end - corner) / MOST_CELLS)),
        float((end - corner).max() / MOST_CELLS),
    )
    shape = np.floor((end - corner) / pitch).astype(np.int64) + 1
    first, last = (np.floor((at - corner) / pitch).astype(np.int64) for at in (low, high))
    wide = last - first + 1
    count = wide.prod(axis=1)
    box, within = items_of(count)
    cell = (
        (first[box, 1] + within // wide[box, 0]) * shape[0] + first[box, 0] + within % wide[box, 0]
    )
    order = np.argsort(cell, kind="stable")
    start = np.concatenate([[0], np.cumsum(np.bincount(cell, minlength=int(shape.prod())))])
    return Lattice(
        low=corner, pitch=pitch, shape=shape, start=start.astype(np.int64), rows=box[order]
    )
