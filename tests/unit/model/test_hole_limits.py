"""Limits of a hole and depth of a thread: what they are made of."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from trunnion.model.hole_limits import Limits
from trunnion.model.screw_thread import ScrewThread


def test_limits_have_a_width_and_a_middle():
    limits = Limits(lower=-0.015, upper=0.006)
    assert (limits.width, limits.middle) == pytest.approx((0.021, -0.0045))


@given(st.floats(-1.0, 1.0), st.floats(0.0, 1.0))
def test_the_middle_is_as_far_from_either_limit(lower, width):
    limits = Limits(lower=lower, upper=lower + width)
    assert limits.upper - limits.middle == pytest.approx(limits.middle - limits.lower, abs=1e-12)


def test_limits_the_wrong_way_round_are_refused():
    with pytest.raises(ValueError, match="lower deviation 0.1 is above the upper 0"):
        Limits(lower=0.1, upper=0.0)


def test_a_thread_is_five_eighths_of_its_triangle_deep():
    thread = ScrewThread("M6", 6.0, 1.0, 4.917, 5.153)
    # ISO 724: H1 = 0.541 P.
    assert thread.depth == pytest.approx(0.541, abs=0.0005)
