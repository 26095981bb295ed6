"""How far apart planes may lie: no farther than whatever lies between two of them allows."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from milling import mill
from trunnion.toolpath.contact_passes.stepover.spacing import (
    FacetSlopes,
    least_over,
    marched,
    tip_spacing,
)


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


@settings(deadline=None, max_examples=60)
@given(st.floats(1e-6, 4.0), st.sampled_from([0.002, 0.004, 0.05]))
def test_ridges_in_a_hollow_stay_low_however_nearly_it_is_as_round_as_the_cutter(
    wider: float, height: float
) -> None:
    radius = 3.0
    hollow = radius + wider
    turn = np.array([0.0, 1e-3])
    # The bottom of a hollow about y, as triangles: its normals look at the axis.
    ring = np.column_stack([hollow * np.sin(turn), np.zeros(2), -hollow * np.cos(turn)])
    normals = -ring / hollow
    corners = np.array([[ring[0], ring[1], ring[0] + [0.0, 1e-3, 0.0]]])
    facing = np.array([[normals[0], normals[1], normals[0]]])
    places = FacetSlopes(
        row=np.array([0]),
        normal=facing.mean(axis=1),
        area=np.ones(1),
        tips=corners + radius * facing,
        edges=corners[:, 1:] - corners[:, :1],
        turns=facing[:, 1:] - facing[:, :1],
    )
    step = float(
        tip_spacing(places, mill(2.0 * radius, radius), height, np.array([1.0, 0.0, 0.0]))[0]
    )
    # Centres of the cutter go round the axis of the hollow, `wider` from it.
    half = min(0.5 * step / wider, 0.5 * np.pi)
    middle = wider * np.cos(half) + np.sqrt(radius**2 - (wider * np.sin(half)) ** 2)
    assert hollow - middle <= 1.1 * height
