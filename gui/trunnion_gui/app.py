"""Starts the window."""

from __future__ import annotations

import multiprocessing
import sys
from collections.abc import Sequence


def main(arguments: Sequence[str] | None = None) -> int:
    """Open the window, with the part or project given as first argument, and return the exit code."""
    multiprocessing.freeze_support()
    from PySide6.QtCore import Qt
    from PySide6.QtGui import QGuiApplication
    from PySide6.QtWidgets import QApplication

    from trunnion_gui import i18n, remembered
    from trunnion_gui.window import Window

    words = list(sys.argv[1:] if arguments is None else arguments)
    QGuiApplication.setHighDpiScaleFactorRoundingPolicy(Qt.HighDpiScaleFactorRoundingPolicy.PassThrough)
    app = QApplication.instance() or QApplication(["trunnion"])
    app.setApplicationName("Trunnion")
    app.setOrganizationName("Trunnion")
    i18n.use(remembered.language())
    window = Window()
    window.show()
    if words:
        window.document.open(words[0])
    return QApplication.exec()


if __name__ == "__main__":
    sys.exit(main())
