"""Passes are linked low: a rapid stays down where nothing stands, and only what has to be fed is fed."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from milling import SETUP, Milled, box_blank, closed_pocket, cutting, mill, rounded
from trunnion.geometry.plane.region import Region
from trunnion.model.motion.toolpath import Mark, Motion, Toolpath
from trunnion.model.tool import Tool
from trunnion.plan.prismatic.drive import DriveLevel, PlaneDrive, WallGuide
from trunnion.progress import NO_PROGRESS
from trunnion.toolpath.axis_region import AxisRegion
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.link import descent, is_off, travel
from trunnion.toolpath.offsetting.lead import from_free, lead_in
from trunnion.toolpath.plane.corner import CornerSettings, corner
from trunnion.toolpath.plane.face import FaceSettings, face
from trunnion.toolpath.plane.profile import ProfileRoughSettings, profile_rough
from trunnion.toolpath.plane.rough import RoughSettings, rough
from trunnion.toolpath.stock.heightfield import PlanningStock

BLANK = box_blank((-15, -15, -40), (75, 55, 0))
PLAN = rounded(0, 0, 60, 40, 5)
DEPTH, SAFETY = 30.0, 2.0
POCKET = closed_pocket(PLAN, DEPTH)
ISLAND = rounded(27, 17.5, 33, 22.5, 2)
AROUND = Region.rectangle(-200, -200, 300, 300)


def allowed(drive: PlaneDrive, allowance: float = 0.3) -> PlaneDrive:
    return replace(drive, wall_allowance=allowance, floor_allowance=allowance)


@cache
def opened(island: bool = False) -> tuple[Toolpath, PlanningStock]:
    """A roughed pocket, with the corners that a cutter of 16 mm leaves."""
    plan, stock = PLAN.minus(ISLAND) if island else PLAN, PlanningStock.of(BLANK, SETUP)
    drive = allowed(closed_pocket(plan, DEPTH))
    tool = mill(16, flute_length=35.0)
    path = rough(drive, tool, cutting(8, 4), stock, SETUP, RoughSettings(), NO_PROGRESS).path
    return path, stock.after(path, tool)


def cutter(diameter: float = 8.0) -> Tool:
    return mill(diameter, flute_length=35.0)


def in_pocket(tool: Tool) -> PathBuilder:
    return PathBuilder(tool, cutting(4, 2), opened()[1], SETUP, SAFETY)


def rest_roughing(
    tool: Tool, depth: float = 4.0, width: float = 2.0, island: bool = False
) -> Toolpath:
    plan = PLAN.minus(ISLAND) if island else PLAN
    drive = replace(
        allowed(closed_pocket(plan, DEPTH)),
        kind="corner",
        earlier_radius=8.0,
        earlier_allowance=0.3,
    )
    data, stock = cutting(depth, width), opened(island)[1]
    return corner(drive, tool, data, stock, SETUP, CornerSettings(), NO_PROGRESS).path


def crashes(path: Toolpath, tool: Tool, island: bool = False) -> list[tuple[int, float]]:
    milled = Milled((-15, -15), (75, 55), 0.0).cut(opened(island)[0], mill(16, flute_length=35.0))
    milled.crashes.clear()
    return milled.cut(path, tool).crashes


def test_a_rapid_goes_down_to_the_cut_where_what_stands_is_deeper_by_the_safety_distance() -> None:
    builder = in_pocket(cutter())
    travel(builder, (30, 20), -DEPTH + 0.3 + SAFETY)
    assert builder.finished().motion.tolist() == [Motion.RAPID] * 3
    assert builder.finished().position[1, 2] == pytest.approx(-DEPTH + 0.3 + SAFETY)


def test_over_what_stands_the_rapid_ends_at_the_safety_distance() -> None:
    builder = in_pocket(cutter())
    travel(builder, (30, 20), -DEPTH + 0.5)
    path = builder.finished()
    assert path.position[1, 2] == pytest.approx(-DEPTH + 0.3 + SAFETY)
    assert (path.motion[2], path.mark[2]) == (Motion.LINE, Mark.LEAD)


def test_beside_the_blank_where_nothing_is_known_the_last_of_the_way_down_is_fed() -> None:
    builder = in_pocket(cutter())
    travel(builder, (-40, 20), -10.0)
    assert builder.finished().position[1, 2] == pytest.approx(-10.0 + SAFETY)


def test_a_near_position_is_fed_to_where_the_axis_may_go_instead_of_lifting() -> None:
    for region, lifts in ((AxisRegion(PLAN.offset(-4.0)), False), (None, True)):
        builder = in_pocket(cutter())
        travel(builder, (30, 20), -DEPTH + 0.3)
        before = len(builder)
        travel(builder, (33, 20), -DEPTH + 0.3, region)
        raised = builder.finished().position[before:-1, 2].max() > -DEPTH + 1.0
        assert raised == lifts


def test_a_near_position_that_is_higher_is_reached_by_a_lift_and_no_feed_upwards() -> None:
    builder = in_pocket(cutter())
    travel(builder, (30, 20), -DEPTH + 0.3)
    before = len(builder)
    travel(builder, (33, 20), -10.0, AxisRegion(PLAN.offset(-4.0)))
    assert set(builder.finished().motion[before:]) == {Motion.RAPID}


def test_a_cutter_steps_off_a_wall_rather_than_being_lifted_over_it() -> None:
    tool = cutter()
    region = AxisRegion(PLAN.offset(-tool.radius))
    builder = in_pocket(tool)
    travel(builder, (30, 20), -10.0)
    builder.line((30, 4.1, -10.0), 1000.0)
    builder.line((30, 4.3, -10.0), 1000.0)
    assert not is_off(builder, builder.here, -10.0)
    before = len(builder)
    travel(builder, (50, 20), -10.0, region)
    path = builder.finished()
    assert path.position[before:-1, 2].max() == pytest.approx(-10.0)
    assert (path.motion[before], path.mark[before]) == (Motion.LINE, Mark.LEAD)
    assert crashes(path, tool) == []


def test_a_lead_is_lengthened_until_the_way_down_to_it_need_not_be_fed() -> None:
    tool = cutter()
    builder, region = in_pocket(tool), AxisRegion(PLAN.offset(-tool.radius))
    lead = lead_in(np.array([30.0, 4.0]), np.array([1.0, 0.0]), 0.5)
    found, free = from_free(builder, lead, np.array([1.0, 0.0]), -10.0, region)
    assert free and descent(builder, found.before, -10.0) == 0.0
    assert descent(builder, lead.before, -10.0) > 10.0
    assert 0.0 < float(np.linalg.norm(found.before - found.outside)) <= 0.5 * tool.radius


@pytest.mark.parametrize("island", [False, True])
def test_the_layers_of_a_corner_are_linked_below_the_top_and_through_no_material(island) -> None:
    tool = cutter()
    path = rest_roughing(tool, island=island)
    corner_of = (path.position[:, :2] > [30.0, 20.0]) @ [1, 2]
    same = (corner_of[1:] == corner_of[:-1]) & (np.arange(1, len(path)) < len(path) - 1)
    first = np.flatnonzero(path.motion != Motion.RAPID)[0]
    assert path.position[first:-1][same[first:]][:, 2].max() < 0.0
    assert crashes(path, tool, island) == []


def test_little_of_the_way_of_rest_roughing_is_fed_straight_down() -> None:
    path = rest_roughing(cutter())
    way = path.position - path.starts()
    down = (path.motion == Motion.LINE) & (np.abs(way[:, :2]).max(axis=1) < 1e-9)
    # The lowest layer of each of the four corners alone ends on something.
    assert -way[down, 2].sum() <= 4 * SAFETY + 1e-6


def test_a_narrow_rest_is_taken_in_deeper_layers_up_to_the_same_cross_section() -> None:
    def layers(width: float) -> int:
        path = rest_roughing(cutter(), depth=3.0, width=width)
        return len(np.unique(path.position[path.mark == Mark.CUT, 2].round(6)))

    # A rest of about 9 mm2 is 1.1 mm wide over the diameter of 8 mm.
    assert layers(1.0) == 10
    assert layers(2.0) == 6


def test_what_finishing_takes_with_its_allowance_is_not_roughed() -> None:
    drive = replace(allowed(POCKET), kind="corner", earlier_radius=5.5, earlier_allowance=0.3)
    planned = corner(
        drive, cutter(), cutting(4, 2), opened()[1], SETUP, CornerSettings(), NO_PROGRESS
    )
    assert not len(planned.path)
    assert [f.code for f in planned.findings] == ["corner.little"]


def test_finishing_a_roughed_corner_goes_along_the_walls_alone() -> None:
    tool = cutter()
    first = rest_roughing(tool)
    drive = replace(POCKET, kind="corner_finish", earlier_radius=8.0)
    path = corner(
        drive,
        tool,
        cutting(15, 0.3),
        opened()[1].after(first, tool),
        SETUP,
        CornerSettings(),
        NO_PROGRESS,
    ).path
    # On the floor, which is not finished here, the inner passes have their allowance to take.
    cuts = path.position[(path.mark == Mark.CUT) & (path.position[:, 2] > -DEPTH + 1.0), :2]
    assert len(cuts) and np.abs(PLAN.signed_distance(cuts) - tool.radius).max() < 1e-6


OUTLINE = rounded(0, 0, 100, 60, 15)


def profile_roughed(tool: Tool, width: float) -> Toolpath:
    """The blank stands 13.3 mm out of the outline's rounded corners, 5 mm out of its sides."""
    level = DriveLevel(
        top=0.0,
        bottom=-20.0,
        wanted=Region.rectangle(-5, -5, 105, 65).minus(OUTLINE),
        boundary=AROUND.minus(OUTLINE),
    )
    guide = WallGuide(
        curve=OUTLINE.curves()[0].reversed(), top=0.0, bottom=-20.0, fillet=0.0, faces=(7,)
    )
    drive = PlaneDrive(
        feature="profile-01",
        kind="profile_rough",
        levels=(level,),
        walls=(guide,),
        wall_allowance=0.3,
    )
    stock = PlanningStock.of(box_blank((-5, -5, -20), (105, 65, 0)), SETUP)
    data = cutting(20, width)
    path = profile_rough(drive, tool, data, stock, SETUP, ProfileRoughSettings(), NO_PROGRESS).path
    milled = Milled((-5, -5), (105, 65), 0.0).cut(path, tool)
    outside = OUTLINE.signed_distance(milled.points).reshape(milled.x.shape)
    assert (milled.height[outside < -0.31] == -20.0).all()
    assert milled.crashes == []
    return path


def farthest_ring(path: Toolpath, tool: Tool) -> float:
    cuts = path.position[path.mark == Mark.CUT, :2]
    return float(-OUTLINE.signed_distance(cuts).min()) - tool.radius


def test_rings_around_the_profile_go_only_where_the_margin_stands() -> None:
    tool = mill(16, flute_length=30.0)
    path = profile_roughed(tool, 5.0)
    assert farthest_ring(path, tool) == pytest.approx(10.3, abs=0.01)
    # The two outer rings are four short arcs each.
    way = path.lengths()[path.mark == Mark.CUT].sum()
    around = sum(c.length for c in OUTLINE.offset(tool.radius + 0.3).curves())
    assert way < 1.75 * around


def test_a_ring_that_would_cut_hardly_anything_is_left_to_the_next_one() -> None:
    tool = mill(16, flute_length=30.0)
    assert farthest_ring(profile_roughed(tool, 6.0), tool) == pytest.approx(6.3, abs=0.01)


def test_arcs_of_all_rings_at_a_corner_are_cut_before_the_next_corners() -> None:
    tool = mill(16, flute_length=30.0)
    path = profile_roughed(tool, 5.0)
    cuts = path.mark == Mark.CUT
    begins = np.flatnonzero(cuts & ~np.roll(cuts, 1))
    ends = np.flatnonzero(cuts & ~np.roll(cuts, -1))
    middle = np.array([path.position[a : b + 1, :2].mean(axis=0) for a, b in zip(begins, ends)])
    length = np.array([path.lengths()[a : b + 1].sum() for a, b in zip(begins, ends)])
    arcs = length < 60.0
    assert arcs.sum() == 8 and not arcs[-1]
    corner = (middle[arcs] > [50.0, 30.0]) @ [1, 2]
    assert (corner[::2] == corner[1::2]).all() and len(set(corner)) == 4
    # The outer one, the shorter, comes first.
    assert (length[arcs][::2] < length[arcs][1::2]).all()


def test_facing_goes_to_the_next_row_at_rapid() -> None:
    level = DriveLevel(top=2.0, bottom=0.0, wanted=Region.rectangle(0, 0, 80, 50), boundary=AROUND)
    drive = PlaneDrive(feature="blank", kind="face", levels=(level,), stock_top=2.0)
    stock = PlanningStock.of(box_blank((0, 0, -20), (80, 50, 2)), SETUP)
    path = face(drive, mill(20), cutting(2.0, 14.0), stock, SETUP, FaceSettings(), NO_PROGRESS).path
    way = np.abs(path.position - path.starts())[1:-1]
    across = way[:, 1] > 1e-9
    assert across.any() and (path.motion[1:-1][across] == Motion.RAPID).all()
    assert (way[across, 2] == 0.0).all()
