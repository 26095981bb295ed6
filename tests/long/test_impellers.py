"""A random impeller with root fillets through the whole line: released, no gouge, no collision, no rapid in stock."""

from __future__ import annotations

import pytest

from seeded.impellers import impeller
from trunnion import tolerance
from trunnion.findings import Severity
from trunnion.pipeline import Engine

pytestmark = [pytest.mark.long, pytest.mark.timeout(3600)]
CHOICES = {
    "setup.machine": "Trunnion 650",
    "post.dialect": "sinumerik",
    "repair.rounds": 0,
}


@pytest.mark.parametrize("seed", [0])
def test_a_random_impeller_with_root_fillets_is_released(seed, tmp_path):
    engine = Engine()
    session = engine.open(impeller(seed, rounded=True).written(tmp_path))
    session = engine.run(engine.with_choices(session, CHOICES))
    verdict = session.verdict
    errors = [str(f) for f in session.findings() if f.severity is Severity.ERROR]
    assert verdict.releases, errors
    assert (verdict.collisions, verdict.rapids_in_stock) == (0, 0)
    assert verdict.gouge <= tolerance.GOUGE and verdict.coverage > 0.98
