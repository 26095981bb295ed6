"""Links of a leaning tool to passes that begin with another axis: over the surface, by their leads, low through the air, or over all."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from surface_drives import DATA, driven, grid
from trunnion.geometry.frame import WORLD
from trunnion.model.blank import Box
from trunnion.model.motion.toolpath import Mark, Motion
from trunnion.progress import NO_PROGRESS
from trunnion.toolpath.contact_passes.linking.leaning_links import MOST_TURN
from trunnion.toolpath.contact_passes.linking.link_passes import linked
from trunnion.toolpath.contact_passes.linking.parameters import LinkParameters
from trunnion.toolpath.contact_passes.linking.pass_order import ordered
from trunnion.toolpath.contact_passes.passes import UPRIGHT, Pass
from trunnion.toolpath.contact_passes.stock_clearance import StockClearance
from trunnion.toolpath.stock.remaining import NEAR
from trunnion.toolpath.stock.voxels import StockVoxels
from verify_tools import bull

BALL = bull(6.0, 3.0)()
MANNER = LinkParameters(stepover=0.5, lead_radius=1.0, turn=math.radians(10.0))


def leant(degrees, towards=(1.0, 0.0)):
    lean = math.radians(degrees)
    return np.array([math.sin(lean) * towards[0], math.sin(lean) * towards[1], math.cos(lean)])


def straight(start, end, axis):
    tips = np.array([start, end], dtype=float)
    return Pass(tip=tips, axis=np.tile(axis, (2, 1)), normal=np.tile(UPRIGHT, (2, 1)))


def everywhere(tip, axis, **_):
    return np.ones(len(tip), dtype=bool)


class Air:
    """Air that is clear above a height; the tool is fed out by 0.5 mm."""

    def __init__(self, height):
        self.height = height

    def retreats(self, tip, axis):
        return np.full(len(tip), 0.5)

    def is_free_between(self, start_tip, start_axis, tip, axis):
        return np.minimum(start_tip[:, 2], tip[:, 2]) >= self.height


def made(passes, manner):
    drive, setup, stock = driven(grid(lambda x, y: 0.0 * x, n=4))
    return linked(passes, drive, BALL, DATA, stock, setup, manner), setup


def link_of(path):
    """Return the rows of a path from the end of its first pass to the start of its second one."""
    first, second = np.flatnonzero(path.mark == Mark.CUT)
    return slice(first, second)


def side_by_side(turn, apart=1.0):
    """Return two passes, the second of which begins beside the end of the first, the tool turned by some degrees."""
    return [
        straight((5, 5, 0), (25, 5, 0), leant(20.0)),
        straight((25, 5 + apart, 0), (5, 5 + apart, 0), leant(20.0 + turn)),
    ]


def test_an_axis_that_turns_little_is_turned_on_the_way_over_the_surface() -> None:
    path, _ = made(side_by_side(9.0), replace(MANNER, query=everywhere, link_clearance=Air(0.0)))
    assert Motion.RAPID not in path.motion[link_of(path)]
    link = path.mark == Mark.LINK
    assert link.sum() == 1 and path.position[link][0] == pytest.approx([25.0, 6.0, 0.0])
    assert path.axis[link][0] == pytest.approx(leant(29.0))


def test_an_axis_that_turns_more_is_turned_between_the_leads() -> None:
    path, _ = made(side_by_side(30.0), replace(MANNER, query=everywhere, link_clearance=Air(0.0)))
    assert Motion.RAPID not in path.motion[link_of(path)]
    turning = np.flatnonzero(np.abs(np.diff(path.axis, axis=0)).max(axis=1) > 1e-9)
    assert len(turning) == 1
    assert path.position[turning[0] : turning[0] + 2, 2] == pytest.approx([1.0, 1.0])
    assert (path.mark[turning[0] : turning[0] + 2] == Mark.LINK).all()


@pytest.mark.parametrize("why", ["far", "turned", "no leads", "not clear"])
def test_elsewhere_the_tool_is_led_through_the_air_as_low_as_is_clear(why) -> None:
    def never_across(tip, axis, *, start_tip=None, start_axis=None):
        return np.abs(start_axis - axis).max(axis=1) < 1e-9

    passes = side_by_side(
        math.degrees(MOST_TURN) + 1.0 if why == "turned" else 30.0, 8.0 if why == "far" else 1.0
    )
    manner = replace(
        MANNER,
        lead_radius=0.0 if why == "no leads" else 1.0,
        query=never_across if why == "not clear" else everywhere,
        link_clearance=Air(4.0),
    )
    path, setup = made(passes, manner)
    rows = link_of(path)
    tip, axis, rapid = path.position[rows], path.axis[rows], path.motion[rows] == Motion.RAPID
    # Fed off as far as its air wants and on again; in between, at rapid, as high as it must be, where the axis turns.
    turns = np.flatnonzero(np.abs(np.diff(axis, axis=0)).max(axis=1) > 1e-9)
    assert len(turns) == 1 and rapid[turns[0] + 1]
    across = tip[turns[0] : turns[0] + 2, 2]
    assert across.min() >= 4.0 and across.max() < 11.0 < setup.clearance
    lead = 0.0 if why == "no leads" else 1.0
    first, last = np.flatnonzero(rapid)[[0, -1]]
    assert tip[first - 1] == pytest.approx([25.0 + lead, 5.0, lead] + 0.5 * axis[0])
    assert tip[last] == pytest.approx([25.0 + lead, passes[1].tip[0, 1], lead] + 0.5 * axis[-1])


def test_where_no_air_is_clear_the_tool_goes_over_everything() -> None:
    manner = replace(MANNER, query=everywhere, link_clearance=Air(1000.0))
    path, setup = made(side_by_side(30.0, apart=8.0), manner)
    turns = np.flatnonzero(np.abs(np.diff(path.axis, axis=0)).max(axis=1) > 1e-9)
    assert len(turns) == 1
    assert path.position[turns[0] : turns[0] + 2, 2].min() >= setup.clearance


def scattered(count, seed=4):
    """Return short passes in any order, all to the same side."""
    pick = np.random.default_rng(seed)
    starts = np.column_stack([pick.uniform(0.0, 30.0, (count, 2)), np.zeros(count)])
    return [
        straight(s, s + [0.5, 0.0, 0.0], leant(pick.uniform(0.0, 60.0), (math.sin(k), math.cos(k))))
        for k, s in enumerate(starts)
    ]


def way_between(passes):
    return sum(
        np.linalg.norm(b.tip[0] - a.tip[-1]) + np.linalg.norm(b.axis[0] - a.axis[-1]) / MANNER.turn
        for a, b in pairwise(passes)
    )


def nearest_of_all(passes, manner):
    """Return the passes in the order of the nearest ends, by all distances."""
    out, left = [passes[0]], list(passes[1:])
    while left:
        here = out[-1]

        def away(tip, axis, here=here):
            return math.hypot(
                np.linalg.norm(tip - here.tip[-1]),
                np.linalg.norm(axis - here.axis[-1]) / manner.turn,
            )

        one = min(left, key=lambda p: away(p.tip[0], p.axis[0]))
        out.append(one)
        left = [p for p in left if p is not one]
    return out


def test_scattered_passes_are_cut_in_the_order_that_turns_and_moves_the_tool_less() -> None:
    passes, manner = scattered(150), replace(MANNER, order="shorter")
    found = ordered(passes, manner, NO_PROGRESS)
    assert [id(p) for p in found] == [id(p) for p in nearest_of_all(passes, manner)]
    assert way_between(found) < 0.3 * way_between(passes)


def test_an_order_that_is_shorter_than_the_nearest_stays() -> None:
    """From the middle, the nearest passes leave one behind on the other side."""
    along = [0.0, 1.1, -1.0, -3.2]
    passes = [straight((x, 0, 0), (x, 1e-3, 0), leant(10.0)) for x in along]
    nearest = ordered(passes, replace(MANNER, order="nearest"), NO_PROGRESS)
    assert [p.tip[0, 0] for p in nearest] == [0.0, -1.0, 1.1, -3.2]
    assert ordered(passes, replace(MANNER, order="shorter"), NO_PROGRESS) == passes


def rapids_among_stock(query_for=None):
    """Return the air of a ball over a level part, a ridge of stock 10 mm high left from x = 14 to 16."""
    blank = Box(
        frame=WORLD,
        low=np.array([14.0, 0.0, 0.0]),
        high=np.array([16.0, 30.0, 10.0]),
        material="7050-T7451",
        density=2.83,
    )
    skin = grid(lambda x, y: 0.0 * x, n=30)
    drive, *_ = driven(skin)
    drive = replace(
        drive,
        remaining_stock=StockVoxels.of(blank, skin, NEAR).remaining(WORLD, leaning=False),
        query_for=query_for or (lambda tool: everywhere),
    )
    return StockClearance(drive, BALL, 1.0)


def between(air, start, first, end, last):
    poses = (np.array([v], dtype=float) for v in (start, first, end, last))
    return bool(air.is_free_between(*poses)[0])


def test_rapids_keep_the_tip_and_the_holder_out_of_what_stands() -> None:
    air = rapids_among_stock()
    up = leant(0.0)
    assert not between(air, (5, 15, 2), up, (25, 15, 2), up)
    assert between(air, (5, 15, 13), up, (25, 15, 13), up)
    assert between(air, (5, 15, 2), up, (5, 25, 2), up)
    # The tip stays on its side; the tool leans over to the other one and back, through the ridge.
    apart = (leant(40.0, (-1.0, 0.0)), leant(80.0, (1.0, 0.0)))
    assert not between(air, (5, 15, 2), apart[0], (5, 16, 2), apart[1])


def test_rapids_are_asked_for_all_along_as_a_tool_that_is_thicker() -> None:
    asked = []

    def query_for(tool):
        def query(tip, axis, *, start_tip=None, start_axis=None):
            asked.append((tool.diameter, tip, axis, start_tip, start_axis))
            return tip[:, 0] < 20.0

        return query

    air = rapids_among_stock(query_for)
    first, last = leant(0.0), leant(45.0, (0.0, 1.0))
    assert between(air, (5, 15, 40), first, (5, 15, 60), last)
    (diameter, tip, axis, start_tip, start_axis), *_ = asked
    assert diameter == pytest.approx(BALL.diameter + 2.0) and len(tip) == 5
    assert start_tip[1:] == pytest.approx(tip[:-1]) and start_axis[1:] == pytest.approx(axis[:-1])
    assert axis[-1] == pytest.approx(last) and tip[-1] == pytest.approx((5, 15, 60) - last)
    assert not between(air, (5, 15, 40), first, (30, 15, 60), last)
