"""The one main window: six panels left, the picture in the middle, features and process right, messages and programs below."""

from __future__ import annotations

import contextlib
from importlib.resources import as_file
from pathlib import Path

from PySide6.QtCore import QTimer
from PySide6.QtGui import QCloseEvent, QDragEnterEvent, QDropEvent, QShowEvent
from PySide6.QtWidgets import QFileDialog, QMainWindow

import trunnion_resources
from trunnion import __version__
from trunnion.findings import Finding, Severity
from trunnion_gui import colours, edits, i18n, icons, remembered, theme
from trunnion_gui.actions import Registry
from trunnion_gui.arrangement import BELOW, LEFT, RIGHT, Arrangement, column
from trunnion_gui.centre import Centre
from trunnion_gui.deviation import DeviationSource
from trunnion_gui.docks.code import CodeDock
from trunnion_gui.docks.deviation import DeviationDock
from trunnion_gui.docks.features import FeatureDock
from trunnion_gui.docks.listing import ListingDock
from trunnion_gui.docks.messages import MessagesDock
from trunnion_gui.docks.playback import PlaybackBar
from trunnion_gui.docks.process import ProcessDock
from trunnion_gui.docks.properties import PropertiesDock
from trunnion_gui.document import PROJECT, Document
from trunnion_gui.families.views import Views
from trunnion_gui.finder import Finder
from trunnion_gui.following import Following
from trunnion_gui.i18n import tr
from trunnion_gui.menus.bars import fill_menus, toolbar
from trunnion_gui.menus.general import add_general_commands
from trunnion_gui.menus.playing import add_playback_commands
from trunnion_gui.panels.blank import BlankPanel
from trunnion_gui.panels.generate import GeneratePanel
from trunnion_gui.panels.optimize import OptimizePanel
from trunnion_gui.panels.recognize import RecognizePanel
from trunnion_gui.panels.route import RoutePanel
from trunnion_gui.panels.size import SizePanel
from trunnion_gui.player import Player
from trunnion_gui.recovery import Recovery
from trunnion_gui.status import Status
from trunnion_gui.steps import STAGES
from trunnion_gui.unsaved import UnsavedWork
from trunnion_gui.widgets.panel import Panel
from trunnion_gui.worker import ENGINE

PANELS: dict[str, type[Panel]] = {"recognize": RecognizePanel, "size": SizePanel, "blank": BlankPanel, "route": RoutePanel,
                                  "optimize": OptimizePanel, "generate": GeneratePanel}
PART_FILES = "STEP, IGES, Trunnion (*.step *.stp *.stpz *.igs *.iges *.trunnion)"


class Window(QMainWindow):
    """Arranges, connects, and asks for files; what it shows is the document's."""

    def __init__(self, factory: str = ENGINE) -> None:
        super().__init__()
        self._is_leaving = False
        self.setWindowTitle("Trunnion")
        self.setWindowIcon(icons.window_icon())
        self.setAcceptDrops(True)
        self.resize(1440, 900)
        self.theme = colours.theme(remembered.theme_name())
        theme.apply(self.theme)
        self.document = Document(factory, self)
        self.registry = Registry(self)
        self.player, self.deviation = Player(self.document, self), DeviationSource(self.document, self)
        self.views = Views(self.document)
        add_general_commands(self)
        for view in self.views:
            view.add_commands(self)
        add_playback_commands(self)
        self.centre = Centre(self.document, self.registry, self.theme, self.player, self.deviation, self.views)
        self.setCentralWidget(self.centre)
        for view in self.views:
            view.begin(self)
        self.panels = {s.name: PANELS[s.name](s, n, self.document, self.registry, self.views) for n, s in enumerate(STAGES, 1)}
        for view in self.views:
            for name, block in view.blocks().items():
                self.panels[name].content.addWidget(block)
        self.arrangement = Arrangement(self)
        self._make_docks()
        fill_menus(self.menuBar(), self.registry, self.document.files.open)
        self.toolbar = toolbar(self.registry)
        self.addToolBar(self.toolbar)
        self.status = Status(self.document, self.registry)
        self.setStatusBar(self.status)
        self.finder = Finder(self.registry, self)
        self.following = Following(self.player, self.code, self.process, self)
        self.unsaved = UnsavedWork(self.document, self.save, self)
        self.document.files.holds_work = self.unsaved.holds
        self.recovery = Recovery(self.document, self.centre.notice, self)
        self._connect()
        self.use_theme(self.theme)
        self.arrangement.begin()
        self.centre.welcome.show_recent(remembered.recent())
        self.recovery.offer()
        self._refresh()

    # what a person is asked; tests replace these

    def ask_open_path(self) -> str:
        """Ask which file to open; empty when nothing was chosen."""
        return QFileDialog.getOpenFileName(self, tr("Open a part or a project"), "", PART_FILES)[0]

    def ask_save_path(self) -> str:
        """Ask where to save the project."""
        part = self.document.session.part
        proposed = str(Path(self.document.files.path).with_suffix(PROJECT)) if part else ""
        return QFileDialog.getSaveFileName(self, tr("Save the project"), proposed, f"Trunnion (*{PROJECT})")[0]

    def ask_folder(self) -> str:
        """Ask which folder the programs are written to."""
        return QFileDialog.getExistingDirectory(self, tr("Write programs into"))

    def ask_picture_path(self) -> str:
        """Ask where to keep a picture."""
        return QFileDialog.getSaveFileName(self, tr("Save the picture"), "", "PNG (*.png)")[0]

    # what the commands do

    def open(self) -> None:
        """Choose a file and open it."""
        path = self.ask_open_path()
        if path:
            self.document.files.open(path)

    def open_sample(self) -> None:
        """Open the part that comes with the program."""
        self._sample = contextlib.ExitStack()
        self.document.files.open(self._sample.enter_context(as_file(trunnion_resources.sample("B1"))))

    def save(self) -> None:
        """Save the project where it was saved before; ask otherwise."""
        if self.document.files.project:
            self.document.files.save(self.document.files.project)
        else:
            self.save_as()

    def save_as(self) -> None:
        """Ask where to save the project."""
        path = self.ask_save_path()
        if path:
            self.document.files.save(path if path.endswith(PROJECT) else path + PROJECT)

    def write(self) -> None:
        """Ask for a folder and write everything there."""
        folder = self.ask_folder()
        if folder:
            self.document.files.write(folder)

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
        chosen = self.document.selection.current
        edit = edits.without_feature if chosen.kind == "feature" else edits.without_operation
        if chosen.kind in ("feature", "operation"):
            self.document.edit(tr("Delete {id}").format(id=chosen.id), edit(chosen.id))

    def leave(self) -> None:
        """Put away what is being done in the picture; else select nothing."""
        if not self.centre.end_tool():
            self.document.selection.select_face(0)

    def suppress_selected(self) -> None:
        """Suppress the selected operation, or take it up again."""
        operation = self.document.operation(self.document.selection.current.id)
        if operation is not None:
            words = tr("Cut {id} again") if operation.suppressed else tr("Suppress {id}")
            self.document.edit(words.format(id=operation.id), edits.with_suppressed(operation.id, not operation.suppressed))

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
        self.arrangement.forget()

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
            self.document.files.open(paths[0])

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        QTimer.singleShot(0, self.arrangement.settle)

    def closeEvent(self, event: QCloseEvent) -> None:
        if not self._is_leaving and self.unsaved.holds(self._leave):
            event.ignore()
            return
        self.arrangement.keep()
        self.recovery.end()
        self.document.jobs.close()
        self.centre.scene.end()
        super().closeEvent(event)

    def _leave(self) -> None:
        self._is_leaving = True
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

    def show_dock(self, name: str) -> None:
        """Bring a dock to the front by its name."""
        self.arrangement.show(name)

    # building

    def _make_docks(self) -> None:
        self.features, self.process = FeatureDock(self.document, self.views), ProcessDock(self.document)
        self.properties, self.messages = PropertiesDock(self.document), MessagesDock(self.document)
        self.code, self.listing = CodeDock(self.document), ListingDock(self.document)
        self.places = DeviationDock(self.document)
        self.playback = PlaybackBar(self.player, self.registry, self.theme)
        self.centre.add_bar(self.playback)
        self.arrangement.add("steps", tr("Steps"), column(list(self.panels.values())), LEFT)
        self.arrangement.add_tabs(RIGHT, ("features", tr("Features"), self.features), ("process", tr("Process tree"), self.process))
        self.arrangement.add("properties", tr("Properties"), self.properties, RIGHT)
        self.arrangement.add_tabs(BELOW, ("messages", tr("Messages"), self.messages), ("code", tr("G-code"), self.code),
                                  ("listing", tr("Listing"), self.listing), ("deviation", tr("Deviation"), self.places),
                                  *((d.name, d.title, d.widget) for view in self.views for d in view.docks()))

    def _connect(self) -> None:
        document, messages = self.document, self.arrangement.dock("messages")
        document.changed.connect(self._refresh)
        document.jobs.changed.connect(self._refresh)
        document.selection.changed.connect(lambda _: self.registry.refresh())
        document.noticed.connect(self._tell)
        document.files.opened.connect(self._opened)
        document.files.saved.connect(remembered.add_recent)
        self.messages.counted.connect(lambda n: messages.setWindowTitle(f"{tr('Messages')} {n}" if n else tr("Messages")))
        size, generate = self.panels["size"], self.panels["generate"]
        assert isinstance(size, SizePanel)
        assert isinstance(generate, GeneratePanel)
        size.pointed.connect(self.centre.show_size)
        for changed in (self.player.opened, self.player.changed, self.deviation.arrived):
            changed.connect(lambda *_: self.registry.refresh())
        self.deviation.arrived.connect(self.places.show_map)
        self.places.chosen.connect(self.centre.look_at_place)
        self.centre.hinted.connect(self.status.hint)
        generate.motions_changed.connect(self.centre.show_motions)

    def use_theme(self, chosen: colours.Theme) -> None:
        """Give everything the look of a theme."""
        self.theme = chosen
        theme.apply(chosen)
        self.registry.redraw()
        # The main button is drawn on the accent colour, in both themes.
        self.registry.action("run.program").setIcon(icons.icon("program", chosen.accent_text))
        self.centre.use_theme(chosen)
        for dock in (self.process, self.messages, self.code, self.places, self.playback):
            dock.use_theme(chosen)
        for view in self.views:
            view.use_theme(chosen)
        for panel in self.panels.values():
            panel.use_theme(chosen)

    # following the document

    def _refresh(self) -> None:
        self.registry.refresh()
        history, part = self.document.history, self.document.shown.part
        undo, redo = self.registry.action("edit.undo"), self.registry.action("edit.redo")
        undo.setText(f"{tr('Undo')}: {history.undo_label}" if history.undo_label else tr("Undo"))
        redo.setText(f"{tr('Redo')}: {history.redo_label}" if history.redo_label else tr("Redo"))
        star = "*" if part is not None and history.is_dirty else ""
        self.setWindowTitle(f"{part.name}{star} – Trunnion" if part is not None else "Trunnion")

    def _tell(self, finding: Finding) -> None:
        self.centre.notice.tell(finding)

    def _opened(self, path: str) -> None:
        remembered.add_recent(path)
        self.centre.welcome.show_recent(remembered.recent())
        self.centre.notice.hide()
