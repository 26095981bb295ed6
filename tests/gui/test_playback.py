"""The playback with real clicks: the stock gets smaller along the slider, the tool stands where it cuts, everything keeps in step."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fake_engine import FLOOR, HEADER, POCKETS
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QTextCursor
from PySide6.QtTest import QTest
from shared_window import shared_window, until
from test_viewport import hue, pixel

from leaning_tools import EVERY_FORM
from trunnion.verify.cutter import outline_of
from trunnion_gui.look.colours import rgb, tool_colours
from trunnion_gui.viewport.layers.tool import cutter_outline

LEFT = Qt.MouseButton.LeftButton
MIDDLES = {
    f"pocket-{n:02d}": ((b[0] + b[2]) / 2, (b[1] + b[3]) / 2) for n, b in enumerate(POCKETS, 1)
}


@pytest.fixture(scope="module")
def programmed(qapp, tmp_path_factory):
    """One window for all tests here, with the made-up part programmed."""
    part = tmp_path_factory.mktemp("parts") / "tray.step"
    part.write_text("a made-up part")
    with shared_window(tmp_path_factory.mktemp("settings"), "fake_engine:FakeEngine") as window:
        window.document.files.open(part)
        window.document.program()
        until(lambda: not window.document.is_busy and window.document.session.verdict is not None)
        yield window


@pytest.fixture
def played(programmed, qtbot):
    """That window playing the program, standing at its beginning, seen from the top."""
    window = programmed
    window.registry.run("view.top")
    QTest.mouseClick(window.toolbar.widgetForAction(window.registry.action("play.show")), LEFT)
    qtbot.waitUntil(lambda: window.player.timeline is not None, timeout=60000)
    window.player.set_by_block(False)
    window.player.set_speed(10)
    window.player.go(0.0)
    settled(window, qtbot)
    yield window
    if window.player.is_on:
        window.registry.run("play.show")


def settled(window, qtbot) -> None:
    """Wait until the stock is where the tool is, and words and program follow."""
    followers = (window.playback._soon, window.following.soon)
    qtbot.waitUntil(
        lambda: window.player.is_settled and not any(timer.isActive() for timer in followers),
        timeout=60000,
    )


def go(window, qtbot, position) -> None:
    """Click the slider at a position."""
    track = window.playback.track
    QTest.mouseClick(track, LEFT, pos=QPoint(round(track.x_of(position)), 10))
    settled(window, qtbot)


def surface_at(window, x, y) -> float:
    """Return how high the shown stock is at a place of the plan."""
    mesh = window.viewport.scene.view.actors["stock"].mapper.GetInput()
    points, _ = mesh.ray_trace((x, y, 100.0), (x, y, -100.0), first_point=True)
    return float(points[2])


def test_the_stock_takes_the_parts_place(played):
    assert played.playback.isVisible()
    actors = played.viewport.scene.view.actors
    assert actors["stock"].visibility and not actors["part"].visibility and "rapids" not in actors
    played.registry.run("play.show")
    actors = played.viewport.scene.view.actors
    assert "stock" not in actors and "cutter" not in actors and actors["part"].visibility
    assert not played.playback.isVisible()


def test_the_stock_gets_smaller_along_the_slider(played, qtbot):
    removed = []
    played.player.cut.connect(lambda moment: removed.append(moment.removed))
    for share in (0.1, 0.4, 0.7, 1.0):
        go(played, qtbot, share * played.player.end)
    assert sorted(removed) == removed and len(set(removed)) >= 4


def test_a_pocket_is_there_only_after_it_was_cut(played, qtbot):
    x, y = MIDDLES["pocket-03"]
    go(played, qtbot, 1.0)
    assert surface_at(played, x, y) > FLOOR + 10.0
    go(played, qtbot, played.player.end)
    assert surface_at(played, x, y) == pytest.approx(FLOOR, abs=1e-3)
    go(played, qtbot, 1.0)
    assert surface_at(played, x, y) > FLOOR + 10.0


def test_the_cut_surface_looks_other_than_the_blank(played, qtbot):
    # Behind the last pocket nothing is cut but the top: a place beside it keeps the blank's colour until the face mill was there.
    played.registry.run("view.isometric")
    before = pixel(played, (-5.0, 70.0, 12.0))
    go(played, qtbot, played.player.end)
    cut = pixel(played, (*MIDDLES["pocket-01"], FLOOR))
    assert np.abs(cut - before).max() > 25


def test_the_tool_stands_where_it_cuts(played, qtbot):
    played.registry.run("view.front")
    go(played, qtbot, 40.0)
    line = played.player.timeline
    tip, axis = line.pose(played.player.position)
    bounds = np.array(played.viewport.scene.view.actors["cutter"].bounds)
    tool = line.passage(40.0).tool
    assert bounds[4] == pytest.approx(tip[2], abs=1e-3)
    assert bounds[5] == pytest.approx(tip[2] + tool.flute_length, abs=1e-3)
    assert (bounds[0] + bounds[1]) / 2 == pytest.approx(tip[0], abs=1e-3)
    seen = pixel(played, tip + axis * (tool.flute_length - 2.0))
    assert hue(seen) @ hue(rgb(tool_colours()["cutter"])) > 0.9


def test_while_a_job_runs_nothing_plays_and_the_stock_follows_afterwards(played, qtbot, tmp_path):
    go(played, qtbot, 20.0)
    played.document.files.save(tmp_path / "tray.trunnion")
    assert played.document.is_busy
    assert not played.playback.buttons["play.run"].isEnabled()
    played.player.play()
    assert not played.player.is_playing
    QTest.mouseClick(
        played.playback.track, LEFT, pos=QPoint(round(played.playback.track.x_of(60.0)), 10)
    )
    qtbot.waitUntil(lambda: not played.document.is_busy, timeout=30000)
    settled(played, qtbot)
    assert played.player.position == pytest.approx(60.0, abs=1.0)
    assert played.playback.buttons["play.run"].isEnabled()


def test_words_that_do_not_fit_end_in_dots(played, qtbot):
    go(played, qtbot, 20.0)
    full = played.playback.position_label.text()
    assert not full.endswith("…")
    played.playback.position_label.setFixedWidth(120)
    qtbot.waitUntil(lambda: played.playback.position_label.width() == 120)
    go(played, qtbot, 22.0)
    assert played.playback.position_label.text().endswith("…")
    played.playback.position_label.setMinimumWidth(0)
    played.playback.position_label.setMaximumWidth(16777215)


def test_each_operation_has_its_tool(played, qtbot):
    widths = []
    for row in (0, 1):
        go(played, qtbot, float(played.player.timeline.first[row]) + 4)
        bounds = played.viewport.scene.view.actors["cutter"].bounds
        widths.append(bounds[1] - bounds[0])
    assert widths == pytest.approx([63.0, 20.0], rel=0.01)


def test_the_buttons_go_a_block_or_an_operation_on_and_back(played, qtbot):
    buttons, first = played.playback.buttons, played.player.timeline.first

    def position_after(id):
        QTest.mouseClick(buttons[id], LEFT)
        return played.player.position

    assert position_after("play.forward") == 1.0
    assert position_after("play.forward") == 2.0
    assert position_after("play.back") == 1.0
    assert position_after("play.next") == first[1]
    assert position_after("play.next") == first[2]
    assert position_after("play.previous") == first[1]
    assert position_after("play.end") == first[-1]
    assert position_after("play.begin") == 0.0


def test_play_runs_the_tool_and_pause_stops_it(played, qtbot):
    QTest.mouseClick(played.playback.buttons["play.run"], LEFT)
    qtbot.waitUntil(lambda: played.player.position > 2.0, timeout=20000)
    QTest.mouseClick(played.playback.buttons["play.run"], LEFT)
    assert not played.player.is_playing
    at = played.player.position
    settled(played, qtbot)
    assert played.player.position == at


def test_the_tool_never_runs_ahead_of_the_stock_that_was_asked_for(played, qtbot):
    ahead = []
    played.player.set_speed(1000)
    played.player.moved.connect(
        lambda p: ahead.append(p - max(played.player._requested_for, played.player._stock_at))
    )
    played.player.play()
    qtbot.waitUntil(lambda: not played.player.is_playing, timeout=60000)
    assert max(ahead) <= 1e-9
    settled(played, qtbot)
    assert played.player.position == played.player.end


def test_block_by_block_every_block_takes_the_same_time(played):
    player = played.player
    player.set_by_block(True)
    player.set_speed(5)
    assert player._after(3.0, 0.4) == pytest.approx(5.0)
    player.set_by_block(False)
    line = player.timeline
    assert line.seconds_at(player._after(3.0, 0.4)) == pytest.approx(line.seconds_at(3.0) + 2.0)


def test_speed_and_mode_are_chosen_in_the_bar(played):
    QTest.keyClick(played.playback.speed, Qt.Key.Key_End)
    played.playback.speed.activated.emit(played.playback.speed.count() - 1)
    assert played.player.speed == 1000
    played.playback.mode.activated.emit(1)
    assert played.player.by_block
    played.registry.run("play.slower")
    assert played.player.speed == 500 and played.playback.speed.currentText() == "×500"


def test_the_arrow_keys_step_on_the_slider(played):
    QTest.keyClick(played.playback.track, Qt.Key.Key_Right)
    QTest.keyClick(played.playback.track, Qt.Key.Key_Right)
    QTest.keyClick(played.playback.track, Qt.Key.Key_Left)
    assert played.player.position == 1.0


def test_the_slider_knows_the_operations(played):
    track, line = played.playback.track, played.player.timeline
    middle = (line.first[1] + line.first[2]) / 2
    assert line.passages[1].operation in track.words_at(track.x_of(middle))


def test_load_and_blocks_at_fault_stand_below_the_operations(played, qtbot):
    track, n = played.playback.track, int(played.player.end)
    load, bad = np.full(n, 50.0), np.zeros(n, bool)
    load[: n // 2], bad[3 * n // 4] = 100.0, True
    low = track.height()
    track.show_load(load, bad)
    qtbot.waitUntil(lambda: track.height() > low)
    picture = track.grab().toImage()
    ratio = picture.height() / track.height()

    def colour(value, below):
        at = (track.x_of(value) + 1) * ratio, (track.height() - below) * ratio
        return np.array(picture.pixelColor(round(at[0]), round(at[1])).toTuple()[:3], dtype=float)

    assert hue(colour(3 * n // 4, 6)) @ hue(rgb(played.theme.bad)) > 0.9
    high, half = (colour(share * n, 16) for share in (0.3, 0.6))
    assert hue(high) @ hue(rgb(played.theme.accent)) > 0.9
    assert np.ptp(half) < np.ptp(high)
    track.show_load(np.zeros(0), np.zeros(0, bool))
    assert track.height() == low


def test_the_words_say_block_line_and_operation(played, qtbot):
    go(played, qtbot, 60.0)
    passage = played.player.timeline.passage(60.0)
    assert (
        played.playback.position_label.text()
        == f"block 60 of {int(played.player.end)} · line {60 + len(HEADER)} · {passage.operation}"
    )


def test_the_line_of_the_block_is_marked_in_the_program(played, qtbot):
    go(played, qtbot, 60.0)
    assert played.docks.code.isVisible()
    qtbot.waitUntil(lambda: played.docks.code.text.marked == 60 + len(HEADER))
    tip = played.player.timeline.pose(60.0)[0]
    block = played.docks.code.text.document().findBlockByNumber(60 + len(HEADER) - 1)
    assert f"X{tip[0]:.3f} Y{tip[1]:.3f}" in block.text()


def test_a_click_on_a_line_goes_to_its_block(played, qtbot):
    text = played.docks.code.text
    go(played, qtbot, 60.0)
    text.mark(30)
    row = text.cursorRect(QTextCursor(text.document().findBlockByNumber(29)))
    QTest.mouseClick(text.viewport(), LEFT, pos=row.center() + QPoint(20, 0))
    assert played.player.position == 30 - len(HEADER)


def test_the_played_operation_is_stressed_in_the_process_tree(played, qtbot):
    def stressed():
        return [id for id, item in played.docks.process._items.items() if item.font(0).bold()]

    go(played, qtbot, 4.0)
    qtbot.waitUntil(lambda: stressed() == ["op-01"])
    go(played, qtbot, played.player.end)
    qtbot.waitUntil(lambda: stressed() == [played.player.timeline.passages[-1].operation])
    played.registry.run("play.show")
    qtbot.waitUntil(lambda: stressed() == [])


def test_an_edit_takes_the_new_plan_and_undo_the_old_one(played, qtbot, idle):
    blocks = played.player.end
    played.document.selection.select_operation("op-07")
    played.registry.run("edit.delete")
    idle(played)
    played.document.run("verify", "Verify")
    idle(played)
    qtbot.waitUntil(
        lambda: played.player.timeline is not None and played.player.end < blocks, timeout=20000
    )
    played.registry.run("edit.undo")
    played.registry.run("edit.undo")
    qtbot.waitUntil(
        lambda: played.player.timeline is not None and played.player.end == blocks, timeout=20000
    )
    played.document.selection.select_face(0)


def test_a_killed_worker_plays_on_when_it_is_back(played, qtbot):
    played.document.jobs.worker._process.kill()
    qtbot.waitUntil(lambda: played.player.timeline is None, timeout=10000)
    qtbot.waitUntil(lambda: played.player.timeline is not None, timeout=60000)
    go(played, qtbot, 20.0)


def test_nothing_is_played_before_there_are_toolpaths(window, part_file, idle):
    window.document.files.open(part_file)
    idle(window)
    assert not window.registry.action("play.show").isEnabled()
    assert not window.registry.action("play.run").isEnabled()


def test_dark_shows_the_playback_too(played, qtbot):
    go(played, qtbot, 60.0)
    played.registry.run("view.theme")
    actors = played.viewport.scene.view.actors
    played.registry.run("view.theme")
    assert actors["stock"].visibility and not actors["part"].visibility


@pytest.mark.parametrize("form", EVERY_FORM)
def test_the_drawn_cutter_has_the_proofs_outline(form):
    tool = EVERY_FORM[form]
    rows = cutter_outline(tool)
    assert rows[0] == pytest.approx((0.0, 0.0)) and rows[-1][1] == pytest.approx(tool.flute_length)
    spans = outline_of(tool)
    for point in (p for p in rows if p[0] > 0.1):
        assert min(distance(span, point) for span in spans) < 1e-6


def distance(span, point) -> float:
    """Return how far a point (radius, height) is from a line or an arc of the proof's outline."""
    r0, z0, r1, z1, cr, cz, radius = span
    if radius:
        return abs(math.dist(point, (cr, cz)) - abs(radius))
    return abs((r1 - r0) * (point[1] - z0) - (z1 - z0) * (point[0] - r0)) / math.dist(
        (r0, z0), (r1, z1)
    )
