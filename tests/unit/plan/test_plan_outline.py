"""The outline of upright walls that stand free: as wide as all of the part above their foot, and along these walls alone."""

from __future__ import annotations

import cadquery as cq
import numpy as np
import pytest

from milling import cutting, mill
from samples import read
from trunnion import tolerance
from trunnion.geometry.frame import WORLD
from trunnion.model.blank import Box
from trunnion.model.operation import Operation
from trunnion.model.setup import Setup
from trunnion.part.shape.skin import skin_of
from trunnion.plan.freeform.cutters.cutter import level_disc
from trunnion.plan.freeform.finishing.areas import on_outline, walls_of
from trunnion.plan.freeform.outline import outline_drive
from trunnion.plan.freeform.reach import samples_on
from trunnion.plan.freeform.space import SurfaceSpace
from trunnion.progress import NO_PROGRESS
from trunnion.toolpath.plane.profile import ProfileFinishSettings, profile_finish
from trunnion.toolpath.stock.heightfield import PlanningStock, positions_on

BOUND = 0.02


def space_of(shape, high):
    part = read(shape.val().wrapped)
    blank = Box(
        frame=WORLD,
        low=np.array([-1.0, -1.0, 0.0]),
        high=np.array(high),
        material="EN AW-7075",
        density=2.8,
    )
    setup = Setup(name="S1", frame=WORLD, work_offset="G54", clearance=60.0, machine="Trunnion 650")
    return SurfaceSpace.of(part, skin_of(part, WORLD, BOUND), blank, setup)


def drive_of(space, tags):
    operation = Operation(
        id="outline",
        kind="profile_finish",
        strategy="plane.profile_finish",
        feature="group-01",
        setup="S1",
        tool=mill(10.0),
        faces=tags,
        data=cutting(5.0, 0.3),
    )
    return outline_drive(operation, space)


@pytest.fixture(scope="module")
def leaning():
    """A block from which a thin bar stands out that leans by 60 degrees: its end is upright, its sides are not."""
    bar = (
        cq.Workplane("YZ")
        .polyline([(2.0, 2.0), (5.0, 2.0), (33.0, 18.0), (30.0, 18.0)])
        .close()
        .extrude(40.0)
    )
    return space_of(
        cq.Workplane("XY").box(20, 40, 20, centered=False).union(bar), (41.0, 41.0, 21.0)
    )


@pytest.fixture(scope="module")
def end(leaning):
    graph = leaning.part.graph()
    (tag,) = (t for t in leaning.part.tags if graph.centre[t - 1][0] > 39.9)
    return tag


def test_the_end_of_a_leaning_bar_stands_free(leaning, end):
    samples = samples_on(leaning.skin, leaning.part.tags)
    walls = walls_of(samples, leaning.part.tags)
    assert end in on_outline(leaning, walls)


def test_nothing_of_the_part_above_the_walls_foot_is_within_the_boundary(leaning, end):
    drive = drive_of(leaning, (end,))
    (level,) = drive.levels
    samples = samples_on(leaning.skin, leaning.part.tags, 5000)
    above = samples.point[:, 2] > drive.walls[0].bottom + 0.01
    assert (level.boundary.signed_distance(samples.point[above, :2]) < 0.01).all()


def test_the_guide_runs_along_the_own_walls_alone(leaning, end):
    (guide,) = drive_of(leaning, (end,)).walls
    assert not guide.curve.closed
    assert guide.curve.sampled(0.01)[:, 0] == pytest.approx(40.0, abs=0.2)
    assert guide.curve.length == pytest.approx(31.0, abs=0.5)


def test_the_outline_of_a_block_is_exact_and_closed():
    space = space_of(cq.Workplane("XY").box(20, 10, 5, centered=False), (21.0, 11.0, 6.0))
    graph = space.part.graph()
    sides = tuple(t for t in space.part.tags if abs(graph.normal[t - 1][2]) < 0.5)
    (guide,) = drive_of(space, sides).walls
    assert guide.curve.closed and guide.curve.n_segments == 4
    assert guide.curve.area == pytest.approx(-200.0)


def test_one_side_of_a_block_is_cut_along_that_side():
    space = space_of(cq.Workplane("XY").box(20, 10, 5, centered=False), (21.0, 11.0, 6.0))
    graph = space.part.graph()
    (side,) = (t for t in space.part.tags if graph.normal[t - 1][0] > 0.5)
    (guide,) = drive_of(space, (side,)).walls
    assert guide.curve.length == pytest.approx(10.0, abs=0.2)


def test_the_guide_is_exact_at_all_heights(leaning, end):
    (guide,) = drive_of(leaning, (end,)).walls
    inner = guide.curve.sampled(0.01)
    inner = inner[(inner[:, 1] > 3.0) & (inner[:, 1] < 32.0)]
    assert inner[:, 0] == pytest.approx(40.0, abs=1e-6)


def test_equal_walls_whose_heights_differ_by_noise_share_their_plan_area():
    posts = cq.Workplane("XY").box(30.0, 10.0, 4.0, centered=False)
    for x, foot in ((5.0, 4.0), (20.0, 4.0 + 1e-8)):
        posts = posts.union(
            cq.Workplane("XY", origin=(0, 0, foot - 1.0))
            .rect(4.0, 4.0)
            .extrude(9.0)
            .translate((x, 5.0, 0.0))
        )
    space = space_of(posts, (31.0, 11.0, 13.0))
    graph, skin = space.part.graph(), space.skin
    left, right = (
        tuple(
            t
            for t in space.part.tags
            if abs(graph.centre[t - 1][0] - x) < 2.5 and 4.5 < graph.centre[t - 1][2] < 11.5
        )
        for x in (5.0, 20.0)
    )
    assert len(left) == len(right) == 4
    heights = [skin.points[skin.triangles[skin.of(tags)], 2] for tags in (left, right)]
    assert heights[0].max() != heights[1].max()
    first = drive_of(space, left)
    kept = len(space._above)
    second = drive_of(space, right)
    assert kept > 0 and len(space._above) == kept
    assert first.levels[0].bottom == pytest.approx(second.levels[0].bottom, abs=1e-6)


# thin blades


@pytest.fixture(scope="module")
def blade():
    """A hub from which a blade of 0.6 mm stands out that leans by 60 degrees and ends at an upright cylinder of radius 40."""
    thin = (
        cq.Workplane("YZ")
        .polyline([(2.0, 2.0), (2.6, 2.0), (30.6, 18.0), (30.0, 18.0)])
        .close()
        .extrude(60.0)
        .intersect(cq.Workplane("XY").circle(40.0).extrude(20.0))
    )
    return space_of(cq.Workplane("XY").circle(12.0).extrude(20.0).union(thin), (41.0, 41.0, 21.0))


@pytest.fixture(scope="module")
def edge(blade):
    """The blade's end."""
    graph = blade.part.graph()
    return max(blade.part.tags, key=lambda t: np.hypot(*graph.centre[t - 1][:2]))


def test_no_height_of_a_thin_blade_stands_out_of_its_outline(blade, edge):
    drive = drive_of(blade, (edge,))
    samples = samples_on(blade.skin, blade.part.tags, 20_000)
    above = samples.point[:, 2] > drive.walls[0].bottom + tolerance.SEW
    (level,) = drive.levels
    outside = level.boundary.signed_distance(samples.point[above, :2])
    assert outside.max() < tolerance.COINCIDENT


def test_the_guide_of_a_thin_blade_is_one_arc_from_end_to_end(blade, edge):
    (guide,) = drive_of(blade, (edge,)).walls
    assert guide.curve.n_segments == 1
    assert np.hypot(*guide.curve.sampled(0.001).T) == pytest.approx(40.0, abs=1e-3)
    own = blade.skin.points[blade.skin.triangles[blade.skin.of((edge,))]].reshape(-1, 3)
    turn = np.arctan2(own[:, 1], own[:, 0])
    assert guide.curve.length == pytest.approx(40.0 * np.ptp(turn), abs=1e-3)


@pytest.mark.parametrize("diameter", [2.0, 10.0])
def test_the_profile_of_a_thin_blade_stays_out_of_the_part(blade, edge, diameter):
    tool = mill(diameter)
    path = profile_finish(
        drive_of(blade, (edge,)),
        tool,
        cutting(5.0, 0.3),
        PlanningStock.of(blade.blank, blade.setup),
        blade.setup,
        ProfileFinishSettings(),
        NO_PROGRESS,
    ).path
    rows = np.repeat(np.arange(1, len(path)), 50)
    at = positions_on(path, rows, np.tile(np.linspace(0.0, 1.0, 50), len(path) - 1))
    disc = level_disc(tool.radius - tolerance.FINISH_GOUGE)
    over = blade.skin.drop.drop(at[:, :2], disc, float(blade.low[2]) - 1.0)
    assert (at[:, 2] < 10.0).any()
    assert (over <= at[:, 2] + tolerance.SEW).all()


# holes


def drilled(radius):
    """Return a dome with an upright hole through its middle, and the tags of the hole."""
    dome = (
        cq.Workplane("XY")
        .sphere(60.0)
        .translate((15.0, 15.0, -48.0))
        .intersect(cq.Workplane("XY").box(30.0, 30.0, 20.0, centered=False))
    )
    made = dome.cut(cq.Workplane("XY", origin=(15.0, 15.0, 0.0)).circle(radius).extrude(30.0))
    space = space_of(made, (31.0, 31.0, 13.0))
    graph = space.part.graph()
    return space, tuple(t for t in space.part.tags if graph.surface[t - 1] == "cylinder")


def test_walls_round_a_hole_are_followed_inside_it():
    space, tags = drilled(8.0)
    (guide,) = drive_of(space, tags).walls
    assert guide.curve.closed and guide.curve.area == pytest.approx(np.pi * 64.0, rel=1e-4)
    assert not guide.is_around


def test_other_holes_are_filled():
    space, tags = drilled(8.0)
    graph = space.part.graph()
    sides = tuple(t for t in space.part.tags if t not in tags and abs(graph.normal[t - 1][2]) < 0.1)
    drive = drive_of(space, sides)
    assert drive.levels[0].boundary.signed_distance(np.array([[15.0, 15.0]]))[0] < 0.0


def test_a_post_in_a_hole_stays_where_it_is():
    plate = cq.Workplane("XY").circle(20.0).extrude(2.0)
    ring = cq.Workplane("XY").circle(20.0).circle(14.0).extrude(10.0)
    post = cq.Workplane("XY").circle(3.0).extrude(10.0)
    space = space_of(plate.union(ring).union(post), (21.0, 21.0, 11.0))
    graph, skin = space.part.graph(), space.skin
    hole = tuple(
        t
        for t in space.part.tags
        if np.hypot(*skin.points[skin.triangles[skin.of((t,))]].reshape(-1, 3)[:, :2].T)
        == pytest.approx(14.0)
    )
    assert graph.surface[hole[0] - 1] == "cylinder"
    level = drive_of(space, hole).levels[0]
    near = level.boundary.signed_distance(np.array([[0.0, 0.0], [8.0, 0.0], [17.0, 0.0]]))
    assert (near > 0.0).tolist() == [False, True, False]


# walls that are not the same at all heights


@pytest.mark.parametrize(
    ("lean", "free"), [(0.0, True), (0.005, True), (0.02, False), (0.3, False)]
)
def test_a_wall_that_leans_has_no_outline(lean, free):
    """The first side of a block of 20 mm leans by some degrees: nothing, noise, more than noise."""
    off = 20.0 * np.tan(np.radians(lean))
    shape = (
        cq.Workplane("XZ")
        .polyline([(0.0, 0.0), (30.0, 0.0), (30.0 - off, 20.0), (0.0, 20.0)])
        .close()
        .extrude(-20.0)
    )
    space = space_of(shape, (31.0, 21.0, 21.0))
    graph = space.part.graph()
    (side,) = (t for t in space.part.tags if graph.normal[t - 1][0] > 0.5)
    samples = samples_on(space.skin, space.part.tags)
    upright = walls_of(samples, space.part.tags)
    assert side in upright
    assert (side in on_outline(space, upright)) == free


def test_a_wall_that_twists_has_no_outline():
    """The side of a block is ruled between two lines that cross in plan: upright in its middle alone."""
    low, high = (
        cq.Edge.makeLine(*ends)
        for ends in (
            (cq.Vector(30.004, 0, 0), cq.Vector(29.996, 20, 0)),
            (cq.Vector(29.996, 0, 20), cq.Vector(30.004, 20, 20)),
        )
    )
    side = cq.Face.makeRuledSurface(low, high)
    corners = {
        "low": [(0, 0, 0), (30.004, 0, 0), (29.996, 20, 0), (0, 20, 0)],
        "high": [(0, 0, 20), (29.996, 0, 20), (30.004, 20, 20), (0, 20, 20)],
        "back": [(0, 0, 0), (0, 20, 0), (0, 20, 20), (0, 0, 20)],
        "first": [(0, 0, 0), (30.004, 0, 0), (29.996, 0, 20), (0, 0, 20)],
        "last": [(0, 20, 0), (29.996, 20, 0), (30.004, 20, 20), (0, 20, 20)],
    }
    faces = [
        cq.Face.makeFromWires(cq.Wire.makePolygon([cq.Vector(*p) for p in [*ring, ring[0]]]))
        for ring in corners.values()
    ]
    solid = cq.Solid.makeSolid(cq.Shell.makeShell([side, *faces]))
    space = space_of(cq.Workplane(solid), (31.0, 21.0, 21.0))
    graph = space.part.graph()
    (twisted,) = (t for t in space.part.tags if graph.centre[t - 1][0] > 29.0)
    samples = samples_on(space.skin, space.part.tags)
    upright = walls_of(samples, space.part.tags)
    assert twisted in upright
    assert twisted not in on_outline(space, upright)


def test_a_wall_with_something_before_one_end_does_not_stand_free():
    block = cq.Workplane("XY").box(40.0, 60.0, 40.0, centered=False).translate((-40.0, 0.0, -20.0))
    bar = cq.Workplane("XY").box(40.0, 10.0, 4.0, centered=False)
    longer = cq.Workplane("XY").box(40.5, 2.0, 4.0, centered=False).translate((0.0, 11.0, 0.0))
    space = space_of(block.union(bar).union(longer), (42.0, 61.0, 21.0))
    graph = space.part.graph()
    first, second = (
        next(t for t in space.part.tags if graph.centre[t - 1][0] == pytest.approx(x))
        for x in (40.0, 40.5)
    )
    assert on_outline(space, (first, second)) == (second,)


# plan curves


def sides_of(space):
    skin = space.skin
    return tuple(
        t
        for t in space.part.tags
        if np.allclose(skin.normals[skin.triangles[skin.of((t,))], 2], 0.0)
    )


def rounded(x, y, radius):
    return cq.Workplane("XY").rect(x, y).extrude(10.0).edges("|Z").fillet(radius)


CORNER = 4.0 - np.pi
ELBOW = [(0.0, 0.0), (40.0, 0.0), (40.0, 10.0), (10.0, 10.0), (10.0, 40.0), (0.0, 40.0)]


@pytest.mark.parametrize(
    ("shape", "outer", "segments"),
    [
        (cq.Workplane("XY").circle(20.0).extrude(10.0), 400.0 * np.pi, 2),
        (rounded(40.0, 30.0, 5.0), 1200.0 - 25.0 * CORNER, 8),
        (cq.Workplane("XY").polyline(ELBOW).close().extrude(10.0), 700.0, 6),
        (cq.Workplane("XY").polyline([(0, 0), (40, 0), (0, 6)]).close().extrude(10.0), 120.0, 3),
    ],
    ids=["cylinder", "rounded", "elbow", "acute"],
)
def test_the_outline_has_the_walls_own_lines_and_arcs(shape, outer, segments):
    space = space_of(shape, (41.0, 41.0, 11.0))
    (guide,) = drive_of(space, sides_of(space)).walls
    assert guide.curve.closed and guide.curve.n_segments == segments
    assert guide.curve.area == pytest.approx(-outer, rel=1e-8)


def test_a_rounded_hole_is_followed_by_its_own_lines_and_arcs():
    shape = rounded(40.0, 30.0, 5.0).cut(rounded(20.0, 12.0, 4.0))
    space = space_of(shape, (21.0, 16.0, 11.0))
    hole = max((w.curve for w in drive_of(space, sides_of(space)).walls), key=lambda c: c.area)
    assert hole.area == pytest.approx(240.0 - 16.0 * CORNER, rel=1e-8)
    assert hole.n_segments == 8


def test_arcs_stand_for_a_wall_that_is_none():
    space = space_of(cq.Workplane("XY").ellipse(30.0, 15.0).extrude(10.0), (31.0, 16.0, 11.0))
    (guide,) = drive_of(space, sides_of(space)).walls
    x, y = guide.curve.sampled(1e-5).T
    # How far off an ellipse a point near it is, to the first order.
    off = (x * x / 900.0 + y * y / 225.0 - 1.0) / (2.0 * np.hypot(x / 900.0, y / 225.0))
    assert np.abs(off).max() < 2.0 * tolerance.FITTED


def test_a_patch_that_is_cut_with_the_walls_is_no_wall():
    shape = cq.Workplane("XY").rect(40.0, 30.0).extrude(10.0).faces(">Z").edges(">X").chamfer(0.001)
    space = space_of(shape, (21.0, 16.0, 11.0))
    walls = sides_of(space)
    graph = space.part.graph()
    (patch,) = (t for t in space.part.tags if 0.1 < graph.normal[t - 1][2] < 0.9)
    (guide,) = drive_of(space, (*walls, patch)).walls
    assert guide.curve.area == pytest.approx(-1200.0)
