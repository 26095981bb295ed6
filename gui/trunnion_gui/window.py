"""The one main window: six panels left, the picture in the middle, features and process right, messages and programs below."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from functools import partial
from importlib.resources import as_file
from pathlib import Path

from PySide6.QtCore import QSize, Qt, QTimer
from PySide6.QtGui import QCloseEvent, QDragEnterEvent, QDropEvent, QShowEvent
from PySide6.QtWidgets import (
    QDockWidget,
    QFileDialog,
    QMainWindow,
    QMenu,
    QMessageBox,
    QScrollArea,
    QSizePolicy,
    QTabBar,
    QTabWidget,
    QToolBar,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

import trunnion_resources
from trunnion import __version__
from trunnion.findings import Finding, Severity
from trunnion_gui import colours, commands, i18n, icons, remembered, theme
from trunnion_gui.actions import Command, Registry
from trunnion_gui.centre import Centre
from trunnion_gui.deviation import DeviationSource
from trunnion_gui.docks.accuracy import AccuracyDock
from trunnion_gui.docks.code import CodeDock
from trunnion_gui.docks.deviation import DeviationDock
from trunnion_gui.docks.features import FeatureDock
from trunnion_gui.docks.listing import ListingDock
from trunnion_gui.docks.messages import MessagesDock
from trunnion_gui.docks.playback import PlaybackBar
from trunnion_gui.docks.process import ProcessDock
from trunnion_gui.docks.properties import PropertiesDock
from trunnion_gui.document import PROJECT, Document
from trunnion_gui.estimate import EstimateSource
from trunnion_gui.finder import Finder
from trunnion_gui.i18n import tr
from trunnion_gui.panels.blank import BlankPanel
from trunnion_gui.panels.generate import GeneratePanel
from trunnion_gui.panels.optimize import OptimizePanel
from trunnion_gui.panels.recognize import RecognizePanel
from trunnion_gui.panels.route import RoutePanel
from trunnion_gui.panels.size import SizePanel
from trunnion_gui.patch_commands import add_patch_commands
from trunnion_gui.patches import PatchTools
from trunnion_gui.player import Player
from trunnion_gui.status import Status
from trunnion_gui.steps import STAGES
from trunnion_gui.widgets.export import SUFFIXES, ExportDialog
from trunnion_gui.widgets.panel import Panel
from trunnion_gui.worker import ENGINE

PANELS: dict[str, type[Panel]] = {"recognize": RecognizePanel, "size": SizePanel, "blank": BlankPanel, "route": RoutePanel,
                                  "optimize": OptimizePanel, "generate": GeneratePanel}
PART_FILES = "STEP, IGES, Trunnion (*.step *.stp *.stpz *.igs *.iges *.trunnion)"
_AUTOSAVE_MS = 20_000
_FOLLOW_MS = 66
"""G-code and process tree follow the tool this often at most."""
_LEFT_WIDTH = 344
_RIGHT_WIDTH = 380
_LEFT = Qt.DockWidgetArea.LeftDockWidgetArea
_RIGHT = Qt.DockWidgetArea.RightDockWidgetArea
_BELOW = Qt.DockWidgetArea.BottomDockWidgetArea
_MENUS = ("File", "Edit", "Steps", "Patches", "Playback", "View", "Help")
_MENU_OF = {"file": "File", "edit": "Edit", "run": "Steps", "step": "Steps", "job": "Steps", "play": "Playback", "view": "View",
            "help": "Help"}
"""The menu of a command, by the first word of its id."""
_TOOLBAR = ("file.open", "file.save", "", "edit.undo", "edit.redo", "", "run.program", "", "view.isometric", "view.top", "view.front",
            "view.right", "view.fit", "", "view.colours", "view.blank", "view.paths", "view.section", "view.isolate", "", "play.show",
            "view.deviation", ">", "view.find",
            "view.theme")


class Window(QMainWindow):
    """Arranges, connects, and asks for files; what it shows is the document's."""

    def __init__(self, factory: str = ENGINE) -> None:
        super().__init__()
        self.confirms_closing = True
        self.setWindowTitle("Trunnion")
        self.setWindowIcon(icons.window_icon())
        self.setAcceptDrops(True)
        self.resize(1440, 900)
        self.theme = colours.theme(remembered.theme_name())
        theme.apply(self.theme)
        self.document = Document(factory, self)
        self.registry = Registry(self)
        self.player, self.deviation = Player(self.document, self), DeviationSource(self.document, self)
        self.patches, self.estimate = PatchTools(self.document, self), EstimateSource(self.document, self)
        self._add_commands()
        add_patch_commands(self)
        self._add_playing()
        self.centre = Centre(self.document, self.registry, self.theme, self.player, self.deviation, self.patches)
        self.export_dialog = ExportDialog(self.document, self.ask_export_path, self)
        self.setCentralWidget(self.centre)
        self.panels = {s.name: PANELS[s.name](s, n, self.document, self.registry) for n, s in enumerate(STAGES, 1)}
        self._make_docks()
        self._make_menus()
        self._make_toolbar()
        self.status = Status(self.document, self.registry)
        self.setStatusBar(self.status)
        self.finder = Finder(self.registry, self)
        self._connect()
        self.use_theme(self.theme)
        self._arrangement = self.saveState()
        self._restore()
        self._autosave = QTimer(self)
        self._autosave.setSingleShot(True)
        self._autosave.setInterval(_AUTOSAVE_MS)
        self._autosave.timeout.connect(lambda: self.document.autosave(remembered.autosave_file()))
        self._offer_recovery()
        self._refresh()

    # what a person is asked; tests replace these

    def ask_open_path(self) -> str:
        """Ask which file to open; empty when nothing was chosen."""
        return QFileDialog.getOpenFileName(self, tr("Open a part or a project"), "", PART_FILES)[0]

    def ask_save_path(self) -> str:
        """Ask where to save the project."""
        part = self.document.session.part
        proposed = str(Path(self.document.path).with_suffix(PROJECT)) if part else ""
        return QFileDialog.getSaveFileName(self, tr("Save the project"), proposed, f"Trunnion (*{PROJECT})")[0]

    def ask_folder(self) -> str:
        """Ask which folder the programs are written to."""
        return QFileDialog.getExistingDirectory(self, tr("Write programs into"))

    def ask_export_path(self, proposed: str, kind: str) -> str:
        """Ask which STEP or IGES file patches are written to."""
        return QFileDialog.getSaveFileName(self, tr("Export patches"), proposed, f"{kind} (*{' *'.join(SUFFIXES[kind])})")[0]

    def ask_picture_path(self) -> str:
        """Ask where to keep a picture."""
        return QFileDialog.getSaveFileName(self, tr("Save the picture"), "", "PNG (*.png)")[0]

    # what the commands do

    def open(self) -> None:
        """Choose a file and open it."""
        path = self.ask_open_path()
        if path:
            self.document.open(path)

    def open_sample(self) -> None:
        """Open the part that comes with the program."""
        self._sample = contextlib.ExitStack()
        self.document.open(self._sample.enter_context(as_file(trunnion_resources.sample("B1"))))

    def save(self) -> None:
        """Save the project where it was saved before; ask otherwise."""
        if self.document.project:
            self.document.save(self.document.project)
        else:
            self.save_as()

    def save_as(self) -> None:
        """Ask where to save the project."""
        path = self.ask_save_path()
        if path:
            self.document.save(path if path.endswith(PROJECT) else path + PROJECT)

    def write(self) -> None:
        """Ask for a folder and write everything there."""
        folder = self.ask_folder()
        if folder:
            self.document.write(folder)

    def keep_picture(self) -> None:
        """Ask for a file and write what the viewport shows."""
        path = self.ask_picture_path()
        if path:
            self.centre.scene.save_picture(path)

    def program(self) -> None:
        """Do the whole line; without a part, choose one first."""
        if not self.document.has_part and not self.document.is_busy:
            self.open()
            if not self.document.is_busy:
                return
        self.document.program()

    def delete_selected(self) -> None:
        """Delete the selected feature or operation."""
        chosen = self.document.selection
        edit = commands.without_feature if chosen.kind == "feature" else commands.without_operation
        if chosen.kind in ("feature", "operation"):
            self.document.edit(tr("Delete {id}").format(id=chosen.id), edit(chosen.id))

    def leave(self) -> None:
        """Put away what is being done in the picture; else select nothing."""
        if self.centre.cutting.is_on:
            self.centre.cutting.end()
        else:
            self.document.select_face(0)

    def suppress_selected(self) -> None:
        """Suppress the selected operation, or take it up again."""
        operation = self.document.operation(self.document.selection.id)
        if operation is not None:
            words = tr("Cut {id} again") if operation.suppressed else tr("Suppress {id}")
            self.document.edit(words.format(id=operation.id), commands.with_suppressed(operation.id, not operation.suppressed))

    def change_theme(self) -> None:
        """Change between light and dark."""
        name = "dark" if self.theme.name == "light" else "light"
        remembered.remember("theme", name)
        self.use_theme(colours.theme(name))

    def change_language(self) -> None:
        """Take the next language; it is spoken from the next start on."""
        known = i18n.languages()
        following = known[(known.index(remembered.language()) + 1) % len(known)]
        remembered.remember("language", following)
        self.document.notice(tr("The window speaks {language} from the next start on").format(language=following), severity=Severity.INFO)

    def forget_arrangement(self) -> None:
        """Put docks back where they were at first."""
        self.restoreState(self._arrangement)
        self._hide_old_tabs()

    def about(self) -> None:
        """Say what this is."""
        self.document.notice(f"Trunnion {__version__}", tr("From the CAD model of an aerospace part to a proven NC program. Apache-2.0."),
                             severity=Severity.INFO)

    # Qt's events

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        if event.mimeData().hasUrls():
            event.acceptProposedAction()

    def dropEvent(self, event: QDropEvent) -> None:
        paths = [u.toLocalFile() for u in event.mimeData().urls() if u.isLocalFile()]
        if paths:
            event.acceptProposedAction()
            self.document.open(paths[0])

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        QTimer.singleShot(0, self._settle)

    def closeEvent(self, event: QCloseEvent) -> None:
        if self.confirms_closing and self.document.has_part and self.document.history.is_dirty and not self._may_close():
            event.ignore()
            return
        remembered.remember("geometry", self.saveGeometry())
        remembered.remember("state", self.saveState())
        self._autosave.stop()
        self.document.close()
        remembered.autosave_file().unlink(missing_ok=True)
        self.centre.scene.end()
        super().closeEvent(event)

    def _may_close(self) -> bool:
        answer = QMessageBox.question(self, tr("Close Trunnion"), tr("There are changes that were not saved. Close without saving?"),
                                      QMessageBox.StandardButton.Discard | QMessageBox.StandardButton.Cancel)
        return answer == QMessageBox.StandardButton.Discard

    # building

    def _add_commands(self) -> None:
        document, add = self.document, self.registry.add

        def has_part() -> bool:
            return document.has_part and not document.is_busy

        def is_free() -> bool:
            return not document.is_busy

        def has_program() -> bool:
            return has_part() and bool(document.session.posted)

        def has_chosen(*kinds: str) -> bool:
            return is_free() and document.selection.kind in kinds

        def command(id: str, text: str, run: Callable[[], object], icon: str = "", keys: str = "", help: str = "",
                    enabled: Callable[[], bool] | None = None) -> None:
            add(Command(id=id, text=text, run=run, icon=icon, keys=keys, help=help, enabled=enabled, menu=_MENU_OF[id.split(".")[0]]))

        command("file.open", "Open…", self.open, "open", "Ctrl+O", "Open a STEP or IGES part, or a project", is_free)
        command("file.sample", "Open the sample part", self.open_sample, "sample", "", "An aircraft panel to try things with", is_free)
        command("file.save", "Save", self.save, "save", "Ctrl+S", "Save the project", has_part)
        command("file.save_as", "Save as…", self.save_as, "save_as", "Ctrl+Shift+S", "", has_part)
        command("file.write", "Write programs…", self.write, "write", "Ctrl+E", "Write NC, CL, tool list, XML and report into a folder",
                has_program)
        command("file.picture", "Save a picture…", self.keep_picture, "picture", "", "Write what the viewport shows as PNG", None)
        command("file.quit", "Quit", self.close, "quit", "Ctrl+Q", "", None)
        command("edit.undo", "Undo", document.undo, "undo", "Ctrl+Z", "", lambda: is_free() and bool(document.history.undo_label))
        command("edit.redo", "Redo", document.redo, "redo", "Ctrl+Shift+Z", "", lambda: is_free() and bool(document.history.redo_label))
        command("edit.delete", "Delete what is selected", self.delete_selected, "delete", "Del", "",
                partial(has_chosen, "feature", "operation"))
        command("edit.suppress", "Suppress or cut again", self.suppress_selected, "suppress", "Ctrl+D",
                "Keep the selected operation in the tree without cutting it", partial(has_chosen, "operation"))
        command("edit.none", "Select nothing", self.leave, "", "Escape", "", None)
        command("run.program", "Program", self.program, "program", "F5", "The whole line: features, route, toolpaths, proof", is_free)
        for id, text, last, icon, keys in (
                ("step.recognize", "Recognize", "recognize", "recognize", "F6"), ("step.size", "Analyse", "size", "size", "F7"),
                ("step.blank", "Create blank", "blank", "blank", "F8"), ("step.route", "Generate route", "route", "route", "F9"),
                ("step.optimize", "Optimize", "optimize", "optimize", "F10"), ("step.generate", "Generate", "toolpath", "generate", "F11"),
                ("step.verify", "Verify", "verify", "verify", "F12")):
            command(id, text, partial(document.run, last, tr(text)), icon, keys, f"{text}: what is stale up to here", has_part)
        command("job.cancel", "Cancel the running job", document.cancel, "cancel", "Ctrl+.", "", lambda: document.is_busy)
        for view in ("isometric", "top", "bottom", "front", "back", "left", "right"):
            number = ("isometric", "top", "bottom", "front", "back", "left", "right").index(view)
            command(f"view.{view}", f"View: {view}", partial(self._look, view), view, f"Ctrl+{number}", "", None)
        command("view.fit", "Fit", self._fit, "fit", "F", "Fit the part into the picture", None)
        for name, text, keys, on in (("colours", "Show all features", "C", True), ("blank", "Show the blank", "B", True),
                                     ("paths", "Show toolpaths", "T", True), ("isolate", "Fade all but the selection", "I", False)):
            add(Command(id=f"view.{name}", text=text, run=partial(self.show_layer, name), icon=name, keys=keys, checkable=True, checked=on,
                        menu="View"))
        add(Command(id="view.section", text="Section", run=self._section, icon="section", keys="X", checkable=True, menu="View",
                    help="Cut the part open across its height"))
        add(Command(id="view.deviation", text="Deviation map", run=self.show_deviation, icon="deviation", keys="D", checkable=True,
                    menu="View", help="Colour the part by gouges and material left, as the proof measured them",
                    enabled=lambda: self.deviation.can_show or self.deviation.is_on))
        command("view.find", "Find a command…", self._find, "search", "Ctrl+Shift+P", "", None)
        command("view.theme", "Light or dark", self.change_theme, "theme", "Ctrl+Shift+L", "", None)
        command("view.arrangement", "Put docks back", self.forget_arrangement, "reset", "", "", None)
        command("view.language", "Next language", self.change_language, "language", "", "", None)
        command("help.about", "About Trunnion", self.about, "help", "", "", None)

    def _add_playing(self) -> None:
        player = self.player

        def is_open() -> bool:
            return player.is_ready

        def command(id: str, text: str, run: Callable[[], object], icon: str, keys: str, help: str = "") -> None:
            self.registry.add(Command(id=id, text=text, run=run, icon=icon, keys=keys, help=help, menu="Playback", enabled=is_open))

        self.registry.add(Command(id="play.show", text="Playback", run=self.show_playback, icon="playback", keys="P", checkable=True,
                                  menu="Playback", help="See the stock being cut, block by block",
                                  enabled=lambda: player.can_play or player.is_on))
        command("play.run", "Play", player.toggle, "play", "K", "Play or pause")
        command("play.back", "One block back", lambda: player.step(-1), "step_back", ",")
        command("play.forward", "One block on", lambda: player.step(1), "step_forward", ".")
        command("play.previous", "Previous operation", lambda: player.skip(-1), "previous", "J")
        command("play.next", "Next operation", lambda: player.skip(1), "next", "L")
        command("play.begin", "To the beginning", lambda: player.go(0.0), "first", "Home")
        command("play.end", "To the end", lambda: player.go(player.end), "last", "End")
        command("play.slower", "Slower", lambda: player.faster(-1), "slower", "-")
        command("play.faster", "Faster", player.faster, "faster", "+")

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

    def _look(self, view: str) -> None:
        self.centre.scene.look(view)

    def _fit(self) -> None:
        self.centre.scene.fit()

    def show_layer(self, name: str, on: bool) -> None:
        """Show or hide a layer of the picture."""
        self.centre.show_layer(name, on)

    def _section(self, on: bool) -> None:
        self.centre.show_section(on)

    def _find(self) -> None:
        self.finder.open()

    def _make_docks(self) -> None:
        for corner, side in ((Qt.Corner.BottomLeftCorner, _LEFT), (Qt.Corner.BottomRightCorner, _RIGHT)):
            self.setCorner(corner, side)
        self.setTabPosition(Qt.DockWidgetArea.AllDockWidgetAreas, QTabWidget.TabPosition.North)
        self.features, self.process = FeatureDock(self.document, self.patches), ProcessDock(self.document)
        self.properties, self.messages = PropertiesDock(self.document), MessagesDock(self.document)
        self.code, self.listing = CodeDock(self.document), ListingDock(self.document)
        self.places, self.accuracy = DeviationDock(self.document), AccuracyDock(self.document)
        self.playback = PlaybackBar(self.player, self.registry, self.theme)
        self.centre.add_bar(self.playback)
        self._dock("steps", tr("Steps"), self._steps(), _LEFT)
        features = self._dock("features", tr("Features"), self.features, _RIGHT)
        process = self._dock("process", tr("Process tree"), self.process, _RIGHT)
        self._dock("properties", tr("Properties"), self.properties, _RIGHT)
        self.messages_dock = self._dock("messages", tr("Messages"), self.messages, _BELOW)
        code = self._dock("code", tr("G-code"), self.code, _BELOW)
        listing = self._dock("listing", tr("Listing"), self.listing, _BELOW)
        places = self._dock("deviation", tr("Deviation"), self.places, _BELOW)
        self.tabifyDockWidget(features, process)
        self.tabifyDockWidget(self.messages_dock, code)
        self.tabifyDockWidget(code, listing)
        self.tabifyDockWidget(listing, places)
        accuracy = self._dock("accuracy", tr("Size error"), self.accuracy, _BELOW)
        self.tabifyDockWidget(places, accuracy)
        for dock in (features, process, self.messages_dock, code, listing, places, accuracy):
            dock.setTitleBarWidget(QWidget())  # the tab is title enough, and can be dragged
        features.raise_()
        self.messages_dock.raise_()
        self._size_docks()

    def _size_docks(self) -> None:
        def dock(name: str) -> QDockWidget:
            return self.findChild(QDockWidget, name)  # type: ignore[return-value]

        self.resizeDocks([dock("steps"), dock("features")], [_LEFT_WIDTH, _RIGHT_WIDTH], Qt.Orientation.Horizontal)
        self.resizeDocks([dock("features"), dock("properties")], [420, 300], Qt.Orientation.Vertical)
        self.resizeDocks([dock("messages")], [170], Qt.Orientation.Vertical)

    def _settle(self) -> None:
        """Put the docks right once the window is there: Qt forgets some sizes that were asked for before."""
        self._hide_old_tabs()
        if remembered.arrangement("state") is None:
            self._size_docks()

    def _hide_old_tabs(self) -> None:
        """Hide the tab bars that Qt made while docks were put together and has no use for: they would show where docks move away."""
        bars = self.findChildren(QTabBar, options=Qt.FindChildOption.FindDirectChildrenOnly)
        titles = [{bar.tabText(n) for n in range(bar.count())} for bar in bars]
        for n, bar in enumerate(bars):
            if any(titles[n] <= later for later in titles[n + 1:]):
                bar.hide()

    def show_dock(self, name: str) -> None:
        """Bring a dock to the front by its name."""
        dock = self.findChild(QDockWidget, name)
        if isinstance(dock, QDockWidget):
            dock.show()
            dock.raise_()

    def _dock(self, name: str, title: str, widget: QWidget, area: Qt.DockWidgetArea) -> QDockWidget:
        dock = QDockWidget(title, self)
        dock.setObjectName(name)
        dock.setWidget(widget)
        self.addDockWidget(area, dock)
        return dock

    def _steps(self) -> QScrollArea:
        inside = QWidget()
        inside.setObjectName("steps")
        column = QVBoxLayout(inside)
        column.setContentsMargins(8, 2, 6, 8)
        column.setSpacing(7)
        for panel in self.panels.values():
            column.addWidget(panel)
        column.addStretch(1)
        scroll = QScrollArea()
        scroll.setObjectName("stepsArea")
        scroll.setWidgetResizable(True)
        scroll.setFrameShape(QScrollArea.Shape.NoFrame)
        scroll.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        scroll.setMinimumWidth(_LEFT_WIDTH)
        scroll.setWidget(inside)
        return scroll

    def _make_menus(self) -> None:
        menus = {name: self.menuBar().addMenu(tr(name)) for name in _MENUS}
        for command in self.registry.commands():
            menus[command.menu].addAction(self.registry.action(command.id))
            if command.id == "file.sample":
                self._recent_menu: QMenu = menus["File"].addMenu(tr("Open recent"))
        self._recent_menu.aboutToShow.connect(self._list_recent)

    def _list_recent(self) -> None:
        self._recent_menu.clear()
        for path in remembered.recent():
            entry = self._recent_menu.addAction(Path(path).name)
            entry.setToolTip(path)
            entry.triggered.connect(lambda _=False, chosen=path: self.document.open(chosen))

    def _make_toolbar(self) -> None:
        bar = QToolBar(tr("Tools"))
        bar.setObjectName("tools")
        bar.setMovable(False)
        bar.setIconSize(QSize(19, 19))
        for id in _TOOLBAR:
            if id == "":
                bar.addSeparator()
            elif id == ">":
                gap = QWidget()
                gap.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
                bar.addWidget(gap)
            else:
                bar.addAction(self.registry.action(id))
        button = bar.widgetForAction(self.registry.action("run.program"))
        assert isinstance(button, QToolButton)
        button.setObjectName("program")
        button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.addToolBar(bar)
        self.toolbar = bar

    def _connect(self) -> None:
        document = self.document
        document.changed.connect(self._refresh)
        document.job_changed.connect(self._refresh)
        document.selected.connect(lambda _: self.registry.refresh())
        document.noticed.connect(self._tell)
        document.opened.connect(self._opened)
        document.saved.connect(remembered.add_recent)
        self.messages.counted.connect(lambda n: self.messages_dock.setWindowTitle(f"{tr('Messages')} {n}" if n else tr("Messages")))
        size, generate, optimize = self.panels["size"], self.panels["generate"], self.panels["optimize"]
        assert isinstance(size, SizePanel)
        assert isinstance(generate, GeneratePanel)
        assert isinstance(optimize, OptimizePanel)
        self.estimate.arrived.connect(optimize.show_estimate)
        size.pointed.connect(self.centre.show_size)
        self._connect_playing()
        generate.motions_changed.connect(self.centre.show_motions)

    def _connect_playing(self) -> None:
        self._soon = QTimer(self)
        self._soon.setSingleShot(True)
        self._soon.setInterval(_FOLLOW_MS)
        self._soon.timeout.connect(self._follow_tool)
        self.player.moved.connect(lambda _: self._soon.isActive() or self._soon.start())
        self.player.opened.connect(self._follow_tool)
        for changed in (self.player.opened, self.player.changed, self.deviation.arrived):
            changed.connect(lambda *_: self.registry.refresh())
        self.code.line_chosen.connect(self._go_to_line)
        self.deviation.arrived.connect(self.places.show_map)
        self.places.chosen.connect(self.centre.look_at_place)
        self.centre.hinted.connect(lambda words: self.status.hint(words))

    def _follow_tool(self) -> None:
        """Let G-code and process tree stand where the tool is."""
        line, position = self.player.timeline, self.player.position
        if line is None:
            self.process.mark("")
            self.code.show_line("", 0)
            return
        passage = line.passage(position)
        self.process.mark(passage.operation)
        self.code.show_line(passage.file, int(line.line[line.block(position)]))

    def _go_to_line(self, file: str, number: int) -> None:
        line = self.player.timeline
        position = line.position_of(file, number) if line is not None else None
        if position is not None:
            self.player.pause()
            self.player.go(position)

    def use_theme(self, chosen: colours.Theme) -> None:
        """Give everything the look of a theme."""
        self.theme = chosen
        theme.apply(chosen)
        self.registry.redraw()
        # The main button is drawn on the accent colour, in both themes.
        self.registry.action("run.program").setIcon(icons.icon("program", chosen.accent_text))
        self.centre.use_theme(chosen)
        for dock in (self.process, self.messages, self.code, self.places, self.accuracy, self.playback):
            dock.use_theme(chosen)
        for panel in self.panels.values():
            panel.use_theme(chosen)

    def _restore(self) -> None:
        geometry, state = remembered.arrangement("geometry"), remembered.arrangement("state")
        if geometry is not None:
            self.restoreGeometry(geometry)
        if state is not None:
            self.restoreState(state)

    # following the document

    def _refresh(self) -> None:
        self.registry.refresh()
        history, part = self.document.history, self.document.shown.part
        undo, redo = self.registry.action("edit.undo"), self.registry.action("edit.redo")
        undo.setText(f"{tr('Undo')}: {history.undo_label}" if history.undo_label else tr("Undo"))
        redo.setText(f"{tr('Redo')}: {history.redo_label}" if history.redo_label else tr("Redo"))
        star = "*" if part is not None and history.is_dirty else ""
        self.setWindowTitle(f"{part.name}{star} – Trunnion" if part is not None else "Trunnion")
        if history.is_dirty and self.document.has_part and not self.document.is_busy:
            self._autosave.start()

    def _tell(self, finding: Finding) -> None:
        self.centre.notice.tell(finding)

    def _opened(self, path: str) -> None:
        remembered.add_recent(path)
        self.centre.welcome.show_recent(remembered.recent())
        self.centre.notice.hide()

    def _offer_recovery(self) -> None:
        self.centre.welcome.show_recent(remembered.recent())
        left = remembered.left_behind()
        if left is not None:
            finding = Finding(severity=Severity.INFO, code="window", text=tr("The last session ended without being saved"),
                              remedy=tr("take it up where it ended, or throw it away"))
            self.centre.notice.tell(finding, {tr("Recover"): partial(self._recover, left), tr("Discard"): left.unlink})

    def _recover(self, left: Path) -> None:
        """Take up a session that was left behind; its file goes once the session is kept in one of our own."""

        def keep() -> None:
            if self.document.has_part:
                self.document.opened.disconnect(keep)
                left.replace(remembered.autosave_file())

        self.document.opened.connect(keep)
        self.document.open(left, is_recovery=True)
