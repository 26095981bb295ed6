"""What a reply's session has in common with the request's is not sent, and is the same object in the window."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from trunnion.model.session import Session, SizeEntry
from trunnion_gui.worker.session_changes import SharedSession
from trunnion_gui.worker.shared_memory import packed, unpacked


def entry(name):
    return SizeEntry(name=name, value=1.0, unit="mm", feature="pocket-01")


@pytest.fixture
def known():
    return Session(sizes=(entry("a"), entry("b")), choices={"fake.blank.side": 8.0})


def arrived(known, *sent):
    """Return what comes of sessions that are sent one after the other as replies to a request with a known one: made of a copy of it."""
    theirs, ours = unpacked(packed(known)), SharedSession(known)
    worker = SharedSession(theirs)
    return [unpacked(packed(make(theirs), worker, 7), ours) for make in sent]


def test_what_was_not_changed_is_the_windows_own(known):
    (found,) = arrived(known, lambda s: replace(s, choices={}))
    assert found.sizes is known.sizes
    assert found.choices == {}


def test_items_that_stay_are_the_windows_own(known):
    (found,) = arrived(known, lambda s: replace(s, sizes=(s.sizes[1], entry("c"), s.sizes[0])))
    assert found.sizes[0] is known.sizes[1] and found.sizes[2] is known.sizes[0]
    assert found.sizes[1] == entry("c")


def test_a_reply_follows_the_one_before(known):
    new = (entry("c"),)
    first, second = arrived(
        known, lambda s: replace(s, sizes=new), lambda s: replace(s, sizes=new, choices={})
    )
    assert first.sizes == new and second.sizes is first.sizes
    assert first.choices is known.choices


def test_what_is_taken_away_is_not_taken_for_known(known):
    (found,) = arrived(known, lambda s: Session())
    assert found.sizes == () and found.choices == {} and found.recognition is None


def test_large_arrays_of_a_reduced_session_arrive(known):
    values = np.arange(100_000, dtype=float)
    (found,) = arrived(known, lambda s: replace(s, choices={"x": values}))
    assert np.array_equal(found.choices["x"], values)


def test_a_message_without_the_session_that_it_needs_is_refused(known):
    theirs = unpacked(packed(known))
    message = packed(theirs, SharedSession(theirs))
    with pytest.raises(ValueError, match="sent as known"):
        unpacked(message)


def test_a_run_leaves_results_of_earlier_steps_as_they_are(opened, idle):
    seen, drawn = {}, []
    draw = opened.viewport.scene.show_setups
    opened.viewport.scene.show_setups = lambda setups: (drawn.append(setups), draw(setups))
    opened.document.run("blank", "Create")
    idle(opened)
    before = opened.document.session
    opened.document.changed.connect(
        lambda: seen.update({id(opened.document.shown): opened.document.shown})
    )
    opened.document.program()
    idle(opened)
    assert len(seen) > 3
    assert all(s.recognition is before.recognition for s in seen.values())
    assert all(s.blank is before.blank for s in seen.values())
    assert len([setups for setups in drawn if setups]) == 1
