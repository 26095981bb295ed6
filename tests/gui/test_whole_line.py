"""The sample part from file to verdict with the real engine: real window, real clicks, one run that every test here looks at."""

from __future__ import annotations

import time
from importlib.resources import as_file

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

import trunnion_resources
from person import Person, wait_for_job
from trunnion_gui.look.colours import kind_colour, rgb

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture(scope="module")
def programmed(tmp_path_factory, qapp):
    """The window after a person has opened the sample part and pressed Program, and that person."""
    from trunnion_gui.gc_control import GcControl
    from trunnion_gui.window import Window

    with pytest.MonkeyPatch.context() as patch, as_file(trunnion_resources.sample("B1")) as part:
        patch.setenv("TRUNNION_SETTINGS", str(tmp_path_factory.mktemp("settings")))
        # As the program does it, so that the time of collections is measured as the program has it.
        gc_control = GcControl()
        window = Window()
        gc_control.keep()
        window.unsaved.confirms = False
        window.resize(1440, 900)
        window.show()
        person = Person(window)
        patch.setattr(window.dialogs, "open_path", person.chooses(part))
        person.clicks(window.toolbar.widgetForAction(window.registry.action("file.open")))
        wait_for_job(window, 120.0)
        person.clicks(window.toolbar.widgetForAction(window.registry.action("run.program")))
        wait_for_job(window, 280.0)
        person.rests()
        gc_control.stop()
        yield person
        window.close()
        window.deleteLater()


def test_the_part_is_programmed_in_at_most_five_interactions(programmed):
    assert programmed.interactions <= 5
    assert programmed.window.status.verdict.text().startswith("verdict: passed")


def frame_s(window) -> float:
    """Return what drawing one frame of the part with its paths takes this machine, s: of the window's own thread, the middle of nine."""
    taken = []
    for _ in range(9):
        began = time.thread_time()
        window.viewport.scene.view.render_window.Render()
        taken.append(time.thread_time() - began)
    return sorted(taken)[4]


def test_the_window_never_works_long_at_a_stretch(programmed):
    # Time of the window's own thread: what other processes take of a shared machine is not counted. The longest draws the first frame of
    # the part; others draw a frame, which takes a machine without a graphics card some tens of milliseconds.
    # Machines are shared, and their speed varies by more than a half: where frames are slow, so many frames' time is the bound.
    frame = frame_s(programmed.window)
    assert max(programmed.stretches) < max(0.2, 5.0 * frame)
    assert sorted(programmed.stretches)[-5] < max(0.1, 3.0 * frame)


def test_the_program_is_played_to_its_end(programmed, qtbot):
    window = programmed.window
    programmed.clicks(window.toolbar.widgetForAction(window.registry.action("play.show")))
    qtbot.waitUntil(lambda: window.player.timeline is not None, timeout=60000)
    line, removed = window.player.timeline, []
    window.player.cut.connect(lambda moment: removed.append(moment.removed))
    for share in (0.25, 0.5, 1.0):
        position = float(round(share * len(line)))
        QTest.mouseClick(
            window.playback.track, LEFT, pos=QPoint(round(window.playback.track.x_of(position)), 10)
        )
        qtbot.waitUntil(lambda: window.player.is_settled, timeout=60000)
    assert removed == sorted(removed)
    session = window.document.session
    outside = session.blank.volume - session.part.volume
    assert 0.6 * outside < removed[-1] < outside


def test_the_marked_line_is_the_tools_block(programmed, qtbot):
    window, line = programmed.window, programmed.window.player.timeline
    block = int(np.flatnonzero(~line.rapid & (line.sweep == 0.0))[500])
    window.player.go(float(block + 1))
    qtbot.waitUntil(lambda: window.docks.code.text.marked == line.line[block], timeout=5000)
    text = window.docks.code.text.document().findBlockByNumber(int(line.line[block]) - 1).text()
    tip = window.document.session.setups[0].frame.to_local(line.tip[block])
    words = {w[0]: float(w[1:]) for w in text.split() if w[0] in "XYZ"}
    assert words and all(
        tip["XYZ".index(axis)] == pytest.approx(value, abs=1e-3) for axis, value in words.items()
    )
    assert window.docks.process.item(line.passage(float(block + 1)).operation).font(0).bold()


def test_all_of_the_sample_is_finished_on_the_map(programmed, qtbot):
    window = programmed.window
    programmed.clicks(window.toolbar.widgetForAction(window.registry.action("view.deviation")))
    qtbot.waitUntil(lambda: window.deviation.shown is not None, timeout=60000)
    shown = window.deviation.shown.map
    assert np.mean((shown.value >= shown.low) & (shown.value <= shown.high)) > 0.99
    assert not window.player.is_on
    window.registry.run("view.deviation")


def test_the_verdict_is_what_the_demo_promises(programmed):
    verdict = programmed.window.document.session.verdict
    assert verdict.releases
    assert verdict.gouge <= 0.02
    assert verdict.coverage >= 0.99
    assert verdict.collisions == verdict.rapids_in_stock == 0


def test_every_panel_says_done(programmed):
    assert {name: panel.state for name, panel in programmed.window.panels.items()} == dict.fromkeys(
        programmed.window.panels, "done"
    )


def test_a_click_on_a_floor_selects_its_pocket_and_the_row_its_faces(programmed, qtbot):
    window = programmed.window
    window.registry.run("view.top")
    qtbot.wait(20)
    pocket = window.document.session.recognition.of_kind("pocket")[3]
    floor = pocket.with_role("floor")[0]
    mesh = window.document.mesh
    rows = np.flatnonzero(mesh.face == floor)
    point = mesh.corners()[rows[np.argmax(mesh.areas()[rows])]].mean(axis=0)
    programmed.clicks(window.viewport.scene.view, window.viewport.scene.where(point).toPoint())
    assert window.document.selection.current.id == pocket.id
    assert window.docks.features.tree.currentItem().text(0) == pocket.id
    assert set(window.viewport.scene._selected) == set(pocket.tags)


def test_a_pockets_floor_has_the_pockets_colour(programmed, qtbot):
    window = programmed.window
    window.document.selection.select_face(0)
    window.registry.action("view.paths").setChecked(False)
    window.viewport.show_layer("paths", False)
    window.registry.run("view.top")
    qtbot.wait(20)
    mesh = window.document.mesh
    floor = window.document.session.recognition.of_kind("pocket")[0].with_role("floor")[0]
    rows = np.flatnonzero(mesh.face == floor)
    point = mesh.corners()[rows[np.argmax(mesh.areas()[rows])]].mean(axis=0)
    image = window.viewport.scene.view.grab().toImage()
    seen = np.array(
        image.pixelColor(window.viewport.scene.where(point).toPoint()).toTuple()[:3], dtype=float
    )
    wanted = np.array(rgb(kind_colour("pocket")), dtype=float)
    seen, wanted = seen - seen.mean(), wanted - wanted.mean()
    assert seen @ wanted / np.linalg.norm(seen) / np.linalg.norm(wanted) > 0.97


def test_the_program_and_its_listing_are_there_to_read(programmed, qtbot):
    window = programmed.window
    window.show_dock("code")
    qtbot.waitUntil(lambda: len(window.docks.code.text.toPlainText()) > 1000)
    assert "REJECTED" not in window.docks.code.text.toPlainText()
    operation = window.document.session.process.operations[0].id
    window.document.selection.select_operation(operation)
    window.show_dock("listing")
    qtbot.waitUntil(lambda: operation in window.docks.listing.toPlainText())


def test_a_suppressed_operation_makes_only_what_follows_stale(programmed, qtbot):
    window = programmed.window
    last = window.document.session.process.operations[-1].id
    window.document.selection.select_operation(last)
    window.registry.run("edit.suppress")
    qtbot.waitUntil(lambda: window.panels["generate"].state == "stale", timeout=30000)
    assert window.panels["recognize"].state == "done"
    window.registry.run("edit.undo")
    qtbot.waitUntil(lambda: window.panels["generate"].state == "done", timeout=30000)


def test_the_saved_project_opens_as_it_was(programmed, tmp_path, qtbot):
    window = programmed.window
    before = window.document.session
    window.document.files.save(tmp_path / "B1.trunnion")
    qtbot.waitUntil(lambda: not window.document.is_busy, timeout=60000)
    window.document.files.open(tmp_path / "B1.trunnion")
    qtbot.waitUntil(lambda: not window.document.is_busy, timeout=120000)
    assert window.viewport.notice.isHidden(), window.viewport.notice.text
    after = window.document.session
    assert after.recognition.counts() == before.recognition.counts()
    assert after.verdict.outcome == before.verdict.outcome
    assert window.document.states["verify"] == "done"
