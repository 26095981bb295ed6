"""The turning of a casing: its setups, what is turned in each, the machine that does it, and the way from route to verdict."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import shapely

import samples
from seeded.casings import short_ring
from trunnion.findings import Severity
from trunnion.geometry.frame import WORLD
from trunnion.model.blank import Revolved
from trunnion.model.operation import Operation
from trunnion.model.session import Session
from trunnion.pipeline import Engine
from trunnion.plan.blank import ring_turned_outline
from trunnion.plan.casing.turning_route import held_height, held_straight, lathe_for
from trunnion.plan.cutting.milling import CuttingSettings
from trunnion.plan.turning.operations import SetupTurning
from trunnion.plan.turning.reach import TurningLimits
from trunnion.plan.turning.settings import TurningSettings
from trunnion.shop import load_shop
from turned_rings import SETUP

CHOICES = {
    "setup.machine": "Trunnion 650",
    "recognize.family": "casing",
    "blank.kind": "turned",
    "blank.bored": True,
}
RING = shapely.Polygon(
    [(94, 0), (120, 0), (120, 10), (100, 10), (100, 90), (120, 90), (120, 100), (94, 100)]
)


@cache
def routed(part, **choices) -> tuple[Engine, Session]:
    engine = Engine()
    session = engine.open(samples.written(part(), name=part.__name__))
    words = {**CHOICES, **{k.replace("__", "."): v for k, v in choices.items()}}
    return engine, engine.run(engine.with_choices(session, words), until="route")


def turning(session: Session) -> list[Operation]:
    return [o for o in session.process.operations if not o.tool.rotates]


def test_what_turning_leaves_is_where_milling_begins():
    engine, session = routed(short_ring)
    setups = session.setups
    assert [s.name for s in setups] == ["S1", "S2", "S3"]
    assert [s.machine for s in setups] == ["Vertical lathe 600"] * 2 + ["Trunnion 650"]
    assert [s.work_offset for s in setups] == ["G54", "G55", "G56"]
    assert {o.setup for o in turning(session)} == {"S1", "S2"}
    assert setups[0].blank is None
    left, frame = setups[2].blank, session.recognition.frame
    assert isinstance(left, Revolved)
    part = engine.context.part
    ring = ring_turned_outline(frame, part.mesh(), part.graph())
    a, b = (shapely.Polygon(x) for x in (left.outline, ring))
    # Grooves of 4 mm beside the ring of bosses are too narrow for these inserts: some is left to milling. What must stand stands.
    assert b.difference(a).area < 0.01 and a.difference(b).area < 20.0


def test_the_first_setup_has_the_lower_end_up_and_both_turn_about_the_axis():
    _, session = routed(short_ring)
    over, upright = (s.frame for s in session.setups[:2])
    assert np.allclose(over.z, -upright.z) and np.allclose(upright.z, session.recognition.frame.z)
    for frame in (over, upright):
        origin = session.recognition.frame.to_local(frame.origin)
        assert np.allclose(origin[:2], 0.0, atol=1e-9)
    assert upright.to_local(over.origin)[2] == pytest.approx(-26.0)


def test_the_first_setup_turns_what_the_second_holds_and_a_little_more():
    _, session = routed(short_ring)
    first = [o.choices["turn.lowest"] for o in turning(session) if o.setup == "S1"]
    second = [
        o.choices["turn.lowest"]
        for o in turning(session)
        if o.setup == "S2" and o.choices["turn.side"] != "face"
    ]
    # The lower flange is 4 mm thick: 3 mm past it, and then all but half a millimetre of it.
    assert set(first) == {-7.0} and second and all(v == pytest.approx(-22.5) for v in second)


def test_finishing_operations_name_the_faces_that_their_chips_come_off():
    _, session = routed(short_ring)
    finishing = [o for o in turning(session) if o.kind == "turning_finish"]
    assert finishing and all(o.faces for o in finishing if o.setup == "S2" and o.id.endswith("S2"))
    assert not any(o.faces for o in turning(session) if o.kind == "turning_rough")


def test_a_blank_that_comes_turned_is_not_turned_again():
    _, session = routed(short_ring, blank__kind="ring-turned")
    assert not turning(session)
    assert "route.turned" in {f.code for f in session.process.findings}
    assert "route.turned" not in {f.code for f in routed(short_ring)[1].process.findings}


def test_a_blank_without_a_bore_has_no_inside_to_turn():
    shop = load_shop()
    machine, material = shop.machine("Vertical lathe 600"), shop.material("EN AW-7075")
    plan = shop.plan_for("casing")
    turned = SetupTurning(
        setup=SETUP,
        part=RING,
        stock=shapely.box(0.0, 0.0, 125.0, 102.0),
        limits=TurningLimits(floor=8.0, lowest=8.0),
        tools=shop.turning,
        material=material,
        table=shop.turning_for(material),
        spindle=machine.work_spindle,
        cutting=CuttingSettings(),
        settings=TurningSettings(),
    )
    for stage in plan.stages:
        if stage.cutter == "turn_inside":
            turned.plan(stage, "profile-01")
    assert not turned.operations
    (found,) = turned.findings
    assert (found.code, found.severity) == ("route.no-boring-bar", Severity.WARNING)
    assert "no bore" in found.text


def test_a_machine_that_does_not_turn_is_named():
    _, session = routed(short_ring, casing__lathe="Mill 1200")
    (found,) = (f for f in session.process.findings if f.code == "route.not-turned")
    assert found.severity is Severity.ERROR and "Mill 1200 turns no blank" in found.text


@pytest.mark.parametrize(
    ("outline", "height"),
    [
        (RING, 10.0),
        # No flange: a share of the length, and never more than what is sensible to hold.
        (shapely.box(50.0, 0.0, 60.0, 40.0), 10.0),
        (shapely.box(50.0, 0.0, 60.0, 400.0), 20.0),
        # A cone that grows upwards has none either.
        (shapely.Polygon([(50, 0), (60, 0), (80, 100), (50, 100)]), 20.0),
    ],
)
def test_a_casing_is_held_where_its_lower_flange_ends(outline, height):
    assert held_height(outline) == pytest.approx(height, abs=0.1)


def test_turned_over_the_ground_behind_the_flange_stays():
    kept = held_straight(RING, 10.0)
    assert kept.bounds == (94.0, 0.0, 120.0, 100.0) and kept.area == pytest.approx(2600.0, abs=1.0)


@pytest.fixture(scope="module")
def proven():
    """Return the short ring with nothing but its turning, posted, read back and proven."""
    engine, session = routed(short_ring)
    process = session.process
    kept = tuple(replace(o, suppressed=o.tool.rotates) for o in process.operations)
    session = replace(session, process=replace(process, operations=kept))
    return engine.run(
        engine.with_choices(session, {"repair.rounds": 0, "verify.coverage": 0.2}), until="verify"
    )


def test_turning_passes_its_proof_from_the_posted_text(proven):
    verdict = proven.verdict
    assert (verdict.gouge < 2e-3, verdict.collisions, verdict.rapids_in_stock) == (True, 0, 0)
    assert {o.outcome.value for o in verdict.operations} == {"passed"}
    assert all(o.removed > 0.0 and o.power > 0.0 for o in verdict.operations)
    assert {f.suffix for f in proven.posted if f.setup} == {"S1.MPF", "S2.MPF"}
    assert verdict.releases, [str(f) for f in verdict.findings]


def test_turned_faces_are_finished(proven):
    done = {f.face: f for f in proven.verdict.faces if f.planned and not f.blank_surface}
    assert len(done) >= 5
    assert all(f.gouge < 2e-3 for f in done.values())
    # In the narrow grooves beside the rings of bosses the ground is left to milling.
    assert sum(f.finished for f in done.values()) >= 0.8 * sum(f.area for f in done.values())


def test_the_text_turns_with_its_own_words(proven):
    text = next(f.text for f in proven.posted if f.suffix == "S2.MPF")
    assert (
        "G18 DIAMON" in text and "G962 S" in text and "X IS A DIAMETER WHILE THE WORK TURNS" in text
    )


def test_turning_again_changes_nothing(proven):
    engine, _ = routed(short_ring)
    assert engine.run(proven, until="verify").verdict is proven.verdict


def test_the_smallest_machine_that_takes_the_blank_turns_it():
    shop = load_shop()

    def blank(radius: float) -> Revolved:
        return Revolved.cylinder(WORLD, radius, (0.0, 100.0), "EN AW-7075", 2.8)

    assert lathe_for(shop, "", blank(100.0))[0].name == "Vertical lathe 600"
    assert lathe_for(shop, "", blank(400.0))[0].name == "Vertical lathe 1250"
    machine, why = lathe_for(shop, "", blank(700.0))
    assert machine is None and "1400 mm across" in why[0].text
    strong = replace(shop.machine("Vertical lathe 600"))
    assert strong.work_spindle.power_at(150.0) == pytest.approx(1.0 + 36.0 * 140.0 / 290.0)
