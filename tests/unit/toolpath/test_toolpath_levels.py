"""Heights of layers, axial steps and fillet steps, worked out by hand."""

from __future__ import annotations

import itertools
import math

import pytest

from trunnion.toolpath.offsetting.levels import fillet_steps, layers, steps_down


def test_steps_are_equal_and_end_at_the_bottom() -> None:
    assert steps_down(0.0, -10.0, 4.0) == pytest.approx((-10 / 3, -20 / 3, -10.0))


def test_a_depth_that_fits_exactly_needs_no_further_step() -> None:
    assert steps_down(0.3, -8.7, 3.0) == pytest.approx((-2.7, -5.7, -8.7))


def test_the_last_layer_leaves_the_allowance_on_a_floor() -> None:
    assert layers(0.0, -9.0, 4.0, [-9.0], 0.3)[-1] == pytest.approx(-8.7)


def test_a_band_that_ends_on_no_face_is_cut_to_its_end() -> None:
    assert layers(0.0, -9.0, 4.0, [-20.0], 0.3)[-1] == -9.0


def test_a_band_thinner_than_its_allowance_needs_no_layer() -> None:
    assert layers(-8.7, -9.0, 4.0, [-9.0], 0.3) == ()


def test_a_cutter_with_the_fillets_radius_makes_it_in_one_pass() -> None:
    assert fillet_steps(3.0, 3.0, 0.01) == (0.0,)
    assert fillet_steps(0.0, 0.0, 0.01) == (0.0,)


@pytest.mark.parametrize("corner", [0.5, 1.0, 2.0, 2.5])
def test_cusps_on_a_fillet_stay_below_the_scallop(corner: float) -> None:
    gap, scallop = 3.0 - corner, 0.01
    steps = fillet_steps(3.0, corner, scallop)
    angles = [math.asin(min(1.0, (gap - t) / gap)) for t in steps]
    for a, b in itertools.pairwise(angles):
        half = 0.5 * (b - a)
        cusp = 3.0 - gap * math.cos(half) - math.sqrt(corner**2 - (gap * math.sin(half)) ** 2)
        assert cusp <= scallop + 1e-9


def test_fillet_steps_go_from_the_top_of_the_fillet_to_the_floor() -> None:
    steps = fillet_steps(3.0, 1.0, 0.01)
    assert steps[0] == pytest.approx(2.0)
    assert steps[-1] == 0.0
    assert list(steps) == sorted(steps, reverse=True)
