"""Flank passes: blocks within their chord error, lifts over a floor, gaps where something is in the way."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from funnels import funnel
from surface_drives import DATA, driven, grid
from trunnion.findings import Refused
from trunnion.geometry.arrays import Floats
from trunnion.model.motion.toolpath import Mark
from trunnion.plan.freeform.swarf.guide_lines import GuideLine
from trunnion.toolpath.contact_passes.contacts import slerp
from trunnion.toolpath.contact_passes.flank.flank_passes import (
    flank_passes,
    lifts,
    poses_on,
    stretches,
)
from trunnion.toolpath.stock.leaning_cuts import LeaningCut
from trunnion.toolpath.surface.swarf import SwarfSettings, swarf
from verify_tools import bull, flat


def free(tip: Floats, axis: Floats, **_: Floats):
    return np.ones(len(tip), dtype=bool)


def over_floor(tool):
    """Return the query of a level floor at 0 under a tool's end."""

    def query(tip: Floats, axis: Floats, **_: Floats):
        # The lowest place of a torus of the corner radius r about a disc of R - r.
        side = np.sqrt(np.maximum(1.0 - axis[:, 2] ** 2, 0.0))
        r, flat_radius = tool.corner_radius, tool.radius - tool.corner_radius
        return tip[:, 2] + r * axis[:, 2] - flat_radius * side - r >= -1e-9

    return query


def wall(lean: float, count: int = 41, long: float = 40.0) -> GuideLine:
    """Return the line along the foot of a plane wall along x that leans away (over where negative) by degrees; free is at higher y."""
    a = math.radians(lean)
    at = (count, 3)
    return GuideLine(
        point=np.column_stack([np.linspace(long, 0.0, count), np.zeros((count, 2))]),
        normal=np.broadcast_to([0.0, math.cos(a), math.sin(a)], at),
        ruling=np.broadcast_to([0.0, -math.sin(a), math.cos(a)], at),
        face=np.ones(count, dtype=np.int64),
    )


def arc(lean: float, radius: float = 20.0, count: int = 1200) -> GuideLine:
    """Return a closed line round a conical pocket of a radius there."""
    a, turn = math.radians(lean), np.linspace(0.0, 2.0 * math.pi, count)
    out = np.column_stack([np.cos(turn), np.sin(turn)])
    one = np.ones(count)
    return GuideLine(
        point=np.column_stack([radius * out, np.zeros(count)]),
        normal=np.column_stack([-math.cos(a) * out, math.sin(a) * one]),
        ruling=np.column_stack([math.sin(a) * out, math.cos(a) * one]),
        face=np.ones(count, dtype=np.int64),
        closed=True,
    )


@pytest.mark.parametrize("lean", [-7.0, 0.0, 11.0])
def test_a_flank_lies_on_a_plane_in_one_block(lean: float) -> None:
    tool = bull(10.0, 2.0)()
    made = flank_passes([wall(lean)], tool, 0.0, free, 0.002)
    (one,) = made.passes
    assert len(one) == 2 and made.done == pytest.approx(made.whole) == pytest.approx(40.0)
    normal = wall(lean).normal[0]
    # The middle line of the flank keeps the radius from the plane at both ends of its flutes.
    for up in (tool.corner_radius, tool.flute_length):
        assert (one.tip + up * one.axis) @ normal == pytest.approx(5.0, abs=1e-9)


def test_an_allowance_keeps_the_flank_off() -> None:
    poses = poses_on(wall(5.0), flat(10.0)(), 0.7)
    assert poses.tip @ wall(5.0).normal[0] == pytest.approx(5.7, abs=1e-9)


@pytest.mark.parametrize("lean", [-6.0, 0.0, 8.0])
def test_blocks_round_a_cone_stay_within_their_chord_error(lean: float) -> None:
    tool, line = bull(10.0, 2.0)(), arc(lean)
    (one,) = flank_passes([line], tool, 0.0, free, 0.002).passes
    assert one.closed and 100 < len(one) < 600
    share = np.linspace(0.0, 1.0, 9)[1:-1]
    axis = slerp(
        *(np.repeat(v, len(share), axis=0) for v in (one.axis[:-1], one.axis[1:])),
        np.tile(share, len(one) - 1),
    )
    tip = (one.tip[:-1, None] + share[:, None] * np.diff(one.tip, axis=0)[:, None]).reshape(-1, 3)
    # A point at height z on the middle line is as far from the cone as its radius there less its own, seen along the normal.
    a = math.radians(lean)
    for up in (tool.corner_radius, tool.flute_length):
        middle = tip + up * axis
        cone = 20.0 + middle[:, 2] * math.tan(a)
        off = (cone - np.hypot(middle[:, 0], middle[:, 1])) * math.cos(a) - tool.radius
        assert np.abs(off).max() <= 0.002 + 0.0005


@pytest.mark.parametrize("lean", [-9.0, -3.0, 4.0])
def test_a_flank_is_lifted_until_its_end_is_over_the_floor(lean: float) -> None:
    tool = bull(12.0, 3.0)()
    line = wall(lean)
    found = lifts(line, tool, 0.0, over_floor(tool), tool.diameter)
    # At the foot of a fillet of the corner's radius: where the wall leans away the end comes lowest at the wall.
    a = math.radians(abs(lean))
    lowest = poses_on(line, tool)
    low = lowest.tip[0, 2] + 3.0 * math.cos(a) - 3.0 * math.sin(a) - 3.0
    assert found == pytest.approx(-low / math.cos(a), abs=0.01)


def test_a_ball_needs_no_lift_where_the_fillet_is_as_round() -> None:
    tool, a = bull(6.0, 3.0)(), math.radians(8.0)
    line = wall(-8.0)
    # Where a fillet of 3 mm ends on the wall, its middle is 3 mm over the floor.
    line = line.at(line.point + [0.0, 0.0, 3.0 * (1.0 + math.sin(a))])
    assert lifts(line, tool, 0.0, over_floor(tool), 6.0).max() <= 0.01


def test_lifts_go_evenly_between_few_positions() -> None:
    tool = flat(10.0)()
    line = wall(-5.0)
    bump = np.zeros(len(line))
    bump[17], bump[25] = 0.5, 0.8

    def query(tip: Floats, axis: Floats, **_: Floats):
        rows = np.rint(np.clip((40.0 - tip[:, 0]), 0.0, 40.0)).astype(int)
        return tip[:, 2] >= poses_on(line, tool).tip[0, 2] + bump[rows] * axis[:, 2]

    found = lifts(line, tool, 0.0, query, 5.0)
    assert (found >= bump).all() and (np.diff(found, 2) <= 1e-9).all()


def test_where_something_is_in_the_way_passes_have_gaps() -> None:
    def query(tip: Floats, axis: Floats, *, start_tip: Floats | None = None, start_axis=None):
        x = tip[:, 0]
        if start_tip is None:
            return np.abs(x - 20.0) > 3.0
        # A long block is blocked if anything between is.
        low, high = np.minimum(x, start_tip[:, 0]), np.maximum(x, start_tip[:, 0])
        return (high < 17.0) | (low > 23.0)

    made = flank_passes([wall(5.0)], flat(10.0)(), 0.0, query, 0.002)
    assert len(made.passes) == 2
    assert made.done / made.whole == pytest.approx(0.83, abs=0.05)


def test_a_closed_line_with_a_gap_is_one_open_stretch() -> None:
    clear = np.ones(11, dtype=bool)
    assert stretches(clear, closed=True)[0][1]
    clear[4] = False
    ((rows, closed),) = stretches(clear, closed=True)
    assert rows.tolist() == [5, 6, 7, 8, 9, 0, 1, 2, 3] and not closed


@pytest.mark.parametrize("height", [8.0, 20.0, 33.0, 61.0])
@pytest.mark.parametrize("leans", [(5.0,) * 4, (6.0, -4.0, 0.0, 3.0)])
def test_walls_are_cut_over_all_their_height(height: float, leans: tuple[float, ...]) -> None:
    # Nothing is roughed: the neck goes where the flutes were on the passes above.
    skin = funnel(leans, height=height)
    tool = replace(bull(8.0, 1.0)(flute=15.0), neck_length=80.0, stickout=90.0, gauge_length=150.0)
    drive, setup, stock = driven(skin, faces=(1, 2, 3, 4), top=height)
    drive = replace(drive, query_for=lambda _: free)
    path = swarf(drive, tool, DATA, stock, setup, SwarfSettings()).path
    cut = np.array([m is Mark.CUT or m == Mark.CUT for m in path.mark])
    axis = path.axis[cut]
    # Where the flank begins, but for how far its middle line is beside the wall, and how far up it reaches from there.
    begins = (path.position[cut] + tool.corner_radius * axis)[:, 2]
    beside = tool.radius * math.sin(math.radians(max(leans)))
    reach = tool.flute_length - tool.corner_radius
    lowest = np.unique(np.round(begins, 3))
    assert lowest[0] == pytest.approx(0.0, abs=beside + 0.01)
    assert (np.diff(lowest) <= reach).all() and lowest[-1] + reach >= height
    # From the top down: no neck is where no flank has been.
    assert (np.diff(begins) <= 2.0 * beside).all()


def test_swarf_milling_needs_rotary_axes() -> None:
    drive, setup, stock = driven(grid(lambda x, y: 0.0 * x))
    with pytest.raises(Refused, match="rotary axes"):
        swarf(drive, flat(10.0)(), DATA, stock, setup, SwarfSettings())


def test_a_cutter_that_is_too_short_goes_all_the_way_and_the_proof_tells() -> None:
    """Its holder would be in stock nearly everywhere: trimmed to nothing it would be as silent as it is useless."""
    skin = funnel((5.0,) * 4, height=30.0)
    drive, setup, stock = driven(skin, faces=(1, 2, 3, 4), top=30.0)
    drive = replace(drive, query_for=lambda _: free)
    short = bull(8.0, 1.0)(flute=15.0)
    long = replace(short, neck_length=80.0, stickout=90.0, gauge_length=150.0)
    found, expected = (
        swarf(drive, tool, DATA, stock, setup, SwarfSettings()) for tool in (short, long)
    )
    cut, all_cut = (p.path.position[p.path.mark == Mark.CUT] for p in (found, expected))
    assert not found.findings and np.array_equal(cut, all_cut)


def test_feet_are_cut_where_an_earlier_cutter_has_made_way(monkeypatch) -> None:
    monkeypatch.setattr("trunnion.toolpath.surface.swarf.LEAST_SHARE", 0.0)
    height = 20.0
    skin = funnel((5.0,) * 4, height=height)
    wide = replace(bull(8.0, 1.0)(flute=30.0), gauge_length=150.0, stickout=90.0, neck_length=80.0)
    slim = replace(wide, flute_length=6.0)
    drive, setup, stock = driven(skin, faces=(1, 2, 3, 4), top=height)
    drive = replace(drive, query_for=lambda _: free)
    above = swarf(drive, wide, DATA, stock, setup, SwarfSettings()).path
    blind = swarf(drive, slim, DATA, stock, setup, SwarfSettings(feet=True))
    assert not len(blind.path) and [f.code for f in blind.findings] == ["swarf.left"]
    known = replace(drive, leaning_cuts=(LeaningCut(above, wide, drive.frame),))
    seeing = swarf(known, slim, DATA, stock, setup, SwarfSettings(feet=True))
    assert len(seeing.path) and not seeing.findings
