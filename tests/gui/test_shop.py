"""The window of the shop: tools searched, put into a machine, planned with, read from a library of another program; by real clicks."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QColor, QDropEvent
from PySide6.QtTest import QTest

from samples import block_with_pocket
from trunnion.shop.crib import load_cribs
from trunnion_gui.look import colours
from trunnion_gui.shop.tool_table import NAME, NUMBER, TICK

LEFT = Qt.MouseButton.LeftButton
LIBRARIES = Path(__file__).parents[1] / "tool_libraries"
MACHINE, DRILL = "Mill 1200", "DR-S D8"
pytestmark = pytest.mark.timeout(240)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A user's folder of the test's own; the worker starts afresh with it in its environment."""
    monkeypatch.setenv("TRUNNION_USER_FOLDER", str(tmp_path / "user"))
    return tmp_path / "user"


@pytest.fixture
def shop(folder, make_window, qtbot):
    """The window of the shop over the real engine, opened by its key."""
    window = make_window("trunnion.pipeline:Engine")
    QTest.keyClick(window, Qt.Key.Key_T, Qt.KeyboardModifier.ControlModifier)
    qtbot.waitUntil(lambda: window.shop is not None, timeout=5000)
    settle(window.shop, qtbot)
    choose(window.shop.tools.filter.machine, MACHINE)
    return window.shop


def settle(shop, qtbot):
    qtbot.waitUntil(lambda: not shop.waiting.isVisible(), timeout=60000)


def choose(field, words):
    """Choose an entry of a list by its keys."""
    field.setFocus()
    for _ in range(field.count()):
        if field.currentText() == words:
            return
        QTest.keyClick(field, Qt.Key.Key_Down)
    QTest.keyClick(field, Qt.Key.Key_Home)
    while field.currentText() != words:
        before = field.currentIndex()
        QTest.keyClick(field, Qt.Key.Key_Down)
        assert field.currentIndex() > before, words


def search(shop, words):
    line = shop.tools.filter.words
    line.setFocus()
    line.selectAll()
    QTest.keyClicks(line, words)


def listed(shop):
    model = shop.tools.table.model()
    return [model.index(r, NAME).data() for r in range(model.rowCount())]


def click(shop, name, column=NAME):
    """Click a cell of the table, at its tick in the column of ticks."""
    table = shop.tools.table
    index = shop.tools.model.index(listed(shop).index(name), column)
    table.scrollTo(index)
    box = table.visualRect(index)
    at = QPoint(box.left() + 14, box.center().y()) if column == TICK else box.center()
    QTest.mouseClick(table.viewport(), LEFT, pos=at)


def click_tick(box):
    QTest.mouseClick(box, LEFT, pos=QPoint(8, box.height() // 2))


def type_into(field, words):
    field.setFocus()
    field.selectAll()
    QTest.keyClicks(field, words)
    QTest.keyClick(field, Qt.Key.Key_Return)


def picture_of(shop, name):
    if kept := os.environ.get("TRUNNION_PICTURES"):
        shop.grab().save(os.path.join(kept, f"shop-{name}.png"))


def test_tools_are_found_by_words_form_material_and_diameter(shop):
    all_tools = len(listed(shop))
    search(shop, "tap_blind M6x1")
    assert listed(shop) == ["TAP-C M6x1"]
    search(shop, "no such tool")
    assert listed(shop) == []
    shop.tools.filter.words.clear()
    assert len(listed(shop)) == all_tools > 800
    choose(shop.tools.filter.form, "drill")
    type_into(shop.tools.filter.least, "8")
    type_into(shop.tools.filter.most, "8.2")
    rows = {r.name: r for r in shop.tools.model.rows}
    assert DRILL in listed(shop)
    assert all(rows[n].form == "drill" and 8.0 <= rows[n].diameter <= 8.2 for n in listed(shop))
    assert shop.tools.filter.count.text().startswith(f"{len(listed(shop))} of {all_tools} tools")
    shop.tools.filter.form.setCurrentIndex(0)
    group = shop.tools.filter.group
    choose(group, next(group.itemText(n) for n in range(group.count()) if group.itemData(n) == "N"))
    assert listed(shop) and all("N" in rows[n].suits for n in listed(shop))


def test_a_tool_is_drawn_from_its_data_with_cutter_and_holder_in_colours_of_their_own(shop):
    search(shop, DRILL)
    click(shop, DRILL)
    details = shop.tools.details
    assert details.title.text() == DRILL
    for theme in ("light", "dark"):
        shop.use_theme(colours.theme(theme))
        drawn = details.picture.grab().toImage()
        across = [
            {drawn.pixelColor(x, y).name() for x in range(drawn.width())}
            for y in range(drawn.height())
        ]
        tool = colours.tool_colours()
        cutter = [y for y, row in enumerate(across) if QColor(tool["cutter"]).name() in row]
        holder = [y for y, row in enumerate(across) if QColor(tool["holder"]).name() in row]
        # The cutter is below the holder, and each as long as its data say.
        assert max(holder) < min(cutter)
        row = next(r for r in shop.tools.model.rows if r.name == DRILL)
        shown = (max(cutter) - min(cutter)) / (max(holder) - min(holder))
        assert shown == pytest.approx(
            row.flute_length / (row.gauge_length - row.stickout), rel=0.15
        )
        picture_of(shop, theme)
    fields = [details.fields.item(r, 0).text() for r in range(details.fields.rowCount())]
    assert {"Diameter", "Point angle", "Holder"} <= set(fields)


def test_a_tool_is_put_into_the_machine_numbered_worn_and_taken_out(shop, folder, qtbot):
    search(shop, "DR-S D8")
    click(shop, DRILL, TICK)
    settle(shop, qtbot)
    assert load_cribs(folder)[MACHINE].numbers == ((DRILL, 1),)
    click(shop, DRILL)
    details = shop.tools.details
    assert details.loaded.isChecked() and details.number.isEnabled()
    type_into(details.number, "12")
    settle(shop, qtbot)
    type_into(details.pocket, "7")
    settle(shop, qtbot)
    row = next(r for r in shop.tools.model.rows if r.name == DRILL)
    type_into(details.gauge, f"{row.gauge_length - 0.015:.3f}")
    settle(shop, qtbot)
    type_into(details.radius, "-0.004")
    settle(shop, qtbot)
    tool = load_cribs(folder)[MACHINE].tool(DRILL)
    assert (tool.number, tool.pocket) == (12, 7)
    assert (tool.wear_length, tool.wear_radius) == (-0.015, -0.004)
    assert shop.tools.model.index(listed(shop).index(DRILL), NUMBER).data() == "12"
    assert details.length.value() == -0.015
    # The table is sorted by a click on a column, and the tool stays selected.
    header = shop.tools.table.horizontalHeader()
    at = QPoint(header.sectionViewportPosition(NUMBER) + 30, header.height() // 2)
    QTest.mouseClick(header.viewport(), LEFT, pos=at)
    QTest.mouseClick(header.viewport(), LEFT, pos=at)
    assert listed(shop)[0] == DRILL and shop.tools.selected_names() == (DRILL,)
    # A number that another tool has is refused in words, and the field shows again what is so.
    search(shop, "DR-S D8.5")
    (other,) = listed(shop)
    click(shop, other)
    click_tick(details.loaded)
    settle(shop, qtbot)
    type_into(details.number, "12")
    qtbot.waitUntil(shop.notice.isVisible, timeout=10000)
    settle(shop, qtbot)
    assert "the same number, 12" in shop.notice.text
    assert details.number.value() == 1
    click_tick(details.loaded)
    settle(shop, qtbot)
    search(shop, "")
    shop.tools.filter.words.clear()
    click_tick(shop.tools.filter.loaded)
    assert listed(shop) == [DRILL]


def test_a_route_takes_only_tools_in_the_machine_where_that_is_ticked(shop, qtbot, idle):
    window, only = shop.parent(), shop.tools.filter.only
    assert not only.isEnabled()
    window.document.files.open(block_with_pocket())
    idle(window, 90000)
    assert only.isEnabled() and not only.isChecked()
    click_tick(only)
    idle(window)
    assert window.document.session.choices["route.only_in_machine"] is True
    window.document.choose("setup.machine", "Machine", MACHINE)
    name = "AL3-stub D12 R0"
    search(shop, name)
    click(shop, name)
    click_tick(shop.tools.details.loaded)
    settle(shop, qtbot)
    type_into(shop.tools.details.number, "33")
    settle(shop, qtbot)
    window.document.run("route", "Generate route")
    idle(window, 90000)
    tools = window.document.session.process.tools()
    assert [(t.name, t.number) for t in tools] == [(name, 33)]
    # Taking it out makes the plan stale.
    click_tick(shop.tools.details.loaded)
    settle(shop, qtbot)
    idle(window)
    assert window.document.states["route"] == "stale"
    window.document.undo()
    window.document.undo()
    window.document.undo()
    idle(window)
    assert not only.isChecked()


def test_a_dropped_library_is_taken_after_its_losses_are_shown(shop, folder, qtbot):
    page, data = shop.tools, QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(LIBRARIES / "linuxcnc" / "sample_tool.tbl"))])
    page.dropEvent(
        QDropEvent(
            QPointF(5, 5), Qt.DropAction.CopyAction, data, LEFT, Qt.KeyboardModifier.NoModifier
        )
    )
    qtbot.waitUntil(page.exchange.isVisible, timeout=10000)
    losses = page.exchange.table
    words = [losses.item(r, 0).text() for r in range(losses.rowCount())]
    assert any("assumed: flute_length" in w for w in words)
    assert "sample_tool.tbl" in page.exchange.title.text()
    assert not (folder / "tools").exists()
    picture_of(shop, "losses")
    count = len(page.exchange.shown.names)
    QTest.mouseClick(page.exchange.accept, LEFT)
    settle(shop, qtbot)
    assert (folder / "tools" / "sample_tool.toml").is_file()
    qtbot.waitUntil(lambda: page.table.isVisible(), timeout=5000)
    assert page.selected_names()[0] in page.exchange.shown.names
    assert len(page.model.rows) == 876 + count
    # Once more would write over it.
    page.read_library(str(LIBRARIES / "linuxcnc" / "sample_tool.tbl"))
    qtbot.waitUntil(page.exchange.isVisible, timeout=10000)
    QTest.mouseClick(page.exchange.accept, LEFT)
    qtbot.waitUntil(shop.notice.isVisible, timeout=10000)
    assert "is there already" in shop.notice.text
    QTest.mouseClick(page.exchange.back, LEFT)
    assert page.table.isVisible()


def test_selected_tools_are_written_with_their_numbers_in_the_machine(
    shop, tmp_path, qtbot, monkeypatch
):
    page, output = shop.tools, tmp_path / "own.tbl"
    search(shop, "DR-S D8")
    click(shop, DRILL, TICK)
    settle(shop, qtbot)
    click(shop, DRILL)
    type_into(page.details.number, "21")
    settle(shop, qtbot)
    monkeypatch.setattr(page, "output_path", lambda: str(output))
    QTest.mouseClick(page.write, LEFT)
    qtbot.waitUntil(page.exchange.isVisible, timeout=10000)
    assert output.read_text().startswith("T21 ")
    assert page.exchange.table.rowCount() and not page.exchange.accept.isVisible()
    monkeypatch.setattr(page, "library_path", lambda: str(tmp_path / "gone.tbl"))
    QTest.mouseClick(page.exchange.back, LEFT)
    QTest.mouseClick(page.read, LEFT)
    qtbot.waitUntil(shop.notice.isVisible, timeout=10000)
    assert "gone.tbl: can't be read" in shop.notice.text


def test_machines_and_materials_have_pages_with_their_fields(shop, qtbot):
    bar = shop.pages.tabBar()
    for n, (page, field) in enumerate(
        ((shop.machines, "Tool places"), (shop.materials, "Speed rough")), 1
    ):
        QTest.mouseClick(bar, LEFT, pos=bar.tabRect(n).center())
        assert page.table.isVisible() and page.table.rowCount() > 3
        at = page.table.visualItemRect(page.table.item(1, 0)).center()
        QTest.mouseClick(page.table.viewport(), LEFT, pos=at)
        fields = [page.fields.item(r, 0).text() for r in range(page.fields.rowCount())]
        assert field in fields


def test_everything_fits_into_a_small_window(shop):
    shop.resize(1024, 640)
    QTest.qWait(50)
    assert (shop.width(), shop.height()) == (1024, 640)
    header = shop.tools.table.horizontalHeader()
    assert header.sectionSize(NAME) > 120
    assert header.length() <= shop.tools.table.viewport().width() + 1
    picture_of(shop, "small")
