"""The table of tools: a line a tool with a tick where it is in the machine, sorted and filtered."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from PySide6.QtCore import (
    QAbstractTableModel,
    QModelIndex,
    QPersistentModelIndex,
    QSortFilterProxyModel,
    Qt,
    Signal,
)
from PySide6.QtWidgets import QAbstractItemView, QHeaderView, QTableView

from trunnion.shop.crib import Crib
from trunnion_gui.i18n import tr
from trunnion_gui.look.words import amount
from trunnion_gui.widgets.table import RIGHT
from trunnion_gui.worker.shop_requests import ToolRow

Index = QModelIndex | QPersistentModelIndex
TICK, NUMBER, NAME, FORM, DIAMETER, CORNER, FLUTES, STICKOUT, GAUGE = range(9)
_SORTED = Qt.ItemDataRole.UserRole
"""The role of what columns are sorted by."""
_ENDS = ("flat", "bull", "ball")
END_MILL = "end mill"
_TURNING = "turning"
_WIDTHS = {TICK: 30, NUMBER: 40, FORM: 76, DIAMETER: 52, CORNER: 46}
_NUMBER_WIDTH = 66
"""Pixels of columns; the tool's name takes what remains."""
_NO_PARENT = QModelIndex()


@dataclass(frozen=True, slots=True)
class ToolQuery:
    """Which tools are listed: words that each must have, a form or `END_MILL` (empty: any), a group of ISO 513 (empty: any), diameters
    in mm (0: no limit), and whether only those in the machine."""

    words: str = ""
    form: str = ""
    group: str = ""
    least: float = 0.0
    most: float = 0.0
    only_loaded: bool = False

    def takes(self, row: ToolRow, is_loaded: bool) -> bool:
        """Return whether a tool is listed."""
        return (
            (is_loaded or not self.only_loaded)
            and (self.form in ("", row.form) or (self.form == END_MILL and row.form in _ENDS))
            and (not self.group or self.group in row.suits)
            and self.least <= row.diameter
            and (not self.most or row.diameter <= self.most)
            and all(word in row.searched for word in self.words.lower().split())
        )


class ToolModel(QAbstractTableModel):
    """The tools of the catalogue with the crib of one machine."""

    ticked = Signal(str, bool)
    """A person put a tool into the machine, or took it out."""

    def __init__(self) -> None:
        super().__init__()
        self.rows: Sequence[ToolRow] = ()
        self.crib = Crib(machine="")
        self._titles = (
            "",
            tr("T"),
            tr("Tool"),
            tr("Form"),
            "D",
            "R",
            tr("Flutes"),
            tr("Stickout"),
            tr("Gauge"),
        )

    def show_tools(self, rows: Sequence[ToolRow], crib: Crib) -> None:
        """Show other tools, or the same in another crib."""
        if rows is not self.rows:
            self.beginResetModel()
            self.rows, self.crib = rows, crib
            self.endResetModel()
        elif crib != self.crib:
            self.crib = crib
            if rows:
                self.dataChanged.emit(self.index(0, 0), self.index(len(rows) - 1, GAUGE))

    def rowCount(self, parent: Index = _NO_PARENT) -> int:
        return 0 if parent.isValid() else len(self.rows)

    def columnCount(self, parent: Index = _NO_PARENT) -> int:
        return len(self._titles)

    def headerData(
        self, section: int, orientation: Qt.Orientation, role: int = Qt.ItemDataRole.DisplayRole
    ) -> Any:
        if orientation == Qt.Orientation.Vertical:
            return None
        if role == Qt.ItemDataRole.DisplayRole:
            return self._titles[section]
        if role == Qt.ItemDataRole.TextAlignmentRole and _is_number(section):
            return RIGHT
        return None

    def flags(self, index: Index) -> Qt.ItemFlag:
        flags = super().flags(index)
        return flags | Qt.ItemFlag.ItemIsUserCheckable if index.column() == TICK else flags

    def data(self, index: Index, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        row, column = self.rows[index.row()], index.column()
        if role == Qt.ItemDataRole.DisplayRole:
            return self._words(row, column)
        if role == _SORTED:
            return self._sorted(row, column)
        if role == Qt.ItemDataRole.TextAlignmentRole and _is_number(column):
            return RIGHT
        if role == Qt.ItemDataRole.CheckStateRole and column == TICK:
            is_loaded = self.crib.tool(row.name) is not None
            return Qt.CheckState.Checked if is_loaded else Qt.CheckState.Unchecked
        if role == Qt.ItemDataRole.ToolTipRole:
            return row.title or row.name
        return None

    def setData(self, index: Index, value: Any, role: int = Qt.ItemDataRole.EditRole) -> bool:
        if role != Qt.ItemDataRole.CheckStateRole or index.column() != TICK:
            return False
        self.ticked.emit(self.rows[index.row()].name, Qt.CheckState(value) == Qt.CheckState.Checked)
        return True

    def _words(self, row: ToolRow, column: int) -> str:
        if column == TICK:
            return ""
        if column == NUMBER:
            return str(self._sorted(row, column) or "")
        if column in (NAME, FORM):
            return row.name if column == NAME else tr(row.form)
        value = self._sorted(row, column)
        return "" if row.form == _TURNING and value in (0.0, math.inf) else amount(value, 3)

    def _sorted(self, row: ToolRow, column: int) -> Any:
        loaded = self.crib.tool(row.name)
        return (
            loaded is None,
            loaded.number if loaded is not None else 0,
            row.name,
            row.form,
            row.diameter or math.inf,
            row.corner_radius,
            row.flute_length,
            row.stickout,
            row.gauge_length,
        )[column]


class ToolFilter(QSortFilterProxyModel):
    """The tools that a query takes, sorted by a column."""

    def __init__(self, model: ToolModel) -> None:
        super().__init__()
        self._model, self._query = model, ToolQuery()
        self.setSourceModel(model)
        self.setSortRole(_SORTED)

    def use(self, query: ToolQuery) -> None:
        """List what a query takes."""
        self._query = query
        self.invalidate()

    def filterAcceptsRow(self, source_row: int, source_parent: Index) -> bool:
        row = self._model.rows[source_row]
        return self._query.takes(row, self._model.crib.tool(row.name) is not None)


def tool_view(model: ToolFilter) -> QTableView:
    """Return the table over a filter, as the window's other tables look."""
    made = QTableView()
    made.setObjectName("toolTable")
    made.setModel(model)
    made.setSortingEnabled(True)
    made.sortByColumn(DIAMETER, Qt.SortOrder.AscendingOrder)
    made.verticalHeader().hide()
    made.verticalHeader().setDefaultSectionSize(26)
    made.setShowGrid(False)
    made.setWordWrap(False)
    made.setTextElideMode(Qt.TextElideMode.ElideMiddle)
    made.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
    made.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
    header = made.horizontalHeader()
    header.setHighlightSections(False)
    header.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
    for column in range(model.columnCount()):
        header.setSectionResizeMode(column, QHeaderView.ResizeMode.Interactive)
        header.resizeSection(column, _WIDTHS.get(column, _NUMBER_WIDTH))
    header.setSectionResizeMode(NAME, QHeaderView.ResizeMode.Stretch)
    return made


def _is_number(column: int) -> bool:
    return column == NUMBER or column >= DIAMETER
