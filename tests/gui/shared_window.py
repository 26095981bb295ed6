"""One window for all tests of a module, over the real engine unless told otherwise: each test takes back what it changed."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from PySide6.QtTest import QTest

from warm import CAN_FORK, WARM


@contextmanager
def shared_window(settings: Path, factory: str = "trunnion.pipeline:Engine") -> Iterator[Any]:
    """Give a window that is closed at the end; it keeps its settings in a folder of its own, its computing process starts warm."""
    from trunnion_gui.window import Window

    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("TRUNNION_SETTINGS", str(settings))
        if CAN_FORK:
            warm = SimpleNamespace(get_context=lambda _: WARM)
            patch.setattr("trunnion_gui.worker.worker.multiprocessing", warm)
        window = Window(factory)
        window.unsaved.confirms = False
        window.resize(1440, 900)
        window.show()
        until(lambda: bool(window.document.groups))
        yield window
        window.close()
        # One that stays would be dressed anew with every theme that a later test takes.
        window.deleteLater()


@contextmanager
def taken_back(window: Any) -> Iterator[Any]:
    """Give a window with nothing selected, and undo afterwards what was done to its document."""
    before = window.document.session
    window.document.selection.clear()
    yield window
    while window.document.session is not before and window.document.history.undo_label:
        window.registry.run("edit.undo")
    wait(window)
    assert window.document.session is before


def wait(window: Any, seconds: float = 60.0) -> None:
    """Wait until a window's job is done."""
    document = window.document
    until(lambda: not document.is_busy and not document.jobs.is_querying, seconds)


def until(is_so: Callable[[], bool], seconds: float = 60.0) -> None:
    """Wait until something is so."""
    end = time.monotonic() + seconds
    while not is_so():
        assert time.monotonic() < end
        QTest.qWait(10)
