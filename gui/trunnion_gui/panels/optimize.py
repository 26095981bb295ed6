"""Panel 5: speeds, feeds and what the spindle has to give for them; for curved parts, what cutters of their own gain."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QLabel

from trunnion.model.operation import Operation
from trunnion_gui.i18n import tr
from trunnion_gui.verbs import Estimated
from trunnion_gui.widgets import table as tables
from trunnion_gui.widgets.panel import Panel
from trunnion_gui.words import amount, duration, share

_MOST_ROWS = 8


class OptimizePanel(Panel):
    """The balance of every operation: spindle speed, feed, power against the machine's limit. Below it the time of areas by their rates."""

    command = "step.optimize"

    def build(self) -> None:
        super().build()
        self.table = tables.table([tr("Op"), "n", "vf", tr("Power")], has_names=True)
        tips = tr("Operation"), tr("Spindle speed, 1/min"), tr("Feed, mm/min"), tr("Share of the spindle's power")
        for column, words in enumerate(tips):
            self.table.model().setHeaderData(column, Qt.Orientation.Horizontal, words, Qt.ItemDataRole.ToolTipRole)
        self.table.cellClicked.connect(lambda row, _: self.document.select_operation(self._cut[row].id))
        self.content.addWidget(self.table)
        self.areas = tables.table([tr("Area of"), "mm²", "mm²/s", tr("Time")], has_names=True)
        self.areas.cellClicked.connect(lambda row, _: self.document.select_operation(self._finished[row]))
        self.gain = QLabel()
        self.gain.setWordWrap(True)
        for widget in (self.areas, self.gain):
            self.content.addWidget(widget)
            widget.hide()
        self._shown: object = None
        self._cut: list[Operation] = []
        self._finished: list[str] = []

    def fill(self) -> None:
        process = self.document.shown.process
        self.table.setVisible(process is not None)
        if process is self._shown:
            return
        self._shown = process
        if process is None:
            self.result.setText("")
            return
        self._cut = cut = [o for o in process.operations if not o.suppressed]
        rows = [(o.id, amount(o.data.spindle, 0), amount(o.data.feed, 0), share(o.data.power / o.data.power_limit)) for o in cut]
        tables.fill(self.table, rows, right=(1, 2, 3))
        tables.fit_height(self.table, _MOST_ROWS)
        most = max(cut, key=lambda o: o.data.power / o.data.power_limit, default=None)
        if most is not None:
            self.result.setText(tr("highest load: {id}, {power} of {limit} kW").format(
                id=most.id, power=amount(most.data.power, 1), limit=amount(most.data.power_limit, 1)))

    def show_estimate(self, found: Estimated | None) -> None:
        """Show how long each area takes by its rate, and the gain over the slowest cutter alone; nothing where no areas are finished."""
        self.areas.setVisible(found is not None)
        self.gain.setVisible(found is not None)
        if found is None:
            return
        self._finished = [a.operation for a in found.rows]
        rows = [(a.operation, amount(a.area, 1), amount(a.rate, 2), duration(a.seconds)) for a in found.rows]
        tables.fill(self.areas, rows, right=(1, 2, 3))
        tables.fit_height(self.areas, _MOST_ROWS)
        words = tr("{tool} alone: {alone}; with their own cutters {own}: {gain} % more efficient, {saving} % of the time saved ({source})")
        self.gain.setText(words.format(
            tool=found.alone, alone=duration(found.seconds_alone), own=duration(found.seconds), gain=f"{100.0 * found.gain:.2f}",
            saving=f"{100.0 * found.saving:.2f}",
            source=tr("measured on the toolpaths") if found.is_measured else tr("from feed and distance of passes")))
