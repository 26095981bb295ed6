"""The guide lines of the selected operation, requested from the worker when somebody looks at them."""

from __future__ import annotations

from PySide6.QtCore import QObject, Signal

from trunnion.model.guides import OperationGuides
from trunnion_gui.document import Document
from trunnion_gui.worker.worker import Reply

NONE = OperationGuides(operation="")


class GuideSource(QObject):
    """Keeps the guides in step with the plan and the selection while they are switched on."""

    arrived = Signal(object)
    """Other `OperationGuides`."""

    def __init__(self, document: Document, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._document = document
        self.is_on = False
        self.shown = NONE
        self._of: tuple[object, str] = (None, "")
        self._requested = 0
        document.jobs.worker.replied.connect(self._receive)
        document.jobs.worker.restarted.connect(self._restart)
        document.changed.connect(self._follow)
        document.jobs.changed.connect(self._follow)
        document.selection.changed.connect(self._follow)

    def switch(self, on: bool) -> None:
        """Show the guides, or not."""
        self.is_on = on
        self._restart()

    def _restart(self) -> None:
        self._requested, self._of = 0, (None, "")
        self._show(NONE)
        self._follow()

    def _follow(self, *_: object) -> None:
        selected, process = self._document.selection.current, self._document.session.process
        id = selected.id if selected.kind == "operation" and self.is_on else ""
        if self._document.is_busy or (self._of[0] is process and self._of[1] == id):
            return
        self._of, self._requested = (process, id), 0
        self._show(NONE)
        if id and process is not None:
            self._requested = self._document.jobs.worker.send("guides", self._document.session, id)

    def _receive(self, reply: Reply) -> None:
        if not reply.is_last or reply.number != self._requested:
            return
        self._requested = 0
        if reply.kind == "failed":
            self._document.notice(reply.text)
        if reply.kind == "done":
            self._show(reply.value)
            if reply.value.refused:
                self._document.notice(reply.value.refused)

    def _show(self, guides: OperationGuides) -> None:
        if guides is not self.shown:
            self.shown = guides
            self.arrived.emit(guides)
