"""Pictures of the whole window, for the documentation: the same widgets, drawn without a screen."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from PySide6.QtCore import QCoreApplication

    from trunnion_gui.window import Window


def shoot(part: str | Path, picture: str | Path, *, prepare: Callable[..., None] | None = None, size: tuple[int, int] = (1600, 1000),
          factory: str = "", until: str = "verify", theme: str = "light", timeout_s: float = 300.0) -> None:
    """Open a part in a window, run up to a step, let `prepare(window)` arrange what is to be seen, and write the picture as PNG.

    Raises `TimeoutError` when the line takes longer than `timeout_s`.
    """
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    from PySide6.QtWidgets import QApplication

    from trunnion_gui import colours
    from trunnion_gui.window import Window
    from trunnion_gui.worker import ENGINE

    app = QApplication.instance() or QApplication(["trunnion"])
    window = Window(factory or ENGINE)
    window.confirms_closing = False
    try:
        window.use_theme(colours.theme(theme))
        window.resize(*size)
        window.centre.scene.smooth()
        window.show()
        window.document.open(str(part))
        _wait(app, lambda: not window.document.is_busy, timeout_s)
        if until:
            window.document.run(until, "Program")
            _wait(app, lambda: not window.document.is_busy, timeout_s)
        if prepare is not None:
            prepare(window)
        for _ in range(5):
            app.processEvents()
        window.grab().save(str(picture))
    finally:
        window.close()


def shoot_all(folder: str | Path) -> tuple[Path, ...]:
    """Write the pictures of the documentation into a folder: the sample part with its features, and programmed, light and dark."""
    from importlib.resources import as_file

    import trunnion_resources

    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    wanted = (("features", "route", "light", _show_feature), ("window", "verify", "light", _show_operation),
              ("window-dark", "verify", "dark", _show_operation))
    with as_file(trunnion_resources.sample("B1")) as part:
        for name, until, theme, prepare in wanted:
            shoot(part, folder / f"{name}.png", prepare=prepare, until=until, theme=theme)
    return tuple(folder / f"{name}.png" for name, *_ in wanted)


def _show_feature(window: Window) -> None:
    window.panels["blank"].fold(False)
    window.panels["route"].fold(False)
    recognition = window.document.session.recognition
    if recognition is not None:
        window.document.select_feature(recognition.of_kind("pocket")[0].id)


def _show_operation(window: Window) -> None:
    window.panels["recognize"].fold(True)
    window.panels["generate"].fold(False)
    process = window.document.session.process
    if process is not None:
        window.show_dock("process")
        window.document.select_operation(next(o.id for o in process.operations if o.kind.endswith("rough")))


def _wait(app: QCoreApplication, is_done: Callable[[], bool], timeout_s: float) -> None:
    end = time.monotonic() + timeout_s
    while not is_done():
        if time.monotonic() > end:
            raise TimeoutError(f"the window was not ready within {timeout_s:g} s")
        app.processEvents()
        time.sleep(0.01)
    app.processEvents()


if __name__ == "__main__":
    shoot_all(sys.argv[1] if len(sys.argv) > 1 else "docs/pictures")
