"""What leaning tools have cut: the poses of their flutes, taken off the positions of a lattice that stand.

No field of heights can hold such a cut. A position counts as gone where the flutes hold it, whatever of its cell they left.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.frame import Frame
from trunnion.geometry.kernels.bodies import lattice_held
from trunnion.geometry.sphere import angle_between
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.model.tool import Tool
from trunnion.settings import digest
from trunnion.toolpath.stock.heightfield import positions_on

STEP = 0.5
"""mm that no place of the flutes goes between two poses that are looked at: half of what positions lie apart, or less."""
RINGS = 6
"""Heights up the round end of a cutter between which it counts as a cone."""
ROUND = ("ball", "bull", "flat")
"""Forms whose flutes are known as a round end with a cylinder over it; what others cut is not taken off."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class StockLattice:
    """Positions at even distances in a frame: from `low` (3,) mm, `step` (3,) mm apart, `count` of them along each axis."""

    low: Floats
    step: Floats
    count: tuple[int, int, int]

    def points(self) -> Floats:
        """Return all positions (k, 3), those along the last axis next to each other."""
        return self.low + np.argwhere(np.ones(self.count, dtype=bool)) * self.step


@dataclass(frozen=True)
class LeaningCut:
    """The path of a leaning tool in a frame: what its feed moves cut."""

    path: Toolpath
    tool: Tool
    frame: Frame

    @cached_property
    def digest(self) -> str:
        """A short stable digest of what is cut."""
        return digest(self.path.position, self.path.axis, self.path.motion, self.tool, self.frame)

    @cached_property
    def poses(self) -> tuple[Floats, Floats]:
        """Tips and axes (k, 3) along the moves, in the part's coordinates."""
        path = self.path
        start, turned_from = path.starts(), np.vstack([path.axis[:1], path.axis[:-1]])
        turn = angle_between(turned_from, path.axis)
        moved = np.linalg.norm(path.position - start, axis=1) + self.tool.flute_length * turn
        count = np.maximum(np.ceil(moved / STEP), 1.0).astype(np.int64)
        count[path.motion == Motion.RAPID] = 0
        rows = np.repeat(np.arange(len(path)), count)
        share = (np.arange(len(rows)) - np.repeat(np.cumsum(count) - count, count) + 1) / count[
            rows
        ]
        axis = turned_from[rows] + share[:, None] * (path.axis[rows] - turned_from[rows])
        axis /= np.linalg.norm(axis, axis=1, keepdims=True)
        tip = positions_on(path, rows, share)
        return self.frame.to_world(tip), self.frame.world_direction(axis)

    def take_off(self, present: Bools, lattice: StockLattice, frame: Frame) -> None:
        """Clear what the flutes hold of the positions of a lattice in a frame that stand (nx, ny, nz)."""
        tips, axes = self.poses
        if self.tool.form in ROUND and len(tips):
            lattice_held(
                present,
                lattice.low,
                lattice.step,
                np.ascontiguousarray(frame.to_local(tips)),
                np.ascontiguousarray(frame.local_direction(axes)),
                _flutes(self.tool),
            )


def _flutes(tool: Tool) -> Floats:
    """Return the cutting part of a tool as cones (r, 4) from the tip up, inside of it."""
    lean = np.linspace(0.0, 0.5 * np.pi, RINGS + 1)
    height = tool.corner_radius * (1.0 - np.cos(lean))
    wide = tool.radius - tool.corner_radius * (1.0 - np.sin(lean))
    height, wide = np.append(height, tool.flute_length), np.append(wide, tool.radius)
    rows = np.column_stack([height[:-1], wide[:-1], height[1:], wide[1:]])
    return np.ascontiguousarray(rows[rows[:, 2] > rows[:, 0]])
