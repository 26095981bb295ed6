"""Milling holes: rings that leave no post, a bottom that is flat, and what a cutter can't do."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pytest import approx

from milling import SETUP, Milled, box_blank, cutting, mill
from trunnion.geometry.plane.region import Region
from trunnion.model.motion.toolpath import Mark
from trunnion.plan.holes.drive import HoleDrive
from trunnion.plan.holes.hole import PlannedHole
from trunnion.progress import NO_PROGRESS
from trunnion.toolpath.hole.mill import MillSettings, ring_radii
from trunnion.toolpath.hole.mill import mill as mill_holes
from trunnion.toolpath.stock.heightfield import PlanningStock

BLANK = box_blank((0, 0, -40), (100, 60, 0))


def at(x, y, diameter, depth=6.0, **changed):
    words = {"feature": f"hole-{x:g}", "top": 0.0, "bottom": -depth, "through": False, **changed}
    return PlannedHole(x=x, y=y, diameter=diameter, **words)


def milled(*holes, tool, width=2.0, **words):
    drive = HoleDrive(kind="counterbore", holes=holes)
    stock = PlanningStock.of(BLANK, SETUP)
    data = cutting(1.2, width)
    return mill_holes(drive, tool, data, stock, SETUP, MillSettings(**words), NO_PROGRESS)


@pytest.mark.parametrize("diameter", [7.7, 11.0, 15.0, 32.0])
def test_a_hole_is_cleared_to_its_wall_and_its_floor_and_not_beyond(diameter):
    tool = mill(6.0)
    path = milled(at(30, 30, diameter), tool=tool).path
    field = Milled((0, 0), (60, 60), 0.0, cell=0.25).cut(path, tool)
    round_hole = Region.circle((30.0, 30.0), diameter / 2)
    target = field.pocket_target(round_hole, 6.0)
    assert field.depth_below(target, round_hole, margin=0.02) < 1e-6
    assert field.area_above(target, round_hole, margin=0.02) == 0.0
    assert not field.crashes


@settings(max_examples=60, deadline=None)
@given(
    st.floats(4.0, 20.0),
    st.floats(1.3, 6.0),
    st.floats(0.05, 1.0),
    st.sampled_from([0.0, 0.3, 0.8]),
)
def test_rings_leave_no_post_and_take_no_more_than_their_width(diameter, times, share, core):
    tool, width = mill(diameter), share * diameter
    hole = at(0, 0, times * diameter, core=core * diameter)
    radii = ring_radii(hole, tool, width)
    assert radii[-1] == approx(hole.radius - tool.radius)
    assert radii[0] - tool.radius <= hole.core / 2 + 1e-9
    assert (np.diff(radii) <= width + 1e-6).all() and (np.diff(radii) > 0.0).all()


def test_a_through_hole_is_milled_past_its_end():
    path = milled(at(30, 30, 10.0, 40.0, through=True), tool=mill(6.0, flute_length=45)).path
    assert path.position[:, 2].min() == approx(-40.5)


def test_no_turn_goes_down_more_than_the_cutting_depth():
    path = milled(at(30, 30, 20.0), tool=mill(6.0), ramp_angle=30.0).path
    down = -np.diff(path.position[:, 2])[(path.mark[1:] == Mark.ENTRY) & (path.motion[1:] >= 2)]
    assert down.max() <= 0.6 + 1e-9


def test_the_cutter_leaves_the_wall_before_it_is_lifted():
    path = milled(at(30, 30, 10.0), tool=mill(6.0)).path
    away = np.hypot(*(path.position[-1, :2] - [30.0, 30.0]))
    assert away < 2.0 - 0.5


def test_holes_that_are_too_narrow_for_the_cutter_are_named():
    planned = milled(at(30, 30, 5.0), at(70, 30, 10.0), tool=mill(6.0))
    assert [f.code for f in planned.findings] == ["hole.too-narrow"]
    assert planned.path.position[:, 0].min() > 60.0


def test_the_cone_of_a_milled_hole_is_told_as_left():
    planned = milled(at(30, 30, 10.0, point_angle=118.0), tool=mill(6.0))
    assert [f.code for f in planned.findings] == ["hole.point"]
