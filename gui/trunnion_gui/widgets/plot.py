"""A curve of numbers over numbers, with points that are marked on it. Drawn by hand, as calm as the rest."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QFont, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget

from trunnion_gui.look.colours import Theme

_LEFT, _RIGHT, _TOP, _BELOW = 52, 14, 22, 34
_DOT, _MARK = 1.8, 4.0
_STEPS = 4.0
"""Steps of an axis that are named at most."""
_MARGIN = 0.06
"""Of the range of values: room beside them."""


@dataclass(frozen=True, slots=True)
class PlotMark:
    """A point that is marked: where, and the words beside it; the chosen one has the accent."""

    x: float
    y: float
    words: str
    is_optimum: bool = False


class Plot(QWidget):
    """Draws points joined by a curve, the words of both axes, and marks."""

    def __init__(self) -> None:
        super().__init__()
        self._theme: Theme | None = None
        self.points: tuple[tuple[float, float], ...] = ()
        self.marks: tuple[PlotMark, ...] = ()
        self._across, self._up = "", ""
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setMinimumSize(QSize(200, 150))

    def sizeHint(self) -> QSize:
        return QSize(260, 170)

    def use_theme(self, theme: Theme) -> None:
        """Draw in the colours of a theme."""
        self._theme = theme
        self.update()

    def show_points(
        self,
        across: str,
        up: str,
        points: Sequence[tuple[float, float]],
        marks: Sequence[PlotMark] = (),
    ) -> None:
        """Show points (x, y) in their order, under words for either axis."""
        self._across, self._up = across, up
        self.points, self.marks = tuple(points), tuple(marks)
        self.update()

    def position(self, x: float, y: float) -> QPointF:
        """Return where a point is drawn."""
        area = self._area()
        (x0, x1), (y0, y1) = self._range(0), self._range(1)
        return QPointF(
            area.left() + area.width() * (x - x0) / (x1 - x0),
            area.bottom() - area.height() * (y - y0) / (y1 - y0),
        )

    def paintEvent(self, event: QPaintEvent) -> None:
        if self._theme is None or not self.points:
            return
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        font = QFont(self.font())
        font.setPixelSize(11)
        painter.setFont(font)
        self._frame(painter, self._theme)
        self._curve(painter, self._theme)
        for mark in self.marks:
            self._draw_mark(painter, self._theme, mark)
        painter.end()

    def _frame(self, painter: QPainter, theme: Theme) -> None:
        area = self._area()
        painter.setPen(QPen(QColor(theme.line), 1))
        painter.drawRect(area)
        painter.setPen(QColor(theme.muted))
        painter.drawText(QRectF(4, 3, self.width() - 8, 16), Qt.AlignmentFlag.AlignLeft, self._up)
        below = QRectF(area.left(), area.bottom() + 17, area.width(), 16)
        painter.drawText(below, Qt.AlignmentFlag.AlignHCenter, self._across)
        for value in self._named(0):
            x = self.position(value, self._range(1)[0]).x()
            box = QRectF(x - 30, area.bottom() + 3, 60, 14)
            painter.drawText(box, Qt.AlignmentFlag.AlignHCenter, f"{value:g}")
        aligned = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
        for value in self._named(1):
            y = self.position(self._range(0)[0], value).y()
            painter.drawText(QRectF(0, y - 8, area.left() - 5, 16), aligned, f"{value:g}")

    def _curve(self, painter: QPainter, theme: Theme) -> None:
        points = [self.position(*p) for p in self.points]
        painter.setPen(QPen(QColor(theme.accent), 1.6))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawPolyline(QPolygonF(points))
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(theme.accent))
        for point in points:
            painter.drawEllipse(point, _DOT, _DOT)

    def _draw_mark(self, painter: QPainter, theme: Theme, mark: PlotMark) -> None:
        at, area = self.position(mark.x, mark.y), self._area()
        colour = QColor(theme.good if mark.is_optimum else theme.warning)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(colour)
        painter.drawEllipse(at, _MARK, _MARK)
        painter.setPen(colour)
        # The words lie on the side that has room, the chosen point's below it.
        is_right = at.x() > area.center().x()
        side = Qt.AlignmentFlag.AlignRight if is_right else Qt.AlignmentFlag.AlignLeft
        left = at.x() - 127 if is_right else at.x() + 7
        top = min(max(at.y() + (4 if mark.is_optimum else -18), area.top()), area.bottom() - 15)
        painter.drawText(QRectF(left, top, 120, 15), side, mark.words)

    def _area(self) -> QRectF:
        width, height = self.width() - _LEFT - _RIGHT, self.height() - _TOP - _BELOW
        return QRectF(_LEFT, _TOP, max(width, 10), max(height, 10))

    def _range(self, axis: int) -> tuple[float, float]:
        """Return the ends of an axis: those of its values, with a margin."""
        values = [p[axis] for p in self.points]
        values += [(m.x, m.y)[axis] for m in self.marks]
        low, high = min(values, default=0.0), max(values, default=1.0)
        spare = _MARGIN * (high - low) or 0.05 * abs(high) or 1.0
        return low - spare, high + spare

    def _named(self, axis: int) -> list[float]:
        """Return the values of an axis that are named: multiples of 1, 2 or 5 times a power of ten."""
        low, high = self._range(axis)
        step = 10.0 ** math.floor(math.log10(high - low))
        step *= next(
            s for s in (0.1, 0.2, 0.5, 1.0, 2.0, 5.0) if (high - low) / (step * s) <= _STEPS
        )
        return [round(float(v), 12) for v in np.arange(math.ceil(low / step) * step, high, step)]
