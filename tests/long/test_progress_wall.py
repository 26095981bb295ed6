"""Progress in seconds over the whole line of parts with known truth: generous, because other work runs on the machine as well."""

from __future__ import annotations

import time

import pytest

from parts import PARTS, needs_parts
from trunnion.pipeline import STEPS, Engine
from trunnion.progress import Progress

pytestmark = [pytest.mark.long, needs_parts, pytest.mark.timeout(1800)]

WITHOUT_LOOK, WITHOUT_REPORT = 2.0, 2.5
"""Seconds at most: ten times and five times what is wanted. The mesh of a whole part is one call of the CAD kernel and is made before."""


class Clock:
    """When looks and reports came."""

    def __init__(self) -> None:
        self.looks, self.reports = [time.perf_counter()], [time.perf_counter()]

    def progress(self) -> Progress:
        return Progress(lambda fraction, text: self.reports.append(time.perf_counter()), self._look)

    def _look(self) -> bool:
        self.looks.append(time.perf_counter())
        return False

    def longest(self) -> tuple[float, float]:
        """Return the longest gaps between looks and between reports."""
        now = time.perf_counter()
        return tuple(
            max(b - a for a, b in zip(times, [*times[1:], now], strict=True))
            for times in (self.looks, self.reports)
        )


@pytest.mark.parametrize(
    "name", ["panel/B1.step", "panel/B2.step", "surface/D2.step", "surface/D1.igs"]
)
def test_no_step_stands_still(name):
    engine = Engine()
    session = engine.open(PARTS / name)
    engine.mesh(session)
    slow = {}
    for step in STEPS:
        clock = Clock()
        session = engine.run(session, step, clock.progress())
        look, report = clock.longest()
        if look > WITHOUT_LOOK or report > WITHOUT_REPORT:
            slow[step] = (look, report)
    assert slow == {}
