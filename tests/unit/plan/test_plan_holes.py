"""Holes in a setup, the drills that fit them, and the operations that are planned for them."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from lxml import etree
from pytest import approx

from flat_parts import MILL, blank_of
from holed import HIGH, feature, hole
from programs import part_info
from trunnion.findings import Refused
from trunnion.geometry.frame import WORLD, Frame
from trunnion.model.feature import Feature
from trunnion.plan.holes.drive import hole_drive
from trunnion.plan.holes.hole import hole_in
from trunnion.plan.holes.tools import drills_for, pilots_for, tip_of
from trunnion.plan.panel.hole_tasks import HOLE_TASK_MAKERS
from trunnion.plan.panel.route import RouteSettings
from trunnion.plan.panel.tasks import PanelPlanState
from trunnion.plan.prismatic.regions import SetupSpace
from trunnion.plan.repair.contract import RepairJob
from trunnion.plan.repair.tool_change import next_tool
from trunnion.plan.setups import SetupSettings, make_setups
from trunnion.settings import choose
from trunnion.store.process import process_xml
from walled_plates import SHOP, around, route, walled

DRILLS = SHOP.tools_for("N", "drill")
D8 = next(t for t in DRILLS if t.name == "DR-K D8")
TURNED = Frame(np.array([100.0, 60.0, HIGH]), np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, -1.0]))
SIDEWAYS = Frame(np.zeros(3), np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0]))


def shape(sizes, setup=WORLD, **attributes):
    made = replace(feature(1, sizes), attributes=attributes)
    return hole_in(made, WORLD, setup)


def test_a_hole_lies_in_the_setup_as_its_sizes_say():
    bore = shape(hole(30, 20, 8, 12.0, point_angle=118.0)).bore
    assert (bore.x, bore.y, bore.top, bore.bottom) == approx((30, 20, 20, 8))
    assert bore.point_length == approx(4.0 / math.tan(math.radians(59.0)))


def test_a_through_hole_is_reached_from_both_of_its_ends():
    bore = shape(hole(30, 20, 8), TURNED).bore
    assert (bore.top, bore.bottom) == approx((HIGH, 0.0))


@pytest.mark.parametrize(
    ("sizes", "setup", "words"),
    [
        (hole(30, 20, 8, 12.0), TURNED, "opens away from the tool"),
        (hole(30, 20, 8, counterbore_diameter=14, counterbore_depth=4), TURNED, "opens away"),
        (hole(30, 20, 8), SIDEWAYS, "leans by 90 degrees"),
        (hole(30, 20, 0.0), WORLD, "above 0"),
    ],
)
def test_what_a_setup_does_not_reach_is_refused_with_why(sizes, setup, words):
    with pytest.raises(Refused, match=words):
        shape(sizes, setup)


def test_a_hole_without_sizes_is_refused():
    bare = Feature(id="hole-01", kind="hole", faces=(), sizes={"x": 1.0, "y": 2.0})
    with pytest.raises(Refused, match="nothing says its top_z, diameter, depth"):
        hole_in(bare, WORLD, WORLD)


def test_a_hole_with_a_direction_is_reached_from_there():
    bore = shape({**hole(30, 20, 8, 12.0), "top_z": 0.0}, TURNED, direction=(0.0, 0.0, -1.0)).bore
    assert (bore.top, bore.bottom) == approx((HIGH, HIGH - 12.0))


def test_a_through_hole_is_drilled_past_its_end_by_point_and_breakthrough():
    assert tip_of(shape(hole(0, 0, 8)).bore, D8, 1.0) == approx(-1.0 - D8.point_length)


@pytest.mark.parametrize(
    ("angle", "deeper"),
    [(140.0, D8.point_length), (118.0, D8.point_length), (160.0, 4 / math.tan(math.radians(80)))],
    ids=["its own", "a sharper cone", "a blunter cone"],
)
def test_a_drills_tip_goes_no_deeper_than_the_holes_own_cone(angle, deeper):
    assert tip_of(shape(hole(0, 0, 8, 12.0, point_angle=angle)).bore, D8, 1.0) == approx(8 - deeper)


def test_a_flat_floor_is_drilled_down_to_with_the_tip():
    assert tip_of(shape(hole(0, 0, 8, 12.0)).bore, D8, 1.0) == approx(8.0)


def chosen(made, **changed):
    surroundings, first = around(made)
    words = {"diameter_tolerance": 0.02, "breakthrough": 1.0, **changed}
    return drills_for(first, DRILLS, surroundings, **words)


def test_the_shortest_drill_of_the_diameter_comes_first():
    names = [t.name for t in chosen(walled(hole(30, 30, 8, 12.0, point_angle=140.0))).tools]
    assert names == ["DR-K D8", "DR-L D8"]


def test_a_hole_deeper_than_short_flutes_gets_a_longer_drill():
    assert chosen(walled(hole(30, 30, 3))).tools[0].name == "DR-L D3"


def test_a_hole_at_the_foot_of_a_wall_gets_a_drill_whose_shank_passes_it():
    """A drill of D 3 has a shank of 6: beside a wall 2 mm away it must stay over the wall's top."""
    low = hole(37, 30, 3, 5.0, top_z=HIGH - 8.0, point_angle=140.0)
    assert chosen(walled(low)).tools[0].name == "DR-K D3"
    assert chosen(walled(low, wall=8.0)).tools[0].name == "DR-K D3"
    deeper = hole(38, 30, 3, 2.0, top_z=HIGH - 17.0, point_angle=140.0)
    assert chosen(walled(deeper, wall=17.0)).tools[0].name == "DR-L D3"


@pytest.mark.parametrize(
    ("sizes", "words"),
    [
        (hole(30, 30, 7.77), "no drill of D 7.77"),
        (hole(30, 30, 3, 18.0, top_z=HIGH), None),
        ({**hole(30, 30, 3, 60.0), "through": True}, "flutes of"),
        (hole(38, 30, 3, 2.0, top_z=HIGH - 17.5, point_angle=140.0), None),
    ],
)
def test_what_is_missing_is_said(sizes, words):
    found = chosen(walled(sizes))
    assert bool(found.tools) == (words is None)
    assert words is None or (words in found.reason and found.remedy)


def test_shank_or_holder_at_a_high_wall_is_named():
    low = hole(36, 30, 3, 3.0, top_z=2.0, point_angle=140.0)
    part, recognition = walled(low, wall=18.0)
    tall = replace(
        part, height=60.0, cuts=(*part.cuts[:1], replace(part.cuts[1], low=2.0, high=61))
    )
    found = chosen((tall, recognition))
    assert not found.tools and "too near" in found.reason


def test_a_covered_mouth_is_seen():
    surroundings, first = around(walled(hole(30, 30, 8, 12.0)))
    assert surroundings.is_open(first)
    assert not surroundings.is_open(replace(first, x=first.x + 20.0, top=first.top - 5.0))


EQUAL = (hole(20, 20, 8), hole(80, 20, 8), hole(50, 40, 6, 8.0, point_angle=140.0), hole(20, 40, 8))


def test_equal_holes_are_one_operation():
    made = {o.id: o for o in route(walled(*EQUAL)).operations if o.kind == "drill"}
    assert [o.all_features for o in made.values()] == [
        ("hole-03",),
        ("hole-01", "hole-02", "hole-04"),
    ]
    assert made["drill-hole-01"].faces == (3, 5, 9)
    assert {o.tool.name for o in made.values()} == {"DR-S D8", "DR-K D6"}


def test_holes_deep_enough_to_be_drilled_otherwise_are_another_operation():
    made = route(
        walled(hole(20, 20, 4, 8.0, point_angle=140.0), hole(80, 20, 4, 14.0, point_angle=140.0))
    )
    assert len([o for o in made.operations if o.kind == "drill"]) == 2


def test_holes_are_drilled_after_the_face():
    process = route(walled(*EQUAL))
    kinds = [o.kind for o in process.operations]
    assert kinds.index("face") < kinds.index("drill")


def test_a_hole_without_a_tool_is_an_error_that_says_what_is_missing():
    process = route(walled(hole(20, 20, 1.234)))
    found = [f for f in process.findings if f.code == "route.no-cutter"]
    assert found and "hole-01" in found[0].text and "1.234" in found[0].text


def test_a_hole_that_is_not_reached_is_a_finding():
    part, recognition = walled(hole(20, 20, 8, 12.0))
    aside = replace(recognition.features[0], attributes={"direction": (0.6, 0.0, 0.8)})
    process = route((part, replace(recognition, features=(aside,))))
    assert not [o for o in process.operations if o.kind == "drill"]
    assert "leans by 36.87" in next(
        f.text for f in process.findings if f.code == "hole.not-reached"
    )


def test_holes_are_spotted_when_that_is_asked_for():
    process = route(walled(*EQUAL), **{"holes.spot": True})
    spots = [o for o in process.operations if o.kind == "spot"]
    assert len(spots) == 1 and len(spots[0].all_features) == 4 and not spots[0].faces
    assert all(spots[0].id in o.after for o in process.operations if o.kind == "drill")
    assert not [o for o in route(walled(*EQUAL)).operations if o.kind == "spot"]


def test_a_drive_is_made_of_features_again_and_tells_of_those_that_are_gone():
    made = walled(*EQUAL)
    process = route(made)
    operation = process.operation("drill-hole-01")
    setup = process.setups[0].frame
    drive, findings = hole_drive(operation, made[1], process, setup)
    assert [h.feature for h in drive.holes] == list(operation.all_features) and not findings
    gone = replace(made[1], features=made[1].features[:-1])
    with pytest.raises(Refused, match="hole-04 is not there any more"):
        hole_drive(operation, gone, process, setup)


def test_drilling_data_come_from_the_table_and_know_their_power():
    operation = next(o for o in route(walled(hole(20, 20, 8))).operations if o.kind == "drill")
    data = operation.data
    table = SHOP.drilling["N"]
    assert data.speed == approx(table.speed) and data.width == 8.0 and data.depth == 4.0
    turn = data.feed / data.spindle
    # Kienzle with h = fz sin(kappa), as the makers' tables have it: Pc = f vc D kc / 240000.
    chip = turn / 2 * math.sin(math.radians(0.5 * operation.tool.point_angle))
    specific = SHOP.material("EN AW-7075").force * chip**-0.25
    assert data.power == approx(turn * data.speed * 8.0 * specific / 240_000, rel=1e-6)
    assert any("drilling table" in rule for rule in data.rules)
    assert any("thrust" in rule for rule in data.rules)


def test_a_diameter_without_a_drill_is_milled():
    process = route(walled(hole(30, 30, 7.7), hole(70, 30, 25.0)))
    made = {o.feature: o for o in process.operations if o.kind == "hole_mill"}
    assert set(made) == {"hole-01", "hole-02"} and not process.findings
    assert all(o.strategy == "hole.mill" and o.tool.form == "flat" for o in made.values())
    assert made["hole-01"].tool.diameter <= 0.8 * 7.7


def test_a_drill_that_is_too_short_gives_way_to_an_end_mill_and_both_reasons_are_told():
    deep = {**hole(30, 30, 3, 60.0), "through": True}
    process = route(walled(deep))
    text = next(f.text for f in process.findings if f.code == "route.no-cutter")
    assert "flutes" in text and "end mill" in text


def test_a_flat_floor_is_milled_after_its_drill():
    process = route(walled(hole(30, 30, 8, 10.0), hole(70, 30, 8, 10.0), hole(50, 30, 8)))
    (floor,) = (o for o in process.operations if o.kind == "hole_floor")
    assert floor.all_features == ("hole-01", "hole-02")
    assert "drill-hole-01" in floor.after
    drive, _ = hole_drive(
        floor,
        walled(hole(30, 30, 8, 10.0), hole(70, 30, 8, 10.0))[1],
        process,
        process.setups[0].frame,
    )
    drill = process.operation("drill-hole-01").tool
    # From half a millimetre over what the point has left.
    assert drive.holes[0].depth == approx(drill.point_length + 0.5)


def test_a_counterbore_is_milled_after_its_pilot():
    sunk = {"counterbore_diameter": 15.0, "counterbore_depth": 6.0}
    process = route(walled(hole(30, 30, 9, **sunk), hole(70, 30, 9, **sunk), hole(50, 30, 9)))
    (wide,) = (o for o in process.operations if o.kind == "counterbore")
    assert wide.all_features == ("hole-01", "hole-02")
    order = [o.id for o in process.operations]
    pilot = next(o for o in process.operations if o.kind == "drill" and "hole-01" in o.all_features)
    assert pilot.id in wide.after and order.index(pilot.id) < order.index(wide.id)
    shapes = hole_in(walled(hole(30, 30, 9, **sunk))[1].features[0], WORLD, WORLD)
    assert (shapes.counterbores[0].bottom, shapes.counterbores[0].core) == (HIGH - 6.0, 9.0)


def test_a_blind_hole_gets_a_drill_with_its_own_point():
    """Though another one is in use: the cone at its bottom is part of the drawing."""
    named = [t.name for t in chosen(walled(hole(30, 30, 9, 12.0, point_angle=118.0))).tools]
    assert named == ["DR-S D9", "DR-J D9"]


def test_a_deep_through_hole_gets_a_jobber_drill():
    deep = {**hole(30, 30, 6, 45.0, top_z=HIGH), "through": True}
    assert [t.name for t in chosen(walled(deep)).tools] == ["DR-J D6"]


def test_countersinks_of_one_angle_are_one_operation_by_the_narrowest_tool():
    def sunk(x, wide, angle):
        return hole(x, 30, 6, countersink_diameter=wide, countersink_angle=angle)

    process = route(walled(sunk(20, 12.0, 90.0), sunk(50, 10.0, 90.0), sunk(80, 9.5, 100.0)))
    made = {o.tool.name: o for o in process.operations if o.kind == "countersink"}
    assert set(made) == {"CS90 D12.4", "CS100 D10.4"}
    assert made["CS90 D12.4"].all_features == ("hole-01", "hole-02")
    assert made["CS90 D12.4"].data.speed == approx(0.5 * SHOP.drilling["N"].speed)
    assert any(i.startswith("drill") for i in made["CS90 D12.4"].after)


def test_a_countersink_without_a_tool_is_named():
    process = route(walled(hole(20, 30, 6, countersink_diameter=12, countersink_angle=82)))
    text = next(f.text for f in process.findings if f.code == "route.no-cutter")
    assert "no countersink of 82 degrees" in text


def test_every_step_of_a_stepped_hole_is_a_counterbore():
    sizes = hole(30, 30, 9, diameters=(20.0, 14.0, 9.0), step_depths=(4.0, 8.0, HIGH))
    steps = shape(sizes).counterbores
    assert [(s.diameter, s.depth, s.core) for s in steps] == [(14.0, 8.0, 9.0), (20.0, 4.0, 9.0)]


def test_a_ball_shaped_bottom_is_drilled_no_deeper_than_it_is():
    bore = shape(hole(30, 30, 8, 12.0, bottom_radius=4.0)).bore
    assert bore.point_length == approx(4.0) and not bore.is_flat
    assert shape(hole(30, 30, 8, 12.0, bottom_radius=5.0)).bore.point_length == approx(2.0)


def test_a_tapered_hole_is_refused():
    with pytest.raises(Refused, match="tapered"):
        shape(hole(30, 30, 8, taper_angle=3.0))


def test_what_is_wider_at_the_far_end_is_widened_from_there_and_bored_once():
    sizes = hole(30, 30, 9, back_counterbore_diameter=15.0, back_counterbore_depth=4.0)
    process = route(walled(sizes))
    own = [o for o in process.operations if o.feature == "hole-01"]
    assert [(o.kind, o.setup) for o in own] == [("drill", "S1"), ("counterbore", "S2")]
    assert not [f for f in process.findings if f.code == "hole.not-reached"]


def test_what_opens_away_at_the_far_end_is_told_where_no_other_side_is_planned():
    sizes = hole(30, 30, 9, back_counterbore_diameter=15.0, back_counterbore_depth=4.0)
    part, recognition = walled(sizes)
    blank = blank_of(part)
    (setup,) = make_setups(recognition, blank, choose(SetupSettings, MILL))
    state = PanelPlanState(
        space=SetupSpace.of(part, recognition, blank, setup),
        recognition=recognition,
        material=SHOP.material(blank.material),
        machine=SHOP.machine(setup.machine),
        settings=choose(RouteSettings, {}),
        shop=SHOP,
        adjacent={},
    )
    (stage,) = [s for s in SHOP.plans["Panel, three axes"].stages if s.cutter == "drill"]
    HOLE_TASK_MAKERS["drill"](state, stage, recognition.features)
    assert "far end" in next(f.text for f in state.findings if f.code == "hole.not-reached")


@pytest.mark.parametrize(
    ("sizes", "steps"),
    [
        ({"back_counterbore_diameter": 15.0, "back_counterbore_depth": 4.0}, [(15.0, 4.0)]),
        (
            {
                "back_counterbore_diameter": 15.0,
                "back_counterbore_depth": 4.0,
                "diameters": (9.0, 12.0, 15.0),
                "step_depths": (8.0, 16.0, HIGH),
            },
            [(12.0, 12.0), (15.0, 4.0)],
        ),
    ],
)
def test_the_far_end_is_seen_from_there_from_the_bore_outwards(sizes, steps):
    seen = shape(hole(30, 20, 9, **sizes), TURNED)
    assert [c.diameter for c in seen.counterbores] == approx([d for d, _ in steps])
    assert [c.depth for c in seen.counterbores] == approx([deep for _, deep in steps])
    assert all(c.top == approx(HIGH) for c in seen.counterbores)


def test_a_through_hole_whose_drill_meets_a_wall_is_drilled_from_the_other_side():
    low = hole(36, 30, 3, 2.0, top_z=2.0, point_angle=140.0)
    part, recognition = walled(low, wall=18.0)
    tall = replace(
        part, height=60.0, cuts=(*part.cuts[:1], replace(part.cuts[1], low=2.0, high=61))
    )
    process = route((tall, recognition))
    assert [(o.kind, o.setup) for o in process.operations if o.feature == "hole-01"] == [
        ("drill", "S2")
    ]
    assert not [f for f in process.findings if f.code == "route.no-cutter"]
    blind = replace(recognition.features[0], sizes={**low, "through": False})
    told = route((tall, replace(recognition, features=(blind,))))
    assert [f.code for f in told.findings] == ["route.no-cutter"]


def test_a_hole_too_deep_for_every_drill_is_drilled_half_from_each_side():
    part, recognition = walled(hole(30, 30, 8))
    tall = replace(part, height=120.0, cuts=(replace(part.cuts[0], high=121.0),))
    (bore,) = recognition.features
    deep = replace(bore, sizes={**bore.sizes, "top_z": 120.0, "depth": 120.0})
    recognition = replace(recognition, features=(deep,))
    process = route((tall, recognition))
    drills = [o for o in process.operations if o.kind == "drill"]
    assert [(o.id, o.setup) for o in drills] == [
        ("drill-hole-01-S1", "S1"),
        ("drill-hole-01-S2", "S2"),
    ]
    assert len({o.tool.name for o in drills}) == 1
    halves = [
        hole_drive(o, recognition, process, process.setup(o.setup).frame)[0].holes[0]
        for o in drills
    ]
    assert [h.depth for h in halves] == approx([60.0, 60.0]) and all(h.through for h in halves)
    whole = route((tall, recognition), **{"route.sides.halves": False})
    assert [f.code for f in whole.findings] == ["route.no-cutter"] and len(whole.setups) == 1


def test_the_process_tree_names_all_features_of_an_operation():
    process = route(walled(*EQUAL))
    root = etree.fromstring(process_xml(process, part_info()))
    (equal,) = root.xpath("operation[@id='drill-hole-01']")
    assert [e.get("id") for e in equal.findall("feature")] == ["hole-02", "hole-04"]
    (single,) = root.xpath("operation[@id='drill-hole-03']")
    assert not single.findall("feature")


def test_a_fix_changes_no_drill_for_one_of_another_shape():
    sunk = hole(50, 20, 6, countersink_diameter=12, countersink_angle=90)
    process = route(walled(*EQUAL, sunk), **{"holes.spot": True})
    job = RepairJob(shop=SHOP, choices={})
    for o in (o for o in process.operations if o.tool.form in ("drill", "form")):
        other = next_tool(process, o, job, lambda t: True)
        assert other is None or (other.diameter, other.point_angle, other.outline) == (
            o.tool.diameter,
            o.tool.point_angle,
            o.tool.outline,
        )
    spot = next(o for o in process.operations if o.kind == "spot")
    assert next_tool(process, spot, job, lambda t: True) is None


@pytest.mark.parametrize("diameter", [8.0, 7.5, 5.0, 3.0])
@pytest.mark.parametrize("angle", [90.0, 118.0, 140.0, 180.0])
def test_no_drill_leaves_the_cone_of_a_blind_hole(diameter, angle):
    bore = shape(hole(0, 0, 8, 12.0, point_angle=angle)).bore
    drill = replace(D8, diameter=diameter)
    tip = tip_of(bore, drill, 1.0)

    def floor_at(radius):
        return bore.bottom - bore.point_length * (1.0 - radius / bore.radius)

    # Both are cones: where tip and edge are inside, all of the drill is.
    assert tip >= floor_at(0.0) - 1e-9
    assert tip + drill.point_length >= floor_at(drill.radius) - 1e-9
    assert min(tip - floor_at(0.0), tip + drill.point_length - floor_at(drill.radius)) == approx(0)


def test_the_thickest_drill_with_the_holes_point_leaves_its_cone_before_it_is_milled():
    open_above, _ = around(walled(hole(30, 30, 8.3, 12.0)))
    bore = shape(hole(30, 30, 8.3, 12.0, point_angle=140.0)).bore
    drills = [replace(D8, name=f"D{d:g}", diameter=d) for d in (5.0, 8.0, 8.3)]
    drills.append(replace(D8, name="sharper", diameter=8.2, point_angle=118.0))
    found = pilots_for(bore, 8.25, drills, open_above, 1.0)
    assert [t.name for t in found.tools] == ["D8"]
    flat = shape(hole(30, 30, 8.3, 12.0)).bore
    through = shape(hole(30, 30, 8.3)).bore
    assert not pilots_for(flat, 8.3, drills, open_above, 1.0).tools
    assert not pilots_for(through, 8.3, drills, open_above, 1.0).tools


def test_a_blind_hole_that_is_milled_is_drilled_before_and_a_ring_of_its_cone_is_told():
    process = route(walled(hole(30, 30, 8.3, 12.0, point_angle=140.0)))
    (drill,) = [o for o in process.operations if o.kind == "drill"]
    (milled,) = [o for o in process.operations if o.kind == "hole_mill"]
    assert drill.tool.diameter == 8.0 and drill.id in milled.after
    assert not [o for o in route(walled(hole(30, 30, 8.3))).operations if o.kind == "drill"]
