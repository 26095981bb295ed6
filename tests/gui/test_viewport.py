"""The picture: is the pocket's colour where the pocket is, and do clicks pick both ways."""

from __future__ import annotations

import os
import time
from dataclasses import replace

import numpy as np
import pytest
from fake_engine import FLOOR, HEIGHT, LENGTH, WIDTH, box_mesh
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from shared_window import shared_window, taken_back, wait

from trunnion.geometry.frame import WORLD
from trunnion.model.blank import Revolved
from trunnion.report import palette as palettes
from trunnion.report.colour_choice import distinct_colours
from trunnion.report.lines import opened as opened_chords
from trunnion_gui.look.colours import kind_colour, motions, rgb
from trunnion_gui.viewport.layers import paths
from trunnion_gui.worker.drawing import border_edges, hull_of

LEFT = Qt.MouseButton.LeftButton
IN_POCKET = {
    "pocket-01": (60.0, 70.0, FLOOR),
    "pocket-02": (175.0, 37.0, FLOOR),
    "pocket-03": (175.0, 103.0, FLOOR),
}
ON_RIB = (115.0, 70.0, HEIGHT)


@pytest.fixture
def recognized(window, part_file, idle, qtbot):
    """A window that shows the made-up part's features from the top."""
    window.document.files.open(part_file)
    idle(window)
    window.document.run("recognize", "Recognize")
    idle(window)
    window.registry.run("view.top")
    qtbot.wait(20)
    return window


@pytest.fixture(scope="module")
def shown_once(qapp, tmp_path_factory):
    """One window for all tests that only look and select, with the made-up part's features."""
    part = tmp_path_factory.mktemp("parts") / "tray.step"
    part.write_text("a made-up part")
    with shared_window(tmp_path_factory.mktemp("settings"), "fake_engine:FakeEngine") as window:
        window.document.files.open(part)
        wait(window)
        window.document.run("recognize", "Recognize")
        wait(window)
        yield window


@pytest.fixture
def shown(shown_once, qtbot):
    """That window from the top, with nothing selected."""
    with taken_back(shown_once) as window:
        window.registry.run("view.top")
        qtbot.wait(20)
        yield window


def pixel(window, point) -> np.ndarray:
    """Return the colour (3,) 0 to 255 that the viewport shows at a point of the part."""
    view = window.viewport.scene.view
    image = view.grab().toImage()
    at = window.viewport.scene.where(point).toPoint()
    colour = image.pixelColor(at)
    return np.array([colour.red(), colour.green(), colour.blue()], dtype=float)


def hue(colour) -> np.ndarray:
    """Return a colour's direction away from grey, which light and shade leave alone."""
    away = np.asarray(colour, dtype=float) - np.mean(colour)
    return away / np.linalg.norm(away)


@pytest.mark.parametrize("id", IN_POCKET)
def test_a_pocket_has_the_pockets_colour(shown, id):
    assert hue(pixel(shown, IN_POCKET[id])) @ hue(rgb(kind_colour("pocket"))) > 0.97


def test_a_rib_has_the_ribs_colour(shown):
    assert hue(pixel(shown, ON_RIB)) @ hue(rgb(kind_colour("rib"))) > 0.97


def test_without_colours_everything_looks_like_metal(recognized):
    recognized.registry.run("view.colours")
    assert np.ptp(pixel(recognized, IN_POCKET["pocket-01"])) < 20


def test_a_click_on_the_part_selects_the_row(shown):
    view, scene = shown.viewport.scene.view, shown.viewport.scene
    QTest.mouseClick(view, LEFT, pos=scene.where(IN_POCKET["pocket-02"]).toPoint())
    assert shown.document.selection.current.id == "pocket-02"
    assert shown.docks.features.tree.currentItem().text(0) == "pocket-02"


def test_a_click_on_the_row_highlights_the_faces(shown, qtbot):
    before = pixel(shown, IN_POCKET["pocket-03"])
    tree = shown.docks.features.tree
    QTest.mouseClick(
        tree.viewport(),
        LEFT,
        pos=tree.visualItemRect(shown.docks.features.item("pocket-03")).center(),
    )
    qtbot.wait(20)
    after = pixel(shown, IN_POCKET["pocket-03"])
    assert (
        hue(after) @ hue(rgb(shown.theme.selection))
        > 0.9
        > hue(before) @ hue(rgb(shown.theme.selection))
    )


def test_a_click_beside_the_part_selects_nothing(shown):
    shown.document.selection.select_feature("pocket-01")
    QTest.mouseClick(
        shown.viewport.scene.view,
        LEFT,
        pos=QPoint(shown.viewport.scene.view.width() - 4, 4),
    )
    assert shown.document.selection.current.kind == ""


def test_a_drag_turns_the_part_and_selects_nothing(shown):
    view = shown.viewport.scene.view
    before = view.camera.position
    start = shown.viewport.scene.where(IN_POCKET["pocket-01"]).toPoint()
    QTest.mousePress(view, LEFT, pos=start)
    QTest.mouseMove(view, start + QPoint(60, 40))
    QTest.mouseRelease(view, LEFT, pos=start + QPoint(60, 40))
    assert shown.document.selection.current.kind == ""
    assert view.camera.position != before


@pytest.mark.parametrize(("view", "axis"), [("top", 2), ("front", 1), ("right", 0)])
def test_a_standard_view_looks_along_its_axis(shown, view, axis):
    shown.registry.run(f"view.{view}")
    away = np.subtract(
        shown.viewport.scene.view.camera.position,
        shown.viewport.scene.view.camera.focal_point,
    )
    assert np.argmax(np.abs(away)) == axis
    assert np.sort(np.abs(away))[1] < 1e-6 * np.abs(away).max()


def test_the_legend_names_the_kinds_with_their_counts(shown):
    rows = [(words, count) for _, words, count in shown.viewport.legend.rows]
    assert rows == [("Pocket", "3"), ("Rib", "2"), ("Datum", "1"), ("Profile", "1")]


def test_the_table_and_the_legend_have_the_same_colours(shown):
    top = shown.docks.features.tree.topLevelItem(0)
    image = top.icon(0).pixmap(24, 24).toImage()
    assert (
        image.pixelColor(12, 12).name() == kind_colour("pocket") == shown.viewport.legend.rows[0][0]
    )


def test_the_blank_stands_around_the_part(recognized, idle):
    recognized.document.run("blank", "Create blank")
    idle(recognized)
    low, high = (
        np.array(recognized.viewport.scene.view.actors["blank"].bounds)[k::2] for k in (0, 1)
    )
    assert low == pytest.approx([-5, -5, 0]) and high == pytest.approx(
        [LENGTH + 5, WIDTH + 5, HEIGHT + 2]
    )


def test_a_round_bar_is_drawn_round(recognized):
    bar = Revolved.cylinder(WORLD, 30.0, (-10.0, 50.0), "EN AW-7075", 2.8, "y")
    recognized.viewport.scene.show_blank(bar)
    drawn = recognized.viewport.scene.view.actors["blank"]
    across = np.linalg.norm(drawn.GetMapper().GetInput().points[:, [0, 2]], axis=1)
    assert np.array(drawn.bounds)[2:4] == pytest.approx([-10.0, 50.0])
    assert across.max() == pytest.approx(30.0, rel=1e-3)
    assert np.sort(across)[2:].min() > 29.9


def test_the_blank_is_fitted_into_the_picture_while_it_is_shown(recognized, idle):
    scene = recognized.viewport.scene
    before = scene.view.camera.parallel_scale
    recognized.document.run("blank", "Create blank")
    idle(recognized)
    assert scene.view.camera.parallel_scale > before
    for x in (-5.0, LENGTH + 5.0):
        for y in (-5.0, WIDTH + 5.0):
            for z in (0.0, HEIGHT + 2.0):
                assert scene.view.rect().contains(scene.where((x, y, z)).toPoint())
    recognized.registry.run("view.blank")
    assert scene.view.camera.parallel_scale == pytest.approx(before)


def test_cutting_moves_are_drawn_in_their_colour(recognized, idle, qtbot):
    recognized.document.run("toolpath", "Generate")
    idle(recognized)
    recognized.document.selection.select_operation("op-02")
    qtbot.wait(20)
    picture = (
        recognized.viewport.scene.view.grab()
        .toImage()
        .convertToFormat(recognized.grab().toImage().format())
    )
    wanted = np.array(rgb(motions()["cut"]))
    seen = [
        np.array(picture.pixelColor(x, y).toTuple()[:3])
        for x in range(0, picture.width(), 2)
        for y in range(0, picture.height(), 2)
    ]
    assert sum(np.abs(c - wanted).max() < 12 for c in seen) > 20


def test_only_the_ticked_motions_are_shown(recognized, idle):
    recognized.document.run("toolpath", "Generate")
    idle(recognized)
    assert "rapids" in recognized.viewport.scene.view.actors
    recognized.viewport.show_motions(("cut",))
    assert "rapids" not in recognized.viewport.scene.view.actors


def test_a_section_opens_the_part(shown):
    shown.registry.run("view.section")
    assert (
        shown.viewport.scene.view.actors["part"].mapper.GetClippingPlanes().GetNumberOfItems() == 1
    )
    shown.registry.run("view.section")
    assert (
        shown.viewport.scene.view.actors["part"].mapper.GetClippingPlanes().GetNumberOfItems() == 0
    )


def test_a_size_is_written_where_it_is(recognized, idle, qtbot):
    recognized.document.run("size", "Analyse")
    idle(recognized)
    recognized.panels["size"].fold(False)
    table = recognized.panels["size"].table
    QTest.mouseClick(table.viewport(), LEFT, pos=table.visualItemRect(table.item(1, 0)).center())
    assert recognized.document.selection.current.faces == recognized.document.feature(
        "pocket-02"
    ).with_role("floor")
    assert any(name.startswith("size") for name in recognized.viewport.scene.view.actors)


def test_borders_of_faces_are_the_edges_of_one_triangle():
    mesh, _ = box_mesh()
    ends, owners = border_edges(mesh)
    assert (
        len(ends) == 4 * mesh.face.max()
    )  # every face of the made-up part is a rectangle of two triangles
    assert sorted(set(owners)) == sorted(set(mesh.face))


def test_standard_views_follow_the_frame_of_the_recognition(recognized):
    recognized.viewport.scene.use_frame(
        WORLD.__class__(np.zeros(3), np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0]))
    )
    recognized.registry.run("view.top")
    away = np.subtract(
        recognized.viewport.scene.view.camera.position,
        recognized.viewport.scene.view.camera.focal_point,
    )
    assert np.argmax(away) == 0


def test_many_changes_in_one_turn_are_drawn_once(recognized, qtbot):
    scene, drawn = recognized.viewport.scene, []
    scene.view.grab()
    scene.view.render_window.AddObserver("StartEvent", lambda *_: drawn.append(1))
    for _ in range(5):
        scene.use_tool(None)
        scene.fit()
    assert len(drawn) <= 1  # pyvista draws at once where a camera was never set
    qtbot.waitUntil(lambda: bool(drawn))
    qtbot.wait(50)
    assert len(drawn) <= 2


def test_what_lies_above_the_picture_is_painted_without_drawing_it_early(recognized, qtbot):
    scene, drawn = recognized.viewport.scene, []
    scene.view.grab()
    scene.view.render_window.AddObserver("StartEvent", lambda *_: drawn.append(1))
    scene.view.render()
    scene.view.repaint()
    assert not drawn
    qtbot.waitUntil(lambda: bool(drawn))


@pytest.mark.skipif(
    os.environ.get("QT_QPA_PLATFORM") == "offscreen", reason="without a screen Qt has no surface"
)
def test_a_closed_view_keeps_no_surface_of_qts(window, qtbot):
    view = window.viewport.scene.view
    qtbot.waitUntil(lambda: view._surface is not None)
    window.close()
    assert view._surface is None


def test_toolpaths_are_opened_once(recognized, idle, monkeypatch):
    lengthened = []
    monkeypatch.setattr(
        paths, "opened", lambda path: lengthened.append(path) or opened_chords(path)
    )
    recognized.document.run("toolpath", "Generate")
    idle(recognized)
    listed = recognized.document.session.paths
    assert len(lengthened) == len(listed) > 1
    recognized.viewport.show_motions(("cut",))
    recognized.document.selection.select_operation(listed[0].operation)
    recognized.viewport.show_motions(tuple(motions()))
    recognized.document.selection.select_face(0)
    idle(recognized)
    assert len(lengthened) == len(listed)


def test_many_toolpaths_are_drawn_in_pieces(recognized, idle, qtbot, monkeypatch):
    recognized.document.run("toolpath", "Generate")
    idle(recognized)
    scene, session = recognized.viewport.scene, recognized.document.session
    frame = session.process.setups[0].frame
    copies = [(replace(p.path), frame) for p in session.paths for _ in range(30)]

    def slow(path):
        end = time.thread_time() + 0.005
        while time.thread_time() < end:
            pass
        return opened_chords(path)

    monkeypatch.setattr(paths, "opened", slow)
    before = scene.view.actors["feed moves"]
    scene.show_paths(copies)
    assert scene.view.actors["feed moves"] is before
    qtbot.waitUntil(lambda: scene.view.actors["feed moves"] is not before, timeout=10000)
    n_lines = scene.view.actors["feed moves"].mapper.dataset.n_lines
    assert n_lines == 30 * before.mapper.dataset.n_lines


def test_the_hull_is_as_wide_as_the_mesh_in_every_direction():
    points = np.random.default_rng(5).normal(size=(2000, 3))
    corners, directions = hull_of(points), np.random.default_rng(6).normal(size=(50, 3))
    assert len(corners) < 0.2 * len(points)
    assert np.allclose((corners @ directions.T).max(axis=0), (points @ directions.T).max(axis=0))


@pytest.mark.parametrize("n", [0, 1, 3, 50])
def test_points_in_a_plane_are_their_own_hull(n):
    points = np.column_stack([np.random.default_rng(7).normal(size=(n, 2)), np.ones(n)])
    assert np.array_equal(hull_of(points), points)


def test_the_picture_is_fitted_without_a_look_at_every_point(recognized):
    scene, drawing = recognized.viewport.scene, recognized.document.drawing
    before = scene.view.camera.parallel_scale
    assert len(drawing.hull) < len(drawing.mesh.points)
    scene.show_mesh(replace(drawing, hull=2.0 * drawing.hull), keep_camera=True)
    scene.fit()
    assert scene.view.camera.parallel_scale > 1.5 * before


def test_colours_of_features_are_worked_out_once_for_table_and_picture(
    window, part_file, idle, monkeypatch
):
    worked_out = []
    monkeypatch.setattr(
        palettes,
        "distinct_colours",
        lambda *given: worked_out.append(1) or distinct_colours(*given),
    )
    window.document.files.open(part_file)
    idle(window)
    window.document.run("recognize", "Recognize")
    idle(window)
    window.registry.run("view.paths")
    assert len(worked_out) == 1
