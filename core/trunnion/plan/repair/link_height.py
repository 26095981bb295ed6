"""The fix `lift`: rapids of an operation end and cross farther above what may stand there."""

from __future__ import annotations

from dataclasses import replace

from trunnion import registry
from trunnion.findings import Fix
from trunnion.model.process import ProcessTree
from trunnion.plan.repair.contract import RepairJob
from trunnion.registry import STRATEGIES
from trunnion.settings import choose, declared

MARGIN = 0.5
"""mm that rapids are lifted by beyond what was measured."""


def with_higher_links(process: ProcessTree, fix: Fix, job: RepairJob) -> ProcessTree | None:
    """Return the process with a greater safety distance for an operation: by as much as a rapid was too low, and a margin; None where its
    strategy has no such setting or its range ends."""
    operation = process.operation(fix.operation)
    settings = registry.get(STRATEGIES, operation.strategy).settings
    safety = next((d for d in declared(settings) if d.name == "safety"), None)
    if safety is None:
        return None
    wanted = choose(settings, {**job.choices, **operation.choices}).safety + fix.amount + MARGIN
    if safety.high is not None and wanted > safety.high:
        return None
    return process.with_operation(
        replace(operation, choices={**operation.choices, safety.key: wanted})
    )
