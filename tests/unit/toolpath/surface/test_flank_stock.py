"""Leads off flank passes: neck and shank go where flutes have been, or over the stock."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import cKDTree

from funnels import funnel
from long_mark import mostly_long
from surface_drives import DATA, driven, grid
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.frame import WORLD
from trunnion.geometry.kernels.flutes import bodies_free_reference
from trunnion.model.motion.toolpath import Mark, Motion, Toolpath
from trunnion.model.tool import Tool
from trunnion.toolpath.contact_passes.flank.flank_stock import FlankStock, moves_of, pieces
from trunnion.toolpath.contact_passes.flank.flank_trimming import LOOK_STEP, passes_off_stock
from trunnion.toolpath.contact_passes.linking.link_passes import linked_in_order
from trunnion.toolpath.contact_passes.linking.parameters import LinkParameters
from trunnion.toolpath.contact_passes.passes import Pass
from trunnion.toolpath.contact_passes.stock_clearance import StockClearance
from trunnion.toolpath.contact_passes.tool_moves import ToolMoves
from trunnion.toolpath.stock.flute_cuts import INSIDE, FluteCuts, frames_of
from trunnion.toolpath.stock.leaning_cuts import LeaningCut, flutes_of
from trunnion.toolpath.surface.swarf import SwarfSettings, swarf
from verify_tools import bull

TOOL = replace(
    bull(8.0, 1.0)(flute=6.0),
    neck_diameter=7.5,
    neck_length=25.0,
    shank_diameter=8.0,
    stickout=40.0,
    gauge_length=90.0,
)
"""Flutes of 6 mm with a neck 0.25 mm thinner all round behind them."""
TOP = 20.0


def leaning(lean: float) -> Floats:
    """Return the axis (3,) of a tool that leans by degrees to y."""
    return np.array([0.0, math.sin(math.radians(lean)), math.cos(math.radians(lean))])


def along(axis: Floats, depth: float, start: float = 5.0, end: float = 20.0) -> Pass:
    """Return a pass along x whose tip is so many mm along its axis below the top of the stock."""
    foot = np.array([0.0, 15.0, TOP]) - depth * axis
    at = (2, 3)
    return Pass(
        tip=foot + np.array([[start, 0.0, 0.0], [end, 0.0, 0.0]]),
        axis=np.broadcast_to(axis, at),
        normal=np.broadcast_to([0.0, 1.0, 0.0], at),
    )


def blocks(top: float = TOP):
    """Return a drive over a floor at 0, its setup, and a stock that stands up to a height over it."""
    return driven(grid(lambda x, y: 0.0 * x), top=top)


@pytest.mark.parametrize("lean", [-9.0, 0.0, 7.0])
def test_a_neck_goes_where_the_pass_above_was(lean: float) -> None:
    _, _, stock = blocks()
    axis = leaning(lean)
    passes = [along(axis, 5.0), along(axis, 10.5)]
    beside = FlankStock.after(passes, TOOL, stock)
    tips = passes[1].tip[:1] + np.array([[0.0, 0.0, 0.0], [9.0, 0.0, 0.0], [15.0, 0.0, 0.0]])
    axes = np.broadcast_to(axis, tips.shape)
    assert beside.is_free(tips, axes, np.ones(3, int)).all()
    assert not beside.is_free(tips, axes, np.zeros(3, int)).any()
    # A lead of a millimetre past the end of both.
    on = tips[2:] + [1.0, 0.0, 0.0]
    assert not beside.is_free(on, axes[:1], np.ones(1, int)).any()
    longer = FlankStock.after([along(axis, 5.0, end=21.0), passes[1]], TOOL, stock)
    assert longer.is_free(on, axes[:1], np.ones(1, int)).all()


def test_no_deeper_than_the_flutes_nothing_is_in_a_neck_s_way() -> None:
    _, _, stock = blocks()
    one = along(leaning(0.0), 5.9)
    assert FlankStock.after([one], TOOL, stock).is_free(one.tip, one.axis, np.zeros(2, int)).all()


class Points:
    """What stands, as points in a fine grid."""

    def __init__(self, low: Floats, high: Floats, step: float) -> None:
        axes = [np.arange(a, b, step) for a, b in zip(low, high, strict=True)]
        self.points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
        self.tree = cKDTree(self.points)
        self.stands = np.ones(len(self.points), dtype=bool)

    def cut(self, rows: Floats, tips: Floats, axes: Floats) -> None:
        """Take off what a body of cones holds at poses."""
        for tip, axis in zip(tips, axes, strict=True):
            self.stands[self._held(rows, tip, axis)] = False

    def met(self, rows: Floats, tips: Floats, axes: Floats) -> Bools:
        """Return at which poses a body of cones holds any."""
        return np.array([len(self._held(rows, t, a)) > 0 for t, a in zip(tips, axes, strict=True)])

    def _held(self, rows: Floats, tip: Floats, axis: Floats) -> Ints:
        found = []
        for z0, r0, z1, r1 in rows:
            near = self.tree.query_ball_point(
                tip + 0.5 * (z0 + z1) * axis, math.hypot(0.5 * (z1 - z0), max(r0, r1))
            )
            near = np.array(near, dtype=np.int64)
            near = near[self.stands[near]]
            off = self.points[near] - tip
            up = off @ axis
            away = np.sqrt(np.maximum((off * off).sum(axis=1) - up * up, 0.0))
            wide = r0 + (up - z0) / max(z1 - z0, 1e-9) * (r1 - r0)
            found.append(near[(up >= z0) & (up <= z1) & (away < wide)])
        return np.concatenate(found)


def flutes(tool: Tool) -> Floats:
    """Return the cutting part of a tool as cones."""
    return flutes_of(tool, 0.0)


def above(tool: Tool, deeper: float) -> Floats:
    """Return what is above the flutes as cones, smaller by some mm all round."""
    return np.array(
        [(z0 + deeper, r0 - deeper, z1, r1 - deeper) for z0, r0, z1, r1 in tool.profile()]
    )


@pytest.mark.parametrize("seed", mostly_long(range(8), 0, 3, 5))
def test_what_is_free_holds_nothing_of_a_fine_grid_of_points(seed: int) -> None:
    pick = np.random.default_rng(seed)
    _, _, stock = blocks()
    passes = []
    for depth in np.sort(pick.uniform(2.0, 16.0, 5)):
        at = (3, 3)
        tip = along(leaning(0.0), float(depth)).tip.mean(axis=0) + pick.uniform(-4.0, 4.0, at)
        axis = np.array([leaning(a) for a in pick.uniform(-12.0, 12.0, 3)])
        passes.append(Pass(tip=tip, axis=axis, normal=np.broadcast_to([0.0, 1.0, 0.0], at)))
    beside = FlankStock.after(passes, TOOL, stock)
    stand = Points(np.array([0.0, 3.0, 0.0]), np.array([25.0, 27.0, TOP]), 0.5)
    found = []
    for k, one in enumerate(passes):
        tips = one.tip[:1] + pick.normal(0.0, 1.2, (12, 3))
        axes = np.repeat(one.axis[:1], 12, axis=0)
        free = beside.is_free(tips, axes, np.full(12, k))
        # Between two points the body may be a little in what flutes have left there.
        assert not (free & stand.met(above(TOOL, 0.1), tips, axes)).any()
        found += free.tolist()
        moves = ToolMoves(one.tip[:-1], one.axis[:-1], one.tip[1:], one.axis[1:])
        _, tips, axes = moves.poses(np.ceil(moves.travel / 0.2))
        stand.cut(flutes(TOOL), tips, axes)
    assert 0 < sum(found) < len(found)


def contacts(path: Toolpath, stand: Points, tool: Tool = TOOL) -> int:
    """Cut what stands along a path, and return on how many leads and links anything above the flutes meets it."""
    starts, turned_from = path.starts(), np.vstack([path.axis[:1], path.axis[:-1]])
    met = 0
    for k in range(1, len(path)):
        if path.motion[k] == Motion.RAPID:
            continue
        moves = ToolMoves(*(v[k : k + 1] for v in (starts, turned_from, path.position, path.axis)))
        _, tips, axes = moves.poses(np.ceil(moves.travel / 0.4 + 30.0 * moves.turn))
        # Flutes first: they are before the neck wherever both go.
        stand.cut(flutes(tool), tips, axes)
        if path.mark[k] != Mark.CUT:
            met += bool(stand.met(above(tool, 0.1), tips, axes).any())
    return met


@pytest.mark.parametrize("lean", [-6.0, 5.0])
def test_a_lead_that_the_one_above_had_no_space_for_is_left_out(lean: float) -> None:
    """Only over the lower pass there is space past its end: its neck would go where nothing has cut."""
    drive, setup, stock = blocks()
    axis = leaning(lean)
    passes = [along(axis, 5.0), along(axis, 10.5)]

    def query(tip: Floats, axis: Floats, **_: Floats) -> Bools:
        return (tip[:, 2] < passes[0].tip[0, 2] - 1.0) | (tip[:, 0] <= 20.0 + 1e-9)

    drive = replace(drive, query_for=lambda _: query)
    parameters = LinkParameters(
        stepover=5.5, query=query, link_clearance=StockClearance(drive, TOOL, 1.0)
    )
    made = [
        linked_in_order(
            passes, drive, TOOL, DATA, stock, setup, replace(parameters, pass_stock=beside)
        )
        for beside in (None, FlankStock.after(passes, TOOL, stock))
    ]
    low, high = np.array([0.0, 3.0, 0.0]), np.array([30.0, 27.0, TOP])
    blind, seeing = (contacts(path, Points(low, high, 0.35)) for path in made)
    assert blind and not seeing


ALIKE, VARIED = (5.0,) * 4, (6.0, -4.0, 0.0, 3.0)


@pytest.mark.parametrize("leans", mostly_long((ALIKE, VARIED), VARIED))
def test_leads_in_the_corners_of_a_pocket_meet_no_stock(leans: tuple[float, ...]) -> None:
    height = 12.0
    skin = funnel(leans, size=0.45, height=height)
    drive, setup, stock = driven(skin, faces=(1, 2, 3, 4), top=height)
    stock = replace(stock, field=np.minimum(stock.field, height))

    def free(tip: Floats, axis: Floats, **_: Floats) -> Bools:
        return np.ones(len(tip), dtype=bool)

    drive = replace(drive, query_for=lambda _: free)
    path = swarf(drive, TOOL, DATA, stock, setup, SwarfSettings()).path
    assert not contacts(path, Points(drive.low, np.append(drive.high[:2], height), 0.7))


@pytest.mark.parametrize("lean", [-6.0, 0.0, 5.0])
def test_a_pass_ends_where_those_above_do(lean: float) -> None:
    _, _, stock = blocks()
    axis = leaning(lean)
    passes = [along(axis, 5.0, start=7.0, end=18.0), along(axis, 10.5)]
    (first, second), _ = passes_off_stock(passes, TOOL, stock)
    assert first is passes[0]
    assert 7.0 - 0.3 <= second.tip[0, 0] <= 7.0 + LOOK_STEP and len(second) == 2
    assert 18.0 - LOOK_STEP <= second.tip[-1, 0] <= 18.0 + 0.3
    # A tool that came as deep before, farther along, leaves it its way.
    wide = along(axis, 5.0, start=4.0, end=21.0)
    before = LeaningCut(path=a_path(wide), tool=TOOL, frame=WORLD)
    (first, second), _ = passes_off_stock(passes, TOOL, stock, [before])
    assert (second.tip == passes[1].tip).all()


def a_path(one: Pass) -> Toolpath:
    """Return a pass as a path, reached at rapid."""
    n = len(one)
    return Toolpath(
        position=one.tip,
        axis=one.axis,
        motion=np.array([Motion.RAPID, *[Motion.LINE] * (n - 1)]),
        feed=np.array([0.0, *[100.0] * (n - 1)]),
        mark=np.full(n, Mark.CUT),
        centre=np.full((n, 3), np.nan),
    )


def test_a_closed_pass_begins_behind_what_is_left_out_of_it() -> None:
    _, _, stock = blocks()
    axis = leaning(0.0)
    corners = np.array([[5.0, 8.0], [20.0, 8.0], [20.0, 22.0], [5.0, 22.0], [5.0, 8.0]])
    at = (5, 3)
    lower = Pass(
        tip=np.column_stack([corners, np.full(5, TOP - 10.5)]),
        axis=np.broadcast_to(axis, at),
        normal=np.broadcast_to([0.0, 1.0, 0.0], at),
        closed=True,
    )
    upper = Pass(tip=lower.tip + [0.0, 0.0, 5.5], axis=lower.axis, normal=lower.normal, closed=True)
    whole, _ = passes_off_stock([upper, lower], TOOL, stock)
    assert whole[1] is lower
    # Nothing has cut above the second side.
    found, _ = passes_off_stock([upper.of([1, 0]), upper.of([3, 2]), lower], TOOL, stock)
    assert [p.closed for p in found[2:]] == [False, False]
    assert all(np.ptp(p.tip[:, 1]) < 0.3 for p in found[2:])
    sides = sorted(float(p.tip[:, 1].mean()) for p in found[2:])
    assert sides == pytest.approx([8.0, 22.0], abs=0.3)


@pytest.mark.parametrize("seed", mostly_long(range(8), 3))
def test_no_pass_that_is_left_meets_points_of_a_fine_grid(seed: int) -> None:
    pick = np.random.default_rng(seed)
    _, _, stock = blocks()
    passes = []
    for depth in np.arange(4.0, 16.0, 2.5):
        at = (4, 3)
        tip = along(leaning(0.0), float(depth)).tip.mean(axis=0) + pick.uniform(-0.4, 0.4, at)
        tip[:, 0] += np.linspace(-5.0, 5.0, 4)
        axis = np.array([leaning(a) for a in pick.uniform(-4.0, 4.0, 4)])
        passes.append(Pass(tip=tip, axis=axis, normal=np.broadcast_to([0.0, 1.0, 0.0], at)))
    kept, _ = passes_off_stock(passes, TOOL, stock)
    low, high = np.array([0.0, 3.0, 0.0]), np.array([25.0, 27.0, TOP])
    blind, seeing = (met(some, Points(low, high, 0.4)) for some in (passes, kept))
    assert blind and not seeing
    assert sum(p.length for p in kept) > 0.3 * sum(p.length for p in passes)


def met(passes: Sequence[Pass], stand: Points) -> int:
    """Cut what stands along passes, and return at how many poses anything above the flutes meets it."""
    found = 0
    for one in passes:
        _, tips, axes = moves_of(one).poses(pieces(moves_of(one), TOOL, 0.2))
        for k in range(len(tips)):
            stand.cut(flutes(TOOL), tips[k : k + 1], axes[k : k + 1])
            # Between two poses that were asked about and between points of the body a little is met.
            found += int(stand.met(above(TOOL, 0.15), tips[k : k + 1], axes[k : k + 1]).any())
    return found


@pytest.mark.parametrize("seed", mostly_long(range(6), 3))
def test_the_kernel_that_asks_where_flutes_have_been_and_the_plain_one_agree(seed: int) -> None:
    pick = np.random.default_rng(seed)
    cuts = FluteCuts.within(np.array([1.0, 0.0, -2.0]), np.array([13.0, 11.0, 9.0]), 1.7)
    kinds = [flutes_of(bull(d, r)(flute=5.0), INSIDE) for d, r in ((4.0, 0.5), (6.0, 2.0))]
    poses = []
    for number in range(5):
        tips, axes = pick.uniform(0.0, 12.0, (7, 3)), pick.normal(size=(7, 3))
        axes /= np.linalg.norm(axes, axis=1, keepdims=True)
        cuts.add(tips, axes, kinds[number % 2], number)
        poses.append((tips, axes, np.full(7, number), np.full(7, number)))
    cut_tips, cut_axes, numbers, kind = (np.concatenate(v) for v in zip(*poses, strict=True))
    _, _, stock = blocks(top=8.0)
    stock = replace(stock, field=np.where(pick.random(stock.field.shape) < 0.5, 8.0, 0.0))
    # In the box alone poses are listed.
    tips = pick.uniform([2.0, 1.0, -1.0], [12.0, 10.0, 8.0], (900, 3))
    axes, before = np.tile([0.0, 0.6, 0.8], (900, 1)), pick.integers(0, 6, 900)
    body = np.array([[0.0, 0.0, 0.0], [0.2, 0.1, 0.5]])
    found = cuts.is_free(body, stock, tips, axes, before)
    plain = bodies_free_reference(
        cut_tips,
        cut_axes,
        numbers,
        kind % 2,
        np.array(kinds),
        stock.field,
        stock.corner,
        stock.cell,
        tips,
        frames_of(axes),
        body,
        before,
    )
    assert (found == plain).all() and 0.2 < found.mean() < 0.9
