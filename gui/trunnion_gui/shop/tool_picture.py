"""The picture of a tool, drawn from its data: cutter, shank and holder to scale, with their dimensions."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget

from trunnion_gui.i18n import tr
from trunnion_gui.look.colours import Theme, mixed, tool_colours
from trunnion_gui.look.words import amount
from trunnion_gui.worker.shop_requests import OutlinePart, ToolRow

_MARGIN = 14.0
_DIMENSION = 62.0
"""Pixels beside the tool for each column of dimensions."""
_BELOW = 26.0
"""Pixels below the tip for the diameter."""
_LINE, _ARROW = 1.0, 4.0


class ToolPicture(QWidget):
    """A tool in its holder as it stands in the spindle, tip down; the same scale along and across."""

    def __init__(self) -> None:
        super().__init__()
        self._row: ToolRow | None = None
        self._theme: Theme | None = None
        self._worn = 0.0
        self.setMinimumSize(240, 170)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)

    def sizeHint(self) -> QSize:
        return QSize(320, 300)

    def use_theme(self, theme: Theme) -> None:
        """Draw in the colours of a theme."""
        self._theme = theme
        self.update()

    def show_tool(self, row: ToolRow | None, worn: float = 0.0) -> None:
        """Draw a tool (None: nothing) whose measured gauge length is longer than its own by `worn` mm."""
        self._row, self._worn = row, worn
        self.setAccessibleName(row.name if row is not None else "")
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        if self._theme is None:
            return
        painter.fillRect(self.rect(), QColor(self._theme.panel))
        if self._row is None or not self._row.outline:
            painter.setPen(QColor(self._theme.muted))
            words = tr("Select a tool") if self._row is None else tr("Turning tools are not drawn")
            painter.drawText(self.rect(), Qt.AlignmentFlag.AlignCenter, words)
            return
        _Drawing(painter, self._theme, self._row, self._worn, QRectF(self.rect())).draw()


class _Drawing:
    """One picture: the painter, and the scale that fits the tool and its dimensions into a rectangle."""

    def __init__(
        self, painter: QPainter, theme: Theme, row: ToolRow, worn: float, area: QRectF
    ) -> None:
        self._painter, self._theme, self._row, self._worn = painter, theme, row, worn
        points = [p for part in row.outline for p in part.points]
        self._widest = max(r for r, _ in points)
        self._high = max(z for _, z in points)
        across = area.width() - 2.0 * _MARGIN - 3.0 * _DIMENSION
        along = area.height() - _MARGIN - _BELOW - _MARGIN
        self._scale = min(across / (2.0 * self._widest), along / self._high)
        self._middle = _MARGIN + max(across, 0.0) / 2.0
        self._tip = area.bottom() - _BELOW - _MARGIN

    def draw(self) -> None:
        """Draw the parts from the holder down, the axis, and the dimensions."""
        for part in reversed(self._row.outline):
            self._draw_part(part)
        self._draw_axis()
        self._draw_dimensions()

    def _at(self, radius: float, height: float) -> QPointF:
        return QPointF(self._middle + radius * self._scale, self._tip - height * self._scale)

    def _draw_part(self, part: OutlinePart) -> None:
        colour = tool_colours()[part.kind]
        right = [self._at(r, z) for r, z in part.points]
        mirrored = [self._at(-r, z) for r, z in reversed(part.points)]
        self._painter.setPen(QPen(QColor(mixed(colour, self._theme.text, 0.45)), _LINE))
        self._painter.setBrush(QColor(colour))
        self._painter.drawPolygon(QPolygonF([*right, *mirrored]))

    def _draw_axis(self) -> None:
        pen = QPen(QColor(mixed(self._theme.muted, self._theme.panel, 0.3)), _LINE)
        pen.setStyle(Qt.PenStyle.DashDotLine)
        self._painter.setPen(pen)
        over = 8.0 / self._scale
        self._painter.drawLine(self._at(0.0, -over), self._at(0.0, self._high + over))

    def _draw_dimensions(self) -> None:
        row = self._row
        lengths: Sequence[tuple[str, float]] = (
            (tr("flutes"), row.flute_length),
            (tr("stickout"), row.stickout),
            (tr("gauge"), row.gauge_length),
        )
        edge = self._at(self._widest, 0.0).x()
        for column, (words, height) in enumerate(lengths):
            label = f"{words}\n{amount(height, 2)}"
            if column == 2 and self._worn:
                label += f"\n{self._worn:+.3f}"
            self._draw_height(edge + 10.0 + column * _DIMENSION, height, label)
        self._draw_diameter()

    def _draw_height(self, x: float, height: float, words: str) -> None:
        """Draw the dimension of a height over the tip, its line at a place across."""
        low, high = self._at(0.0, 0.0).y(), self._at(0.0, height).y()
        edge = self._at(self._widest, 0.0).x()
        soft = QPen(QColor(self._theme.line), _LINE)
        self._painter.setPen(soft)
        for y in (low, high):
            self._painter.drawLine(QPointF(edge + 4.0, y), QPointF(x + 4.0, y))
        self._painter.setPen(QPen(QColor(self._theme.muted), _LINE))
        self._painter.drawLine(QPointF(x, low), QPointF(x, high))
        for y, sense in ((low, -1.0), (high, 1.0)):
            for side in (-1.0, 1.0):
                end = QPointF(x + side * _ARROW / 2.0, y + sense * 1.5 * _ARROW)
                self._painter.drawLine(QPointF(x, y), end)
        self._painter.setPen(QColor(self._theme.text))
        box = QRectF(x + 4.0, (low + high) / 2.0 - 26.0, _DIMENSION - 6.0, 52.0)
        flags = Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft
        self._painter.drawText(box, flags, words)

    def _draw_diameter(self) -> None:
        radius, y = self._row.diameter / 2.0, self._at(0.0, 0.0).y() + 10.0
        begin, end = self._at(-radius, 0.0).x(), self._at(radius, 0.0).x()
        self._painter.setPen(QPen(QColor(self._theme.muted), _LINE))
        self._painter.drawLine(QPointF(begin, y), QPointF(end, y))
        for x in (begin, end):
            self._painter.drawLine(QPointF(x, y - _ARROW), QPointF(x, y + _ARROW))
        self._painter.setPen(QColor(self._theme.text))
        words = f"D {amount(self._row.diameter)}"
        if self._row.corner_radius:
            words += f"  R {amount(self._row.corner_radius)}"
        box = QRectF(self._middle - 100.0, y + 3.0, 200.0, 20.0)
        self._painter.drawText(box, Qt.AlignmentFlag.AlignCenter, words)
