"""A program's text with its words in colour. Only what is seen is coloured, so that a text of any length opens at once."""

from __future__ import annotations

import re

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import (
    QColor,
    QMouseEvent,
    QPaintEvent,
    QResizeEvent,
    QTextBlock,
    QTextCharFormat,
    QTextCursor,
    QTextLayout,
)
from PySide6.QtWidgets import QPlainTextEdit, QTextEdit

from trunnion_gui.look.colours import Theme, motions, readable

_PATTERN = re.compile(
    r"(?P<comment>(?<!\w)\([^)]*\)|;.*$|^\$\$.*$)|(?P<rapid>\bG0?0\b|\bRAPID\b)|(?P<cut>\bG0?[123]\b|\bGOTO\b|\bCIRCLE\b)"
    r"|(?P<tool>\b[TMS]\d+(?:\.\d+)?\b|\b[A-Z]{4,}/)|(?P<number>\bN\d+\b)"
)


class CodeView(QPlainTextEdit):
    """Comments muted, motion words in the colour of their motion, tool and spindle words in the accent; one line may be marked."""

    clicked = Signal(int)
    """The number of a clicked line, counted from 1."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("code")
        self.setReadOnly(True)
        self.setLineWrapMode(QPlainTextEdit.LineWrapMode.NoWrap)
        self._looks: dict[str, QTextCharFormat] = {}
        self._mark_colour = QColor()
        self._look = 0
        self.marked = 0

    def use_theme(self, theme: Theme) -> None:
        """Draw in the colours of a theme."""
        colours = {"comment": theme.muted, "number": theme.muted, "tool": theme.accent}
        colours |= {
            name: readable(motions()[name], theme.panel, theme.text) for name in ("rapid", "cut")
        }
        self._looks = {name: QTextCharFormat() for name in colours}
        for name, colour in colours.items():
            self._looks[name].setForeground(QColor(colour))
        self._mark_colour = QColor(theme.accent_soft)
        self._look += 1
        self.mark(self.marked)

    def show_text(self, text: str) -> None:
        """Show a text; no line is marked."""
        self.setPlainText(text)
        self.mark(0)

    def mark(self, line: int) -> None:
        """Mark a line (counted from 1) and bring it into view; 0 marks none."""
        self.marked = line
        block = self.document().findBlockByNumber(line - 1) if line else QTextBlock()
        if not block.isValid():
            self.setExtraSelections([])
            return
        line_format = QTextEdit.ExtraSelection()
        line_format.cursor = QTextCursor(block)
        line_format.format.setBackground(self._mark_colour)
        line_format.format.setProperty(QTextCharFormat.Property.FullWidthSelection, True)
        self.setExtraSelections([line_format])
        top = self.firstVisibleBlock().blockNumber()
        shown = self.viewport().height() // max(self.fontMetrics().lineSpacing(), 1)
        if not top + 1 <= line - 1 <= top + shown - 3:
            self.verticalScrollBar().setValue(max(line - 1 - shown // 3, 0))

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        super().mouseReleaseEvent(event)
        if event.button() == Qt.MouseButton.LeftButton and not self.textCursor().hasSelection():
            self.clicked.emit(self.cursorForPosition(event.position().toPoint()).blockNumber() + 1)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self.mark(self.marked)

    def paintEvent(self, event: QPaintEvent) -> None:
        block = self.firstVisibleBlock()
        y = self.blockBoundingGeometry(block).translated(self.contentOffset()).top()
        while block.isValid() and y <= self.viewport().height():
            if block.userState() != self._look:
                block.setUserState(self._look)
                block.layout().setFormats(self._formats(block.text()))
            y += self.blockBoundingRect(block).height()
            block = block.next()
        super().paintEvent(event)

    def _formats(self, text: str) -> list[QTextLayout.FormatRange]:
        found = []
        for match in _PATTERN.finditer(text):
            one = QTextLayout.FormatRange()
            one.start, one.length = match.start(), match.end() - match.start()
            one.format = self._looks.get(match.lastgroup or "comment", QTextCharFormat())
            found.append(one)
        return found
