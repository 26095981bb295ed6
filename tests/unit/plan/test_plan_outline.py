"""The outline of upright walls that stand free: as wide as all of the part above their foot, and along these walls alone."""

from __future__ import annotations

import cadquery as cq
import numpy as np
import pytest

from milling import cutting, mill
from samples import read
from trunnion.geometry.frame import WORLD
from trunnion.model.blank import Box
from trunnion.model.operation import Operation
from trunnion.model.setup import Setup
from trunnion.part.shape.skin import skin_of
from trunnion.plan.freeform.finishing.areas import on_outline, walls_of
from trunnion.plan.freeform.outline import outline_drive
from trunnion.plan.freeform.reach import samples_on
from trunnion.plan.freeform.space import SurfaceSpace

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
    assert end in on_outline(leaning, samples, walls)


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


def test_the_guide_is_exact_between_sections_too(leaning, end):
    (guide,) = drive_of(leaning, (end,)).walls
    inner = guide.curve.sampled(0.01)
    inner = inner[(inner[:, 1] > 3.0) & (inner[:, 1] < 32.0)]
    assert inner[:, 0] == pytest.approx(40.0, abs=1e-6)


def test_equal_walls_whose_heights_differ_by_noise_share_their_sections():
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
    kept = len(space.part._sections), len(space._above)
    second = drive_of(space, right)
    assert min(kept) > 0 and (len(space.part._sections), len(space._above)) == kept
    assert first.levels[0].bottom == pytest.approx(second.levels[0].bottom, abs=1e-6)
