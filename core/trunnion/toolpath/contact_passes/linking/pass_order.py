"""In which order passes are cut, and where closed ones begin."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree

from trunnion import tolerance
from trunnion.geometry.arrays import Floats, Ints, unit
from trunnion.progress import Progress
from trunnion.toolpath.contact_passes.linking.parameters import LinkParameters
from trunnion.toolpath.contact_passes.passes import Pass

FIRST = 8
"""Neighbours that are asked for at first; four times as many where all of them are cut already."""


def ordered(passes: Sequence[Pass], parameters: LinkParameters, progress: Progress) -> list[Pass]:
    """Return the passes in the order they are cut, closed ones begun where they come nearest to the end of the one before."""
    if parameters.order != "given":
        nearest = _nearest(passes, parameters, progress)
        if parameters.order == "nearest" or _air(nearest, parameters) < _air(passes, parameters):
            passes = nearest
    out: list[Pass] = []
    for one in passes:
        if one.closed:
            one = _overlapped(
                _begun(one, out[-1].tip[-1] if out else one.tip[0]), parameters.overlap
            )
        out.append(one)
    return out


def _air(passes: Sequence[Pass], parameters: LinkParameters) -> float:
    """Return how far it is from the ends of all passes to the starts of the next ones."""
    starts, ends = (_poses(passes, row, parameters) for row in (0, -1))
    return float(np.linalg.norm(starts[1:] - ends[:-1], axis=1).sum())


def _poses(passes: Sequence[Pass], row: int, parameters: LinkParameters) -> Floats:
    """Return one end of each pass (m, 6): its tip, and its axis in mm of the way on which it may turn so far."""
    return np.array([[*p.tip[row], *(p.axis[row] / parameters.turn)] for p in passes])


def _nearest(
    passes: Sequence[Pass], parameters: LinkParameters, progress: Progress
) -> Sequence[Pass]:
    """Return the passes so that each begins near where the one before ends, from the first on."""
    # Greedy nearest neighbour on the passes' ends.
    starts, ends = (_poses(passes, row, parameters) for row in (0, -1))
    forward, backward = _Remaining(starts), _Remaining(ends)
    out, row, turns = list[Pass](), 0, False
    for n in range(len(passes)):
        progress.at(n / len(passes), "Ordering passes")
        if n:
            here = (starts if turns else ends)[row]
            row, ahead = forward.nearest(here)
            turns = False
            if parameters.reversing:
                other, back = backward.nearest(here)
                turns = back < ahead - tolerance.COINCIDENT
                row = other if turns else row
        out.append(passes[row].reversed() if turns else passes[row])
        forward.remove(row)
        backward.remove(row)
    return out


class _Remaining:
    """Positions that are left of some, (m, 6), by a k-d tree of them that is made again when half of it is gone."""

    def __init__(self, positions: Floats) -> None:
        self._positions, self._is_left = positions, np.ones(len(positions), dtype=bool)
        self._grow()

    def remove(self, row: int) -> None:
        """Take one of the positions away."""
        self._is_left[row] = False
        self._left -= 1
        if 2 * self._left < len(self._rows) and self._left:
            self._grow()

    def nearest(self, here: Floats) -> tuple[int, float]:
        """Return the row of the position that is nearest to one (6,), and how far it is; the first of several."""
        count = FIRST
        while True:
            some = min(count, len(self._rows))
            far, found = (np.atleast_1d(v) for v in self._tree.query(here, some))
            rows: Ints = self._rows[found]
            left = self._is_left[rows]
            if left.any():
                far, rows = far[left], rows[left]
                return int(rows[far <= far[0]].min()), float(far[0])
            count *= 4

    def _grow(self) -> None:
        self._rows = np.flatnonzero(self._is_left)
        self._tree, self._left = cKDTree(self._positions[self._rows]), len(self._rows)


def _begun(one: Pass, position: Floats) -> Pass:
    """Return a closed pass that begins at its tip nearest to a position."""
    row = int(np.argmin(np.linalg.norm(one.tip[:-1] - position, axis=1)))
    order = np.append(np.roll(np.arange(len(one) - 1), -row), row)
    return Pass(tip=one.tip[order], axis=one.axis[order], normal=one.normal[order], closed=True)


def _overlapped(one: Pass, overlap: float) -> Pass:
    """Return a closed pass that goes on over its start by an overlap."""
    if overlap <= 0.0:
        return one
    run = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(one.tip, axis=0), axis=1))])
    last = min(overlap, 0.5 * float(run[-1]))
    row = int(np.searchsorted(run, last, side="right")) - 1
    share = (last - run[row]) / (run[row + 1] - run[row])
    more = (
        np.vstack([a[1 : row + 1], (1.0 - share) * a[row : row + 1] + share * a[row + 1 : row + 2]])
        for a in (one.tip, one.axis, one.normal)
    )
    tip, axis, normal = (
        np.vstack([a, b]) for a, b in zip((one.tip, one.axis, one.normal), more, strict=True)
    )
    return Pass(tip=tip, axis=unit(axis), normal=normal)
