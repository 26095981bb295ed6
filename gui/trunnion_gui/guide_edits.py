"""Operations led by other faces: what the menu on faces offers for it, and the requests to the worker."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from PySide6.QtCore import QObject
from PySide6.QtWidgets import QMenu

from trunnion.model.operation import Operation
from trunnion_gui.document import Document
from trunnion_gui.i18n import tr
from trunnion_gui.look import icons
from trunnion_gui.look.words import faces_named
from trunnion_gui.worker import guide_requests
from trunnion_gui.worker.requests import SessionState


class GuideEdits(QObject):
    """Changes of what leads operations, by clicking on faces; each is one entry of the history."""

    def __init__(self, document: Document) -> None:
        super().__init__(document)
        self._document = document

    def add_face_entries(self, menu: QMenu, tags: tuple[int, ...], operation: str) -> None:
        """Add to a menu how some faces may lead operations: the one that was selected, or all that machine the features they are of."""
        found = self._document.operation(operation)
        led = [found] if found is not None else self._operations(tags)
        into = [(o, tuple(t for t in tags if t not in o.faces)) for o in led]
        out = [(o, tuple(t for t in tags if t in o.faces)) for o in led]
        self._add(menu, tr("Lead along"), self.lead_along, into, found)
        self._add(menu, tr("Leave out of"), self.leave_out, out, found)

    def lead_along(self, id: str, tags: tuple[int, ...]) -> None:
        """Lead an operation along faces too."""
        label = tr("Lead {id} along face {faces}").format(id=id, faces=faces_named(tags))
        self._change(label, id, tags, ())

    def leave_out(self, id: str, tags: tuple[int, ...]) -> None:
        """Lead an operation along its other faces only."""
        label = tr("Leave face {faces} out of {id}").format(id=id, faces=faces_named(tags))
        self._change(label, id, (), tags)

    def _add(
        self,
        menu: QMenu,
        title: str,
        change: Callable[[str, tuple[int, ...]], None],
        entries: Sequence[tuple[Operation, tuple[int, ...]]],
        selected: Operation | None,
    ) -> None:
        given = [(o, tags) for o, tags in entries if tags]
        if not given:
            return
        if selected is None:
            menu = menu.addMenu(icons.icon("guides"), title)
        for o, tags in given:
            text = o.id if selected is None else f"{title}: {o.id}"
            menu.addAction(text, partial(change, o.id, tags))

    def _operations(self, tags: tuple[int, ...]) -> list[Operation]:
        """Return the operations that finish some of the faces, or other faces of the features that they are of."""
        shown = self._document.shown
        owners = {f.id for f in shown.recognition or () if set(f.tags) & set(tags)}
        return [
            o
            for o in (shown.process.operations if shown.process else ())
            if o.faces and (set(o.faces) & set(tags) or owners.intersection(o.all_features))
        ]

    def _change(
        self, label: str, id: str, along: tuple[int, ...], leave_out: tuple[int, ...]
    ) -> None:
        def keep(state: SessionState) -> None:
            self._document.keep(label, state)
            self._document.selection.select_operation(id)

        self._document.request(guide_requests.lead, label, id, along, leave_out, finish=keep)
