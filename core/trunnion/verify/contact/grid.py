"""Boxes listed by the cells of a plan grid: what lies near a position is found without looking at the rest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Floats, Ints
from trunnion.verify.kernels.contact import strips as kernel

GRID_CELLS = 1_000_000
"""Most cells of a grid; the pitch grows when what it covers is larger than that."""


@dataclass(frozen=True, slots=True, eq=False)
class Grid:
    """Boxes listed by the cells of a plan grid: frame (3,) is x, y and pitch; shape (2,) cells; start (cells + 1,) into rows."""

    frame: Floats
    shape: Ints
    start: Ints
    rows: Ints


def grid_of(boxes: Floats, pitch: float, order: Ints | None = None) -> Grid:
    """Return the grid over plan boxes (n, 4); the rows of a cell come in the boxes' order, or in that of `order`."""
    if not len(boxes):
        return Grid(
            np.array([0.0, 0.0, pitch]),
            np.zeros(2, np.int64),
            np.zeros(1, np.int64),
            np.zeros(0, np.int64),
        )
    order = np.arange(len(boxes)) if order is None else order
    boxes = boxes[order]
    low, high = boxes[:, :2].min(axis=0), boxes[:, 2:].max(axis=0)
    pitch = max(
        pitch,
        float(np.sqrt(np.prod(high - low) / GRID_CELLS)),
        float((high - low).max() / GRID_CELLS),
    )
    frame, shape = np.array([*low, pitch]), (np.floor((high - low) / pitch) + 1).astype(np.int64)
    counts = np.zeros(int(shape.prod()), np.int64)
    kernel.fill_cells(boxes, frame, shape, counts, np.zeros(0, np.int64), np.zeros(0, np.int64))
    start = np.concatenate([[0], np.cumsum(counts)])
    rows = np.zeros(int(start[-1]), np.int64)
    kernel.fill_cells(boxes, frame, shape, counts, start, rows)
    return Grid(frame, shape, start, order[rows])
