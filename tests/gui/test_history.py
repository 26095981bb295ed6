"""The history of edits, without a window."""

from __future__ import annotations

from dataclasses import replace

import pytest
from fake_engine import FakeEngine

from trunnion.findings import Refused
from trunnion.model.session import Session
from trunnion_gui import edits
from trunnion_gui.edits import History


@pytest.fixture(scope="module")
def programmed(tmp_path_factory):
    path = tmp_path_factory.mktemp("part") / "tray.step"
    path.write_text("a made-up part")
    engine = FakeEngine()
    return engine.run(engine.open(path))


def test_undo_brings_back_the_very_session_that_was_there():
    first, second = Session(), Session(choices={"a.b": 1})
    history = History(first)
    history.push("choose b", second)
    assert history.undo_label == "choose b"
    assert history.undo() is first
    assert history.redo() is second


def test_a_new_edit_forgets_what_could_be_redone():
    history = History(Session())
    history.push("one", Session())
    history.undo()
    history.push("two", Session())
    assert history.redo_label == ""


def test_edits_of_one_gesture_are_one_entry():
    first = Session()
    history = History(first)
    for value in (1, 2, 3):
        history.push(f"stepover {value}", Session(choices={"s": value}), gesture="visit 7")
    history.push("stepover 9", Session(choices={"s": 9}), gesture="visit 8")
    assert history.undo().choices == {"s": 3}
    assert history.undo() is first


def test_an_edit_that_changes_nothing_is_no_entry():
    history = History(Session(choices={"a.b": 2}))
    history.push("again", edits.with_choice("a.b", 2)(history.session))
    assert history.undo_label == ""


def test_a_session_is_dirty_until_it_is_saved():
    history = History(Session())
    history.push("one", Session())
    assert history.is_dirty
    history.mark_saved(history.session)
    assert not history.is_dirty


def test_faces_of_a_deleted_feature_become_unexplained(programmed):
    gone = programmed.recognition.feature("rib-01")
    after = edits.without_feature("rib-01")(programmed)
    assert set(gone.tags) <= set(after.recognition.unexplained)
    assert all(f.id != "rib-01" for f in after.recognition)
    assert after.recognition.removed == (gone.tags,)


def test_a_changed_kind_is_marked_as_a_persons(programmed):
    changed = edits.with_kind("rib-01", "island")(programmed).recognition.feature("rib-01")
    assert (changed.kind, changed.by_hand) == ("island", True)


def test_a_deleted_operation_holds_nothing_up_any_more(programmed):
    after = edits.without_operation("op-01")(programmed)
    assert all("op-01" not in o.after for o in after.process.operations)
    assert after.process.removed == ("op-01",)


def test_a_deletion_is_undone_as_if_it_had_never_been(programmed):
    history = History(programmed)
    history.push("delete", edits.without_feature("rib-01")(programmed))
    history.push("delete", edits.without_operation("op-01")(history.session))
    assert history.undo().process.removed == ()
    assert history.undo() is programmed


def test_an_operation_moves_in_front_of_another_and_is_marked(programmed):
    after = edits.with_operation_before("op-06", "op-04")(programmed)
    assert [o.id for o in after.process.operations] == [
        "op-01",
        "op-02",
        "op-03",
        "op-06",
        "op-04",
        "op-05",
        "op-07",
    ]
    assert after.process.operation("op-06").moved


def test_finishing_before_roughing_is_refused_in_words(programmed):
    with pytest.raises(Refused, match="op-03 must come after op-02"):
        edits.with_operation_before("op-03", "op-02")(programmed)


def test_an_edit_of_features_needs_features():
    with pytest.raises(Refused, match="recognize the part first"):
        edits.without_feature("pocket-01")(Session())


def test_a_suppressed_operation_stays_in_the_tree(programmed):
    after = edits.with_suppressed("op-02", True)(programmed)
    assert len(after.process.operations) == len(programmed.process.operations)
    assert "op-02" not in [o.id for o in after.process.of_setup("S1")]


def test_choices_go_back_to_their_defaults(programmed):
    chosen = replace(programmed, choices={"a.x": 1, "a.y": 2})
    assert edits.without_choices("a.x")(chosen).choices == {"a.y": 2}
