"""How near finishing passes lie: what ridges and chords leave together counts as finished."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from trunnion import tolerance
from trunnion.plan.freeform.finishing.chord import chord_choices, laid_height

STRATEGIES = ("surface.parallel", "surface.constant", "surface.waterline", "surface.point")


@given(st.sampled_from(STRATEGIES), st.floats(0.0005, tolerance.GOUGE))
def test_the_highest_ridge_and_the_chord_error_together_are_finished(
    strategy: str, height: float
) -> None:
    laid = laid_height(strategy, height)
    (chord,) = chord_choices(strategy, laid).values()
    assert 0.7 * height < laid <= height
    assert 1.1 * laid + chord + tolerance.SKIN_CHORD <= tolerance.GOUGE + 1e-12


@pytest.mark.parametrize("height", [0.002, 0.004, 0.01, 0.03, 0.2])
def test_what_is_wanted_fine_or_on_purpose_coarse_is_as_wanted(height: float) -> None:
    assert laid_height("surface.parallel", height) == height
