"""What of a part's triangles stands around a hole: never said to be farther than it is, and no section where nothing is near."""

from __future__ import annotations

from types import SimpleNamespace

import cadquery as cq
import numpy as np
import pytest
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
from trunnion.plan.holes.axis_clearance import AxisClearance
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


@settings(deadline=None)
@given(corners=CORNERS, z=st.floats(-40.0, 40.0), within=st.floats(1.0, 80.0))
def test_no_point_of_a_triangle_from_a_height_on_is_nearer_than_the_bound(corners, z, within):
    near = AxisClearance.near(skin_from(corners), 0.0, LEANING, AXIS, within)
    points = (SHARES @ corners).reshape(-1, 3)
    away = np.linalg.norm(points[points[:, 2] >= z + 1e-9, :2] - AXIS, axis=1)
    assert min(away.min(initial=np.inf), within) >= min(near.distance_from(z), within) - 1e-9


@settings(deadline=None)
@given(corners=CORNERS)
def test_of_triangles_that_are_all_over_the_height_it_is_their_distance(corners):
    points = (SHARES @ corners).reshape(-1, 3)[:, :2]
    nearest = np.linalg.norm(points - AXIS, axis=1).min()
    found = AxisClearance.near(skin_from(corners), 0.0, LEANING, AXIS, 200.0).distance_from(-50.0)
    # No triangle is wider than 160 mm, and its points are drawn that densely.
    assert nearest - 40.0 <= found <= nearest + 1e-9


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


def test_triangles_call_free_only_what_sections_do(space):
    skin = skin_of(space.part, WORLD, tolerance.CHORD)
    quick, exact = (HoleSpace(space=space, clearance=1.0, skin=s) for s in (skin, None))
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


def test_no_section_is_made_where_nothing_stands_near(space):
    skin = skin_of(space.part, WORLD, tolerance.CHORD)
    lonely = SimpleNamespace(top=space.top, setup=space.setup)
    around = HoleSpace(space=lonely, clearance=1.0, skin=skin)
    corner = hole_at(space, 5.0, 5.0)
    assert around.is_open(corner)
    assert around.is_free(corner, corner.top + 1.0, 20.0)
    with pytest.raises(AttributeError):
        around.is_free(corner, corner.top + 1.0, AROUND - 1.0)
