"""Passes of roughing are cut only where stock stands before the cutter, and leave nothing of what is wanted."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from milling import SETUP, Milled, box_blank, cutting, mill
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.region import Region
from trunnion.model.motion.toolpath import Mark
from trunnion.plan.prismatic.drive import DriveLevel, PlaneDrive
from trunnion.progress import NO_PROGRESS
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.offsetting.trimming import MARGIN, PassTrimming
from trunnion.toolpath.plane.rough import RoughSettings, rough
from trunnion.toolpath.stock.heightfield import PlanningStock

LOW, HIGH = (0.0, 0.0), (120.0, 60.0)
BLANK = box_blank((*LOW, -20.0), (*HIGH, 0.0))
AROUND = Region.rectangle(-100.0, -100.0, 220.0, 160.0)
Z = -4.0


def _builder(tool) -> PathBuilder:
    return PathBuilder(tool, cutting(4.0, 8.0), PlanningStock.of(BLANK, SETUP), SETUP, 2.0)


@settings(deadline=None)
@given(
    y=st.floats(4.0, 56.0),
    diameter=st.floats(6.0, 25.0),
    before=st.floats(20.0, 80.0),
    after=st.floats(20.0, 80.0),
)
def test_a_pass_begins_a_radius_before_the_stock_and_ends_where_its_front_has_left_it(
    y, diameter, before, after
):
    tool = mill(diameter)
    builder = _builder(tool)
    trimming = PassTrimming.of(builder, AROUND, Z)
    (part,) = trimming.parts(builder, Curve.polyline([[-before, y], [HIGH[0] + after, y]]))
    slack = MARGIN + 2.0 * PlanningStock.of(BLANK, SETUP).cell
    # The rim's flanks meet the sides of the blank later than its middle where they stand out past it.
    assert -tool.radius - slack <= part.start[0] <= max(-before, -tool.radius + slack)
    assert HIGH[0] - slack <= part.end[0] <= HIGH[0] + slack


def test_where_nothing_stands_there_is_no_pass_and_a_ring_is_opened_at_its_longest_gap():
    tool = mill(10.0)
    builder = _builder(tool)
    trimming = PassTrimming.of(builder, Region.rectangle(40.0, 0.0, 60.0, 60.0), Z)
    assert trimming.parts(builder, Curve.polyline([[-30.0, -20.0], [150.0, -20.0]])) == []
    near, far = trimming.parts(builder, Curve.rectangle(5.0, 10.0, 115.0, 50.0))
    assert not near.closed and not far.closed
    assert {round(near.start[1]), round(far.start[1])} == {10, 50}
    inside = Curve.rectangle(44.0, 4.0, 56.0, 56.0)
    assert trimming.parts(builder, inside) == [inside]


def _open_drive(standing: Region, part: Region) -> PlaneDrive:
    level = DriveLevel(top=0.0, bottom=Z, wanted=standing.minus(part), boundary=AROUND.minus(part))
    return PlaneDrive(feature="part", kind="rough", levels=(level,), stock_top=0.0)


@pytest.mark.parametrize("width", [3.0, 8.0, 13.0])
@pytest.mark.parametrize("rim", [1.5, 3.8, 12.0, 25.0])
def test_everything_around_a_part_goes_whatever_the_rim_and_the_step(width, rim):
    part = Region.rectangle(LOW[0] + rim, LOW[1] + rim, HIGH[0] - rim, HIGH[1] - rim)
    tool = mill(16.0)
    drive = _open_drive(Region.rectangle(*LOW, *HIGH), part)
    stock = PlanningStock.of(BLANK, SETUP)
    planned = rough(drive, tool, cutting(4.0, width), stock, SETUP, RoughSettings(), NO_PROGRESS)
    milled = Milled(LOW, HIGH, 0.0).cut(planned.path, tool)
    wanted = drive.levels[0].wanted.offset(-0.3)
    inside = wanted.signed_distance(milled.points).reshape(milled.x.shape) > 0.0
    assert milled.height[inside].max() <= Z + 1e-6
    assert milled.crashes == []


def test_hardly_any_way_is_fed_through_air():
    rim = 3.8
    part = Region.rectangle(rim, rim, HIGH[0] - rim, HIGH[1] - rim)
    tool = mill(20.0)
    drive = _open_drive(Region.rectangle(*LOW, *HIGH), part)
    stock = PlanningStock.of(BLANK, SETUP)
    path = rough(drive, tool, cutting(4.0, 8.0), stock, SETUP, RoughSettings(), NO_PROGRESS).path
    way = np.linalg.norm(np.diff(path.position, axis=0, prepend=path.position[:1]), axis=1)
    cut = way[path.mark == Mark.CUT].sum()
    # One pass along the four sides of the part; before, two rings ran around it out in the open.
    assert cut < 1.25 * 2.0 * (HIGH[0] + HIGH[1])
