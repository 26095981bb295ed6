"""Random parts: every program that the proof releases is clean in the simulation, which shares nothing with planner and proof."""

from __future__ import annotations

import pytest

from seeded.panels import panel
from seeded.plates import plate
from simulated import simulated
from simulation.judge import judged

pytestmark = [pytest.mark.long, pytest.mark.timeout(900)]


def _is_clean(part, folder):
    for program in simulated(part.written(folder), folder):
        report = judged(program.on, program.text)
        if program.told["verdict"].startswith("passed"):
            assert report.is_clean(program.told["coverage"]), (report.left, report.faults[:5])


@pytest.mark.parametrize("seed", range(60, 68))
def test_what_is_released_of_a_random_panel_is_clean(seed, tmp_path):
    _is_clean(panel(seed), tmp_path)


@pytest.mark.parametrize("seed", range(60, 64))
def test_what_is_released_of_a_random_plate_is_clean(seed, tmp_path):
    _is_clean(plate(seed), tmp_path)
