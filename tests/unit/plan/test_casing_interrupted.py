"""Interrupted turning in a casing's route: on which machines, between which operations, and what milling is left."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from gap_turning import RING
from subjects import own, part_of
from trunnion.geometry.frame import WORLD
from trunnion.model.blank import Revolved
from trunnion.pipeline import Engine
from trunnion.plan.casing.interrupted_route import turns_and_mills
from trunnion.plan.casing.turning_route import lathe_for
from trunnion.plan.cutting.interrupted import interrupted_data
from trunnion.plan.cutting.milling import CuttingSettings
from trunnion.settings import choose
from trunnion.shop import load_shop


@cache
def routed(until: str = "route", **more):
    shared, _ = own("casing")
    engine = Engine()
    choices = {**RING, **{key.replace("__", "."): value for key, value in more.items()}}
    session = engine.with_choices(engine.open(part_of(shared).path), choices)
    return engine.run(session, until=until)


def kinds(session) -> list[str]:
    return [o.kind for o in session.process.operations]


def test_gaps_are_turned_after_roughing_and_before_bottoms():
    process = routed().process
    (turned,) = [o for o in process.operations if o.kind == "interrupted"]
    assert turned.tool.locked and turned.spindle == 0.0
    assert turned.faces and turned.choices
    order = kinds(routed())
    assert max(k for k, kind in enumerate(order) if kind == "rough") < order.index("interrupted")
    assert order.index("interrupted") < order.index("floor")
    assert "route.locked-spindle" in {f.code for f in process.findings}


@pytest.mark.parametrize(
    "more",
    [
        {"casing__interrupted": False},
        {"setup__machine": "Trunnion 650"},
        # At 40 m/min no gap of so small a ring is long enough.
        {"casing__regions__surface_speed": 40.0},
        {"casing__regions__threshold": 500.0},
    ],
)
def test_else_bottoms_are_milled_throughout(more):
    assert "interrupted" not in kinds(routed(**more))
    assert "floor" in kinds(routed(**more))


def test_only_a_table_that_turns_under_a_head_that_leans_holds_turning_inserts():
    machines = load_shop().machines.values()
    assert [m.name for m in machines if turns_and_mills(m)] == ["Mill-turn 1250"]


@pytest.mark.parametrize(
    ("wanted", "radius", "rule"),
    [
        (8.0, 300.0, "speed for interrupted cuts"),
        # 65 m/min of the table of titanium; axis C at 100 1/min; 40 m/min less the way out, at 15 mm over 300.
        (500.0, 20.0, "axis C turns at 100"),
        (500.0, 300.0, "feeds at most 40"),
    ],
)
def test_the_speed_is_bounded_by_table_and_feed(wanted, radius, rule):
    shop = load_shop()
    machine, material = shop.machine("Mill-turn 1250"), shop.material("Ti-6Al-4V")
    insert = next(t for t in shop.tools if t.locked)
    data = interrupted_data(
        insert,
        material,
        shop.turning_for(material),
        machine,
        machine.work_spindle,
        choose(CuttingSettings, {}),
        speed=wanted,
        retract_speed=20.0,
        radius=radius,
        lift=15.0,
        depth=0.3,
        ridge=0.006,
    )
    assert rule in data.rules[1 if wanted > 100.0 else 0]
    assert data.speed <= wanted
    # Over the ground, at the lift and while it retracts, nothing is fed more quickly than the machine does.
    fastest = np.hypot(data.speed * (radius + 15.0) / radius, 20.0)
    assert fastest <= 40.0 * (1.0 + 1e-9)
    assert data.feed_per_tooth**2 / (8.0 * insert.radius) <= 0.006 * (1.0 + 1e-9)
    assert data.power < data.power_limit


def test_ground_that_the_machine_brings_too_slowly_is_milled_and_told():
    # Axis C turns a ring of 24 mm at 15 m/min at most.
    session = routed(casing__regions__surface_speed=200.0, casing__regions__lowest_speed=100.0)
    assert "interrupted" not in kinds(session)
    (told,) = [f for f in session.process.findings if f.code == "route.gaps-milled"]
    assert "inserts need 100" in told.text


def test_a_machine_that_turns_and_mills_is_no_lathe():
    shop = load_shop()
    machine = shop.machine("Mill-turn 1250")
    blank = Revolved(
        frame=WORLD,
        outline=np.array([[500.0, 0.0], [660.0, 0.0], [660.0, 100.0], [500.0, 100.0]]),
        material="Ti-6Al-4V",
        density=4.4,
    )
    # It would take this blank, which is too large for the lathes.
    assert 2.0 * blank.radius < machine.work_spindle.largest_diameter
    assert lathe_for(shop, "", blank)[0] is None
    assert lathe_for(shop, machine.name, blank)[0] is None
