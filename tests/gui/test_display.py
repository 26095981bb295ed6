"""What a window needs of the machine: a screen and libraries, looked at before Qt ends the process without a word."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import PySide6
import pytest

from trunnion.findings import BadCall
from trunnion_gui import display
from trunnion_gui.display import DRAWING, XCB, check_display, missing_libraries, uses_xcb

ROOT = Path(__file__).parents[2]
PLUGIN = Path(PySide6.__file__).parent / "Qt" / "plugins" / "platforms" / "libqxcb.so"
FROM_OTHERS = {"libxcb.so.1", "libxcb-util.so.1"}
"""Come with the packages that are named: every one of them depends on libxcb1, libxcb-cursor0 on libxcb-util1."""


def test_setup_installs_every_library_that_a_window_needs():
    named = set(
        re.findall(
            r"[a-z0-9.+-]+", (ROOT / "installer" / "debian.sh").read_text().split('[ "${1')[0]
        )
    )
    assert set(DRAWING.values()) | set(XCB.values()) <= named


def test_a_window_started_by_make_has_its_packages_looked_at():
    rules = (ROOT / "Makefile").read_text()
    assert "run: setup" in rules and re.search(r"^setup: packages ", rules, re.M)
    assert "debian.sh" in rules.split("\npackages:")[1].split("\n\n")[0]


def test_every_library_of_qts_xcb_plugin_is_looked_for():
    listed = subprocess.run(["ldd", str(PLUGIN)], capture_output=True, text=True, check=True).stdout
    linked = {
        name
        for name in re.findall(r"^\s*(\S+) =>", listed, re.M)
        if name.startswith(("libxcb", "libX11-xcb", "libxkbcommon-x11"))
    }
    assert linked - FROM_OTHERS <= set(XCB)


def test_a_library_that_is_missing_is_named_with_its_package(monkeypatch):
    monkeypatch.setitem(display.XCB, "libtrunnion-nowhere.so.7", "libtrunnion-nowhere7")
    with pytest.raises(BadCall) as told:
        check_display({"DISPLAY": ":0"})
    assert "libtrunnion-nowhere.so.7" in str(told.value) and "libtrunnion-nowhere7" in str(
        told.value
    )
    assert "\n" not in str(told.value)


def test_xcb_is_not_asked_for_where_another_platform_draws():
    assert uses_xcb({"DISPLAY": ":0"}) and uses_xcb({"QT_QPA_PLATFORM": "xcb"})
    assert not uses_xcb({"DISPLAY": ":0", "WAYLAND_DISPLAY": "wayland-0"})
    assert not uses_xcb({"DISPLAY": ":0", "QT_QPA_PLATFORM": "offscreen"})


def test_no_screen_at_all_is_told():
    with pytest.raises(BadCall, match="no screen"):
        check_display({})


def test_libraries_are_told_apart():
    assert missing_libraries(["libc.so.6", "libtrunnion-nowhere.so.7"]) == [
        "libtrunnion-nowhere.so.7"
    ]
