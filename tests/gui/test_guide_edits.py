"""A guide line changed in the window, with the real engine and real clicks: a wall left out of it, taken in again, undone."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtTest import QTest
from shared_window import shared_window, taken_back, wait
from test_face_edits import RIGHT, entry, open_menu

LEAVE, LEAD = "Leave out of", "Lead along"


@pytest.fixture(scope="module")
def guided(qapp, tmp_path_factory, sample_panel):
    """One window for all tests here, with operations of the small panel, and the guide lines of the selected one switched on."""
    with shared_window(tmp_path_factory.mktemp("settings")) as window:
        window.document.files.open(sample_panel)
        wait(window)
        window.document.run("route", "Route")
        wait(window)
        window.registry.action("view.guides").trigger()
        yield window


@pytest.fixture
def routed(guided):
    with taken_back(guided) as window:
        yield window


def seen_wall(window, faces):
    """Return a wall among some faces that is seen, and a place on it."""
    mesh, scene = window.document.mesh, window.viewport.scene
    for tag in faces:
        role = {f.role for f in window.document.feature("pocket-01").faces if f.face == tag}
        for corners in mesh.corners()[mesh.face == tag]:
            place = tuple(corners.mean(axis=0).tolist())
            if "wall" in role and scene.face_at(scene.where(place)) == tag:
                return tag, place
    raise AssertionError("no wall of the pocket is seen")


def right_click(window, place) -> object:
    scene = window.viewport.scene
    QTest.mouseClick(scene.view, RIGHT, pos=scene.where(place).toPoint())
    return open_menu(window)


def choose(window, place, idle, *words) -> None:
    menu = right_click(window, place)
    entry(menu, *words).trigger()
    menu.close()
    idle(window)


def shown_on(window, qtbot) -> set[int]:
    """Return the faces that the guide lines of walls shown in the window are on."""
    qtbot.waitUntil(lambda: bool(window.guides.shown.lines), timeout=60000)
    return {t for line in window.guides.shown.lines for t in line.chain.on}


def the_wall(window):
    return next(
        o
        for o in window.document.session.process.operations
        if (o.kind, o.feature) == ("wall", "pocket-01")
    )


def test_a_wall_is_left_out_of_the_selected_operation_and_taken_in_again(routed, idle, qtbot):
    window, before = routed, routed.document.session
    operation = the_wall(window)
    window.document.selection.select_operation(operation.id)
    face, place = seen_wall(window, operation.faces)
    assert face in shown_on(window, qtbot)

    choose(window, place, idle, f"{LEAVE}: {operation.id}")
    assert face not in the_wall(window).faces and the_wall(window).own_faces
    # The operation is selected again, and its line ends at the walls beside.
    assert window.document.selection.current.id == operation.id
    assert face not in shown_on(window, qtbot)
    assert window.panels["generate"].state in ("stale", "empty")

    choose(window, place, idle, f"{LEAD}: {operation.id}")
    assert set(the_wall(window).faces) == set(operation.faces)
    assert face in shown_on(window, qtbot)
    for _ in range(2):
        window.registry.run("edit.undo")
    idle(window)
    assert window.document.session is before


def test_without_a_selected_operation_all_that_machine_the_face_are_offered(routed, idle):
    window = routed
    operation = the_wall(window)
    face, place = seen_wall(window, operation.faces)
    window.document.selection.clear()
    menu = right_click(window, place)
    out = next(a.menu() for a in menu.actions() if a.text() == LEAVE)
    assert operation.id in [a.text() for a in out.actions()]
    into = next(a.menu() for a in menu.actions() if a.text() == LEAD)
    offered = [a.text() for a in into.actions()]
    assert operation.id not in offered and offered
    menu.close()
    choose(window, place, idle, LEAVE, operation.id)
    assert face not in the_wall(window).faces


def test_what_can_not_lead_an_operation_is_told(routed, idle):
    window = routed
    floor = next(o for o in window.document.session.process.operations if o.kind == "floor")
    face, _ = seen_wall(window, the_wall(window).faces)
    window.views.guide_edits.lead_along(floor.id, (face,))
    idle(window)
    assert any(
        "none of its guide lines can be on face" in m.text for m in window.docks.messages.findings
    )
    assert np.array_equal(floor.faces, window.document.session.process.operation(floor.id).faces)
