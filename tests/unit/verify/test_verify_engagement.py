"""How much of the cutter's circumference is in material, and how deep: angles worked out by hand, in heights and in intervals."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from pytest import approx

from trunnion.geometry.arrays import floats
from trunnion.geometry.frame import WORLD
from trunnion.model.blank import Box
from trunnion.verify.kernels.stock.engagement import engagement_in_zmap
from trunnion.verify.motion import moves_of
from trunnion.verify.stock import Stock, run_stock
from trunnion.verify.stock.engagement import (
    MOST_PROBES,
    Tally,
    engagement_of,
    flute_of,
    probes_of,
    rings_of,
)
from verify_tools import FORMS, bull, flat, program_section

PITCH = 0.25
BOX = Box(frame=WORLD, low=(0.0, 0.0, 0.0), high=(100.0, 60.0, 20.0), material="test", density=2.8)
FLAT = flat(10.0)()
STEP = 4.0
"""Degrees between two directions looked at."""


def seen(tool, heights, start, end, bands=1):
    """Return the engagement of one move from a start to an end over heights, looked at in bands of rows one by one."""
    moves = moves_of([program_section(tool, [start, end if len(end) == 2 else tuple(end)])])
    probes = probes_of(moves)
    found = Tally.empty(int(probes.start[-1]))
    edges = np.linspace(0, len(heights), bands + 1).astype(int)
    for a, b in pairwise(edges):
        tally = Tally.empty(int(probes.start[-1]))
        engagement_in_zmap(
            heights[a:b],
            floats((0.0, a * PITCH), (2,), "origin"),
            PITCH,
            0.0,
            moves.row[1],
            probes.rings[0],
            probes.circle,
            0,
            int(probes.start[-1]),
            tally.counted,
            tally.spans,
        )
        found = found.plus(tally)
    whole = engagement_of(probes, found, moves)
    return math.degrees(whole.largest[1]), math.degrees(whole.mean[1]), whole.depth[1]


def heights(where=None, top=20.0, cleared=15.0):
    """Return heights of the box; `where` (x, y) -> mask says what is cleared already."""
    y, x = (np.indices((240, 400)) + 0.5) * PITCH
    return np.full(x.shape, top) if where is None else np.where(where(x, y), cleared, top)


def width(ae, radius=5.0):
    return math.degrees(math.acos(1.0 - ae / radius))


def run(tool, stops, intervals=False, **more):
    """Return the run of stops through the whole box, in heights or in intervals."""
    stock = Stock.of(BOX, PITCH)
    if intervals:
        stock.open_field()
    return run_stock(stock, moves_of([program_section(tool, stops, **more)]), WORLD)


@pytest.mark.parametrize("intervals", [False, True])
def test_a_slot_takes_half_the_circle_and_a_plunge_all_of_it(intervals):
    found = run(
        FLAT, [(20, 30, 25), (20, 30, 15), (60, 30, 15), (21.1, 30, 25), (21.1, 30, 25)], intervals
    )
    assert np.degrees(found.engagement[:3]) == approx([0.0, 360.0, 180.0], abs=STEP)
    assert found.depth_of_cut[:3] == approx([0.0, 5.0, 5.0], abs=0.5 if intervals else 1e-9)


@pytest.mark.parametrize("intervals", [False, True])
@pytest.mark.parametrize("ae", [0.5, 1.0, 2.5, 5.0, 8.0])
def test_beside_an_edge_it_is_as_the_width_of_cut_says(ae, intervals):
    stops = [(-20, ae - 5.0, 12), (120, ae - 5.0, 12)]
    assert math.degrees(run(FLAT, stops, intervals).engagement[1]) == approx(
        width(ae), abs=STEP + 2.0
    )


@pytest.mark.parametrize("form", ["flat", "bull", "ball"])
def test_short_moves_see_the_same_as_a_long_one(form):
    tool = {"flat": FLAT, "bull": bull(10.0, 2.0)(), "ball": bull(10.0, 5.0)()}[form]
    stops = [(-20, -3.0, 4.0), *((x, -3.0, 4.0) for x in np.arange(-19.0, 50.0, 0.7))]
    assert np.median(np.degrees(run(tool, stops).engagement[50:])) == approx(
        width(2.0), abs=STEP + 2.0
    )


def test_climb_and_conventional_see_the_same_angle():
    there, back = ((-20, -3, 15), (60, -3, 15)), ((60, -3, 15), (-20, -3, 15))
    assert seen(FLAT, heights(), *there)[0] == approx(seen(FLAT, heights(), *back)[0], abs=STEP)
    assert seen(FLAT, heights(), *there)[0] == approx(width(2.0), abs=STEP + 1.0)


def test_in_air_and_on_a_finished_floor_it_is_nothing():
    cleared = heights(lambda x, y: y < 40)
    assert seen(FLAT, cleared, (20, 20, 20.0), (80, 20, 20.0)) == (0.0, 0.0, 0.0)
    assert seen(FLAT, cleared, (20, 20, 15.0), (80, 20, 15.0)) == (0.0, 0.0, 0.0)
    assert seen(FLAT, heights(), (-50, 30, 5), (-20, 30, 5)) == (0.0, 0.0, 0.0)


def test_along_a_finished_wall_it_is_nothing():
    assert seen(FLAT, heights(lambda x, y: y < 40), (20, 35, 15), (80, 35, 15))[0] == 0.0


def test_entering_at_an_edge_the_circle_is_in_as_far_as_the_front_reaches():
    angle, mean, depth = seen(FLAT, heights(), (-12, 30, 12), (-2.5, 30, 12))
    assert angle == approx(120.0, abs=STEP + 2.0)
    assert 0.0 < mean < angle
    assert depth == 8.0


def test_into_a_corner_it_grows():
    def pocket(x, y):
        return (x < 60.0) & (y > 20.0)

    along = seen(FLAT, heights(pocket), (20, 24, 15), (40, 24, 15))[0]
    into = seen(FLAT, heights(pocket), (20, 24, 15), (56, 24, 15))[0]
    assert along == approx(width(1.0), abs=STEP + 1.0)
    # Side and front each by 1 mm: acos(4/5) at the side, twice as much ahead.
    assert into == approx(3.0 * width(1.0), abs=2.0 * STEP)


def test_a_ramp_looks_ahead_and_as_deep_as_its_end():
    angle, _, depth = seen(FLAT, heights(), (20, 30, 20), (80, 30, 17))
    assert angle == approx(180.0, abs=STEP)
    assert depth == approx(3.0)


def test_a_plunge_half_over_the_edge_takes_half_the_circle():
    assert seen(FLAT, heights(), (30, 0, 25), (30, 0, 10))[0] == approx(180.0, abs=3 * STEP)


def test_straight_up_it_is_nothing():
    assert seen(FLAT, heights(), (30, 30, 10), (30, 30, 25)) == (0.0, 0.0, 0.0)


def test_around_an_arc_the_front_turns_with_it():
    # Anticlockwise about (50, 30) with the tip 10 from it; material outside a circle of 14 only: 1 mm at the outer side.
    ring = heights(lambda x, y: np.hypot(x - 50, y - 30) < 14.0)
    angle = seen(FLAT, ring, (60, 30, 15), ((40, 30, 15), (50, 30)))[0]
    # The cutter's circle and the wall's meet where the sine from the front is (14^2 - 10^2 - 5^2) / (2 * 10 * 5).
    assert angle == approx(90.0 - math.degrees(math.asin(0.71)), abs=STEP + 2.0)


def test_a_shallow_ball_is_seen_where_it_cuts():
    angle, _, depth = seen(bull(10.0, 5.0)(), heights(), (20, 30, 19.6), (60, 30, 19.6))
    assert angle == approx(180.0, abs=2 * STEP)
    assert depth == approx(0.4)


def test_what_tiles_see_adds_up_to_what_the_whole_sees():
    rough = heights(lambda x, y: np.sin(x / 3.0) + np.cos(y / 4.0) > 0.3, cleared=16.0)
    for tool in (FLAT, bull(10.0, 5.0)()):
        assert seen(tool, rough, (20, 20, 14), (70, 33, 14), bands=7) == seen(
            tool, rough, (20, 20, 14), (70, 33, 14)
        )


def test_a_cutter_lying_beside_the_top_is_in_by_its_flank():
    # Its axis along x, 4 mm above the top: 1 mm of its radius of 5 is in, over the 20 mm that its flutes are over the block.
    from leaning_tools import leaning_section

    moves = moves_of([leaning_section(FLAT, [(80, -20, 24), (80, 80, 24)], [(1, 0, 0), (1, 0, 0)])])
    stock = Stock.of(BOX, PITCH, ("x", "y", "z"))
    found = run_stock(stock, moves, WORLD)
    assert math.degrees(found.engagement[1]) == approx(width(1.0), abs=STEP + 3.0)
    assert found.depth_of_cut[1] == approx(20.0, abs=0.6)


def test_a_leaning_cutter_in_solid_material_is_in_by_half_its_circle():
    from leaning_tools import leaning_section

    moves = moves_of(
        [
            leaning_section(
                FLAT,
                [(30, 30, 25), (30, 30, 4), (70, 30, 4)],
                [(0, 0.3, 1), (0, 0.3, 1), (0, 0.3, 1)],
            )
        ]
    )
    found = run_stock(Stock.of(BOX, 0.5), moves, WORLD)
    assert math.degrees(found.engagement[2]) == approx(180.0, abs=2 * STEP)
    assert found.depth_of_cut[2] == approx(16.0 * math.hypot(1.0, 0.3), abs=2.0)


def test_long_moves_are_looked_at_in_a_bounded_number_of_places():
    probes = probes_of(moves_of([program_section(FLAT, [(0, 0, 50), (2, 0, 15), (1000, 0, 15)])]))
    assert np.diff(probes.start).tolist() == [0, 15, MOST_PROBES]


@pytest.mark.parametrize("form", sorted(FORMS))
def test_rings_and_flutes_are_on_the_cutter(form):
    tool = FORMS[form]
    rings, flute = np.array(rings_of(tool)), np.array(flute_of(tool))
    assert (np.diff(rings[:, 1]) <= 0.0).all() and (rings[:, 0] <= rings[0, 0]).all()
    assert (flute[:, 0] <= rings[0, 0] + 1e-9).all() and flute[-1, 1] < tool.flute_length


def test_what_stands_over_the_flutes_is_not_cut():
    disc = flat(10.0)(flute=4.0)
    stops = [(-20, -3.0, 6.0), (120, -3.0, 6.0)]
    assert run(disc, stops).depth_of_cut[1] == approx(4.0)
    assert run(FLAT, stops).depth_of_cut[1] == approx(14.0, abs=0.5)
