"""Pockets with leaning walls and curved floors through the whole line, seeded ones too: a minute each, so left to `make test-long`."""

from __future__ import annotations

from functools import cache
from typing import Any

import pytest

import leaning_pockets
import samples
from trunnion.model.session import Session
from trunnion.model.verdict import Outcome
from trunnion.pipeline import Engine
from trunnion.tolerance import CONTACT_BOUND, FINISH_GOUGE, GOUGE

pytestmark = [pytest.mark.long, pytest.mark.timeout(900)]

SEEDS = range(5)


@cache
def programmed(shape: Any, machine: str = "") -> Session:
    engine = Engine()
    words: dict[str, Any] = {"repair.rounds": 0}
    if machine:
        words["setup.machine"] = machine
    return engine.run(engine.with_choices(engine.open(samples.written(shape)), words))


@pytest.mark.parametrize(
    "shape", [leaning_pockets.leaning_block, leaning_pockets.bowl_block], ids=["away", "bowl"]
)
def test_open_walls_and_curved_floors_are_finished(shape: Any) -> None:
    verdict = programmed(shape()).verdict
    assert verdict is not None and verdict.outcome in (Outcome.PASSED, Outcome.REMARKS)
    assert verdict.reachable >= 0.99 and verdict.gouge <= FINISH_GOUGE
    assert (verdict.collisions, verdict.rapids_in_stock) == (0, 0)


def test_a_wall_that_leans_over_is_left_whole_and_the_rest_is_finished() -> None:
    session = programmed(leaning_pockets.mixed_block())
    verdict = session.verdict
    assert verdict is not None and verdict.releases
    assert verdict.reachable >= 0.99 and verdict.collisions == 0
    assert verdict.gouge <= FINISH_GOUGE
    assert session.recognition is not None
    (hanging,) = session.recognition.feature("pocket-01").with_role("inner_convergence")
    assert f"face {hanging}" in {
        w for f in session.findings() if f.code == "route.not-planned" for w in f.where
    }
    (proof,) = [f for f in verdict.faces if f.face == hanging]
    # What the contact engine can tell from nothing.
    assert proof.gouge <= CONTACT_BOUND and not proof.planned


@pytest.mark.parametrize("seed", SEEDS)
def test_random_leans_depths_and_radii_are_finished_without_a_gouge(seed: int) -> None:
    verdict = programmed(leaning_pockets.random_block(seed)).verdict
    assert verdict is not None and verdict.releases, [str(f) for f in verdict.findings]
    assert verdict.reachable >= 0.99 and verdict.gouge <= FINISH_GOUGE and verdict.collisions == 0


@pytest.mark.parametrize("seed", SEEDS)
def test_random_leans_depths_and_radii_are_swarf_milled(seed: int) -> None:
    session = programmed(leaning_pockets.random_block(seed), "Trunnion 650")
    assert session.process is not None
    assert "surface.swarf" in {o.strategy for o in session.process.operations}
    verdict = session.verdict
    assert verdict is not None and verdict.releases, [str(f) for f in verdict.findings]
    assert verdict.reachable >= 0.99 and verdict.gouge <= GOUGE and verdict.collisions == 0
