"""Cutting data of reamers and taps: tables, limits of the machine, and the feed of a tap that nothing eases."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import programs
from own_shop import own_shop
from trunnion.findings import BadInput, Fix
from trunnion.plan.cutting.milling import CuttingSettings
from trunnion.plan.cutting.optimization.operation import can_be_optimised
from trunnion.plan.cutting.optimize import recomputed
from trunnion.plan.cutting.peak import is_overload, with_peak
from trunnion.plan.cutting.power import tapping_torque, tool_power
from trunnion.plan.holes.cutting_data import hole_data, is_on_holes
from trunnion.plan.holes.finish_tools import set_to
from trunnion.plan.manual.operation_change import OperationChange, with_change
from trunnion.plan.repair.contract import RepairJob
from trunnion.plan.repair.feed import with_lower_feed

SHOP = own_shop()
TOOLS = {t.name: t for t in SHOP.tools}
ALUMINIUM, STEEL = SHOP.material("EN AW-7075"), SHOP.material("C45")
MILL = SHOP.machine("Mill 1200")
REAMER, TAP = TOOLS["RE-H7 D10"], TOOLS["TAP-B M8x1.25"]
ALL_TAPS = [t for t in SHOP.tools if t.form == "tap"]
ALL_REAMERS = [t for t in SHOP.tools if t.form == "reamer"]


def tapped(tool=TAP, material=ALUMINIUM, machine=MILL, **limits):
    return hole_data("tap", tool, material, machine, SHOP, CuttingSettings(**limits))


def reamed(tool=REAMER, material=ALUMINIUM, machine=MILL, **limits):
    return hole_data("ream", tool, material, machine, SHOP, CuttingSettings(**limits))


def test_a_tap_turns_at_the_tables_speed_by_whole_revolutions_and_is_fed_by_its_pitch():
    data = tapped()
    # 20 m/min on 8 mm: 795.8 1/min.
    assert (data.spindle, data.feed, data.plunge_feed) == (795.0, 993.75, 993.75)
    assert data.speed == pytest.approx(math.pi * 8 * 795 / 1000)
    assert data.feed_per_tooth * TAP.teeth == pytest.approx(1.25)
    assert data.depth == pytest.approx(0.541266 * 1.25, rel=1e-5)


@settings(deadline=None)
@given(
    st.sampled_from(ALL_TAPS),
    st.sampled_from(sorted(SHOP.materials)),
    st.sampled_from(sorted(SHOP.machines)),
    st.floats(0.3, 3.0),
    st.floats(0.2, 2.0),
    st.floats(100.0, 30_000.0),
)
def test_a_taps_feed_is_its_pitch_times_whole_revolutions_under_any_limits(
    tool, material, machine, speed_share, feed_share, spindle_limit
):
    limits = {"speed_share": speed_share, "feed_share": feed_share, "spindle_limit": spindle_limit}
    machine = SHOP.machine(machine)
    data = tapped(tool, SHOP.material(material), machine, **limits)
    assert data.spindle.is_integer()
    assert data.feed == tool.pitch * data.spindle
    assert data.spindle <= min(machine.spindle_high, spindle_limit)
    assert data.feed <= machine.feed_max
    assert data.power == pytest.approx(data.torque * data.spindle * math.tau / 60_000)


def test_the_torque_of_a_tap_is_that_of_the_formula():
    # h = P^2 / (2 z l), with l of five threads: P / 30.
    chip = 1.25 / 30
    specific = STEEL.force * chip**-STEEL.force_exponent
    assert tapping_torque(STEEL, TAP) == pytest.approx(1.25**2 * 8 * specific / 8000)
    # Lubero's table has 2500 N/mm2 for steel of 500 to 950 N/mm2: 3.9 Nm; ours is more, not twice as much.
    assert 1.25**2 * 8 * 2500 / 8000 < tapping_torque(STEEL, TAP) < 2 * 1.25**2 * 8 * 2500 / 8000


def test_a_spindle_that_is_slower_lowers_a_taps_speed():
    data = tapped(spindle_limit=500.5)
    assert (data.spindle, data.feed) == (500.0, 625.0)
    assert any("limit of spindle or feed" in rule for rule in data.rules)
    slow = replace(MILL, feed_max=300.0)
    assert (tapped(machine=slow).spindle, tapped(machine=slow).feed) == (240.0, 300.0)


def test_torque_that_the_spindle_gives_only_at_a_lower_speed_lowers_the_speed():
    # 0.25 kW at any speed but the lowest: the torque falls as the speed grows.
    weak = replace(MILL, spindle_low=10.0, power=((10.0, 0.25), (24_000.0, 0.25)))
    free, bound = tapped(material=STEEL), tapped(material=STEEL, machine=weak)
    assert bound.spindle < free.spindle and bound.feed == 1.25 * bound.spindle
    assert bound.power <= bound.power_limit < bound.torque * (bound.spindle + 1) * math.tau / 60_000
    assert not is_overload(bound)


def test_torque_that_no_speed_gives_is_an_overload():
    weak = replace(MILL, power=((MILL.spindle_high, 0.01),))
    data = tapped(TOOLS["TAP-B M24x3"], STEEL, weak)
    assert is_overload(data) and data.feed == 3.0 * data.spindle
    assert any("more than the spindle gives at any speed" in rule for rule in data.rules)


def test_a_tap_takes_off_the_groove_of_its_thread():
    data = tapped()
    # Between a third and a half of the ring between minor and major diameter: the thread stands in the rest of it.
    ring = math.pi / 4 * (8.0**2 - 6.647**2) * data.feed / 1000
    assert 0.33 * ring < data.removal_rate < 0.5 * ring


def test_a_reamer_has_speed_feed_and_depth_of_its_table():
    data, table = reamed(), SHOP.reaming_for(ALUMINIUM)
    assert data.speed == table.speed == 150.0
    assert data.feed / data.spindle == pytest.approx(0.38)
    assert table.allowance(10.0) == (0.2, 0.3) and data.depth == 0.15
    assert data.removal_rate == pytest.approx(math.pi * 9.85 * 0.15 * data.feed / 1000)
    assert any("0.2 to 0.3 mm smaller" in rule for rule in data.rules)


@pytest.mark.parametrize("material", sorted(SHOP.materials))
def test_every_material_can_be_reamed_and_tapped(material):
    found = SHOP.material(material)
    for tool in ALL_REAMERS:
        data = reamed(tool, found)
        assert 0.0 < data.power <= data.power_limit and data.feed > 0.0
        least, most = SHOP.reaming_for(found).allowance(tool.diameter)
        assert 0.0 < least <= most < 0.2 * tool.diameter and data.depth == most / 2
    assert tapped(TAP, found).spindle < reamed(TOOLS["RE-H7 D8"], found).spindle


@pytest.mark.parametrize("group", ["N", "P", "M", "K", "S"])
def test_every_group_has_tables_with_sources(group):
    material = replace(STEEL, name="of the group", iso_group=group)
    assert SHOP.reaming_for(material).source.count(": ") >= 3
    assert SHOP.tapping_for(material).source.startswith("speed: ")


def test_a_reamer_goes_slower_on_a_weak_spindle():
    weak = replace(MILL, power=((MILL.spindle_high, 0.3),))
    free, bound = reamed(material=STEEL), reamed(material=STEEL, machine=weak)
    assert bound.feed < free.feed and bound.power == pytest.approx(bound.power_limit)


def test_only_a_tap_taps_and_only_a_reamer_reams():
    with pytest.raises(BadInput, match="DR-K D10 is no tap"):
        hole_data("tap", TOOLS["DR-K D10"], STEEL, MILL, SHOP, CuttingSettings())
    with pytest.raises(BadInput, match="TAP-B M8x1.25 is no reamer"):
        hole_data("ream", TAP, STEEL, MILL, SHOP, CuttingSettings())
    assert is_on_holes("tap", TAP) and is_on_holes("ream", REAMER) and is_on_holes("", TAP)


def test_a_group_without_a_table_is_told_with_the_folder():
    hard = replace(STEEL, name="Hard", iso_group="H")
    with pytest.raises(BadInput, match="nothing is known of tapping Hard.* to the tapping folder"):
        tapped(material=hard)
    with pytest.raises(BadInput, match="nothing is known of reaming Hard.* to the reaming folder"):
        reamed(material=hard)


def tree_with(tool, data, kind="tap", material="C45"):
    """Return a plan of one operation with a tool, and the operation."""
    tree = programs.process_tree()
    operation = replace(tree.operations[0], kind=kind, tool=tool, data=data, choices={})
    setups = tuple(replace(s, machine="Mill 1200") for s in tree.setups)
    return replace(tree, material=material, setups=setups, operations=(operation,)), operation


def test_power_of_a_reamer_and_a_tap_is_that_of_their_data():
    for tool, data in ((REAMER, reamed()), (TAP, tapped())):
        power = tool_power(ALUMINIUM, tool, data.feed_per_tooth, data.depth, data.width, data.feed)
        assert power == pytest.approx(data.power)


@pytest.mark.parametrize(("tool", "kind"), [(REAMER, "ream"), (TAP, "tap"), (TAP, "rough")])
def test_reamers_and_taps_keep_their_tables(tool, kind):
    _, operation = tree_with(tool, tapped() if tool is TAP else reamed(), kind)
    assert not can_be_optimised(operation)


def test_data_computed_again_have_the_pitch_under_a_share_of_feeds():
    tree, operation = tree_with(TAP, tapped())
    again = recomputed(operation, tree, STEEL, SHOP, CuttingSettings(feed_share=0.5)).data
    assert again.feed == 1.25 * again.spindle and again.spindle < operation.data.spindle


def test_a_peak_over_the_limit_does_not_slow_a_tap():
    data = replace(tapped(material=STEEL), power_limit=1e-3)
    for tool, slows in ((TAP, False), (TOOLS["DR-K D10"], True)):
        _, operation = tree_with(tool, data, "drill")
        found = with_peak(replace(operation, strategy="hole.drill"), (), STEEL, {})
        assert (found.data.feed < data.feed) is slows


def test_a_repair_does_not_lower_the_feed_of_a_tap():
    job = RepairJob(shop=SHOP, choices={})
    for tool, data, lowers in ((TAP, tapped(), False), (REAMER, reamed(), True)):
        tree, operation = tree_with(tool, data)
        fix = Fix(kind="feed", operation=operation.id, amount=0.5)
        assert (with_lower_feed(tree, fix, job) is not None) is lowers


def by_hand(change, tool=TAP, data=None):
    tree, operation = tree_with(tool, data or tapped(material=STEEL))
    return with_change(tree, operation.id, change, SHOP, {}).operations[0]


def test_a_spindle_speed_by_hand_takes_a_taps_feed_along():
    data = by_hand(OperationChange(spindle=300.0)).data
    assert (data.spindle, data.feed, data.plunge_feed) == (300.0, 375.0, 375.0)
    assert data.torque == pytest.approx(tapping_torque(STEEL, TAP))
    assert data.power == pytest.approx(data.torque * 300 * math.tau / 60_000)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (OperationChange(feed=500.0), "a tap's feed is its pitch times the spindle speed"),
        (OperationChange(spindle=300.5), "a whole number of revolutions a minute, not at 300.5"),
        (OperationChange(spindle=24_000.0), "the pitch asks for 30000 mm/min"),
        (
            OperationChange(tool="TAP-B M8x1"),
            "cuts another thread .* a tap of D 8 and pitch 1.25 mm",
        ),
        (OperationChange(tool="DR-K D8"), "a tap tool is needed"),
    ],
)
def test_what_would_strip_a_thread_by_hand_is_refused(change, words):
    with pytest.raises(BadInput, match=words):
        by_hand(change)


def test_another_tap_of_the_same_thread_may_stand_in_by_hand():
    changed = by_hand(OperationChange(tool="TAP-C M8x1.25"))
    assert changed.tool.name == "TAP-C M8x1.25" and changed.data.feed == 1.25 * changed.data.spindle


def test_power_of_a_reamer_by_hand_is_that_of_its_ring():
    data = by_hand(OperationChange(feed=100.0), REAMER, reamed(material=STEEL)).data
    chip = 100.0 / (6 * data.spindle) * math.sqrt(0.5)
    area = math.pi * 9.85 * 0.15
    assert data.power == pytest.approx(
        area * 100.0 * STEEL.force * chip**-STEEL.force_exponent / 6e7
    )


def test_a_boring_bar_has_speed_feed_and_depth_of_its_own_table():
    bar = set_to(next(t for t in SHOP.tools if t.name == "FB D20-26"), 22.0, "H6")
    table = SHOP.boring_for(ALUMINIUM)
    data = hole_data("fine_bore", bar, ALUMINIUM, MILL, SHOP, CuttingSettings())
    low, high = table.feeds[0][1:]
    assert data.speed == pytest.approx(table.speed)
    assert data.feed / data.spindle == pytest.approx(low + table.feed_share * (high - low))
    assert data.depth == pytest.approx(0.5 * table.allowance(22.0)[1])
    # One edge: the ring of the depth of cut at the chip of a lead of 45 degrees.
    chip = data.feed / data.spindle * math.sqrt(0.5)
    area = math.pi * (22.0 - data.depth) * data.depth
    force = ALUMINIUM.force * chip**-ALUMINIUM.force_exponent
    assert data.power == pytest.approx(area * data.feed * force / 6e7)
    assert any("boring wrought aluminium" in rule for rule in data.rules)


@pytest.mark.parametrize("material", sorted(SHOP.materials))
def test_every_material_may_be_bored(material):
    table = SHOP.boring_for(SHOP.material(material))
    assert table.speed > 0.0 and 0.0 < table.allowance(30.0)[0] < table.allowance(30.0)[1]
