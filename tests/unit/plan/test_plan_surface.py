"""What the plan of curved parts stands on: cutting frames, height maps, what a cutter reaches, areas and the stock of directions."""

from __future__ import annotations

from dataclasses import replace

import cadquery as cq
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from milling import mill
from samples import read
from shaped_parts import bowl
from surface_drives import grid, joined
from trunnion.geometry.frame import WORLD, Frame
from trunnion.geometry.plane.region import Region
from trunnion.geometry.surface.drop_surface import DropSurface
from trunnion.model.blank import Box
from trunnion.model.feature import FaceRole, Feature, Recognition
from trunnion.model.motion.toolpath import Mark, Motion, Toolpath
from trunnion.model.setup import Setup
from trunnion.part.shape.skin import skin_of
from trunnion.pipeline.operation_path import turned
from trunnion.plan.freeform.cutters.choice import cutter_for
from trunnion.plan.freeform.finishing.areas import (
    areas_of,
    blank_faces,
    connected,
    hidden_areas,
    on_outline,
    walls_of,
    with_joined_hollows,
)
from trunnion.plan.freeform.reach import reached, samples_on
from trunnion.plan.freeform.roughing.heights import HeightMap, region_below
from trunnion.plan.freeform.roughing.layers import level_faces
from trunnion.plan.freeform.space import SurfaceSpace, skin_around
from trunnion.plan.setups.frames import cutting_setup
from trunnion.progress import NO_PROGRESS
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.toolpath.stock.views import StockViews

BLANK = Box(
    frame=WORLD,
    low=np.zeros(3),
    high=np.array([40.0, 30.0, 20.0]),
    material="EN AW-7075",
    density=2.8,
)
SETUP = Setup(
    name="S1",
    frame=Frame(np.array([0.0, 0.0, 20.0]), np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])),
    work_offset="G54",
    clearance=20.0,
    machine="Trunnion 650",
)
BALL_4, BALL_6 = (
    replace(mill(d), name=f"ball {d:g}", form="ball", corner_radius=d / 2) for d in (4.0, 6.0)
)


def block(skin):
    """Return the space of a skin in the blank, upright."""
    return SurfaceSpace(
        part=None,
        blank=BLANK,
        setup=replace(SETUP, frame=WORLD, clearance=40.0),
        direction=(0.0, 0.0, 1.0),
        skin=skin,
        low=BLANK.low,
        high=BLANK.high,
    )


def domed():
    """Return a block of 40 x 30 x 10 with a ball of radius 8 half in the middle of its top."""
    ball = cq.Workplane("XY").sphere(8).translate((20, 15, 10))
    return read(cq.Workplane("XY").box(40, 30, 10, centered=False).union(ball).val().wrapped)


# cutting frames


def test_an_upright_operation_is_cut_in_the_setup_itself():
    assert cutting_setup(SETUP, (0.0, 0.0, 1.0), BLANK) is SETUP


def test_a_tool_from_the_side_sees_the_blank_from_there_with_the_same_clearance():
    turned_setup = cutting_setup(SETUP, (1.0, 0.0, 0.0), BLANK)
    assert turned_setup.frame.z == pytest.approx([1.0, 0.0, 0.0])
    assert BLANK.corners(turned_setup.frame)[:, 2].max() == pytest.approx(40.0)
    assert turned_setup.clearance == pytest.approx(60.0)


def test_a_path_turned_into_another_frame_and_back_is_the_same():
    path = Toolpath(
        position=np.array([[0.0, 0, 5], [10, 0, 1], [0, 10, 1]]),
        axis=np.tile([0.0, 0.0, 1.0], (3, 1)),
        motion=np.array([Motion.RAPID, Motion.LINE, Motion.ARC_CCW]),
        feed=np.array([0.0, 100, 100]),
        mark=np.zeros(3, int),
        centre=np.array([[np.nan] * 3, [np.nan] * 3, [0.0, 0, 1]]),
    )
    tilted = cutting_setup(SETUP, (0.6, 0.0, 0.8), BLANK).frame
    there = turned(path, tilted, SETUP.frame)
    assert there.axis[0] == pytest.approx([0.6, 0.0, 0.8])
    assert there.sweeps() == pytest.approx(path.sweeps())
    again = turned(there, SETUP.frame, tilted)
    assert again.position == pytest.approx(path.position)
    assert again.centre[2] == pytest.approx(path.centre[2])


# height maps and layers


def test_the_area_below_a_height_of_a_cone_is_outside_its_circle():
    skin = grid(lambda x, y: 10.0 - np.hypot(x - 15.0, y - 15.0), n=80)
    tall = HeightMap.of(
        skin.drop, np.array([0.0, 0.0, -20.0]), np.array([30.0, 30.0, 10.0]), 0.25, 0.0
    )
    area = tall.below(4.0, 0.02)
    # Where the cone is as high as 4 the radius is 6; what is kept off it is a disc of a cell's diagonal and a chord of the rim.
    assert area.signed_distance(np.array([[15.0, 15.0 + 6.0]]))[0] < 0.0
    assert area.signed_distance(np.array([[15.0, 15.0 + 6.0 + 0.36 + 0.1]]))[0] > 0.0
    assert (900.0 - area.area) == pytest.approx(np.pi * 6.38**2, rel=0.02)


def test_an_allowance_keeps_off_in_every_direction():
    skin = grid(lambda x, y: np.where(x < 15.0, 0.0, 1.0) * 10.0, n=3000 // 50)
    plain, thick = (
        HeightMap.of(skin.drop, np.array([0.0, 0.0, -5.0]), np.array([30.0, 30.0, 12.0]), 0.25, a)
        for a in (0.0, 0.5)
    )
    level = thick.height[10, 10] - plain.height[10, 10]
    assert level == pytest.approx(0.5)
    assert plain.below(5.0, 0.01).area - thick.below(5.0, 0.01).area == pytest.approx(
        0.5 * 30.0, rel=0.2
    )


@settings(deadline=None, max_examples=12)
@given(
    st.lists(
        st.tuples(st.floats(5, 25), st.floats(5, 25), st.floats(1, 6), st.floats(1, 8)),
        min_size=1,
        max_size=4,
    ),
    st.floats(0.5, 6.0),
)
def test_nothing_in_the_area_below_a_height_is_higher(bumps, z):
    def height(x, y):
        return np.max(
            [h * np.exp(-((x - a) ** 2 + (y - b) ** 2) / r**2) for a, b, r, h in bumps], axis=0
        )

    skin = grid(height, n=60)
    area = HeightMap.of(
        skin.drop, np.array([0.0, 0.0, -1.0]), np.array([30.0, 30.0, 10.0]), 0.5, 0.0
    ).below(z, 0.05)
    places = np.random.default_rng(1).uniform(0.0, 30.0, (2000, 2))
    inside = places[area.contains(places)]
    if len(inside):
        needle = np.array([[0.0, 1e-6, 0.0, 0.0, 0.0, 0.0]])
        assert (
            DropSurface.of(skin.points, skin.triangles).drop(inside, needle, -1.0).max() <= z + 1e-6
        )


def test_a_cell_with_two_low_corners_across_is_one_area():
    height = np.array([[0.0, 2.0], [2.0, 0.0]])
    assert len(region_below(height, np.zeros(2), 1.0, 1.0, 1e-6).pieces) == 1


@given(st.floats(0.1, 0.9), st.floats(-50.0, 50.0))
def test_no_hair_stands_between_the_cells_of_a_low_area_whatever_their_size(cell, corner):
    area = region_below(np.zeros((24, 7)), np.array([corner, 0.0]), cell, 1.0, 0.01)
    assert area.area == pytest.approx((23 * cell - 0.02) * (6 * cell - 0.02))


def test_level_faces_end_layers():
    assert level_faces(
        block(joined(grid(lambda x, y: 0 * x + 5.0, n=4), grid(lambda x, y: 0 * x + 12.0, n=4)))
    ) == [12.0, 5.0]


# what a cutter reaches


def test_places_stand_for_equal_shares_of_the_area():
    places = samples_on(
        joined(
            grid(lambda x, y: 0 * x, n=3, high=(10.0, 10.0), tag=1),
            grid(lambda x, y: x, n=9, high=(10.0, 10.0), tag=2),
        ),
        (1, 2),
        500,
    )
    assert places.area == pytest.approx((100.0 + 100.0 * np.sqrt(2.0)) / 500)
    assert (places.face == 1).sum() == pytest.approx(500 / (1 + np.sqrt(2.0)), abs=1)
    assert (
        np.abs(places.normal[places.face == 2] - np.array([-1.0, 0.0, 1.0]) / np.sqrt(2.0)).max()
        < 1e-9
    )


@pytest.mark.parametrize("tag", [1, 2])
@pytest.mark.parametrize("count", [60, 500, 20_000])
def test_places_lie_everywhere_on_a_triangle(tag, count):
    """A spread whose two steps add up to a whole number has all its places on one line."""
    halves = joined(
        grid(lambda x, y: 0.0 * x, n=1, high=(10.0, 10.0), tag=1),
        grid(lambda x, y: 0.0 * x, n=3, low=(20.0, 0.0), high=(30.0, 7.0), tag=2),
    )
    places = samples_on(halves, (tag,), count)
    corners = halves.points[halves.triangles[halves.of((tag,))]][:, :, :2].reshape(-1, 2)
    low, high = corners.min(axis=0), corners.max(axis=0)
    looked = low + np.random.default_rng(1).uniform(0.02, 0.98, (4000, 2)) * (high - low)
    hole = cKDTree(places.point[:, :2]).query(looked)[0].max()
    assert hole < 2.2 * np.sqrt(places.area)
    share = (places.point[:, :2] < 0.5 * (low + high)).all(axis=1).mean()
    assert share == pytest.approx(0.25, abs=0.05 if count > 60 else 0.1)


def test_a_ball_reaches_a_trough_that_is_wider_than_it_and_no_other():
    trough = grid(
        lambda x, y: 20.0 - np.sqrt(np.maximum(25.0 / 4 - (y - 5.0) ** 2, 0.0)),
        n=120,
        low=(0.0, 2.8),
        high=(10.0, 7.2),
    )
    space, places = block(trough), samples_on(trough, (1,), 300)
    assert reached(space, places, BALL_4, 1.0).mean() > 0.9
    assert reached(space, places, BALL_6, 1.0).mean() < 0.1


def hollow(radius, half=1.9):
    """Return the skin of a square part of a hollow sphere."""
    return grid(
        lambda x, y: 20.0 - np.sqrt(radius**2 - x**2 - y**2),
        n=40,
        low=(-half, -half),
        high=(half, half),
    )


@pytest.mark.parametrize(
    ("radius", "chosen"), [(3.02, BALL_4), (3.2, BALL_4), (3.5, BALL_6), (9.0, BALL_6)]
)
def test_a_ball_nearly_as_round_as_a_hollow_is_left_for_a_smaller_one(radius, chosen):
    space = block(hollow(radius))
    places = samples_on(space.skin, (1,), 400)
    assert reached(space, places, BALL_6, 1.0).mean() > 0.9
    found = cutter_for(space, places, (BALL_4, BALL_6), 0.9, 1.0, None, NO_PROGRESS)
    assert found.tool is chosen
    assert cutter_for(space, places, (BALL_6,), 0.9, 1.0, None, NO_PROGRESS).tool is BALL_6
    assert cutter_for(space, places, (BALL_4,), 0.9, 1.0, BALL_6, NO_PROGRESS).tool is BALL_6


def test_a_ball_nearly_as_round_as_a_fillet_goes_along_it():
    trough = grid(
        lambda x, y: 20.0 - np.sqrt(3.02**2 - y**2), n=40, low=(-9.0, -2.2), high=(9.0, 2.2)
    )
    space, places = block(trough), samples_on(trough, (1,), 400)
    found = cutter_for(space, places, (BALL_4, BALL_6), 0.9, 1.0, None, NO_PROGRESS)
    assert found.tool is BALL_6


def test_a_ball_as_round_as_a_bowl_has_no_way_to_go_in_it():
    part = bowl(20.0, 16.0, 8.0, 3.0)
    hollow = next(t for t in part.tags if part.graph().surface[t - 1] == "sphere")
    space = block(skin_of(part, WORLD, 0.0025))
    places = samples_on(space.skin, (hollow,), 300)
    # The one as round as the bowl touches all of it from its middle.
    assert reached(space, places, BALL_6, 1.0).mean() < 0.5
    assert reached(space, places, BALL_4, 1.0).mean() > 0.9


def test_a_holder_that_would_touch_a_wall_keeps_a_cutter_out():
    floor = grid(lambda x, y: 0 * x, n=4, high=(30.0, 10.0))
    wall = grid(lambda x, y: 0 * x + 19.0, n=4, low=(0.0, 10.5), high=(30.0, 20.0), tag=2)
    space = block(joined(floor, wall))
    places = samples_on(space.skin, (1,), 200)
    near = np.abs(places.point[:, 1] - 8.0) < 1.0
    short, long = (
        replace(mill(2.0, 0.0, flute_length=5.0, stickout=length), form="ball", corner_radius=1.0)
        for length in (18.0, 40.0)
    )
    assert not reached(space, places, short, 1.0)[near].any()
    assert reached(space, places, long, 0.2)[near].all()


def test_a_ball_touches_a_steep_foot_only_from_below_what_it_stands_on():
    wall = grid(lambda x, y: 10.0 * (10.0 - x), n=4, low=(9.0, 0.0), high=(10.0, 10.0))
    space, places = block(wall), samples_on(wall, (1,), 300)
    # Its tip is lower than where it touches by R (1 - cos a), a the slope's angle.
    lower = BALL_6.radius * (1.0 - 1.0 / np.hypot(1.0, 10.0))
    foot = places.point[:, 2] < float(space.low[2]) + lower - 0.05
    assert foot.sum() > 20
    assert not reached(space, places, BALL_6, 1.0)[foot].any()
    assert reached(space, places, BALL_6, 1.0, below=1.0)[foot].any()
    assert reached(space, places, BALL_6, 1.0, below=BALL_6.radius)[foot].all()
    some = (space, places, (BALL_4, BALL_6), 0.99, 1.0, None, NO_PROGRESS)
    assert cutter_for(*some).tool is BALL_4
    assert cutter_for(*some, below=BALL_6.radius).tool is BALL_6


# areas


def test_local_features_hang_together_and_the_rest_is_one_area():
    part = domed()
    ball = next(t for t in part.tags if part.graph().surface[t - 1] == "sphere")
    rest = tuple(t for t in part.tags if t != ball)
    found = Recognition(
        family="surface",
        features=(
            Feature(
                id="group-01",
                kind="group",
                faces=tuple(FaceRole(role="face", face=t) for t in rest),
                attributes={"local": False},
            ),
            Feature(
                id="group-02",
                kind="group",
                faces=(FaceRole(role="face", face=ball),),
                attributes={"local": True},
            ),
        ),
    )
    areas = areas_of(found, part.graph())
    assert [(a.id, a.local) for a in areas] == [("remaining", False), ("local-01", True)]
    assert areas[1].tags == (ball,)
    assert connected(part.tags, part.graph()) == [part.tags]


def test_sides_of_a_block_stand_free_and_its_bottom_lies_in_the_blank():
    part = domed()
    graph = part.graph()
    blank = replace(BLANK, low=np.array([-5.0, -5.0, 0.0]), high=np.array([45.0, 35.0, 20.0]))
    space = SurfaceSpace.of(part, skin_of(part, WORLD, 0.02), blank, replace(SETUP, frame=WORLD))
    assert [graph.normal[t - 1][2] for t in blank_faces(part, blank)] == pytest.approx([-1.0])
    places = samples_on(space.skin, part.tags)
    walls = walls_of(places, part.tags)
    assert len(walls) == 4
    assert on_outline(space, walls) == walls


def test_hollows_that_hang_together_are_apart_from_what_they_run_into():
    part = read(
        cq.Workplane("XY")
        .box(40, 30, 10, centered=False)
        .union(cq.Workplane("XY").center(20, 15).circle(6).extrude(18))
        .edges(cq.selectors.BoxSelector((10, 5, 9), (30, 25, 11)))
        .fillet(2.0)
        .val()
        .wrapped
    )
    graph = part.graph()
    hollow = next(t for t in part.tags if graph.surface[t - 1] == "torus")
    round_ = next(t for t in part.tags if graph.surface[t - 1] == "cylinder")
    found = Recognition(
        family="surface",
        features=(
            Feature(
                id="group-01",
                kind="group",
                faces=(FaceRole(role="face", face=hollow),),
                sizes={"concave_radius": 2.0},
            ),
            Feature(id="group-02", kind="group", faces=(FaceRole(role="face", face=round_),)),
        ),
    )
    assert {a.tags: a.local for a in hidden_areas(found, graph, (hollow, round_))} == {
        (round_,): False,
        (hollow,): True,
    }
    # The hollow is cut with hidden ones that it hangs together with, and only then.
    both = tuple(sorted((hollow, round_)))
    tight = tuple(replace(f, sizes={"concave_radius": 2.0}) for f in found.features)
    joined = Recognition(family="surface", features=tight)
    assert with_joined_hollows(joined, graph, (round_,), both) == both
    assert with_joined_hollows(joined, graph, (), both) == ()
    assert with_joined_hollows(found, graph, (hollow,), both) == (hollow,)


# the stock of several directions


def cut_from(x):
    """Return a path that clears the blank from x = 0 to `x` down to its bottom, upright."""
    rows = [
        (x - 5.0 - 6.0 * k, y)
        for k in range(4)
        for y in ((-6.0, 36.0) if k % 2 == 0 else (36.0, -6.0))
    ]
    position = np.array([(*rows[0], 5.0), *((px, py, -20.0) for px, py in rows)])
    n = len(position)
    return Toolpath(
        position=position,
        axis=np.tile([0.0, 0.0, 1.0], (n, 1)),
        feed=np.array([0.0] + [500.0] * (n - 1)),
        motion=np.array([Motion.RAPID] + [Motion.LINE] * (n - 1)),
        centre=np.full((n, 3), np.nan),
        mark=np.full(n, Mark.CUT),
    )


def test_what_is_cut_from_above_is_gone_from_the_side_too():
    sides = StockViews(BLANK)
    from_left = cutting_setup(SETUP, (-1.0, 0.0, 0.0), BLANK)
    before = sides.seen(from_left)
    assert before.heights.max() == pytest.approx(0.0)
    sides.seen(SETUP)
    sides.cut(SETUP, cut_from(20.0), mill(10.0))
    after = sides.seen(from_left)
    assert after.digest != before.digest
    # The cutter's flank went as far as x = 20: seen from the left the stock begins there, within two cells and never deeper.
    middle = after.heights[2:-2, 2:-2]
    assert (middle >= -20.0 - 1e-9).all() and (middle <= -20.0 + 3 * after.cell).all()


def test_a_blank_that_stands_askew_is_as_high_as_it_is_there():
    tilted = cutting_setup(SETUP, (0.6, 0.0, 0.8), BLANK)
    stock = StockViews(BLANK).seen(tilted)
    around = PlanningStock.of(BLANK, tilted)
    assert stock.heights.shape == around.heights.shape and (stock.heights <= around.heights).all()
    low, high = stock.box()
    places = np.array(
        [
            [x, y]
            for x in np.linspace(low[0], high[0], 15)[1:-1]
            for y in np.linspace(low[1], high[1], 9)[1:-1]
        ]
    )
    for place in places:
        top = stock.height(place, place, 0.1)
        line = tilted.frame.to_world(
            np.column_stack([np.tile(place, (400, 1)), np.linspace(-60.0, 60.0, 400)])
        )
        inside = ((line >= BLANK.low) & (line <= BLANK.high)).all(axis=1)
        if inside.any():
            true = np.linspace(-60.0, 60.0, 400)[inside].max()
            assert true - 0.4 <= top <= true + 1.5


def test_a_leaning_path_takes_nothing_off():
    sides = StockViews(BLANK)
    before = sides.seen(SETUP)
    path = cut_from(20.0)
    sides.cut(SETUP, replace(path, axis=np.tile([0.6, 0.0, 0.8], (len(path), 1))), mill(10.0))
    assert sides.seen(SETUP) is before


def test_an_area_without_anything_low_is_empty():
    assert not region_below(np.full((3, 3), 5.0), np.zeros(2), 1.0, 1.0, 0.01)
    whole = region_below(np.zeros((3, 3)), np.zeros(2), 1.0, 1.0, 0.01)
    assert whole.area == pytest.approx(Region.rectangle(0.01, 0.01, 1.99, 1.99).area)


def test_what_a_cutter_comes_near_to_is_kept_of_a_skin_and_no_more():
    # A wide wavy floor, and a little of it that is finished.
    skin = grid(lambda x, y: np.sin(x / 7.0) * np.cos(y / 5.0), n=160, low=(0, 0), high=(400, 300))
    middle = skin.points[skin.triangles].mean(axis=1)
    mine = (np.abs(middle[:, :2] - [200.0, 150.0]) < 12.0).all(axis=1)
    skin = replace(skin, face=np.where(mine, 2, 1))
    near = skin_around(skin, (2,), [BALL_4, BALL_6], 5.0)
    assert near.of((2,)).sum() == mine.sum() and len(near.triangles) < 0.1 * len(skin.triangles)
    # Tips come a radius from where they touch and 5 mm more, the widest of the tool as far again.
    corners = skin.points[skin.triangles[mine]].reshape(-1, 3)[:, :2]
    off = BALL_6.radius + 5.0
    tips = np.random.default_rng(5).uniform(
        corners.min(axis=0) - off, corners.max(axis=0) + off, (400, 2)
    )
    for z, radius in BALL_6.rings():
        disc = np.array([[0.0, radius, 0.0, 0.0, 0.0, 0.0]])
        if z < 10.0:
            assert (near.drop.drop(tips, disc, -9.0) == skin.drop.drop(tips, disc, -9.0)).all()
