"""What the middle shows while no part is open: how to begin."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from trunnion_gui.actions import Registry
from trunnion_gui.document import Document
from trunnion_gui.i18n import tr
from trunnion_gui.widgets.layout import empty
from trunnion_gui.widgets.panel import rule

_WIDTH = 430


class Welcome(QFrame):
    """A card: drop a file, open one, or take one of the last."""

    def __init__(self, document: Document, registry: Registry, parent: QWidget) -> None:
        super().__init__(parent)
        self.setObjectName("card")
        self._document = document
        self._registry = registry
        self.setFixedWidth(_WIDTH)
        column = QVBoxLayout(self)
        column.setContentsMargins(28, 26, 28, 22)
        column.setSpacing(10)
        title = QLabel(tr("Drop a part here"))
        words = QLabel(
            tr(
                "STEP or IGES, or a Trunnion project. Then press Program: features, route, toolpaths and proof follow."
            )
        )
        title.setObjectName("welcome")
        words.setObjectName("muted")
        words.setWordWrap(True)
        column.addWidget(title)
        column.addWidget(words)
        row = QHBoxLayout()
        row.addWidget(self._button("file.open", "primary"))
        row.addWidget(self._button("file.sample", ""))
        row.addStretch(1)
        column.addLayout(row)
        self._recent = QVBoxLayout()
        self._recent.setSpacing(2)
        column.addLayout(self._recent)

    def show_recent(self, paths: Sequence[str]) -> None:
        """List the files opened last."""
        empty(self._recent)
        if paths:
            self._recent.addWidget(rule())
        for path in paths[:4]:
            button = QPushButton(Path(path).name)
            button.setObjectName("link")
            button.setToolTip(path)
            button.setCursor(Qt.CursorShape.PointingHandCursor)
            button.clicked.connect(lambda _=False, p=path: self._document.files.open(p))
            self._recent.addWidget(button)
        self.adjustSize()

    def _button(self, command: str, name: str) -> QPushButton:
        action = self._registry.action(command)
        button = QPushButton(action.text())
        button.setObjectName(name)
        button.clicked.connect(action.trigger)
        return button
