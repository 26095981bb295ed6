"""Plain data: frames, tools, toolpaths, the face graph's JSON."""

from __future__ import annotations

import math

import numpy as np
import pytest
from pytest import approx

from trunnion.geometry.frame import WORLD, Frame
from trunnion.model.material import Machine
from trunnion.model.motion.toolpath import Mark, Motion, Toolpath
from trunnion.model.tool import Holder, Tool

UP = (0.0, 0.0, 1.0)
NOWHERE = (math.nan,) * 3


def tool(**changes: object) -> Tool:
    given = dict(
        number=1,
        name="D10 R2",
        form="bull",
        diameter=10.0,
        corner_radius=2.0,
        flute_length=20.0,
        neck_diameter=9.6,
        neck_length=40.0,
        shank_diameter=10.0,
        stickout=50.0,
        gauge_length=130.0,
        teeth=3,
        centre_cutting=True,
        helix_angle=40.0,
        holder=Holder(name="ER32", rows=((0.0, 20.0, 30.0, 25.0),)),
    )
    return Tool(**{**given, **changes})  # type: ignore[arg-type]


def quarter_circle() -> Toolpath:
    return Toolpath(
        position=[(10.0, 0.0, 5.0), (10.0, 0.0, 0.0), (0.0, 10.0, -2.0)],
        axis=[UP] * 3,
        motion=[Motion.RAPID, Motion.LINE, Motion.ARC_CCW],
        centre=[NOWHERE, NOWHERE, (0.0, 0.0, 0.0)],
        feed=[0.0, 100.0, 100.0],
        mark=[Mark.RETRACT, Mark.ENTRY, Mark.CUT],
    )


def test_a_frame_maps_points_there_and_back() -> None:
    frame = Frame(np.array([5.0, 6.0, 7.0]), np.array([0.0, 2.0, 0.5]), np.array([1.0, 0.0, 0.0]))
    points = np.array([[1.0, 2.0, 3.0], [-4.0, 0.0, 9.0]])
    assert frame.to_world(frame.to_local(points)) == approx(points)
    assert np.linalg.det(frame.axes) == approx(1.0)


def test_a_frame_without_a_direction_is_refused() -> None:
    with pytest.raises(ValueError, match="no direction"):
        Frame(np.zeros(3), np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, 1.0]))


def test_world_is_the_part_as_read() -> None:
    assert WORLD.as_dict() == {
        "origin": [0.0, 0.0, 0.0],
        "x": [1.0, 0.0, 0.0],
        "z": [0.0, 0.0, 1.0],
    }


def test_a_bull_cutter_is_as_wide_as_its_profile_says() -> None:
    assert tool().radius_at(0.0) == approx(3.0)
    assert tool().radius_at(2.0) == approx(5.0)
    assert tool().radius_at(1.0) == approx(3.0 + math.sqrt(3.0))


def test_what_is_above_the_flutes_is_stacked_from_the_tip() -> None:
    assert tool().profile() == (
        (20.0, 4.8, 40.0, 4.8),
        (40.0, 5.0, 50.0, 5.0),
        (50.0, 20.0, 80.0, 25.0),
    )


@pytest.mark.parametrize("fillet", [0.0, 1.0, 3.0])
@pytest.mark.parametrize("back", [0.0, 0.25, 2.0])
def test_layers_along_a_wall_leave_the_flutes_room_over_the_layer_above(
    fillet: float, back: float
) -> None:
    cutter = tool(corner_radius=fillet, neck_diameter=10.0 - 2.0 * back)
    step = cutter.flank_step(40.0)
    over = fillet - (cutter.flute_length - step)
    left = fillet - math.sqrt(fillet**2 - over**2)
    assert step <= cutter.flute_length
    assert left == approx(min(back, fillet))


def test_one_layer_takes_all_that_the_flutes_are_long() -> None:
    cutter = tool(corner_radius=3.0)
    assert cutter.flank_step(cutter.flute_length) == cutter.flute_length


def test_a_tool_whose_lengths_do_not_grow_is_refused() -> None:
    with pytest.raises(ValueError, match="must grow"):
        tool(stickout=30.0)


def test_a_helix_is_as_long_as_it_is() -> None:
    path = quarter_circle()
    assert path.sweeps() == approx([0.0, 0.0, math.pi / 2])
    assert path.lengths() == approx([0.0, 5.0, math.hypot(5 * math.pi, 2.0)])


def test_a_full_circle_ends_where_it_starts() -> None:
    path = Toolpath(
        position=[(10.0, 0.0, 0.0)] * 2,
        axis=[UP] * 2,
        motion=[Motion.RAPID, Motion.ARC_CW],
        centre=[NOWHERE, (0.0, 0.0, 0.0)],
        feed=[0.0, 50.0],
        mark=[0, 0],
    )
    assert path.sweeps()[1] == approx(-2 * math.pi)


def test_a_path_that_starts_with_a_feed_move_is_refused() -> None:
    with pytest.raises(ValueError, match="first block must be a rapid"):
        Toolpath(
            position=[(0.0, 0.0, 0.0)],
            axis=[UP],
            motion=[Motion.LINE],
            centre=[NOWHERE],
            feed=[1.0],
            mark=[0],
        )


def test_an_arc_without_a_centre_is_refused() -> None:
    with pytest.raises(ValueError, match="needs a centre"):
        Toolpath(
            position=[(0.0, 0.0, 0.0)] * 2,
            axis=[UP] * 2,
            motion=[0, 2],
            centre=[NOWHERE] * 2,
            feed=[0.0, 9.0],
            mark=[0, 0],
        )


def test_toolpath_arrays_are_read_only() -> None:
    with pytest.raises(ValueError, match="read-only"):
        quarter_circle().position[0, 0] = 1.0


def test_power_runs_straight_between_the_rows_of_the_curve() -> None:
    machine = Machine(
        name="m",
        title="m",
        axes=(),
        spindle_low=0,
        spindle_high=24000,
        power=((1000.0, 10.0), (3000.0, 30.0)),
        feed_max=1.0,
        tool_change_s=1.0,
        tool_places=1,
    )
    assert [machine.power_at(n) for n in (500.0, 2000.0, 9000.0)] == approx([5.0, 20.0, 30.0])
