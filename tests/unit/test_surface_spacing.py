"""How far apart planes may lie: no farther than whatever lies between two of them allows."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from trunnion.toolpath.surface.spacing import least_over, marched


@settings(deadline=None, max_examples=30)
@given(st.integers(0, 10_000))
def test_the_least_over_each_strip_is_that_of_all_that_lies_over_it(seed: int) -> None:
    rng = np.random.default_rng(seed)
    count = int(rng.integers(1, 40))
    first, last = np.sort(rng.integers(0, count, (2, 12)), axis=0)
    values = rng.uniform(0.1, 2.0, 12)
    plain = [values[(first <= k) & (k <= last)].min(initial=np.inf) for k in range(count)]
    assert least_over(first, last, values, count).tolist() == plain


def test_planes_are_nearer_to_each_other_where_something_between_demands_it() -> None:
    at = marched(np.array([0.0, 4.0]), np.array([10.0, 5.0]), np.array([1.0, 0.25]), 0.0, 10.0)
    step = np.diff(at)
    assert at[0] == 0.0 and at[-1] == 10.0 and step.max() <= 1.0 + 1e-9
    near = (at[1:] > 4.0) & (at[:-1] < 5.0)
    assert step[near].max() <= 0.25 + 1e-9 and (step[at[1:] < 3.9] > 0.99).all()
