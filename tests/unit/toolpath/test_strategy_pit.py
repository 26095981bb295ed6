"""Pits in walls: where the disc of a T-slot cutter goes, and what is told of what it leaves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from pytest import approx

from milling import SETUP, box_blank, cutting, mill
from trunnion.geometry.plane.region import EMPTY_REGION, Region
from trunnion.model.motion.toolpath import Mark, Motion
from trunnion.plan.prismatic.drive import DriveLevel, PlaneDrive
from trunnion.plan.prismatic.pits import PitReach, PitSettings
from trunnion.progress import NO_PROGRESS
from trunnion.toolpath.plane.pit import pit
from trunnion.toolpath.stock.heightfield import PlanningStock
from verify_tools import FORMS

POCKET = Region.rectangle(0.0, 0.0, 80.0, 50.0)
PIT = Region.rectangle(20.0, 49.0, 60.0, 53.0)
TOP, ROOF, FLOOR = 0.0, -10.0, -18.0
CLEARANCE = PitSettings().clearance
BLANK = box_blank((-15, -15, -30), (95, 65, 0))


def disc(diameter=12.0, thick=8.0, neck=4.0):
    return replace(
        FORMS["t-slot"],
        name=f"TS D{diameter:g} H{thick:g}",
        diameter=diameter,
        corner_radius=0.0,
        flute_length=thick,
        neck_diameter=neck,
        neck_length=30.0,
        shank_diameter=10.0,
        stickout=40.0,
        gauge_length=140.0,
    )


def drive_for(pit_area=PIT):
    wanted = pit_area.minus(POCKET)
    return PlaneDrive(
        feature="pit-01",
        kind="pit",
        levels=(
            DriveLevel(top=TOP, bottom=ROOF, wanted=EMPTY_REGION, boundary=POCKET),
            DriveLevel(top=ROOF, bottom=FLOOR, wanted=wanted, boundary=POCKET.union(pit_area)),
        ),
        stock_top=TOP,
    )


def pocketed_stock() -> PlanningStock:
    """Return the stock in which the pocket is cut already."""
    stock = PlanningStock.of(BLANK, SETUP)
    field = stock.field.copy()
    x, y = (stock.corner[k] + stock.cell * np.arange(field.shape[k] + 1) for k in (0, 1))
    # Cells that the pocket has all of.
    inside = np.ix_(
        (x[:-1] >= 0.0) & (x[1:] <= 80.0),
        (y[:-1] >= 0.0) & (y[1:] <= 50.0),
    )
    field[inside] = -25.0
    return replace(stock, field=field, digest="pocketed")


def cut(tool=None, drive=None, width=1.0):
    tool = tool or disc()
    data = cutting(tool.flute_length, width)
    return pit(
        drive or drive_for(), tool, data, pocketed_stock(), SETUP, PitSettings(), NO_PROGRESS
    )


def reach_of(tool, drive):
    over, level = drive.levels
    return PitReach.of(level.wanted, level.boundary, over.boundary, TOP - FLOOR, tool, CLEARANCE)


@pytest.mark.parametrize("thick", [8.0, 5.0, 3.0])
def test_the_disc_stays_where_neck_and_disc_are_free(thick):
    tool = disc(thick=thick)
    planned, reach = cut(tool), reach_of(disc(thick=thick), drive_for())
    path = planned.path
    low = path.position[:, 2] < ROOF
    inside = reach.axis.signed_distance(path.position[low, :2])
    assert inside.min() > -1e-3
    # Nothing goes up or down but where nothing is over the disc.
    starts = path.starts()
    upright = np.abs(path.position[:, 2] - starts[:, 2]) > 1e-6
    upright[0] = False
    at = path.position[upright, :2]
    assert reach.outside.signed_distance(at).min() > -1e-3
    assert (np.abs(at - starts[upright, :2]) < 1e-9).all()


def test_all_that_the_disc_gets_to_is_cut_from_roof_to_floor():
    tool = disc(thick=5.0)
    path, reach = cut(tool).path, reach_of(disc(thick=5.0), drive_for())
    feeds = path.motion != Motion.RAPID
    heights = np.unique(np.round(path.position[feeds, 2], 6))
    low = heights[heights < ROOF]
    assert low.min() == approx(FLOOR) and low.max() + 5.0 == approx(ROOF)
    swept = EMPTY_REGION
    starts = path.starts()
    for a, b in zip(starts[feeds], path.position[feeds], strict=True):
        if abs(a[2] - FLOOR) < 1e-6 and abs(b[2] - FLOOR) < 1e-6:
            for p in np.linspace(a[:2], b[:2], 1 + int(np.hypot(*(b - a)[:2]) / 0.5)):
                swept = swept.union(Region.circle(p, tool.radius))
    assert reach.covered.minus(swept.offset(0.1)).area == approx(0.0, abs=0.05)


def test_each_pass_goes_in_no_deeper_than_the_width_of_cut():
    width = 0.8
    path = cut(width=width).path
    deep = sorted({round(float(y), 6) for y in path.position[path.mark == Mark.CUT, 1]})
    assert max(np.diff(deep)) <= width + 1e-6 and len(deep) >= 3


def test_the_cutter_climbs():
    path = cut().path
    starts, rows = path.starts(), path.mark == Mark.CUT
    along = (path.position - starts)[rows]
    inner = along[np.abs(along[:, 0]) > 5.0]
    # The wall is at the back, y up: with it on the right the disc goes towards -x.
    assert len(inner) and (inner[:, 0] < 0.0).all()


def test_the_way_into_the_material_is_slower():
    path = cut().path
    entries = path.feed[path.mark == Mark.ENTRY]
    assert len(entries) and (entries <= 0.5 * cutting(8.0, 1.0).feed + 1e-9).all()


def test_what_stands_over_the_pit_stays_in_the_stock_and_what_is_beside_it_goes():
    stock = pocketed_stock()
    after = stock.after(cut().path, disc())
    x, y = (stock.corner[k] + stock.cell * (np.arange(stock.field.shape[k]) + 0.5) for k in (0, 1))
    over = after.field[np.ix_((x > 26) & (x < 54), (y > 51.0) & (y < 52.5))]
    assert (over == TOP).all()


@pytest.mark.parametrize(
    ("tool", "words"),
    [
        (mill(12), "is no T-slot cutter"),
        (disc(thick=8.5), "is no T-slot cutter that is thin enough"),
        (disc(diameter=60.0, neck=4.0), "does not come down beside it"),
    ],
)
def test_a_tool_that_does_not_fit_is_told_and_moves_nothing(tool, words):
    planned = cut(tool)
    (told,) = planned.findings
    assert told.code == "pit.not-cut" and words in told.text and told.remedy
    assert not len(planned.path)


def test_what_a_thick_neck_leaves_is_told():
    planned = cut(disc(neck=9.0))
    (told,) = [f for f in planned.findings if f.code == "pit.left"]
    assert "neck too thick" in told.text and told.where == ("pit-01",)
    assert not [f for f in cut().findings if "neck" in f.text and "0 %" in f.text]
