"""The commands of the menu *Patches*: what a person does with the groups of equal patches of a curved part."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from trunnion_gui.actions import Command
from trunnion_gui.menus.window_access import WindowAccess

if TYPE_CHECKING:
    from trunnion_gui.families.surface.view import SurfaceView


def add_commands(view: SurfaceView, window: WindowAccess) -> None:
    """Add them to a window's registry."""
    document, tools = view.document, view.tools

    def is_free() -> bool:
        return tools.has_groups and not document.is_busy

    def can_cut() -> bool:
        return document.has_part and not document.is_busy

    def command(
        id: str,
        text: str,
        run: Callable[..., object],
        icon: str,
        keys: str,
        help: str,
        enabled: Callable[[], bool] = is_free,
        checkable: bool = False,
    ) -> None:
        window.registry.add(
            Command(
                id=f"patch.{id}",
                text=text,
                run=run,
                icon=icon,
                keys=keys,
                help=help,
                menu="Patches",
                enabled=enabled,
                checkable=checkable,
            )
        )

    def begin_cut(by_plane: bool) -> None:
        faces = document.selection.current.faces
        view.begin_cut(faces[0] if len(faces) == 1 else 0, by_plane)

    def mark_local(on: bool) -> None:
        window.viewport.give_clicks_to(tools.toggle_face if on else None)

    def measure() -> None:
        view.jobs.measure()
        window.show_dock("accuracy")

    command(
        "local",
        "Local feature, or no longer",
        lambda: tools.toggle_local(document.selection.current.faces),
        "local",
        "O",
        "Give the selected groups a cutter of their own, or let them go with the remaining area",
        lambda: is_free() and bool(tools.groups_of(document.selection.current.faces)),
    )
    command(
        "click_local",
        "Click local features",
        mark_local,
        "local",
        "Shift+O",
        "While this is on, a click on the part makes its group a local feature, or no longer",
        checkable=True,
    )
    command(
        "ids",
        "Show IDs",
        lambda on: window.viewport.show_layer("ids", on),
        "ids",
        "N",
        "Write the ID of every group on the part, or of every selected face",
        lambda: document.has_part,
        True,
    )
    command(
        "radii",
        "Colours by radius",
        lambda on: window.viewport.colour_by(view.by_radius if on else None),
        "radii",
        "R",
        "Colour every group by its smallest concave radius",
        lambda: tools.has_groups,
        True,
    )
    command(
        "cut_plane",
        "Cut a face by a plane…",
        partial(begin_cut, True),
        "cut_plane",
        "",
        "Make two patches of one, across x, y or z or through three places",
        can_cut,
    )
    command(
        "cut_way",
        "Cut a face along a drawn line…",
        partial(begin_cut, False),
        "cut_way",
        "",
        "Make two patches of one, along a line through the places you click",
        can_cut,
    )
    command(
        "errors",
        "Size error by points",
        measure,
        "errors",
        "",
        "Measure how exact the feature sizes are and what they cost, by the number of points on each edge",
        can_cut,
    )
    command(
        "export",
        "Export patches…",
        lambda: view.export_dialog.begin(),
        "export",
        "Ctrl+Shift+E",
        "Write local features, the remaining area or some groups as STEP or IGES",
    )
