"""The least time of operations: rates that no choice of data passes, and times that no proof undercuts."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from pytest import approx

from cutting_problems import SHOP, random_operation
from trunnion.geometry.spanning_tree import least_tree
from trunnion.model.verdict import OperationProof, Outcome
from trunnion.plan.cutting.milling import ROUGHING, cutting_data
from trunnion.plan.cutting.optimization.operation import OptimizationSettings
from trunnion.plan.cutting.optimize import choices_of
from trunnion.plan.cutting.time_bound import HighestRates, RateSearch, least_seconds

SETTINGS = OptimizationSettings.of({})


def proof_of(operation, **measured) -> OperationProof:
    figures = {"time_s": 1000.0, "cutting_s": 800.0, "removed": 60_000.0, "served": 0.0}
    return OperationProof(
        operation=operation.id,
        setup=operation.setup,
        outcome=Outcome.PASSED,
        gouge=0.0,
        collisions=0,
        rapids_in_stock=0,
        air_share=0.0,
        **{**figures, **measured},
    )


@pytest.mark.parametrize("seed", range(12))
def test_no_data_remove_more_than_the_highest_rate(seed):
    operation, process = random_operation(seed)
    material, machine = SHOP.material(process.material), SHOP.machine(process.setups[0].machine)
    made = choices_of(process, SHOP, {}, only=operation.id)[0]
    rates = RateSearch(material).rates(made.handbook, machine, SETTINGS)
    for data in (made.handbook.data, made.optimised.data):
        assert data.removal_rate <= rates.removal * (1.0 + 1e-3)


@pytest.mark.parametrize("name", sorted(SHOP.materials))
def test_every_mill_of_the_catalogue_has_highest_rates(name):
    material, machine = SHOP.material(name), SHOP.machine("Mill 1200")
    search = RateSearch(material)
    mills = [t for t in SHOP.tools if t.form in ("flat", "bull", "ball")]
    for tool in mills[::20]:
        data = cutting_data(
            tool,
            material,
            machine,
            "rough",
            SETTINGS.cutting,
            0.3 * tool.diameter,
            0.2 * tool.diameter,
        )
        operation = replace(random_operation(0)[0], kind="rough", tool=tool, data=data)
        rates = search.rates(operation, machine, SETTINGS)
        assert rates.removal >= data.removal_rate > 0.0, tool.name


def test_roughing_takes_its_volume_and_finishing_its_area_or_volume():
    seed = next(s for s in range(99) if random_operation(s)[0].kind in ROUGHING)
    rough = random_operation(seed)[0]
    finish = replace(rough, kind="floor")
    rates = HighestRates(removal=120.0, area=6000.0)
    # 60 cm3 at 120 cm3/min, 2000 mm2 at 6000 mm2/min, 9000 mm2 at 6000 mm2/min.
    assert least_seconds(rough, proof_of(rough, served=9000.0), rates) == approx(30.0)
    assert least_seconds(finish, proof_of(finish, served=2000.0), rates) == approx(30.0)
    assert least_seconds(finish, proof_of(finish, served=9000.0), rates) == approx(90.0)


def test_the_bound_is_never_above_the_time():
    rough = random_operation(0)[0]
    rates = HighestRates(removal=0.5, area=1.0)
    assert least_seconds(rough, proof_of(rough), rates) == 1000.0


def test_a_tool_without_models_goes_once_through_what_it_cuts():
    drill = replace(random_operation(0)[0], kind="drill")
    assert least_seconds(drill, proof_of(drill, cutting_s=12.0), None) == 12.0


def test_least_tree_is_the_minimum_and_below_every_tour():
    from scipy.sparse.csgraph import minimum_spanning_tree
    from scipy.spatial.distance import cdist

    assert least_tree(np.zeros((0, 3))) == least_tree(np.zeros((1, 3))) == 0.0
    # A unit square with its centre: four half diagonals.
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0.5]], float)
    assert least_tree(square) == approx(4.0 * np.sqrt(0.5))
    for seed in range(5):
        points = np.random.default_rng(seed).uniform(size=(40, 3))
        found = least_tree(points)
        assert found == approx(minimum_spanning_tree(cdist(points, points)).sum())
        assert found <= np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
