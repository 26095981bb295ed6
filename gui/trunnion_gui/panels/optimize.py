"""Panel 5: speeds and feeds, what they gain over the tables, and what the spindle has to give for them."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QBrush, QColor

from trunnion.model.load import SpindleLoad, spindle_loads
from trunnion.model.operation import CuttingData, Operation
from trunnion_gui.i18n import tr
from trunnion_gui.look.colours import Theme
from trunnion_gui.look.words import amount, share
from trunnion_gui.panels.search import SearchBlock, choice_words
from trunnion_gui.widgets import table as tables
from trunnion_gui.widgets.panel import Panel

_MOST_ROWS = 8
_POWER = 3
"""The column of the share of the spindle's power."""
_GAIN = 4
"""The column of the time that is saved over the tables' data."""


class OptimizePanel(Panel):
    """The balance of every operation: spindle speed, feed, power against the machine's limit, and the gain over the tables."""

    command = "step.optimize"

    def build(self) -> None:
        super().build()
        self.table = tables.table([tr("Op"), "n", "vf", tr("Power"), tr("Gain")], has_names=True)
        tips = (
            tr("Operation"),
            tr("Spindle speed, 1/min"),
            tr("Feed, mm/min"),
            tr("Share of the spindle's power, at the highest load"),
            tr("Time saved for the same way, over the data of the material's tables"),
        )
        for column, words in enumerate(tips):
            self.table.model().setHeaderData(
                column, Qt.Orientation.Horizontal, words, Qt.ItemDataRole.ToolTipRole
            )
        self.table.cellClicked.connect(lambda row, _: self._select(row))
        self.content.addWidget(self.table)
        self.search = SearchBlock(self.document)
        self.content.addWidget(self.search)
        self._shown: tuple[object, object, object, object] | None = None
        self._cut: list[Operation] = []

    def use_theme(self, theme: Theme) -> None:
        self.search.use_theme(theme)
        super().use_theme(theme)

    def _select(self, row: int) -> None:
        operation = self._cut[row]
        self.document.selection.select_operation(operation.id)
        self.search.select(operation)

    def _follow(self) -> None:
        """Let the search go on with the operation that it shows as it is now, or with none where that is gone."""
        shown = self.search.operation
        found = next((o for o in self._cut if o.id == shown), None)
        if shown:
            self.search.select(found)

    def fill(self) -> None:
        process = self.document.shown.process
        # A verdict on an earlier plan says nothing of this one's load.
        verdict = (
            self.document.shown.verdict
            if self.document.states.get("verify") in ("done", "problem")
            else None
        )
        # A path of an earlier plan says nothing either.
        is_laid = self.document.states.get("toolpath") in ("done", "problem")
        paths = self.document.shown.paths if is_laid else ()
        self.table.setVisible(process is not None)
        self.search.setVisible(process is not None)
        if self._shown is not None and all(
            a is b for a, b in zip(self._shown, (process, verdict, paths, self.theme), strict=True)
        ):
            return
        self._shown = process, verdict, paths, self.theme
        if process is None:
            self.result.setText("")
            return
        self._cut = cut = [o for o in process.operations if not o.suppressed]
        loads = spindle_loads(cut, verdict, paths)
        rows = [
            (
                o.id,
                amount(o.data.spindle, 0),
                amount(o.data.feed, 0),
                share(load.share),
                gain(o.data),
            )
            for o, load in zip(cut, loads, strict=True)
        ]
        tables.fill(self.table, rows, right=(1, 2, _POWER, _GAIN))
        tables.fit_height(self.table, _MOST_ROWS)
        self._show_overloads(loads)
        self._show_choices()
        self._follow()
        most = max(loads, key=lambda load: load.share, default=None)
        self.result.setText("" if most is None else load_words(most))

    def _show_choices(self) -> None:
        """Say on every gain what was chosen, and what stops a quicker choice."""
        for row, operation in enumerate(self._cut):
            item = self.table.item(row, _GAIN)
            if item is not None:
                item.setToolTip(choice_words(operation))

    def _show_overloads(self, loads: tuple[SpindleLoad, ...]) -> None:
        """Give shares over the whole the colour of what is wrong, and a tip with the figures on every share."""
        for row, load in enumerate(loads):
            item = self.table.item(row, _POWER)
            if item is None:
                continue
            item.setToolTip(load_words(load))
            if load.share > 1.0 and self.theme is not None:
                item.setForeground(QBrush(QColor(self.theme.bad)))


def gain(data: CuttingData) -> str:
    """Return the time that an operation's data save over the tables' in whole per cent, with its sign; empty where they are the tables'."""
    if not data.handbook_feed:
        return ""
    return f"{round(100.0 * data.feed_gain) + 0:+d} %"


def load_words(load: SpindleLoad) -> str:
    """Return an operation's highest load in words: how much, of what, and where."""
    words = tr("highest load: {id}, {power} of {limit} kW")
    if load.measured:
        words = tr(
            "highest load: {id}, {power} of {limit} kW as the proof measured ({steady} kW steady)"
        )
    elif load.at:
        words = tr("highest load: {id}, {power} of {limit} kW where {place} ({steady} kW steady)")
    if load.share > 1.0:
        words = tr("overload: {load}").format(load=words)
    return words.format(
        id=load.operation,
        power=amount(load.highest, 1),
        limit=amount(load.limit, 1),
        steady=amount(load.steady, 1),
        place=tr(load.at),
    )
