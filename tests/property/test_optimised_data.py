"""Optimised cutting data keep every limit on random operations, in steady cutting and at the largest engagement, and never lose time for
nothing."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from cutting_problems import SHOP, random_operation
from trunnion import tolerance
from trunnion.plan.cutting.milling import CuttingSettings
from trunnion.plan.cutting.optimization.problem import weighted
from trunnion.plan.cutting.optimize import balance, choices_of
from trunnion.plan.cutting.peak import is_overload, overloads
from trunnion.settings import choose

SLACK = 1.0 + 10.0 * tolerance.PARAMETRIC


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 10_000))
def test_no_limit_is_passed(seed):
    operation, process = random_operation(seed)
    made = choices_of(process, SHOP, {})[0]
    if made.optimum is None:
        return
    data, problem = made.optimised.data, made.problem
    machine = SHOP.machine(process.setups[0].machine)
    assert (problem.shares(made.optimum.spindle, made.optimum.feed) <= SLACK).all()
    assert machine.spindle_low / SLACK <= data.spindle <= machine.spindle_high * SLACK
    assert data.feed <= machine.feed_max * SLACK
    assert data.depth <= operation.data.depth * SLACK
    assert not is_overload(data) or made.optimised is made.handbook


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10_000))
def test_tables_that_keep_the_limits_are_never_better(seed):
    made = choices_of(random_operation(seed)[1], SHOP, {})[0]
    problem, best = made.problem, made.optimum
    if best is None or not problem.is_feasible(*problem.handbook).all():
        return
    tables = weighted(
        problem.time(*problem.handbook),
        problem.cost(*problem.handbook),
        best.least_time,
        best.least_cost,
        0.5,
    )
    assert best.objective <= float(tables) + tolerance.PARAMETRIC
    assert best.least_time <= float(problem.time(*problem.handbook)) * SLACK


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 10_000), st.sampled_from([0.2, 0.5]))
def test_a_persons_limits_bind(seed, power_share):
    process = random_operation(seed)[1]
    choices = {
        "optimize.data": "optimised",
        "cutting.power_share": power_share,
        "cutting.spindle_limit": 3000.0,
        "cutting.feed_limit": 900.0,
    }
    (operation,) = balance(process, SHOP, choose(CuttingSettings, choices), choices).operations
    data = operation.data
    assert data.spindle <= 3000.0 * SLACK and data.feed <= 900.0 * SLACK
    machine = SHOP.machine(process.setups[0].machine)
    assert np.isclose(data.power_limit, power_share * machine.power_at(data.spindle))
    assert data.highest_power <= data.power_limit * SLACK or overloads([operation])


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 10_000))
def test_balancing_again_changes_nothing(seed):
    choices = {"optimize.data": "optimised"}
    once = balance(random_operation(seed)[1], SHOP, choose(CuttingSettings, {}), choices)
    assert balance(once, SHOP, choose(CuttingSettings, {}), choices) == once
