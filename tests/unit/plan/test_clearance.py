"""Who answers a strategy whose tool leans: machine limits, room for the holder, and moves as well as poses."""

from __future__ import annotations

import numpy as np
import pytest
from pytest import approx

from leaning_tools import cutter
from trunnion.geometry.frame import WORLD, Frame
from trunnion.part.read.part_file import read_part
from trunnion.part.shape.skin import skin_of
from trunnion.pipeline.planning.clearance import PartClearance
from trunnion.shop import load_shop
from trunnion.toolpath.contact_passes.axis_search import thickened

BALL = cutter("ball", diameter=6.0, corner=3.0, flute=12.0)
UP, SIDE, DOWN = (
    np.array([[0.0, 0.0, 1.0]]),
    np.array([[1.0, 0.0, 0.0]]),
    np.array([[0.6, 0.0, -0.8]]),
)


@pytest.fixture(scope="module")
def block(sample_part):
    """The block with a pocket, from the part's box: its skin and itself."""
    part = read_part(sample_part)
    return part, skin_of(part, WORLD, 0.01)


def around(block, machine="Trunnion 650", cutting=WORLD):
    part, skin = block
    return PartClearance(
        part, skin.moved(WORLD, cutting), cutting, WORLD, load_shop().machines[machine]
    )


def test_a_tool_above_the_part_is_clear_and_one_in_it_is_not(block) -> None:
    part, ask = block[0], around(block)(BALL)
    middle = 0.5 * (part.low + part.high)
    above = np.array([[middle[0], middle[1], part.high[2]]])
    assert ask(above + [0.0, 0.0, 0.1], UP).all()
    beside = np.array([[part.low[0] + 1.0, part.low[1] + 1.0, part.high[2]]])
    assert ask(beside, UP).all() and not ask(beside - [0.0, 0.0, 0.1], UP).any()


def test_a_move_is_asked_all_along_its_way(block) -> None:
    part, ask = block[0], around(block)(BALL)
    y, z = 0.5 * (part.low[1] + part.high[1]), part.high[2] - 2.0
    left, right = (np.array([[x, y, z]]) for x in (part.low[0] - 50.0, part.high[0] + 50.0))
    assert ask(left, UP).all() and ask(right, UP).all()
    assert not ask(right, UP, start_tip=left, start_axis=UP).any()
    assert ask(
        right + [0.0, 0.0, 90.0], UP, start_tip=left + [0.0, 0.0, 90.0], start_axis=SIDE
    ).all()


def test_an_axis_beyond_the_machine_s_limits_is_not_clear_wherever_the_tool_is(block) -> None:
    far = block[0].high[None] + 500.0
    three, five = around(block, "Mill 1200")(BALL), around(block)(BALL)
    assert three(far, UP).all() and not three(far, SIDE).any()
    assert five(far, SIDE).all() and not five(far, DOWN).any()


def test_a_turn_between_two_axes_that_leaves_the_machine_s_limits_is_not_clear(block) -> None:
    far, lean = block[0].high[None] + 500.0, np.radians(119.0)
    first = np.array([[np.sin(lean), 0.0, np.cos(lean)]])
    ask = around(block)(BALL)
    for aside, clear in ((1.0, True), (90.0, False)):
        turn = np.radians(aside)
        last = np.array([[np.sin(lean) * np.cos(turn), np.sin(lean) * np.sin(turn), np.cos(lean)]])
        assert ask(far, first).all() and ask(far, last).all()
        assert ask(far, last, start_tip=far, start_axis=first).all() == clear


def test_poses_are_given_in_the_cutting_frame(block) -> None:
    turned = Frame(np.zeros(3), np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, -1.0]))
    part = block[0]
    # z of this frame points down in the setup's: the machine can't hold it, but it can hold its opposite.
    ask = around(block, cutting=turned)(BALL)
    above = turned.to_local(np.array([[part.low[0] + 1.0, part.low[1] + 1.0, part.high[2] + 0.1]]))
    assert ask(above, -UP).all() and not ask(above, UP).any()


def test_neck_shank_and_holder_are_asked_for_thicker_than_they_are() -> None:
    thick = thickened(BALL, 0.25)
    assert (thick.diameter, thick.corner_radius) == (BALL.diameter, BALL.corner_radius)
    assert thick.shank_diameter == approx(BALL.shank_diameter + 0.5)
    assert [row[1] for row in thick.holder.rows] == approx(
        [row[1] + 0.25 for row in BALL.holder.rows]
    )
