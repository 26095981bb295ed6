"""Blocks are robust against rounding: nothing goes nowhere, arcs keep their radius, and no arc comes near a full turn."""

from __future__ import annotations

import math

import numpy as np
import pytest

from milling import SETUP, box_blank, cutting, mill
from trunnion.geometry.plane.curve import Curve
from trunnion.model.motion.toolpath import Mark, Motion
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.feed import arc_feed
from trunnion.toolpath.stock.heightfield import PlanningStock


@pytest.fixture
def builder() -> PathBuilder:
    stock = PlanningStock.of(box_blank((0, 0, -20), (60, 40, 0)), SETUP)
    made = PathBuilder(mill(10), cutting(4, 4), stock, SETUP, 2.0)
    made.rapid((10.0, 10.0, 50.0))
    return made


def test_a_path_ends_with_a_retract_to_the_clearance_height(builder: PathBuilder) -> None:
    builder.line((10, 10, -1), 500.0)
    path = builder.finished()
    assert path.position[-1].tolist() == [10.0, 10.0, SETUP.clearance]
    assert path.motion[-1] == Motion.RAPID


def test_nothing_made_is_an_empty_path() -> None:
    stock = PlanningStock.of(box_blank((0, 0, -20), (60, 40, 0)), SETUP)
    assert len(PathBuilder(mill(10), cutting(4, 4), stock, SETUP, 2.0).finished()) == 0


def test_a_move_that_goes_nowhere_is_dropped(builder: PathBuilder) -> None:
    builder.line((10.00005, 10.0, 50.0), 500.0)
    assert len(builder) == 1


def test_a_full_circle_leaves_as_two_halves(builder: PathBuilder) -> None:
    builder.arc((10, 10, 50), (15, 10), 2 * math.pi, 500.0)
    assert builder.finished().motion.tolist() == [Motion.RAPID, Motion.ARC_CCW, Motion.ARC_CCW]


def test_an_arc_shorter_than_its_rounding_leaves_as_a_line(builder: PathBuilder) -> None:
    builder.arc((10.003, 10.0, 50.0), (10.0015, 10.0), math.pi, 500.0)
    assert builder.finished().motion[1] == Motion.LINE


def test_both_ends_of_an_arc_are_equally_far_from_its_centre(builder: PathBuilder) -> None:
    builder.arc((20.0003, 10.0, 50.0), (15.0001, 9.9998), -math.pi, 500.0)
    path = builder.finished()
    radii = np.linalg.norm(path.position[[0, 1], :2] - path.centre[1, :2], axis=1)
    assert abs(radii[0] - radii[1]) < 1e-9


def test_a_curve_keeps_its_arcs(builder: PathBuilder) -> None:
    slot = Curve(
        np.array([[10.0, 10.0], [20.0, 10.0], [20.0, 20.0]]), np.array([0.0, 1.0, 0.0]), False
    )
    builder.curve(slot, 50.0, 600.0)
    path = builder.finished()
    assert path.motion.tolist() == [Motion.RAPID, Motion.LINE, Motion.ARC_CCW]
    assert path.centre[2].tolist() == [20.0, 15.0, 50.0]


def test_inside_a_corner_the_centre_goes_slower_by_the_ratio_of_the_radii() -> None:
    # The contour's radius is 5 + 5 mm where the centre's is 5: the edge keeps the feed when the centre goes half as fast.
    assert arc_feed(1000.0, 5.0, 5.0, 1.0) == 500.0
    assert arc_feed(1000.0, 5.0, 5.0, -1.0) == 1000.0


def test_the_builder_knows_what_its_own_cuts_have_removed(builder: PathBuilder) -> None:
    assert builder.stock().height((30, 20), (30, 20), 2.0) == 0.0
    builder.line((10, 20, -3), 500.0, Mark.ENTRY)
    builder.line((50, 20, -3), 500.0)
    assert builder.stock().height((30, 20), (30, 20), 2.0) == -3.0


def test_the_heading_is_the_direction_in_which_the_last_block_ended(builder: PathBuilder) -> None:
    builder.arc((20, 10, 50), (15, 10), math.pi, 500.0)
    assert builder.heading() == pytest.approx([0.0, 1.0], abs=1e-9)
