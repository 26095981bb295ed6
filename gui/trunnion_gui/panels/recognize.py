"""Panel 1: the part, its family, and what was found on it."""

from __future__ import annotations

from PySide6.QtWidgets import QLabel

from trunnion_gui.i18n import tr
from trunnion_gui.widgets.panel import Panel
from trunnion_gui.words import amount, counted, share


class RecognizePanel(Panel):
    """Choose, recognize, and see the counts."""

    command = "step.recognize"
    folds_settings = True

    def build(self) -> None:
        self.part = QLabel()
        self.part.setWordWrap(True)
        self.content.addWidget(self.part)
        super().build()

    def fill(self) -> None:
        part, found = self.document.shown.part, self.document.shown.recognition
        if part is None:
            self.part.setText(tr("No part is open."))
        else:
            size = " × ".join(amount(v, 1) for v in part.high - part.low)
            solids = "" if part.n_solids <= 1 else " · " + tr("solid {n} of {all}").format(n=part.solid, all=part.n_solids)
            self.part.setText(f"<b>{part.name}</b><br>{size} mm · {part.n_faces} {tr('faces')}{solids}")
        if found is None:
            self.result.setText("")
            return
        counts = " · ".join(counted(n, tr(kind)) for kind, n in found.counts().items())
        loose = "" if not found.unexplained else "<br>" + tr("{n} faces unexplained ({share} of the area)").format(
            n=len(found.unexplained), share=share(found.unexplained_share))
        self.result.setText(f"{tr('Family')} {tr(found.family)}: {counts}{loose}")
