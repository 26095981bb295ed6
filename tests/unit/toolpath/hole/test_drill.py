"""Drilling: cycles by depth, heights of retract planes and ways between holes, short tours."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pytest import approx

from milling import SETUP, box_blank
from own_shop import own_shop
from trunnion.model.motion.cycle import CycleKind
from trunnion.model.motion.toolpath import Motion
from trunnion.plan.cutting.drilling import drilling_data
from trunnion.plan.cutting.milling import CuttingSettings
from trunnion.plan.holes.drive import HoleDrive
from trunnion.plan.holes.hole import PlannedHole
from trunnion.plan.holes.settings import DrillSettings
from trunnion.progress import NO_PROGRESS
from trunnion.toolpath.hole.drill import drill
from trunnion.toolpath.motion.tour import short_tour
from trunnion.toolpath.stock.heightfield import PlanningStock

SHOP = own_shop()
BLANK = box_blank((0, 0, -40), (100, 60, 0))


def tool(name: str):
    return next(t for t in SHOP.tools if t.name == name)


D8 = tool("DR-L D8")


def data(of):
    material = SHOP.material("EN AW-7075")
    table, machine = SHOP.drilling_for(material), SHOP.machine("Mill 1200")
    return drilling_data(of, material, table, machine, CuttingSettings())


def at(x, y, depth=10.0, top=0.0, through=False, angle=140.0, feature="hole-01"):
    return PlannedHole(
        feature=feature,
        x=x,
        y=y,
        top=top,
        bottom=top - depth,
        diameter=8.0,
        through=through,
        point_angle=angle,
    )


def drilled(*holes, cutter=D8, stock=None, kind="drill", **words):
    stock = stock or PlanningStock.of(BLANK, SETUP)
    drive = HoleDrive(kind=kind, holes=holes)
    return drill(drive, cutter, data(cutter), stock, SETUP, DrillSettings(**words), NO_PROGRESS)


@pytest.mark.parametrize(
    ("depth", "kind"), [(10, CycleKind.DRILL), (25, CycleKind.CHIP_BREAK), (47, CycleKind.PECK)]
)
def test_the_cycle_is_that_of_the_depth(depth, kind):
    path = drilled(at(50, 30, depth), peck_from=5.5).path
    assert [b.cycle.kind for b in path.cycles] == [kind]
    assert path.cycles[0].cycle.peck == (0.0 if kind is CycleKind.DRILL else 8.0)


def test_a_blind_holes_full_diameter_ends_where_it_should():
    path = drilled(at(50, 30, 10)).path
    assert path.position[:, 2].min() == approx(-10.0 - D8.point_length)


def test_a_through_hole_goes_past_its_end():
    path = drilled(at(50, 30, 40, through=True), breakthrough=1.5).path
    assert path.position[:, 2].min() == approx(-41.5 - D8.point_length)


def test_a_path_begins_and_ends_at_the_clearance_height():
    path = drilled(at(20, 20), at(80, 40)).path
    assert path.position[[0, -1], 2] == approx(SETUP.clearance)
    assert path.motion[0] == path.motion[-1] == Motion.RAPID


def test_between_holes_on_a_plane_it_stays_on_the_retract_plane():
    path = drilled(at(20, 20), at(80, 40)).path
    assert {b.cycle.lift for b in path.cycles} == {0.0}
    across = np.abs(np.diff(path.position[:, :2], axis=0)).max(axis=1) > 1.0
    assert path.position[1:][across, 2] == approx(2.0)


def test_over_a_ridge_every_cycle_returns_above_it():
    """Pockets of depth 20 to both sides of a ridge, a hole in each."""
    stock = PlanningStock.of(BLANK, SETUP).working()
    stock.heights[:80], stock.heights[120:] = -20.0, -20.0
    path = drilled(at(20, 30, top=-20.0), at(80, 30, top=-20.0), stock=stock).path
    assert {b.cycle.lift for b in path.cycles} == {20.0}
    across = np.abs(np.diff(path.position[:, :2], axis=0)).max(axis=1) > 1.0
    assert (path.position[1:][across, 2] >= 2.0).all()


def test_material_that_still_stands_over_a_hole_is_drilled_too():
    path = drilled(at(50, 30, 10, top=-20.0)).path
    assert path.cycles[0].cycle.depth == approx(2.0 + 30.0 + D8.point_length)
    assert path.cycles[0].cycle.kind is CycleKind.CHIP_BREAK


def test_a_hole_that_the_shank_does_not_let_it_reach_is_left_and_named():
    thin = tool("DR-K D3")
    low = PlannedHole(
        feature="hole-07",
        x=50,
        y=30,
        top=-30,
        bottom=-40,
        diameter=3,
        through=False,
        point_angle=140,
    )
    planned = drilled(low, cutter=thin)
    assert not len(planned.path)
    assert [f.code for f in planned.findings] == ["hole.kept-off"]
    assert "hole-07" in planned.findings[0].text and planned.findings[0].remedy


@pytest.mark.parametrize(("angle", "code"), [(180.0, "hole.floor"), (118.0, "hole.point")])
def test_what_the_point_leaves_is_said(angle, code):
    assert [f.code for f in drilled(at(50, 30, angle=angle)).findings] == [code]


def test_a_spot_is_as_wide_as_its_hole():
    spot = tool("SP D16")
    path = drilled(at(50, 30), cutter=spot, kind="spot").path
    assert path.position[:, 2].min() == approx(-0.5 * spot.point_length)


def test_the_planners_stock_is_no_lower_than_the_point_leaves_it():
    stock = PlanningStock.of(BLANK, SETUP)
    after = stock.after(drilled(at(50, 30, 10), stock=stock).path, D8)
    assert after.heights.min() == approx(-10.0)


def test_a_tour_on_a_grid_is_as_short_as_can_be():
    grid = np.array([(x, y) for x in range(4) for y in range(3)], dtype=float)[::-1]
    order = short_tour(grid)
    way = np.linalg.norm(np.diff(grid[order], axis=0), axis=1).sum()
    assert way == approx(11.0) and grid[order[0]].tolist() == [0.0, 0.0]


@settings(max_examples=30, deadline=None)
@given(
    st.lists(st.tuples(st.integers(0, 50), st.integers(0, 50)), min_size=1, max_size=7, unique=True)
)
def test_a_tour_visits_all_and_is_near_the_shortest(points):
    places = np.array(points, dtype=float)
    order = short_tour(places)
    assert sorted(order.tolist()) == list(range(len(places)))
    assert order.tolist() == short_tour(places).tolist()

    def way(tour):
        return float(np.linalg.norm(np.diff(places[list(tour)], axis=0), axis=1).sum())

    best = min(way(t) for t in itertools.permutations(range(len(places))))
    assert way(order) <= 1.25 * best + 1e-9


def test_a_drill_wider_than_the_hole_is_not_let_into_it():
    planned = drilled(at(50, 30), cutter=tool("DR-K D10"))
    assert not len(planned.path)
    assert [f.code for f in planned.findings] == ["hole.too-narrow"]
