"""The drive geometry of turning: what must stand and what is there, in the plane through the work's axis."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from trunnion.geometry.arrays import Floats, floats
from trunnion.model.guides import GuideCurve, GuideKind
from trunnion.plan.plane_guides import GuideSpace, line_along

LEAST_AREA = 0.05
"""mm2 of the meridian: less is not worth a pass."""


@dataclass(frozen=True, eq=False, kw_only=True)
class RevolvedDrive:
    """What a turning operation cuts: `part` (k, 2), the closed outline of r and z in mm in the setup's frame that must stand when turning
    is done; what is left on it is the strategy's. `to_cut` mm2 is what of the stock's meridian lies beyond it.
    """

    part: Floats
    to_cut: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "part", floats(self.part, (None, 2), "turned part"))

    @property
    def is_empty(self) -> bool:
        """Whether there is nothing to turn."""
        return self.to_cut <= LEAST_AREA

    def guides(self, space: GuideSpace) -> tuple[GuideCurve, ...]:
        """Return the outline that must stand, in the half plane of x."""
        r, z = np.vstack([self.part, self.part[:1]]).T
        points = np.column_stack([r, np.zeros(len(r)), z])
        return (line_along(GuideKind.CONTOUR, points, (), space),)

    @cached_property
    def part_area(self) -> BaseGeometry:
        """The part's meridian."""
        return shapely.Polygon(self.part)
