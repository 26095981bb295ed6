"""Scallops, stepovers, and the paper's efficiency figures by the same arithmetic."""

from __future__ import annotations

import math

import pytest

from trunnion.plan.freeform.estimate.efficiency import AreaRate, gain, mixed_time, saving
from trunnion.plan.freeform.estimate.scallop import (
    height_of,
    stepover_on_plane,
)

LARGE = AreaRate(area=1440.73, time=2 * 3600 + 16 * 60 + 2)
SMALL = AreaRate(area=1440.73, time=2 * 3600 + 54 * 60 + 22)


@pytest.mark.parametrize(
    ("large", "small", "gained", "saved"),
    [
        ((1440.73,), (), 28.18, 21.98),
        ((3391.81, 5432.81), (2746.51,), 20.14, 16.77),
        ((735.836,), (737.478,), 12.33, 10.98),
    ],
)
def test_the_three_gains_of_the_paper(large, small, gained, saved) -> None:
    old, new = (
        mixed_time((), (*large, *small), LARGE, SMALL),
        mixed_time(large, small, LARGE, SMALL),
    )
    assert (round(100 * gain(old, new), 2), round(100 * saving(old, new), 2)) == (gained, saved)


def test_a_stepover_leaves_the_scallop_it_was_chosen_for() -> None:
    half = 0.5 * stepover_on_plane(4.0, 0.004)
    assert 4.0 - math.sqrt(4.0**2 - half**2) == pytest.approx(0.004)


def test_equal_scallops_of_a_wider_cutter_gain_the_root_of_the_radii() -> None:
    assert stepover_on_plane(4.0, 0.004) / stepover_on_plane(3.0, 0.004) == pytest.approx(
        math.sqrt(8 / 6), rel=1e-3
    )


def test_the_papers_scallop_for_its_roughness() -> None:
    assert height_of(1.6) == pytest.approx(0.004)
