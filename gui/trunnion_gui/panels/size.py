"""Panel 2: the sizes that choose cutters and order. A click shows where a size is."""

from __future__ import annotations

from PySide6.QtCore import Signal

from trunnion_gui.i18n import tr
from trunnion_gui.look.words import amount, kind_words
from trunnion_gui.widgets import table as tables
from trunnion_gui.widgets.panel import Panel

_MOST_ROWS = 8


class SizePanel(Panel):
    """The table of sizes."""

    command = "step.size"
    pointed = Signal(object)
    """The `SizeEntry` that was clicked."""

    def build(self) -> None:
        super().build()
        self.table = tables.table([tr("Size"), tr("Feature"), tr("Value")], has_names=True)
        self.table.cellClicked.connect(lambda row, _: self._point(row))
        self.content.addWidget(self.table)
        self._shown: tuple = ()

    def fill(self) -> None:
        sizes = self.document.shown.sizes
        self.table.setVisible(bool(sizes))
        if sizes is self._shown:
            return
        self._shown = sizes
        self.result.setText(tr("{n} sizes").format(n=len(sizes)) if sizes else "")
        rows = [
            (kind_words(tr(s.name)), s.feature, f"{amount(s.value)} {s.unit}".strip())
            for s in sizes
        ]
        tables.fill(self.table, rows, right=(2,))
        tables.fit_height(self.table, _MOST_ROWS)

    def _point(self, row: int) -> None:
        self.pointed.emit(self.document.shown.sizes[row])
