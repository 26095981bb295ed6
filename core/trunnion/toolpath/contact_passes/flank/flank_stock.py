"""Stock beside passes of a flank while they are cut in their order: all above its flutes goes where flutes have been, or over the stock.

Flutes clear what a neck needs only as far as passes go: a lead runs on past the end of its pass, in a corner into what none above has cut.
Points of neck, shank and holder are asked, each on its own; what other leaning tools have cut before counts as left.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.model.tool import Tool
from trunnion.toolpath.contact_passes.passes import Pass
from trunnion.toolpath.contact_passes.tool_moves import ToolMoves
from trunnion.toolpath.stock.heightfield import PlanningStock

STEP = 0.5
"""mm that no place of the flutes goes between two poses that are looked at."""
INSIDE = 0.05
"""mm that a point is within the flutes by: between two points the body is nearer to the axis, and flutes between two poses clear less."""
ROUND = 36
"""Points round a body at one height."""
CHUNK = 64
"""Poses that points are held against before those that were in none of them are looked for in more."""
APART = 1.0
"""mm between two heights of points on a neck, and of those on wider bodies a quarter of their radius at least."""


@dataclass(frozen=True, eq=False)
class FlankStock:
    """What stands beside passes of a tool that are cut in their order (`linking.parameters.PassStock`), in the stock before them."""

    passes: Sequence[Pass]
    tool: Tool
    stock: PlanningStock

    def is_free(self, tips: Floats, axes: Floats, cut: Ints) -> Bools:
        """Return at which tips (k, 3) with axes (k, 3) nothing above the flutes meets stock when so many passes (k,) are cut."""
        found = np.ones(len(tips), dtype=bool)
        if not len(self._body):
            return found
        for k, (tip, axis) in enumerate(zip(tips, axes, strict=True)):
            points = tip + self._body @ _frame(axis)
            points = points[self.stock.heights_at(points[:, :2]) > points[:, 2]]
            found[k] = not len(points) or bool(self._are_cut(points, int(cut[k])).all())
        return found

    def tops(self, tips: Floats, cut: Ints) -> Floats:
        """Return that nothing stands over a flank's flutes: it goes out along its axis, where these have been or cut."""
        return np.full(len(tips), -np.inf)

    def _are_cut(self, points: Floats, cut: int) -> Bools:
        """Return which points (k, 3) were in the flutes on one of so many passes."""
        tips, axes, of_pass = self._poses
        middle = points.mean(axis=0)
        reach = self._reach + float(np.linalg.norm(points - middle, axis=1).max())
        near = np.array(self._tree.query_ball_point(middle, reach), dtype=np.int64)
        near = np.sort(near[of_pass[near] < cut])
        found = np.zeros(len(points), dtype=bool)
        # Nearest ones last cut: most points are found there.
        for first in range(len(near), 0, -CHUNK):
            rows = near[max(first - CHUNK, 0) : first]
            left = np.flatnonzero(~found)
            off = points[left, None] - tips[rows]
            along = (off * axes[rows]).sum(axis=2)
            square = (off * off).sum(axis=2) - along * along
            is_in = (along >= 0.0) & (along <= self.tool.flute_length)
            found[left] = (is_in & (square <= self._radius(along) ** 2)).any(axis=1)
            if found.all():
                break
        return found

    def _radius(self, height: Floats) -> Floats:
        """Return how far (mm) from the axis points are sure to be in the flutes at heights over the tip."""
        corner = self.tool.corner_radius
        over = np.maximum(corner - height, 0.0)
        rim = self.tool.radius - corner + np.sqrt(np.maximum(corner * corner - over * over, 0.0))
        return np.maximum(rim - INSIDE, 0.0)

    @cached_property
    def _body(self) -> Floats:
        """Points (p, 3) on and in all that is above the flutes, the tip at the origin, its axis z."""
        turn = 2.0 * math.pi * np.arange(ROUND) / ROUND
        ring = np.column_stack([np.cos(turn), np.sin(turn)])
        found = [np.zeros((0, 3))]
        for z0, r0, z1, r1 in self.tool.profile():
            count = max(1, math.ceil((z1 - z0) / max(APART, 0.25 * max(r0, r1))))
            for share in np.linspace(0.0, 1.0, count + 1).tolist():
                z, r = z0 + share * (z1 - z0), r0 + share * (r1 - r0)
                # The lowest place is the flutes' own top.
                up = max(z, self.tool.flute_length)
                found += [np.column_stack([s * r * ring, np.full(ROUND, up)]) for s in (1.0, 0.5)]
        return np.vstack(found)

    @cached_property
    def _poses(self) -> tuple[Floats, Floats, Ints]:
        """Tips and axes (n, 3) along all passes, and the pass (n,) that each is on."""
        found = [(*_along(p, self.tool.flute_length), k) for k, p in enumerate(self.passes)]
        tips, axes = (np.vstack([f[n] for f in found]) for n in (0, 1))
        return tips, axes, np.repeat([f[2] for f in found], [len(f[0]) for f in found])

    @cached_property
    def _tree(self) -> cKDTree:
        tips, axes, _ = self._poses
        return cKDTree(tips + 0.5 * self.tool.flute_length * axes)

    @property
    def _reach(self) -> float:
        """How far in mm the flutes reach from the middle of their axis."""
        return math.hypot(0.5 * self.tool.flute_length, self.tool.radius)


def _along(one: Pass, flutes: float) -> tuple[Floats, Floats]:
    """Return tips and axes (n, 3) along a pass, between which no place of the flutes (mm) goes farther than `STEP`."""
    moves = ToolMoves(one.tip[:-1], one.axis[:-1], one.tip[1:], one.axis[1:])
    _, tip, axis = moves.poses(np.ceil((moves.travel + flutes * moves.turn) / STEP))
    return tip, axis


def _frame(axis: Floats) -> Floats:
    """Return a right-handed frame (3, 3), in rows, whose third direction is an axis (3,)."""
    first = np.cross(axis, np.eye(3)[int(np.argmin(np.abs(axis)))])
    first /= np.linalg.norm(first)
    return np.array([first, np.cross(axis, first), axis])
