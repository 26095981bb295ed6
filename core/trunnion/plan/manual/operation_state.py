"""An operation taken out of the program and put back by a person, and settings of its strategy that it alone has."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from trunnion.findings import BadInput
from trunnion.model.process import ProcessTree
from trunnion.settings import Value, checked, choose, declared


def with_suppressed(process: ProcessTree, id: str, suppressed: bool) -> ProcessTree:
    """Return a process that keeps an operation in its tree without cutting, or takes it up again."""
    now = process.operation(id)
    if now.suppressed == suppressed:
        return process
    return process.with_operation(replace(now, suppressed=suppressed, by_hand=True))


def with_own_choices(
    process: ProcessTree, id: str, words: Mapping[str, Value], settings: type
) -> ProcessTree:
    """Return a process with values of its strategy's `settings` for one operation, by full key or by name.

    Raises `BadInput` for a setting that the strategy has not, and for a value that can't be.
    """
    now = process.operation(id)
    known = {name: d for d in declared(settings) for name in (d.key, d.name)}
    for word in words:
        if word not in known:
            raise BadInput(
                f"{id}: {now.strategy} has no setting {word}; it has {', '.join(d.key for d in declared(settings))}"
            )
    values = {known[word].key: known[word].parse(value) for word, value in words.items()}
    checked(choose(settings, {**now.choices, **values}))
    return with_own_values(process, id, values)


def with_own_values(process: ProcessTree, id: str, values: Mapping[str, Value]) -> ProcessTree:
    """Return a process with values of settings, by full key, for one operation; they were checked before."""
    now = process.operation(id)
    own = tuple(dict.fromkeys((*now.own_choices, *values)))
    changed = replace(now, choices={**now.choices, **values}, own_choices=own, by_hand=True)
    return process if changed == now else process.with_operation(changed)
