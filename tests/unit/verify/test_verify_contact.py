"""The contact engine on closed forms, and its compiled loops against plain ones."""

from __future__ import annotations

import math

import numpy as np
import pytest
from pytest import approx

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.part.shape.facets import Facets
from trunnion.part.shape.surfaces import (
    STRIP_COLUMNS,
    ContactFace,
    Guide,
    Profile,
    TrimEdge,
    circle_edges,
    level_face,
    line_edges,
    strip_row,
    strips_of,
    surfaces_from,
)
from trunnion.verify.contact import PartContact, guide_points
from trunnion.verify.contact import facets as facets_module
from trunnion.verify.contact import strips as strips_module
from trunnion.verify.finish.sweep import Sweep
from trunnion.verify.kernels.contact import strips as kernel
from trunnion.verify.motion import moves_of, poses_of
from verify_tools import FORMS, block_with_pocket, bull, flat, program_section, tool_of

NO_CHORDS, NO_LEVEL = np.zeros((0, 4)), np.zeros((0, STRIP_COLUMNS))


def touched(strips, tool, stops):
    """Return the depths of the last block into strips, cutter first."""
    faces = surfaces_from([ContactFace(1, np.atleast_2d(strips), NO_LEVEL, NO_CHORDS)])
    return PartContact(faces).along(moves_of([program_section(tool, stops)])).depth[-1]


def swept(guide, profile, u0, u1, s0, s1):
    return strip_row(guide, profile, u0, u1, TrimEdge(s0, u0, s0, u1), TrimEdge(s1, u0, s1, u1))


WALL = swept(Guide(0, 0.0, 0.0, 1.0, 0.0), Profile(0.0, 0.0, 0.0, 1.0), 0.0, 20.0, 0.0, 100.0)
BORE = swept(Guide(1, 0.0, 0.0), Profile(20.0, 0.0, 0.0, 1.0), 0.0, 20.0, 0.0, 2 * math.pi)
HOLLOW = swept(
    Guide(0, 0.0, 0.0, 1.0, 0.0), Profile(0.0, 4.0, radius=4.0), math.pi, 1.5 * math.pi, 0.0, 100.0
)


@pytest.mark.parametrize("depth", [0.0, 0.005, 0.3])
def test_a_flat_cutter_along_a_wall_is_as_deep_as_it_stands_off_less_than_its_radius(depth):
    assert touched(WALL, flat(10.0)(), [(10, -40, 5), (10, -5 + depth, 5), (90, -5 + depth, 5)])[
        0
    ] == approx(depth, abs=2e-9)


@pytest.mark.parametrize("depth", [0.005, 0.3])
def test_an_arc_inside_a_bore_is_as_deep_as_both_radii_are_too_large(depth):
    r = 15.0 + depth
    assert touched(BORE, flat(10.0)(), [(r, 0, 5), ((-r, 0.0, 5.0), (0.0, 0.0))])[0] == approx(
        depth, abs=2e-9
    )


@pytest.mark.parametrize("depth", [0.005, 0.05, 0.5])
def test_a_ball_in_a_fillet_of_its_own_radius_is_as_deep_as_it_is_pushed(depth):
    push = depth * math.sqrt(0.5)
    # The fillet is hollow about (w 0, z 4); a ball of radius 4 fits it when its centre is there.
    stops = [(10, -push, -push), (90, -push, -push)]
    assert touched(HOLLOW, bull(8.0, 4.0)(), stops)[0] == approx(depth, abs=tolerance.CONTACT_BOUND)


def test_a_torus_corner_in_a_ring_fillet_is_as_deep_as_it_is_lowered():
    ring = swept(
        Guide(1, 0.0, 0.0),
        Profile(16.0, 4.0, radius=4.0),
        1.5 * math.pi,
        2 * math.pi,
        0.0,
        2 * math.pi,
    )
    r = 20.0 - 6.0
    depth = touched(ring, bull(12.0, 4.0)(), [(r, 0, -0.05), ((-r, 0.0, -0.05), (0.0, 0.0))])[0]
    assert depth == approx(0.05, abs=tolerance.CONTACT_BOUND)


def test_a_sharp_rim_meets_a_slope_at_its_crossing():
    # The plane z = w through the origin, the rim 1 mm inside of it along the normal.
    slope = swept(
        Guide(0, 0.0, 0.0, 1.0, 0.0),
        Profile(0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5)),
        -10.0,
        10.0,
        0.0,
        100.0,
    )
    z = 5.0 - math.sqrt(2.0)
    depth = touched(slope, flat(10.0)(), [(10, 0.0, z), (90, 0.0, z)])[0]
    # Depth counts to the nearest side: floor and flank are equally far at the middle of the chord.
    assert depth == approx(math.sqrt(2.0) / 2, abs=tolerance.CONTACT_BOUND)


def test_a_floor_is_touched_without_a_gouge_and_entered_in_its_middle():
    floor = surfaces_from(
        [level_face(1, 0.0, line_edges(np.array([[0, 0], [50, 0], [50, 50], [0, 50], [0, 0.0]])))]
    )
    depths = PartContact(floor).along(
        moves_of(
            [
                program_section(
                    flat(10.0)(), [(25, 25, 9), (25, 25, 0), (30, 25, 0), (30, 30, -0.03)]
                )
            ]
        )
    )
    assert depths.depth[:, 0] == approx([0.0, 0.0, 0.0, 0.03])
    assert depths.position[3, 0] == approx([30, 25, 0.0], abs=5.1)


def test_a_helix_is_as_deep_as_its_lowest_turn():
    ring = [
        level_face(
            1, 0.0, line_edges(np.array([[-50, -50], [50, -50], [50, 50], [-50, 50], [-50, -50.0]]))
        )
    ]
    stops = [(8, 0, 3.0), ((8.0, 0.0, -0.04), (0.0, 0.0))]
    depth = (
        PartContact(surfaces_from(ring))
        .along(moves_of([program_section(flat(10.0)(), stops)]))
        .depth
    )
    assert depth[1, 0] == approx(0.04, abs=tolerance.CONTACT_BOUND)


def test_a_cutter_that_passes_beyond_the_end_of_a_wall_is_clear():
    assert touched(WALL, flat(10.0)(), [(106, -40, 5), (106, 40, 5)]) == approx([0.0, 0.0])


def test_a_rounded_end_of_a_wall_is_trimmed_exactly():
    # A wall whose right end is a quarter circle of radius 20 about (80, 0): at height 12 it ends at 80 + 16.
    wall = strips_of(
        Guide(0, 0.0, 0.0, 1.0, 0.0),
        Profile(0.0, 0.0, 0.0, 1.0),
        [TrimEdge(0, 0, 0, 20), TrimEdge(100, 0, 80, 20, 80.0, 0.0, 20.0, 1.0)],
        1.0,
    )
    depth = touched(wall, flat(10.0)(), [(101 - 0.5, -40, 12), (101 - 0.5, 40, 12)])[0]
    # The wall ends earlier the higher up: where it is deepest, the flank is as far as the cutter's end.
    assert depth == approx(
        5.0 - (100.5 - 80.0 - math.sqrt(20.0**2 - (12.0 + depth) ** 2)), abs=tolerance.CONTACT_BOUND
    )


def test_shank_and_holder_are_told_apart_from_the_cutter():
    tool = flat(10.0)(flute=5.0)
    # From 18 above the tip the holder's radius is 20; the wall is 20 high and 7 from the axis.
    cutter, above = touched(WALL, tool, [(10, -7, 0), (90, -7, 0)])
    assert (cutter, above) == approx((0.0, 13.0))
    assert touched(WALL, tool, [(10, -7, 12.0), (90, -7, 12.0)]) == approx([0.0, 0.0])


def leaning_wall(lean, low, high):
    """Return a wall along x that leans back over +y by an angle, between two heights."""
    return swept(
        Guide(0, 0.0, 0.0, 1.0, 0.0), Profile(0.0, 0.0, math.tan(lean), 1.0), low, high, 0.0, 100.0
    )


def level(z, low, high, side=1.0):
    """Return the faces of one level rectangle between two corners."""
    (x0, y0), (x1, y1) = low, high
    return surfaces_from(
        [
            level_face(
                1,
                z,
                line_edges(np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1], [x0, y0]], float)),
                side,
            )
        ]
    )


def entered(faces, tool, stops):
    """Return the depths of the last block into faces, cutter first."""
    return PartContact(faces).along(moves_of([program_section(tool, stops)])).depth[-1]


def beside(y, z):
    """Return a rapid and a block along x at one place beside a wall."""
    return [(10.0, y, z), (90.0, y, z)]


# Each depth of 0 is the clean twin of the ones after it: the cutter touches exactly.
PUSHED = pytest.mark.parametrize("depth", [0.0, 0.005, 0.05, 0.3])
BOUND = tolerance.CONTACT_BOUND


@PUSHED
def test_a_ball_over_a_floor_is_as_deep_as_its_lowest_point(depth):
    floor = level(0.0, (0, 0), (100, 50))
    assert entered(
        floor, FORMS["ball"], [(10, 25, 20), (10, 25, -depth), (90, 25, -depth)]
    ) == approx([depth, 0.0], abs=1e-9)


@PUSHED
def test_a_ball_over_a_slope_is_as_deep_as_its_centre_is_nearer_than_its_radius(depth):
    # The plane z = y; a centre straight above the origin is nearer to it by the cosine of 45 degrees.
    slope = swept(
        Guide(0, 0.0, 0.0, 1.0, 0.0),
        Profile(0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5)),
        -10.0,
        10.0,
        0.0,
        100.0,
    )
    assert touched(
        slope, FORMS["ball"], beside(0.0, (5.0 - depth) * math.sqrt(2.0) - 5.0)
    ) == approx([depth, 0.0], abs=BOUND)


@PUSHED
def test_a_bull_cutter_in_a_fillet_of_its_corner_radius_is_as_deep_as_it_is_pushed(depth):
    push = depth * math.sqrt(0.5)
    # The fillet of radius 2 is hollow about (w 0, z 2): the corner's circle fits it with the axis 3 mm away.
    fillet = swept(
        Guide(0, 0.0, 0.0, 1.0, 0.0),
        Profile(0.0, 2.0, radius=2.0),
        1.5 * math.pi,
        2.0 * math.pi,
        0.0,
        100.0,
    )
    assert touched(fillet, FORMS["bull"], beside(-3.0 + push, -push)) == approx(
        [depth, 0.0], abs=BOUND
    )


@PUSHED
def test_a_taper_flank_on_a_wall_of_its_own_lean_is_as_deep_as_it_is_pushed(depth):
    lean = math.radians(10.0)
    # Diameter 6, corner 1: the flank's line meets the tip's height at 2 + (1 - sin) / cos from the axis.
    off = 2.0 + (1.0 - math.sin(lean)) / math.cos(lean)
    wall = leaning_wall(lean, 2.0, 19.0)
    assert touched(wall, FORMS["taper"], beside(-off + depth / math.cos(lean), 0.0)) == approx(
        [depth, 0.0], abs=BOUND
    )


@PUSHED
def test_a_taper_flank_on_an_upright_wall_is_deepest_at_the_walls_top(depth):
    # A tapered ball of radius 2 leans out by 5 degrees: at height 10 it is 2 (1 - sin) / cos + 10 tan from the axis.
    lean = math.radians(5.0)
    off = 2.0 * (1.0 - math.sin(lean)) / math.cos(lean) + 10.0 * math.tan(lean)
    assert touched(
        WALL, FORMS["taper ball"], beside(-off + depth / math.cos(lean), 10.0)
    ) == approx([depth, 0.0], abs=BOUND)


@PUSHED
def test_a_barrel_flank_on_a_wall_is_as_deep_as_its_widest_circle(depth):
    # The widest circle, of radius 5, is 20.41 above the tip, beside the wall's upper half.
    assert touched(WALL, FORMS["barrel"], beside(-5.0 + depth, -5.0)) == approx(
        [depth, 0.0], abs=BOUND
    )


@PUSHED
def test_a_barrel_flank_over_a_walls_top_edge_is_as_deep_as_the_edge_is_in_the_flanks_circle(depth):
    # The flank's circle of radius 60 is about 55 beyond the axis and 2 + sqrt(58^2 - 55^2) up; the wall ends 12 above the tip.
    height = 2.0 + math.sqrt(58.0**2 - 55.0**2) - 12.0
    off = math.sqrt((60.0 - depth) ** 2 - height**2) - 55.0
    assert touched(WALL, FORMS["barrel"], beside(-off, 8.0)) == approx([depth, 0.0], abs=BOUND)


@PUSHED
def test_a_t_slot_cutter_under_a_ledge_is_as_deep_as_it_reaches_above_it(depth):
    # 6 mm thick, its axis 5 mm before the ledge's edge: the neck of radius 4 stays clear.
    ledge = level(10.0, (0, 0), (100, 50), -1.0)
    assert entered(ledge, FORMS["t-slot"], beside(-5.0, 4.0 + depth)) == approx(
        [depth, 0.0], abs=1e-9
    )


@PUSHED
def test_a_t_slot_cutter_that_climbs_is_deepest_where_its_ramp_ends(depth):
    ledge = level(10.0, (0, 0), (100, 50), -1.0)
    assert entered(
        ledge, FORMS["t-slot"], [(10.0, -5.0, 2.0), (90.0, -5.0, 4.0 + depth)]
    ) == approx([depth, 0.0], abs=BOUND)


@PUSHED
def test_the_neck_of_a_t_slot_cutter_meets_the_edge_of_its_ledge(depth):
    ledge = level(10.0, (0, 0), (100, 50), -1.0)
    assert entered(ledge, FORMS["t-slot"], beside(-4.0 + depth, 3.0)) == approx(
        [0.0, depth], abs=1e-9
    )


@PUSHED
def test_a_drill_point_in_a_floor_is_as_deep_as_its_cone(depth):
    # A cone of 120 degrees: its side is nearer than its lowest point is deep, by the sine of 60 degrees.
    floor = level(0.0, (0, 0), (100, 50))
    stops = [(50, 25, 20.0), (50, 25, -depth / math.sin(math.radians(60.0)))]
    assert entered(floor, FORMS["drill"], stops) == approx([depth, 0.0], abs=1e-9)


@PUSHED
def test_a_drill_in_a_bore_of_its_own_radius_is_as_deep_as_it_is_off_the_axis(depth):
    bore = swept(Guide(1, 0.0, 0.0), Profile(4.0, 0.0, 0.0, 1.0), 0.0, 20.0, 0.0, 2 * math.pi)
    assert touched(bore, FORMS["drill"], [(depth, 0, 30.0), (depth, 0, -3.0)]) == approx(
        [depth, 0.0], abs=1e-9
    )


@PUSHED
def test_a_form_cutters_cone_on_a_wall_of_its_lean_is_as_deep_as_it_is_pushed(depth):
    # From (1, 0) to (4, 2): the cone leans out by 1.5 a millimetre, its normal is (2, -3) / sqrt 13.
    wall = leaning_wall(math.atan(1.5), 0.5, 1.5)
    assert touched(
        wall, FORMS["form"], beside(-1.0 + depth * math.sqrt(13.0) / 2.0, 0.0)
    ) == approx([depth, 0.0], abs=BOUND)


@PUSHED
def test_a_form_cutters_cylinder_along_a_wall_is_as_deep_as_it_is_pushed(depth):
    # Radius 7 from 5 to 12 above the tip.
    assert touched(WALL, FORMS["form"], beside(-7.0 + depth, 10.0)) == approx(
        [depth, 0.0], abs=1e-9
    )


@pytest.mark.parametrize("form", FORMS)
@PUSHED
def test_a_tool_of_every_form_meets_a_floor_with_its_tip(form, depth):
    sharp = form == "drill"
    z = -depth / (math.sin(math.radians(60.0)) if sharp else 1.0)
    stops = [(10, 25, 40.0), (10, 25, z), (90, 25, z)]
    assert entered(level(0.0, (0, 0), (100, 50)), FORMS[form], stops) == approx(
        [depth, 0.0], abs=BOUND
    )


@pytest.mark.parametrize("form", FORMS)
@PUSHED
def test_the_holder_of_every_form_is_told_apart_from_what_cuts(form, depth):
    # The nose of the test holder, of radius 12, over a table that stays beyond 11 of the axis.
    tool = FORMS[form]
    table = level(0.0, (0, 11), (100, 50))
    assert entered(table, tool, beside(0.0, -tool.stickout - depth)) == approx(
        [0.0, depth], abs=1e-9
    )


def test_a_cutter_larger_than_a_corner_leaves_it_and_gouges_it_when_it_goes_to_its_centre():
    # A corner of radius 4 about the origin, between walls at x = -4 and y = -4; the cutter's radius is 5.
    corner = swept(
        Guide(1, 0.0, 0.0), Profile(4.0, 0.0, 0.0, 1.0), 0.0, 20.0, math.pi, 1.5 * math.pi
    )
    assert touched(corner, flat(10.0)(), [(20, 1, 5), (1, 1, 5)]) == approx([0.0, 0.0])
    assert touched(corner, flat(10.0)(), [(20, 0, 5), (0, 0, 5)]) == approx([1.0, 0.0])


def test_a_cutter_that_leaves_over_a_floors_edge_before_it_goes_lower_is_clear():
    # Where the axis passes the edge the tip is 3.6 high; the rim leaves it at 0.6.
    floor = level(0.0, (0, 0), (50, 50))
    assert entered(floor, flat(10.0)(), [(25, 25, 9.0), (125, 25, -9.0)]) == approx([0.0, 0.0])


def test_a_cutter_that_ramps_through_a_level_face_is_deepest_half_way_through():
    # A disc 6 mm thick and far wider than that: its middle passes the face at a depth of 3.
    face = level(0.0, (-50, -50), (50, 50))
    assert entered(face, FORMS["t-slot"], [(0, 0, 12.0), (20, 0, -12.0)])[0] == approx(
        3.0, abs=BOUND
    )


@pytest.mark.parametrize(
    ("tool", "depth"),
    [
        (tool_of("drill", diameter=8.0, point_angle=120.0), 0.4 * math.sin(math.radians(60.0))),
        (tool_of("drill", diameter=8.0, point_angle=60.0), 0.4 * math.sin(math.radians(30.0))),
        (bull(1.0, 0.5)(), 0.4),
    ],
)
def test_a_pointed_tool_between_the_rim_of_a_disc_and_its_chords_is_as_deep_as_in_its_middle(
    tool, depth
):
    disc = surfaces_from([level_face(1, 0.0, circle_edges(0.0, 0.0, 10.0, 0.0, math.tau))])
    angle = np.linspace(0.0, math.tau, 201)
    tips = np.column_stack([9.953 * np.cos(angle), 9.953 * np.sin(angle), np.full(201, -0.4)])
    assert PartContact(disc).along(poses_of(tool, tips)).depth[:, 0] == approx(
        np.full(201, depth), abs=1e-9
    )


def test_a_pointed_tool_in_a_hole_beside_the_chords_of_its_rim_is_as_deep_as_its_distance_leaves():
    square = line_edges(np.array([[-50, -50], [50, -50], [50, 50], [-50, 50], [-50, -50.0]]))
    floor = surfaces_from(
        [level_face(1, 0.0, square + circle_edges(0.0, 0.0, 10.0, 0.0, math.tau))]
    )
    angle = np.linspace(0.0, math.tau, 201)
    tips = np.column_stack([9.953 * np.cos(angle), 9.953 * np.sin(angle), np.full(201, -0.4)])
    half = math.radians(30.0)
    depth = (
        PartContact(floor)
        .along(poses_of(tool_of("drill", diameter=8.0, point_angle=60.0), tips))
        .depth[:, 0]
    )
    assert depth == approx(np.full(201, 0.4 * math.sin(half) - 0.047 * math.cos(half)), abs=1e-9)


def test_places_lie_on_the_guide_where_it_is_nearest_to_the_path():
    found = PartContact(surfaces_from([ContactFace(1, WALL[None], NO_LEVEL, NO_CHORDS)])).along(
        moves_of([program_section(flat(10.0)(), [(40, -20, 5), (40, -4.9, 5)])])
    )
    points = guide_points(WALL, float(found.position[-1, 0, 2]), np.linspace(0.0, 1.0, 65))
    assert found.position[-1, 0] == approx(
        points[np.argmin(np.hypot(points[:, 0] - 40.0, points[:, 1] + 4.9))]
    )


def test_any_number_of_threads_measures_the_same(monkeypatch):
    monkeypatch.setattr(strips_module, "CHUNK", 3)
    monkeypatch.setattr(facets_module, "CHUNK", 3)
    # The pocket's floor is entered equally deep by many blocks: the first of them counts.
    stops = [
        (0.0, 0.0, 30.0),
        (0.0, 0.0, 7.95),
        *[(x, y, 7.95) for x in (-9.0, 19.0) for y in np.linspace(-6.0, 6.0, 20)],
    ]
    moves = moves_of([program_section(bull(6.0, 2.0)(), stops)])
    contact = PartContact(
        block_with_pocket(),
        fixtures=[box_mesh((-30, -18, 18), (-8, 18, 30)), box_mesh((21, -18, 18), (30, 18, 30))],
    )
    alone, *others = [contact.along(moves, threads=count) for count in (1, 2, 5)]
    assert alone.face_move[1, 0] == 1 and alone.face_depth[1, 0] == approx(0.05)
    assert set(alone.fixture) == {-1, 0, 1}
    for name in alone.__slots__:
        assert all(
            np.array_equal(getattr(alone, name), getattr(other, name), equal_nan=True)
            for other in others
        )


def test_poses_are_clear_where_nothing_enters_deeper_than_allowed():
    contact = PartContact(block_with_pocket())
    tips = np.array([[0.0, 0.0, 8.0], [0.0, 0.0, 7.99], [0.0, 0.0, 7.9], [0.0, 0.0, 40.0]])
    assert contact.clear(poses_of(bull(6.0, 2.0)(), tips), 0.02).tolist() == [
        True,
        True,
        False,
        True,
    ]


def test_a_leaning_tool_is_refused_where_the_part_has_no_facets():
    with pytest.raises(BadInput, match="needs the part's facets: block 0 leans"):
        PartContact(block_with_pocket()).clear(
            poses_of(flat(10.0)(), np.zeros((1, 3)), np.array([[0.6, 0.0, 0.8]])), 0.02
        )


def box_mesh(low, high):
    """Return the facets of a box, as a clamp is one."""
    corners = np.array(
        [
            [x, y, z]
            for x in (low[0], high[0])
            for y in (low[1], high[1])
            for z in (low[2], high[2])
        ],
        float,
    )
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = np.array([(q[0], q[k], q[k + 1]) for q in quads for k in (1, 2)])
    return Facets.of_mesh(corners, triangles, np.zeros(12, int), np.array([1]))


@PUSHED
def test_a_holder_over_a_clamp_is_a_contact_with_the_fixture_and_not_with_the_part(depth):
    # The holder's nose is 33 above the tip; the clamp's top passes under it, beside the cutter.
    clamps = (box_mesh((200, 200, 0), (210, 210, 10)), box_mesh((30, 7, 0), (60, 40, 33.0 + depth)))
    moves = moves_of([program_section(flat(10.0)(), [(0, 0, 60.0), (0, 0, 0.0), (90, 0, 0.0)])])
    found = PartContact(level(-1.0, (0, 0), (100, 50)), fixtures=clamps).along(moves)
    assert found.depth == approx(np.zeros((3, 2)))
    assert found.fixture_depth == approx([0.0, 0.0, depth], abs=BOUND)
    assert found.fixture.tolist() == [-1, -1, 1 if depth else -1]
    assert np.isnan(found.fixture_position[:2]).all()


def test_a_pose_with_its_cutter_in_a_clamp_is_not_clear():
    contact = PartContact(
        level(-1.0, (0, 0), (100, 50)), fixtures=(box_mesh((30, 7, 0), (60, 40, 20)),)
    )
    assert contact.clear(
        poses_of(flat(10.0)(), np.array([[45, 1.9, 5.0], [45, 2.1, 5.0]])), 0.02
    ).tolist() == [True, False]


def test_compiled_loops_agree_with_themselves_uncompiled():
    moves = moves_of(
        [
            program_section(
                bull(8.0, 2.0)(), [(0, -9, 3), (40, -3.9, 1), ((44.0, 0.0, 1.0), (40.0, 0.1))]
            )
        ]
    )
    guide, path, stack, spans = (
        np.zeros(kernel.MOVE_COLUMNS),
        np.zeros(kernel.MOVE_COLUMNS),
        np.zeros((96, 2)),
        np.zeros((96, 2)),
    )
    for row in moves.row[1:]:
        both = [
            f(
                WALL,
                row,
                moves.bodies.arc,
                moves.bodies.piece[0],
                0.001,
                0.001,
                path,
                guide,
                stack,
                spans,
            )
            for f in (kernel.move_depth, kernel.move_depth.py_func)
        ]
        assert both[0] == approx(both[1], abs=1e-12)


def test_material_left_is_the_distance_to_the_nearest_sweep():
    section = program_section(
        flat(10.0)(flute=8.0), [(0, 0, 20), (0, 0, 2), (50, 0, 2), (50, 0, 20)]
    )
    points = np.array([[25, 0, 0.0], [25, 6, 5], [25, 0, 11.0], [25, 4.5, 2.25], [25, 90, 5]])
    left, _ = Sweep.of(moves_of([section]), 3.0).residual(points, np.full(5, 3.0))
    # Below by 2; beside by 1; above the flutes by 1; inside by a quarter; too far to be looked at.
    assert left == approx([2.0, 1.0, 1.0, -0.25, 3.0])


def test_material_left_by_a_ramp_is_within_the_bound():
    section = program_section(flat(10.0)(), [(0, 0, 10), (100, 0, 0)])
    left, _ = Sweep.of(moves_of([section]), 3.0).residual(
        np.array([[50.0, 0.0, 4.0]]), np.array([3.0])
    )
    # The rim of the flat end reaches (50, z) last when its centre is at 55: 4.5 high.
    assert left == approx([0.5 * 10 / math.hypot(10.0, 1.0)], abs=0.01)
