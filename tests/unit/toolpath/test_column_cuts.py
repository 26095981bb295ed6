"""Straight cuts looked up by squares leave columns as high as all of them do."""

from __future__ import annotations

import numpy as np
import pytest

from trunnion.geometry.kernels.heightfield import columns_cut_reference
from trunnion.toolpath.stock.column_cuts import ColumnCutGrid, ColumnCuts

LOW, HIGH = np.array([-7.0, 3.0]), np.array([18.0, 22.0])


def cuts_of(pick, count=400):
    """Return short and long moves about the plan, some of them wholly beside it."""
    starts = pick.uniform([-20.0, -10.0, 0.0], [30.0, 40.0, 8.0], (count, 3))
    ends = starts + pick.normal(size=(count, 3)) * pick.choice([0.2, 10.0], (count, 1))
    return ColumnCuts(starts, ends, 2.0, 1.0, 4.0)


@pytest.mark.parametrize("seed", range(5))
def test_cuts_by_squares_and_all_cuts_leave_the_same(seed):
    pick = np.random.default_rng(seed)
    cuts, points = cuts_of(pick), pick.uniform(LOW, HIGH, (300, 2))
    heights = pick.uniform(2.0, 12.0, 300)
    by_square = ColumnCutGrid.of(cuts, LOW, HIGH)
    plain, some = heights.copy(), heights.copy()
    data = (cuts.radius, cuts.corner_radius, cuts.flute_length)
    columns_cut_reference(plain, points, cuts.starts, cuts.ends, *data)
    assert np.allclose(by_square.lowered(heights, points), plain, atol=1e-12)
    assert (plain < heights - 0.1).any() and (plain == heights).any()
    done = pick.random(len(cuts.starts)) < 0.3
    columns_cut_reference(some, points, cuts.starts[done], cuts.ends[done], *data)
    assert np.allclose(by_square.lowered(heights, points, done), some, atol=1e-12)


def test_no_cuts_leave_what_stood():
    none = ColumnCuts(np.zeros((0, 3)), np.zeros((0, 3)), 2.0, 1.0, 4.0)
    heights, points = np.array([3.0, 4.0]), np.array([[0.0, 5.0], [17.9, 21.9]])
    assert ColumnCutGrid.of(none, LOW, HIGH).lowered(heights, points).tolist() == [3.0, 4.0]
