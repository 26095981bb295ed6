"""The lines above the table of tools: the machine, whether plans use its tools alone, and which tools are listed."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QCheckBox, QHBoxLayout, QLabel, QLineEdit, QVBoxLayout, QWidget

from trunnion_gui.document import Document
from trunnion_gui.document.shop import ONLY_IN_MACHINE
from trunnion_gui.form import ChoiceField, NumberField
from trunnion_gui.i18n import tr
from trunnion_gui.shop.tool_table import END_MILL, ToolQuery
from trunnion_gui.worker.shop_requests import ShopView

_WIDEST = 1000.0
"""mm: no cutter is wider."""
_CHOICE_WIDTH, _GROUPS_WIDTH = 124, 320
"""Pixels of a choice, and of the list of groups when it is open."""


class ToolFilterBar(QWidget):
    """Two lines of fields; `query` is what they ask for."""

    changed = Signal()
    """Other tools are to be listed."""

    def __init__(self, document: Document) -> None:
        super().__init__()
        self._document, self._shop = document, document.shop
        self._is_filling = False
        self.machine = ChoiceField()
        self.machine.setObjectName("shopMachine")
        self.machine.setMinimumWidth(150)
        self.only = QCheckBox(tr("Only tools in the machine"))
        self.only.setObjectName("onlyInMachine")
        self.loaded = QCheckBox(tr("List what is in the machine"))
        self.loaded.setObjectName("listLoaded")
        self.words = QLineEdit()
        self.words.setObjectName("toolSearch")
        self.words.setPlaceholderText(tr("Search by name, use or holder"))
        self.words.setClearButtonEnabled(True)
        self.form, self.group = ChoiceField(), ChoiceField()
        self.form.setFixedWidth(_CHOICE_WIDTH)
        self.group.setFixedWidth(_CHOICE_WIDTH)
        self.group.view().setMinimumWidth(_GROUPS_WIDTH)
        self.least, self.most = _diameter(tr("from")), _diameter(tr("to"))
        self.count = QLabel()
        self.count.setObjectName("muted")
        self._arrange()
        self.machine.currentIndexChanged.connect(self._choose_machine)
        self.only.toggled.connect(self._choose_only)
        self.words.textChanged.connect(lambda _: self._report())
        self.loaded.toggled.connect(lambda _: self._report())
        for choice in (self.form, self.group):
            choice.currentIndexChanged.connect(lambda _: self._report())
        for field in (self.least, self.most):
            field.valueChanged.connect(lambda _: self._report())
        document.changed.connect(self.follow)

    @property
    def query(self) -> ToolQuery:
        """Which tools are to be listed."""
        return ToolQuery(
            words=self.words.text(),
            form=str(self.form.currentData() or ""),
            group=str(self.group.currentData() or ""),
            least=self.least.value(),
            most=self.most.value(),
            only_loaded=self.loaded.isChecked(),
        )

    def show_view(self, view: ShopView) -> None:
        """Offer the machines, forms and groups of materials of the catalogue."""
        forms = sorted({row.form for row in view.tools})
        groups = sorted({group for row in view.tools for group in row.suits})
        self._is_filling = True
        _offer(self.machine, [(m.name, m.name) for m in view.machines], self._shop.machine)
        _offer(
            self.form,
            [(tr("All forms"), ""), (tr("End mills"), END_MILL), *((tr(f), f) for f in forms)],
            str(self.form.currentData() or ""),
        )
        _offer(
            self.group,
            [(tr("All materials"), ""), *((_group_words(g, view), g) for g in groups)],
            str(self.group.currentData() or ""),
        )
        self._is_filling = False
        self.follow()

    def follow(self) -> None:
        """Show whether plans of the session use the tools in the machine alone."""
        document = self._document
        self._is_filling = True
        self.only.setChecked(bool(document.session.choices.get(ONLY_IN_MACHINE, False)))
        self._is_filling = False
        self.only.setEnabled(document.has_part and not document.is_busy)
        self.only.setToolTip(
            tr("Cutters of the route are chosen from the tools in its machine alone")
            if document.has_part
            else tr("A setting of the part's plan: open a part first")
        )

    def show_count(self, listed: int, all: int, loaded: int) -> None:
        """Show how many tools are listed, and how many are in the machine."""
        self.count.setText(
            tr("{listed} of {all} tools, {loaded} in the machine").format(
                listed=listed, all=all, loaded=loaded
            )
        )

    def _arrange(self) -> None:
        first, second = QHBoxLayout(), QHBoxLayout()
        widgets: tuple[QWidget, ...] = (QLabel(tr("Machine")), self.machine, self.only, self.loaded)
        for widget in widgets:
            first.addWidget(widget)
        first.addStretch(1)
        first.addWidget(self.count)
        second.addWidget(self.words, 1)
        widgets = (self.form, self.group, QLabel("D"), self.least, self.most)
        for widget in widgets:
            second.addWidget(widget)
        lines = QVBoxLayout(self)
        lines.setContentsMargins(0, 0, 0, 0)
        lines.addLayout(first)
        lines.addLayout(second)

    def _choose_machine(self) -> None:
        if not self._is_filling:
            self._shop.show_machine(str(self.machine.currentData() or ""))

    def _choose_only(self, on: bool) -> None:
        if not self._is_filling:
            self._document.choose(ONLY_IN_MACHINE, tr("Only tools in the machine"), on)

    def _report(self) -> None:
        if not self._is_filling:
            self.changed.emit()


def _diameter(words: str) -> NumberField:
    field = NumberField()
    field.setRange(0.0, _WIDEST)
    field.setDecimals(3)
    field.setSpecialValueText(words)
    field.setSuffix(" mm")
    field.setFixedWidth(86)
    return field


def _offer(field: ChoiceField, choices: Sequence[tuple[str, str]], now: str) -> None:
    field.clear()
    for words, value in choices:
        field.addItem(words, value)
    field.setCurrentIndex(max(field.findData(now), 0))


def _group_words(group: str, view: ShopView) -> str:
    """Return a group of ISO 513 with the materials that the catalogue has of it."""
    names = ", ".join(m.name for m in view.materials if m.kind == group)
    return f"{group}: {names}" if names else group
