"""The estimate of a plan's finishing by area rates: computed before there are toolpaths, measured on them afterwards."""

from __future__ import annotations

from trunnion.model.motion.toolpath import Mark
from trunnion.model.session import Session
from trunnion.pipeline.context import Context
from trunnion.pipeline.planning.patches import groups_of
from trunnion.plan.freeform.estimate.finishing_time import Estimate, PathFigures, estimate_of
from trunnion.toolpath.motion.time import machining_time


def estimate(session: Session, context: Context) -> Estimate | None:
    """Return how long each area of curved faces takes, and the gain of cutters of their own; None where the plan has no such area.

    The area rates are the toolpaths' own where those are there.
    """
    if session.process is None:
        return None
    groups = groups_of(session.recognition) if session.recognition else ()
    return estimate_of(
        session.process,
        context.part.graph().area,
        _paths(session, context),
        {g.id: g.tags for g in groups},
        [g.id for g in groups if g.attributes.get("local")],
    )


def _paths(session: Session, context: Context) -> dict[str, PathFigures]:
    """Return what the operations' toolpaths take, by operation; nothing before there are any."""
    process = session.process
    if process is None or not session.paths:
        return {}
    machines = {s.name: context.shop.machine(s.machine) for s in process.setups}
    found = {}
    for operation in process.operations:
        made = session.path_of(operation.id)
        if made is not None and len(made.path):
            path = made.path
            found[operation.id] = PathFigures(
                seconds=machining_time(path, machines[operation.setup]),
                length=float(path.lengths()[path.mark == Mark.CUT].sum()),
            )
    return found
