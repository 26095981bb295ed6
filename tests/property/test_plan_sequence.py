"""Any set of operations whose waits run one way is ordered whole, and never against a wait."""

from __future__ import annotations

from itertools import pairwise, permutations

from hypothesis import given, settings
from hypothesis import strategies as st

from trunnion.plan.sequence import OrderedOperation, ordered


@st.composite
def job_lists(draw) -> list[OrderedOperation]:
    count = draw(st.integers(1, 6))
    waits = [draw(st.sets(st.integers(0, n - 1), max_size=2)) if n else set() for n in range(count)]
    return [
        OrderedOperation(
            id=f"op-{n}",
            tool=draw(st.sampled_from("ABC")),
            stage=draw(st.integers(0, 3)),
            position=(draw(st.floats(-9, 9)), 0.0),
            after=frozenset(f"op-{w}" for w in waits[n]),
        )
        for n in range(count)
    ]


def changes(order: tuple[str, ...], tools: dict[str, str]) -> int:
    return sum(tools[a] != tools[b] for a, b in pairwise(order))


def allowed(order: tuple[str, ...], jobs: list[OrderedOperation]) -> bool:
    return all(order.index(w) < order.index(j.id) for j in jobs for w in j.after)


@settings(deadline=None, max_examples=40)
@given(job_lists())
def test_an_order_keeps_every_wait_with_the_fewest_tool_changes(jobs):
    tools = {j.id: j.tool for j in jobs}
    order = ordered(jobs)
    best = min(changes(p, tools) for p in permutations(tools) if allowed(p, jobs))
    assert sorted(order) == sorted(tools) and allowed(order, jobs) and changes(order, tools) == best


@settings(deadline=None, max_examples=20)
@given(job_lists(), st.randoms(use_true_random=False))
def test_the_order_does_not_depend_on_how_the_jobs_were_given(jobs, random):
    mixed = list(jobs)
    random.shuffle(mixed)
    assert ordered(mixed) == ordered(jobs)
