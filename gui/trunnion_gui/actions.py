"""One registry of commands: it feeds the menu, the toolbar, the keys, the palette, the panels' buttons and the tests."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtCore import QObject
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QWidget

from trunnion_gui.i18n import tr
from trunnion_gui.look import icons


@dataclass(frozen=True, slots=True, kw_only=True)
class Command:
    """Something a person can do: an id (`file.open`), words, where it stands in the menu, and what it does."""

    id: str
    text: str
    run: Callable[..., object]
    menu: str = ""
    icon: str = ""
    keys: str = ""
    help: str = ""
    checkable: bool = False
    checked: bool = False
    enabled: Callable[[], bool] | None = None


class Registry(QObject):
    """The commands of a window by id, each with its `QAction`."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self._commands: dict[str, Command] = {}
        self._actions: dict[str, QAction] = {}

    def add(self, command: Command) -> QAction:
        """Add a command; its keys work at once."""
        if command.id in self._commands:
            raise ValueError(f"two commands are named {command.id}")
        parent = self.parent()
        assert isinstance(parent, QWidget)
        action = QAction(tr(command.text), parent)
        action.setObjectName(command.id)
        action.setCheckable(command.checkable)
        action.setChecked(command.checked)
        if command.keys:
            action.setShortcut(QKeySequence(command.keys))
        keys = (
            f" ({QKeySequence(command.keys).toString(QKeySequence.SequenceFormat.NativeText)})"
            if command.keys
            else ""
        )
        action.setToolTip(f"{tr(command.help or command.text)}{keys}")
        action.triggered.connect(
            lambda on=False: command.run(on) if command.checkable else command.run()
        )
        parent.addAction(action)
        self._commands[command.id], self._actions[command.id] = command, action
        self._draw(command.id)
        return action

    def action(self, id: str) -> QAction:
        """Return the action of a command."""
        return self._actions[id]

    def commands(self) -> tuple[Command, ...]:
        """Return all commands in the order they were added."""
        return tuple(self._commands.values())

    def run(self, id: str) -> None:
        """Do a command as if its menu entry had been clicked."""
        self._actions[id].trigger()

    def refresh(self) -> None:
        """Update whether each command can be done now."""
        for id, command in self._commands.items():
            if command.enabled is not None:
                self._actions[id].setEnabled(bool(command.enabled()))

    def redraw(self) -> None:
        """Draw all icons anew after the theme changed."""
        for id in self._commands:
            self._draw(id)

    def _draw(self, id: str) -> None:
        if self._commands[id].icon:
            self._actions[id].setIcon(icons.icon(self._commands[id].icon))
