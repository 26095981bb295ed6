"""An operation copied by a person: the same work once more right behind it, to be given a tool, data, settings or a place of its own."""

from __future__ import annotations

from dataclasses import replace

from trunnion.model.process import ProcessTree


def with_copy(process: ProcessTree, id: str) -> tuple[ProcessTree, str]:
    """Return a process with a copy of an operation behind it, and the copy's id.

    A copy needs what its original needs, not the original itself: it may be moved before that.
    """
    original = process.operation(id)
    first = original.copy_of or original.id
    name = _free_id(first, {o.id for o in process.operations} | set(process.removed))
    made = replace(original, id=name, copy_of=first, by_hand=True, suppressed=False)
    at = process.operations.index(original) + 1
    operations = (*process.operations[:at], made, *process.operations[at:])
    return replace(process, operations=operations), name


def _free_id(first: str, taken: set[str]) -> str:
    """Return the first id of a copy that is not taken.

    >>> _free_id("rough-pocket-01", {"rough-pocket-01-copy"})
    'rough-pocket-01-copy-2'
    """
    name, number = f"{first}-copy", 1
    while name in taken:
        number += 1
        name = f"{first}-copy-{number}"
    return name
