"""Unsaved work: asked about wherever it could be lost, kept while it grows, offered after a crash."""

from __future__ import annotations

import json
import os

import pytest
from PySide6.QtCore import QMimeData, QPointF, Qt, QTimer, QUrl
from PySide6.QtGui import QDropEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QMessageBox, QPushButton

from trunnion_gui.storage import preferences, recovery
from trunnion_gui.storage.autosave import autosave_owner, notes_of
from trunnion_gui.storage.unsaved import CANCEL, DISCARD, SAVE

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def other_file(tmp_path):
    """Another file that the fake engine takes for a part."""
    path = tmp_path / "other.step"
    path.write_text("a made-up part")
    return path


def by_dialog(window, path, monkeypatch):
    monkeypatch.setattr(window.dialogs, "open_path", lambda: str(path))
    window.registry.run("file.open")


def by_drop(window, path, _monkeypatch):
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(path))])
    window.dropEvent(
        QDropEvent(
            QPointF(10, 10), Qt.DropAction.CopyAction, data, LEFT, Qt.KeyboardModifier.NoModifier
        )
    )


def by_recent(window, path, _monkeypatch):
    preferences.add_recent(str(path))
    menu = next(
        a.menu()
        for m in window.menuBar().actions()
        for a in m.menu().actions()
        if a.text() == "Open recent"
    )
    menu.aboutToShow.emit()
    next(a for a in menu.actions() if a.text() == path.name).trigger()


def by_welcome(window, path, _monkeypatch):
    window.viewport.welcome.show_recent([str(path)])
    next(
        b for b in window.viewport.welcome.findChildren(QPushButton) if b.text() == path.name
    ).click()


WAYS = (by_dialog, by_drop, by_recent, by_welcome)


def answering(window, monkeypatch, answer) -> list[int]:
    """Let a person answer the question; return a list that grows with every time it is asked."""
    asked = []
    window.unsaved.confirms = True
    monkeypatch.setattr(window.unsaved, "confirm", lambda: asked.append(1) or answer)
    return asked


def test_cancel_keeps_the_work_whichever_way_another_file_is_opened(
    programmed, other_file, idle, monkeypatch
):
    before = programmed.document.session
    for way in WAYS:
        asked = answering(programmed, monkeypatch, CANCEL)
        way(programmed, other_file, monkeypatch)
        idle(programmed)
        assert len(asked) == 1, way
        assert programmed.document.session is before, way
        assert programmed.document.history.undo_label == "Program", way


@pytest.mark.parametrize("way", WAYS)
def test_discard_opens_the_other_file(programmed, other_file, idle, monkeypatch, way):
    answering(programmed, monkeypatch, DISCARD)
    way(programmed, other_file, monkeypatch)
    idle(programmed)
    assert programmed.document.session.part.name == "other"


def test_save_writes_the_project_first_and_then_opens_the_other_file(
    programmed,
    other_file,
    tmp_path,
    idle,
    monkeypatch,
    qtbot,
):
    project = tmp_path / "tray.trunnion"
    answering(programmed, monkeypatch, SAVE)
    monkeypatch.setattr(programmed.dialogs, "save_path", lambda: str(project))
    by_dialog(programmed, other_file, monkeypatch)
    qtbot.waitUntil(lambda: programmed.document.session.part.name == "other", timeout=10000)
    idle(programmed)
    programmed.document.files.open(project)
    idle(programmed)
    assert programmed.document.session.verdict is not None


def test_a_person_who_then_chooses_no_file_to_save_to_keeps_the_work(
    programmed, other_file, idle, monkeypatch
):
    answering(programmed, monkeypatch, SAVE)
    monkeypatch.setattr(programmed.dialogs, "save_path", lambda: "")
    before = programmed.document.session
    by_dialog(programmed, other_file, monkeypatch)
    idle(programmed)
    assert programmed.document.session is before


def test_a_project_that_can_not_be_written_keeps_the_work(
    programmed, other_file, tmp_path, idle, monkeypatch
):
    answering(programmed, monkeypatch, SAVE)
    monkeypatch.setattr(
        programmed.dialogs, "save_path", lambda: str(tmp_path / "nowhere" / "tray.trunnion")
    )
    before = programmed.document.session
    by_dialog(programmed, other_file, monkeypatch)
    idle(programmed)
    assert (
        programmed.document.session is before
        and "can't be written" in programmed.viewport.notice.text
    )


def test_nothing_is_asked_where_nothing_would_be_lost(opened, other_file, idle, monkeypatch):
    asked = answering(opened, monkeypatch, CANCEL)
    by_dialog(opened, other_file, monkeypatch)
    idle(opened)
    assert asked == [] and opened.document.session.part.name == "other"


def test_the_dialog_offers_to_save_to_discard_and_to_go_back(programmed, qtbot):
    seen = []

    def look() -> None:
        box = QApplication.activeModalWidget()
        assert isinstance(box, QMessageBox)
        seen.extend(box.button(b).text() for b in (SAVE, DISCARD, CANCEL))
        seen.append(box.text())
        QTest.keyClick(box, Qt.Key.Key_Escape)

    QTimer.singleShot(200, look)
    assert programmed.unsaved.confirm() == CANCEL
    assert seen == ["Save", "Discard", "Cancel", "Save the changes to tray.step?"]


@pytest.mark.parametrize(("answer", "closes"), [(CANCEL, False), (DISCARD, True), (SAVE, True)])
def test_closing_asks_the_same(programmed, tmp_path, monkeypatch, qtbot, answer, closes):
    project = tmp_path / "tray.trunnion"
    asked = answering(programmed, monkeypatch, answer)
    monkeypatch.setattr(programmed.dialogs, "save_path", lambda: str(project))
    programmed.close()
    if closes:
        qtbot.waitUntil(lambda: not programmed.isVisible(), timeout=10000)
    assert (
        len(asked) == 1
        and programmed.isVisible() != closes
        and project.exists() == (answer == SAVE)
    )
    programmed.unsaved.confirms = False


def test_closing_while_a_run_goes_on_saves_what_was_finished(
    make_window, part_file, tmp_path, idle, monkeypatch, qtbot
):
    window = make_window("fake_engine:SlowEngine")
    window.document.files.open(part_file)
    idle(window)
    project = tmp_path / "tray.trunnion"
    answering(window, monkeypatch, SAVE)
    monkeypatch.setattr(window.dialogs, "save_path", lambda: str(project))
    window.document.program()
    qtbot.waitUntil(lambda: window.document.shown.recognition is not None, timeout=20000)
    window.close()
    qtbot.waitUntil(lambda: not window.isVisible(), timeout=20000)
    again = make_window()
    again.document.files.open(project)
    idle(again)
    assert again.document.session.recognition is not None


# recovery


def left_behind(window, monkeypatch, qtbot):
    """Return the autosave of a window as if its program had been killed; the window's own is gone."""
    window.recovery.keep()
    own = preferences.autosave_file()
    qtbot.waitUntil(lambda: notes_of(own).exists(), timeout=10000)
    left = own.with_name("autosave-999999999.trunnion")
    left.write_bytes(own.read_bytes())
    notes_of(left).write_text(notes_of(own).read_text())
    return left


def press(window, words: str) -> None:
    QTest.mouseClick(
        next(b for b in window.viewport.notice.findChildren(QPushButton) if b.text() == words), LEFT
    )


def test_steady_work_is_kept_and_does_not_put_the_keeping_off(opened, idle, qtbot):
    opened.recovery._soon.setInterval(300)
    for n in range(8):  # an edit every 100 ms: a timer that begins anew would never fire
        opened.document.choose("fake.blank.side", "Allowance", 6.0 + n)
        qtbot.wait(100)
    assert preferences.autosave_file().exists()


def test_ten_edits_are_kept_at_once(opened, idle, qtbot):
    opened.recovery._soon.setInterval(600_000)
    for n in range(recovery.MOST_EDITS - 1):
        opened.document.choose("fake.blank.side", "Allowance", 6.0 + n)
    qtbot.wait(100)
    assert not preferences.autosave_file().exists()
    opened.document.choose("fake.blank.side", "Allowance", 3.0)
    qtbot.waitUntil(preferences.autosave_file().exists, timeout=5000)


def test_at_most_five_seconds_are_lost():
    assert recovery.LATEST_MS <= 4500


def test_steps_that_a_run_has_finished_are_kept_while_it_goes_on(
    make_window, part_file, idle, qtbot
):
    window = make_window("fake_engine:SlowEngine")
    window.document.files.open(part_file)
    idle(window)
    window.recovery._soon.setInterval(100)
    window.document.program()
    qtbot.waitUntil(preferences.autosave_file().exists, timeout=20000)
    assert window.document.is_busy
    window.registry.run("job.cancel")
    idle(window)


def test_an_explicit_save_leaves_no_autosave(programmed, tmp_path, idle, monkeypatch, qtbot):
    programmed.recovery.keep()
    own = preferences.autosave_file()
    qtbot.waitUntil(own.exists, timeout=10000)
    monkeypatch.setattr(programmed.dialogs, "save_path", lambda: str(tmp_path / "tray.trunnion"))
    programmed.registry.run("file.save")
    idle(programmed)
    qtbot.waitUntil(lambda: not own.exists() and not notes_of(own).exists(), timeout=10000)


def test_what_was_undone_to_the_saved_state_leaves_no_autosave(opened, idle, qtbot):
    opened.document.choose("fake.blank.side", "Allowance", 8.0)
    opened.recovery.keep()
    qtbot.waitUntil(preferences.autosave_file().exists, timeout=10000)
    idle(opened)
    opened.document.undo()
    qtbot.waitUntil(lambda: not preferences.autosave_file().exists(), timeout=10000)


def test_a_recovered_project_knows_its_file_and_still_has_to_be_saved(
    make_window,
    programmed,
    tmp_path,
    idle,
    monkeypatch,
    qtbot,
):
    project = tmp_path / "tray.trunnion"
    monkeypatch.setattr(programmed.dialogs, "save_path", lambda: str(project))
    programmed.registry.run("file.save")
    idle(programmed)
    programmed.document.choose("fake.blank.side", "Allowance", 8.0)
    left = left_behind(programmed, monkeypatch, qtbot)
    window = make_window()
    told = autosave_owner(left)
    assert (
        "tray.trunnion" in window.viewport.notice.text
        and told.time.partition("T")[2] in window.viewport.notice.text
    )
    press(window, "Recover")
    idle(window)
    assert window.document.session.choices["fake.blank.side"] == 8.0
    assert window.document.files.project == str(project) and window.document.history.is_dirty
    assert not left.exists() and not notes_of(left).exists()
    window.registry.run("file.save")
    idle(window)
    assert not window.document.history.is_dirty
    again = make_window()
    again.document.files.open(project)
    idle(again)
    assert again.document.session.choices["fake.blank.side"] == 8.0


def test_a_recovered_part_without_a_project_is_named_by_its_file(
    make_window, programmed, idle, monkeypatch, qtbot
):
    left_behind(programmed, monkeypatch, qtbot)
    window = make_window()
    assert "tray.step" in window.viewport.notice.text
    press(window, "Recover")
    idle(window)
    assert window.document.session.verdict is not None
    assert window.document.history.is_dirty and window.document.files.project == ""


def test_work_that_is_thrown_away_makes_room_for_the_next_one(
    make_window, programmed, monkeypatch, qtbot
):
    left = left_behind(programmed, monkeypatch, qtbot)
    older = left.with_name("autosave-999999998.trunnion")
    older.write_bytes(left.read_bytes())
    notes_of(older).write_text(json.dumps({"project": "/somewhere/older.trunnion"}))
    os.utime(older, (1.0, 1.0))
    window = make_window()
    press(window, "Discard")
    assert not left.exists() and not notes_of(left).exists()
    assert "older.trunnion" in window.viewport.notice.text


def test_an_autosave_with_damaged_notes_is_offered_by_its_time(make_window, monkeypatch):
    left = preferences.autosave_file().with_name("autosave-999999999.trunnion")
    left.write_bytes(b"")
    notes_of(left).write_text("{")
    window = make_window()
    assert "was not saved when the program ended" in window.viewport.notice.text


def test_an_autosave_is_left_behind_when_another_program_got_its_number(tmp_path):
    left = preferences.autosave_file().with_name("autosave-1.trunnion")
    left.write_bytes(b"")
    os.utime(left, (1.0, 1.0))  # older than the program that has the number now
    assert preferences.leftover_file() == left


def test_work_that_can_not_be_kept_is_told(opened, monkeypatch, qtbot):
    folder = preferences.autosave_file().parent
    opened.recovery.file._path = folder / "nowhere" / "autosave.trunnion"
    opened.document.choose("fake.blank.side", "Allowance", 8.0)
    opened.recovery.keep()
    qtbot.waitUntil(lambda: "not kept for recovery" in opened.viewport.notice.text, timeout=10000)
