"""What a person did to a process, taken over into a new route of the same part; what can't be is named, never dropped in silence."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from trunnion.findings import Finding, warning
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.plan.manual.operation_order import out_of_order
from trunnion.plan.process import with_tool_numbers
from trunnion.shop.crib import NO_CRIBS, Cribs


def with_manual_operations(
    before: ProcessTree | None, made: ProcessTree, cribs: Cribs = NO_CRIBS
) -> ProcessTree:
    """Return the plan that was made with the operations that a person changed, copied and moved as they were, and without those that were
    deleted.

    A place by hand is behind the same operation as before, or behind the nearest one before it that is still there.
    """
    if before is None:
        return made
    planned = {o.id for o in made.operations}
    changed = {o.id: o for o in before.operations if o.by_hand and o.id in planned}
    copies = {o.id for o in before.operations if _is_copied(o, planned, made)}
    kept = [
        _taken_over(changed.get(o.id), o) for o in made.operations if o.id not in before.removed
    ]
    operations, left = _reordered(_without_lost_needs(kept, copies), before, copies)
    return replace(
        made,
        # A cutter of the plan before has the number that it had there.
        operations=with_tool_numbers(_without_lost_needs(operations), made.setups, cribs),
        removed=tuple(dict.fromkeys((*made.removed, *before.removed))),
        findings=(*made.findings, *_lost(before, planned | copies), *_not_moved(left)),
    )


def _taken_over(changed: Operation | None, planned: Operation) -> Operation:
    """Return an operation as a person changed it, on the faces that the new route has for it where he chose none."""
    if changed is None:
        return planned
    if changed.own_faces or changed.strategy != planned.strategy:
        return changed
    return replace(changed, faces=planned.faces)


def _is_copied(operation: Operation, planned: set[str], made: ProcessTree) -> bool:
    """Return whether an operation is a copy of one that the new route has too, in a setup that it has."""
    setups = {s.name for s in made.setups}
    return operation.copy_of in planned and operation.setup in setups


def _reordered(
    operations: Sequence[Operation], before: ProcessTree, copies: set[str]
) -> tuple[list[Operation], list[str]]:
    """Return the operations with copies and those that a person moved behind what they were behind, and the ids of those that stay
    where the plan has them, or behind what they are copied from: at their places something would come before what it needs."""
    there = {o.id for o in operations}
    applied = {o.id for o in before.operations if o.id in copies or (o.moved and o.id in there)}
    left = list[str]()
    while True:
        ordered = _in_manual_order(operations, before, copies, applied)
        wrong = (id for pair in out_of_order(ordered) for id in pair if id in applied)
        first = next(wrong, None)
        if first is None:
            return ordered, left
        applied.remove(first)
        left.append(first)


def _in_manual_order(
    operations: Sequence[Operation], before: ProcessTree, copies: set[str], applied: set[str]
) -> list[Operation]:
    """Return the operations with those `applied` behind what they were behind, and all other copies behind their originals and what
    they need.

    Taken in the order they had, each one finds what was right before it already in its place, so that what can be all as it was is.
    """
    ordered, now = list(operations), {o.id: o for o in operations}
    for n, old in enumerate(before.operations):
        if old.id in applied:
            taken = replace(now.get(old.id, old), moved=old.moved)
            earlier = before.operations[:n]
        elif old.id in copies:
            taken = replace(old, moved=False)
            earlier = tuple(
                o for o in ordered if old.copy_of in (o.id, o.copy_of) or o.id in old.after
            )
        else:
            continue
        ordered = [o for o in ordered if o.id != old.id]
        ordered.insert(_index_behind(ordered, earlier), taken)
    return ordered


def _index_behind(operations: Sequence[Operation], earlier: Sequence[Operation]) -> int:
    """Return the index behind the last of some earlier operations that is still there, 0 where none is."""
    row = {o.id: n for n, o in enumerate(operations)}
    return next((row[o.id] + 1 for o in reversed(earlier) if o.id in row), 0)


def _without_lost_needs(
    operations: Sequence[Operation], coming: Iterable[str] = ()
) -> tuple[Operation, ...]:
    """Return operations that need only what is there, or is still `coming`."""
    there = {o.id for o in operations}.union(coming)
    return tuple(
        o
        if there.issuperset(o.after)
        else replace(o, after=tuple(id for id in o.after if id in there))
        for o in operations
    )


def _lost(before: ProcessTree, kept: set[str]) -> Iterable[Finding]:
    names = [o.id for o in before.operations if (o.by_hand or o.moved) and o.id not in kept]
    if names:
        yield warning(
            "route.by-hand-lost",
            f"{_count(names)} changed, copied or moved by hand and the new route has nothing in "
            f"{'its' if len(names) == 1 else 'their'} place",
            *names,
            remedy="change what cuts there now, or undo the change that led to the new route",
        )


def _not_moved(names: Sequence[str]) -> Iterable[Finding]:
    if names:
        yield warning(
            "route.order-by-hand",
            f"{_count(names)} moved by hand to a place before what the new route needs first: the plan's own order stands",
            *names,
            remedy="move it again where the process tree lets it go",
        )


def _count(names: Sequence[str]) -> str:
    return "1 operation was" if len(names) == 1 else f"{len(names)} operations were"
