"""Reaming and tapping as panels are planned: which tools, in which order, and what is told where there is none."""

from __future__ import annotations

from dataclasses import replace

import pytest
from pytest import approx

from holed import HIGH, hole
from trunnion.plan.holes.demand import fit_demand, thread_demand, with_demand
from trunnion.plan.holes.finish_tools import bars_for, finish_tip, tap_tip, taps_for, thread_end
from trunnion.plan.holes.hole import HoleThread
from trunnion.plan.holes.settings import FineBoringSettings, ReamSettings, TapSettings
from trunnion.settings import choose
from walled_plates import SHOP, around, route, walled

TAPPING, REAMING = choose(TapSettings, {}), choose(ReamSettings, {})
BORING = choose(FineBoringSettings, {})


def planned(*holes_and_demands, **choices):
    """Return the process of a plate with holes, each with what is demanded of it or None."""
    part, found = walled(*(h for h, _ in holes_and_demands))
    for n, (_, demand) in enumerate(holes_and_demands, 1):
        if demand is not None:
            found = with_demand(found, [f"hole-{n:02}"], demand, SHOP)
    return route((part, found), **choices)


def of_kind(process, *kinds):
    return [o for o in process.operations if o.kind in kinds]


def test_a_fit_is_reamed_after_a_drill_that_leaves_its_allowance():
    process = planned((hole(30, 30, 10), fit_demand("H7")), (hole(70, 30, 10), None))
    (ream,) = of_kind(process, "ream")
    drills = {o.all_features: o.tool.diameter for o in of_kind(process, "drill")}
    assert drills == {("hole-01",): 9.8, ("hole-02",): 10.0}
    assert (ream.tool.name, ream.feature, ream.strategy) == ("RE-H7 D10", "hole-01", "hole.ream")
    drill = next(o for o in of_kind(process, "drill") if o.feature == "hole-01")
    assert drill.id in ream.after and not process.findings
    # The reamer finishes the side of the bore, the drill does not.
    assert ream.faces == (3,) and drill.faces == ()


def test_a_bore_that_no_drill_prepares_is_milled_with_the_reamers_allowance():
    process = planned((hole(30, 30, 19), fit_demand("H7")), (hole(70, 30, 19), None))
    (ream,) = of_kind(process, "ream")
    mills = {o.feature: dict(o.choices) for o in of_kind(process, "hole_mill")}
    assert ream.tool.diameter == 19.0
    assert mills["hole-01"]["hole.mill.allowance"] == approx(0.1)
    assert "hole.mill.allowance" not in mills.get("hole-02", {})


def test_a_fit_that_no_reamer_has_is_bored_by_a_bar_that_is_set_for_it():
    process = planned((hole(30, 30, 10), fit_demand("K7")), (hole(70, 30, 25.2), fit_demand("H6")))
    made = {o.feature: o for o in of_kind(process, "fine_bore")}
    assert not of_kind(process, "ream") and not process.findings
    bar = made["hole-01"].tool
    assert (bar.name, bar.diameter, bar.fit) == ("FB D8-11 at D10", 10.0, "K7")
    assert made["hole-02"].tool.name == "FB D20-26 at D25.2"
    # What is before it leaves the bar the allowance of the boring table.
    (drill,) = of_kind(process, "drill")
    assert drill.feature == "hole-01" and 9.6 <= drill.tool.diameter <= 9.8
    (milled,) = of_kind(process, "hole_mill")
    assert milled.choices["hole.mill.allowance"] == approx(0.15)
    assert made["hole-02"].data.depth == approx(0.3) and made["hole-01"].data.depth == approx(0.2)


def test_a_fit_that_nothing_makes_is_made_to_its_nominal_size_and_told():
    process = planned((hole(30, 30, 4), fit_demand("K7")))
    assert not of_kind(process, "ream", "fine_bore")
    assert of_kind(process, "drill")[0].tool.diameter == 4.0
    (told,) = process.findings
    assert "no reamer of D 4 K7" in told.text and "no boring bar" in told.text
    assert told.severity == "warning" and told.remedy


def test_the_range_of_a_boring_bar_ends_at_its_smallest_and_its_largest_diameter():
    surroundings, bore = around(walled(hole(36, 30, 10.0)))
    bars = [t for t in SHOP.tools_for("N", "bore") if t.name in ("FB D8-11", "FB D11-15")]

    def found(diameter):
        wide = replace(bore, diameter=diameter)
        return [t.name for t in bars_for(wide, "H6", bars, surroundings, BORING).tools]

    assert found(11.0) == ["FB D8-11 at D11", "FB D11-15 at D11"]
    assert found(8.0) == ["FB D8-11 at D8"] and found(15.0) == ["FB D11-15 at D15"]
    assert found(7.9) == [] and found(15.1) == []


def test_a_coarse_fit_is_drilled():
    process = planned((hole(30, 30, 10), fit_demand("H11")))
    assert not of_kind(process, "ream") and of_kind(process, "drill")[0].tool.diameter == 10.0


@pytest.mark.parametrize(("deep", "series"), [(HIGH, "TAP-B"), (14.0, "TAP-C")])
def test_through_and_blind_threads_get_taps_whose_chips_go_the_right_way(deep, series):
    process = planned((hole(30, 30, 5, deep, point_angle=140.0), thread_demand("M6")))
    (tap,) = of_kind(process, "tap")
    assert tap.tool.name == f"{series} M6x1" and tap.strategy == "hole.tap"
    (drill,) = of_kind(process, "drill")
    assert drill.id in tap.after and drill.tool.diameter == 5.0 and not process.findings
    assert tap.data.feed == approx(tap.data.spindle * 1.0)


def test_equal_threads_are_one_operation_and_other_depths_are_another():
    process = planned(
        *((hole(x, 30, 5, 14.0, point_angle=140.0), thread_demand("M6")) for x in (20, 40)),
        (hole(60, 30, 5, 14.0, point_angle=140.0), thread_demand("M6", 6.0)),
    )
    assert [o.all_features for o in of_kind(process, "tap")] == [
        ("hole-01", "hole-02"),
        ("hole-03",),
    ]
    assert len(of_kind(process, "drill")) == 1


def test_threads_come_after_countersinks():
    sunk = hole(30, 30, 5, countersink_diameter=7.0, countersink_angle=90.0)
    process = planned((sunk, thread_demand("M6")))
    kinds = [o.kind for o in process.operations]
    assert kinds.index("drill") < kinds.index("countersink") < kinds.index("tap")


def test_a_thread_too_deep_for_the_taps_lead_is_told():
    process = planned((hole(30, 30, 5, 8.0, point_angle=140.0), thread_demand("M6", 7.5)))
    assert not of_kind(process, "tap")
    (told,) = process.findings
    assert "too short" in told.text and "full threads" in told.text


def test_a_tap_whose_shank_does_not_get_into_its_bore_is_none():
    """An M6 has a shank of 6 mm 30 mm above its tip: a bore of 40 mm is too deep for it."""
    surroundings, bore = around(walled(hole(36, 30, 5, 19.0, point_angle=140.0)))
    thread = HoleThread(diameter=6.0, pitch=1.0, depth=0.0)
    taps = SHOP.tools_for("N", "tap_blind")
    assert taps_for(bore, thread, taps, surroundings, TAPPING).tools
    deeper = replace(bore, bottom=bore.top - 40.0)
    found = taps_for(deeper, thread, taps, surroundings, TAPPING)
    assert not found.tools and found.hindered and "shank" in found.reason


def test_the_tips_of_reamers_and_taps():
    reamer = next(t for t in SHOP.tools if t.name == "RE-H7 D10")
    blind_tap = next(t for t in SHOP.tools if t.name == "TAP-C M6x1")
    through_tap = next(t for t in SHOP.tools if t.name == "TAP-B M6x1")
    _, through = around(walled(hole(30, 30, 10)))
    _, blind = around(walled(hole(30, 30, 10, 12.0, point_angle=140.0)))
    assert finish_tip(through, reamer, REAMING.breakthrough) == approx(
        through.bottom - reamer.lead - 1.0
    )
    assert finish_tip(blind, reamer, REAMING.breakthrough) == approx(blind.bottom)
    whole, short = (HoleThread(diameter=6.0, pitch=1.0, depth=d) for d in (0.0, 6.0))
    assert tap_tip(through, whole, through_tap, TAPPING) == approx(
        through.bottom - through_tap.lead - 1.0
    )
    assert tap_tip(blind, whole, blind_tap, TAPPING) == approx(blind.bottom + 1.0)
    tip = tap_tip(blind, short, blind_tap, TAPPING)
    assert thread_end(blind, tip, blind_tap) == approx(6.0)
