"""Starts the window."""

from __future__ import annotations

import multiprocessing
import sys
from collections.abc import Sequence
from typing import NoReturn

from trunnion.findings import TrunnionError
from trunnion_gui.display import check_display


def main(arguments: Sequence[str] | None = None) -> int:
    """Open the window, with the part or project given as first argument, and return the exit code."""
    multiprocessing.freeze_support()
    check_display()
    from PySide6.QtCore import Qt
    from PySide6.QtGui import QGuiApplication
    from PySide6.QtWidgets import QApplication

    from trunnion_gui import i18n
    from trunnion_gui.gc_control import GcControl
    from trunnion_gui.storage import preferences
    from trunnion_gui.window import Window

    words = list(sys.argv[1:] if arguments is None else arguments)
    QGuiApplication.setHighDpiScaleFactorRoundingPolicy(
        Qt.HighDpiScaleFactorRoundingPolicy.PassThrough
    )
    app = QApplication.instance() or QApplication(["trunnion"])
    app.setApplicationName("Trunnion")
    app.setOrganizationName("Trunnion")
    i18n.use(preferences.language())
    gc_control = GcControl()
    window = Window()
    gc_control.keep()
    window.show()
    if words:
        window.document.files.open(words[0])
    try:
        return QApplication.exec()
    finally:
        gc_control.stop()


def run() -> NoReturn:
    """Run the window as a program of its own: what stops it is one line and exit code 2, as on the command line."""
    try:
        sys.exit(main())
    except TrunnionError as reason:
        print(f"trunnion-gui: {reason}", file=sys.stderr)  # noqa: T201
        sys.exit(2)


if __name__ == "__main__":
    run()
