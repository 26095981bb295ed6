"""Thread milling as panels are planned: when it takes the place of taps, with which tools, at which data."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pytest import approx

from holed import HIGH, hole
from trunnion.findings import BadInput
from trunnion.plan.cutting.milling import CuttingSettings
from trunnion.plan.cutting.optimization.operation import can_be_optimised
from trunnion.plan.cutting.optimize import recomputed
from trunnion.plan.cutting.peak import is_overload, with_peak
from trunnion.plan.holes.cutting_data import hole_data, is_on_holes
from trunnion.plan.holes.demand import thread_demand, with_demand
from trunnion.plan.holes.hole import HoleThread
from trunnion.plan.holes.settings import ThreadMillSettings
from trunnion.plan.holes.thread_mills import pitch_tolerance, thread_mills_for, widening
from trunnion.plan.manual.operation_change import OperationChange, with_change
from trunnion.settings import choose
from walled_plates import SHOP, around, route, walled

TOOLS = {t.name: t for t in SHOP.tools}
MILLS = [t for t in SHOP.tools if t.form == "thread-mill"]
ALUMINIUM, STEEL, TITANIUM = (SHOP.material(n) for n in ("EN AW-7075", "C45", "Ti-6Al-4V"))
MACHINE = SHOP.machine("Mill 1200")
MILLING = choose(ThreadMillSettings, {})
ALWAYS = {"holes.thread_milling": "always"}


def planned(*holes_and_demands, **choices):
    """Return the process of a plate with holes, each with the thread that is demanded of it."""
    part, found = walled(*(h for h, _ in holes_and_demands))
    for n, (_, demand) in enumerate(holes_and_demands, 1):
        found = with_demand(found, [f"hole-{n:02}"], demand, SHOP)
    return route((part, found), **choices)


def of_kind(process, *kinds):
    return [o for o in process.operations if o.kind in kinds]


def test_a_thread_that_no_tap_has_is_milled_after_its_bore():
    process = planned((hole(50, 30, 25), thread_demand("M27x2")))
    (mill,) = of_kind(process, "thread_mill")
    assert (mill.strategy, mill.feature, mill.faces) == ("hole.thread_mill", "hole-01", (3,))
    # Two turns of ten teeth; of those that get into 25 mm the thickest that keeps the flanks.
    assert mill.tool.name == "TM-C D20x2"
    (before,) = of_kind(process, "hole_mill", "drill")
    assert before.id in mill.after and not of_kind(process, "tap") and not process.findings


def test_a_blind_thread_that_no_taps_lead_leaves_is_milled():
    """14 mm of a bore of 16 mm: a tap M8 has a lead of 3.1 mm and stays 1 mm over the bottom."""
    deep = hole(30, 30, 6.8, 16.0, point_angle=140.0)
    (mill,) = of_kind(planned((deep, thread_demand("M8", 13.5))), "tap", "thread_mill")
    assert (mill.kind, mill.tool.name) == ("thread_mill", "TM-C D5.8x1.25")
    (tap,) = of_kind(planned((deep, thread_demand("M8", 10.0))), "tap", "thread_mill")
    assert tap.kind == "tap"


def test_a_person_may_have_all_threads_milled():
    m6 = (hole(30, 30, 5), thread_demand("M6"))
    assert [o.kind for o in of_kind(planned(m6), "tap", "thread_mill")] == ["tap"]
    process = planned(m6, **ALWAYS)
    (mill,) = of_kind(process, "tap", "thread_mill")
    assert (mill.kind, mill.tool.name) == ("thread_mill", "TM-C D4.3x1") and not process.findings


def test_equal_threads_are_one_operation_and_other_depths_are_another():
    process = planned(
        *((hole(x, 30, 5, 14.0, point_angle=140.0), thread_demand("M6", 8.0)) for x in (20, 40)),
        (hole(60, 30, 5, 14.0, point_angle=140.0), thread_demand("M6", 6.0)),
        **ALWAYS,
    )
    operations = of_kind(process, "thread_mill")
    assert [o.all_features for o in operations] == [("hole-01", "hole-02"), ("hole-03",)]


def test_threads_are_milled_after_countersinks():
    sunk = hole(30, 30, 5, countersink_diameter=7.0, countersink_angle=90.0)
    kinds = [o.kind for o in planned((sunk, thread_demand("M6")), **ALWAYS).operations]
    assert kinds.index("drill") < kinds.index("countersink") < kinds.index("thread_mill")


def test_where_neither_a_tap_nor_a_thread_mill_serves_both_reasons_are_told():
    shallow = hole(30, 30, 5, 8.0, point_angle=140.0)
    process = planned((shallow, thread_demand("M6", 7.5)))
    assert not of_kind(process, "tap", "thread_mill")
    (told,) = process.findings
    assert told.severity == "warning" and told.remedy
    assert "tap's lead" in told.text and "too short for a thread mill: 6.25 mm" in told.text


def test_a_person_who_wants_all_milled_is_told_where_no_thread_mill_serves():
    shallow = hole(30, 30, 5, 10.0, point_angle=140.0)
    process = planned((shallow, thread_demand("M6", 8.5)), **ALWAYS)
    (told,) = process.findings
    assert "too short for a thread mill: 8.25 mm" in told.text and "milled threads" in told.text


@pytest.mark.parametrize(
    ("diameter", "pitch", "printed"),
    # ISO 965-1:2013, table of TD2: grade 6, in mm; the formula is rounded there, and taken at the mean of a range of diameters.
    [
        (6.0, 1.0, 0.150),
        (8.0, 1.25, 0.160),
        (12.0, 1.75, 0.200),
        (20.0, 2.5, 0.224),
        (27.0, 2.0, 0.224),
    ],
)
def test_the_tolerance_of_the_pitch_diameter_is_about_the_standards(diameter, pitch, printed):
    thread = HoleThread(diameter=diameter, pitch=pitch, depth=0.0)
    assert pitch_tolerance(thread) == approx(printed, rel=0.08)


@settings(deadline=None)
@given(st.floats(0.3, 0.8), st.floats(4.0, 40.0), st.floats(0.05, 0.16))
def test_the_widening_of_the_flanks_is_that_of_the_tooth_swept_along_its_helix(share, size, steep):
    """Held against the tooth at its root's edge, sample by sample round the tool."""
    pitch = steep * size
    tool = replace(
        TOOLS["TM-C D6.3x1"],
        diameter=share * size,
        pitch=pitch,
        flute_length=pitch,
        neck_diameter=0.01,
    )
    if tool.core_diameter <= 0.5 * tool.diameter:
        return
    radius, orbit = tool.radius, 0.5 * (size - tool.diameter)
    least = 0.0
    for n in range(-4000, 4001):
        phi = n * 0.9 / 4000
        x, y = orbit + radius * math.cos(phi), radius * math.sin(phi)
        gone_on = pitch * math.atan2(y, x) / math.tau
        lost = (0.5 * size - math.hypot(x, y)) * math.tan(math.pi / 6)
        least = max(least, gone_on - lost)
    thread = HoleThread(diameter=size, pitch=pitch, depth=0.0)
    assert widening(tool, thread) == approx(2.0 * least / math.tan(math.pi / 6), rel=0.06)


def test_a_thread_mill_too_thick_to_keep_the_flanks_is_none():
    surroundings, bore = around(walled(hole(36, 30, 5)))
    thread = HoleThread(diameter=6.0, pitch=1.0, depth=0.0)
    thick = replace(TOOLS["TM-C D4.3x1"], diameter=4.75, neck_diameter=3.0)
    found = thread_mills_for(bore, thread, [thick], surroundings, MILLING)
    assert not found.tools and "thin enough to keep its flanks" in found.reason
    assert thread_mills_for(bore, thread, [TOOLS["TM-C D4.3x1"]], surroundings, MILLING).tools


def test_a_thread_mill_whose_shank_does_not_get_into_its_bore_is_none():
    """The comb for M6 has a shank of 6 mm 24 mm above its tip."""
    surroundings, bore = around(walled(hole(36, 30, 5)))
    thread = HoleThread(diameter=6.0, pitch=1.0, depth=0.0)
    comb = [TOOLS["TM-C D4.3x1"]]
    assert thread_mills_for(bore, thread, comb, surroundings, MILLING).tools
    deeper = replace(bore, bottom=bore.top - HIGH - 6.0)
    found = thread_mills_for(deeper, thread, comb, surroundings, MILLING)
    assert not found.tools and found.hindered and "shank" in found.reason


@pytest.mark.parametrize(("x", "free"), [(26.0, True), (27.0, False)])
def test_a_wall_over_the_bore_that_teeth_would_cut_is_told(x, free):
    """The wall begins at 40 mm: 14 or 13 mm from the axis of a bore of 12.5 mm radius and a thread of 13.5 mm."""
    surroundings, bore = around(walled(hole(x, 30, 25, 10.0, top_z=10.0), wall=10.0))
    long = {"stickout": 80.0, "neck_length": 75.0, "gauge_length": 160.0}
    comb = replace(TOOLS["TM-C D16x2"], **long)
    thread = HoleThread(diameter=27.0, pitch=2.0, depth=0.0)
    found = thread_mills_for(bore, thread, [comb], surroundings, MILLING)
    assert bool(found.tools) == free
    assert free or "the teeth of a thread mill would cut it" in found.reason


def data(tool, material=ALUMINIUM, **limits):
    return hole_data("thread_mill", TOOLS[tool], material, MACHINE, SHOP, CuttingSettings(**limits))


def test_speed_and_feed_are_those_of_the_table():
    made = data("TM-C D6.3x1")
    # 115 m/min, fz between 0.13 at D 6 and 0.14 at D 7; 26 mm stick out of 6.3: 4.127 diameters, 0.989 of it.
    assert made.spindle == approx(115_000 / (math.pi * 6.3))
    assert made.feed_per_tooth == approx(0.133 * (1 - 0.5 * (26 / 6.3 - 4) / 6))
    assert made.feed == approx(made.feed_per_tooth * 4 * made.spindle)
    assert any("thread milling wrought aluminium (N)" in rule for rule in made.rules)


def test_the_first_pass_is_as_deep_as_the_tables_number_of_passes_says():
    depth = 0.541266 * 2.0
    assert data("TM-C D16x2").width == approx(depth, rel=1e-5)
    assert data("TM-C D16x2", STEEL).width == approx(depth / math.sqrt(2), rel=1e-5)
    assert data("TM-C D16x2", TITANIUM).width == approx(depth / math.sqrt(3), rel=1e-5)
    # In one pass ten teeth cut a groove of 7/16 P mean width each (ISO 68-1).
    assert data("TM-C D16x2").depth == approx(10 * 7 / 16 * 2.0)


@settings(deadline=None, max_examples=50)
@given(
    st.sampled_from(MILLS),
    st.sampled_from(sorted(SHOP.materials)),
    st.sampled_from(sorted(SHOP.machines)),
    st.floats(0.3, 3.0),
    st.floats(100.0, 30_000.0),
)
def test_the_data_keep_the_limits_of_spindle_feed_and_power(
    tool, material, machine, share, spindle_limit
):
    machine = SHOP.machine(machine)
    limits = CuttingSettings(feed_share=share, spindle_limit=spindle_limit)
    material = SHOP.material(material)
    made = hole_data("thread_mill", tool, material, machine, SHOP, limits)
    assert made.spindle <= max(min(machine.spindle_high, spindle_limit), machine.spindle_low) + 1e-9
    assert made.feed <= machine.feed_max + 1e-9
    assert made.power <= made.power_limit * (1 + 1e-9)


def test_thread_mills_do_nothing_else_and_nothing_else_does_their_work():
    limits = CuttingSettings()
    with pytest.raises(BadInput, match="DR-K D10 is no thread-mill: an operation of the kind"):
        hole_data("thread_mill", TOOLS["DR-K D10"], STEEL, MACHINE, SHOP, limits)
    with pytest.raises(BadInput, match="TM-C D6.3x1 is a thread-mill: it does no operation"):
        hole_data("hole_mill", TOOLS["TM-C D6.3x1"], STEEL, MACHINE, SHOP, limits)


def milled():
    process = planned((hole(30, 30, 5), thread_demand("M6")), **ALWAYS)
    return process, of_kind(process, "thread_mill")[0]


def test_a_thread_mills_data_come_again_from_its_table_and_are_not_optimised():
    process, operation = milled()
    assert is_on_holes(operation.kind, operation.cutter) and not can_be_optimised(operation)
    material = SHOP.material(process.material)
    slower = recomputed(operation, process, material, SHOP, CuttingSettings(speed_share=0.5))
    assert slower.data.spindle == approx(0.5 * operation.data.spindle)
    assert not is_overload(with_peak(operation, (), material, {}).data)


def test_a_person_may_take_another_thread_mill_and_another_feed_but_no_tap():
    process, operation = milled()
    single = OperationChange(tool="TM-S D3.6 P0.5-1", spindle=0.0, feed=0.0)
    changed = with_change(process, operation.id, single, SHOP, {}).operation(operation.id)
    assert changed.tool.name == "TM-S D3.6 P0.5-1" and changed.data.feed != operation.data.feed
    slower = replace(single, tool="", feed=200.0)
    assert (
        with_change(process, operation.id, slower, SHOP, {}).operation(operation.id).data.feed
        == 200.0
    )
    with pytest.raises(BadInput, match="a thread-mill tool is needed"):
        with_change(process, operation.id, replace(single, tool="TAP-B M6x1"), SHOP, {})
