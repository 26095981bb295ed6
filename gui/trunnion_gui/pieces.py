"""Long work of the window's own thread in pieces, between which the event loop takes up other events."""

from __future__ import annotations

import time
from collections.abc import Iterator

from PySide6.QtCore import QObject, QTimer

STRETCH_S = 0.03
"""s of the thread's own time after which the event loop has its turn: two frames of a screen."""


class PieceExecution(QObject):
    """Does the pieces of one work: as many as a stretch has time for at once, the others in later events."""

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._pieces: Iterator[None] = iter(())
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.timeout.connect(self._go_on)

    @property
    def is_running(self) -> bool:
        """Whether pieces are left."""
        return self._timer.isActive()

    def begin(self, pieces: Iterator[None]) -> None:
        """Begin another work, which goes from one piece to the next at every `yield`; what is left of the one before is dropped."""
        self._pieces = pieces
        self._go_on()

    def stop(self) -> None:
        """Drop what is left."""
        self._timer.stop()
        self._pieces = iter(())

    def _go_on(self) -> None:
        self._timer.stop()
        end = time.thread_time() + STRETCH_S
        for _ in self._pieces:
            if time.thread_time() > end:
                self._timer.start(0)
                return
