"""The fix `trim`: an operation that cuts mostly air cuts only where a cutter before it left something."""

from __future__ import annotations

from dataclasses import replace

from trunnion import registry
from trunnion.findings import Fix
from trunnion.model.process import ProcessTree
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.plan.freeform.keys import EARLIER
from trunnion.plan.repair.contract import RepairJob
from trunnion.plan.repair.rest_finishing import NOT_FINISHING
from trunnion.registry import STRATEGIES


def trimmed_to_rest(process: ProcessTree, fix: Fix, job: RepairJob) -> ProcessTree | None:
    """Return the process with a finishing operation told which larger cutter finished its faces before; None where none did."""
    operation = process.operation(fix.operation)
    strategy = registry.get(STRATEGIES, operation.strategy)
    if not issubclass(strategy.drive, SurfaceDrive) or operation.choices.get(EARLIER):
        return None
    before = process.operations[: process.operations.index(operation)]
    larger = [
        o
        for o in before
        if set(o.faces) >= set(operation.faces)
        and o.setup == operation.setup
        and not o.suppressed
        and o.kind not in NOT_FINISHING
        and o.cutter.radius > operation.cutter.radius
    ]
    if not operation.faces or not larger:
        return None
    return process.with_operation(
        replace(operation, choices={**operation.choices, EARLIER: larger[-1].cutter.name})
    )
