"""The estimate of a plan's finishing by area rates: computed before there are toolpaths, measured on them afterwards."""

from __future__ import annotations

from trunnion.model.session import Session
from trunnion.pipeline.context import Context
from trunnion.plan.freeform.estimate.finishing_time import Estimate, estimate_of, measured
from trunnion.toolpath.motion.time import machining_time


def estimate(session: Session, context: Context) -> Estimate | None:
    """Return how long each area of curved faces takes, and the gain of cutters of their own; None where the plan has no such area.

    The area rates are the toolpaths' own where those are there.
    """
    if session.process is None:
        return None
    found = estimate_of(session.process, context.part.graph().area)
    if found is None or not session.paths:
        return found
    machines = {s.name: context.shop.machine(s.machine) for s in session.process.setups}
    seconds = {}
    for area in found.areas:
        made = session.path_of(area.operation)
        if made is not None and len(made.path):
            seconds[area.operation] = machining_time(
                made.path, machines[session.process.operation(area.operation).setup]
            )
    return measured(found, seconds)
