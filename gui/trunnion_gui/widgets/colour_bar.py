"""What the colours of the deviation map mean: a bar from gouge to material left, with the tolerance marked."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QFont, QLinearGradient, QPainter, QPaintEvent
from PySide6.QtWidgets import QFrame, QLabel, QVBoxLayout, QWidget

from trunnion.report.deviation import DeviationMap
from trunnion.report.palette import DeviationColours
from trunnion_gui.i18n import tr
from trunnion_gui.look.colours import Theme
from trunnion_gui.look.words import fine_amount

_BAR, _HEIGHT, _WORDS = 16, 210, 74
_STOPS = 96
_PAD = 9


class _Bar(QWidget):
    def __init__(self, theme: Theme, colours: DeviationColours) -> None:
        super().__init__()
        self.theme = theme
        self.shown: DeviationMap | None = None
        self._colours = colours
        self.pointed: float | None = None
        self.setFixedSize(QSize(_BAR + _WORDS, _HEIGHT + 2 * _PAD))

    def y_of(self, value: float) -> float:
        """Return where a deviation is on the bar."""
        limit = self.shown.limit if self.shown is not None else 1.0
        return _PAD + (1.0 - (min(max(value, -limit), limit) / limit + 1.0) / 2.0) * _HEIGHT

    def paintEvent(self, event: QPaintEvent) -> None:
        shown = self.shown
        if shown is None:
            return
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        gradient = QLinearGradient(0, _PAD + _HEIGHT, 0, _PAD)
        shares = np.linspace(0.0, 1.0, _STOPS)
        for share, colour in zip(
            shares,
            self._colours.at((2 * shares - 1) * shown.limit, shown.low, shown.high, shown.limit),
        ):
            gradient.setColorAt(float(share), QColor(*(int(c) for c in colour)))
        painter.setPen(QColor(self.theme.line))
        painter.setBrush(gradient)
        painter.drawRoundedRect(QRectF(0.5, _PAD, _BAR, _HEIGHT), 3, 3)
        font = QFont(self.font())
        font.setPixelSize(12)
        painter.setFont(font)
        for value, words in (
            (shown.limit, f"≥ {fine_amount(shown.limit)}"),
            (shown.high, fine_amount(shown.high)),
            (0.0, "0"),
            (shown.low, fine_amount(shown.low)),
            (-shown.limit, f"≤ {fine_amount(-shown.limit)}"),
        ):
            y = self.y_of(value)
            painter.setPen(QColor(self.theme.muted))
            painter.drawLine(QPointF(_BAR + 2, y), QPointF(_BAR + 6, y))
            painter.setPen(QColor(self.theme.text))
            painter.drawText(
                QRectF(_BAR + 10, y - 8, _WORDS - 10, 16), Qt.AlignmentFlag.AlignVCenter, words
            )
        if self.pointed is not None:
            y = self.y_of(self.pointed)
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(QColor(self.theme.text))
            painter.drawPolygon(
                [QPointF(_BAR - 3, y), QPointF(_BAR + 5, y - 4.5), QPointF(_BAR + 5, y + 4.5)]
            )
        painter.end()


class ColourBar(QFrame):
    """A card in the upper left corner of the picture while the map is shown."""

    def __init__(self, parent: QWidget, theme: Theme, colours: DeviationColours) -> None:
        super().__init__(parent)
        self.setObjectName("legend")
        self.bar = _Bar(theme, colours)
        self.over, self.under = QLabel(tr("material left")), QLabel(tr("gouge"))
        column = QVBoxLayout(self)
        column.setContentsMargins(12, 8, 10, 8)
        column.setSpacing(0)
        for label in (self.over, self.under):
            label.setObjectName("muted")
        column.addWidget(self.over)
        column.addWidget(self.bar)
        column.addWidget(self.under)
        self.hide()

    def use_theme(self, theme: Theme) -> None:
        """Draw in the colours of a theme."""
        self.bar.theme = theme
        self.bar.update()

    def show_map(self, shown: DeviationMap | None) -> None:
        """Explain a map, or hide."""
        self.bar.shown = shown
        self.setVisible(shown is not None)
        self.adjustSize()
        self.bar.update()

    def point(self, value: float | None) -> None:
        """Mark a value, or none."""
        if value != self.bar.pointed:
            self.bar.pointed = value
            self.bar.update()
