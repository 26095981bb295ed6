"""Features of a panel given other faces in the window, with the real engine and real clicks: taken, added, merged, made, undone."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QMenu
from shared_window import shared_window, taken_back, wait

CTRL = Qt.KeyboardModifier.ControlModifier
LEFT, RIGHT = Qt.MouseButton.LeftButton, Qt.MouseButton.RightButton
ON_LEFT, ON_RIGHT = (20.0, 25.0, 4.0), (110.0, 50.0, 4.0)
"""Places on the floors of both pockets."""


@pytest.fixture(scope="module")
def panel(qapp, tmp_path_factory, sample_panel):
    """One window for all tests here, with the features of the small panel, seen from the top."""
    with shared_window(tmp_path_factory.mktemp("settings")) as window:
        window.document.files.open(sample_panel)
        wait(window)
        window.document.run("recognize", "Recognize")
        wait(window)
        window.registry.run("view.top")
        yield window


@pytest.fixture
def recognised(panel):
    with taken_back(panel) as window:
        yield window


def click(window, place, button=LEFT, keys=Qt.KeyboardModifier.NoModifier) -> None:
    """Click the part at a place of it."""
    QTest.mouseClick(
        window.viewport.scene.view, button, keys, window.viewport.scene.where(place).toPoint()
    )


def face_at(window, place) -> int:
    return window.viewport.scene.face_at(window.viewport.scene.where(place))


def owner(window, face: int) -> str:
    """Return the pocket or the like that a face is in."""
    return next((f.id for f in window.document.shown.recognition if face in f.tags), "")


def open_menu(window) -> QMenu:
    return next(m for m in window.viewport.findChildren(QMenu) if m.isVisible())


def entry(menu: QMenu, *words: str):
    """Return the entry of a menu, or of the menus in it, that is called so."""
    *outer, last = words
    for word in outer:
        menu = next(a.menu() for a in menu.actions() if a.text() == word)
    return next(a for a in menu.actions() if a.text() == last)


def test_faces_are_taken_added_and_made_a_feature_by_clicks_and_undone(recognised, idle):
    window, before = recognised, recognised.document.session
    face = face_at(window, ON_LEFT)
    home = owner(window, face)
    other = owner(window, face_at(window, ON_RIGHT))
    assert home.startswith("pocket") and other.startswith("pocket") and home != other

    click(window, ON_LEFT, RIGHT)
    menu = open_menu(window)
    entry(menu, f"Take from {home}").trigger()
    menu.close()
    idle(window)
    assert face in window.document.shown.recognition.unexplained
    assert "through" in window.document.feature(home).attributes

    click(window, ON_LEFT, RIGHT)
    menu = open_menu(window)
    entry(menu, "Add to", other).trigger()
    menu.close()
    idle(window)
    assert owner(window, face) == other
    assert ("floor", face) in {(f.role, f.face) for f in window.document.feature(other).faces}

    click(window, ON_LEFT, RIGHT)
    menu = open_menu(window)
    entry(menu, "New feature", "Pocket").trigger()
    menu.close()
    idle(window)
    made = owner(window, face)
    assert made not in (home, other, "")
    assert window.document.feature(made).by_hand
    assert window.panels["size"].state in ("stale", "empty")

    for _ in range(3):
        window.registry.run("edit.undo")
    idle(window)
    assert window.document.session is before


def test_selected_pockets_are_merged_by_the_menu_of_a_row_and_undone(recognised, idle):
    window, tree = recognised, recognised.docks.features.tree
    first, second = (owner(window, face_at(window, at)) for at in (ON_LEFT, ON_RIGHT))
    faces = {*window.document.feature(first).tags, *window.document.feature(second).tags}
    for id, keys in ((first, Qt.KeyboardModifier.NoModifier), (second, CTRL)):
        row = window.docks.features.item(id)
        tree.scrollToItem(row)
        QTest.mouseClick(tree.viewport(), LEFT, keys, tree.visualItemRect(row).center())
    menu = window.docks.features.menu(window.document.feature(first))
    entry(menu, f"Merge {second} into {first}").trigger()
    idle(window)
    assert set(window.document.feature(first).tags) == faces
    assert window.document.feature(second) is None
    window.registry.run("edit.undo")
    idle(window)
    assert window.document.feature(second) is not None


def test_what_can_not_be_a_feature_is_refused_in_a_message(recognised, idle):
    window = recognised
    face = face_at(window, ON_LEFT)
    window.views.face_edits.make("island", (face,))
    idle(window)
    assert owner(window, face).startswith("pocket")
    assert any("stands on the floor" in m.text for m in window.docks.messages.findings)
