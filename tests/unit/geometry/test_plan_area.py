"""What triangles have above a height, in plan."""

from __future__ import annotations

import numpy as np
import pytest

from trunnion.geometry.plane.plan_area import plan_area_above

BASE = np.array([[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [10.0, 10.0, 0.0], [0.0, 10.0, 0.0]])
TIP = np.array([5.0, 5.0, 10.0])
SIDES = np.stack([BASE, np.roll(BASE, -1, axis=0), np.tile(TIP, (4, 1))], axis=1)
EVENED = 0.05
"""mm that a rim may stand out."""


@pytest.mark.parametrize("z", [1.0, 5.0, 9.0])
def test_a_pyramid_is_as_wide_above_a_height_as_its_section_there(z):
    area = plan_area_above(SIDES, z)
    wide = 10.0 - z
    assert wide**2 <= area.area < (wide + 2.0 * EVENED) ** 2


@pytest.mark.parametrize("z", [1.0, 5.0, 9.0])
def test_a_funnel_is_all_above_a_height_but_its_tip(z):
    funnel = SIDES * [1.0, 1.0, -1.0] + [0.0, 0.0, 10.0]
    area = plan_area_above(funnel, z)
    hollow = 100.0 - z**2
    assert hollow <= area.area < hollow + 80.0 * EVENED


def test_a_corner_at_the_very_height_counts_as_above_it():
    area = plan_area_above(SIDES[:1] + [0.0, 0.0, -10.0], -10.0)
    assert area.area == pytest.approx(25.0, abs=30.0 * EVENED)
