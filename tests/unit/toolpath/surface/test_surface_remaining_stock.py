"""Tools among stock that stands: what is known of it, which poses keep out of it, and links under what hangs over."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from surface_drives import DATA, driven, grid, joined
from trunnion.geometry.frame import WORLD
from trunnion.geometry.kernels.bodies import bodies_hold_reference
from trunnion.geometry.kernels.voxels import (
    voxels_above,
    voxels_above_reference,
    voxels_held,
    voxels_held_reference,
)
from trunnion.geometry.point_groups import PointGroups
from trunnion.geometry.sheet.skin import Skin
from trunnion.model.blank import Box
from trunnion.model.motion.toolpath import Mark, Motion, Toolpath
from trunnion.model.setup import Setup
from trunnion.plan.freeform.finishing.rest import HOLDER_CLEARANCE, remaining_upright, without_met
from trunnion.toolpath.contact_passes.linking.link_passes import linked
from trunnion.toolpath.contact_passes.linking.parameters import LinkParameters
from trunnion.toolpath.contact_passes.passes import UPRIGHT, Pass
from trunnion.toolpath.contact_passes.stock_clearance import StockClearance, grown
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.toolpath.stock.leaning_cuts import LeaningCut
from trunnion.toolpath.stock.views import StockViews
from trunnion.toolpath.stock.voxels import StockVoxels, samples_of
from verify_tools import bull

BALL = replace(bull(6.0, 3.0)(), flute_length=8.0, neck_length=20.0)
MANNER = LinkParameters(stepover=0.5, lead_radius=1.0)
BLANK = Box(
    frame=WORLD,
    low=np.zeros(3),
    high=np.array([30.0, 20.0, 10.0]),
    material="7050-T7451",
    density=2.83,
)
SETUP = Setup(name="S1", frame=WORLD, work_offset="G54", clearance=15.0, machine="Trunnion 650")
LEANING = np.array([0.6, 0.0, 0.8])


def cleared(depth, past):
    """Return the field of the blank cut down to a depth where x is greater than `past`."""
    stock = PlanningStock.of(BLANK, SETUP)
    heights = stock.heights.copy()
    rows = stock.corner[0] + (np.arange(len(heights)) + 0.5) * stock.cell > past
    heights[rows] = depth
    return replace(stock, field=heights)


def far_part():
    """Return a floor far below the blank."""
    return grid(lambda x, y: -50.0 + 0.0 * x)


def standing_below(field, part=None, near=1.0):
    """Return what stands below a field in the blank, off a part that is far below it where none is given."""
    voxels = StockVoxels.of(BLANK, part or far_part(), near)
    voxels.lower("field", field, WORLD)
    return voxels.remaining(WORLD, leaning=False)


def straight(start, end, axis=UPRIGHT):
    tips = np.array([start, end], dtype=float)
    return Pass(tip=tips, axis=np.tile(axis, (2, 1)), normal=np.tile(UPRIGHT, (2, 1)))


def leaf(height, low, high):
    """Return a level leaf over a rectangle that looks down, as its triangles have it: face 2."""
    skin = grid(lambda x, y: height + 0.0 * x, n=4, low=low, high=high, tag=2)
    return Skin(
        points=skin.points,
        normals=-skin.normals,
        triangles=skin.triangles[:, ::-1],
        face=skin.face,
        bound=0.0,
    )


def roofed():
    """Return a level floor of 30 by 30 mm at height 0 and a roof over its first 10 mm, 12 mm higher."""
    floor = grid(lambda x, y: 0.0 * x, n=30)
    return joined(floor, leaf(12.0, (0.0, 0.0), (10.0, 30.0)))


@pytest.mark.parametrize(("count", "spacing"), [(60, 1.0), (60, 100.0), (3000, 1.5)])
def test_the_compiled_kernel_and_the_plain_one_agree(count, spacing):
    pick = np.random.default_rng(3)
    points, tips = pick.uniform(-10.0, 10.0, (count, 3)), pick.uniform(-30.0, 30.0, (400, 3))
    axes = pick.normal(size=(400, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    rows = np.array([[0.0, 1.0, 4.0, 1.0], [4.0, 1.0, 6.0, 3.0], [6.0, 5.0, 9.0, 5.0]])
    plain = np.zeros(400, bool)
    found = PointGroups.of(points, spacing).held_by(rows, tips, axes)
    bodies_hold_reference(points, tips, axes, rows, plain)
    assert (found == plain).all() and 0 < found.sum() < 400


def test_groups_hold_every_point_within_their_balls():
    points = np.random.default_rng(5).uniform(-10.0, 10.0, (5000, 3))
    groups = PointGroups.of(points, 1.0)
    assert sorted(groups.points.tolist()) == sorted(points.tolist())
    for start, ball in (
        (groups.start, groups.ball),
        (groups.start[groups.large_start], groups.large_ball),
    ):
        group = np.repeat(np.arange(len(ball)), np.diff(start))
        away = np.linalg.norm(groups.points - ball[group, :3], axis=1)
        assert (away <= ball[group, 3] + 1e-9).all()
    assert len(groups.large_ball) < len(groups.ball) / 8 < len(points) / 64


def test_what_one_direction_has_cut_stands_no_more():
    whole, cut = (standing_below(f) for f in (PlanningStock.of(BLANK, SETUP), cleared(4.0, 20.0)))
    # Only the outermost voxels are asked for, which are those in the blank's sides.
    inside = ((whole.points > 0.6) & (whole.points < BLANK.high - 0.6)).all(axis=1)
    assert not inside.any() and len(whole.points) == 60 * 40 * 20 - 58 * 38 * 18
    gone = (cut.points[:, 0] > 20.5) & (cut.points[:, 2] > 4.5)
    assert not gone.any() and (cut.points[:, 2] > 4.5).any()
    # What was under the cut is outermost now.
    assert ((cut.points[:, 0] > 21.0) & (np.abs(cut.points[:, 2] - 3.75) < 0.1)).sum() > 500


def test_whatever_stands_has_the_middle_of_a_voxel_near():
    """A skin of 0.1 mm over the floor, and a rib of 0.1 mm on it: less than the voxels."""
    stock = PlanningStock.of(BLANK, SETUP, 0.05)
    heights = np.full_like(stock.heights, 4.1)
    at = stock.corner[0] + (np.arange(len(heights)) + 0.5) * stock.cell
    heights[np.abs(at - 12.31) < 0.05] = 7.03
    stood = standing_below(replace(stock, field=heights))
    reach = 0.5 * np.sqrt(3.0) * stood.side
    rib = np.column_stack([np.full(50, 12.31), np.full(50, 9.7), np.linspace(4.2, 7.0, 50)])
    for point in (*rib, [25.0, 5.0, 4.09]):
        assert np.linalg.norm(stood.points - point, axis=1).min() <= reach
    assert not ((stood.points[:, 2] > 4.5) & (np.abs(stood.points[:, 0] - 12.31) > 0.5)).any()


def test_a_body_is_clear_where_nothing_stands_and_only_there():
    stock = standing_below(cleared(0.0, 10.0))
    tips = np.array([[20.0, 10.0, 2.0], [12.0, 10.0, 2.0], [5.0, 10.0, 2.0]])
    shank = ((0.0, 2.0, 20.0, 2.0),)
    assert stock.is_free(shank, tips, np.tile(UPRIGHT, (3, 1))).tolist() == [True, False, False]
    # The same tip with its axis leaning towards what stands is in it.
    away, towards = LEANING, LEANING * [-1.0, 1.0, 1.0]
    tip = np.array([[16.0, 10.0, 2.0]] * 2)
    assert stock.is_free(shank, tip, np.array([away, towards])).tolist() == [True, False]


def test_near_the_part_stock_is_not_counted_nor_is_the_part_itself():
    floor = grid(lambda x, y: 4.0 + 0.0 * x, n=30)
    left = standing_below(PlanningStock.of(BLANK, SETUP), floor, near=2.0)
    assert left.points[:, 2].min() > 6.0 and left.points[:, 2].max() > 9.0


@settings(max_examples=20, deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1),
    size=st.tuples(st.integers(1, 14), st.integers(1, 14), st.integers(1, 14)),
)
def test_blocks_that_are_far_from_the_part_are_marked_as_their_voxels_would_be(seed, size):
    pick = np.random.default_rng(seed)
    wave = pick.uniform(0.0, 1.5, 3)
    floor = grid(lambda x, y: 4.0 + np.sin(wave[0] * x) + np.cos(wave[1] * y + wave[2]), n=40)
    high = np.array(size) * 2.0
    blank = replace(BLANK, high=high)
    near = pick.uniform(0.2, 3.0)
    voxels = StockVoxels.of(blank, floor, near)
    samples = samples_of(floor)
    middle = voxels.low + np.argwhere(np.ones(voxels.wanted.shape, bool)) * voxels.step
    away, row = cKDTree(samples.point).query(middle)
    outside = ((middle - samples.point[row]) * samples.normal[row]).sum(axis=1) > 0.0
    assert (voxels.wanted.ravel() == (outside & (away > near))).mean() > 0.999


def clearance(remaining_stock, skin=None):
    """Return the queries of a ball on a drive where nothing of the part is ever met."""
    drive, *_ = driven(skin or grid(lambda x, y: 0.0 * x, n=30))
    drive = replace(
        drive,
        remaining_stock=remaining_stock,
        query_for=lambda tool: lambda tip, axis, **_: np.ones(len(tip), bool),
    )
    return StockClearance(drive, BALL, 2.0)


def test_a_leaning_tool_keeps_its_shank_out_of_stock_that_stands():
    around = clearance(standing_below(cleared(0.0, 10.0)))
    query = around.with_stock(lambda tip, axis, **_: np.ones(len(tip), bool))
    tip, axes = np.array([[16.0, 10.0, 0.0]] * 2), np.array([LEANING, LEANING * [-1.0, 1.0, 1.0]])
    assert query(tip, axes).tolist() == [True, False]


def post():
    """Return what stands of the blank in a post of 2 by 4 mm about (15, 10)."""
    stock = PlanningStock.of(BLANK, SETUP)
    heights = np.zeros_like(stock.heights)
    x, y = (
        stock.corner[k] + (np.arange(n) + 0.5) * stock.cell for k, n in enumerate(heights.shape)
    )
    heights[np.ix_(np.abs(x - 15.0) < 1.0, np.abs(y - 10.0) < 2.0)] = 10.0
    return standing_below(replace(stock, field=heights))


@pytest.mark.parametrize(
    ("start", "end", "is_free"),
    [
        (((5.0, 10.0, 0.5), UPRIGHT), ((25.0, 10.0, 0.5), UPRIGHT), False),
        (((5.0, 2.0, 0.5), UPRIGHT), ((25.0, 2.0, 0.5), UPRIGHT), True),
        # Its tip stays where it is: the axis turns past the post, or away from it.
        (((8.0, 10.0, 0.5), (0.4, 0.7, 0.6)), ((8.0, 10.0, 0.5), (0.4, -0.7, 0.6)), False),
        (((8.0, 10.0, 0.5), (-0.4, 0.7, 0.6)), ((8.0, 10.0, 0.5), (-0.4, -0.7, 0.6)), True),
    ],
)
def test_a_leaning_tool_keeps_its_shank_out_of_stock_between_two_poses(start, end, is_free):
    query = clearance(post()).with_stock(lambda tip, axis, **_: np.ones(len(tip), bool))
    (tip, axis), (end_tip, end_axis) = (
        (np.array([p]), np.array([a]) / np.linalg.norm(a)) for p, a in (start, end)
    )
    for one in ((tip, axis), (end_tip, end_axis)):
        assert query(*one).all()
    found = query(end_tip, end_axis, start_tip=tip, start_axis=axis)
    assert found.tolist() == [is_free]


def test_poses_are_asked_for_from_the_safest_to_those_clear_of_the_part_alone():
    whole = standing_below(cleared(0.0, 10.0))
    widths, bare = [], lambda tip, axis, **_: np.ones(len(tip), bool)

    def query_for(tool):
        widths.append(tool.neck_diameter - BALL.neck_diameter)
        return bare

    found = clearance(whole).queries(query_for, bare)
    # Twice the wanted thickness on either side, then a millimetre's, then nothing but what stands.
    assert widths == pytest.approx([4.0, 2.0]) and len(found) == 3
    # With its shank in stock a tool goes nowhere, whatever it leaves.
    tip, into = np.array([[16.0, 10.0, 0.0]]), np.array([LEANING * [-1.0, 1.0, 1.0]])
    assert [bool(q(tip, into)[0]) for q in found] == [False] * 3
    nothing = replace(whole, points=np.zeros((0, 3)))
    found = clearance(nothing).queries(query_for, bare)
    assert len(found) == 3 and found[-1] is bare
    assert len(clearance(whole).queries(query_for, bare, wary=True)) == 2


def leant(past, y=10.0, low=0.0):
    """Return the path of a leaning tool along the blank from its end to an x, at a height."""
    tips = np.array([[32.0, y, low + 20.0], [32.0, y, low], [past, y, low]])
    return Toolpath(
        position=tips,
        axis=np.tile(LEANING, (3, 1)),
        motion=np.array([Motion.RAPID, Motion.LINE, Motion.LINE]),
        feed=np.array([0.0, 100.0, 100.0]),
        mark=np.array([Mark.RETRACT, Mark.ENTRY, Mark.CUT]),
        centre=np.full((3, 3), np.nan),
    )


def test_the_kernel_that_takes_bodies_off_voxels_and_the_plain_one_agree():
    pick = np.random.default_rng(7)
    tips, axes = pick.uniform(-2.0, 12.0, (12, 3)), pick.normal(size=(12, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    rows = np.array([[0.0, 0.2, 1.0, 1.5], [1.0, 1.5, 5.0, 1.5]])
    low, step = np.array([0.3, -0.2, 0.1]), np.array([1.0, 0.9, 1.1])
    found, plain = (np.ones((10, 11, 9), bool) for _ in range(2))
    voxels_held(found, low, step, tips, axes, rows)
    voxels_held_reference(plain, low, step, tips, axes, rows)
    assert (found == plain).all() and 0 < (~found).sum() < 990


@pytest.mark.parametrize("side", [0.4, 1.7])
def test_the_kernel_that_takes_off_what_is_above_a_field_and_the_plain_one_agree(side):
    pick = np.random.default_rng(9)
    low, step = np.array([0.3, -0.2, 0.1]), np.array([1.0, 0.9, 1.1])
    heights = pick.uniform(-8.0, 10.0, (20, 30))
    for _ in range(6):
        turn = np.linalg.qr(pick.normal(size=(3, 3)))[0]
        shift, corner = pick.uniform(-3.0, 3.0, 3), pick.uniform(-8.0, 0.0, 2)
        found = pick.random((10, 11, 9)) < 0.8
        plain, before = found.copy(), int(found.sum())
        place = (low, step, turn, shift, heights, corner, side)
        voxels_above(found, *place)
        voxels_above_reference(plain, *place)
        assert (found == plain).all() and 0 < found.sum() < before


def test_what_a_leaning_tool_has_cut_stands_no_more_where_that_is_asked_for():
    views = StockViews(BLANK)
    views.seen(SETUP)
    assert not views.cut(SETUP, leant(10.0), BALL, allowance=0.2)
    asked, unasked = (views.remaining_stock(WORLD, far_part, leaning=v) for v in (True, False))
    assert asked.cut and not unasked.cut
    assert asked.cut != StockViews(BLANK).remaining_stock(WORLD, far_part, leaning=True).cut
    forgotten = StockViews(BLANK)
    forgotten.cut(SETUP, leant(10.0), BALL)
    assert not forgotten.remaining_stock(WORLD, far_part, leaning=True).cut


def test_a_voxel_is_cut_where_all_of_it_is_in_the_flutes():
    voxels = StockVoxels.of(BLANK, far_part(), 1.0)
    voxels.cut(LeaningCut(leant(10.0), BALL, WORLD))
    rows = np.argwhere(voxels.wanted & ~voxels.uncut)
    signs = np.argwhere(np.ones((2, 2, 2), dtype=bool)) - 0.5
    corners = (voxels.low + (rows[:, None] + signs) * voxels.step).reshape(-1, 3)
    # Beside the way in, the flutes stand over the line y = 10, z = 0, leaning.
    along = corners[corners[:, 0] < 29.0] - [0.0, 10.0, 0.0]
    top = LEANING[2] * BALL.flute_length + LEANING[0] * BALL.radius
    assert len(rows) > 500 and (along[:, 2] <= top + 1e-9).all()
    assert (np.abs(along[:, 1]) <= BALL.radius + 1e-9).all()
    middle = np.array([[20.0, 10.0, 0.0]]) + LEANING * BALL.radius
    at = np.floor((middle[0] - voxels.low) / voxels.step + 0.5).astype(int)
    assert not voxels.uncut[tuple(at)]


def test_a_shank_goes_where_an_earlier_leaning_tool_has_cut():
    views = StockViews(BLANK)
    views.seen(SETUP)
    wide = replace(BALL, diameter=12.0, corner_radius=6.0, flute_length=30.0, neck_length=31.0)
    views.cut(SETUP, leant(12.0), wide, allowance=0.2)
    tip, axis = np.array([[20.0, 10.0, 3.0]]), LEANING[None]
    shank = ((5.0, 1.0, 20.0, 1.0),)
    for leaning in (True, False):
        stock = views.remaining_stock(WORLD, far_part, leaning=leaning)
        assert bool(stock.is_free(shank, tip, axis)[0]) is leaning


def test_a_tool_goes_out_at_feed_until_it_has_left_the_stock():
    around = clearance(standing_below(cleared(0.0, 10.0)))
    beside, below = around.retreats(
        np.array([[25.0, 10.0, 0.0], [8.0, 10.0, 1.0]]), np.array([LEANING, UPRIGHT])
    )
    assert beside == 0.0 and below >= 8.0


def test_a_grown_tool_is_nowhere_slimmer_than_below():
    wide = grown(BALL, 2.0)
    assert (wide.diameter, wide.corner_radius) == (10.0, 5.0)
    radii = [wide.radius, *(r for _, r0, _, r1 in wide.profile() for r in (r0, r1))]
    assert radii[0] == min(radii)


class NoAir:
    """No rapid between two passes is clear; the tool is fed out by 4 mm."""

    def retreats(self, tip, axis):
        return np.full(len(tip), 4.0)

    def is_free_between(self, start_tip, start_axis, tip, axis):
        return np.zeros(len(tip), dtype=bool)


def test_a_leaning_tool_is_fed_off_and_onto_its_passes_as_far_as_demanded():
    drive, setup, stock = driven(grid(lambda x, y: 0.0 * x, n=4))
    passes = [straight((5, 5, 0), (25, 5, 0), LEANING), straight((5, 20, 0), (25, 20, 0), LEANING)]
    path = linked(
        passes,
        drive,
        BALL,
        DATA,
        stock,
        setup,
        replace(MANNER, link_clearance=NoAir()),
    )
    rapid = np.flatnonzero(path.motion == Motion.RAPID)
    before = rapid[rapid > 0] - 1
    off = np.linalg.norm(path.position[before] - path.position[before - 1], axis=1)
    fed = (path.motion[before] == Motion.LINE) & (path.mark[before] == Mark.LEAD)
    assert fed.sum() == 2 and off[fed] == pytest.approx(4.0)
    onto = rapid[:-1][path.motion[rapid[:-1] + 1] == Motion.LINE] + 1
    assert np.linalg.norm(path.position[onto] - path.position[onto - 1], axis=1) == pytest.approx(
        4.0
    )


def test_a_straight_link_that_touches_something_is_lifted_over():
    passes = [
        straight((5, 5, 0), (25, 5, 0), LEANING),
        straight((25, 5.5, 0), (5, 5.5, 0), LEANING),
    ]
    drive, setup, stock = driven(grid(lambda x, y: 0.0 * x, n=4))
    for clear in (True, False):
        manner = replace(
            MANNER, query=lambda tip, axis, *, clear=clear, **_: np.full(len(tip), clear)
        )
        path = linked(passes, drive, BALL, DATA, stock, setup, manner)
        assert (Mark.LINK in path.mark) == clear


def test_an_upright_tool_under_something_that_hangs_over_rises_at_feed():
    drive, setup, stock = driven(roofed(), top=20.0)
    # The ball is 1 mm beside the roof: with what is left on it, it doesn't come by at rapid.
    path = linked(
        [straight((14, 5, 0), (14, 25, 0)), straight((25, 5, 0), (25, 25, 0))],
        drive, BALL, DATA, stock, setup, replace(MANNER, lead_radius=0.0),
    )  # fmt: skip
    cut = path.mark == Mark.CUT
    first = np.flatnonzero(cut & (path.position[:, 0] < 20.0))[-1]
    assert path.motion[first + 1] == Motion.LINE and path.position[first + 1, 2] >= 12.0
    last = np.flatnonzero(cut)[-1]
    assert path.motion[last + 1] == Motion.RAPID


def test_under_stock_on_a_roof_an_upright_neck_leaves_the_floor_to_a_leaning_tool():
    # Flutes of 8 mm under a roof 12 mm high at x = 10: the ball stands free from 13 on, its neck keeps off what is left on the roof's rim.
    radius = 0.5 * BALL.neck_diameter
    for left, past in ((0.0, 13.0), (2.0, 10.0 + radius + HOLDER_CLEARANCE + 2.0)):
        found, tags = without_met(roofed(), (1,), BALL, -50.0, 0.02, left)
        middle = found.points[found.triangles[found.of(tags)]].mean(axis=1)
        beside = (middle[:, 0] > 13.0) & (middle[:, 0] < 14.5)
        assert beside.any() == (left == 0.0)
        gone, given = remaining_upright(roofed(), (1,), BALL, -50.0, 0.02, left)
        handed = gone.points[gone.triangles[gone.of(given)]]
        assert past < handed[:, :, 0].max() < past + 6.0
        # Between what an upright tool cuts and what is handed on nothing stays.
        assert handed[:, :, 0].max() > middle[middle[:, 0] > 13.0, 0].min()
