"""Paths over tabs: they rise before the bridge, stay at its top beside it, and come down behind it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from milling import SETUP, box_blank, cutting, mill
from trunnion.geometry.arrays import Floats
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.model.tabs import Tab
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.tab_lift import TabLift
from trunnion.toolpath.stock.heightfield import PlanningStock, positions_on

STOCK = PlanningStock.of(box_blank((-60, -40, -10), (60, 40, 0)), SETUP)
TAB = Tab(
    middle=(0.0, 0.0),
    direction=math.radians(90.0),
    width=8.0,
    reach=20.0,
    bottom=-10.0,
    top=-8.0,
    ramp=math.radians(30.0),
)
RUN = 2.0 / math.tan(math.radians(30.0))


def tips(path: Toolpath) -> Floats:
    """Return positions all along a path, 0.1 mm apart or less."""
    rows = np.repeat(np.arange(1, len(path)), 400)
    return positions_on(path, rows, np.tile(np.linspace(0.0, 1.0, 400), len(path) - 1))


def builder(feed: float = 2400.0, tabs: tuple[Tab, ...] = (TAB,)) -> PathBuilder:
    return PathBuilder(mill(10.0), cutting(2.0, 4.0, feed), STOCK, SETUP, 2.0, tabs)


def test_a_line_past_a_tab_has_its_ramps_where_the_formula_puts_them() -> None:
    made = builder()
    made.rapid((-40.0, 5.0, 50.0))
    made.line((-40.0, 5.0, -10.0), 500.0)
    made.line((40.0, 5.0, -10.0), 2400.0)
    corners = made.finished().position[2:-1]
    # Half its width and the cutter's radius to both sides at the top, a ramp of 30 degrees farther at the bottom.
    assert corners[:, 0] == pytest.approx([-9.0 - RUN, -9.0, 9.0, 9.0 + RUN, 40.0], abs=1e-3)
    assert corners[:, 2] == pytest.approx([-10.0, -8.0, -8.0, -10.0, -10.0], abs=1e-3)


def test_it_goes_up_at_the_feed_and_down_no_faster_than_it_plunges() -> None:
    made = builder(feed=2400.0)
    made.rapid((-40.0, 5.0, 50.0))
    made.line((-40.0, 5.0, -10.0), 500.0)
    made.line((40.0, 5.0, -10.0), 2400.0)
    path = made.finished()
    plunge = made.data.plunge_feed
    up, over, down = path.feed[3], path.feed[4], path.feed[5]
    assert up == over == 2400.0
    assert down * math.sin(math.radians(30.0)) == pytest.approx(plunge, rel=1e-3)
    assert not (path.motion[2:-1] == Motion.RAPID).any()


@pytest.mark.parametrize("angle", [0.0, 0.3, 1.1, math.pi / 2])
@pytest.mark.parametrize("offset", [-3.0, 0.0, 7.0])
def test_no_flat_end_comes_into_the_bridge(angle: float, offset: float) -> None:
    """Lines at any angle, and an arc, go over it; elsewhere they are as deep as they were to be."""
    made = builder()
    along = np.array([math.cos(angle), math.sin(angle)])
    middle = np.array([0.0, 10.0]) + offset * np.array([-along[1], along[0]])
    made.rapid((*(middle - 45.0 * along), 50.0))
    made.line((*(middle - 45.0 * along), -10.0), 500.0)
    made.line((*(middle + 45.0 * along), -10.0), 2400.0)
    made.arc((*(middle - 45.0 * along), -10.0), middle, math.pi, 2400.0)
    found = tips(made.finished())
    away = TAB.distance(found[:, :2])
    assert found[away < 5.0 - 1e-3, 2].min() >= TAB.top - 1e-3
    at_ends = np.hypot(*(found[:, :2] - (middle - 45.0 * along)).T) < 1e-6
    low = found[(away > 5.0 + RUN + 0.01) & ~at_ends]
    assert low[:, 2] == pytest.approx(-10.0, abs=1e-6)


def test_a_plunge_into_a_tab_ends_at_its_top_and_goes_on_from_there() -> None:
    made = builder()
    made.rapid((0.0, 5.0, 50.0))
    made.line((0.0, 5.0, -10.0), 500.0)
    assert made.here == pytest.approx((0.0, 5.0, -8.0))
    made.line((30.0, 5.0, -10.0), 2400.0)
    assert made.here == pytest.approx((30.0, 5.0, -10.0))
    assert tips(made.finished())[:, 2][-1] == 50.0


def test_over_its_top_nothing_changes() -> None:
    def path(tabs: tuple[Tab, ...]) -> Toolpath:
        made = builder(tabs=tabs)
        made.rapid((-40.0, 5.0, 50.0))
        made.line((-40.0, 5.0, -8.0), 500.0)
        made.arc((40.0, 5.0, -8.0), (0.0, 5.0), math.pi, 2400.0)
        return made.finished()

    with_tab, without = path((TAB,)), path(())
    assert np.array_equal(with_tab.position, without.position)
    assert np.array_equal(with_tab.feed, without.feed)


def test_the_lowest_tip_of_two_tabs_is_the_higher_ones() -> None:
    higher = Tab(
        middle=(30.0, 0.0), direction=TAB.direction, width=8.0, reach=20.0, bottom=-10.0, top=-6.0,
        ramp=TAB.ramp,
    )  # fmt: skip
    lift = TabLift((TAB, higher), 5.0)
    found = lift.lowest(np.array([(0.0, 5.0), (30.0, 5.0), (15.0, 5.0)]))
    slope = math.tan(TAB.ramp)
    assert found == pytest.approx([-8.0, -6.0, max(-8.0 - 6.0 * slope, -6.0 - 6.0 * slope)])
