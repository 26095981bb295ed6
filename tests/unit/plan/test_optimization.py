"""The optimiser's models: worked-out numbers, the paper's example, and both searches held against a refined grid."""

from __future__ import annotations

import math
import subprocess
import sys
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from pytest import approx

from cutting_problems import SHOP, grid_best, random_operation
from trunnion.findings import BadInput
from trunnion.model.operation import Engagement
from trunnion.plan.cutting.optimization import limits
from trunnion.plan.cutting.optimization.exact import solve_exactly
from trunnion.plan.cutting.optimization.example import (
    SPEED_UNITS,
    example_cuts,
    example_file,
    read_cuts,
)
from trunnion.plan.cutting.optimization.genetic import pareto_front, solve_genetically
from trunnion.plan.cutting.optimization.operation import OptimizationSettings
from trunnion.plan.cutting.optimization.problem import CuttingProblem, Economics, weighted
from trunnion.plan.cutting.optimization.settings import GeneticSettings
from trunnion.plan.cutting.optimize import choices_of
from trunnion.plan.cutting.power import cutting_power
from trunnion.plan.cutting.time_bound import RateSearch

PAPER = example_cuts()[0]
ALUMINIUM, TITANIUM = SHOP.material("EN AW-7075"), SHOP.material("Ti-6Al-4V")
MACHINE = SHOP.machine("Mill 1200")
D20 = next(t for t in SHOP.tools if t.name == "AL3-regular D20 R0")
CLOSE, CLOSE_OBJECTIVE = 1.005, 0.002
"""Time and cost over the grid's, and the objective above it: what is asked of the searches."""
SEEDS = range(20)


def test_the_papers_points_come_to_what_its_equations_give():
    problem = PAPER.problem()
    n, fz = np.array([[p.spindle, p.feed] for p in PAPER.printed]).T
    # tm = 640 / (0.2 * 4 * 300) = 2.667; t = 1.25 + 2.667 + 0.55 * 2.667 / 180.
    assert problem.time(n, fz) == approx([3.925, 3.647, 3.600], abs=6e-4)
    # C = 20 t + 150 tm / 180 + 25 fz^0.8 n^0.3.
    assert problem.cost(n, fz) == approx([118.9, 111.2, 110.2], abs=0.06)


@pytest.mark.parametrize(
    ("unit", "forces"), [("mm/s", (5.5, 4.6, 4.5)), ("m/s", (22.0, 18.3, 18.0))]
)
def test_the_papers_force_by_the_reading_of_its_speed(unit, forces):
    law = PAPER.reading(unit).force
    n, fz = np.array([[p.spindle, p.feed] for p in PAPER.printed]).T
    assert law.force(n) * fz**0.75 / 1000.0 == approx(forces, abs=0.06)


def test_the_papers_power_is_short_of_force_times_speed_by_60_to_the_exponent():
    law, n = PAPER.force, np.array([300.0])
    speed = math.pi * 125.0 * n / 60.0 / 1000.0
    assert law.force(n) * speed / 1000.0 / law.power(n) == approx(60.0**0.2)


def test_the_papers_optimum_is_at_its_fastest_spindle():
    found = solve_exactly(PAPER.problem(), 0.5)
    assert (found.spindle, found.feed) == (approx(1800.0), approx(0.037, abs=5e-4))


@pytest.mark.parametrize("unit", SPEED_UNITS)
def test_the_exact_search_is_at_the_grids_best_on_the_papers_example(unit):
    assert_close(PAPER.reading(unit).problem(), solve_exactly(PAPER.reading(unit).problem(), 0.5))


def choice(seed):
    process = random_operation(seed)[1]
    return choices_of(process, SHOP, {})[0]


def grid_of(problem: CuttingProblem):
    """Return the least time and cost of a refined grid, and the best point by the weighted objective: value, spindle, feed per tooth."""
    time, cost = grid_best(problem, problem.time)[0], grid_best(problem, problem.cost)[0]
    return time, cost, grid_best(problem, lambda n, fz: value(problem, n, fz, time, cost))


def value(problem, n, fz, time, cost):
    return weighted(problem.time(n, fz), problem.cost(n, fz), time, cost, 0.5)


def assert_close(problem: CuttingProblem, found, grid=None) -> None:
    """Hold an optimum against a refined grid: each alone, and the weighted objective."""
    time, cost, (best, n, fz) = grid or grid_of(problem)
    assert found.least_time <= CLOSE * time and found.least_cost <= CLOSE * cost
    assert float(value(problem, found.spindle, found.feed, time, cost)) <= best + CLOSE_OBJECTIVE
    assert found.time <= CLOSE * float(problem.time(n, fz))
    assert found.cost <= CLOSE * float(problem.cost(n, fz))


@cache
def worn():
    """Return the choice of an operation whose optimum lies between least time and least cost, as its tool's life has it."""
    for seed in range(200):
        made = choice(seed)
        if made.optimum is not None and made.optimum.objective > 0.02:
            return made
    raise AssertionError("no operation is bound by wear")


@cache
def grids(name):
    """Return a problem and its refined grid, worked out once for all seeds."""
    problem = worn().problem if name == "worn" else PAPER.reading(name).problem()
    return problem, grid_of(problem)


def feasible(count):
    """Return the choices of random operations whose limits can be kept."""
    found, seed = [], 0
    while len(found) < count:
        made = choice(seed)
        if made.optimum is not None:
            found.append(made)
        seed += 1
    return found


def test_the_exact_search_is_at_the_grids_best_for_twenty_operations():
    for made in feasible(20):
        assert_close(made.problem, made.optimum)


@pytest.mark.parametrize("name", ["worn", *SPEED_UNITS])
@pytest.mark.parametrize("seed", SEEDS)
def test_the_genetic_algorithm_is_near_the_grids_best_whatever_its_seed(name, seed):
    problem, grid = grids(name)
    found = solve_genetically(problem, 0.5, GeneticSettings(seed=seed)).optimum
    assert problem.is_feasible(found.spindle, found.feed).all()
    assert_close(problem, found, grid)


def test_the_same_seed_gives_the_same_result():
    problem, settings = PAPER.problem(), GeneticSettings(population=12, generations=5, seed=7)
    first, second = (solve_genetically(problem, 0.5, settings) for _ in range(2))
    assert first == second
    other = solve_genetically(problem, 0.5, replace(settings, seed=8))
    assert other.convergence != first.convergence


def test_the_convergence_curve_never_rises():
    found = solve_genetically(PAPER.problem(), 0.5, GeneticSettings(generations=15))
    assert len(found.convergence) == 15
    assert all(a >= b for a, b in zip(found.convergence, found.convergence[1:]))


@pytest.mark.parametrize("kind", ["cost", "load"])
def test_no_point_of_the_front_is_better_in_both(kind):
    made = worn()
    front = pareto_front(made.problem, GeneticSettings(front=kind))
    assert len(front) > 1
    time, other = np.array([[p.time, getattr(p, kind)] for p in front]).T
    assert (np.diff(time) >= 0.0).all() and (np.diff(other) <= 1e-9).all()
    assert made.problem.is_feasible([p.spindle for p in front], [p.feed for p in front]).all()


def test_a_heavier_weight_of_time_is_quicker_and_dearer():
    problem = worn().problem
    found = [solve_exactly(problem, weight) for weight in (0.0, 0.5, 1.0)]
    assert [o.time for o in found] == sorted((o.time for o in found), reverse=True)
    assert [o.cost for o in found] == sorted(o.cost for o in found)
    assert found[0].cost == approx(found[0].least_cost)
    assert found[2].time == approx(found[2].least_time)


def test_the_least_cost_lies_at_taylors_speed():
    # Least of (c0 + ct / T0 (v / v0)^4) / v: (v / v0)^4 = c0 T0 / (3 ct), tool changes left out.
    problem = CuttingProblem(
        length=1000.0,
        teeth=4,
        spindle=(100.0, 5000.0),
        feed=(0.05, 0.1),
        life=lambda n: 60.0 * (1000.0 / n) ** 4,
        economics=Economics(rate=1.5, tool=40.0),
        constraints=(),
        handbook=(1000.0, 0.05),
    )
    found = solve_exactly(problem, 0.0)
    assert found.spindle == approx(1000.0 * (1.5 * 60.0 / 3.0 / 40.0) ** 0.25, rel=1e-5)
    assert found.feed == approx(0.1)


def test_nothing_is_chosen_where_even_the_smallest_feed_passes_a_limit():
    problem = replace(PAPER.problem(), feed=(5.0, 6.0))
    assert solve_exactly(problem, 0.5) is None
    assert solve_genetically(problem, 0.5, GeneticSettings(generations=3)) is None


def test_force_is_power_over_speed():
    met = Engagement(width=10.0, depth=5.0, share=1.0, at="")
    fz, n = 0.1, 2000.0
    power = cutting_power(ALUMINIUM, 20.0, fz, 5.0, 10.0, fz * D20.teeth * n)
    speed = math.pi * 20.0 * n / 60_000.0
    force = limits.mean_force(ALUMINIUM, D20, met) * fz**0.75
    assert force == approx(1000.0 * power / speed)


def test_a_plain_beam_bends_by_the_textbook():
    # F L^3 / (3 E I): a shank all along, the force at its tip.
    beam = replace(
        D20, flute_length=1e-6, neck_length=1e-6, neck_diameter=20.0, shank_diameter=20.0
    )
    inertia = math.pi * 20.0**4 / 64.0
    assert limits.compliance(beam, 0.0) == approx(
        beam.stickout**3 / (3.0 * 600_000.0 * inertia), rel=1e-6
    )


def test_a_tooth_is_in_contact_longer_for_its_helix():
    straight = replace(D20, helix_angle=0.0)
    met = Engagement(width=10.0, depth=5.0, share=1.0, at="")
    assert limits.contact_share(straight, met) == approx(3 * (math.pi / 2.0) / (2.0 * math.pi))
    assert limits.contact_share(D20, met) > limits.contact_share(straight, met)
    assert limits.contact_share(D20, replace(met, width=20.0, depth=38.0)) == 1.0


def test_feed_marks_have_rt_and_a_quarter_of_it_as_ra():
    # fz 0.2 at 1 mm: 1000 * 0.04 / 8 = 5 um of Rt, 1.25 um of Ra.
    fz, n = np.array([0.2]), np.array([1000.0])
    assert limits.rt_limit(1.0, 5.0).share(n, fz) == approx([1.0])
    assert limits.ra_limit(1.0, 1.25).share(n, fz) == approx([1.0])


def test_life_of_titanium_goes_with_speed_and_width_as_it_was_tried():
    life = TITANIUM.life
    assert 0.99 ** (-1.0 / life.exponent) == approx(1.04, abs=0.002)
    assert life.width_exponent == 1.0 and life.widths == (0.1, 0.7)


def test_the_bound_of_roughing_is_above_what_its_data_remove():
    seed = next(s for s in range(99) if random_operation(s)[0].kind == "rough")
    made, process = choice(seed), random_operation(seed)[1]
    material, machine = SHOP.material(process.material), SHOP.machine(process.setups[0].machine)
    bound = RateSearch(material).rates(made.handbook, machine, OptimizationSettings.of({})).removal
    assert bound >= made.optimised.data.removal_rate > 0.0


def test_the_ranges_are_the_materials_own():
    process = random_operation(0)[1]
    material, tool = SHOP.material("C45"), D20
    rough = replace(
        process.operations[0], tool=tool, kind="rough", strategy="plane.rough", faces=()
    )
    rough = replace(rough, data=replace(rough.data, width=10.0, depth=1.0))
    made = choices_of(replace(process, material="C45", operations=(rough,)), SHOP, {})[0]
    speed = np.array(made.problem.spindle) * math.pi * tool.diameter / 1000.0
    assert speed == approx(material.speed_range)
    # The table's feeds of D 20 from 0.10 to 0.17, for chips thinned by 20 / (2 sqrt(5 * 15)) at a quarter of the diameter.
    assert made.problem.feed == approx((0.1155, 0.1963), abs=5e-5)


def test_a_file_with_a_fault_is_refused_with_its_place(tmp_path):
    text = Path(example_file()).read_text(encoding="utf-8").replace("teeth = 4", "teeth = 0")
    (tmp_path / "cut.toml").write_text(text, encoding="utf-8")
    with pytest.raises(BadInput, match="cut.toml: paper: cut: teeth must be a whole number"):
        read_cuts(tmp_path / "cut.toml")


def test_pymoo_is_loaded_by_nothing_that_does_not_search_with_it():
    words = (
        "import sys, trunnion.pipeline, trunnion.plan.cutting.optimize, trunnion.cli.main;"
        "assert 'pymoo' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", words], check=True)
