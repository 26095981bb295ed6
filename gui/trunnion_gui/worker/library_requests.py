"""What the worker does with the plan library: plans added, removed, put back, and those that match a part. No Qt."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from trunnion.findings import Finding
from trunnion.model.session import Session
from trunnion.progress import Progress
from trunnion.shop.library import TaughtPlan
from trunnion_gui.worker.requests import SendEvent, SessionState, state_of, writes_files


@dataclass(frozen=True, slots=True)
class LibraryChange:
    """A plan that was added to the library or removed from it, the session's states after that, and what a person should know."""

    plan: TaughtPlan
    state: SessionState
    findings: tuple[Finding, ...] = ()


@dataclass(frozen=True, slots=True)
class MatchRow:
    """A plan of the library for parts of the family: its name, the similarity from 0 to 1, why in words, and whether a route follows it."""

    name: str
    similarity: float
    words: str
    is_followed: bool


def matching(
    engine: Any, _progress: Progress, _send_event: SendEvent, session: Session
) -> tuple[MatchRow, ...]:
    """Return the plans for a session's part, the most similar first; none before it has features and a blank."""
    from trunnion.pipeline.planning.library import library_choice, matches, signature_of

    context = engine.context_of(session)
    if signature_of(session, context) is None:
        return ()
    found = matches(session, context)
    followed = library_choice(session, context).plan
    return tuple(
        MatchRow(
            m.plan.name,
            m.similarity.value,
            m.similarity.words,
            followed is not None and followed.name == m.plan.name,
        )
        for m in found
    )


@writes_files
def add(
    engine: Any,
    _progress: Progress,
    _send_event: SendEvent,
    session: Session,
    name: str,
    date: str,
) -> LibraryChange:
    """Add what a session's process teaches, under a name and with a date."""
    from trunnion.pipeline.planning.library import add_to_library

    result = add_to_library(session, engine.context_of(session), name=name, date=date)
    return LibraryChange(result.plan, state_of(engine, session), result.findings)


@writes_files
def remove(
    engine: Any, _progress: Progress, _send_event: SendEvent, session: Session, name: str
) -> LibraryChange:
    """Remove a plan by its name, and return it, so that it can be put back."""
    plan = engine.library.plan(name)
    engine.library.remove(name)
    return LibraryChange(plan, state_of(engine, session))


@writes_files
def take_out(
    engine: Any, _progress: Progress, _send_event: SendEvent, session: Session, plan: TaughtPlan
) -> SessionState:
    """Remove a plan again that was added."""
    engine.library.remove(plan.name)
    return state_of(engine, session)


@writes_files
def put_back(
    engine: Any, _progress: Progress, _send_event: SendEvent, session: Session, plan: TaughtPlan
) -> SessionState:
    """Put a plan back that was removed, as it was."""
    engine.library.add(plan)
    return state_of(engine, session)
