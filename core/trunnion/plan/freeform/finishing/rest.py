"""What an earlier cutter left of faces, as an area of its own: where it was lifted off them, and a little around; and what is none of a
cutter's area, for its shank or holder would meet the part there."""

from __future__ import annotations

import math

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.geometry.sheet.skin import Skin
from trunnion.model.tool import Tool
from trunnion.plan.freeform.cutters.cutter import level_disc, lower_side, tip_at
from trunnion.plan.freeform.estimate.scallop import stepover_on_plane
from trunnion.plan.freeform.finishing.partition import parted_near
from trunnion.progress import NO_PROGRESS, Progress

LIFTED = 0.5 * tolerance.GOUGE
"""mm: a cutter that other faces lift by no more than this still reaches a position."""
UNSEEN = 0.1
"""Of the scallop height: a cutter that is lifted by no more than this finishes a position."""
AROUND = 0.3
"""mm at least that an area goes on past what was left, so that no seam stays; as far as passes are apart where that is more."""
MET, MOST = 1.5, 20_000
"""mm: the longest edge of triangles that are tested for shank or holder meeting something; and how many such squares there are at most."""
QUERY_SPACING, DOUBT = 1.0, 1.5
"""mm: one position of each cube of this width, and of each side that faces turn there, is queried first; and by how much wider and lower
shank and holder are taken then, for its neighbours' sake."""
HOLDER_CLEARANCE = 0.2
"""mm that shank and holder keep from adjacent walls."""


def remaining_of(
    skin: Skin,
    tags: tuple[int, ...],
    earlier: Tool,
    lowest: float,
    height: float,
    progress: Progress = NO_PROGRESS,
) -> tuple[Skin, tuple[int, ...]]:
    """Return the skin with what an upright cutter leaves of faces given tags of their own, and those tags; `height` is the scallop height
    in mm that is wanted."""
    limit = min(UNSEEN * height, LIFTED)

    def over(position: Floats, normal: Floats) -> Floats:
        lift = np.full(len(position), np.inf)
        up = normal[:, 2] > 0.0
        tip, top = _drop(skin, position[up], normal[up], earlier, lowest, progress)
        lift[up] = top - tip[:, 2] - limit
        return lift

    return parted_near(
        skin,
        tags,
        over,
        max(AROUND, stepover_on_plane(earlier.corner_radius, height)),
        progress=progress,
    )


def without_met(
    skin: Skin,
    tags: tuple[int, ...],
    tool: Tool,
    lowest: float,
    height: float,
    progress: Progress = NO_PROGRESS,
) -> tuple[Skin, tuple[int, ...]]:
    """Return the skin and the tags of what of faces an upright tool finishes without its shank or holder meeting the part: all of them
    where these meet nothing, else not what lies around such positions, twice as far as passes are apart at a scallop height in mm."""
    wider = [
        (z0, max(r0, r1))
        for z0, r0, _, r1 in tool.profile()
        if max(r0, r1) > tool.radius + tolerance.COINCIDENT
    ]
    highest = float(skin.points[:, 2].max())

    def over(position: Floats, normal: Floats, more: float = 0.0) -> Floats:
        met = np.full(len(position), -np.inf)
        up = normal[:, 2] > -math.sin(tolerance.ANGLE)
        tip, top = _drop(skin, position[up], normal[up], tool, lowest, progress)
        material_top = np.maximum(top, tip[:, 2])
        deepest = np.full(len(tip), -np.inf)
        for z, radius in wider:
            low = np.flatnonzero(material_top + z - more < highest)
            if len(low):
                wall_top = skin.drop.drop(
                    tip[low, :2], level_disc(radius + HOLDER_CLEARANCE + more), lowest, progress
                )
                deepest[low] = np.maximum(deepest[low], wall_top - material_top[low] - z + more)
        met[up] = deepest
        return met

    rows = skin.triangles[skin.of(tags)]
    middle, normal = skin.points[rows].mean(axis=1), skin.normals[rows].mean(axis=1)
    normal = normal / np.linalg.norm(normal, axis=1, keepdims=True)
    some = np.unique(
        np.column_stack([np.floor(middle / QUERY_SPACING), np.round(normal)]),
        axis=0,
        return_index=True,
    )[1]
    if not (over(middle[some], normal[some], DOUBT) > 0.0).any():
        return skin, tags
    # The passes go on over a rim for the distance of two of them.
    around = 2.0 * max(AROUND, stepover_on_plane(max(tool.corner_radius, height), height))
    corners = skin.points[skin.triangles[skin.of(tags)]]
    area = (
        0.5
        * np.linalg.norm(
            np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
        ).sum()
    )
    met_skin, met = parted_near(
        skin, tags, over, around, max(MET, math.sqrt(area / MOST)), progress
    )
    return (met_skin, tuple(t for t in tags if met_skin.of((t,)).any())) if met else (skin, tags)


def _drop(
    skin: Skin, position: Floats, normal: Floats, tool: Tool, lowest: float, progress: Progress
) -> tuple[Floats, Floats]:
    """Return the tips (p, 3) of an upright cutter that touches at positions (p, 3) with normals (p, 3), and the heights (p,) that the part
    lifts it to there."""
    at = position + 2.0 * skin.bound * normal
    tip = tip_at(tool, at, normal, np.tile([0.0, 0.0, 1.0], (len(at), 1)))
    return tip, skin.drop.drop(tip[:, :2], lower_side(tool), lowest, progress)
