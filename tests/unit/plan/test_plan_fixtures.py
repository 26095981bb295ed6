"""What fixtures keep a cutter from, on boxes whose distances are worked out by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
from pytest import approx

from clamps import clamp
from surface_forms import plane
from trunnion import tolerance
from trunnion.geometry.frame import WORLD, Frame
from trunnion.geometry.plane.plan_area import plan_area_above
from trunnion.geometry.plane.region import Region
from trunnion.model.blank import Box
from trunnion.model.setup import Setup
from trunnion.plan.freeform.fixtures import OffsetFixture, off_fixtures, with_fixtures
from trunnion.plan.prismatic import fixtures
from trunnion.plan.prismatic.drive import DriveLevel, PlaneDrive, WallGuide
from trunnion.plan.setups import held
from trunnion.plan.setups.frames import cutting_setup
from trunnion.toolpath.motion.fixture_links import FixtureSurface
from verify_tools import tool_of

ROOM = tolerance.FIXTURE_CLEARANCE
BLANK = Box(
    frame=WORLD,
    low=np.array([0.0, 0.0, 0.0]),
    high=np.array([100.0, 60.0, 20.0]),
    material="",
    density=2.8,
)
SETUP = Setup(name="S1", frame=WORLD, work_offset="G54", clearance=40.0, machine="")
LONG = {"gauge_length": 300.0, "neck_diameter": 10.0, "shank_diameter": 10.0}
D10 = tool_of("flat", flute_length=25.0, neck_length=25.0, stickout=200.0, **LONG)
"""10 mm wide all along, its holder out of the way."""
SHORT = tool_of("flat", flute_length=25.0, neck_length=25.0, stickout=36.0, **LONG)
"""The same with its holder, 20 mm in radius at its widest, 36 mm above the tip."""


def setup_with(*fixtures):
    return held(SETUP, fixtures, BLANK)


def level(top=20.0, bottom=0.0):
    area = Region.rectangle(0.0, 0.0, 100.0, 60.0)
    return DriveLevel(top=top, bottom=bottom, wanted=area, boundary=area.offset(30.0))


def drive(**changes):
    return PlaneDrive(**{"feature": "face-01", "kind": "face", "levels": (level(),), **changes})


def cut(setup, tool=D10, **changes):
    standing = [fixtures.PlanFixture.of(f, setup, BLANK) for f in setup.fixtures]
    return fixtures.off_fixtures(drive(**changes), tool, setup, standing)


def test_a_fixture_far_away_leaves_a_drive_as_it_is():
    kept, found = cut(setup_with(clamp((-200, 0, 0), (-150, 60, 90))))
    assert kept.levels[0].wanted.area == approx(6000.0)
    assert found == () and len(kept.levels) == 1


def test_the_clearance_is_as_far_above_a_fixture_as_above_the_blank():
    assert setup_with(clamp((0, 0, 0), (9, 9, 15))).clearance == 40.0
    tall = setup_with(clamp((-30, 0, 0), (-20, 9, 55)))
    assert tall.clearance == approx(75.0)
    # Seen along x the highest is the clamp's side at x = -20, or the blank's at 100.
    assert cutting_setup(tall, (1.0, 0.0, 0.0), BLANK).clearance == approx(120.0)
    assert cutting_setup(tall, (-1.0, 0.0, 0.0), BLANK).clearance == approx(50.0)


def test_a_clamp_on_the_blank_is_cut_off_with_its_room():
    kept, (finding,) = cut(setup_with(clamp((-20, 20, 0), (10, 40, 30))))
    (only,) = kept.levels
    # In plan a rectangle of 10 x 20 mm, a strip of 1 mm along three of its sides, and two quarters of a disc.
    lost = 10 * 20 + 2 * 10 * ROOM + 20 * ROOM + math.pi * ROOM**2 / 2
    assert level().wanted.area - only.wanted.area == approx(lost, abs=1.5)
    assert finding.code == "fixture.kept-off" and "mm2 in plan of face-01" in finding.text
    assert "fixture clamp is in the way of flat 10" in finding.text


def test_over_a_low_clamp_everything_is_cut():
    kept, _ = cut(setup_with(clamp((-20, 20, 0), (10, 40, 8))))
    upper, lower = kept.levels
    assert (upper.top, upper.bottom, lower.top, lower.bottom) == approx((20.0, 9.0, 9.0, 0.0))
    assert upper.wanted.area == level().wanted.area > lower.wanted.area + 200.0


def test_a_holder_keeps_off_a_clamp_that_the_cutter_would_pass():
    # Beside a clamp 50 mm high the holder is over its top and the room with the tip at 15; its second ring begins 10 mm further up.
    kept, _ = cut(setup_with(clamp((-20, 20, 0), (-7, 40, 50))), SHORT)
    assert [each.bottom for each in kept.levels] == approx([15.0, 5.0, 0.0])
    out = [level().boundary.minus(each.boundary).area for each in kept.levels]
    # The holder is 15 mm wider than the cutter: the clamp counts as so much larger, and the boundary ends at x = -30.
    assert out[0] == approx(15.0 * 20 + 2 * 13 + math.pi, abs=2.0)
    assert out[1] == out[2] > out[0] + 500.0


def test_a_plate_under_the_blank_takes_nothing_away():
    kept, found = cut(setup_with(clamp((-50, -50, -20), (150, 110, 0))))
    assert found == () and kept.levels[0].wanted.area == level().wanted.area


def test_walls_that_a_clamp_covers_are_told():
    guide = WallGuide(
        curve=Region.rectangle(0.0, 0.0, 100.0, 60.0).pieces[0].outer.reversed(),
        top=20.0,
        bottom=0.0,
        fillet=0.0,
        faces=(1,),
    )
    _, (finding,) = cut(setup_with(clamp((-20, 20, 0), (-3, 40, 30))), walls=(guide,), faces=(1,))
    # The axis runs 5 mm beside the wall, 2 mm into the clamp: it keeps 6 mm from it, so 20 + 2 x 6 mm of wall 20 mm high stay.
    assert "640 mm2 of walls" in finding.text and finding.where == ("face-01", "face 1")


def test_a_shadow_is_what_a_mesh_has_above_a_height():
    corners = clamp((0, 0, 0), (10, 5, 8)).mesh.corners()
    assert plan_area_above(corners, 4.0).area == approx(50.0, abs=1.0)
    assert not plan_area_above(corners, 8.0)


@pytest.mark.parametrize(("x", "expected"), [(-60.0, -math.inf), (-30.0, -169.0), (-10.0, 31.0)])
def test_links_go_over_a_clamp(x, expected):
    # The clamp's top with its room; beside it only the holder, 200 mm up and 20 in radius, is over it.
    obstacles = FixtureSurface.of(setup_with(clamp((-20, 20, 0), (0, 40, 30))))
    assert obstacles.lowest_tip(D10, np.array([x, 30.0]), np.array([x, 30.0])) == approx(expected)


def test_a_link_beside_a_clamp_is_held_up_on_its_way():
    obstacles = FixtureSurface.of(setup_with(clamp((-20, 20, 0), (0, 40, 30))))
    ends = np.array([-10.0, -30.0]), np.array([-10.0, 90.0])
    assert [obstacles.lowest_tip(D10, p, p) for p in ends] == [-math.inf, -math.inf]
    assert obstacles.lowest_tip(D10, *ends) == approx(31.0)


def test_a_box_is_thicker_all_round_by_its_room():
    made = OffsetFixture.of(clamp((0, 0, 0), (10, 5, 8)), SETUP, BLANK)
    assert made.corners.reshape(-1, 3).min(axis=0) == approx([-ROOM, -ROOM, 0.0])
    assert made.corners.reshape(-1, 3).max(axis=0) == approx([10 + ROOM, 5 + ROOM, 8 + ROOM])


def test_of_a_plane_beside_a_clamp_what_the_cutter_cannot_reach_is_left_out():
    skin = plane(40.0, 30.0, n=31)
    low, high = skin.box()
    blank = Box(frame=WORLD, low=low - [0, 0, 9], high=high + [0, 0, 1], material="", density=2.8)
    block = clamp((low[0] - 10, -90, low[2] - 9), (low[0], 90, high[2] + 20))
    thick = (OffsetFixture.of(block, SETUP, blank),)
    kept, tags, refused = off_fixtures(skin, (1,), D10, thick, -50.0, 0.01)
    whole = skin.areas(skin.of((1,))).sum()
    # A flat cutter's axis stays 6 mm off, where it touches the plane at its rim: what lies nearer than that is left out.
    assert refused.by == ("clamp",) and refused.area == approx(
        whole - kept.areas(kept.of(tags)).sum()
    )
    assert 0.0 < refused.area < 0.5 * whole
    standing = with_fixtures(kept, thick)
    assert standing.drop.drop(np.array([[low[0] - 5.0, 0.0]]), np.zeros((1, 6)), -50.0) == approx(
        high[2] + 20 + ROOM
    )


def test_from_below_a_fixture_stands_the_other_way_up():
    under = Frame(np.array([0.0, 0.0, 20.0]), np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, -1.0]))
    setup = Setup(name="S2", frame=under, work_offset="G55", clearance=20.0, machine="")
    assert held(setup, (clamp((0, 0, -12), (9, 9, 15)),), BLANK).clearance == approx(32.0)
