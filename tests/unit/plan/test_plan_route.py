"""The route: which operations, with which cutters, in which order, and what is said of the rest."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flat_parts import MILL, blank_of, narrow_panel, open_panel, panel, stepped_panel
from own_shop import own_shop
from trunnion.findings import Severity
from trunnion.model.blank import Box
from trunnion.model.feature import FaceRole, Feature
from trunnion.plan.panel.route import RouteSettings, make_route
from trunnion.plan.setups import SetupSettings, make_setups
from trunnion.plan.tool_choice import SLENDER, without_slender
from trunnion.progress import NO_PROGRESS
from trunnion.settings import choose

SHOP = own_shop()


def route(made, *, blank=None, **words):
    part, recognition = made
    blank = blank or blank_of(part)
    setups = make_setups(recognition, blank, choose(SetupSettings, MILL))
    return make_route(
        recognition, (), blank, setups, SHOP, part, choose(RouteSettings, words), NO_PROGRESS
    )


def with_sizes(made, id, **sizes):
    part, recognition = made
    changed = tuple(
        replace(f, sizes={**f.sizes, **sizes}) if f.id == id else f for f in recognition
    )
    return part, replace(recognition, features=changed)


TREE = route(panel())


def place(id: str) -> int:
    return [o.id for o in TREE.operations].index(id)


def test_every_operation_comes_after_those_it_waits_for():
    for operation in TREE.operations:
        assert all(place(earlier) < place(operation.id) for earlier in operation.after)


def test_the_top_is_faced_first_and_the_outline_finished_last():
    assert (TREE.operations[0].kind, TREE.operations[-1].kind) == ("face", "profile_finish")


def test_ribs_are_cut_between_roughing_and_finishing_of_the_pockets_beside_them():
    assert (
        place("rough-pocket-01")
        < place("rib_top-rib-01")
        < place("floor-pocket-01")
        < place("wall-pocket-01")
    )
    assert place("rough-pocket-02") < place("rib_top-rib-01") < place("floor-pocket-02")


def test_tools_are_few_and_numbered_in_the_order_of_use():
    assert [t.number for t in TREE.tools()] == list(range(1, len(TREE.tools()) + 1))
    assert len(TREE.tools()) <= 4


@pytest.mark.parametrize("id", ["wall-pocket-01", "wall-pocket-02"])
def test_a_walls_cutter_has_the_fillets_radius_and_passes_through_the_corners(id):
    tool = TREE.operation(id).tool
    assert tool.corner_radius == 3.0 and tool.radius <= 0.9 * 8.0


def test_every_cutter_reaches_its_floor_with_clearance():
    assert all(
        o.tool.neck_length >= 25.0 + 1.0 for o in TREE.operations if o.feature == "pocket-01"
    )


def test_a_corner_is_roughed_again_where_the_first_cutter_did_not_fit():
    assert TREE.operation("rough-pocket-01").tool.radius > 8.0
    assert place("rough-pocket-01") < place("corner-pocket-01") < place("wall-pocket-01")


def test_a_walls_cutter_passes_between_an_island_and_the_wall():
    tree = route(narrow_panel())
    assert tree.operation("wall-pocket-01").tool.diameter <= 12.0
    assert (
        tree.operation("corner-pocket-01").tool.diameter
        <= 12.0
        < tree.operation("rough-pocket-01").tool.diameter
    )


def test_roughing_leaves_allowances_and_finishing_none():
    assert TREE.operation("rough-pocket-01").choices["route.wall_allowance"] == 0.5
    assert not TREE.operation("wall-pocket-01").choices


def test_finishing_operations_name_the_faces_they_finish():
    assert TREE.operation("wall-pocket-02").faces == (5, 9)
    assert TREE.operation("rough-pocket-02").faces == ()
    assert TREE.operations[0].faces == (1,)


def test_every_choice_keeps_its_rule_in_words():
    assert all(len(o.rules) >= 3 and len(o.data.rules) >= 2 for o in TREE.operations)


def test_the_same_part_gives_the_same_route():
    again = route(panel())
    assert [(o.id, o.tool, o.data) for o in again.operations] == [
        (o.id, o.tool, o.data) for o in TREE.operations
    ]


def test_an_open_pocket_is_roughed_after_the_outline():
    part, recognition = open_panel()
    outline = Feature(id="profile-01", kind="profile", faces=(FaceRole(role="wall", face=3),))
    tree = route((part, replace(recognition, features=(*recognition.features, outline))))
    ids = [o.id for o in tree.operations]
    assert ids.index("profile_rough-profile-01") < ids.index("rough-open_pocket-01")


def test_a_stepped_pocket_is_planned_whole():
    assert {o.kind for o in route(stepped_panel()).operations} >= {"rough", "floor", "wall"}


def test_leaning_walls_are_named_and_left_with_their_rib():
    tree = route(with_sizes(panel(), "pocket-01", leans=(0.0, 5.0)))
    told = [f for f in tree.findings if f.code == "route.not-planned"]
    assert {w for f in told for w in f.where} >= {"pocket-01", "rib-01", "face 2"}
    assert all(f.severity is Severity.WARNING for f in told)
    assert not any(o.feature in ("pocket-01", "rib-01") for o in tree.operations)


def test_a_refused_pocket_takes_its_island_with_it():
    part, recognition = panel()
    refused = tuple(
        replace(f, attributes={"refused": "its walls lean"}) if f.id == "pocket-02" else f
        for f in recognition
    )
    tree = route((part, replace(recognition, features=refused)))
    told = {f.text for f in tree.findings}
    assert told >= {
        "pocket-02 not planned: its walls lean",
        "island-01 not planned: it stands in pocket-02, which is not planned",
    }


def test_features_of_a_kind_that_no_stage_serves_are_named_together():
    part, recognition = panel()
    slots = tuple(
        Feature(id=f"slot-0{n}", kind="slot", faces=(FaceRole(role="side", face=7),))
        for n in (1, 2)
    )
    (told,) = route((part, replace(recognition, features=(*recognition.features, *slots)))).findings
    assert told.text == "slot-01, slot-02 not planned: the typical plan has no operation for a slot"


def test_a_corner_sharper_than_any_cutter_is_cut_by_the_slimmest_and_told():
    tree = route(with_sizes(panel(), "pocket-01", corner_radius=1.0))
    assert not [f for f in tree.findings if f.severity is Severity.ERROR]
    told = [f for f in tree.findings if f.code == "route.second-choice" and "corners" in f.text]
    assert told and all("no tool is small enough" in f.text and f.remedy for f in told)
    slim = tree.operation("corner_finish-pocket-01").tool
    assert f"leaves a radius of {slim.radius:g} mm in the corners" in told[-1].text
    assert slim.diameter == min(
        t.diameter
        for t in SHOP.tools_for("N", "finish")
        if t.corner_radius == 3.0 and t.neck_length >= 26.0
    )


def test_walls_are_finished_also_where_no_cutter_gets_into_the_corners():
    tree = route(with_sizes(panel(), "pocket-01", corner_radius=1.0))
    assert tree.operation("wall-pocket-01").tool.corner_radius == 3.0


def test_where_no_cutter_is_slimmer_than_a_deep_corner_one_as_round_as_it_is_taken():
    # 25 mm deep and 26 mm clear: cutters of D 5 reach 50 mm, those of D 6 60 mm
    tight = with_sizes(panel(), "pocket-01", corner_radius=3.0, floor_fillet=1.0)
    tree = route(tight, reach_clearance=26.0)
    assert not [f for f in tree.findings if f.severity is Severity.ERROR]
    assert tree.operation("corner_finish-pocket-01").tool.radius == 3.0
    told = [f.text for f in tree.findings if f.code == "route.second-choice"]
    assert any("as round as the corners" in t for t in told)


def test_a_sharp_inner_corner_is_cut_as_far_as_cutters_go_and_told():
    tree = route(with_sizes(panel(), "pocket-01", corner_radius=0.0))
    assert [f.code for f in tree.findings] == ["route.sharp-corner"]
    assert any(o.id == "wall-pocket-01" for o in tree.operations)
    fillets = [
        t.diameter
        for t in SHOP.tools_for("N", "finish")
        if t.corner_radius == 3.0 and t.neck_length >= 26.0
    ]
    assert tree.operation("corner_finish-pocket-01").tool.diameter == min(fillets)


def test_a_fillet_no_cutter_has_is_stepped_and_told():
    tree = route(with_sizes(panel(), "pocket-01", floor_fillet=2.8))
    assert [f.code for f in tree.findings] == ["route.fillet"]
    assert tree.operation("wall-pocket-01").tool.corner_radius == 2.5


def test_a_blank_larger_than_the_machine_is_an_error_and_nothing_is_planned():
    part, _ = panel()
    box = blank_of(part)
    huge = Box(
        frame=box.frame,
        low=box.low,
        high=box.high + np.array([20000.0, 0, 0]),
        material=box.material,
        density=1,
    )
    tree = route(panel(), blank=huge)
    assert [f.code for f in tree.findings] == ["route.travel"]
    assert "exceeds the machine's travel" in tree.findings[0].text and tree.operations == ()


def test_titanium_gets_cutters_with_four_teeth():
    part, _ = panel()
    tree = route(panel(), blank=replace(blank_of(part), material="Ti-6Al-4V"))
    assert tree.operations and all(o.tool.teeth >= 4 for o in tree.operations)


def test_a_floors_cutter_waits_for_the_rest_roughing_of_corners_that_it_gets_into():
    tree = route(with_sizes(panel(), "pocket-01", corner_radius=4.0, floor_fillet=1.0))
    ids = [o.id for o in tree.operations]
    for pocket in ("pocket-01", "pocket-02"):
        floor = tree.operation(f"floor-{pocket}")
        if floor.tool.radius < tree.operation(f"rough-{pocket}").tool.radius:
            rest = [i for i in ids if i.startswith(f"corner-{pocket}")]
            assert all(ids.index(i) < ids.index(floor.id) for i in rest)


@pytest.mark.parametrize("foot", [0.0, 1.0])
def test_an_island_with_a_sharper_foot_than_its_pocket_gets_a_cutter_for_it(foot):
    tree = route(with_sizes(panel(), "island-01", floor_fillet=foot))
    cutter = tree.operation("foot-pocket-02")
    assert cutter.tool.corner_radius <= foot < tree.operation("wall-pocket-02").tool.corner_radius
    assert cutter.faces == (9,)
    ids = [o.id for o in tree.operations]
    assert ids.index("wall-pocket-02") < ids.index("foot-pocket-02")


def test_an_island_with_its_pockets_foot_needs_none():
    tree = route(with_sizes(panel(), "island-01", floor_fillet=3.0))
    assert "foot-pocket-02" not in [o.id for o in tree.operations]


def test_a_slender_cutter_is_for_what_no_shorter_one_of_its_size_reaches():
    tools = SHOP.tools_for("N", "finish")
    slender = [t for t in tools if t.stickout > SLENDER * t.diameter]
    assert slender
    kept = without_slender(tools)
    assert not set(slender) & set(kept)
    assert set(tools) - set(kept) == set(slender)
    deep = [t for t in tools if t.neck_length > 50.0 and t.diameter <= 8.0]
    assert set(without_slender(deep)) == set(deep) <= set(slender)
