"""What the worker does to the faces that lead operations: more of them, fewer of them. No Qt."""

from __future__ import annotations

from typing import Any

from trunnion.model.session import Session
from trunnion.progress import Progress
from trunnion_gui.worker.requests import SendEvent, SessionState, state_of


def lead_along(
    engine: Any,
    progress: Progress,
    _send_event: SendEvent,
    session: Session,
    id: str,
    faces: tuple[int, ...],
) -> SessionState:
    """Return the session with an operation led along some faces too."""
    from trunnion.pipeline.planning.guide_faces import with_guide_faces

    return state_of(engine, with_guide_faces(engine, session, id, add=faces, progress=progress))


def leave_out(
    engine: Any,
    progress: Progress,
    _send_event: SendEvent,
    session: Session,
    id: str,
    faces: tuple[int, ...],
) -> SessionState:
    """Return the session with an operation led along its other faces only."""
    from trunnion.pipeline.planning.guide_faces import with_guide_faces

    return state_of(
        engine, with_guide_faces(engine, session, id, leave_out=faces, progress=progress)
    )
