"""Blanks of every kind: box, body of revolution, triangles; what they answer, held against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from pytest import approx

from trunnion.geometry.frame import WORLD, Frame
from trunnion.geometry.kernels.revolved_rays import inside_outline
from trunnion.geometry.mesh import Mesh, welded
from trunnion.model.blank import Box, Faceted, Revolved
from trunnion.model.blank.base import BlankBase
from trunnion.model.setup import Setup
from trunnion.pipeline.proof.playback import fresh_of
from trunnion.store.mapping import Members, from_xml, to_xml
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.verify.stock import Stock
from trunnion.verify.stock.mesh import mesh_of

RADIUS, BOTTOM, TOP = 12.0, -5.0, 20.0
RING = np.array([[4.0, 0.0], [10.0, 0.0], [8.0, 6.0], [4.0, 6.0]])
"""A ring with a bore of 8 mm whose outside is a cone."""
ASKEW = Frame(np.array([3.0, -2.0, 7.0]), np.array([0.8, 0.6, 0.0]), np.array([0.36, -0.48, 0.8]))
UP, ACROSS = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])
SLANTED = np.array([0.48, 0.6, 0.64])


def bar(axis: str = "z", frame: Frame = WORLD) -> Revolved:
    return Revolved.cylinder(frame, RADIUS, (BOTTOM, TOP), "test", 2.8, axis)


def ring(frame: Frame = WORLD) -> Revolved:
    return Revolved(frame=frame, outline=RING, material="test", density=2.8)


def box(frame: Frame = WORLD) -> Box:
    return Box(frame=frame, low=(-5, -4, -3), high=(5, 4, 3), material="test", density=2.8)


def faceted(solid, frame: Frame = WORLD) -> Faceted:
    """Return the triangles of a solid's shell as a blank of its own."""
    points, triangles = solid.shell()
    return Faceted(frame=frame, points=points, triangles=triangles, material="test", density=2.8)


ALL = [box(), bar(), bar("x"), bar("y"), ring(), faceted(box()), faceted(ring())]


def scattered(n: int = 4000) -> np.ndarray:
    return np.random.default_rng(3).uniform(-15.0, 25.0, (n, 3))


@pytest.mark.parametrize("blank", ALL, ids=lambda b: b.kind)
def test_what_lies_between_the_corners_of_a_box_lies_in_it(blank):
    corners = blank.corners(blank.frame)
    assert (blank.inward(corners).min() >= -1e-9) or not blank.is_box
    assert blank.is_box == isinstance(blank, Box)


def test_volumes_are_those_of_the_textbook():
    assert bar().volume == approx(math.pi * RADIUS**2 * (TOP - BOTTOM))
    cone = math.pi * 6.0 / 3.0 * (10.0**2 + 10.0 * 8.0 + 8.0**2)
    assert ring().volume == approx(cone - math.pi * 4.0**2 * 6.0)
    assert faceted(box()).volume == approx(10 * 8 * 6) and box().mass == approx(480 * 2.8e-6)


@pytest.mark.parametrize("blank", ALL, ids=lambda b: b.kind)
def test_every_blank_lies_in_its_own_box(blank):
    inside = blank.inward(scattered()) > 0.0
    points = scattered()[inside]
    assert len(points)
    assert (points >= blank.low).all() and (points <= blank.high).all()


@pytest.mark.parametrize("direction", [UP, ACROSS, SLANTED], ids=["up", "across", "slanted"])
@pytest.mark.parametrize("blank", ALL, ids=lambda b: b.kind)
def test_rays_are_inside_where_points_on_them_are(blank, direction):
    start = scattered(400)
    found = blank.intervals(start, direction)
    for along in np.linspace(-40.0, 40.0, 41):
        inward = blank.inward(start + along * direction)
        said = np.zeros(len(start), bool)
        for k in range(found.low.shape[1]):
            said |= (k < found.count) & (found.low[:, k] <= along) & (along <= found.high[:, k])
        sure = np.abs(inward) > 1e-9
        assert (said == (inward > 0.0))[sure].all()


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("ends", [(-100.0, 100.0), (1.0, 2.0), (50.0, 60.0)])
def test_rays_of_a_grid_through_a_box_are_those_of_its_slabs(axis, ends):
    box = Box(frame=WORLD, low=[-3, -4, -5], high=[3, 4, 5], material="x", density=1.0)
    u, v = np.linspace(-6.0, 6.0, 13), np.linspace(-7.0, 7.0, 15)
    quick, plain = (
        box.grid_intervals(axis, u, v, ends),
        BlankBase.grid_intervals(box, axis, u, v, ends),
    )
    assert (plain.count.sum() > 0) == (ends[0] < 5.0)
    for a, b in ((quick.count, plain.count), (quick.low, plain.low), (quick.high, plain.high)):
        np.testing.assert_array_equal(a, b)


def test_a_ray_through_a_ring_is_inside_twice():
    found = ring().intervals(np.array([[-20.0, 0.0, 3.0]]), ACROSS)
    assert found.count.tolist() == [2]
    assert found.low[0] == approx([11.0, 24.0]) and found.high[0] == approx([16.0, 29.0])


def test_a_ray_down_the_edge_of_two_triangles_crosses_the_surface_once():
    cube = faceted(box())
    corners = cube.points[:, :2]
    middles = 0.5 * (corners.min(axis=0) + corners.max(axis=0))
    start = np.array([[*middles, -50.0], [0.0, 2.0, -50.0], [2.5, 2.0, -50.0], [0.0, 0.0, -50.0]])
    found = cube.intervals(start, UP)
    assert found.count.tolist() == [1, 1, 1, 1]
    assert found.low[:, 0] == approx([47.0] * 4) and found.high[:, 0] == approx([53.0] * 4)


def test_solids_of_one_file_that_overlap_are_one():
    points, triangles = box().shell()
    both = np.vstack([points, points + [4.0, 0.0, 0.0]])
    twice = np.vstack([triangles, triangles + len(points)])
    blank = Faceted(frame=WORLD, points=both, triangles=twice, material="test", density=1.0)
    found = blank.intervals(np.array([[-20.0, 0.5, 0.25]]), ACROSS)
    assert (found.count[0], found.low[0, 0], found.high[0, 0]) == (1, approx(15.0), approx(29.0))


@pytest.mark.parametrize("axis", ["x", "y", "z"])
def test_the_box_of_a_bar_is_as_small_as_it_can_be(axis):
    k = "xyz".index(axis)
    low, high = bar(axis).box_in(Frame(np.zeros(3), SLANTED * [1, 1, 0], UP))
    along = bar(axis).frame.axes[k]
    turned = Frame(np.zeros(3), SLANTED * [1, 1, 0], UP).local_direction(along)
    across = RADIUS * np.sqrt(1.0 - turned**2)
    assert high == approx(across + np.maximum(BOTTOM * turned, TOP * turned))
    assert low == approx(-across + np.minimum(BOTTOM * turned, TOP * turned))


def test_the_corners_of_a_box_in_a_frame_that_stands_askew():
    corners = box().corners(ASKEW)
    assert ASKEW.to_world(corners).max(axis=0) == approx([5, 4, 3])
    low, high = box().box_in(ASKEW)
    assert (low == corners.min(axis=0)).all() and (high == corners.max(axis=0)).all()


def test_depth_is_the_distance_to_the_surface_and_nothing_outside():
    points = np.array([[0.0, 0.0, 0.0], [11.0, 0.0, 5.0], [0.0, 11.0, 19.5], [13.0, 0.0, 5.0]])
    assert bar().depth(points, WORLD) == approx([5.0, 1.0, 0.5, 0.0])
    assert faceted(bar()).depth(points, WORLD)[3] == 0.0
    local = ASKEW.to_local(points)
    assert bar().depth(local, ASKEW) == approx([5.0, 1.0, 0.5, 0.0])


def test_points_on_a_bar_are_in_its_side_or_in_an_end():
    sides = bar().sides(np.array([[12.0, 0.0, 3.0], [1.0, 1.0, 20.0], [0.0, 0.0, 3.0]]), 1e-6)
    assert sides.sum(axis=1).tolist() == [1, 1, 0]
    assert (sides[0] != sides[1]).any()


def test_a_standing_bar_seen_from_above_is_a_disc_and_a_lying_one_a_rectangle():
    assert bar().plan_area(WORLD).area == approx(math.pi * RADIUS**2)
    assert bar("x").plan_area(WORLD).area == approx(2 * RADIUS * (TOP - BOTTOM), rel=1e-3)
    assert box().plan_area(WORLD).area == approx(80.0)


@pytest.mark.parametrize("axis", ["x", "y", "z"])
def test_the_stock_of_a_bar_has_its_volume(axis):
    for bundles in (("z",), ("x", "y", "z")):
        stock = Stock.of(bar(axis), 0.25, bundles)
        assert stock.volume == approx(bar(axis).volume, rel=2e-3)


def test_a_stock_of_heights_is_one_only_where_every_column_is_solid_from_the_floor_up():
    assert Stock.of(bar(), 0.5).field is not None and Stock.of(ring(), 0.5).field is not None
    assert Stock.of(bar("x"), 0.5).field is None
    assert Stock.of(ring(), 0.1).volume == approx(ring().volume, rel=2e-3)
    assert Stock.of(faceted(ring()), 0.1).volume == approx(faceted(ring()).volume, rel=2e-3)


@pytest.mark.parametrize("blank", [box(), bar(), bar("x"), ring()], ids=lambda b: b.kind)
def test_nothing_of_a_whole_blanks_picture_looks_cut(blank):
    stock = Stock.of(blank, 0.25, ("x", "y", "z"))
    mesh = mesh_of(stock)
    fresh = fresh_of(mesh.points, mesh.triangles, blank, stock.pitch)
    assert mesh.areas()[fresh].sum() < 0.02 * mesh.areas().sum()


def test_a_patch_of_a_bars_stock_keeps_to_the_bar():
    patch = Stock.of(bar("x"), 0.5, ("x", "y", "z")).patch(
        np.array([0.0, 0.0, 6.0]), np.array([5.0, 12.0, 12.0]), 0.1
    )
    # Five long, the quarter of the circle's cap over z = 6: half of R^2 (pi/3 - sin(120)/2).
    cap = 0.5 * RADIUS**2 * (math.pi / 3 - 0.5 * math.sin(2 * math.pi / 3))
    assert patch.volume == approx(5.0 * cap, rel=5e-3)


@pytest.mark.parametrize("blank", ALL, ids=lambda b: b.kind)
@pytest.mark.parametrize("frame", [WORLD, ASKEW], ids=["upright", "askew"])
def test_the_planning_stock_is_nowhere_lower_than_the_blank(blank, frame):
    setup = Setup(name="S1", frame=frame, work_offset="G54", clearance=50.0, machine="m")
    stock = PlanningStock.of(blank, setup, 1.0)
    inside = scattered(20000)
    local = frame.to_local(inside[blank.inward(inside) > 0.0])
    cell = np.floor((local[:, :2] - stock.corner) / stock.cell).astype(int)
    assert (local[:, 2] <= stock.heights[tuple(cell.T)] + 1e-9).all()


def test_the_planning_stock_of_a_round_bar_has_no_corners():
    setup = Setup(name="S1", frame=WORLD, work_offset="G54", clearance=50.0, machine="m")
    stock = PlanningStock.of(bar(), setup, 0.5)
    high = stock.heights > BOTTOM
    assert high.sum() * stock.cell**2 == approx(math.pi * RADIUS**2, rel=0.1)
    assert stock.heights[0, 0] == BOTTOM and set(stock.heights[high]) == {TOP}


@pytest.mark.parametrize("blank", ALL, ids=lambda b: b.kind)
def test_a_blank_is_kept_and_comes_back(blank):
    from trunnion.model.blank import Blank
    from trunnion.settings import digest

    members = Members()
    again = from_xml(to_xml(blank, Blank | None, "blank", members), Blank | None, members)
    assert type(again) is type(blank) and digest(again) == digest(blank)
    assert again.low.tolist() == blank.low.tolist()


def test_a_box_of_a_file_without_a_type_is_a_box():
    from trunnion.model.blank import Blank

    element = to_xml(box(), Blank | None, "blank", Members())
    assert element.get("type") is None
    assert from_xml(element, Blank | None, Members()).kind == "box"


@pytest.mark.parametrize(
    ("outline", "says"),
    [
        ([[0, 0], [5, 0]], "three points"),
        ([[0, 0], [5, 0], [-1, 5]], "beyond the axis"),
        ([[0, 5], [5, 5], [5, 0], [0, 0]], "anticlockwise"),
        ([[0, 0], [9, 9], [9, 0], [0, 6]], "cross"),
    ],
)
def test_an_outline_that_encloses_nothing_is_refused(outline, says):
    with pytest.raises(ValueError, match=says):
        Revolved(frame=WORLD, outline=outline, material="test", density=1.0)


def test_triangles_that_enclose_nothing_are_refused():
    points, triangles = box().shell()
    for own, says in (
        (triangles[:-1], "not closed, 3 edges"),
        (triangles[:, ::-1], "look inwards"),
        (triangles[:0], "has triangles"),
    ):
        with pytest.raises(ValueError, match=says):
            Faceted(frame=WORLD, points=points, triangles=own, material="test", density=1.0)


def test_faces_of_a_mesh_are_welded_where_they_meet():
    points, triangles = box().shell()
    apart = points[triangles].reshape(-1, 3) + 1e-8
    mesh = Mesh(apart, np.arange(len(apart)).reshape(-1, 3), np.ones(len(triangles)))
    joined, rows = welded(mesh, 1e-6)
    assert len(joined) == 8 and len(rows) == 12
    blank = Faceted(frame=WORLD, points=joined, triangles=rows, material="test", density=1.0)
    assert blank.volume == approx(480.0)


def test_a_point_is_inside_a_turned_outline_by_the_lines_beyond_it():
    outline = np.array(
        [[10, 0], [20, 0], [20, 5], [15, 5], [15, 10], [22, 20], [12, 20], [12, 12], [10, 12.0]]
    )
    at = np.random.default_rng(0).uniform([5, -3], [25, 23], (5000, 2))
    expected = shapely.contains_xy(shapely.Polygon(outline), at)
    assert (inside_outline(outline, at) == expected).all() and expected.any()


def test_a_smooth_run_of_an_outline_is_one_side_and_its_ends_are_others():
    turn = np.linspace(0.0, 0.5 * math.pi, 30)
    dome = np.column_stack([10.0 * np.cos(turn), 10.0 * np.sin(turn)])
    dome[-1, 0] = 0.0
    blank = Revolved(
        frame=WORLD, outline=np.vstack([[0.0, 0.0], dome]), material="EN AW-7075", density=2.8e-6
    )
    on_dome = np.column_stack([dome[:-1, 0], np.zeros(29), dome[:-1, 1]])
    sides = blank.sides(on_dome, 0.02)
    assert sides.shape[1] == 2 and sides.all(axis=0).sum() == 1


@pytest.mark.parametrize("solid", ALL, ids=lambda b: f"{b.kind} {getattr(b, 'axis', '')}")
@pytest.mark.parametrize("frame", [WORLD, ASKEW])
def test_no_point_of_a_blank_is_farther_away_than_it_reaches(solid, frame):
    for point in np.random.default_rng(5).uniform(-20.0, 20.0, (20, 3)):
        away = np.linalg.norm(
            solid.frame.to_local(frame.to_world(point)) - solid.shell()[0], axis=1
        )
        # The facets of a shell stand out of its circles by less than a hundredth.
        assert solid.reach(point, frame) == approx(away.max(), rel=0.01)


def test_a_round_blank_reaches_less_far_than_the_corners_of_its_box():
    middle = np.array([0.0, 0.0, 0.5 * (BOTTOM + TOP)])
    assert bar().reach(middle, WORLD) == approx(math.hypot(RADIUS, 0.5 * (TOP - BOTTOM)))
