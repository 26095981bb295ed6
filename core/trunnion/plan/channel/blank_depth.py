"""How deep below its blank's surface a place of a wheel lies, quickly: by a table of the meridian where the blank is round."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import RegularGridInterpolator

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.geometry.frame import Frame
from trunnion.model.blank import Blank
from trunnion.plan.channel.meridian import cylindrical, in_space

CELL, CLEARANCE = 0.4, 3.0
"""mm between places of the table, and how far it goes beyond the blank; between them the depth is at most a cell off."""
ANGLES = (0.0, 1.0, 2.7)
"""rad about the axis at which a blank must look the same to count as round."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BlankDepth:
    """The depth of places in a blank, in the rotor's frame; `table` None where the blank is not round about its axis."""

    blank: Blank
    rotor: Frame
    low: Floats
    high: Floats
    table: RegularGridInterpolator | None

    @staticmethod
    def of(blank: Blank, rotor: Frame) -> BlankDepth:
        """Return the depths of a blank in the rotor's frame."""
        low, high = blank.box_in(rotor)
        radius = np.arange(0.0, float(np.abs([*low[:2], *high[:2]]).max()) + CLEARANCE + CELL, CELL)
        height = np.arange(float(low[2]) - CLEARANCE, float(high[2]) + CLEARANCE + CELL, CELL)
        grid = np.stack(np.meshgrid(radius, height, indexing="ij"), axis=-1).reshape(-1, 2)
        seen = [
            blank.inward(blank.own(in_space(grid, np.full(len(grid), a)), rotor)) for a in ANGLES
        ]
        table = None
        if max(float(np.abs(s - seen[0]).max()) for s in seen) < tolerance.SEW:
            table = RegularGridInterpolator(
                (radius, height), seen[0].reshape(len(radius), len(height))
            )
        return BlankDepth(blank=blank, rotor=rotor, low=low, high=high, table=table)

    def __call__(self, points: Floats) -> Floats:
        """Return how deep below the blank's surface points (k, 3) lie, at least, mm; negative outside."""
        outside = np.maximum(np.maximum(self.low - points, points - self.high), 0.0)
        deep = -np.linalg.norm(outside, axis=1)
        rows = np.flatnonzero(deep > -0.5 * CLEARANCE)
        if not len(rows):
            return np.asarray(deep)
        if self.table is None:
            deep[rows] = self.blank.inward(self.blank.own(points[rows], self.rotor))
        else:
            inside = cylindrical(points[rows])[0]
            edge = self.table.grid[0][-1]
            near = inside[:, 0] < edge
            # Beyond the table, in the corners of the box: a round blank is nowhere wider than its box.
            widest = float(np.abs([*self.low[:2], *self.high[:2]]).max())
            deep[rows[~near]] = np.minimum(deep[rows[~near]], widest - inside[~near, 0])
            deep[rows[near]] = self.table(inside[near]) + CELL / math.sqrt(2.0)
        return np.asarray(deep)
