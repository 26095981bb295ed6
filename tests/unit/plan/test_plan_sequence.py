"""The order of operations."""

from __future__ import annotations

from itertools import pairwise

import pytest

from trunnion.plan import sequence
from trunnion.plan.sequence import OrderedOperation, ordered


def job(id: str, tool: str, stage: int = 0, after: str = "", x: float = 0.0) -> OrderedOperation:
    return OrderedOperation(
        id=id, tool=tool, stage=stage, position=(x, 0.0), after=frozenset(after.split())
    )


def changes(order: tuple[str, ...], jobs: list[OrderedOperation]) -> int:
    tools = [next(j.tool for j in jobs if j.id == id) for id in order]
    return sum(a != b for a, b in pairwise(tools))


def test_what_must_come_before_is_done_before():
    assert ordered([job("b", "T1", after="a"), job("a", "T2")]) == ("a", "b")


def test_one_tool_does_all_it_can_before_the_next_comes():
    jobs = [
        job("a", "T1"),
        job("b", "T2", 1, after="a"),
        job("c", "T1", 2),
        job("d", "T2", 3, after="c"),
    ]
    order = ordered(jobs)
    assert changes(order, jobs) == 1


def test_the_tool_that_saves_a_change_comes_first_even_in_a_later_stage():
    # T1 first: T1 T2 T1; T2 first: T2 T1.
    jobs = [job("a", "T1", 0), job("b", "T2", 1), job("c", "T1", 2, after="b")]
    assert ordered(jobs) == ("b", "a", "c")


def test_within_a_tool_the_nearest_comes_next():
    jobs = [job("far", "T1", x=50), job("near", "T1", x=10), job("middle", "T1", x=30)]
    assert ordered(jobs) == ("near", "middle", "far")


def test_jobs_that_wait_for_each_other_are_refused():
    with pytest.raises(ValueError, match="circle"):
        ordered([job("a", "T1", after="b"), job("b", "T1", after="a")])


def test_many_tools_that_are_ready_at_once_are_not_tried_in_every_order(monkeypatch):
    looks, whole = [], sequence._with_all_ready
    monkeypatch.setattr(sequence, "_with_all_ready", lambda *args: looks.append(1) or whole(*args))
    # Each of 14 pockets has a tool of its own, begun and ended by tools that all share: 2^14 sets of pockets may be done.
    first = [job(f"rough-{n}", "T1") for n in range(14)]
    own = [job(f"wall-{n}", f"W{n:02d}", 1, after=f"rough-{n}") for n in range(14)]
    last = [job(f"floor-{n}", "T2", 2, after=f"wall-{n}") for n in range(14)]
    assert changes(ordered([*first, *own, *last]), [*first, *own, *last]) == 15
    assert len(looks) < 5000
