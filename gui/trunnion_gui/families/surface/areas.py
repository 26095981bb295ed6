"""The time of areas by their rates, and what cutters of their own gain: a block below the balance of operations."""

from __future__ import annotations

from PySide6.QtWidgets import QLabel, QVBoxLayout, QWidget

from trunnion_gui.document import Document
from trunnion_gui.families.surface.requests import EstimatedTimes
from trunnion_gui.i18n import tr
from trunnion_gui.look.words import amount, duration
from trunnion_gui.widgets import table as tables

_MOST_ROWS = 8


class AreasBlock(QWidget):
    """A table of the areas that are finished and of each feature's total, and the gain over one cutter in words; hidden where
    there are none."""

    def __init__(self, document: Document) -> None:
        super().__init__()
        self._finished: list[str] = []
        self._selection = document.selection
        self.table = tables.table([tr("Area of"), "mm²", "mm²/s", tr("Time")], has_names=True)
        self.table.cellClicked.connect(lambda row, _: self._select(row))
        self.gain = QLabel()
        self.gain.setWordWrap(True)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(8)
        column.addWidget(self.table)
        column.addWidget(self.gain)
        self.hide()

    def show_estimate(self, found: EstimatedTimes | None) -> None:
        """Show how long each area takes by its rate, and the gain over the smallest cutter alone; nothing where no areas are finished."""
        self.setVisible(found is not None)
        if found is None:
            return
        self._finished = [a.operation for a in found.rows]
        rows = [
            (
                a.operation or tr("{feature} in all").format(feature=tr(a.feature)),
                amount(a.area, 1) if a.area else tr("rest"),
                amount(a.rate, 2) if a.rate else "",
                duration(a.seconds),
            )
            for a in found.rows
        ]
        tables.fill(self.table, rows, right=(1, 2, 3))
        tables.fit_height(self.table, _MOST_ROWS)
        words = tr(
            "{tool} alone, each area at its own rate for such places: {alone}; with their own cutters {own}: {gain} % more efficient, "
            "{saving} % of the time saved ({source})"
        )
        self.gain.setText(
            words.format(
                tool=found.alone,
                alone=duration(found.seconds_alone),
                own=duration(found.seconds),
                gain=f"{100.0 * found.gain:.2f}",
                saving=f"{100.0 * found.saving:.2f}",
                source=tr("measured on the toolpaths")
                if found.is_measured
                else tr("from feed and distance of passes"),
            )
        )

    def _select(self, row: int) -> None:
        if self._finished[row]:
            self._selection.select_operation(self._finished[row])
