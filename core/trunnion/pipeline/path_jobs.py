"""Toolpaths of a setup's operations in their order, those of leaning tools several at a time.

A leaning tool takes nothing off the planner's fields of heights, so that the next operations need not wait for its path: it is made in a
copy of the process. Leaning tools that leave nothing wait for those that leave an allowance, whose cuts they are told. All that depends on
the order (the pose that a tool is left in, the stock) is seen to when paths are taken over, in their order.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, replace
from types import TracebackType

from trunnion import registry
from trunnion.findings import Refused
from trunnion.forks import Fork, copies
from trunnion.model.operation import Operation, OperationPath
from trunnion.model.session import Session
from trunnion.pipeline.operation_path import PathJob
from trunnion.pipeline.planning.scene import SetupScene
from trunnion.pipeline.turning import refused, turned_path
from trunnion.plan.contract import Planner, ToolAxis
from trunnion.plan.turning.drive import RevolvedDrive
from trunnion.progress import LOOK_S, Progress
from trunnion.registry import STRATEGIES
from trunnion.settings import checked, choose
from trunnion.toolpath.contract import Planned

DRIVEN = 0.2
"""Share of an operation's progress for the geometry that drives it."""
Maker = Callable[[Progress], Planned]
"""Returns the path of a strategy, or raises why there is none."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Begun:
    """An operation whose path is made, or will be when it is taken over; `prepared` is None where its drive was refused."""

    operation: Operation
    progress: Progress
    prepared: PathJob | None
    make: Maker


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
        self._copies: list[Fork[Planned]] = []
        self._is_taking_over = False
        scene.before_laid = self.take_over
        scene.before_leaning = self._take_over_allowances

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
        if may_be_kept:
            self.take_over()
        begun = self._prepared(operation, progress, now=not may_be_kept)
        if begun.prepared is not None and not may_be_kept and not begun.prepared.is_empty:
            begun = (self._in_copy if leans and more and copies() else _made)(begun)
        self._begun.append(begun)
        if not leans:
            self.take_over()

    def take_over(self) -> None:
        """Wait for all paths that are begun and take them over."""
        # Whatever asks for paths while they are taken over gets those before its own.
        if self._is_taking_over:
            return
        self._is_taking_over, changed = True, False
        try:
            while self._begun:
                begun = self._begun.popleft()
                if changed and begun.prepared is not None:
                    # A tool that was to lean stood upright: what was begun after it knew another stock.
                    begun = self._prepared(begun.operation, begun.progress, now=False)
                changed |= self._take(begun)
        finally:
            self._is_taking_over = False

    def _take_over_allowances(self) -> None:
        """Wait for all paths that are begun where one of them leaves an allowance, and take them over."""
        if any(b.prepared is not None and b.prepared.driven.allowance > 0.0 for b in self._begun):
            self.take_over()

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
                operation=operation, progress=progress, prepared=None, make=_raising(reason)
            )
        return _Begun(
            operation=operation, progress=progress, prepared=prepared, make=prepared.planned
        )

    def _in_copy(self, begun: _Begun) -> _Begun:
        """Begin to make a path in a copy of the process, as soon as one more may be at work."""
        while len([c for c in self._copies if not c.is_done()]) >= copies():
            begun.progress.check()
            time.sleep(LOOK_S)
        if begun.prepared is not None:
            # All copies ask about the same part: its tree is built once, before them.
            self._scene.context.make_ready(self._scene.setup, begun.prepared.driven.setup.frame)
        self._idle()
        copy = Fork(begun.make)
        self._copies.append(copy)
        return replace(begun, make=copy.result)

    def _take(self, begun: _Begun) -> bool:
        """Take over a path; return whether the stock is another one then."""
        progress, prepared = begun.progress, begun.prepared
        try:
            made = prepared.kept(self._session) if prepared is not None else None
            if made is None:
                planned = begun.make(progress.part(DRIVEN, 1.0))
                assert prepared is not None
                made = prepared.path(planned)
        except Refused as reason:
            self._taken(begun.operation, refused(begun.operation, reason))
            return False
        changed = prepared is not None and prepared.cut(made, progress.part(1.0, 1.0))
        self._taken(begun.operation, made)
        return changed


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
