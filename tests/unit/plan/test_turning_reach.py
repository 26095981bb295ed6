"""What turning tools reach: the ceiling of their points against tools put there one by one, and what they leave."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from pytest import approx

from trunnion.plan.turning.reach import (
    DEEP,
    HOLDER_CLEARANCE,
    NOSE_CHORD,
    TURNED_FREE,
    TurningLimits,
    ceiling_of,
    reach_of,
    touching,
)
from trunnion.plan.turning.tools import bars_that_fit, candidates
from trunnion.plan.turning.view import PassView, TurningSide
from turned_rings import (
    BACK,
    BAR,
    BLANK,
    HELD,
    RING,
    SHOP,
    SLENDER,
    STRONG,
    WORK,
    ring_area,
    turning_tool,
)

TOUCH = 2e-3
"""mm: chords of insert and part."""


def reach(name, side, lowest, part=RING, stock=BLANK, **choices):
    return reach_of(
        turning_tool(name),
        TurningSide(side),
        ring_area(part),
        TurningLimits(floor=min(lowest, HELD), lowest=lowest),
        ring_area(stock),
        **choices,
    )


@pytest.mark.parametrize(("side", "name", "lowest"), WORK)
def test_on_its_ceiling_a_tool_enters_nothing(side, name, lowest):
    found = reach(name, side, lowest)
    part = found.view.shape_seen(ring_area()).buffer(-TOUCH)
    tool = turning_tool(name)
    shapes = [
        found.view.seen(s) for s in (tool.insert_profile(NOSE_CHORD), *tool.holder_profiles())
    ]
    for point in found.allowed_ceiling():
        for shape in shapes:
            assert not shapely.intersects(shapely.Polygon(shape + point), part)


@pytest.mark.parametrize(("side", "name", "lowest"), WORK)
def test_a_ceiling_never_falls_faster_than_the_edge_behind_the_nose_allows(side, name, lowest):
    way = reach(name, side, lowest).allowed_ceiling()
    step = np.diff(way, axis=0)
    slope = math.tan(math.radians(turning_tool(name).end_angle) - TURNED_FREE)
    assert (step[:, 0] >= -1e-9).all() and (step[:, 1] >= -slope * step[:, 0] - 1e-6).all()


def test_finishing_tools_of_both_hands_leave_the_ring_itself():
    stock = ring_area(BLANK)
    for side, name, lowest in WORK:
        stock = reach(name, side, lowest, stock=shapely.get_coordinates(stock)[:-1]).cut_from(stock)
    left = stock.difference(ring_area())
    # What is held keeps its 5 and 2 mm. Noses leave (1 - pi / 4) r^2 in the two corners outside and at the two ends of what is held.
    held = 7.0 * HELD
    corners = (1.0 - math.pi / 4.0) * (2.0 * 0.8**2 + 0.8**2 + 1.2**2)
    assert left.area - held == approx(corners, abs=0.15)
    assert ring_area().difference(stock).area < 0.01


def test_what_roughing_keeps_is_its_allowance():
    found = reach(STRONG, "face", 100.0, allowance=0.3)
    assert found.cut_from(ring_area(BLANK)).bounds[3] == approx(100.3, abs=1e-3)


def test_a_holder_keeps_clear_of_what_its_insert_leaves():
    # Behind a deep narrow groove stands more than the part: the bar may not pass through it.
    found = reach(SLENDER, "outside", HELD)
    left = found.view.shape_seen(found.cut_from(ring_area(BLANK))).buffer(-0.06)
    holder = [found.view.seen(h) for h in turning_tool(SLENDER).holder_profiles()]
    for point in found.allowed_ceiling()[::5]:
        for shape in holder:
            assert not shapely.intersects(shapely.Polygon(shape + point), left)


outlines = st.lists(st.tuples(st.floats(2.0, 12.0), st.floats(60.0, 90.0)), min_size=2, max_size=7)


@settings(max_examples=15, deadline=None)
@given(steps=outlines, name=st.sampled_from([STRONG, SLENDER, BACK]))
def test_any_stepped_shaft_is_kept(steps, name):
    heights = np.cumsum([0.0, *(h for h, _ in steps)])
    points = [(40.0, 0.0)]
    for k, (_, r) in enumerate(steps):
        points += [(r, heights[k]), (r, heights[k + 1])]
    part = np.array([*points, (40.0, heights[-1])])
    found = reach_of(
        turning_tool(name),
        TurningSide.OUTSIDE,
        shapely.Polygon(part).buffer(0.0),
        TurningLimits(floor=-200.0, lowest=-200.0),
        shapely.box(40.0, 0.0, 95.0, heights[-1]),
    )
    left = found.cut_from(shapely.box(40.0, 0.0, 95.0, heights[-1]))
    assert shapely.Polygon(part).buffer(-TOUCH).difference(left).area < 1e-6
    # A step that the nose can lie on is finished: the largest radius always is.
    widest = max(r for _, r in steps)
    assert left.bounds[2] == approx(widest, abs=TOUCH) or name == BACK


def test_a_ceiling_is_the_upper_outline_of_what_is_closed_downwards():
    top = ceiling_of(shapely.union_all([shapely.box(0, 0, 4, 2), shapely.box(1, 0, 2, 5)]))
    corners = shapely.get_coordinates(shapely.LineString(top[1:-1]).simplify(0.0))
    assert corners.tolist() == [[0, 0], [0, 2], [1, 2], [1, 5], [2, 5], [2, 2], [4, 2], [4, 0]]
    assert top[0, 1] == top[-1, 1] == -DEEP


def test_positions_that_touch_stock_are_a_minkowski_sum():
    square = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
    assert touching(shapely.box(0, 0, 3, 2), square).bounds == (-1.0, -1.0, 3.0, 2.0)


@pytest.mark.parametrize("side", list(TurningSide))
@pytest.mark.parametrize("name", [STRONG, BACK, BAR])
def test_views_go_back_to_where_they_came_from(side, name):
    view = PassView.of(side, turning_tool(name))
    points = np.array([(3.0, 4.0), (-1.0, 2.0)])
    assert np.allclose(view.back(view.seen(points)), points)


def test_strong_inserts_rough_first_and_slender_ones_finish():
    rough = candidates(SHOP.turning, TurningSide.OUTSIDE, "right", finish=False)
    finish = candidates(SHOP.turning, TurningSide.OUTSIDE, "right", finish=True)
    assert [t.insert.point_angle for t in rough] == [80.0, 55.0, 35.0]
    assert [t.insert.point_angle for t in finish] == [55.0, 35.0]
    assert rough[0].insert.nose_radius == 1.2


def test_a_bar_goes_in_where_it_has_room_and_reaches():
    bars = [t for t in SHOP.turning if t.inside]
    assert bars_that_fit(bars, 14.0, 50.0, 2.0) == []
    assert {t.shank_width for t in bars_that_fit(bars, 20.0, 50.0, 2.0)} == {25.0}
    assert {t.shank_width for t in bars_that_fit(bars, 100.0, 310.0, 2.0)} == {40.0}
    assert bars_that_fit(bars, 100.0, 400.0, 2.0) == []


def test_the_holders_clearance_is_kept_from_the_part():
    found = reach(SLENDER, "outside", HELD)
    part = found.view.shape_seen(ring_area()).buffer(HOLDER_CLEARANCE - 0.05)
    shank = found.view.seen(turning_tool(SLENDER).holder_profiles()[1])
    for point in found.allowed_ceiling()[::3]:
        assert not shapely.intersects(shapely.Polygon(shank + point), part)
