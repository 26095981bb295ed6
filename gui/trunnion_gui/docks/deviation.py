"""The worst places of the deviation map; a click goes there."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QLabel, QStackedLayout, QTableWidget, QWidget

from trunnion.report.deviation import WorstPoint
from trunnion_gui.document import Document
from trunnion_gui.i18n import tr
from trunnion_gui.look import icons
from trunnion_gui.look.colours import Theme
from trunnion_gui.look.words import fine_amount
from trunnion_gui.widgets import table as tables
from trunnion_gui.worker.drawing import DrawnMap


class DeviationDock(QWidget):
    """One row a place: what is wrong, how much, on which face of which feature, where."""

    picked = Signal(object)
    """A `WorstPoint` that a person wants to see."""

    def __init__(self, document: Document) -> None:
        super().__init__()
        self._document = document
        self._theme: Theme | None = None
        self.shown: DrawnMap | None = None
        self.worst_points: tuple[WorstPoint, ...] = ()
        self.table: QTableWidget = tables.table(
            ["", tr("Deviation"), tr("Face"), tr("Feature"), "x", "y", "z"], stretched=(0, 3)
        )
        self.empty = QLabel()
        self.empty.setObjectName("muted")
        self.empty.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.empty.setWordWrap(True)
        self._stack = QStackedLayout(self)
        self._stack.addWidget(self.table)
        self._stack.addWidget(self.empty)
        self.table.cellClicked.connect(lambda row, _: self.picked.emit(self.worst_points[row]))

    def use_theme(self, theme: Theme) -> None:
        """Draw in the colours of a theme."""
        self._theme = theme
        self.show_map(self.shown)

    def show_map(self, shown: DrawnMap | None) -> None:
        """List the worst places of a map."""
        self.shown = shown
        self.worst_points = shown.map.worst if shown is not None else ()
        rows, drawn = [], []
        for worst in self.worst_points:
            is_gouge = worst.deviation < 0.0
            rows.append(
                (
                    tr("gouge") if is_gouge else tr("material left"),
                    fine_amount(worst.deviation),
                    str(worst.face),
                    self._feature(worst.face),
                    *(f"{v:.2f}" for v in worst.point),
                )
            )
            drawn.append(icons.icon("gouge" if is_gouge else "left_over", self._colour(is_gouge)))
        tables.fill(self.table, rows, right=(1, 2, 4, 5, 6), icons=drawn)
        self.empty.setText(self._nothing())
        self._stack.setCurrentWidget(self.table if rows else self.empty)

    def _nothing(self) -> str:
        """Return why the list is empty."""
        if self.shown is None:
            return tr("The worst places stand here while the deviation map is shown.")
        low, high = fine_amount(self.shown.map.low), fine_amount(self.shown.map.high)
        return tr(
            "Nothing to list: every place that was measured lies between {low} and {high}."
        ).format(low=low, high=high)

    def _colour(self, is_gouge: bool) -> str:
        return "" if self._theme is None else self._theme.bad if is_gouge else self._theme.accent

    def _feature(self, tag: int) -> str:
        owners = [f for f in self._document.shown.recognition or () if tag in f.tags]
        return min(owners, key=lambda f: len(f.tags)).id if owners else ""
