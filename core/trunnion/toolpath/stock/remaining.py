"""What stands of the blank off the part, as positions for bodies to keep clear of.

No place in it is farther from one of them than half the diagonal of a voxel, by which bodies are taken wider (`voxels.py`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.point_groups import PointGroups
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.threads import in_parallel

NEAR = 1.0
"""mm from the part up to which nothing is said: some stock stands there nearly everywhere."""
POSES = 500
"""Poses that one thread holds against what stands before it looks for more."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RemainingStock:
    """Positions (k, 3) mm, the middles of voxels of side `side` (mm) in which something stands, in the frame of the poses that are held
    against it. `cut` is a digest of what leaning tools have cut of it, empty where that is nothing."""

    points: Floats
    side: float
    cut: str = ""
    _groups: list[PointGroups] = field(init=False, repr=False, default_factory=list)

    @property
    def groups(self) -> PointGroups:
        """The positions in groups; made on first use."""
        if not self._groups:
            self._groups.append(PointGroups.of(self.points, self.side))
        return self._groups[0]

    @property
    def is_empty(self) -> bool:
        """Whether nothing stands."""
        return not len(self.points)

    def is_free(
        self,
        rows: Sequence[tuple[float, float, float, float]],
        tip: Floats,
        axis: Floats,
        progress: Progress = NO_PROGRESS,
    ) -> Bools:
        """Return at which poses (k,) a body of cones (z0, r0, z1, r1) from the tip up holds nothing of it."""
        wider = 0.5 * math.sqrt(3.0) * self.side
        body = np.array([(z0 - wider, r0 + wider, z1, r1 + wider) for z0, r0, z1, r1 in rows])
        held = np.zeros(len(tip), dtype=bool)
        if len(self.points) and len(body):
            groups = self.groups

            def work(first: int, last: int) -> None:
                held[first:last] = groups.held_by(body, tip[first:last], axis[first:last])

            in_parallel(work, len(tip), POSES, progress, "Looking for what stands in the way")
        return ~held
