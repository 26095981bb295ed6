"""The commands on files, edits, steps and the view."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from trunnion_gui.actions import Command
from trunnion_gui.i18n import tr
from trunnion_gui.menus.window_access import WindowAccess

_MENU_OF = {
    "file": "File",
    "edit": "Edit",
    "run": "Steps",
    "step": "Steps",
    "job": "Steps",
    "library": "Steps",
    "view": "View",
    "help": "Help",
}
"""The menu of a command, by the first word of its id."""
_STEPS = (
    ("step.recognize", "Recognize", "recognize", "recognize", "F6"),
    ("step.size", "Analyse", "size", "size", "F7"),
    ("step.blank", "Create blank", "blank", "blank", "F8"),
    ("step.route", "Generate route", "route", "route", "F9"),
    ("step.optimize", "Optimize", "optimize", "optimize", "F10"),
    ("step.generate", "Generate", "toolpath", "generate", "F11"),
    ("step.verify", "Verify", "repair", "verify", "F12"),
)
"""Id, words, the last step that runs, icon, keys."""
_VIEWS = ("isometric", "top", "bottom", "front", "back", "left", "right")
_LAYERS = (
    ("colours", "Show all features", "C", True),
    ("blank", "Show the blank", "B", True),
    ("paths", "Show toolpaths", "T", True),
    ("isolate", "Fade all but the selection", "I", False),
)
"""Name, words, keys, whether it is on at first."""


def add_general_commands(window: WindowAccess) -> None:
    """Add them to a window's registry."""
    document, add, do = window.document, window.registry.add, window.handlers

    def has_part() -> bool:
        return document.has_part and not document.is_busy

    def is_free() -> bool:
        return not document.is_busy

    def has_program() -> bool:
        return has_part() and bool(document.session.posted)

    def has_selected(*kinds: str) -> bool:
        return is_free() and document.selection.current.kind in kinds

    def command(
        id: str,
        text: str,
        run: Callable[[], object],
        icon: str = "",
        keys: str = "",
        help: str = "",
        enabled: Callable[[], bool] | None = None,
    ) -> None:
        add(
            Command(
                id=id,
                text=text,
                run=run,
                icon=icon,
                keys=keys,
                help=help,
                enabled=enabled,
                menu=_MENU_OF[id.split(".")[0]],
            )
        )

    def switch(
        id: str,
        text: str,
        run: Callable[[bool], object],
        keys: str,
        help: str = "",
        checked: bool = False,
        enabled: Callable[[], bool] | None = None,
    ) -> None:
        add(
            Command(
                id=f"view.{id}",
                text=text,
                run=run,
                icon=id,
                keys=keys,
                help=help,
                checkable=True,
                checked=checked,
                enabled=enabled,
                menu="View",
            )
        )

    command(
        "file.open",
        "Open…",
        do.open,
        "open",
        "Ctrl+O",
        "Open a STEP or IGES part, or a project",
        is_free,
    )
    command(
        "file.sample",
        "Open the sample part",
        do.open_sample,
        "sample",
        "",
        "An aircraft panel to try things with",
        is_free,
    )
    command(
        "file.revise",
        "Take up a revised part…",
        do.revise,
        "revise",
        "",
        "Go on with a revised part file: settings, features and operations by hand are kept by matching faces",
        has_part,
    )
    command("file.save", "Save", do.save, "save", "Ctrl+S", "Save the project", has_part)
    command("file.save_as", "Save as…", do.save_as, "save_as", "Ctrl+Shift+S", "", has_part)
    command(
        "file.write",
        "Write programs…",
        do.write,
        "write",
        "Ctrl+E",
        "Write NC, CL, tool list, XML and report into a folder",
        has_program,
    )
    command(
        "file.picture",
        "Save a picture…",
        do.keep_picture,
        "picture",
        "",
        "Write what the viewport shows as PNG",
        None,
    )
    command("file.quit", "Quit", window.close, "quit", "Ctrl+Q", "", None)
    command(
        "edit.undo",
        "Undo",
        document.undo,
        "undo",
        "Ctrl+Z",
        "",
        lambda: is_free() and bool(document.history.undo_label),
    )
    command(
        "edit.redo",
        "Redo",
        document.redo,
        "redo",
        "Ctrl+Shift+Z",
        "",
        lambda: is_free() and bool(document.history.redo_label),
    )
    command(
        "edit.delete",
        "Delete what is selected",
        do.delete_selected,
        "delete",
        "Del",
        "",
        partial(has_selected, "feature", "operation"),
    )
    command(
        "edit.suppress",
        "Suppress or cut again",
        do.suppress_selected,
        "suppress",
        "Ctrl+D",
        "Keep the selected operation in the tree without cutting it",
        partial(has_selected, "operation"),
    )
    command(
        "edit.copy",
        "Copy the operation",
        do.copy_selected,
        "copy",
        "Ctrl+Shift+D",
        "The same work once more behind it, to be given a tool, data, settings or a place of its own",
        partial(has_selected, "operation"),
    )
    command("edit.none", "Select nothing", do.leave, "", "Escape", "", None)
    command(
        "run.program",
        "Program",
        do.program,
        "program",
        "F5",
        "The whole line: features, route, toolpaths, proof",
        is_free,
    )
    for id, text, last, icon, keys in _STEPS:
        command(
            id,
            text,
            partial(document.run, last, tr(text)),
            icon,
            keys,
            f"{text}: what is stale up to here",
            has_part,
        )
    command(
        "library.add",
        "Add to library",
        document.library.add,
        "",
        "",
        "Keep the process as a plan for similar parts",
        document.library.can_add,
    )
    command(
        "library.remove",
        "Remove from library",
        document.library.remove,
        "",
        "",
        "Take the selected plan out of the library",
        document.library.can_remove,
    )
    command(
        "job.cancel",
        "Cancel the running job",
        document.jobs.cancel,
        "cancel",
        "Ctrl+.",
        "",
        lambda: document.is_busy,
    )
    for number, view in enumerate(_VIEWS):
        command(
            f"view.{view}",
            f"View: {view}",
            lambda view=view: window.viewport.scene.look(view),  # type: ignore[misc]
            view,
            f"Ctrl+{number}",
            "",
            None,
        )
    command(
        "view.fit",
        "Fit",
        lambda: window.viewport.scene.fit(),
        "fit",
        "F",
        "Fit the part into the picture",
        None,
    )

    def show_layer(name: str) -> Callable[[bool], object]:
        return lambda on: window.viewport.show_layer(name, on)

    for name, text, keys, on in _LAYERS:
        switch(name, text, show_layer(name), keys, checked=on)
    switch(
        "guides",
        "Guide lines",
        window.guides.switch,
        "G",
        "Show what leads the selected operation",
    )
    switch(
        "section",
        "Section",
        lambda on: window.viewport.show_section(on),
        "X",
        "Cut the part open across its height",
    )
    switch(
        "deviation",
        "Deviation map",
        window.show_deviation,
        "D",
        "Colour the part by gouges and material left, as the proof measured them",
        enabled=lambda: window.deviation.can_show or window.deviation.is_on,
    )
    command(
        "view.find",
        "Find a command…",
        lambda: window.finder.open(),
        "search",
        "Ctrl+Shift+P",
        "",
        None,
    )
    command("view.theme", "Light or dark", do.change_theme, "theme", "Ctrl+Shift+L", "", None)
    command("view.arrangement", "Put docks back", do.forget_arrangement, "reset", "", "", None)
    command("view.language", "Next language", do.change_language, "language", "", "", None)
    command("help.about", "About Trunnion", do.about, "help", "", "", None)
