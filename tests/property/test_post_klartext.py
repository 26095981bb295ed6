"""Helices in Klartext are said by angles: whatever parts they are made of, read again they go where they were planned to."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from programs import CCW, CW, FLAT_16, LINE, RAPID, S1, path_of, section
from random_programs import coordinates, farthest
from trunnion.model.motion.program import Program
from trunnion.model.motion.toolpath import Motion
from trunnion.post.dialects.heidenhain import HeidenhainDialect
from trunnion.post.header import Header
from trunnion.post.linearize import lines_for_arcs
from trunnion.post.settings import PostSettings

HEADER = Header(name="B1", part="B1", part_digest="ab12", plan_digest="cd34")
turns = st.lists(st.floats(0.02, math.tau), min_size=1, max_size=20)
climbs = st.sampled_from([-0.6, -0.013, 0.25])
TICK = {"mm": 1e-4, "inch": 25.4e-5}
"""mm of the last decimal."""
CHORD = 2e-4
"""mm that the polyline which is compared may leave the arcs."""


@st.composite
def windings(draw):
    """Return a path of one or two helices, each of parts of turns that climb evenly, then down to the next."""
    x, y = draw(coordinates), draw(coordinates)
    blocks = [(RAPID, x, y, 50.0)]
    for _ in range(draw(st.integers(1, 2))):
        radius, angle, sense = (
            draw(st.floats(0.5, 60.0)),
            draw(st.floats(0, math.tau)),
            draw(st.sampled_from([CW, CCW])),
        )
        climb, z = draw(climbs), draw(st.floats(-5.0, 5.0))
        blocks.append((LINE, x, y, z, 300.0))
        cx, cy = x - radius * math.cos(angle), y - radius * math.sin(angle)
        for turn in draw(turns):
            angle += turn if sense == CCW else -turn
            z += climb * turn
            x, y = cx + radius * math.cos(angle), cy + radius * math.sin(angle)
            blocks.append((sense, x, y, z, cx, cy, 300.0))
    return path_of(*blocks, (RAPID, x, y, 50.0))


def opened(path):
    """Return the points (n, 3) of a path with its arcs as lines within `CHORD`."""
    arcs = np.flatnonzero(path.motion >= Motion.ARC_CW)
    return lines_for_arcs(path, arcs, CHORD)[0].position


@settings(deadline=None, max_examples=60)
@given(path=windings(), units=st.sampled_from(["mm", "inch"]))
def test_helices_go_where_they_were_planned_to(path, units):
    dialect = HeidenhainDialect()
    made = Program(name="B1.S1", setup=S1, sections=(section("op", FLAT_16, path, 9000.0),))
    text = dialect.write([made], HEADER, PostSettings(units=units))
    (read,) = dialect.read(text, (FLAT_16,), [S1])
    found = read.sections[0].path
    within = 6 * TICK[units] + CHORD
    assert farthest(found.position, opened(path)) <= within
    assert farthest(path.position, opened(found)) <= within
