"""An operation's tool, spindle speed and feed set by hand: what follows from them, what stays, and what is refused."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from pytest import approx

from flat_parts import operation
from own_shop import own_shop
from trunnion.findings import BadInput
from trunnion.geometry.frame import WORLD
from trunnion.model.process import ProcessTree
from trunnion.model.setup import Setup
from trunnion.plan.cutting.milling import CuttingSettings, cutting_data
from trunnion.plan.cutting.optimize import balance
from trunnion.plan.cutting.power import cutting_power
from trunnion.plan.freeform.keys import EARLIER
from trunnion.plan.manual.operation_change import OperationChange, with_change
from trunnion.settings import choose

SHOP = own_shop()
MATERIAL, MACHINE = SHOP.material("EN AW-7075"), SHOP.machine("Mill 1200")
LIMITS = choose(CuttingSettings, {})


def tool(name: str):
    return next(t for t in SHOP.tools if t.name == name)


def process() -> ProcessTree:
    """Return a plan that roughs with D 20, then finishes a rest that knows the earlier cutter."""
    large = tool("AL3-regular D20 R3")
    rough = replace(
        operation("rough", "pocket-01", large),
        faces=(3,),
        data=cutting_data(large, MATERIAL, MACHINE, "rough", LIMITS, 12.0, 10.0),
    )
    small = replace(tool("AL3-regular D10 R3"), number=2)
    rest = replace(
        operation("corner", "pocket-01", small),
        faces=(3,),
        choices={EARLIER: large.name},
        data=cutting_data(small, MATERIAL, MACHINE, "corner", LIMITS, 5.0, 2.0),
    )
    setup = Setup(name="S1", frame=WORLD, work_offset="G54", clearance=20.0, machine="Mill 1200")
    return ProcessTree(
        plan="by hand", material=MATERIAL.name, setups=(setup,), operations=(rough, rest)
    )


def change(**values) -> OperationChange:
    return choose(OperationChange, {f"operation.{name}": v for name, v in values.items()})


def changed(id: str = "rough-pocket-01", **values) -> ProcessTree:
    return with_change(process(), id, change(**values), SHOP, {})


def test_a_feed_by_hand_gives_its_feed_per_tooth_removal_rate_and_power():
    before = process().operation("rough-pocket-01").data
    data = changed(feed=3000.0).operation("rough-pocket-01").data
    assert data.feed == 3000.0 and data.spindle == before.spindle
    assert data.feed_per_tooth == approx(3000.0 / (3 * before.spindle))
    assert data.removal_rate == approx(12.0 * 10.0 * 3000.0 / 1000.0)
    expected = cutting_power(MATERIAL, 20.0, data.feed_per_tooth, 12.0, 10.0, 3000.0)
    assert data.power == approx(expected)
    assert data.torque == approx(expected * 30_000.0 / (math.pi * data.spindle))
    assert data.plunge_feed / data.feed == approx(before.plunge_feed / before.feed)
    assert data.rules[-1] == "vf 3000 mm/min: set by hand"
    assert [r for r in data.rules if r.startswith("fz")] == []
    assert [r for r in data.rules if r.startswith("vc")] != []


def test_a_spindle_speed_by_hand_keeps_the_feed_a_minute():
    before = process().operation("rough-pocket-01").data
    data = changed(spindle=8000.0).operation("rough-pocket-01").data
    assert (data.spindle, data.feed) == (8000.0, before.feed)
    assert data.speed == approx(math.pi * 20.0 * 8000.0 / 1000.0)
    assert data.feed_per_tooth == approx(before.feed / (3 * 8000.0))
    assert data.power_limit == approx(MACHINE.power_at(8000.0) * LIMITS.power_share)


def test_another_tool_brings_the_data_of_the_tables_and_followers_know_it():
    made = changed(tool="AL3-regular D16 R3")
    first = made.operation("rough-pocket-01")
    assert first.tool.name == "AL3-regular D16 R3" and first.by_hand
    assert first.data.spindle == approx(700_000.0 / (math.pi * 16.0))
    assert first.rules[-1] == "AL3-regular D16 R3 instead of AL3-regular D20 R3: a person chose it."
    assert made.operation("corner-pocket-01").choices[EARLIER] == "AL3-regular D16 R3"
    assert [o.tool.number for o in made.operations] == [1, 2]


def test_tool_speed_and_feed_together_are_those_that_were_given():
    data = changed(tool="AL3-regular D16 R3", spindle=9000.0, feed=2500.0).operations[0].data
    assert (data.spindle, data.feed) == (9000.0, 2500.0)
    assert data.feed_per_tooth == approx(2500.0 / (3 * 9000.0))


def test_what_was_set_by_hand_stays_when_data_are_balanced_again():
    made = changed(feed=3000.0, spindle=8000.0)
    again = balance(made, SHOP, LIMITS, {}).operation("rough-pocket-01")
    assert (again.data.feed, again.data.spindle, again.by_hand) == (3000.0, 8000.0, True)


def test_nothing_new_changes_nothing():
    before = process()
    now = before.operation("rough-pocket-01")
    same = change(tool=now.tool.name, spindle=now.data.spindle, feed=now.data.feed)
    assert with_change(before, now.id, same, SHOP, {}) is before
    assert not now.by_hand


@pytest.mark.parametrize(
    ("id", "values", "words"),
    [
        ("rough-pocket-09", {"feed": 100.0}, "there is no operation rough-pocket-09; known: rough"),
        ("rough-pocket-01", {"tool": "EM99"}, "there is no tool EM99 in the catalogue"),
        ("rough-pocket-01", {"tool": "DR-S D10"}, "can't do the work of AL3-regular D20 R3"),
        ("rough-pocket-01", {"tool": "HM4-regular D10 R0"}, "not made for EN AW-7075"),
        ("rough-pocket-01", {"spindle": 90_000.0}, "turns its spindle at"),
        ("rough-pocket-01", {"feed": 190_000.0}, "feeds at most"),
        ("rough-pocket-01", {"feed": -1.0}, "feed"),
    ],
)
def test_what_can_not_be_is_refused_in_one_line(id, values, words):
    with pytest.raises(BadInput) as refused:
        changed(id, **values)
    assert words in str(refused.value) and "\n" not in str(refused.value)
