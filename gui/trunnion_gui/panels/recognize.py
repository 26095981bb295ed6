"""Panel 1: the part, its family, and what was found on it."""

from __future__ import annotations

from html import escape

from PySide6.QtWidgets import QComboBox, QHBoxLayout, QLabel, QPushButton, QWidget

from trunnion.model.feature import Recognition, TakenFor
from trunnion.model.session import PartInfo
from trunnion_gui.i18n import tr
from trunnion_gui.look.colours import kind_label
from trunnion_gui.look.words import amount, counted, share
from trunnion_gui.widgets.layout import empty
from trunnion_gui.widgets.panel import Panel

FAMILY, AUTOMATIC = "recognize.family", "auto"
"""The setting that chooses a family, and its value that leaves the choice to the program."""


class RecognizePanel(Panel):
    """Choose, recognize, see what the part was taken for and the counts; go on as a family where recognition stopped."""

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
        self.go_on = QWidget()
        self._actions = QHBoxLayout(self.go_on)
        self._actions.setContentsMargins(0, 0, 0, 0)
        self._actions.setSpacing(6)
        self._offered: tuple[str, ...] = ()
        self.content.addWidget(self.go_on)

    def fill(self) -> None:
        part, found = self.document.shown.part, self.document.shown.recognition
        if part is None:
            self.part.setText(tr("No part is open."))
            self.solid.hide()
        else:
            self._fill_solids(part)
            size = " × ".join(amount(v, 1) for v in part.high - part.low)
            self.part.setText(f"<b>{part.name}</b><br>{size} mm · {part.n_faces} {tr('faces')}")
        self._offer(found)
        if found is None:
            self.result.setText("")
            return
        counts = " · ".join(counted(n, tr(kind_label(kind))) for kind, n in found.counts().items())
        loose = (
            ""
            if not found.unexplained
            else "<br>"
            + tr("{n} faces unexplained ({share} of the area)").format(
                n=len(found.unexplained), share=share(found.unexplained_share)
            )
        )
        taken = f"{_taken(found.taken_for)}<br>" if found.taken_for is not None else ""
        counted_up = tr("Nothing was recognized.")
        if found.features:
            counted_up = f"{tr('Family')} {tr(found.family)}: {counts}{self.views.remarks(found)}"
        self.result.setText(f"{taken}{counted_up}{loose}")

    def _offer(self, found: Recognition | None) -> None:
        """Offer to go on as one of the families there are while recognition doubts what the part is, its own choice first."""
        families = self._served() if found is not None and found.doubt else ()
        offered = tuple(sorted(families, key=lambda name: found is None or name != found.family))
        if offered != self._offered:
            self._offered = offered
            empty(self._actions)
            for name in offered:
                button = QPushButton(tr("Go on as {family}").format(family=tr(name)))
                button.setProperty("family", name)
                button.setToolTip(tr("Choose this family of parts and recognize again"))
                button.clicked.connect(lambda _=False, family=name: self._go_on_as(family))
                self._actions.addWidget(button)
        self.go_on.setVisible(bool(offered))
        self.go_on.setEnabled(not self.document.is_busy)

    def _served(self) -> tuple[str, ...]:
        """Return the families there are, from the setting that chooses one."""
        declared = (
            s
            for g in self.document.groups.get("recognize", ())
            for s in g.settings
            if s.key == FAMILY
        )
        return tuple(str(name) for s in declared for name in s.choices if name != AUTOMATIC)

    def _go_on_as(self, family: str) -> None:
        """Choose a family, which can be undone, and recognize the part as one of it."""
        self.document.choose(FAMILY, f"{tr('Family')}: {tr(family)}", family)
        self.document.run("recognize", tr("Recognize"))

    def _fill_solids(self, part: PartInfo) -> None:
        self.solid.setVisible(part.n_solids > 1)
        if self.solid.count() != part.n_solids:
            self.solid.clear()
            self.solid.addItems(
                [
                    tr("Solid {n} of {all}").format(n=n + 1, all=part.n_solids)
                    for n in range(part.n_solids)
                ]
            )
        self.solid.setCurrentIndex(part.solid - 1)

    def _choose_solid(self, row: int) -> None:
        """Open the file again with another solid: it is another part."""
        part = self.document.session.part
        if part is not None and part.solid != row + 1:
            self.document.files.open(self.document.files.path, solid=row + 1)


def _taken(taken: TakenFor) -> str:
    """Return what a part was taken for, how sure and why, as a line of rich text."""
    words = tr("Taken for {noun} ({sure}): {reason}")
    return words.format(
        noun=escape(tr(taken.noun)), sure=f"{taken.score:.2f}", reason=escape(taken.reason)
    )
