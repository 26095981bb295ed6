"""Faces, tops and the outer profile: cut from outside, to their exact heights, without touching what stays."""

from __future__ import annotations

import numpy as np
import pytest

from milling import SETUP, Milled, box_blank, closed_pocket, cutting, mill, rounded
from trunnion.geometry.plane.region import Region
from trunnion.model.motion.toolpath import Mark, Motion
from trunnion.plan.prismatic.drive import DriveLevel, PlaneDrive, WallGuide
from trunnion.progress import NO_PROGRESS
from trunnion.toolpath.plane.face import FaceSettings, face
from trunnion.toolpath.plane.profile import (
    ProfileFinishSettings,
    ProfileRoughSettings,
    profile_finish,
    profile_rough,
)
from trunnion.toolpath.plane.rib import RibTopSettings, rib_top
from trunnion.toolpath.plane.rough import RoughSettings, rough
from trunnion.toolpath.stock.heightfield import PlanningStock

STOCK = PlanningStock.of(box_blank((-5, -5, -20), (85, 55, 2)), SETUP)
AROUND = Region.rectangle(-200, -200, 300, 300)
OUTLINE = rounded(0, 0, 80, 50, 10)


def columns() -> Milled:
    return Milled((-5, -5), (85, 55), 2.0)


def facing(
    width: float, low: tuple[float, float] = (-5, -5), high: tuple[float, float] = (85, 55)
) -> PlaneDrive:
    level = DriveLevel(top=2.0, bottom=0.0, wanted=Region.rectangle(*low, *high), boundary=AROUND)
    return PlaneDrive(feature="blank", kind="face", levels=(level,), stock_top=2.0)


@pytest.mark.parametrize("width", [10.0, 24.0, 39.0])
@pytest.mark.parametrize("pattern", ["zigzag", "climb"])
def test_facing_leaves_the_whole_top_at_its_height(width: float, pattern: str) -> None:
    planned = face(
        facing(width),
        mill(40),
        cutting(1.0, width),
        STOCK,
        SETUP,
        FaceSettings(pattern=pattern),
        NO_PROGRESS,
    )
    milled = columns().cut(planned.path, mill(40))
    assert (milled.height == 0.0).all()
    assert milled.crashes == []


def test_a_tall_blank_is_faced_along_its_longer_side() -> None:
    drive = facing(10, (0, 0), (20, 80))
    path = face(drive, mill(20), cutting(2.0, 8.0), STOCK, SETUP, FaceSettings(), NO_PROGRESS).path
    rows = np.abs(path.position - path.starts())[
        (path.motion == Motion.LINE) & (path.mark == Mark.CUT)
    ]
    assert rows[:, 1].min() > 80.0 and rows[:, 0].max() == 0.0


def test_facing_turns_outside_the_blank() -> None:
    path = face(
        facing(10), mill(40), cutting(2.0, 24.0), STOCK, SETUP, FaceSettings(), NO_PROGRESS
    ).path
    across = np.abs(path.position - path.starts())[:, 1] > 0.0
    turns = path.position[across, 0]
    assert len(turns) and ((turns < -5 - 20) | (turns > 85 + 20)).all()


def profile(allowance: float = 0.0) -> PlaneDrive:
    level = DriveLevel(
        top=0.0,
        bottom=-20.0,
        wanted=Region.rectangle(-5, -5, 85, 55).minus(OUTLINE),
        boundary=AROUND.minus(OUTLINE),
    )
    walls = (
        WallGuide(
            curve=OUTLINE.curves()[0].reversed(), top=0.0, bottom=-20.0, fillet=0.0, faces=(7,)
        ),
    )
    return PlaneDrive(
        feature="profile-01",
        kind="profile_rough",
        levels=(level,),
        walls=walls,
        stock_top=2.0,
        wall_allowance=allowance,
    )


def test_the_profile_is_roughed_to_its_allowance_and_finished_exactly() -> None:
    stock, tool, milled = STOCK, mill(12), columns()
    first = profile_rough(
        profile(0.3), tool, cutting(6, 4), stock, SETUP, ProfileRoughSettings(), NO_PROGRESS
    )
    milled.cut(first.path, tool)
    outside = OUTLINE.signed_distance(milled.points).reshape(milled.x.shape)
    assert (milled.height[outside > -0.29] == 2.0).all()
    assert (milled.height[outside < -0.31] == -20.0).all()
    last = profile_finish(
        profile(),
        tool,
        cutting(10, 4),
        stock.after(first.path, tool),
        SETUP,
        ProfileFinishSettings(),
        NO_PROGRESS,
    )
    milled.cut(last.path, tool)
    assert (milled.height[outside > 0.01] == 2.0).all()
    assert (milled.height[outside < -0.01] == -20.0).all()
    assert milled.crashes == []
    assert first.findings == last.findings == ()


@pytest.mark.parametrize(("flute", "passes"), [(20.5, 2), (30.0, 1)])
def test_the_flutes_not_the_shank_meet_what_roughing_left_over_a_wall(flute, passes) -> None:
    roughed = STOCK.after(
        profile_rough(
            profile(0.3), mill(12), cutting(6, 4), STOCK, SETUP, ProfileRoughSettings(), NO_PROGRESS
        ).path,
        mill(12),
    )
    # The wall is 20 mm tall, its allowance stands 2 mm higher.
    path = profile_finish(
        profile(), mill(12, flute_length=flute), cutting(20, 4), roughed, SETUP,
        ProfileFinishSettings(), NO_PROGRESS,
    ).path  # fmt: skip
    assert len(np.unique(path.position[path.mark == Mark.CUT, 2].round(3))) == passes


def test_the_profile_is_cut_clockwise_so_that_it_climbs() -> None:
    path = profile_finish(
        profile(), mill(12), cutting(20, 4), STOCK, SETUP, ProfileFinishSettings(), NO_PROGRESS
    ).path
    arcs = path.motion[(path.mark == Mark.CUT) & (path.motion >= Motion.ARC_CW)]
    assert len(arcs) and (arcs == Motion.ARC_CW).all()


def test_the_profile_is_approached_from_outside_the_blank() -> None:
    path = profile_finish(
        profile(), mill(12), cutting(20, 4), STOCK, SETUP, ProfileFinishSettings(), NO_PROGRESS
    ).path
    down = np.flatnonzero(path.position[1:, 2] < path.position[:-1, 2] - 5.0) + 1
    x, y = path.position[down, :2].T
    assert ((x < -5 - 5.9) | (x > 85 + 5.9) | (y < -5 - 5.9) | (y > 55 + 5.9)).all()


def test_a_bull_cutter_that_can_not_finish_the_bottom_edge_is_warned_about() -> None:
    planned = profile_finish(
        profile(), mill(12, 2.0), cutting(20, 4), STOCK, SETUP, ProfileFinishSettings(), NO_PROGRESS
    )
    assert [f.code for f in planned.findings] == ["profile.corner"]


def rib(between: Region, top: Region) -> PlaneDrive:
    level = DriveLevel(top=0.0, bottom=-6.0, wanted=top, boundary=between)
    return PlaneDrive(feature="rib-01", kind="rib_top", levels=(level,), stock_top=0.0)


@pytest.mark.parametrize("thickness", [1.5, 4.0, 11.0])
def test_a_rib_between_two_walls_is_cut_to_its_height_with_its_flares(thickness: float) -> None:
    between = rounded(0, 0, 80, 50, 6)
    left, right = (
        rounded(0, 0, 40 - thickness / 2, 50, 6),
        rounded(40 + thickness / 2, 0, 80, 50, 6),
    )
    top = between.minus(left).minus(right).intersect(Region.rectangle(20, 0, 60, 50))
    milled = Milled((0, 0), (80, 50), 0.0)
    planned = rib_top(
        rib(between, top), mill(12), cutting(3, 5), STOCK, SETUP, RibTopSettings(), NO_PROGRESS
    )
    milled.cut(planned.path, mill(12))
    inside = top.signed_distance(milled.points).reshape(milled.x.shape) > 0.0
    assert (milled.height[inside] == -6.0).all()
    assert planned.findings == ()


def test_a_rib_keeps_clear_of_the_walls_at_its_ends() -> None:
    between = rounded(0, 0, 80, 50, 6)
    planned = rib_top(
        rib(between, Region.rectangle(38, 0, 42, 50)),
        mill(12),
        cutting(3, 5),
        STOCK,
        SETUP,
        RibTopSettings(),
        NO_PROGRESS,
    )
    down = planned.path.position[planned.path.position[:, 2] < -0.5, :2]
    assert between.signed_distance(down).min() >= 6.0 - 1e-6


def test_a_rib_is_entered_from_the_pockets_beside_it_and_not_by_a_helix() -> None:
    between, top = rounded(0, 0, 80, 50, 6), Region.rectangle(38, 0, 42, 50)
    cleared = STOCK
    for low, high in ((0, 38), (42, 80)):
        pocket = closed_pocket(rounded(low, 0, high, 50, 6), 12.0)
        roughed = rough(
            pocket, mill(8), cutting(12, 4), cleared, SETUP, RoughSettings(), NO_PROGRESS
        )
        cleared = cleared.after(roughed.path, mill(8))
    path = rib_top(
        rib(between, top), mill(12), cutting(6, 5), cleared, SETUP, RibTopSettings(), NO_PROGRESS
    ).path
    milled = Milled((0, 0), (80, 50), 0.0).cut(path, mill(12))
    inside = top.signed_distance(milled.points).reshape(milled.x.shape) > 0.0
    assert (milled.height[inside] == -6.0).all()
    entries = path.mark == Mark.ENTRY
    assert (path.motion[entries] == Motion.LINE).all()
    assert (path.position[entries, 2] == -6.0).all()
    assert path.feed[entries].max() <= 5.0 / 12.0 * cutting(6, 5).feed
    # It is no wider than the cutter: one way along it is enough, and back would be through air.
    assert path.lengths()[path.mark == Mark.CUT].sum() < 50.0


def test_a_rib_where_the_cutter_has_no_room_is_an_error() -> None:
    planned = rib_top(
        rib(Region.rectangle(35, 0, 45, 50), Region.rectangle(38, 0, 42, 50)),
        mill(12),
        cutting(3, 5),
        STOCK,
        SETUP,
        RibTopSettings(),
        NO_PROGRESS,
    )
    assert [f.code for f in planned.findings] == ["rib.too-narrow"]


def test_an_islands_top_is_cut_inside_its_pocket() -> None:
    pocket, island = rounded(0, 0, 80, 50, 8), Region.circle((40, 25), 8)
    drive = closed_pocket(
        pocket,
        6.0,
        kind="island_top",
        levels=(DriveLevel(top=0.0, bottom=-6.0, wanted=island, boundary=pocket),),
    )
    milled = Milled((0, 0), (80, 50), 0.0)
    milled.cut(
        rib_top(drive, mill(12), cutting(3, 5), STOCK, SETUP, RibTopSettings(), NO_PROGRESS).path,
        mill(12),
    )
    assert (
        milled.height[island.signed_distance(milled.points).reshape(milled.x.shape) > 0.0] == -6.0
    ).all()
