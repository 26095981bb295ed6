"""Operations copied, moved, suppressed and deleted by a person, and what a new route of the same part keeps of it."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flat_parts import operation
from programs import FLAT_16
from trunnion.findings import BadInput, Refused
from trunnion.geometry.frame import WORLD
from trunnion.model.feature import FaceRole, Feature, Recognition
from trunnion.model.process import ProcessTree
from trunnion.model.setup import Setup
from trunnion.plan.manual.manual_operations import with_manual_operations
from trunnion.plan.manual.operation_copy import copy_targets, with_copy, with_copy_on
from trunnion.plan.manual.operation_order import out_of_order, with_operation_before
from trunnion.plan.manual.operation_state import with_own_choices, with_suppressed
from trunnion.toolpath.plane.rough import RoughSettings

SETUPS = tuple(
    Setup(name=name, frame=WORLD, work_offset=offset, clearance=20.0, machine="Mill 1200")
    for name, offset in (("S1", "G54"), ("S2", "G55"))
)


def tree(*rows: tuple[str, str, tuple[str, ...]]) -> ProcessTree:
    """Return a plan of operations, each an id, its setup and what it needs."""
    return ProcessTree(
        plan="by hand",
        material="EN AW-7075",
        setups=SETUPS,
        operations=tuple(
            replace(operation("rough", "pocket-01", FLAT_16), id=id, setup=setup, after=after)
            for id, setup, after in rows
        ),
    )


PLANNED = tree(
    ("rough", "S1", ()),
    ("corner", "S1", ("rough",)),
    ("wall", "S1", ("corner",)),
    ("back", "S2", ()),
)


def ids(process: ProcessTree) -> list[str]:
    return [o.id for o in process.operations]


def test_a_copy_does_the_same_right_behind_and_is_marked():
    copied, name = with_copy(PLANNED, "corner")
    assert (name, ids(copied)) == (
        "corner-copy",
        ["rough", "corner", "corner-copy", "wall", "back"],
    )
    made, original = copied.operation(name), copied.operation("corner")
    assert made == replace(original, id=name, copy_of="corner", by_hand=True)
    assert not original.by_hand


def test_a_copy_of_a_copy_is_one_more_of_the_first_and_cuts_though_that_is_suppressed():
    once, name = with_copy(with_suppressed(PLANNED, "wall", True), "wall")
    twice, second = with_copy(once, name)
    assert (name, second) == ("wall-copy", "wall-copy-2")
    assert twice.operation(second).copy_of == "wall"
    assert [o.suppressed for o in twice.operations if o.id.startswith("wall")] == [
        True,
        False,
        False,
    ]


def test_a_copy_may_go_before_its_original_but_not_before_what_that_needs():
    copied, name = with_copy(PLANNED, "wall")
    assert ids(with_operation_before(copied, name, "wall"))[2:4] == [name, "wall"]
    with pytest.raises(Refused, match="wall-copy must come after corner: move corner first"):
        with_operation_before(copied, name, "corner")


def test_a_deleted_copy_is_forgotten_and_a_deleted_operation_is_not():
    copied, name = with_copy(PLANNED, "wall")
    assert copied.without(name).removed == ()
    assert copied.without(name, "back").removed == ("back",)
    assert with_copy(copied.without(name), "wall")[1] == name


def test_a_moved_operation_is_marked_and_its_data_still_follow_the_plan():
    moved = with_operation_before(PLANNED, "back", None)
    assert moved is PLANNED
    copied, _ = with_copy(PLANNED, "rough")
    moved = with_operation_before(copied, "rough", "corner").operation("rough")
    assert moved.moved and moved.is_manual and not moved.keeps_data


def test_own_settings_are_parsed_and_checked_by_the_strategy():
    group = RoughSettings
    changed = with_own_choices(PLANNED, "rough", {"slot_feed": "0.7"}, group).operation("rough")
    assert changed.choices == {"plane.rough.slot_feed": 0.7}
    assert changed.own_choices == ("plane.rough.slot_feed",) and changed.by_hand
    with pytest.raises(BadInput, match="has no setting depth_of_everything; it has plane.rough"):
        with_own_choices(PLANNED, "rough", {"depth_of_everything": "1"}, group)
    with pytest.raises(BadInput, match="slot_feed"):
        with_own_choices(PLANNED, "rough", {"plane.rough.slot_feed": "fast"}, group)


def faces(*rows: tuple[str, int]) -> tuple[FaceRole, ...]:
    return tuple(FaceRole(role=role, face=face) for role, face in rows)


FOUND = Recognition(
    family="panel",
    features=(
        Feature(id="pocket-01", kind="pocket", faces=faces(("floor", 1), ("wall", 2), ("wall", 3))),
        Feature(id="pocket-02", kind="pocket", faces=faces(("floor", 4), ("wall", 5))),
        Feature(id="rib-01", kind="rib", faces=faces(("top", 6))),
    ),
)


def on(process: ProcessTree, id: str, **values) -> ProcessTree:
    return process.with_operation(replace(process.operation(id), **values))


TWO_POCKETS = tree(
    ("rough-pocket-01", "S1", ()),
    ("rough-pocket-02", "S2", ()),
    ("wall-pocket-01", "S1", ("rough-pocket-01",)),
)
TWO_POCKETS = on(TWO_POCKETS, "rough-pocket-02", feature="pocket-02", direction=(0.0, 1.0, 0.0))
TWO_POCKETS = on(TWO_POCKETS, "wall-pocket-01", faces=(2, 3), kind="wall")


def test_a_copy_on_another_feature_has_its_faces_its_side_and_needs_what_is_done_there():
    copied, name = with_copy_on(TWO_POCKETS, "wall-pocket-01", "pocket-02", FOUND)
    made = copied.operation(name)
    assert (name, made.feature, made.faces) == ("wall-pocket-02-copy", "pocket-02", (5,))
    assert (made.setup, made.direction) == ("S2", (0.0, 1.0, 0.0))
    assert (made.after, made.copy_of) == (("rough-pocket-02",), "wall-pocket-01")
    assert ids(copied) == ["rough-pocket-01", "rough-pocket-02", name, "wall-pocket-01"]
    # Back again it is one more of the first kind; nothing of that is lost in a new route.
    back, second = with_copy_on(copied, name, "pocket-01", FOUND)
    assert (second, back.operation(second).faces) == ("wall-pocket-01-copy", (2, 3))
    assert back.operation(second).after == ("rough-pocket-01",)
    assert ids(with_manual_operations(back, TWO_POCKETS)) == ids(back)


def test_a_copy_goes_to_another_feature_of_the_same_kind_alone():
    assert copy_targets(TWO_POCKETS.operation("wall-pocket-01"), FOUND) == ("pocket-02",)
    for feature in ("rib-01", "pocket-01"):
        with pytest.raises(BadInput, match=r"only to another feature of its kind: pocket-02"):
            with_copy_on(TWO_POCKETS, "wall-pocket-01", feature, FOUND)
    with pytest.raises(BadInput, match="there is no feature boss-01; known: pocket-01"):
        with_copy_on(TWO_POCKETS, "wall-pocket-01", "boss-01", FOUND)


def test_from_where_a_feature_without_operations_is_reached_is_not_guessed():
    alone = TWO_POCKETS.without("rough-pocket-02")
    copied, name = with_copy_on(alone, "wall-pocket-01", "pocket-02", FOUND)
    assert copied.operation(name).after == ()
    tilted = on(alone, "wall-pocket-01", direction=(0.0, 1.0, 0.0))
    with pytest.raises(Refused, match="pocket-02: no operation says from which side"):
        with_copy_on(tilted, "wall-pocket-01", "pocket-02", FOUND)


def test_a_new_route_keeps_copies_and_places():
    copied, name = with_copy(PLANNED, "wall")
    edited = with_operation_before(copied, name, "wall")
    kept = with_manual_operations(edited, PLANNED)
    assert ids(kept) == ids(edited)
    assert kept.operation(name).moved and kept.findings == ()


def test_two_that_need_each_other_are_both_moved_again():
    made = tree(("a", "S1", ()), ("b", "S1", ("a",)), ("c", "S1", ()))
    edited = with_operation_before(made, "b", None)
    edited = with_operation_before(edited, "a", "b")
    assert ids(edited) == ["c", "a", "b"] == ids(with_manual_operations(edited, made))


def test_a_place_that_the_new_route_forbids_is_told_and_left():
    made = tree(("a", "S1", ()), ("b", "S1", ()))
    edited = with_operation_before(made, "b", "a")
    needs = tree(("a", "S1", ()), ("b", "S1", ("a",)))
    kept = with_manual_operations(edited, needs)
    (told,) = kept.findings
    assert ids(kept) == ["a", "b"]
    assert (told.code, told.where) == ("route.order-by-hand", ("b",))


def test_what_the_new_route_has_no_place_for_is_named():
    copied, name = with_copy(PLANNED, "corner")
    without = tree(("rough", "S1", ()), ("wall", "S1", ("rough",)), ("back", "S2", ()))
    kept = with_manual_operations(copied, without)
    (told,) = kept.findings
    assert ids(kept) == ["rough", "wall", "back"]
    assert (told.code, told.where) == ("route.by-hand-lost", (name,))


def test_a_changed_operation_needs_only_what_there_is():
    changed = with_suppressed(PLANNED, "wall", True)
    kept = with_manual_operations(changed, tree(("rough", "S1", ()), ("wall", "S1", ("rough",))))
    assert kept.operation("wall").after == ()


NAMES = [f"op-{n}" for n in range(7)]


@st.composite
def routes(draw):
    """Return a plan of some of seven operations in two setups; each may need any before it."""
    names = draw(st.permutations(NAMES))[: draw(st.integers(1, len(NAMES)))]
    rows = []
    for n, name in enumerate(names):
        needed = draw(st.sets(st.sampled_from(names[:n]), max_size=2)) if n else set()
        rows.append((name, draw(st.sampled_from(["S1", "S1", "S2"])), tuple(sorted(needed))))
    return tree(*rows)


@st.composite
def edited(draw):
    """Return a plan, and the same after a person's copies, moves, suppressions and deletions."""
    made = draw(routes())
    process = made
    for _ in range(draw(st.integers(0, 8))):
        if not process.operations:
            break
        id = draw(st.sampled_from(ids(process)))
        act = draw(st.sampled_from(["copy", "move", "move", "suppress", "delete"]))
        if act == "copy":
            process, _ = with_copy(process, id)
        elif act == "suppress":
            process = with_suppressed(process, id, not process.operation(id).suppressed)
        elif act == "delete":
            process = process.without(id)
        else:
            mine = [o.id for o in process.of_setup(process.operation(id).setup)]
            try:
                process = with_operation_before(process, id, draw(st.sampled_from([*mine, None])))
            except Refused:
                continue
    return made, process


def state(process: ProcessTree, setup: Setup) -> list[tuple]:
    """Return what a person may have changed of the operations of a setup, in their order."""
    return [
        (o.id, o.after, o.copy_of, o.moved, o.by_hand, o.suppressed)
        for o in process.operations
        if o.setup == setup.name
    ]


@given(edited())
@settings(max_examples=200, deadline=None)
def test_the_same_route_made_again_is_what_a_person_left(plans):
    made, process = plans
    kept = with_manual_operations(process, made)
    for setup in SETUPS:
        assert state(kept, setup) == state(process, setup)
    assert (kept.removed, kept.findings) == (process.removed, ())


@given(edited(), routes())
@settings(max_examples=200, deadline=None)
def test_any_other_route_keeps_what_it_can_and_names_the_rest(plans, other):
    _, process = plans
    kept = with_manual_operations(process, other)
    planned, there = set(ids(other)), set(ids(kept))
    assert len(ids(kept)) == len(there)
    assert planned - set(process.removed) == {o.id for o in kept.operations if not o.copy_of}
    assert all(there.issuperset(o.after) for o in kept.operations)
    lost = {id for f in kept.findings if f.code == "route.by-hand-lost" for id in f.where}
    for o in process.operations:
        assert not o.is_manual or (o.id in there) != (o.id in lost)
    # Where the other route and what a person changed agree on what needs what, nothing comes too early.
    if all(o.after == other.operation(o.id).after for o in process.operations if o.id in planned):
        assert not [p for p in out_of_order(kept.operations) if kept.operation(p[0]).copy_of == ""]


def test_a_cutter_by_hand_gets_a_number_of_its_own_in_a_new_route():
    other = replace(FLAT_16, number=1, name="flat 12", diameter=12.0)
    by_hand = replace(PLANNED.operation("wall"), tool=other, by_hand=True)
    routed = with_manual_operations(PLANNED.with_operation(by_hand), PLANNED)
    numbers = {o.tool.name: o.tool.number for o in routed.operations}
    assert numbers == {FLAT_16.name: 1, "flat 12": 2}


def test_an_operation_changed_by_hand_is_on_the_faces_of_the_new_route_but_for_those_a_person_chose():
    planned = PLANNED.with_operation(replace(PLANNED.operation("wall"), faces=(4, 5, 6)))
    before = replace(PLANNED.operation("wall"), faces=(4, 5), by_hand=True)
    for own_faces, faces in ((False, (4, 5, 6)), (True, (4, 5))):
        changed = PLANNED.with_operation(replace(before, own_faces=own_faces))
        assert with_manual_operations(changed, planned).operation("wall").faces == faces
