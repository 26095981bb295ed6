"""Drilling cycles: what they expand to, worked out by hand and for any numbers."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pytest import approx

from random_programs import cycle, cycles, ticks
from trunnion.model.motion.cycle import BACK_OFF, MOST_PECKS, Cycle, CycleKind, expanded
from trunnion.model.motion.drilling import drilled
from trunnion.model.motion.toolpath import Motion

UP = np.array([0.0, 0.0, 1.0])
TOP = np.array([10.0, 5.0, 2.0])
HIGH = np.array([0.0, 0.0, 20.0])


@st.composite
def directions(draw):
    a, b = draw(st.floats(0.0, 2 * math.pi)), draw(st.floats(-1.0, 1.0))
    return np.array([math.sqrt(1 - b * b) * math.cos(a), math.sqrt(1 - b * b) * math.sin(a), b])


def heights(made, start=TOP):
    """Return the strokes of a cycle from its retract plane as (height, F or R)."""
    found = expanded(made, start, TOP, UP)
    return [
        (round(z - TOP[2], 6), "R" if rapid else "F")
        for z, rapid in zip(found.position[:, 2], found.rapid, strict=True)
    ]


@pytest.mark.parametrize(
    ("kind", "strokes"),
    [
        ("drill", [(-7.0, "F"), (0.0, "R")]),
        ("dwell", [(-7.0, "F"), (0.0, "R")]),
        (
            "peck",
            [
                (-3.0, "F"),
                (0.0, "R"),
                (-2.746, "R"),
                (-6.0, "F"),
                (0.0, "R"),
                (-5.746, "R"),
                (-7.0, "F"),
                (0.0, "R"),
            ],
        ),
        (
            "chip-break",
            [(-3.0, "F"), (-2.746, "R"), (-6.0, "F"), (-5.746, "R"), (-7.0, "F"), (0.0, "R")],
        ),
        ("ream", [(-7.0, "F"), (0.0, "F")]),
        ("bore", [(-7.0, "F"), (0.0, "F")]),
        ("tap", [(-7.0, "F"), (0.0, "F")]),
    ],
)
def test_the_strokes_of_each_kind(kind, strokes):
    assert heights(cycle(CycleKind(kind))) == strokes


def test_a_cycle_goes_over_the_hole_then_down_and_ends_where_it_is_told():
    found = expanded(cycle(CycleKind.DRILL, lift=18.0), HIGH, TOP, UP)
    assert found.position.tolist() == [[10, 5, 20], [10, 5, 2], [10, 5, -5], [10, 5, 20]]
    assert found.rapid.tolist() == [True, True, False, True]


def test_from_below_the_retract_plane_it_goes_up_first():
    found = expanded(cycle(CycleKind.DRILL), np.array([0.0, 5.0, -3.0]), TOP, UP)
    assert found.position.tolist() == [[0, 5, 2], [10, 5, 2], [10, 5, -5], [10, 5, 2]]


def test_the_tool_waits_at_the_bottom():
    found = expanded(cycle(CycleKind.BORE), TOP, TOP, UP)
    assert found.dwell.tolist() == [0.5, 0.0]


@given(made=cycles(), start=st.tuples(ticks, ticks, ticks), axis=directions())
def test_whatever_its_numbers_a_cycle_reaches_its_bottom_once_and_ends_at_its_lift(
    made, start, axis
):
    found = expanded(made, np.array(start), TOP, axis)
    along = (found.position - TOP) @ axis
    assert along.min() == approx(-made.depth)
    assert along[-1] == approx(made.lift)
    # Strokes at the feed never pass what the ones before have cut by more than one peck.
    feeds = along[~found.rapid]
    into = feeds[feeds < -1e-6]
    assert len(into) == made.pecks
    assert np.diff(into, prepend=0.0).min() >= -max(made.peck, made.depth * (made.peck == 0.0)) * (
        1 + 1e-9
    )
    assert found.dwell.sum() == made.dwell


@given(made=cycles())
def test_a_rapid_never_goes_below_what_is_cut(made):
    along = (expanded(made, HIGH, TOP, UP).position - TOP) @ UP
    rapid, reached = expanded(made, HIGH, TOP, UP).rapid, 0.0
    for z, fast in zip(along, rapid, strict=True):
        assert not fast or z >= reached + (BACK_OFF - 1e-9 if z < 0.0 else 0.0)
        reached = min(reached, z)


@given(made=cycles(), feed=ticks, n=st.integers(1, 4))
def test_a_path_of_holes_holds_each_cycle_as_one_block(made, feed, n):
    tops = np.array([[20.0 * k, 3.0, 1.0] for k in range(n)])
    path = drilled(HIGH, tops, made, feed)
    assert [b.cycle for b in path.cycles] == [made] * n
    for block, top in zip(path.cycles, tops, strict=True):
        assert path.position[block.last] == approx(top + made.lift * UP)
        rows = slice(block.first, block.last + 1)
        assert path.position[rows, 2].min() == approx(top[2] - made.depth)
        assert set(path.feed[rows][path.motion[rows] == Motion.LINE]) == {feed}
    assert path.dwells().sum() == approx(n * made.dwell)


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"kind": CycleKind.DRILL, "depth": 0.0}, "its depth is above 0"),
        ({"kind": CycleKind.DRILL, "depth": 1.0, "lift": -1.0}, "at or above the retract plane"),
        ({"kind": CycleKind.PECK, "depth": 1.0}, "deep drilling has a peck"),
        ({"kind": CycleKind.DRILL, "depth": 1.0, "peck": 1.0}, "deep drilling has a peck"),
        ({"kind": CycleKind.PECK, "depth": 1.0, "peck": 0.2}, "deeper than the back-off of 0.254"),
        ({"kind": CycleKind.PECK, "depth": 400.0, "peck": 0.3}, f"more than {MOST_PECKS}"),
        ({"kind": CycleKind.DRILL, "depth": 1.0, "dwell": 1.0}, "only dwell drilling and boring"),
        ({"kind": CycleKind.DWELL, "depth": 1.0}, "its dwell is above 0"),
        ({"kind": CycleKind.TAP, "depth": 1.0}, "tapping has a pitch"),
    ],
)
def test_numbers_that_make_no_cycle_are_refused(changes, says):
    with pytest.raises(ValueError, match=says):
        Cycle(**changes)
