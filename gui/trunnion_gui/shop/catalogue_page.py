"""The page of machines or of materials: a table, and beside it the fields of what is selected. Nothing is changed here."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QHBoxLayout, QLabel, QSplitter, QVBoxLayout, QWidget

from trunnion_gui.i18n import tr
from trunnion_gui.shop.tool_details import field_table, fill_fields
from trunnion_gui.widgets import table as tables
from trunnion_gui.worker.shop_requests import CatalogueRow


class CataloguePage(QWidget):
    """Entries of a catalogue by name; `kind` is the title of the column that tells their kind."""

    def __init__(self, kind: str, folder: str) -> None:
        super().__init__()
        self._rows: Sequence[CatalogueRow] = ()
        self.table = tables.table([tr("Name"), kind, tr("Title")], stretched=(2,))
        self.fields = field_table()
        note = QLabel(
            tr(
                "A shop's own ones are TOML files in the folder {folder} of the user's folder"
            ).format(folder=folder)
        )
        note.setObjectName("muted")
        note.setWordWrap(True)
        split = QSplitter(Qt.Orientation.Horizontal)
        split.addWidget(self.table)
        split.addWidget(self.fields)
        split.setStretchFactor(0, 3)
        split.setStretchFactor(1, 2)
        split.setChildrenCollapsible(False)
        lines, below = QVBoxLayout(self), QHBoxLayout()
        lines.setContentsMargins(10, 10, 10, 10)
        lines.addWidget(split, 1)
        below.addWidget(note)
        lines.addLayout(below)
        self.table.itemSelectionChanged.connect(self._select)

    def show_rows(self, rows: Sequence[CatalogueRow]) -> None:
        """Show the entries of a catalogue, the first one selected."""
        listed = sorted(rows, key=lambda r: r.name)
        if listed == self._rows:
            return
        self._rows = listed
        tables.fill(self.table, [(r.name, r.kind, r.title) for r in self._rows])
        if rows:
            self.table.selectRow(0)

    def _select(self) -> None:
        row = self.table.currentRow()
        fill_fields(self.fields, self._rows[row].fields if 0 <= row < len(self._rows) else ())
