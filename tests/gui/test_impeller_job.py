"""An impeller from its file to proven programs in the real window, by real clicks: by one, by the six panels, and with the operations'
cutters, speeds and feeds typed by hand."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from PySide6.QtWidgets import QPushButton

from person import Person, wait_for_job
from seeded.impellers import impeller
from trunnion_gui.docks.properties import data_choices

pytestmark = [pytest.mark.long, pytest.mark.timeout(3600)]
STEPS = ("recognize", "size", "blank", "route", "optimize", "verify")
LONGEST_S = 1800.0


@pytest.fixture
def begins(make_window, tmp_path, monkeypatch):
    """A person in front of a window in which he has opened a random wheel with root fillets, or that of a file."""

    def begin():
        file = os.environ.get("TRUNNION_WHEEL")
        part = Path(file) if file else impeller(0, rounded=True).written(tmp_path)
        window = make_window("trunnion.pipeline:Engine")
        person = Person(window)
        person.rests()
        monkeypatch.setattr(window.dialogs, "open_path", person.chooses(part))
        person.clicks(window.toolbar.widgetForAction(window.registry.action("file.open")))
        wait_for_job(window, 240.0)
        return person

    return begin


def panel_button(window, step):
    """Return the button of a step in its panel, which is unfolded."""
    name = "generate" if step == "verify" else step
    panel = window.panels[name]
    panel.fold(False)
    return next(
        b for b in panel.findChildren(QPushButton) if b.property("command") == f"step.{step}"
    )


def assert_proven(window):
    assert window.status.verdict.text().startswith("verdict: passed")
    verdict = window.document.session.verdict
    assert verdict.gouge <= 0.02 and not verdict.collisions


def test_one_click_programs_an_impeller(begins):
    person = begins()
    window, opened = person.window, person.interactions
    person.clicks(window.toolbar.widgetForAction(window.registry.action("run.program")))
    wait_for_job(window, LONGEST_S)
    assert_proven(window)
    assert person.interactions - opened == 1
    print(
        f"one click: {person.interactions - opened} interactions, {person.seconds:.0f} s of a person with opening"
    )


def test_the_six_panels_program_an_impeller_and_by_hand_it_takes_more_than_twice_as_long(
    begins, idle
):
    person = begins()
    window, opened = person.window, person.interactions
    for step in STEPS:
        person.clicks(panel_button(window, step))
        wait_for_job(window, LONGEST_S)
    assert_proven(window)
    assert person.interactions - opened <= 6
    panels = person.interactions, person.seconds
    operations = [o for o in window.document.session.process.operations if not o.suppressed]
    tree = window.docks.process.tree
    for operation in operations:
        item = window.docks.process.item(operation.id)
        tree.scrollToItem(item)
        person.clicks(tree.viewport(), tree.visualItemRect(item).center())
        values = data_choices(operation)
        for key, words in (
            ("operation.tool", str(values["operation.tool"])),
            ("operation.spindle", f"{0.9 * values['operation.spindle']:.0f}"),
            ("operation.feed", f"{0.9 * values['operation.feed']:.0f}"),
        ):
            person.types(window.docks.properties.data_form.field(key), words)
            idle(window)
        assert window.document.operation(operation.id).by_hand
    print(
        f"six panels: {panels[0] - opened} interactions, {panels[1]:.0f} s of a person with opening"
    )
    print(
        f"by hand: {person.interactions - opened} interactions, {person.seconds:.0f} s, {len(operations)} operations"
    )
    assert person.seconds > 2.0 * panels[1]
