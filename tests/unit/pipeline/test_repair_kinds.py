"""Kinds of fixes beyond tools, feeds and operations: links, allowances, leaning tools, remarks; each on a planted fault."""

from __future__ import annotations

from dataclasses import replace

import cadquery as cq
import pytest

from trunnion.findings import BadInput, Fix, Severity
from trunnion.model.keep_out import KeepOutBox
from trunnion.model.motion.toolpath import Motion
from trunnion.pipeline import Engine
from trunnion.plan.repair.contract import numbered
from trunnion.toolpath.motion import link

LOW = 3.0
"""mm by which a planted planner takes stock for lower than it is: more than the safety distance of its links."""


@pytest.fixture(scope="module")
def plate(tmp_path_factory):
    """The engine and the proven session of a plate of 70 x 40 mm with a pocket 8 mm deep around an island."""
    path = tmp_path_factory.mktemp("kinds") / "plate.step"
    block = cq.Workplane("XY").box(70.0, 40.0, 14.0, centered=False)
    pocket = cq.Workplane("XY").box(54.0, 26.0, 8.0, centered=False).edges("|Z").fillet(6.0)
    island = cq.Workplane("XY").box(8.0, 8.0, 8.0, centered=False).edges("|Z").fillet(2.0)
    cut = pocket.cut(island.translate((23.0, 9.0, 0.0)))
    cq.exporters.export(block.cut(cut.translate((8, 7, 6))), str(path))
    engine = Engine()
    return engine, engine.run(engine.open(path))


@pytest.fixture(scope="module")
def dome(tmp_path_factory):
    """The engine and the session of a small dome on a plate, planned for a machine with rotary axes."""
    path = tmp_path_factory.mktemp("kinds") / "dome.step"
    foot = cq.Workplane("XY").box(36.0, 30.0, 8.0, centered=(True, True, False))
    ball = cq.Workplane("XY").sphere(22.0).translate((0.0, 0.0, -8.0))
    above = cq.Workplane("XY").box(80.0, 80.0, 40.0, centered=(True, True, False))
    cq.exporters.export(
        foot.union(ball.intersect(above).intersect(foot.translate((0, 0, 6)))), str(path)
    )
    engine = Engine()
    choices = {
        "recognize.family": "surface",
        "setup.machine": "Trunnion 650",
        "surface.scallop": "0.05",
        "surface.semi_scallop": "0.3",
    }
    return engine, engine.run(engine.with_choices(engine.open(path), choices), "route")


def _changed(session, kind, change):
    (operation,) = (o for o in session.process.operations if o.kind == kind)
    return replace(session, process=session.process.with_operation(change(operation)))


def _codes(session, severity):
    return {f.code for f in session.findings() if f.severity is severity}


def _without_repair(engine, session):
    return engine.run(engine.with_choices(session, {"repair.rounds": "0"}))


def test_rapids_that_are_too_low_are_lifted(plate, monkeypatch):
    engine, session = plate
    true_height = link.lowest_tip
    monkeypatch.setattr(link, "lowest_tip", lambda *given: true_height(*given) - LOW)
    planted = _changed(
        session, "rough", lambda o: replace(o, choices={**o.choices, "cutting.feed_share": 0.9})
    )
    # All paths are made with the fault, not the changed one alone.
    planted = replace(planted, paths=())
    failed = _without_repair(engine, planted)
    assert "verify.rapid-in-stock" in _codes(failed, Severity.ERROR)
    mended = engine.run(planted)
    assert mended.verdict.releases
    lifted = {f.operation for r in mended.repairs if r.kept for f in r.fixes if f.kind == "lift"}
    assert lifted
    for id in lifted:
        (safety,) = (
            v for k, v in mended.process.operation(id).choices.items() if k.endswith(".safety")
        )
        assert safety > 2.0


def test_roughing_that_goes_into_a_wall_keeps_farther_off(plate):
    engine, session = plate
    keys = ("route.wall_allowance", "route.floor_allowance")
    planted = _changed(
        session,
        "rough",
        lambda o: replace(o, choices={**o.choices, **dict.fromkeys(keys, -0.2)}),
    )
    failed = _without_repair(engine, planted)
    assert "verify.gouge" in _codes(failed, Severity.ERROR)
    mended = engine.run(planted)
    assert mended.verdict.releases
    (rough,) = (o for o in mended.process.operations if o.kind == "rough")
    assert all(rough.choices[k] > 0.0 for k in keys)


def test_finishing_keeps_its_size(plate):
    engine, session = plate
    (wall,) = (o for o in session.process.operations if o.kind == "wall")
    with pytest.raises(BadInput, match="follow the remedy by hand"):
        engine.with_fix(
            session, Fix(kind="allowance", operation=wall.id, reason="verify.gouge", amount=0.1)
        )


def test_an_operation_that_cuts_only_air_is_left_out_when_remarks_are_repaired(plate):
    engine, session = plate
    (wall,) = (o for o in session.process.operations if o.kind == "wall")
    again = replace(wall, id="wall-again", after=(wall.id,))
    operations = list(session.process.operations)
    operations.insert(operations.index(wall) + 1, again)
    slow = {"cutting.feed_share": 0.1}
    planted = replace(
        session,
        process=replace(
            session.process,
            operations=tuple(replace(o, choices=slow) if o is again else o for o in operations),
        ),
    )
    remarked = engine.run(planted)
    assert remarked.verdict.releases and remarked.repairs == ()
    assert "wall-again" in {
        o for f in remarked.findings() if f.code == "verify.air" for o in f.where
    }
    mended = engine.run(engine.with_choices(planted, {"repair.remarks": "true"}))
    assert mended.verdict.releases and mended.process.operation("wall-again").suppressed
    assert mended.verdict.machining_time_s < remarked.verdict.machining_time_s
    assert "remarked on" in next(f.text for f in mended.findings() if f.code == "repair.kept")


def test_more_load_than_the_data_are_for_is_fed_more_slowly_when_remarks_are_repaired(plate):
    engine, session = plate
    planted = _changed(
        session, "rough", lambda o: replace(o, choices={**o.choices, "plane.rough.slot_feed": 1.0})
    )
    # Thick chips alone: what a feed allows to be removed goes down with it.
    planted = engine.with_choices(planted, {"verify.chip": "1", "verify.removal": "3"})
    remarked = engine.run(planted)
    loads = {o for f in remarked.findings() if f.code == "verify.load" for o in f.where}
    mended = engine.run(engine.with_choices(planted, {"repair.remarks": "true"}))
    after = {o for f in mended.findings() if f.code == "verify.load" for o in f.where}
    assert remarked.verdict.releases and mended.verdict.releases
    assert loads and len(after) < len(loads)


def approached(dome):
    """Return the session with a fix of the finishing of the dome, and the fix: the tool comes from another direction."""
    engine, session = dome
    finish = next(
        o for o in session.process.operations if o.kind == "finish" and o.cutter.form == "ball"
    )
    fix = Fix(kind="approach", operation=finish.id, reason="verify.collision", amount=0.4)
    return engine.with_fix(session, fix), finish, fix


@pytest.mark.long
def test_a_leaning_tool_that_finishes_faces_does_no_harm(dome):
    verdict = dome[0].run(approached(dome)[0]).verdict
    assert verdict.collisions == 0 and verdict.rapids_in_stock == 0


def test_faces_that_an_upright_tool_does_harm_at_are_finished_by_a_leaning_one(dome):
    engine, session = dome
    changed, finish, fix = approached(dome)
    alone = replace(changed.process.operation(finish.id), after=())
    process = numbered(replace(changed.process, operations=(alone,)), {})
    fixed = engine.run(replace(changed, process=process), "toolpath")
    (leaning,) = fixed.paths
    assert (leaning.path.axis[:, 2] < 0.999).any()
    wary = engine.with_fix(changed, fix)
    assert wary.process.operation(finish.id).choices["surface.point.wary"] is True
    with pytest.raises(BadInput, match="follow the remedy by hand"):
        engine.with_fix(wary, fix)
    fixed_axis = engine.with_choices(session, {"setup.machine": "Mill 1200"})
    with pytest.raises(BadInput, match="follow the remedy by hand"):
        engine.with_fix(engine.run(fixed_axis, "route"), fix)


def test_a_smaller_cutter_after_a_larger_one_cuts_only_its_rest(dome):
    engine, session = dome
    planned = next(
        o for o in session.process.operations if o.kind == "finish" and o.cutter.form == "ball"
    )
    small, large = (
        next(t for t in engine.context.shop.tools if t.form == "ball" and t.diameter == d)
        for d in (3.0, 6.0)
    )
    finish = replace(planned, tool=large, after=())
    again = replace(finish, id="finish-again", tool=small, after=(finish.id,))
    process = replace(session.process, operations=(finish, again))
    planted = replace(session, process=numbered(process, {}))
    fix = Fix(kind="trim", operation="finish-again", reason="verify.air", amount=0.9)
    trimmed = engine.with_fix(planted, fix)
    assert trimmed.process.operation("finish-again").choices["surface.earlier"] == finish.tool.name

    def length(of):
        path = next(p for p in engine.run(of, "toolpath").paths if p.operation == "finish-again")
        return len(path.path)

    assert length(trimmed) < 0.5 * length(planted)


def test_a_finishing_operation_on_curved_faces_keeps_out_of_what_it_avoids(dome):
    engine, session = dome
    finish = next(
        o for o in session.process.operations if o.kind == "finish" and o.cutter.form == "ball"
    )

    def laid(operation):
        process = replace(session.process, operations=(replace(operation, after=()),))
        made = engine.run(replace(session, process=numbered(process, {})), "toolpath")
        path = made.paths[0].path
        return made, path.position[path.motion != Motion.RAPID]

    _, plain = laid(finish)
    x, y = plain[:, :2].mean(axis=0)
    avoid = KeepOutBox(low=(x - 6.0, y - 40.0), high=(x + 6.0, y + 4.0), top=100.0)
    made, kept = laid(replace(finish, avoid=(avoid,)))
    inside, after = (
        ((tips[:, :2] > avoid.low) & (tips[:, :2] < avoid.high)).all(axis=1)
        for tips in (plain, kept)
    )
    assert inside.sum() > 50 and not after.any() and len(after) > 0.3 * len(inside)
    (told,) = (f for f in made.findings() if f.code == "operation.left-out")
    assert finish.feature in told.where and "mm2" in told.text
