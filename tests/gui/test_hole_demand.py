"""Fits and threads typed in the window on selected holes, with the real engine: planned, undone, refused in words."""

from __future__ import annotations

import pytest
from shared_window import shared_window, taken_back, wait

from holed import hole, plate
from person import typed
from trunnion_gui.docks.hole_demand import DEPTH, FIT, THREAD
from trunnion_gui.edits import with_choice

HOLES = (hole(20, 15, 10), hole(80, 15, 10), hole(50, 40, 6.8, 16.0, point_angle=140.0))


@pytest.fixture(scope="module")
def panel(qapp, tmp_path_factory):
    """One window for all tests here, with the features of the part."""
    folder = tmp_path_factory.mktemp("panel")
    with shared_window(folder) as window:
        window.document.files.open(plate(folder / "plate.step", *HOLES))
        wait(window)
        window.document.edit("panel", with_choice("recognize.family", "panel"))
        window.document.run("recognize", "Recognize")
        wait(window)
        yield window


@pytest.fixture
def recognised(panel):
    with taken_back(panel) as window:
        yield window


def holes(window, diameter):
    return [f.id for f in window.document.shown.recognition if f.sizes.get("diameter") == diameter]


def fields(window):
    return window.docks.properties.demand


def test_a_fit_typed_on_two_holes_is_one_entry_and_is_undone(recognised, idle):
    window, ids = recognised, holes(recognised, 10.0)
    before = window.document.session
    assert window.document.selection.select_ids(ids)
    assert fields(window).isVisibleTo(window)
    typed(fields(window).form.field(FIT), "H7")
    idle(window)
    found = window.document.shown.recognition
    assert [found.feature(id).attributes["fit"] for id in ids] == ["H7", "H7"]
    assert fields(window).form.values()[FIT] == "H7"
    assert [window.docks.features.item(id).text(2) for id in ids] == ["10 mm H7"] * 2
    window.registry.run("edit.undo")
    idle(window)
    assert window.document.session is before
    assert fields(window).form.values()[FIT] == ""


def test_a_thread_takes_the_place_of_a_fit_and_is_planned(recognised, idle):
    window, (id,) = recognised, holes(recognised, 6.8)
    window.document.selection.select_feature(id)
    typed(fields(window).form.field(FIT), "H7")
    idle(window)
    typed(fields(window).form.field(THREAD), "M8")
    idle(window)
    typed(fields(window).form.field(DEPTH), "10")
    idle(window)
    feature = window.document.feature(id)
    assert "fit" not in feature.attributes and feature.attributes["thread"] == "M8"
    assert feature.sizes["thread_depth"] == 10.0
    window.document.run("route", "Route")
    idle(window, timeout=120000)
    taps = [o for o in window.document.shown.process.operations if o.kind == "tap"]
    assert [o.feature for o in taps] == [id]


def test_a_thread_that_does_not_fit_is_refused_in_words_and_nothing_changes(recognised, idle):
    window, (id,) = recognised, holes(recognised, 6.8)
    before = window.document.session
    window.document.selection.select_feature(id)
    typed(fields(window).form.field(THREAD), "M6")
    idle(window)
    assert window.document.session is before
    assert "M6 needs a bore of" in window.viewport.notice.text


def test_what_is_no_hole_has_no_such_fields(recognised):
    window = recognised
    other = next(f.id for f in window.document.shown.recognition if f.kind != "hole")
    window.document.selection.select_feature(other)
    assert not fields(window).isVisibleTo(window)
    window.document.selection.select_feature(holes(window, 6.8)[0])
    assert fields(window).isVisibleTo(window)
