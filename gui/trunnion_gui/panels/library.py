"""The plan library in the route panel: what matches the part and why, and buttons that add a plan and remove one."""

from __future__ import annotations

from PySide6.QtWidgets import QLabel, QLineEdit, QPushButton

from trunnion_gui.actions import Registry
from trunnion_gui.document import Document
from trunnion_gui.i18n import tr
from trunnion_gui.look.words import share
from trunnion_gui.widgets import table as tables
from trunnion_gui.widgets.foldout import Foldout

_MOST_ROWS = 6
_SIMILARITY, _WHY = 1, 2
"""Columns of the similarity and of its reason."""


class LibraryBlock(Foldout):
    """A table of plans, a name for the next one, and buttons; while it is open, it follows the part."""

    def __init__(self, document: Document, registry: Registry) -> None:
        super().__init__(tr("Plan library"), is_group=True)
        self._document, self._library = document, document.library
        self.words = QLabel()
        self.words.setWordWrap(True)
        self.words.setObjectName("muted")
        self.table = tables.table([tr("Plan"), tr("Similarity"), tr("Why")], stretched=(_WHY,))
        self.name = QLineEdit()
        self.name.setToolTip(tr("Name of the plan in the library; empty: the part's name"))
        self.add = _button(registry, "library.add")
        self.remove = _button(registry, "library.remove")
        self.reason = QLabel()
        self.reason.setWordWrap(True)
        self.reason.setObjectName("muted")
        for widget in (self.words, self.table, self.reason, self.name, self.add, self.remove):
            self.content.addWidget(widget)
        self._registry = registry
        self._seen: tuple[object, ...] = ()
        self.name.textChanged.connect(self._rename)
        self.table.itemSelectionChanged.connect(self._select)
        self.toggled.connect(lambda _: self.follow())
        self._library.changed.connect(self._show)
        self._show()

    def follow(self) -> None:
        """Request the matches anew where the part, its settings or the states of its steps are others."""
        self.name.setPlaceholderText(self._library.default_name)
        document, shown = self._document, self._document.shown
        if self.is_folded or document.is_busy:
            return
        now = (
            shown.recognition,
            shown.blank,
            shown.sizes,
            dict(shown.choices),
            document.states.get("route"),
        )
        if len(self._seen) == len(now) and all(
            a is b or (isinstance(a, (dict, str)) and a == b)
            for a, b in zip(self._seen, now, strict=True)
        ):
            return
        self._seen = now
        self._library.refresh()

    def _rename(self, name: str) -> None:
        self._library.name = name

    def _select(self) -> None:
        row = self.table.currentRow()
        rows = self._library.rows
        is_one = bool(self.table.selectedItems()) and 0 <= row < len(rows)
        self._library.selected = rows[row].name if is_one else ""
        explained = rows[row] if is_one else next((r for r in rows if r.is_followed), None)
        self.reason.setText(f"{explained.name}: {explained.words}" if explained else "")
        self.reason.setVisible(explained is not None)
        self._registry.refresh()

    def _show(self) -> None:
        rows = self._library.rows
        tables.fill(
            self.table,
            [(r.name, share(r.similarity), r.words) for r in rows],
            right=(_SIMILARITY,),
        )
        tables.fit_height(self.table, _MOST_ROWS)
        self.table.setVisible(bool(rows))
        followed = next((r for r in rows if r.is_followed), None)
        self.words.setText(self._summary(followed.name if followed is not None else ""))
        self._select()

    def _summary(self, followed: str) -> str:
        if not self._library.rows:
            return tr("No plan of the library is for parts of this family")
        if not followed:
            return tr("The route follows none of these plans")
        return tr("The route follows {name}").format(name=followed)


def _button(registry: Registry, command: str) -> QPushButton:
    """Return a button for a command of the registry."""
    action = registry.action(command)
    button = QPushButton(action.text())
    button.setProperty("command", command)
    button.setToolTip(action.toolTip())
    button.setEnabled(action.isEnabled())
    button.clicked.connect(action.trigger)
    action.enabledChanged.connect(button.setEnabled)
    return button
