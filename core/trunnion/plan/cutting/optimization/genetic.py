"""The genetic algorithm: pymoo's GA for the weighted objective, and NSGA-II for the front of time against cost or load.

pymoo (Blank and Deb, IEEE Access 8, 2020) is imported where it is used, so that nothing else waits for it. The genes of a point are the
logarithm of its spindle speed, and where its feed lies between the smallest and the largest that keeps the constraints there
(`CuttingProblem.feed_between`): optima lie on constraints, which breeding comes near to but does not meet when feeds are bred themselves.
Speeds at which no feed keeps them lose against any other by the library's rule for constraints. Same seed, same result.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.plan.cutting.optimization.problem import (
    CuttingProblem,
    Optimum,
    optimum_at,
    weighted,
)
from trunnion.plan.cutting.optimization.settings import LOAD, GeneticSettings
from trunnion.progress import NO_PROGRESS, Progress

DISTRIBUTION_INDEX = 15.0
"""Distribution index of crossover and mutation: pymoo's own for crossover."""
Values = Callable[[Floats, Floats], Floats]
"""From spindle speeds (n,) and feeds per tooth (n,) to objectives (n, k)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GeneticResult:
    """The optimum, and the best objective of each generation: the convergence curve."""

    optimum: Optimum
    convergence: tuple[float, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class FrontPoint:
    """A point of the Pareto front: none is better in both. `load` is the share of what the spindle may give."""

    spindle: float
    feed: float
    time: float
    cost: float
    load: float


def solve_genetically(
    problem: CuttingProblem,
    weight: float,
    settings: GeneticSettings,
    progress: Progress = NO_PROGRESS,
) -> GeneticResult | None:
    """Return the optimum of the weighted objective by the genetic algorithm; None where it finds no point that keeps the constraints."""
    quickest = _evolved(problem, lambda n, fz: problem.time(n, fz)[:, None], settings, progress)
    cheapest = _evolved(problem, lambda n, fz: problem.cost(n, fz)[:, None], settings, progress)
    if quickest is None or cheapest is None:
        return None
    least_time = float(problem.time(*quickest.best))
    least_cost = float(problem.cost(*cheapest.best))

    def value(spindle: Floats, feed: Floats) -> Floats:
        time, cost = problem.time(spindle, feed), problem.cost(spindle, feed)
        return weighted(time, cost, least_time, least_cost, weight)[:, None]

    found = _evolved(problem, value, settings, progress)
    if found is None:
        return None
    optimum = optimum_at(problem, *found.best, least_time, least_cost, weight)
    return GeneticResult(optimum=optimum, convergence=found.convergence)


def pareto_front(
    problem: CuttingProblem, settings: GeneticSettings, progress: Progress = NO_PROGRESS
) -> tuple[FrontPoint, ...]:
    """Return the front of time against cost or load (`settings.front`) by NSGA-II, the quickest point first; empty where nothing is
    feasible."""
    from pymoo.algorithms.moo.nsga2 import NSGA2

    rows = [k for k, c in enumerate(problem.constraints) if c.name == problem.load]

    def load(spindle: Floats, feed: Floats) -> Floats:
        shares = problem.shares(spindle, feed)
        return np.asarray(shares[rows].max(axis=0, initial=0.0))

    def values(spindle: Floats, feed: Floats) -> Floats:
        other = (load if settings.front == LOAD else problem.cost)(spindle, feed)
        return np.column_stack([problem.time(spindle, feed), other])

    points = _run(NSGA2, problem, values, 2, settings, progress, None)
    if points is None:
        return ()
    points = points[np.argsort(values(*points.T)[:, 0], kind="stable")]
    time, cost, loads = (f(*points.T) for f in (problem.time, problem.cost, load))
    return tuple(
        FrontPoint(spindle=float(n), feed=float(fz), time=float(t), cost=float(c), load=float(s))
        for (n, fz), t, c, s in zip(points, time, cost, loads, strict=True)
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class _Evolved:
    """The best point (spindle, feed per tooth) and the best value of each generation that had a feasible one."""

    best: tuple[float, float]
    convergence: tuple[float, ...]


def _evolved(
    problem: CuttingProblem, values: Values, settings: GeneticSettings, progress: Progress
) -> _Evolved | None:
    from pymoo.algorithms.soo.nonconvex.ga import GA

    best: list[float] = []
    points = _run(GA, problem, values, 1, settings, progress, best)
    if points is None:
        return None
    spindle, feed = points[0]
    return _Evolved(best=(float(spindle), float(feed)), convergence=tuple(best))


def _run(
    algorithm: Any,
    problem: CuttingProblem,
    values: Values,
    objectives: int,
    settings: GeneticSettings,
    progress: Progress,
    best: list[float] | None,
) -> Floats | None:
    """Return the points (k, 2) that an algorithm of pymoo ends with, None where none is feasible; `best` takes each generation's value."""
    from pymoo.core.problem import Problem
    from pymoo.operators.crossover.sbx import SBX
    from pymoo.operators.mutation.pm import PM
    from pymoo.optimize import minimize

    low, high = np.log(problem.spindle)

    def points_of(genes: Floats) -> Floats:
        speed, step = np.asarray(genes, float).T
        spindle = np.clip(np.exp(low + speed * (high - low)), *problem.spindle)
        return np.column_stack([spindle, problem.feed_between(spindle, step)])

    class GeneticProblem(Problem):
        def __init__(self) -> None:
            super().__init__(
                n_var=2,
                n_obj=objectives,
                n_ieq_constr=len(problem.constraints),
                xl=np.zeros(2),
                xu=np.ones(2),
            )

        def _evaluate(self, x: Floats, out: dict[str, Any], *args: Any, **kwargs: Any) -> None:
            n, fz = points_of(x).T
            out["F"] = values(n, fz)
            if problem.constraints:
                out["G"] = (problem.shares(n, fz) - 1.0 - tolerance.PARAMETRIC).T

    def look(running: Any) -> None:
        progress.check()
        if best is not None and running.opt is not None and bool(running.opt[0].FEAS[0]):
            best.append(float(running.opt[0].F[0]))

    with _without_warnings():
        result = minimize(
            GeneticProblem(),
            algorithm(
                pop_size=settings.population,
                eliminate_duplicates=False,
                crossover=SBX(prob=settings.crossover, eta=DISTRIBUTION_INDEX),
                mutation=PM(prob=1.0, prob_var=settings.mutation, eta=DISTRIBUTION_INDEX),
            ),
            ("n_gen", settings.generations),
            seed=settings.seed,
            callback=look,
            verbose=False,
        )
    if result.X is None:
        return None
    points = points_of(np.atleast_2d(result.X))
    kept = problem.is_feasible(*points.T)
    return points[kept] if kept.any() else None


@contextmanager
def _without_warnings() -> Iterator[None]:
    """Keep warnings of the library's own numbers from a person: what it returns is checked."""
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        yield
