"""The time of finishing by area rates, requested from the worker whenever the plan of a curved part is another one."""

from __future__ import annotations

from PySide6.QtCore import QObject, Signal

from trunnion.model.session import Session
from trunnion_gui.document import Document
from trunnion_gui.families.surface import requests
from trunnion_gui.families.surface.groups import GROUP
from trunnion_gui.worker.worker import Reply


class EstimateSource(QObject):
    """Keeps the estimate in step with the session; requests only while no job runs, and only of parts with groups of patches."""

    arrived = Signal(object)
    """Another `EstimatedTimes`, or None."""

    def __init__(self, document: Document) -> None:
        super().__init__(document)
        self._document = document
        self.shown: requests.EstimatedTimes | None = None
        self._source: tuple[object, object] = (None, None)
        self._requested = 0
        document.jobs.worker.replied.connect(self._receive)
        document.jobs.worker.restarted.connect(self._restart)
        document.changed.connect(self._follow)
        document.jobs.changed.connect(self._follow)

    def _restart(self) -> None:
        self._requested, self._source = 0, (None, None)

    def _follow(self) -> None:
        session = self._document.session
        source = (session.process, session.paths)
        if self._document.is_busy or all(a is b for a, b in zip(source, self._source, strict=True)):
            return
        self._source, self._requested = source, 0
        if _has_areas(session):
            self._requested = self._document.jobs.worker.send(requests.estimate, session)
        else:
            self._show(None)

    def _receive(self, reply: Reply) -> None:
        if reply.is_last and reply.number == self._requested:
            self._requested = 0
            self._show(reply.value if reply.kind == "done" else None)

    def _show(self, found: requests.EstimatedTimes | None) -> None:
        if found is not self.shown:
            self.shown = found
            self.arrived.emit(found)


def _has_areas(session: Session) -> bool:
    return (
        session.process is not None
        and session.recognition is not None
        and bool(session.recognition.of_kind(GROUP))
    )
