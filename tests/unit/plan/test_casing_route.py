"""Routes of casings: what is planned on the least of them, in which order, and from which blank."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import shapely

import samples
from seeded.casings import bolted_ring, ribbed_ring
from shaped_parts import part_of_shape
from subjects import own, part_of, until
from trunnion.geometry.turned_state import round_and_straight, turned_state
from trunnion.model.feature import Feature
from trunnion.pipeline import Engine
from trunnion.plan.freeform.lands import LATERAL
from trunnion.plan.holes.route import outward_direction
from trunnion.plan.tool_choice import Candidates
from trunnion.recognize.revolution import RevolutionAxis, of_revolution


def routed():
    return until("casing", "route")


def test_its_blank_is_what_turning_leaves():
    session = routed()
    outline = session.blank.outline
    # Bore and ground of the short ring are done, and a ring stands as high as the farthest corner of its bosses.
    assert np.isclose(outline[:, 0], 21.0).sum() == 2
    assert np.isclose(outline[:, 0], 24.0).sum() >= 2
    between = (outline[:, 1] > 4.5) & (outline[:, 1] < 21.5)
    assert outline[between, 0].max() >= math.hypot(27.0, 3.5) - 1e-6


def test_bottoms_are_roughed_first_and_bosses_go_along_their_own_normals():
    session = routed()
    process = session.process
    assert process.operations[0].strategy == "plane.rough"
    tops = [o for o in process.operations if o.kind == "land"]
    part, frame = part_of(own("casing")[0]), session.setups[0].frame
    assert len(tops) == 2
    for o in tops:
        normal = frame.local_direction(part.graph().normal[o.faces[0] - 1])
        assert np.allclose(o.direction, normal, atol=1e-9)


def test_every_boss_gets_its_top_and_sides_and_the_hole_is_drilled_along_its_axis():
    process = routed().process
    sides = {o.feature for o in process.operations if o.strategy == "surface.waterline"}
    tops = {o.feature for o in process.operations if o.kind == "land"}
    assert sides == tops and len(tops) == 2
    drilled = [o for o in process.operations if o.kind == "drill"]
    assert len(drilled) == 1 and abs(drilled[0].direction[2]) < 1e-6


@pytest.mark.parametrize(("hollow", "left"), [(1.0, True), (2.05, False), (30.0, False)])
def test_sides_with_hollows_that_nothing_goes_into_are_cut_by_one_of_the_smallest(hollow, left):
    """A random boss of three lobes had hollows of R 2.16: no cutter was nine tenths of that, and the whole program was refused for it."""
    # An engine of its own: the shared one's session may have been made while a package's family was registered, and is stale without it.
    shared, known = own("casing")
    engine = Engine()
    opened = engine.with_choices(engine.open(part_of(shared).path), known.choices)
    session = engine.run(opened, until="route")
    bosses = {f.id for f in session.recognition.of_kind("boss")}
    features = tuple(
        replace(f, sizes={**f.sizes, "concave_radius": hollow}) if f.id in bosses else f
        for f in session.recognition.features
    )
    process = engine.run(
        replace(session, recognition=replace(session.recognition, features=features), process=None),
        "route",
    ).process
    sides = [o for o in process.operations if o.strategy == "surface.waterline"]
    assert {o.feature for o in sides} == bosses
    told = [f for f in process.findings if "hollows of R" in f.text]
    assert len(told) == (len(bosses) if left else 0)
    assert all(f.severity == "warning" for f in told)
    if hollow < 10.0:
        assert len({o.cutter.diameter for o in sides}) == 1
        assert sides[0].cutter.diameter < 5.0


def test_passes_on_the_bottom_lie_no_farther_apart_than_its_bend_allows():
    bottoms = [o for o in routed().process.operations if o.kind == "floor"]
    # Half a stepover w leaves w^2 / 8 r: 0.01 mm on a radius of 24.
    assert bottoms and all(o.data.width**2 / (8.0 * 24.0) <= 0.0101 for o in bottoms)


def test_what_must_come_turned_is_said():
    assert "route.turned" in {f.code for f in routed().process.findings}


@pytest.mark.parametrize(
    ("direction", "through", "out"),
    [
        # Recognition may give a through hole either way: it is drilled from outside.
        ((-1.0, 0.0, 0.0), True, (1.0, 0.0, 0.0)),
        ((1.0, 0.0, 0.0), True, (1.0, 0.0, 0.0)),
        ((-0.8, 0.0, 0.6), True, (0.8, 0.0, -0.6)),
        ((-1.0, 0.0, 0.0), False, (-1.0, 0.0, 0.0)),
        ((0.0, 0.0, -1.0), True, (0.0, 0.0, -1.0)),
    ],
)
def test_through_holes_are_left_away_from_the_axis(direction, through, out):
    hole = Feature(
        id="hole-01",
        kind="hole",
        faces=(),
        sizes={"x": 90.0, "y": 3.0, "top_z": 20.0, "depth": 12.0, "diameter": 6.0},
        attributes={"direction": direction, "through": through},
    )
    assert np.allclose(outward_direction(hole), out)


def test_what_is_left_on_faces_that_hang_over_is_what_roughing_leaves():
    # Not twice the depth of cut, the boss's height: that would keep necks off flanges that lean over a boss by all of it.
    sides = [o for o in routed().process.operations if o.strategy == "surface.waterline"]
    assert sides and all(o.choices["surface.overhang"] == 0.5 for o in sides)


def test_bolts_under_the_upper_flange_are_drilled_with_the_part_turned_over():
    engine = Engine()
    session = engine.open(samples.written(bolted_ring(), name="bolted-ring"))
    choices = {"setup.machine": "Trunnion 650"}
    session = engine.run(engine.with_choices(session, choices), until="route")
    process, part = session.process, engine.context.part
    drilled = [o for o in process.operations if o.kind == "drill"]
    assert [(o.setup, len(o.all_features)) for o in drilled] == [("S1", 6), ("S2", 6)]
    assert [o.setup for o in process.operations] == sorted(o.setup for o in process.operations)
    # Each setup drills the flange that is up in it, straight down.
    up = [setup.frame.z @ session.recognition.frame.z for setup in session.setups]
    assert up == pytest.approx([1.0, -1.0])
    graph = part.graph()
    height = session.recognition.frame.to_local(graph.sample_point)[:, 2]
    upper, lower = (
        float(height[np.isin(graph.sample_face, [t - 1 for t in o.faces])].mean()) for o in drilled
    )
    assert (lower, upper) == pytest.approx((2.5, 87.5), abs=1.0)
    assert all(o.direction == (0.0, 0.0, 1.0) for o in drilled)
    codes = {f.code for f in process.findings}
    assert "route.turned-over" in codes and "hole.not-reached" not in codes


def test_a_boss_that_runs_into_a_rib_is_topped_up_to_the_rib():
    engine = Engine()
    session = engine.open(samples.written(ribbed_ring(), name="ribbed-ring"))
    choices = {"setup.machine": "Trunnion 650", "recognize.family": "casing"}
    process = engine.run(engine.with_choices(session, choices), until="route").process
    assert "route.no-cutter" not in {f.code for f in process.findings}
    lateral = {o.feature: o.choices[LATERAL] for o in process.operations if o.kind == "land"}
    # The rib cuts a boss in two, whose tops end at its sides; the third stands alone.
    assert sorted(lateral.values()) == [0.0, 0.0, 1.0]


def test_a_hole_that_no_drill_gets_at_for_what_stands_around_is_left_to_another_setup(monkeypatch):
    def hindered(*_):
        return Candidates(tools=(), reason="every drill would come too near", hindered=True)

    monkeypatch.setattr("trunnion.plan.holes.route.drills_for", hindered)
    monkeypatch.setattr("trunnion.plan.holes.route.mills_of", lambda *_: Candidates(tools=()))
    engine, session = own("casing")
    found = engine.run(session, until="route")
    codes = {f.code for f in found.process.findings}
    assert "hole.not-reached" in codes and "route.no-cutter" not in codes
    assert not [o for o in found.process.operations if o.kind == "drill"]


@pytest.mark.parametrize("seed", range(6))
def test_what_turning_leaves_does_not_hang_on_the_last_digits(seed):
    # Askew in its file a part has its heights to a hundredth of a micrometre: bolts of a flange end at its face all the same.
    part = part_of_shape(bolted_ring())
    mesh, graph = part.mesh(), part.graph()
    turned = of_revolution(
        graph, RevolutionAxis(point=np.zeros(3), direction=np.array([0, 0, 1.0]))
    )
    faces = round_and_straight(turned, graph.surface)
    exact = turned_state(mesh.points, mesh.triangles, mesh.face, *faces)
    noise = np.random.default_rng(seed).normal(scale=3e-8, size=mesh.points.shape)
    noisy = turned_state(mesh.points + noise, mesh.triangles, mesh.face, *faces)
    assert shapely.Polygon(exact).symmetric_difference(shapely.Polygon(noisy)).area < 0.01
