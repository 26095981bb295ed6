"""The order of operations: what must come before is done before, tools change as seldom as that allows, paths between are short."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

CIRCLE = "operations wait for each other in a circle or for one that is not planned"


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
    places = {j.id: n for n, j in enumerate(jobs)}
    if any(not j.after <= places.keys() for j in jobs):
        raise ValueError(CIRCLE)
    tools = sorted(
        {j.tool for j in jobs}, key=lambda t: (min(j.stage for j in jobs if j.tool == t), t)
    )
    # Sets of jobs as bits of a number: many thousands of them are looked at.
    waits = [sum(1 << places[i] for i in j.after) for j in jobs]
    of_tool = {t: [n for n, j in enumerate(jobs) if j.tool == t] for t in tools}
    everything = (1 << len(jobs)) - 1
    layer: dict[int, tuple[str, ...]] = {0: ()}
    seen = {0}
    while layer:
        if everything in layer:
            return _walked(jobs, waits, of_tool, layer[everything])
        following: dict[int, tuple[str, ...]] = {}
        for done, sequence in layer.items():
            for tool in tools:
                more = _with_all_ready(of_tool[tool], waits, done)
                if more not in seen:
                    seen.add(more)
                    following[more] = (*sequence, tool)
        layer = following
    raise ValueError(CIRCLE)


def _with_all_ready(rows: Sequence[int], waits: Sequence[int], done: int) -> int:
    """Return the jobs `done` (bits) with those of `rows` that can be done after them, among them those that only wait for each other."""
    waiting = [n for n in rows if not done >> n & 1]
    while True:
        ready = [n for n in waiting if waits[n] & ~done == 0]
        if not ready:
            return done
        done |= sum(1 << n for n in ready)
        waiting = [n for n in waiting if not done >> n & 1]


def _walked(
    jobs: Sequence[OrderedOperation],
    waits: Sequence[int],
    of_tool: Mapping[str, Sequence[int]],
    tools: Sequence[str],
) -> tuple[str, ...]:
    """Return the jobs tool by tool, within a tool by stage, within a stage always the nearest next."""
    order: list[str] = []
    at, done = (0.0, 0.0), 0
    for tool in tools:
        remaining = _with_all_ready(of_tool[tool], waits, done) & ~done
        while remaining:
            ready = [n for n in of_tool[tool] if remaining >> n & 1 and waits[n] & ~done == 0]
            here = at
            n = min(
                ready,
                key=lambda n: (
                    jobs[n].stage,
                    (jobs[n].position[0] - here[0]) ** 2 + (jobs[n].position[1] - here[1]) ** 2,
                    jobs[n].id,
                ),
            )
            order.append(jobs[n].id)
            at, done, remaining = jobs[n].position, done | 1 << n, remaining & ~(1 << n)
    return tuple(order)
