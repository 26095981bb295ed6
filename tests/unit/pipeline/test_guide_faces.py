"""Operations led by other faces by a person: what they cut then, what comes and goes with a wall, and what is refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from holed import hole, plate
from trunnion.findings import BadCall, BadInput
from trunnion.model.motion.toolpath import Motion
from trunnion.pipeline import Engine
from trunnion.pipeline.planning.guide_faces import FACES_RULE, with_guide_faces


@pytest.fixture(scope="module")
def planned(sample_panel):
    """An engine and its session of the small panel, with toolpaths."""
    engine = Engine()
    return engine, engine.run(engine.open(sample_panel), until="toolpath")


def the(session, kind, feature="pocket-01"):
    return next(o for o in session.process.operations if (o.kind, o.feature) == (kind, feature))


def walls_of(engine, session, operation):
    """Return the plane walls of an operation: tag, a point, and the outward normal."""
    graph = engine.context_of(session).part.graph()
    feature = session.recognition.feature(operation.feature)
    return {
        tag: (graph.centre[tag - 1], graph.normal[tag - 1])
        for tag in feature.with_role("wall")
        if tag in operation.faces and graph.surface[tag - 1] == "plane"
    }


def least_distance(session, operation, wall) -> float:
    """Return how near the tips of an operation's cutting moves come to the plane of a wall."""
    made = session.path_of(operation.id)
    frame = session.process.setup(operation.setup).frame
    tips = frame.to_world(made.path.position[made.path.motion != Motion.RAPID])
    point, normal = wall
    return float(((tips - point) @ normal).min())


def rerun(engine, session):
    return engine.run(session, until="toolpath")


def test_a_wall_that_is_left_out_is_not_gone_along_any_more(planned) -> None:
    engine, session = planned
    before = the(session, "wall")
    radius = before.cutter.radius
    walls = walls_of(engine, session, before)
    assert len(walls) >= 3
    tag = min(walls)
    other = {t: w for t, w in walls.items() if w[1] @ walls[tag][1] < 0.5}
    assert least_distance(session, before, walls[tag]) == pytest.approx(radius, abs=1e-3)

    changed = rerun(engine, with_guide_faces(engine, session, before.id, leave_out=[tag]))
    after = the(changed, "wall")
    assert tag not in after.faces and after.own_faces and after.by_hand
    assert FACES_RULE in after.rules
    assert least_distance(changed, after, walls[tag]) >= radius - 1e-3
    along = [
        np.abs(least_distance(changed, after, wall) - radius) < 1e-3 for wall in other.values()
    ]
    assert all(along)
    # Of all paths of the plan that one alone is another.
    others = {
        p.operation
        for p, q in zip(session.paths, changed.paths, strict=True)
        if len(p.path) != len(q.path) or not np.array_equal(p.path.position, q.path.position)
    }
    assert others == {before.id}


def test_the_fillet_at_the_foot_of_a_wall_goes_and_comes_with_it(planned) -> None:
    engine, session = planned
    before = the(session, "wall")
    graph = engine.context_of(session).part.graph()
    feature = session.recognition.feature(before.feature)
    tag = min(walls_of(engine, session, before))
    at_foot = {r + 1 for r in graph.neighbours(tag - 1)}.intersection(
        feature.with_role("floor_fillet")
    )
    assert len(at_foot) == 1 and at_foot <= set(before.faces)
    without = with_guide_faces(engine, session, before.id, leave_out=[tag])
    assert set(before.faces) - set(the(without, "wall").faces) == {tag, *at_foot}

    again = with_guide_faces(engine, without, before.id, add=[tag])
    assert set(the(again, "wall").faces) == set(before.faces)
    one, other = (s.path_of(before.id).path for s in (session, rerun(engine, again)))
    assert np.array_equal(one.position, other.position)


def test_a_floor_is_left_out_of_an_operation_on_floors_alone(planned) -> None:
    engine, session = planned
    floor = the(session, "floor")
    with pytest.raises(BadInput, match="no face would lead it any more; suppress it"):
        with_guide_faces(engine, session, floor.id, leave_out=floor.faces)
    wall = min(walls_of(engine, session, the(session, "wall")))
    with pytest.raises(BadInput, match=f"can be on face {wall}; they are on faces"):
        with_guide_faces(engine, session, floor.id, add=[wall])


def test_a_new_route_keeps_the_faces_that_a_person_gave(planned) -> None:
    engine, session = planned
    before = the(session, "wall")
    tag = min(walls_of(engine, session, before))
    changed = with_guide_faces(engine, session, before.id, leave_out=[tag])
    choices = {**changed.choices, "route.wall_allowance": 0.4}
    routed = engine.run(replace(changed, choices=choices), until="optimize")
    assert the(routed, "wall").faces == the(changed, "wall").faces
    assert the(routed, "wall").own_faces
    assert engine.guides(routed, before.id).lines[0].chain.on.count(tag) == 0


def test_what_can_not_lead_it_is_told(planned) -> None:
    engine, session = planned
    wall, rough = the(session, "wall"), the(session, "rough")
    with pytest.raises(BadInput, match="face 999 is not one of its faces"):
        with_guide_faces(engine, session, wall.id, leave_out=[999])
    with pytest.raises(BadInput, match="on face 999"):
        with_guide_faces(engine, session, wall.id, add=[999])
    with pytest.raises(BadInput, match="plane.rough works on areas"):
        with_guide_faces(engine, session, rough.id, leave_out=[1])
    with pytest.raises(BadInput, match="there is no operation wall-99"):
        with_guide_faces(engine, session, "wall-99", leave_out=[1])
    with pytest.raises(BadCall, match="generate the route first"):
        with_guide_faces(engine, replace(session, process=None), wall.id, add=[1])
    assert with_guide_faces(engine, session, wall.id, add=wall.faces[:1]) is session


def test_toolpaths_keep_the_guide_lines_that_led_them(planned) -> None:
    engine, session = planned
    wall = the(session, "wall")
    chains = [g.chain for g in engine.guides(session, wall.id).lines]
    assert list(session.path_of(wall.id).guides) == chains
    assert set(walls_of(engine, session, wall)) <= set(chains[0].on)
    tops = session.path_of(next(o.id for o in session.process.operations if o.kind == "rib_top"))
    assert all(any(chain.on) or chain.faces for chain in tops.guides)


def test_a_hole_is_left_out_of_an_operation_on_several(tmp_path) -> None:
    engine = Engine()
    holes = [hole(20, 15, 8), hole(80, 15, 8), hole(80, 45, 8)]
    session = engine.open(plate(tmp_path / "plate.step", *holes))
    session = engine.run(session, until="toolpath")
    drill = next(o for o in session.process.operations if o.kind == "drill")
    assert len(drill.faces) == 3
    gone = drill.faces[1]
    changed = rerun(engine, with_guide_faces(engine, session, drill.id, leave_out=[gone]))
    axes = [g.chain.faces for g in engine.guides(changed, drill.id).lines]
    assert axes == [(drill.faces[0],), (drill.faces[2],)]
    cut, all_cut = (s.path_of(drill.id).path for s in (changed, session))
    assert 0 < len(cut) < len(all_cut)
