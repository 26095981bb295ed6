"""The fix `add_operation`: faces with unfinished places are finished once more by a smaller cutter, only there where the larger one left
something."""

from __future__ import annotations

from dataclasses import replace

from trunnion import registry, tolerance
from trunnion.findings import Fix
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.plan.cutting.milling import ROUGHING
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.plan.freeform.keys import EARLIER
from trunnion.plan.repair.contract import RepairJob
from trunnion.plan.repair.rest_roughing import free_operation
from trunnion.plan.repair.tool_change import next_tool
from trunnion.plan.tool_choice import depth_reached
from trunnion.registry import STRATEGIES

MOST_FACES = 8
"""Faces, the least finished first, that one round adds operations for."""
FALLING = 0.65
"""Largest cutter that finishes a rest over the one that left it: what a hardly smaller one comes into is not worth its way."""
SLIM = 0.4
"""The same for a cutter that goes where the next smaller one doesn't."""
NOT_FINISHING = (*ROUGHING, "semi")
"""Kinds of operations that leave an allowance."""


def with_rest_finishing(process: ProcessTree, fix: Fix, job: RepairJob) -> ProcessTree | None:
    """Return the process with an operation after each of those that finish some faces last, with the next smaller cutter."""
    return _with_each_smaller(process, fix, job, FALLING)


def with_slim_finishing(process: ProcessTree, fix: Fix, job: RepairJob) -> ProcessTree | None:
    """Return the same with a much smaller cutter: what is left may lie where the next smaller one doesn't come in."""
    return _with_each_smaller(process, fix, job, SLIM)


def _with_each_smaller(
    process: ProcessTree, fix: Fix, job: RepairJob, share: float
) -> ProcessTree | None:
    last: dict[str, tuple[Operation, list[int]]] = {}
    for face in fix.faces[:MOST_FACES]:
        finishing = [
            o
            for o in process.operations
            if face in o.faces
            and o.tool.rotates
            and not o.suppressed
            and o.kind not in NOT_FINISHING
        ]
        if finishing:
            smallest = min(finishing, key=lambda o: (o.cutter.diameter, o.id))
            last.setdefault(smallest.id, (smallest, []))[1].append(face)
    done = process
    for operation, faces in last.values():
        done = _with_smaller(done, operation, tuple(sorted(faces)), job, share) or done
    return None if done is process else done


def _with_smaller(
    process: ProcessTree,
    operation: Operation,
    faces: tuple[int, ...],
    job: RepairJob,
    most: float,
) -> ProcessTree | None:
    now = operation.cutter
    beside = [
        o
        for o in process.operations
        if set(o.faces) & set(faces) and o.tool.rotates and not o.suppressed
    ]
    deep = min(depth_reached(o.cutter) for o in beside)
    tool = next_tool(
        process,
        operation,
        job,
        lambda t: t.radius <= most * now.radius and depth_reached(t) >= deep - tolerance.COINCIDENT,
    )
    if tool is None:
        return None
    choices = dict(operation.choices)
    if issubclass(registry.get(STRATEGIES, operation.strategy).drive, SurfaceDrive):
        choices[EARLIER] = now.name
    data, share = operation.data, tool.diameter / now.diameter
    added = replace(
        operation,
        id=free_operation(process, f"again-{operation.id}"),
        tool=tool,
        faces=faces,
        choices=choices,
        data=replace(data, width=data.width * share),
        after=tuple(dict.fromkeys((*operation.after, operation.id))),
        rules=(f"It finishes what {now.name} of {operation.id} left: the proof asked for it.",),
    )
    at = next(n for n, o in enumerate(process.operations) if o.id == operation.id)
    return replace(
        process, operations=(*process.operations[: at + 1], added, *process.operations[at + 1 :])
    )
