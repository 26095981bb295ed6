"""Panel 5: speeds, feeds and what the spindle has to give for them."""

from __future__ import annotations

from trunnion.model.operation import Operation
from trunnion_gui.i18n import tr
from trunnion_gui.widgets import table as tables
from trunnion_gui.widgets.panel import Panel
from trunnion_gui.words import amount, share

_MOST_ROWS = 8


class OptimizePanel(Panel):
    """The balance of every operation: spindle speed, feed, power against the machine's limit."""

    command = "step.optimize"

    def build(self) -> None:
        super().build()
        self.table = tables.table([tr("Op"), "n 1/min", "vf mm/min", tr("Power")])
        self.table.cellClicked.connect(lambda row, _: self.document.select_operation(self._cut[row].id))
        self.content.addWidget(self.table)
        self._shown: object = None
        self._cut: list[Operation] = []

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
