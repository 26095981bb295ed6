"""The drive geometry of interrupted turning: circles about the main axis with the gaps between bosses that are cut on each."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.geometry.development import Development
from trunnion.model.guides import GuideCurve, GuideKind
from trunnion.plan.plane_guides import GuideSpace, line_along

ARC = math.radians(2.0)
"""Angle between two points of a guide line about the axis at most."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GapPass:
    """One turn of the table: the tool is `along` mm up the ground's straight lines, in each of the `gaps` down on the ground and between
    them `lift` mm over it. A gap is two angles (rad) from the development's middle, the second one above the first."""

    along: float
    lift: float
    gaps: tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class GapDrive:
    """Passes over ground that turns under a tool, in order; `clearance` mm over the ground the tool is clear of all."""

    development: Development
    passes: tuple[GapPass, ...]
    clearance: float

    @property
    def is_empty(self) -> bool:
        """Whether there is no gap to turn."""
        return not self.passes

    def guides(self, space: GuideSpace) -> tuple[GuideCurve, ...]:
        """Return the arcs on the ground in the gaps of all passes; their places don't depend on the frame."""
        return tuple(
            line_along(
                GuideKind.CONTOUR,
                self._arc(one, begin, end),
                (),
                GuideSpace(np.asarray, space.faces_at),
            )
            for one in self.passes
            for begin, end in one.gaps
        )

    def _arc(self, one: GapPass, begin: float, end: float) -> Floats:
        """Return points (n, 3) on the ground from one angle to another, in the part's coordinates."""
        count = max(2, math.ceil((end - begin) / ARC) + 1)
        turns = np.linspace(begin, end, count)
        return self.development.points_about_axis(np.full(count, one.along), turns, np.zeros(count))
