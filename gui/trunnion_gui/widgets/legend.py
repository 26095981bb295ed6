"""What the colours mean: kinds of features with their count, kinds of motion when toolpaths are shown."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtWidgets import QFrame, QGridLayout, QLabel, QVBoxLayout, QWidget

from trunnion_gui.widgets.panel import swatch


class Legend(QFrame):
    """A card in the upper left corner of the picture; hidden while it has nothing to say."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setObjectName("legend")
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(12, 9, 14, 9)
        self._body = QWidget()
        self._column.addWidget(self._body)
        self.rows: tuple[tuple[str, str, str], ...] = ()
        self.hide()

    def show_rows(self, rows: Sequence[tuple[str, str, str]]) -> None:
        """Show rows of colour, words and count; a row without a colour is a heading, or a gap when it has no words either."""
        if tuple(rows) == self.rows:
            return
        self.rows = tuple(rows)
        self._column.removeWidget(self._body)
        self._body.hide()
        self._body.deleteLater()
        self._body = _body(rows)
        self._column.addWidget(self._body)
        self._body.show()
        self.setVisible(bool(rows))
        self.adjustSize()


def _body(rows: Sequence[tuple[str, str, str]]) -> QWidget:
    body = QWidget()
    grid = QGridLayout(body)
    grid.setContentsMargins(0, 0, 0, 0)
    grid.setHorizontalSpacing(8)
    grid.setVerticalSpacing(3)
    for n, (colour, words, count) in enumerate(rows):
        if not colour and not words:
            grid.setRowMinimumHeight(n, 6)
            continue
        if not colour:
            grid.addWidget(QLabel(words), n, 0, 1, 3)
            continue
        number = QLabel(count)
        number.setObjectName("muted")
        for column, widget in enumerate((swatch(colour), QLabel(words), number)):
            grid.addWidget(widget, n, column)
    return body
