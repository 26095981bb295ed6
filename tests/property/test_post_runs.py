"""Straight moves are written many at a time: the texts are those of one block after the other."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from leaning_paths import HEADER, TABLE, path_of, program, standing
from random_programs import program_of, programs
from trunnion import registry
from trunnion.findings import Refused
from trunnion.model.motion.toolpath import Motion
from trunnion.model.spindle import FeedMode
from trunnion.post.settings import PostSettings
from trunnion.post.ticks import TickScale
from trunnion.post.writer import runs
from trunnion.post.writer.klartext import KlartextScale

DIALECTS = ["linuxcnc", "fanuc", "sinumerik", "heidenhain"]
ONE_BY_ONE = 10**9
"""Blocks of a run that no path has."""
by_dialect = pytest.mark.parametrize("name", DIALECTS)


def same_text(name, made, place=None, **chosen):
    """Return the text of a program, which is the same in runs of any length; None where it is refused."""
    dialect, places = registry.get("dialects", name)(), {} if place is None else {"S1": place}
    texts = []
    for least in (1, 3, ONE_BY_ONE):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(runs, "LEAST_RUN", least)
            try:
                texts.append(dialect.write([made], HEADER, PostSettings(**chosen), places))
            except Refused as refused:
                texts.append(str(refused))
    assert texts[0] == texts[2] and texts[1] == texts[2]


@settings(deadline=None, max_examples=200)
@given(
    ticks=st.lists(st.integers(-(10**12), 10**12), max_size=12),
    decimals=st.integers(0, 9),
    point=st.sampled_from(["", ".", ".0"]),
    scale=st.sampled_from([TickScale, KlartextScale]),
)
def test_many_numbers_are_written_as_each_by_itself(ticks, decimals, point, scale):
    made = scale(unit=1.0, decimals=decimals, feed_decimals=1, point=point)
    ticks = [*ticks, 0, *(10**decimals * sign for sign in (1, -20))]
    assert made.texts(np.array(ticks), " X") == [f" X{made.text(v)}" for v in ticks]


@pytest.mark.examples(15)
@by_dialect
@settings(deadline=None, max_examples=40)
@given(parts=programs, units=st.sampled_from(["mm", "inch"]))
def test_runs_of_three_axes_are_written_as_block_by_block(name, parts, units):
    same_text(name, program_of(parts), units=units)


@pytest.mark.examples(15)
@by_dialect
@settings(deadline=None, max_examples=40)
@given(
    stops=st.lists(
        st.tuples(
            st.integers(-2, 2), st.integers(0, 1), st.sampled_from([0.0, 0.1, 0.3]), st.booleans()
        ),
        min_size=4,
        max_size=40,
    ),
    mode=st.sampled_from(FeedMode),
    dwells=st.booleans(),
)
def test_runs_of_five_axes_are_written_as_block_by_block(name, stops, mode, dwells):
    path = path_of(
        *[
            ((5.0 * x, 3.0 * n, float(z)), (math.sin(a), 0.0, math.cos(a)))
            for n, (x, z, a, _) in enumerate(stops)
        ]
    )
    motion, rapid = np.array(path.motion), np.resize([s[3] for s in stops], len(path))
    motion[1:-1] = np.where(rapid[1:-1], Motion.RAPID, Motion.LINE)
    feed = np.where(np.arange(len(path)) % 5 < 3, 300.0, 300.01)
    dwell = np.where(np.arange(len(path)) % 7 == 3, 0.5, 0.0) if dwells else None
    made = program(replace(path, motion=motion, feed=feed, dwell=dwell))
    sections = tuple(replace(s, feed_mode=mode) for s in made.sections)
    same_text(name, replace(made, sections=sections), standing(TABLE))
