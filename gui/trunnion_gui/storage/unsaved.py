"""Work that was not saved is never lost without a word: a person is asked wherever the open part makes room for something else."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QObject, QTimer
from PySide6.QtWidgets import QMessageBox, QWidget

from trunnion_gui.document import Document
from trunnion_gui.i18n import tr

SAVE, DISCARD, CANCEL = (
    QMessageBox.StandardButton.Save,
    QMessageBox.StandardButton.Discard,
    QMessageBox.StandardButton.Cancel,
)
GoOn = Callable[[], None]
"""What was asked for and waits until the work is safe: opening another file, closing the window."""


class UnsavedWork(QObject):
    """Stands between a document's unsaved work and what would put it away."""

    def __init__(self, document: Document, save: Callable[[], None], window: QWidget) -> None:
        super().__init__(window)
        self._document, self._save, self._window = document, save, window
        self._waiting: GoOn | None = None
        self._saves_when_free = False
        self.confirms = True
        """Whether a person is there to be asked."""
        document.files.saved.connect(self._saved)
        document.jobs.changed.connect(self._job_ended)

    def holds(self, go_on: GoOn) -> bool:
        """Return whether there is unsaved work that a person does not give up: then `go_on` is called once it is saved, or never."""
        if not (self.confirms and self._document.has_unsaved_work):
            return False
        decision = self.confirm()
        if decision == SAVE:
            self._waiting = go_on
            self._save_soon()
        return decision != DISCARD

    def confirm(self) -> QMessageBox.StandardButton:
        """Ask what shall become of the work: `SAVE`, `DISCARD` or `CANCEL`. Tests answer in a person's place."""
        job, box = self._document.jobs.job, QMessageBox(self._window)
        box.setWindowTitle("Trunnion")
        box.setIcon(QMessageBox.Icon.Warning)
        box.setText(tr("Save the changes to {name}?").format(name=self._document.files.name))
        running = (
            tr("{job} still runs and is cancelled.").format(job=job.label) + " "
            if job is not None
            else ""
        )
        box.setInformativeText(running + tr("They are lost if you discard them."))
        box.setStandardButtons(SAVE | DISCARD | CANCEL)
        for button, words in ((SAVE, tr("Save")), (DISCARD, tr("Discard")), (CANCEL, tr("Cancel"))):
            box.button(button).setText(words)
        box.setDefaultButton(SAVE)
        box.setEscapeButton(CANCEL)
        return QMessageBox.StandardButton(box.exec())

    def _save_soon(self) -> None:
        """Save, after the running job has stopped; a person who chooses no file keeps everything as it is."""
        self._saves_when_free = self._document.is_busy
        if self._saves_when_free:
            self._document.jobs.cancel()
            return
        self._save()
        if not self._document.is_busy:
            self._waiting = None

    def _job_ended(self) -> None:
        if self._document.is_busy:
            return
        if self._saves_when_free:
            self._save_soon()
        else:
            self._waiting = None  # what was to be saved could not be: the message says why

    def _saved(self, _path: str) -> None:
        go_on, self._waiting = self._waiting, None
        if go_on is not None:
            QTimer.singleShot(0, go_on)
