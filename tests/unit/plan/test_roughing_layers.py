"""Layers over curved parts: deep ones on the way down, steps up the slopes from the side that is cut already."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flat_parts import operation
from milling import Milled, cutting, mill
from surface_drives import grid
from trunnion.geometry.frame import WORLD
from trunnion.geometry.plane.region import Region
from trunnion.model.blank import Box
from trunnion.model.motion.toolpath import Motion
from trunnion.model.setup import Setup
from trunnion.plan.freeform.keys import ALLOWANCE, BOTTOM, CELL, LAYER
from trunnion.plan.freeform.roughing.layers import layer_groups, plane_drive_of, without_rims
from trunnion.plan.freeform.space import SurfaceSpace
from trunnion.progress import NO_PROGRESS
from trunnion.toolpath.plane.rough import RoughSettings, rough
from trunnion.toolpath.stock.heightfield import PlanningStock

SETUP = Setup(name="S1", frame=WORLD, work_offset="G54", clearance=60.0, machine="Mill")
LOW, HIGH = np.zeros(3), np.array([60.0, 60.0, 20.0])
BLANK = Box(frame=WORLD, low=LOW, high=HIGH, material="aluminium", density=2.7)
STEP, DEEP, KEPT = 1.5, 9.0, 0.3
CUTTER = mill(8.0, 1.0)
CHOICES = {ALLOWANCE: KEPT, BOTTOM: 2.0 + KEPT, CELL: 0.5, LAYER: STEP}


def hill(x, y):
    """Return the height of a hill with slopes of 45 degrees at most, in a wide flat."""
    return 2.0 + np.clip(15.0 - 0.7 * np.hypot(x - 30.0, y - 30.0), 0.0, 12.0)


def space_of_hill() -> SurfaceSpace:
    """Return the hill in its blank, seen from above."""
    return SurfaceSpace(
        part=None,
        blank=BLANK,
        setup=SETUP,
        direction=(0.0, 0.0, 1.0),
        skin=grid(hill, high=(60.0, 60.0)),
        low=LOW,
        high=HIGH,
    )


def milled(depth: float) -> tuple[float, Milled]:
    """Return the length of the feed moves and the stock that roughing the hill with a depth of cut leaves."""
    made = operation("rough", "group-01", CUTTER, CHOICES)
    data = cutting(depth, 3.0)
    stock = PlanningStock.of(BLANK, SETUP)
    drive = plane_drive_of(replace(made, data=data), space_of_hill(), stock, NO_PROGRESS)
    path = rough(drive, CUTTER, data, stock, SETUP, RoughSettings(), NO_PROGRESS).path
    feed = float(path.lengths()[path.motion != Motion.RAPID].sum())
    return feed, Milled((0.0, 0.0), (60.0, 60.0), 20.0).cut(path, CUTTER)


def test_deep_layers_with_steps_up_the_slopes_leave_what_shallow_ones_do_in_half_the_way():
    long, shallow = milled(STEP)
    short, deep = milled(DEEP)
    assert short < 0.5 * long
    assert deep.crashes == []
    assert (np.abs(deep.height - shallow.height) < 0.05).mean() > 0.98
    over = deep.height - hill(deep.x, deep.y)
    assert over.min() > 0.5 * KEPT
    assert np.quantile(over, 0.99) < STEP + 2.0 * KEPT + 1.0


@given(
    st.lists(st.floats(0.1, 1.5), min_size=1, max_size=40),
    st.floats(1.5, 20.0),
)
def test_groups_hold_all_heights_in_order_and_none_is_thicker_than_the_depth(steps, depth):
    heights = list(-np.cumsum(steps))
    groups = layer_groups(0.0, heights, depth)
    assert [z for _, group in groups for z in group] == heights
    ends = [0.0, *(group[-1] for _, group in groups)]
    assert [above for above, _ in groups] == ends[:-1]
    assert all(a - b <= depth + 1e-6 for a, b in pairwise(ends))


@pytest.mark.parametrize("depth", [1.5, 4.0, 9.0])
def test_groups_are_as_even_as_their_heights_allow(depth):
    heights = [-1.5 * n for n in range(1, 13)]
    thick = [above - group[-1] for above, group in layer_groups(0.0, heights, depth)]
    assert max(thick) - min(thick) <= 1.5 + 1e-9


@pytest.mark.parametrize("cells", [2, 3, 4, 8])
def test_a_thin_plate_is_cut_where_it_stands_by_itself_and_not_as_the_rim_of_a_wall(cells):
    cell, wall = 0.5, Region.rectangle(20.0, 20.0, 40.0, 40.0)
    free = Region.rectangle(-50.0, -50.0, 110.0, 110.0).minus(wall)
    plate = Region.rectangle(0.0, 0.0, 60.0, cells * cell)
    rim = wall.offset(2.0 * cell)
    found = without_rims(plate.union(rim), free, cell)
    assert found.minus(plate).area < 1e-6
    # Round corners of the openings alone are left.
    assert plate.minus(found).area < 4.0 * (2.0 * cell) ** 2


def test_stock_beside_a_wall_is_cut_where_it_is_wider_than_a_rim():
    cell, wall = 0.5, Region.rectangle(0.0, 0.0, 60.0, 5.0)
    free = Region.rectangle(-50.0, -50.0, 110.0, 110.0).minus(wall)
    for width, cut in ((1.0, False), (3.0, True)):
        high = Region.rectangle(0.0, 0.0, 60.0, 5.0 + width)
        assert bool(without_rims(high, free, cell)) is cut


def test_a_plate_under_what_was_roughed_from_above_is_cut_from_the_side_layer_by_layer():
    """Seen from the side, a plate that another direction left stands all the way down: no layer may go by it."""
    made = replace(operation("rough", "group-01", CUTTER, CHOICES), data=cutting(DEEP, 3.0))
    uncut = PlanningStock.of(BLANK, SETUP)
    heights = np.full_like(uncut.heights, 0.0)
    heights[:3] = uncut.heights[:3]
    drive = plane_drive_of(made, space_of_hill(), replace(uncut, field=heights), NO_PROGRESS)
    plate = Region.rectangle(0.0, 0.0, 1.5, 60.0)
    groups = {level.top for level in drive.levels}
    for top in groups:
        wanted = [level.wanted for level in drive.levels if level.top == top]
        assert plate.minus(wanted[0]).area < 0.05 * plate.area
