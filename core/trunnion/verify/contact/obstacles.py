"""Known obstacles: points of the part that blocked a tool near some positions, tested before any search; they settle most poses where
access is hard.

An obstacle is a point of the part. Where it is deeper in a tool than is allowed, and by more than the bound of the engines of contact, each
of them would say so too; where none is, nothing is known.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.frame import Frame
from trunnion.model.tool import Tool
from trunnion.verify.cutter import bodies_of_one
from trunnion.verify.kernels.contact import pose_search as kernel

KEPT = 24
"""Obstacles that are remembered at a position, those that stopped a tool last: a pit is closed by about so many from all sides."""


@dataclass(frozen=True, slots=True, eq=False)
class Obstacles:
    """Points position (k, w, 3) of the part that were in a tool's way at each of k positions, the first count (k,) of them known."""

    position: Floats
    count: Ints

    @staticmethod
    def none(k: int) -> Obstacles:
        """Return that nothing is known at k positions."""
        return Obstacles(np.zeros((k, KEPT, 3)), np.zeros(k, np.int64))

    def of(self, rows: Ints) -> Obstacles:
        """Return a copy for some of the positions; `put` takes what it learns back."""
        return Obstacles(self.position[rows], self.count[rows])

    def moved(self, frame: Frame, other: Frame) -> Obstacles:
        """Return a copy, given in a frame, as it is in another."""
        position = other.to_local(frame.to_world(self.position.reshape(-1, 3)))
        return Obstacles(position.reshape(self.position.shape), self.count.copy())

    def put(self, rows: Ints, known: Obstacles) -> None:
        """Take what is known of some of the positions."""
        self.position[rows], self.count[rows] = known.position, known.count

    def stop(self, tool: Tool, tips: Floats, axes: Floats, rows: Ints, allowed: float) -> Bools:
        """Return for poses (n, 3) of a tool, each of one of the positions, whether what is known there is deeper in the tool than
        allowed."""
        bodies, stopped = bodies_of_one(tool), np.zeros(len(tips), bool)
        kernel.blocked_by_known_loop(
            tips,
            axes,
            rows,
            bodies.arc,
            bodies.piece,
            self.position,
            self.count,
            allowed + tolerance.CONTACT_BOUND,
            stopped,
        )
        return stopped

    def add(self, found: Floats, rows: Ints) -> None:
        """Remember what stopped poses, each of one of the positions: points (n, 3), NaN where nothing did."""
        kernel.insert_obstacle_loop(found, rows, self.position, self.count)
