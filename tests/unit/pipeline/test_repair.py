"""Repair: planted faults of every kind, the fix that mends each, and what happens where none does."""

from __future__ import annotations

from dataclasses import replace

import cadquery as cq
import pytest

from trunnion import registry
from trunnion.findings import BadInput, Fix, Severity
from trunnion.model.repair import PlanScore
from trunnion.pipeline import Engine
from trunnion.plan.repair.alternatives import ALTERNATIVES
from trunnion.plan.repair.contract import numbered
from trunnion.store.project import load_project

DEPTH = 20.0


@pytest.fixture(scope="module")
def deep(tmp_path_factory):
    """The engine and the proven session of a plate with a pocket of 44 x 30 mm, 20 mm deep, and a slot of 13 mm at its side."""
    path = tmp_path_factory.mktemp("repair") / "deep.step"
    plate = cq.Workplane("XY").box(90.0, 50.0, 26.0, centered=False)
    pocket = cq.Workplane("XY").box(44.0, 30.0, DEPTH, centered=False).edges("|Z").fillet(6.0)
    slot = cq.Workplane("XY").box(36.0, 13.0, DEPTH, centered=False).edges("|Z").fillet(6.0)
    plate = plate.cut(pocket.translate((10, 10, 6))).cut(slot.translate((44, 20, 6)))
    cq.exporters.export(plate, str(path))
    engine = Engine()
    return engine, engine.run(engine.open(path))


def _planted(session, **changes):
    """Return the session with the operations of some kinds changed, given as functions of the operation."""
    process = session.process
    for operation in process.operations:
        if operation.kind in changes:
            process = process.with_operation(changes[operation.kind](operation))
    return replace(session, process=numbered(process, {}))


def _rejected(engine, session):
    """Return the session without repair; it is rejected."""
    failed = engine.run(engine.with_choices(session, {"repair.rounds": "0"}))
    assert not failed.verdict.releases and failed.repairs == ()
    return failed


def _errors(session):
    return {f.code for f in session.findings() if f.severity is Severity.ERROR}


def _less_power(session):
    """Return the share of the spindle's power that the most loaded operation asks a half more than."""
    return f"{max(p.power / p.power_limit for p in session.verdict.operations) / 1.5:.4f}"


def test_a_plan_that_passes_is_left_as_it_is(deep):
    _, session = deep
    assert session.verdict.releases and session.repairs == ()
    assert "repair" in session.records


def test_a_tool_too_short_is_changed_for_one_that_reaches(deep):
    engine, session = deep

    def short(o):
        shank = o.tool.diameter + 4.0
        return replace(
            o,
            tool=replace(
                o.tool, name="short", flute_length=10.0, neck_length=12.0, shank_diameter=shank
            ),
        )

    planted = _planted(session, wall=short)
    failed = _rejected(engine, planted)
    assert _errors(failed) & {"verify.collision", "verify.collision-stock"}
    mended = engine.run(planted)
    assert mended.verdict.releases
    assert [r.kept for r in mended.repairs][-1]
    (wall,) = (o for o in mended.process.operations if o.kind == "wall")
    assert wall.tool.name != "short" and wall.tool.neck_length >= DEPTH
    kept = next(f for f in mended.findings() if f.code == "repair.kept")
    assert wall.id in kept.where


def test_what_no_fix_touched_keeps_its_toolpath(deep):
    engine, session = deep
    planted = _planted(session, wall=lambda o: replace(o, choices={"cutting.feed_share": 3.0}))
    before = {p.operation: p.key for p in session.paths}
    after = {p.operation: p.key for p in engine.run(planted).paths}
    changed = {id for id in before if before[id] != after[id]}
    assert changed == {o.id for o in session.process.operations if o.kind == "wall"}


def test_a_feed_that_the_spindle_does_not_bear_is_lowered(deep):
    engine, session = deep
    tight = engine.with_choices(session, {"verify.power": _less_power(session)})
    failed = _rejected(engine, tight)
    assert "verify.power" in _errors(failed)
    mended = engine.run(tight)
    assert mended.verdict.releases
    slowed = [o for o in mended.process.operations if "cutting.feed_share" in o.choices]
    assert slowed and all(o.choices["cutting.feed_share"] < 1.0 for o in slowed)
    first = {o.id: o for o in failed.process.operations}
    assert all(o.data.feed < first[o.id].data.feed for o in slowed)


def test_what_a_larger_cutter_left_is_finished_by_a_smaller_one(deep):
    engine, session = deep
    large = max(
        (t for t in engine.context.shop.tools if t.form == "flat" and t.neck_length > DEPTH),
        key=lambda t: (t.diameter <= 16.0, t.diameter),
    )
    planted = _planted(
        session,
        wall=lambda o: replace(o, tool=large),
        corner_finish=lambda o: replace(o, suppressed=True),
    )
    failed = _rejected(engine, planted)
    assert "verify.coverage" in _errors(failed)
    mended = engine.run(planted)
    assert mended.verdict.reachable > failed.verdict.reachable
    assert mended.verdict.releases
    assert any(o.id.startswith("again-wall") for o in mended.process.operations)


def test_an_operation_that_can_not_be_made_and_is_not_needed_is_left_out(deep):
    engine, session = deep
    (wall,) = (o for o in session.process.operations if o.kind == "wall")
    lost = replace(wall, id="wall-lost", feature="pocket-99", after=(wall.id,))
    planted = replace(
        session,
        process=replace(session.process, operations=(*session.process.operations, lost)),
    )
    failed = _rejected(engine, planted)
    assert "toolpath.refused" in _errors(failed)
    mended = engine.run(planted)
    assert mended.verdict.releases
    assert mended.process.operation("wall-lost").suppressed
    assert not any(o.suppressed for o in mended.process.operations if o.id != "wall-lost")


def test_stock_in_the_way_is_roughed_before_by_a_smaller_cutter(deep):
    engine, session = deep
    wide = next(t for t in engine.context.shop.tools if t.name == "AL3-stub D16 R0")
    planted = _planted(session, rough=lambda o: replace(o, tool=wide))
    (floor,) = (o for o in planted.process.operations if o.kind == "floor")
    fixed = engine.with_fix(
        planted,
        Fix(kind="clear_first", operation=floor.id, reason="verify.collision-stock", amount=0.4),
    )
    ids = [o.id for o in fixed.process.operations]
    added = fixed.process.operation("clear-pocket-01-1")
    assert ids.index("rough-pocket-01") < ids.index(added.id) == ids.index(floor.id) - 1
    assert added.cutter.diameter <= 0.7 * wide.diameter
    assert added.id in fixed.process.operation(floor.id).after
    cut = engine.run(fixed)
    removed = {p.operation: p.removed for p in cut.verdict.operations}
    assert cut.verdict.releases and removed[added.id] > removed[floor.id]


def test_a_cutter_that_does_not_fit_gives_way_to_a_smaller_one(deep):
    engine, session = deep
    (wall,) = (o for o in session.process.operations if o.kind == "wall")
    fixed = engine.with_fix(
        session, Fix(kind="smaller_tool", operation=wall.id, reason="toolpath.refused")
    )
    smaller = fixed.process.operation(wall.id).cutter
    assert smaller.diameter < wall.cutter.diameter and smaller.neck_length >= DEPTH


def test_passes_follow_a_face_more_closely_after_a_gouge(tmp_path):
    path = tmp_path / "dome.step"
    dome = cq.Workplane("XY").box(40.0, 30.0, 10.0, centered=(True, True, False))
    ball = cq.Workplane("XY").sphere(30.0).translate((0, 0, -12.0))
    cq.exporters.export(
        dome.intersect(cq.Workplane("XY").box(40, 30, 60)).union(
            ball.intersect(cq.Workplane("XY").box(40.0, 30.0, 40.0, centered=(True, True, False)))
        ),
        str(path),
    )
    engine = Engine()
    session = engine.run(
        engine.with_choices(engine.open(path), {"recognize.family": "surface"}), "route"
    )
    finish = next(o for o in session.process.operations if o.kind == "finish")
    gouge = Fix(kind="tolerance", operation=finish.id, reason="verify.gouge", amount=0.03)
    key = f"{finish.strategy}.chord"
    coarse = replace(
        session,
        process=session.process.with_operation(
            replace(finish, choices={**finish.choices, key: 0.02})
        ),
    )
    once = engine.with_fix(coarse, gouge)
    assert once.process.operation(finish.id).choices[key] == pytest.approx(0.01)
    assert once.process.operation(finish.id).tool == finish.tool


def test_rounds_are_bounded_and_what_was_tried_is_told(deep):
    engine, session = deep
    planted = _planted(
        session,
        rough=lambda o: replace(o, suppressed=True),
        corner=lambda o: replace(o, suppressed=True),
    )
    left = engine.run(engine.with_choices(planted, {"repair.rounds": "2"}))
    assert len(left.repairs) <= 2


def test_what_nobody_planned_is_not_repaired(deep):
    engine, session = deep
    left_out = replace(
        session,
        process=replace(
            session.process,
            operations=tuple(
                replace(o, suppressed=o.feature == "pocket-01") for o in session.process.operations
            ),
        ),
    )
    failed = engine.run(left_out)
    (coverage,) = (f for f in failed.verdict.findings if f.code == "verify.coverage")
    assert coverage.fix is None
    assert failed.repairs == ()


def test_a_fix_of_what_a_person_set_by_hand_is_not_made(deep):
    engine, session = deep
    (wall,) = (o for o in session.process.operations if o.kind == "wall")
    by_hand = replace(session, process=session.process.with_operation(replace(wall, by_hand=True)))
    with pytest.raises(BadInput, match="by hand"):
        engine.with_fix(by_hand, Fix(kind="tool", operation=wall.id, reason="verify.collision"))


def test_one_fix_is_applied_alone(deep):
    engine, session = deep
    (wall,) = (o for o in session.process.operations if o.kind == "wall")
    fixed = engine.with_fix(
        session, Fix(kind="feed", operation=wall.id, reason="verify.power", amount=0.5)
    )
    assert fixed.process.operation(wall.id).choices["cutting.feed_share"] == pytest.approx(0.5)
    assert engine.states(fixed)["verify"] == "stale"
    with pytest.raises(BadInput, match="follow the remedy by hand"):
        # Applied by a person it is never replaced by another kind, such as leaving the operation out.
        engine.with_fix(
            session, Fix(kind="feed", operation=wall.id, reason="verify.collision", amount=1.0)
        )
    with pytest.raises(BadInput, match="not in the plan any more"):
        engine.with_fix(session, Fix(kind="feed", operation="wall-99", reason="verify.power"))


def test_repairs_come_back_from_the_project_file(deep, tmp_path):
    engine, session = deep
    tight = engine.with_choices(session, {"verify.power": _less_power(session)})
    mended = engine.run(tight)
    engine.save(mended, tmp_path / "mended.trunnion")
    again, _, _ = load_project(tmp_path / "mended.trunnion")
    assert again.repairs == mended.repairs and len(again.repairs) > 0
    assert set(again.repairs[0].as_dicts()[0]) == {
        "round",
        "finding",
        "fix",
        "before",
        "after",
        "kept",
    }


def test_every_kind_on_a_ladder_is_registered():
    kinds = {kind for kinds in ALTERNATIVES.values() for kind in kinds}
    assert kinds == set(registry.names(registry.FIXES))


def test_scores_count_errors_before_all_else():
    best = PlanScore(errors=0, is_short=False, harms=9, unfinished=0.5, remarks=9, time=9e9)
    assert best < PlanScore(errors=1, is_short=False, harms=0, unfinished=0.0, remarks=0, time=0.0)


def test_a_harm_mended_by_leaving_faces_uncut_is_not_mended():
    collides = PlanScore(errors=1, is_short=False, harms=9, unfinished=0.002, remarks=9, time=9e9)
    uncut = PlanScore(errors=1, is_short=True, harms=0, unfinished=0.1, remarks=0, time=0.0)
    assert collides < uncut
