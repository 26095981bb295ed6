"""Toolpaths of turning operations: the blank itself is their stock, and what they leave of it is the next one's."""

from __future__ import annotations

from typing import Any

from trunnion import registry
from trunnion.findings import Fix, Refused, error, info
from trunnion.model.blank import Revolved
from trunnion.model.operation import Operation, OperationPath
from trunnion.model.session import Session
from trunnion.model.tool import TurningTool
from trunnion.pipeline.planning.scene import SetupScene
from trunnion.plan.contract import DriveNeeds, Planner
from trunnion.progress import Progress
from trunnion.registry import STRATEGIES
from trunnion.settings import checked, choose, digest
from trunnion.toolpath.turning_passes.stock import turned_by

DRIVEN = 0.1
"""Share of an operation's progress for the geometry that drives it."""


def turned_path(
    session: Session, planner: Planner, scene: SetupScene, operation: Operation, progress: Progress
) -> OperationPath:
    """Return the toolpath of a turning operation; the scene's blank is what it leaves."""
    strategy, tool, blank = (
        registry.get(STRATEGIES, operation.strategy),
        operation.tool,
        scene.blank,
    )
    settings = checked(choose(strategy.settings, {**session.choices, **operation.choices}))
    try:
        if not isinstance(tool, TurningTool) or not isinstance(blank, Revolved):
            raise Refused(
                f"{operation.id}: a blank of revolution is turned by a turning tool; choose blank.kind = turned and another tool"
            )
        driven = planner.drive(
            operation, DriveNeeds(drive=strategy.drive), scene, progress.part(0.0, DRIVEN)
        )
        key = digest(
            operation.strategy, driven.identity, tool, operation.data, settings, blank, scene.setup
        )
        kept = session.path_of(operation.id)
        if driven.drive.is_empty:
            kept = empty_path(operation, key)
        if kept is None or kept.key != key:
            planned: Any = strategy(
                driven.drive,
                tool,
                operation.data,
                blank,
                driven.setup,
                settings,
                progress.part(DRIVEN, 1.0),
            )
            kept = OperationPath(
                operation=operation.id, path=planned.path, findings=planned.findings, key=key
            )
    except Refused as reason:
        return refused(operation, reason)
    if len(kept.path):
        scene.blank = turned_by(blank, scene.setup.frame, kept.path, tool)
    return kept


def empty_path(operation: Operation, key: str) -> OperationPath:
    """Return the empty path of an operation that finds nothing to cut."""
    nothing = info(
        "toolpath.nothing-left",
        f"{operation.id}: nothing stands there any more that it could cut",
        operation.id,
        remedy="suppress it",
    )
    return OperationPath(operation=operation.id, findings=(nothing,), key=key)


def refused(operation: Operation, reason: Refused) -> OperationPath:
    """Return the empty path of an operation that can't be made, with the reason."""
    refusal = error(
        "toolpath.refused",
        str(reason),
        operation.id,
        operation.feature,
        fix=Fix(kind="smaller_tool", operation=operation.id, reason="toolpath.refused")
        if operation.tool.rotates
        else None,
    )
    return OperationPath(operation=operation.id, findings=(refusal,))
