"""How the optimiser's search went for one operation: its convergence, and the Pareto front of time against cost or load."""

from __future__ import annotations

from PySide6.QtWidgets import QLabel

from trunnion.model.operation import Operation
from trunnion_gui.document import Document
from trunnion_gui.i18n import tr
from trunnion_gui.look.colours import Theme
from trunnion_gui.look.words import amount, share
from trunnion_gui.widgets.foldout import Foldout
from trunnion_gui.widgets.plot import Plot, PlotMark
from trunnion_gui.worker import optimization
from trunnion_gui.worker.optimization import SearchFigures
from trunnion_gui.worker.worker import Reply


class SearchBlock(Foldout):
    """Words and two plots for the operation that is selected; while it is open, another selection is searched for anew."""

    def __init__(self, document: Document) -> None:
        super().__init__(tr("Search"), is_group=True)
        self._document, self._worker = document, document.jobs.worker
        self._operation: Operation | None = None
        self._requested = 0
        self.words = QLabel(tr("Select an operation in the table"))
        self.words.setWordWrap(True)
        self.words.setObjectName("muted")
        self.convergence, self.front = Plot(), Plot()
        for widget in (self.words, self.convergence, self.front):
            self.content.addWidget(widget)
        self._show_plots(False)
        self.toggled.connect(lambda _: self._search())
        self._worker.replied.connect(self._receive)

    @property
    def operation(self) -> str:
        """The id of the operation that is shown; empty for none."""
        return self._operation.id if self._operation is not None else ""

    def use_theme(self, theme: Theme) -> None:
        super().use_theme(theme)
        for plot in (self.convergence, self.front):
            plot.use_theme(theme)

    def select(self, operation: Operation | None) -> None:
        """Show the search for an operation; None for none."""
        if operation == self._operation:
            return
        self._operation = operation
        self._show_plots(False)
        self.words.setText("" if operation is not None else tr("Select an operation in the table"))
        self._search()

    def _search(self) -> None:
        if self._operation is None or self.is_folded:
            return
        self.words.setText(tr("searching…"))
        session = self._document.shown
        self._requested = self._worker.send(optimization.search, session, self._operation.id)

    def _receive(self, reply: Reply) -> None:
        if not reply.is_last or reply.number != self._requested:
            return
        if reply.kind == "done":
            self._show(reply.value)
        else:
            self.words.setText(reply.text)

    def _show(self, found: SearchFigures) -> None:
        operation = self._operation
        if operation is None or found.tables is None or found.optimum is None:
            self.words.setText(
                tr(
                    "the data of the tables stay: no choice keeps the limits, or there are no models"
                )
            )
            return
        self.words.setText(choice_words(operation))
        generations = [(float(n), m) for n, m in enumerate(found.convergence, 1)]
        self.convergence.show_points(tr("generation"), tr("objective M"), generations)
        other = tr("load, %") if found.by_load else tr("cost a metre")
        marks = (
            PlotMark(*found.tables, tr("tables")),
            PlotMark(*found.optimum, tr("optimum"), is_optimum=True),
        )
        self.front.show_points(tr("time, s a metre"), other, found.front, marks)
        self._show_plots(True)

    def _show_plots(self, are_visible: bool) -> None:
        self.convergence.setVisible(are_visible)
        self.front.setVisible(are_visible)


def choice_words(operation: Operation) -> str:
    """Return in words what was chosen for an operation, what the tables have, and what stops a quicker choice."""
    data = operation.data
    if not data.handbook_feed:
        return tr("{id}: data of the tables").format(id=operation.id)
    words = tr(
        "{id}: {spindle} 1/min and {feed} mm/min instead of {old_spindle} and {old_feed}; {gain} less time for the same way; "
        "bound by {bound}"
    )
    return words.format(
        id=operation.id,
        spindle=amount(data.spindle, 0),
        feed=amount(data.feed, 0),
        old_spindle=amount(data.handbook_spindle, 0),
        old_feed=amount(data.handbook_feed, 0),
        gain=share(data.feed_gain),
        bound=", ".join(tr(name) for name in data.bound_by.split(", ")),
    )
