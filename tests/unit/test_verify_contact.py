"""The contact engine on closed forms, and its compiled loops against plain ones."""

from __future__ import annotations

import math

import numpy as np
import pytest
from pytest import approx

from trunnion import tolerance
from trunnion.part.surfaces import (
    STRIP_COLUMNS,
    Edge,
    Face,
    Guide,
    Profile,
    level_face,
    line_edges,
    strip_row,
    strips_of,
    surfaces_from,
    triangle_face,
)
from trunnion.verify.contact import PartContact
from trunnion.verify.kernels import strips as kernel
from trunnion.verify.motion import moves_of
from trunnion.verify.sweep import Sweep
from verify_tools import bull, flat, program_section

NO_CHORDS, NO_LEVEL = np.zeros((0, 4)), np.zeros((0, STRIP_COLUMNS))


def touched(strips, tool, stops):
    """Return the depths of the last block into strips, cutter first."""
    faces = surfaces_from([Face(1, np.atleast_2d(strips), NO_LEVEL, NO_CHORDS)])
    return PartContact(faces).along(moves_of([program_section(tool, stops)])).depth[-1]


def swept(guide, profile, u0, u1, s0, s1):
    return strip_row(guide, profile, u0, u1, Edge(s0, u0, s0, u1), Edge(s1, u0, s1, u1))


WALL = swept(Guide(0, 0.0, 0.0, 1.0, 0.0), Profile(0.0, 0.0, 0.0, 1.0), 0.0, 20.0, 0.0, 100.0)
BORE = swept(Guide(1, 0.0, 0.0), Profile(20.0, 0.0, 0.0, 1.0), 0.0, 20.0, 0.0, 2 * math.pi)
HOLLOW = swept(Guide(0, 0.0, 0.0, 1.0, 0.0), Profile(0.0, 4.0, radius=4.0), math.pi, 1.5 * math.pi, 0.0, 100.0)


@pytest.mark.parametrize("depth", [0.0, 0.005, 0.3])
def test_a_flat_cutter_along_a_wall_is_as_deep_as_it_stands_off_less_than_its_radius(depth):
    assert touched(WALL, flat(10.0)(), [(10, -40, 5), (10, -5 + depth, 5), (90, -5 + depth, 5)])[0] == approx(depth, abs=2e-9)


@pytest.mark.parametrize("depth", [0.005, 0.3])
def test_an_arc_inside_a_bore_is_as_deep_as_both_radii_are_too_large(depth):
    r = 15.0 + depth
    assert touched(BORE, flat(10.0)(), [(r, 0, 5), ((-r, 0.0, 5.0), (0.0, 0.0))])[0] == approx(depth, abs=2e-9)


@pytest.mark.parametrize("depth", [0.005, 0.05, 0.5])
def test_a_ball_in_a_fillet_of_its_own_radius_is_as_deep_as_it_is_pushed(depth):
    push = depth * math.sqrt(0.5)
    # The fillet is hollow about (w 0, z 4); a ball of radius 4 fits it when its centre is there.
    stops = [(10, -push, -push), (90, -push, -push)]
    assert touched(HOLLOW, bull(8.0, 4.0)(), stops)[0] == approx(depth, abs=tolerance.CONTACT_BOUND)


def test_a_torus_corner_in_a_ring_fillet_is_as_deep_as_it_is_lowered():
    ring = swept(Guide(1, 0.0, 0.0), Profile(16.0, 4.0, radius=4.0), 1.5 * math.pi, 2 * math.pi, 0.0, 2 * math.pi)
    r = 20.0 - 6.0
    depth = touched(ring, bull(12.0, 4.0)(), [(r, 0, -0.05), ((-r, 0.0, -0.05), (0.0, 0.0))])[0]
    assert depth == approx(0.05, abs=tolerance.CONTACT_BOUND)


def test_a_sharp_rim_meets_a_slope_at_its_crossing():
    # The plane z = w through the origin, the rim 1 mm inside of it along the normal.
    slope = swept(Guide(0, 0.0, 0.0, 1.0, 0.0), Profile(0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5)), -10.0, 10.0, 0.0, 100.0)
    z = 5.0 - math.sqrt(2.0)
    depth = touched(slope, flat(10.0)(), [(10, 0.0, z), (90, 0.0, z)])[0]
    # Depth counts to the nearest side: floor and flank are equally far at the middle of the chord.
    assert depth == approx(math.sqrt(2.0) / 2, abs=tolerance.CONTACT_BOUND)


def test_a_floor_is_touched_without_a_gouge_and_entered_in_its_middle():
    floor = surfaces_from([level_face(1, 0.0, line_edges(np.array([[0, 0], [50, 0], [50, 50], [0, 50], [0, 0.0]])))])
    depths = PartContact(floor).along(moves_of([program_section(flat(10.0)(), [(25, 25, 9), (25, 25, 0), (30, 25, 0), (30, 30, -0.03)])]))
    assert depths.depth[:, 0] == approx([0.0, 0.0, 0.0, 0.03])
    assert depths.place[3, 0] == approx([30, 25, 0.0], abs=5.1)


def test_a_helix_is_as_deep_as_its_lowest_turn():
    ring = [level_face(1, 0.0, line_edges(np.array([[-50, -50], [50, -50], [50, 50], [-50, 50], [-50, -50.0]])))]
    stops = [(8, 0, 3.0), ((8.0, 0.0, -0.04), (0.0, 0.0))]
    depth = PartContact(surfaces_from(ring)).along(moves_of([program_section(flat(10.0)(), stops)])).depth
    assert depth[1, 0] == approx(0.04, abs=tolerance.CONTACT_BOUND)


def test_a_cutter_that_passes_beyond_the_end_of_a_wall_is_clear():
    assert touched(WALL, flat(10.0)(), [(106, -40, 5), (106, 40, 5)]) == approx([0.0, 0.0])


def test_a_rounded_end_of_a_wall_is_trimmed_exactly():
    # A wall whose right end is a quarter circle of radius 20 about (80, 0): at height 12 it ends at 80 + 16.
    wall = strips_of(Guide(0, 0.0, 0.0, 1.0, 0.0), Profile(0.0, 0.0, 0.0, 1.0),
                     [Edge(0, 0, 0, 20), Edge(100, 0, 80, 20, 80.0, 0.0, 20.0, 1.0)], 1.0)
    depth = touched(wall, flat(10.0)(), [(101 - 0.5, -40, 12), (101 - 0.5, 40, 12)])[0]
    # The wall ends earlier the higher up: where it is deepest, the flank is as far as the cutter's end.
    assert depth == approx(5.0 - (100.5 - 80.0 - math.sqrt(20.0**2 - (12.0 + depth) ** 2)), abs=tolerance.CONTACT_BOUND)


def test_shank_and_holder_are_told_apart_from_the_cutter():
    tool = flat(10.0)(flute=5.0)
    # From 18 above the tip the holder's radius is 20; the wall is 20 high and 7 from the axis.
    cutter, above = touched(WALL, tool, [(10, -7, 0), (90, -7, 0)])
    assert (cutter, above) == approx((0.0, 13.0))
    assert touched(WALL, tool, [(10, -7, 12.0), (90, -7, 12.0)]) == approx([0.0, 0.0])


def test_triangles_stand_for_a_face_of_any_shape():
    corners = np.array([[0, 0, 0], [40, 0, 0], [0, 0, 30.0]])
    face = triangle_face(1, corners)
    depth = PartContact(surfaces_from([face])).along(moves_of([program_section(flat(10.0)(), [(10, -20, 2), (10, -4.9, 2)])])).depth
    assert depth[1, 0] == approx(0.1)


def test_compiled_loops_agree_with_themselves_uncompiled():
    moves = moves_of([program_section(bull(8.0, 2.0)(), [(0, -9, 3), (40, -3.9, 1), ((44.0, 0.0, 1.0), (40.0, 0.1))])])
    guide, path, stack, spans = (np.zeros(kernel.MOVE_COLUMNS), np.zeros(kernel.MOVE_COLUMNS), np.zeros((96, 2)), np.zeros((96, 2)))
    for row in moves.row[1:]:
        both = [f(WALL, row, moves.bodies.arc, moves.bodies.piece[0], 0.001, 0.001, path, guide, stack, spans)
                for f in (kernel.move_depth, kernel.move_depth.py_func)]
        assert both[0] == approx(both[1], abs=1e-12)


def test_material_left_is_the_distance_to_the_nearest_sweep():
    section = program_section(flat(10.0)(flute=8.0), [(0, 0, 20), (0, 0, 2), (50, 0, 2), (50, 0, 20)])
    points = np.array([[25, 0, 0.0], [25, 6, 5], [25, 0, 11.0], [25, 4.5, 2.25], [25, 90, 5]])
    left, _ = Sweep.of(moves_of([section]), 3.0).left(points, np.full(5, 3.0))
    # Below by 2; beside by 1; above the flutes by 1; inside by a quarter; too far to be looked at.
    assert left == approx([2.0, 1.0, 1.0, -0.25, 3.0])


def test_material_left_by_a_ramp_is_within_the_bound():
    section = program_section(flat(10.0)(), [(0, 0, 10), (100, 0, 0)])
    left, _ = Sweep.of(moves_of([section]), 3.0).left(np.array([[50.0, 0.0, 4.0]]), np.array([3.0]))
    # The rim of the flat end reaches (50, z) last when its centre is at 55: 4.5 high.
    assert left == approx([0.5 * 10 / math.hypot(10.0, 1.0)], abs=0.01)
