"""How exact the patches' feature sizes are, and what they cost, by the number of points on each edge (quick segmentation, figure 8)."""

from __future__ import annotations

from PySide6.QtWidgets import QHBoxLayout, QLabel, QSplitter, QTableWidget, QVBoxLayout, QWidget

from trunnion.recognize.surface.accuracy import EXACT, REPAIR
from trunnion_gui.document import Document
from trunnion_gui.families.surface.jobs import PatchJobs
from trunnion_gui.families.surface.requests import Accuracy
from trunnion_gui.i18n import tr
from trunnion_gui.look.colours import Theme
from trunnion_gui.look.words import duration, grouped
from trunnion_gui.widgets import table as tables
from trunnion_gui.widgets.chart import Chart, ChartCurve
from trunnion_gui.widgets.panel import rule


class AccuracyDock(QWidget):
    """A table and a chart of the last measurement; empty until one is requested."""

    def __init__(self, document: Document, jobs: PatchJobs) -> None:
        super().__init__()
        self.shown: Accuracy | None = None
        self.table: QTableWidget = tables.table(
            [tr("Per edge"), tr("Points"), tr("Largest error"), tr("Mean error"), tr("Time")]
        )
        self.chart = Chart()
        self.words = QLabel()
        self.words.setObjectName("muted")
        self.words.setWordWrap(True)
        left = QWidget()
        column = QVBoxLayout(left)
        column.setContentsMargins(0, 0, 0, 4)
        column.addWidget(self.table)
        column.addWidget(rule())
        self.words.setContentsMargins(10, 0, 10, 0)
        column.addWidget(self.words)
        split = QSplitter()
        split.addWidget(left)
        split.addWidget(self.chart)
        split.setSizes([540, 360])
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.addWidget(split)
        jobs.measured.connect(self.show_errors)
        document.mesh_changed.connect(lambda: self.show_errors(None))
        document.redrawn.connect(lambda: self.show_errors(None))
        self.show_errors(None)

    def use_theme(self, theme: Theme) -> None:
        """Draw in the colours of a theme."""
        self.chart.use_theme(theme)

    def show_errors(self, found: Accuracy | None) -> None:
        """Show what was measured, or what to do for it."""
        self.shown = found
        rows = found.rows if found is not None else ()
        tables.fill(
            self.table,
            [
                (
                    row_words(r.on_edge),
                    grouped(r.points),
                    per_cent(r.largest),
                    per_cent(r.mean),
                    duration(r.seconds),
                )
                for r in rows
            ],
            right=(0, 1, 2, 3, 4),
        )
        if found is None:
            self.words.setText(
                tr("Patches › Size error by points measures how exact the feature sizes are.")
            )
            self.chart.show_curves("", (), None, None)
            return
        self.words.setText(
            tr(
                "The file's boundary curves are within {error} of their surfaces (face {face})."
            ).format(error=f"{1000.0 * found.boundary:.3g} µm", face=found.face)
        )
        spread = [r for r in rows if r.on_edge not in (REPAIR, EXACT)]
        repair = next((100.0 * r.largest for r in rows if r.on_edge == REPAIR), None)
        self.chart.show_curves(
            tr("points on an edge"),
            [str(r.on_edge) for r in spread],
            ChartCurve(
                tr("largest error"), tuple(100.0 * r.largest for r in spread), "%", by_powers=True
            ),
            ChartCurve(tr("time"), tuple(r.seconds for r in spread), "s"),
            (repair, tr("the paper's repair")) if repair is not None else None,
        )


def row_words(on_edge: int) -> str:
    """Return what points of a row there are on an edge."""
    if on_edge == EXACT:
        return tr("exact")
    return tr("the paper's repair") if on_edge == REPAIR else str(on_edge)


def per_cent(share: float) -> str:
    """Return a share in per cent, as fine as small ones need.

    >>> per_cent(0.0137), per_cent(0.00000213), per_cent(0.0)
    ('1.37 %', '0.000213 %', '0 %')
    """
    return f"{100.0 * share:.3g} %" if share == 0.0 or share >= 1e-6 else f"{100.0 * share:.6f} %"
