"""Requests of the window to the worker for curved parts, and the handling of their replies."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QObject, Signal

from trunnion.geometry.cut import Cut
from trunnion_gui.document import Document
from trunnion_gui.families.surface import requests
from trunnion_gui.i18n import tr
from trunnion_gui.worker.requests import Work

_MOST_NAMED = 3
"""Faces that a label names at most."""


class PatchJobs(QObject):
    """Jobs on faces and groups of faces; each edit of them is one entry of the history."""

    measured = Signal(object)
    """An `Accuracy` of the part's patches."""

    def __init__(self, document: Document) -> None:
        super().__init__(document)
        self._document = document

    def cut(self, cut: Cut) -> None:
        """Cut a face in two; features are found anew where they had been found."""
        self._change(requests.cut, tr("Cut face {n}").format(n=cut.face), cut)

    def take_back(self, number: int) -> None:
        """Take one of the cuts back, counted from 0."""
        cuts = self._document.session.cuts
        if number < len(cuts):
            self._change(
                requests.uncut, tr("Join face {n} again").format(n=cuts[number].face), number
            )

    def move(self, faces: tuple[int, ...], group: str = "") -> None:
        """Move faces to a group by its id, or to a new one."""
        if faces:
            words = ", ".join(map(str, faces[:_MOST_NAMED])) + (
                "…" if len(faces) > _MOST_NAMED else ""
            )
            label = tr("Move face {faces} to {group}").format(
                faces=words, group=group or tr("a new group")
            )
            self._document.request(
                requests.move,
                label,
                faces,
                group,
                finish=lambda state: self._document.keep(label, state),
            )

    def measure(self) -> None:
        """Measure how exact the patches' feature sizes are by the number of points on their edges."""
        self._document.request(
            requests.accuracy, tr("measuring patches"), finish=self.measured.emit
        )

    def export(self, what: tuple[str, ...], path: str) -> None:
        """Write patches as IGES or STEP by the path's suffix: `local`, `remaining`, or groups by their ids."""
        self._document.request(
            requests.export,
            tr("exporting {name}").format(name=Path(path).name),
            what,
            path,
            finish=lambda n: self._document.reported.emit(
                tr("{n} faces written to {path}").format(n=n, path=path)
            ),
        )

    def _change(self, work: Work, label: str, wanted: Cut | int) -> None:
        """Change the faces of the part."""
        self._document.request(
            work,
            label,
            wanted,
            finish=lambda found: self._document.keep(label, found.state, found.drawing),
        )
