"""Pits in the walls of pockets: what a setup sees of them, which T-slot cutters get in, and why others do not."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import cadquery as cq
import numpy as np
import pytest
from pytest import approx

from pitted import POCKET, opened, pit_in_wall, pitted_block, pitted_shape
from trunnion.findings import Refused, Severity
from trunnion.model.tool import T_SLOT
from trunnion.plan.panel.pit_tasks import t_slot_cutters
from trunnion.plan.prismatic.drive import drive_of
from trunnion.plan.prismatic.pits import PitReach, body_radius, pit_heights, pit_space
from trunnion.plan.prismatic.regions import SetupSpace
from verify_tools import FORMS


def spaced(shape):
    """Return the pit of a shape and the space of its first setup."""
    engine, session = opened(shape)
    session = engine.run(session, until="route")
    (pit,) = session.recognition.of_kind("pit")
    part, recognition, blank = engine.context.part, session.recognition, session.blank
    return pit, SetupSpace.of(part, recognition, blank, session.setups[0])


def disc(diameter=12.0, thick=4.0, neck=6.0, long=30.0, corner=0.0):
    """Return a T-slot cutter."""
    return replace(
        FORMS["t-slot"],
        name=f"TS D{diameter:g} H{thick:g}",
        diameter=diameter,
        corner_radius=corner,
        flute_length=thick,
        neck_diameter=neck,
        neck_length=long,
        shank_diameter=10.0,
        stickout=long + 5.0,
        gauge_length=long + 100.0,
    )


def test_a_pit_is_what_lies_under_material_between_its_floor_and_its_roof():
    pit, space = spaced(pitted_shape(pit_in_wall()))
    seen = pit_space(pit, space)
    assert seen.roof - seen.floor == approx(8.0) and seen.top - seen.roof == approx(30.0 - 18.0)
    corners = 2.0 * (1.0 - math.pi / 4.0) * 3.0**2
    assert seen.wanted.area == approx(40.0 * 3.0 - corners, rel=1e-4)
    assert seen.fillet == 0.0
    free = POCKET[0] * POCKET[1] - 4.0 * (1.0 - math.pi / 4.0) * 8.0**2
    assert seen.beside.area == approx(free + seen.wanted.area, rel=1e-4)


@pytest.mark.parametrize("radius", [0.5, 1.5])
def test_fillets_at_floor_and_roof_are_suppressed(radius):
    rounded = pit_in_wall(corner=9.0).faces("<Z or >Z").edges().fillet(radius)
    seen = pit_space(*spaced(pitted_shape(rounded)))
    assert seen.fillet == approx(radius)
    assert seen.wanted.box()[1][0] - seen.wanted.box()[0][0] == approx(
        pit_space(*spaced(pitted_shape(pit_in_wall(corner=9.0)))).wanted.box()[1][0]
        - seen.wanted.box()[0][0],
        abs=1e-3,
    )


def test_a_pit_whose_roof_is_not_level_is_refused():
    back = 0.5 * POCKET[1]
    outline = [(back - 2.0, 10.0), (back + 4.0, 10.0), (back + 4.0, 15.0), (back - 2.0, 20.0)]
    slope = cq.Workplane("YZ", origin=(-20.0, 0.0, 0.0)).polyline(outline).close().extrude(40.0)
    pit, space = spaced(pitted_shape(slope))
    with pytest.raises(Refused, match="roof is not level"):
        pit_space(pit, space)


def test_the_neck_keeps_off_what_is_over_the_pit():
    seen = pit_space(*spaced(pitted_shape(pit_in_wall(depth=4.0))))
    deep = seen.top - seen.floor
    for neck, reached in ((3.0, 4.0), (6.0, 2.8)):
        reach = PitReach.of(seen.wanted, seen.beside, seen.over, deep, disc(neck=neck), 0.2)
        low, high = reach.covered.box()
        assert min(high - low) == approx(reached, abs=0.02)
        assert reach.outside.minus(reach.axis.offset(1e-3)).area == approx(0.0, abs=1e-3)
        body = seen.over.offset(-(0.5 * neck + 0.2))
        assert not reach.axis.minus(body.offset(1e-3))


def test_what_follows_the_disc_is_as_wide_as_it_is_in_the_part():
    tool = disc(neck=5.0, long=20.0)
    assert body_radius(tool, 19.0) == 2.5 and body_radius(tool, 21.0) == 5.0
    assert body_radius(tool, 60.0) == max(r for row in tool.holder.rows for r in row[1::2])


def test_a_cutter_that_does_not_come_down_beside_a_pit_reaches_nothing():
    seen = pit_space(*spaced(pitted_shape(pit_in_wall())))
    reach = PitReach.of(seen.wanted, seen.beside, seen.over, 20.0, disc(diameter=50.0), 0.2)
    assert not reach.outside and not reach.covered


@pytest.mark.parametrize(
    ("height", "thick", "corner", "count"),
    [
        (8.0, 8.0, 0.0, 1),
        (8.0, 6.0, 0.0, 2),
        (8.0, 4.0, 0.0, 2),
        (8.0, 4.0, 1.0, 3),
        (9.0, 2.0, 1.0, 8),
    ],
)
def test_levels_go_from_the_roof_to_the_floor_without_a_cusp(height, thick, corner, count):
    heights = pit_heights(-20.0, -20.0 + height, disc(thick=thick, corner=corner))
    assert len(heights) == count and heights[-1] == -20.0
    assert count == 1 or heights[0] + thick == approx(-20.0 + height)
    steps = [a - b for a, b in pairwise(heights)]
    flat = thick - 2.0 * corner or 0.5 * thick
    assert all(0.0 < s <= flat + 1e-9 for s in steps)


def test_of_the_cutters_those_that_get_to_most_are_taken_and_the_thickest_first():
    seen = pit_space(*spaced(pitted_shape(pit_in_wall())))
    tools = (
        disc(thick=3.0),
        disc(thick=8.0),
        disc(thick=9.0),
        disc(neck=9.0, thick=8.0, diameter=13.0),
    )
    found = t_slot_cutters(seen, tools, 0.2)
    assert [t.name for t in found.tools] == ["TS D12 H8"]


@pytest.mark.parametrize(
    ("tools", "words"),
    [
        ((disc(thick=9.0),), "no T-slot cutter is as thin as it is high, 8 mm"),
        ((disc(neck=11.0),), "the best, TS D12 H4, to"),
        ((disc(diameter=50.0),), "none comes down beside it and into it"),
    ],
)
def test_why_no_cutter_gets_in_is_told(tools, words):
    seen = pit_space(*spaced(pitted_shape(pit_in_wall())))
    found = t_slot_cutters(seen, tools, 0.2)
    assert not found.tools and words in found.reason and found.remedy


def test_a_corner_radius_below_that_of_the_fillets_would_cut_into_them():
    rounded = pit_in_wall(corner=9.0).faces("<Z or >Z").edges().fillet(1.0)
    seen = pit_space(*spaced(pitted_shape(rounded)))
    assert not t_slot_cutters(seen, (disc(),), 0.2).tools
    assert t_slot_cutters(seen, (disc(corner=1.0),), 0.2).tools


def test_the_pit_comes_after_its_pocket_and_before_the_outline_is_finished():
    session = pitted_block()[1]
    kinds = [o.kind for o in session.process.operations]
    assert kinds.count("pit") == 1
    assert kinds.index("wall") < kinds.index("pit") < kinds.index("profile_finish")
    operation = next(o for o in session.process.operations if o.kind == "pit")
    (pit,) = session.recognition.of_kind("pit")
    assert operation.tool.form == T_SLOT and set(operation.faces) == set(pit.tags)


def test_its_drive_has_what_is_over_it_and_guide_lines_along_its_walls():
    engine, session = pitted_block()
    operation = next(o for o in session.process.operations if o.kind == "pit")
    setup = session.setups[0]
    space = SetupSpace.of(engine.context.part, session.recognition, session.blank, setup)
    drive = drive_of(operation, session.process, space)
    over, own = drive.levels
    assert not over.wanted and own.wanted and over.bottom == own.top
    (wall,) = drive.walls
    assert not wall.curve.closed and wall.top - wall.bottom == approx(8.0)
    # The material is on the right, what is wanted on the left.
    middle, tangent = wall.curve.at(0.5 * wall.curve.length)
    left = np.array([middle[0] - 0.1 * tangent[1], middle[1] + 0.1 * tangent[0]])
    assert own.wanted.contains(left[None]).all()


def test_a_pit_that_no_cutter_gets_into_is_told_and_the_rest_is_released():
    engine, session = opened(pitted_shape(pit_in_wall(length=12.0, depth=9.0)))
    session = engine.run(session)
    told = [f for f in session.findings() if "pit-01" in f.where and f.code == "route.not-planned"]
    assert len(told) == 1 and told[0].severity is Severity.WARNING and told[0].remedy
    assert session.verdict.releases
    assert not [o for o in session.process.operations if o.kind == "pit"]
