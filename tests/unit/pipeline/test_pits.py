"""Random panels with pits in the walls of their pocket, from the file to the proof."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from long_mark import mostly_long
from pitted import pitted_block
from releases import assert_released
from seeded.pitted_panels import pitted_panel
from trunnion.model.tool import T_SLOT
from trunnion.pipeline import Engine
from trunnion.pipeline.proof.posted_programs import program_of, prove_programs
from trunnion.progress import NO_PROGRESS


@pytest.mark.parametrize("seed", mostly_long((0, 6), 0))
def test_random_pits_are_cut_without_a_gouge(seed, tmp_path):
    part = pitted_panel(seed)
    engine = Engine()
    session = engine.run(engine.open(part.written(tmp_path)))
    pits = session.recognition.of_kind("pit")
    assert len(pits) == part.counts["pit"]
    assert_released(session)
    assert session.verdict.reachable > 0.995
    cut = {o.feature for o in session.process.operations if o.kind == "pit"}
    assert cut == {p.id for p in pits}
    finished = {f.face: f.finished / f.area for f in session.verdict.faces}
    backs = [tag for p in pits for tag in p.with_role("floor")]
    assert min(finished[tag] for tag in backs) > 0.7


def test_a_disc_that_goes_in_deeper_than_its_neck_lets_it_is_found():
    engine, session = pitted_block()
    session = engine.run(session, until="verify")
    program = program_of(session, session.setups[0])

    def deeper(section):
        if section.tool.form != T_SLOT:
            return section
        position = section.path.position.copy()
        low = position[:, 2] < -12.0
        off = position[low, 1] - np.median(position[low, 1])
        position[low, 1] += 2.0 * np.sign(off[np.abs(off).argmax()])
        return replace(section, path=replace(section.path, position=position))

    changed = replace(program, sections=tuple(map(deeper, program.sections)))
    verdict = prove_programs(session, engine.context, (changed,), NO_PROGRESS)
    assert not verdict.releases and verdict.gouge > 0.5
