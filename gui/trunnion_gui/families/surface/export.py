"""What of a curved part is exported: local features, the remaining area, or some groups, as STEP or IGES. Never modal."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QButtonGroup,
    QDialog,
    QFileDialog,
    QHBoxLayout,
    QLabel,
    QListWidget,
    QListWidgetItem,
    QPushButton,
    QRadioButton,
    QVBoxLayout,
    QWidget,
)

from trunnion_gui.document import Document
from trunnion_gui.families.surface.groups import GROUP, LOCAL, is_local
from trunnion_gui.families.surface.jobs import PatchJobs
from trunnion_gui.i18n import tr
from trunnion_gui.look.colours import feature_colours
from trunnion_gui.widgets.table import colour_icon

REMAINING, SELECTED = "remaining", "chosen"
SUFFIXES = {"STEP": (".step", ".stp"), "IGES": (".igs", ".iges")}
_LINES = 10


class ExportDialog(QDialog):
    """Chooses patches and a format, asks where to, and hands it over."""

    def __init__(self, document: Document, jobs: PatchJobs, parent: QWidget) -> None:
        super().__init__(parent)
        self._document, self._jobs = document, jobs
        self.setWindowTitle(tr("Export patches"))
        self.setModal(False)
        self._ticked: set[str] = set()
        self.parts: dict[str, QRadioButton] = {}
        self.formats: dict[str, QRadioButton] = {}
        self.list = QListWidget()
        self.export_button, self.close_button = QPushButton(tr("Export…")), QPushButton(tr("Close"))
        self.export_button.setObjectName("primary")
        self._lay_out()
        self.export_button.clicked.connect(self.export)
        self.close_button.clicked.connect(self.hide)
        self.list.itemChanged.connect(self._tick)
        document.changed.connect(self.refresh)
        document.jobs.changed.connect(self.refresh)

    def begin(self) -> None:
        """Show the dialog; groups that have selected faces are ticked."""
        self._ticked = {
            f.id
            for f in self._groups()
            if set(f.tags) & set(self._document.selection.current.faces)
        }
        if self._ticked:
            self.parts[SELECTED].setChecked(True)
        self._fill()
        self.refresh()
        self.show()
        self.raise_()

    def words(self) -> tuple[str, ...]:
        """Return what shall be exported, as the engine takes it."""
        part = next(name for name, button in self.parts.items() if button.isChecked())
        return (
            (part,)
            if part != SELECTED
            else tuple(f.id for f in self._groups() if f.id in self._ticked)
        )

    def export(self) -> None:
        """Ask for the file and write it."""
        part, words = self._document.session.part, self.words()
        if part is None or not words:
            return
        kind = next(name for name, button in self.formats.items() if button.isChecked())
        what = words[0] if len(words) == 1 else f"{len(words)}-groups"
        path = self._choose_path(
            f"{Path(part.path).with_suffix('')}.{what}{SUFFIXES[kind][0]}", kind
        )
        if path:
            right = Path(path).suffix.lower() in SUFFIXES[kind]
            self._jobs.export(words, path if right else path + SUFFIXES[kind][0])

    def _choose_path(self, proposed: str, kind: str) -> str:
        """Ask which STEP or IGES file patches are written to; empty when none was chosen. Tests replace this."""
        return QFileDialog.getSaveFileName(
            self.parentWidget(),
            tr("Export patches"),
            proposed,
            f"{kind} (*{' *'.join(SUFFIXES[kind])})",
        )[0]

    def refresh(self) -> None:
        """Show the groups of the shown session, and say how much is chosen."""
        if not self.isVisible() and not self.list.count():
            return
        if [self.list.item(n).text().split()[0] for n in range(self.list.count())] != [
            f.id for f in self._groups()
        ]:
            self._fill()
        words = self.words()
        groups = {
            LOCAL: [f for f in self._groups() if is_local(f)],
            REMAINING: [f for f in self._groups() if not is_local(f)],
        }.get(words[0] if words else "", [f for f in self._groups() if f.id in words])
        self.count.setText(
            tr("{n} faces in {groups} groups").format(
                n=sum(len(f.tags) for f in groups), groups=len(groups)
            )
        )
        self.list.setEnabled(self.parts[SELECTED].isChecked())
        self.export_button.setEnabled(bool(groups) and not self._document.is_busy)

    def _groups(self) -> list:
        found = self._document.shown.recognition
        return list(found.of_kind(GROUP)) if found is not None else []

    def _fill(self) -> None:
        found = self._document.shown.recognition
        colours = feature_colours(found) if found is not None else {}
        self.list.blockSignals(True)
        self.list.clear()
        for f in self._groups():
            item = QListWidgetItem(colour_icon(colours[f.id]), f"{f.id}   {len(f.tags)}")
            item.setData(Qt.ItemDataRole.UserRole, f.id)
            item.setFlags(item.flags() | Qt.ItemFlag.ItemIsUserCheckable)
            item.setCheckState(
                Qt.CheckState.Checked if f.id in self._ticked else Qt.CheckState.Unchecked
            )
            self.list.addItem(item)
        self.list.blockSignals(False)

    def _tick(self, item: QListWidgetItem) -> None:
        id = item.data(Qt.ItemDataRole.UserRole)
        (self._ticked.add if item.checkState() is Qt.CheckState.Checked else self._ticked.discard)(
            id
        )
        self.refresh()

    def _lay_out(self) -> None:
        self.count = QLabel()
        self.count.setObjectName("muted")
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 14, 16, 14)
        column.setSpacing(8)
        self._whats, self._kinds = QButtonGroup(self), QButtonGroup(self)
        for name, words in (
            (LOCAL, tr("Local features")),
            (REMAINING, tr("Remaining area")),
            (SELECTED, tr("These groups")),
        ):
            self.parts[name] = self._radio(words, self._whats)
            column.addWidget(self.parts[name])
        self.list.setFixedHeight(_LINES * 24)
        column.addWidget(self.list)
        column.addWidget(self.count)
        row = QHBoxLayout()
        for name in SUFFIXES:
            self.formats[name] = self._radio(name, self._kinds)
            row.addWidget(self.formats[name])
        row.addStretch(1)
        row.addWidget(self.close_button)
        row.addWidget(self.export_button)
        column.addLayout(row)
        self.parts[LOCAL].setChecked(True)
        self.formats["STEP"].setChecked(True)

    def _radio(self, words: str, group: QButtonGroup) -> QRadioButton:
        made = QRadioButton(words)
        group.addButton(made)
        made.toggled.connect(lambda _: self.refresh())
        return made
