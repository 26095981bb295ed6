"""Tables and trees as the window has them: flat, no grid, numbers right-aligned."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TypeVar

from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QIcon, QPainter, QPixmap
from PySide6.QtWidgets import (
    QAbstractItemView,
    QHeaderView,
    QTableWidget,
    QTableWidgetItem,
    QTreeWidget,
    QTreeWidgetItem,
)

Tree = TypeVar("Tree", bound=QTreeWidget)
RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter


def tree(headers: Sequence[str], stretched: int = 0, kind: type[Tree] = QTreeWidget) -> Tree:  # type: ignore[assignment]
    """Return an empty tree (of a class of one's own) with its columns; one of them takes the room that is left."""
    made = kind()
    made.setHeaderLabels(list(headers))
    made.setUniformRowHeights(True)
    made.setTextElideMode(Qt.TextElideMode.ElideMiddle)  # names of one kind differ at their ends
    made.setIndentation(12)
    made.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
    made.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
    made.header().setStretchLastSection(False)
    for column in range(len(headers)):
        mode = (
            QHeaderView.ResizeMode.Stretch
            if column == stretched
            else QHeaderView.ResizeMode.ResizeToContents
        )
        made.header().setSectionResizeMode(column, mode)
    return made


def select_row(made: QTreeWidget, item: QTreeWidgetItem | None) -> None:
    """Select a row of a tree and bring it into view, or none; without a signal."""
    made.blockSignals(True)
    if item is None:
        made.clearSelection()
    else:
        made.setCurrentItem(item)
        made.scrollToItem(item)
    made.blockSignals(False)


def table(
    headers: Sequence[str], stretched: Sequence[int] = (0,), has_names: bool = False
) -> QTableWidget:
    """Return an empty table with its columns; some of them share the room that is left. Names that don't fit keep beginning and end."""
    made = QTableWidget(0, len(headers))
    made.setHorizontalHeaderLabels(list(headers))
    made.verticalHeader().hide()
    made.verticalHeader().setDefaultSectionSize(26)
    made.setShowGrid(False)
    made.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
    made.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
    made.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
    made.setHorizontalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
    made.setWordWrap(False)
    if has_names:
        made.setTextElideMode(Qt.TextElideMode.ElideMiddle)
    header = made.horizontalHeader()
    header.setHighlightSections(False)
    header.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
    for column in range(len(headers)):
        mode = (
            QHeaderView.ResizeMode.Stretch
            if column in stretched
            else QHeaderView.ResizeMode.ResizeToContents
        )
        header.setSectionResizeMode(column, mode)
    return made


def fill(
    made: QTableWidget,
    rows: Iterable[Sequence[str]],
    right: Sequence[int] = (),
    icons: Sequence[QIcon] = (),
) -> None:
    """Put rows of words into a table; the columns in `right` are right-aligned, the first column has the icons."""
    listed = list(rows)
    made.setRowCount(len(listed))
    for column in right:
        header = made.horizontalHeaderItem(column)
        if header is not None:
            header.setTextAlignment(RIGHT)
    for r, row in enumerate(listed):
        for c, words in enumerate(row):
            item = QTableWidgetItem(words)
            item.setToolTip(words)
            if c in right:
                item.setTextAlignment(RIGHT)
            if c == 0 and r < len(icons):
                item.setIcon(icons[r])
            made.setItem(r, c, item)


def fit_height(made: QTableWidget, most: int) -> None:
    """Make a table as high as its rows, at most so many."""
    rows = min(made.rowCount(), most) * made.verticalHeader().defaultSectionSize()
    made.setFixedHeight(made.horizontalHeader().sizeHint().height() + rows + 4)


def colour_icon(colour: str) -> QIcon:
    """Return a small square in a colour as an icon."""
    picture = QPixmap(24, 24)
    picture.fill(QColor(0, 0, 0, 0))
    painter = QPainter(picture)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setBrush(QColor(colour))
    painter.setPen(Qt.PenStyle.NoPen)
    painter.drawRoundedRect(3, 3, 18, 18, 4, 4)
    painter.end()
    return QIcon(picture)
