"""A tool library on its way in or out: what is lost, shown before it is taken and after it was written."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QHeaderView, QLabel, QPushButton, QVBoxLayout, QWidget

from trunnion_gui.form import ChoiceField
from trunnion_gui.i18n import tr
from trunnion_gui.look import icons
from trunnion_gui.look.words import counted, message_sentence
from trunnion_gui.widgets import table as tables
from trunnion_gui.worker.shop_requests import LibraryExchange

_UNITS = ("mm", "inch")


class ExchangePage(QWidget):
    """The losses of one library, and buttons that take it over or go back to the tools."""

    unit_changed = Signal(str)
    """The file is to be read in another unit."""
    accepted = Signal()
    closed = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.shown: LibraryExchange | None = None
        self.title, self.subtitle = QLabel(), QLabel()
        self.title.setObjectName("title")
        self.subtitle.setObjectName("muted")
        self.subtitle.setWordWrap(True)
        self.table = tables.table([tr("What is lost"), tr("Tools")], stretched=(0, 1))
        self.table.setObjectName("losses")
        self.table.setWordWrap(True)
        rows = self.table.verticalHeader()
        rows.setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        self.unit = ChoiceField()
        for word in _UNITS:
            self.unit.addItem(word, word)
        self.unit.setToolTip(tr("Unit of files that name none, such as tables of LinuxCNC"))
        self.accept, self.back = QPushButton(), QPushButton()
        self.accept.setObjectName("primary")
        line = QHBoxLayout()
        self._unit_label = QLabel(tr("Unit"))
        for widget in (self._unit_label, self.unit):
            line.addWidget(widget)
        line.addStretch(1)
        line.addWidget(self.back)
        line.addWidget(self.accept)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        for shown in (self.title, self.subtitle):
            column.addWidget(shown)
        column.addWidget(self.table, 1)
        column.addLayout(line)
        self.accept.clicked.connect(self.accepted.emit)
        self.back.clicked.connect(self.closed.emit)
        self.unit.currentIndexChanged.connect(
            lambda _: self.unit_changed.emit(str(self.unit.currentData()))
        )

    def show_read(self, read: LibraryExchange) -> None:
        """Show what taking a library over would bring and lose."""
        tools = counted(len(read.names), tr("tool"))
        self._show(read, tr("Take {tools} of {file}?").format(tools=tools, file=_file(read)))
        self.accept.setText(tr("Take {tools}").format(tools=tools))
        self.back.setText(tr("Don't take them"))
        self._offer(True)

    def show_written(self, written: LibraryExchange) -> None:
        """Show what a written library lost."""
        tools = counted(len(written.names), tr("tool"))
        self._show(
            written, tr("{tools} written to {file}").format(tools=tools, file=_file(written))
        )
        self.back.setText(tr("Back to the tools"))
        self._offer(False)

    def _show(self, exchange: LibraryExchange, title: str) -> None:
        self.shown = exchange
        self.title.setText(title)
        self.subtitle.setText(
            tr("Format {format}. What the other side can't hold, or leaves open:").format(
                format=exchange.format
            )
            if exchange.findings
            else tr("Format {format}. Nothing is lost.").format(format=exchange.format)
        )
        rows = [(message_sentence(f.text), f.location) for f in exchange.findings]
        drawn = [icons.icon(f.severity.value) for f in exchange.findings]
        tables.fill(self.table, rows, icons=drawn)

    def _offer(self, is_read: bool) -> None:
        for widget in (self.accept, self.unit, self._unit_label):
            widget.setVisible(is_read)


def _file(exchange: LibraryExchange) -> str:
    return Path(exchange.path).name
