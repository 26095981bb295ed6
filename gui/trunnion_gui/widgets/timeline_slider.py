"""The slider over all blocks: the operations as segments below it, and the load on the way; what is done in the accent colour."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import (
    QColor,
    QHelpEvent,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QWheelEvent,
)
from PySide6.QtWidgets import QSizePolicy, QToolTip, QWidget

from trunnion_gui.look.colours import Theme, mixed

_EDGE = 9
_GROOVE, _MARKS, _KNOB = 5, 6, 7
_HEIGHT = 27
_LOAD = 20
"""Height of the load's picture, when it is known."""


class TimelineSlider(QWidget):
    """A slider from 0 to `end` with marks; says where a person wants to go."""

    wanted = Signal(float)
    stepped = Signal(int)
    """Arrow keys and wheel: so many blocks on or back."""

    def __init__(self, theme: Theme) -> None:
        super().__init__()
        self._theme = theme
        self._end, self._value, self._stock = 0.0, 0.0, 0.0
        self._firsts: tuple[float, ...] = ()
        self._words: tuple[str, ...] = ()
        self._colours: tuple[str, ...] = ()
        self._load, self._bad = np.zeros(0), np.zeros(0, bool)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setFixedHeight(_HEIGHT)
        self.setMouseTracking(True)

    def sizeHint(self) -> QSize:
        return QSize(400, _HEIGHT)

    def use_theme(self, theme: Theme) -> None:
        """Draw in the colours of a theme."""
        self._theme = theme
        self.update()

    def show_marks(
        self, end: float, firsts: Sequence[float], words: Sequence[str], colours: Sequence[str]
    ) -> None:
        """Show segments that begin at `firsts`, each with words and a colour."""
        self._end, self._firsts, self._words, self._colours = (
            end,
            tuple(firsts),
            tuple(words),
            tuple(colours),
        )
        self.setEnabled(end > 0.0)
        self.update()

    def show_load(self, load: np.ndarray, bad: np.ndarray) -> None:
        """Show the load of every block (n,), as a share of the highest, and which blocks (n,) the proof found at fault; empty: neither."""
        self._load, self._bad = load, bad
        self.setFixedHeight(_HEIGHT + (_LOAD if len(load) else 0))
        self.update()

    def show_value(self, value: float) -> None:
        """Put the knob at a position."""
        if round(self.x_of(value)) != round(self.x_of(self._value)):
            self.update()
        self._value = value

    def show_stock(self, value: float) -> None:
        """Show how far the stock is."""
        if value != self._stock:
            self._stock = value
            self.update()

    def x_of(self, value: float) -> float:
        """Return where a position is on the widget."""
        return _EDGE + (value / self._end if self._end else 0.0) * max(self.width() - 2 * _EDGE, 1)

    def value_at(self, x: float) -> float:
        """Return the whole position at a point of the widget."""
        share = (x - _EDGE) / max(self.width() - 2 * _EDGE, 1)
        return float(round(min(max(share, 0.0), 1.0) * self._end))

    def paintEvent(self, event: QPaintEvent) -> None:
        theme, painter = self._theme, QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(Qt.PenStyle.NoPen)
        middle = 10.0
        left, right, at = (
            self.x_of(0.0),
            self.x_of(self._end) if self._end else self.width() - _EDGE,
            self.x_of(self._value),
        )
        painter.setBrush(QColor(theme.line))
        painter.drawRoundedRect(
            QRectF(left, middle - _GROOVE / 2, right - left, _GROOVE), _GROOVE / 2, _GROOVE / 2
        )
        if self._end:
            painter.setBrush(QColor(mixed(theme.accent, theme.panel, 0.55)))
            painter.drawRoundedRect(
                QRectF(left, middle - _GROOVE / 2, self.x_of(self._stock) - left, _GROOVE),
                _GROOVE / 2,
                _GROOVE / 2,
            )
            painter.setBrush(QColor(theme.accent))
            painter.drawRoundedRect(
                QRectF(left, middle - _GROOVE / 2, at - left, _GROOVE), _GROOVE / 2, _GROOVE / 2
            )
        self._paint_marks(painter, middle + 9.0)
        self._paint_load(painter, middle + 9.0 + _MARKS + 3.0)
        if self._end:
            painter.setPen(QColor(theme.accent))
            painter.setBrush(QColor(theme.panel))
            painter.drawEllipse(QPointF(at, middle), _KNOB, _KNOB)
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(QColor(theme.accent))
            painter.drawEllipse(QPointF(at, middle), _KNOB / 2, _KNOB / 2)
        painter.end()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton and self._end:
            self.wanted.emit(self.value_at(event.position().x()))

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if event.buttons() & Qt.MouseButton.LeftButton and self._end:
            self.wanted.emit(self.value_at(event.position().x()))

    def wheelEvent(self, event: QWheelEvent) -> None:
        self.stepped.emit(1 if event.angleDelta().y() > 0 else -1)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        step = {
            Qt.Key.Key_Right: 1,
            Qt.Key.Key_Left: -1,
            Qt.Key.Key_PageUp: 100,
            Qt.Key.Key_PageDown: -100,
        }.get(Qt.Key(event.key()))
        if step is None:
            super().keyPressEvent(event)
        else:
            self.stepped.emit(step)

    def event(self, event: QEvent) -> bool:
        if isinstance(event, QHelpEvent) and event.type() == QEvent.Type.ToolTip:
            words = self.words_at(event.pos().x())
            QToolTip.showText(event.globalPos(), words, self) if words else QToolTip.hideText()
            return True
        return super().event(event)

    def words_at(self, x: float) -> str:
        """Return the words of the segment at a point of the widget."""
        value = self.value_at(x)
        row = sum(first <= value for first in self._firsts) - 1
        return self._words[row] if 0 <= row < len(self._words) else ""

    def _paint_marks(self, painter: QPainter, y: float) -> None:
        ends = (*self._firsts[1:], self._end)
        for first, last, colour in zip(self._firsts, ends, self._colours):
            x0, x1 = self.x_of(first), self.x_of(last)
            is_here = first <= self._value < last or (self._value == last == self._end)
            painter.setBrush(QColor(colour if is_here else mixed(colour, self._theme.panel, 0.45)))
            painter.drawRoundedRect(QRectF(x0, y, max(x1 - x0 - 1.5, 1.0), _MARKS), 2, 2)

    def _paint_load(self, painter: QPainter, y: float) -> None:
        """Draw the highest load of the blocks at each pixel as a bar, and a red tick where one of them is at fault."""
        n, high = len(self._load), float(self._load.max(initial=0.0))
        if not n or not high or n != round(self._end):
            return
        left, width = round(self.x_of(0.0)), max(round(self.x_of(self._end) - self.x_of(0.0)), 1)
        first = np.minimum((np.arange(width) * n) // width, n - 1)
        tops = np.maximum.reduceat(self._load, first) / high
        bad = np.logical_or.reduceat(self._bad, first)
        done = self.x_of(self._value) - left
        pale, full, red = (
            QColor(c)
            for c in (
                mixed(self._theme.accent, self._theme.panel, 0.6),
                self._theme.accent,
                self._theme.bad,
            )
        )
        for x in range(width):
            height = float(tops[x]) * (_LOAD - 4)
            painter.fillRect(
                QRectF(left + x, y + _LOAD - 4 - height, 1.0, height), full if x < done else pale
            )
            if bad[x]:
                painter.fillRect(QRectF(left + x - 1, y - 1, 2.5, _LOAD - 3), red)
