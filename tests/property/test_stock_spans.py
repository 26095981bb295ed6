"""Within a span every point runs straight past the tool: as near as `STOCK_CHORD` to the way it really has, at the same time."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from leaning_tools import EVERY_FORM, leaning_section
from trunnion import tolerance
from trunnion.verify.motion import moves_of
from trunnion.verify.stock.spans import _Poses, spans_each, spans_of

TIMES = np.linspace(0.0, 1.0, 9)
ROUNDED = 1.001
"""Of `STOCK_CHORD`: an even turn is not quite a parabola."""


def moved(seed: int, form: str, turn: float):
    """Return a move of some mm along which the tool turns about any axis across it by up to `turn` rad."""
    rng = np.random.default_rng(seed)
    axis, other = rng.normal(size=3), rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    tips = rng.uniform(-1.0, 1.0, (2, 3)) * rng.choice([0.0, 0.3, 3.0])
    other -= (other @ axis) * axis
    other /= np.linalg.norm(other)
    angle = rng.uniform(0.2, 1.0) * turn
    axes = np.array([axis, np.cos(angle) * axis + np.sin(angle) * other])
    return rng, moves_of([leaning_section(EVERY_FORM[form], tips, axes)])


def strays(rng, moves) -> float:
    """Return how far (mm) points that pass a cutter leave the ways that spans give them, at any time."""
    each = spans_each(moves, np.zeros(len(moves), bool))
    spans = spans_of(moves, np.array([1]), each[[1]], np.zeros(1, bool))
    poses = _Poses(moves, np.ones(1, np.int64))
    tool = moves.tools[0]
    worst, n = 0.0, int(each[1])
    for k, row in enumerate(spans.row):
        angle, radius = rng.uniform(0.0, 2.0 * np.pi, 60), tool.radius * rng.choice([0.0, 1.0], 60)
        own = np.column_stack(
            [
                radius * np.cos(angle),
                radius * np.sin(angle),
                tool.flute_length * rng.choice([0.0, 0.5, 1.0], 60),
            ]
        )
        (tip0, frame0), (tip1, frame1) = (
            (row[t : t + 3], row[f : f + 9].reshape(3, 3)) for t, f in ((0, 3), (12, 15))
        )
        for t in TIMES:
            tip, frame = poses.at(np.array([(k + t) / n]))
            points = tip[0] + own @ frame[0]
            way = (1.0 - t) * (points - tip0) @ frame0.T + t * (points - tip1) @ frame1.T
            worst = max(worst, float(np.linalg.norm(way - own, axis=1).max()))
    return worst


@pytest.mark.examples(40)
@settings(max_examples=120, deadline=None)
@given(st.integers(0, 10**6), st.sampled_from(["ball", "bull", "taper"]), st.floats(0.001, 0.6))
def test_points_pass_a_turning_tool_as_its_spans_say(seed, form, turn):
    rng, moves = moved(seed, form, turn)
    assert strays(rng, moves) <= ROUNDED * tolerance.STOCK_CHORD
