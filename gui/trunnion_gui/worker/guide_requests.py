"""What the worker does to the faces that lead operations. No Qt."""

from __future__ import annotations

from typing import Any

from trunnion.model.session import Session
from trunnion.progress import Progress
from trunnion_gui.worker.requests import SendEvent, SessionState, state_of


def lead(
    engine: Any,
    progress: Progress,
    _send_event: SendEvent,
    session: Session,
    id: str,
    along: tuple[int, ...],
    leave_out: tuple[int, ...],
) -> SessionState:
    """Return the session with an operation led along some faces too, and some left out of it."""
    from trunnion.pipeline.planning.guide_faces import with_guide_faces

    made = with_guide_faces(engine, session, id, add=along, leave_out=leave_out, progress=progress)
    return state_of(engine, made)
