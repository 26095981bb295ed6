"""The other panels with known truth, and B1 lying elsewhere, through the whole line: minutes, so left to `make test-long`."""

from __future__ import annotations

import numpy as np
import pytest

from parts import PARTS, needs_parts
from trunnion import tolerance
from trunnion.model.verdict import Outcome
from trunnion.pipeline import Engine

pytestmark = [pytest.mark.long, needs_parts, pytest.mark.timeout(900)]


def programmed(path):
    engine = Engine()
    return engine.run(engine.open(path))


def test_b4_is_programmed_and_proven():
    verdict = programmed(PARTS / "panel" / "B4.step").verdict
    assert verdict.releases and verdict.reachable >= 0.99
    assert (verdict.gouge, verdict.collisions, verdict.rapids_in_stock) == (0.0, 0, 0)


def test_b5_is_programmed_and_proven_from_both_sides():
    session = programmed(PARTS / "panel" / "B5.step")
    verdict = session.verdict
    assert [s.name for s in session.process.setups] == ["S1", "S2"]
    assert verdict.releases and verdict.reachable >= 0.99
    # The waterlines of a leaning side touch it by a micrometre; that is within what contact can tell.
    assert verdict.gouge <= tolerance.CONTACT_BOUND
    assert (verdict.collisions, verdict.rapids_in_stock) == (0, 0)
    webs = [f for f in session.findings() if f.code == "route.thin-web"]
    assert webs and all("2 mm" in f.text for f in webs)


def test_b3_is_programmed_with_its_leaning_walls_and_curved_floors():
    verdict = programmed(PARTS / "panel" / "B3.step").verdict
    assert verdict.releases and verdict.reachable >= 0.99
    assert verdict.gouge <= 0.02 and (verdict.collisions, verdict.rapids_in_stock) == (0, 0)


def test_b1_is_proven_from_iges_too():
    verdict = programmed(PARTS / "panel" / "B1.igs").verdict
    assert verdict.outcome is Outcome.PASSED and verdict.gouge <= 0.02 and verdict.coverage >= 0.99


def test_b1_is_proven_however_it_lies(tmp_path):
    from OCP.STEPControl import STEPControl_Reader

    from samples import turned, written

    reader = STEPControl_Reader()
    reader.ReadFile(str(PARTS / "panel" / "B1.step"))
    reader.TransferRoots()
    verdict = programmed(
        written(turned(reader.OneShape(), (1.0, -2.0, 0.7), 77.0, (3000.0, -200.0, 50.0)))
    ).verdict
    assert verdict.outcome is Outcome.PASSED and verdict.coverage >= 0.99
    assert np.isfinite(verdict.machining_time_s)
