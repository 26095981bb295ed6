"""The fix `tolerance`: passes follow the faces more closely, where a gouge lies within what their chords may miss."""

from __future__ import annotations

from dataclasses import replace

from trunnion import registry
from trunnion.findings import Fix
from trunnion.model.process import ProcessTree
from trunnion.plan.repair.contract import RepairJob
from trunnion.registry import STRATEGIES
from trunnion.settings import choose, declared

FINER = 0.5
"""Share of the chord error that is tried next."""
LEAST_CHORD = 1e-4
"""mm: no gouge comes from chords that are closer."""


def with_finer_passes(process: ProcessTree, fix: Fix, job: RepairJob) -> ProcessTree | None:
    """Return the process with half the chord error for an operation whose strategy has one."""
    operation = process.operation(fix.operation)
    settings = registry.get(STRATEGIES, operation.strategy).settings
    key = next((d.key for d in declared(settings) if d.name == "chord"), "")
    if not key:
        return None
    chord = FINER * choose(settings, {**job.choices, **operation.choices}).chord
    if chord < LEAST_CHORD:
        return None
    return process.with_operation(replace(operation, choices={**operation.choices, key: chord}))
