"""What the optimiser gains for each operation over the tables, and how its search went for one of them."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from trunnion.findings import BadCall
from trunnion.model.operation import CuttingData
from trunnion.model.session import Session
from trunnion.pipeline.context import Context
from trunnion.plan.cutting.optimization.genetic import (
    FrontPoint,
    pareto_front,
    solve_genetically,
)
from trunnion.plan.cutting.optimization.operation import OptimizationSettings, bound_of
from trunnion.plan.cutting.optimization.problem import CuttingProblem
from trunnion.plan.cutting.optimization.settings import OPTIMISED
from trunnion.plan.cutting.optimize import Choice, choices_of
from trunnion.plan.cutting.time_bound import RateSearch
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.units import SECONDS_PER_MINUTE


@dataclass(frozen=True, slots=True, kw_only=True)
class DataFigures:
    """What spindle speed (1/min) and feed (fz mm, vf mm/min) come to: s and money a metre of way, removal rate cm3/min, the highest power
    kW of `power_limit`, and the share of each limit, by its name."""

    spindle: float
    feed_per_tooth: float
    feed: float
    seconds: float
    cost: float
    removal_rate: float
    power: float
    power_limit: float
    shares: dict[str, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class OperationComparison:
    """An operation with the tables' data and the optimiser's: None where it keeps the tables'; `gain` the share of time that is saved,
    `bound_by` what stops a quicker choice, and `removal_bound` cm3/min, the most that any engagement allows (0 where it is not known).

    `proven_s` is the time at the machine that the last proof measured, whatever data that was for, and `bound_s` its bound
    (both 0 before).
    """

    operation: str
    tool: int
    handbook: DataFigures | None
    optimised: DataFigures | None
    gain: float
    bound_by: str
    objective: float
    removal_bound: float
    proven_s: float = 0.0
    bound_s: float = 0.0

    def as_dict(self) -> dict[str, Any]:
        """Return the comparison as JSON has it."""
        return asdict(self)


@dataclass(frozen=True, slots=True, kw_only=True)
class Search:
    """How the genetic algorithm went for an operation: the best objective of each generation, and the front of time against cost and load.

    `handbook` and `exact` are the tables' point and the exact search's.
    """

    operation: str
    convergence: tuple[float, ...]
    front: tuple[FrontPoint, ...]
    handbook: FrontPoint
    exact: FrontPoint


def is_optimised(session: Session) -> bool:
    """Return whether a session's operations get the optimiser's data."""
    return OptimizationSettings.of(session.choices).optimize.data == OPTIMISED


def comparisons(
    session: Session, context: Context, progress: Progress = NO_PROGRESS
) -> tuple[OperationComparison, ...]:
    """Return every operation's comparison, in their order; raise `BadCall` before there are operations."""
    if session.process is None:
        raise BadCall("no operations yet: generate the route first")
    material = context.shop.material(session.process.material)
    found, search = [], RateSearch(material)
    for choice in choices_of(session.process, context.shop, session.choices, progress):
        operation = choice.handbook
        bound = 0.0
        if choice.problem is not None:
            machine = context.shop.machine(session.process.setup(operation.setup).machine)
            own = OptimizationSettings.of({**session.choices, **operation.choices})
            bound = search.rates(operation, machine, own).removal
        found.append(_compared(choice, bound, session))
    return tuple(found)


def _compared(choice: Choice, bound: float, session: Session) -> OperationComparison:
    problem, optimum, id = choice.problem, choice.optimum, choice.handbook.id
    is_changed = optimum is not None and choice.optimised is not choice.handbook
    handbook = None if problem is None else _figures(problem, choice.handbook.data)
    optimised = _figures(problem, choice.optimised.data) if problem and is_changed else None
    verdict = session.verdict
    proof = next((p for p in verdict.operations if p.operation == id), None) if verdict else None
    return OperationComparison(
        operation=id,
        tool=choice.handbook.tool.number,
        handbook=handbook,
        optimised=optimised,
        gain=1.0 - optimised.seconds / handbook.seconds if handbook and optimised else 0.0,
        bound_by=bound_of(problem, optimum) if problem and optimum and is_changed else "",
        objective=optimum.objective if optimum is not None else 0.0,
        removal_bound=bound,
        proven_s=proof.time_s if proof is not None else 0.0,
        bound_s=proof.bound_s if proof is not None and bound > 0.0 else 0.0,
    )


def _figures(problem: CuttingProblem, data: CuttingData) -> DataFigures:
    n, fz = data.spindle, data.feed_per_tooth
    shares = problem.shares(n, fz)[:, 0]
    return DataFigures(
        spindle=n,
        feed_per_tooth=fz,
        feed=data.feed,
        seconds=float(problem.time(n, fz)) * SECONDS_PER_MINUTE,
        cost=float(problem.cost(n, fz)),
        removal_rate=data.removal_rate,
        power=data.highest_power,
        power_limit=data.power_limit,
        shares={c.name: float(s) for c, s in zip(problem.constraints, shares, strict=True)},
    )


def search_of(
    session: Session, context: Context, operation: str, progress: Progress = NO_PROGRESS
) -> Search | None:
    """Return how the genetic algorithm went for one operation; None where there are no models for it or nothing keeps the limits."""
    if session.process is None:
        raise BadCall("no operations yet: generate the route first")
    found = choices_of(session.process, context.shop, session.choices, progress, operation)
    choice = found[0] if found else None
    if choice is None or choice.problem is None or choice.optimum is None:
        return None
    problem, settings = choice.problem, OptimizationSettings.of(session.choices)
    genetic = solve_genetically(
        problem, settings.optimize.time_weight, settings.genetic, progress.part(0.0, 0.6)
    )
    return Search(
        operation=operation,
        convergence=genetic.convergence if genetic else (),
        front=pareto_front(problem, settings.genetic, progress.part(0.6, 1.0)),
        handbook=_point(problem, *problem.handbook),
        exact=_point(problem, choice.optimum.spindle, choice.optimum.feed),
    )


def _point(problem: CuttingProblem, spindle: float, feed: float) -> FrontPoint:
    shares = problem.shares(spindle, feed)[:, 0]
    loads = [s for c, s in zip(problem.constraints, shares, strict=True) if c.name == problem.load]
    return FrontPoint(
        spindle=spindle,
        feed=feed,
        time=float(problem.time(spindle, feed)),
        cost=float(problem.cost(spindle, feed)),
        load=float(max(loads, default=0.0)),
    )
