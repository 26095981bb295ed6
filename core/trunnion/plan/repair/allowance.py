"""The fix `allowance`: roughing that goes into a face keeps farther off all of them."""

from __future__ import annotations

from dataclasses import replace

from trunnion import registry
from trunnion.findings import Fix
from trunnion.model.process import ProcessTree
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.plan.freeform.keys import ALLOWANCE, number
from trunnion.plan.prismatic.drive import FLOOR_ALLOWANCE, WALL_ALLOWANCE
from trunnion.plan.repair.contract import RepairJob
from trunnion.plan.repair.rest_finishing import NOT_FINISHING
from trunnion.registry import STRATEGIES

MARGIN = 0.1
"""mm that roughing stays off a face beyond what it went in."""


def with_more_allowance(process: ProcessTree, fix: Fix, job: RepairJob) -> ProcessTree | None:
    """Return the process with a roughing or semi-finishing operation that leaves as much more as it cut too deep, and a margin; None for
    finishing, whose allowance is the part's size."""
    operation = process.operation(fix.operation)
    if operation.kind not in NOT_FINISHING:
        return None
    keys = _keys(operation.strategy)
    more = {key: number(operation, key) + fix.amount + MARGIN for key in keys}
    return process.with_operation(replace(operation, choices={**operation.choices, **more}))


def _keys(strategy: str) -> tuple[str, ...]:
    """Return the keys of an operation's choices that say what it leaves."""
    if issubclass(registry.get(STRATEGIES, strategy).drive, SurfaceDrive):
        return (ALLOWANCE,)
    return WALL_ALLOWANCE, FLOOR_ALLOWANCE
