"""A random impeller with root fillets through the whole line: released, no gouge, no collision, no rapid in stock."""

from __future__ import annotations

import pytest

from releases import assert_released
from seeded.impellers import impeller
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
    assert_released(session, coverage=0.98)
