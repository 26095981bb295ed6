"""What a finished process teaches, and when a taught cutter fits another part."""

from __future__ import annotations

from dataclasses import replace

import pytest

from flat_parts import operation
from own_shop import own_shop
from taught_plans import RING, stage
from trunnion.geometry.frame import WORLD
from trunnion.model.feature import Feature, Recognition
from trunnion.model.process import ProcessTree
from trunnion.model.setup import Setup
from trunnion.plan.cutting.milling import CuttingSettings, cutting_data
from trunnion.plan.library.follow import followed, refusal
from trunnion.plan.library.teach import taught_plan
from trunnion.plan.manual.operation_change import OperationChange, with_change
from trunnion.settings import choose
from trunnion.shop import TypicalPlan
from trunnion_gui import edits

SHOP = own_shop()
MATERIAL, MACHINE = SHOP.material("EN AW-7075"), SHOP.machine("Mill 1200")
LIMITS = choose(CuttingSettings, {})
D8, D10, D12, D16 = (f"AL3-stub D{d} R0" for d in (8, 10, 12, 16))
STAGES = (
    stage("rough", kind="rough", on=("pocket",)),
    stage("top", on=("boss",), after_all=("rough",)),
    stage("side", on=("boss", "rib"), after_all=("rough", "top")),
    stage("hole", on=("hole",), after_all=("top",)),
)
BASE = TypicalPlan(name="Casing", title="Casings", family="ring", stages=STAGES)
FEATURES = ("pocket-01", "boss-01", "boss-02", "boss-03", "rib-01")
RECOGNITION = Recognition(
    family="ring", features=tuple(Feature(id=id, kind=id[:-3], faces=()) for id in FEATURES)
)
SIGNATURE = replace(RING, material=MATERIAL.name)


def tool(name: str):
    return next(t for t in SHOP.tools if t.name == name)


def made(stage: str, feature: str, name: str):
    """Return an operation of a stage on a feature by a tool."""
    cutter = tool(name)
    data = cutting_data(cutter, MATERIAL, MACHINE, "finish", LIMITS, 5.0, 2.0)
    found = replace(operation("finish", feature, cutter), data=data, group=stage)
    return replace(found, id=f"{stage}-{feature}", rules=("It is finished.",))


def process(*operations) -> ProcessTree:
    setup = Setup(name="S1", frame=WORLD, work_offset="G54", clearance=20.0, machine=MACHINE.name)
    return ProcessTree(
        plan="Casing", material=MATERIAL.name, setups=(setup,), operations=operations
    )


def planned() -> ProcessTree:
    """Return the process as a planner makes it."""
    return process(
        made("rough", "pocket-01", D16),
        made("top", "boss-01", D16),
        made("top", "boss-02", D16),
        made("side", "boss-01", D12),
        made("side", "boss-02", D12),
        made("side", "boss-03", D8),
        made("side", "rib-01", D12),
    )


def session_edit(tree: ProcessTree, edit) -> ProcessTree:
    """Return a process after an edit of the window."""
    from trunnion.model.session import Session

    return edit(Session(process=tree)).process


def changed(tree: ProcessTree, id: str, **values) -> ProcessTree:
    change = choose(OperationChange, {f"operation.{name}": v for name, v in values.items()})
    return with_change(tree, id, change, SHOP, {})


def taught(tree: ProcessTree):
    return taught_plan(
        tree,
        RECOGNITION,
        BASE,
        SIGNATURE,
        name="A",
        date="2026-01-01",
        part="ring",
        part_digest="",
        settings={},
    )


def follow(tree: ProcessTree, plan):
    return followed(tree, plan, RECOGNITION, SHOP, {})


def test_a_process_as_planned_teaches_its_cutters_by_stage_and_kind():
    result = taught(planned())
    assert result.findings == () and result.plan.stages == STAGES
    assert [(o.stage, o.kind, o.planned, o.tool, o.count) for o in result.plan.operations] == [
        ("rough", "pocket", D16, D16, 1),
        ("top", "boss", D16, D16, 2),
        ("side", "boss", D12, D12, 2),
        ("side", "boss", D8, D8, 1),
        ("side", "rib", D12, D12, 1),
    ]


def test_a_plan_followed_on_its_own_part_changes_nothing_but_rules():
    result = follow(planned(), taught(planned()).plan)
    assert (result.taught, result.other_cutter) == (7, 0)
    for before, after in zip(planned().operations, result.process.operations, strict=True):
        rules = (*before.rules, "From the taught plan A: stage, choices and cutter.")
        number = after.tool.number
        assert after == replace(before, rules=rules, tool=replace(before.tool, number=number))


def test_a_cutter_changed_by_hand_is_taught_for_what_the_planner_takes_there():
    tree = changed(planned(), "rough-pocket-01", tool=D12)
    plan = taught(tree).plan
    assert [(o.planned, o.tool) for o in plan.operations if o.stage == "rough"] == [(D16, D12)]
    after = follow(planned(), plan).process.operation("rough-pocket-01")
    assert after.tool.name == D12 and not after.by_hand
    assert f"{D12} instead of {D16}: the taught plan A has it here." in after.rules
    assert after.data.spindle == tree.operation("rough-pocket-01").data.spindle


def test_a_followed_plan_teaches_the_same_again():
    plan = taught(changed(planned(), "rough-pocket-01", tool=D12, spindle=5000.0)).plan
    again = taught(follow(planned(), plan).process).plan
    assert again.operations == plan.operations


def test_speeds_set_by_hand_are_taken_for_the_same_material_and_kept():
    tree = changed(planned(), "rough-pocket-01", spindle=5000.0, feed=1200.0)
    plan = taught(tree).plan
    after = follow(planned(), plan).process.operation("rough-pocket-01")
    assert (after.data.spindle, after.data.feed) == (5000.0, 1200.0)
    assert after.keeps_data and not after.by_hand
    other = replace(plan, signature=replace(SIGNATURE, material="Ti-6Al-4V"))
    kept = follow(planned(), other).process.operation("rough-pocket-01")
    assert kept.data == planned().operation("rough-pocket-01").data
    assert "set by hand for Ti-6Al-4V" in kept.rules[-1]


def test_speeds_that_the_machine_does_not_have_are_named():
    plan = taught(changed(planned(), "rough-pocket-01", spindle=5000.0)).plan
    fast = replace(plan.operations[0], spindle=150_000.0)
    after = follow(planned(), replace(plan, operations=(fast,))).process.operations[0]
    assert after.data == planned().operations[0].data
    assert "not taken" in after.rules[-1] and "not at 150000" in after.rules[-1]


def test_a_setting_given_to_one_operation_is_taught():
    key = "surface.waterline.scallop"
    tree = session_edit(planned(), edits.with_operation_choice("side-rib-01", key, 0.02))
    plan = taught(tree).plan
    assert [dict(o.choices) for o in plan.operations if o.kind == "rib"] == [{key: 0.02}]
    after = follow(planned(), plan).process
    assert after.operation("side-rib-01").choices[key] == 0.02
    assert key not in after.operation("side-boss-01").choices


def test_what_one_of_several_has_otherwise_is_named_and_not_taught():
    key = "surface.waterline.scallop"
    tree = planned()
    more = process(*tree.operations, made("side", "boss-04", D12))
    tree = session_edit(more, edits.with_operation_choice("side-boss-01", key, 0.02))
    recognition = replace(
        RECOGNITION,
        features=(*RECOGNITION.features, Feature(id="boss-04", kind="boss", faces=())),
    )
    result = taught_plan(
        tree, recognition, BASE, SIGNATURE, name="A", date="", part="", part_digest="", settings={}
    )
    assert all(not o.choices for o in result.plan.operations)
    assert [(f.code, f.where) for f in result.findings] == [
        ("library.not-taught", ("side-boss-01",))
    ]


def test_a_stage_that_is_suppressed_is_no_part_of_the_plan():
    tree = planned()
    for id in ("top-boss-01", "top-boss-02"):
        tree = session_edit(tree, edits.with_suppressed(id, True))
    plan = taught(tree).plan
    assert [s.name for s in plan.stages] == ["rough", "side", "hole"]
    # What came after it comes after what is there.
    assert plan.stages[1].after_all == ("rough",) and plan.stages[2].after_all == ()


def test_a_kind_of_feature_that_is_deleted_from_a_stage_leaves_it():
    tree = session_edit(planned(), edits.without_operation("side-rib-01"))
    assert [s.on for s in taught(tree).plan.stages if s.name == "side"] == [("boss",)]


def test_one_of_several_that_is_suppressed_is_named():
    tree = session_edit(planned(), edits.with_suppressed("side-boss-02", True))
    result = taught(tree)
    assert result.plan.stages == STAGES
    assert [f.where for f in result.findings] == [("side-boss-02",)]


def test_a_stage_that_a_person_moved_keeps_its_turn():
    tree = process(*(replace(o, after=()) for o in planned().operations))
    for id in ("side-rib-01", "side-boss-03", "side-boss-02", "side-boss-01"):
        first = tree.operations[0].id
        tree = session_edit(tree, edits.with_operation_before(id, first))
    assert [s.name for s in taught(tree).plan.stages] == ["side", "rough", "top", "hole"]


def test_work_that_the_taught_part_did_not_have_says_so():
    plan = taught(planned()).plan
    tree = process(*planned().operations, made("hole", "hole-01", D8))
    result = follow(tree, plan)
    assert (result.taught, len(result.process.operations)) == (7, 8)
    assert result.process.operations[-1].rules[-1].startswith("Not in the taught plan A")


def test_a_gap_that_is_too_narrow_gets_the_planners_own_cutter():
    plan = taught(planned()).plan
    tree = process(made("rough", "pocket-01", D10))
    result = follow(tree, plan)
    assert (result.taught, result.other_cutter) == (1, 1)
    after = result.process.operations[0]
    assert after.tool.name == D10
    assert (
        f"{D16} does not fit here (the gap is too narrow for D 16, D 10 goes in)"
        in (after.rules[-1])
    )


def test_the_cutter_of_the_plan_that_is_nearest_to_the_planners_is_named():
    tree = process(
        made("side", "boss-01", D16),
        made("side", "boss-02", D12),
        made("side", "boss-03", "AL3-stub D6 R0.5"),
    )
    finishing = [replace(o, faces=(n,)) for n, o in enumerate(tree.operations, 1)]
    plan = taught(process(*finishing)).plan
    here = replace(made("side", "boss-01", D10), faces=(1,))
    rule = follow(process(here), plan).process.operations[0].rules[-1]
    assert f"{D12} does not fit here (the gap is too narrow for D 12, D 10 goes in)" in rule
    assert D16 not in rule


def test_a_wider_gap_keeps_the_taught_cutter_where_it_reaches_as_deep():
    long, short = "AL3-regular D12 R0", D12
    for taught_tool, here in ((long, long), (short, D16)):
        plan = taught(process(made("rough", "pocket-01", taught_tool))).plan
        after = follow(process(made("rough", "pocket-01", D16)), plan).process.operations[0]
        assert after.tool.name == here
    assert "too short" in after.rules[-1]


def test_a_cutter_that_the_catalogue_lost_is_named():
    plan = taught(planned()).plan
    gone = replace(plan.operations[0], tool="gone D9")
    result = follow(process(made("rough", "pocket-01", D16)), replace(plan, operations=(gone,)))
    assert "the catalogue does not have it any more" in result.process.operations[0].rules[-1]


def longer(name: str, reach: float):
    return replace(tool(name), neck_length=reach, stickout=reach)


@pytest.mark.parametrize(
    ("taught", "planned", "now", "finishes", "words"),
    [
        # The part leaves as much space as the taught one did: a thicker cutter that was right there is right here.
        ((D12, 30.0), (D10, 30.0), (D10, 30.0), False, ""),
        ((D12, 30.0), (D10, 30.0), (D8, 30.0), False, "too narrow"),
        ((D12, 30.0), (D12, 30.0), (D16, 30.0), False, ""),
        ((D12, 30.0), (D12, 30.0), (D12, 45.0), False, "too short"),
        # A person chose a shorter one than the planner does, and here is no more depth than there.
        ((D12, 30.0), (D12, 45.0), (D12, 45.0), False, ""),
        (("AL2-ball D6 R3", 30.0), (D12, 30.0), (D12, 30.0), True, "another shape"),
        (("AL3-stub D6 R0.5", 45.0), (D12, 30.0), (D12, 30.0), True, "another shape"),
        (("AL3-stub D6 R0.5", 45.0), (D12, 30.0), (D12, 30.0), False, ""),
        (("DR-S D4", 60.0), ("DR-S D4", 60.0), ("DR-S D5", 60.0), True, "another shape"),
    ],
)
def test_a_taught_cutter_fits_where_the_planners_choice_leaves_it_space(
    taught, planned, now, finishes, words
):
    here = replace(made("side", "boss-01", D12), tool=longer(*now), faces=(1,) if finishes else ())
    reason = refusal(longer(*taught), longer(*planned), here)
    assert words in reason and bool(words) == bool(reason)


def test_a_copy_is_not_taught_and_the_note_says_so():
    plain = planned()
    copied = session_edit(plain, edits.with_copy("side-boss-02"))
    result = taught_plan(
        copied,
        RECOGNITION,
        BASE,
        SIGNATURE,
        name="A",
        date="",
        part="",
        part_digest="",
        settings={},
    )
    assert [(f.code, f.where) for f in result.findings] == [
        ("library.not-taught", ("side-boss-02-copy",))
    ]
    assert "copied by hand" in result.findings[0].text
    original = taught_plan(
        plain, RECOGNITION, BASE, SIGNATURE, name="A", date="", part="", part_digest="", settings={}
    )
    assert result.plan == original.plan
