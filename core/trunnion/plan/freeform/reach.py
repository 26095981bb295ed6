"""Reach of a cutter from a direction: the share of the part's area that it touches without entering the part anywhere."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.sheet.skin import Skin
from trunnion.model.tool import Tool
from trunnion.plan.freeform.cutters.cutter import level_disc, lower_side, tip_at
from trunnion.plan.freeform.finishing.rest import HOLDER_CLEARANCE, LIFTED
from trunnion.plan.freeform.space import SurfaceSpace
from trunnion.progress import NO_PROGRESS, Progress

SAMPLES = 1500
"""Samples that an area is judged by; one of them stands for less than a thousandth of it."""
BESIDE = 1.0
"""mm: how far to both sides of the height that decides whether a tool is free heights are told apart: much, to rounding."""
PLASTIC = 1.3247179572447460
"""The real root of x^3 = x + 1."""
STEPS = (1.0 / PLASTIC, 1.0 / PLASTIC**2)
"""Steps of an even spread over a square (Roberts 2018, R2). No whole numbers of both add up to one: else lines would hold all of it."""


class PartSpace(Protocol):
    """The skin of a part and the lower corner (3,) of its blank's box, seen from the tool's direction (`SurfaceSpace`, `SurfaceDrive`)."""

    @property
    def skin(self) -> Skin: ...

    @property
    def low(self) -> Floats: ...


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class AreaSamples:
    """Samples (k, 3) on faces with outward unit normals (k, 3) and tags (k,), each standing for the same area in mm2."""

    point: Floats
    normal: Floats
    face: Ints
    area: float

    def __len__(self) -> int:
        return len(self.face)

    def of(self, rows: Bools) -> AreaSamples:
        """Return some of the samples."""
        return AreaSamples(
            point=self.point[rows], normal=self.normal[rows], face=self.face[rows], area=self.area
        )


def samples_on(skin: Skin, tags: tuple[int, ...], count: int = SAMPLES) -> AreaSamples:
    """Return samples spread evenly over faces: a sample stands for an equal share of their area, the same ones each time."""
    rows = np.flatnonzero(skin.of(tags))
    corners = skin.points[skin.triangles[rows]]
    area = skin.areas(skin.of(tags))
    total = float(area.sum())
    if total <= 0.0:
        return AreaSamples(
            point=np.zeros((0, 3)), normal=np.zeros((0, 3)), face=np.zeros(0, np.int64), area=0.0
        )
    at = np.minimum(
        np.searchsorted(np.cumsum(area), (np.arange(count) + 0.5) / count * total), len(rows) - 1
    )
    u, v = (np.mod((np.arange(count) + 0.5) * step, 1.0) for step in STEPS)
    over = u + v > 1.0
    u, v = np.where(over, 1.0 - u, u), np.where(over, 1.0 - v, v)
    weight = np.column_stack([1.0 - u - v, u, v])[:, :, None]
    normal = (weight * skin.normals[skin.triangles[rows[at]]]).sum(axis=1)
    return AreaSamples(
        point=(weight * corners[at]).sum(axis=1),
        normal=normal / np.linalg.norm(normal, axis=1, keepdims=True),
        face=skin.face[rows[at]],
        area=total / count,
    )


def leans(samples: AreaSamples) -> Floats:
    """Return how far the normals of samples lean from the tool's axis (k,), rad."""
    return np.asarray(np.arccos(np.clip(samples.normal[:, 2], -1.0, 1.0)))


def reached(
    space: PartSpace,
    samples: AreaSamples,
    tool: Tool,
    clearance: float,
    allowance: float = 0.0,
    progress: Progress = NO_PROGRESS,
    below: float = 0.0,
) -> Bools:
    """Return which samples (k,) an upright cutter touches without being lifted off by other faces, with its shank and holder at least
    `clearance` mm above the part, and without going lower than the blank by more than is allowed `below` it (mm).

    With an allowance it is the faces thickened by so much that it touches.
    """
    steepest = math.pi / 2.0 + tolerance.ANGLE
    found = leans(samples) < steepest
    rows = np.flatnonzero(found)
    axis = np.tile([0.0, 0.0, 1.0], (len(rows), 1))
    # Off the face by twice what its triangles may be too high: beside steep faces a little of that lifts a cutter far. The cutter stays as
    # thick as it is: one as round as a bowl touches it everywhere from one place, and has no way to go in it.
    off = allowance + 2.0 * space.skin.bound
    tip = tip_at(tool, samples.point[rows] + off * samples.normal[rows], samples.normal[rows], axis)
    plan = tip[:, :2]
    # Only on which side of a height the tip is matters: what lies far from that is never searched to its end.
    near = tip[:, 2] - allowance
    side = lower_side(tool, allowance)
    space.skin.made_ready(progress)
    top = space.skin.drop.drop(plan, side, near - BESIDE, progress, near + BESIDE) + allowance
    highest = float(space.skin.points[:, 2].max())
    clear = (top - tip[:, 2] < LIFTED) & (tip[:, 2] > space.low[2] - below - tolerance.SEW)
    for z0, r0, _, r1 in tool.profile():
        # What is no wider than the cutter goes where it has been.
        if max(r0, r1) > tool.radius + tolerance.COINCIDENT:
            some = np.flatnonzero(clear)[tip[clear, 2] + z0 - clearance < highest]
            near = tip[some, 2] + z0 - clearance
            disc = level_disc(max(r0, r1) + HOLDER_CLEARANCE)
            over = space.skin.drop.drop(plan[some], disc, near - BESIDE, progress, near + BESIDE)
            clear[some] = over < near
    found[rows] = clear
    return found


def is_clear_of_walls(
    space: SurfaceSpace,
    samples: AreaSamples,
    tool: Tool,
    bottom: float,
    clearance: float,
    allowance: float,
) -> bool:
    """Return whether shank and holder of a cutter that goes along upright walls, its tip at a height, stay `clearance` mm over what is
    beside: the part with an allowance all round."""
    shifted = samples.point[:, :2] + tool.radius * samples.normal[:, :2]
    lowest = float(space.low[2]) - 1.0
    for z0, r0, _, r1 in tool.profile():
        if max(r0, r1) > tool.radius + tolerance.COINCIDENT:
            over = space.skin.drop.drop(
                shifted, level_disc(max(r0, r1) + HOLDER_CLEARANCE + allowance), lowest
            )
            if (over + allowance + clearance >= bottom + z0).any():
                return False
    return True


def free_before(
    space: SurfaceSpace,
    samples: AreaSamples,
    radius: float,
    bottom: float,
    progress: Progress = NO_PROGRESS,
) -> Bools:
    """Return before which samples (k,) of upright walls a disc of a radius (mm) may go down to a height: none of the part is over it."""
    shifted = samples.point[:, :2] + (radius + tolerance.SEW) * samples.normal[:, :2]
    lowest = float(space.low[2]) - 1.0
    over = space.skin.drop.drop(shifted, level_disc(radius), lowest, progress)
    return np.asarray(over < bottom + tolerance.SEW)
