"""Files that a person drags from another program and drops on a widget."""

from __future__ import annotations

from PySide6.QtGui import QDragEnterEvent, QDropEvent


def accept_files(event: QDragEnterEvent) -> None:
    """Let a drag in that has files."""
    if event.mimeData().hasUrls():
        event.acceptProposedAction()


def dropped_file(event: QDropEvent) -> str:
    """Return the path of the first file that is dropped and take the drop; nothing where there is none on this computer."""
    paths = [u.toLocalFile() for u in event.mimeData().urls() if u.isLocalFile()]
    if not paths:
        return ""
    event.acceptProposedAction()
    return paths[0]
