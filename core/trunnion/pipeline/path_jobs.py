"""Toolpaths of a setup's operations in their order, several at a time in copies of the process.

A leaning tool takes nothing off the planner's fields of heights, so that the next operations need not wait for its path. Leaning tools that
leave nothing wait for those that leave an allowance, whose cuts they are told. An upright tool lowers the fields, but hardly where those on
other features look: their paths are made ahead, on the stock of the moment, and kept where all that was looked at of it is the same when
their turn comes. All that depends on the order (the pose that a tool is left in, the stock) is seen to when paths are taken over, in their
order: they are those that are made one after the other.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from types import TracebackType

from trunnion import registry
from trunnion.findings import Refused
from trunnion.forks import Fork, copies
from trunnion.model.operation import Operation, OperationPath
from trunnion.model.session import Session
from trunnion.pipeline.operation_path import CopyResult, PathJob
from trunnion.pipeline.planning.scene import SetupScene
from trunnion.pipeline.turning import refused, turned_path
from trunnion.plan.contract import Planner, ToolAxis
from trunnion.plan.prismatic.drive import PlaneDrive
from trunnion.plan.turning.drive import RevolvedDrive
from trunnion.progress import LOOK_S, Progress
from trunnion.registry import STRATEGIES
from trunnion.settings import checked, choose
from trunnion.toolpath.contract import Planned

DRIVEN = 0.2
"""Share of an operation's progress for the geometry that drives it."""
LEAST_S = 1.5
"""Seconds that paths of a strategy take on average from which on they are made ahead: a copy of the process is not for nothing."""
MISSES = 2
"""How many more paths may be made ahead for nothing than are kept before no more are."""
WAITING = 4
"""Times as many paths as are made beside each other may wait to be taken over: the stock of the moment gets older meanwhile."""
Maker = Callable[[Progress], Planned]
"""Returns the path of a strategy, or raises why there is none."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Begun:
    """An operation whose path is made, or will be when it is taken over; `prepared` is None where its drive was refused. `changes` is how
    often the stock had changed before; with `ahead` a copy makes it on the stock of that moment."""

    operation: Operation
    progress: Progress
    prepared: PathJob | None
    make: Maker
    changes: int
    ahead: Fork[CopyResult] | None = None


@dataclass(slots=True)
class _Experience:
    """How many seconds each path took that was made here, by strategies; how many of those made ahead were `kept`, how many `missed`."""

    seconds: dict[str, list[float]] = field(default_factory=dict)
    kept: int = 0
    missed: int = 0

    def add(self, strategy: str, seconds: float) -> None:
        """Take in how long a path took that was made here."""
        self.seconds.setdefault(strategy, []).append(seconds)

    def is_worth_a_copy(self, strategy: str) -> bool:
        """Return whether the next path of a strategy should be made ahead."""
        taken = self.seconds.get(strategy, [])
        is_long = bool(taken) and sum(taken) >= LEAST_S * len(taken)
        return is_long and self.missed <= self.kept + MISSES


class _MustWait(Exception):
    """A drive looks at the paths before it: it can't be made ahead of them."""


class PathJobs:
    """The operations of a setup, added in their order; `taken` is told of each with its path, in that order too.

    `idle` waits until no thread of this process is at work.
    """

    def __init__(
        self,
        session: Session,
        planner: Planner,
        scene: SetupScene,
        taken: Callable[[Operation, OperationPath], None],
        idle: Callable[[], None],
    ) -> None:
        self._session, self._planner, self._scene = session, planner, scene
        self._taken, self._idle = taken, idle
        self._begun: deque[_Begun] = deque()
        self._copies: list[Fork[Planned] | Fork[CopyResult]] = []
        self._is_taking_over = False
        self._changes, self._experience = 0, _Experience()
        scene.before_laid = self.take_over
        scene.before_leaning = self._take_over_allowances
        scene.before_cuts = self._take_over_for

    def __enter__(self) -> PathJobs:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        reason: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        for copy in self._copies:
            copy.stop()

    def add(self, operation: Operation, progress: Progress, *, more: bool) -> None:
        """Begin the path of an operation; with `more` another one follows it."""
        strategy = registry.get(STRATEGIES, operation.strategy)
        if strategy.drive is RevolvedDrive:
            self.take_over()
            path = turned_path(self._session, self._planner, self._scene, operation, progress)
            self._taken(operation, path)
            return
        leans, may_be_kept = self._leans(operation), self._session.path_of(operation.id) is not None
        in_copy = more and not may_be_kept and copies() > 0
        if in_copy and not leans and self._experience.is_worth_a_copy(operation.strategy):
            self._begun.append(self._begun_ahead(operation, progress))
            return
        if may_be_kept or any(b.ahead is not None for b in self._begun):
            self.take_over()
        start = time.perf_counter()
        begun = self._prepared(operation, progress, now=not may_be_kept)
        if begun.prepared is not None and not may_be_kept and not begun.prepared.is_empty:
            begun = (self._in_copy if leans and in_copy else _made)(begun)
        self._experience.add(operation.strategy, time.perf_counter() - start)
        self._begun.append(begun)
        if not leans:
            self.take_over()

    def take_over(self) -> None:
        """Wait for all paths that are begun and take them over."""
        self._take_while(lambda: True)

    def _take_while(self, wanted: Callable[[], bool]) -> None:
        """Take over paths that are begun, in their order, as long as it is wanted."""
        # Whatever asks for paths while they are taken over gets those before its own.
        if self._is_taking_over:
            return
        self._is_taking_over = True
        try:
            while self._begun and wanted():
                self._take(self._at_last(self._begun.popleft()))
        finally:
            self._is_taking_over = False

    def _at_last(self, begun: _Begun) -> _Begun:
        """Return an operation whose turn has come: begun anew where the stock is another one now, but for a path that would be the same."""
        is_same = begun.changes == self._changes
        now = begun if is_same else self._prepared(begun.operation, begun.progress, now=False)
        if begun.ahead is None or begun.prepared is None or now.prepared is None:
            return now
        try:
            made = begun.ahead.result(begun.progress.part(DRIVEN, 1.0))
        except _MustWait:
            return now
        except Refused as reason:
            # On this stock it may come to something.
            return replace(now, make=_raising(reason)) if is_same else now
        if not is_same:
            fits = now.prepared.takes(begun.prepared, made)
            self._experience.kept += fits
            self._experience.missed += not fits
            if not fits:
                return now
        make = _returning(made.planned or Planned())
        return replace(now, prepared=now.prepared.known_by(made), make=make)

    def _take_over_allowances(self) -> None:
        """Wait for all paths that are begun where one of them leaves an allowance, and take them over."""
        if any(b.prepared is not None and b.prepared.driven.allowance > 0.0 for b in self._begun):
            self.take_over()

    def _take_over_for(self, feature: str) -> None:
        """Take over the paths that are begun as long as one of them is for a feature."""
        self._take_while(lambda: any(b.operation.feature == feature for b in self._begun))

    def _leans(self, operation: Operation) -> bool:
        """Return whether the tool of an operation leans from its setup's or its cutting frame's z."""
        strategy = registry.get(STRATEGIES, operation.strategy)
        settings = checked(
            choose(strategy.settings, {**self._session.choices, **operation.choices})
        )
        return bool(strategy.tool_axis(settings) is ToolAxis.LEANING)

    def _prepared(self, operation: Operation, progress: Progress, *, now: bool) -> _Begun:
        """Return an operation with what its path depends on; with `now` its drive is made at once, as the path will be too."""
        try:
            prepared = PathJob.of(
                self._session, self._planner, self._scene, operation, progress.part(0.0, DRIVEN)
            )
            if now:
                prepared.driven.lazy.made()
        except Refused as reason:
            return _Begun(
                operation=operation,
                progress=progress,
                prepared=None,
                make=_raising(reason),
                changes=self._changes,
            )
        return _Begun(
            operation=operation,
            progress=progress,
            prepared=prepared,
            make=prepared.planned,
            changes=self._changes,
        )

    def _begun_ahead(self, operation: Operation, progress: Progress) -> _Begun:
        """Begin the path of an upright tool in a copy of the process, on the stock of the moment."""
        # Those on the same feature look at what the others cut; the later the moment the more of the stock is known.
        self._take_while(
            lambda: any(
                b.ahead is not None and b.operation.feature == operation.feature
                for b in self._begun
            )
        )
        self._take_while(lambda: len(self._begun) >= WAITING * copies())
        self._take_while(self._is_next_done)
        while self._is_busy():
            progress.check()
            time.sleep(LOOK_S)
            self._take_while(self._is_next_done)
        begun = self._prepared(operation, progress, now=False)
        if begun.prepared is None:
            return begun
        if registry.get(STRATEGIES, operation.strategy).drive is PlaneDrive:
            # All copies look for the faces of their guide lines in the same triangles: they are made once, before them.
            part = self._scene.context.part
            part.mesh(part.picture_chord)
        self._idle()
        copy = Fork(partial(_made_ahead, self._scene, begun.prepared))
        self._copies.append(copy)
        return replace(begun, ahead=copy)

    def _is_busy(self) -> bool:
        """Return whether as many copies are at work as may be."""
        return sum(not c.is_done() for c in self._copies) >= copies()

    def _is_next_done(self) -> bool:
        """Return whether the path that is to be taken over next was made ahead, and is there."""
        ahead = self._begun[0].ahead
        return ahead is not None and ahead.is_done()

    def _in_copy(self, begun: _Begun) -> _Begun:
        """Begin to make a path in a copy of the process, as soon as one more may be at work."""
        while self._is_busy():
            begun.progress.check()
            time.sleep(LOOK_S)
        if begun.prepared is not None:
            # All copies ask about the same part: its tree is built once, before them.
            self._scene.context.make_ready(self._scene.setup, begun.prepared.driven.setup.frame)
        self._idle()
        copy = Fork(begun.make)
        self._copies.append(copy)
        return replace(begun, make=copy.result)

    def _take(self, begun: _Begun) -> None:
        """Take over a path."""
        progress, prepared = begun.progress, begun.prepared
        try:
            made = prepared.kept(self._session) if prepared is not None else None
            if made is None:
                planned = begun.make(progress.part(DRIVEN, 1.0))
                assert prepared is not None
                made = prepared.path(planned)
        except Refused as reason:
            self._taken(begun.operation, refused(begun.operation, reason))
            return
        self._changes += prepared is not None and prepared.cut(made, progress.part(1.0, 1.0))
        self._taken(begun.operation, made)


def _made_ahead(scene: SetupScene, job: PathJob, progress: Progress) -> CopyResult:
    """Return what a copy of the process makes of a job."""

    def wait() -> None:
        raise _MustWait

    # The paths that others make are nobody's there.
    kept = scene.before_laid, scene.before_leaning, scene.before_cuts
    scene.before_laid = scene.before_leaning = wait
    scene.before_cuts = lambda feature: wait()
    try:
        return job.ahead(progress)
    finally:
        scene.before_laid, scene.before_leaning, scene.before_cuts = kept


def _made(begun: _Begun) -> _Begun:
    """Make a path here and now."""
    try:
        planned = begun.make(begun.progress.part(DRIVEN, 1.0))
    except Refused as reason:
        make = _raising(reason)
    else:
        make = _returning(planned)
    return replace(begun, make=make)


def _returning(planned: Planned) -> Maker:
    return lambda progress: planned


def _raising(reason: Refused) -> Maker:
    def make(progress: Progress) -> Planned:
        raise reason

    return make
