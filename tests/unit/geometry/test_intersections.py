"""Which segments can meet."""

from __future__ import annotations

import numpy as np
import pytest

from trunnion.geometry.plane.curve import Curve, join_segments, segment_boxes
from trunnion.geometry.plane.intersections import CLOSE, overlapping_boxes


@pytest.mark.parametrize("spread", [3.0, 30.0])
def test_boxes_that_meet_are_found_in_the_order_of_their_rows(spread):
    numbers = np.random.default_rng(7)
    curves = [
        Curve(
            (numbers.uniform(0.0, spread, 2) + numbers.integers(-2, 3, (5, 2))).astype(float),
            numbers.choice([0.0, 0.5, -1.0], 5),
            True,
        )
        for _ in range(40)
    ]
    s = join_segments(c.segments() for c in curves)
    low, high = segment_boxes(s)
    pairs = [
        (i, j)
        for i in range(len(s))
        for j in range(i + 1, len(s))
        if (low[i] - 2.0 * CLOSE <= high[j]).all() and (low[j] - 2.0 * CLOSE <= high[i]).all()
    ]
    i, j = overlapping_boxes(s)
    assert pairs == list(zip(i.tolist(), j.tolist(), strict=True))
