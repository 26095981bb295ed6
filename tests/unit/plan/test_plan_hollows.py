"""What roughing by layers leaves on walls, and the hollows that its cutter does not come into."""

from __future__ import annotations

import math
import re

import cadquery as cq
import numpy as np
import pytest
from pytest import approx

from samples import written
from shaped_parts import bowl, plate
from trunnion.geometry.frame import WORLD
from trunnion.geometry.plane.curve import Curve
from trunnion.model.blank import Box
from trunnion.model.setup import Setup
from trunnion.part.shape.skin import skin_of
from trunnion.pipeline import Engine
from trunnion.plan.freeform.roughing.heights import HeightMap
from trunnion.plan.freeform.roughing.hollows import are_opened, hollow_depths
from trunnion.plan.freeform.roughing.layers import remaining_on_walls
from trunnion.plan.freeform.space import SurfaceSpace

SETUP = Setup(name="S1", frame=WORLD, work_offset="G54", clearance=20.0, machine="Mill 1200")
ALLOWANCE, CELL = 0.3, 0.25


def space_of(part, width, depth, height):
    """Return the space of a part that stands on the origin, in a blank with 5 mm around it."""
    blank = Box(
        frame=WORLD,
        low=np.array([-5.0, -5.0, 0.0]),
        high=np.array([width + 5.0, depth + 5.0, height + 2.0]),
        material="EN AW-7075",
        density=2.8,
    )
    return SurfaceSpace.of(part, skin_of(part, WORLD, 0.01), blank, SETUP)


def off_the_wall(space, width, depth, z):
    """Return the least and the greatest distance of a layer's rim from a plate's walls, in mm."""
    margin = 2.0 * CELL * np.array([1.0, 1.0, 0.0])
    tall = HeightMap.of(
        space.skin.drop, space.low - margin, space.high + margin, CELL, ALLOWANCE
    ).below(z, 0.5 * ALLOWANCE)
    (rim,) = (hole for piece in tall.pieces for hole in piece.holes)
    away = Curve.rectangle(0.0, 0.0, width, depth).distance(rim.points)
    return float(away.min()), float(away.max())


@pytest.mark.parametrize("z", (1.0, 4.0, 7.0))
def test_layers_leave_on_walls_about_what_is_foreseen_and_never_twice_as_much(z):
    width, depth = 20.1, 16.3
    space = space_of(plate(width, depth, 8.0), width, depth, 8.0)
    least, most = off_the_wall(space, width, depth, z)
    foreseen = remaining_on_walls(space, ALLOWANCE, CELL)
    # The cell's diagonal 0.354 and the rim's straightening 0.15 come to the allowance.
    assert foreseen == approx(0.3 + 0.3536 + 0.15, abs=1e-4)
    assert ALLOWANCE < least <= most < 2.0 * foreseen


def test_a_disc_over_a_round_hollow_stays_as_far_above_its_bottom_as_its_rim_says():
    space = space_of(bowl(20.0, 16.0, 8.0, 6.0), 20.0, 16.0, 8.0)
    middle = np.array([[10.0, 8.0, 2.0]])
    for radius in (2.0, 4.0):
        depth = hollow_depths(space, middle, radius)[0]
        assert depth == approx(6.0 - math.sqrt(36.0 - radius**2), abs=0.03)
    assert hollow_depths(space, middle, 7.0)[0] == approx(6.0, abs=0.03)


def test_level_ground_and_the_foot_of_a_wall_are_no_hollows():
    space = space_of(plate(20.0, 16.0, 8.0), 20.0, 16.0, 8.0)
    top = np.column_stack([np.linspace(0.1, 19.9, 9), np.full(9, 0.1), np.full(9, 8.0)])
    assert hollow_depths(space, top, 6.0) == approx(np.zeros(9), abs=1e-9)
    assert len(hollow_depths(space, np.zeros((0, 3)), 6.0)) == 0


def roughing(radius, width=20.0, depth=16.0):
    """Return the roughing operations of a plate with a round hollow."""
    engine = Engine()
    part = written(bowl(width, depth, 1.4 * radius, radius).shape, name="bowl")
    process = engine.run(engine.open(part), "route").process
    return [o for o in process.operations if o.kind == "rough"]


def test_a_hollow_that_the_roughing_cutter_is_too_wide_for_is_roughed_with_a_smaller_one():
    first, second = roughing(6.0)
    assert second.tool.diameter < 0.7 * first.tool.diameter
    assert any("opens hollows" in rule for rule in second.rules)


def test_a_wide_hollow_needs_no_smaller_roughing_cutter():
    assert not [
        o for o in roughing(24.0, 70.0, 60.0) if any("opens hollows" in rule for rule in o.rules)
    ]


def test_what_a_coarse_map_leaves_is_in_the_data_of_the_outlines_finish():
    engine = Engine()
    session = engine.open(written(bowl(20.0, 16.0, 8.0, 6.0).shape, name="bowl"))
    widths = []
    for cell in (0.25, 1.0):
        process = engine.run(engine.with_choices(session, {"surface.cell": cell}), "route").process
        (outline,) = (o for o in process.operations if o.kind == "profile_finish")
        widths.append(outline.data.width)
    assert widths[1] - widths[0] == approx(0.75 * math.sqrt(2.0))


def grooved(width, deep=16.0):
    """Return the shape of a block with two grooves with round bottoms."""
    round_bottom = cq.Workplane("YZ").circle(0.5 * width).extrude(62.0)
    sides = cq.Workplane().box(62.0, width, deep, centered=(False, True, False))
    groove = sides.translate((0.0, 0.0, 0.5 * width)).union(round_bottom)
    block = cq.Workplane().box(60.0, 50.0, 24.0, centered=False)
    for y in (14.0, 36.0):
        block = block.cut(groove.translate((-1.0, y, 24.0 - deep + 0.5 * width)))
    return block.val().wrapped


def unroughed(width):
    """Return what a route says of the hollows of a grooved block that no roughing cutter comes to."""
    engine = Engine()
    session = engine.open(written(grooved(width), name="grooves"))
    session = engine.with_choices(session, {"recognize.family": "surface"})
    route = engine.run(session, "route").process
    return [f for f in route.findings if f.code == "route.not-roughed"]


def test_grooves_that_are_too_narrow_for_every_roughing_cutter_are_told_with_the_cutter_they_need():
    (told,) = unroughed(5.0)
    # Of a cutter and what roughing leaves on both walls, 0.8 mm each, most goes into 5 mm; the round bottom is 16 mm deep.
    diameter, deep = (
        float(re.search(pattern, told.text)[1])
        for pattern in (r"one of D ([\d.]+)", r"reaches (\d+) mm")
    )
    assert 1.5 <= diameter <= 5.0 - 2.0 * 0.8 and 13.0 <= deep <= 16.0
    area = float(re.search(r"([\d.]+) mm2", told.text)[1])
    walls = 2 * 60.0 * (2 * 13.5 + math.pi * 2.5)
    assert 0.7 * walls < area <= walls
    assert "such a cutter" in told.remedy


def test_grooves_that_a_roughing_cutter_goes_into_are_not_told():
    assert not unroughed(14.0)


def test_what_a_disc_comes_to_is_above_its_closing_and_above_where_roughing_ends():
    space = space_of(bowl(20.0, 16.0, 8.0, 6.0), 20.0, 16.0, 8.0)
    # A disc of 4 mm comes down to 8 - sqrt(36 - 16) = 3.53 over the middle of the bowl.
    points = np.array([[10.0, 8.0, z] for z in (3.0, 3.7, 7.0)])
    assert are_opened(space, 0.0, points, 4.0).tolist() == [False, True, True]
    assert are_opened(space, 5.0, points, 4.0).tolist() == [False, False, True]
