"""The picture of a curved part's groups for the documentation, with a cut about to be made."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from trunnion_gui.families.surface.groups import GROUP, is_local
from trunnion_gui.families.surface.view import SurfaceView
from trunnion_gui.screenshots import opened, take

if TYPE_CHECKING:
    from trunnion_gui.window import Window


def shoot_patches(part: str | Path, folder: str | Path) -> Path:
    """Write the picture into a folder and return its path."""
    made = Path(folder) / "patches.png"
    with opened(part, until="recognize", size=(1500, 900)) as window:
        take(window, made, _show_patches)
    return made


def _show_patches(window: Window) -> None:
    """Show where a plane would cut a curved face of the remaining area."""
    recognition, view = window.document.session.recognition, window.views[SurfaceView.name]
    assert isinstance(view, SurfaceView)
    curved = (
        [f for f in recognition.of_kind(GROUP) if "convex_radius" in f.sizes and not is_local(f)]
        if recognition is not None
        else []
    )
    if curved:
        view.begin_cut(curved[0].tags[0], True)


if __name__ == "__main__":
    shoot_patches(sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else "docs/pictures")
