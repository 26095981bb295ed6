"""What an earlier cutter left of faces, as an area of its own: where it was lifted off them, and a little around; and what is none of a
cutter's area, for its shank or holder would meet the part there."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.geometry.sheet.skin import Skin
from trunnion.geometry.surface.drop_surface import DropSurface
from trunnion.model.tool import Tool
from trunnion.plan.freeform.cutters.cutter import level_disc, lower_side, tip_at
from trunnion.plan.freeform.estimate.scallop import stepover_on_plane
from trunnion.plan.freeform.finishing.partition import parted_near, with_shorter_edges
from trunnion.progress import NO_PROGRESS, Progress

LIFTED = 0.5 * tolerance.GOUGE
"""mm: a cutter that other faces lift by no more than this still reaches a position."""
UNSEEN = 0.1
"""Of the scallop height: a cutter that is lifted by no more than this finishes a position."""
UPRIGHT = -math.sin(tolerance.ANGLE)
"""Least height of a unit normal of a face that an upright cutter touches: upright walls are among them."""
AROUND = 0.3
"""mm at least that an area goes on past what was left, so that no seam stays; as far as passes are apart where that is more."""
LAP = 3.0
"""Of the same: how far what is handed on to a leaning tool goes on."""
MET, MOST = 1.5, 20_000
"""mm: the longest edge of triangles that are tested for shank or holder meeting something; and how many such squares there are at most."""
QUERY_SPACING, DOUBT = 1.0, 1.5
"""mm: one position of each cube of this width, and of each side that faces turn there, is queried first; and by how much wider and lower
shank and holder are taken then, for its neighbours' sake."""
SHOWN = 1.0
"""mm: what shank and holder are clear of by more counts no better, and what they are in by more no worse; nor does a cutter that is lifted
by more leave more."""
HOLDER_CLEARANCE = 0.2
"""mm that shank and holder keep from adjacent walls."""


def remaining_of(
    skin: Skin,
    tags: tuple[int, ...],
    earlier: Tool,
    lowest: float,
    height: float,
    progress: Progress = NO_PROGRESS,
    upright: Tool | None = None,
) -> tuple[Skin, tuple[int, ...]]:
    """Return the skin with what an upright cutter leaves of faces given tags of their own, and those tags; `height` is the scallop height
    in mm that is wanted. Of that another `upright` one gets what it isn't lifted off too, a leaning one (None) what hangs over as well."""
    over = lifted = _lifted_over(
        skin, earlier, lowest, height, np.inf if upright is None else -np.inf, progress
    )
    if upright is not None:
        again = _lifted_over(skin, upright, lowest, math.inf, np.inf, progress)
        # Beside a wall it gets a strip as wide as their radii differ, which may lie within one triangle of a long face. Cutters are dropped
        # on the few triangles that there were before.
        strip = max(earlier.corner_radius - upright.corner_radius, AROUND)
        finest = math.sqrt(skin.areas(skin.of(tags)).sum() / MOST)
        skin = with_shorter_edges(skin, tags, max(strip, finest), progress)

        def over(position: Floats, normal: Floats) -> Floats:
            lift = lifted(position, normal)
            rows = np.flatnonzero(lift > 0.0)
            lift[rows] = np.minimum(lift[rows], -again(position[rows], normal[rows]))
            return lift

    return parted_near(skin, tags, over, _past(earlier, height), progress=progress)


def remaining_upright(
    skin: Skin,
    tags: tuple[int, ...],
    earlier: Tool,
    lowest: float,
    height: float,
    thickness: float = 0.0,
    progress: Progress = NO_PROGRESS,
) -> tuple[Skin, tuple[int, ...]]:
    """Return the skin with what an upright cutter can't come to on faces given tags of its own, and those tags: where other faces lift it,
    what hangs over, and where its neck, shank or holder would meet the part, or a `thickness` (mm) left on faces that hang over."""
    lifted, met = (
        _lifted_over(skin, earlier, lowest, height, np.inf, progress),
        _met_over(skin, earlier, lowest, thickness, progress),
    )

    def over(position: Floats, normal: Floats) -> Floats:
        return np.maximum(lifted(position, normal), met(position, normal))

    # An upright one keeps off by two of these (`without_met`).
    return parted_near(skin, tags, over, LAP * _past(earlier, height), progress=progress)


def _past(tool: Tool, height: float) -> float:
    """Return how far in mm an area goes on past what a cutter left."""
    return max(AROUND, stepover_on_plane(tool.corner_radius, height))


def _lifted_over(
    skin: Skin, tool: Tool, lowest: float, height: float, under: float, progress: Progress
) -> Callable[[Floats, Floats], Floats]:
    """Return how far (p,) mm an upright cutter is lifted off positions (p, 3) with normals (p, 3) past what nobody sees; `under` is said
    of those that hang over.

    A cutter as round as a hollow that it lies in, or between walls as far apart as it is wide, touches it everywhere: triangles, which are
    a little off the faces, would lift it by much where they are steep. So it is taken thinner by as much.
    """
    limit, thinner = min(UNSEEN * height, LIFTED), -2.0 * skin.bound

    def over(position: Floats, normal: Floats) -> Floats:
        lift = np.full(len(position), under)
        up = normal[:, 2] > UPRIGHT
        axis = np.tile([0.0, 0.0, 1.0], (int(up.sum()), 1))
        tip = tip_at(tool, position[up], normal[up], axis)
        # It touches at its own position at least: nothing that is lower by more than triangles are off has to be looked at.
        floor = np.maximum(tip[:, 2] + 2.0 * thinner, lowest)
        # Nor does it matter where it would be that is lifted far.
        most = np.maximum(floor, tip[:, 2] + SHOWN)
        side = lower_side(tool, thinner)
        lift[up] = (
            skin.drop.drop(tip[:, :2], side, floor, progress, most) + thinner - tip[:, 2] - limit
        )
        return lift

    return over


def without_met(
    skin: Skin,
    tags: tuple[int, ...],
    tool: Tool,
    lowest: float,
    height: float,
    thickness: float = 0.0,
    progress: Progress = NO_PROGRESS,
) -> tuple[Skin, tuple[int, ...]]:
    """Return the skin and the tags of what of faces an upright tool finishes without its shank or holder meeting the part: all of them
    where these meet nothing, else not what lies around such positions, twice as far as passes are apart at a scallop height in mm.

    Neither do neck, shank and holder meet a `thickness` (mm) left on faces that hang over."""
    over = _met_over(skin, tool, lowest, thickness, progress)
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
    longest = max(MET, math.sqrt(skin.areas(skin.of(tags)).sum() / MOST))
    met_skin, met = parted_near(skin, tags, over, around, longest, progress)
    return (met_skin, tuple(t for t in tags if met_skin.of((t,)).any())) if met else (skin, tags)


def _met_over(
    skin: Skin, tool: Tool, lowest: float, thickness: float, progress: Progress
) -> Callable[..., Floats]:
    """Return how deep (p,) mm shank or holder of an upright tool are in the part at positions (p, 3) with normals (p, 3), all taken wider
    and lower by `more`; where they are not, at most nothing: -inf where an upright tool doesn't touch or nothing stands beside it, else no
    more than `SHOWN` to either side.

    What is no wider than the cutter goes where it has been, but under faces that hang over: there it meets a `thickness` (mm) left on them.
    """
    wider = tool.rings()[1:]
    whole = [(z0, max(r0, r1)) for z0, r0, _, r1 in tool.profile()]
    overhang = overhanging(skin) if thickness > 0.0 else None
    highest = float(skin.points[:, 2].max())

    def over(position: Floats, normal: Floats, more: float = 0.0) -> Floats:
        met = np.full(len(position), -np.inf)
        up = normal[:, 2] > UPRIGHT
        tip = upright_tips(skin, position[up], normal[up], tool)
        # How high the tip must be for all of the tool to be above what stands beside it.
        free = np.full(len(tip), -np.inf)
        for surface, around, bodies in ((skin.drop, 0.0, wider), (overhang, thickness, whole)):
            for z, radius in bodies if surface is not None else ():
                low = np.flatnonzero(tip[:, 2] + z - more < highest)
                if surface is not None and len(low):
                    disc = level_disc(radius + around + HOLDER_CLEARANCE + more)
                    floor = np.maximum(tip[low, 2] + z - more - SHOWN, lowest)
                    wall_top = surface.drop(tip[low, :2], disc, floor, progress)
                    free[low] = np.maximum(free[low], wall_top - z + more)
        deepest = free - tip[:, 2]
        # The part may lift the tip above its position: that needs a look only where it would be too low.
        doubtful = np.flatnonzero(deepest > 0.0)
        top = skin.drop.drop(tip[doubtful, :2], lower_side(tool), lowest, progress)
        deepest[doubtful] = np.minimum(deepest[doubtful], free[doubtful] - top)
        met[up] = np.where(deepest > -np.inf, np.clip(deepest, -SHOWN, SHOWN), -np.inf)
        return met

    return over


def overhanging(skin: Skin) -> DropSurface | None:
    """Return what of a skin faces downwards above its lowest height, ready for dropping cutters on it; None where nothing does."""
    # The face's own normals: a sliver between points of its border may be turned over, and level ground would hang over all along it.
    normal = skin.normals[skin.triangles].mean(axis=1)
    hangs = normal[:, 2] < -math.sin(tolerance.ANGLE) * np.linalg.norm(normal, axis=1)
    top = skin.points[skin.triangles][:, :, 2].max(axis=1)
    hangs &= top > float(skin.points[:, 2].min()) + tolerance.SEW
    return DropSurface.of(skin.points, skin.triangles[hangs]) if hangs.any() else None


def upright_tips(skin: Skin, position: Floats, normal: Floats, tool: Tool) -> Floats:
    """Return the tips (p, 3) of an upright cutter that touches at positions (p, 3) with normals (p, 3)."""
    at = position + 2.0 * skin.bound * normal
    return tip_at(tool, at, normal, np.tile([0.0, 0.0, 1.0], (len(at), 1)))
