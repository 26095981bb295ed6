"""Five-axis parts through the whole line on a trunnion machine: released, no gouge, no collision, no rapid in stock."""

from __future__ import annotations

import pytest

from releases import assert_released
from seeded.blades import blade, fan
from trunnion.pipeline import Engine

pytestmark = [pytest.mark.long, pytest.mark.timeout(1800)]
CHOICES = {"setup.machine": "Trunnion 650", "surface.scallop": 0.02}


@pytest.mark.parametrize("part", [blade, fan])
def test_a_five_axis_part_is_released(part, tmp_path):
    engine = Engine()
    session = engine.open(part(0).written(tmp_path))
    session = engine.run(engine.with_choices(session, CHOICES))
    assert_released(session)
