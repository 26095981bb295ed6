"""What commands reach of the window: they know this much of it and no more."""

from __future__ import annotations

from typing import Protocol

from trunnion_gui.actions import Registry
from trunnion_gui.arrangement import Arrangement
from trunnion_gui.deviation import DeviationSource
from trunnion_gui.dialogs import FileDialogs
from trunnion_gui.document import Document
from trunnion_gui.guides import GuideSource
from trunnion_gui.look.colours import Theme
from trunnion_gui.menus.handlers import Handlers
from trunnion_gui.playback.player import Player
from trunnion_gui.viewport_pane import ViewportPane
from trunnion_gui.widgets.finder import Finder


class WindowAccess(Protocol):
    """The window as commands see it. Parts are reached when a command runs, not before: some are made after the commands."""

    document: Document
    registry: Registry
    player: Player
    deviation: DeviationSource
    guides: GuideSource
    viewport: ViewportPane
    finder: Finder
    dialogs: FileDialogs
    handlers: Handlers
    arrangement: Arrangement
    theme: Theme

    def use_theme(self, new_theme: Theme) -> None: ...
    def show_shop(self, page: str) -> None: ...
    def show_dock(self, name: str) -> None: ...
    def show_playback(self, on: bool) -> None: ...
    def show_deviation(self, on: bool) -> None: ...
    def close(self) -> bool: ...
