"""Groups of equal patches in the window, with the real engine and real clicks: local features, faces moved, cut and exported.

The part is a plate with three small domes, a larger one and a wall with a fillet: seen from the top every dome is one patch.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QMenu
from shared_window import shared_window, until
from test_viewport import hue, pixel

from samples import written
from trunnion.geometry.cut import plane_cut
from trunnion_gui.families.surface.appearance import radius_colour
from trunnion_gui.families.surface.cutting import DRAWN, THREE
from trunnion_gui.look.colours import rgb

LEFT, RIGHT = Qt.MouseButton.LeftButton, Qt.MouseButton.RightButton
CTRL = Qt.KeyboardModifier.ControlModifier
TOP = 10.0
SMALL, LARGE = ((-20.0, 10.0), (0.0, 10.0), (20.0, 10.0)), (0.0, -8.0)
SMALL_RADIUS, LARGE_RADIUS = 4.0, 7.0
ON_SMALL = [(x, y, TOP + SMALL_RADIUS) for x, y in SMALL]
ON_LARGE = (*LARGE, TOP + LARGE_RADIUS)
ON_TOP = (-24.0, -14.0, TOP)
FILLET = 3.0
ON_FILLET = (-15.0, 20.0 - FILLET + FILLET * math.sin(0.5), TOP + FILLET - FILLET * math.cos(0.5))


def domed_plate():
    """Return the plate of 60 x 40 x 10 mm with its domes, and a wall along its back that a fillet leads up to."""
    import cadquery as cq

    body = cq.Workplane("XY").box(60.0, 40.0, TOP, centered=(True, True, False))
    body = body.union(
        cq.Workplane("XY")
        .box(60.0, 4.0, 16.0, centered=(True, True, False))
        .translate((0.0, 22.0, 0.0))
    )
    body = body.edges(cq.selectors.NearestToPointSelector((0.0, 20.0, TOP))).fillet(FILLET)
    for (x, y), radius in (*((at, SMALL_RADIUS) for at in SMALL), (LARGE, LARGE_RADIUS)):
        body = body.union(cq.Workplane("XY").sphere(radius).translate((x, y, TOP)))
    return body.val().wrapped


@pytest.fixture(scope="module")
def segmented(qapp, tmp_path_factory):
    """One window for all tests here, with the plate segmented; every test takes back what it changed."""
    with shared_window(tmp_path_factory.mktemp("settings")) as window:
        window.document.files.open(written(domed_plate(), name="domes"))
        until(lambda: window.document.has_part and not window.document.is_busy)
        window.document.choose("recognize.family", "Family: surface", "surface")
        window.document.run("recognize", "Recognize")
        until(
            lambda: window.document.session.recognition is not None and not window.document.is_busy
        )
        yield window


@pytest.fixture
def shown(segmented, qtbot):
    """That window seen from the top, with nothing selected."""
    window, before = segmented, segmented.document.session
    window.registry.run("view.top")
    window.document.selection.select_face(0)
    yield window
    window.views["surface"].cutting.end()
    while window.document.session is not before and window.document.history.undo_label:
        window.registry.run("edit.undo")
    qtbot.waitUntil(
        lambda: not window.document.is_busy and not window.document.jobs.is_querying, timeout=30000
    )


def click(window, place, button=LEFT, keys=Qt.KeyboardModifier.NoModifier) -> None:
    """Click the part at a place of it."""
    QTest.mouseClick(
        window.viewport.scene.view, button, keys, window.viewport.scene.where(place).toPoint()
    )


def face_at(window, place) -> int:
    """Return the tag of the face at a place of the picture."""
    return window.viewport.scene.face_at(window.viewport.scene.where(place))


def group_at(window, place):
    """Return the group of the face at a place of the picture."""
    face = face_at(window, place)
    return next(f for f in window.document.shown.recognition if face in f.tags)


def done(window, qtbot) -> None:
    """Wait until a job that a click began is done."""
    qtbot.waitUntil(
        lambda: not window.document.is_busy and not window.document.jobs.is_querying, timeout=60000
    )


def test_equal_domes_are_one_group_and_local(shown):
    small, large = group_at(shown, ON_SMALL[0]), group_at(shown, ON_LARGE)
    assert {face_at(shown, p) for p in ON_SMALL} == set(small.tags)
    assert small.attributes["local"] and large.attributes["local"] and small.id != large.id
    assert not group_at(shown, ON_TOP).attributes["local"]


def test_local_groups_have_warm_colours_and_the_rest_cold_ones(shown, qtbot):
    (_, remaining, _), (_, local, _) = (
        (rgb(c), w, n) for c, w, n in shown.viewport.legend.rows[:2]
    )
    assert (remaining, local) == ("Remaining area", "Local features")
    beside = [
        (x + 1.2, y - 1.2, z - 0.4) for x, y, z in ON_SMALL
    ]  # the ball's seam runs through its pole
    cold, warm, other = (pixel(shown, place) for place in (ON_TOP, *beside[:2]))
    assert cold[2] > cold[0] + 20 and warm[0] > warm[2] + 20
    assert hue(other) @ hue(warm) > 0.97


def own_column(window, number: int) -> int:
    """Return the column of the features' tree that is the part's own family's first, second or third."""
    tree = window.docks.features.tree
    return [c for c in range(3, tree.columnCount()) if not tree.isColumnHidden(c)][number]


def test_a_row_shows_faces_size_and_the_mark(shown):
    small = group_at(shown, ON_SMALL[0])
    row = shown.docks.features.item(small.id)
    assert (row.text(0), row.text(1), row.text(2)) == (small.id, "3", "8")
    assert row.checkState(own_column(shown, 2)) is Qt.CheckState.Checked
    assert row.parent().text(0).startswith("Local features")


def test_an_id_keeps_its_number_when_there_is_little_room(shown):
    id, tree = group_at(shown, ON_SMALL[0]).id, shown.docks.features.tree
    narrow = tree.fontMetrics().elidedText(
        id, tree.textElideMode(), tree.fontMetrics().horizontalAdvance(id) - 10
    )
    assert narrow != id and narrow.endswith(id[-2:])


def test_a_click_on_the_mark_changes_the_class_and_undo_brings_it_back(shown, qtbot):
    id, tree = group_at(shown, ON_SMALL[0]).id, shown.docks.features.tree
    tree.scrollToItem(shown.docks.features.item(id))
    at, mark = tree.visualItemRect(shown.docks.features.item(id)), own_column(shown, 2)
    QTest.mouseClick(
        tree.viewport(),
        LEFT,
        pos=QPoint(
            tree.columnViewportPosition(mark) + tree.columnWidth(mark) // 2, at.center().y()
        ),
    )
    qtbot.waitUntil(lambda: shown.document.feature(id).attributes["local"] is False)
    assert shown.docks.features.item(id).parent().text(0).startswith("Remaining area")
    assert shown.document.feature(id).by_hand
    shown.registry.run("edit.undo")
    qtbot.waitUntil(
        lambda: shown.docks.features.item(id).parent().text(0).startswith("Local features")
    )


def test_clicks_on_the_part_mark_local_features_while_that_is_on(shown, qtbot):
    shown.registry.run("patch.click_local")
    try:
        click(shown, ON_TOP)
        qtbot.waitUntil(lambda: group_at(shown, ON_TOP).attributes["local"] is True)
        click(shown, ON_LARGE)
        qtbot.waitUntil(lambda: group_at(shown, ON_LARGE).attributes["local"] is False)
    finally:
        shown.registry.run("patch.click_local")
    click(shown, ON_LARGE)
    assert shown.document.selection.current.id == group_at(shown, ON_LARGE).id
    assert group_at(shown, ON_LARGE).attributes["local"] is False


def test_groups_are_chosen_by_id_and_marked_together(shown, qtbot):
    small, large = group_at(shown, ON_SMALL[0]), group_at(shown, ON_LARGE)
    line = shown.docks.features.line
    line.setFocus()
    QTest.keyClicks(line, f"{small.id}, {large.id}")
    QTest.keyClick(line, Qt.Key.Key_Return)
    assert set(shown.document.selection.current.faces) == {*small.tags, *large.tags}
    assert {i.text(0) for i in shown.docks.features.tree.selectedItems()} == {small.id, large.id}
    shown.registry.run("patch.local")
    assert not any(shown.document.feature(f.id).attributes["local"] for f in (small, large))
    line.clear()


def test_an_id_that_is_not_there_is_told(shown):
    shown.docks.features.line.setText("group-99")
    QTest.keyClick(shown.docks.features.line, Qt.Key.Key_Return)
    assert shown.viewport.notice.text == "group-99: no feature and no face has this ID"
    shown.docks.features.line.clear()
    shown.viewport.notice.hide()


def test_ctrl_clicks_gather_faces_of_any_group(shown):
    for place in (ON_SMALL[0], ON_LARGE):
        click(shown, place, keys=CTRL)
    assert set(shown.document.selection.current.faces) == {
        face_at(shown, ON_SMALL[0]),
        face_at(shown, ON_LARGE),
    }
    click(shown, ON_LARGE, keys=CTRL)
    assert shown.document.selection.current.faces == (face_at(shown, ON_SMALL[0]),)


def test_a_face_moves_to_another_group_by_the_menu_of_a_right_click(shown, qtbot):
    face, into = face_at(shown, ON_SMALL[1]), group_at(shown, ON_LARGE)
    click(shown, ON_SMALL[1], RIGHT)
    menu = next(m for m in shown.viewport.findChildren(QMenu) if m.isVisible())
    groups = next(
        a.menu() for a in menu.actions() if a.menu() is not None and a.text() == "Move to"
    )
    next(a for a in groups.actions() if a.text() == into.id).trigger()
    menu.close()
    done(shown, qtbot)
    assert group_at(shown, ON_LARGE).id == into.id == group_at(shown, ON_SMALL[1]).id
    assert len(group_at(shown, ON_SMALL[0]).tags) == 2
    shown.registry.run("edit.undo")
    assert face in group_at(shown, ON_SMALL[0]).tags


def test_faces_move_to_a_new_group(shown, qtbot):
    shown.views["surface"].jobs.move((face_at(shown, ON_SMALL[1]),))
    done(shown, qtbot)
    alone = group_at(shown, ON_SMALL[1])
    assert len(alone.tags) == 1 and alone.by_hand
    assert shown.docks.features.item(alone.id).text(1) == "1"


def test_a_plane_through_a_click_cuts_a_patch_in_two(shown, qtbot):
    before, n = shown.document.mesh, shown.document.session.part.n_faces
    click(shown, ON_TOP)
    shown.document.selection.select_face_alone(face_at(shown, ON_TOP))
    shown.registry.run("patch.cut_plane")
    bar = shown.views["surface"].cutting
    assert bar.isVisible() and bar.method.currentData() == "x"  # across the face's longest side
    click(shown, (-10.0, -14.0, TOP))
    assert bar.value.value() == pytest.approx(-10.0, abs=0.2)
    assert "cut line" in shown.viewport.scene.view.actors
    QTest.mouseClick(bar.apply, LEFT)
    done(shown, qtbot)
    assert not bar.isVisible() and "cut line" not in shown.viewport.scene.view.actors
    assert shown.document.session.part.n_faces == n + 1
    assert face_at(shown, (-15.0, -14.0, TOP)) != face_at(shown, (-5.0, -14.0, TOP))
    assert shown.panels["recognize"].state == "done"
    shown.registry.run("edit.undo")
    assert shown.document.mesh is before
    assert face_at(shown, (-15.0, -14.0, TOP)) == face_at(shown, (-5.0, -14.0, TOP))
    shown.registry.run("edit.redo")
    assert face_at(shown, (-15.0, -14.0, TOP)) != face_at(shown, (-5.0, -14.0, TOP))


def test_three_clicks_make_a_plane(shown, qtbot):
    n = shown.document.session.part.n_faces
    shown.registry.run("patch.cut_plane")
    bar = shown.views["surface"].cutting
    bar.method.setCurrentIndex(bar.method.findData(THREE))
    x, y, z = ON_SMALL[2]
    for place in ((x, y, z), (x + 1.0, y + 1.0, z - 0.26), (x - 1.0, y - 1.0, z - 0.26)):
        assert not bar.apply.isEnabled()
        click(shown, place)
    assert bar.face == face_at(shown, ON_SMALL[2])
    QTest.mouseClick(bar.apply, LEFT)
    done(shown, qtbot)
    assert (
        shown.document.session.part.n_faces > n
    )  # the seam of the ball divides one side once more
    assert face_at(shown, (x + 2.0, y - 2.0, z)) != face_at(shown, (x - 2.0, y + 2.0, z))


def test_a_line_drawn_with_clicks_cuts_a_patch_and_the_cut_can_be_taken_back(shown, qtbot):
    x, y, z = ON_LARGE
    n = shown.document.session.part.n_faces
    shown.document.selection.select_face_alone(face_at(shown, ON_LARGE))
    shown.registry.run("patch.cut_way")
    bar = shown.views["surface"].cutting
    assert bar.method.currentData() == DRAWN and not bar.apply.isEnabled()
    for dx, dy in ((-4.0, 0.0), (0.0, 1.5), (3.0, 1.0), (4.0, 0.0)):
        click(shown, (x + dx, y + dy, z))
    assert len(bar.positions) == 4
    QTest.mouseClick(bar.back, LEFT)
    assert len(bar.positions) == 3
    QTest.mouseClick(bar.apply, LEFT)
    done(shown, qtbot)
    assert shown.document.session.part.n_faces == n + 1
    assert face_at(shown, (x, y + 4.0, z)) != face_at(shown, (x, y - 4.0, z))
    menu = shown.views.face_menu(shown, (face_at(shown, ON_TOP),))
    back = next(a.menu() for a in menu.actions() if a.text() == "Take back a cut")
    assert [a.text() for a in back.actions()] == [f"1: face {bar_face(shown)} along a drawn line"]
    back.actions()[0].trigger()
    done(shown, qtbot)
    assert shown.document.session.part.n_faces == n and shown.document.session.cuts == ()


def bar_face(window) -> int:
    """Return the face that was cut last."""
    return window.document.session.cuts[-1].face


def test_escape_puts_a_cut_away_and_keeps_the_selection(shown):
    shown.document.selection.select_face_alone(face_at(shown, ON_TOP))
    shown.registry.run("patch.cut_way")
    click(shown, ON_TOP)
    shown.registry.run("edit.none")
    assert not shown.views[
        "surface"
    ].cutting.isVisible() and shown.document.selection.current.faces == (face_at(shown, ON_TOP),)


def test_a_cut_along_its_faces_border_is_refused_in_words(shown, qtbot):
    shown.document.selection.select_face_alone(face_at(shown, ON_TOP))
    shown.registry.run("patch.cut_plane")
    bar = shown.views["surface"].cutting
    assert bar.method.currentData() == "x"
    bar.value.setValue(-30.0)
    QTest.mouseClick(bar.apply, LEFT)
    qtbot.waitUntil(lambda: shown.viewport.notice.isVisible(), timeout=30000)
    assert "doesn't divide it" in shown.viewport.notice.text
    assert bar.isVisible() and shown.document.session.cuts == ()
    shown.viewport.notice.hide()


@pytest.mark.parametrize(("kind", "suffix"), [("STEP", ".step"), ("IGES", ".igs")])
def test_local_features_are_exported_alone(shown, qtbot, tmp_path, kind, suffix):
    path = tmp_path / f"local{suffix}"
    dialog = shown.views["surface"].export_dialog
    shown.registry.run("patch.export")
    dialog._choose_path = lambda proposed, chosen: str(path.with_suffix(""))
    QTest.mouseClick(dialog.parts["local"], LEFT, pos=QPoint(8, 8))
    QTest.mouseClick(dialog.formats[kind], LEFT, pos=QPoint(8, 8))
    assert dialog.words() == ("local",) and dialog.count.text() == "4 faces in 2 groups"
    QTest.mouseClick(dialog.export_button, LEFT)
    done(shown, qtbot)
    dialog.hide()
    assert path.exists()
    assert "4 faces written" in shown.status.text.text()
    assert faces_in(path) == 4


def faces_in(path) -> int:
    """Return how many faces the CAD kernel's own reader finds in a file."""
    from OCP.IGESControl import IGESControl_Reader
    from OCP.STEPControl import STEPControl_Reader

    from trunnion.part.topology.identity import faces_of

    reader = IGESControl_Reader() if path.suffix == ".igs" else STEPControl_Reader()
    reader.ReadFile(str(path))
    reader.TransferRoots()
    return len(faces_of(reader.OneShape()))


def test_the_groups_of_the_selection_are_ticked_for_export(shown):
    click(shown, ON_LARGE)
    shown.registry.run("patch.export")
    assert shown.views["surface"].export_dialog.words() == (group_at(shown, ON_LARGE).id,)
    assert shown.views["surface"].export_dialog.list.isEnabled()
    shown.views["surface"].export_dialog.hide()


def test_radii_stand_in_columns_and_as_colours(shown, qtbot):
    small, large = group_at(shown, ON_SMALL[0]), group_at(shown, ON_LARGE)
    rows = [shown.docks.features.item(f.id) for f in (small, large)]
    concave, convex = own_column(shown, 0), own_column(shown, 1)
    assert [row.text(convex) for row in rows] == ["4", "7"]
    assert [row.text(concave) for row in rows] == ["", ""]
    assert shown.docks.features.item(group_at(shown, ON_FILLET).id).text(concave) == "3"
    shown.registry.run("patch.radii")
    try:
        assert shown.viewport.legend.rows[0][1] == "Smallest concave radius"
        assert hue(pixel(shown, ON_FILLET)) @ hue(rgb(radius_colour(3.0))) > 0.95
        assert np.ptp(pixel(shown, ON_TOP)) < 25
    finally:
        shown.registry.run("patch.radii")
    assert shown.viewport.legend.rows[0][1] == "Remaining area"


def test_only_the_settings_of_the_parts_own_family_are_offered(shown):
    panel = shown.panels["recognize"]
    panel.fold(False)
    assert (
        panel.settings.group("recognize.surface").isVisible()
        and not panel.settings.group("recognize.panel").isVisible()
    )


def test_a_cutter_is_found_by_letters_of_its_name(shown):
    field = next(
        f.field("surface.cutter")
        for f in shown.panels["route"].forms
        if "surface.cutter" in f.values()
    )
    finder = field.completer()
    finder.setCompletionPrefix("ball d6")
    assert finder.completionCount() > 0 and "ball D6" in finder.currentCompletion()


def test_ids_are_written_on_the_part(shown):
    shown.registry.run("patch.ids")
    assert any(name.startswith("names") for name in shown.viewport.scene.view.actors)
    shown.registry.run("patch.ids")
    assert not any(name.startswith("names") for name in shown.viewport.scene.view.actors)


def test_the_properties_say_what_the_selected_faces_belong_to(shown):
    click(shown, ON_SMALL[0], keys=CTRL)
    click(shown, ON_LARGE, keys=CTRL)
    table = shown.docks.properties.table
    assert [table.item(r, 0).text() for r in range(table.rowCount())] == sorted(
        {group_at(shown, ON_SMALL[0]).id, group_at(shown, ON_LARGE).id}
    )


def test_a_plate_seen_from_the_top_shows_what_was_built(shown):
    assert np.allclose(np.ptp(shown.document.mesh.points, axis=0), (60.0, 44.0, 17.0), atol=0.2)


def test_the_error_of_the_sizes_is_shown_by_the_number_of_points(shown, qtbot):
    shown.registry.run("patch.errors")
    qtbot.waitUntil(lambda: shown.views["surface"].accuracy.shown is not None, timeout=60000)
    dock, rows = shown.views["surface"].accuracy, shown.views["surface"].accuracy.shown.rows
    assert dock.isVisible() and dock.table.rowCount() == len(rows)
    assert dock.table.item(len(rows) - 2, 0).text() == "the paper's repair"
    assert [dock.table.item(len(rows) - 1, k).text() for k in (0, 2)] == ["exact", "0 %"]
    assert rows[0].largest > rows[3].largest >= rows[7].largest
    heights = [dock.chart.point(dock.chart.left, k).y() for k in (0, 3, 7)]
    assert heights == sorted(heights)  # less error lies lower
    picture = dock.chart.grab().toImage()
    ratio = picture.width() / dock.chart.width()
    at = dock.chart.point(dock.chart.left, 0) * ratio
    assert hue(picture.pixelColor(at.toPoint()).toTuple()[:3]) @ hue(rgb(shown.theme.accent)) > 0.9


def test_a_saved_project_opens_with_its_cuts_and_what_was_called_local(
    make_window, tmp_path, qtbot
):
    window = make_window("trunnion.pipeline:Engine")
    window.document.files.open(written(domed_plate(), name="domes"))
    done(window, qtbot)
    window.document.choose("recognize.family", "Family: surface", "surface")
    window.document.run("recognize", "Recognize")
    done(window, qtbot)
    window.registry.run("view.top")
    window.views["surface"].jobs.cut(
        plane_cut(face_at(window, ON_TOP), (-10.0, 0.0, 0.0), (1.0, 0.0, 0.0))
    )
    done(window, qtbot)
    window.views["surface"].tools.toggle_local((face_at(window, ON_TOP),))
    done(window, qtbot)
    faces, id = window.document.session.part.n_faces, group_at(window, ON_TOP).id
    assert window.document.feature(id).attributes["local"] is True
    window.document.files.save(tmp_path / "domes.trunnion")
    done(window, qtbot)
    window.document.files.open(tmp_path / "domes.trunnion")
    done(window, qtbot)
    window.registry.run("view.top")
    assert window.document.session.part.n_faces == faces
    assert face_at(window, (-15.0, -14.0, TOP)) != face_at(window, (-5.0, -14.0, TOP))
    assert (
        group_at(window, ON_TOP).id == id and group_at(window, ON_TOP).attributes["local"] is True
    )
    assert window.document.states["recognize"] == "done"


def test_own_areas_and_times_give_the_papers_gains(shown, qtbot):
    block = shown.views["surface"].efficiency
    assert shown.panels["optimize"].isAncestorOf(block) and not block.isHidden()
    block.fold(False)
    qtbot.waitUntil(lambda: "28.18 %" in block.words.text(), timeout=30000)
    assert [block.choice.itemText(n) for n in range(block.choice.count())] == [
        "Test piece",
        "Whole impeller",
        "Turbine blade",
    ]
    assert block.fields["large", "measured_time"].text() == "2 h 16 min 02 s"
    block.choice.setCurrentIndex(1)
    block.choice.activated.emit(1)
    qtbot.waitUntil(lambda: "20.14 %" in block.words.text(), timeout=30000)
    for cutter, area in (("large", "735.836"), ("small", "737.478")):
        field = block.fields[cutter, "areas"]
        field.selectAll()
        QTest.keyClicks(field, area)
    qtbot.waitUntil(lambda: "12.33 %" in block.words.text(), timeout=30000)
    QTest.keyClicks(field, "x")
    qtbot.waitUntil(lambda: "areas must be a number" in block.words.text(), timeout=30000)
    block.fold(True)


def test_areas_and_times_are_opened_from_a_file(shown, qtbot, tmp_path, monkeypatch):
    block, file = shown.views["surface"].efficiency, tmp_path / "own.toml"
    cutter = "areas = [{}]\nmeasured_area = 10\nmeasured_time = {}\n"
    file.write_text(f"[own.large]\n{cutter.format(100, 60)}[own.small]\n{cutter.format(0.5, 90)}")
    monkeypatch.setattr(block, "_choose_path", lambda: str(file))
    block.open_button.click()
    qtbot.waitUntil(lambda: block.choice.itemText(0) == "own", timeout=30000)
    # 904.5 s by the small one alone, 600 + 4.5 s with both
    qtbot.waitUntil(lambda: "49.63 %" in block.words.text(), timeout=30000)
    monkeypatch.setattr(block, "_choose_path", lambda: str(tmp_path / "none.toml"))
    block.open_button.click()
    qtbot.waitUntil(lambda: "none.toml: No such file" in block.words.text(), timeout=30000)
