"""What the commands on files, edits and the look of the window do."""

from __future__ import annotations

import contextlib
from importlib.resources import as_file
from typing import TYPE_CHECKING

import trunnion_resources
from trunnion import __version__
from trunnion.findings import Severity
from trunnion_gui import edits, i18n
from trunnion_gui.document import PROJECT
from trunnion_gui.i18n import tr
from trunnion_gui.look import colours
from trunnion_gui.storage import preferences

if TYPE_CHECKING:
    from trunnion_gui.menus.window_access import WindowAccess


class Handlers:
    """Commands that need more than one call of a part of the window."""

    def __init__(self, window: WindowAccess) -> None:
        self._window, self._document = window, window.document

    def open(self) -> None:
        """Choose a file and open it."""
        path = self._window.dialogs.open_path()
        if path:
            self._document.files.open(path)

    def revise(self) -> None:
        """Choose a revised part file and take it up."""
        path = self._window.dialogs.revised_path()
        if path:
            self._document.files.revise(path)

    def open_sample(self) -> None:
        """Open the part that comes with the program."""
        self._sample = contextlib.ExitStack()
        self._document.files.open(
            self._sample.enter_context(as_file(trunnion_resources.sample("B1")))
        )

    def save(self) -> None:
        """Save the project where it was saved before; ask otherwise."""
        if self._document.files.project:
            self._document.files.save(self._document.files.project)
        else:
            self.save_as()

    def save_as(self) -> None:
        """Ask where to save the project."""
        path = self._window.dialogs.save_path()
        if path:
            self._document.files.save(path if path.endswith(PROJECT) else path + PROJECT)

    def write(self) -> None:
        """Ask for a folder and write everything there."""
        folder = self._window.dialogs.folder()
        if folder:
            self._document.files.write(folder)

    def keep_picture(self) -> None:
        """Ask for a file and write what the viewport shows."""
        path = self._window.dialogs.picture_path()
        if path:
            self._window.viewport.scene.save_picture(path)

    def program(self) -> None:
        """Do the whole line; without a part, choose one first."""
        if not self._document.has_part and not self._document.is_busy:
            self.open()
            if not self._document.is_busy:
                return
        self._document.program()

    def delete_selected(self) -> None:
        """Delete the selected feature or operation."""
        selected = self._document.selection.current
        edit = edits.without_feature if selected.kind == "feature" else edits.without_operation
        if selected.kind in ("feature", "operation"):
            self._document.edit(tr("Delete {id}").format(id=selected.id), edit(selected.id))

    def leave(self) -> None:
        """Put away what is being done in the picture; else select nothing."""
        if not self._window.viewport.end_tool():
            self._document.selection.select_face(0)

    def suppress_selected(self) -> None:
        """Suppress the selected operation, or take it up again."""
        operation = self._document.operation(self._document.selection.current.id)
        if operation is not None:
            words = tr("Cut {id} again") if operation.suppressed else tr("Suppress {id}")
            self._document.edit(
                words.format(id=operation.id),
                edits.with_suppressed(operation.id, not operation.suppressed),
            )

    def copy_selected(self) -> None:
        """Copy the selected operation."""
        operation = self._document.operation(self._document.selection.current.id)
        if operation is not None:
            self._document.copy_operation(operation.id)

    def change_theme(self) -> None:
        """Change between light and dark."""
        name = "dark" if self._window.theme.name == "light" else "light"
        preferences.remember("theme", name)
        self._window.use_theme(colours.theme(name))

    def change_language(self) -> None:
        """Take the next language; it is spoken from the next start on."""
        known = i18n.languages()
        following = known[(known.index(preferences.language()) + 1) % len(known)]
        preferences.remember("language", following)
        self._document.notice(
            tr("The window speaks {language} from the next start on").format(language=following),
            severity=Severity.INFO,
        )

    def forget_arrangement(self) -> None:
        """Put docks back where they were at first."""
        self._window.arrangement.forget()

    def about(self) -> None:
        """Say what this is."""
        self._document.notice(
            f"Trunnion {__version__}",
            tr("From the CAD model of an aerospace part to a proven NC program. Apache-2.0."),
            severity=Severity.INFO,
        )
