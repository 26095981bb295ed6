"""Bounds of what a tool sweeps in a span hold all that it sweeps, and say more of a ray than the box does."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from leaning_tools import EVERY_FORM, cutter, leaning_section
from trunnion.verify.kernels.body import (
    CLOSED_FIRST,
    CLOSED_LAST,
    R_MAX,
    Z_HIGH,
    Z_LOW,
    radius_at,
)
from trunnion.verify.kernels.stock import swept_bounds as kernel
from trunnion.verify.motion import moves_of
from trunnion.verify.stock.spans import spans_each, spans_of

COUNT = 40
"""Points tried in each span."""


def poses(rng, turns):
    """Return three tips (3, 3) and unit axes (3, 3), still ones unless the tool turns."""
    lean = rng.normal(size=(3, 3)) * 0.4 + rng.normal(size=3)
    axis = lean if turns else np.tile(lean[:1], (3, 1))
    return rng.uniform(-20.0, 20.0, (3, 3)), axis / np.linalg.norm(axis, axis=1, keepdims=True)


def swept(rng, row, piece, arcs):
    """Return random points (COUNT, 3) that a piece passes in a span, half of them on its surface, by the ways of its points."""
    height = rng.uniform(*piece[[Z_LOW, Z_HIGH]], COUNT)
    ends = int(piece[CLOSED_FIRST]), int(piece[CLOSED_LAST])
    widest = np.array([max(radius_at(arcs, *ends, h), 0.0) for h in height])
    angle, radius = rng.uniform(0.0, 2.0 * np.pi, COUNT), widest * rng.choice([1.0, 0.5], COUNT)
    own = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), height])
    t = rng.uniform(size=(COUNT, 1))
    start, end = (
        row[tip : tip + 3] + own @ row[frame : frame + 9].reshape(3, 3)
        for tip, frame in ((kernel.TIP0, kernel.FRAME0), (kernel.TIP1, kernel.FRAME1))
    )
    return (1.0 - t) * start + t * end


@pytest.mark.examples(20)
@settings(max_examples=60, deadline=None)
@given(st.integers(0, 10**6), st.sampled_from(sorted(EVERY_FORM)), st.booleans())
def test_what_a_piece_sweeps_is_within_its_frustum(seed, form, turns):
    rng = np.random.default_rng(seed)
    tips, axes = poses(rng, turns)
    moves = moves_of([leaning_section(EVERY_FORM[form], tips, axes)])
    whole = np.zeros(len(moves), dtype=bool)
    each = spans_each(moves, whole)
    spans = spans_of(moves, np.arange(len(moves)), each, whole)
    frustum, box = np.zeros(kernel.FRUSTUM), np.zeros(6)
    for axis in range(3):
        for row in spans.along(axis)[rng.integers(0, len(spans.row), 4)]:
            for piece in moves.bodies.of(0):
                enclosing = kernel.enclosing_frustum(moves.bodies.arc, piece)
                kernel.swept_frustum(frustum, row, piece, *enclosing, turns)
                kernel.swept_box(box, row, piece, turns)
                for u, v, w in swept(rng, row, piece, moves.bodies.arc):
                    low, high = kernel.frustum_interval(frustum, u, v)
                    assert low <= w <= high
                    assert (box[:3] <= (u, v, w)).all() and (box[3:] >= (u, v, w)).all()


def test_a_flank_that_bends_up_to_its_top_is_within_its_frustum():
    tool = cutter("form", flute=12.0, outline=((1.0, 0.0, 0.1), (5.0, 12.0, 0.0)))
    up = np.array([0.0, 0.0, 1.0])
    moves = moves_of([leaning_section(tool, [[0, 0, 0], [1, 0, 0]], [up, up])])
    piece, arcs = moves.bodies.of(0)[0], moves.bodies.arc
    start, grows = kernel.enclosing_frustum(arcs, piece)
    assert 0.0 < grows < 0.3
    ends = int(piece[CLOSED_FIRST]), int(piece[CLOSED_LAST])
    for h in np.linspace(piece[Z_LOW], piece[Z_HIGH], 5001):
        assert radius_at(arcs, *ends, h) <= start + grows * h


def test_beside_and_beyond_a_leaning_tool_a_ray_is_not_looked_at():
    lean = np.array([0.0, np.sin(0.8), np.cos(0.8)])
    moves = moves_of([leaning_section(EVERY_FORM["flat"], [[0, 0, 0], [0.5, 0, 0]], [lean, lean])])
    row = spans_of(moves, np.array([1]), np.array([1]), np.zeros(1, bool)).along(2)[0]
    piece = moves.bodies.of(0)[0]
    frustum, box = np.zeros(kernel.FRUSTUM), np.zeros(6)
    kernel.swept_frustum(
        frustum, row, piece, *kernel.enclosing_frustum(moves.bodies.arc, piece), False
    )
    kernel.swept_box(box, row, piece, False)
    radius = piece[R_MAX]
    # Through the tip, the ray meets the end face there, and the flank on the other side.
    low, high = kernel.frustum_interval(frustum, 0.25, 0.0)
    assert np.allclose([low, high], [0.0, radius / np.sin(0.8)], atol=0.6)
    assert box[5] - box[2] > 2.0 * (high - low)
    # Just beside the flank, though inside of the box.
    low, high = kernel.frustum_interval(frustum, 0.25 + radius + 0.3, 0.0)
    assert low > high and box[0] < 0.25 + radius < box[3]


def test_a_ray_along_the_axis_is_in_or_out_as_a_whole():
    up = np.array([0.0, 0.0, 1.0])
    moves = moves_of([leaning_section(EVERY_FORM["ball"], [[0, 0, 0], [1, 0, 0]], [up, up])])
    row = spans_of(moves, np.array([1]), np.array([1]), np.zeros(1, bool)).along(2)[0]
    piece = moves.bodies.of(0)[0]
    frustum = np.zeros(kernel.FRUSTUM)
    kernel.swept_frustum(
        frustum, row, piece, *kernel.enclosing_frustum(moves.bodies.arc, piece), False
    )
    low, high = kernel.frustum_interval(frustum, 0.5, piece[R_MAX])
    assert np.allclose([low, high], piece[[Z_LOW, Z_HIGH]], atol=1e-4)
    low, high = kernel.frustum_interval(frustum, 0.5, piece[R_MAX] + 0.6)
    assert low > high
