"""Fixtures and areas to avoid in the way of links: how low the tip may go between two positions without coming near one."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.geometry.surface.drop_surface import DropSurface, tops_over
from trunnion.model.keep_out import plan_boxes
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.freeform.cutters.cutter import level_disc

SPACING = 2.0
"""mm between the positions of a link that are looked at; the tool is taken wider by half of it, so that nothing falls in between."""


@dataclass(frozen=True, slots=True, eq=False)
class FixtureSurface:
    """The fixtures of a setup in its frame, ready for a tool that comes down on them (None: it has none), and the boxes (k, 5), as
    `DropSurface.avoid` has them, that the tip stays out of."""

    surface: DropSurface | None
    avoid: Floats

    @staticmethod
    def of(setup: Setup) -> FixtureSurface | None:
        """Return the fixtures of a setup and what is avoided in it, None where it has neither."""
        corners = [f.mesh.corners().reshape(-1, 3) for f in setup.fixtures]
        if not corners:
            return FixtureSurface(None, plan_boxes(setup.avoid)) if setup.avoid else None
        points = setup.frame.to_local(np.concatenate(corners))
        surface = DropSurface.of(points, np.arange(len(points)).reshape(-1, 3))
        return FixtureSurface(surface, plan_boxes(setup.avoid))

    def lowest_tip(self, tool: Tool, start: Floats, end: Floats) -> float:
        """Return how low the tip may go between two positions (2,), all of the tool its room away from fixtures and the tip out of what is
        avoided; -inf beside all."""
        way = _along(start, end)
        between = 0.5 * SPACING if len(way) > 1 else 0.0
        top = float(tops_over(way, self.avoid, between).max())
        if self.surface is None:
            return top
        wider = tolerance.FIXTURE_CLEARANCE + between
        tips = [
            self.surface.drop(way, level_disc(radius + wider), -math.inf).max() - above
            for above, radius in tool.rings()
        ]
        return max(top, float(max(tips)) + tolerance.FIXTURE_CLEARANCE)


def _along(start: Floats, end: Floats) -> Floats:
    """Return positions (k, 2) on the straight way between two, no farther apart than `SPACING`."""
    count = math.ceil(float(np.hypot(*(end - start))) / SPACING)
    return np.asarray(start + np.linspace(0.0, 1.0, count + 1)[:, None] * (end - start))
