"""Docks keep their widths whatever happens in them: names stay readable, and nothing jumps when a job ends."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QLabel

from trunnion_gui.storage import preferences

WIDE = "a line that is much longer than any dock is wide " * 40


def widths(window) -> dict[str, int]:
    """Return how wide every visible dock and the picture are."""
    docks = ("steps", "features", "properties")
    return {name: window.arrangement.dock(name).width() for name in docks} | {
        "centre": window.viewport.width()
    }


def relaid(window, qtbot) -> dict[str, int]:
    """Return the widths after everything that waits to be laid out has been."""
    qtbot.wait(50)
    return widths(window)


@pytest.mark.parametrize("size", [(1280, 800), (1440, 900)])
def test_a_change_of_a_proven_plan_leaves_the_docks_as_wide_as_they_were(
    programmed, idle, qtbot, size
):
    programmed.resize(*size)
    programmed.show_dock("code")
    before = relaid(programmed, qtbot)
    programmed.document.selection.select_feature("rib-01")
    programmed.registry.run("edit.delete")
    idle(programmed)
    assert programmed.docks.code.stale.isVisible()
    assert relaid(programmed, qtbot) == before
    programmed.document.run("route", "Generate route")
    idle(programmed)
    assert relaid(programmed, qtbot) == before


@pytest.mark.parametrize("size", [(1280, 800), (1440, 900)])
def test_bars_below_the_picture_take_no_width_from_the_docks(programmed, idle, qtbot, size):
    programmed.resize(*size)
    before = relaid(programmed, qtbot)
    programmed.show_playback(True)
    idle(programmed)
    assert relaid(programmed, qtbot) == before
    programmed.show_playback(False)
    programmed.views["surface"].begin_cut(1, by_plane=True)
    assert relaid(programmed, qtbot) == before


def test_no_dock_asks_for_more_than_its_least_width_whatever_stands_in_it(window, qtbot):
    before = relaid(window, qtbot)
    for name in window.arrangement.names():
        window.show_dock(name)
        inside = window.arrangement.dock(name).widget()
        if inside.layout() is not None:
            inside.layout().addWidget(QLabel(WIDE))
        assert relaid(window, qtbot) == before, name


def test_a_column_that_was_left_too_narrow_is_wide_enough_at_the_next_start(make_window, qtbot):
    first = make_window()
    narrow = first.arrangement
    for name in ("features", "process", "properties"):
        narrow.dock(name).widget().setMinimumWidth(1)
    first.resizeDocks([narrow.dock("features")], [120], Qt.Orientation.Horizontal)
    qtbot.wait(50)
    assert widths(first)["features"] < 200
    narrow.keep()
    assert preferences.arrangement("state") is not None
    again = make_window()
    assert relaid(again, qtbot)["features"] >= 260
