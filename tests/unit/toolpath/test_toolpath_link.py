"""Ways through the air keep clear of what may be there, with everything that hangs on the spindle."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from milling import SETUP, box_blank, cutting, mill
from trunnion.geometry.plane.curve import Curve
from trunnion.geometry.plane.curve_parts import parts_where
from trunnion.geometry.plane.region import Region
from trunnion.model.motion.toolpath import Mark, Motion
from trunnion.toolpath.axis_region import AxisRegion
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.link import step_aside, travel
from trunnion.toolpath.offsetting.lead import fitting_lead, lead_in
from trunnion.toolpath.stock.heightfield import PlanningStock

BLANK = box_blank((0, 0, -60), (100, 60, 0))


def at_the_bottom_of_a_slot() -> PathBuilder:
    builder = PathBuilder(
        mill(10, stickout=200.0), cutting(4, 4), PlanningStock.of(BLANK, SETUP), SETUP, 2.0
    )
    builder.rapid((-20, 30, 50))
    builder.line((-20, 30, -30), 500.0)
    builder.line((120, 30, -30), 500.0)
    return builder


def test_the_first_way_comes_down_from_the_clearance_height_to_just_above_the_material() -> None:
    builder = PathBuilder(mill(10), cutting(4, 4), PlanningStock.of(BLANK, SETUP), SETUP, 2.0)
    travel(builder, (50, 30), -1.0)
    path = builder.finished()
    assert path.position[:3, 2] == pytest.approx([50.0, 2.0, -1.0])
    assert path.motion[:3].tolist() == [Motion.RAPID, Motion.RAPID, Motion.LINE]


def test_going_down_where_material_may_be_uses_the_plunge_feed() -> None:
    builder = PathBuilder(mill(10), cutting(4, 4), PlanningStock.of(BLANK, SETUP), SETUP, 2.0)
    travel(builder, (50, 30), -1.0)
    path = builder.finished()
    assert (path.mark[2], path.feed[2]) == (Mark.ENTRY, builder.data.plunge_feed)


def test_a_way_over_material_rises_above_it_first() -> None:
    builder = at_the_bottom_of_a_slot()
    travel(builder, (120, 0), -30.0)
    travel(builder, (-20, 0), -30.0)
    assert builder.finished().position[:, 2].max() == SETUP.clearance
    heights = [p[2] for p in builder.finished().position[4:]]
    assert 2.0 in heights


def test_a_way_through_air_beside_the_blank_stays_low() -> None:
    builder = at_the_bottom_of_a_slot()
    before = len(builder)
    travel(builder, (130, 40), -30.0)
    assert builder.finished().position[before:-1, 2].max() <= -28.0 + 1e-9


def test_a_holder_that_would_touch_lifts_the_way() -> None:
    # The holder's nose hangs 45 mm above the tip and is wider than the slot: with 2 mm of safety the tip stays above -43, and 2 more.
    builder = PathBuilder(
        mill(10, stickout=45.0), cutting(4, 4), PlanningStock.of(BLANK, SETUP), SETUP, 2.0
    )
    builder.rapid((-20, 24, 50))
    for place in ((-20, 24), (120, 24), (120, 30), (-20, 30), (-20, 36), (120, 36)):
        builder.line((*place, -50), 500.0)
    builder.rapid((120, 36, 10))
    travel(builder, (50, 30), -50.0)
    path = builder.finished()
    assert path.position[path.motion == Motion.RAPID, 2].min() == pytest.approx(-41.0)


def test_stepping_aside_goes_left_where_there_is_room() -> None:
    builder = at_the_bottom_of_a_slot()
    step_aside(builder, (1.0, 0.0), AxisRegion(Region.rectangle(0, 0, 200, 60)))
    assert builder.here == pytest.approx([120.0, 31.5, -30.0])


def test_stepping_aside_stays_where_there_is_no_room() -> None:
    builder = at_the_bottom_of_a_slot()
    step_aside(builder, (1.0, 0.0), AxisRegion(Region.rectangle(0, 0, 200, 30)))
    assert builder.here == pytest.approx([120.0, 30.0, -30.0])


def test_a_lead_is_a_quarter_circle_from_the_left() -> None:
    lead = lead_in(np.array([10.0, 0.0]), np.array([1.0, 0.0]), 3.0)
    assert lead.centre.tolist() == [10.0, 3.0]
    assert lead.outside.tolist() == [7.0, 3.0]


def test_a_lead_shrinks_until_it_fits() -> None:
    lead = fitting_lead(
        np.array([10.0, 0.0]),
        np.array([1.0, 0.0]),
        10.0,
        AxisRegion(Region.rectangle(0, 0, 20, 4)),
        leaves=False,
    )
    assert lead is not None and lead.radius == pytest.approx(3.5)


def test_no_lead_fits_where_there_is_no_room_at_all() -> None:
    assert (
        fitting_lead(
            np.array([10.0, 0.0]),
            np.array([1.0, 0.0]),
            10.0,
            AxisRegion(Region.rectangle(0, 0, 20, 1)),
            leaves=False,
        )
        is None
    )


def test_the_parts_of_a_closed_curve_wrap_over_its_start() -> None:
    box = Curve.rectangle(0, 0, 10, 10)
    parts = parts_where(box, lambda p: 5.0 - p[:, 0])
    assert len(parts) == 1
    assert parts[0].start == pytest.approx([5.0, 10.0], abs=1e-3)
    assert parts[0].end == pytest.approx([5.0, 0.0], abs=1e-3)


def test_a_curve_that_is_wanted_everywhere_stays_closed() -> None:
    box = Curve.rectangle(0, 0, 10, 10)
    assert parts_where(box, lambda p: np.ones(len(p))) == [box]
    assert parts_where(box, lambda p: -np.ones(len(p))) == []


def beside_what_stands(apart: float, neck: float) -> PathBuilder:
    """Return a path that ends at the foot of a step that a wider cutter left `apart` mm off the cutter's axis, deeper than its flutes."""
    wide = PathBuilder(
        mill(20, flute_length=60.0), cutting(4, 4), PlanningStock.of(BLANK, SETUP), SETUP, 2.0
    )
    wide.rapid((-20, 30, 50))
    for z in (-15.0, -30.0):
        wide.rapid((-20, 30, z))
        wide.line((60, 30, z), 500.0)
        wide.lift(50.0)
    stock = PlanningStock.of(BLANK, SETUP).after(wide.finished(), wide.tool)
    slim = replace(mill(6, flute_length=9.0, stickout=80.0), neck_diameter=neck, neck_length=70.0)
    builder = PathBuilder(slim, cutting(4, 4), stock, SETUP, 2.0)
    builder.rapid((40, 30, 50))
    builder.rapid((40, 30, -29))
    # The wide cutter has cut up to x = 70.
    builder.line((70.0 - apart, 30, -29), 500.0)
    return builder


@pytest.mark.parametrize(("apart", "fed"), [(2.9, True), (3.0, False), (4.0, False)])
def test_flutes_are_fed_out_past_what_the_neck_stands_beside(apart: float, fed: bool) -> None:
    builder = beside_what_stands(apart, neck=5.6)
    path = builder.finished()
    assert path.motion[-1] == Motion.RAPID
    up = path.position[-2] - path.position[-3]
    if fed:
        assert (path.motion[-2], path.mark[-2]) == (Motion.LINE, Mark.LEAD)
        assert up == pytest.approx([0.0, 0.0, 29.0])
    else:
        assert up[2] == 0.0


def test_what_the_layers_above_have_cut_is_in_nobodys_way() -> None:
    """Layer by layer down a wall that is deeper than the flutes are long: at every lift all of it is cut."""
    tool = replace(mill(6, flute_length=9.0, stickout=80.0), neck_diameter=5.6, neck_length=70.0)
    builder = PathBuilder(tool, cutting(4, 4), PlanningStock.of(BLANK, SETUP), SETUP, 2.0)
    builder.rapid((-20, 30, 50))
    for z in range(-4, -40, -4):
        builder.rapid((-20, 30, z))
        builder.line((60, 30, z), 500.0)
        builder.lift(50.0)
    assert not (builder.finished().mark == Mark.LEAD).any()
    # But not where the layers above have ended earlier.
    builder.rapid((-20, 30, -40))
    builder.line((60.1, 30, -40), 500.0)
    assert builder.finished().mark[-2] == Mark.LEAD
