"""Passes of a flank along guide lines: the cutter lies on each ruling, in blocks as long as its chord error and what is around allow."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.model.tool import Tool
from trunnion.plan.clearance import ClearanceQuery
from trunnion.plan.freeform.swarf.flank import flank_poses
from trunnion.plan.freeform.swarf.guide_lines import GuideLine
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.toolpath.contact_passes.contacts import slerp
from trunnion.toolpath.contact_passes.passes import Pass

HALVINGS = 12
"""Halvings in which the lift of a position is found: to a thousandth of the most that is tried, and less."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FlankPasses:
    """Passes of a flank, and how far in mm guide lines go with them and in all."""

    passes: tuple[Pass, ...]
    done: float
    whole: float


def poses_on(line: GuideLine, tool: Tool, allowance: float = 0.0) -> Pass:
    """Return where a cutter lies along the rulings of a line, its flank beginning at the line's points, kept off by an allowance (mm)."""
    tip, axis = flank_poses(line.point, line.normal, line.ruling, tool, allowance)
    return Pass(tip=tip, axis=axis, normal=line.normal, closed=line.closed)


def flank_passes(
    lines: Sequence[GuideLine],
    tool: Tool,
    allowance: float,
    query: ClearanceQuery,
    chord: float,
    progress: Progress = NO_PROGRESS,
) -> FlankPasses:
    """Return the passes of a cutter's flank along lines, those of each after one another, without what touches something it must not."""
    passes = list[Pass]()
    done = whole = 0.0
    for line in progress.over(list(lines), "Laying a flank along walls"):
        poses = poses_on(line, tool, allowance)
        length = np.linalg.norm(np.diff(line.point, axis=0), axis=1)
        clear = query(poses.tip, poses.axis)
        whole += float(length.sum())
        for rows, closed in stretches(clear, closed=line.closed):
            some = poses.of(rows)
            kept = _thinned(some, tool.flute_length, chord)
            for piece in _free_pieces(some, kept, query):
                is_whole = closed and len(piece) > 1 and int(piece[-1] - piece[0]) == len(some) - 1
                passes.append(
                    Pass(
                        tip=some.tip[piece],
                        axis=some.axis[piece],
                        normal=some.normal[piece],
                        closed=is_whole,
                    )
                )
                gone = rows[piece[0] : piece[-1] + 1] % max(len(line) - 1, 1)
                done += float(length[np.minimum(gone[:-1], len(length) - 1)].sum())
    return FlankPasses(passes=tuple(passes), done=done, whole=whole)


def lifts(
    line: GuideLine, tool: Tool, allowance: float, query: ClearanceQuery, most: float
) -> Floats:
    """Return how far (k,) in mm a flank on a line is lifted along its rulings until it touches nothing; infinite where the most won't do.

    Over a face as a whole the lift is no less than wanted anywhere, and goes evenly between few positions: the least concave function of
    the way that is nowhere below.
    """
    found = np.zeros(len(line))
    rows = np.flatnonzero(~_is_clear(line, found, tool, allowance, query))
    low, high = np.zeros(len(rows)), np.full(len(rows), most)
    if not len(rows):
        return found
    some = line.of(rows)
    lost = ~_is_clear(some, high, tool, allowance, query)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        clear = _is_clear(some, middle, tool, allowance, query)
        low, high = np.where(clear, low, middle), np.where(clear, middle, high)
    # A clear pose may still enter a face by what finishing cuts may: that is for the faces it is laid on.
    found[rows] = np.where(lost, np.inf, high + tolerance.FINISH_GOUGE)
    return _evened(line, found)


def _is_clear(
    line: GuideLine, lift: Floats, tool: Tool, allowance: float, query: ClearanceQuery
) -> Bools:
    poses = poses_on(line.at(line.point + lift[:, None] * line.ruling), tool, allowance)
    return query(poses.tip, poses.axis)


def _evened(line: GuideLine, lift: Floats) -> Floats:
    """Return lifts (k,) as the least concave functions of the way over each face that are nowhere below; infinite ones stay."""
    found = lift.copy()
    gone = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line.point, axis=0), axis=1))])
    is_known = np.isfinite(lift)
    breaks = (np.diff(line.face) != 0) | (np.diff(is_known.astype(np.int8)) != 0)
    ends = [0, *(np.flatnonzero(breaks) + 1).tolist(), len(lift)]
    for a, b in pairwise(ends):
        if is_known[a] and b - a > 2:
            hull = _upper_hull(gone[a:b], lift[a:b])
            found[a:b] = np.interp(gone[a:b], gone[a:b][hull], lift[a:b][hull])
    return found


def _upper_hull(x: Floats, y: Floats) -> Ints:
    """Return the rows of the upper convex hull of points with ascending x (Andrew's monotone chain)."""
    hull = list[int]()
    for row in range(len(x)):
        while len(hull) > 1:
            a, b = hull[-2:]
            if (y[b] - y[a]) * (x[row] - x[a]) > (y[row] - y[a]) * (x[b] - x[a]):
                break
            hull.pop()
        hull.append(row)
    return np.array(hull)


def stretches(clear: Bools, *, closed: bool) -> list[tuple[Ints, bool]]:
    """Return the rows of positions that are clear one after the other, and whether they are all of a closed line."""
    n = len(clear)
    if clear.all():
        return [(np.arange(n), closed)]
    rows = np.arange(n)
    if closed:
        # Begun behind what is not clear; the last position of a closed line is its first one.
        first = int(np.flatnonzero(~clear)[0])
        rows = np.concatenate([np.arange(first, n - 1), np.arange(0, first + 1)])
    edges = np.flatnonzero(np.diff(clear[rows].astype(np.int8), prepend=0, append=0))
    return [(rows[a:b], False) for a, b in edges.reshape(-1, 2).tolist() if b - a > 1]


def _thinned(poses: Pass, flank: float, chord: float) -> Ints:
    """Return the rows of poses (k,) that blocks need: between two of them neither the tip nor the end of a flank (mm) over it is farther
    than the chord error from where it would be at the others (Douglas and Peucker)."""
    n = len(poses)
    gone = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(poses.tip, axis=0), axis=1))])
    kept, open_blocks = {0, n - 1}, [(0, n - 1)]
    while open_blocks:
        a, b = open_blocks.pop()
        if b - a < 2:
            continue
        inner = np.arange(a + 1, b)
        size = gone[b] - gone[a]
        share = (gone[inner] - gone[a]) / size if size > 0.0 else np.zeros(len(inner))
        at = np.full(len(inner), a), np.full(len(inner), b)
        axis = slerp(poses.axis[at[0]], poses.axis[at[1]], share)
        tip = poses.tip[a] + share[:, None] * (poses.tip[b] - poses.tip[a])
        off = tip - poses.tip[inner]
        far = np.maximum(
            np.linalg.norm(off, axis=1),
            np.linalg.norm(off + flank * (axis - poses.axis[inner]), axis=1),
        )
        worst = int(np.argmax(far))
        if far[worst] > chord:
            row = int(inner[worst])
            kept.add(row)
            open_blocks += [(a, row), (row, b)]
    return np.array(sorted(kept))


def _free_pieces(poses: Pass, kept: Ints, query: ClearanceQuery) -> list[Ints]:
    """Return the rows of poses in pieces whose blocks are clear: a long block that is not is tried again from one position to the next."""
    kept = kept[np.insert(_goes(poses, kept), 0, True)]
    if len(kept) < 2:
        return []
    clear = _free_blocks(poses, kept, query)
    if not clear.all():
        again = [
            np.arange(a, b) if not ok else np.array([a])
            for a, b, ok in zip(kept[:-1].tolist(), kept[1:].tolist(), clear.tolist(), strict=True)
        ]
        kept = np.concatenate([*again, kept[-1:]])
        kept = kept[np.insert(_goes(poses, kept), 0, True)]
        clear = _free_blocks(poses, kept, query)
    edges = np.flatnonzero(np.diff(clear.astype(np.int8), prepend=0, append=0)).reshape(-1, 2)
    return [kept[a : b + 1] for a, b in edges.tolist()]


def _goes(poses: Pass, rows: Ints) -> Bools:
    """Return which of some rows but the first bring the tool anywhere from the one before."""
    moved = np.linalg.norm(np.diff(poses.tip[rows], axis=0), axis=1)
    turned = np.linalg.norm(np.diff(poses.axis[rows], axis=0), axis=1)
    return (moved > tolerance.COINCIDENT) | (turned > tolerance.PARAMETRIC)


def _free_blocks(poses: Pass, kept: Ints, query: ClearanceQuery) -> Bools:
    tip, axis = poses.tip[kept], poses.axis[kept]
    return query(tip[1:], axis[1:], start_tip=tip[:-1], start_axis=axis[:-1])
