"""Gaps on circles about the axis: where a turning insert may be down, and what it finishes."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from flat_parts import operation
from gap_turning import BUTTON_12
from milling import mill
from ringed_block import HIGH, RADIUS, WIDE, ground
from trunnion.geometry.plane.region import EMPTY_REGION
from trunnion.plan.development.drives import GroundCutter, floor_over
from trunnion.plan.development.gap_passes import gap_passes, turned_region
from trunnion.plan.freeform.lands import ABOVE_TOOL, AROUND_TOOL
from trunnion.plan.prismatic.drive import WALL_ALLOWANCE

STEP = 0.5
CUTTER = GroundCutter(tool=BUTTON_12, allowance=0.0, around=0.5, above=1.0)
ROUGHER = GroundCutter(tool=mill(10.0), allowance=0.3, around=0.8, above=1.0)


def found(needed=lambda lift: 50.0, roughed=(ROUGHER,)):
    return gap_passes(ground(), CUTTER, roughed, STEP, needed)


def test_a_gap_goes_round_from_one_side_of_the_block_to_the_other():
    passes = found()
    beside = [p for p in passes if abs(p.along - 30.0) < 0.5 * WIDE - 1.0]
    assert beside
    for each in beside:
        ((start, end),) = each.gaps
        # The block's foot is seen under asin(half its width / R); insert and roughing keep off by their radius and more.
        foot = math.asin(0.5 * WIDE / RADIUS)
        free = 2.0 * math.pi - 2.0 * (foot + (BUTTON_12.radius + 1.3) / RADIUS)
        assert free - 0.03 <= end - start <= free + 0.03
        assert math.cos(0.5 * (start + end)) == pytest.approx(-1.0, abs=1e-3)


def test_between_gaps_the_tool_is_over_the_blank():
    assert all(p.lift >= HIGH + 1.0 for p in found())


def test_the_tool_keeps_off_what_roughing_leaves_on_sides():
    more = replace(CUTTER, allowance=3.0)
    kept, whole = gap_passes(ground(), more, (ROUGHER,), STEP, lambda lift: 50.0), found()
    size = {p.along: p.gaps[0][1] - p.gaps[0][0] for p in whole}
    beside = [p for p in kept if abs(p.along - 30.0) < 0.5 * WIDE - 1.0]
    assert beside
    for each in beside:
        less = size[each.along] - (each.gaps[0][1] - each.gaps[0][0])
        assert less * RADIUS == pytest.approx(6.0, abs=2.1)


@pytest.mark.parametrize(("needed", "any_"), [(560.0, True), (640.0, False)])
def test_shorter_gaps_than_needed_are_left(needed, any_):
    assert bool(found(lambda lift: needed)) is any_


def test_nothing_is_turned_where_nothing_was_roughed():
    assert found(roughed=()) == ()


def test_what_is_finished_lies_between_neighbouring_passes_but_for_the_ends_of_gaps():
    passes, ramp = found(), 20.0
    area = turned_region(ground(), passes, STEP, lambda lift: ramp)
    expected = sum(
        STEP * (RADIUS * (p.gaps[0][1] - p.gaps[0][0]) - 2.0 * ramp) for p in passes[:-1]
    )
    assert area.area == pytest.approx(expected, rel=0.03)
    points = np.array([[math.pi * RADIUS - 1.0, 30.0], [-math.pi * RADIUS + 1.0, 30.0]])
    assert area.contains(points).all()
    assert not area.contains([[0.0, 30.0]])[0]


def test_a_floor_is_milled_without_what_is_turned():
    made = operation(
        "floor", "pocket-01", mill(10.0), {WALL_ALLOWANCE: 0.0, AROUND_TOOL: 0.5, ABOVE_TOOL: 1.0}
    )
    turned = turned_region(ground(), found(), STEP, lambda lift: 20.0)
    whole, rest = (floor_over(made, ground(), (), 0.3, area) for area in (EMPTY_REGION, turned))
    areas = [drive.floors[0].region.area for drive in (whole, rest)]
    assert turned.area > 0.3 * areas[0]
    # What a cutter of 10 mm does not come between is no floor any more.
    left = areas[0] - turned.intersect(whole.floors[0].region).area
    assert 0.85 * left < areas[1] <= left + 1e-6
