"""What stands of a blank in voxels of its box, whatever direction it was cut from; a voxel counts as gone when nothing in it is left.

So whatever stands has the middle of such a voxel within half its diagonal: bodies that are wider by that keep clear of all of it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from scipy.spatial import cKDTree

from trunnion.geometry.arrays import Bools, Floats
from trunnion.geometry.frame import Frame
from trunnion.geometry.kernels.voxels import voxels_above, voxels_held
from trunnion.geometry.sheet.skin import Skin
from trunnion.model.blank import Blank
from trunnion.plan.freeform.reach import AreaSamples, samples_on
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.settings import digest
from trunnion.threads import in_parallel
from trunnion.toolpath.stock.heightfield import PlanningStock
from trunnion.toolpath.stock.leaning_cuts import LeaningCut
from trunnion.toolpath.stock.remaining import RemainingStock

SIDE, MOST = 0.5, 12_000_000
"""Side of a voxel in mm, and how many of them a blank has at most: beyond, they are larger."""
EACH, MOST_SAMPLES = 0.5, 200_000
"""mm2 of the part for each of the samples that say how far voxels are off it, and the most of them."""
BLOCK = 4
"""Voxels along the side of a block that is looked at whole where the part is far."""
BLOCKS = 4_000
"""Blocks that are looked at between two looks at cancel."""
POSES = 2000
"""Poses whose cuts one thread takes off before it looks for more."""


@dataclass(slots=True, eq=False, kw_only=True)
class StockVoxels:
    """Voxels of a blank, their middles from `low` (3,) mm in its frame on and `step` (3,) apart: `wanted` those that are ever asked for,
    `below` those that a field of heights still has, `uncut` those that leaning tools have left, all (nx, ny, nz)."""

    frame: Frame
    low: Floats
    step: Floats
    wanted: Bools
    below: Bools
    uncut: Bools
    _seen: dict[str, str] = field(default_factory=dict)
    _cuts: list[str] = field(default_factory=list)

    @staticmethod
    def of(blank: Blank, part: Skin, near: float, progress: Progress = NO_PROGRESS) -> StockVoxels:
        """Return the voxels of an uncut blank, of which those are wanted that are outside of a part, given by its skin in its own
        coordinates, and farther from it than `near` (mm)."""
        low, high = blank.box_in(blank.frame)
        side = max(SIDE, float(np.prod(high - low) / MOST) ** (1.0 / 3.0))
        count = np.maximum(np.ceil((high - low) / side), 1).astype(int)
        step = (high - low) / count
        first = low + 0.5 * step
        nx, ny, nz = count.tolist()
        wanted = np.zeros((nx, ny, nz), dtype=bool)
        _mark_outside(wanted, blank.frame, first, step, samples_of(part), near, progress)
        return StockVoxels(
            frame=blank.frame,
            low=first,
            step=step,
            wanted=wanted,
            below=wanted.copy(),
            uncut=wanted.copy(),
        )

    @property
    def reach(self) -> float:
        """How far in mm something in a voxel may be from its middle."""
        return 0.5 * float(np.linalg.norm(self.step))

    @property
    def cuts(self) -> int:
        """How many leaning tools' cuts were taken off."""
        return len(self._cuts)

    def lower(self, name: str, stock: PlanningStock, frame: Frame) -> None:
        """Take off what a stock in a frame, known by a name, has no more."""
        if self._seen.get(name) != stock.digest:
            self._seen[name] = stock.digest
            turn = frame.axes @ self.frame.axes.T
            shift = frame.to_local(self.frame.origin)
            voxels_above(
                self.below,
                self.low,
                self.step,
                np.ascontiguousarray(turn),
                np.ascontiguousarray(shift),
                stock.heights,
                stock.corner,
                stock.cell,
            )

    def cut(self, cut: LeaningCut, progress: Progress = NO_PROGRESS) -> None:
        """Take off what a leaning tool has cut, the next one of all."""
        self._cuts.append(cut.digest)
        rows = cut.flutes(self.reach)
        tips, axes = cut.poses_in(self.frame)
        if not len(rows) or not len(tips):
            return
        tips, axes = np.ascontiguousarray(tips), np.ascontiguousarray(axes)

        def work(first: int, last: int) -> None:
            # Threads may clear the same voxel: what comes of it is the same.
            voxels_held(self.uncut, self.low, self.step, tips[first:last], axes[first:last], rows)

        in_parallel(work, len(tips), POSES, progress, "Looking for what stands in the way")

    def remaining(self, frame: Frame, *, leaning: bool) -> RemainingStock:
        """Return the outermost of the wanted voxels in which something stands, in a frame: what comes to others comes to them. With
        `leaning` without what leaning tools have cut."""
        there = self.below & self.uncut if leaning else self.below
        rows = np.argwhere(there & ~_inner(there))
        points = frame.to_local(self.frame.to_world(self.low + rows * self.step))
        cut = digest(*self._cuts) if leaning and self._cuts else ""
        return RemainingStock(points=points, side=2.0 / math.sqrt(3.0) * self.reach, cut=cut)


def samples_of(part: Skin) -> AreaSamples:
    """Return the samples of a skin by which voxels are known to be off it."""
    area = float(part.areas().sum())
    tags = tuple(int(t) for t in np.unique(part.face))
    return samples_on(part, tags, int(min(max(area / EACH, 1.0), MOST_SAMPLES)))


def _mark_outside(
    wanted: Bools,
    frame: Frame,
    low: Floats,
    step: Floats,
    part: AreaSamples,
    near: float,
    progress: Progress,
) -> None:
    """Set the voxels in a frame outside of a part whose middles are farther from it than `near` (mm). Where the part is far from a block of
    voxels, its middle tells for all of them."""
    point, normal = frame.to_local(part.point), frame.local_direction(part.normal)
    tree = cKDTree(point)

    def looked(middle: Floats) -> tuple[Bools, Floats]:
        away, nearest = tree.query(middle)
        off = ((middle - point[nearest]) * normal[nearest]).sum(axis=1)
        return np.asarray(off > 0.0), np.asarray(away)

    block = BLOCK * step
    # No place on the part is farther from a sample than the side of the square that it stands for.
    enough = near + 0.5 * float(np.linalg.norm(block)) + math.sqrt(part.area)
    blocks = np.argwhere(np.ones([-(-n // BLOCK) for n in wanted.shape], dtype=bool))
    within = np.argwhere(np.ones((BLOCK,) * 3, dtype=bool))
    for first in progress.each(range(0, len(blocks), BLOCKS)):
        some = blocks[first : first + BLOCKS]
        outside, away = looked(low - 0.5 * step + (some + 0.5) * block)
        for i, j, k in (BLOCK * some[outside & (away > enough)]).tolist():
            wanted[i : i + BLOCK, j : j + BLOCK, k : k + BLOCK] = True
        rows = (BLOCK * some[away <= enough][:, None] + within).reshape(-1, 3)
        rows = rows[(rows < wanted.shape).all(axis=1)]
        outside, away = looked(low + rows * step)
        wanted[tuple(rows[outside & (away > near)].T)] = True


def _inner(there: Bools) -> Bools:
    """Return the voxels of a set (nx, ny, nz) whose neighbours all round, over edges and corners too, are in it."""
    for axis in range(3):
        here = np.moveaxis(there, axis, 0)
        inner = np.zeros_like(here)
        inner[1:-1] = here[:-2] & here[1:-1] & here[2:]
        there = np.moveaxis(inner, 0, axis)
    return there
