"""An operation copied by a person: the same work once more, on its own feature or on another one of its kind."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace

from trunnion.findings import BadInput, Refused
from trunnion.model.feature import Feature, Recognition
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.plan.settings import KEPT_KEYS
from trunnion.plan.setups.frames import UPRIGHT

_SUFFIX = re.compile(r"-copy(-\d+)?$")


def with_copy(process: ProcessTree, id: str) -> tuple[ProcessTree, str]:
    """Return a process with a copy of an operation right behind it, and the copy's id.

    A copy needs what its original needs, not the original itself: it may be moved before that.
    """
    original = process.operation(id)
    made = _copy(original, _free_id(original.id, process))
    return _inserted(process, made, process.operations.index(original) + 1), made.id


def with_copy_on(
    process: ProcessTree, id: str, feature: str, found: Recognition
) -> tuple[ProcessTree, str]:
    """Return a process with a copy of an operation on another feature of the same kind, and the copy's id.

    It finishes the faces that have the same roles there, comes from where that feature is reached, and stands behind what it needs and
    what is like it. Raises `BadInput` for a feature that there is not or that it can't go to, and `Refused` where nothing says from which
    side the feature is reached.
    """
    original = process.operation(id)
    target = _target(original, feature, found)
    there = [o for o in process.operations if feature in o.all_features]
    alike = next((o for o in there if o.kind == original.kind), there[0] if there else original)
    if alike is original and original.direction != UPRIGHT:
        raise Refused(
            f"{feature}: no operation says from which side it is reached; copy one that is on it already"
        )
    roles = {f.role for f in found.feature(original.feature).faces if f.face in original.faces}
    made = replace(
        _copy(original, _free_id(original.id.replace(original.feature, feature), process)),
        feature=feature,
        others=(),
        faces=target.with_role(*roles),
        setup=alike.setup,
        direction=alike.direction,
        after=tuple(_needs_on(feature, original, process)),
        # What the other feature keeps is no matter of this one.
        choices={k: v for k, v in original.choices.items() if not k.startswith(KEPT_KEYS)},
    )
    row = {o.id: n for n, o in enumerate(process.operations)}
    return _inserted(process, made, max(row[o] for o in (*made.after, alike.id)) + 1), made.id


def copy_targets(operation: Operation, found: Recognition) -> tuple[str, ...]:
    """Return the features, by id, that an operation can be copied to: all others of its feature's kind."""
    kinds = {f.id: f.kind for f in found.features}
    kind = kinds.get(operation.feature)
    return tuple(
        id for id, other in kinds.items() if other == kind and id not in operation.all_features
    )


def _target(original: Operation, feature: str, found: Recognition) -> Feature:
    if feature not in {f.id for f in found.features}:
        raise BadInput(
            f"there is no feature {feature}; known: {', '.join(f.id for f in found.features)}"
        )
    fits = copy_targets(original, found)
    if feature not in fits:
        raise BadInput(
            f"{original.id} can't be copied to {feature}, only to another feature of its kind: "
            f"{', '.join(fits) or 'there is none'}"
        )
    return found.feature(feature)


def _needs_on(feature: str, original: Operation, process: ProcessTree) -> Iterable[str]:
    """Return what a copy on another feature needs: for what is on the original's own feature, that which does the same there."""
    for id in original.after:
        needed = process.operation(id)
        if original.feature not in needed.all_features:
            yield id
            continue
        for o in process.operations:
            if (o.kind, o.group) == (needed.kind, needed.group) and feature in o.all_features:
                yield o.id


def _copy(original: Operation, name: str) -> Operation:
    first = original.copy_of or original.id
    return replace(original, id=name, copy_of=first, by_hand=True, moved=False, suppressed=False)


def _inserted(process: ProcessTree, made: Operation, at: int) -> ProcessTree:
    operations = (*process.operations[:at], made, *process.operations[at:])
    return replace(process, operations=operations)


def _free_id(original: str, process: ProcessTree) -> str:
    """Return the first id of a copy that is not taken; of a copy, as of what that is copied from."""
    taken = {o.id for o in process.operations}.union(process.removed)
    first = _SUFFIX.sub("", original)
    name, number = f"{first}-copy", 1
    while name in taken:
        number += 1
        name = f"{first}-copy-{number}"
    return name
