"""Where a map of heights lies low, and what of a stock is over a layer of a pocket: held against cells looked at one by one."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.ndimage import gaussian_filter

from trunnion.geometry.plane.region import Region
from trunnion.plan.freeform.roughing.heights import region_below
from trunnion.plan.freeform.roughing.layers import stock_over
from trunnion.toolpath.stock.heightfield import PlanningStock

CELL, CHORD = 0.5, 1e-5


def field(seed: int, smooth: float, shape: tuple[int, int] = (24, 17)) -> np.ndarray:
    """Return heights of a random field with hills some cells wide, none of them saddles of alternate corners where it is smooth."""
    found = gaussian_filter(np.random.default_rng(seed).normal(size=shape), smooth)
    return (found - found.mean()) / found.std()


def low_part(corners: np.ndarray, value: np.ndarray) -> shapely.Geometry:
    """Return what of a cell (4, 2), anticlockwise, lies low: corners with a value of 0 or less and where its edges cross 0."""
    points = []
    for a, b, v, w in zip(corners, np.roll(corners, -1, 0), value, np.roll(value, -1), strict=True):
        if v <= 0.0:
            points.append(a)
        if (v <= 0.0) != (w <= 0.0):
            points.append(a + v / (v - w) * (b - a))
    return shapely.Polygon(points) if len(points) > 2 else shapely.Polygon()


@given(st.integers(0, 10_000), st.floats(-1.5, 1.5), st.floats(-60.0, 60.0))
@settings(max_examples=25, deadline=None)
def test_a_low_area_is_that_of_its_cells(seed, z, corner):
    height = field(seed, 2.5)
    saddles, area = 0.0, 0.0
    for i in range(height.shape[0] - 1):
        for j in range(height.shape[1] - 1):
            at = np.array([(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)])
            value = height[at[:, 0], at[:, 1]] - z
            area += low_part(CELL * at, value).area
            low = value <= 0.0
            saddles += CELL**2 if low[0] == low[2] != low[1] == low[3] else 0.0
    found = region_below(height, np.array([corner, -3.0]), CELL, z, CHORD)
    rim = sum(c.length for p in found.pieces for c in (p.outer, *p.holes))
    assert found.area == pytest.approx(area, abs=saddles + 3.0 * CHORD * (rim + 1.0) + 1e-3)


@given(st.integers(0, 10_000), st.floats(-1.0, 1.0))
@settings(max_examples=10, deadline=None)
def test_no_higher_place_is_in_a_low_area(seed, z):
    height = field(seed, 1.5)
    found = region_below(height, np.zeros(2), CELL, z, 0.05)
    places = CELL * np.argwhere(height > z)
    assert not len(places) or not found.contains(places).any()


@given(st.integers(0, 10_000), st.floats(-1.0, 1.0))
@settings(max_examples=10, deadline=None)
def test_the_stock_over_a_pocket_is_found_from_the_cells_about_it(seed, z):
    heights = 2.0 * field(seed, 8.0, (160, 120))
    stock = PlanningStock(field=heights, corner=np.array([-20.0, -15.0]), cell=0.25, digest="")
    everywhere = np.array([-30.0, -30.0, 0.0]), np.array([30.0, 30.0, 0.0])
    pocket = np.array([-6.0, -4.0, 0.0]), np.array([9.0, 7.0, 0.0])
    inside = Region.rectangle(-6.0, -4.0, 9.0, 7.0)
    of_all, of_some = (
        stock_over(stock, z, z + 1.0, box).intersect(inside) for box in (everywhere, pocket)
    )
    assert of_some.area == pytest.approx(of_all.area, abs=0.05)
    assert of_all.minus(of_some.offset(0.05)).area + of_some.minus(of_all.offset(0.05)).area < 0.05
