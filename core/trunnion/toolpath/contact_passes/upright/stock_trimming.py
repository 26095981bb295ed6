"""Passes of an upright tool trimmed to where stock stands: what is left out of one would be air.

Levels are as near to each other as the tightest place at their height wants; elsewhere the passes before have taken all there is, and
roughing may have come as far. Places on the area say so: a field of heights knows its cells alone, and beside a wall none may lie in
what stands on it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Bools, Floats, Ints, items_of
from trunnion.geometry.kernels.stock_points import UNCUT, cut_points
from trunnion.model.tool import Tool
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.plan.freeform.reach import AreaSamples
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.toolpath.contact_passes.passes import Pass
from trunnion.toolpath.offsetting.trimming import LINK
from trunnion.toolpath.stock.heightfield import MOVES, PlanningStock, cutting_chords
from trunnion.units import SECONDS_PER_MINUTE

APART, MOST = 0.25, 200_000
"""mm that samples of the area are apart, and how many of them there are at most: beyond, they lie farther apart."""
CELL = 1.0
"""mm: side of the cells that samples are looked up by."""
GONE = 0
"""By which move a point is cleared that an earlier path has cleared, or where there never was stock."""
MARGIN = 0.2
"""Of the cutter's radius: what a pass begins before it takes something, and goes on after it."""
LEAST = 0.25
"""mm2 of the area: a piece of a pass that takes less is left out."""


def sample_count(area: float) -> int:
    """Return how many samples an area in mm2 is given."""
    return int(np.clip(math.ceil(area / APART**2), 1, MOST))


def trimmed_to_stock(
    passes: Sequence[Pass],
    samples: AreaSamples,
    drive: SurfaceDrive,
    tool: Tool,
    stock: PlanningStock,
    feed: float,
    progress: Progress = NO_PROGRESS,
) -> list[Pass]:
    """Return the pieces of passes, in their order, which take something off samples of the area where more stands than the drive's
    scallop height over what the passes are to leave; `feed` in mm/min.

    Whatever a whole pass would take there the pieces take, but for specks no larger than `LEAST`.
    """
    if not passes or not len(samples):
        return list(passes)
    uncut = _StockSamples.of(samples, drive.allowance + drive.height)
    uncut.lower_to(stock)
    for path, cutter in progress.each(stock.exact_cuts):
        starts, ends, _, error = cutting_chords(path, cutter)
        uncut.cut(starts, ends, cutter.radius - error, cutter.corner_radius, progress)
    kept = list[Pass]()
    gap = LINK * feed / SECONDS_PER_MINUTE
    fewest = max(1, math.ceil(LEAST / samples.area))
    for one in passes:
        progress.check()
        kept += _pieces(one, uncut, tool, gap, fewest)
    return kept


@dataclass(frozen=True, slots=True, eq=False)
class _StockSamples:
    """Points (k, 3) of the stock, in lists by cells (`cut_points`) from a corner (2,), and what cleared each (k,)."""

    points: Floats
    corner: Floats
    first: Ints
    following: Ints
    by: Ints

    @staticmethod
    def of(samples: AreaSamples, over: float) -> _StockSamples:
        """Return the points that lie over samples by some mm along their normals."""
        points = samples.point + over * samples.normal
        corner = points[:, :2].min(axis=0)
        at = np.floor((points[:, :2] - corner) / CELL).astype(np.int64)
        first = np.full(at.max(axis=0) + 1, -1)
        following = np.empty(len(points), np.int64)
        for k, (i, j) in enumerate(at.tolist()):
            following[k], first[i, j] = first[i, j], k
        return _StockSamples(points, corner, first, following, np.full(len(points), UNCUT))

    def lower_to(self, stock: PlanningStock) -> None:
        """Take what is higher than the stock as gone; beside its field nothing stands."""
        near = stock.cropped(self.corner, self.points[:, :2].max(axis=0))
        at = np.floor((self.points[:, :2] - near.corner) / near.cell).astype(np.int64)
        inside = np.flatnonzero(((at >= 0) & (at < near.field.shape)).all(axis=1))
        higher = inside[near.field[tuple(at[inside].T)] > self.points[inside, 2]]
        self.by[:] = GONE
        self.by[higher] = UNCUT

    def cut(
        self, starts: Floats, ends: Floats, radius: float, corner: float, progress: Progress
    ) -> None:
        """Take moves (n, 3) off; the number of the first that clears a point is put down."""
        for begin in progress.each(range(0, len(starts), MOVES)):
            some = slice(begin, begin + MOVES)
            self._clear(starts[some], ends[some], radius, corner)

    def take(self, one: Pass, tool: Tool) -> tuple[Ints, Ints]:
        """Take a pass off; return the points (m,) that it clears, and the moves (m,) that do."""
        before = self.by == UNCUT
        self._clear(one.tip[:-1], one.tip[1:], tool.radius, tool.corner_radius)
        rows = np.flatnonzero(before & (self.by != UNCUT))
        return rows, self.by[rows]

    def give_back(self, rows: Ints) -> None:
        """Let points (m,) stand again."""
        self.by[rows] = UNCUT

    def _clear(self, starts: Floats, ends: Floats, radius: float, corner: float) -> None:
        cut_points(
            self.points,
            self.first,
            self.following,
            *self.corner,
            CELL,
            np.array(starts),
            np.array(ends),
            radius,
            min(corner, radius),
            self.by,
        )


@dataclass(frozen=True, slots=True, eq=False)
class _FinePass:
    """A pass with positions no farther apart than a step, which of them are its own (n,), and how far along it each is (n,) mm."""

    whole: Pass
    own: Bools
    run: Floats

    @staticmethod
    def of(one: Pass, step: float) -> _FinePass:
        """Return a pass in moves no longer than a step (mm)."""
        long = np.linalg.norm(np.diff(one.tip, axis=0), axis=1)
        count = np.maximum(np.ceil(long / step), 1.0).astype(np.int64)
        row, number = items_of(count)
        share = (number / count[row])[:, None]
        tip = np.vstack([one.tip[row] + share * (one.tip[row + 1] - one.tip[row]), one.tip[-1:]])
        row = np.append(row, len(one) - 1)
        run = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(tip, axis=0), axis=1)))
        whole = Pass(tip=tip, axis=one.axis[row], normal=one.normal[row], closed=one.closed)
        return _FinePass(whole, np.append(number == 0, True), run)

    def begun_at(self, row: int) -> _FinePass:
        """Return a closed pass begun at one of its positions."""
        order = np.append(np.roll(np.arange(len(self.run) - 1), -row), row)
        ahead = np.roll(np.diff(self.run), -row)
        whole = Pass(
            tip=self.whole.tip[order],
            axis=self.whole.axis[order],
            normal=self.whole.normal[order],
            closed=True,
        )
        return _FinePass(whole, self.own[order], np.append(0.0, np.cumsum(ahead)))

    def between(self, start: float, end: float) -> Pass:
        """Return what lies from one distance along it to another, in its own positions and the two at the ends."""
        first = max(int(np.searchsorted(self.run, start, side="right")) - 1, 0)
        last = min(int(np.searchsorted(self.run, end)), len(self.run) - 1)
        kept = self.own.copy()
        kept[:first], kept[last + 1 :] = False, False
        kept[[first, last]] = True
        return self.whole.of(kept)


def _pieces(one: Pass, uncut: _StockSamples, tool: Tool, gap: float, fewest: int) -> list[Pass]:
    """Return the pieces of a pass that take standing points; those they don't take stand on."""
    margin = MARGIN * tool.radius
    fine = _FinePass.of(one, margin)
    points, moves = uncut.take(fine.whole, tool)
    if not len(points):
        return []
    count = np.bincount(moves, minlength=len(fine.run) - 1)
    if one.closed:
        begin, free = _longest_gap(fine.run, count)
        if free <= gap:
            return [one]
        fine = fine.begun_at(begin)
        count, moves = np.roll(count, -begin), (moves - begin) % len(count)
    # Runs of moves that take something, joined over gaps that are fed through sooner than linked over.
    taking = np.flatnonzero(count)
    breaks = np.flatnonzero(fine.run[taking[1:]] - fine.run[taking[:-1] + 1] > gap) + 1
    made = []
    for group in np.split(taking, breaks):
        if count[group].sum() < fewest:
            uncut.give_back(points[np.isin(moves, group)])
        else:
            made.append(fine.between(fine.run[group[0]] - margin, fine.run[group[-1] + 1] + margin))
    return made


def _longest_gap(run: Floats, count: Ints) -> tuple[int, float]:
    """Return the position in the middle of the longest way on which the moves of a closed pass take nothing, (n,) each, and how long in mm
    that is."""
    taking = np.flatnonzero(count)
    free = np.append(run[taking[1:]], run[taking[0]] + run[-1]) - run[taking + 1]
    widest = int(np.argmax(free))
    middle = math.fmod(float(run[taking[widest] + 1] + 0.5 * free[widest]), float(run[-1]))
    return int(np.abs(run[:-1] - middle).argmin()), float(free[widest])
