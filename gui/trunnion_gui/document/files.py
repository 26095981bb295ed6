"""Files of a document: parts and projects that are opened, the project that is saved, programs that are written."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from trunnion_gui.i18n import tr
from trunnion_gui.worker.requests import OpenedSession

if TYPE_CHECKING:
    from trunnion_gui.document.document import Document

PROJECT = ".trunnion"


class Files(QObject):
    """Where a document's part and project came from and go to."""

    opened = Signal(str)
    saved = Signal(str)
    written = Signal(object)
    """The folder and the names of the files written there."""

    def __init__(self, document: Document) -> None:
        super().__init__(document)
        self._document, self._jobs = document, document.jobs
        self.path = ""
        """The part's file."""
        self.project = ""
        """The project file, empty while there is none."""
        self.kept = (b"", "")
        """The part file's bytes and suffix, as they go into a project file."""
        self.holds_work: Callable[[Callable[[], None]], bool] = lambda go_on: False
        """Asked before another part is opened: whether unsaved work stands in the way. It then calls what it is given later, or never."""

    @property
    def name(self) -> str:
        """The file's name that a person knows the work by: the project's, or the part's while there is none."""
        return Path(self.project or self.path).name

    def open(self, path: str | Path, solid: int | None = None) -> None:
        """Open a part or a project file, after a person was asked about unsaved work."""
        file = str(path)
        self._open(
            tr("opening {name}").format(name=Path(path).name),
            file,
            solid,
            lambda found: self._install(found, file, file if file.endswith(PROJECT) else ""),
        )

    def revise(self, path: str | Path) -> None:
        """Take up a revised part file in place of the part, with what was done by hand, after a person was asked about unsaved work."""

        def go_on() -> None:
            if self._document.is_ready():
                self._jobs.start(
                    "revise",
                    tr("taking up {name}").format(name=Path(path).name),
                    self._document.session,
                    str(path),
                    finish=lambda found: self._install(found, str(path), "", is_saved=False),
                )

        if self._document.is_ready() and not self.holds_work(go_on):
            go_on()

    def recover(self, path: str | Path, project: str) -> None:
        """Take up work from an autosave; it belongs to a project file (empty: none yet) and still has to be saved there."""

        def install(found: OpenedSession) -> None:
            part = found.state.session.part
            self._install(
                found, part.path if part is not None else str(path), project, is_saved=False
            )

        self._open(
            tr("recovering {name}").format(name=Path(project or path).name),
            str(path),
            None,
            install,
        )

    def save(self, path: str | Path) -> None:
        """Write the project file."""
        if self._document.is_ready():
            label = tr("saving {name}").format(name=Path(path).name)
            self._jobs.start("save", label, self._document.session, str(path), finish=self._saved)

    def write(self, folder: str | Path) -> None:
        """Write programs, tool list, XML and report into a folder."""
        if self._document.is_ready():
            self._jobs.start(
                "write",
                tr("writing files"),
                self._document.session,
                str(folder),
                finish=lambda names: self._written(str(folder), names),
            )

    def _open(
        self, label: str, path: str, solid: int | None, finish: Callable[[OpenedSession], None]
    ) -> None:
        def go_on() -> None:
            if self._jobs.is_free():
                self._jobs.start("open", label, path, solid, finish=finish)

        if self._jobs.is_free() and not self.holds_work(go_on):
            go_on()

    def _install(
        self, found: OpenedSession, path: str, project: str, is_saved: bool = True
    ) -> None:
        self.path, self.project, self.kept = path, project, found.kept
        self._document.install(found.state, found.drawing, is_saved)
        self.opened.emit(path)

    def _saved(self, path: str) -> None:
        self.project = path
        self._document.history.mark_saved(self._document.session)
        self.saved.emit(path)
        self._document.changed.emit()

    def _written(self, folder: str, names: Sequence[str]) -> None:
        """Name the files that must not run, which a person may have expected under other names."""
        self.written.emit((folder, names))
        rejected = [name for name in names if ".REJECTED." in name]
        if rejected:
            self._document.notice(
                tr("The proof failed, so the programs are {files}").format(
                    files=", ".join(rejected)
                ),
                tr("they must not run; see the messages for what the proof found"),
            )
