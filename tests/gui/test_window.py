"""The window with real clicks, over the fake engine."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtCore import QMimeData, QObject, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDropEvent, QGuiApplication
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QPushButton, QToolButton
from shared_window import shared_window, taken_back, wait

from trunnion.findings import Fix, error, face_tags, warning
from trunnion_gui.look import icons
from trunnion_gui.storage import preferences
from trunnion_gui.widgets.finder import score
from trunnion_gui.worker.steps import STAGES, STEPS, TITLES, joined_state

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture(scope="module")
def programmed_once(qapp, tmp_path_factory):
    """One window for tests that take back what they changed, with the made-up part programmed."""
    part = tmp_path_factory.mktemp("parts") / "tray.step"
    part.write_text("a made-up part")
    with shared_window(tmp_path_factory.mktemp("settings"), "fake_engine:FakeEngine") as window:
        window.document.files.open(part)
        wait(window)
        window.document.program()
        wait(window)
        yield window


@pytest.fixture
def tray(programmed_once):
    """That window with nothing selected and no message filtered."""
    with taken_back(programmed_once) as window:
        window.docks.messages.filter.words.clear()
        yield window


def tool_button(window, command: str) -> QToolButton:
    """Return the toolbar's button of a command."""
    return window.toolbar.widgetForAction(window.registry.action(command))


def panel_button(window, panel: str, command: str) -> QPushButton:
    """Return a panel's button of a command."""
    return next(
        b
        for b in window.panels[panel].findChildren(QPushButton)
        if b.property("command") == command
    )


def test_a_part_is_programmed_in_three_interactions(window, part_file, idle, monkeypatch):
    monkeypatch.setattr(
        window.dialogs, "open_path", lambda: str(part_file)
    )  # choosing the file: one interaction
    QTest.mouseClick(tool_button(window, "file.open"), LEFT)
    idle(window)
    QTest.mouseClick(tool_button(window, "run.program"), LEFT)
    idle(window)
    assert "verdict: passed" in window.status.verdict.text()
    assert "coverage 99.6 %" in window.status.verdict.text()


def test_program_without_a_part_asks_for_one_and_goes_on(
    window, part_file, idle, monkeypatch, qtbot
):
    monkeypatch.setattr(window.dialogs, "open_path", lambda: str(part_file))
    QTest.mouseClick(tool_button(window, "run.program"), LEFT)
    qtbot.waitUntil(lambda: window.document.session.verdict is not None, timeout=20000)


def test_every_panel_runs_its_step(opened, idle):
    for panel, command in (
        ("recognize", "step.recognize"),
        ("size", "step.size"),
        ("blank", "step.blank"),
        ("route", "step.route"),
        ("optimize", "step.optimize"),
        ("generate", "step.verify"),
    ):
        opened.panels[panel].fold(False)
        QTest.mouseClick(panel_button(opened, panel, command), LEFT)
        idle(opened)
        assert opened.panels[panel].state == "done"


def test_a_setting_makes_its_step_and_all_after_it_stale(tray, idle):
    field = tray.panels["blank"].forms[0].field("fake.blank.side")
    field.setValue(8.0)
    idle(tray)
    assert tray.document.session.choices["fake.blank.side"] == 8.0
    assert [tray.panels[n].state for n in ("recognize", "size", "blank", "route")] == [
        "done",
        "done",
        "stale",
        "stale",
    ]


def test_undo_takes_a_setting_back_and_redo_brings_it_again(opened, idle):
    field = opened.panels["blank"].forms[0].field("fake.blank.side")
    field.setValue(8.0)
    idle(opened)
    QTest.mouseClick(tool_button(opened, "edit.undo"), LEFT)
    assert field.value() == 5.0
    QTest.mouseClick(tool_button(opened, "edit.redo"), LEFT)
    assert field.value() == 8.0


def test_a_deleted_feature_comes_back_with_undo(tray, idle):
    tray.document.selection.select_feature("rib-01")
    tray.registry.run("edit.delete")
    idle(tray)
    assert tray.document.feature("rib-01") is None
    tray.registry.run("edit.undo")
    assert tray.document.feature("rib-01") is not None


def test_the_unexplained_share_follows_a_deletion(tray, idle):
    tray.document.selection.select_feature("profile-01")
    tray.registry.run("edit.delete")
    idle(tray)
    around = 2 * (240.0 + 140.0) * 30.0
    share = 100.0 * around / tray.document.session.recognition.face_area.sum()
    assert (
        f"4 faces unexplained ({share:.1f} % of the area)" in tray.panels["recognize"].result.text()
    )


def test_the_feature_menu_changes_a_kind(tray, idle):
    feature = tray.document.feature("rib-01")
    change = tray.docks.features.menu(feature).actions()[0].menu()
    next(a for a in change.actions() if a.text() == "Island").trigger()
    idle(tray)
    assert tray.document.feature("rib-01").kind == "island"
    assert tray.panels["size"].state == "stale"


def test_an_operation_dropped_on_another_is_cut_before_it(tray, idle):
    tray.docks.process.tree.dropped.emit("op-06", "op-04")
    idle(tray)
    order = [o.id for o in tray.document.session.process.operations]
    assert order.index("op-06") < order.index("op-04")


def test_a_wrong_order_is_refused_in_a_message(tray, idle):
    before = tray.document.session
    tray.docks.process.tree.dropped.emit("op-03", "op-02")
    assert tray.document.session is before
    assert "op-03 must come after op-02" in tray.viewport.notice.text


def test_an_operations_own_setting_is_an_edit_by_hand(tray, idle):
    tray.document.selection.select_operation("op-02")
    tray.docks.properties.form.field("fake.rough.stepover").setValue(0.25)
    idle(tray)
    operation = tray.document.operation("op-02")
    assert (operation.choices["fake.rough.stepover"], operation.by_hand) == (0.25, True)


def typed(field, words: str) -> None:
    """Type words into a field in place of what it shows, and leave it by the return key."""
    field.setFocus()
    field.selectAll()
    QTest.keyClicks(field, words)
    QTest.keyClick(field, Qt.Key.Key_Return)


def test_a_typed_feed_speed_and_tool_are_edits_by_hand_and_undo_takes_all_back(tray, idle):
    before = tray.document.session
    tray.document.selection.select_operation("op-02")
    for name, words in (
        ("feed", "1234"),
        ("spindle", "5600"),
        ("tool", "AL3-regular D16 R3"),
    ):
        typed(tray.docks.properties.data_form.field(f"operation.{name}"), words)
        idle(tray)
    changed = tray.document.operation("op-02")
    assert (changed.data.feed, changed.data.spindle) == (1234.0, 5600.0)
    assert changed.tool.name == "AL3-regular D16 R3" and changed.by_hand
    assert tray.document.history.undo_label == "op-02: Tool AL3-regular D16 R3"
    for _ in range(3):
        tray.registry.run("edit.undo")
        idle(tray)
    assert tray.document.session is before


def test_a_feed_that_the_machine_does_not_have_is_refused_and_the_field_shows_the_old_one(
    tray, idle
):
    before = tray.document.session
    tray.document.selection.select_operation("op-02")
    field = tray.docks.properties.data_form.field("operation.feed")
    typed(field, "90000")
    idle(tray)
    assert tray.document.session is before
    assert "feeds at most 20000 mm/min" in tray.viewport.notice.text
    assert field.value() == round(before.process.operation("op-02").data.feed, 1)


def test_a_click_on_a_finding_selects_what_it_names(tray):
    table = tray.docks.messages.table
    row = next(r for r in range(table.rowCount()) if "leans" in table.item(r, 1).text())
    QTest.mouseClick(table.viewport(), LEFT, pos=table.visualItemRect(table.item(row, 1)).center())
    assert tray.document.selection.current.id == "pocket-01"


def test_a_message_about_many_faces_names_eight_and_selects_all(opened):
    faces = face_tags(range(1, 16))
    opened.document.noticed.emit(warning("fake.many", "many faces lean", *faces))
    table = opened.docks.messages.table
    assert table.item(0, 2).text() == f"{', '.join(faces[:8])} and 7 more"
    QTest.mouseClick(table.viewport(), LEFT, pos=table.visualItemRect(table.item(0, 1)).center())
    assert opened.document.selection.current.faces == tuple(range(1, 16))


def shown_messages(window) -> list[str]:
    """Return the texts of the messages that the filter lets through."""
    table = window.docks.messages.table
    return [table.item(r, 1).text() for r in range(table.rowCount()) if not table.isRowHidden(r)]


def test_messages_are_filtered_by_what_they_name_and_by_how_grave_they_are(tray):
    dock = tray.docks.messages
    everything = shown_messages(tray)
    QTest.keyClicks(dock.filter.words, "pocket-02 CUTTER")
    assert shown_messages(tray) == ["two pockets could share a cutter"]
    assert dock.filter.count.text() == f"1 of {len(everything)}"
    dock.filter.words.clear()
    dock.filter.severity.setCurrentIndex(2)
    assert "two pockets could share a cutter" not in shown_messages(tray)
    assert "a wall leans over the floor" in shown_messages(tray)
    dock.filter.severity.setCurrentIndex(0)
    assert shown_messages(tray) == everything and dock.filter.count.text() == ""


def test_a_click_on_a_filtered_message_still_goes_to_what_it_names(tray):
    dock = tray.docks.messages
    QTest.keyClicks(dock.filter.words, "leans")
    row = next(r for r in range(dock.table.rowCount()) if not dock.table.isRowHidden(r))
    at = dock.table.visualItemRect(dock.table.item(row, 1)).center()
    QTest.mouseClick(dock.table.viewport(), LEFT, pos=at)
    assert tray.document.selection.current.id == "pocket-01"


def test_selected_messages_are_copied_as_lines(tray, qtbot):
    dock = tray.docks.messages
    tray.activateWindow()  # a screen without a window manager gives the keyboard to no window by itself
    qtbot.waitUntil(tray.isActiveWindow)
    QTest.keyClicks(dock.filter.words, "leans")
    row = next(r for r in range(dock.table.rowCount()) if not dock.table.isRowHidden(r))
    dock.table.selectRow(row)
    dock.table.setFocus()
    QTest.keyClick(dock.table, Qt.Key.Key_C, Qt.KeyboardModifier.ControlModifier)
    copied = QGuiApplication.clipboard().text()
    assert copied.startswith("warning\ta wall leans over the floor\tpocket-01")
    assert copied.endswith("panel.leaning-wall") and "\n" not in copied
    dock.menu().actions()[1].trigger()
    assert QGuiApplication.clipboard().text() == copied


def test_long_messages_wrap_in_the_width_there_is(opened):
    opened.show_dock("messages")
    opened.document.noticed.emit(warning("fake.short", "short"))
    low = opened.docks.messages.table.rowHeight(0)
    opened.document.noticed.emit(warning("fake.long", "a wall leans over the floor " * 20))
    assert opened.docks.messages.table.rowHeight(0) > 2 * low


def test_a_bad_file_is_told_with_what_to_do(window, tmp_path, idle):
    path = tmp_path / "notes.txt"
    path.write_text("nothing")
    window.document.files.open(path)
    idle(window)
    assert window.viewport.notice.isVisible()
    assert "export the part as STEP" in window.viewport.notice.text


def test_a_dropped_file_is_opened(window, part_file, idle):
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(part_file))])
    window.dropEvent(
        QDropEvent(
            QPointF(10, 10), Qt.DropAction.CopyAction, data, LEFT, Qt.KeyboardModifier.NoModifier
        )
    )
    idle(window)
    assert window.document.session.part.name == "tray"


def test_a_saved_project_opens_again_and_is_recent(programmed, tmp_path, idle, monkeypatch):
    path = tmp_path / "tray.trunnion"
    monkeypatch.setattr(programmed.dialogs, "save_path", lambda: str(path))
    programmed.registry.run("file.save")
    idle(programmed)
    assert not programmed.document.history.is_dirty
    programmed.document.files.open(path)
    idle(programmed)
    assert programmed.document.session.verdict is not None
    assert preferences.recent()[0] == str(path)


def test_programs_are_written_into_a_folder(tray, tmp_path, idle, monkeypatch):
    monkeypatch.setattr(tray.dialogs, "folder", lambda: str(tmp_path / "out"))
    tray.registry.run("file.write")
    idle(tray)
    assert [p.name for p in (tmp_path / "out").iterdir()] == ["tray.S1.nc"]


def test_the_time_of_areas_stands_below_the_balance_of_operations(
    make_window, part_file, idle, qtbot
):
    window = make_window("fake_engine:AreasEngine")
    window.document.files.open(part_file)
    idle(window)
    window.document.run("optimize", "Optimise")
    panel = window.panels["optimize"]
    panel.fold(False)
    areas = window.views["surface"].areas
    assert panel.isAncestorOf(areas)
    qtbot.waitUntil(areas.isVisible, timeout=20000)
    assert [areas.table.item(r, 0).text() for r in range(areas.table.rowCount())] == [
        "op-03",
        "op-05",
        "op-07",
        "remaining area in all",
        "pocket-01 in all",
        "pocket-02 in all",
        "pocket-03 in all",
    ]
    assert areas.table.item(4, 1).text() == areas.table.item(0, 1).text()
    each = [float(areas.table.item(r, 1).text()) for r in range(3)]
    assert float(areas.table.item(3, 1).text()) == sum(each)
    # The floor of 104 x 124 and four walls 24 high.
    assert areas.table.item(0, 1).text() == f"{104 * 124 + 2 * (104 + 124) * 24}"
    assert (
        "0.00 % of the time saved" in areas.gain.text()
        and "from feed and distance of passes" in areas.gain.text()
    )
    QTest.mouseClick(
        areas.table.viewport(),
        LEFT,
        pos=areas.table.visualItemRect(areas.table.item(1, 0)).center(),
    )
    assert window.document.selection.current.id == "op-05"
    # A total is of no operation.
    areas.table.cellClicked.emit(3, 0)
    assert window.document.selection.current.id == "op-05"
    window.document.run("toolpath", "Generate")
    qtbot.waitUntil(lambda: "measured on the toolpaths" in areas.gain.text(), timeout=20000)


def test_a_panel_has_no_areas_to_be_timed(tray):
    tray.panels["optimize"].fold(False)
    assert not tray.views["surface"].areas.isVisible()


def test_a_failed_verdict_names_the_files_that_must_not_run(
    make_window, part_file, tmp_path, idle, monkeypatch
):
    window = make_window("fake_engine:FailingEngine")
    window.document.files.open(part_file)
    idle(window)
    window.document.program()
    idle(window)
    window.panels["generate"].fold(False)
    assert window.panels["generate"].rejected.isVisible()
    assert "tray.S1.REJECTED.nc" in window.panels["generate"].rejected.text()
    monkeypatch.setattr(window.dialogs, "folder", lambda: str(tmp_path / "out"))
    window.registry.run("file.write")
    idle(window)
    assert [p.name for p in (tmp_path / "out").iterdir()] == ["tray.S1.REJECTED.nc"]
    assert "tray.S1.REJECTED.nc" in window.viewport.notice.text


def test_a_passed_verdict_names_no_files(tray):
    tray.panels["generate"].fold(False)
    assert not tray.panels["generate"].rejected.isVisible()


def test_a_message_keeps_the_case_of_a_files_name(make_window, part_file, idle):
    window = make_window("fake_engine:RefusingEngine")
    window.document.files.open(part_file)
    idle(window)
    window.document.program()
    idle(window)
    assert window.viewport.notice.text == "tray.step: parts of this family are not planned yet"


def test_a_program_of_an_earlier_plan_is_marked_as_stale(tray, idle):
    tray.show_dock("code")
    assert not tray.docks.code.stale.isVisible()
    tray.document.selection.select_operation("op-02")
    tray.registry.run("edit.suppress")
    idle(tray)
    assert tray.docks.code.stale.isVisible()
    tray.registry.run("edit.undo")
    idle(tray)
    assert not tray.docks.code.stale.isVisible()


def test_the_palette_runs_what_was_typed(opened, qtbot, idle):
    opened.activateWindow()  # a screen without a window manager activates none by itself
    qtbot.waitUntil(opened.isActiveWindow)  # a window that is not active yet has no shortcuts
    QTest.keyClick(
        opened,
        Qt.Key.Key_P,
        Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier,
    )
    qtbot.waitUntil(opened.finder.isVisible)
    QTest.keyClicks(opened.finder.line, "recog")
    QTest.keyClick(opened.finder.line, Qt.Key.Key_Return)
    idle(opened)
    assert opened.document.session.recognition is not None
    assert not opened.finder.isVisible()


def test_what_starts_a_word_is_found_before_scattered_letters():
    assert score("prog", "Program") > score("prog", "Put rows of gears") > 0
    assert score("zz", "Program") == 0


def test_every_command_has_an_icon_or_words_and_its_own_keys(window):
    keys = [c.keys for c in window.registry.commands() if c.keys]
    assert len(keys) == len(set(keys))
    assert all(c.icon in icons.names() for c in window.registry.commands() if c.icon)


def test_every_icon_is_in_the_icon_font(window):
    for name in icons.names():
        assert not icons.pixmap(name, 16).isNull(), name


def test_every_command_stands_in_a_menu(window):
    listed = {a.objectName() for menu in window.menuBar().actions() for a in menu.menu().actions()}
    assert {c.id for c in window.registry.commands()} <= listed


def test_light_and_dark_change_and_are_remembered(window):
    window.registry.run("view.theme")
    assert (window.theme.name, preferences.theme_name()) == ("dark", "dark")
    window.registry.run("view.theme")
    assert window.theme.name == "light"


def test_what_is_up_to_date_is_not_computed_again(tray, idle):
    before = tray.document.session
    tray.document.program()
    assert not tray.document.is_busy and tray.document.session is before
    assert "up to date" in tray.viewport.notice.text


def test_a_row_dragged_onto_another_moves_in_front_of_it(tray, idle, qtbot):
    tree, target = tray.docks.process.tree, tray.docks.process.item("op-04")
    tray.show_dock("process")
    qtbot.waitUntil(tree.isVisible)
    tree.setCurrentItem(tray.docks.process.item("op-06"))
    at = tree.visualItemRect(target).topLeft() + QPoint(4, 2)
    tree.dropEvent(
        QDropEvent(
            QPointF(at), Qt.DropAction.MoveAction, QMimeData(), LEFT, Qt.KeyboardModifier.NoModifier
        )
    )
    idle(tray)
    order = [o.id for o in tray.document.session.process.operations]
    assert order.index("op-06") == order.index("op-04") - 1


def test_a_copy_of_an_operation_stands_behind_it_and_is_selected(tray, idle):
    document, before = tray.document, tray.document.session
    document.selection.select_operation("op-04")
    tray.registry.run("edit.copy")
    idle(tray)
    order = [o.id for o in document.session.process.operations]
    assert order[order.index("op-04") + 1] == "op-04-copy"
    assert document.selection.current.id == "op-04-copy"
    assert tray.docks.process.item("op-04-copy").isSelected()
    # Of the copy alone, by its own entry of the menu, one more is made of the same.
    menu = tray.docks.process.menu(document.operation("op-04-copy"))
    next(a for a in menu.actions() if a.text() == "Copy op-04-copy").trigger()
    idle(tray)
    assert document.selection.current.id == "op-04-copy-2"
    for _ in range(2):
        tray.registry.run("edit.undo")
    assert document.session is before


def test_an_operation_is_copied_to_another_feature_by_the_menu(tray, idle):
    document, before = tray.document, tray.document.session
    id = next(o.id for o in before.process.operations if o.feature == "pocket-01")
    menu = tray.docks.process.menu(document.operation(id))
    (onto,) = (a.menu() for a in menu.actions() if a.text() == f"Copy {id} to")
    assert [a.text() for a in onto.actions()] == ["pocket-02", "pocket-03"]
    onto.actions()[1].trigger()
    idle(tray)
    copy = document.operation(document.selection.current.id)
    assert (copy.feature, copy.copy_of) == ("pocket-03", id)
    assert tray.docks.process.item(copy.id).text(1) == "pocket-03"
    tray.registry.run("edit.undo")
    assert document.session is before


def test_the_listing_shows_the_selected_operations_motions(tray, qtbot):
    tray.show_dock("listing")
    tray.document.selection.select_operation("op-02")
    qtbot.waitUntil(lambda: tray.docks.listing.toPlainText().startswith("setup S1"))


def test_the_program_text_is_shown(tray, qtbot):
    tray.docks.code.parentWidget().raise_()
    qtbot.waitUntil(lambda: "G0 X10." in tray.docks.code.text.toPlainText())


def test_a_state_of_two_steps_is_the_one_that_asks_for_attention():
    assert joined_state({"toolpath": "done", "verify": "stale"}, ("toolpath", "verify")) == "stale"
    assert joined_state({"toolpath": "done", "verify": "empty"}, ("toolpath", "verify")) == "stale"
    assert joined_state({"toolpath": "done", "verify": "done"}, ("toolpath", "verify")) == "done"


def test_the_panels_stand_for_the_pipelines_steps():
    from trunnion.pipeline import STEPS as pipeline_steps
    from trunnion.pipeline.steps import STEP_TABLE

    assert pipeline_steps == STEPS
    assert {s.name: s.title for s in STEP_TABLE} == TITLES
    assert tuple(s for stage in STAGES for s in stage.steps) == STEPS


def test_calls_that_return_nothing_keep_the_count_of_none():
    thing = QObject()
    before = sys.getrefcount(None)
    for n in range(500):
        thing.setObjectName(str(n))
    assert sys.getrefcount(None) > before - 100


def test_the_frame_of_the_window_does_not_import_cad():
    import subprocess

    code = (
        "import os, sys; os.environ['QT_QPA_PLATFORM'] = 'offscreen'; import trunnion_gui.window; "
        "bad = {'OCP', 'cadquery', 'numba', 'trunnion.pipeline'} & set(sys.modules); sys.exit(' '.join(bad) or 0)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, cwd=Path(__file__).parent
    )
    assert done.returncode == 0, done.stderr


def test_a_header_opens_and_folds_its_panel(window):
    panel = window.panels["blank"]
    QTest.mouseClick(panel.header, LEFT, pos=QPoint(40, 12))
    assert panel.body.isVisible()
    QTest.mouseClick(panel.header, LEFT, pos=QPoint(40, 12))
    assert not panel.body.isVisible()


@pytest.mark.parametrize("name", ["light", "dark"])
def test_words_of_a_program_can_be_read_in_both_themes(window, name):
    from trunnion_gui.look.colours import READABLE, contrast, theme

    window.use_theme(theme(name))
    looks = window.docks.code.text._looks
    assert {
        k: round(contrast(looks[k].foreground().color().name(), theme(name).panel), 1)
        for k in ("rapid", "cut")
        if contrast(looks[k].foreground().color().name(), theme(name).panel) < READABLE
    } == {}


def test_a_message_has_the_room_that_the_columns_beside_it_do_not_need(window, qtbot):
    window.resize(1280, 800)
    window.show_dock("messages")
    window.document.notice(
        "a message that is long enough to be cut off where every other column takes its full width "
        * 2
    )
    table = window.docks.messages.table
    qtbot.waitUntil(lambda: table.columnWidth(1) > 0.5 * table.viewport().width())


def test_the_fix_of_a_finding_is_applied_beside_it_and_undone(tray, idle, qtbot):
    document = tray.document
    operation = document.session.process.operations[0].id
    fix = Fix(kind="drop", operation=operation, reason="verify.gouge")
    gouge = replace(error("verify.gouge", "a gouge", operation), fix=fix)
    before = document.session
    document.noticed.emit(gouge)
    tray.show_dock("messages")
    table = tray.docks.messages.table
    row = tray.docks.messages.findings.index(gouge)
    others = [r for r in range(table.rowCount()) if r != row]
    assert all(table.cellWidget(r, 5) is None for r in others)
    QTest.mouseClick(table.cellWidget(row, 5), LEFT)
    idle(tray)
    assert document.session.process.operation(operation).suppressed
    assert document.states["verify"] == "stale"
    document.undo()
    assert document.session is before


@pytest.mark.parametrize(
    ("id", "kind", "words"),
    [
        ("profile-finish-face-2", "profile_finish", "Profile finish face-2"),
        ("semi-local-01", "semi", "Semi local-01"),
        ("floor-pocket-03", "floor", "Floor"),
    ],
)
def test_an_operations_label_says_nothing_twice(id, kind, words):
    from fake_engine import cutter, cutting

    from trunnion.model.operation import Operation
    from trunnion_gui.docks.process import label

    made = Operation(
        id=id,
        kind=kind,
        strategy="fake",
        feature="pocket-03",
        setup="S1",
        tool=cutter(1, 10.0),
        data=cutting(300, 10),
    )
    assert label(made) == words


def test_operations_that_differ_at_their_ends_are_told_apart_in_the_panel(tray):
    table = tray.panels["optimize"].table
    metrics = table.fontMetrics()
    room = metrics.horizontalAdvance("finish-local") - 1
    shown = {
        metrics.elidedText(id, table.textElideMode(), room)
        for id in ("finish-local-01", "finish-local-02", "finish-local-01-steep")
    }
    assert len(shown) == 3
    assert "mm/min" in table.horizontalHeaderItem(2).toolTip()


def test_the_process_tree_shows_times_beside_their_bounds_once_they_are_proven(programmed):
    tree, verdict = programmed.docks.process.tree, programmed.document.shown.verdict
    titles = {tree.headerItem().text(n): n for n in range(tree.columnCount())}
    assert tree.isColumnHidden(titles["⌀ mm"]) and not tree.isColumnHidden(titles["Time"])
    proof = verdict.operations[0]
    item = programmed.docks.process.item(proof.operation)
    assert item.text(titles["Time"]) == "1:35"
    assert item.text(titles["×"]) == f"{proof.over_bound:.1f}"
    panel = programmed.panels["generate"]
    assert not panel.minutes.isHidden()
    assert panel.minutes.bar.shares == verdict.time_shares()
