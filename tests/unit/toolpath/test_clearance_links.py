"""Links over a blank, looked at where the blank is a ball about the origin."""

from __future__ import annotations

import math

import numpy as np
import pytest

from leaning_tools import cutter
from trunnion.toolpath.contact_passes.blank_clearance import tool_outside
from trunnion.toolpath.contact_passes.linking.clearance_links import ClearanceLinks

RADIUS, CLEARANCE = 20.0, 2.0
OUTSIDE = tool_outside(
    cutter("ball", 6.0, 3.0), lambda p: RADIUS - np.linalg.norm(p, axis=1), CLEARANCE
)


def everything(tip, axis):
    return np.ones(len(tip), dtype=bool)


def links(holds=everything) -> ClearanceLinks:
    return ClearanceLinks(outside=OUTSIDE, holds=holds)


def pose(angle: float, depth: float = 5.0):
    """Return a tip as deep in the ball as said, and the axis out of it, at an angle (degrees) from z."""
    out = np.array([[math.sin(math.radians(angle)), 0.0, math.cos(math.radians(angle))]])
    return (RADIUS - depth) * out, out


def test_a_link_leaves_and_arrives_along_the_axes_and_keeps_clear_between():
    (link,) = links().between(pose(-20.0), pose(20.0))
    assert link is not None
    for row, angle in ((0, -20.0), (-1, 20.0)):
        tip, axis = pose(angle)
        along = float((link.tip[row] - tip[0]) @ axis[0])
        assert link.tip[row] == pytest.approx(tip[0] + along * axis[0]) and along >= 7.0
        assert link.axis[row] == pytest.approx(axis[0])
    assert OUTSIDE(link.tip, link.axis).all()
    share = np.linspace(0.0, 1.0, 5)[:, None]
    middle = link.tip[:-1] + share[:, :, None] * np.diff(link.tip, axis=0)
    assert np.linalg.norm(middle, axis=2).min() > RADIUS + CLEARANCE - 0.1


def test_the_other_side_of_the_blank_is_not_reached_straight():
    assert links().between(pose(0.0), pose(175.0)) == [None]


def test_an_axis_that_the_machine_can_not_hold_makes_no_link():
    def steep(tip, axis):
        return axis[:, 2] < 0.99

    assert links(steep).between(pose(-20.0), pose(20.0)) == [None]


def test_a_tool_that_is_clear_already_is_not_lifted():
    (link,) = links().between(pose(-5.0, depth=-6.0), pose(5.0, depth=-6.0))
    assert link is not None and link.tip[0] == pytest.approx(pose(-5.0, depth=-6.0)[0][0])
