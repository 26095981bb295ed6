"""A session on its way back to the window: what it has in common with one that both processes know does not travel.

A request gives a session to the worker, and a reply gives one back that differs in some results. Whatever the worker left as it was is
after the journey the very same object in the window too, so that a view sees at once that it has nothing to draw anew.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from typing import Any

from trunnion.model.session import Session


@dataclass(frozen=True, slots=True)
class SharedField:
    """Stands for a field of the known session, which is in the new one as it was."""


@dataclass(frozen=True, slots=True)
class SharedEntry:
    """Stands for an item of a tuple in the known session, by its index there."""

    index: int


@dataclass(frozen=True, slots=True)
class SharedEntries:
    """Stands for a tuple with items of the one in the known session, which are given as `SharedEntry`."""

    items: tuple[Any, ...]


class SharedSession:
    """The session of a request, then the one of the last reply to it; the worker and the window have one each, of equal content."""

    def __init__(self, session: Session | None = None) -> None:
        self._session, self._following = session, session

    def reduced(self, session: Session) -> tuple[Callable[..., Session], tuple[dict[str, Any]]]:
        """Return what the pickle of a session consists of: `complete_session`, and its fields."""
        self._following = session
        known = self._session
        return complete_session, (
            {
                f.name: _difference(getattr(session, f.name), getattr(known, f.name, None))
                for f in fields(Session)
            },
        )

    def complete(self, values: dict[str, Any]) -> Session:
        """Return the session of such a pickle; raise `ValueError` when it needs a known one that is not there."""
        known = self._session
        self._following = Session(
            **{name: _completed(value, known, name) for name, value in values.items()}
        )
        return self._following

    def settle(self) -> None:
        """Take the session of a message as the known one, once the whole message is packed or unpacked."""
        self._session = self._following


def session_of(arguments: Sequence[Any]) -> Session | None:
    """Return the session among the arguments of a request, if there is one."""
    return next((a for a in arguments if isinstance(a, Session)), None)


def complete_session(values: dict[str, Any]) -> Session:
    """Return a session that has nothing in common with a known one; its name in a pickle leads to `SharedSession.complete` elsewhere."""
    return SharedSession().complete(values)


def _difference(value: Any, known: Any) -> Any:
    """Return a field with what stands for its known parts."""
    if value is None:
        return None
    if value is known:
        return SharedField()
    if not isinstance(value, tuple) or not isinstance(known, tuple):
        return value
    index = {id(item): n for n, item in enumerate(known)}
    if not any(id(item) in index for item in value):
        return value
    return SharedEntries(
        tuple(SharedEntry(index[id(item)]) if id(item) in index else item for item in value)
    )


def _completed(value: Any, session: Session | None, name: str) -> Any:
    if not isinstance(value, (SharedField, SharedEntries)):
        return value
    if session is None:
        raise ValueError(f"{name} is sent as known, and there is no session that has it")
    known = getattr(session, name)
    if isinstance(value, SharedField):
        return known
    return tuple(known[i.index] if isinstance(i, SharedEntry) else i for i in value.items)
