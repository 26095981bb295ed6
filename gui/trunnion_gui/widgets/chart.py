"""Two curves over one axis: what is wanted small on the left, what it costs on the right. Drawn by hand, as calm as the rest."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QFont, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget

from trunnion_gui.look.colours import Theme

_LEFT, _RIGHT, _TOP, _BELOW = 62, 62, 24, 34
_DOT = 3.0


@dataclass(frozen=True, slots=True)
class ChartCurve:
    """A curve of a chart: what it is, its values (k,), the words for a value, and whether its axis counts by powers of ten."""

    words: str
    values: tuple[float, ...]
    unit: str
    by_powers: bool = False


class Chart(QWidget):
    """Draws a curve on the left axis and one on the right over the same places."""

    def __init__(self) -> None:
        super().__init__()
        self._theme: Theme | None = None
        self.positions: tuple[str, ...] = ()
        self.left: ChartCurve | None = None
        self.right: ChartCurve | None = None
        self.level: tuple[float, str] | None = None
        self._across = ""
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setMinimumSize(QSize(260, 110))

    def use_theme(self, theme: Theme) -> None:
        """Draw in the colours of a theme."""
        self._theme = theme
        self.update()

    def show_curves(
        self,
        across: str,
        positions: Sequence[str],
        left: ChartCurve | None,
        right: ChartCurve | None,
        level: tuple[float, str] | None = None,
    ) -> None:
        """Show two curves over places that are named along the axis below; `level` is a value on the left with its words."""
        self._across, self.positions, self.left, self.right, self.level = (
            across,
            tuple(positions),
            left,
            right,
            level,
        )
        self.update()

    def point(self, curve: ChartCurve, row: int) -> QPointF:
        """Return where a value of a curve is drawn."""
        return QPointF(self._x(row), self._y(curve, curve.values[row]))

    def paintEvent(self, event: QPaintEvent) -> None:
        if self._theme is None or self.left is None or self.right is None:
            return
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        font = QFont(self.font())
        font.setPixelSize(11)
        painter.setFont(font)
        self._frame(painter)
        for curve, colour, side in (
            (self.right, self._theme.warning, Qt.AlignmentFlag.AlignRight),
            (self.left, self._theme.accent, Qt.AlignmentFlag.AlignLeft),
        ):
            self._axis(painter, curve, colour, side)
            self._line(painter, curve, colour)
        painter.end()

    def _frame(self, painter: QPainter) -> None:
        assert self._theme is not None and self.left is not None
        area = self._area()
        painter.setPen(QPen(QColor(self._theme.line), 1))
        painter.drawRect(area)
        painter.setPen(QColor(self._theme.muted))
        for row, words in enumerate(self.positions):
            painter.drawText(
                QRectF(self._x(row) - 30, area.bottom() + 3, 60, 14),
                Qt.AlignmentFlag.AlignHCenter,
                words,
            )
        painter.drawText(
            QRectF(area.left(), area.bottom() + 16, area.width(), 16),
            Qt.AlignmentFlag.AlignHCenter,
            self._across,
        )
        if self.level is not None:
            y = self._y(self.left, self.level[0])
            painter.setPen(QPen(QColor(self._theme.muted), 1, Qt.PenStyle.DashLine))
            painter.drawLine(QPointF(area.left(), y), QPointF(area.right(), y))
            painter.drawText(
                QRectF(area.left() + 6, y - 16, area.width() - 12, 14),
                Qt.AlignmentFlag.AlignRight,
                self.level[1],
            )

    def _axis(
        self, painter: QPainter, curve: ChartCurve, colour: str, side: Qt.AlignmentFlag
    ) -> None:
        area, is_left = self._area(), side == Qt.AlignmentFlag.AlignLeft
        painter.setPen(QColor(colour))
        painter.drawText(QRectF(4, 4, self.width() - 8, 16), side, curve.words)
        for value in self._steps(curve):
            y = self._y(curve, value) - 8
            words = f"{value:g} {curve.unit}"
            if is_left:
                painter.drawText(
                    QRectF(0, y, area.left() - 5, 16),
                    Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter,
                    words,
                )
            else:
                painter.drawText(
                    QRectF(area.right() + 5, y, _RIGHT - 5, 16),
                    Qt.AlignmentFlag.AlignVCenter,
                    words,
                )

    def _line(self, painter: QPainter, curve: ChartCurve, colour: str) -> None:
        points = [self.point(curve, row) for row in range(len(curve.values))]
        painter.setPen(QPen(QColor(colour), 1.8))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawPolyline(QPolygonF(points))
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(colour))
        for point in points:
            painter.drawEllipse(point, _DOT, _DOT)

    def _area(self) -> QRectF:
        return QRectF(
            _LEFT,
            _TOP,
            max(self.width() - _LEFT - _RIGHT, 10),
            max(self.height() - _TOP - _BELOW, 10),
        )

    def _x(self, row: int) -> float:
        area = self._area()
        return area.left() + area.width() * (row + 0.5) / max(len(self.positions), 1)

    def _y(self, curve: ChartCurve, value: float) -> float:
        low, high = self._range(curve)
        area = self._area()
        if curve.by_powers:
            value = math.log10(max(value, 10.0**low))
        return area.bottom() - area.height() * (value - low) / max(high - low, 1e-12)

    def _range(self, curve: ChartCurve) -> tuple[float, float]:
        """Return the ends of a curve's axis: of its values, or of their powers of ten."""
        if curve.by_powers:
            above = [v for v in curve.values if v > 0.0] or [1.0]
            return math.floor(math.log10(min(above))), max(
                math.ceil(math.log10(max(above))), math.floor(math.log10(min(above))) + 1
            )
        return 0.0, max(*curve.values, 1e-9) * 1.1

    def _steps(self, curve: ChartCurve) -> list[float]:
        low, high = self._range(curve)
        if curve.by_powers:
            return [
                10.0**k for k in range(int(low), int(high) + 1, max(1, round((high - low) / 4)))
            ]
        step = 10.0 ** math.floor(math.log10(high))
        step *= next(s for s in (0.2, 0.5, 1.0, 2.0, 5.0) if high / (step * s) <= 5.0)
        return [float(v) for v in np.arange(0.0, high, step)]
