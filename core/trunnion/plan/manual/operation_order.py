"""An operation moved by a person: in front of another one of its setup, or to the setup's end, never before what it needs."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from trunnion.findings import Refused
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree


def with_operation_before(process: ProcessTree, id: str, before: str | None) -> ProcessTree:
    """Return a process with an operation moved in front of another one of its setup, or to the setup's end.

    Its data follow the plan as before. Raises `Refused` when it would come before one that it needs, or after one that needs it.
    """
    moved = replace(process.operation(id), moved=True)
    if before == id:
        return process
    if before is not None and process.operation(before).setup != moved.setup:
        raise Refused(
            f"{id} is cut in setup {moved.setup} and can't be moved to {process.operation(before).setup}"
        )
    rest = [o for o in process.operations if o.id != id]
    index = _index_of(rest, moved, before)
    ordered = (*rest[:index], moved, *rest[index:])
    # Only what the moved one needs, or what needs it, can have come out of order.
    for late, first in (pair for pair in out_of_order(ordered) if id in pair):
        raise Refused(f"{late} must come after {first}: move {first} first, or delete one of them")
    if [o.id for o in ordered] == [o.id for o in process.operations]:
        return process
    return replace(process, operations=ordered)


def out_of_order(operations: Sequence[Operation]) -> Iterable[tuple[str, str]]:
    """Return the pairs of operations, by id, of which the first one needs the second and comes before it."""
    row = {o.id: n for n, o in enumerate(operations)}
    return (
        (o.id, first) for o in operations for first in o.after if row.get(first, -1) > row[o.id]
    )


def _index_of(rest: Sequence[Operation], moved: Operation, before: str | None) -> int:
    if before is not None:
        return next(n for n, o in enumerate(rest) if o.id == before)
    return max((n + 1 for n, o in enumerate(rest) if o.setup == moved.setup), default=len(rest))
