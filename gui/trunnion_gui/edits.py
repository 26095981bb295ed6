"""Edits of a session and their history. No Qt: an edit is a plain function, undo keeps the earlier session."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from trunnion.findings import Refused
from trunnion.model.feature import Recognition
from trunnion.model.process import ProcessTree
from trunnion.model.session import Session
from trunnion.plan.manual.operation_copy import with_copy as copied
from trunnion.plan.manual.operation_copy import with_copy_on as copied_on
from trunnion.plan.manual.operation_order import with_operation_before as moved_before
from trunnion.plan.manual.operation_state import with_own_values
from trunnion.plan.manual.operation_state import with_suppressed as suppressed_in
from trunnion.settings import Value

Edit = Callable[[Session], Session]


@dataclass(frozen=True, slots=True)
class ExternalEdit:
    """An edit of what is kept outside of the session, such as the plan library: the worker's requests that take it back and do it again,
    both with the session and a `subject`."""

    undo: Callable[..., Any]
    redo: Callable[..., Any]
    subject: Any


@dataclass(frozen=True, slots=True)
class HistoryEntry:
    """One state in the history: what led to it, the session, the gesture that may still go on, and what was changed outside of it."""

    label: str
    session: Session
    gesture: str = ""
    external: ExternalEdit | None = None


class History:
    """The sessions a person can go back and forth between.

    Edits of one gesture (one drag, one visit to a field) are one entry; merging is by the gesture's name, never by the clock.
    """

    def __init__(self, session: Session, label: str = "") -> None:
        self._entries = [HistoryEntry(label, session)]
        self._at = 0
        self._saved: Session | None = session

    @property
    def session(self) -> Session:
        """The session as it is now."""
        return self._entries[self._at].session

    @property
    def undo_label(self) -> str:
        """What `undo` would take back, or empty."""
        return self._entries[self._at].label if self._at else ""

    @property
    def redo_label(self) -> str:
        """What `redo` would bring back, or empty."""
        return self._entries[self._at + 1].label if self._at + 1 < len(self._entries) else ""

    @property
    def undo_external(self) -> ExternalEdit | None:
        """What `undo` has to take back outside of the session first, if anything."""
        return self._entries[self._at].external if self._at else None

    @property
    def redo_external(self) -> ExternalEdit | None:
        """What `redo` has to do again outside of the session first, if anything."""
        following = self._entries[self._at + 1 : self._at + 2]
        return following[0].external if following else None

    @property
    def is_dirty(self) -> bool:
        """Whether the session differs from the one last saved."""
        return self.session is not self._saved

    def push(
        self,
        label: str,
        session: Session,
        gesture: str = "",
        external: ExternalEdit | None = None,
    ) -> None:
        """Add a state; what could be redone is forgotten. An edit that changed nothing, inside or outside, adds nothing."""
        if session is self.session and external is None:
            return
        goes_on = (
            gesture
            and gesture == self._entries[self._at].gesture
            and self._at == len(self._entries) - 1
        )
        del self._entries[self._at + (0 if goes_on else 1) :]
        self._entries.append(HistoryEntry(label, session, gesture, external))
        self._at = len(self._entries) - 1

    def undo(self) -> Session:
        """Go one state back and return the session there (the same one when there is nothing to undo)."""
        self._at = max(self._at - 1, 0)
        return self.session

    def redo(self) -> Session:
        """Go one state forward and return the session there (the same one when there is nothing to redo)."""
        self._at = min(self._at + 1, len(self._entries) - 1)
        return self.session

    def mark_saved(self, session: Session | None) -> None:
        """Remember which session is in the file; None when there is no file."""
        self._saved = session


def with_choice(key: str, value: Value) -> Edit:
    """Return the edit that chooses a setting by its full key; what depends on it goes stale by its digest."""

    def edit(session: Session) -> Session:
        if session.choices.get(key) == value:
            return session
        return replace(session, choices={**session.choices, key: value})

    return edit


def without_choices(*keys: str) -> Edit:
    """Return the edit that takes settings back to their defaults."""

    def edit(session: Session) -> Session:
        if not any(k in session.choices for k in keys):
            return session
        return replace(session, choices={k: v for k, v in session.choices.items() if k not in keys})

    return edit


def without_feature(id: str) -> Edit:
    """Return the edit that deletes a feature, also for when its step runs again."""

    def edit(session: Session) -> Session:
        return replace(session, recognition=recognition_of(session).without(id))

    return edit


def with_kind(id: str, kind: str) -> Edit:
    """Return the edit that changes the kind of a feature, marked as a person's."""

    def edit(session: Session) -> Session:
        found = recognition_of(session)
        if found.feature(id).kind == kind:
            return session
        changed = tuple(
            replace(f, kind=kind, by_hand=True) if f.id == id else f for f in found.features
        )
        return replace(session, recognition=replace(found, features=changed))

    return edit


def without_operation(id: str) -> Edit:
    """Return the edit that deletes an operation, also for when its step runs again."""

    return _with_process(lambda tree: tree.without(tree.operation(id).id))


def with_suppressed(id: str, suppressed: bool) -> Edit:
    """Return the edit that keeps an operation in the tree without cutting, or takes it up again."""
    return _with_process(lambda tree: suppressed_in(tree, id, suppressed))


def with_operation_choice(id: str, key: str, value: Value) -> Edit:
    """Return the edit that chooses a strategy's setting for one operation only."""
    return _with_process(lambda tree: with_own_values(tree, id, {key: value}))


def with_operation_before(id: str, before: str | None) -> Edit:
    """Return the edit that moves an operation in front of another one of its setup, or to the setup's end.

    Raises `Refused` when the operation would come before one that it needs, or after one that needs it.
    """
    return _with_process(lambda tree: moved_before(tree, id, before))


def with_copy(id: str) -> Edit:
    """Return the edit that copies an operation: the same work once more, right behind it."""
    return _with_process(lambda tree: copied(tree, id)[0])


def with_copy_on(id: str, feature: str) -> Edit:
    """Return the edit that copies an operation to another feature of the same kind."""

    def edit(session: Session) -> Session:
        made, _ = copied_on(_process(session), id, feature, recognition_of(session))
        return replace(session, process=made)

    return edit


def _with_process(change: Callable[[ProcessTree], ProcessTree]) -> Edit:
    def edit(session: Session) -> Session:
        tree = _process(session)
        after = change(tree)
        return session if after is tree else replace(session, process=after)

    return edit


def recognition_of(session: Session) -> Recognition:
    """Return what was recognized; raise `Refused` when nothing was yet."""
    if session.recognition is None:
        raise Refused("there are no features yet: recognize the part first")
    return session.recognition


def _process(session: Session) -> ProcessTree:
    if session.process is None:
        raise Refused("there is no process tree yet: generate the route first")
    return session.process
