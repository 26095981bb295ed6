"""Pictures of the whole window, for the documentation: the same widgets, drawn without a screen."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from PySide6.QtCore import QCoreApplication


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


def _wait(app: QCoreApplication, is_done: Callable[[], bool], timeout_s: float) -> None:
    end = time.monotonic() + timeout_s
    while not is_done():
        if time.monotonic() > end:
            raise TimeoutError(f"the window was not ready within {timeout_s:g} s")
        app.processEvents()
        time.sleep(0.01)
    app.processEvents()
