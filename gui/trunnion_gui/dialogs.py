"""Which files and folders a person is asked for; tests answer in a person's place."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtWidgets import QFileDialog, QWidget

from trunnion_gui.document import PROJECT, Document
from trunnion_gui.i18n import tr

PART_FILES = "STEP, IGES, Trunnion (*.step *.stp *.stpz *.igs *.iges *.trunnion)"
REVISED_FILES = "STEP, IGES (*.step *.stp *.stpz *.igs *.iges)"


class FileDialogs:
    """Dialogs over a window; each returns a path, empty when nothing was chosen."""

    def __init__(self, document: Document, window: QWidget) -> None:
        self._document, self._window = document, window

    def open_path(self) -> str:
        """Ask which file to open."""
        return QFileDialog.getOpenFileName(
            self._window, tr("Open a part or a project"), "", PART_FILES
        )[0]

    def revised_path(self) -> str:
        """Ask which revised part file to take up."""
        return QFileDialog.getOpenFileName(
            self._window,
            tr("Take up a revised part"),
            str(Path(self._document.files.path).parent),
            REVISED_FILES,
        )[0]

    def save_path(self) -> str:
        """Ask where to save the project."""
        part = self._document.session.part
        proposed = str(Path(self._document.files.path).with_suffix(PROJECT)) if part else ""
        return QFileDialog.getSaveFileName(
            self._window, tr("Save the project"), proposed, f"Trunnion (*{PROJECT})"
        )[0]

    def folder(self) -> str:
        """Ask which folder the programs are written to."""
        return QFileDialog.getExistingDirectory(self._window, tr("Write programs into"))

    def picture_path(self) -> str:
        """Ask where to keep a picture."""
        return QFileDialog.getSaveFileName(self._window, tr("Save the picture"), "", "PNG (*.png)")[
            0
        ]
