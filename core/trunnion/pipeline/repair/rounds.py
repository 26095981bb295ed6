"""The rounds of repair: fixes together, proven, kept when the plan is better, else one by one.

Only operations whose drive, tool, data or stock changed are laid again (their digests say so). The judge is never told that it is a
repair, and no fix touches a tolerance, a margin or the goal of coverage.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace

from trunnion.findings import BadInput, Finding, Fix, Refused, Severity
from trunnion.model.process import ProcessTree
from trunnion.model.repair import RepairRound
from trunnion.model.session import Session
from trunnion.pipeline.repair.score import score_of
from trunnion.pipeline.repair.settings import RepairSettings
from trunnion.plan.repair.alternatives import fixes_for
from trunnion.plan.repair.contract import RepairJob, applied
from trunnion.progress import Progress
from trunnion.settings import digest

Prove = Callable[[Session, Progress], Session]
"""Runs the steps after the route on a session whose process was changed: data, toolpaths, proof."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Proposal:
    """A fix with the finding that asks for it."""

    fix: Fix
    finding: str

    def is_of(self, session: Session) -> bool:
        """Return whether a session still has a finding of the same kind in the same operation."""
        return any(
            f.fix is not None and (f.code, f.fix.operation) == (self.fix.reason, self.fix.operation)
            for f in session.findings()
        )


@dataclass(slots=True)
class Attempts:
    """What was tried before: a kind of fix on an operation as it stood then."""

    done: set[str] = field(default_factory=set)

    def key(self, fix: Fix, process: ProcessTree) -> str:
        """Return what tells an attempt from others: the kind, and the operation or faces as they are now."""
        now = next((o for o in process.operations if o.id == fix.operation), None)
        there = [o.id for o in process.operations] if now is None else now
        return digest(fix.kind, fix.faces, there)


def repaired(
    session: Session, job: RepairJob, settings: RepairSettings, prove: Prove, progress: Progress
) -> Session:
    """Return the session after the rounds of repair that settings allow; the one given when it needs none, or nothing helped."""
    most = settings.rounds
    tried, rounds = Attempts(), list[RepairRound]()
    alone: list[Proposal] = []
    while len(rounds) < most and _needs_repair(session, settings):
        together = [alone.pop(0)] if alone else _proposals(session, job, tried)
        changed = _with(session, together, job)
        if changed is None:
            if alone:
                continue
            break
        share = progress.part(
            len(rounds) / most, (len(rounds) + 1) / most, f"repair, round {len(rounds) + 1}"
        )
        made = _tried(len(rounds) + 1, together, session, changed, prove, share)
        rounds.append(made.round)
        if made.round.kept:
            session = made.session
            alone = [p for p in alone if p.is_of(session)]
        elif len(together) > 1:
            alone = together
    return replace(session, repairs=(*session.repairs, *rounds)) if rounds else session


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Trial:
    """A round, and the session that came of its fixes."""

    round: RepairRound
    session: Session


def _tried(
    number: int,
    proposals: Sequence[Proposal],
    session: Session,
    changed: Session,
    prove: Prove,
    progress: Progress,
) -> Trial:
    """Return what comes of a changed plan; where it can't be made at all, the round says why and is not kept."""
    before, refusal, after = score_of(session), "", None
    try:
        changed = prove(changed, progress)
        after = score_of(changed)
    except (BadInput, Refused) as reason:
        refusal = str(reason)
    made = RepairRound(
        number=number,
        fixes=tuple(p.fix for p in proposals),
        findings=tuple(p.finding for p in proposals),
        before=before,
        after=after,
        kept=after is not None and after < before,
        refusal=refusal,
    )
    return Trial(round=made, session=changed)


def _with(session: Session, proposals: Sequence[Proposal], job: RepairJob) -> Session | None:
    """Return the session with all that fixes change in its process; None where nothing does."""
    process = session.process
    if process is None:
        return None
    for proposal in proposals:
        process = applied(process, proposal.fix, job) or process
    return None if process is session.process else replace(session, process=process)


def _proposals(session: Session, job: RepairJob, tried: Attempts) -> list[Proposal]:
    """Return the next fix of every operation that has errors, in the order of the findings; each is counted as tried."""
    process = session.process
    if process is None:
        return []
    found: dict[str, Proposal] = {}
    for finding in _repairable(session):
        for fix in fixes_for(finding):
            key = tried.key(fix, process)
            if fix.operation in found or key in tried.done:
                continue
            tried.done.add(key)
            if applied(process, fix, job) is not None:
                found[fix.operation] = Proposal(fix=fix, finding=finding.text)
    return list(found.values())


def _needs_repair(session: Session, settings: RepairSettings) -> bool:
    verdict = session.verdict
    return verdict is not None and (not verdict.releases or settings.remarks)


def _repairable(session: Session) -> Iterator[Finding]:
    """Yield what asks for a fix, each once: the errors of toolpaths and proof while there are any that keep the plan from being released,
    then remarks."""
    released = session.verdict is not None and session.verdict.releases
    for finding in dict.fromkeys(session.findings()):
        if finding.fix is not None and (finding.severity is Severity.ERROR) is not released:
            yield finding
