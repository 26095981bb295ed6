"""Toolpaths as lines to be drawn."""

from __future__ import annotations

import math

import numpy as np
import pytest

from trunnion.model.motion.toolpath import EMPTY, Mark, Motion, Toolpath
from trunnion.report.lines import MOTIONS, kinds_of, leans, opened, strokes


def path_of(rows, axis=(0.0, 0.0, 1.0)) -> Toolpath:
    """Return a path of rows (position, motion, mark, centre); the axis is one for all, or one each."""
    axes = np.broadcast_to(np.asarray(axis, float), (len(rows), 3))
    return Toolpath(
        position=np.array([r[0] for r in rows], float),
        axis=axes,
        motion=np.array([r[1] for r in rows]),
        mark=np.array([r[2] for r in rows]),
        centre=np.array([r[3] or (np.nan,) * 3 for r in rows], float),
        feed=np.array([0.0 if r[1] == Motion.RAPID else 500.0 for r in rows]),
    )


def straight(*points, axis=(0.0, 0.0, 1.0)) -> Toolpath:
    return path_of(
        [(p, Motion.LINE if n else Motion.RAPID, Mark.CUT, None) for n, p in enumerate(points)],
        axis,
    )


def test_the_kinds_are_the_marks_and_rapids():
    assert (*(m.name.lower() for m in Mark), "rapid") == MOTIONS
    path = path_of(
        [
            ((0, 0, 5), Motion.RAPID, Mark.RETRACT, None),
            ((0, 0, 0), Motion.LINE, Mark.ENTRY, None),
            ((9, 0, 0), Motion.LINE, Mark.CUT, None),
        ]
    )
    assert [MOTIONS[k] for k in kinds_of(path)] == ["rapid", "entry", "cut"]


def test_an_opened_helix_stays_on_its_cylinder_and_climbs_evenly():
    path = path_of(
        [
            ((10, 0, 0), Motion.RAPID, Mark.RETRACT, None),
            ((0, 10, -3), Motion.ARC_CCW, Mark.ENTRY, (0, 0, 0)),
        ]
    )
    points, block = opened(path)
    assert len(points) == len(block) + 1 == 16
    assert np.hypot(points[:, 0], points[:, 1]) == pytest.approx(10.0)
    assert points[:, 2] == pytest.approx(np.linspace(0.0, -3.0, 16))
    assert points[-1] == pytest.approx(path.position[-1])


def test_an_arc_of_a_tilted_tool_lies_across_its_axis():
    axis = np.array([0.6, 0.0, 0.8])
    u, v = np.array([0.8, 0.0, -0.6]), np.array([0.0, 1.0, 0.0])
    path = path_of(
        [(5 * u, Motion.RAPID, Mark.RETRACT, None), (5 * v, Motion.ARC_CCW, Mark.LEAD, (0, 0, 0))],
        axis,
    )
    points, _ = opened(path)
    assert points @ axis == pytest.approx(0.0, abs=1e-12)
    assert np.linalg.norm(points, axis=1) == pytest.approx(5.0)
    assert len(points) == 16


def test_a_path_without_blocks_has_no_lines():
    points, block = opened(EMPTY)
    assert len(points) == len(block) == len(strokes(EMPTY, 1.0, 5.0, 10)) == 0


def test_an_upright_tool_needs_no_strokes():
    assert not leans(straight((0, 0, 0), (30, 0, 0)))
    assert len(strokes(straight((0, 0, 0), (30, 0, 0)), 1.0, 5.0, 10)) == 0


def test_strokes_stand_at_equal_distances_along_the_axis():
    tilt = (math.sin(0.3), 0.0, math.cos(0.3))
    made = strokes(straight((0, 0, 0), (10, 0, 0), (10, 30, 0), axis=tilt), 8.0, 5.0, 100)
    assert made[:, 0] == pytest.approx(
        np.array([at(run) for run in (40 / 12, 10.0, 50 / 3, 70 / 3, 30.0, 110 / 3)])
    )
    assert made[:, 1] - made[:, 0] == pytest.approx(np.tile(5.0 * np.array(tilt), (6, 1)))


def at(run: float) -> tuple[float, float, float]:
    """Return the place on the corner path after a way."""
    return (min(run, 10.0), max(run - 10.0, 0.0), 0.0)


def test_between_two_blocks_the_axis_turns_evenly():
    path = straight((0, 0, 0), (20, 0, 0), axis=[(0.0, 0.0, 1.0), (1.0, 0.0, 0.0)])
    made = strokes(path, 30.0, 1.0, 10)
    assert made[0] == pytest.approx(
        np.array([(10, 0, 0), (10 + math.sqrt(0.5), 0, math.sqrt(0.5))])
    )


def test_a_long_path_has_no_more_strokes_than_asked_for():
    assert len(strokes(straight((0, 0, 0), (1000, 0, 0), axis=(0.6, 0.0, 0.8)), 1.0, 5.0, 40)) == 40
