"""Machining times of simple paths, worked out by hand."""

from __future__ import annotations

import math

import pytest

from milling import SETUP, box_blank, cutting, mill
from trunnion.model.material import Axis, Machine
from trunnion.model.toolpath import EMPTY
from trunnion.toolpath.builder import PathBuilder
from trunnion.toolpath.stock import PlanningStock
from trunnion.toolpath.time import block_times, machining_time

AXES = tuple(Axis(name=n, kind="linear", low=0, high=1000, rapid=30000, acceleration=1000) for n in "XYZ")
MACHINE = Machine(name="M", title="M", axes=AXES, spindle_low=0, spindle_high=20000, power=((100, 10),), feed_max=10000, tool_change_s=5,
                  tool_places=10)


@pytest.fixture
def builder() -> PathBuilder:
    made = PathBuilder(mill(10), cutting(4, 4), PlanningStock.of(box_blank((0, 0, -20), (600, 40, 0)), SETUP), SETUP, 2.0)
    made.rapid((0.0, 0.0, 50.0))
    return made


def test_no_path_takes_no_time() -> None:
    assert machining_time(EMPTY, MACHINE) == 0.0


def test_a_long_line_takes_its_length_over_the_feed_and_once_the_time_to_speed_up(builder: PathBuilder) -> None:
    builder.line((500, 0, 50), 6000.0)
    # 100 mm/s at 1000 mm/s2: 0.1 s up and 0.1 s down, each over 5 mm.
    assert machining_time(builder.finished(), MACHINE) == pytest.approx(490 / 100 + 0.2)


def test_a_short_line_never_reaches_its_feed(builder: PathBuilder) -> None:
    builder.line((2.5, 0, 50), 6000.0)
    assert machining_time(builder.finished(), MACHINE) == pytest.approx(2 * math.sqrt(2.5 / 1000))


def test_a_line_in_two_blocks_takes_as_long_as_in_one(builder: PathBuilder) -> None:
    builder.line((200, 0, 50), 6000.0)
    builder.line((500, 0, 50), 6000.0)
    assert machining_time(builder.finished(), MACHINE) == pytest.approx(490 / 100 + 0.2)


def test_a_sharp_corner_costs_time(builder: PathBuilder) -> None:
    builder.line((250, 0, 50), 6000.0)
    builder.line((0, 0, 50), 6000.0)
    assert machining_time(builder.finished(), MACHINE) == pytest.approx(2 * (240 / 100 + 0.2), rel=1e-3)


def test_a_rapid_is_bounded_by_the_axis_that_moves(builder: PathBuilder) -> None:
    builder.rapid((500, 0, 50))
    # 500 mm/s takes 125 mm and 0.5 s to reach, as much to brake from: 250 mm stay for the full speed.
    assert machining_time(builder.finished(), MACHINE) == pytest.approx(0.5 + 250 / 500 + 0.5)


def test_a_small_arc_is_bounded_by_the_centripetal_acceleration(builder: PathBuilder) -> None:
    for _ in range(10):
        builder.arc((0, 0, 50), (2.5, 0), 2 * math.pi, 6000.0)
    # sqrt(1000 * 2.5) = 50 mm/s round ten circles of 2.5 mm.
    assert machining_time(builder.finished(), MACHINE) == pytest.approx(10 * math.tau * 2.5 / 50 + 50 / 1000, rel=0.01)


def test_the_first_block_takes_no_time_because_its_start_is_unknown(builder: PathBuilder) -> None:
    builder.line((10, 0, 50), 6000.0)
    assert block_times(builder.finished(), MACHINE)[0] == 0.0
