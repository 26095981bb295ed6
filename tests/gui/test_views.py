"""What a family brings to the window: the window takes up a view that lives in a package of its own."""

from __future__ import annotations

import importlib
import sys

import pytest
from PySide6.QtCore import Qt

from trunnion import registry

RIBS = """
from trunnion_gui.actions import Command
from trunnion_gui.families.contract import Colouring, Column, Dock, FamilyView, FeatureClass
from PySide6.QtWidgets import QLabel


def count(engine, progress, tell, session, word):
    return f"{word} {len(session.recognition.of_kind('rib'))}"


class RibView(FamilyView):
    kinds = ("rib",)

    def __init__(self, document):
        super().__init__(document)
        self.clicked, self.answer, self.label, self.block = [], "", QLabel("ribs"), QLabel("strength")

    def owns(self, group):
        return group == "fake.rough"

    def columns(self):
        return (Column(title="Stiff", tip="", is_ticked=lambda f: f.id == "rib-01", click=lambda f: self.clicked.append(f.id)),
                Column(title="Faces twice", tip="", words=lambda f: str(2 * len(f.tags))))

    def classes(self, kind, features):
        return (FeatureClass("thin", "Thin ribs", "#123456", tuple(features)),)

    def remark(self, found):
        return ", all thin"

    def add_face_entries(self, menu, tags):
        menu.addAction("Stiffen")

    def add_feature_entries(self, menu, feature):
        menu.addAction(f"Stiffen {feature.id}")

    def add_commands(self, shell):
        shell.registry.add(Command(id="rib.count", text="Count ribs", menu="Ribs", run=self.ask))
        red = Colouring(lambda found: dict.fromkeys((t for f in found for t in f.tags), "#ff0000"), lambda: [("#ff0000", "Red", "")])
        shell.registry.add(Command(id="rib.red", text="Red", menu="Ribs", checkable=True,
                                   run=lambda on: shell.viewport.colour_by(red if on else None)))

    def ask(self):
        self.document.request(count, "counting", "ribs:", finish=lambda answer: setattr(self, "answer", answer))

    def blocks(self):
        return {"size": self.block}

    def docks(self):
        return (Dock("ribs", "Ribs", self.label),)
"""


def test_every_view_has_a_family():
    assert set(registry.names("views")) <= set(registry.names("families"))


@pytest.fixture
def ribs(tmp_path, monkeypatch):
    """A package that brings a view of ribs, installed beside the project."""
    home = tmp_path / "site"
    (home / "ribs-1.0.dist-info").mkdir(parents=True)
    (home / "ribs-1.0.dist-info" / "METADATA").write_text(
        "Metadata-Version: 2.1\nName: ribs\nVersion: 1.0\n"
    )
    (home / "ribs-1.0.dist-info" / "entry_points.txt").write_text(
        "[trunnion.views]\nribs = view_of_ribs:RibView\n"
    )
    (home / "view_of_ribs.py").write_text(RIBS)
    monkeypatch.syspath_prepend(str(home))
    forget()
    yield
    forget()
    sys.modules.pop("view_of_ribs", None)


def forget() -> None:
    """Let the registry look for packages anew."""
    importlib.invalidate_caches()
    registry._points.cache_clear()
    registry.get.cache_clear()


@pytest.fixture
def recognized(ribs, make_window, part_file, idle):
    """A window with that view, over the made-up plate and its two ribs."""
    window = make_window()
    window.document.files.open(part_file)
    idle(window)
    window.document.run("recognize", "Recognize")
    idle(window)
    return window


def test_a_view_of_another_package_fills_table_legend_and_words(recognized):
    tree, row = recognized.docks.features.tree, recognized.docks.features.item("rib-01")
    titles = [tree.headerItem().text(n) for n in range(tree.columnCount())]
    stiff, twice = titles.index("Stiff"), titles.index("Faces twice")
    assert not tree.isColumnHidden(stiff) and tree.isColumnHidden(titles.index("Local"))
    assert row.checkState(stiff) is Qt.CheckState.Checked and row.text(twice) == "2"
    assert recognized.docks.features.item("pocket-01").text(twice) == ""
    assert row.parent().text(0) == "Thin ribs · 2"
    assert ("#123456", "Thin ribs", "2") in recognized.viewport.legend.rows
    assert recognized.panels["recognize"].result.text().endswith(", all thin")


def test_a_click_in_a_views_column_is_the_views(recognized):
    tree = recognized.docks.features.tree
    stiff = next(n for n in range(tree.columnCount()) if tree.headerItem().text(n) == "Stiff")
    for id in ("rib-02", "pocket-01"):
        tree.itemClicked.emit(recognized.docks.features.item(id), stiff)
    assert recognized.views["ribs"].clicked == ["rib-02"]


def test_a_view_brings_menus_docks_and_blocks(recognized):
    document = recognized.document
    assert [a.text() for a in recognized.views.face_menu(recognized, (1,)).actions()].count(
        "Stiffen"
    ) == 1
    assert (
        recognized.docks.features.menu(document.feature("rib-01")).actions()[0].text()
        == "Stiffen rib-01"
    )
    assert (
        recognized.docks.features.menu(document.feature("pocket-01")).actions()[0].text()
        == "Change kind"
    )
    menus = [a.text() for a in recognized.menuBar().actions()]
    assert menus.index("Steps") < menus.index("Ribs") < menus.index("Playback")
    assert recognized.arrangement.dock("ribs").widget() is recognized.views["ribs"].label
    assert recognized.panels["size"].isAncestorOf(recognized.views["ribs"].block)


def test_a_view_colours_the_part_and_says_what_that_means(recognized):
    recognized.registry.run("rib.red")
    assert recognized.viewport.legend.rows == (("#ff0000", "Red", ""),)
    recognized.registry.run("rib.red")
    assert ("#ff0000", "Red", "") not in recognized.viewport.legend.rows


def test_the_worker_does_a_views_own_work(recognized, idle):
    recognized.registry.run("rib.count")
    idle(recognized)
    assert recognized.views["ribs"].answer == "ribs: 2"


def test_settings_that_a_view_owns_go_with_its_features(recognized):
    views, found = recognized.views, recognized.document.shown.recognition
    assert views.offers("fake.rough", found)
    for id in ("rib-01", "rib-02"):
        found = found.without(id)
    assert not views.offers("fake.rough", found)
    assert views.offers("fake.blank", found) and views.offers("fake.rough", None)
