"""Nothing is lost: work in progress is kept in a file of its own, and offered when a program ended without saving."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from PySide6.QtCore import QObject, QTimer

from trunnion.findings import Finding, Severity
from trunnion_gui import remembered
from trunnion_gui.document import Document
from trunnion_gui.i18n import tr
from trunnion_gui.widgets.notice import Notice

_AUTOSAVE_MS = 20_000


class Recovery(QObject):
    """Keeps a document's session a while after it changed."""

    def __init__(self, document: Document, parent: QObject) -> None:
        super().__init__(parent)
        self._document = document
        self._soon = QTimer(self)
        self._soon.setSingleShot(True)
        self._soon.setInterval(_AUTOSAVE_MS)
        self._soon.timeout.connect(lambda: document.autosave(remembered.autosave_file()))
        document.changed.connect(self._changed)
        document.job_changed.connect(self._changed)

    def end(self) -> None:
        """Keep nothing any more."""
        self._soon.stop()

    def offer(self, notice: Notice) -> None:
        """Offer what an earlier program left behind, if there is something."""
        left = remembered.left_behind()
        if left is not None:
            finding = Finding(severity=Severity.INFO, code="window", text=tr("The last session ended without being saved"),
                              remedy=tr("take it up where it ended, or throw it away"))
            notice.tell(finding, {tr("Recover"): partial(self._recover, left), tr("Discard"): left.unlink})

    def _changed(self) -> None:
        if self._document.history.is_dirty and self._document.has_part and not self._document.is_busy:
            self._soon.start()

    def _recover(self, left: Path) -> None:
        """Take up a session that was left behind; its file goes once the session is kept in one of our own."""

        def keep() -> None:
            if self._document.has_part:
                self._document.opened.disconnect(keep)
                left.replace(remembered.autosave_file())

        self._document.opened.connect(keep)
        self._document.open(left, is_recovery=True)
