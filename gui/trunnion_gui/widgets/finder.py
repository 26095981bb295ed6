"""The command palette: type a few letters of what you want to do, press Enter."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QAction, QKeyEvent, QKeySequence
from PySide6.QtWidgets import QFrame, QLineEdit, QListWidget, QListWidgetItem, QVBoxLayout, QWidget

from trunnion_gui.actions import Registry
from trunnion_gui.i18n import tr

_WIDTH, _ROWS = 520, 9


def score(wanted: str, text: str) -> int:
    """Return how well a text answers what was typed, 0 when its letters are not all there in order.

    >>> score("prg", "Program") > 0, score("xyz", "Program")
    (True, 0)
    """
    wanted, text, at, total = wanted.lower().replace(" ", ""), text.lower(), -1, 1
    for letter in wanted:
        found = text.find(letter, at + 1)
        if found < 0:
            return 0
        total += 8 if found == at + 1 else 4 if found == 0 or text[found - 1] == " " else 1
        at = found
    return total


class Finder(QFrame):
    """A list of the commands that can be done now, filtered by what is typed."""

    def __init__(self, registry: Registry, parent: QWidget) -> None:
        super().__init__(parent)
        self.setObjectName("finder")
        self._registry = registry
        self.line = QLineEdit()
        self.line.setPlaceholderText(tr("What do you want to do?"))
        self.list = QListWidget()
        self.list.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        column = QVBoxLayout(self)
        column.setContentsMargins(10, 10, 10, 10)
        column.addWidget(self.line)
        column.addWidget(self.list)
        self.line.textChanged.connect(self._filter)
        self.line.returnPressed.connect(self._run)
        self.list.itemClicked.connect(lambda _: self._run())
        self.line.installEventFilter(self)
        self.hide()

    def open(self) -> None:
        """Show the palette in the upper middle of the window."""
        self.setFixedSize(_WIDTH, 48 + _ROWS * 30)
        self.move((self.window().width() - _WIDTH) // 2, 84)
        self.line.clear()
        self._filter("")
        self.show()
        self.raise_()
        self.line.setFocus()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if isinstance(event, QKeyEvent) and event.type() == QEvent.Type.KeyPress:
            if event.key() == Qt.Key.Key_Escape:
                self.hide()
                return True
            if event.key() in (Qt.Key.Key_Down, Qt.Key.Key_Up):
                step = 1 if event.key() == Qt.Key.Key_Down else -1
                self.list.setCurrentRow(
                    min(max(self.list.currentRow() + step, 0), self.list.count() - 1)
                )
                return True
        if event.type() == QEvent.Type.FocusOut:
            self.hide()
        return False

    def _filter(self, wanted: str) -> None:
        self.list.clear()
        able = [
            self._registry.action(c.id)
            for c in self._registry.commands()
            if self._registry.action(c.id).isEnabled()
        ]
        ranked = sorted(((score(wanted, a.text()), a) for a in able), key=lambda pair: -pair[0])
        for points, action in ranked:
            if points:
                self._add(action)
        self.list.setCurrentRow(0)

    def _add(self, action: QAction) -> None:
        keys = action.shortcut().toString(QKeySequence.SequenceFormat.NativeText)
        item = QListWidgetItem(
            action.icon(), f"{action.text()}    {keys}" if keys else action.text()
        )
        item.setData(Qt.ItemDataRole.UserRole, action.objectName())
        self.list.addItem(item)

    def _run(self) -> None:
        item = self.list.currentItem()
        self.hide()
        if item is not None:
            self._registry.run(item.data(Qt.ItemDataRole.UserRole))
