"""Playback: the plan's blocks over time, and the stock cut forward to any of them.

What is played is the posted text read back when it belongs to the plan, so that every block knows its line; else the toolpaths.
The stock is cut forward from the nearest snapshot. Cutting a part of a block first and the whole of it later leaves the same stock, so a
playback may stop anywhere.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from trunnion.findings import BadCall, Cancelled, Refused, TrunnionError
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.model.blank import Blank
from trunnion.model.material import Machine
from trunnion.model.motion.program import Program
from trunnion.model.motion.toolpath import Mark, Motion, Toolpath
from trunnion.model.playback import Moment, Passage, Timeline
from trunnion.model.session import PostedFile, Session
from trunnion.pipeline.context import Context
from trunnion.pipeline.proof.posted_programs import machine_of, programs_of, read_back
from trunnion.post.release import release
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.settings import checked, choose, digest
from trunnion.verify.judge.setups import bundles_of
from trunnion.verify.machine.times import seconds_of
from trunnion.verify.motion import Moves, moves_of
from trunnion.verify.settings import ProofSettings
from trunnion.verify.stock import Stock, run_stock
from trunnion.verify.stock.mesh import mesh_of
from trunnion.verify.stock.stock import Snapshot

FINENESS = 900
"""Cells along the longest side of the blank when nobody chooses, for heights: as fine as a picture shows, and still cut at once."""
COARSER = 400
"""The same for several bundles."""
FLUSH = 1e-4
"""Of a cell: what is so near to a flat side of the blank lies in it."""
CURVED = 1.0
"""Of a cell: the same beside a curved side, which cells follow in steps."""
SNAPSHOTS = 32
"""Positions of the plan that the stock is remembered at."""
_LEAST = 1e-3
"""mm: a part of a block shorter than this is not cut on its own."""
_FIRST_CHUNK = 256
"""Blocks cut before the first look at the clock; later chunks take what the clock allows."""
_TOGETHER_S = 0.1
"""Time that blocks cut together should take."""
_MOST_TOGETHER = 20_000


class Playback:
    """A plan that can be looked at from its first block to its last. Not for several threads at a time."""

    def __init__(
        self,
        session: Session,
        context: Context,
        cell: float = 0.0,
        progress: Progress = NO_PROGRESS,
    ) -> None:
        """`cell` mm is the fineness of the stock; 0: as fine as a picture shows. Raises `BadCall` where nothing can be played."""
        if session.process is None or session.blank is None:
            raise BadCall("no toolpaths yet: generate them first")
        programs, files = progress.aside(
            lambda _: played(session, context.shop.machines), "reading the text back"
        )
        if not any(p.sections for p in programs):
            raise BadCall("no toolpaths yet: generate them first")
        # What turns is not played: the first setup that mills begins with what turning leaves.
        milling = [
            k for k, p in enumerate(programs) if not any(s.path.work_turns for s in p.sections)
        ]
        if not milling:
            raise BadCall("turning can't be played back: nothing else is programmed")
        programs = tuple(programs[k] for k in milling)
        files = tuple(files[k] for k in milling) if files else files
        self.blank = programs[0].setup.begins_with(session.blank)
        bundles = bundles_of(programs, self.blank, checked(choose(ProofSettings, session.choices)))
        self.cell = cell or float(np.max(self.blank.size)) / (
            FINENESS if bundles == ("z",) else COARSER
        )
        self._programs = programs
        self._moves = progress.aside(
            lambda _: [moves_of(p.sections) for p in programs], "putting the blocks in time"
        )
        machines = [machine_of(p.setup, context.shop.machines) for p in programs]
        self.timeline = progress.aside(
            lambda _: timeline_of(
                programs,
                self._moves,
                files,
                machines,
                digest(self.cell, [f.text for f in files], _keys(session)),
            )
        )
        self._starts = np.cumsum([0, *(len(m) for m in self._moves)])
        self._every = max(1, -(-len(self.timeline) // SNAPSHOTS))
        self._chunk = _FIRST_CHUNK
        self._stock = progress.aside(
            lambda _: Stock.of(self.blank, self.cell, bundles), "filling the blank with rays"
        )
        self._position, self._removed = 0.0, 0.0
        self._kept: dict[int, tuple[Snapshot, float]] = {0: (self._stock.snapshot(), 0.0)}

    @property
    def n_blocks(self) -> int:
        """Number of blocks of all programs."""
        return len(self.timeline)

    def at(self, position: float, progress: Progress = NO_PROGRESS) -> Moment:
        """Return the stock at a position (blocks done, from 0 to `n_blocks`)."""
        return self.towards(position, np.inf, progress)

    def towards(self, position: float, seconds: float, progress: Progress = NO_PROGRESS) -> Moment:
        """Return the stock at a position, or on the way there when it is not reached in some seconds: call again to go on."""
        wanted = min(max(float(position), 0.0), float(self.n_blocks))
        if wanted < self._position:
            self._go_back(wanted)
        began, start, end = self._position, time.perf_counter(), time.perf_counter() + seconds
        while self._position < wanted:
            done = (self._position - began) / max(wanted - began, 1.0)
            progress.at(done, "cutting the stock")
            self._step(wanted, progress.part(done, done))
            now = time.perf_counter()
            # A block may take a thousand times as long as another: the chunk at most doubles.
            self._chunk = int(
                np.clip(
                    self._chunk * _TOGETHER_S / max(now - start, 1e-6),
                    16,
                    min(2 * self._chunk, _MOST_TOGETHER),
                )
            )
            start = now
            if now >= end:
                break
        return self._moment(progress)

    def _step(self, wanted: float, progress: Progress) -> None:
        """Cut some blocks: not beyond the position wanted, the next snapshot or the end of a program."""
        first = int(self._position)
        program = int(np.searchsorted(self._starts, first, side="right")) - 1
        stop = min(
            wanted,
            first + self._chunk,
            (first // self._every + 1) * self._every,
            self._starts[program + 1],
        )
        last = int(stop)
        own = self._moves[program]
        rows = np.arange(first, last) - self._starts[program]
        pieces = [own.some(rows[~own.rapid[rows]])]
        if stop > last:
            pieces.append(self._part(program, last, stop - last))
        try:
            for moves in pieces:
                if len(moves):
                    run = run_stock(
                        self._stock, moves, self._programs[program].setup.frame, progress=progress
                    )
                    self._removed += float(run.removed.sum())
        except (TrunnionError, Cancelled):
            self._go_back(self._position)  # a stock that was not cut whole is of no use
            raise
        self._position = float(stop)
        if stop == last and last % self._every == 0 and last not in self._kept:
            self._kept[last] = (self._stock.snapshot(), self._removed)

    def _part(self, program: int, block: int, share: float) -> Moves:
        """Return the first part of a block as moves of its own: none for a rapid, or when it is too short to matter."""
        own, row = self._moves[program], block - int(self._starts[program])
        nothing = own.some(np.zeros(0, np.int64))
        if own.rapid[row] or share * own.length[row] < _LEAST:
            return nothing
        section = self._programs[program].sections[own.section[row]]
        frame = self._programs[program].setup.frame
        tip, axis = self.timeline.pose(block + share)
        k = int(own.block[row])
        path = Toolpath(
            position=np.stack([own.start[row], frame.to_local(tip)]),
            centre=np.stack([np.full(3, np.nan), own.centre[row]]),
            axis=np.stack([own.start_axis[row], frame.local_direction(axis)]),
            feed=np.array([0.0, own.feed[row]]),
            motion=np.array([Motion.RAPID, section.path.motion[k]]),
            mark=np.array([Mark.RETRACT, section.path.mark[k]]),
        )
        return moves_of([replace(section, path=path)]).some(np.array([1]))

    def _go_back(self, wanted: float) -> None:
        nearest = max(k for k in self._kept if k <= wanted)
        snapshot, self._removed = self._kept[nearest]
        self._stock.restore(snapshot)
        self._position = float(nearest)

    def _moment(self, progress: Progress) -> Moment:
        line = self.timeline
        progress.doing("making the picture of the stock")
        mesh = mesh_of(
            self._stock
        )  # not aside: cancelled, it would go on reading a stock that is cut again
        points, triangles = mesh.points, mesh.triangles
        tip, axis = line.pose(self._position)
        return Moment(
            position=self._position,
            points=self.blank.frame.to_world(points).astype(np.float32),
            triangles=triangles.astype(np.int32),
            fresh=fresh_of(points, triangles, self.blank, self.cell),
            tip=tip,
            axis=axis,
            operation=line.passage(self._position).operation,
            line=int(line.line[line.block(self._position)]),
            removed=self._removed,
            time=line.seconds_at(self._position),
        )


def played(
    session: Session, machines: Mapping[str, Machine]
) -> tuple[tuple[Program, ...], tuple[PostedFile, ...]]:
    """Return the programs to play, and the posted file of each: of the text that belongs to the plan, else of the toolpaths, without."""
    try:
        files = tuple(f for f in release(session) if f.setup)
    except (BadCall, Refused):
        return programs_of(session), ()
    return read_back(session, session.posted, machines), files


def _keys(session: Session) -> tuple[str, ...]:
    return tuple(p.key for p in session.paths)


def timeline_of(
    programs: tuple[Program, ...],
    moves: list[Moves],
    files: tuple[PostedFile, ...],
    machines: Sequence[Machine],
    key: str,
) -> Timeline:
    """Return all blocks of some programs over time, each on its own machine; a change of the tool counts to the first block after it."""
    passages: list[Passage] = []
    spans: list[Floats] = []
    lines: list[Ints] = []
    for k, (program, own, machine) in enumerate(zip(programs, moves, machines, strict=True)):
        span = seconds_of(own, machine, np.zeros(3))
        begins = np.cumsum([0, *(len(s.path) for s in program.sections)])
        for n, section in enumerate(program.sections):
            if n == 0 or program.sections[n - 1].tool.number != section.tool.number:
                span[begins[n]] += machine.tool_change_s
            span[begins[n]] += section.dwell - section.path.dwells().sum()
            span[begins[n] : begins[n + 1]] += section.path.dwells()
            passages.append(
                Passage(
                    operation=section.operation,
                    setup=program.setup.name,
                    tool=section.cutter,
                    file=files[k].suffix if files else "",
                )
            )
            lines.append(
                np.array(section.block_lines or np.zeros(len(section.path)), dtype=np.int64)
            )
        spans.append(span)
    sections = [(p.setup.frame, s) for p in programs for s in p.sections]
    return Timeline(
        key=key,
        passages=tuple(passages),
        first=np.cumsum([0, *(len(s.path) for _, s in sections)]),
        tip=np.vstack([f.to_world(s.path.position) for f, s in sections]),
        axis=np.vstack([f.world_direction(s.path.axis) for f, s in sections]),
        centre=np.vstack([f.to_world(s.path.centre) for f, s in sections]),
        sweep=np.concatenate([s.path.sweeps() for _, s in sections]),
        rapid=np.concatenate([s.path.motion == Motion.RAPID for _, s in sections]),
        mark=np.concatenate([s.path.mark for _, s in sections]),
        line=np.concatenate(lines),
        time=np.concatenate([[0.0], np.cumsum(np.concatenate(spans))]),
    )


def fresh_of(points: Floats, triangles: Ints, blank: Blank, cell: float) -> Bools:
    """Return for each triangle (t,) of a stock's surface in the blank's frame whether it was cut: it doesn't lie in a side of the blank.

    Round a curved side of the blank the surface of a stock with cells of `cell` mm is only near it.
    """
    sides = blank.sides(points, FLUSH * cell, CURVED * cell)
    a, b, c = (sides[triangles[:, k]] for k in range(3))
    return np.asarray(~(a & b & c).any(axis=1))
