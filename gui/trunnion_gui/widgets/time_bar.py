"""Where the minutes at the machine go: one bar in as many parts as there are reasons, with their shares in words below."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QRectF, QSize
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPaintEvent
from PySide6.QtWidgets import QGridLayout, QLabel, QSizePolicy, QVBoxLayout, QWidget

from trunnion_gui.i18n import tr
from trunnion_gui.look.colours import machine_time
from trunnion_gui.widgets.layout import empty
from trunnion_gui.widgets.panel import swatch

_HEIGHT, _CORNER = 12, 3.0
_COLUMNS = 2


class _Bar(QWidget):
    def __init__(self) -> None:
        super().__init__()
        self.shares: tuple[tuple[str, float], ...] = ()
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)

    def sizeHint(self) -> QSize:
        return QSize(160, _HEIGHT)

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        outline = QPainterPath()
        outline.addRoundedRect(QRectF(self.rect()), _CORNER, _CORNER)
        painter.setClipPath(outline)
        colours, x = machine_time(), 0.0
        for name, share in self.shares:
            width = share * self.width()
            painter.fillRect(QRectF(x, 0.0, width, self.height()), QColor(colours[name]))
            x += width
        painter.end()


class TimeBar(QWidget):
    """A bar of shares of the machining time, with a legend."""

    def __init__(self) -> None:
        super().__init__()
        self.bar = _Bar()
        self._legend = QGridLayout()
        self._legend.setHorizontalSpacing(8)
        self._legend.setVerticalSpacing(2)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 4, 0, 0)
        column.setSpacing(5)
        column.addWidget(self.bar)
        column.addLayout(self._legend)
        self.hide()

    def show_shares(self, shares: Sequence[tuple[str, float]]) -> None:
        """Show shares by their names, in their order; hide where there are none."""
        self.bar.shares = tuple(shares)
        empty(self._legend)
        for n, (name, share) in enumerate(shares):
            row, column = divmod(n, _COLUMNS)
            words = QLabel(f"{tr(name)} {100.0 * share:.0f} %")
            words.setObjectName("muted")
            self._legend.addWidget(swatch(machine_time()[name]), row, 2 * column)
            self._legend.addWidget(words, row, 2 * column + 1)
            self._legend.setColumnStretch(2 * column + 1, 1)
        self.setVisible(bool(shares))
        self.bar.update()
