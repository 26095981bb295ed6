"""Drive geometry, on prisms whose areas and lengths are worked out by hand. The blank's top is z 0 of the setup, the part's top -2."""

from __future__ import annotations

import math

import numpy as np
import pytest
from pytest import approx

from flat_parts import (
    MILL,
    FlatPart,
    Prism,
    blank_of,
    open_panel,
    open_panel_with_island,
    operation,
    panel,
    rounded,
    stepped_panel,
)
from own_shop import own_shop
from trunnion.findings import Refused
from trunnion.geometry.frame import WORLD
from trunnion.model.feature import FaceRole, Feature, Recognition
from trunnion.model.process import ProcessTree
from trunnion.plan.prismatic.drive import drive_of, foot_clearance
from trunnion.plan.prismatic.regions import SetupSpace
from trunnion.plan.setups import SetupSettings, make_setups
from trunnion.settings import choose

SHOP = own_shop()
D20, D10 = (next(t for t in SHOP.tools if t.name == f"AL3-regular D{d} R3") for d in (20, 10))
CORNERS = (4 - math.pi) * 64
"""What four corners of radius 8 take from a rectangle."""


def drive(made, kind, feature, earlier=(), choices=None):
    part, recognition = made
    (setup,) = make_setups(recognition, blank_of(part), choose(SetupSettings, MILL))
    one = operation(kind, feature, D10, choices)
    process = ProcessTree(plan="", material="", setups=(setup,), operations=(*earlier, one))
    return drive_of(one, process, SetupSpace.of(part, recognition, blank_of(part), setup))


def test_a_pocket_beside_a_low_rib_stays_closed_over_it():
    (level,) = drive(panel(), "rough", "pocket-01").levels
    assert (level.top, level.bottom) == approx((-2.0, -27.0))
    assert level.wanted.area == approx(85 * 80 - CORNERS)
    assert level.boundary.area == approx(level.wanted.area)


def test_an_island_is_a_hole_below_its_top_only():
    upper, lower = drive(panel(), "rough", "pocket-02").levels
    assert (upper.bottom, lower.bottom) == approx((-17.0, -24.0))
    assert upper.wanted.area - lower.wanted.area == approx(20 * 20 - CORNERS)


def test_a_pockets_loop_runs_anticlockwise_and_its_islands_clockwise():
    outer, island = drive(panel(), "wall", "pocket-02").walls
    assert outer.curve.area > 0 > island.curve.area
    assert (outer.top, outer.bottom, island.top, island.bottom) == approx((-2, -24, -17, -24))
    assert (outer.faces, island.faces) == ((5,), (9,))


def test_the_floor_reaches_up_to_the_walls_and_carries_its_fillet():
    (floor,) = drive(panel(), "floor", "pocket-02").floors
    assert floor.region.area == approx((91 * 80 - CORNERS) - (20 * 20 - CORNERS))
    assert (floor.z, floor.fillet, floor.face) == (approx(-24.0), 3.0, 4)


def test_roughing_knows_the_islands_top_as_a_face_too():
    assert [f.face for f in drive(panel(), "rough", "pocket-02").floors] == [4, 8]


def test_a_ribs_top_may_be_cut_from_both_pockets_and_ends_at_the_walls():
    ribs = drive(panel(), "rib_top", "rib-01")
    (level,) = ribs.levels
    assert level.wanted.area == approx(20 * 80 - 2 * (8 * 80 - CORNERS / 2))
    assert level.boundary.area == approx((20 + 2 * 60) * 80)
    assert sorted(w.curve.length for w in ribs.walls) == approx([20.0, 20.0])


def test_the_wall_at_a_ribs_end_has_the_material_on_its_right():
    low = min(
        (w.curve for w in drive(panel(), "rib_top", "rib-01").walls), key=lambda c: c.points[0, 1]
    )
    assert low.end[0] > low.start[0]


def test_an_islands_top_is_cut_inside_its_pocket():
    (level,) = drive(panel(), "island_top", "island-01").levels
    assert level.boundary.area == approx(91 * 80 - CORNERS)


def test_the_outline_has_the_material_on_its_right_and_the_blanks_rest_to_clear():
    outline = drive(panel(), "profile_finish", "profile-01")
    (wall,) = outline.walls
    assert wall.curve.closed and wall.curve.area == approx(-(200 * 100 - (4 - math.pi) * 100))
    assert outline.levels[0].wanted.area == approx(210 * 110 + wall.curve.area)
    assert (wall.top, wall.bottom) == approx((-2.0, -32.0))


def test_facing_takes_the_whole_blank_down_to_the_parts_top():
    (level,) = drive(panel(), "face", "blank").levels
    assert (level.top, level.bottom, level.wanted.area) == approx((0.0, -2.0, 210 * 110))


def test_an_open_pocket_ends_at_the_outline_but_its_cutter_may_run_past():
    open_pocket = drive(open_panel(), "rough", "open_pocket-01")
    (level,) = open_pocket.levels
    assert level.wanted.area == approx(80 * 40 - CORNERS / 2)
    assert level.boundary.box()[1][0] > 105 + 100


def test_an_open_pockets_wall_is_open_where_there_is_no_material():
    (wall,) = drive(open_panel(), "wall", "open_pocket-01").walls
    assert not wall.curve.closed
    assert wall.curve.length == approx(2 * 72 + 24 + 8 * math.pi)
    assert np.array([wall.curve.start[0], wall.curve.end[0]]) == approx([105.0, 105.0])


def test_an_open_pockets_wall_is_one_guide_past_the_top_of_its_island():
    around, island = drive(open_panel_with_island(), "wall", "open_pocket-01").walls
    assert (around.curve.closed, around.top, around.bottom) == (False, approx(-2.0), approx(-12.0))
    assert (island.curve.closed, island.top, island.bottom) == (True, approx(-7.0), approx(-12.0))


def test_a_step_gives_two_levels_and_two_floors():
    stepped = drive(stepped_panel(), "floor", "pocket-01")
    assert [f.region.area for f in stepped.floors] == approx([40 * 40, 40 * 40 - CORNERS])
    assert [(level.top, level.bottom) for level in stepped.levels] == [
        approx((-2, -17)),
        approx((-17, -27)),
    ]


def test_the_upper_guide_of_a_step_is_closed_over_it():
    upper, lower = drive(stepped_panel(), "wall", "pocket-01").walls
    assert upper.curve.area == approx(80 * 40 - CORNERS)
    assert (upper.bottom, lower.top) == approx((-17.0, -17.0))


def test_a_corner_knows_the_cutter_that_was_there_before():
    before = operation("rough", "pocket-01", D20, {"route.wall_allowance": 0.4})
    corner = drive(
        panel(),
        "corner",
        "pocket-01",
        (before,),
        {"route.wall_allowance": 0.5, "route.floor_allowance": 0.3},
    )
    assert (corner.earlier_radius, corner.earlier_allowance) == (10.0, 0.4)
    assert (corner.wall_allowance, corner.floor_allowance) == (0.5, 0.3)


def test_the_same_drive_comes_out_in_a_setup_from_below():
    area = rounded(20, 10, 80, 40, 8)
    part = FlatPart(
        outline=rounded(0, 0, 100, 50, 10),
        height=20.0,
        cuts=(Prism(area=area, low=-1, high=12, face=2, side=3, at=(50, 25)),),
    )
    pocket = Feature(
        id="pocket-01",
        kind="pocket",
        faces=(FaceRole(role="floor", face=2),),
        sizes={"corner_radius": 8.0},
        attributes={"direction": (0.0, 0.0, -1.0)},
    )
    recognition = Recognition(family="panel", frame=WORLD, features=(pocket,))
    _, below = make_setups(recognition, blank_of(part), choose(SetupSettings, MILL))
    process = ProcessTree(plan="", material="", setups=(below,))
    space = SetupSpace.of(part, recognition, blank_of(part), below)
    (level,) = drive_of(operation("rough", "pocket-01", D10), process, space).levels
    assert (level.top, level.bottom) == approx((0.0, -12.0))
    assert level.wanted.area == approx(60 * 30 - CORNERS)
    assert level.wanted.curves()[0].area > 0


def test_a_pocket_that_the_sections_do_not_show_is_refused_by_name():
    part, _ = panel()
    ghost = Feature(
        id="pocket-07",
        kind="pocket",
        faces=(FaceRole(role="floor", face=1),),
        sizes={"floor_z": 30.0},
    )
    with pytest.raises(Refused, match="pocket-07"):
        drive((part, Recognition(family="panel", features=(ghost,))), "rough", "pocket-07")


def test_a_sharp_cutter_keeps_the_fillets_radius_from_the_wall_at_the_floor():
    assert foot_clearance(3.0, 0.0, 0.0) == 3.0
    assert foot_clearance(3.0, 3.0, 0.0) == 0.0
    assert foot_clearance(3.0, 1.0, 2.0) == 0.0
    # The cutter's corner touches the fillet's circle: (gap - e)^2 + (gap - t)^2 = gap^2.
    e = foot_clearance(3.0, 1.0, 0.8)
    assert (2.0 - e) ** 2 + (2.0 - 0.8) ** 2 == approx(4.0)
