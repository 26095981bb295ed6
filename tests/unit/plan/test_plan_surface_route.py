"""The route of parts of curved surfaces: every face is planned or told of, local features have their own cutter, sides are found."""

from __future__ import annotations

from dataclasses import replace

import cadquery as cq
import pytest
from lxml import etree

from samples import written
from seeded.blades import blade
from trunnion.findings import BadInput, Severity
from trunnion.geometry.cut import plane_cut
from trunnion.pipeline import Engine
from trunnion.pipeline.planning.patches import with_cut
from trunnion.plan.freeform.cutters.choice import named
from trunnion.plan.freeform.keys import ALLOWANCE, EARLIER, SCALLOP
from trunnion.shop import load_shop
from trunnion.store.process import process_xml

CURVED = {"recognize.family": "surface"}


def routed(shape, **words):
    return routed_file(written(shape), **words)


def routed_file(file, **words):
    engine = Engine()
    session = engine.open(file)
    return engine.run(engine.with_choices(session, {**CURVED, **words}), "route")


def hilly():
    """Return a block with a wide, gentle hill and a small dome on it."""
    hill = (
        cq.Workplane("XY")
        .sphere(60)
        .translate((30, 20, -48))
        .intersect(cq.Workplane("XY").box(60, 40, 40, centered=False))
    )
    dome = cq.Workplane("XY").sphere(4).translate((20, 20, 10.5))
    return cq.Workplane("XY").box(60, 40, 8, centered=False).union(hill).union(dome).val().wrapped


@pytest.fixture(scope="module")
def session():
    return routed(hilly())


def planned(process):
    return {tag for o in process.operations for tag in o.faces}


def test_every_face_is_planned_or_lies_in_the_blank(session):
    tags = {tag for f in session.recognition for tag in f.tags}
    told = {
        int(w.removeprefix("face "))
        for f in session.process.findings
        if f.code == "route.not-planned"
        for w in f.where
    }
    assert len(tags - planned(session.process) - told) == 1
    assert not told


def test_layers_come_first_and_finishing_last(session):
    kinds = [o.kind for o in session.process.operations]
    assert kinds[0] == "rough"
    assert kinds.index("profile_finish") < kinds.index("finish")
    for o in session.process.operations:
        done = {b.id for b in session.process.operations[: session.process.operations.index(o)]}
        assert set(o.after) <= done


def test_a_local_feature_has_a_cutter_and_operations_of_its_own(session):
    by_id = {o.id: o for o in session.process.operations}
    dome = next(f for f in session.recognition if f.attributes["local"])
    assert set(by_id["finish-local-01"].faces) <= set(dome.tags)
    assert by_id["finish-remaining"].tool.diameter > by_id["finish-local-01"].tool.diameter or (
        by_id["finish-remaining"].tool.name == by_id["finish-local-01"].tool.name
    )


def test_finishing_leaves_the_wanted_scallop_and_semi_finishing_its_allowance(session):
    for o in session.process.operations:
        if o.kind == "finish":
            assert (o.choices[SCALLOP], o.choices[ALLOWANCE]) == (0.004, 0.0)
        if o.kind == "semi":
            assert (o.choices[SCALLOP], o.choices[ALLOWANCE]) == (0.05, 0.1)


def test_tools_are_numbered_in_the_order_of_use(session):
    numbers = [o.tool.number for o in session.process.operations]
    assert numbers == sorted(numbers) or [
        n for k, n in enumerate(numbers) if n not in numbers[:k]
    ] == sorted(set(numbers))


@pytest.fixture(scope="module")
def sharp():
    """The route of a gently domed plate with a wide boss whose foot is sharp: a large ball leaves some per cent of the plate beside it."""
    return routed(_with_sharp_boss())


def _with_sharp_boss():
    plate = cq.Workplane("XY").box(140.0, 110.0, 20.0, centered=(True, True, False))
    dome = cq.Workplane("XY").sphere(600.0).translate((0.0, 0.0, -585.0))
    boss = cq.Workplane("XY").circle(16.0).extrude(24.0, taper=4.0)
    return plate.intersect(dome).union(boss).val().wrapped


def test_a_larger_cutter_goes_before_an_area_s_own_where_both_are_quicker(sharp):
    operations = sharp.process.operations
    chain = [o for o in operations if o.kind in ("finish", "rest_finish") and "remaining" in o.id]
    ids = [o.id for o in chain if not o.id.endswith("-steep")]
    assert ids[:2] == ["finish-remaining", "rest-finish-remaining"]
    first, own = (next(o for o in chain if o.id == id) for id in ids[:2])
    assert first.cutter.diameter > own.cutter.diameter
    assert EARLIER not in first.choices and own.choices[EARLIER] == first.cutter.name
    for o in chain:
        earlier = o.choices.get(EARLIER)
        before = operations[: operations.index(o)]
        assert earlier is None or any(
            b.cutter.name == earlier and set(b.faces) & set(o.faces) for b in before
        )


def test_what_the_larger_cutter_leaves_is_semi_finished_too(sharp):
    semi = {o.id: o for o in sharp.process.operations if o.kind == "semi"}
    first, rest = semi["semi-remaining"], semi["semi-remaining-rest"]
    own = sharp.process.operation("rest-finish-remaining")
    assert rest.cutter.name == own.cutter.name and rest.choices[EARLIER] == first.cutter.name
    assert rest.choices[ALLOWANCE] == first.choices[ALLOWANCE] > 0.0
    assert set(rest.faces) == set(own.faces)


@pytest.fixture(scope="module")
def with_named_cutter(sharp):
    """The name of the smaller of that plate's two cutters, and the plate's route where a person names it, and asks for less."""
    own = sharp.process.operation("rest-finish-remaining").cutter.name
    return own, routed(_with_sharp_boss(), **{"surface.cutter": own, "surface.ra": 3.2})


def test_no_larger_cutter_goes_before_one_that_a_person_names(with_named_cutter):
    own, chosen = with_named_cutter
    assert chosen.process.operation("finish-remaining").cutter.name == own


def test_a_person_may_name_the_cutters(with_named_cutter):
    own, chosen = with_named_cutter
    finish = chosen.process.operation("finish-remaining")
    assert finish.tool.name == own
    assert finish.choices[SCALLOP] == pytest.approx(0.008)


def test_a_cutter_that_is_not_there_is_named_with_those_it_is_nearest_to():
    with pytest.raises(
        BadInput, match="no cutter al2-ball d6 r5 in the catalogue; .*AL2-ball D6 R3"
    ):
        named(load_shop(), "al2-ball d6 r5")


def test_semi_finishing_that_leaves_more_than_roughing_is_refused():
    with pytest.raises(
        BadInput, match=r"surface.semi_allowance.* 0.5 mm, .*surface.rough_allowance"
    ):
        routed(hilly(), **{"surface.semi_allowance": 0.5})


def test_patches_that_no_side_sees_are_segmented_but_not_planned():
    engine = Engine()
    ball = cq.Workplane().sphere(10).cut(cq.Workplane().circle(3).extrude(20))
    shell = cq.Shell.makeShell([f for f in ball.faces().vals() if f.geomType() == "SPHERE"])
    found = engine.run(
        engine.with_choices(engine.open(written(shell.wrapped)), CURVED), "recognize"
    )
    assert [f.kind for f in found.recognition] == ["group"]
    assert "open.no-side" in {f.code for f in found.findings()}
    with pytest.raises(BadInput, match="can't be machined from any one side.*choose open.side"):
        engine.run(found, "route")


def spool():
    """Return a post between two plates: what lies between them is hidden from above."""
    plate = cq.Workplane("XY").box(30, 30, 6)
    return (
        plate.translate((0, 0, 3))
        .union(cq.Workplane("XY").circle(6).extrude(30))
        .union(plate.translate((0, 0, 29)))
        .val()
        .wrapped
    )


def test_without_rotary_axes_what_is_hidden_is_told_of_with_a_remedy():
    process = routed(spool()).process
    (told,) = [f for f in process.findings if f.code == "route.not-planned"]
    assert len(told.where) == 3
    assert "rotary axes" in told.remedy
    assert all(o.direction == (0.0, 0.0, 1.0) for o in process.operations)


def test_with_rotary_axes_it_is_roughed_from_two_sides_and_finished_leaning():
    process = routed(spool(), **{"setup.machine": "Trunnion 650"}).process
    sides = [o for o in process.operations if o.direction != (0.0, 0.0, 1.0)]
    assert {round(o.direction[2], 9) for o in sides} == {0.0}
    first, second = {o.direction for o in sides}
    assert first == pytest.approx(tuple(-v for v in second))
    leaning = [
        o for o in process.operations if o.strategy == "surface.point" and o.kind == "finish"
    ]
    assert sorted(len(o.faces) for o in leaning) == [1, 1, 1]
    assert not [f for f in process.findings if f.code == "route.not-planned"]


def test_beside_what_hangs_over_no_thick_cutter_comes_first_and_the_leaning_one_last(tmp_path):
    process = routed_file(
        blade(0).written(tmp_path), **{"setup.machine": "Trunnion 650", "surface.scallop": 0.02}
    ).process
    rests = [o for o in process.operations if EARLIER in o.choices]
    # Of the area beside the blade the smallest cutter that reaches enough is the first one.
    assert rests and not [o for o in rests if o.kind == "semi"]
    after = {o.id: o.after for o in process.operations}
    assert "semi-remaining" in after["semi-remaining-leaning"]


def test_an_operations_direction_is_in_the_xml_where_it_is_not_the_setups_z(session):
    process = session.process
    tilted = replace(process.operations[0], direction=(0.6, 0.0, 0.8))
    root = etree.fromstring(process_xml(process.with_operation(tilted), session.part))
    first, second = root.findall("operation")[:2]
    assert dict(first.find("direction").attrib) == {"x": "0.6", "y": "0.0", "z": "0.8"}
    assert second.find("direction") is None


@pytest.fixture(scope="module")
def speckled():
    """The hilly block with a patch of 0.3 mm cut out of its hill, which joins no group."""
    engine = Engine()
    session = engine.with_choices(engine.open(written(hilly())), CURVED)
    hill = max(
        (t for t in engine.context_of(session).part.tags),
        key=lambda t: _round_area(engine, session, t),
    )
    session = with_cut(engine, session, plane_cut(hill, (34.0, 0.0, 0.0), (1.0, 0.0, 0.0)))
    for point, normal in (
        ((34.3, 0.0, 0.0), (1.0, 0.0, 0.0)),
        ((0.0, 22.3, 0.0), (0.0, 1.0, 0.0)),
        ((0.0, 22.0, 0.0), (0.0, 1.0, 0.0)),
    ):
        graph = engine.context_of(session).part.graph()
        face = next(
            t
            for t in engine.context_of(session).part.tags
            if graph.surface[t - 1] == "sphere" and _holds(graph, t, (34.15, 22.15))
        )
        session = with_cut(engine, session, plane_cut(face, point, normal))
    return engine.run(session, "route"), engine


def _round_area(engine, session, tag):
    graph = engine.context_of(session).part.graph()
    return graph.area[tag - 1] if graph.surface[tag - 1] == "sphere" else 0.0


def _holds(graph, tag, at):
    return (
        all(graph.box_low[tag - 1][k] <= at[k] <= graph.box_high[tag - 1][k] for k in (0, 1))
        and graph.box_high[tag - 1][2] > 9.0
    )


def test_a_speck_on_a_curved_face_joins_no_group_and_is_told(speckled):
    session, _ = speckled
    (speck,) = session.recognition.unexplained
    told = next(f for f in session.findings() if f.code == "surface.small")
    assert told.where == (f"face {speck}",)
    assert "0.42" in told.text and "0.5 mm" in told.text and "mm2" in told.text


def test_a_speck_is_finished_with_the_area_around_it(speckled):
    session, engine = speckled
    (speck,) = session.recognition.unexplained
    graph = engine.context_of(session).part.graph()
    around = {row + 1 for row in graph.neighbours(speck - 1)}
    mine = [o for o in session.process.operations if speck in o.faces]
    assert {"semi", "finish"} <= {o.kind for o in mine}
    assert all(around & set(o.faces) for o in mine)
    assert not [f for f in session.process.findings if f.code == "route.not-planned"]


def test_who_cuts_a_speck_is_told(speckled):
    session, _ = speckled
    (speck,) = session.recognition.dropped
    (told,) = (f for f in session.process.findings if f.code == "route.dropped")
    cutting = [o.id for o in session.process.operations if speck in o.faces]
    assert told.where == (f"face {speck}",) and cutting
    assert f"face {speck} by " in told.text and all(id in told.text for id in cutting)


def test_a_group_that_a_person_deleted_is_not_cut(speckled):
    session, engine = speckled
    gone = next(f for f in session.recognition if f.attributes.get("local"))
    after = engine.run(replace(session, recognition=session.recognition.without(gone.id)), "route")
    assert not set(gone.tags) & planned(after.process)


def test_a_hole_through_a_hill_is_finished_inside_it_with_a_cutter_that_has_space():
    hole = cq.Workplane("XY", origin=(40.0, 20.0, 0.0)).circle(8.0).extrude(30.0)
    process = routed(cq.Workplane(cq.Shape.cast(hilly())).cut(hole).val().wrapped).process
    assert not [f for f in process.findings if f.severity is Severity.ERROR]
    (inside,) = (
        o for o in process.operations if o.kind == "profile_finish" and o.cutter.diameter < 13.0
    )
    assert 1.25 * inside.cutter.radius < 8.0


def test_what_falls_off_steeply_to_the_blank_s_underside_is_finished_by_one_cutter():
    """Half a cone lies on its flat side: a ball touches the lowest of it from below the blank only, where paths go too."""
    cone = cq.Workplane("YZ").circle(12.0).workplane(offset=60.0).circle(8.0).loft()
    half = cone.intersect(cq.Workplane("XY").box(200.0, 200.0, 50.0, centered=(True, True, False)))
    session = routed(half.val().wrapped)
    by_id = {o.id: o for o in session.process.operations}
    steep, shallow = (by_id[f"finish-remaining{end}"] for end in ("-steep", ""))
    assert steep.faces == shallow.faces and steep.tool.name == shallow.tool.name
    assert not [o for o in session.process.operations if o.kind == "rest_finish"]
