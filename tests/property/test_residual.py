"""Random cutters, moves and points: material left against a far finer search that samples, looks closer and samples again."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from leaning_tools import EVERY_FORM, PlainCutter, leaning_section
from trunnion.model.motion.toolpath import Motion
from trunnion.verify.finish.sweep import Sweep
from trunnion.verify.motion import moves_of

FIXED, TURNING = 2e-3, 5e-3
QUICK = settings(deadline=None, max_examples=25, phases=[Phase.explicit, Phase.generate])
NUMBER = st.integers(-1000, 1000).map(lambda n: n / 50)
PLAIN = {name: PlainCutter(tool) for name, tool in EVERY_FORM.items()}
POINTS = st.lists(st.tuples(NUMBER, NUMBER, NUMBER), min_size=4, max_size=8).map(np.array)


@st.composite
def axes(draw):
    """A tool axis: upright, or leaning anywhere."""
    if draw(st.integers(0, 2)) == 0:
        return np.array([0.0, 0.0, 1.0])
    lean, about = draw(st.floats(0.0, 2.0)), draw(st.floats(0.0, 6.28))
    return np.array(
        [math.sin(lean) * math.cos(about), math.sin(lean) * math.sin(about), math.cos(lean)]
    )


@st.composite
def tips(draw):
    return np.array([draw(NUMBER), draw(NUMBER), draw(NUMBER)])


def agrees(form, section, points, bound):
    most = np.full(len(points), 15.0)
    left, nearest = Sweep.of(moves_of([section]), 15.0).residual(points, most, threads=1)
    true = np.minimum([PLAIN[form].nearest(section, 1, p) for p in points], most)
    if form == "form":
        # Inside of several bodies the deepest one counts, which is less deep than their union.
        left, true = np.maximum(left, 0.0), np.maximum(true, 0.0)
    assert (left >= true - 1e-4).all(), (left, true)
    assert (left <= true + bound).all(), (left, true)
    assert ((nearest == 1) == (left < most)).all() or form == "form"


@pytest.mark.examples(10)
@QUICK
@given(
    form=st.sampled_from(sorted(EVERY_FORM)), start=tips(), end=tips(), axis=axes(), points=POINTS
)
def test_lines_come_as_near_as_a_finer_search_finds(form, start, end, axis, points):
    agrees(form, leaning_section(EVERY_FORM[form], [start, end], [axis, axis]), points, FIXED)


@pytest.mark.examples(10)
@QUICK
@given(
    form=st.sampled_from(sorted(EVERY_FORM)),
    start=tips(),
    depth=st.floats(0.1, 40.0),
    axis=axes(),
    points=POINTS,
)
def test_plunges_come_as_near_as_a_finer_search_finds(form, start, depth, axis, points):
    agrees(
        form,
        leaning_section(EVERY_FORM[form], [start, start - depth * axis], [axis, axis]),
        points,
        FIXED,
    )


@pytest.mark.examples(10)
@QUICK
@given(
    form=st.sampled_from(sorted(EVERY_FORM)),
    start=tips(),
    axis=axes(),
    radius=st.floats(0.5, 30.0),
    turn=st.floats(0.1, 6.2),
    climb=st.sampled_from([0.0, 0.5, -4.0]),
    clockwise=st.booleans(),
    points=POINTS,
)
def test_arcs_and_helices_come_as_near_as_a_finer_search_finds(
    form, start, axis, radius, turn, climb, clockwise, points
):
    aside = np.cross(axis, [0.3, 0.5, 0.81])
    aside = radius * aside / np.linalg.norm(aside)
    angle = -turn if clockwise else turn
    end = (
        start
        + aside
        - (math.cos(angle) * aside + math.sin(angle) * np.cross(axis, aside))
        + climb * axis
    )
    section = leaning_section(
        EVERY_FORM[form],
        [start, end],
        [axis, axis],
        centre=start + aside,
        motion=Motion.ARC_CW if clockwise else Motion.ARC_CCW,
    )
    agrees(form, section, points, FIXED)


@pytest.mark.examples(10)
@QUICK
@given(
    form=st.sampled_from(sorted(EVERY_FORM)),
    start=tips(),
    end=tips(),
    first=axes(),
    last=axes(),
    share=st.floats(0.02, 1.0),
    points=POINTS,
)
def test_turning_axes_come_as_near_as_a_finer_search_finds(
    form, start, end, first, last, share, points
):
    last = first + share * (last - first)
    if np.linalg.norm(last) < 0.1:
        last = first
    agrees(
        form,
        leaning_section(EVERY_FORM[form], [start, start + share * (end - start)], [first, last]),
        points,
        TURNING,
    )
