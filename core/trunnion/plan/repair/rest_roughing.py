"""The fix `clear_first`: what stands in a tool's way is roughed before, by a copy of the roughing there with a smaller cutter."""

from __future__ import annotations

from dataclasses import replace

from trunnion import tolerance
from trunnion.findings import Fix
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.model.tool import Tool
from trunnion.plan.cutting.milling import ROUGHING
from trunnion.plan.repair.contract import RepairJob
from trunnion.plan.repair.tool_change import next_tool
from trunnion.plan.tool_choice import depth_reached

LEAST = 3.0
"""mm: no smaller cutter is sent to clear; it would take longer than the part is worth."""
FALLING = 0.7
"""Largest cutter that clears over the one that roughed before."""


def cleared_first(process: ProcessTree, fix: Fix, job: RepairJob) -> ProcessTree | None:
    """Return the process with rest roughing before an operation, on its feature or, where that is roughed with all others, on the whole."""
    operation = process.operation(fix.operation)
    before = process.operations[: _index(process, operation.id)]
    rough = [
        o
        for o in before
        if o.setup == operation.setup
        and not o.suppressed
        and o.kind in ROUGHING
        and o.kind != "face"
        and o.direction == operation.direction
        and (o.feature == operation.feature or not _is_of_feature(process, o))
    ]
    if not rough:
        return None
    last = min(rough, key=lambda o: (o.cutter.diameter, o.id))
    tool = _clearing_tool(process, last, operation, job)
    if tool is None:
        return None
    share = tool.diameter / last.cutter.diameter
    data = last.data
    added = replace(
        last,
        id=free_operation(process, f"clear-{operation.feature}"),
        tool=tool,
        data=replace(
            data,
            width=data.width * share,
            depth=data.depth * share,
            routed_depth=data.routed_depth * share,
        ),
        after=tuple(dict.fromkeys((*last.after, last.id))),
        rules=(
            f"It clears what {operation.tool.name} of {operation.id} would meet with its shank.",
        ),
    )
    at = _index(process, operation.id)
    waiting = replace(operation, after=tuple(dict.fromkeys((*operation.after, added.id))))
    return replace(
        process,
        operations=(*process.operations[:at], added, waiting, *process.operations[at + 1 :]),
    )


def _is_of_feature(process: ProcessTree, rough: Operation) -> bool:
    """Return whether roughing is of one feature alone: others of its kind are of other features."""
    return len({o.feature for o in process.operations if o.kind == rough.kind and not o.faces}) > 1


def _clearing_tool(
    process: ProcessTree, last: Operation, operation: Operation, job: RepairJob
) -> Tool | None:
    most = FALLING * last.cutter.diameter + tolerance.COINCIDENT
    deep = min(depth_reached(last.cutter), depth_reached(operation.cutter))
    return next_tool(
        process,
        last,
        job,
        lambda t: LEAST <= t.diameter <= most and depth_reached(t) >= deep - tolerance.COINCIDENT,
    )


def _index(process: ProcessTree, id: str) -> int:
    return next(n for n, o in enumerate(process.operations) if o.id == id)


def free_operation(process: ProcessTree, name: str) -> str:
    """Return a name with the first number that no operation has."""
    taken, number = {o.id for o in process.operations}, 1
    while f"{name}-{number}" in taken:
        number += 1
    return f"{name}-{number}"
