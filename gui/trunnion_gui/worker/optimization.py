"""What the worker computes of the optimiser: how its search went for one operation. No Qt."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from trunnion.model.session import Session
from trunnion.progress import Progress
from trunnion_gui.worker.requests import SendEvent

Pair = tuple[float, float]


@dataclass(frozen=True, slots=True)
class SearchFigures:
    """How the genetic algorithm went for an operation: the best objective of each generation, and points of time (s a metre of way) against
    cost a metre, or load in percent where `by_load`: the front, the tables' point and the optimum. Empty where it has no models.
    """

    operation: str
    convergence: tuple[float, ...] = ()
    front: tuple[Pair, ...] = ()
    tables: Pair | None = None
    optimum: Pair | None = None
    by_load: bool = False


def search(
    engine: Any, progress: Progress, _send_event: SendEvent, session: Session, operation: str
) -> SearchFigures:
    """Return how the search went for one operation of a session."""
    from trunnion.pipeline.planning.optimization import search_of
    from trunnion.plan.cutting.optimization.settings import LOAD, GeneticSettings
    from trunnion.settings import choose
    from trunnion.units import SECONDS_PER_MINUTE

    found = search_of(session, engine.context_of(session), operation, progress)
    if found is None:
        return SearchFigures(operation)
    by_load = choose(GeneticSettings, session.choices).front == LOAD

    def pair(point: Any) -> Pair:
        other = 100.0 * point.load if by_load else point.cost
        return SECONDS_PER_MINUTE * point.time, other

    return SearchFigures(
        operation,
        found.convergence,
        tuple(map(pair, found.front)),
        pair(found.handbook),
        pair(found.exact),
        by_load,
    )
