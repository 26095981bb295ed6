"""What leaning tools have cut: the poses of their flutes. No field of heights can hold such a cut; `voxels.py` does."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from trunnion.geometry.arrays import Floats, items_of
from trunnion.geometry.frame import Frame
from trunnion.geometry.sphere import angle_between
from trunnion.model.motion.toolpath import Motion, Toolpath
from trunnion.model.tool import Tool
from trunnion.settings import digest
from trunnion.toolpath.stock.heightfield import positions_on

STEP = 0.5
"""mm that no place of the flutes goes between two poses that are looked at; what they cut only on the way there counts as left."""
RINGS = 6
"""Heights up the round end of a cutter between which it counts as a cone."""
ROUND = ("ball", "bull", "flat")
"""Forms whose flutes are known as a round end with a cylinder over it; what others cut is not taken off."""


@dataclass(frozen=True)
class LeaningCut:
    """The path of a leaning tool in a frame, for a feature, what its feed moves cut; `allowance`: mm that it leaves for later ones, 0 where
    it leaves nothing."""

    path: Toolpath
    tool: Tool
    frame: Frame
    feature: str = ""
    allowance: float = 0.0

    @cached_property
    def digest(self) -> str:
        """A short stable digest of what is cut."""
        return digest(self.path.position, self.path.axis, self.path.motion, self.tool, self.frame)

    def poses_in(self, frame: Frame, step: float = STEP) -> tuple[Floats, Floats]:
        """Return tips and axes (k, 3) along the moves in a frame, between which no place of the flutes goes farther than a step (mm)."""
        path = self.path
        start, turned_from = path.starts(), np.vstack([path.axis[:1], path.axis[:-1]])
        turn = angle_between(turned_from, path.axis)
        moved = np.linalg.norm(path.position - start, axis=1) + self.tool.flute_length * turn
        count = np.maximum(np.ceil(moved / step), 1.0).astype(np.int64)
        count[path.motion == Motion.RAPID] = 0
        rows, number = items_of(count)
        share = (number + 1) / count[rows]
        axis = turned_from[rows] + share[:, None] * (path.axis[rows] - turned_from[rows])
        axis /= np.linalg.norm(axis, axis=1, keepdims=True)
        tip = self.frame.to_world(positions_on(path, rows, share))
        return frame.to_local(tip), frame.local_direction(self.frame.world_direction(axis))

    def flutes(self, inside: float) -> Floats:
        """Return the cutting part of the tool as cones (r, 4), as `flutes_of` has them."""
        return flutes_of(self.tool, inside)


def flutes_of(tool: Tool, inside: float) -> Floats:
    """Return the cutting part of a tool as cones (r, 4) from the tip up, with at least `inside` (mm) of it all round them; nothing where it
    is too small or not known."""
    corner, wide = max(tool.corner_radius - inside, 0.0), tool.radius - inside
    if tool.form not in ROUND or wide <= 0.0:
        return np.zeros((0, 4))
    lean = np.linspace(0.0, 0.5 * np.pi, RINGS + 1)
    height = inside + corner * (1.0 - np.cos(lean))
    reach = wide - corner * (1.0 - np.sin(lean))
    top = tool.flute_length - inside
    height, reach = np.append(height, top), np.append(reach, wide)
    rows = np.column_stack([height[:-1], reach[:-1], height[1:], reach[1:]])
    return np.ascontiguousarray(rows[rows[:, 2] > rows[:, 0]])
