"""Fixtures in the way of links: how low the tip may go between two positions without any of the tool coming near one."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.geometry.surface.drop_surface import DropSurface
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.freeform.cutters.cutter import level_disc

SPACING = 2.0
"""mm between the positions of a link that are looked at; the tool is taken wider by half of it, so that nothing falls in between."""


@dataclass(frozen=True, slots=True, eq=False)
class FixtureSurface:
    """The fixtures of a setup in its frame, ready for a tool that comes down on them."""

    surface: DropSurface

    @staticmethod
    def of(setup: Setup) -> FixtureSurface | None:
        """Return the fixtures of a setup, None where it has none."""
        corners = [f.mesh.corners().reshape(-1, 3) for f in setup.fixtures]
        if not corners:
            return None
        points = setup.frame.to_local(np.concatenate(corners))
        return FixtureSurface(DropSurface.of(points, np.arange(len(points)).reshape(-1, 3)))

    def lowest_tip(self, tool: Tool, start: Floats, end: Floats) -> float:
        """Return how low the tip may go between two positions (2,), all of the tool its room away from fixtures; -inf beside them."""
        way = _along(start, end)
        wider = tolerance.FIXTURE_CLEARANCE + (0.5 * SPACING if len(way) > 1 else 0.0)
        tips = [
            self.surface.drop(way, level_disc(radius + wider), -math.inf).max() - above
            for above, radius in tool.rings()
        ]
        return float(max(tips)) + tolerance.FIXTURE_CLEARANCE


def _along(start: Floats, end: Floats) -> Floats:
    """Return positions (k, 2) on the straight way between two, no farther apart than `SPACING`."""
    count = math.ceil(float(np.hypot(*(end - start))) / SPACING)
    return np.asarray(start + np.linspace(0.0, 1.0, count + 1)[:, None] * (end - start))
