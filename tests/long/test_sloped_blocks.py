"""Blocks with slopes outside of their pocket through the whole line, each released as it is planned first."""

from __future__ import annotations

import pytest

import samples
import sloped_blocks
from trunnion import tolerance
from trunnion.pipeline import Engine

pytestmark = [pytest.mark.long, pytest.mark.timeout(900)]

SHAPES = {
    "chamfers": sloped_blocks.chamfered_block,
    "flat chamfers": lambda: sloped_blocks.chamfered_block(2.0, 1.0),
    "away": sloped_blocks.drafted_block,
    "over": lambda: sloped_blocks.drafted_block(-6.0),
    "wide": lambda: sloped_blocks.drafted_block(14.0),
    "fringe": sloped_blocks.fringed_block,
}


@pytest.mark.parametrize("name", SHAPES)
def test_a_block_with_slopes_is_released(name) -> None:
    engine = Engine()
    session = engine.open(samples.written(SHAPES[name]()))
    session = engine.run(engine.with_choices(session, {"repair.rounds": "0"}))
    verdict = session.verdict
    assert verdict.releases, [str(f) for f in session.findings()]
    assert (verdict.collisions, verdict.rapids_in_stock) == (0, 0)
    assert verdict.gouge <= tolerance.GOUGE and verdict.reachable >= 0.99
