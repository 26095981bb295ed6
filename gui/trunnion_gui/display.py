"""Whether a window can open here: a screen, and the shared libraries that Qt's wheels leave to the system.

Qt ends the process without a word of ours when its platform plugin can't be loaded, so both are looked at before Qt is imported.
"""

from __future__ import annotations

import ctypes
import os
import sys
from collections.abc import Iterable, Mapping

from trunnion.findings import BadCall

DRAWING = {
    "libEGL.so.1": "libegl1",
    "libGL.so.1": "libgl1",
    "libfontconfig.so.1": "libfontconfig1",
    "libfreetype.so.6": "libfreetype6",
    "libdbus-1.so.3": "libdbus-1-3",
    "libglib-2.0.so.0": "libglib2.0-0",
    "libxkbcommon.so.0": "libxkbcommon0",
    "libX11.so.6": "libx11-6",
}
"""What Qt and VTK load on any platform: the library's name, and the Debian package that has it."""
XCB = {
    "libxcb-cursor.so.0": "libxcb-cursor0",
    "libxcb-icccm.so.4": "libxcb-icccm4",
    "libxcb-image.so.0": "libxcb-image0",
    "libxcb-keysyms.so.1": "libxcb-keysyms1",
    "libxcb-randr.so.0": "libxcb-randr0",
    "libxcb-render-util.so.0": "libxcb-render-util0",
    "libxcb-render.so.0": "libxcb-render0",
    "libxcb-shape.so.0": "libxcb-shape0",
    "libxcb-shm.so.0": "libxcb-shm0",
    "libxcb-sync.so.1": "libxcb-sync1",
    "libxcb-xfixes.so.0": "libxcb-xfixes0",
    "libxcb-xkb.so.1": "libxcb-xkb1",
    "libX11-xcb.so.1": "libx11-xcb1",
    "libxkbcommon-x11.so.0": "libxkbcommon-x11-0",
}
"""What Qt's xcb plugin loads besides, for a window on an X server."""
_SCREENS = ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM")


def check_display(environment: Mapping[str, str] = os.environ) -> None:
    """Raise `BadCall` where no window can open: no screen, or libraries that are missing, named with their Debian packages."""
    if not sys.platform.startswith("linux"):
        return
    if not any(environment.get(name) for name in _SCREENS):
        raise BadCall(
            "no screen to open the window on (neither DISPLAY nor WAYLAND_DISPLAY is set); start a desktop, or use the commands"
        )
    wanted = DRAWING | (XCB if uses_xcb(environment) else {})
    missing = missing_libraries(wanted)
    if missing:
        raise BadCall(
            f"the window can't open: {', '.join(missing)} missing; on Debian: "
            f"apt-get install --no-install-recommends {' '.join(wanted[name] for name in missing)}"
        )


def uses_xcb(environment: Mapping[str, str]) -> bool:
    """Whether Qt would take its xcb plugin: asked for by name, or on an X server without Wayland."""
    platform = environment.get("QT_QPA_PLATFORM", "")
    if platform:
        return platform.split(":")[0] == "xcb"
    return bool(environment.get("DISPLAY")) and not environment.get("WAYLAND_DISPLAY")


def missing_libraries(names: Iterable[str]) -> list[str]:
    """Return the shared libraries that the loader does not find, in the order given."""
    return [name for name in names if not _loads(name)]


def _loads(name: str) -> bool:
    try:
        ctypes.CDLL(name)
    except OSError:
        return False
    return True
