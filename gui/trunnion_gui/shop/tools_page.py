"""The page of tools: the table with its filter, the selected tool beside it, libraries read and written."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt
from PySide6.QtGui import QDragEnterEvent, QDropEvent
from PySide6.QtWidgets import (
    QFileDialog,
    QHBoxLayout,
    QPushButton,
    QSplitter,
    QStackedWidget,
    QVBoxLayout,
    QWidget,
)

from trunnion_gui.document import Document
from trunnion_gui.i18n import tr
from trunnion_gui.look.colours import Theme
from trunnion_gui.shop.exchange_page import ExchangePage
from trunnion_gui.shop.tool_details import ToolDetails
from trunnion_gui.shop.tool_filter import ToolFilterBar
from trunnion_gui.shop.tool_table import NAME, ToolModel, tool_view
from trunnion_gui.widgets.dropped_files import accept_files, dropped_file
from trunnion_gui.worker.shop_requests import (
    FormatRow,
    LibraryExchange,
    ShopView,
    ToolRow,
)

_TABLE_WIDTH, _DETAILS_WIDTH = 700, 410
"""Pixels at first; the table takes what the window is wider."""


class ToolsPage(QWidget):
    """Follows the document's shop; a file that is dropped on it is read as a tool library."""

    def __init__(self, document: Document) -> None:
        super().__init__()
        self._shop = document.shop
        self.setAcceptDrops(True)
        self.filter = ToolFilterBar(document)
        self.model = ToolModel()
        self.table = tool_view(self.model)
        self.details = ToolDetails(self._shop)
        self.exchange = ExchangePage()
        self.read, self.write = QPushButton(tr("Import…")), QPushButton(tr("Export…"))
        self.read.setToolTip(tr("Read a tool library of another program; or drop one here"))
        self.write.setToolTip(tr("Write the selected tools as a library of another program"))
        self._split, self._stack = QSplitter(Qt.Orientation.Horizontal), QStackedWidget()
        self._wanted: tuple[str, ...] = ()
        self._view: ShopView | None = None
        self._arrange()
        self.filter.changed.connect(self._list)
        self.model.modelAboutToBeReset.connect(self._remember)
        self.model.modelReset.connect(self._select_again)
        self.table.selectionModel().selectionChanged.connect(lambda *_: self._select())
        self.model.ticked.connect(self._tick)
        self.read.clicked.connect(self._choose_library)
        self.write.clicked.connect(self._choose_output)
        self._shop.changed.connect(self.follow)
        self._shop.read.connect(self._show_read)
        self._shop.written.connect(self._show_written)
        self._shop.taken.connect(self._show_taken)
        self.exchange.unit_changed.connect(self._read_again)
        self.exchange.accepted.connect(self._accept)
        self.exchange.closed.connect(lambda: self._stack.setCurrentWidget(self._split))

    def use_theme(self, theme: Theme) -> None:
        """Draw in the colours of a theme."""
        self.details.use_theme(theme)

    def follow(self) -> None:
        """Show the catalogue and the crib as they are now; what is selected stays so."""
        view = self._shop.view
        if view is None:
            return
        if view is not self._view:
            self._view = view
            self.filter.show_view(view)
        self._list()

    def selected_names(self) -> tuple[str, ...]:
        """Return the names of the selected tools, in the order of the table."""
        return tuple(row.name for row in self._selected())

    def reload(self) -> None:
        """Bring back what the crib has, after a change was refused."""
        self._select()

    # Qt's events

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        accept_files(event)

    def dropEvent(self, event: QDropEvent) -> None:
        if file := dropped_file(event):
            self.read_library(file)

    # libraries

    def read_library(self, path: str) -> None:
        """Read a tool library to show what taking it over would bring and lose."""
        self._shop.read_library(path, str(self.exchange.unit.currentData()))

    def library_path(self) -> str:
        """Ask which tool library to read."""
        return QFileDialog.getOpenFileName(
            self, tr("Read a tool library"), "", self._patterns(is_all=True)
        )[0]

    def output_path(self) -> str:
        """Ask where to write the selected tools."""
        return QFileDialog.getSaveFileName(
            self, tr("Write a tool library"), "", self._patterns(is_all=False)
        )[0]

    def _choose_library(self) -> None:
        path = self.library_path()
        if path:
            self.read_library(path)

    def _choose_output(self) -> None:
        path = self.output_path() if self.selected_names() else ""
        if path:
            self._shop.write_library(self.selected_names(), path)

    def _patterns(self, is_all: bool) -> str:
        formats: tuple[FormatRow, ...] = self._shop.view.formats if self._shop.view else ()
        rows = [(f.title, f.suffixes) for f in formats]
        if is_all:
            every = tuple(suffix for f in formats for suffix in f.suffixes)
            rows = [(tr("Tool libraries"), every), *rows]
        return ";;".join(f"{words} ({' '.join(f'*{s}' for s in ends)})" for words, ends in rows)

    def _show_read(self, read: LibraryExchange) -> None:
        self.exchange.show_read(read)
        self._stack.setCurrentWidget(self.exchange)

    def _show_written(self, written: LibraryExchange) -> None:
        self.exchange.show_written(written)
        self._stack.setCurrentWidget(self.exchange)

    def _read_again(self, unit: str) -> None:
        if self.exchange.shown is not None and self._stack.currentWidget() is self.exchange:
            self._shop.read_library(self.exchange.shown.path, unit)

    def _accept(self) -> None:
        if self.exchange.shown is not None:
            unit = str(self.exchange.unit.currentData())
            self._shop.take_library(self.exchange.shown.path, unit)

    def _show_taken(self, taken: LibraryExchange) -> None:
        self._stack.setCurrentWidget(self._split)
        self._wanted = taken.names

    # the table

    def _tick(self, name: str, on: bool) -> None:
        if on:
            self._shop.put(name)
        else:
            self._shop.take(name)

    def _list(self) -> None:
        """List what the filter asks for."""
        view, crib = self._shop.view, self._shop.crib
        if view is None:
            return
        self.model.show_tools(view.tools, crib, self.filter.query)
        self.filter.show_count(len(self.model.listed), len(view.tools), len(crib.tools))
        self._select()

    def _selected(self) -> list[ToolRow]:
        rows = self.table.selectionModel().selectedRows(NAME)
        return [self.model.listed[r] for r in sorted(i.row() for i in rows)]

    def _select(self) -> None:
        rows = self._selected()
        self.details.show_tool(rows[0] if rows else None)
        self.write.setEnabled(bool(rows))

    def _remember(self) -> None:
        """Remember which tools are selected before the rows change, unless others are wanted then."""
        self._wanted = self._wanted or self.selected_names()

    def _select_again(self) -> None:
        wanted, self._wanted = self._wanted, ()
        self.select_tools(wanted)

    def select_tools(self, names: Sequence[str]) -> None:
        """Select the listed ones of some tools, and bring the first into view."""
        wanted, model = frozenset(names), self.table.selectionModel()
        flags = model.SelectionFlag.Select | model.SelectionFlag.Rows
        found = [n for n, row in enumerate(self.model.listed) if row.name in wanted]
        for row in found:
            model.select(self.model.index(row, NAME), flags)
        if found:
            self.table.scrollTo(self.model.index(found[0], NAME))
        self._select()

    def _arrange(self) -> None:
        left = QWidget()
        column = QVBoxLayout(left)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self.table, 1)
        buttons = QHBoxLayout()
        buttons.addWidget(self.read)
        buttons.addWidget(self.write)
        buttons.addStretch(1)
        column.addLayout(buttons)
        self._split.addWidget(left)
        self._split.addWidget(self.details)
        self._split.setStretchFactor(0, 1)
        self._split.setStretchFactor(1, 0)
        self._split.setSizes([_TABLE_WIDTH, _DETAILS_WIDTH])
        self._split.setChildrenCollapsible(False)
        self._stack.addWidget(self._split)
        self._stack.addWidget(self.exchange)
        lines = QVBoxLayout(self)
        lines.setContentsMargins(10, 10, 10, 10)
        lines.addWidget(self.filter)
        lines.addWidget(self._stack, 1)
