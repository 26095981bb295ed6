"""Forms: any declared settings to widgets and back."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QFileDialog, QToolButton

from trunnion.pipeline import Engine
from trunnion.settings import declared
from trunnion_gui.form import Form, read, show

GROUPS = sorted({c.GROUP: c for classes in Engine().settings().values() for c in classes}.items())


@pytest.mark.parametrize("group", [c for _, c in GROUPS], ids=[name for name, _ in GROUPS])
def test_a_form_of_every_group_shows_defaults_and_reads_them_back(qtbot, group):
    form = Form(declared(group))
    qtbot.addWidget(form)
    assert form.values() == {d.key: d.default for d in declared(group)}


@pytest.mark.parametrize("group", [c for _, c in GROUPS], ids=[name for name, _ in GROUPS])
def test_a_form_of_every_group_gives_values_that_are_allowed(qtbot, group):
    form = Form(declared(group))
    qtbot.addWidget(form)
    for d in declared(group):
        other = (
            d.choices[-1]
            if d.choices
            else d.high
            if d.high is not None
            else not d.default
            if d.kind is bool
            else d.default
        )
        show(form.field(d.key), other)
        assert d.parse(read(form.field(d.key))) == other


def test_typing_a_number_tells_once_with_the_full_key(qtbot):
    group = next(c for _, c in GROUPS if any(d.kind is float for d in declared(c)))
    setting = next(d for d in declared(group) if d.kind is float)
    form = Form(declared(group))
    qtbot.addWidget(form)
    form.show()
    told = []
    form.changed.connect(lambda key, value, gesture: told.append((key, value)))
    field = form.field(setting.key)
    field.setFocus()
    field.selectAll()
    wanted = setting.low if setting.low != setting.default else setting.high
    QTest.keyClicks(field, f"{wanted:g}")
    QTest.keyClick(field, Qt.Key.Key_Return)
    assert told == [(setting.key, pytest.approx(wanted))]


def test_every_field_says_what_it_does(qtbot):
    for _, group in GROUPS:
        form = Form(declared(group))
        qtbot.addWidget(form)
        assert all(
            d.help in form.field(d.key).toolTip() and d.key in form.field(d.key).toolTip()
            for d in declared(group)
        )


def test_a_file_is_chosen_by_a_button_in_its_line(qtbot, monkeypatch, tmp_path):
    setting = next(d for _, group in GROUPS for d in declared(group) if d.key == "blank.file")
    form = Form((setting,))
    qtbot.addWidget(form)
    form.show()
    asked, told = [], []
    form.changed.connect(lambda key, value, gesture: told.append((key, value)))
    chosen = str(tmp_path / "casting.stl")

    def dialog(parent, title, start, kinds):
        asked.append(kinds)
        return (chosen if len(asked) == 1 else "", "")

    monkeypatch.setattr(QFileDialog, "getOpenFileName", dialog)
    field = form.field(setting.key)
    button = next(b for b in field.findChildren(QToolButton) if b.toolTip() == "Choose a file")
    QTest.mouseClick(button, Qt.MouseButton.LeftButton)
    assert told == [("blank.file", chosen)] and read(field) == chosen
    assert all(ending in asked[0] for ending in setting.files)
    QTest.mouseClick(button, Qt.MouseButton.LeftButton)
    assert read(field) == chosen and len(told) == 1
