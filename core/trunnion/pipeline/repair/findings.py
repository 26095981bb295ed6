"""What is reported of a repair: the fixes that were kept, and for a plan that stays rejected what was tried."""

from __future__ import annotations

from collections.abc import Iterable

from trunnion.findings import Finding, Fix, info
from trunnion.model.repair import words_of
from trunnion.model.session import Session


def repair_findings(session: Session) -> tuple[Finding, ...]:
    """Return a finding on what repair changed, and one on what it tried in vain where the plan stays rejected."""
    kept = [f for r in session.repairs if r.kept for f in r.fixes]
    vain = [f for r in session.repairs if not r.kept for f in r.fixes]
    found = []
    if kept:
        rejected = session.repairs[0].before.errors > 0
        found.append(
            info(
                "repair.kept",
                f"the proof {'rejected' if rejected else 'remarked on'} the first plan; it was repaired: {_listed(kept)}",
                *_operations(kept),
            )
        )
    if vain and session.verdict is not None and not session.verdict.releases:
        found.append(
            info(
                "repair.tried",
                f"tried without success: {_listed(vain)}",
                *_operations(vain),
                remedy="follow the errors' remedies by hand, or raise repair.rounds",
            )
        )
    return tuple(found)


def _listed(fixes: Iterable[Fix]) -> str:
    return "; ".join(dict.fromkeys(words_of(f) for f in fixes))


def _operations(fixes: Iterable[Fix]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(f.operation for f in fixes if f.operation))
