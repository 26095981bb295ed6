"""The fix `exclude`: an operation keeps out of where its tool collides, where no other tool and no approach helps."""

from __future__ import annotations

from dataclasses import replace

import cadquery as cq
import numpy as np
import pytest
from lxml import etree

from clamps import clamp
from trunnion.findings import BadInput, Fix, Severity
from trunnion.model.keep_out import KeepOutBox, plan_boxes
from trunnion.model.motion.toolpath import Motion
from trunnion.pipeline import Engine
from trunnion.plan import contract
from trunnion.plan.repair.alternatives import ALTERNATIVES
from trunnion.plan.repair.contract import RepairJob, numbered
from trunnion.store.process import process_xml
from trunnion.store.project import load_project
from trunnion.toolpath.motion.fixture_links import FixtureSurface

WALL = "wall-open_pocket-01"


@pytest.fixture(scope="module")
def stepped(tmp_path_factory):
    """The engine and the proven session of a block of 90 x 50 mm with a step, 80 mm wide, 18 mm under its rim."""
    path = tmp_path_factory.mktemp("exclude") / "stepped.step"
    block = cq.Workplane("XY").box(90.0, 50.0, 32.0, centered=False)
    step = cq.Workplane("XY").box(80.0, 50.0, 18.0, centered=False)
    cq.exporters.export(block.cut(step.translate((10.0, 0.0, 14.0))), str(path))
    engine = Engine()
    return engine, engine.run(engine.open(path))


@pytest.fixture
def no_other_tool(monkeypatch):
    """A shop with no tool but those in the plan, on a machine without rotary axes."""
    monkeypatch.setattr(RepairJob, "milling_tools", lambda *_: ())


def _planted(session):
    """Return the session with a cutter for the wall whose holder goes in 1 mm over the wall's rim when it cuts at its foot."""
    wall = session.process.operation(WALL)
    tool = replace(wall.cutter, name="short", flute_length=10.0, neck_length=12.0, stickout=17.0)
    process = session.process.with_operation(replace(wall, tool=tool))
    return replace(session, process=numbered(process, {}))


def _rejected(engine, session):
    return engine.run(engine.with_choices(session, {"repair.rounds": "0"}))


def _tips(session, id, apart=0.5):
    """Return tips (k, 3) along an operation's straight moves."""
    path = next(p.path for p in session.paths if p.operation == id)
    ends = np.stack([path.starts(), path.position], axis=1)[path.motion <= Motion.LINE]
    count = np.ceil(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) / apart).astype(int) + 1
    return np.concatenate([np.linspace(a, b, n) for (a, b), n in zip(ends, count, strict=True)])


def _inside(tips, boxes):
    rows = plan_boxes(boxes)
    low, high, top = rows[:, :2] + 0.02, rows[:, 2:4] - 0.02, rows[:, 4] - 0.02
    plan = tips[:, None, :2]
    held = ((plan > low) & (plan < high)).all(axis=2) & (tips[:, None, 2] < top)
    return int(held.any(axis=1).sum())


def test_what_no_tool_reaches_without_harm_is_left_out_and_told(stepped, no_other_tool):
    engine, session = stepped
    planted = _planted(session)
    failed = _rejected(engine, planted)
    assert "verify.collision" in {f.code for f in failed.verdict.findings}
    mended = engine.run(planted)
    assert mended.verdict.releases and mended.verdict.collisions == 0
    (fix,) = (f for r in mended.repairs if r.kept for f in r.fixes)
    assert (fix.kind, fix.operation) == ("exclude", WALL)
    wall = mended.process.operation(WALL)
    assert wall.avoid and not wall.suppressed and wall.tool.name == "short"
    assert any("keeps out of where its tool collides" in rule for rule in wall.rules)
    (told,) = (f for f in mended.findings() if f.code == "operation.left-out")
    assert told.severity is Severity.WARNING and "open_pocket-01" in told.where
    assert "short would collide there" in told.text
    # What is left out is measured: of the wall, 8.5 % of the part, its foot of 1.5 mm of 18 and a little around.
    assert 0.99 < mended.verdict.coverage < 1.0 - 0.085 * 1.5 / 18.0
    height = _tips(mended, WALL)[:, 2]
    (top,) = {box.top for box in wall.avoid}
    assert top in height and mended.verdict.reachable == mended.verdict.coverage
    assert _inside(_tips(failed, WALL), wall.avoid) > 0 == _inside(_tips(mended, WALL), wall.avoid)


def test_without_it_the_part_is_rejected(stepped, no_other_tool, monkeypatch):
    engine, session = stepped
    for code, kinds in ALTERNATIVES.items():
        monkeypatch.setitem(ALTERNATIVES, code, tuple(k for k in kinds if k != "exclude"))
    assert not engine.run(_planted(session)).verdict.releases


def test_it_is_tried_before_an_operation_is_left_out_altogether():
    for kinds in ALTERNATIVES.values():
        if "exclude" in kinds:
            assert kinds[-2:] == ("exclude", "drop")
    assert all("exclude" in ALTERNATIVES[f"verify.{k}"] for k in ("collision", "fixture"))


def test_the_proof_says_where_the_tip_is_when_it_collides(stepped):
    engine, session = stepped
    failed = _rejected(engine, _planted(session))
    again = _rejected(engine, engine.with_choices(_planted(session), {"verify.threads": "1"}))
    fixes = [f.fix for f in failed.verdict.findings if f.fix is not None]
    assert fixes and fixes == [f.fix for f in again.verdict.findings if f.fix is not None]
    boxes = np.array(fixes[0].boxes)
    assert all(f.boxes == fixes[0].boxes for f in fixes) and 0 < len(boxes) <= 12
    # The holder is 21 mm in radius at its lowest, the wall at x = 10: it is over the rim with the tip up to x = 31.
    assert 30.0 < boxes[:, 3].max() <= 31.2
    # Along the wall it is as far past the block's ends at the most.
    assert boxes[:, 1].min() >= -21.2 and boxes[:, 4].max() <= 71.2
    assert (boxes[:, 2] == -20.0).all() and (boxes[:, 5] < -18.0).all()
    assert (np.round(boxes, 1) == boxes).all()
    assert fixes[0].as_dict()["boxes"] == boxes.tolist()
    assert "boxes" not in Fix(kind="tool").as_dict()


def test_boxes_grow_where_they_were_too_small(stepped):
    engine, session = stepped
    fix = Fix(kind="exclude", operation=WALL, amount=1.0, boxes=((20.0, 0, -20, 25, 50, -20),))
    once = engine.with_fix(session, fix)
    assert once.process.operation(WALL).avoid == (
        KeepOutBox(low=(19.0, -1.0), high=(26.0, 51.0), top=-18.5),
    )
    beside = replace(fix, boxes=((26.5, 0, -20, 27, 50, -19),))
    twice = engine.with_fix(once, beside).process.operation(WALL)
    assert twice.avoid[1] == KeepOutBox(low=(23.5, -3.0), high=(30.0, 53.0), top=-8.0)
    assert len([r for r in twice.rules if "keeps out" in r]) == 1
    with pytest.raises(BadInput, match="follow the remedy by hand"):
        engine.with_fix(once, replace(fix, boxes=((22.2, 3, -40, 22.8, 47, -39),)))


def test_nothing_is_left_out_where_the_proof_names_no_boxes_or_a_person_made_it(stepped):
    engine, session = stepped
    fix = Fix(kind="exclude", operation=WALL, boxes=((20.0, 0.0, -20.0, 25.0, 50.0, -20.0),))
    with pytest.raises(BadInput, match="follow the remedy by hand"):
        engine.with_fix(session, replace(fix, boxes=()))
    wall = replace(session.process.operation(WALL), by_hand=True)
    with pytest.raises(BadInput, match="by hand"):
        engine.with_fix(replace(session, process=session.process.with_operation(wall)), fix)


def test_boxes_are_turned_with_the_tool(stepped):
    engine, session = stepped
    wall = replace(session.process.operation(WALL), direction=(1.0, 0.0, 0.0))
    turned = replace(session, process=session.process.with_operation(wall))
    fix = Fix(kind="exclude", operation=WALL, boxes=((5.0, 2.0, -20.0, 9.0, 40.0, -3.0),))
    (box,) = engine.with_fix(turned, fix).process.operation(WALL).avoid
    # Along x the setup's y is seen as x, its z as y, its x as the height.
    assert box == KeepOutBox(low=(1.0, -21.0), high=(41.0, -2.0), top=9.5)


def test_areas_to_avoid_come_back_from_the_files(stepped, tmp_path):
    engine, session = stepped
    fix = Fix(kind="exclude", operation=WALL, boxes=((20.0, 0.0, -20.0, 25.0, 50.0, -20.0),))
    changed = engine.with_fix(session, fix)
    for one, name in ((session, "before"), (changed, "after")):
        engine.save(one, tmp_path / name)
        assert load_project(tmp_path / name)[0].process.operations == one.process.operations
    (avoid,) = etree.fromstring(process_xml(changed.process, changed.part)).iter("avoid")
    assert {k: float(v) for k, v in avoid.items()} == {
        "x0": 19.0,
        "y0": -1.0,
        "x1": 26.0,
        "y1": 51.0,
        "top": -19.5,
    }
    assert b"avoid" not in process_xml(session.process, session.part)


def test_an_operation_that_avoids_something_changes_no_other_path(stepped):
    engine, session = stepped
    fix = Fix(kind="exclude", operation=WALL, boxes=((20.0, 0.0, -20.0, 25.0, 50.0, -20.0),))
    changed = engine.run(engine.with_fix(session, fix), "toolpath")
    before = {p.operation: p.key for p in session.paths}
    different = {p.operation for p in changed.paths if p.key != before[p.operation]}
    order = [o.id for o in session.process.operations]
    assert WALL in different and all(order.index(o) >= order.index(WALL) for o in different)
    back = session.process.operation(WALL)
    undone = replace(changed, process=changed.process.with_operation(back))
    assert {p.operation: p.key for p in engine.run(undone, "toolpath").paths} == before


def test_a_fixture_that_a_planner_does_not_see_is_kept_out_of(stepped, monkeypatch):
    engine, session = stepped
    monkeypatch.setattr(contract, "_off_fixtures", lambda driven, *_: driven)
    of = FixtureSurface.of
    monkeypatch.setattr(FixtureSurface, "of", lambda setup: of(replace(setup, fixtures=())))
    pin = clamp((84.0, 44.0, 10.0), (87.0, 47.0, 24.0), name="pin")
    held = engine.with_choices(replace(session, fixtures=(pin,)), {"verify.coverage": "0.8"})
    failed = _rejected(engine, held)
    assert "verify.fixture" in {f.code for f in failed.verdict.findings}
    mended = engine.run(held)
    kept = {(f.kind, f.operation) for r in mended.repairs if r.kept for f in r.fixes}
    assert mended.verdict.releases, [str(f) for f in mended.findings()]
    # Where leaving the pin out makes nothing better at once, an operation may go altogether.
    assert "exclude" in {kind for kind, _ in kept} <= {"exclude", "drop"}
    assert "operation.left-out" in {f.code for f in mended.findings()}
