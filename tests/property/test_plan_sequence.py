"""Any set of operations whose waits run one way is ordered whole, and never against a wait."""

from __future__ import annotations

from itertools import pairwise, permutations

from hypothesis import given, settings
from hypothesis import strategies as st

from trunnion.plan.sequence import OrderedOperation, Precedence, ordered


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


@given(
    pairs=st.lists(st.tuples(st.integers(0, 7), st.integers(0, 7), st.booleans()), max_size=40),
)
def test_preferences_never_make_jobs_wait_in_a_circle(pairs):
    after = Precedence(8)
    for job, before, needed in sorted(pairs, key=lambda p: not (p[2] and p[1] < p[0])):
        # What is needed is no circle: a job needs those with lower numbers alone.
        if needed and before < job:
            after.add(job, before)
        else:
            after.prefer(job, before)
    done: set[int] = set()
    while ready := [n for n in range(8) if n not in done and after.direct[n] <= done]:
        done.update(ready)
    assert len(done) == 8
    for job, before, _ in pairs:
        waits = after.direct[job]
        assert before in waits or before == job or _is_before(after, before, job)


def _is_before(after, job, other):
    """Return whether a job waits for another one, over others too."""
    return other in after.direct[job] or any(_is_before(after, n, other) for n in after.direct[job])
