"""Areas and measured times of a person's own, and what a larger cutter for some of them gains: a foldout below the times of areas."""

from __future__ import annotations

from PySide6.QtCore import QSignalBlocker, Qt
from PySide6.QtWidgets import (
    QFileDialog,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QWidget,
)

from trunnion.units import timed
from trunnion_gui.document import Document
from trunnion_gui.families.surface import requests
from trunnion_gui.families.surface.groups import GROUP
from trunnion_gui.families.surface.requests import CutterFigures, EfficiencyFigures
from trunnion_gui.form import ChoiceField
from trunnion_gui.i18n import tr
from trunnion_gui.widgets.foldout import Foldout
from trunnion_gui.worker.worker import Reply

CUTTERS = ("large", "small")
NARROW = 60
"""px that a field needs at least in a narrow panel."""
FIELDS = ("areas", "measured_area", "measured_time")


class EfficiencyBlock(Foldout):
    """Fields for two cutters, the estimates of a file to begin with, and the gain in words; hidden while there are no groups of patches."""

    def __init__(self, document: Document) -> None:
        super().__init__(tr("Own areas and times"), is_group=True)
        self._document, self._worker = document, document.jobs.worker
        self._listing, self._computing = 0, 0
        self._known: tuple[EfficiencyFigures, ...] = ()
        self.choice, self.open_button = ChoiceField(), QPushButton(tr("Open…"))
        self.open_button.setToolTip(tr("Areas and measured times from a file (.toml)"))
        self.fields = {(c, f): QLineEdit() for c in CUTTERS for f in FIELDS}
        self.words = QLabel()
        self.words.setWordWrap(True)
        self._lay_out()
        self.choice.activated.connect(self._choose)
        self.open_button.clicked.connect(self._open)
        for field in self.fields.values():
            field.textEdited.connect(self._compute)
        self.toggled.connect(self._list_examples)
        self._worker.replied.connect(self._receive)
        document.changed.connect(self._follow)
        self.hide()

    def figures(self, cutter: str) -> CutterFigures:
        """Return what is typed of one cutter."""
        return CutterFigures(**{f: self.fields[cutter, f].text() for f in FIELDS})

    def _follow(self) -> None:
        found = self._document.shown.recognition
        self.setVisible(found is not None and bool(found.of_kind(GROUP)))

    def _list_examples(self, is_open: bool) -> None:
        if is_open and not self._known:
            self._listing = self._worker.send(requests.example_efficiencies)

    def _open(self) -> None:
        if path := self._choose_path():
            self._listing = self._worker.send(requests.read_efficiencies, path)

    def _choose_path(self) -> str:
        """Ask which file has the figures; empty when none was chosen. Tests replace this."""
        return QFileDialog.getOpenFileName(
            self.window(), tr("Open areas and times"), "", "TOML (*.toml)"
        )[0]

    def _choose(self, row: int) -> None:
        """Show the figures of an estimate that is known, and its gain."""
        known = self._known[row]
        for cutter in CUTTERS:
            for name in FIELDS:
                field = self.fields[cutter, name]
                field.setText(getattr(getattr(known, cutter), name))
                field.setCursorPosition(0)
        self._compute()

    def _compute(self) -> None:
        self._computing = self._worker.send(requests.efficiency, *map(self.figures, CUTTERS))

    def _receive(self, reply: Reply) -> None:
        if not reply.is_last or reply.number not in (self._listing, self._computing):
            return
        if reply.kind != "done":
            self.words.setText(reply.text)
        elif reply.number == self._listing:
            self._show_known(reply.value)
        else:
            self.words.setText(gain_words(reply.value))

    def _show_known(self, known: tuple[EfficiencyFigures, ...]) -> None:
        self._known = known
        with QSignalBlocker(self.choice):
            self.choice.clear()
            self.choice.addItems([e.name for e in known])
            for row, estimate in enumerate(known):
                self.choice.setItemData(row, estimate.title, Qt.ItemDataRole.ToolTipRole)
        self._choose(0)

    def _lay_out(self) -> None:
        row = QHBoxLayout()
        row.addWidget(self.choice, 1)
        row.addWidget(self.open_button)
        self.content.addLayout(row)
        body = QWidget()
        grid = QGridLayout(body)
        grid.setContentsMargins(0, 0, 0, 0)
        titles = (tr("Large cutter"), tr("Small cutter"))
        labels = (tr("Areas, mm²"), tr("Measured area, mm²"), tr("Measured time"))
        for column, title in enumerate(titles):
            grid.addWidget(QLabel(title), 0, column)
        for n, (name, words) in enumerate(zip(FIELDS, labels, strict=True)):
            label = QLabel(words)
            label.setObjectName("muted")
            grid.addWidget(label, 2 * n + 1, 0, 1, len(CUTTERS))
            for column, cutter in enumerate(CUTTERS):
                self.fields[cutter, name].setMinimumWidth(NARROW)
                grid.addWidget(self.fields[cutter, name], 2 * n + 2, column)
        self.content.addWidget(body)
        self.content.addWidget(self.words)


def gain_words(found: EfficiencyFigures) -> str:
    """Return in words what cutters of their own gain over the small one."""
    words = tr(
        "small cutter alone {alone}, both cutters {both}: {gain} % more efficient, {saving} % of the time saved"
    )
    return words.format(
        alone=timed(float(round(found.seconds_alone))),
        both=timed(float(round(found.seconds))),
        gain=f"{100.0 * found.gain:.2f}",
        saving=f"{100.0 * found.saving:.2f}",
    )
