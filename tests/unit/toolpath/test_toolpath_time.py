"""Machining times of simple paths, worked out by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from leaning_paths import FORK, TABLE, UP, lean, path_of, standing
from milling import SETUP, box_blank, cutting, mill
from trunnion.model.material import Axis, Machine
from trunnion.model.motion.toolpath import EMPTY, Motion, Toolpath
from trunnion.toolpath.motion.builder import PathBuilder
from trunnion.toolpath.motion.time import block_times, machining_time, reached_feeds
from trunnion.toolpath.stock.heightfield import PlanningStock

AXES = tuple(
    Axis(name=n, kind="linear", low=0, high=1000, rapid=30000, acceleration=1000) for n in "XYZ"
)
MACHINE = Machine(
    name="M",
    title="M",
    axes=AXES,
    spindle_low=0,
    spindle_high=20000,
    power=((100, 10),),
    feed_max=10000,
    tool_change_s=5,
    tool_places=10,
)


@pytest.fixture
def builder() -> PathBuilder:
    made = PathBuilder(
        mill(10),
        cutting(4, 4),
        PlanningStock.of(box_blank((0, 0, -20), (600, 40, 0)), SETUP),
        SETUP,
        2.0,
    )
    made.rapid((0.0, 0.0, 50.0))
    return made


def test_no_path_takes_no_time() -> None:
    assert machining_time(EMPTY, MACHINE) == 0.0


def test_a_long_line_takes_its_length_over_the_feed_and_once_the_time_to_speed_up(
    builder: PathBuilder,
) -> None:
    builder.line((500, 0, 50), 6000.0)
    # 100 mm/s at 1000 mm/s2: 0.1 s up and 0.1 s down, each over 5 mm.
    assert machining_time(builder.finished(), MACHINE) == pytest.approx(490 / 100 + 0.2)


def test_the_feed_that_is_reached_is_the_top_of_the_ramps_and_never_more_than_programmed(
    builder: PathBuilder,
) -> None:
    builder.line((2.5, 0, 50), 6000.0)
    builder.line((400, 0, 50), 1200.0)
    path = builder.finished()
    # From rest over 2.5 mm at 1000 mm/s2, and down to 20 mm/s: v2 = (2 a s + 20^2) / 2.
    top = np.sqrt(0.5 * (2.0 * 1000.0 * 2.5 + 20.0**2)) * 60.0
    assert reached_feeds(path, MACHINE)[1:] == pytest.approx([top, 1200.0])


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
    assert machining_time(builder.finished(), MACHINE) == pytest.approx(
        2 * (240 / 100 + 0.2), rel=1e-3
    )


def test_a_rapid_is_bounded_by_the_axis_that_moves(builder: PathBuilder) -> None:
    builder.rapid((500, 0, 50))
    # 500 mm/s takes 125 mm and 0.5 s to reach, as much to brake from: 250 mm stay for the full speed.
    assert machining_time(builder.finished(), MACHINE) == pytest.approx(0.5 + 250 / 500 + 0.5)


def test_a_small_arc_is_bounded_by_the_centripetal_acceleration(builder: PathBuilder) -> None:
    for _ in range(10):
        builder.arc((0, 0, 50), (2.5, 0), 2 * math.pi, 6000.0)
    # sqrt(1000 * 2.5) = 50 mm/s round ten circles of 2.5 mm.
    assert machining_time(builder.finished(), MACHINE) == pytest.approx(
        10 * math.tau * 2.5 / 50 + 50 / 1000, rel=0.01
    )


def test_a_table_that_turns_under_a_tip_that_stands_takes_its_own_time() -> None:
    # C turns 90 degrees at 300 a second and 1000 a second squared under a tip over its middle: 0.3 s up and down, 45 degrees each.
    path = path_of(
        ((10.0, 5.0, 5.0), UP),
        ((10.0, 5.0, 5.0), lean(1e-4, 0.0)),
        ((10.0, 5.0, 5.0), lean(1e-4, 90.0)),
        feed=1000.0,
    )
    assert block_times(path, TABLE, standing(TABLE))[2] == pytest.approx(
        2 * math.sqrt(90 / 1000), rel=0.02
    )


def test_a_tip_that_goes_on_while_the_tool_leans_slowly_keeps_its_feed() -> None:
    path = path_of(
        *[((10.0 + k, 5.0, 5.0), lean(10.0 + 0.01 * k, 90.0)) for k in range(101)], feed=600.0
    )
    assert machining_time(path, TABLE, standing(TABLE), 140.0) == pytest.approx(10.0, rel=0.01)


def test_a_fork_that_leans_must_take_its_arm_along() -> None:
    # The pivot is 360 mm from the tip: leaning by 60 degrees at 4 s a turn it goes 377 mm.
    path = path_of(*[((0.0, 0.0, 5.0), lean(k, 90.0)) for k in range(0, 61, 2)], feed=1e4)
    short, long = (machining_time(path, FORK, standing(FORK), gauge) for gauge in (0.0, 1500.0))
    assert short >= 60.0 / 240.0
    assert long > 1.5 * short


def test_an_arc_of_a_leaning_tool_takes_as_long_as_one_that_stands() -> None:
    def around(axis):
        a = np.cross(axis, [0.0, 1.0, 0.0])
        a /= np.linalg.norm(a)
        ends = [5.0 * (math.cos(t) * a + math.sin(t) * np.cross(axis, a)) for t in (0.0, 3.0)]
        return Toolpath(
            position=ends,
            axis=[axis, axis],
            motion=[Motion.RAPID, Motion.ARC_CCW],
            centre=[[np.nan] * 3, [0.0] * 3],
            feed=[0.0, 2000.0],
            mark=[0, 0],
        )

    assert machining_time(around(lean(40.0)), TABLE, standing(TABLE)) == pytest.approx(
        machining_time(around(UP), TABLE), rel=1e-6
    )


def test_the_first_block_takes_no_time_because_its_start_is_unknown(builder: PathBuilder) -> None:
    builder.line((10, 0, 50), 6000.0)
    assert block_times(builder.finished(), MACHINE)[0] == 0.0
