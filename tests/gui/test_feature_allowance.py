"""Allowances typed in the window on selected features, with the real engine: kept, undone, refused in words."""

from __future__ import annotations

import pytest
from shared_window import shared_window, taken_back, wait

from kept_parts import ribbed_file
from person import typed
from trunnion import registry
from trunnion.plan.contract import AllowancePlanner
from trunnion_gui.edits import with_choice

WALL, FLOOR = "feature.wall_allowance", "feature.floor_allowance"


@pytest.fixture(scope="module")
def panel(qapp, tmp_path_factory):
    """One window for all tests here, with the features of the part."""
    folder = tmp_path_factory.mktemp("panel")
    with shared_window(folder) as window:
        window.document.files.open(ribbed_file(folder / "ribbed.step"))
        wait(window)
        window.document.edit("panel", with_choice("recognize.family", "panel"))
        window.document.run("recognize", "Recognize")
        wait(window)
        yield window


@pytest.fixture
def recognised(panel):
    with taken_back(panel) as window:
        yield window


def fields(window):
    return window.docks.properties.allowance


def test_an_amount_typed_on_two_pockets_is_one_entry_and_is_undone(recognised, idle):
    window = recognised
    before, ids = window.document.session, ("pocket-01", "pocket-02")
    assert window.document.selection.select_ids(ids)
    assert fields(window).isVisibleTo(window)
    typed(fields(window).form.field(WALL), "0.3")
    idle(window)
    found = window.document.shown.recognition
    assert [found.feature(id).attributes["wall_allowance"] for id in ids] == [0.3, 0.3]
    # The other amount stays as it was.
    typed(fields(window).form.field(FLOOR), "0.2")
    idle(window)
    kept = window.document.feature("pocket-01").attributes
    assert (kept["wall_allowance"], kept["floor_allowance"]) == (0.3, 0.2)
    window.registry.run("edit.undo")
    window.registry.run("edit.undo")
    idle(window)
    assert window.document.session is before
    assert fields(window).form.values()[WALL] == 0.0


def test_an_amount_that_a_feature_can_not_keep_is_refused_in_words(recognised, idle):
    window = recognised
    before = window.document.session
    window.document.selection.select_feature("profile-01")
    typed(fields(window).form.field(FLOOR), "0.3")
    idle(window)
    assert window.document.session is before
    assert "profile-01 has no floor" in window.viewport.notice.text


def test_what_can_not_keep_anything_has_no_such_fields(recognised):
    window = recognised
    window.document.selection.select_feature("datum-01")
    assert not fields(window).isVisibleTo(window)
    window.document.selection.select_feature("rib-01")
    assert fields(window).isVisibleTo(window)


@pytest.mark.parametrize("family", registry.names("views"))
def test_a_view_offers_what_the_planner_of_its_family_can_leave(family):
    planner = registry.get("planners", family)()
    can = planner.allowance_kinds if isinstance(planner, AllowancePlanner) else ()
    assert registry.get("views", family).allowance_kinds == can
