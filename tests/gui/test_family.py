"""What a part was taken for stands in the first panel, and a click goes on where recognition stopped."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QPushButton

from trunnion import registry

FAMILIES = list(registry.names("families"))


def answers(window) -> dict[str, QPushButton]:
    """Return the shown buttons that go on as a family, by its name and in their order."""
    panel = window.panels["recognize"]
    row = [panel._actions.itemAt(n).widget() for n in range(panel._actions.count())]
    return {b.property("family"): b for b in row if b.isVisible()}


@pytest.fixture
def stopped(make_window, part_file, idle):
    """A window whose part is taken for a casing, after a try to program it."""
    window = make_window("fake_engine:DoubtingEngine")
    window.document.files.open(part_file)
    idle(window)
    window.document.program()
    idle(window)
    return window


def test_the_window_stops_and_says_what_the_part_looks_like(stopped):
    assert stopped.document.states["size"] == "empty"
    assert (
        stopped.viewport.notice.text
        == "The part looks like a casing: choose recognize.family = panel or surface"
    )
    said = stopped.panels["recognize"].result.text()
    assert said.startswith(
        "Taken for a casing (0.97): 96 % of the area is of revolution, &lt;thin&gt;<br>Nothing was recognized."
    )
    assert [b.text() for b in answers(stopped).values()] == [
        f"Go on as {name}" for name in FAMILIES
    ]


def test_a_click_goes_on_as_a_family_and_undo_takes_it_back(stopped, idle):
    QTest.mouseClick(answers(stopped)["panel"], Qt.MouseButton.LeftButton)
    idle(stopped)
    document = stopped.document
    assert document.session.choices["recognize.family"] == "panel"
    assert document.session.recognition.family == "panel" and not document.session.recognition.doubt
    assert document.states["recognize"] == "done"
    assert answers(stopped) == {}
    assert (
        stopped.panels["recognize"]
        .result.text()
        .startswith("Taken for a panel (0.12): 12 % of the area")
    )
    document.undo()
    document.undo()
    idle(stopped)
    assert "recognize.family" not in document.session.choices
    assert list(answers(stopped)) == FAMILIES


def test_the_family_it_was_taken_for_is_offered_first(make_window, part_file, idle):
    window = make_window("fake_engine:UnsureEngine")
    window.document.files.open(part_file)
    idle(window)
    window.document.run("recognize", "Recognize")
    idle(window)
    assert list(answers(window)) == ["surface", *(name for name in FAMILIES if name != "surface")]
    QTest.mouseClick(answers(window)["surface"], Qt.MouseButton.LeftButton)
    idle(window)
    assert window.document.session.choices["recognize.family"] == "surface"
    assert answers(window) == {}


def test_a_sure_recognition_offers_nothing(make_window, part_file, idle):
    window = make_window()
    window.document.files.open(part_file)
    idle(window)
    window.document.run("recognize", "Recognize")
    idle(window)
    assert answers(window) == {}
    assert "Taken for" not in window.panels["recognize"].result.text()
