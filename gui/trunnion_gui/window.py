"""The one main window: six panels left, the picture in the middle, features and process right, messages and programs below."""

from __future__ import annotations

from PySide6.QtCore import QTimer
from PySide6.QtGui import QCloseEvent, QDragEnterEvent, QDropEvent, QShowEvent
from PySide6.QtWidgets import QMainWindow

from trunnion.findings import Finding
from trunnion_gui.actions import Registry
from trunnion_gui.arrangement import LEFT, Arrangement, column
from trunnion_gui.deviation import DeviationSource
from trunnion_gui.dialogs import FileDialogs
from trunnion_gui.docks.layout import Docks
from trunnion_gui.docks.playback import PlaybackBar
from trunnion_gui.document import Document
from trunnion_gui.families.views import Views
from trunnion_gui.guides import GuideSource
from trunnion_gui.i18n import tr
from trunnion_gui.look import colours, icons, theme
from trunnion_gui.menus.bars import fill_menus, toolbar
from trunnion_gui.menus.general import add_general_commands
from trunnion_gui.menus.handlers import Handlers
from trunnion_gui.menus.playback import add_playback_commands
from trunnion_gui.menus.shop import add_shop_commands
from trunnion_gui.panels.blank import BlankPanel
from trunnion_gui.panels.generate import GeneratePanel
from trunnion_gui.panels.optimize import OptimizePanel
from trunnion_gui.panels.recognize import RecognizePanel
from trunnion_gui.panels.route import RoutePanel
from trunnion_gui.panels.size import SizePanel
from trunnion_gui.playback.player import Player
from trunnion_gui.playback.sync import PlaybackSync
from trunnion_gui.shop.window import ShopWindow
from trunnion_gui.storage import preferences
from trunnion_gui.storage.recovery import Recovery
from trunnion_gui.storage.unsaved import UnsavedWork
from trunnion_gui.viewport_pane import ViewportPane
from trunnion_gui.widgets.dropped_files import accept_files, dropped_file
from trunnion_gui.widgets.finder import Finder
from trunnion_gui.widgets.panel import Panel
from trunnion_gui.widgets.status import StatusBar
from trunnion_gui.worker.steps import STAGES
from trunnion_gui.worker.worker import ENGINE

PANELS: dict[str, type[Panel]] = {
    "recognize": RecognizePanel,
    "size": SizePanel,
    "blank": BlankPanel,
    "route": RoutePanel,
    "optimize": OptimizePanel,
    "generate": GeneratePanel,
}


class Window(QMainWindow):
    """Arranges and connects; what it shows is the document's, what its commands do is in `handlers`."""

    def __init__(self, factory: str = ENGINE) -> None:
        super().__init__()
        self._is_closing = False
        self.shop: ShopWindow | None = None
        self.setWindowTitle("Trunnion")
        self.setWindowIcon(icons.window_icon())
        self.setAcceptDrops(True)
        self.resize(1440, 900)
        self.theme = colours.theme(preferences.theme_name())
        theme.apply(self.theme)
        self.document = Document(factory, self)
        self.registry = Registry(self)
        self.player, self.deviation = (
            Player(self.document, self),
            DeviationSource(self.document, self),
        )
        self.guides = GuideSource(self.document, self)
        self.views = Views(self.document)
        self.dialogs, self.handlers = FileDialogs(self.document, self), Handlers(self)
        add_general_commands(self)
        for view in self.views:
            view.add_commands(self)
        add_shop_commands(self)
        add_playback_commands(self)
        self.viewport = ViewportPane(
            self.document,
            self.registry,
            self.theme,
            self.player,
            self.deviation,
            self.guides,
            self.views,
        )
        self.setCentralWidget(self.viewport)
        for view in self.views:
            view.begin(self)
        self.panels = {
            s.name: PANELS[s.name](s, n, self.document, self.registry, self.views)
            for n, s in enumerate(STAGES, 1)
        }
        for view in self.views:
            for name, block in view.blocks().items():
                self.panels[name].content.addWidget(block)
        self.arrangement = Arrangement(self)
        self._make_docks()
        fill_menus(self.menuBar(), self.registry, self.document.files.open)
        self.toolbar = toolbar(self.registry)
        self.addToolBar(self.toolbar)
        self.status = StatusBar(self.document, self.registry)
        self.setStatusBar(self.status)
        self.finder = Finder(self.registry, self)
        self.following = PlaybackSync(self.player, self.docks.code, self.docks.process, self)
        self.unsaved = UnsavedWork(self.document, self.handlers.save, self)
        self.document.files.holds_work = self.unsaved.holds
        self.recovery = Recovery(self.document, self.viewport.notice, self)
        self._connect()
        self.use_theme(self.theme)
        self.arrangement.begin()
        self.viewport.welcome.show_recent(preferences.recent())
        self.recovery.offer()
        self._refresh()

    # Qt's events

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        accept_files(event)

    def dropEvent(self, event: QDropEvent) -> None:
        if file := dropped_file(event):
            self.document.files.open(file)

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        QTimer.singleShot(0, self.arrangement.settle)

    def closeEvent(self, event: QCloseEvent) -> None:
        if not self._is_closing and self.unsaved.holds(self._leave):
            event.ignore()
            return
        self.arrangement.keep()
        if self.shop is not None:
            self.shop.close()
        self.recovery.end()
        self.document.jobs.close()
        self.viewport.scene.end()
        super().closeEvent(event)

    def _leave(self) -> None:
        self._is_closing = True
        self.close()

    def show_playback(self, on: bool) -> None:
        """Open or close the playback; the deviation map and the playback take turns."""
        action = self.registry.action("play.show")
        action.setChecked(on)
        if on and self.deviation.is_on:
            self.show_deviation(False)
        self.playback.setVisible(on)
        if on:
            self.show_dock("code")
        self.player.switch(on)

    def show_deviation(self, on: bool) -> None:
        """Show the deviation map, or the part in its own colours."""
        self.registry.action("view.deviation").setChecked(on)
        if on and self.player.is_on:
            self.show_playback(False)
        self.deviation.switch(on)
        if on:
            self.show_dock("deviation")

    def show_shop(self, page: str) -> None:
        """Open the window of the shop, made when it is first wanted, at one of its pages."""
        if self.shop is None:
            self.shop = ShopWindow(self.document, self)
            self.shop.use_theme(self.theme)
        self.shop.open(page)

    def show_dock(self, name: str) -> None:
        """Bring a dock to the front by its name."""
        self.arrangement.show(name)

    # building

    def _make_docks(self) -> None:
        self.docks = Docks(self.document, self.views)
        self.playback = PlaybackBar(self.player, self.registry, self.theme)
        self.viewport.add_bar(self.playback)
        self.arrangement.add("steps", tr("Steps"), column(list(self.panels.values())), LEFT)
        self.docks.arrange(self.arrangement)

    def _connect(self) -> None:
        document, messages = self.document, self.arrangement.dock("messages")
        document.changed.connect(self._refresh)
        document.jobs.changed.connect(self._refresh)
        document.selection.changed.connect(lambda _: self.registry.refresh())
        document.noticed.connect(self._report)
        document.files.opened.connect(self._opened)
        document.files.saved.connect(preferences.add_recent)
        self.docks.messages.counted.connect(
            lambda n: messages.setWindowTitle(f"{tr('Messages')} {n}" if n else tr("Messages"))
        )
        size, generate = self.panels["size"], self.panels["generate"]
        assert isinstance(size, SizePanel)
        assert isinstance(generate, GeneratePanel)
        size.pointed.connect(self.viewport.show_size)
        for changed in (self.player.opened, self.player.changed, self.deviation.arrived):
            changed.connect(lambda *_: self.registry.refresh())
        self.deviation.arrived.connect(self.docks.deviation.show_map)
        self.docks.deviation.picked.connect(self.viewport.look_at_worst_point)
        self.viewport.hinted.connect(self.status.hint)
        generate.motions_changed.connect(self.viewport.show_motions)

    def use_theme(self, new_theme: colours.Theme) -> None:
        """Give everything the look of a theme."""
        self.theme = new_theme
        theme.apply(new_theme)
        self.registry.redraw()
        # The main button is drawn on the accent colour, in both themes.
        self.registry.action("run.program").setIcon(icons.icon("program", new_theme.accent_text))
        self.viewport.use_theme(new_theme)
        self.docks.use_theme(new_theme)
        self.playback.use_theme(new_theme)
        if self.shop is not None:
            self.shop.use_theme(new_theme)
        for view in self.views:
            view.use_theme(new_theme)
        for panel in self.panels.values():
            panel.use_theme(new_theme)

    # following the document

    def _refresh(self) -> None:
        self.registry.refresh()
        history, part = self.document.history, self.document.shown.part
        undo, redo = self.registry.action("edit.undo"), self.registry.action("edit.redo")
        undo.setText(f"{tr('Undo')}: {history.undo_label}" if history.undo_label else tr("Undo"))
        redo.setText(f"{tr('Redo')}: {history.redo_label}" if history.redo_label else tr("Redo"))
        star = "*" if part is not None and history.is_dirty else ""
        self.setWindowTitle(f"{part.name}{star} – Trunnion" if part is not None else "Trunnion")

    def _report(self, finding: Finding) -> None:
        self.viewport.notice.show_finding(finding)

    def _opened(self, path: str) -> None:
        preferences.add_recent(path)
        self.viewport.welcome.show_recent(preferences.recent())
        self.viewport.notice.hide()
