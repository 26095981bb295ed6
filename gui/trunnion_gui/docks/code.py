"""The written programs, one a setup and dialect, with their words in colour."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QLabel, QVBoxLayout, QWidget

from trunnion.model.session import PostedFile
from trunnion_gui.document import Document
from trunnion_gui.i18n import tr
from trunnion_gui.look.colours import Theme
from trunnion_gui.look.words import grouped
from trunnion_gui.widgets.code import CodeView


class CodeDock(QWidget):
    """The text of the chosen program; filled when it is looked at."""

    line_picked = Signal(str, int)
    """A clicked line: the suffix of the file it stands in, and its number from 1."""

    def __init__(self, document: Document) -> None:
        super().__init__()
        self._document = document
        self._shown: tuple[PostedFile, ...] = ()
        self._at = ("", 0)
        self.choice = QComboBox()
        self.choice.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToContents)
        self.choice.setMinimumContentsLength(18)
        self.lines = QLabel()
        self.lines.setObjectName("muted")
        self.stale = QLabel(
            tr(
                "stale: this is the program of the plan before its last change; verify to write it anew"
            )
        )
        self.stale.setProperty("verdict", "warning")
        self.stale.setWordWrap(True)
        self.stale.hide()
        self.text = CodeView()
        self.text.setPlaceholderText(
            tr("The program appears here when it has been generated and verified.")
        )
        top = QHBoxLayout()
        top.setContentsMargins(10, 6, 10, 0)
        top.addWidget(self.choice)
        top.addWidget(self.lines)
        top.addWidget(self.stale, 1)
        top.addStretch(0)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(2)
        column.addLayout(top)
        column.addWidget(self.text)
        self.choice.currentIndexChanged.connect(self._read)
        self.text.clicked.connect(self._choose)
        document.changed.connect(self.refresh)

    def use_theme(self, theme: Theme) -> None:
        """Draw in the colours of a theme."""
        self.text.use_theme(theme)

    def show_line(self, suffix: str, line: int) -> None:
        """Mark the line of a file that is being played, if anybody looks; line 0 marks none."""
        self._at = (suffix, line)
        if not self.isVisible():
            return
        rows = [n for n, file in enumerate(self._shown) if file.suffix == suffix]
        if line and rows and self.choice.currentIndex() != rows[0]:
            self.choice.setCurrentIndex(rows[0])
        self.text.mark(line if rows else 0)

    def refresh(self) -> None:
        """Show the programs of the shown session, if anybody looks."""
        session = self._document.shown
        self.stale.setVisible(
            bool(session.posted) and self._document.states.get("verify") not in ("done", "problem")
        )
        posted = self._document.programs if session.posted else ()
        if not self.isVisible() or posted == self._shown:
            return
        self._shown = posted
        self.choice.blockSignals(True)
        self.choice.clear()
        for file in posted:
            self.choice.addItem(f"{file.suffix}  {file.dialect}")
        self.choice.blockSignals(False)
        self.choice.setVisible(bool(posted))
        self._read()

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self.refresh()
        self.show_line(*self._at)

    def _choose(self, line: int) -> None:
        row = self.choice.currentIndex()
        if 0 <= row < len(self._shown):
            self.line_picked.emit(self._shown[row].suffix, line)

    def _read(self) -> None:
        row = self.choice.currentIndex()
        text = self._shown[row].text if 0 <= row < len(self._shown) else ""
        self.text.show_text(text)
        self.lines.setText(tr("{n} lines").format(n=grouped(text.count("\n"))) if text else "")
