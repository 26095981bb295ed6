"""Following a dropped cutter along lines in plan: where its tip goes, in as few straight moves as a chord error allows.

All lines are worked on together. Positions are put in between (halving) until every chord's middle is on the path and no chord climbs so
differently from its neighbours that a kink could hide in it. Then those that aren't needed are taken out (Douglas and Peucker), which keeps
kinks since they lie farthest from any chord.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints, items_of
from trunnion.geometry.kernels.cutter_contact.drop_cutter import RHO1, height_at
from trunnion.geometry.surface.drop_surface import DropSurface
from trunnion.progress import NO_PROGRESS, Progress

UNSEEN = 0.5
"""Of the chord error: what stands up between two positions of a path, too narrow to be seen from either, is at most so high."""
WIDEST = 0.06
"""Of the cutter's radius: positions of a path are never farther apart, whatever would be seen; a wave could hide between them."""
HALVINGS = 30
SEEN, THINNED = 0.1, 0.3
"""Shares of the chord error: how far a middle may be from its chord, and how far a position that is taken out."""


def follow(
    drop: DropSurface,
    pieces: Floats,
    curves: Sequence[Floats],
    chord: float,
    lowest: float | Floats,
    progress: Progress = NO_PROGRESS,
    highest: float | Floats = np.inf,
) -> list[Floats]:
    """Return the tips (n, 3) of a cutter that follows each plan polyline (k, 2), as high as `DropSurface.drop` puts them between a lowest
    and a highest height, for all or for each polyline.

    Between two tips lies a straight move that leaves the cutter's path by at most `chord` mm; the ends and every kink of the path stay.
    Where nothing is under the cutter its tip is at `lowest`.
    """
    if not len(curves):
        return []
    # Drop at even steps, close enough that nothing as wide as the cutter sees hides between two.
    positions, line = _spaced(curves, 2.0 * _sight(pieces, chord))
    floor, ceiling = (np.full(len(curves), v, dtype=np.float64) for v in (lowest, highest))

    def dropped(plan: Floats, of: Ints, share: Progress) -> Floats:
        height = drop.drop(plan, pieces, floor[of], share, ceiling[of])
        return np.column_stack([plan, height])

    tips = dropped(positions, line, progress.part(0.0, 0.3))
    # Halve: invariant, `is_open[k]` marks the chord from tip k to k + 1 whose middle may still be off it by more than SEEN chord.
    is_open = np.append(line[1:] == line[:-1], False)
    for k in range(HALVINGS):
        rows = np.flatnonzero(is_open)
        if not len(rows):
            break
        middles = 0.5 * (tips[rows, :2] + tips[rows + 1, :2])
        share = progress.part(1.0 - 0.7 * 0.5**k, 1.0 - 0.7 * 0.5 ** (k + 1))
        found = dropped(middles, line[rows], share)
        is_open[rows] = chord_distance(found, tips[rows], tips[rows + 1]) > SEEN * chord
        tips, line = np.insert(tips, rows + 1, found, axis=0), np.insert(line, rows + 1, line[rows])
        is_open = np.insert(is_open, rows + 1, is_open[rows])
        is_open |= _bent(tips, line, chord)
        is_open[:-1] &= (line[1:] == line[:-1]) & (
            np.hypot(*np.diff(tips[:, :2], axis=0).T) > chord
        )
    progress.check()
    # Thin: the rest of the chord error pays for the tips that are left out.
    kept = thinned(tips, line, THINNED * chord)
    return np.split(tips[kept], np.flatnonzero(np.diff(line[kept])) + 1)


def thinned(points: Floats, line: Ints, chord: float) -> Bools:
    """Return which points (n, 3) of lines, numbered (n,) in ascending order, are needed so that none is farther than `chord` from its line.

    The first and last point of each line are.
    """
    # Douglas and Peucker (1973), all lines at once: the farthest point of each gap is kept until none is farther than the chord error.
    n = len(points)
    kept = np.ones(n, dtype=bool)
    kept[1:-1] = (line[1:-1] != line[:-2]) | (line[1:-1] != line[2:])
    rows = np.flatnonzero(~kept)
    while len(rows):
        ends = np.flatnonzero(kept)
        after = np.searchsorted(ends, rows)
        off = chord_distance(points[rows], points[ends[after - 1]], points[ends[after]])
        first = np.flatnonzero(np.diff(after, prepend=-1))
        most = np.maximum.reduceat(off, first)
        owner = np.repeat(np.arange(len(first)), np.diff(np.append(first, len(rows))))
        too_far = most > chord
        farthest = np.flatnonzero((off == most[owner]) & too_far[owner])
        farthest = farthest[np.diff(owner[farthest], prepend=-1) != 0]
        kept[rows[farthest]] = True
        rows = rows[too_far[owner] & ~kept[rows]]
    return kept


def chord_distance(points: Floats, start: Floats, end: Floats) -> Floats:
    """Return how far points (n, 3) are from the straight paths (n, 3) from a start to an end."""
    direction, to = end - start, points - start
    square = (direction * direction).sum(axis=1)
    share = np.clip(
        np.divide(
            (to * direction).sum(axis=1), square, out=np.zeros(len(direction)), where=square > 0.0
        ),
        0.0,
        1.0,
    )
    off: Floats = np.linalg.norm(to - share[:, None] * direction, axis=1)
    return off


def _bent(tips: Floats, line: Ints, chord: float) -> Bools:
    """Return for each tip (n,) whether the chord from it to the next climbs so differently from its neighbours that a kink may hide in
    it."""
    direction = np.diff(tips, axis=0)
    level = np.hypot(direction[:, 0], direction[:, 1])
    turn = np.abs(np.diff(np.arctan2(direction[:, 2], level)))
    turn[line[2:] != line[:-2]] = 0.0
    length = np.hypot(level, direction[:, 2])
    hidden = 0.25 * length * np.maximum(np.append(turn, 0.0), np.insert(turn, 0, 0.0))
    return np.append(hidden > SEEN * chord, False)


def _sight(pieces: Floats, chord: float) -> float:
    """Return how far apart positions may be so that nothing higher than `UNSEEN` chords hides between them: as wide as the cutter is
    there."""
    radius = float(pieces[-1, RHO1])
    low, high = 0.0, radius
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (
            (middle, high)
            if height_at(pieces, np.array([middle]))[0] < UNSEEN * chord
            else (low, middle)
        )
    return min(max(2.0 * low, tolerance.SHORT_MOVE), WIDEST * radius)


def _spaced(curves: Sequence[Floats], step: float) -> tuple[Floats, Ints]:
    """Return points (n, 2) of all polylines, their own ones and others between no farther than `step` apart, and which line (n,) each is
    on."""
    line = np.repeat(np.arange(len(curves)), [len(c) for c in curves])
    points = np.concatenate([np.asarray(c, dtype=np.float64) for c in curves])
    inside = np.append(line[1:] == line[:-1], False)
    direction = np.vstack([np.diff(points, axis=0), np.zeros((1, 2))])
    count = np.where(
        inside, np.maximum(np.ceil(np.hypot(direction[:, 0], direction[:, 1]) / step), 1.0), 1.0
    ).astype(np.int64)
    rows, number = items_of(count)
    share = number / count[rows]
    return points[rows] + share[:, None] * np.where(inside[rows, None], direction[rows], 0.0), line[
        rows
    ]
