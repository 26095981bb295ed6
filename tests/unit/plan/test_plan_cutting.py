"""Cutting data: worked-out numbers, and the bounds of machine and cutter."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from pytest import approx

from flat_parts import operation
from own_shop import own_shop
from trunnion.geometry.frame import WORLD
from trunnion.model.process import ProcessTree
from trunnion.model.setup import Setup
from trunnion.plan.cutting.engaged import (
    CONSTANT_ENGAGEMENT,
    engaged_depth,
    engaged_width,
    roughing_choice,
    strip_engagement,
)
from trunnion.plan.cutting.milling import (
    CuttingSettings,
    chip_thinning,
    cutting_data,
    layer_depth,
    layer_width,
    roughing_depth,
    roughing_width,
    slenderness,
    table_feed,
)
from trunnion.plan.cutting.optimize import balance
from trunnion.plan.cutting.power import cutting_power
from trunnion.settings import choose

SHOP = own_shop()
ALUMINIUM, MACHINE, DEFAULT = (
    SHOP.material("EN AW-7075"),
    SHOP.machine("Mill 1200"),
    choose(CuttingSettings, {}),
)

TABLES = {"optimize.data": "handbook"}


def tool(name: str):
    return next(t for t in SHOP.tools if t.name == name)


def test_chips_thin_out_below_half_the_diameter_only():
    assert chip_thinning(10.0, 5.0) == 1.0
    assert chip_thinning(10.0, 8.0) == 1.0
    assert chip_thinning(10.0, 1.0) == approx(10.0 / (2 * 3.0))


def test_the_feed_per_tooth_lies_on_the_materials_table():
    # Three quarters of the way from 0.08 to 0.13 at D 12.
    assert table_feed(ALUMINIUM, 12.0) == approx(0.1175)
    assert table_feed(ALUMINIUM, 14.0) == approx((0.1175 + 0.135) / 2)
    assert table_feed(ALUMINIUM, 4.0) == approx(0.06 * 4 / 5)
    assert table_feed(ALUMINIUM, 25.0) == approx(0.1525)


def test_the_spindle_follows_from_speed_and_diameter():
    data = cutting_data(
        tool("AL3-regular D20 R3"), ALUMINIUM, MACHINE, "rough", DEFAULT, 12.0, 10.0
    )
    assert data.spindle == approx(700_000 / (math.pi * 20))
    assert data.feed == approx(data.spindle * 3 * 0.1525)


def test_a_small_cutter_is_bound_by_the_spindle_and_says_so():
    data = cutting_data(tool("AL3-stub D4 R0"), ALUMINIUM, MACHINE, "rough", DEFAULT, 1.0, 2.0)
    assert data.spindle == 24000
    assert data.speed == approx(24 * math.pi * 4)
    assert any("the spindle's limit" in rule for rule in data.rules)


def test_power_by_kienzle_at_half_the_width():
    # ae = D / 2: the arc is 90 degrees, the mean chip 0.1 * 2 * 0.5 / (pi / 2).
    chip = 0.1 / (math.pi / 2)
    assert cutting_power(ALUMINIUM, 20.0, 0.1, 5.0, 10.0, 3000.0) == approx(
        5 * 10 * 3000 * 700 * chip**-0.25 / 60e6
    )


def test_the_spindles_power_slows_the_feed():
    weak = replace(MACHINE, power=((50.0, 0.1), (24000.0, 4.0)))
    data = cutting_data(tool("AL3-regular D20 R3"), ALUMINIUM, weak, "rough", DEFAULT, 20.0, 20.0)
    assert data.power == approx(data.power_limit, rel=1e-6)
    assert any("the spindle gives" in rule for rule in data.rules)


def test_the_machines_feed_is_never_passed():
    slow = replace(MACHINE, feed_max=500.0)
    assert (
        cutting_data(tool("AL3-regular D20 R3"), ALUMINIUM, slow, "wall", DEFAULT, 5.0, 0.5).feed
        == 500.0
    )


def test_a_long_cutter_loses_feed():
    short, long = tool("HM4-stub D10 R0"), tool("HM4-long D10 R0")
    assert slenderness(short, DEFAULT) == 1.0
    assert slenderness(long, DEFAULT) == approx(1.0 - 0.5 * (6.0 - 4.0) / 6.0)


def test_torque_and_power_belong_together():
    data = cutting_data(tool("AL3-regular D20 R3"), ALUMINIUM, MACHINE, "rough", DEFAULT, 12.0, 5.0)
    assert data.torque * data.spindle * 2 * math.pi / 60 == approx(data.power * 1000)


def process(kind: str, by_hand: bool = False) -> ProcessTree:
    one = replace(operation(kind, "pocket-01", tool("AL3-regular D20 R3")), by_hand=by_hand)
    setup = Setup(name="S1", frame=WORLD, work_offset="G54", clearance=20.0, machine="Mill 1200")
    return ProcessTree(plan="", material="EN AW-7075", setups=(setup,), operations=(one,))


def test_layers_that_slots_open_are_deeper_where_the_material_says_so():
    cutter = tool("AL3-regular D20 R0")
    assert layer_depth(cutter, ALUMINIUM, DEFAULT) == approx(20.0)
    assert roughing_depth(cutter, ALUMINIUM, DEFAULT) == approx(12.0)
    titanium = SHOP.material("Ti-6Al-4V")
    assert layer_depth(cutter, titanium, DEFAULT) == roughing_depth(cutter, titanium, DEFAULT)


def test_at_constant_engagement_a_shallower_cut_is_wider_at_the_same_section():
    cutter = tool("AL3-regular D20 R0")
    # Two diameters, of which its flutes are 38 mm long, at 0.3 diameters.
    assert engaged_depth(cutter, ALUMINIUM, DEFAULT) == approx(38.0)
    for depth in (38.0, 35.0, 25.0):
        assert engaged_width(cutter, ALUMINIUM, DEFAULT, depth) * depth == approx(40.0 * 6.0)
    # No wider than half the diameter, where every tooth still climbs.
    assert engaged_width(cutter, ALUMINIUM, DEFAULT, 10.0) == approx(10.0)
    titanium = SHOP.material("Ti-6Al-4V")
    for depth in (40.0, 10.0):
        assert engaged_width(cutter, titanium, DEFAULT, depth) == approx(2.0)


def test_only_a_material_with_deep_slots_lets_a_flank_meet_corners():
    assert ALUMINIUM.bears_deep_slots
    assert not SHOP.material("Ti-6Al-4V").bears_deep_slots


def test_balance_keeps_a_wide_shallow_cut_at_constant_engagement():
    cutter = tool("AL3-regular D20 R0")
    chosen = roughing_choice(cutter, ALUMINIUM, MACHINE, DEFAULT, 25.0, CONSTANT_ENGAGEMENT)
    tree = process("rough")
    tree = replace(tree, operations=(replace(tree.operations[0], data=chosen.data),))
    found = balance(tree, SHOP, DEFAULT, TABLES).operations[0].data
    assert (found.depth, found.width) == (approx(25.0), approx(9.6))


def test_balance_keeps_deep_layers_and_bounds_them_by_a_persons_share():
    tree = process("rough")
    one = tree.operations[0]
    data = cutting_data(one.cutter, ALUMINIUM, MACHINE, "rough", DEFAULT, 18.0, 5.0)
    tree = replace(tree, operations=(replace(one, data=data),))
    for share, depth in ((1.0, 18.0), (0.5, 10.0)):
        limits = replace(DEFAULT, depth_share=share)
        found = balance(tree, SHOP, limits, TABLES).operations[0].data
        assert found.depth == approx(depth)
        assert found.entry_angle == ALUMINIUM.entry_angle > 0.0


def test_balance_computes_every_operation_again():
    data = balance(process("wall"), SHOP, DEFAULT, TABLES).operations[0].data
    assert data.spindle == approx(900_000 / (math.pi * 20))


def test_balance_leaves_what_a_person_set():
    assert (
        balance(process("wall", by_hand=True), SHOP, DEFAULT, TABLES).operations[0].data.spindle
        == 1000
    )


@pytest.mark.parametrize("material", sorted(SHOP.materials))
def test_data_of_every_material_keep_the_machines_limits(material):
    group = SHOP.material(material)
    for cutter in SHOP.tools_for(group.iso_group, "rough"):
        data = cutting_data(
            cutter, group, MACHINE, "rough", DEFAULT, cutter.diameter, cutter.diameter / 4
        )
        assert (
            0 < data.feed <= MACHINE.feed_max
            and data.power <= data.power_limit * 1.000001
            and data.spindle <= 24000
        )


def test_layers_in_aluminium_are_half_the_diameter_wide_and_in_titanium_as_other_roughing():
    cutter, titanium = tool("AL3-regular D20 R0"), SHOP.material("Ti-6Al-4V")
    assert layer_width(cutter, ALUMINIUM, DEFAULT) == approx(10.0)
    assert roughing_width(cutter, ALUMINIUM, DEFAULT) == approx(5.0)
    assert layer_width(cutter, titanium, DEFAULT) == roughing_width(cutter, titanium, DEFAULT)
    narrow = replace(DEFAULT, width_share=0.5)
    assert layer_width(cutter, ALUMINIUM, narrow) == approx(5.0)


def test_ramps_are_fed_at_three_quarters_of_the_feed_and_go_down_no_faster_than_a_plunge():
    data = cutting_data(
        tool("AL3-regular D20 R0"), ALUMINIUM, MACHINE, "rough", DEFAULT, 15.0, 10.0
    )
    assert data.ramp_feed(math.radians(5.0)) == approx(0.75 * data.feed)
    # Steeper than about 32 degrees, 0.4 of the feed down is less than that along the slope.
    steep = math.radians(60.0)
    assert data.ramp_feed(steep) * math.sin(steep) == approx(data.plunge_feed)
    assert data.ramp_feed(math.pi / 2.0) == approx(data.plunge_feed)
    plunged = replace(data, ramp_share=0.0)
    assert plunged.ramp_feed(math.radians(5.0)) == data.plunge_feed


def test_a_lower_limit_on_the_width_narrows_layers_that_were_routed_wider():
    cutter = tool("AL3-regular D20 R0")
    data = cutting_data(cutter, ALUMINIUM, MACHINE, "rough", DEFAULT, 15.0, 10.0)
    rough = replace(operation("rough", "pocket-01", cutter), data=data)
    setup = Setup(name="S1", frame=WORLD, work_offset="G54", clearance=20.0, machine=MACHINE.name)
    process = ProcessTree(plan="", material=ALUMINIUM.name, setups=(setup,), operations=(rough,))
    (same,) = balance(process, SHOP, DEFAULT, TABLES).operations
    (less,) = balance(process, SHOP, replace(DEFAULT, width_share=0.6), TABLES).operations
    assert (same.data.width, less.data.width) == (approx(10.0), approx(6.0))


@pytest.mark.parametrize(
    ("name", "material", "height", "depth", "width"),
    [
        # One pass 36 mm deep takes half the time of two that are 18 mm deep.
        ("AL3-regular D20 R0", "EN AW-7075", 36.0, 36.0, 4.5),
        # Flutes are 38 mm long: two layers either way, and the wider of equals.
        ("AL3-regular D20 R0", "EN AW-7075", 40.0, 20.0, 4.5),
        # Titanium bears no deep slot, which a ring meets in a notch.
        ("HM4-regular D20 R0", "Ti-6Al-4V", 36.0, 12.0, 3.0),
    ],
)
def test_a_strip_along_a_wall_is_taken_off_in_the_least_time(name, material, height, depth, width):
    found = strip_engagement(
        tool(name), SHOP.material(material), MACHINE, DEFAULT, "profile_rough", height, 4.5
    )
    assert found == (approx(depth), approx(width))
