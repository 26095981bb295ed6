"""How good a proven plan is, in one place: what a round of repair is kept or taken back by."""

from __future__ import annotations

from trunnion.findings import Severity
from trunnion.model.repair import PlanScore
from trunnion.model.session import Session
from trunnion.model.verdict import Outcome

SHORT = "verify.coverage"
"""Code of the finding that too little of the area is finished."""
DECIMALS = 6
"""Decimals of a share of area that count: what differs less is the sums' rounding."""


def score_of(session: Session) -> PlanScore:
    """Return the score of a session whose programs were proven; raise `ValueError` before."""
    verdict = session.verdict
    if verdict is None:
        raise ValueError("the score of a plan is that of its proof: nothing is proven yet")
    found = session.findings()
    return PlanScore(
        errors=sum(f.severity is Severity.ERROR for f in found),
        is_short=any(f.code == SHORT and f.severity is Severity.ERROR for f in found),
        harms=verdict.collisions
        + verdict.rapids_in_stock
        + sum(o.outcome is Outcome.FAILED for o in verdict.operations),
        unfinished=round(1.0 - verdict.reachable, DECIMALS),
        remarks=sum(f.severity in (Severity.REMARK, Severity.WARNING) for f in found),
        time=round(verdict.machining_time_s, DECIMALS),
    )
