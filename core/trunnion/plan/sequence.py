"""The order of operations: what must come before is done before, tools change as seldom as that allows, paths between are short."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class OrderedOperation:
    """What is ordered: an operation with its tool's name, its stage in the plan (0 first), its position and what comes before."""

    id: str
    tool: str
    stage: int
    position: tuple[float, float]
    after: frozenset[str]


def ordered(jobs: Sequence[OrderedOperation]) -> tuple[str, ...]:
    """Return the ids in an order that keeps every `after` with the fewest tool changes; the same jobs give the same order.

    With one tool everything that is ready is done before the next tool comes: putting it off never saves a change. So the search goes
    over sequences of tools only, breadth first, and the first that does everything has the fewest. Raises `ValueError` when jobs wait
    for each other in a circle or for one that isn't there.
    """
    by_id = {j.id: j for j in jobs}
    tools = sorted(
        {j.tool for j in jobs}, key=lambda t: (min(j.stage for j in jobs if j.tool == t), t)
    )
    layer: dict[frozenset[str], tuple[str, ...]] = {frozenset(): ()}
    seen: set[frozenset[str]] = {frozenset()}
    while layer:
        for done, sequence in layer.items():
            if len(done) == len(by_id):
                return _walked(by_id, sequence)
        following: dict[frozenset[str], tuple[str, ...]] = {}
        for done, sequence in layer.items():
            for tool in tools:
                more = done | _exhausted(by_id, tool, done)
                if more not in seen:
                    seen.add(more)
                    following[more] = (*sequence, tool)
        layer = following
    raise ValueError("operations wait for each other in a circle or for one that is not planned")


def _exhausted(
    jobs: Mapping[str, OrderedOperation], tool: str, done: frozenset[str]
) -> frozenset[str]:
    """Return the jobs of one tool that can be done after `done`, among them those that only wait for each other."""
    found: set[str] = set()
    waiting = [j for j in jobs.values() if j.tool == tool and j.id not in done]
    grew = True
    while grew:
        ready = [j for j in waiting if j.id not in found and j.after <= done | found]
        found.update(j.id for j in ready)
        grew = bool(ready)
    return frozenset(found)


def _walked(jobs: Mapping[str, OrderedOperation], tools: Sequence[str]) -> tuple[str, ...]:
    """Return the jobs tool by tool, within a tool by stage, within a stage always the nearest next."""
    order: list[str] = []
    at = (0.0, 0.0)
    for tool in tools:
        remaining = _exhausted(jobs, tool, frozenset(order))
        while remaining:
            ready = [jobs[i] for i in remaining if jobs[i].after <= set(order)]
            here = at
            job = min(
                ready,
                key=lambda j: (
                    j.stage,
                    (j.position[0] - here[0]) ** 2 + (j.position[1] - here[1]) ** 2,
                    j.id,
                ),
            )
            order.append(job.id)
            at, remaining = job.position, remaining - {job.id}
    return tuple(order)
