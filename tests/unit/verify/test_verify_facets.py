"""The contact engine on triangles: closed forms for leaning and turning tools, and what it promises beside its figures."""

from __future__ import annotations

import math
import time

import numpy as np
import pytest
from pytest import approx

from five_axis import five_axis_case, wavy_block
from samples import block_with_pocket_shape, box_shape, drilled_block_shape, read
from trunnion import tolerance
from trunnion.findings import Cancelled, OutOfMemory
from trunnion.geometry.frame import WORLD, Frame
from trunnion.model.motion.program import ProgramSection
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.part.shape import refine_mesh as part_opening
from trunnion.part.shape.facets import Facets, facets_of
from trunnion.part.shape.surfaces import surfaces_of
from trunnion.progress import Progress
from trunnion.verify.contact.facets import FacetContact
from trunnion.verify.kernels import tool_motion as kernel
from trunnion.verify.motion import moves_of, poses_of
from verify_tools import FORMS, bull, flat, tool_of

FIXED, TURNING = tolerance.CONTACT_BOUND, tolerance.TURNING_BOUND
FLOOR = np.array(
    [
        [[-200, -200, 0], [200, -200, 0], [200, 200, 0]],
        [[-200, -200, 0], [200, 200, 0], [-200, 200, 0]],
    ],
    dtype=float,
)
"""A level floor, its diagonal through the origin."""


def contact(triangles, face=None):
    face = np.zeros(len(triangles), int) if face is None else np.asarray(face)
    return FacetContact(
        Facets.of_mesh(
            np.reshape(triangles, (-1, 3)),
            np.arange(3 * len(triangles)).reshape(-1, 3),
            face,
            np.arange(1, face.max() + 2),
        )
    )


def leaning(degrees, about="y"):
    """Return the axis that leans by an angle towards +x (about y) or towards -y (about x)."""
    a = math.radians(degrees)
    return (math.sin(a), 0.0, math.cos(a)) if about == "y" else (0.0, -math.sin(a), math.cos(a))


def going(tool, *stops):
    """Return moves through stops (tip, axis) or (tip, axis, centre of an anticlockwise arc); the first is a rapid."""
    n = len(stops)
    motion = [Motion.RAPID, *(Motion.LINE if len(s) == 2 else Motion.ARC_CCW for s in stops[1:])]
    path = Toolpath(
        position=[s[0] for s in stops],
        axis=[s[1] for s in stops],
        motion=motion,
        centre=[s[2] if len(s) == 3 else [np.nan] * 3 for s in stops],
        feed=[0.0] + [1000.0] * (n - 1),
        mark=[0] * n,
    )
    return moves_of([ProgramSection(operation="op", tool=tool, spindle=10000.0, path=path)])


def touch(triangles, tool, *stops):
    """Return what the last move to the stops touches."""
    moves = going(tool, *stops)
    return contact(triangles).along(moves, np.array([len(moves) - 1]), threads=1)


def depth(triangles, tool, *stops, kind=0):
    return max(float(touch(triangles, tool, *stops).depth[0, kind]), 0.0)


def rim_depth(below, lean):
    """Return how deep a plane is in a square rim that leans and reaches `below` under it: half way between its end face and its flank."""
    return below / (math.sin(math.radians(lean)) + math.cos(math.radians(lean)))


@pytest.mark.parametrize("below", [0.005, 0.05, 0.5])
@pytest.mark.parametrize("lean", [1.0, 12.0, 40.0])
def test_a_flat_end_that_leans_enters_a_floor_with_its_rim(below, lean):
    tip = 5.0 * math.sin(math.radians(lean)) - below
    found = touch(FLOOR, flat(10.0)(), ((0, 0, tip), leaning(lean)), ((30, 7, tip), leaning(lean)))
    assert found.depth[0, 0] == approx(rim_depth(below, lean), abs=FIXED)
    assert found.position[0, 0, 2] == approx(0.0, abs=1e-9)


def test_a_sharp_rim_is_found_on_a_narrow_strip_between_two_places():
    # The strip is 0.02 mm wide and lies across the way, 11.37 mm from its start.
    strip = np.array(
        [
            [[11.37, -3, 0], [11.39, -3, 0], [11.39, 3, 0]],
            [[11.37, -3, 0], [11.39, 3, 0], [11.37, 3, 0]],
        ]
    )
    tip = 5.0 * math.sin(math.radians(10.0)) - 0.03
    stops = ((0, 0, tip), leaning(10.0)), ((40, 0, tip), leaning(10.0))
    assert depth(strip, flat(10.0)(), *stops) == approx(rim_depth(0.03, 10.0), abs=FIXED)


@pytest.mark.parametrize("off", [0.0, 0.004, 0.05, 0.3])
def test_a_ball_is_as_deep_in_a_floor_as_its_lowest_moment_while_its_axis_turns(off):
    tool, z0, z1 = bull(12.0, 6.0)(), 0.8 - off, 1.4 - off
    stops = ((0, 0, z0), leaning(-30.0)), ((9, 4, z1), leaning(50.0))
    t = np.linspace(0.0, 1.0, 100_001)
    lowest = (z0 + t * (z1 - z0) + 6.0 * np.cos(np.radians(-30.0 + 80.0 * t)) - 6.0).min()
    assert depth(FLOOR, tool, *stops) == approx(max(-lowest, 0.0), abs=TURNING)


@pytest.mark.parametrize("below", [0.005, 0.05])
def test_the_flank_of_a_taper_enters_an_edge_by_what_the_edge_stands_over_it(below):
    # The axis leans until the lowest line of the flank is level; a fin stands under the middle of it.
    tool = FORMS["taper"]
    lean = 90.0 - tool.taper_angle
    c, angle = tool.corner_radius, math.radians(tool.taper_angle)
    # The flank's tangent is the distance c from the corner's centre, which lies (radius - c, c) from the tip.
    reach = (tool.radius - c) * math.cos(angle) - c * math.sin(angle) + c
    fin = np.array([[[10, -20, 0], [10, 20, 0], [10, 0, -30]]], dtype=float)
    z = reach - below
    stops = ((0, -2, z), leaning(lean)), ((0, 2, z), leaning(lean))
    assert depth(fin, tool, *stops) == approx(below, abs=FIXED)


@pytest.mark.parametrize("below", [0.01, 0.2])
def test_a_t_slot_cutter_enters_the_underside_of_a_shelf(below):
    tool = FORMS["t-slot"]
    shelf = np.array([[[5, -50, 0], [5, 50, 0], [80, 0, 0]]], dtype=float)
    z = below - tool.flute_length
    assert depth(shelf, tool, ((0, -5, z), leaning(0)), ((0, 5, z), leaning(0))) == approx(
        below, abs=FIXED
    )


@pytest.mark.parametrize("below", [0.02, 0.4])
def test_a_holder_that_turns_towards_a_wall_enters_it_at_the_end(below):
    tool, lean = flat(10.0)(), 25.0
    wall = np.array([[[0, -400, -400], [0, 400, -400], [0, 0, 800]]], dtype=float)
    # The holder's upper rim, 20 mm from the axis, is what comes nearest.
    top = tool.stickout + tool.holder.length
    x = below - top * math.sin(math.radians(lean)) - 20.0 * math.cos(math.radians(lean))
    found = touch(wall, tool, ((x, 0, 0), leaning(0)), ((x, 0, 0), leaning(lean)))
    assert found.depth[0, 1] == approx(rim_depth(below, lean), abs=TURNING)
    assert found.depth[0, 0] == -np.inf


def test_a_wall_touched_by_the_flank_while_the_tool_swings_along_it_is_clean():
    wall = np.array([[[5, -300, -300], [5, 300, -300], [5, 0, 600]]], dtype=float)
    stops = ((0, -20, 0), leaning(-20, "x")), ((0, 20, 3), leaning(30, "x"))
    assert (
        depth(
            wall,
            tool_of(
                "flat",
                holder=FORMS["flat"].holder,
                stickout=90.0,
                neck_length=90.0,
                flute_length=80.0,
                gauge_length=150.0,
            ),
            *stops,
        )
        == 0.0
    )


def test_a_floor_touched_by_a_flat_end_a_bull_and_a_ball_is_clean():
    for tool in (flat(10.0)(), bull(10.0, 2.0)(), bull(10.0, 5.0)()):
        assert depth(FLOOR, tool, ((0, 0, 0), leaning(0)), ((50, 20, 0), leaning(0))) == 0.0


@pytest.mark.parametrize("below", [0.005, 0.05])
def test_an_arc_about_a_leaning_axis_is_as_deep_as_its_circle_runs_below_a_leaning_floor(below):
    tool, axis = flat(10.0)(), np.array(leaning(30))
    across, along = np.array(leaning(120)), np.array([0.0, 1.0, 0.0])
    # The floor stands across the axis: turned like it, the whole end face lies `below` under it.
    floor = FLOOR @ np.stack([across, along, axis])
    centre = 3.0 * along - below * axis
    stops = (centre + 12.0 * across, axis), (centre + 12.0 * along, axis, centre)
    assert depth(floor, tool, *stops) == approx(below, abs=FIXED)


def test_a_helix_and_a_plunge_are_as_deep_as_they_end():
    tool, axis = bull(10.0, 2.0)(), np.array(leaning(20))
    floor = FLOOR @ np.stack([leaning(110), (0.0, 1.0, 0.0), axis])
    helix = (
        (8.0 * np.array(leaning(110)) + 2.0 * axis, axis),
        (np.array([0.0, 8.0, 0.0]) - 0.3 * axis, axis, (0.0, 0.0, 0.0)),
    )
    assert depth(floor, tool, *helix) == approx(0.3, abs=FIXED)
    assert depth(floor, tool, (5.0 * axis, axis), (-0.3 * axis, axis)) == approx(0.3, abs=FIXED)


def test_deeper_than_a_millimetre_is_only_known_to_be_so():
    assert depth(FLOOR, flat(10.0)(), ((0, 0, -7), leaning(3)), ((20, 0, -7), leaning(5))) >= 1.0


def test_of_two_faces_touched_alike_the_first_counts_and_each_has_its_depth():
    lower = FLOOR - [0.0, 0.0, 0.2]
    moves = going(
        flat(10.0)(),
        ((0, 0, -0.5), leaning(0)),
        ((20, 0, -0.5), leaning(0)),
        ((30, 0, -0.5), leaning(0)),
    )
    found = contact(np.vstack([lower, FLOOR, FLOOR]), [2, 2, 1, 1, 0, 0]).along(
        moves, np.array([1, 2]), threads=1
    )
    assert found.face[:, 0].tolist() == [0, 0]
    assert found.face_depth[:, 0] == approx([0.5, 0.5, 0.3], abs=FIXED)
    assert found.face_move[:, 0].tolist() == [1, 1, 1]
    assert (found.face_move[:, 1] == -1).all()


def test_a_pose_is_clear_up_to_what_is_allowed():
    tips = np.array([[0.0, 0.0, z] for z in (0.0, -0.015, -0.025, -3.0)])
    poses = poses_of(flat(10.0)(), tips, np.tile(leaning(0), (4, 1)))
    assert np.isnan(contact(FLOOR).stopped(poses, np.arange(4), 0.02)[:, 0]).tolist() == [
        True,
        True,
        False,
        False,
    ]


CASE = five_axis_case(1600, 3000, "bull", deeper=0.02)
JOB = FacetContact(Facets.of_mesh(CASE.points, CASE.triangles, CASE.face, CASE.tag))


def test_any_number_of_threads_gives_the_same():
    moves = moves_of([CASE.section])
    rows = np.arange(len(moves))
    one, four = JOB.along(moves, rows, threads=1), JOB.along(moves, rows, threads=4)
    assert (one.depth > 0.01).any()
    for name in ("depth", "face", "position", "face_depth", "face_move"):
        assert getattr(one, name).tobytes() == getattr(four, name).tobytes()


def test_cancel_is_heard_within_a_fifth_of_a_second():
    moves, asked = moves_of([CASE.section]), []

    def cancelled():
        asked.append(time.monotonic())
        return len(asked) > 4

    with pytest.raises(Cancelled):
        JOB.along(
            moves, np.tile(np.arange(len(moves)), 40), Progress(cancelled=cancelled), threads=1
        )
    assert max(np.diff(asked)) < 0.2


def test_the_tree_holds_every_triangle_once_inside_its_boxes():
    points, triangles, face = wavy_block(3000)
    tree = FacetContact(Facets.of_mesh(points, triangles, face, np.arange(1, face.max() + 2))).tree
    first, count = tree.leaves[tree.leaves[:, 1] > 0].T
    assert sorted(
        np.concatenate([np.arange(a, a + n) for a, n in zip(first, count, strict=True)])
    ) == list(range(len(triangles)))
    for node in range(0, len(tree.boxes), 97):
        rows = [np.arange(a, a + n) for a, n in tree.leaves[node : tree.skip[node]] if n]
        corners = tree.corners[np.concatenate(rows)].reshape(-1, 3)
        assert (np.abs(corners - tree.boxes[node, :3]) <= tree.boxes[node, 3:] + 1e-9).all()
        assert tree.node_face[node] in (-1, *tree.face[np.concatenate(rows)])


@pytest.mark.parametrize("leading", [[], [0, 2], [1], list(range(6))])
def test_leading_faces_are_asked_alone_by_the_tree_of_all(leading):
    points, triangles, face = wavy_block(3000)
    facets = Facets.of_mesh(points, triangles, face, np.arange(1, face.max() + 2))
    engine, alone = FacetContact(facets, np.array(leading, int)), facets.of_faces(np.array(leading))
    tree, first = engine.tree, engine.of_leading().tree
    assert sorted(map(tuple, tree.corners)) == sorted(map(tuple, points[triangles].reshape(-1, 9)))
    own = FacetContact(alone).tree
    for name in ("boxes", "skip", "leaves", "node_face", "corners", "normals", "face"):
        assert np.array_equal(getattr(first, name), getattr(own, name))
        assert np.shares_memory(getattr(first, name), getattr(tree, name)) or not leading
    moves = moves_of([CASE.section])
    rows = np.arange(0, len(moves), 7)
    one, two = FacetContact(facets).along(moves, rows), engine.along(moves, rows)
    deeper = np.abs(np.maximum(one.depth, 0.0) - np.maximum(two.depth, 0.0))
    assert deeper.max() <= tolerance.TURNING_BOUND < one.depth.max()


def test_compiled_loops_agree_with_themselves_uncompiled():
    way, plain = np.zeros(kernel.MOTION_COLUMNS), np.zeros(kernel.MOTION_COLUMNS)
    start, end, centre = np.array([1.0, 2.0, 3.0]), np.array([4.0, 1.0, 2.0]), np.full(3, np.nan)
    for turned in (leaning(30), leaning(-170), (0.0, 0.0, -1.0)):
        args = start, end, np.array(leaning(0)), np.array(turned), centre, 0.0
        kernel.fill_tool_motion(*args, way)
        kernel.fill_tool_motion.py_func(*args, plain)
        assert way == approx(plain)
        assert kernel.axis_at(way, 1.0) == approx(turned, abs=1e-12)
        assert kernel.tip_at(way, 0.5) == approx((start + end) / 2)


def test_planes_come_as_few_triangles_and_exact():
    facets = facets_of(read(box_shape()), WORLD)
    assert len(facets.triangles) == 12
    assert facets.bound == 0.0


@pytest.mark.parametrize("chord", [0.01, 0.0025])
def test_curved_faces_stay_within_their_measured_bound(chord):
    part = read(drilled_block_shape())
    facets = facets_of(part, WORLD, chord)
    hole = int(np.argmax(np.bincount(facets.face)))
    corners = facets.points[facets.triangles[facets.face == hole]]
    middles = np.vstack(
        [corners.mean(axis=1), 0.5 * (corners + np.roll(corners, -1, axis=1)).reshape(-1, 3)]
    )
    off = np.abs(np.hypot(middles[:, 0] - 20.0, middles[:, 1] - 15.0) - 4.0).max()
    assert 0.0 < off <= chord
    assert off <= facets.bound <= 1.25 * chord


def test_facets_look_out_and_have_the_rows_of_the_exact_faces():
    part = read(block_with_pocket_shape())
    facets = facets_of(part, WORLD)
    assert facets.tag.tolist() == surfaces_of(part, WORLD).tag.tolist()
    assert set(facets.face) == set(range(len(facets.tag)))
    a, b, c = np.moveaxis(facets.points[facets.triangles], 1, 0)
    assert (a * np.cross(b, c)).sum() / 6.0 == approx(part.volume, rel=1e-4)


def test_facets_of_some_faces_leave_the_others_empty_and_move_with_their_frame():
    part, frame = (
        read(drilled_block_shape()),
        Frame(np.array([1.0, 2.0, 3.0]), np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0])),
    )
    some = facets_of(part, WORLD, only=[2, 5])
    assert set(some.tag[some.face]) == {2, 5}
    assert not some.whole
    assert some.moved(WORLD, frame).points == approx(facets_of(part, frame, only=[2, 5]).points)


def test_more_triangles_than_fit_are_refused_with_what_to_do(monkeypatch):
    monkeypatch.setattr(part_opening, "MOST_TRIANGLES", 20)
    with pytest.raises(OutOfMemory, match="allow a larger one"):
        facets_of(read(drilled_block_shape()), WORLD)


def test_triangles_without_area_count_as_the_line_or_point_they_are():
    line, point = np.array([[[0, -9, 0], [0, -9, 0], [0, 9, 0]]], dtype=float), np.zeros((1, 3, 3))
    for thin in (line, line[:, ::-1], line[:, [0, 2, 1]], point):
        assert depth(
            thin, flat(10.0)(), ((-20, 0, -0.3), leaning(0)), ((20, 3, -0.3), leaning(0))
        ) == approx(0.3, abs=FIXED)
