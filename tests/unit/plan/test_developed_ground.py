"""Ground laid flat with what stands on it: where cutters may go, layers over it, and what they leave."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from flat_parts import operation
from milling import mill
from ringed_block import BOSS, HIGH, RADIUS, WIDE, ground
from trunnion.geometry.development import Development
from trunnion.geometry.frame import WORLD
from trunnion.geometry.plane.region import Region
from trunnion.model.tool import Tool
from trunnion.plan.development.drives import (
    GroundCutter,
    layers_down,
    layers_over,
    ring_of,
    shank_clearance,
    tangent_reach,
)
from trunnion.plan.development.ground import GroundBounds, sector
from trunnion.plan.freeform.lands import ABOVE_TOOL, AROUND_TOOL
from trunnion.plan.prismatic.drive import FLOOR_ALLOWANCE, WALL_ALLOWANCE


def test_a_block_stands_on_the_ground_as_wide_as_it_is_seen_from_the_axis() -> None:
    area = ground().over(4.0)
    block = max(area.split(), key=lambda r: float(r.contains([[0.0, 30.0]])[0]))
    (x0, y0), (x1, y1) = block.box()
    # Its sides are parallel: higher up they take less of the angle about the axis.
    foot = RADIUS * math.asin(0.5 * WIDE / (RADIUS + 4.0))
    assert (x0, x1) == pytest.approx((-foot, foot), abs=0.1)
    assert (y0, y1) == pytest.approx((20.0, 40.0), abs=0.1)


@pytest.mark.parametrize(("beyond", "is_there"), [(10.0, True), (88.0, True), (92.0, False)])
def test_only_what_no_cutter_on_the_ground_comes_near_is_left_out(beyond, is_there) -> None:
    """The block ends at 40 mm; cutters reach two of the 45 mm that are looked at beyond the ground."""
    assert bool(ground((40.0 + beyond, 140.0 + beyond)).obstacles) == is_there
    assert bool(ground((-140.0 - beyond, 20.0 - beyond)).obstacles) == is_there


def test_over_its_top_nothing_of_it_is_in_the_way() -> None:
    rim = math.hypot(RADIUS + HIGH, 0.5 * WIDE) - RADIUS
    assert not ground().over(rim + 0.01).contains([[9.2, 30.0]])[0]
    assert ground().over(rim - 0.05).contains([[9.2, 30.0]])[0]


def test_a_flange_is_in_the_way_all_round_and_beyond_where_the_plane_ends() -> None:
    at = np.array([[u, 0.0] for u in (-330.0, -100.0, 200.0, 330.0)])
    assert ground().over(5.0).contains(at).all()
    assert not ground().over(5.0).contains(at + [0.0, 2.0]).any()


def test_the_ring_of_the_blank_is_what_is_milled() -> None:
    (x0, y0), (x1, y1) = ring_of(ground()).box()
    assert (y0, y1) == pytest.approx((17.0, 43.0), abs=0.8)
    assert x1 - x0 == pytest.approx(2.0 * math.pi * RADIUS, abs=0.1)


def test_limited_ground_is_milled_within_its_limit_and_below_its_ceiling_alone() -> None:
    """The block's own plan area is the limit here; above 3 mm at one end and 9 mm at the other the ring goes with other ground."""
    limit = GroundBounds(tags=(BOSS,), ceiling=((0.0, 3.0), (60.0, 9.0)))
    whole, limited = ground(), ground(limited=limit)
    block = Region.rectangle(-0.5 * WIDE, 20.0, 0.5 * WIDE, 40.0).offset(0.2)
    assert limited.milled() and not limited.milled().minus(block)
    assert not limited.blank_over(1.0).minus(block)
    assert not limited.free(HIGH + 1.0, mill(4.0), 0.0, 0.0).minus(block)
    assert not ring_of(limited).minus(block)
    # The ring ends at 42 mm, where the ceiling is as high as this, give or take a step between places.
    assert limited.top == pytest.approx(3.0 + 0.1 * 42.0, abs=0.1)
    assert limited.top_with(0.5) == pytest.approx(limited.top + 0.5)
    assert (limited.ring_top, limited.widths) == (whole.ring_top, whole.widths)
    assert whole.top_with(0.5) == whole.top
    assert limited.over(4.0).contains([[0.0, 30.0]])[0]


def test_shank_and_holder_keep_from_what_is_high_beside_the_cutter() -> None:
    tool = mill(10.0)
    free = ground().free(0.0, tool, 1.0, 1.0)
    assert free.contains([[60.0, 30.0]])[0] and not free.contains([[0.0, 30.0]])[0]


def test_what_is_free_within_an_area_is_what_is_free_of_it() -> None:
    tool, whole = mill(8.0), ground()
    for middle in ((0.0, 30.0), (14.0, 30.0), (0.0, 6.0)):
        near = Region.rectangle(middle[0] - 9.0, middle[1] - 5.0, middle[0] + 9.0, middle[1] + 5.0)
        free = whole.free(0.0, tool, 1.0, 1.0, near)
        expected = whole.free(0.0, tool, 1.0, 1.0).intersect(near)
        assert free.area == pytest.approx(expected.area, abs=1e-6)
        assert free.minus(expected).area == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("limited", [None, GroundBounds(tags=(BOSS,))])
@pytest.mark.parametrize("z", [0.0, 0.3, HIGH + 1.0])
def test_no_cutter_may_be_where_its_tip_may_not(limited, z) -> None:
    laid = ground(limited=limited)
    tip = laid.free_for_tip(z)
    for tool in (mill(4.0), mill(10.0), mill(6.0, flute_length=8.0)):
        free = laid.free(z, tool, 1.0, 1.0)
        assert (free or limited) and free.minus(tip).area < 1e-6


def test_layers_are_a_step_thick_but_the_first_and_hold_the_tops_of_bosses() -> None:
    found = layers_down(10.0, 0.3, 4.0, (8.0, 7.6, 7.59, 5.0, 0.0), 0.3)
    heights = [height for layer in found for height in (layer.top, layer.bottom)]
    assert heights == pytest.approx([10.0, 8.3, 8.3, 4.3, 4.3, 0.3])
    # A top where a layer ends is cut with it, and of two nearly at one height the upper one counts.
    assert [layer.tops for layer in found] == [(), pytest.approx((7.9, 5.3)), ()]
    # Hardly over a layer's bottom it would stand in the way of it; hardly below, the layer leaves little more than its allowance.
    over, below = (layers_down(10.0, 0.3, 4.0, (z,), 0.3) for z in (4.02, 3.98))
    assert over[1].tops == pytest.approx((4.32,)) and not any(layer.tops for layer in below)


def test_a_boss_is_cut_to_its_top_without_another_layer_all_round() -> None:
    tool, whole = mill(10.0), ground()
    choices = {
        WALL_ALLOWANCE: 0.5,
        FLOOR_ALLOWANCE: 0.3,
        AROUND_TOOL: 1.0,
        ABOVE_TOOL: 1.0,
    }
    rough = operation("rough", "pocket-01", tool, choices)
    rough = replace(rough, data=replace(rough.data, depth=6.0))
    # Over bent ground the level block is highest at its sides.
    high = math.hypot(RADIUS + HIGH, 0.5 * WIDE) - RADIUS
    first, top, second = layers_over(rough, whole, (high,), ()).levels
    assert [first.top, first.bottom] == pytest.approx([whole.top, 6.3])
    assert [top.top, top.bottom] == pytest.approx([whole.top, high + 0.3])
    assert [second.top, second.bottom] == pytest.approx([6.3, 0.3])
    # The block, its allowance and the corners that the cutter can't reach, from half a cutter's radius beside it.
    block = Region.rectangle(-0.5 * WIDE, 30.0 - 0.5 * WIDE, 0.5 * WIDE, 30.0 + 0.5 * WIDE)
    assert not block.minus(top.wanted).opened(0.05)
    assert not top.wanted.minus(block.offset(0.5 + 0.5 * tool.radius + 0.2)).opened(0.05)
    assert top.wanted.area < 0.2 * first.wanted.area
    # An earlier cutter of the same size leaves nothing of it.
    again = layers_over(rough, whole, (high,), (GroundCutter.of(rough),)).levels
    assert not any(level.wanted for level in again)


def test_a_disc_finishes_bent_ground_as_far_as_it_is_near_to_it() -> None:
    reach = tangent_reach(ground())
    assert math.hypot(RADIUS, reach) - RADIUS == pytest.approx(0.01, rel=1e-3)


def test_short_cutters_keep_their_shanks_off_what_roughing_leaves_high_up() -> None:
    """On the top's radius of 109 mm a cutter of 20 mm spans 18.3 mm of the ground's 100: 0.83 mm more stay on either side of a block."""
    laid = ground()
    assert laid.ring_top == pytest.approx(9.0)
    short, roughed = mill(6.0, flute_length=7.0), [mill(20.0, 0.5), mill(12.0, 0.5)]
    left = 0.5 + 10.0 * (1.0 - RADIUS / 109.0)
    assert left < shank_clearance(laid, short, roughed, 0.5) < left + 0.5
    # Flutes that reach over the ring, and cutters that went first, meet nothing.
    assert shank_clearance(laid, mill(6.0, flute_length=10.0), roughed, 0.5) == 0.0
    assert shank_clearance(laid, mill(20.0, flute_length=7.0), roughed, 0.5) == 0.0


def test_relieved_necks_go_along_flanges_that_came_finished() -> None:
    """The flange is 12 mm high and the ring 9: flutes of 10 mm finish all of its side that is not turned, and the neck follows them."""
    laid = ground()
    beside = laid.band(*laid.ends)

    def lowest(tool: Tool) -> float:
        return float(laid.free(0.0, tool, 0.5, 1.0).intersect(beside).box()[0][1])

    flush = lowest(mill(6.0, flute_length=30.0))
    assert lowest(mill(6.0, flute_length=10.0)) == pytest.approx(flush, abs=1e-6)
    assert lowest(mill(6.0, flute_length=8.0)) == pytest.approx(flush + 0.25, abs=0.01)
    thick = replace(mill(6.0, flute_length=10.0), neck_diameter=6.0)
    assert lowest(thick) == pytest.approx(flush + 0.5, abs=0.01)


@pytest.mark.parametrize("slope", [0.3, -0.3, 1.8])
def test_bands_of_cones_lie_flat_between_true_arcs(slope: float) -> None:
    development = Development(frame=WORLD, radius=RADIUS, height=0.0, slope=slope, middle=0.4)
    band = sector(development, 10.0, 30.0, math.pi)
    low, high = (float(r) for r in development.radius_at(np.array([10.0, 30.0])))
    assert band.area == pytest.approx(math.pi * (low + high) * 20.0, rel=1e-9)
    # Two arcs and two straight ends: nothing is made of chords.
    assert [piece.outer.n_segments for piece in band.pieces] == [4]
    height = 10.0 / math.hypot(1.0, slope)
    on = development.from_cylindrical(
        np.array([low]), np.array([0.9 * math.pi]), np.array([height])
    )
    assert band.signed_distance(on[:, :2]) == pytest.approx(0.0, abs=1e-9)


def test_a_steep_cone_does_not_lap_over_itself() -> None:
    development = Development(frame=WORLD, radius=RADIUS, height=0.0, slope=2.0, middle=0.0)
    half, share = 2.0 * math.pi, development.half_turn / math.pi
    low, high = (float(r) / share for r in development.radius_at(np.array([10.0, 30.0])))
    whole = math.pi * (high**2 - low**2)
    assert sector(development, 10.0, 30.0, half).area == pytest.approx(whole, rel=0.01)
    assert sector(development, 10.0, 30.0, half).area < whole
