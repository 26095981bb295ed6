"""Floors, walls and corners together finish a pocket: nothing is gouged and nothing stays, fillets and corners included."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from milling import SETUP, Milled, box_blank, closed_pocket, cutting, mill, rounded
from trunnion.findings import Severity
from trunnion.geometry.plane.region import Region
from trunnion.model.motion.toolpath import Mark, Motion, Toolpath
from trunnion.model.tool import Tool
from trunnion.plan.prismatic.drive import DriveLevel, PlaneDrive, WallGuide
from trunnion.progress import NO_PROGRESS
from trunnion.toolpath.axis_region import AxisRegions
from trunnion.toolpath.plane.corner import CornerSettings, corner
from trunnion.toolpath.plane.floor import FloorSettings, floor
from trunnion.toolpath.plane.rough import RoughSettings, rough
from trunnion.toolpath.plane.wall import WallSettings, wall
from trunnion.toolpath.stock.heightfield import PlanningStock

BLANK = box_blank((-15, -15, -40), (75, 55, 0))
PLAN = rounded(0, 0, 60, 40, 10)
DEPTH = 15.0


class Shop:
    """Cuts operations one after the other on the same stock, and keeps the brute-force columns beside the planner's own."""

    def __init__(self) -> None:
        self.stock = PlanningStock.of(BLANK, SETUP)
        self.milled = Milled((-15, -15), (75, 55), 0.0)
        self.paths: list[Toolpath] = []

    def run(
        self,
        strategy: object,
        drive: PlaneDrive,
        tool: Tool,
        settings: object,
        depth: float = 6.0,
        width: float = 5.0,
    ) -> Toolpath:
        planned = strategy(
            drive, tool, cutting(depth, width), self.stock, SETUP, settings, NO_PROGRESS
        )  # type: ignore[operator]
        self.stock = self.stock.after(planned.path, tool)
        self.milled.cut(planned.path, tool)
        self.paths.append(planned.path)
        return planned.path


def roughed(plan: Region, fillet: float, tool: Tool) -> Shop:
    shop = Shop()
    shop.run(
        rough,
        closed_pocket(plan, DEPTH, fillet, wall_allowance=0.3, floor_allowance=0.3),
        tool,
        RoughSettings(),
    )
    return shop


@cache
def finished(
    fillet: float, rough_corner: float, finish_corner: float, scallop: float = 0.01
) -> Shop:
    shop = roughed(PLAN, fillet, mill(16, rough_corner))
    drive = closed_pocket(PLAN, DEPTH, fillet)
    shop.run(floor, drive, mill(16, finish_corner), FloorSettings())
    shop.run(wall, drive, mill(16, finish_corner), WallSettings(scallop=scallop), depth=12.0)
    return shop


@pytest.mark.parametrize(
    ("fillet", "corner_radius"), [(0.0, 0.0), (3.0, 3.0), (3.0, 1.5), (2.0, 3.0)]
)
def test_floor_and_wall_gouge_nothing(fillet: float, corner_radius: float) -> None:
    shop = finished(fillet, max(fillet, corner_radius), corner_radius)
    assert shop.milled.depth_below(shop.milled.pocket_target(PLAN, DEPTH, fillet), PLAN) < 5e-3


@pytest.mark.parametrize(("fillet", "corner_radius"), [(0.0, 0.0), (3.0, 3.0), (3.0, 1.5)])
def test_floor_and_wall_leave_nothing_the_strip_along_the_wall_included(
    fillet: float, corner_radius: float
) -> None:
    shop = finished(fillet, fillet, corner_radius)
    # The cusps of a fillet cut in steps are 0.01 mm high, but measured up along the columns twice as much where it is steep.
    assert (
        shop.milled.area_above(
            shop.milled.pocket_target(PLAN, DEPTH, fillet),
            PLAN,
            0.02 if corner_radius == fillet else 0.04,
        )
        == 0.0
    )


def test_no_rapid_of_the_whole_sequence_goes_through_material() -> None:
    assert finished(3.0, 3.0, 3.0).milled.crashes == []


def test_the_floor_passes_keep_off_the_walls() -> None:
    path = finished(3.0, 3.0, 3.0).paths[1]
    on_floor = path.position[path.position[:, 2] == -DEPTH, :2]
    assert PLAN.signed_distance(on_floor).min() >= 8.0 + 0.4 - 1e-6


def test_wall_passes_touch_the_wall_exactly() -> None:
    path = finished(3.0, 3.0, 3.0).paths[2]
    on_wall = path.position[(path.mark == Mark.CUT), :2]
    assert PLAN.signed_distance(on_wall) == pytest.approx(8.0, abs=1e-5)


def test_wall_passes_run_anticlockwise_inside_a_pocket() -> None:
    path = finished(3.0, 3.0, 3.0).paths[2]
    arcs = path.motion[(path.mark == Mark.CUT) & (path.motion >= Motion.ARC_CW)]
    assert len(arcs) and (arcs == Motion.ARC_CCW).all()


def test_every_lead_is_tangential_to_the_pass_it_leads_to() -> None:
    path = finished(3.0, 3.0, 3.0).paths[2]
    onto = np.flatnonzero(
        (path.mark[:-1] == Mark.LEAD)
        & (path.motion[:-1] >= Motion.ARC_CW)
        & (path.mark[1:] == Mark.CUT)
    )
    assert len(onto) == 2
    for n in onto:
        ray = path.position[n, :2] - path.centre[n, :2]
        way = path.position[n + 1, :2] - path.position[n, :2]
        assert abs(ray @ way) < 1e-6 * np.linalg.norm(way) * 100


def test_a_closed_wall_is_cut_past_its_start() -> None:
    path = finished(3.0, 3.0, 3.0).paths[2]
    around = PLAN.offset(-8.0).curves()[0].length
    cut = path.lengths()[(path.mark == Mark.CUT) & (path.position[:, 2] == -DEPTH)].sum()
    assert cut == pytest.approx(around + WallSettings().overlap)


def test_a_spring_pass_goes_round_once_more() -> None:
    shop = roughed(PLAN, 3.0, mill(16, 3.0))
    chosen = WallSettings(spring=True, overlap=0.0, floor_rest=False)
    path = shop.run(wall, closed_pocket(PLAN, DEPTH, 3.0), mill(16, 3.0), chosen, depth=15.0)
    assert path.lengths()[path.mark == Mark.CUT].sum() == pytest.approx(
        2 * PLAN.offset(-8.0).curves()[0].length
    )


def test_corners_sharper_than_the_cutter_are_named_and_a_smaller_one_finishes_them() -> None:
    plan, tool = rounded(0, 0, 60, 40, 5), mill(16, 3.0)
    shop = roughed(plan, 3.0, tool)
    drive = closed_pocket(plan, DEPTH, 3.0)
    shop.run(
        corner,
        replace(
            drive,
            kind="corner",
            wall_allowance=0.3,
            floor_allowance=0.3,
            earlier_radius=8.0,
            earlier_allowance=0.3,
        ),
        mill(8, 3.0),
        CornerSettings(),
        width=3.0,
    )
    shop.run(floor, drive, tool, FloorSettings())
    planned = wall(drive, tool, cutting(12, 1), shop.stock, SETUP, WallSettings(), NO_PROGRESS)
    assert [f.code for f in planned.findings] == ["wall.left"]
    shop.run(wall, drive, tool, WallSettings(), depth=12.0)
    shop.run(
        corner,
        replace(drive, kind="corner_finish", earlier_radius=8.0),
        mill(8, 3.0),
        CornerSettings(),
        width=2.0,
    )
    target = shop.milled.pocket_target(plan, DEPTH, 3.0)
    assert shop.milled.depth_below(target, plan) < 5e-3
    assert shop.milled.area_above(target, plan) == 0.0
    assert shop.milled.crashes == []


def test_corner_passes_stay_in_the_corners() -> None:
    plan = rounded(0, 0, 60, 40, 5)
    drive = closed_pocket(plan, DEPTH, 3.0, earlier_radius=8.0)
    path = corner(
        drive,
        mill(8, 3.0),
        cutting(6, 2),
        PlanningStock.of(BLANK, SETUP),
        SETUP,
        CornerSettings(),
        NO_PROGRESS,
    ).path
    feeds = path.position[path.mark == Mark.CUT, :2]
    corners = np.array([[0, 0], [60, 0], [60, 40], [0, 40]])
    assert np.linalg.norm(feeds[:, None] - corners, axis=2).min(axis=1).max() < 15.0


def test_a_corner_cutter_that_is_still_too_large_says_what_stays() -> None:
    drive = closed_pocket(rounded(0, 0, 60, 40, 2), DEPTH, earlier_radius=8.0)
    planned = corner(
        drive,
        mill(8),
        cutting(6, 2),
        PlanningStock.of(BLANK, SETUP),
        SETUP,
        CornerSettings(),
        NO_PROGRESS,
    )
    assert [f.code for f in planned.findings] == ["corner.left"]


def test_an_open_wall_is_cut_straight_past_its_ends() -> None:
    part = Region.rectangle(-10, -10, 70, 50)
    boundary = Region.rectangle(-200, -200, 300, 300).minus(
        part.minus(Region.rectangle(-100, 20, 200, 200))
    )
    guide = Region.rectangle(-10, -10, 70, 20).curves()[0].split(110, 190).reversed()
    level = DriveLevel(
        top=0.0, bottom=-10.0, wanted=Region.rectangle(-10, 20, 70, 50), boundary=boundary
    )
    walls = (WallGuide(curve=guide, top=0.0, bottom=-10.0, fillet=0.0, faces=(1,)),)
    drive = closed_pocket(level.wanted, 10.0, levels=(level,), walls=walls)
    path = wall(
        drive,
        mill(10),
        cutting(20, 1),
        PlanningStock.of(BLANK, SETUP),
        SETUP,
        WallSettings(floor_rest=False),
        NO_PROGRESS,
    ).path
    cut = path.position[path.mark == Mark.CUT]
    assert cut[:, 1] == pytest.approx(25.0, abs=1e-3)
    assert cut[:, 0].max() - cut[:, 0].min() > 80.0


def test_floor_between_walls_too_close_for_the_floor_cutter_is_finished_with_the_walls() -> None:
    plan = rounded(0, 0, 60, 40, 10).minus(Region.rectangle(22, 16, 38, 24).offset(2))
    shop, drive = roughed(plan, 0.0, mill(10)), closed_pocket(plan, DEPTH)
    shop.run(floor, drive, mill(16), FloorSettings(wall_distance=0.6))
    shop.run(wall, drive, mill(8), WallSettings(), depth=15.0)
    assert shop.milled.area_above(shop.milled.pocket_target(plan, DEPTH), plan) == 0.0
    assert shop.milled.crashes == []


def test_a_wall_where_the_cutter_has_no_room_is_an_error() -> None:
    drive = closed_pocket(rounded(0, 0, 60, 10, 4), DEPTH)
    planned = wall(
        drive,
        mill(16),
        cutting(12, 1),
        PlanningStock.of(BLANK, SETUP),
        SETUP,
        WallSettings(),
        NO_PROGRESS,
    )
    assert [f.code for f in planned.findings] == ["wall.too-narrow"]


def test_a_floor_where_the_cutter_has_no_room_is_left_with_a_warning() -> None:
    drive = closed_pocket(rounded(0, 0, 60, 10, 4), DEPTH)
    planned = floor(
        drive,
        mill(16),
        cutting(12, 1),
        PlanningStock.of(BLANK, SETUP),
        SETUP,
        FloorSettings(),
        NO_PROGRESS,
    )
    assert [(f.code, f.severity) for f in planned.findings] == [
        ("floor.too-wide", Severity.WARNING)
    ]


def test_a_sharp_foot_is_cut_without_touching_the_rounder_ones_beside_it() -> None:
    island = rounded(20, 14, 32, 26, 3)
    plan, fillet, cutter = rounded(0, 0, 60, 40, 8), 3.0, mill(8)
    pocket, around = plan.curves()[0], plan.minus(island).curves()[1]
    guides = [
        WallGuide(curve=pocket, top=0.0, bottom=-DEPTH, fillet=fillet, faces=(1,)),
        WallGuide(curve=around, top=-DEPTH + fillet, bottom=-DEPTH, fillet=0.0, faces=(2,)),
    ]
    assert guides[1].is_around and not guides[0].is_around
    drive = closed_pocket(
        plan.minus(island), DEPTH, floors=(), walls=(guides[1],), beside=(guides[0],)
    )
    path = wall(
        drive,
        cutter,
        cutting(3, 3),
        PlanningStock.of(BLANK, SETUP),
        SETUP,
        WallSettings(),
        NO_PROGRESS,
    ).path
    deep = path.position[np.abs(path.position[:, 2] + DEPTH) < 1e-9]
    assert len(deep)
    assert pocket.distance(deep[:, :2]).min() >= cutter.radius + fillet - 1e-6
    assert around.distance(deep[:, :2]).min() == pytest.approx(cutter.radius, abs=1e-3)


def test_axis_regions_of_areas_that_are_made_and_gone_are_not_mixed_up() -> None:
    """At each height a wall's pass has an area of its own, made for it alone, and often the same distance."""
    known = AxisRegions()
    for k in range(100):
        found = known.of(Region.rectangle(0.0, 0.0, 10.0 + k, 10.0), 1.0)
        assert found.region.area == pytest.approx(8.0 * (8.0 + k))
    boundary = Region.rectangle(0.0, 0.0, 10.0, 10.0)
    assert known.of(boundary, 1.0) is known.of(boundary, 1.0) is not known.of(boundary, 2.0)
