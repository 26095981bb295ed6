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
_FIELDS = {
    NAME: "name",
    FORM: "form",
    DIAMETER: "diameter",
    CORNER: "corner_radius",
    FLUTES: "flute_length",
    STICKOUT: "stickout",
    GAUGE: "gauge_length",
}
"""What the columns after the first two have of a row."""
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
    """The tools of the catalogue with the crib of one machine: `rows` all of them, `listed` what a query takes, sorted by a column.

    Filtered and sorted here and not by a proxy of Qt, which would call back for each comparison: seconds for thousands of tools.
    """

    ticked = Signal(str, bool)
    """A person put a tool into the machine, or took it out."""

    def __init__(self) -> None:
        super().__init__()
        self.rows: Sequence[ToolRow] = ()
        self.listed: list[ToolRow] = []
        self.crib = Crib(machine="")
        self._numbers: dict[str, int] = {}
        self._query = ToolQuery()
        self._order = DIAMETER, Qt.SortOrder.AscendingOrder
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

    def show_tools(self, rows: Sequence[ToolRow], crib: Crib, query: ToolQuery) -> None:
        """List the tools that a query takes."""
        self.rows, self.crib, self._query = rows, crib, query
        self._numbers = dict(crib.numbers)
        self._renew()

    def sort(self, column: int, order: Qt.SortOrder = Qt.SortOrder.AscendingOrder) -> None:
        self._order = column, order
        self._renew()

    def is_loaded(self, row: ToolRow) -> bool:
        """Return whether a tool is in the machine."""
        return row.name in self._numbers

    def _renew(self) -> None:
        column, order = self._order
        listed = sorted(
            (r for r in self.rows if self._query.takes(r, self.is_loaded(r))),
            key=lambda r: self._value(r, column),
            reverse=order == Qt.SortOrder.DescendingOrder,
        )
        is_other = len(listed) != len(self.listed) or any(
            a is not b for a, b in zip(listed, self.listed, strict=True)
        )
        if is_other:
            self.beginResetModel()
            self.listed = listed
            self.endResetModel()
        elif listed:
            self.dataChanged.emit(self.index(0, 0), self.index(len(listed) - 1, GAUGE))

    def rowCount(self, parent: Index = _NO_PARENT) -> int:
        return 0 if parent.isValid() else len(self.listed)

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
        row, column = self.listed[index.row()], index.column()
        if role == Qt.ItemDataRole.DisplayRole:
            return self._words(row, column)
        if role == Qt.ItemDataRole.TextAlignmentRole and _is_number(column):
            return RIGHT
        if role == Qt.ItemDataRole.CheckStateRole and column == TICK:
            return Qt.CheckState.Checked if self.is_loaded(row) else Qt.CheckState.Unchecked
        if role == Qt.ItemDataRole.ToolTipRole:
            return row.title or row.name
        return None

    def setData(self, index: Index, value: Any, role: int = Qt.ItemDataRole.EditRole) -> bool:
        if role != Qt.ItemDataRole.CheckStateRole or index.column() != TICK:
            return False
        self.ticked.emit(
            self.listed[index.row()].name, Qt.CheckState(value) == Qt.CheckState.Checked
        )
        return True

    def _words(self, row: ToolRow, column: int) -> str:
        if column == TICK:
            return ""
        if column == NUMBER:
            return str(self._value(row, column) or "")
        if column in (NAME, FORM):
            return row.name if column == NAME else tr(row.form)
        value = self._value(row, column)
        return "" if row.form == _TURNING and value in (0.0, math.inf) else amount(value, 3)

    def _value(self, row: ToolRow, column: int) -> Any:
        if column in (TICK, NUMBER):
            number = self._numbers.get(row.name, 0)
            return number == 0 if column == TICK else number
        value = getattr(row, _FIELDS[column])
        return value or math.inf if column == DIAMETER else value


def tool_view(model: ToolModel) -> QTableView:
    """Return the table of a model, as the window's other tables look."""
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
