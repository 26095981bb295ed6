"""Dialects of a package of one's own, registered as pip would: `tests/dialects` on the path, its entry points beside ours."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from trunnion import registry
from trunnion.post.contract import Dialect

FOLDER = Path(__file__).resolve().parent / "dialects"


@contextmanager
def with_own_dialects() -> Iterator[None]:
    """Let the registry find the dialects of `tests/dialects` too, for as long as the context lasts."""
    sys.path.insert(0, str(FOLDER))
    forget()
    try:
        yield
    finally:
        sys.path.remove(str(FOLDER))
        forget()


def forget() -> None:
    """Let the registry look for entry points again."""
    registry._points.cache_clear()
    registry.get.cache_clear()


def all_dialects() -> dict[str, type[Dialect]]:
    """Return every registered dialect by its name, ours and those of `tests/dialects`."""
    with with_own_dialects():
        return {name: registry.get("dialects", name) for name in registry.names("dialects")}
