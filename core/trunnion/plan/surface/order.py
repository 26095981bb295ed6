"""The order of operations on a part of curved surfaces: by stages, steep before shallow, hanging faces and large cutters first."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import product

from trunnion.model.operation import Operation
from trunnion.plan.freeform.keys import EARLIER, UPRIGHT_EARLIER
from trunnion.plan.sequence import OrderedOperation, Precedence, ordered
from trunnion.plan.surface.plan_state import SurfacePlanState
from trunnion.shop import Stage

FALLING = ("rough", "semi")
"""Kinds of operations that larger cutters come first in: what they leave is little for the smaller ones."""
FIRST = "-steep"
"""Ends the name of an operation on the steep positions of an area. It comes before the others there: from the top down it takes off what
would stand in the way of a neck or shank at a wall's foot."""


def in_order(state: SurfacePlanState, stages: Sequence[Stage]) -> list[Operation]:
    """Return the operations in the order of the plan's stages, with as few tool changes as that allows."""
    rank = {stage.name: n for n, stage in enumerate(stages)}
    by_stage = {stage.name: stage for stage in stages}
    row = {o.id: n for n, o in enumerate(state.operations)}
    after = Precedence(len(row))
    for o, other in product(state.operations, repeat=2):
        if _has_to_wait(o, other, by_stage[o.group]):
            after.add(row[o.id], row[other.id])
    for o, other in product(state.operations, repeat=2):
        if _had_better_wait(state, o, other):
            after.prefer(row[o.id], row[other.id])
    jobs, done = [], {}
    for n, o in enumerate(state.operations):
        before = sorted(state.operations[k].id for k in after.direct[n])
        done[o.id] = replace(o, after=tuple(before))
        jobs.append(
            OrderedOperation(
                id=o.id,
                tool=o.tool.name,
                stage=rank[o.group],
                position=_position(state, o.faces),
                after=frozenset(before),
            )
        )
    return [done[id] for id in ordered(jobs)]


def _has_to_wait(operation: Operation, other: Operation, stage: Stage) -> bool:
    """Return whether an operation of a stage can't be cut before another one."""
    return (
        other.group in stage.after_all
        or (
            other.group in stage.after
            and not set(other.faces or operation.faces).isdisjoint(operation.faces)
        )
        or other.id == operation.id + FIRST
        or _is_rest_of(operation, other)
    )


def _had_better_wait(state: SurfacePlanState, operation: Operation, other: Operation) -> bool:
    """Return whether an operation is cut easier after another one of its stage: after those on hidden faces; after larger cutters, where
    both lean or neither does."""
    if operation.group != other.group:
        return False
    over, is_over = _is_over(state, other), _is_over(state, operation)
    return (over and not is_over) or (
        over == is_over
        and operation.kind in FALLING
        and (UPRIGHT_EARLIER in operation.choices) == (UPRIGHT_EARLIER in other.choices)
        and other.cutter.diameter > operation.cutter.diameter
    )


def _is_rest_of(operation: Operation, other: Operation) -> bool:
    """Return whether an operation cuts what another one of its stage leaves: a smaller cutter after the larger one, a leaning one after
    the upright ones."""
    if operation.group != other.group or set(operation.faces).isdisjoint(other.faces):
        return False
    if UPRIGHT_EARLIER in operation.choices:
        return UPRIGHT_EARLIER not in other.choices
    return operation.choices.get(EARLIER) == other.cutter.name


def _is_over(state: SurfacePlanState, operation: Operation) -> bool:
    """Return whether an operation cuts hidden faces alone: what is left on them stands in the way of necks below, so they come first."""
    return bool(operation.faces) and state.hanging.issuperset(operation.faces)


def _position(state: SurfacePlanState, tags: tuple[int, ...]) -> tuple[float, float]:
    if not tags:
        return 0.0, 0.0
    at = state.space.frame.to_local(state.space.part.graph().centre[tags[0] - 1])
    return float(at[0]), float(at[1])
