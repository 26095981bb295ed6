"""Where a cutter is whose flank lies along the rulings of a guide line, and which cutters have room to lie there."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from trunnion.geometry.arrays import Floats
from trunnion.geometry.sheet.skin import Skin
from trunnion.model.tool import Tool
from trunnion.plan.clearance import ClearanceQuery
from trunnion.plan.freeform.cutters.cutter import tip_at
from trunnion.plan.freeform.swarf.guide_lines import guide_lines
from trunnion.plan.freeform.swarf.level_sections import level_sections

WHOLE, FEET = (0.15, 0.5, 0.85), (0.05,)
"""Heights between the lowest and the highest place of walls at which cutters are tried: for all of them, and for their feet."""
SAMPLES = 60
"""Positions at each of these heights."""


def flank_poses(
    point: Floats, normal: Floats, ruling: Floats, tool: Tool, allowance: float = 0.0
) -> tuple[Floats, Floats]:
    """Return tips and axes (k, 3) of a cutter that lies along rulings (k, 3) at points (k, 3) with outward unit normals (k, 3), kept off by
    an allowance: its flank begins at the points."""
    # A ruling lies in the tangent plane but for rounding: the axis is put there.
    axis = ruling - (ruling * normal).sum(axis=1, keepdims=True) * normal
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    return tip_at(tool, point + allowance * normal, normal, axis), axis


def fitting_share(
    skin: Skin,
    faces: tuple[int, ...],
    tool: Tool,
    query: ClearanceQuery,
    heights: Sequence[float] = WHOLE,
) -> float:
    """Return at which share of some positions on walls, at some heights, a cutter's flank lies along the ruling with nothing in the way."""
    z = skin.points[np.unique(skin.triangles[skin.of(faces)]), 2]
    low, high = float(z.min()), float(z.max())
    clear = list[Floats]()
    for share in heights:
        for section in level_sections(skin, faces, low + share * (high - low)):
            for line in guide_lines(section, tool.radius):
                rows = np.unique(np.linspace(0, len(line) - 1, SAMPLES).astype(np.int64))
                tip, axis = flank_poses(
                    line.point[rows], line.normal[rows], line.ruling[rows], tool
                )
                clear.append(query(tip, axis).astype(np.float64))
    return float(np.concatenate(clear).mean()) if clear else 0.0


def first_fitting(
    skin: Skin,
    faces: tuple[int, ...],
    tools: Sequence[Tool],
    query_for: Callable[[Tool], ClearanceQuery],
    share: float,
    heights: Sequence[float] = WHOLE,
) -> Tool | None:
    """Return the first of some cutters that has room at a share of all positions at some heights; None where none has."""
    return next(
        (t for t in tools if fitting_share(skin, faces, t, query_for(t), heights) >= share), None
    )
