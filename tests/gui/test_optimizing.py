"""The Optimize panel with the real optimiser: what it gains, and how its search went, by real clicks."""

from __future__ import annotations

import os

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from shared_window import shared_window, taken_back, wait

from samples import block_with_pocket
from trunnion.model.load import LAID
from trunnion_gui import i18n
from trunnion_gui.panels.search import choice_words

LEFT = Qt.MouseButton.LeftButton
GAIN = 4


@pytest.fixture(scope="module")
def opened_once(qapp, tmp_path_factory):
    """One window for all tests here, with a part whose operations have their cutting data."""
    with shared_window(tmp_path_factory.mktemp("settings")) as window:
        window.document.files.open(block_with_pocket())
        wait(window)
        window.document.choose("optimize.data", "Cutting data: optimised", "optimised")
        window.document.run("optimize", "Optimize")
        wait(window)
        yield window


@pytest.fixture
def optimised(opened_once, qtbot):
    """That window with its Optimize panel unfolded."""
    with taken_back(opened_once) as window:
        window.panels["optimize"].fold(False)
        qtbot.waitUntil(window.panels["optimize"].table.isVisible, timeout=5000)
        yield window


def click_row(panel, row):
    item = panel.table.visualItemRect(panel.table.item(row, 1))
    QTest.mouseClick(panel.table.viewport(), LEFT, pos=item.center())


@pytest.mark.timeout(240)
def test_a_person_sees_what_the_optimiser_gains_and_how_it_searched(optimised, qtbot):
    panel = optimised.panels["optimize"]
    operations = optimised.document.shown.process.operations
    assert all(o.data.handbook_feed > 0.0 and o.data.bound_by for o in operations)
    row = next(n for n, o in enumerate(operations) if o.kind == "rough")
    assert panel.table.item(row, GAIN).text().startswith("+")
    assert "instead of" in panel.table.item(row, GAIN).toolTip()
    QTest.mouseClick(panel.search.header, LEFT, pos=QPoint(30, 8))
    click_row(panel, row)
    assert optimised.document.selection.current.id == operations[row].id
    qtbot.waitUntil(panel.search.front.isVisible, timeout=60000)
    assert panel.search.words.text() == choice_words(operations[row])
    assert len(panel.search.convergence.points) == 40
    chosen = next(m for m in panel.search.front.marks if m.is_optimum)
    tables = next(m for m in panel.search.front.marks if not m.is_optimum)
    assert chosen.x < tables.x
    # Both plots have their height: neither is squeezed, nor lies over the other.
    first, second = panel.search.convergence, panel.search.front
    qtbot.waitUntil(
        lambda: (
            min(first.height(), second.height()) >= 150 and second.y() >= first.geometry().bottom()
        ),
        timeout=5000,
    )
    if folder := os.environ.get("TRUNNION_PICTURES"):
        optimised.grab().save(os.path.join(folder, "optimize.png"))
        panel.search.grab().save(os.path.join(folder, "search.png"))


@pytest.mark.timeout(240)
def test_the_choice_of_data_can_be_taken_back(optimised, idle):
    document, panel = optimised.document, optimised.panels["optimize"]
    fast = document.shown.process.operations[0].data.feed
    document.choose("optimize.data", "Cutting data: handbook", "handbook")
    document.run("optimize", "Optimize")
    idle(optimised, 60000)
    assert document.shown.process.operations[0].data.handbook_feed == 0.0
    assert document.shown.process.operations[0].data.feed < fast
    assert panel.table.item(0, GAIN).text() == ""
    document.undo()
    document.undo()
    assert document.shown.process.operations[0].data.feed == fast


def test_what_stops_a_choice_is_translated():
    from trunnion.plan.cutting.optimization import limits, operation

    i18n.use("zh_CN")
    try:
        for words in (
            *(getattr(limits, n) for n in ("POWER", "PEAK_POWER", "TORQUE", "PEAK_TORQUE")),
            *(getattr(limits, n) for n in ("FORCE", "BENDING", "FEED", "CHIP_PEAK")),
            *(operation.SPEED, operation.SPINDLE, operation.CHIP, operation.WEAR, LAID),
        ):
            assert i18n.tr(words) != words
    finally:
        i18n.use("en")
