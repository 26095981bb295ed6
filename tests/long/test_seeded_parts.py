"""Random parts through the whole line: released, without a gouge, or rejected with a line that a person can act on."""

from __future__ import annotations

import pytest

from seeded.edged_panels import edged_panel
from seeded.panels import panel
from seeded.plates import plate
from trunnion import tolerance
from trunnion.findings import Severity
from trunnion.pipeline import Engine

pytestmark = [pytest.mark.long, pytest.mark.timeout(900)]


def _verdict(part, folder):
    engine = Engine()
    session = engine.run(engine.open(part.written(folder)))
    errors = [f for f in session.findings() if f.severity is Severity.ERROR]
    assert session.verdict.releases, [str(f) for f in errors]
    assert session.verdict.gouge <= tolerance.GOUGE
    return session.verdict


@pytest.mark.parametrize("seed", range(210, 218))
def test_a_random_panel_is_released(seed, tmp_path):
    verdict = _verdict(panel(seed), tmp_path)
    assert (verdict.collisions, verdict.rapids_in_stock) == (0, 0)


@pytest.mark.parametrize("seed", range(210, 216))
def test_a_random_panel_with_edges_is_released(seed, tmp_path):
    verdict = _verdict(edged_panel(seed), tmp_path)
    assert (verdict.collisions, verdict.rapids_in_stock) == (0, 0)


@pytest.mark.parametrize("seed", range(210, 213))
def test_a_random_plate_is_released(seed, tmp_path):
    verdict = _verdict(plate(seed), tmp_path)
    assert (verdict.collisions, verdict.rapids_in_stock) == (0, 0)
