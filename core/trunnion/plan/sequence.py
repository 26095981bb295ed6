"""The order of operations: what must come before is done before, tools change as seldom as that allows, paths between are short."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
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


class Precedence:
    """What comes before each of `count` jobs: `direct[n]` are the jobs that were said to come before n."""

    def __init__(self, count: int) -> None:
        self.direct: list[set[int]] = [set() for _ in range(count)]
        # All jobs before each one, over others too, as bits of a number.
        self._all = [0] * count

    def add(self, job: int, before: int) -> None:
        """Say that a job waits for another one."""
        self.direct[job].add(before)
        more = self._all[before] | 1 << before
        for n in range(len(self._all)):
            if n == job or self._all[n] >> job & 1:
                self._all[n] |= more

    def prefer(self, job: int, before: int) -> None:
        """Say that a job waits for another one, unless that one waits for it, over others too."""
        if job != before and not self._all[before] >> job & 1:
            self.add(job, before)


def ordered(jobs: Sequence[OrderedOperation]) -> tuple[str, ...]:
    """Return the ids in an order that keeps every `after` with the fewest tool changes; the same jobs give the same order.

    With one tool everything that is ready is done before the next tool comes: putting it off never saves a change. So the search goes
    over sequences of tools only; of those with the fewest changes it takes the first one, tools ranked by their first stage. Raises
    `ValueError` when jobs wait for each other in a circle or for one that isn't there.
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
    search = _ToolSearch(waits, [of_tool[t] for t in tools])
    done, sequence = 0, []
    count = search.fewest(done)
    while count:
        number, done = next(
            (n, more) for n, more in search.steps(done) if search.fewest(more) == count - 1
        )
        sequence.append(tools[number])
        count -= 1
    return _walked(jobs, waits, of_tool, sequence)


class _ToolSearch:
    """How many tools have to come one after the other for all jobs that a set of them (bits) leaves; `waits` are the jobs (bits) that each
    one waits for, `rows` those of each tool."""

    def __init__(self, waits: Sequence[int], rows: Sequence[Sequence[int]]) -> None:
        self._waits, self._rows = waits, rows
        self._own = [sum(1 << n for n in own) for own in rows]
        self._everything = (1 << len(waits)) - 1
        self._fewest: dict[int, int] = {self._everything: 0}

    def steps(self, done: int) -> list[tuple[int, int]]:
        """Return the tools, by number, that have something to do now, with the jobs that are done after each."""
        found = (
            (number, _with_all_ready(own, self._waits, done))
            for number, own in enumerate(self._rows)
            if self._own[number] & ~done
        )
        return [(number, more) for number, more in found if more != done]

    def fewest(self, done: int) -> int:
        """Return how many tools come after a set of jobs that is done; raise `ValueError` where some are never ready.

        Breadth first, by two rules that lose no shortest sequence. A tool that can do all of its jobs comes at once: it has to come some
        time, and the sooner the more the others find ready. And a set of jobs that another one as many tools on holds is not looked at.
        """
        if done not in self._fewest:
            layer, count = {done}, 0
            while self._everything not in layer:
                following: set[int] = set()
                for here in layer:
                    steps = self.steps(here)
                    whole = [more for number, more in steps if not self._own[number] & ~more]
                    following.update(whole[:1] or [more for _, more in steps])
                if not following:
                    raise ValueError(CIRCLE)
                layer, count = _largest(following), count + 1
            self._fewest[done] = count
        return self._fewest[done]


def _largest(sets: Collection[int]) -> set[int]:
    """Return the sets (bits) that no other one holds."""
    found: list[int] = []
    for one in sorted(sets, key=lambda s: (-s.bit_count(), s)):
        if not any(one & ~other == 0 for other in found):
            found.append(one)
    return set(found)


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
