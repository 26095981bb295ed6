"""The settings in the panels: made as they are unfolded, and then like any other."""

from __future__ import annotations

import gc
import time

import pytest
from fake_engine import BlankSettings, RoughSettings
from PySide6.QtCore import Qt, QTimer
from PySide6.QtTest import QTest

from trunnion.settings import declared
from trunnion_gui.form import Form
from trunnion_gui.widgets.foldout import Foldout
from trunnion_gui.worker.requests import OPERATION, SettingsGroup
from trunnion_gui.worker.steps import STEPS

GROUPS_OF_A_STEP = 15


@pytest.fixture
def many_groups():
    """Settings of all steps, as many as the program has: every step has fifteen groups, of six lines each."""
    lines = (*declared(BlankSettings), *declared(RoughSettings))
    groups = tuple(
        SettingsGroup(f"group.{n}", f"Group {n}", lines) for n in range(GROUPS_OF_A_STEP)
    )
    return dict.fromkeys(STEPS, groups) | {OPERATION: groups[:1]}


def group_foldouts(panel):
    return [f for f in panel.body.findChildren(Foldout) if f.objectName() == "settingsGroup"]


def longest_stretch(work) -> float:
    """Return how long the thread works at a stretch, s of its own time, while `work` is done and all that it leaves for later events."""
    stretches, last = [], time.thread_time()

    def look():
        nonlocal last
        stretches.append(time.thread_time() - last)
        last = time.thread_time()

    beat = QTimer()
    beat.timeout.connect(look)
    beat.start(0)
    work()
    look()
    QTest.qWait(200)
    beat.stop()
    return max(stretches)


def test_forms_are_not_all_made_at_a_stretch_when_the_settings_arrive(window, many_groups, tidy):
    # Garbage of other tests is not what is measured.
    gc.collect()
    tidy._timer.stop()
    longest = longest_stretch(lambda: window.document._take_groups(many_groups))
    began = time.thread_time()
    forms = [Form(g.settings) for step in STEPS for g in many_groups[step]]
    all_forms = time.thread_time() - began
    assert len(forms) == len(STEPS) * GROUPS_OF_A_STEP
    assert longest < 0.3 * all_forms


def test_a_folded_panel_has_its_settings_when_it_is_unfolded(window, many_groups):
    window.document._take_groups(many_groups)
    panel = window.panels["size"]
    assert not group_foldouts(panel) and not panel.body.findChildren(Form)
    QTest.mouseClick(panel.header, Qt.MouseButton.LeftButton)
    (whole,) = group_foldouts(panel)
    QTest.mouseClick(whole.header, Qt.MouseButton.LeftButton)
    assert len(group_foldouts(panel)) == 1 + GROUPS_OF_A_STEP
    assert not panel.body.findChildren(Form)
    QTest.mouseClick(panel.settings.group("group.3").header, Qt.MouseButton.LeftButton)
    (form,) = panel.body.findChildren(Form)
    assert form.isVisible() and form.values()["fake.blank.side"] == 5.0


def test_a_group_folded_and_unfolded_again_keeps_its_form(window):
    panel = window.panels["route"]
    panel.fold(False)
    before = list(panel.forms)
    for foldout in (*group_foldouts(panel), panel):
        foldout.fold(True)
        foldout.fold(False)
    assert panel.body.findChildren(Form) == before


def test_a_form_that_is_made_late_shows_what_was_chosen_before(opened, idle):
    opened.document.choose("fake.blank.side", "Allowance", 8.0)
    idle(opened)
    panel = opened.panels["blank"]
    assert not panel.body.findChildren(Form)
    panel.fold(False)
    (form,) = panel.body.findChildren(Form)
    assert form.field("fake.blank.side").value() == 8.0
    opened.document.undo()
    assert form.field("fake.blank.side").value() == 5.0


def test_forms_are_given_in_the_order_of_the_groups(window, many_groups):
    window.document._take_groups(many_groups)
    panel = window.panels["size"]
    panel.fold(False)
    group_foldouts(panel)[0].fold(False)
    panel.settings.group("group.7").fold(False)
    unfolded = panel.body.findChildren(Form)
    assert [n for n, form in enumerate(panel.forms) if form in unfolded] == [7]
    assert len(panel.forms) == GROUPS_OF_A_STEP


def test_the_tab_key_goes_through_a_panel_from_top_to_bottom(window, many_groups):
    window.document._take_groups(many_groups)
    panel = window.panels["size"]
    panel.fold(False)
    whole = group_foldouts(panel)[0]
    whole.fold(False)
    panel.settings.group("group.1").fold(False)
    (form,) = panel.body.findChildren(Form)
    wanted = [
        panel.header,
        whole.header,
        panel.settings.group("group.0").header,
        panel.settings.group("group.1").header,
        *form.fields(),
        *(panel.settings.group(f"group.{n}").header for n in range(2, GROUPS_OF_A_STEP)),
        panel._main[0],
    ]
    # A disabled button is passed over; that there is no part yet is not what is looked at here.
    panel._main[0].setEnabled(True)
    panel.header.setFocus()
    reached = [panel.header]
    for _ in wanted[1:]:
        QTest.keyClick(window.focusWidget(), Qt.Key.Key_Tab)
        reached.append(window.focusWidget())
    assert reached == wanted
