"""What a ball cutter has cut, against the distance to the moves of its path."""

from __future__ import annotations

import math

import numpy as np
import pytest

from leaning_tools import cutter
from trunnion.geometry.frame import WORLD, Frame
from trunnion.model.motion.toolpath import Mark, Motion, Toolpath
from trunnion.plan.channel.cut_space import RIDGE, CutSpace

BALL = cutter("ball", 6.0, 3.0, flute=12.0)
TAPER = cutter("taper", 4.0, 2.0, flute=20.0, taper_angle=4.0)
WITHIN = 0.2


def path(tips, axis=(0.0, 0.0, 1.0), rapids=(0,)) -> Toolpath:
    n = len(tips)
    axes = np.broadcast_to(np.asarray(axis) / np.linalg.norm(axis), (n, 3))
    motion = np.full(n, Motion.LINE)
    motion[list(rapids)] = Motion.RAPID
    return Toolpath(
        position=np.asarray(tips, dtype=float),
        axis=axes,
        motion=motion,
        centre=np.full((n, 3), np.nan),
        feed=np.where(motion == Motion.RAPID, 0.0, 1000.0),
        mark=np.full(n, Mark.CUT),
    )


def depth_in(tool, points, start, end, axis):
    """Return how deep points lie in what a tool of one axis sweeps from one tip to another, by the nearest of many poses: the reference."""
    deep = np.full(len(points), -np.inf)
    slope = math.radians(tool.taper_angle) if tool.form == "taper" else 0.0
    for share in np.linspace(0.0, 1.0, 2001):
        away = points - (start + share * (end - start) + tool.corner_radius * axis)
        up = away @ axis
        off = np.linalg.norm(away - up[:, None] * axis, axis=1)
        ball = tool.corner_radius - np.hypot(up, off)
        flank = tool.corner_radius / math.cos(slope) + math.tan(slope) * up - off
        inside = (up > 0.0) & (up <= tool.flute_length - tool.corner_radius)
        deep = np.maximum(deep, np.where(inside, np.maximum(ball, flank), ball))
    return deep


@pytest.mark.parametrize("tool", [BALL, TAPER], ids=["ball", "taper"])
@pytest.mark.parametrize("seed", range(3))
def test_it_holds_what_the_cutter_sweeps_and_nothing_beyond(tool, seed):
    random = np.random.default_rng(seed)
    start, end = random.uniform(-10.0, 10.0, (2, 3))
    axis = random.normal(size=3)
    axis /= np.linalg.norm(axis)
    space = CutSpace.of(path([start, end], axis), tool)
    points = random.uniform(-20.0, 20.0, (4000, 3))
    deep = depth_in(tool, points, start, end, axis)
    held = space.holds(points, WITHIN)
    assert not held[deep < -WITHIN - 0.01].any()
    # In the ball all of it is found; up a flank the poses nearest to a point may not be those that hold it.
    near = np.linalg.norm(points[:, None] - space.centre[None], axis=2).min(axis=1) < tool.radius
    assert held[(deep > 2.0 * RIDGE - WITHIN) & near].all() and (deep > 0.0).sum() > 5


def test_rapids_cut_nothing():
    space = CutSpace.of(path([(0, 0, 0), (10, 0, 0), (10, 10, 0)], rapids=(0, 1)), BALL)
    assert not space.holds(np.array([[3.0, 0.0, 1.0]]), 0.0)[0]
    assert space.holds(np.array([[10.0, 5.0, 1.0]]), 0.0)[0]


def test_it_is_the_same_in_another_frame():
    other = Frame(np.array([1.0, 2.0, 3.0]), np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.6, 0.8]))
    space = CutSpace.of(path([(0, 0, 0), (10, 0, 0)]), BALL)
    points = np.random.default_rng(0).uniform(-8.0, 12.0, (200, 3))
    moved = space.moved(WORLD, other)
    assert (moved.holds(other.to_local(points), 0.1) == space.holds(points, 0.1)).all()
