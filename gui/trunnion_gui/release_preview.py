"""The programs as they would leave now, with the stamp and the names that the proof gives them."""

from __future__ import annotations

from trunnion.findings import TrunnionError, has_errors
from trunnion.model.session import PostedFile, Session


def as_they_leave(session: Session) -> tuple[PostedFile, ...]:
    """Return the programs with the stamp that they would be written with now; not proven, they keep the one that forbids running."""
    from trunnion.post.release import release

    try:
        return release(session)
    except TrunnionError:
        return session.posted


def rejected_names(session: Session) -> tuple[str, ...]:
    """Return the names of the files that the proof rejected, as they are written into a folder; none of a released plan."""
    from trunnion.post.header import REJECTED

    verdict = session.verdict
    if (
        session.part is None
        or verdict is None
        or (verdict.releases and not has_errors(verdict.findings))
    ):
        return ()
    return tuple(
        f"{session.part.name}.{f.suffix}" for f in as_they_leave(session) if REJECTED in f.suffix
    )
