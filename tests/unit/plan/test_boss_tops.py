"""Bosses of a panel, lower than its top and in no pocket: their tops are cut from whichever side they look to, and the part is released."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import cadquery as cq
import numpy as np
import pytest

from long_mark import mostly_long
from trunnion.pipeline import Engine
from trunnion.recognize.panel import PanelFamily
from trunnion.recognize.panel.settings import PanelSettings

WEB, HIGH = 8.0, 24.0
"""Thickness of the web that carries the bosses, and height of the highest one, mm."""


def _arm(seed: int) -> tuple[cq.Workplane, int, int]:
    """Return an arm with a boss at either end and one in its middle, and how many are lower than the middle one above and below."""
    rng = np.random.default_rng(seed)
    length, radius = rng.uniform(90.0, 130.0), rng.uniform(16.0, 22.0, 3)
    tops = np.array([HIGH / 2.0, *(HIGH / 2.0 - rng.choice([0.0, 1.5, 3.0, 6.0], 2))])
    bottoms = np.array([HIGH / 2.0, *(HIGH / 2.0 - rng.choice([0.0, 1.5, 3.0, 6.0], 2))])
    arm = cq.Workplane("XY").box(2.0 * length, 2.0 * float(radius.min()) - 4.0, WEB)
    for x, r, up, down in zip((0.0, -length, length), radius, tops, bottoms, strict=True):
        boss = cq.Workplane("XY").circle(float(r)).extrude(float(up + down))
        arm = arm.union(boss.translate((float(x), 0.0, -float(down))))
    lower = [int((h < HIGH / 2.0).sum()) for h in (tops, bottoms)]
    return arm, lower[0], lower[1]


def _opened(seed: int, folder: Path):
    arm, above, below = _arm(seed)
    path = folder / "arm.step"
    cq.exporters.export(arm, str(path))
    engine = Engine()
    return engine, engine.open(path), above, below


@pytest.mark.parametrize("seed", mostly_long(range(6), 1))
def test_each_low_top_is_a_boss_and_is_cut_from_its_side(seed, tmp_path):
    engine, session, above, below = _opened(seed, tmp_path)
    session = engine.run(session, "route")
    bosses = session.recognition.of_kind("boss")
    sides = [bool(b.attributes.get("direction")) for b in bosses]
    # The frame may look from either side: which one is up is not the arm's to say.
    assert sorted([sides.count(False), sides.count(True)]) == sorted([above, below])
    cut = {o.feature: o.setup for o in session.process.operations if o.kind == "boss_top"}
    assert cut.keys() == {b.id for b in bosses}
    assert len({cut[b.id] for b in bosses}) == len(set(sides))
    for boss in bosses:
        # A person who makes a boss of its top gets what recognition gives.
        bare = replace(boss, sizes={}, attributes={})
        graph = engine.context_of(session).part.graph()
        made = PanelFamily().described(bare, session.recognition, graph, PanelSettings())
        assert (made.faces, made.sizes, made.attributes) == (
            boss.faces,
            boss.sizes,
            boss.attributes,
        )


@pytest.mark.parametrize("seed", [1])
def test_an_arm_with_low_bosses_is_released(seed, tmp_path):
    engine, session, above, below = _opened(seed, tmp_path)
    assert above and below
    verdict = engine.run(session).verdict
    assert verdict.releases and verdict.coverage > 0.999 and verdict.gouge == 0.0


@pytest.mark.long
@pytest.mark.parametrize("seed", range(2, 6))
def test_other_arms_with_low_bosses_are_released(seed, tmp_path):
    engine, session, _, _ = _opened(seed, tmp_path)
    verdict = engine.run(session).verdict
    assert verdict.releases and verdict.gouge == 0.0
