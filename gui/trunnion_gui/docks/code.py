"""The written programs, one a setup and dialect, with their words in colour."""

from __future__ import annotations

import re

from PySide6.QtGui import QColor, QShowEvent, QSyntaxHighlighter, QTextCharFormat
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QLabel, QPlainTextEdit, QVBoxLayout, QWidget

from trunnion.findings import TrunnionError
from trunnion.model.session import PostedFile, Session
from trunnion_gui.colours import Theme, motions
from trunnion_gui.document import Document
from trunnion_gui.i18n import tr


class _Words(QSyntaxHighlighter):
    """Comments muted, motion words in the colour of their motion, tool and spindle words in the accent."""

    _PATTERN = re.compile(r"(?P<comment>\([^)]*\)|;.*$|^\$\$.*$)|(?P<rapid>\bG0?0\b|\bRAPID\b)|(?P<cut>\bG0?[123]\b|\bGOTO\b|\bCIRCLE\b)"
                          r"|(?P<tool>\b[TMS]\d+(?:\.\d+)?\b|\b[A-Z]{4,}/)|(?P<number>\bN\d+\b)")

    def __init__(self, editor: QPlainTextEdit, theme: Theme) -> None:
        super().__init__(editor.document())
        colours = {"comment": theme.muted, "number": theme.muted, "tool": theme.accent}
        colours |= {name: motions()[name] for name in ("rapid", "cut")}
        self._looks = {name: QTextCharFormat() for name in colours}
        for name, colour in colours.items():
            self._looks[name].setForeground(QColor(colour))

    def highlightBlock(self, text: str) -> None:
        for match in self._PATTERN.finditer(text):
            self.setFormat(match.start(), match.end() - match.start(), self._looks[match.lastgroup or "comment"])


class CodeDock(QWidget):
    """The text of the chosen program; filled when it is looked at."""

    def __init__(self, document: Document) -> None:
        super().__init__()
        self._document = document
        self._shown: tuple[PostedFile, ...] = ()
        self._source: tuple[object, object] = ((), None)
        self._words: _Words | None = None
        self.choice = QComboBox()
        self.choice.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToContents)
        self.choice.setMinimumContentsLength(18)
        self.lines = QLabel()
        self.lines.setObjectName("muted")
        self.text = QPlainTextEdit()
        self.text.setObjectName("code")
        self.text.setReadOnly(True)
        self.text.setLineWrapMode(QPlainTextEdit.LineWrapMode.NoWrap)
        self.text.setPlaceholderText(tr("The program appears here when it has been generated and verified."))
        top = QHBoxLayout()
        top.setContentsMargins(10, 6, 10, 0)
        top.addWidget(self.choice)
        top.addWidget(self.lines)
        top.addStretch(1)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(2)
        column.addLayout(top)
        column.addWidget(self.text)
        self.choice.currentIndexChanged.connect(self._read)
        document.changed.connect(self.refresh)

    def use_theme(self, theme: Theme) -> None:
        """Draw in the colours of a theme."""
        self._words = _Words(self.text, theme)

    def refresh(self) -> None:
        """Show the programs of the shown session, if anybody looks."""
        session = self._document.shown
        if not self.isVisible() or (session.posted, session.verdict) == self._source:
            return
        self._source = (session.posted, session.verdict)
        self._shown = posted = as_they_leave(session)
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

    def _read(self) -> None:
        row = self.choice.currentIndex()
        text = self._shown[row].text if 0 <= row < len(self._shown) else ""
        self.text.setPlainText(text)
        self.lines.setText(tr("{n} lines").format(n=f"{text.count(chr(10)):,}".replace(",", " ")) if text else "")


def as_they_leave(session: Session) -> tuple[PostedFile, ...]:
    """Return the programs with the stamp that they would be written with now; not proven, they keep the one that forbids running."""
    from trunnion.post.release import release

    try:
        return release(session)
    except TrunnionError:
        return session.posted
