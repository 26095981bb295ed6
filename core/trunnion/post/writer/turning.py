"""What a section's blocks are where the work turns: points in the plane ZX, X from the work's axis."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.model.motion.program import ProgramSection
from trunnion.model.motion.toolpath import Toolpath
from trunnion.post.ticks import TickScale, WrittenPath, written
from trunnion.post.writer.rotary import inverse_minutes

ZX = [2, 0, 1]
"""Columns of a point with z and x first: about +y the turn from z to x is anticlockwise, as from x to y about +z."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TurningForm:
    """Points of a tool that stands still; see `rotary.AxisForm`."""

    scale: TickScale
    letters: str = ""

    def blocks(
        self, section: ProgramSection, angle: list[int] | None, goes_on: bool
    ) -> tuple[WrittenPath, Floats]:
        """Return the blocks with z, x and 0 as their numbers, and the minutes of those that are fed in inverse time."""
        path = written(in_plane(section.path), self.scale, section.operation)
        return path, inverse_minutes(section, path, self.scale)


def in_plane(path: Toolpath) -> Toolpath:
    """Return a path of turning work with z and x as its first two coordinates."""
    return replace(
        path,
        position=path.position[:, ZX],
        centre=path.centre[:, ZX],
        axis=np.tile([0.0, 0.0, 1.0], (len(path), 1)),
        work_turns=False,
    )
