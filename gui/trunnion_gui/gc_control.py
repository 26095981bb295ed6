"""Garbage is collected in the window's own thread: collected by one that waits for the worker, it would take widgets apart there."""

from __future__ import annotations

import gc

from PySide6.QtCore import QObject, QTimer

OFTEN = 1000
"""ms between two looks at how much there is."""


class GcControl(QObject):
    """Collects in the thread that it lives in, and nowhere else, until `stop`."""

    def __init__(self) -> None:
        super().__init__()
        gc.disable()
        self.keep()
        self._timer = QTimer(self)
        self._timer.timeout.connect(self.look)
        self._timer.start(OFTEN)

    def keep(self) -> None:
        """Look through what there is now in no later collection: modules, the window. It takes most of the time of a full one."""
        gc.freeze()

    def look(self) -> None:
        """Collect the generations that have grown past the interpreter's own thresholds."""
        for generation in (2, 1, 0):
            if gc.get_count()[generation] > gc.get_threshold()[generation]:
                gc.collect(generation)
                return

    def stop(self) -> None:
        """Leave it to the interpreter again."""
        self._timer.stop()
        gc.unfreeze()
        gc.enable()
