"""The fix `feed`: an operation's feed is lowered to what the spindle gives at its highest load."""

from __future__ import annotations

import math
from dataclasses import replace

from trunnion.findings import Fix
from trunnion.model.process import ProcessTree
from trunnion.model.tool import TAP
from trunnion.plan.cutting.milling import CuttingSettings
from trunnion.plan.repair.contract import RepairJob
from trunnion.settings import choose, declared

LEAST_SHARE = 0.2
"""Share of the material's feed below which an operation is planned wrongly, not fed too fast."""
DECIMALS = 3
FEED_SHARE = next(d.key for d in declared(CuttingSettings) if d.name == "feed_share")
"""Key of the factor on the material's feed per tooth."""


def with_lower_feed(process: ProcessTree, fix: Fix, job: RepairJob) -> ProcessTree | None:
    """Return the process with a share of an operation's feed, rounded down; its data follow when they are balanced again. A tap's feed is
    its pitch's: it stays."""
    operation = process.operation(fix.operation)
    if operation.tool.form == TAP:
        return None
    now = choose(CuttingSettings, {**job.choices, **operation.choices}).feed_share
    share = math.floor(now * min(fix.amount, 1.0) * 10**DECIMALS) / 10**DECIMALS
    if share < LEAST_SHARE or share >= now:
        return None
    return process.with_operation(
        replace(operation, choices={**operation.choices, FEED_SHARE: share})
    )
