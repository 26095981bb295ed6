"""The deviation map in the window: a planted gouge has the gouges' colour, what is left another, and both can be found."""

from __future__ import annotations

import numpy as np
import pytest
from fake_engine import FLOOR, GOUGE, LEFT
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from shared_window import shared_window, wait
from test_viewport import hue, pixel

from trunnion.report.palette import load_palette

BUTTON = Qt.MouseButton.LeftButton
SOUND = (60.0, 70.0, FLOOR)


@pytest.fixture(scope="module")
def proven(qapp, tmp_path_factory):
    """One window with the made-up part programmed, for all tests here that look at its map."""
    folder = tmp_path_factory.mktemp("proven")
    (folder / "tray.step").write_text("a made-up part")
    with shared_window(folder, "fake_engine:FakeEngine") as window:
        window.document.files.open(folder / "tray.step")
        wait(window)
        window.document.program()
        wait(window)
        yield window


@pytest.fixture
def mapped(proven, qtbot):
    """That window with the part's deviation from the top, switched on by a click."""
    window = proven
    if window.deviation.is_on:
        window.registry.run("view.deviation")
    window.registry.run("view.top")
    QTest.mouseClick(
        window.toolbar.widgetForAction(window.registry.action("view.deviation")), BUTTON
    )
    qtbot.waitUntil(
        lambda: window.deviation.shown is not None and window.viewport.scale.isVisible(),
        timeout=20000,
    )
    return window


def test_a_planted_gouge_has_the_gouges_colour(mapped):
    assert hue(pixel(mapped, (*GOUGE, FLOOR))) @ hue(load_palette().deviation.gouge[-1]) > 0.9


def test_what_is_left_has_the_other_colour(mapped):
    assert hue(pixel(mapped, (*LEFT, FLOOR))) @ hue(load_palette().deviation.residual[-1]) > 0.9


def test_what_is_finished_is_grey(mapped):
    assert np.ptp(pixel(mapped, SOUND)) < 25


def test_the_scale_stands_in_the_legends_place(mapped):
    assert mapped.viewport.scale.isVisible() and not mapped.viewport.legend.isVisible()
    shown = mapped.deviation.shown.map
    bar = mapped.viewport.scale.bar
    picture = bar.grab().toImage()
    x = 8
    ratio = picture.height() / bar.height()

    def colour(value):
        return np.array(
            picture.pixelColor(round(x * ratio), round(bar.y_of(value) * ratio)).toTuple()[:3],
            dtype=float,
        )

    assert hue(colour(-0.9 * shown.limit)) @ hue(load_palette().deviation.gouge[-1]) > 0.9
    assert hue(colour(0.9 * shown.limit)) @ hue(load_palette().deviation.residual[-1]) > 0.9
    assert np.ptp(colour(0.0)) < 25


def test_the_value_under_the_mouse_is_said(mapped, qtbot):
    view, scene = mapped.viewport.scene.view, mapped.viewport.scene
    QTest.mouseMove(view, scene.where((*GOUGE, FLOOR)).toPoint())
    qtbot.waitUntil(lambda: mapped.viewport.tip.isVisible())
    assert mapped.viewport.tip.text() == "-50 µm"
    assert mapped.status.text.text().startswith("-50 µm · face 6 · pocket-02")
    QTest.mouseMove(view, scene.where(SOUND).toPoint())
    qtbot.waitUntil(lambda: mapped.viewport.tip.text() == "0 µm")
    QTest.mouseMove(view, QPoint(view.width() - 3, 3))
    qtbot.waitUntil(lambda: not mapped.viewport.tip.isVisible())
    assert mapped.status.text.text() == ""


def test_the_worst_places_are_listed_and_a_click_goes_there(mapped):
    table = mapped.docks.deviation.table
    assert [table.item(r, 1).text() for r in range(table.rowCount())] == ["-50 µm", "+200 µm"]
    assert [table.item(r, 3).text() for r in range(table.rowCount())] == ["pocket-02", "pocket-03"]
    QTest.mouseClick(table.viewport(), BUTTON, pos=table.visualItemRect(table.item(0, 1)).center())
    scene = mapped.viewport.scene
    at = scene.where(mapped.docks.deviation.worst_points[0].point)
    assert abs(at.x() - scene.width() / 2) < 3 and abs(at.y() - scene.height() / 2) < 3
    assert scene.view.camera.parallel_scale < 50.0
    # Beside the number that is written at the place.
    x, y, z = mapped.docks.deviation.worst_points[0].point
    inside = np.array([GOUGE[0] - x, GOUGE[1] - y, 0.0]) * 0.8 + (x, y, z)
    assert hue(pixel(mapped, inside)) @ hue(load_palette().deviation.gouge[-1]) > 0.9


def test_an_empty_list_says_why(make_window, part_file, idle, qtbot):
    window = make_window("fake_engine:SoundEngine")
    window.document.files.open(part_file)
    idle(window)
    window.document.program()
    idle(window)
    window.show_dock("deviation")
    qtbot.waitUntil(lambda: window.docks.deviation.empty.isVisible())
    assert "while the deviation map is shown" in window.docks.deviation.empty.text()
    window.registry.run("view.deviation")
    qtbot.waitUntil(lambda: window.deviation.shown is not None, timeout=20000)
    assert window.docks.deviation.empty.isVisible() and not window.docks.deviation.table.isVisible()
    assert "lies between -20 µm and +20 µm" in window.docks.deviation.empty.text()


def test_the_map_goes_as_it_came(mapped):
    mapped.registry.run("view.deviation")
    assert "deviation" not in mapped.viewport.scene.view.actors
    assert mapped.viewport.scene.view.actors["part"].visibility
    assert mapped.viewport.legend.isVisible() and not mapped.viewport.scale.isVisible()


def test_map_and_playback_take_turns(mapped, qtbot):
    mapped.registry.run("play.show")
    assert not mapped.deviation.is_on and not mapped.registry.action("view.deviation").isChecked()
    mapped.registry.run("view.deviation")
    assert mapped.deviation.is_on and not mapped.player.is_on and not mapped.playback.isVisible()


def test_there_is_no_map_before_a_proof(window, part_file, idle):
    window.document.files.open(part_file)
    idle(window)
    assert not window.registry.action("view.deviation").isEnabled()


@pytest.mark.parametrize("size", [(1280, 800), (1024, 700)])
def test_the_part_does_not_lie_under_the_legend(make_window, part_file, idle, size):
    window = make_window()
    window.resize(*size)
    window.document.files.open(part_file)
    idle(window)
    window.document.run("toolpath", "Generate")
    idle(window)
    assert window.viewport.legend.isVisible()
    card = window.viewport.legend.geometry()
    corners = window.document.mesh.points
    assert not any(card.contains(window.viewport.scene.where(p).toPoint()) for p in corners)
    assert all(
        window.viewport.scene.rect().contains(window.viewport.scene.where(p).toPoint())
        for p in corners
    )


def test_a_picture_that_was_turned_is_not_fitted_again(mapped):
    scene = mapped.viewport.scene
    scene.view.camera.azimuth = 20.0
    before = scene.view.camera.position
    mapped.registry.run("view.deviation")
    assert scene.view.camera.position == before
