"""The deviation map of the shown verdict, requested from the worker when somebody looks at it."""

from __future__ import annotations

from PySide6.QtCore import QObject, Signal

from trunnion_gui.document import Document
from trunnion_gui.worker.drawing import DrawnMap
from trunnion_gui.worker.worker import Reply


class DeviationSource(QObject):
    """Keeps the map in step with the session while it is switched on."""

    arrived = Signal(object)
    """Another `DrawnMap`, or None."""

    def __init__(self, document: Document, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._document = document
        self.is_on = False
        self.shown: DrawnMap | None = None
        self._verdict: object = None
        self._requested = 0
        document.jobs.worker.replied.connect(self._receive)
        document.jobs.worker.restarted.connect(self._restart)
        document.changed.connect(self._follow)
        document.jobs.changed.connect(self._follow)

    @property
    def can_show(self) -> bool:
        """Whether there is a verdict, and the worker is free."""
        return not self._document.is_busy and self._document.session.verdict is not None

    def switch(self, on: bool) -> None:
        """Show the map, or not."""
        self.is_on = on
        self._follow()
        self.arrived.emit(self.shown if on else None)

    def _restart(self) -> None:
        self._requested, self._verdict = 0, None
        self._follow()

    def _follow(self) -> None:
        verdict = self._document.session.verdict
        if not self.is_on or self._document.is_busy or verdict is self._verdict:
            return
        self._verdict, self.shown, self._requested = verdict, None, 0
        self.arrived.emit(None)
        if verdict is not None:
            self._requested = self._document.jobs.worker.send("deviation", self._document.session)

    def _receive(self, reply: Reply) -> None:
        if not reply.is_last or reply.number != self._requested:
            return
        self._requested = 0
        if reply.kind == "failed":
            self._document.notice(reply.text)
        if reply.kind == "done":
            self.shown = reply.value
            if self.is_on:
                self.arrived.emit(self.shown)
