"""Toolpaths of a whole process: each operation from its drive geometry, knowing the stock that those before it leave.

An operation whose drive, tool, data, settings and stock have the same digest keeps its toolpath.
"""

from __future__ import annotations

from typing import Any

from trunnion import registry
from trunnion.findings import BadCall, Refused, error
from trunnion.model.operation import Operation, OperationPath
from trunnion.model.session import Session
from trunnion.pipeline.bench import Bench
from trunnion.plan.drive import drive_of
from trunnion.plan.regions import Space
from trunnion.progress import Progress
from trunnion.settings import checked, choose, digest
from trunnion.toolpath.stock import PlanningStock


def strategy_settings() -> tuple[type, ...]:
    """Return the settings of every registered strategy."""
    return tuple(registry.get("strategies", name).settings for name in registry.names("strategies"))


def make_paths(session: Session, bench: Bench, progress: Progress) -> tuple[OperationPath, ...]:
    """Return the toolpath of every operation that is not suppressed, in the order they are cut."""
    if session.process is None or session.recognition is None or session.blank is None:
        raise BadCall("no operations yet: generate the route first")
    made: list[OperationPath] = []
    total = sum(len(session.process.of_setup(setup.name)) for setup in session.setups)
    for setup in session.setups:
        stock = PlanningStock.of(session.blank, setup)
        space = Space.of(bench.part, session.recognition, session.blank, setup)
        for operation in session.process.of_setup(setup.name):
            progress.at(len(made) / max(total, 1), f"toolpath of {operation.id}")
            here = progress.part(len(made) / max(total, 1), (len(made) + 1) / max(total, 1))
            done = _make_one(session, space, operation, stock, here)
            made.append(done)
            if len(done.path):
                stock = stock.after(done.path, operation.tool)
    return tuple(made)


def _make_one(session: Session, space: Space, operation: Operation, stock: PlanningStock, progress: Progress) -> OperationPath:
    if session.process is None:
        raise BadCall("no operations yet: generate the route first")
    strategy = registry.get("strategies", operation.strategy)
    chosen = checked(choose(strategy.settings, {**session.choices, **operation.choices}))
    try:
        drive = drive_of(operation, session.process, space)
        key = digest(operation.strategy, drive, operation.tool, operation.data, chosen, stock.digest, space.setup)
        kept = session.path_of(operation.id)
        if kept is not None and kept.key == key:
            return kept
        planned: Any = strategy(drive, operation.tool, operation.data, stock, space.setup, chosen, progress)
    except Refused as reason:
        left = error("toolpath.refused", str(reason), operation.id, operation.feature)
        return OperationPath(operation=operation.id, findings=(left,))
    return OperationPath(operation=operation.id, path=planned.path, findings=tuple(planned.findings), key=key)
