"""Roughing clears a pocket to its allowances, touches no wall, and never crosses material at rapid."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from milling import SETUP, Milled, box_blank, closed_pocket, cutting, mill, rounded
from trunnion.findings import Cancelled, Severity
from trunnion.geometry.plane.region import Region
from trunnion.model.motion.toolpath import Mark, Motion, Toolpath
from trunnion.plan.cutting.engaged import BY_TIME, CONSTANT_ENGAGEMENT, CONTOUR_PARALLEL
from trunnion.plan.prismatic.drive import DriveLevel, Floor, PlaneDrive
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.toolpath.contract import Planned
from trunnion.toolpath.plane.rough import RoughSettings, rough
from trunnion.toolpath.stock.heightfield import PlanningStock

BLANK = box_blank((-20, -20, -40), (100, 70, 0))
PLAN = rounded(0, 0, 80, 50, 10)


PATTERNS = pytest.mark.parametrize(
    "pattern", [CONTOUR_PARALLEL, CONSTANT_ENGAGEMENT, BY_TIME], ids=str
)


def cut(
    drive: PlaneDrive,
    tool: object,
    depth: float = 6.0,
    width: float = 6.0,
    pattern: str = CONTOUR_PARALLEL,
) -> tuple[Planned, Milled]:
    planned = rough(
        drive,
        tool,
        cutting(depth, width),
        PlanningStock.of(BLANK, SETUP),
        SETUP,
        RoughSettings(pattern=pattern),
        NO_PROGRESS,
    )
    return planned, Milled((-20, -20), (100, 70), 0.0).cut(planned.path, tool)


def with_allowances(plan: Region, depth: float, fillet: float = 0.0) -> PlaneDrive:
    return closed_pocket(plan, depth, fillet, wall_allowance=0.3, floor_allowance=0.3)


@cache
def deep_pocket(pattern: str) -> Milled:
    """Return the pocket of 20 mm as it stands after roughing with a flat cutter of 16 mm."""
    return cut(with_allowances(PLAN, 20.0), mill(16), pattern=pattern)[1]


@PATTERNS
def test_a_pocket_is_cleared_down_to_the_floors_allowance(pattern: str) -> None:
    milled = deep_pocket(pattern)
    inside = PLAN.offset(-0.35).signed_distance(milled.points).reshape(milled.x.shape) > 0.0
    assert milled.height[inside].max() == pytest.approx(-19.7)


@PATTERNS
def test_the_walls_keep_their_allowance(pattern: str) -> None:
    milled = deep_pocket(pattern)
    kept = PLAN.offset(-0.29).signed_distance(milled.points).reshape(milled.x.shape) < 0.0
    assert (milled.height[kept] == 0.0).all()


@PATTERNS
def test_no_rapid_goes_through_material(pattern: str) -> None:
    _, milled = cut(with_allowances(PLAN, 20.0), mill(16, 3.0), pattern=pattern)
    assert milled.crashes == []


@pytest.mark.parametrize("width", [3.0, 9.0, 15.0])
@pytest.mark.parametrize("corner", [0.0, 3.0])
def test_no_post_stays_whatever_the_step(width: float, corner: float) -> None:
    _, milled = cut(with_allowances(PLAN, 10.0, corner), mill(16, corner), width=width)
    inside = (
        PLAN.offset(-0.35 - corner).signed_distance(milled.points).reshape(milled.x.shape) > 0.0
    )
    # A rounded end may leave ridges of 0.3 mm, which the floor's finish takes away.
    assert milled.height[inside].max() <= -9.7 + (0.3 if corner else 0.0) + 1e-9


def test_an_island_stands_untouched_and_all_round_it_is_cleared() -> None:
    island = Region.circle((40, 25), 6)
    _, milled = cut(with_allowances(PLAN.minus(island), 12.0), mill(10))
    stands = island.signed_distance(milled.points).reshape(milled.x.shape) > 0.0
    ring = (
        island.offset(5)
        .minus(island.offset(0.35))
        .signed_distance(milled.points)
        .reshape(milled.x.shape)
        > 0.0
    )
    assert (milled.height[stands] == 0.0).all()
    assert milled.height[ring].max() == pytest.approx(-11.7)


def test_an_island_lower_than_the_rim_keeps_the_floors_allowance_on_its_top() -> None:
    island = Region.circle((40, 25), 8)
    levels = (
        DriveLevel(top=0.0, bottom=-5.0, wanted=PLAN, boundary=PLAN),
        DriveLevel(top=-5.0, bottom=-15.0, wanted=PLAN.minus(island), boundary=PLAN.minus(island)),
    )
    drive = closed_pocket(PLAN, 15.0, levels=levels, wall_allowance=0.3, floor_allowance=0.3)
    _, milled = cut(drive, mill(10))
    stands = island.signed_distance(milled.points).reshape(milled.x.shape) > 0.0
    assert milled.height[stands] == pytest.approx(-4.7)


def test_full_material_is_entered_by_a_helix_of_falling_arcs() -> None:
    path = cut(with_allowances(PLAN, 20.0), mill(16))[0].path
    falling = np.diff(path.position[:, 2], prepend=path.position[0, 2]) < -1e-6
    entry = (path.mark == Mark.ENTRY) & falling
    assert (path.motion[entry] == Motion.ARC_CCW).all()


def test_a_helix_goes_down_no_farther_round_than_its_slope_asks() -> None:
    path = cut(with_allowances(PLAN, 20.0), mill(16))[0].path
    fallen = -np.diff(path.position[:, 2], prepend=path.position[0, 2])
    down = (path.mark == Mark.ENTRY) & (fallen > 1e-9)
    slope = np.degrees(np.arcsin(fallen[down] / path.lengths()[down]))
    assert slope == pytest.approx(np.full(down.sum(), 3.0))
    # Each layer's ends with one turn on its floor.
    level = (path.mark == Mark.ENTRY) & (np.abs(fallen) <= 1e-9)
    turns = path.sweeps()[level & (path.motion == Motion.ARC_CCW)]
    assert turns == pytest.approx(np.full(len(turns), np.pi)) and len(turns) % 2 == 0


def test_a_pocket_too_narrow_for_a_helix_is_entered_by_a_ramp() -> None:
    planned, milled = cut(with_allowances(rounded(0, 0, 80, 12.9, 6.4), 8.0), mill(12))
    path = planned.path
    slope = np.diff(path.position[:, 2], prepend=path.position[0, 2]) / np.maximum(
        path.lengths(), 1e-9
    )
    down = (path.mark == Mark.ENTRY) & (slope < -1e-6)
    assert down.any()
    assert slope[down].min() >= -np.sin(np.radians(3.01))
    assert milled.crashes == []


def test_a_fillet_larger_than_the_cutters_corner_is_not_gouged() -> None:
    _, milled = cut(with_allowances(PLAN, 10.0, 4.0), mill(16, 1.0), depth=2.0)
    assert milled.depth_below(milled.pocket_target(PLAN, 10.0, 4.0), PLAN) == 0.0


@pytest.mark.parametrize(
    "plan", [PLAN, rounded(0, 0, 80, 25, 10), PLAN.minus(rounded(30, 20, 50, 30, 2))]
)
def test_what_stands_over_fillets_is_cut_where_a_layer_is_tall(plan: Region) -> None:
    fillet, layer = 4.0, 20.0
    _, milled = cut(with_allowances(plan, 20.0, fillet), mill(16), depth=layer)
    beside = plan.signed_distance(milled.points).reshape(milled.x.shape)
    strip = (beside > 0.8) & (beside < fillet)
    reached = strip & (plan.offset(-8.4).offset(8.4).signed_distance(milled.points) > 0.1).reshape(
        strip.shape
    )
    assert milled.height[reached].max() == pytest.approx(-20.0 + fillet)
    assert milled.depth_below(milled.pocket_target(plan, 20.0, fillet), plan) == 0.0
    assert milled.crashes == []


def test_a_low_strip_over_a_fillet_is_left_to_finishing() -> None:
    _, milled = cut(with_allowances(PLAN, 20.0, 4.0), mill(16), depth=6.0)
    lowest = {round(float(z), 3) for z in milled.height[milled.height < 0.0].ravel()}
    assert -16.0 not in lowest


@pytest.mark.parametrize("pattern", ["contour-parallel", "constant-engagement"])
def test_no_strip_over_a_fillet_stands_above_the_flutes_in_a_deeper_band(pattern: str) -> None:
    # A step with a fillet at its foot; the deeper part goes on below it along three walls of the pocket.
    deeper, fillet = PLAN.intersect(Region.rectangle(-1, -1, 25, 51)), 2.0
    levels = (
        DriveLevel(top=0.0, bottom=-12.0, wanted=PLAN, boundary=PLAN),
        DriveLevel(top=-12.0, bottom=-24.0, wanted=deeper, boundary=deeper),
    )
    floors = (
        Floor(z=-12.0, region=PLAN.minus(deeper), fillet=fillet, face=1),
        Floor(z=-24.0, region=deeper, fillet=fillet, face=2),
    )
    drive = closed_pocket(
        PLAN, 24.0, levels=levels, floors=floors, fillet=fillet, wall_allowance=0.5
    )
    tool, stock = mill(5, flute_length=7.0), PlanningStock.of(BLANK, SETUP)
    data = replace(cutting(4.0, 1.5), layer_depth=4.0, layer_width=1.5)
    path = rough(drive, tool, data, stock, SETUP, RoughSettings(pattern=pattern), NO_PROGRESS).path
    first = int(np.argmax(path.position[:, 2] < -12.0 - 1.0))
    rows = {name: getattr(path, name)[:first] for name in ("position", "axis", "motion")}
    rows |= {name: getattr(path, name)[:first] for name in ("centre", "feed", "mark")}
    before = stock.after(Toolpath(**rows), tool)
    inner = deeper.offset(-0.5 - 2.0 * before.cell)
    assert before.is_clear(-16.0 + tool.flute_length, inner)


def test_entries_are_as_steep_as_the_material_bears_or_a_person_says() -> None:
    def steepest(bears: float, **chosen: float) -> float:
        planned = rough(
            with_allowances(PLAN, 20.0),
            mill(16),
            replace(cutting(10.0, 6.0), entry_angle=bears),
            PlanningStock.of(BLANK, SETUP),
            SETUP,
            RoughSettings(**chosen),
            NO_PROGRESS,
        )
        path = planned.path
        drop = -np.diff(path.position[:, 2], prepend=path.position[0, 2])
        down = (path.mark == Mark.ENTRY) & (drop > 0.0)
        return float(np.degrees(np.arcsin(drop[down] / path.lengths()[down])).max())

    assert steepest(0.0) == pytest.approx(3.0)
    assert steepest(5.0) == pytest.approx(5.0)
    assert steepest(5.0, ramp_angle=2.0) == pytest.approx(2.0)


def test_passes_climb_with_the_wall_on_the_right() -> None:
    path = cut(with_allowances(PLAN, 6.0), mill(16))[0].path
    reach = path.motion[path.mark == Mark.CUT]
    assert Motion.ARC_CCW in reach or Motion.LINE in reach
    outline = path.position[(path.mark == Mark.CUT), :2]
    x, y = outline[-4:].T
    assert 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)) > 0.0


def test_a_cutter_that_does_not_fit_leaves_a_warning_with_the_area_and_a_remedy() -> None:
    planned, _ = cut(with_allowances(rounded(0, 0, 80, 10, 4.9), 8.0), mill(12))
    assert [(f.code, f.severity) for f in planned.findings] == [
        ("rough.too-wide", Severity.WARNING)
    ]
    assert "779 mm2" in planned.findings[0].text
    assert planned.findings[0].remedy


def test_corners_out_of_reach_are_named_with_their_area() -> None:
    planned, _ = cut(with_allowances(rounded(0, 0, 80, 50, 2), 8.0), mill(20))
    assert [f.code for f in planned.findings] == ["rough.left"]


def test_what_an_operation_before_has_cleared_is_not_cut_again() -> None:
    drive, tool, data = with_allowances(PLAN, 20.0), mill(16), cutting(6, 6)
    stock = PlanningStock.of(BLANK, SETUP)
    first = rough(drive, tool, data, stock, SETUP, RoughSettings(), NO_PROGRESS)
    again = rough(
        drive, tool, data, stock.after(first.path, tool), SETUP, RoughSettings(), NO_PROGRESS
    )
    assert len(again.path) == 0


def test_an_open_pocket_is_cut_from_outside_without_a_helix() -> None:
    part = Region.rectangle(-15, -15, 95, 65)
    pocket = rounded(40, 5, 160, 45, 10)
    boundary = Region.rectangle(-200, -200, 300, 300).minus(part.minus(pocket))
    wanted = part.intersect(pocket)
    level = DriveLevel(top=0.0, bottom=-8.0, wanted=wanted, boundary=boundary)
    planned, milled = cut(
        closed_pocket(wanted, 8.0, levels=(level,), wall_allowance=0.3, floor_allowance=0.3),
        mill(12),
    )
    inside = (
        boundary.offset(-0.35)
        .intersect(wanted)
        .signed_distance(milled.points)
        .reshape(milled.x.shape)
        > 0.0
    )
    assert not (planned.path.mark == Mark.ENTRY).any()
    assert milled.height[inside].max() == pytest.approx(-7.7)
    assert milled.crashes == []


def test_the_same_input_gives_the_same_path() -> None:
    a, b = (cut(with_allowances(PLAN, 12.0), mill(16))[0].path for _ in range(2))
    assert a.position.tobytes() == b.position.tobytes()


def test_it_starts_and_ends_at_the_clearance_height() -> None:
    path: Toolpath = cut(with_allowances(PLAN, 12.0), mill(16))[0].path
    assert path.position[0, 2] == SETUP.clearance
    assert path.position[-1, 2] == SETUP.clearance


def test_a_rapid_changes_the_height_or_the_place_never_both() -> None:
    path = cut(with_allowances(PLAN, 12.0), mill(16))[0].path
    moved = np.abs(path.position - path.starts())[path.motion == Motion.RAPID]
    assert not ((moved[:, :2].max(axis=1) > 1e-9) & (moved[:, 2] > 1e-9)).any()


def test_it_stops_when_a_person_asks() -> None:
    with pytest.raises(Cancelled):
        rough(
            with_allowances(PLAN, 12.0),
            mill(16),
            cutting(6, 6),
            PlanningStock.of(BLANK, SETUP),
            SETUP,
            RoughSettings(),
            Progress(cancelled=lambda: True),
        )


def test_a_closed_space_beside_an_open_one_is_cleared_too() -> None:
    bowl = Region.rectangle(25, 15, 55, 35)
    block, around = Region.rectangle(0, 0, 80, 50), Region.rectangle(-60, -60, 140, 110)
    level = DriveLevel(
        top=0.0,
        bottom=-10.0,
        wanted=Region.rectangle(-20, -20, 100, 70).minus(block).union(bowl),
        boundary=around.minus(block).union(bowl),
    )
    drive = PlaneDrive(feature="part", kind="rough", levels=(level,), stock_top=0.0)
    _, milled = cut(drive, mill(10))
    stands = block.minus(bowl).signed_distance(milled.points).reshape(milled.x.shape) > 0.05
    inside = bowl.offset(-5.05).signed_distance(milled.points).reshape(milled.x.shape) > 0.0
    beside = block.signed_distance(milled.points).reshape(milled.x.shape) < -0.05
    assert (milled.height[stands] == 0.0).all() and milled.crashes == []
    assert milled.height[inside].max() == milled.height[beside].max() == pytest.approx(-10.0)
