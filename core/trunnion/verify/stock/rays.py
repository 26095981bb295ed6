"""Moves run through bundles of rays, tile by tile on all cores; what is summed is summed in the order of the tiles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from trunnion import tolerance
from trunnion.findings import OutOfMemory
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.progress import Progress
from trunnion.threads import in_parallel
from trunnion.verify.cutter import Bodies
from trunnion.verify.kernels.stock import dexels as kernel
from trunnion.verify.kernels.stock.swept_bounds import ALL_BOX
from trunnion.verify.motion import Moves
from trunnion.verify.stock.bundles import AXES, Bundle, cycle
from trunnion.verify.stock.engagement import Probes, Tally
from trunnion.verify.stock.field import UP
from trunnion.verify.stock.spans import Spans, spans_each, spans_of, whole_arcs
from trunnion.verify.stock.stock import MOST_BYTES, Stock

SPANS = 20_000
"""Spans made ready together: 6 MB."""
LOOKS = 8_000_000
"""Rays near the cutter that a tile may have to look at between two looks at cancel: a tenth of a second at most."""


@dataclass(frozen=True, slots=True, eq=False)
class Passed:
    """What moves (n,) did: removed mm3 (the mean of the bundles), depth and position (n, 3) in the blank's frame of rapids, how deep what
    doesn't cut went, and what the probes saw. grazed: moves (k,), and places with depths (k, 4), where rapids may be in material between
    rays."""

    removed: Floats
    depth: Floats
    position: Floats
    body: Floats
    tally: Tally
    grazed: list[tuple[Ints, Floats]] = field(default_factory=list)

    @staticmethod
    def empty(n: int, probes: Probes) -> Passed:
        """Return that nothing happened."""
        return Passed(
            np.zeros(n),
            np.zeros(n),
            np.full((n, 3), np.nan),
            np.zeros(n),
            Tally.empty(int(probes.start[-1])),
        )


@dataclass(frozen=True, slots=True, eq=False)
class BundleStart:
    """A bundle and the first move that goes through it; `looked` when the probes of that move have been looked at."""

    bundle: Bundle
    first: int = 0
    looked: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class _Batch:
    """Moves made ready together: where each one's spans start and the spans in each bundle's coordinates, tool, whether rapid, its way,
    and its probes."""

    start: Ints
    spans: list[Floats]
    bodies: Bodies
    tool: Ints
    rapid: Bools
    motion: Floats
    probes: Probes
    probe_start: Ints
    fine: int


def run_rays(
    stock: Stock,
    starts: Sequence[BundleStart],
    moves: Moves,
    probes: Probes,
    found: Passed,
    fine: int,
    progress: Progress,
    threads: int,
) -> None:
    """Run moves given in the blank's frame through some bundles of a stock and add to what was found.

    Cells that a rapid grazes are looked at in `fine` rays along each side, 0 for not at all. Raises `OutOfMemory` when rays are cut in too
    many pieces.
    """
    n = len(moves)
    share = 1.0 / len(stock.bundles)
    whole = whole_arcs(moves, [AXES.index(name) for name in stock.bundles])
    each = spans_each(moves, whole)
    ends = np.cumsum(each)
    row = min((g.first for g in starts), default=n)
    bundles = [g.bundle for g in starts]
    while row < n:
        begun = ends[row] - each[row]
        rows = np.arange(row, max(row + 1, int(np.searchsorted(ends, begun + SPANS, side="right"))))
        spans = spans_of(moves, rows, each[rows], whole[rows])
        motion = np.column_stack(
            [
                a[rows]
                for a in (
                    moves.start,
                    moves.end,
                    moves.start_axis,
                    moves.end_axis,
                    moves.centre,
                    moves.sweep,
                )
            ]
        )
        batch = _Batch(
            spans.start,
            [spans.along(axis) for axis in range(3)],
            moves.bodies,
            moves.tool[rows],
            moves.rapid[rows],
            motion,
            probes,
            probes.start[row : rows[-1] + 2],
            fine,
        )
        looks = np.cumsum(_looks(spans, (stock.low, stock.high), bundles))
        first = 0
        while first < len(rows):
            before = looks[first - 1] if first else 0.0
            last = min(
                max(first + 1, int(np.searchsorted(looks, before + LOOKS, side="right"))), len(rows)
            )
            jobs = [
                _Job(
                    g,
                    number,
                    tile,
                    batch,
                    max(first, g.first - row),
                    last,
                    g.looked and g.first >= row + first,
                )
                for g in starts
                if g.first < row + last
                for number, tile in enumerate(g.bundle.tiles())
            ]
            part = progress.part(
                float(begun + spans.start[first]) / ends[-1],
                float(begun + spans.start[last]) / ends[-1],
            )
            _run(jobs, bundles, part, threads)
            for job in jobs:
                job.note(found, row, share)
            first = last
        row = int(rows[-1]) + 1


def _run(jobs: list[_Job], bundles: Sequence[Bundle], progress: Progress, threads: int) -> None:
    """Run jobs until all are done, giving tiles more room where they need it; where memory has none gaps shorter than a cell are filled."""
    waiting = jobs
    while waiting:

        def work(first: int, last: int, waiting: list[_Job] = waiting) -> None:
            for job in waiting[first:last]:
                job.run()

        in_parallel(work, len(waiting), 1, progress, "Cutting the stock", threads)
        waiting = [job for job in waiting if not job.done]
        for bundle in {job.bundle.axis: job.bundle for job in waiting}.values():
            full = {job.number for job in waiting if job.bundle is bundle}
            most = MOST_BYTES - sum(b.nbytes for b in bundles if b is not bundle)
            if not (bundle.grow(full, most) or bundle.fill_gaps(bundle.pitch, full, most)):
                raise OutOfMemory(
                    f"stock at cells of {bundle.pitch:g} mm has become so ragged that it would need more than "
                    f"{MOST_BYTES / 1e6:.0f} MB: choose a coarser verify.cell"
                )


class _Job:
    """Some moves of a batch through one tile."""

    def __init__(
        self,
        start: BundleStart,
        number: int,
        tile: tuple[int, int],
        batch: _Batch,
        first: int,
        last: int,
        looked: bool,
    ) -> None:
        n = last - first
        self.bundle, self.number, self.tile, self.batch, self.first, self.last, self.done = (
            start.bundle,
            number,
            tile,
            batch,
            first,
            last,
            False,
        )
        self.resume = np.array([0, 0, 0, 0, 0, int(looked)])
        self.removed, self.depth, self.position, self.body = (
            np.zeros(n),
            np.zeros(n),
            np.full((n, 3), np.nan),
            np.zeros(n),
        )
        self.probe = (
            batch.probe_start[first : last + 1]
            if self.bundle.axis == UP
            else np.zeros(n + 1, np.int64)
        )
        self.tally = Tally.empty(int(self.probe[-1] - self.probe[0]))
        fine = batch.fine if self.bundle.axis == UP else 0
        self.fine, self.grazed = (
            fine,
            np.zeros(((fine > 0) * int(batch.rapid[first:last].sum()) * kernel.MOST_GRAZED, 4)),
        )

    def run(self) -> None:
        """Go on until all moves are done or the tile has no room."""
        own, b, m = slice(self.first, self.last), self.bundle, self.batch
        self.done = kernel.tridexel_cut_tile(
            self.last - self.first,
            m.spans[b.axis],
            m.start[self.first : self.last + 1],
            m.bodies.arc,
            m.bodies.piece,
            m.bodies.start,
            m.tool[own],
            m.rapid[own],
            b.rays(self.number),
            b.columns,
            *self.tile,
            b.origin,
            b.pitch,
            self.resume,
            self.removed,
            self.depth,
            self.position,
            self.body,
            m.motion[own],
            m.probes.rings,
            m.probes.flute,
            m.probes.circle,
            self.probe - self.probe[0],
            self.tally.counted,
            self.tally.spans,
            self.fine,
            tolerance.RAPID_DEPTH,
            self.grazed,
        )

    def note(self, found: Passed, row: int, share: float) -> None:
        """Add what happened to what was found in other tiles; the batch's moves count from `row`."""
        own = slice(row + self.first, row + self.last)
        found.removed[own] += self.removed * (self.bundle.pitch**2 * share)
        found.body[own] = np.maximum(found.body[own], self.body)
        deeper = np.flatnonzero(self.depth > found.depth[own])
        found.depth[own][deeper] = self.depth[deeper]
        found.position[own][deeper[:, None], cycle(self.bundle.axis)] = self.position[deeper]
        seen = slice(self.probe[0], self.probe[-1])
        found.tally.counted[seen] += self.tally.counted
        found.tally.spans[seen] = (
            Tally(found.tally.counted[seen], found.tally.spans[seen]).plus(self.tally).spans
        )
        listed = np.flatnonzero(self.grazed[:, 3] > 0.0)
        if len(listed):
            rapids = row + self.first + np.flatnonzero(self.batch.rapid[self.first : self.last])
            found.grazed.append((rapids[listed // kernel.MOST_GRAZED], self.grazed[listed]))


def _looks(spans: Spans, within: tuple[Floats, Floats], bundles: Sequence[Bundle]) -> Floats:
    """Return a bound for the rays that each move may have to look at."""
    box = spans.row[:, ALL_BOX : ALL_BOX + 6].reshape(-1, 2, 3)
    low, high = within
    size = np.minimum(box[:, 1], high) - np.maximum(box[:, 0], low)
    there = (size > 0.0).all(axis=1)
    rays = 50.0 + sum(there * size[:, cycle(b.axis)[:2]].prod(axis=1) / b.pitch**2 for b in bundles)
    return np.add.reduceat(rays, spans.start[:-1])
