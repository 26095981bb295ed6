"""The Optimize panel: the highest load before and after the proof, and what passes the limit."""

from __future__ import annotations

from dataclasses import replace

import pytest

from trunnion_gui import i18n

PLACE = "the cutter enters at full width"


@pytest.fixture
def shown(window, part_file, idle):
    """Return a function that shows a peak (kW) of one operation, with what the proof measured of it (kW), in a programmed part's panel."""
    window.document.files.open(part_file)
    idle(window)
    window.document.program()
    idle(window)

    def show(peak, measured=None, state="done"):
        document, panel = window.document, window.panels["optimize"]
        session = document.shown
        first, *others = session.process.operations
        first = replace(
            first,
            data=replace(first.data, power=9.8, power_limit=28.0, peak_power=peak, peak_at=PLACE),
        )
        proofs = tuple(
            replace(p, power=measured if measured and p.operation == first.id else 0.1)
            for p in session.verdict.operations
        )
        document.shown = replace(
            session,
            process=replace(session.process, operations=(first, *others)),
            verdict=replace(session.verdict, operations=proofs) if measured else None,
        )
        document.states = {**document.states, "verify": state}
        panel.fill()
        return panel

    return show


def test_before_the_proof_the_highest_load_is_the_peak_and_where_it_is(shown):
    panel = shown(19.8)
    id = panel.table.item(0, 0).text()
    assert panel.result.text() == f"highest load: {id}, 19.8 of 28 kW where {PLACE} (9.8 kW steady)"
    assert panel.table.item(0, 3).text() == "70.7 %"


def test_after_the_proof_it_is_what_that_measured(shown):
    panel = shown(15.0, measured=19.8)
    assert (
        panel.result.text()
        == f"highest load: {panel.table.item(0, 0).text()}, 19.8 of 28 kW as the proof measured (9.8 kW steady)"
    )


def test_a_proof_of_an_earlier_plan_counts_no_more(shown):
    assert " 15 of 28 kW where " in shown(15.0, measured=19.8, state="stale").result.text()


def test_more_than_the_limit_has_the_colour_of_what_is_wrong(shown):
    panel = shown(30.8)
    assert panel.result.text().startswith("overload: highest load: ")
    bad = panel.theme.bad.lower()
    assert panel.table.item(0, 3).foreground().color().name() == bad
    assert panel.table.item(1, 3).foreground().color().name() != bad
    assert "30.8 of 28 kW" in panel.table.item(0, 3).toolTip()


def test_where_strategies_meet_most_is_translated():
    from trunnion.toolpath.motion.load import engagement
    from trunnion.toolpath.plane import face

    i18n.use("zh_CN")
    try:
        for words in (
            engagement.FULL_WIDTH,
            engagement.INNER_CORNER,
            engagement.LEFTOVERS,
            face.ONE_ROW,
        ):
            assert i18n.tr(words) != words
    finally:
        i18n.use("en")
