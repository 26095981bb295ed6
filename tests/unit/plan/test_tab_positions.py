"""Where tabs are put along outlines, and that paths leave them and nothing else: on seeded random outlines."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from milling import SETUP, Milled, box_blank, cutting, mill, rounded
from trunnion.geometry.plane.region import Region
from trunnion.model.tabs import Tab
from trunnion.plan.prismatic.drive import DriveLevel, PlaneDrive, WallGuide
from trunnion.plan.prismatic.tabs import TabForm, frame_behind, spread_tabs
from trunnion.progress import NO_PROGRESS
from trunnion.toolpath.plane.profile import (
    ProfileFinishSettings,
    ProfileRoughSettings,
    profile_finish,
    profile_rough,
)
from trunnion.toolpath.stock.heightfield import PlanningStock, positions_on

BOTTOM, MARGIN = -8.0, 25.0
TOOL = mill(8.0)
FORM = TabForm(
    width=5.0,
    height=1.5,
    ramp=math.radians(30.0),
    channel=13.0,
    frame=5.0,
    radius=4.0,
    bottom=BOTTOM,
    top=0.0,
)
LONG = (180.0, 120.0)


def random_outline(seed: int) -> Region:
    """Return a plate with notches in its sides, some of its corners cut off, all inner corners rounder than the cutter."""
    draw = np.random.default_rng(seed)
    size = draw.uniform((90.0, 70.0), LONG)
    plate = rounded(0.0, 0.0, *map(float, size), float(draw.uniform(1.0, 15.0)))
    for _ in range(draw.integers(0, 4)):
        low = draw.uniform((0.0, -30.0), size)
        if draw.random() < 0.5:
            low[1] = size[1] - draw.uniform(5.0, 20.0)
        wide = draw.uniform((12.0, 40.0), (40.0, 60.0))
        plate = plate.minus(Region.rectangle(*map(float, low), *map(float, low + wide)))
    whole = plate.opened(5.0).closed(5.0).opened(5.0)
    return max(whole.split(), key=lambda piece: piece.area).holes_filled()


def blank_of(outline: Region) -> tuple[Region, PlanningStock]:
    low, high = outline.box()
    x0, y0, x1, y1 = (float(v) for v in (*(low - MARGIN), *(high + MARGIN)))
    return Region.rectangle(x0, y0, x1, y1), PlanningStock.of(
        box_blank((x0, y0, BOTTOM), (x1, y1, 0.0)), SETUP, 0.5
    )


def spread(outline: Region, count: int, form: TabForm = FORM, solid: Region | None = None):
    """Return the tabs of a plate, of which `solid` is its section at all heights."""
    section = outline if solid is None else solid
    blank, _ = blank_of(outline)
    return spread_tabs(outline.pieces[0].outer, outline, blank, lambda z: section, form, count)


def drive_of(outline: Region, blank: Region, tabs: tuple[Tab, ...], allowance: float) -> PlaneDrive:
    around = Region.rectangle(-300, -300, 500, 500)
    level = DriveLevel(
        top=0.0, bottom=BOTTOM, wanted=blank.minus(outline), boundary=around.minus(outline)
    )
    wall = WallGuide(
        curve=outline.pieces[0].outer.reversed(), top=0.0, bottom=BOTTOM, fillet=0.0, faces=(7,)
    )
    return PlaneDrive(
        feature="profile-01",
        kind="profile_rough",
        levels=(level,),
        walls=(wall,),
        stock_top=0.0,
        wall_allowance=allowance,
        tabs=tabs,
        frame=frame_behind(tabs, outline, blank),
    )


def paths_of(outline: Region, tabs: tuple[Tab, ...]):
    """Return the paths that rough and finish an outline, and the stock that they leave by the planner's field."""
    blank, stock = blank_of(outline)
    first = profile_rough(
        drive_of(outline, blank, tabs, 0.3), TOOL, cutting(4.0, 4.0), stock, SETUP,
        ProfileRoughSettings(), NO_PROGRESS,
    ).path  # fmt: skip
    after = stock.after(first, TOOL)
    last = profile_finish(
        drive_of(outline, blank, tabs, 0.0), TOOL, cutting(8.0, 0.3), after, SETUP,
        ProfileFinishSettings(), NO_PROGRESS,
    ).path  # fmt: skip
    return (first, last), after.after(last, TOOL)


@pytest.mark.examples(14)
@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10_000), st.integers(1, 8))
def test_no_tab_is_in_a_corner_and_none_at_another(seed: int, count: int) -> None:
    outline = random_outline(seed)
    tabs = spread(outline, count)
    assert len(tabs) <= count
    half = FORM.half_length
    for tab in tabs:
        across = np.linspace(-half, half, 31)
        on_wall = tab.world(np.stack([across, np.zeros(31)], axis=1))
        assert np.abs(outline.signed_distance(on_wall)).max() < 1e-3
        assert outline.signed_distance(tab.world(np.array([[0.0, 1.0]])))[0] < 0.0
    middles = np.array([t.middle for t in tabs])
    for k, tab in enumerate(tabs):
        others = np.delete(middles, k, axis=0)
        assert not len(others) or np.hypot(*(others - tab.middle).T).min() >= 2 * half + FORM.width


@pytest.mark.examples(2)
@settings(max_examples=6, deadline=None)
@given(st.integers(0, 10_000))
def test_paths_leave_the_tabs_and_nothing_else_of_the_channel(seed: int) -> None:
    outline = random_outline(seed)
    tabs = spread(outline, 4)
    if not tabs:
        return
    paths, stock = paths_of(outline, tabs)
    for path in paths:
        rows = np.repeat(np.arange(1, len(path)), 100)
        tips = positions_on(path, rows, np.tile(np.linspace(0.0, 1.0, 100), len(path) - 1))
        for tab in tabs:
            beside = tab.distance(tips[:, :2]) < TOOL.radius - 1e-3
            assert tips[beside, 2].min(initial=0.0) >= tab.top - 1e-3
    nx, ny = stock.field.shape
    x, y = np.meshgrid(np.arange(nx) + 0.5, np.arange(ny) + 0.5, indexing="ij")
    cells = stock.corner + stock.cell * np.stack([x.ravel(), y.ravel()], axis=1)
    height = stock.field.ravel()
    outside = -outline.signed_distance(cells)
    edge = 1.5 * stock.cell
    channel = (outside > edge) & (outside < TOOL.diameter + 0.3 - edge)
    on_tab = np.zeros(len(cells), bool)
    for tab in tabs:
        u, v = tab.local(cells).T
        box = (np.abs(u) < 0.5 * tab.width - stock.cell) & (v > edge) & (v < TOOL.diameter)
        assert height[box] == pytest.approx(tab.top, abs=1e-3)
        on_tab |= (
            (np.abs(u) < tab.half_length(TOOL.radius, tab.bottom) + edge)
            & (v > 0.0)
            & (v < tab.reach + edge)
        )
    assert height[channel & ~on_tab] == pytest.approx(BOTTOM, abs=1e-6)


def test_the_frame_stays_and_rapids_meet_nothing() -> None:
    outline = rounded(0.0, 0.0, 90.0, 70.0, 8.0)
    tabs = spread(outline, 4)
    paths, _ = paths_of(outline, tabs)
    low, high = outline.box()
    milled = Milled(tuple(low - MARGIN), tuple(high + MARGIN), 0.0)
    for path in paths:
        milled.cut(path, TOOL)
    outside = -outline.signed_distance(milled.points).reshape(milled.x.shape)
    assert len(tabs) == 4 and milled.crashes == []
    assert (milled.height[(outside > FORM.channel) | (outside < -0.01)] == 0.0).all()
    joined = (milled.height > BOTTOM + 0.01) & (outside > 0.01) & (outside < TOOL.diameter)
    assert milled.height[joined].max() <= BOTTOM + FORM.height + 0.3


def test_they_are_spread_evenly() -> None:
    tabs = spread(rounded(0.0, 0.0, 100.0, 100.0, 5.0), 4)
    found = sorted(tuple(round(v, 0) for v in t.middle) for t in tabs)
    middles = np.array([t.middle for t in tabs])
    gaps = np.hypot(*(middles - np.roll(middles, 1, axis=0)).T)
    assert len(found) == 4 and np.ptp(gaps) < 2.0


def test_a_hole_and_a_pocket_at_the_edge_keep_tabs_off() -> None:
    outline = rounded(0.0, 0.0, 100.0, 80.0, 5.0)
    hole = Region.circle((50.0, 4.0), 2.0)
    for tab in spread(outline, 12, solid=outline.minus(hole)):
        u, v = tab.local(np.array([[50.0, 4.0]]))[0]
        assert abs(u) > FORM.half_length or v < -FORM.width
    # A web of half the side's length, as an open pocket leaves it: no section reaches the wall there.
    pocket = outline.minus(Region.rectangle(0.0, -1.0, 55.0, 10.0))
    for tab in spread(outline, 12, solid=pocket):
        assert tab.middle[1] > 0.0 or tab.middle[0] > 55.0 + FORM.half_length


def test_a_disc_and_a_blank_without_a_frame_have_none() -> None:
    disc = Region.circle((0.0, 0.0), 40.0)
    assert spread(disc, 4) == ()
    outline = rounded(0.0, 0.0, 100.0, 80.0, 5.0)
    narrow = TabForm(
        width=5.0, height=1.5, ramp=0.5, channel=21.0, frame=5.0, radius=4.0, bottom=BOTTOM, top=0.0
    )
    assert spread(outline, 4, narrow) == ()


def test_a_notch_that_the_channel_fills_has_none() -> None:
    """On both sides of a notch as wide as a channel and a frame no frame is left between two channels; a tab there joined both walls."""
    plate = Region.rectangle(0.0, 0.0, 140.0, 120.0)
    notch = Region.rectangle(60.0, -1.0, 60.0 + 18.7, 60.0)
    wide = Region.rectangle(40.0, -1.0, 40.0 + 40.0, 60.0)
    assert not [
        t
        for t in spread(plate.minus(notch), 12)
        if 50.0 < t.middle[0] < 90.0 and 0.0 < t.middle[1] < 61.0
    ]
    assert [
        t
        for t in spread(plate.minus(wide), 12)
        if 39.0 < t.middle[0] < 81.0 and 0.0 < t.middle[1] < 61.0
    ]


def test_what_a_bay_encloses_is_no_frame() -> None:
    """A bay that is wider inside than at its mouth, which the channel fills: what stands in it would fall out with a tab on it."""
    plate = Region.rectangle(0.0, 0.0, 160.0, 140.0)
    bay = Region.rectangle(40.0, 30.0, 120.0, 110.0).union(Region.rectangle(70.0, -1.0, 90.0, 31.0))
    tabs = spread(plate.minus(bay), 12)
    assert tabs and not [t for t in tabs if 1.0 < t.middle[0] < 159.0 and 1.0 < t.middle[1] < 139.0]


def test_only_what_a_tab_ends_in_is_frame() -> None:
    """Of a blank that is longer than the part, but hardly wider, two bars stay; a bar that no tab ends in is cut to chips."""
    outline = Region.rectangle(0.0, 0.0, 100.0, 80.0)
    blank = Region.rectangle(-30.0, -5.0, 130.0, 85.0)
    ends = [Tab(middle=(x, 40.0), direction=a, width=5.0, reach=13.0, bottom=BOTTOM, top=-6.5, ramp=0.5)
            for x, a in ((0.0, math.pi), (100.0, 0.0))]  # fmt: skip
    both, one = frame_behind(ends, outline, blank), frame_behind(ends[:1], outline, blank)
    assert len(both.pieces) == 2 and both.area == pytest.approx(2 * one.area)
    # At the blank's long edges, 5 mm beside the part, the round channel comes in by 13 - sqrt(13^2 - 5^2) = 1 mm.
    assert one.box()[1][0] == pytest.approx(-12.0)
