"""Five-axis parts through the whole line on a trunnion machine: released, no gouge, no collision, no rapid in stock."""

from __future__ import annotations

import pytest

from seeded.blades import blade, fan
from trunnion import tolerance
from trunnion.findings import Severity
from trunnion.pipeline import Engine

pytestmark = [pytest.mark.long, pytest.mark.timeout(1800)]
CHOICES = {"setup.machine": "Trunnion 650", "surface.scallop": 0.02}


@pytest.mark.parametrize("part", [blade, fan])
def test_a_five_axis_part_is_released(part, tmp_path):
    engine = Engine()
    session = engine.open(part(0).written(tmp_path))
    session = engine.run(engine.with_choices(session, CHOICES))
    verdict = session.verdict
    errors = [str(f) for f in session.findings() if f.severity is Severity.ERROR]
    assert verdict.releases, errors
    assert (verdict.collisions, verdict.rapids_in_stock) == (0, 0)
    assert verdict.gouge <= tolerance.GOUGE
