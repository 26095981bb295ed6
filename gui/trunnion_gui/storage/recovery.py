"""Nothing is lost: work in progress is kept in a file of its own, and offered when a program ended without saving.

What is kept is what the window shows: an edit, and every step that a run has finished. At most five seconds of work, or ten edits, are not
in the file yet; it goes when the work is saved, given up, or undone as far as it was saved.
"""

from __future__ import annotations

from datetime import datetime
from functools import partial
from pathlib import Path

from PySide6.QtCore import QObject, QTimer, Signal

from trunnion.findings import Finding, Severity
from trunnion.model.session import Session
from trunnion_gui.document import Document
from trunnion_gui.i18n import tr
from trunnion_gui.storage import preferences
from trunnion_gui.storage.autosave import Autosave, AutosaveOwner, autosave_owner, remove, take_over
from trunnion_gui.widgets.notice import Notice

LATEST_MS = 4000
"""ms from the first change that is not kept until it is; writing the file has a second more."""
MOST_EDITS = 10


class Recovery(QObject):
    """Keeps a document's work a little after it changed, and takes up what an earlier program left."""

    _failed = Signal(str)

    def __init__(self, document: Document, notice: Notice, parent: QObject) -> None:
        super().__init__(parent)
        self._document, self._notice = document, notice
        self._seen: Session = document.shown
        self._is_kept, self._edits = False, 0
        self.file = Autosave(preferences.autosave_file(), self._failed.emit)
        self._soon = QTimer(self)
        self._soon.setSingleShot(True)
        self._soon.setInterval(LATEST_MS)
        self._soon.timeout.connect(self.keep)
        self._failed.connect(self._report)
        document.changed.connect(self._changed)
        document.files.saved.connect(lambda _: self._changed())
        document.files.opened.connect(lambda _: self._changed())

    def end(self) -> None:
        """Keep nothing any more: the work was saved or given up."""
        self._soon.stop()
        self.file.end()

    def keep(self) -> None:
        """Keep what is shown now."""
        self._soon.stop()
        document, self._edits, self._is_kept = self._document, 0, True
        part = document.shown.part
        time = datetime.now().isoformat(timespec="seconds")
        owner = AutosaveOwner(
            project=document.files.project, part=part.path if part else "", time=time
        )
        self.file.keep(document.shown, *document.files.kept, owner)

    def offer(self) -> None:
        """Offer what an earlier program left behind, if there is something; the next one when a person throws it away."""
        leftover = preferences.leftover_file()
        if leftover is not None:
            owner = autosave_owner(leftover)
            day, _, clock = owner.time.partition("T")
            text = tr(
                "{name} was not saved when the program ended; its work was kept on {day} at {time}"
            ).format(name=owner.name or tr("A part"), day=day, time=clock)
            finding = Finding(
                severity=Severity.INFO,
                code="window",
                text=text,
                remedy=tr("take it up where it ended, or throw it away"),
            )
            self._notice.show_finding(
                finding,
                {
                    tr("Recover"): partial(self._recover, leftover),
                    tr("Discard"): partial(self._discard, leftover),
                },
            )

    def _changed(self) -> None:
        document = self._document
        if not document.has_unsaved_work:
            self._forget()
        elif document.shown is not self._seen:
            self._edits += 1
            if self._edits >= MOST_EDITS:
                self.keep()
            elif (
                not self._soon.isActive()
            ):  # never begun anew: steady work would put it off for ever
                self._soon.start()
        self._seen = document.shown

    def _forget(self) -> None:
        self._soon.stop()
        self._edits = 0
        if self._is_kept:
            self._is_kept = False
            self.file.forget()

    def _recover(self, leftover: Path) -> None:
        """Take up work that was left behind; its file becomes this program's own until the work is saved."""

        def taken(_path: str) -> None:
            self._document.files.opened.disconnect(taken)
            take_over(leftover, preferences.autosave_file())
            self._is_kept = True

        self._document.files.opened.connect(taken)
        self._document.files.recover(leftover, autosave_owner(leftover).project)

    def _discard(self, leftover: Path) -> None:
        remove(leftover)
        self.offer()

    def _report(self, reason: str) -> None:
        self._document.notice(
            tr("Your work is not kept for recovery: {reason}").format(reason=reason),
            tr("save the project yourself (Ctrl+S), or make room"),
            severity=Severity.WARNING,
        )
