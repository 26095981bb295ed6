"""Passes trimmed to where stock stands: what is left out takes nothing, and what whole passes take the pieces take."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from programs import LINE, RAPID, path_of
from surface_drives import DATA, driven, grid, roughed
from trunnion.geometry.kernels.stock_points import UNCUT, cut_points, cut_points_reference
from trunnion.model.motion.toolpath import Mark
from trunnion.plan.freeform.reach import samples_on
from trunnion.progress import NO_PROGRESS
from trunnion.toolpath.contact_passes.passes import UPRIGHT, Pass
from trunnion.toolpath.contact_passes.upright.stock_trimming import trimmed_to_stock
from trunnion.toolpath.stock.stock_reads import EVERYWHERE
from trunnion.toolpath.surface.waterline import WaterlineSettings, waterline
from verify_tools import bull

BALL = bull(5.0, 2.5)(flute=15.0)
FEED = 1000.0
GAP = 0.4 * FEED / 60.0


def in_lists(points, cell):
    """Return the corner, the first points by cell and the following ones of points (k, 3)."""
    corner = points[:, :2].min(axis=0)
    at = np.floor((points[:, :2] - corner) / cell).astype(np.int64)
    first, following = np.full(at.max(axis=0) + 1, -1), np.empty(len(points), np.int64)
    for k, (i, j) in enumerate(at.tolist()):
        following[k], first[i, j] = first[i, j], k
    return corner, first, following


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize(("radius", "corner"), [(2.5, 2.5), (3.0, 0.0), (4.0, 1.0)])
def test_the_compiled_kernel_and_the_plain_one_agree(seed, radius, corner):
    pick = np.random.default_rng(seed)
    points = pick.uniform((0.0, 0.0, 0.0), (30.0, 20.0, 6.0), (400, 3))
    starts = pick.uniform((-4.0, -4.0, 0.0), (34.0, 24.0, 6.0), (12, 3))
    ends = starts + pick.normal(0.0, 6.0, (12, 3)) * [1.0, 1.0, 0.2]
    ends[3, :2] = starts[3, :2]
    by, plain = np.full(400, UNCUT), np.full(400, UNCUT)
    by[:20] = plain[:20] = 0
    at, first, following = in_lists(points, 1.5)
    cut_points(points, first, following, *at, 1.5, starts, ends, radius, corner, by)
    cut_points_reference(points, starts, ends, radius, corner, plain)
    assert (by == plain).all() and (by == UNCUT).any() and len(np.unique(by)) > 4


def along(y, z=0.0, start=-5.0, end=35.0):
    tips = np.array([[start, y, z], [end, y, z]])
    return Pass(tip=tips, axis=np.tile(UPRIGHT, (2, 1)), normal=np.tile(UPRIGHT, (2, 1)))


def floor(left=0.3, top=20.0):
    """Return the drive of a level floor, and the stock that roughing left some mm high on it."""
    skin = grid(lambda x, y: 0.0 * x, n=8)
    drive, _, stock = driven(skin, height=0.05, allowance=0.1, top=top)
    return drive, roughed(stock, skin, left=left), samples_on(skin, (1,), 20000)


def trimmed(passes, drive, stock, samples):
    return trimmed_to_stock(passes, samples, drive, BALL, stock, FEED, NO_PROGRESS)


def test_over_what_stands_everywhere_passes_are_whole_but_for_what_runs_past_the_area():
    drive, stock, samples = floor()
    (made,) = trimmed([along(15.0, 0.1)], drive, stock, samples)
    assert len(made) == 2 and (made.tip[:, 1:] == [15.0, 0.1]).all()
    # A ball at 0.1 reaches 0.15 at half a millimetre from its middle.
    assert -1.5 < made.tip[0, 0] < 0.5 and 29.5 < made.tip[1, 0] < 31.5


def test_what_stands_no_higher_than_the_scallops_is_left_alone():
    drive, stock, samples = floor(left=0.14)
    assert not trimmed([along(15.0, 0.1)], drive, stock, samples)


def test_a_pass_that_another_has_done_is_left_out_and_half_done_it_is_cut_by_half():
    drive, stock, samples = floor()
    first = along(15.0, 0.1)
    assert len(trimmed([first, first], drive, stock, samples)) == 1
    half = along(15.0, 0.1, start=-5.0, end=15.0)
    one, rest = trimmed([half, first], drive, stock, samples)
    assert one.tip[-1, 0] <= 15.0 and 14.0 < rest.tip[0, 0] < 16.0 and len(rest) == 2


def test_what_paths_before_have_cut_is_gone_to_the_hair_whatever_the_cells_of_the_stock_know():
    drive, _, samples = floor()
    _, _, stock = driven(drive.skin, top=0.3)
    rows = [(-5.0, y) for y in np.arange(0.0, 31.0, 3.0)]
    moves = [
        m
        for x, y in rows
        for m in ((RAPID, x, y, 5.0), (LINE, x, y, 0.12, FEED), (LINE, 35.0, y, 0.12, FEED))
    ]
    cut = stock.after(path_of(*moves), bull(6.0, 0.0)(flute=20.0))
    assert not trimmed([along(15.0, 0.1)], drive, cut, samples)
    assert trimmed([along(15.0, 0.1)], drive, stock, samples)


def test_a_pointed_tool_has_cut_no_more_than_from_where_it_has_its_whole_width():
    drive, _, samples = floor()
    _, _, stock = driven(drive.skin, top=0.3)
    moves = [
        m
        for y in np.arange(0.0, 31.0, 3.0)
        for m in ((RAPID, -5.0, y, 5.0), (LINE, -5.0, y, 0.12, FEED), (LINE, 35.0, y, 0.12, FEED))
    ]
    pointed = replace(bull(6.0, 0.0)(flute=20.0), form="drill", point_angle=118.0)
    assert pointed.full_width_height > 0.5
    cut = stock.after(path_of(*moves), pointed)
    assert trimmed([along(15.0, 0.1)], drive, cut, samples)


def test_what_was_cut_anywhere_is_taken_down_as_looked_at():
    drive, stock, samples = floor()
    watched = stock.recorded()
    trimmed([along(15.0, 0.1)], drive, watched, samples)
    assert watched.box_read() == EVERYWHERE


@pytest.mark.parametrize(("wide", "pieces"), [(0.5 * GAP, 1), (2.0 * GAP, 2)])
def test_short_gaps_are_fed_through(wide, pieces):
    drive, stock, samples = floor()
    x = stock.corner[0] + (np.arange(len(stock.heights)) + 0.5) * stock.cell
    heights = stock.heights.copy()
    heights[np.abs(x - 15.0) < 0.5 * wide] = 0.1
    made = trimmed([along(15.0, 0.1)], drive, replace(stock, field=heights), samples)
    assert len(made) == pieces


def test_a_speck_is_left_to_the_next_operation_but_counts_for_the_passes_after():
    drive, stock, samples = floor()
    x = stock.corner[0] + (np.arange(len(stock.heights)) + 0.5) * stock.cell
    heights = stock.heights.copy()
    heights[np.abs(x - 15.0) > 0.3] = 0.1
    stock = replace(stock, field=heights)
    narrow = along(16.1, 0.1495)
    assert not trimmed([narrow], drive, stock, samples)
    assert len(trimmed([narrow, along(16.1, 0.1)], drive, stock, samples)) == 1


def ring(z, radius=10.0):
    angle = np.linspace(0.0, 2.0 * np.pi, 73)
    tips = np.column_stack(
        [15.0 + radius * np.cos(angle), 15.0 + radius * np.sin(angle), np.full(73, z)]
    )
    tips[-1] = tips[0]
    return Pass(
        tip=tips, axis=np.tile(UPRIGHT, (73, 1)), normal=np.tile(UPRIGHT, (73, 1)), closed=True
    )


def test_a_closed_pass_stays_one_where_stock_stands_all_round_and_opens_where_it_does_not():
    drive, stock, samples = floor()
    whole = ring(0.1)
    assert trimmed([whole], drive, stock, samples) == [whole]
    x = stock.corner[0] + (np.arange(len(stock.heights)) + 0.5) * stock.cell
    for side in (1.0, -1.0):
        heights = stock.heights.copy()
        heights[side * (x - 15.0) > 0.0] = 0.1
        (made,) = trimmed([whole], drive, replace(stock, field=heights), samples)
        assert not made.closed and 0.45 < made.length / whole.length < 0.55
        assert (side * (made.tip[:, 0] - 15.0)).max() < 2.0


@pytest.mark.parametrize("seed", range(8))
def test_pieces_take_what_whole_passes_take(seed):
    pick = np.random.default_rng(seed)
    drive, stock, samples = floor(left=0.4)
    heights = stock.heights.copy()
    for low in pick.integers(0, 50, (6, 2)):
        heights[low[0] : low[0] + 12, low[1] : low[1] + 12] = pick.choice([0.1, 0.2])
    stock = replace(stock, field=heights)
    passes = [
        Pass(
            tip=np.column_stack(
                [pick.uniform(-3.0, 33.0, 6), pick.uniform(-3.0, 33.0, 6), np.full(6, 0.1)]
            ),
            axis=np.tile(UPRIGHT, (6, 1)),
            normal=np.tile(UPRIGHT, (6, 1)),
        )
        for _ in range(5)
    ]
    made = trimmed(passes, drive, stock, samples)
    points = samples.point + 0.15 * samples.normal
    cell = np.floor((points[:, :2] - stock.corner) / stock.cell).astype(int)
    stands = heights[tuple(cell.T)] > points[:, 2]
    taken = []
    for some in (passes, made):
        by = np.full(len(points), UNCUT)
        for one in some:
            cut_points_reference(points, one.tip[:-1], one.tip[1:], 2.5, 2.5, by)
        taken.append(stands & (by != UNCUT))
    missed = (taken[0] & ~taken[1]).sum() * samples.area
    assert missed <= 0.25 * len(passes) and not (taken[1] & ~taken[0]).any()
    assert sum(p.length for p in made) < sum(p.length for p in passes)


@pytest.mark.parametrize("way", ["climb", "both"])
def test_waterlines_are_cut_where_stock_stands_alone(way):
    hill = grid(lambda x, y: 9.0 * np.exp(-((x - 15.0) ** 2 + (y - 15.0) ** 2) / 40.0), n=60)
    drive, setup, stock = driven(hill, height=0.05, allowance=0.1, top=20.0)
    stock = roughed(stock, hill, left=0.6)
    heights = stock.heights.copy()
    x = stock.corner[0] + (np.arange(len(heights)) + 0.5) * stock.cell
    heights[x > 15.0] = -1.0
    stock = replace(stock, field=heights)
    settings = WaterlineSettings(chord=0.005, shallowest=30.0, way=way)
    whole, made = (
        waterline(drive, BALL, DATA, stock, setup, replace(settings, trim=trim), NO_PROGRESS).path
        for trim in (False, True)
    )
    cuts = [path.position[path.mark == Mark.CUT] for path in (whole, made)]
    assert cuts[0][:, 0].max() > 20.0 and len(cuts[1]) < 0.7 * len(cuts[0])
    # Only rings so short that gaps in them are fed through are cut farther past the middle than the ball reaches.
    assert (cuts[1][:, 0] > 15.0 + 2.5).mean() < 0.1
    assert cuts[1][:, 0].min() == pytest.approx(cuts[0][:, 0].min(), abs=0.5)
    left = [stock.after(path, BALL).heights for path in (whole, made)]
    assert np.abs(left[1] - left[0])[x < 14.0].max() < 0.2
