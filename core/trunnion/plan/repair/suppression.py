"""The fix `drop`: an operation that can't be made without harm is left out, where others finish what it was for."""

from __future__ import annotations

from dataclasses import replace

from trunnion.findings import Fix
from trunnion.model.process import ProcessTree
from trunnion.plan.repair.contract import RepairJob


def without_operation(process: ProcessTree, fix: Fix, job: RepairJob) -> ProcessTree | None:
    """Return the process with an operation suppressed: it stays in the tree, and a person can take it back."""
    operation = process.operation(fix.operation)
    if operation.suppressed:
        return None
    return process.with_operation(replace(operation, suppressed=True))
