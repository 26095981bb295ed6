"""What stands over a part beyond a thickness: positions in the blank that no field of heights has above it and no leaning tool has cut, for
bodies to keep clear of.

There is never less than this says but in gaps between the positions, by which bodies are taken wider.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.spatial import cKDTree

from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.frame import Frame
from trunnion.geometry.point_groups import PointGroups
from trunnion.model.blank import Blank
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.settings import digest
from trunnion.threads import in_parallel
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.toolpath.stock.leaning_cuts import LeaningCut, StockLattice

CELL, MOST = 1.0, 400_000
"""mm between positions, and how many of them a blank has at most: beyond, they lie farther apart."""
POSES = 500
"""Poses that one thread holds against what stands before it looks for more."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RemainingStock:
    """Positions (k, 3) mm in material that stands, `cell` mm apart, in the frame of the poses that are held against it. `cut` is a digest
    of what leaning tools have cut of it, empty where that is nothing."""

    points: Floats
    cell: float
    cut: str = ""
    _groups: list[PointGroups] = field(init=False, repr=False, default_factory=list)

    @property
    def groups(self) -> PointGroups:
        """The positions in groups; made on first use."""
        if not self._groups:
            self._groups.append(PointGroups.of(self.points, self.cell))
        return self._groups[0]

    @staticmethod
    def of(
        blank: Blank,
        frame: Frame,
        fields: Sequence[tuple[PlanningStock, Frame]],
        cuts: Sequence[LeaningCut] = (),
    ) -> RemainingStock:
        """Return all that is not known to be gone: what lies in the blank, below every one of some fields, each with its frame, and in no
        cut of a leaning tool."""
        lattice, cell = lattice_in(blank, frame)
        present = np.ones(lattice.count, dtype=bool)
        for cut in cuts:
            cut.take_off(present, lattice, frame)
        points = lattice.points()[present.ravel()]
        for stock, other in fields:
            points = points[_is_below(stock, other.to_local(frame.to_world(points)))]
        return RemainingStock(
            points=points, cell=cell, cut=digest(*(c.digest for c in cuts)) if cuts else ""
        )

    @property
    def is_empty(self) -> bool:
        """Whether nothing stands."""
        return not len(self.points)

    def beyond(self, thickness: float, points: Floats, normals: Floats) -> RemainingStock:
        """Return what of it is farther than a thickness (mm) outside of a part with positions (s, 3) and normals (s, 3) spread over it."""
        if not len(self.points):
            return self
        away, row = cKDTree(points).query(self.points)
        outside = ((self.points - points[row]) * normals[row]).sum(axis=1) > 0.0
        return replace(self, points=self.points[outside & (away > thickness)])

    def is_free(
        self,
        rows: Sequence[tuple[float, float, float, float]],
        tip: Floats,
        axis: Floats,
        progress: Progress = NO_PROGRESS,
    ) -> Bools:
        """Return at which poses (k,) a body of cones (z0, r0, z1, r1) from the tip up holds nothing of it."""
        wider = 0.5 * math.sqrt(3.0) * self.cell
        body = np.array([(z0 - wider, r0 + wider, z1, r1 + wider) for z0, r0, z1, r1 in rows])
        held = np.zeros(len(tip), dtype=bool)
        if len(self.points) and len(body):
            groups = self.groups

            def work(first: int, last: int) -> None:
                held[first:last] = groups.held_by(body, tip[first:last], axis[first:last])

            in_parallel(work, len(tip), POSES, progress, "Looking for what stands in the way")
        return ~held


def lattice_in(blank: Blank, frame: Frame) -> tuple[StockLattice, float]:
    """Return the positions that a blank is known by in a frame, and how far they lie apart in mm at most."""
    low, high = blank.box_in(frame)
    cell = max(CELL, float(np.prod(high - low) / MOST) ** (1.0 / 3.0))
    count = np.maximum(np.ceil((high - low) / cell), 1).astype(int)
    step = (high - low) / count
    nx, ny, nz = count.tolist()
    return StockLattice(low=low + 0.5 * step, step=step, count=(nx, ny, nz)), cell


def _is_below(stock: PlanningStock, points: Floats) -> Bools:
    """Return which points (k, 3) in a field's frame it doesn't know to be gone; beside the field nothing stands."""
    cell = np.floor((points[:, :2] - stock.corner) / stock.cell).astype(np.int64)
    last = np.array(stock.heights.shape) - 1
    inside = ((cell >= 0) & (cell <= last)).all(axis=1)
    return np.asarray(inside & (points[:, 2] < stock.heights[tuple(np.clip(cell, 0, last).T)]))
