"""Holes beside the bore of a wheel: drilled from the back with the wheel turned over, through to the proof."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import pytest

import samples
from releases import assert_released
from seeded.impellers import small_impeller
from subjects import WHEEL
from trunnion.findings import Severity
from trunnion.model.operation import Operation
from trunnion.model.session import Session
from trunnion.pipeline import Engine

HOLES = 3
TINY, ODD = 1.0, 3.374
"""Diameters in mm: no end mill gets into the one, no drill has the other."""


@cache
def bolted(diameter: float = 5.0, between: float = 0.0) -> tuple[Engine, Session]:
    """Return an engine with a small wheel that has blind holes in its back, and its session with features."""
    engine = Engine()
    shape = small_impeller(holes=HOLES, diameter=diameter, between=between)
    session = engine.open(samples.written(shape, name=f"bolted-wheel-{diameter:g}"))
    return engine, engine.run(engine.with_choices(session, WHEEL), until="recognize")


@cache
def routed() -> Session:
    """Return the session of the wheel with holes of 5 mm, with its route."""
    engine, session = bolted()
    return engine.run(session, until="route")


@cache
def odd_ones_routed() -> Session:
    """Return the session of a wheel with tiny and odd holes in its back, with its route."""
    engine, session = bolted(TINY, ODD)
    return engine.run(session, until="route")


def on_holes_of(session: Session, diameter: float) -> tuple[set[str], list[Operation]]:
    """Return the holes of a diameter, and the operations on them."""
    holes = {
        f.id
        for f in session.recognition.of_kind("hole")
        if f.sizes["diameter"] == pytest.approx(diameter, abs=1e-3)
    }
    return holes, [o for o in session.process.operations if holes & set(o.all_features)]


def test_blind_holes_in_the_back_are_made_with_the_wheel_turned_over():
    session, process = routed(), routed().process
    holes = session.recognition.of_kind("hole")
    assert len(holes) == HOLES
    on_holes = [o for o in process.operations if "hole" in o.feature]
    assert [(o.kind, o.strategy, o.setup, len(o.all_features)) for o in on_holes] == [
        ("drill", "hole.drill", "S2", HOLES),
        ("hole_floor", "hole.mill", "S2", HOLES),
    ]
    # The drill leaves its point over the floor, which the end mill of the second one takes.
    assert {t for o in on_holes for t in o.faces} == {t for f in holes for t in f.tags}
    drill, floor = on_holes
    assert drill.cutter.diameter == pytest.approx(5.0, abs=0.02)
    assert floor.cutter.form == "flat" and floor.cutter.diameter < 5.0
    # All of the first setup comes before, and how the wheel is turned is told.
    names = [o.setup for o in process.operations]
    assert names == sorted(names) and [s.name for s in process.setups] == ["S1", "S2"]
    codes = {f.code for f in process.findings}
    assert "route.turned-over" in codes
    assert not codes & {"hole.not-reached", "route.no-cutter"}
    # What comes turned does not name them.
    (told,) = [f for f in process.findings if f.code == "route.turned"]
    assert not set(told.where) & {f.id for f in holes}


def test_drills_take_their_speed_and_feed_from_the_table_of_drilling():
    process = routed().process
    (drill,) = [o for o in process.operations if o.kind == "drill"]
    assert any("drilling" in rule for rule in drill.data.rules)
    assert drill.data.plunge_feed == drill.data.feed


def test_holes_are_spotted_first_where_the_shop_wants_that():
    engine, session = bolted()
    session = engine.with_choices(session, {**session.choices, "holes.spot": True})
    process = engine.run(session, until="route").process
    on_holes = [o for o in process.operations if "hole" in o.feature]
    assert [o.kind for o in on_holes] == ["spot", "drill", "hole_floor"]
    spot, drill, _ = on_holes
    assert len(spot.all_features) == HOLES and not spot.faces and spot.id in drill.after


def test_a_flat_floor_that_no_end_mill_gets_at_keeps_the_point_of_its_drill():
    session = odd_ones_routed()
    holes, operations = on_holes_of(session, TINY)
    assert len(holes) == HOLES and [o.kind for o in operations] == ["drill"]
    # One warning for all that have the same reason.
    (told,) = [f for f in session.process.findings if f.code == "route.no-cutter"]
    assert told.severity is Severity.WARNING and "hole floors" in told.text
    assert holes <= set(told.where)


def test_a_hole_that_no_drill_has_the_diameter_of_is_milled_by_a_small_end_mill():
    """A random wheel was refused for holes of D 3.374: the smallest end mill was one of 4 mm."""
    session = odd_ones_routed()
    _, (mill,) = on_holes_of(session, ODD)
    assert (mill.kind, mill.setup, len(mill.all_features)) == ("hole_mill", "S2", HOLES)
    assert mill.cutter.diameter <= 0.8 * ODD and mill.cutter.form == "flat"
    shop = bolted(TINY, ODD)[0].context_of(session).shop
    # What is for holes alone cuts nothing else.
    small = shop.tools_for("N", "hole_mill")
    assert small and not {t.name for t in small} & {
        t.name for use in ("face", "rough", "finish", "surface") for t in shop.tools_for("N", use)
    }


def test_holes_that_neither_setup_reaches_are_told_of():
    engine, session = bolted()
    leaning = {"direction": (0.0, 0.6, -0.8)}
    features = tuple(
        replace(f, attributes={**f.attributes, **leaning}) if f.kind == "hole" else f
        for f in session.recognition.features
    )
    recognition = replace(session.recognition, features=features)
    found = engine.run(replace(session, recognition=recognition, process=None), "route")
    holes = {f.id for f in recognition.of_kind("hole")}
    told = [f for f in found.process.findings if set(f.where) & holes]
    assert told and all(f.severity is not Severity.INFO for f in told)


@pytest.mark.long
def test_a_wheel_with_holes_in_its_back_is_released():
    engine, session = bolted()
    session = engine.run(session)
    assert_released(session, coverage=0.3)
    tags = {t for f in session.recognition.of_kind("hole") for t in f.tags}
    left = [f for f in session.verdict.findings if f.code == "verify.unplanned"]
    assert not [f for f in left if set(f.where) & {f"face {t}" for t in tags}]
