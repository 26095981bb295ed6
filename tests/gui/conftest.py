"""What the tests of the window share: the fake engine's home, a window over it, and waiting for jobs."""

from __future__ import annotations

import gc
import os
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from warm import CAN_FORK, WARM

sys.path.insert(0, str(Path(__file__).parent))
os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")


@pytest.fixture(autouse=True)
def workers_start_warm(request, monkeypatch):
    """Start each window's computing process from a warm one; with the mark `cold` it starts as the program starts it."""
    if CAN_FORK and request.node.get_closest_marker("cold") is None:
        monkeypatch.setattr(
            "trunnion_gui.worker.worker.multiprocessing",
            SimpleNamespace(get_context=lambda _: WARM),
        )


@pytest.fixture(autouse=True)
def settings_of_their_own(tmp_path, monkeypatch):
    """Keep a test's remembered settings, recent files and autosaves away from the person's own."""
    monkeypatch.setenv("TRUNNION_SETTINGS", str(tmp_path / "settings"))


@pytest.fixture(autouse=True)
def tidy(qapp):
    """Collect garbage in the window's thread only, as the program does, and all of a test's at its end."""
    import trunnion_gui.window  # noqa: F401 - what is imported before is not looked through for garbage
    from trunnion_gui.gc_control import GcControl

    made = GcControl()
    yield made
    gc.collect()
    made.stop()


@pytest.fixture
def make_window(qtbot):
    """Return a function that opens a window over an engine and closes it after the test."""
    from trunnion_gui.window import Window

    made = []

    def make(factory="fake_engine:FakeEngine", wait=True):
        window = Window(factory)
        window.unsaved.confirms = False
        window.resize(1440, 900)
        qtbot.addWidget(window)
        made.append(window)
        window.show()
        if wait:
            qtbot.waitUntil(lambda: bool(window.document.groups), timeout=20000)
        return window

    yield make
    for window in made:
        window.close()


@pytest.fixture
def window(make_window):
    """A window over the fake engine."""
    return make_window()


@pytest.fixture
def idle(qtbot):
    """Return a function that waits until a window's job is done."""

    def wait(window, timeout=30000):
        qtbot.waitUntil(
            lambda: not window.document.is_busy and not window.document.jobs.is_querying,
            timeout=timeout,
        )

    return wait


@pytest.fixture
def part_file(tmp_path):
    """A file that the fake engine takes for a part."""
    path = tmp_path / "tray.step"
    path.write_text("a made-up part")
    return path


@pytest.fixture
def opened(window, part_file, idle):
    """A window with the made-up part open."""
    window.document.files.open(part_file)
    idle(window)
    return window


@pytest.fixture
def programmed(opened, idle):
    """A window with the made-up part programmed."""
    opened.document.program()
    idle(opened)
    return opened
