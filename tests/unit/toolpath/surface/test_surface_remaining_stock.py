"""Tools among stock that stands: what is known of it, which poses keep out of it, and links under what hangs over."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from surface_drives import DATA, driven, grid, joined
from trunnion.geometry.frame import WORLD
from trunnion.geometry.kernels.bodies import (
    bodies_hold_reference,
    lattice_held,
    lattice_held_reference,
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
from trunnion.toolpath.stock.remaining import RemainingStock
from trunnion.toolpath.stock.views import StockViews
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
    whole = RemainingStock.of(BLANK, WORLD, [(PlanningStock.of(BLANK, SETUP), WORLD)])
    assert len(whole.points) * whole.cell**3 == pytest.approx(6000.0, rel=0.01)
    cut = RemainingStock.of(BLANK, WORLD, [(cleared(4.0, 20.0), WORLD)])
    gone = (cut.points[:, 0] > 20.5) & (cut.points[:, 2] > 4.5)
    assert not gone.any() and len(cut.points) < len(whole.points)


def test_a_body_is_clear_where_nothing_stands_and_only_there():
    stock = RemainingStock.of(BLANK, WORLD, [(cleared(0.0, 10.0), WORLD)])
    tips = np.array([[20.0, 10.0, 2.0], [12.0, 10.0, 2.0], [5.0, 10.0, 2.0]])
    shank = ((0.0, 2.0, 20.0, 2.0),)
    assert stock.is_free(shank, tips, np.tile(UPRIGHT, (3, 1))).tolist() == [True, False, False]
    # The same tip with its axis leaning towards what stands is in it.
    away, towards = LEANING, LEANING * [-1.0, 1.0, 1.0]
    tip = np.array([[16.0, 10.0, 2.0]] * 2)
    assert stock.is_free(shank, tip, np.array([away, towards])).tolist() == [True, False]


def test_near_the_part_stock_is_not_counted_nor_is_the_part_itself():
    stock = RemainingStock.of(BLANK, WORLD, [(PlanningStock.of(BLANK, SETUP), WORLD)])
    floor = grid(lambda x, y: 4.0 + 0.0 * x, n=30)
    left = stock.beyond(2.0, floor.points, floor.normals)
    assert left.points[:, 2].min() > 6.0 and left.points[:, 2].max() > 9.0


def clearance(remaining_stock, skin=None):
    """Return the queries of a ball on a drive where nothing of the part is ever met."""
    drive, *_ = driven(skin or grid(lambda x, y: 0.0 * x, n=30))
    drive = replace(
        drive,
        remaining_stock=remaining_stock,
        query_for=lambda tool: lambda tip, axis, **_: np.ones(len(tip), bool),
    )
    return StockClearance.of(drive, BALL, 2.0)


def test_a_leaning_tool_keeps_its_shank_out_of_stock_that_stands():
    around = clearance(RemainingStock.of(BLANK, WORLD, [(cleared(0.0, 10.0), WORLD)]))
    query = around.with_stock(lambda tip, axis, **_: np.ones(len(tip), bool))
    tip, axes = np.array([[16.0, 10.0, 0.0]] * 2), np.array([LEANING, LEANING * [-1.0, 1.0, 1.0]])
    assert query(tip, axes).tolist() == [True, False]


def test_poses_are_asked_for_from_the_safest_to_those_clear_of_the_part_alone():
    whole = RemainingStock.of(BLANK, WORLD, [(cleared(0.0, 10.0), WORLD)])
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


def test_the_kernel_that_takes_bodies_off_a_lattice_and_the_plain_one_agree():
    pick = np.random.default_rng(7)
    tips, axes = pick.uniform(-2.0, 12.0, (12, 3)), pick.normal(size=(12, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    rows = np.array([[0.0, 0.2, 1.0, 1.5], [1.0, 1.5, 5.0, 1.5]])
    low, step = np.array([0.3, -0.2, 0.1]), np.array([1.0, 0.9, 1.1])
    found, plain = (np.ones((10, 11, 9), bool) for _ in range(2))
    lattice_held(found, low, step, tips, axes, rows)
    lattice_held_reference(plain, low, step, tips, axes, rows)
    assert (found == plain).all() and 0 < (~found).sum() < 990


def test_what_a_leaning_tool_has_cut_stands_no_more_where_that_is_asked_for():
    views = StockViews(BLANK)
    views.seen(SETUP)
    assert not views.cut(SETUP, leant(10.0), BALL, remember=True)
    asked, unasked = (views.remaining_stock(WORLD, leaning=v) for v in (True, False))
    gone = {tuple(p) for p in unasked.points.round(6).tolist()} - {
        tuple(p) for p in asked.points.round(6).tolist()
    }
    assert len(asked.points) + len(gone) == len(unasked.points)
    # All of it lies in the flutes of 8 mm over the way of the ball, and nearly all of that is in the blank.
    at = np.array(sorted(gone))
    off = at - [0.0, 10.0, 0.0]
    assert np.abs(off[:, 1]).max() < BALL.radius and (at[:, 2] < 8.0).all()
    across = np.abs(off @ [0.0, 1.0, 0.0]) < 2.0
    assert across.any() and asked.cut and not unasked.cut
    assert asked.cut != StockViews(BLANK).remaining_stock(WORLD, leaning=True).cut
    forgotten = StockViews(BLANK)
    forgotten.cut(SETUP, leant(10.0), BALL)
    assert not forgotten.remaining_stock(WORLD, leaning=True).cut


def test_a_shank_goes_where_an_earlier_leaning_tool_has_cut():
    views = StockViews(BLANK)
    views.seen(SETUP)
    wide = replace(BALL, diameter=12.0, corner_radius=6.0, flute_length=30.0, neck_length=31.0)
    views.cut(SETUP, leant(12.0), wide, remember=True)
    tip, axis = np.array([[20.0, 10.0, 3.0]]), LEANING[None]
    shank = ((5.0, 1.0, 20.0, 1.0),)
    for leaning in (True, False):
        stock = views.remaining_stock(WORLD, leaning=leaning)
        assert bool(stock.is_free(shank, tip, axis)[0]) is leaning


def test_a_tool_goes_out_at_feed_until_it_has_left_the_stock():
    around = clearance(RemainingStock.of(BLANK, WORLD, [(cleared(0.0, 10.0), WORLD)]))
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
