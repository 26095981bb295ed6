"""The plan library in the route panel: a process is added, matched, followed, removed and undone by real clicks."""

from __future__ import annotations

import os

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from shared_window import shared_window, wait

from samples import block_with_pocket
from trunnion.shop.library import PlanLibrary, library_file

CLICK = Qt.MouseButton.LeftButton


@pytest.fixture(scope="module")
def routed_once(qapp, tmp_path_factory):
    """One window for all tests here, the library of a folder of their own, and the project of a routed part."""
    folder = tmp_path_factory.mktemp("library")
    with pytest.MonkeyPatch.context() as patch:
        # The window's worker starts with the folder in its environment.
        patch.setenv("TRUNNION_USER_FOLDER", str(folder))
        with shared_window(folder / "settings") as window:
            window.document.files.open(block_with_pocket())
            wait(window)
            window.document.run("route", "Generate route")
            wait(window)
            window.document.files.save(folder / "routed.trunnion")
            wait(window)
            yield window, PlanLibrary(library_file(None)), folder / "routed.trunnion"


@pytest.fixture
def library(routed_once):
    """That library, with no plan in it."""
    library = routed_once[1]
    for name in library.names():
        library.remove(name)
    return library


@pytest.fixture
def routed(routed_once, library, qtbot):
    """That window with the routed part and the library's block open."""
    window, _, project = routed_once
    window.document.files.open(project)
    wait(window)
    panel = window.panels["route"]
    panel.fold(False)
    qtbot.waitUntil(panel.library.header.isVisible, timeout=5000)
    panel.library.name.clear()
    if not panel.library.add.isVisible():
        QTest.mouseClick(panel.library.header, CLICK, pos=QPoint(30, 8))
    wait(window)
    return window


def press(button):
    assert button.isEnabled(), button.text()
    QTest.mouseClick(button, CLICK)


def shown_rows(block):
    return [
        tuple(block.table.item(row, column).text() for column in range(3))
        for row in range(block.table.rowCount())
    ]


@pytest.mark.timeout(240)
def test_a_person_adds_a_plan_sees_why_it_matches_removes_it_and_takes_both_back(
    routed, library, qtbot, idle
):
    document, block = routed.document, routed.panels["route"].library
    assert shown_rows(block) == [] and library.names() == ()
    assert not block.remove.isEnabled()
    session = document.session

    QTest.keyClicks(block.name, "block A")
    press(block.add)
    idle(routed)
    assert library.names() == ("block A",)
    ((name, similarity, words),) = shown_rows(block)
    assert (name, similarity) == ("block A", "100 %") and "the same sizes" in words
    # The session is the same, and its finished route is not stale: only other parts follow the plan by themselves.
    assert document.session is session and document.states["route"] == "done"
    assert block.words.text() == "The route follows none of these plans"
    assert document.history.undo_label == "Add block A to the library"

    cell = block.table.visualItemRect(block.table.item(0, 0)).center()
    QTest.mouseClick(block.table.viewport(), CLICK, pos=cell)
    assert block.reason.text() == f"block A: {words}"
    if folder := os.environ.get("TRUNNION_PICTURES"):
        routed.grab().save(os.path.join(folder, "plan-library.png"))
    press(block.remove)
    idle(routed)
    assert library.names() == () and shown_rows(block) == []

    document.undo()
    idle(routed)
    assert library.names() == ("block A",) and shown_rows(block)[0][0] == "block A"
    document.undo()
    idle(routed)
    assert library.names() == ()
    document.redo()
    idle(routed)
    assert library.names() == ("block A",)
    assert document.history.undo_label == "Add block A to the library"


@pytest.mark.timeout(240)
def test_a_route_that_follows_the_plan_says_so(routed, library, idle):
    document, block = routed.document, routed.panels["route"].library
    press(block.add)
    idle(routed)
    assert library.names() == (document.session.part.name,)
    name = library.names()[0]
    document.choose("route.library.use", "Plan library", name)
    idle(routed)
    assert document.states["route"] == "stale"
    assert block.words.text() == f"The route follows {name}"
    document.run("route", "Generate route")
    idle(routed, 90000)
    process = document.shown.process
    assert process.plan == document.session.part.name
    assert all("From the taught plan" in o.rules[-1] for o in process.operations)
    assert process.plan in routed.panels["route"].result.text()


@pytest.mark.timeout(240)
def test_a_name_that_is_in_use_is_refused_in_a_message_and_nothing_is_lost(routed, library, idle):
    document, block = routed.document, routed.panels["route"].library
    notices = []
    document.noticed.connect(notices.append)
    press(block.add)
    idle(routed)
    label = document.history.undo_label
    press(block.add)
    idle(routed)
    assert any("choose another name" in n.text for n in notices)
    assert document.history.undo_label == label and len(library.names()) == 1
    # What another window took out can't be taken out again: the history stays where it is.
    library.remove(library.names()[0])
    document.undo()
    idle(routed)
    assert any("there is no plan" in n.text for n in notices)
    assert document.history.undo_label == label
