"""Panel 1: the part, its family, and what was found on it."""

from __future__ import annotations

from PySide6.QtWidgets import QComboBox, QLabel

from trunnion.model.session import PartInfo
from trunnion.report.palette import GROUP
from trunnion_gui.i18n import tr
from trunnion_gui.widgets.panel import Panel
from trunnion_gui.words import amount, counted, share


class RecognizePanel(Panel):
    """Choose, recognize, and see the counts."""

    command = "step.recognize"

    def build(self) -> None:
        self.part = QLabel()
        self.part.setWordWrap(True)
        self.content.addWidget(self.part)
        self.solid = QComboBox()
        self.solid.setToolTip(tr("Which solid of the file is the part"))
        self.solid.activated.connect(self._choose_solid)
        self.content.addWidget(self.solid)
        super().build()

    def fill(self) -> None:
        part, found = self.document.shown.part, self.document.shown.recognition
        if part is None:
            self.part.setText(tr("No part is open."))
            self.solid.hide()
        else:
            self._fill_solids(part)
            size = " × ".join(amount(v, 1) for v in part.high - part.low)
            self.part.setText(f"<b>{part.name}</b><br>{size} mm · {part.n_faces} {tr('faces')}")
        if found is None:
            self.result.setText("")
            return
        counts = " · ".join(counted(n, tr(kind)) for kind, n in found.counts().items())
        loose = "" if not found.unexplained else "<br>" + tr("{n} faces unexplained ({share} of the area)").format(
            n=len(found.unexplained), share=share(found.unexplained_share))
        local = sum(bool(f.attributes.get("local")) for f in found.of_kind(GROUP))
        of_them = tr(", {n} of them local features").format(n=local) if local else ""
        self.result.setText(f"{tr('Family')} {tr(found.family)}: {counts}{of_them}{loose}")

    def _fill_solids(self, part: PartInfo) -> None:
        self.solid.setVisible(part.n_solids > 1)
        if self.solid.count() != part.n_solids:
            self.solid.clear()
            self.solid.addItems([tr("Solid {n} of {all}").format(n=n + 1, all=part.n_solids) for n in range(part.n_solids)])
        self.solid.setCurrentIndex(part.solid - 1)

    def _choose_solid(self, row: int) -> None:
        """Open the file again with another solid: it is another part."""
        part = self.document.session.part
        if part is not None and part.solid != row + 1:
            self.document.open(self.document.path, solid=row + 1)
