"""Where flutes have been, pose by pose: exact where voxels know their sides and fields of heights nothing that leans.

Poses are so near to each other that flutes which are smaller by `INSIDE` clear at them nothing that they don't clear on their way.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.kernels.flutes import bodies_free, list_poses
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.threads import in_parallel
from trunnion.toolpath.stock.heightfield import PlanningStock

STEP = 0.25
"""mm that no place of the flutes goes between two poses."""
INSIDE = 0.01
"""mm that flutes count as smaller by all round: between two poses a cutter of 3 mm clears 0.005 mm less."""
MOST_CELLS = 2_000_000
"""Cells that poses are looked up by at most: beyond, they are larger."""
POSES = 200
"""Poses that one thread asks for before it looks for more."""
NO_ROW = (1.0, 0.0, 0.0, 0.0)
"""A cone that holds nothing."""


@dataclass(slots=True, eq=False)
class FluteCuts:
    """Poses of flutes in a box from `low` (3,) on, in cubic cells of a side (mm): those of each cut under the number that it was given."""

    low: Floats
    side: float
    _first: Ints
    _flutes: list[Floats] = field(default_factory=list)
    _poses: list[tuple[Floats, Floats, int]] = field(default_factory=list)
    _joined: tuple[Floats, Floats, Ints, Ints] | None = None
    _following: Ints = field(default_factory=lambda: np.empty(0, np.int64))
    _pose: Ints = field(default_factory=lambda: np.empty(0, np.int64))
    _entries: int = 0

    @staticmethod
    def within(low: Floats, high: Floats, side: float) -> FluteCuts:
        """Return a box between two corners (3,) in which nothing has cut yet; poses in it are looked up by cells of about a side (mm)."""
        size = np.maximum(high - low, side)
        side = max(side, float(np.prod(size) / MOST_CELLS) ** (1.0 / 3.0))
        return FluteCuts(low, side, np.full(np.ceil(size / side).astype(np.int64), -1))

    def add(self, tips: Floats, axes: Floats, flutes: Floats, number: int) -> None:
        """Add the poses of a cut, tips and axes (n, 3), after all before; its flutes are cones (r, 4) from the tip up."""
        if not len(tips) or not len(flutes):
            return
        begin = sum(len(p[0]) for p in self._poses)
        self._poses.append((tips, axes, number))
        self._flutes.append(flutes)
        self._joined = None
        all_tips, all_axes, _, _ = self._cuts()
        while True:
            needed = list_poses(
                self._first,
                self.low,
                self.side,
                self._following,
                self._pose,
                self._entries,
                all_tips,
                all_axes,
                begin,
                np.ascontiguousarray(flutes),
            )
            if needed <= len(self._following):
                self._entries = needed
                return
            self._following, self._pose = (
                np.resize(a, 2 * needed) if len(a) else np.empty(2 * needed, np.int64)
                for a in (self._following, self._pose)
            )

    def is_free(
        self,
        body: Floats,
        stock: PlanningStock,
        tips: Floats,
        axes: Floats,
        before: Ints,
        progress: Progress = NO_PROGRESS,
    ) -> Bools:
        """Return at which poses, tips and axes (k, 3), all points (p, 3) of a body, the tip at the origin and its axis z, are over a stock
        or where a cut with a number below `before` (k,) has been."""
        free = np.ones(len(tips), dtype=bool)
        if not len(body) or not len(tips):
            return free
        cut_tips, cut_axes, numbers, kinds = self._cuts()
        frames, tips = frames_of(axes), np.ascontiguousarray(tips)
        flutes, heights = self._all_flutes(), stock.heights

        def work(first: int, last: int) -> None:
            some = slice(first, last)
            bodies_free(
                self._first,
                self.low,
                self.side,
                self._following,
                self._pose,
                cut_tips,
                cut_axes,
                numbers,
                kinds,
                flutes,
                heights,
                stock.corner,
                stock.cell,
                tips[some],
                frames[some],
                body,
                before[some],
                free[some],
            )

        in_parallel(work, len(tips), POSES, progress, "Looking for what stands in the way")
        return free

    def _cuts(self) -> tuple[Floats, Floats, Ints, Ints]:
        """Return tips and axes (n, 3) of all poses, and the number and the flutes (n,) of each."""
        if self._joined is None:
            many = [len(p[0]) for p in self._poses]
            none = [np.zeros((0, 3))]
            self._joined = (
                np.concatenate([*none, *(p[0] for p in self._poses)]),
                np.concatenate([*none, *(p[1] for p in self._poses)]),
                np.repeat(np.array([p[2] for p in self._poses], np.int64), many),
                np.repeat(np.arange(len(many)), many),
            )
        return self._joined

    def _all_flutes(self) -> Floats:
        """Return the flutes of all cuts (f, r, 4), filled up with cones that hold nothing."""
        most = max((len(f) for f in self._flutes), default=1)
        found = np.full((max(len(self._flutes), 1), most, 4), NO_ROW)
        for k, rows in enumerate(self._flutes):
            found[k, : len(rows)] = rows
        return found


def frames_of(axes: Floats) -> Floats:
    """Return right-handed frames (k, 3, 3), in rows, whose third directions are axes (k, 3)."""
    rows = np.arange(len(axes))
    least = np.zeros((len(axes), 3))
    least[rows, np.argmin(np.abs(axes), axis=1)] = 1.0
    first = np.cross(axes, least)
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    return np.ascontiguousarray(np.stack([first, np.cross(axes, first), axes], axis=1))


def ring(count: int) -> Floats:
    """Return so many places (k, 2) evenly on the unit circle."""
    turn = 2.0 * math.pi * np.arange(count) / count
    return np.column_stack([np.cos(turn), np.sin(turn)])
