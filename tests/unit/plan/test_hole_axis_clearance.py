"""What of a part's triangles stands around a hole: never said to be farther than it is, and no section where nothing is near."""

from __future__ import annotations

from types import SimpleNamespace

import cadquery as cq
import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from flat_parts import MILL
from shaped_parts import part_of_shape
from trunnion import tolerance
from trunnion.geometry.frame import WORLD, Frame
from trunnion.geometry.sheet.skin import Skin
from trunnion.model.blank import Box
from trunnion.model.feature import Recognition
from trunnion.part.shape.skin import skin_of
from trunnion.plan.holes.axis_clearance import AxisClearance, SkinGroups
from trunnion.plan.holes.hole import PlannedHole
from trunnion.plan.holes.tools import AROUND, HoleSpace
from trunnion.plan.prismatic.regions import SetupSpace
from trunnion.plan.setups import SetupSettings, make_setups
from trunnion.settings import choose

AXIS = np.array([3.0, -2.0])
LEANING = Frame(np.array([1.0, 2.0, 3.0]), np.array([0.8, 0.6, 0.0]), np.array([0.36, -0.48, 0.8]))
CORNERS = arrays(np.float64, (4, 3, 3), elements=st.floats(-40.0, 40.0, width=32))
SHARES = np.random.default_rng(4).dirichlet(np.ones(3), 300)


def skin_from(corners) -> Skin:
    rows = np.arange(corners.size // 3).reshape(-1, 3)
    points = LEANING.to_world(corners.reshape(-1, 3))
    return Skin(
        points=points,
        normals=np.tile([0.0, 0.0, 1.0], (len(points), 1)),
        triangles=rows,
        face=np.ones(len(rows), np.int64),
        bound=0.0,
    )


def clipped(corners, z):
    """Return the points of a dense net over triangles that are over a height, by its barycentric shares: the reference."""
    points = (SHARES @ corners).reshape(-1, 3)
    return points[points[:, 2] >= z]


@settings(deadline=None)
@given(corners=CORNERS, z=st.floats(-40.0, 40.0), within=st.floats(1.0, 80.0))
def test_no_point_of_a_triangle_from_a_height_on_is_nearer_than_the_bound(corners, z, within):
    near = AxisClearance.near(SkinGroups.of(skin_from(corners)), 0.0, LEANING, AXIS, within)
    away = np.linalg.norm(clipped(corners, z + 1e-9)[:, :2] - AXIS, axis=1)
    least, most = near.distance_from(z)
    assert min(away.min(initial=np.inf), within) >= min(least, within) - 1e-9
    assert least <= most


@pytest.mark.parametrize("seed", range(40))
def test_both_bounds_are_the_distance_of_what_is_over_the_height(seed):
    pick = np.random.default_rng(seed)
    corners, z = pick.uniform(-40.0, 40.0, (4, 3, 3)), float(pick.uniform(-40.0, 30.0))
    found = AxisClearance.near(SkinGroups.of(skin_from(corners)), 0.0, LEANING, AXIS, 200.0)
    least, most = found.distance_from(z)
    assert least == most
    away = [shapely.Polygon(c).distance(shapely.Point(AXIS)) for c in map(over(z), corners) if c]
    assert least == pytest.approx(min(away, default=np.inf), abs=1e-9)


def over(z):
    """Return what clips a triangle (3, 3) at a height: the plan corners of what is over it, by Sutherland and Hodgman."""

    def clip(triangle):
        found = []
        for start, end in zip(triangle, np.roll(triangle, -1, axis=0), strict=True):
            if start[2] > z:
                found.append(tuple(start[:2]))
            if (start[2] > z) != (end[2] > z):
                share = (z - start[2]) / (end[2] - start[2])
                found.append(tuple((start + share * (end - start))[:2]))
        return found

    return clip


def test_of_a_triangle_that_is_partly_over_the_height_only_that_part_counts():
    """The whole of it was taken for high: a hole in a slope was never free of it."""
    corners = np.array([[[10.0, -1.0, 0.0], [10.0, 1.0, 0.0], [30.0, 0.0, 20.0]]])
    found = AxisClearance.near(SkinGroups.of(skin_from(corners)), 0.0, LEANING, np.zeros(2), 200.0)
    assert found.distance_from(10.0) == pytest.approx((20.0, 20.0))
    assert found.distance_from(25.0) == (np.inf, np.inf)
    above = np.array([[[-30.0, -10.0, 0.0], [-30.0, 10.0, 0.0], [30.0, 0.0, 20.0]]])
    found = AxisClearance.near(SkinGroups.of(skin_from(above)), 0.0, LEANING, np.zeros(2), 200.0)
    assert found.distance_from(9.9)[0] == 0.0
    assert found.distance_from(12.0) == pytest.approx((6.0, 6.0))


@pytest.mark.parametrize("count", [1, 63, 64, 65, 200])
def test_groups_hold_their_triangles_and_none_near_an_axis_is_missed(count):
    corners = np.random.default_rng(count).uniform(-50.0, 50.0, (count, 1, 3))
    corners = corners + np.random.default_rng(1).uniform(-2.0, 2.0, (count, 3, 3))
    groups = SkinGroups.of(skin_from(corners))
    away = np.linalg.norm(corners[:, :, :2] - AXIS, axis=2).min(axis=1)
    rows = groups.near(LEANING, AXIS, 5.0)
    assert set(np.flatnonzero(away <= 5.0)) <= set(rows.tolist())


@pytest.fixture(scope="module")
def space():
    """A plate with a wall that leans over it, a round post and a bridge from one to the other."""
    plate = cq.Workplane("XY").box(120.0, 80.0, 10.0, centered=False)
    wall = cq.Workplane("XZ", origin=(0.0, 80.0, 0.0)).polyline(
        [(110.0, 10.0), (120.0, 10.0), (112.0, 50.0), (102.0, 50.0)]
    )
    post = cq.Workplane("XY", origin=(30.0, 40.0, 10.0)).circle(8.0).extrude(30.0)
    bridge = cq.Workplane("XY", origin=(30.0, 34.0, 30.0)).box(85.0, 12.0, 6.0, centered=False)
    made = plate.union(wall.close().extrude(80.0)).union(post).union(bridge)
    part = part_of_shape(made.val().wrapped)
    recognition = Recognition(family="panel", frame=WORLD, features=())
    blank = Box(frame=WORLD, low=(-5, -5, -5), high=(125, 85, 60), material="C45", density=7.8)
    setup = make_setups(recognition, blank, choose(SetupSettings, MILL))[0]
    return SetupSpace.of(part, recognition, blank, setup)


def hole_at(space, x, y) -> PlannedHole:
    low = space.setup.frame.to_local(np.array([x, y, 0.0]))
    return PlannedHole(
        feature="hole",
        x=float(low[0]),
        y=float(low[1]),
        top=float(low[2]) + 10.0,
        bottom=float(low[2]),
        diameter=6.0,
        through=True,
    )


def test_triangles_say_of_free_space_what_sections_do(space):
    skin = skin_of(space.part, WORLD, tolerance.CHORD)
    quick, exact = (
        HoleSpace(space=space, clearance=1.0, groups=b) for b in (SkinGroups.of(skin), None)
    )
    pick, told = np.random.default_rng(8), 0
    for x, y, up, radius in zip(
        pick.uniform(2, 100, 60),
        pick.uniform(2, 78, 60),
        pick.uniform(0.5, 45, 60),
        pick.uniform(2, 40, 60),
        strict=True,
    ):
        hole = hole_at(space, x, y)
        away = exact.free_radius(hole, hole.top + up)
        if abs(away - radius) > 0.1:
            assert quick.is_free(hole, hole.top + up, radius) == (away >= radius)
            told += 1
    assert told > 50


def test_sections_are_made_only_where_triangles_are_not_exact_enough(space):
    skin = skin_of(space.part, WORLD, tolerance.CHORD)
    lonely = SimpleNamespace(top=space.top, setup=space.setup)
    around = HoleSpace(space=lonely, clearance=1.0, groups=SkinGroups.of(skin))
    corner = hole_at(space, 5.0, 5.0)
    assert around.is_open(corner)
    assert around.is_free(corner, corner.top + 1.0, 20.0)
    assert not around.is_free(corner, corner.top + 1.0, AROUND - 1.0)
    # What is within the triangles' error is asked of sections.
    near = hole_at(space, 30.0, 22.0)
    with pytest.raises(AttributeError):
        around.is_free(near, near.top + 1.0, 10.0)
