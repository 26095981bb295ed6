"""The plan library as the window has it: plans that match the part, and what a person adds and removes, which can be undone."""

from __future__ import annotations

import datetime
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from trunnion_gui.edits import ExternalEdit
from trunnion_gui.i18n import tr
from trunnion_gui.worker import library_requests
from trunnion_gui.worker.library_requests import LibraryChange, MatchRow

if TYPE_CHECKING:
    from trunnion_gui.document.document import Document


class Library(QObject):
    """The plans that match a document's part (`rows`), the `name` for a plan to be added, and the one that is `selected`."""

    changed = Signal()
    """There are other rows."""

    def __init__(self, document: Document) -> None:
        super().__init__(document)
        self._document = document
        self.rows: tuple[MatchRow, ...] = ()
        self.name = self.selected = ""

    @property
    def default_name(self) -> str:
        """The name that a plan gets where a person gives none: the part's."""
        part = self._document.session.part
        return part.name if part is not None else ""

    def can_add(self) -> bool:
        """Return whether there is a process that can be added now."""
        document = self._document
        return document.has_part and not document.is_busy and document.session.process is not None

    def can_remove(self) -> bool:
        """Return whether a plan is selected that can be removed now."""
        return not self._document.is_busy and any(r.name == self.selected for r in self.rows)

    def refresh(self) -> None:
        """Request the plans that match the shown part."""
        jobs = self._document.jobs
        jobs.forget(library_requests.matching)
        if self._document.has_part:
            jobs.query(library_requests.matching, self._document.shown, finish=self._take_rows)

    def add(self) -> None:
        """Add the process to the library: one entry of the history."""
        name = self.name.strip() or self.default_name
        label = tr("Add {name} to the library").format(name=name)
        self._document.request(
            library_requests.add,
            label,
            name,
            datetime.date.today().isoformat(),
            finish=lambda change: self._finish_added(label, change),
        )

    def remove(self) -> None:
        """Remove the selected plan from the library: one entry of the history."""
        label = tr("Remove {name} from the library").format(name=self.selected)
        self._document.request(
            library_requests.remove,
            label,
            self.selected,
            finish=lambda change: self._keep(
                label,
                change,
                ExternalEdit(library_requests.put_back, library_requests.take_out, change.plan),
            ),
        )

    def _finish_added(self, label: str, change: LibraryChange) -> None:
        edit = ExternalEdit(library_requests.take_out, library_requests.put_back, change.plan)
        self._keep(label, change, edit)
        for finding in change.findings:
            self._document.noticed.emit(finding)

    def _keep(self, label: str, change: LibraryChange, edit: ExternalEdit) -> None:
        self._document.keep(label, change.state, external=edit)
        self.refresh()

    def _take_rows(self, rows: tuple[MatchRow, ...]) -> None:
        self.rows = rows
        self.changed.emit()
