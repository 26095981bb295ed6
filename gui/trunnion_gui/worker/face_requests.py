"""What the worker does to the faces of features: added, taken, merged, made. No Qt."""

from __future__ import annotations

from typing import Any

from trunnion.model.session import Session
from trunnion.progress import Progress
from trunnion_gui.worker.requests import SendEvent, SessionState, state_of


def add(
    engine: Any,
    _progress: Progress,
    _send_event: SendEvent,
    session: Session,
    id: str,
    faces: tuple[int, ...],
) -> SessionState:
    """Return the session with faces added to a feature."""
    from trunnion.pipeline.planning.face_edits import with_faces

    return state_of(engine, with_faces(engine, session, id, faces))


def take(
    engine: Any,
    _progress: Progress,
    _send_event: SendEvent,
    session: Session,
    id: str,
    faces: tuple[int, ...],
) -> SessionState:
    """Return the session with faces taken from a feature."""
    from trunnion.pipeline.planning.face_edits import with_faces_taken

    return state_of(engine, with_faces_taken(engine, session, id, faces))


def merge(
    engine: Any,
    _progress: Progress,
    _send_event: SendEvent,
    session: Session,
    ids: tuple[str, ...],
) -> SessionState:
    """Return the session with features made one."""
    from trunnion.pipeline.planning.face_edits import with_merged

    return state_of(engine, with_merged(engine, session, ids))


def make(
    engine: Any,
    _progress: Progress,
    _send_event: SendEvent,
    session: Session,
    kind: str,
    faces: tuple[int, ...],
) -> SessionState:
    """Return the session with a new feature of faces."""
    from trunnion.pipeline.planning.face_edits import with_feature

    return state_of(engine, with_feature(engine, session, kind, faces))
