"""The menu bar and the toolbar: which commands stand where."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import QMenu, QMenuBar, QSizePolicy, QToolBar, QToolButton, QWidget

from trunnion_gui.actions import Registry
from trunnion_gui.i18n import tr
from trunnion_gui.storage import preferences

_FIRST_MENUS, _LAST_MENUS = ("File", "Edit", "Steps"), ("Playback", "View", "Help")
"""The menus of every window; those that families bring stand between them."""
_BEFORE_RECENT = "file.sample"
"""The command that the files opened last are listed under."""
_GAP, _RIGHTMOST = "", ">"
_TOOLBAR = (
    "file.open",
    "file.save",
    _GAP,
    "edit.undo",
    "edit.redo",
    _GAP,
    "run.program",
    _GAP,
    "view.isometric",
    "view.top",
    "view.front",
    "view.right",
    "view.fit",
    _GAP,
    "view.colours",
    "view.blank",
    "view.paths",
    "view.section",
    "view.isolate",
    _GAP,
    "play.show",
    "view.deviation",
    _RIGHTMOST,
    "view.find",
    "view.theme",
)
_MAIN = "run.program"
_ICON = 19
"""Pixels of a toolbar icon."""


def fill_menus(bar: QMenuBar, registry: Registry, open: Callable[[str], object]) -> None:
    """Fill a menu bar with every command of a registry, and with the files opened last, which `open` opens."""
    named = dict.fromkeys(command.menu for command in registry.commands())
    own = (name for name in named if name not in (*_FIRST_MENUS, *_LAST_MENUS))
    menus = {name: bar.addMenu(tr(name)) for name in (*_FIRST_MENUS, *own, *_LAST_MENUS)}
    for command in registry.commands():
        menus[command.menu].addAction(registry.action(command.id))
        if command.id == _BEFORE_RECENT:
            _add_recent(menus[command.menu].addMenu(tr("Open recent")), open)


def _add_recent(menu: QMenu, open: Callable[[str], object]) -> None:
    def fill() -> None:
        menu.clear()
        for path in preferences.recent():
            entry = menu.addAction(Path(path).name)
            entry.setToolTip(path)
            entry.triggered.connect(lambda _=False, file=path: open(file))

    menu.aboutToShow.connect(fill)


def toolbar(registry: Registry) -> QToolBar:
    """Return the toolbar: what is used most, as icons; the main command in words too."""
    bar = QToolBar(tr("Tools"))
    bar.setObjectName("tools")
    bar.setMovable(False)
    bar.setIconSize(QSize(_ICON, _ICON))
    for id in _TOOLBAR:
        if id == _GAP:
            bar.addSeparator()
        elif id == _RIGHTMOST:
            gap = QWidget()
            gap.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
            bar.addWidget(gap)
        else:
            bar.addAction(registry.action(id))
    button = bar.widgetForAction(registry.action(_MAIN))
    assert isinstance(button, QToolButton)
    button.setObjectName("program")
    button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
    return bar
