"""The neutral listing of motions of the selected operation: what the proof reads, in words."""

from __future__ import annotations

from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QPlainTextEdit

from trunnion.model.motion.program import Program, section_of
from trunnion.model.session import Session
from trunnion_gui.document import Document
from trunnion_gui.i18n import tr


class ListingDock(QPlainTextEdit):
    """One operation's motions."""

    def __init__(self, document: Document) -> None:
        super().__init__()
        self._document = document
        self._shown: object = None
        self.setObjectName("code")
        self.setReadOnly(True)
        self.setLineWrapMode(QPlainTextEdit.LineWrapMode.NoWrap)
        self.setPlaceholderText(tr("Select an operation that has a toolpath."))
        document.changed.connect(self.refresh)
        document.selection.changed.connect(lambda _: self.refresh())

    def refresh(self) -> None:
        """Show the selected operation's motions, if anybody looks."""
        selected, session = self._document.selection.current, self._document.shown
        path = session.path_of(selected.id) if selected.kind == "operation" else None
        if not self.isVisible() or path is self._shown:
            return
        self._shown = path
        self.setPlainText(operation_listing(session, selected.id) if path is not None else "")

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self.refresh()


def operation_listing(session: Session, id: str) -> str:
    """Return the listing of one operation of a session that has its toolpath."""
    from trunnion.model.motion.listing import listing

    path, tree = session.path_of(id), session.process
    if path is None or tree is None:
        return ""
    o = tree.operation(id)
    return listing(
        Program(
            name=id, setup=tree.setup(o.setup), sections=(section_of(o, path.path, path.guides),)
        )
    )
