"""Panel 6: toolpaths, the proof, and the files."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QCheckBox, QGridLayout, QHBoxLayout, QLabel, QWidget

from trunnion.model.session import PostedFile, Session
from trunnion.model.verdict import Outcome
from trunnion.post.header import REJECTED
from trunnion_gui.i18n import tr
from trunnion_gui.look.colours import motions
from trunnion_gui.look.words import amount, duration, over_bound, share
from trunnion_gui.widgets.layout import empty
from trunnion_gui.widgets.panel import Panel, rule, swatch
from trunnion_gui.widgets.time_bar import TimeBar

VERDICTS = {Outcome.PASSED: "good", Outcome.REMARKS: "warning", Outcome.FAILED: "bad"}


class GeneratePanel(Panel):
    """Generate, verify, write; and which motions the picture shows."""

    folds_settings = True
    motions_changed = Signal(object)
    """Which kinds of motion are to be seen."""

    def build(self) -> None:
        self._rejected_names: tuple[str, ...] | None = None
        self.content.addLayout(self.settings)
        self.content.addWidget(
            self.buttons("step.generate", "step.verify", primary="step.generate")
        )
        self.verdict = QLabel()
        self.content.addWidget(self.verdict)
        self.rejected = QLabel()
        self.rejected.setObjectName("muted")
        self.rejected.setWordWrap(True)
        self.content.addWidget(self.rejected)
        self._numbers = QGridLayout()
        self._numbers.setHorizontalSpacing(10)
        self._numbers.setVerticalSpacing(2)
        self._numbers.setColumnStretch(0, 1)
        self.content.addLayout(self._numbers)
        self.minutes = TimeBar()
        self.content.addWidget(self.minutes)
        self.content.addWidget(rule())
        self.content.addWidget(self._motions())
        self.content.addWidget(self.button("file.write"))

    def fill(self) -> None:
        verdict = self.document.shown.verdict
        empty(self._numbers)
        self.verdict.setVisible(verdict is not None)
        self._name_rejected()
        self.minutes.show_shares(verdict.time_shares() if verdict is not None else ())
        if verdict is None:
            return
        self.verdict.setText(tr("Verdict: {outcome}").format(outcome=tr(verdict.outcome.value)))
        self.verdict.setProperty("verdict", VERDICTS[verdict.outcome])
        self.verdict.style().unpolish(self.verdict)
        self.verdict.style().polish(self.verdict)
        for n, (words, value) in enumerate(
            (
                (tr("Coverage"), share(verdict.coverage)),
                (tr("Coverage of what cutters reach"), share(verdict.reachable)),
                (tr("Deepest gouge"), f"{amount(verdict.gouge)} mm"),
                (tr("Collisions"), str(verdict.collisions)),
                (tr("Rapids in stock"), str(verdict.rapids_in_stock)),
                (tr("Machining time"), duration(verdict.machining_time_s)),
                (tr("Time over its bound"), over_bound(verdict.over_bound)),
            )
        ):
            label, number = QLabel(words), QLabel(value)
            label.setObjectName("muted")
            self._numbers.addWidget(label, n, 0)
            self._numbers.addWidget(number, n, 1, Qt.AlignmentFlag.AlignRight)

    def _name_rejected(self) -> None:
        """Say under which names the programs of a failed proof are written."""
        session = self.document.shown
        names = _rejected_names(session, self.document.programs)
        if names != self._rejected_names:
            self._rejected_names = names
            self.rejected.setText(
                tr("Must not run, and is written as {files}").format(files=", ".join(names))
                if names
                else ""
            )
            self.rejected.setVisible(bool(names))

    def shown_motions(self) -> tuple[str, ...]:
        """Return the kinds of motion that are ticked."""
        return tuple(name for name, box in self._boxes.items() if box.isChecked())

    def _motions(self) -> QWidget:
        block = QWidget()
        grid = QGridLayout(block)
        grid.setContentsMargins(0, 2, 0, 2)
        grid.setVerticalSpacing(4)
        self._boxes: dict[str, QCheckBox] = {}
        for n, (name, colour) in enumerate(motions().items()):
            box = QCheckBox(tr(name))
            box.setChecked(True)
            box.toggled.connect(lambda _: self.motions_changed.emit(self.shown_motions()))
            self._boxes[name] = box
            cell = QWidget()
            row = QHBoxLayout(cell)
            row.setContentsMargins(0, 0, 0, 0)
            row.addWidget(swatch(colour))
            row.addWidget(box, 1)
            grid.addWidget(cell, n // 3, n % 3)
        return block


def _rejected_names(session: Session, programs: tuple[PostedFile, ...]) -> tuple[str, ...]:
    """Return the names of the files that the proof rejected, as they are written into a folder."""
    if session.part is None or session.verdict is None:
        return ()
    return tuple(f"{session.part.name}.{p.suffix}" for p in programs if REJECTED in p.suffix)
