"""A family that lives wholly in a package of its own, in the window with the real engine: opened, edited, programmed, drawn."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QImage

from own_packages import with_own_packages
from trunnion_gui.look.colours import motions, rgb
from turned_discs import turned_disc

pytestmark = pytest.mark.cold
BEVEL, SLOT = "disc_bevel-01", "disc_slot-01"


@pytest.fixture(scope="module")
def package():
    """The package on the path of the window and of its worker."""
    with with_own_packages():
        yield


@pytest.fixture
def opened(package, make_window, idle, tmp_path):
    """A window with the disc open and recognised."""
    window = make_window("trunnion.pipeline:Engine")
    window.document.files.open(turned_disc(tmp_path))
    idle(window, 120000)
    window.document.run("recognize", "Recognize")
    idle(window, 120000)
    return window


def shares(window, colours) -> list[float]:
    """Return the shares of the picture whose hue is that of each colour `#rrggbb`."""
    image = window.viewport.scene.view.grab().toImage().convertToFormat(QImage.Format.Format_RGB32)
    seen = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), -1, 4)[..., 2::-1]
    return [share_of(seen.reshape(-1, 3).astype(float), colour) for colour in colours]


def share_of(pixels, colour) -> float:
    wanted = np.array(rgb(colour), dtype=float)
    pixels, wanted = pixels - pixels.mean(axis=1, keepdims=True), wanted - wanted.mean()
    size = np.linalg.norm(pixels, axis=1)
    alike = pixels @ wanted > 0.985 * size * np.linalg.norm(wanted)
    return float(np.mean(alike & (size > 15.0)))


def test_the_disc_is_recognised_edited_programmed_and_drawn(opened, idle, qtbot):
    """One window for all: opening it and starting its worker take most of the time."""
    window, document = opened, opened.document
    looks_as_its_family_says(window)
    an_edge_is_left_sharp_and_comes_back(window)
    document.program()
    idle(window, 240000)
    assert window.status.verdict.text().startswith("verdict: passed")
    the_bevels_operation_is_drawn(window, qtbot)


def looks_as_its_family_says(window) -> None:
    assert window.document.session.recognition.family == "turned_disc"
    assert window.panels["recognize"].result.text().startswith("Taken for a turned disc (1.00)")
    words = [w for _, w, _ in window.viewport.legend.rows]
    assert words == ["Turned · Disc end", "Turned · Disc rim", "Turned · Rim bevel", "Milled"]
    tree = window.docks.features.tree
    titles = [tree.headerItem().text(n) for n in range(tree.columnCount())]
    assert not tree.isColumnHidden(titles.index("Sharp"))
    assert window.docks.features.item(SLOT).parent().text(0) == "Milled · 1"
    window.registry.run("view.top")
    end, rim, slot = shares(window, ("#cc6677", "#117733", "#332288"))
    assert end > 0.002 and slot > 0.01 and rim < end


def an_edge_is_left_sharp_and_comes_back(window) -> None:
    document, command = window.document, window.registry.action("disc.sharp")
    assert not command.isEnabled()
    document.selection.select_feature(BEVEL)
    window.registry.refresh()
    assert command.isEnabled()
    window.registry.run("disc.sharp")
    assert document.feature(BEVEL).attributes["left_sharp"] and document.feature(BEVEL).by_hand
    tree = window.docks.features.tree
    sharp = [tree.headerItem().text(n) for n in range(tree.columnCount())].index("Sharp")
    assert window.docks.features.item(BEVEL).checkState(sharp) is Qt.CheckState.Checked
    entries = [a.text() for a in window.docks.features.menu(document.feature(BEVEL)).actions()]
    assert entries[0] == "Cut the bevel"
    document.undo()
    assert "left_sharp" not in document.feature(BEVEL).attributes


def the_bevels_operation_is_drawn(window, qtbot) -> None:
    """Its round stands in the colour of cuts where the tool's tip goes, and only while paths are shown."""
    window.registry.run("view.top")
    window.document.selection.select_operation(f"bevel-{BEVEL}")
    found = {}
    for shown in (False, True):
        window.viewport.show_layer("paths", shown)
        qtbot.wait(50)
        found[shown] = np.mean([drawn_near(window, p) for p in round_of_the_tip(window)])
    assert found[True] > 0.9 > 0.1 > found[False]


def round_of_the_tip(window):
    """Return points (24, 3) of the part's frame on the circle that the bevel cutter's tip goes round."""
    session = window.document.session
    path, frame = session.path_of(f"bevel-{BEVEL}").path, session.setups[0].frame
    arc = int(np.flatnonzero(np.isfinite(path.centre).all(axis=1))[0])
    centre, radius = path.centre[arc], np.linalg.norm((path.position - path.centre)[arc, :2])
    turn = np.linspace(0.1, 0.1 + 2.0 * np.pi, 24, endpoint=False)
    around = np.stack([np.cos(turn), np.sin(turn), 0.0 * turn], axis=1)
    return frame.to_world(centre * [1, 1, 0] + path.position[arc] * [0, 0, 1] + radius * around)


def drawn_near(window, point) -> bool:
    """Return whether the colour of cuts stands within two pixels of where a point is drawn."""
    wanted = np.array(rgb(motions()["cut"]))
    image, at = window.viewport.scene.view.grab().toImage(), window.viewport.scene.where(point)
    near = [
        image.pixelColor(at.toPoint() + QPoint(x, y)).toTuple()[:3]
        for x in range(-2, 3)
        for y in range(-2, 3)
    ]
    return bool((np.abs(np.array(near) - wanted).max(axis=1) < 60).any())
