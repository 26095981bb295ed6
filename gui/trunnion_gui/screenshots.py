"""Pictures of the whole window, for the documentation: the same widgets, drawn without a screen."""

from __future__ import annotations

import contextlib
import os
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from trunnion.findings import BadCall
from trunnion.model.session import Session

if TYPE_CHECKING:
    from trunnion_gui.window import Window


_SHOWN = "pocket-01"
"""The feature of the sample part that is selected in its picture."""
Prepare = Callable[["Window"], None]


@contextlib.contextmanager
def opened(
    part: str | Path,
    *,
    size: tuple[int, int] = (1600, 1000),
    factory: str = "",
    until: str = "repair",
    theme: str = "light",
    timeout_s: float = 300.0,
) -> Iterator[Window]:
    """Give a window as at a first start, in which a part has been worked on up to a step; raise `BadCall` when that failed."""
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    settings = tempfile.TemporaryDirectory()
    os.environ["TRUNNION_SETTINGS"] = settings.name
    from PySide6.QtWidgets import QApplication

    from trunnion_gui.look import colours
    from trunnion_gui.window import Window
    from trunnion_gui.worker.worker import ENGINE

    app = QApplication.instance() or QApplication(["trunnion"])
    window = Window(factory or ENGINE)
    window.unsaved.confirms = False
    try:
        window.use_theme(colours.theme(theme))
        window.resize(*size)
        window.viewport.scene.smooth()
        window.show()
        window.document.files.open(str(part))
        wait(lambda: not window.document.is_busy, timeout_s)
        if until:
            window.document.run(until, "Program")
            wait(lambda: not window.document.is_busy, timeout_s)
            if window.document.states.get(until) not in ("done", "problem"):
                raise BadCall(
                    f"no picture: {window.viewport.notice.text or 'the part could not be worked on'}"
                )
        yield window
    finally:
        window.close()
        app.processEvents()
        settings.cleanup()


def take(window: Window, picture: str | Path, prepare: Prepare | None = None) -> None:
    """Let `prepare(window)` arrange what is to be seen, and write the picture as PNG."""
    if prepare is not None:
        prepare(window)
    wait(lambda: True)
    window.grab().save(str(picture))


def shoot_all(folder: str | Path) -> tuple[Path, ...]:
    """Write the pictures of the documentation into a folder: the sample part with its features, programmed, played, and measured."""
    from importlib.resources import as_file

    import trunnion_resources

    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    wanted: tuple[tuple[str, str, dict[str, Prepare]], ...] = (
        ("route", "light", {"features": _show_feature}),
        (
            "repair",
            "light",
            {"window": _show_operation, "playback": _show_playback, "deviation": _show_deviation},
        ),
        ("repair", "dark", {"window-dark": _show_operation}),
    )
    made = []
    with as_file(trunnion_resources.sample("B1")) as part:
        for until, theme, pictures in wanted:
            with opened(part, until=until, theme=theme) as window:
                for name, prepare in pictures.items():
                    made.append(folder / f"{name}.png")
                    take(window, made[-1], prepare)
    return tuple(made)


def _show_feature(window: Window) -> None:
    window.panels["blank"].fold(False)
    window.panels["route"].fold(False)
    window.document.selection.select_feature(_SHOWN)


def _show_operation(window: Window) -> None:
    window.panels["recognize"].fold(True)
    window.panels["generate"].fold(False)
    process = window.document.session.process
    if process is not None:
        window.show_dock("process")
        window.document.selection.select_operation(
            next(o.id for o in process.operations if o.kind.endswith("rough"))
        )


def _show_playback(window: Window) -> None:
    """Stop in the middle of the last roughing operation, seen from near."""
    window.panels["generate"].fold(True)
    window.document.selection.select_face(0)
    window.registry.run("play.show")
    wait(lambda: window.player.timeline is not None)
    line = window.player.timeline
    assert line is not None
    row = max(k for k, p in enumerate(line.passages) if p.operation.startswith("rough"))
    window.player.go(
        float(line.first[row] + 0.55 * (line.first[row + 1] - line.first[row])) // 1 + 0.5
    )
    wait(lambda: window.player.is_settled)


def _show_deviation(window: Window) -> None:
    """Prove the plan with two faults planted in it, and show what the proof found."""
    window.document.edit("faults to be found", with_faults)
    wait(lambda: window.document.states.get("verify") == "stale")
    window.document.run("verify", "Verify")
    wait(lambda: not window.document.is_busy, 300.0)
    window.registry.run("view.deviation")
    wait(lambda: window.deviation.shown is not None)


def with_faults(session: Session) -> Session:
    """Return a session whose plan cuts one floor 45 µm too deep and one wall 40 µm too near, with paths of their own keys."""
    floors, walls = (
        [p.operation for p in session.paths if p.operation.startswith(kind)]
        for kind in ("floor", "wall")
    )
    moved = {floors[2]: np.array([0.0, 0.0, -0.045]), walls[-2]: np.array([0.0, -0.04, 0.0])}
    paths = []
    for made in session.paths:
        if made.operation in moved:
            path, by = made.path, moved[made.operation]
            made = replace(
                made,
                key=f"{made.key} moved",
                path=replace(path, position=path.position + by, centre=path.centre + by),
            )
        paths.append(made)
    return replace(session, paths=tuple(paths))


def wait(is_done: Callable[[], bool], timeout_s: float = 120.0) -> None:
    """Let the window work until something is done; raise `TimeoutError` when it takes too long."""
    from PySide6.QtWidgets import QApplication

    end = time.monotonic() + timeout_s
    while not is_done():
        if time.monotonic() > end:
            raise TimeoutError(f"the window was not ready within {timeout_s:g} s")
        QApplication.processEvents()
        time.sleep(0.01)
    for _ in range(10):
        QApplication.processEvents()
        time.sleep(0.02)


if __name__ == "__main__":
    shoot_all(sys.argv[1] if len(sys.argv) > 1 else "docs/pictures")
