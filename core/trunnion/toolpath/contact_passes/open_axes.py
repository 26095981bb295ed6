"""Axes with space around them: in narrow channels the axis that is farthest from everything that stops it, near to what is wanted.

The search of `axis_search` takes the nearest free axis of a coarse choice. Between two walls few of these are free, or none. Here a few
places are asked at many axes near the wanted one, each place takes what lies deepest among the free ones, and what they take is the field
between them: a search that starts from it rarely has to look further.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.spatial import cKDTree

from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.model.tool import Tool
from trunnion.plan.clearance import ClearanceQuery
from trunnion.plan.freeform.cutters.cutter import tip_at
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.toolpath.contact_passes.axis_fields import AxisField

SPACING = math.radians(5.0)
"""Between two axes that are tried: less than the space that a cutter's taper leaves in a channel."""
WIDEST = math.radians(40.0)
"""How far from the wanted axis others are tried, unless said."""
ENOUGH = math.radians(9.0)
"""Space to every side beyond which more is no better."""
PULL = 0.3
"""What a rad off the wanted axis costs, in rad of space."""
NEAREST = 6
"""Places that the field between them is made of."""
NORMALS = 6.0
"""mm that a rad between two normals counts as when places are near each other: both sides of a thin blade are far apart."""
EASINGS = 3
"""Times that each place's axis is put nearer to the mean of its neighbours', as far as it stays free there."""
POSES = 20_000
"""Poses that are asked together: memory, and a look at cancel in between."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class OpenAxes:
    """Places (k, 3) with normals (k, 3), the axes (k, 3) chosen there, and where one was free (k,)."""

    point: Floats
    normal: Floats
    axis: Floats
    free: Bools

    def field(self) -> AxisField:
        """Return the field between the places: their axes weighed by the inverse square of the distance, of place and normal.

        Raises `ValueError` where none of them has an axis.
        """
        if not self.free.any():
            raise ValueError("no place has a free axis")
        known = np.hstack([self.point[self.free], NORMALS * self.normal[self.free]])
        tree, axis = cKDTree(known), self.axis[self.free]
        count = min(NEAREST, len(known))

        def field(point: Floats, normal: Floats, feed: Floats) -> Floats:
            away, row = tree.query(np.hstack([point, NORMALS * normal]), k=count)
            away, row = (np.asarray(v).reshape(len(point), count) for v in (away, row))
            # Shepard's weights, cut off at the farthest of the nearest places so that the field has no leaps.
            far = away[:, -1:] + 1e-6
            weight = (np.maximum(far - away, 0.0) / (far * np.maximum(away, 1e-6))) ** 2
            weight = np.where(weight.sum(axis=1, keepdims=True) > 0.0, weight, 1.0)
            mean = (weight[:, :, None] * axis[row]).sum(axis=1)
            return np.asarray(mean / np.linalg.norm(mean, axis=1, keepdims=True))

        return field


def open_axes(
    point: Floats,
    normal: Floats,
    wanted: Floats,
    tool: Tool,
    query: ClearanceQuery,
    steepest: float,
    *,
    allowance: float = 0.0,
    enough: float = ENOUGH,
    pull: float = PULL,
    widest: float = WIDEST,
    progress: Progress = NO_PROGRESS,
) -> OpenAxes:
    """Return the axes of a tool that touches places (k, 3) of faces with normals (k, 3), near the wanted axes (k, 3), `allowance` mm off.

    An axis leans by no more than `steepest` rad from the normal. Of the free ones at a place it is that with the most space to those that
    are not, up to `enough` rad, less `pull` for every rad off the wanted axis; others than that are tried up to `widest` rad off it.
    """
    lattice, away = _lattice(widest)
    axes = _around(wanted, normal, lattice)
    free = _free(point + allowance * normal, normal, axes, tool, query, steepest, progress)
    k, m = free.shape
    space = np.empty((k, m))
    for row in range(k):
        blocked = ~free[row]
        space[row] = away[:, blocked].min(axis=1) if blocked.any() else widest
    score = np.minimum(space, enough) - pull * np.linalg.norm(lattice, axis=1)
    score = np.where(free, score, -np.inf)
    best = np.argmax(score, axis=1)
    rows = np.arange(k)
    axis, any_free = axes[rows, best], np.asarray(free.any(axis=1))
    return OpenAxes(
        point=point,
        normal=normal,
        axis=_eased(point, normal, axis, any_free, axes, space),
        free=any_free,
    )


def _free(
    point: Floats,
    normal: Floats,
    axes: Floats,
    tool: Tool,
    query: ClearanceQuery,
    steepest: float,
    progress: Progress,
) -> Bools:
    able = (axes * normal[:, None]).sum(axis=2) >= math.cos(steepest)
    contact, column = np.nonzero(able)
    found = np.zeros(len(contact), dtype=bool)
    for n in range(0, len(contact), POSES):
        progress.at(n / max(len(contact), 1), "Looking for space around the tool")
        some = slice(n, n + POSES)
        at, axis = contact[some], axes[contact[some], column[some]]
        found[some] = query(tip_at(tool, point[at], normal[at], axis), axis)
    free = np.zeros(able.shape, dtype=bool)
    free[contact, column] = found
    return free


def _around(wanted: Floats, normal: Floats, lattice: Floats) -> Floats:
    """Return axes (k, m, 3) at the turns of a lattice (m, 2) from wanted ones (k, 3): first towards the normal, then across."""
    lean = normal - (normal * wanted).sum(axis=1, keepdims=True) * wanted
    size = np.linalg.norm(lean, axis=1, keepdims=True)
    other = np.where(np.abs(wanted[:, 2:]) < 0.9, [[0.0, 0.0, 1.0]], [[1.0, 0.0, 0.0]])
    other = other - (other * wanted).sum(axis=1, keepdims=True) * wanted
    lean = np.where(size > 1e-6, lean, other)
    lean /= np.linalg.norm(lean, axis=1, keepdims=True)
    across = np.cross(wanted, lean)
    turn = np.linalg.norm(lattice, axis=1)
    share = np.divide(lattice, turn[:, None], out=np.zeros_like(lattice), where=turn[:, None] > 0.0)
    side = share[None, :, :1] * lean[:, None] + share[None, :, 1:] * across[:, None]
    return np.asarray(
        np.cos(turn)[None, :, None] * wanted[:, None] + np.sin(turn)[None, :, None] * side
    )


def _eased(
    point: Floats, normal: Floats, axis: Floats, known: Bools, axes: Floats, space: Floats
) -> Floats:
    """Return the axes nearer to their neighbours', as far as the lattice's nearest axis there keeps half a spacing of space."""
    rows = np.flatnonzero(known)
    if len(rows) < 3:
        return axis
    near: Ints = np.asarray(
        cKDTree(np.hstack([point, NORMALS * normal])[rows]).query(
            np.hstack([point, NORMALS * normal])[rows], k=min(NEAREST, len(rows))
        )[1]
    )
    out = axis.copy()
    for _ in range(EASINGS):
        mean = out[rows[near]].mean(axis=1)
        mean /= np.linalg.norm(mean, axis=1, keepdims=True)
        nearest = np.argmax((axes[rows] * mean[:, None]).sum(axis=2), axis=1)
        kept = space[rows, nearest] >= 0.5 * SPACING
        out[rows[kept]] = mean[kept]
    return out


@cache
def _lattice(widest: float) -> tuple[Floats, Floats]:
    """Return turns (m, 2) rad of a hexagonal lattice round the wanted axis, itself first, and the distances (m, m) between them."""
    reach = math.ceil(widest / SPACING) + 1
    i, j = (
        a.ravel() for a in np.meshgrid(np.arange(-reach, reach + 1), np.arange(-reach, reach + 1))
    )
    turn = SPACING * np.column_stack([i + 0.5 * j, 0.5 * math.sqrt(3.0) * j])
    size = np.linalg.norm(turn, axis=1)
    turn = turn[size <= widest + 1e-9]
    turn = turn[np.argsort(np.linalg.norm(turn, axis=1), kind="stable")]
    return turn, np.linalg.norm(turn[:, None] - turn[None], axis=2)
