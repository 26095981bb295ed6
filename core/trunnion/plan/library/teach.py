"""What a finished process teaches: its stages in the order of work, its cutters, and what a person changed.

What cannot be carried over to another part (copies, and one operation among several of its kind that was changed, deleted or moved) is
named in notes, never dropped in silence.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from trunnion.findings import Finding, remark
from trunnion.model.feature import Recognition
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.plan.manual.operation_change import BY_HAND, FEED_RULE, SPINDLE_RULE
from trunnion.settings import Value
from trunnion.shop import Stage, TypicalPlan
from trunnion.shop.library import PartSignature, TaughtOperation, TaughtPlan

Key = tuple[str, str, str]
"""Stage, kind of feature, and the cutter that the planner takes."""
Taught = tuple[str, tuple[tuple[str, Value], ...], float, float]
"""Tool, choices by key, spindle speed (1/min) and feed (mm/min) set by hand or 0."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TaughtResult:
    """A taught plan, and what of its process it does not have."""

    plan: TaughtPlan
    findings: tuple[Finding, ...]


def taught_plan(
    process: ProcessTree,
    recognition: Recognition,
    base: TypicalPlan,
    signature: PartSignature,
    *,
    name: str,
    date: str,
    part: str,
    part_digest: str,
    settings: Mapping[str, Value],
) -> TaughtResult:
    """Return the plan that a process teaches; `base` is the typical or taught plan that it was made from.

    `settings` are those of the session that the plan keeps, by full key; `date` is taken as given.
    """
    kinds = kinds_of(recognition)
    active = [o for o in process.operations if not o.suppressed and not o.copy_of]
    groups: dict[Key, list[Operation]] = defaultdict(list)
    for o in active:
        groups[o.group, kinds.get(o.feature, ""), o.planned_tool or o.tool.name].append(o)
    operations = tuple(
        _taught(key, groups[key]) for key in sorted(groups, key=lambda k: _rank(k, base))
    )
    notes = [
        *_exceptions(groups, operations),
        *_single_suppressions(process, kinds),
        *_copies(process),
    ]
    return TaughtResult(
        plan=TaughtPlan(
            name=name,
            date=date,
            part=part,
            part_digest=part_digest,
            base=base.name,
            signature=signature,
            stages=taught_stages(process, kinds, base),
            operations=operations,
            settings=dict(sorted(settings.items())),
        ),
        findings=tuple(notes),
    )


def kinds_of(recognition: Recognition) -> dict[str, str]:
    """Return the kind of each feature by its id."""
    return {f.id: f.kind for f in recognition}


def _rank(key: Key, base: TypicalPlan) -> tuple[int, str, str]:
    order = [s.name for s in base.stages]
    return (order.index(key[0]) if key[0] in order else len(order), *key[1:])


def _taught(key: Key, operations: Sequence[Operation]) -> TaughtOperation:
    """Return what most of the operations have; among equally many, what a person changed."""
    counted = Counter(map(_of_operation, operations))
    plain = (key[2], (), 0.0, 0.0)
    tool, choices, spindle, feed = min(
        counted, key=lambda taught: (-counted[taught], taught == plain, repr(taught))
    )
    return TaughtOperation(
        stage=key[0],
        kind=key[1],
        planned=key[2],
        tool=tool,
        choices=dict(choices),
        spindle=spindle,
        feed=feed,
        count=len(operations),
    )


def _of_operation(o: Operation) -> Taught:
    own = tuple((key, o.choices[key]) for key in sorted(o.own_choices) if key in o.choices)
    return (
        o.tool.name,
        own,
        o.data.spindle if _is_given(o, SPINDLE_RULE) else 0.0,
        o.data.feed if _is_given(o, FEED_RULE) else 0.0,
    )


def _is_given(o: Operation, beginning: str) -> bool:
    """Return whether a person set what the rule that begins so gives."""
    return any(r.startswith(beginning) and r.endswith(BY_HAND) for r in o.data.rules)


def taught_stages(
    process: ProcessTree, kinds: Mapping[str, str], base: TypicalPlan
) -> tuple[Stage, ...]:
    """Return the stages of a plan as its process follows them: in the order that a person gave them, without kinds of features on which a
    person suppressed or deleted all that a stage does, and without stages that have none then.

    Stages that had nothing to do on the part stay.
    """
    kept = [
        replace(stage, on=on) for stage in base.stages if (on := _kinds_on(stage, process, kinds))
    ]
    found: list[Stage] = []
    for stage in _in_taught_order(kept, process):
        before = {s.name for s in found}
        found.append(
            replace(
                stage,
                after=tuple(n for n in stage.after if n in before),
                after_all=tuple(n for n in stage.after_all if n in before),
            )
        )
    return tuple(found)


def _kinds_on(stage: Stage, process: ProcessTree, kinds: Mapping[str, str]) -> tuple[str, ...]:
    mine = [o for o in process.operations if o.group == stage.name]
    cut = {kinds.get(o.feature, "") for o in mine if not o.suppressed}
    idle = {kinds.get(o.feature, "") for o in mine if o.suppressed}
    idle |= _deleted_kinds(stage, process.removed, kinds)
    # What acts on no feature (the blank) has no kind to be taken from `on`.
    if "" in idle and not cut:
        return ()
    return tuple(k for k in stage.on if k in cut or k not in idle)


def _deleted_kinds(stage: Stage, removed: Iterable[str], kinds: Mapping[str, str]) -> set[str]:
    """Return the kinds of features whose operations of a stage were deleted; empty words for operations on no feature.

    Ids of operations begin with their stage's name or kind, and name their feature.
    """
    beginnings = tuple(
        f"{form}-" for word in (stage.name, stage.kind) for form in (word, _dashed(word))
    )
    found = set()
    for id in removed:
        if id.startswith(beginnings):
            named = [kind for feature, kind in kinds.items() if feature in id]
            found.update(named or [""])
    return found


def _dashed(word: str) -> str:
    return word.replace(" ", "-").replace("_", "-")


def _in_taught_order(stages: Sequence[Stage], process: ProcessTree) -> list[Stage]:
    """Return stages in their order, but where a person moved all that one does before all that another does."""
    earlier = {
        (a.name, b.name)
        for n, b in enumerate(stages)
        for a in stages[n + 1 :]
        if _is_moved_before(a.name, b.name, process)
    }
    remaining, found = list(stages), []
    while remaining:
        names = {s.name for s in remaining}
        free = next(
            (s for s in remaining if not any((n, s.name) in earlier for n in names)), remaining[0]
        )
        found.append(free)
        remaining.remove(free)
    return found


def _is_moved_before(first: str, second: str, process: ProcessTree) -> bool:
    """Return whether the operations of a stage come before all of another's in each setup that has both, some of them moved by a person."""
    moved = False
    for setup in process.setups:
        rows = {
            name: [
                n
                for n, o in enumerate(process.operations)
                if o.group == name and o.setup == setup.name and not o.suppressed
            ]
            for name in (first, second)
        }
        if not rows[first] or not rows[second]:
            continue
        if rows[first][-1] > rows[second][0]:
            return False
        both = rows[first] + rows[second]
        moved = moved or any(process.operations[n].is_manual for n in both)
    return moved


def _exceptions(
    groups: Mapping[Key, Sequence[Operation]], taught: Collection[TaughtOperation]
) -> list[Finding]:
    """Return a finding on operations that a person changed otherwise than most of their kind."""
    of = {(t.stage, t.kind, t.planned): t for t in taught}
    names = [
        o.id
        for key, operations in groups.items()
        for o in operations
        if _of_operation(o)
        != (
            of[key].tool,
            tuple(sorted(of[key].choices.items())),
            of[key].spindle,
            of[key].feed,
        )
    ]
    return [_not_taught("changed otherwise than most of their kind", names)] if names else []


def _single_suppressions(process: ProcessTree, kinds: Mapping[str, str]) -> list[Finding]:
    cut = {(o.group, kinds.get(o.feature, "")) for o in process.operations if not o.suppressed}
    names = [
        o.id
        for o in process.operations
        if o.suppressed and (o.group, kinds.get(o.feature, "")) in cut
    ]
    return [_not_taught("suppressed while others of their kind are cut", names)] if names else []


def _copies(process: ProcessTree) -> list[Finding]:
    names = [o.id for o in process.operations if o.copy_of]
    return [_not_taught("copied by hand", names)] if names else []


def _not_taught(why: str, names: Sequence[str]) -> Finding:
    return remark(
        "library.not-taught",
        f"{len(names)} {'operation is' if len(names) == 1 else 'operations are'} {why}: a plan for other parts can't have that",
        *names,
        remedy="change the same in the process of the next part",
    )
